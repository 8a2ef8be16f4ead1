"""A job's external axes: linear tracks and positioners (``robot.external_axes``). They stand still in the passes, or
are coordinated: they move there with the robot.

Each is a displacement of the room: a product of exponentials of its axes, given with all of them at 0. What carries the
robot moves its base; what carries the part moves the frame of the programs, and the robot's base against it the other way.
Values are in mm and degrees, frames 4 x 4 in mm. Coordinates of robot and coordinated axes, as the core has them, are
six joints in rad, then the coordinated axes in rad or m.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base import frames
from ..base.kinds import Floats, Json
from ..engine import InputError

LINEAR, ROBOT, PART, COORDINATED = "linear", "robot", "part", "coordinated"
MOST = 3  # coordinated axes, as the core has it
SAMPLES = 400  # of all coordinated axes together, at a pose, about
TURN, WAY = 15.0, 100.0  # degrees, mm, between samples of an axis, at least
NAME = "E{}"  # of the axis by its number from 1


def validate(axes: Sequence[Json]) -> None:
    """Raises InputError for an axis that cannot stand where the job has it, or for too many that are coordinated."""
    validate_motion(axes)
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


def validate_motion(axes: Sequence[Json]) -> None:
    """Raises InputError for more coordinated axes than a posture can be searched for."""
    count = len(coordinated(axes))
    if count > MOST:
        raise InputError(
            "presets.external_coordinated",
            "{key}: {count} axes are coordinated; at most {most} can be, make the others indexed",
            key="robot.external_axes",
            count=count,
            most=MOST,
        )


def coordinated(axes: Sequence[Json]) -> list[int]:
    """Numbers, from 0, of the axes that move in the passes."""
    return [k for k, one in enumerate(axes) if one.get("motion") == COORDINATED]


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


def for_core(axes: Sequence[Json]) -> list[dict[str, Any]]:
    """As ``core.ArmScene`` takes them."""
    found = []
    for one in axes:
        unit = _unit(one)
        made = {
            "linear": one["kind"] == LINEAR,
            "carries_part": one["carries"] == PART,
            "coordinated": one.get("motion") == COORDINATED,
            "point": np.array(one["origin_mm"], dtype=float),
            "axis": np.array(one["axis"], dtype=float),
        }
        keys = ("lower", "upper", "position", "max_speed")
        found.append({**made, **{key: unit * float(one[key]) for key in keys}})
    return found


def spacing(axes: Sequence[Json]) -> list[float]:
    """rad or m between the first samples of each coordinated axis."""
    chosen = [axes[k] for k in coordinated(axes)]
    each = SAMPLES ** (1.0 / max(len(chosen), 1))
    return [
        _unit(one)
        * max(WAY if one["kind"] == LINEAR else TURN, (one["upper"] - one["lower"]) / each)
        for one in chosen
    ]


def coordinates(axes: Sequence[Json], joints_deg: Floats, values: Sequence[float]) -> Floats:
    """(6 + k,) of six joints in degrees and the ``values`` of all axes."""
    moved = [_unit(axes[k]) * values[k] for k in coordinated(axes)]
    return np.concatenate([np.radians(joints_deg), moved])


def values_of(axes: Sequence[Json], at: Floats) -> tuple[float, ...]:
    """The values of all axes at coordinates (6 + k,); indexed ones stand as they do in the passes."""
    found = [float(one["position"]) for one in axes]
    for k, value in zip(coordinated(axes), at[6:]):
        found[k] = float(value) / _unit(axes[k])
    return tuple(found)


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


def _unit(one: Json) -> float:
    """Of the core, in one of the axis."""
    return 1e-3 if one["kind"] == LINEAR else math.pi / 180.0
