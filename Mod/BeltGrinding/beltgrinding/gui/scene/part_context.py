"""The faces of the part that are not ground, and all its edges, for orientation."""

from __future__ import annotations

from typing import Any

import MeshPart
import numpy as np
import Part
from pivy import coin

from ...engine import InputError
from ...objects import job_data
from ...objects.kinds import DocumentObject, PartShape
from ..common.kinds import Array, Node, Rgb, Surface

GREY = (0.62, 0.64, 0.67)
EDGE = (0.2, 0.2, 0.22)
DEFLECTION = 0.001  # chord error, as a share of the part's diagonal
ANGLE = 0.2  # rad, from facet to facet
KEPT = 8  # tessellations
_designs: list[Any] = []  # (what names it, shapes of the objects, design), the last one first
_rest: list[
    Any
] = []  # (shape, numbers of its ground faces, (points, triangles) of the others), the last one
_edge_lines: list[Any] = []  # (shape, (points, counts)), the last one
_spread: list[Any] = []  # (shape, points of ``points_of_part``), the last one
_tessellated: list[Any] = []  # (shape, deflection, (points, triangles)), the last one first
SPREAD = 600  # points over a part
REST = "BeltGrindingRest"  # name of the node of the faces that are not ground


def design_of(job: DocumentObject) -> tuple[PartShape, list[int]]:
    """(shape, numbers of its ground faces from 1) as ``job_data.design``, which copies the shapes; the same
    shape again as long as the objects have theirs, so that what was made of it is found again. Raises
    InputError."""
    sources = [obj.Shape for obj, _ in job.DesignFaces if hasattr(obj, "Shape")]
    places = [obj.getGlobalPlacement().toMatrix().A for obj, _ in job.DesignFaces]
    key = [obj.Name for obj, _ in job.DesignFaces], [subs for _, subs in job.DesignFaces], places
    for kept, before, found in _designs:
        if kept == key and len(before) == len(sources):
            if all(a.isSame(b) for a, b in zip(before, sources)):
                return found
    found = job_data.design(job)
    _designs.insert(0, (key, sources, found))
    del _designs[KEPT:]
    return found


def design_key(job: DocumentObject) -> tuple[Any, ...]:
    """What a drawing of a job's part depends on, to be compared by ``==``."""
    try:
        shape, numbers = design_of(job)
    except InputError:
        return (None,)
    return shape.hashCode(), tuple(numbers)


def rest_of_part(job: DocumentObject) -> Node:
    """Coin node with the job's part without the faces to be ground, and with its edges; not picked."""
    root = coin.SoSeparator()
    root.setName(REST)
    try:
        shape, numbers = design_of(job)
    except InputError:
        return root
    ground = set(numbers)
    points, triangles = _others(shape, ground)
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = 0.5
    material = coin.SoMaterial()
    material.diffuseColor = GREY
    behind = coin.SoPolygonOffset()  # the edges that lie in the faces are drawn whole
    coordinates = coin.SoCoordinate3()
    coordinates.point.setValues(0, len(points), points.tolist())
    indices = np.column_stack([triangles, np.full(len(triangles), -1)]).ravel().tolist()
    faces = coin.SoIndexedFaceSet()
    faces.coordIndex.setValues(0, len(indices), indices)
    root.addChild(pick)
    for node in (hints, material, behind, coordinates, faces) if len(triangles) else ():
        root.addChild(node)
    root.addChild(line_set(shape))
    return root


def _others(shape: PartShape, ground: set[int]) -> Surface:
    """(points, triangles) of a shape's faces but those numbered ``ground``, from 1."""
    for kept, numbers, found in _rest:
        if numbers == ground and kept.isSame(shape):
            return found
    others = [face for i, face in enumerate(shape.Faces, 1) if i not in ground]
    found = np.zeros((0, 3)), np.zeros((0, 3), dtype=int)
    if others:
        found = _meshed(Part.Compound(others), _deflection(shape))
    _rest[:] = [(shape, ground, found)]
    return found


