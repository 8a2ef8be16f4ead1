"""A job's external axes: linear tracks and positioners, which stand still in the passes (``robot.external_axes``).

Each is a displacement of the room: a product of exponentials of its axes, given with all of them at 0. What carries the
robot moves its base; what carries the part moves the frame of the programs, and the robot's base against it the other way.
Values are in mm and degrees, frames 4 x 4 in mm.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..base import frames
from ..base.kinds import Floats, Json
from ..engine import InputError

LINEAR, ROBOT, PART = "linear", "robot", "part"
NAME = "E{}"  # of the axis by its number from 1


def validate(axes: Sequence[Json]) -> None:
    """Raises InputError for an axis that cannot stand where the job has it."""
    for number, one in enumerate(axes, 1):
        name = NAME.format(number)
        if not np.linalg.norm(one["axis"]) > 0.0:
            raise InputError(
                "presets.external_direction",
                "{key}: {name} has no direction; give a vector such as 0, 0, 1",
                key="robot.external_axes",
                name=name,
            )
        if not one["lower"] < one["upper"]:
            raise InputError(
                "presets.external_limits",
                "{key}: {name} cannot move: its lower limit {lower:g} must lie below its upper one {upper:g}",
                key="robot.external_axes",
                name=name,
                lower=one["lower"],
                upper=one["upper"],
            )
        for what in ("home", "position"):
            if not one["lower"] <= one[what] <= one["upper"]:
                raise InputError(
                    "presets.external_beyond",
                    "{key}: {name}: its {what} {value:g} is beyond its limits of {lower:g} to {upper:g}",
                    key="robot.external_axes",
                    name=name,
                    what=what,
                    value=one[what],
                    lower=one["lower"],
                    upper=one["upper"],
                )


def refuse_held(axes: Sequence[Json], holding: str) -> None:
    """Raises InputError for a positioner of the part that the robot holds (a job's ``cell.holding``)."""
    if holding == "part_in_hand" and any(one["carries"] == PART for one in axes):
        raise InputError(
            "presets.external_of_held",
            "{key}: no external axis carries the part that the robot holds; it carries the robot",
            key="robot.external_axes",
        )


def at(axes: Sequence[Json], what: str) -> tuple[float, ...]:
    """The axes' values: ``what`` is home or position."""
    return tuple(float(one[what]) for one in axes)


def displacement(axes: Sequence[Json], values: Sequence[float], carried: str) -> Floats:
    """How far what is ``carried`` (robot, part) is from where it is with all axes at 0, in the base frame of then."""
    found = np.eye(4)
    for one, value in zip(axes, values, strict=True):
        if one["carries"] == carried:
            found = found @ _moved(one, value)
    return found


def base_from_robot(axes: Sequence[Json], values: Sequence[float], at_zero: Floats) -> Floats:
    """The robot's base in the frame of the programs, which goes with the part; ``at_zero``: with all axes at 0."""
    part = displacement(axes, values, PART)
    found: Floats = np.linalg.inv(part) @ displacement(axes, values, ROBOT) @ at_zero
    return found


def _moved(one: Json, value: float) -> Floats:
    axis = np.asarray(one["axis"], dtype=float)
    axis = axis / np.linalg.norm(axis)
    frame = np.eye(4)
    if one["kind"] == LINEAR:
        frame[:3, 3] = value * axis
        return frame
    frame[:3, :3] = frames.rotation(np.radians(value) * axis)
    origin = np.asarray(one["origin_mm"], dtype=float)
    frame[:3, 3] = origin - frame[:3, :3] @ origin
    return frame
