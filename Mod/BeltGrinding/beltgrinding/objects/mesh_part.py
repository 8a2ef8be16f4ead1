"""A mesh of the document as the part of a job: a shape of flat faces in its place."""

from __future__ import annotations

import tempfile

import Part

from ..engine import InputError
from ..job.workpiece import read_design
from .geometry import export_solid
from .kinds import DocumentObject

MOST_FACETS = 20_000  # of a shape that FreeCAD still handles well: each is a face


def faces_of(mesh: DocumentObject) -> DocumentObject:
    """Adds a Part object with the surface of a Mesh object (FreeCAD's Mesh::Feature) to its document and
    returns it: flat faces, triangles in one plane joined. Raises InputError."""
    count = mesh.Mesh.CountFacets
    if not 0 < count <= MOST_FACETS:
        raise InputError(
            "objects.mesh_facets",
            "{object}: its mesh has {count} triangles, and a part of a job 1 to {most}; reduce it "
            "(Meshes: Decimation), or model its surface",
            object=mesh.Label,
            count=count,
            most=MOST_FACETS,
        )
    with tempfile.TemporaryDirectory() as folder:
        design = {**export_solid(mesh, folder, "part"), "unit_mm": 1.0}
        text = read_design(design).write_brep()
    shape = Part.Shape()
    shape.importBrepFromString(text)
    made = mesh.Document.addObject("Part::Feature", "MeshPart")
    made.Label = f"{mesh.Label} (faces)"
    made.Shape = shape.removeSplitter()
    return made
