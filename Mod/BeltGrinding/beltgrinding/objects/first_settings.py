"""A job's stock, machine and passes, with first values chosen from the part (raster/proposal.py)."""

from __future__ import annotations

from typing import Any

from ..base.kinds import Json
from ..engine import Cancelled, InputError
from ..planning import rough
from ..raster import proposal
from . import job_data, job_inputs, waiting
from .belt_machine import BeltMachine
from .job_data import child, children
from .kinds import DocumentObject
from .properties import rule
from .raster_path import RasterPath, generate, proposed
from .set_up import make_belt_machine, make_raster, make_stock
from .stock import Stock


def set_up(job: DocumentObject, text: str = "") -> dict[str, Any]:
    """Gives a job what it lacks of stock, belt machine and passes, with first values from the part. Returns
    what ``propose`` gives; where no passes can be laid on the faces, dict(notes: the reason) alone, and the
    job gets stock and machine with their defaults. ``text``: what a window says meanwhile. Raises Cancelled;
    the job is then half made: the caller takes it back.
    """
    if child(job, Stock) is None:
        make_stock(job)
    if child(job, BeltMachine) is None:
        make_belt_machine(job)
    try:
        found = propose(job, text)
    except InputError as error:
        return {"notes": [error]}
    if not children(job, RasterPath):
        path = make_raster(job, compute=False)
        path.Proposed = True
    apply(job, found)
    for path in children(job, RasterPath):  # robot programs are among them
        if proposed(path):
            generate(path)
            path.recompute()
    return found


def propose(job: DocumentObject, text: str = "") -> dict[str, Any]:
    """First settings for the job's faces, stock, law and belt, as ``proposal.propose`` gives them."""
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.without_programs(job, folder)
        return waiting.wait(lambda context: proposal.propose(data, context), text)


def expected(job: DocumentObject, text: str = "") -> float | None:
    """Of the area, that the job as it is brings into tolerance, by a coarse run; None where it cannot be run, or nobody
    waits for it."""
    try:
        with job_inputs.scratch_folder() as folder:
            data = job_inputs.to_data(job, folder)
            return waiting.wait(lambda context: rough.expected(data, context), text)
    except (InputError, Cancelled):
        return None


# Property: what a proposal calls it, if it has it, by the kind of machine.
WHEEL = {
    "WheelRadius": "wheel_radius_mm",
    "WheelWidth": "wheel_width_mm",
    "RimThickness": "rim_thickness_mm",
}
BELT = {"ForceTravel": "force_travel_mm", "ContactSpacing": "contact_spacing_mm"}


def values(job: DocumentObject, found: Json) -> dict[DocumentObject, dict[str, Any]]:
    """{object: {property: value}} of a proposal."""
    return {
        job: {"Spacing": found["spacing_mm"]},
        child(job, BeltMachine): {
            **{name: found[key] for name, key in {**WHEEL, **BELT}.items() if key in found},
            "Force": f"{found['force_N']} N",
        },
        **{
            path: {
                "Along": "direction",
                "Direction": tuple(found["direction"]),
                "StepOverShare": found["step_over_share"],
                "MinLength": found["min_length_mm"],
                "Feed": found["feed_mm_s"],
                "ApproachFeed": found["approach_feed_mm_s"],
            }
            for path in children(job, RasterPath)
            if proposed(path)
        },
    }


def apply(job: DocumentObject, found: Json, before: Json | None = None) -> None:
    """Sets a proposal's values; of those that ``before``, an earlier one, has set, only what nobody has
    changed since.
    """
    kept = {} if before is None else values(job, before)
    for obj, wanted in values(job, found).items():
        for name, value in wanted.items():
            if name not in kept.get(obj, ()) or _is(getattr(obj, name), kept[obj][name]):
                setattr(obj, name, value)
    machine = child(job, BeltMachine)
    for name, key in BELT.items():  # of a belt before, and of no use to what it is now
        if before and key in before and key not in found:
            if _is(getattr(machine, name), before[key]):
                setattr(machine, name, rule(f"belt_machine.{key}")[1])


def _is(now: Any, value: Any) -> bool:
    if isinstance(value, str) and hasattr(now, "getValueAs"):
        return abs(now.getValueAs(value.split()[1]).Value - float(value.split()[0])) < 1e-9
    if isinstance(value, tuple):
        return all(abs(a - b) < 1e-9 for a, b in zip(now, value))
    return now == value if isinstance(value, str) else abs(float(now) - value) < 1e-9
