"""Which side of a job's loose faces is outside, for the window: as the core finds it."""

from __future__ import annotations

from ..engine import InputError, core
from ..job import workpiece
from .geometry import faces_digest
from .job_data import design, flips
from .kinds import DocumentObject, PartShape

_shapes: list[tuple[str, core.Shape]] = []  # (digest of the faces, core.Shape), the last one


def loose_faces(shape: PartShape) -> list[int]:
    """Numbers from 1 of a Part shape's faces that bound no solid."""
    bound = {face.hashCode() for solid in shape.Solids for face in solid.Faces}
    return [i for i, face in enumerate(shape.Faces, 1) if face.hashCode() not in bound]


def shape_with_sides(job: DocumentObject, shape: PartShape) -> core.Shape:
    """core.Shape of a job's design (a Part shape as ``design`` gives it), flipped as the job says. Raises
    InputError."""
    digest = faces_digest(shape.Faces)
    if not _shapes or _shapes[0][0] != digest:
        _shapes[:] = [(digest, core.Shape.from_brep(shape.exportBrepToString(), job.Label))]
    given = {"flip_normals": job.FlipNormals, **flips(job)}
    return workpiece.flipped(_shapes[0][1], given)


def notes(job: DocumentObject) -> list[core.Fact]:
    """What is to be known of the sides of a job's loose faces: Facts; none if it grinds none."""
    try:
        shape, numbers = design(job)
        if not set(numbers) & set(loose_faces(shape)):
            return []
        found = shape_with_sides(job, shape)
        return [fact for fact in found.warnings() if fact.code in SIDES]
    except InputError as error:
        return [error.fact]


SIDES = (
    "brep.turned",
    "brep.side_in_doubt",
    "brep.flipped_inwards",
    "brep.sides_contrary",
)