def tessellated(shape: PartShape, whole: PartShape | None = None) -> Surface:
    """(points (n, 3), triangles (m, 3)) of a Part shape, as fine as it is drawn here; ``whole``: what it is a
    face of."""
    deflection = _deflection(whole or shape)
    for kept, fine, found in _tessellated:
        if fine == deflection and kept.isSame(shape):
            return found
    found = _meshed(shape, deflection)
    _tessellated.insert(
        0, (shape, deflection, found)
    )  # the shape stays, so that no other takes its place
    del _tessellated[KEPT:]
    return found


def points_of_part(job: DocumentObject | None) -> Array:
    """(n, 3) some hundred points spread over a job's part by area, mm; none where it has no part."""
    if job is None:
        return np.zeros((0, 3))
    try:
        shape = design_of(job)[0]
        if _spread and _spread[0][0].isSame(shape):
            return _spread[0][1]
        points, triangles = tessellated(shape)
    except InputError:
        return np.zeros((0, 3))
    _spread[:] = [(shape, _spread_over(points, triangles))]
    return _spread[0][1]


def mesh_of_part(job: DocumentObject) -> Surface:
    """(points (n, 3), triangles (m, 3)) of a job's part, mm; none of both where it has no part."""
    try:
        return tessellated(design_of(job)[0])
    except InputError:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=int)


def _spread_over(points: Array, triangles: Array) -> Array:
    a, b, c = points[triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if not areas.sum() > 0.0:
        return points[:SPREAD]
    chance = np.random.default_rng(1)  # the same ones every time
    chosen = chance.choice(len(triangles), SPREAD, p=areas / areas.sum())
    u, v = chance.random((2, SPREAD, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]


def _meshed(shape: PartShape, deflection: float) -> Surface:
    """(points, triangles) of a shape: round holes are round, whatever the size of the part. No two faces share
    a point: light would run over from one to the other."""
    try:
        mesh = MeshPart.meshFromShape(
            Shape=shape,
            LinearDeflection=deflection,
            AngularDeflection=ANGLE,
            Relative=False,
            Segments=True,
        )
        points, faces = (np.array([tuple(one) for one in part]) for part in mesh.Topology)
        if len(faces):
            segment = np.zeros(len(faces), dtype=int)
            for k in range(mesh.countSegments()):
                segment[mesh.getSegment(k)] = k
            own, faces = np.unique(segment[:, None] * len(points) + faces, return_inverse=True)
            points, faces = points[own % len(points)], faces.reshape(-1, 3)
    except Exception:  # of a face that cannot be meshed: what FreeCAD itself would draw
        points, faces = shape.tessellate(deflection)
        points = np.array([tuple(p) for p in points], dtype=float)
    return points.reshape(-1, 3), np.array(faces, dtype=int).reshape(-1, 3)


def edges_of_part(job: DocumentObject) -> Node:
    """Coin node with the edges of the job's part; not picked."""
    root = coin.SoSeparator()
    try:
        shape = design_of(job)[0]
    except InputError:
        return root
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    root.addChild(pick)
    root.addChild(line_set(shape))
    return root


def _deflection(shape: PartShape) -> float:
    return DEFLECTION * max(shape.BoundBox.DiagonalLength, 1e-6)


def line_set(shape: PartShape, rgb: Rgb = EDGE) -> Node:
    """The edges as thin lines: without them, faces of one brightness run into one another, and the
    coloured ones have no light."""
    root = coin.SoSeparator()
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    colour = coin.SoBaseColor()
    colour.rgb = rgb
    points, counts = _lines(shape)
    coordinates = coin.SoCoordinate3()
    coordinates.point.setValues(0, len(points), points)
    lines = coin.SoLineSet()
    lines.numVertices.setValues(0, len(counts), counts)
    for node in (light, colour, coordinates, lines):
        root.addChild(node)
    return root


def _lines(shape: PartShape) -> tuple[list[Any], list[int]]:
    """(points, counts): the shape's edges as lines, one after the other."""
    for kept, found in _edge_lines:
        if kept.isSame(shape):
            return found
    points, counts = [], []
    for edge in shape.Edges:
        if edge.Degenerated:
            continue
        fine = {"Angular": ANGLE, "Curvature": _deflection(shape), "Minimum": 2}
        line = [tuple(point) for point in edge.discretize(**fine)]
        points += line
        counts.append(len(line))
    _edge_lines[:] = [(shape, (points, counts))]
    return points, counts
