"""Shapes and placements of document objects, as the simulator takes them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np

from ..base import frames
from ..base.kinds import Floats, Json
from ..engine import InputError, core
from ..job.workpiece import OwnBrep
from .kinds import DocumentObject, PartFace, PartShape, Placement

GRID = 5  # points per direction and face, and per edge, that tell shapes apart
RESOLUTION = 1e-6  # mm; below it, two shapes are the same
# Off the numbers that people choose, which must not lie on the border between two roundings.
OFFSET = 0.3183


def placed_shape(obj: DocumentObject) -> PartShape:
    """A copy of a document object's shape in the document's coordinates. Raises InputError."""
    shape = getattr(obj, "Shape", None)
    if shape is None or shape.isNull():
        raise InputError(
            "objects.no_shape", "{object} has no shape; choose a part with faces", object=obj.Label
        )
    shape = shape.copy()
    shape.Placement = obj.getGlobalPlacement()
    return shape


def core_shape(shape: PartShape) -> core.Shape:
    """core.Shape of a Part shape."""
    return core.Shape.from_brep(shape.exportBrepToString(), "design")


def export_solid(obj: DocumentObject, folder: Path | str, name: str) -> dict[str, Any]:
    """{"brep": ...} of a Part object, {"file": ...} of a Mesh object, written to ``folder`` under
    ``name``; in the document's coordinates, mm. Raises InputError."""
    if not hasattr(obj, "Mesh"):
        return {"brep": OwnBrep(placed_shape(obj).exportBrepToString())}
    mesh = obj.Mesh.copy()
    mesh.Placement = obj.getGlobalPlacement()
    path = Path(folder) / f"{name}.ply"
    mesh.write(str(path))
    return {"file": str(path)}


def geometry_digest(obj: DocumentObject) -> str:
    """What tells the shape or mesh of an object, and its place, apart from others."""
    if hasattr(obj, "Mesh"):
        mesh = obj.Mesh
        figures = (mesh.CountPoints, mesh.CountFacets, mesh.Area, mesh.Volume)
        return f"{figures} {obj.getGlobalPlacement().toMatrix().A}"
    return faces_digest(placed_shape(obj).Faces)


def faces_digest(faces: Iterable[PartFace]) -> str:
    """Hash of what faces look like. The B-rep's text would not do: FreeCAD changes its flags and
    locations on saving and drawing.
    """
    shares = np.linspace(0.0, 1.0, GRID).tolist()
    numbers, orientations = [], []
    for face in faces:
        orientations.append(face.Orientation)
        u0, u1, v0, v1 = face.ParameterRange
        for u in shares:
            for v in shares:
                numbers.append(face.valueAt(u0 + u * (u1 - u0), v0 + v * (v1 - v0)))
        numbers += _poles(face)
        for edge in face.Edges:
            if not edge.Degenerated:
                first, last = edge.ParameterRange
                numbers += [edge.valueAt(first + t * (last - first)) for t in shares]
    rounded = np.floor(np.array(numbers, dtype=float).reshape(-1, 3) / RESOLUTION + OFFSET)
    return hashlib.sha256(rounded.tobytes() + "".join(orientations).encode()).hexdigest()


def _poles(face: PartFace) -> list[Any]:
    try:
        surface = face.Surface
    except TypeError:  # FreeCAD has no class for it, an offset surface for one
        return []
    return (
        [pole for row in surface.getPoles() for pole in row] if hasattr(surface, "getPoles") else []
    )


def matrix(placement: Placement) -> Floats:
    """(4, 4) array of a FreeCAD.Placement, mm."""
    return np.array(placement.toMatrix().A, dtype=float).reshape(4, 4)


def placement_to_job(placement: Placement) -> dict[str, Any]:
    """A job's frame from a FreeCAD.Placement."""
    x, y, z, w = placement.Rotation.Q
    return {"position_mm": list(placement.Base), "quaternion_wxyz": [w, x, y, z]}


def placement_from_job(frame: Json | None) -> Placement:
    """FreeCAD.Placement of a job's frame (None: identity). Raises ValueError."""
    return FreeCAD.Placement(FreeCAD.Matrix(*frames.from_data(frame).ravel().tolist()))
