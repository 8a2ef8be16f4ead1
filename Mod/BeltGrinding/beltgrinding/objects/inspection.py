"""Adds what a job's result is looked at by: deviation, verdict, sections, the ground part, a scan.
Offered by ``api``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCAD

from ..base.kinds import Json
from ..engine import InputError
from . import (
    deviation as deviations,
    ground_mesh,
    job_data,
    part_scan,
    section as sections,
    verdict as verdicts,
)
from .creation import called, removed_on_error
from .fields import field_of
from .job_data import child
from .kinds import DocumentObject, Point
from .properties import set_by_name
from .simulation import simulated

if TYPE_CHECKING:
    from ..calibration.learning import Learned
    from .proxy import Proxy


def make_deviation(job: DocumentObject) -> DocumentObject:
    """Adds the coloured deviation of the job's simulation, or returns the one that is there."""
    label = FreeCAD.Qt.translate("BeltGrinding", "Deviation")
    return _follower(job, deviations.Deviation, "Mesh::FeaturePython", "Deviation", label)


def make_verdict(job: DocumentObject) -> DocumentObject:
    """Adds the verdict on the job's simulation, or returns the one that is there. It follows the
    result and the job's tolerances.
    """
    label = FreeCAD.Qt.translate("BeltGrinding", "Verdict")
    return _follower(job, verdicts.Verdict, "App::FeaturePython", "Verdict", label)


def _follower(
    job: DocumentObject, proxy: type[Proxy], kind: str, name: str, label: str
) -> DocumentObject:
    """The job's child that shows its result and follows it, made where it is missing."""
    simulation = simulated(job)
    found = child(job, proxy)
    if found is None:
        found = job.Document.addObject(kind, name)
        with removed_on_error(found):
            proxy(found)
            called(found, label)
            found.Simulation = simulation
            job.addObject(found)
            found.Proxy.update(found)
    job.Document.recompute()
    return found


def set_zones(job: DocumentObject, zones: Sequence[Json]) -> None:
    """Gives a job tolerance zones: a list of dicts as the key inspection.zones of a job file, faces
    numbered from 1 (docs/verification.md).
    """
    job_data.set_zones(job, zones)
    job.Document.recompute()


def set_sections(job: DocumentObject, sections: Sequence[Json]) -> None:
    """Gives a job sections of which its verdict tells chord, thickness and edge radii: a list of dicts as the key
    inspection.sections of a job file (docs/section.md).
    """
    job_data.set_sections(job, sections)
    job.Document.recompute()


def make_section(
    job: DocumentObject,
    point: Point | None = None,
    normal: Point | None = None,
    start: Point | None = None,
    end: Point | None = None,
    **properties: Any,
) -> DocumentObject:
    """Adds a cross-section of the job's simulation: by the plane through ``point`` with ``normal``, or
    along the surface from ``start`` to ``end`` (mm, the document's frame). Without any of them: across
    the longest side of the surface, in its middle. Raises InputError where there is nothing to cut.
    """
    simulation = simulated(job)
    field = field_of(simulation)
    if field is None:
        raise InputError(
            "objects.no_field",
            "{object}: its height field is missing; simulate again",
            object=simulation.Label,
        )
    if (point is None) != (normal is None) or (start is None) != (end is None):
        raise InputError(
            "objects.section_of_what", "a section needs a point and a normal, or a start and an end"
        )
    found = job.Document.addObject("App::FeaturePython", "Section")
    with removed_on_error(found):
        sections.Section(found)
        found.Label = FreeCAD.Qt.translate("BeltGrinding", "Cross-section")
        found.Simulation = simulation
        found.Point, found.Normal = sections.first_plane(field)
        if point is not None and normal is not None:
            found.Point, found.Normal = tuple(point), tuple(normal)
        if start is not None and end is not None:
            found.Start, found.End, found.Cut = tuple(start), tuple(end), sections.LINE
        set_by_name(found, properties)
        job.addObject(found)
        found.Proxy.update(found)
        if found.Problem:
            found.Proxy.cut(found)  # raises it
    job.Document.recompute()
    return found


def make_ground_mesh(job: DocumentObject, **properties: Any) -> DocumentObject:
    """Adds the ground part as one closed Mesh object, or makes the one that is there anew. Raises
    InputError where the result is missing or out of date.
    """
    simulation = simulated(job)
    found = child(job, ground_mesh.GroundMesh)
    if found is not None:
        set_by_name(found, properties)
        ground_mesh.make(found)
        return found
    found = job.Document.addObject("Mesh::FeaturePython", "GroundPart")
    with removed_on_error(found):
        ground_mesh.GroundMesh(found)
        found.Label = FreeCAD.Qt.translate("BeltGrinding", "Ground part")
        found.Simulation = simulation
        job.addObject(found)
        set_by_name(found, properties)
        ground_mesh.make(found)
    job.Document.recompute()
    return found


def compare_scan(job: DocumentObject, path: Path | str, **options: Any) -> dict[str, Any]:
    """Aligns a scan of the ground part and keeps its heights with the Simulation; returns the figures.
    ``options``: of ``scan.compare`` (unit_mm, start, pairs, datum_faces, fixed, ...).
    """
    simulation = simulated(job)
    figures = part_scan.compare(simulation, job, path, **options)
    simulation.touch()
    job.Document.recompute()
    return figures


def learn_scan(job: DocumentObject, **options: Any) -> Learned:
    """Corrects the job's law and the wear of its belt by the scan that ``compare_scan`` took, for the next part; returns
    ``calibration.learning.Learned``. ``options``: scatter, drift. The result is out of date then.
    """
    learned = part_scan.learn(simulated(job), job, **options)
    job.Document.recompute()
    return learned
