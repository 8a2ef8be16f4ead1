"""The coarse mode of a job, for searching: fewer samples on the same contact cells, looser contacts, longer steps.

What it changes is small against the tolerance off the edges, and large at them: its figures carry its name, and no
verdict is given by it alone.
"""

from __future__ import annotations

from typing import Any

from ..base.kinds import Facts, Json
from ..engine import core
from .settings import Job
from .typed import typed

FULL, COARSE = "full", "coarse"
SAMPLES = (
    0.6  # of the contact's cells, apart: two thirds is the most that leaves the cells as they are
)
TOLERANCE = 1e-2  # of the contact
TRAVEL, ANGLE = 2.0, 2.0  # mm, degrees of a step


def mode(job: Job | Json) -> str:
    """ "full" or "coarse"; of a job that an older version wrote: full."""
    if isinstance(job, Job):
        return job.resolution.mode if job.resolution else FULL
    return job.get("resolution", {}).get("mode", FULL)


def with_mode(job: Json, mode: str) -> dict[str, Any]:
    """The job in another mode."""
    return {**job, "resolution": {**job.get("resolution", {}), "mode": mode}}


def sooner(job: Json) -> dict[str, Any]:
    """A validated job with the contacts and steps of the coarse mode; what is looser or longer stays, as do the steps of a job with
    temperatures."""
    read = typed(job)
    tolerance = max(read.belt_machine.contact_tolerance, TOLERANCE)
    looser = {**job, "belt_machine": {**job["belt_machine"], "contact_tolerance": tolerance}}
    if read.heat is not None:
        return looser
    longer = {
        "max_travel_mm": max(read.simulation.max_travel_mm, TRAVEL),
        "max_angle_deg": max(read.simulation.max_angle_deg, ANGLE),
    }
    return {**looser, "simulation": {**job["simulation"], **longer}}


def applied(job: Json, warnings: Facts) -> Json:
    """The job, whose spacing is settled, as its mode has it run; that it is coarse is added to ``warnings``."""
    if mode(job) == FULL:
        return job
    read = typed(job)
    sampling, machine = read.sampling, read.belt_machine
    spacing = max(sampling.spacing_mm, SAMPLES * machine.contact_spacing_mm)
    factor = spacing / sampling.spacing_mm
    finer = {
        "spacing_mm": spacing,
        "edge_spacing_mm": factor * sampling.edge_spacing_mm,
        "precision_mm": factor**2 * sampling.precision_mm,  # chords bulge by the square of it
    }
    found = sooner(job)
    warnings.append(
        core.Fact(
            "job.coarse_resolution",
            "coarse resolution, for searching: samples {spacing:.3g} mm apart, steps of {travel:.3g} mm, contacts to "
            "{tolerance:.2g}; the figures are no verdict. For one set {key} to full",
            spacing=spacing,
            travel=found["simulation"]["max_travel_mm"],
            tolerance=found["belt_machine"]["contact_tolerance"],
            key="resolution.mode",
        )
    )
    return {**found, "sampling": {**job["sampling"], **finer}}
