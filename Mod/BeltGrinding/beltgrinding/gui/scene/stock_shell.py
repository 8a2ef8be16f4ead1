"""The stock before grinding, as a see-through shell on the faces to be ground."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ...engine import InputError
from ...objects import sides
from ...objects.kinds import DocumentObject, PartShape
from ..common.kinds import Array, Node, Surface
from .part_context import design_of, tessellated
from .shapes3d import material, separator, triangles, unpickable

COLOUR, SEE_THROUGH = (0.96, 0.72, 0.30), 0.62
CREASE = 0.6  # rad
_sides: list[tuple[PartShape, dict[int, float]]] = []  # (shape, its ``_outwards``), the last one


def shell(job: DocumentObject, allowance: float) -> Node:
    """Coin node of a uniform ``allowance`` (mm) on a job's faces; empty where there is none."""
    root = separator(unpickable())
    try:
        shape, numbers = design_of(job)
    except InputError:
        return root
    if not allowance > 0.0:
        return root
    outwards = _outwards(shape)
    faces_of_shape = shape.Faces
    loose = [n for n in numbers if faces_of_shape[n - 1].hashCode() not in outwards]
    try:
        reversed_faces = sides.shape_with_sides(job, shape).reversed() if loose else ()
    except InputError:  # the job's own check tells
        return root
    for number in numbers:
        face = faces_of_shape[number - 1]
        points, faces = tessellated(face, shape)
        if len(faces):
            side = outwards.get(face.hashCode())
            if side is None:
                side = -1.0 if reversed_faces[number - 1] else 1.0
            points, faces = thickened(points, faces, side * allowance)
            root.addChild(
                separator(material(COLOUR, SEE_THROUGH), triangles(points, faces, CREASE))
            )
    return root


def _outwards(shape: PartShape) -> dict[int, float]:
    """{hash of a face: 1, or -1 where its solid is inside out} of the faces of a shape's solids."""
    for kept, found in _sides:
        if kept.isEqual(shape):
            return found
    found = {}
    for solid in shape.Solids:
        side = -1.0 if solid.Volume < 0.0 else 1.0  # a volume may take a second
        found.update((face.hashCode(), side) for face in solid.Faces)
    _sides[:] = [(shape, found)]
    return found


def thickened(points: Array, faces: Array, thickness: float) -> Surface:
    """(points, triangles) of a surface's copy, ``thickness`` mm along its normals, and of the walls between
    their borders."""
    normals = np.zeros_like(points)
    corners = points[faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for k in range(3):
        np.add.at(normals, faces[:, k], areas)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    _, first, counts = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    border = edges[first[counts == 1]]
    above = border + len(points)
    walls = np.concatenate(
        [
            np.column_stack([border[:, 0], border[:, 1], above[:, 1]]),
            np.column_stack([border[:, 0], above[:, 1], above[:, 0]]),
        ]
    )
    both = np.vstack([points, points + thickness * normals])
    return both, np.vstack([faces + len(points), walls])
