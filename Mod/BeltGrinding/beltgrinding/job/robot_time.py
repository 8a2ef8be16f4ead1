"""The time that the robot takes for a job's programs: its controller's limits, and what blocks keep within them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..base import records, schemas
from ..base.kinds import Json
from ..presets import library
from .settings import Job
from .typed import typed

COMMON = "common"  # the controller of a job that names none
CYCLES = 3  # of the path planner's interpolation, that a block lasts at least
# Key of a job's simulation: the controller's number.
KEYS = {
    "path_acceleration_mm_s2": "path_acceleration",
    "angular_acceleration_deg_s2": "angular_acceleration",
    "rotation_speed_deg_s": "rotation_speed",
    "default_zone_mm": "default_zone",
}


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What a job's programs must keep to; a value that the job itself gives counts more than its controller's."""

    controller: str  # id of its preset
    form: str  # spline, zones
    cycle_s: float  # of the path planner's interpolation
    least_block_s: float  # CYCLES of it at least
    least_block_mm: float
    look_ahead: int  # blocks
    path_acceleration_mm_s2: float
    angular_acceleration_deg_s2: float
    rotation_speed_deg_s: float
    default_zone_mm: float


def limits(job: Job | Json) -> Limits:
    """The ``Limits`` of a validated job. Raises InputError for a controller that is not there."""
    job = typed(job)
    name = job.robot.controller or COMMON
    preset = library.find("controllers", name)
    numbers = {key: library.middle(one) for key, one in library.numbers(preset).items()}
    rules = schemas.schema("job")["properties"]["simulation"]["properties"]
    own = {
        key: getattr(job.simulation, key)
        if getattr(job.simulation, key) != rules[key]["default"]
        else numbers[number]
        for key, number in KEYS.items()
    }
    cycle = numbers["interpolation_cycle"]
    return Limits(
        controller=name,
        form=preset["form"],
        cycle_s=cycle,
        least_block_s=max(CYCLES * cycle, numbers.get("least_block_time", 0.0)),
        least_block_mm=numbers["least_block_length"],
        look_ahead=round(numbers["look_ahead"]),
        **own,
    )


def timed(job: Job | Json) -> dict[str, Any]:
    """A validated job under the robot's time: its ``simulation`` with timing trapezoidal and the numbers of ``limits``.
    Raises InputError for a controller that is not there."""
    found = limits(job)
    data: dict[str, Any] = dict(records.plain(job))
    law = {key: getattr(found, key) for key in KEYS}
    return {**data, "simulation": {**data["simulation"], "timing": "trapezoidal", **law}}
