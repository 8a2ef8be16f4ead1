"""The time that the robot takes for a job's programs: its controller's limits, and what blocks keep within them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..base import frames, records, schemas
from ..base.kinds import Array, Facts, Floats, Json
from ..engine import Fact
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
KRL = ".src"  # the language that has both forms
PLACE_DIGITS, ANGLE_DIGITS = 3, 3  # of mm and degrees, in programs
FEED_DIGITS = 1  # of mm/s
STRAIGHT = 0.9  # cosine between the ways to a pose and from it: no corner
BARELY = 1e-9  # relative: a feed of so much less than a tenth more is that tenth


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

    @property
    def pace(self) -> tuple[float, float, float]:
        """As ``programs.write_program`` takes it."""
        return (
            self.path_acceleration_mm_s2,
            self.angular_acceleration_deg_s2,
            self.rotation_speed_deg_s,
        )


def limits(job: Job | Json) -> Limits:
    """The ``Limits`` of a validated job, or of its robot and simulation alone. Raises InputError for a controller that is
    not there."""
    job = typed(job)
    name = getattr(job.robot, "controller", None) or COMMON
    preset = library.find("controllers", name)
    numbers = {key: library.middle(one) for key, one in library.numbers(preset).items()}
    rules = schemas.schema("job")["properties"]["simulation"]["properties"]
    own = {}
    for key, number in KEYS.items():
        value = getattr(job.simulation, key, rules[key]["default"])
        own[key] = numbers[number] if value == rules[key]["default"] else value
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


def turn_speed(controller: str) -> float:
    """degrees/s at which a controller (a preset's id, "": the common one) turns the tool at most. Raises InputError."""
    numbers = library.numbers(library.find("controllers", controller or COMMON))
    return library.middle(numbers["rotation_speed"])


def form(job: Job | Json, given: str = "") -> str:
    """How passes that were laid or planned for a job are written, as ``write_program`` takes it: as its controller
    follows them, unless a form is given. Raises InputError for a controller that is not there."""
    return given or limits(job).form


def written(job: Job | Json, file: Path | str, given: str = "") -> tuple[dict[str, Any], Facts]:
    """(options of ``write_program`` for passes that were laid or planned for a job: form, digits, pace; what is to be told
    of a form that is ``given``). ``file``: its suffix says the language. Raises InputError."""
    found = limits(job)
    options = {"form": form(job, given), "digits": "robot", "pace": found.pace}
    if given in ("", found.form) or Path(file).suffix.lower() != KRL:
        return options, []
    told = {"form": given, "controller": library.find("controllers", found.controller)["name"]}
    if given == "spline":
        return options, [
            Fact(
                "job.form_unknown",
                "form {form}: {controller} knows no spline blocks and refuses the program; leave the form out, or name "
                "the controller that has them",
                **told,
            )
        ]
    return options, [
        Fact(
            "job.form_slow",
            "form {form}: {controller} reaches the feeds in spline blocks; short blocks with C_DIS may be slower than "
            "simulated",
            **told,
        )
    ]


def timed(job: Job | Json) -> dict[str, Any]:
    """A validated job under the robot's time: its ``simulation`` with timing trapezoidal and the numbers of ``limits``.
    Raises InputError for a controller that is not there."""
    found = limits(job)
    data: dict[str, Any] = dict(records.plain(job))
    law = {key: getattr(found, key) for key in KEYS}
    return {**data, "simulation": {**data["simulation"], "timing": "trapezoidal", **law}}


def laid_out(arrays: Mapping[str, Array], found: Limits) -> dict[str, Array]:
    """Arrays of a program (as ``poses.program_arrays``) with the digits that its file will have, and each pose's zone told:
    no more than half of the shorter way beside it."""
    placed = rounded_frames(arrays["frames"])
    return {**arrays, "frames": placed, "zones": _zones(arrays, placed, found)}


def rounded_frames(placed: Floats) -> Floats:
    """Frames (n, 4, 4) with the digits that programs have: places of mm, and KUKA's angles A, B, C of degrees."""
    return np.array(
        [
            frames.from_abc(
                np.round(frame[:3, 3], PLACE_DIGITS), np.round(frames.to_abc(frame), ANGLE_DIGITS)
            )
            for frame in placed
        ]
    ).reshape(-1, 4, 4)


def rounded_feeds(feeds: Floats) -> Array:
    """Feeds (n,) mm/s to the tenth below, as programs have them; those below a tenth stay."""
    scale = 10.0**FEED_DIGITS
    return np.where(feeds * scale < 1.0, feeds, np.floor(feeds * scale * (1.0 + BARELY)) / scale)


def _zones(arrays: Mapping[str, Array], placed: Floats, found: Limits) -> Floats:
    """(n,) mm: a pose of unknown zone has half of the shorter way beside it where the path goes on nearly straight, the
    default at corners, and 0 beside a rapid motion, as the time law takes it."""
    steps = np.diff(placed[:, :3, 3], axis=0)
    way = np.linalg.norm(steps, axis=1)
    half = 0.5 * np.minimum(np.append(np.inf, way), np.append(way, np.inf))
    on = np.full(len(placed), False)
    on[1:-1] = (steps[1:] * steps[:-1]).sum(axis=1) > STRAIGHT * way[1:] * way[:-1]
    rapid = np.append(arrays["rapid"], True)
    unknown = np.where(on & np.isfinite(half), half, found.default_zone_mm)
    unknown = np.where(rapid[:-1] | rapid[1:], 0.0, unknown)
    zones = np.where(arrays["zones"] == -1.0, unknown, arrays["zones"])
    within = np.where(half > 0.0, np.minimum(zones, half), zones)
    scale = 10.0**PLACE_DIGITS
    return np.floor(within * scale + BARELY) / scale
