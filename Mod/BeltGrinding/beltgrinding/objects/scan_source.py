"""A scan that lies in the document: a mesh, points, or a shape, as the file that a comparison reads."""

from __future__ import annotations

from pathlib import Path

import MeshPart
import numpy as np

from .geometry import placed_shape
from .kinds import DocumentObject

FINE, FINEST, COARSEST = 1e-5, 0.001, 0.02  # chord error of a shape: of its diagonal; mm
HEADER = """ply
format binary_little_endian 1.0
element vertex {}
property double x
property double y
property double z
end_header
"""


def offered(job: DocumentObject) -> list[DocumentObject]:
    """The objects that may be a scan of the job's part: not the part itself, nor what is in a job."""
    design = {obj for obj, _ in job.DesignFaces}
    return [obj for obj in job.Document.Objects if obj not in design and _may_be(obj)]


def _may_be(obj: DocumentObject) -> bool:
    if hasattr(obj, "Proxy") and type(obj.Proxy).__module__.startswith(__package__):
        return False
    if hasattr(obj, "Mesh"):
        return bool(obj.Mesh.CountFacets)
    if hasattr(obj, "Points"):
        return getattr(obj.Points, "CountPoints", 0) > 0
    return bool(getattr(getattr(obj, "Shape", None), "Faces", ()))


def write(obj: DocumentObject, folder: Path | str) -> Path:
    """Writes an object to ``folder``, in the document's coordinates, mm; returns the file. Raises InputError."""
    path = Path(folder, "scan.ply")
    if hasattr(obj, "Points"):
        cloud = obj.Points.copy()
        cloud.Placement = obj.getGlobalPlacement()  # which FreeCAD's own files leave out
        points = np.array([tuple(point) for point in cloud.Points], dtype="<f8")
        path.write_bytes(HEADER.format(len(points)).encode() + points.tobytes())
        return path
    if hasattr(obj, "Mesh"):
        mesh = obj.Mesh.copy()
        mesh.Placement = obj.getGlobalPlacement()
    else:
        shape = placed_shape(obj)
        fine = min(max(FINE * shape.BoundBox.DiagonalLength, FINEST), COARSEST)
        mesh = MeshPart.meshFromShape(Shape=shape, LinearDeflection=fine, AngularDeflection=0.1)
    mesh.write(str(path))
    return path
