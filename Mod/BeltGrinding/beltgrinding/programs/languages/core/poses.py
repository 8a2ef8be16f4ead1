"""Poses as values of robot languages: 4 x 4 in mm, and what is reckoned with them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ....base.kinds import Floats
from ...program import MAX_COORDINATE, Unknown
from . import expression as core
from .expression import COMPARED, Infix, Prefix, number, true


class Joints(tuple[float, ...]):
    """Angles of a robot's axes in degrees, those of external ones behind."""


def pose(value: object) -> Floats:
    """``value`` if it is a pose."""
    if not isinstance(value, np.ndarray):
        raise Unknown("programs.pose_expected", "a pose expected")
    return value


def sound(frame: Floats) -> Floats:
    """``frame`` unless it lies beyond all bounds."""
    if not all(abs(v) < MAX_COORDINATE for v in frame[:3, 3].tolist()):
        raise Unknown("programs.pose_out_of_bounds", "the pose is out of all bounds")
    return frame


def turned(axis: int, degrees: object) -> Floats:
    """The rotation about the axis 0, 1 or 2, 4 x 4."""
    c, s = (f(math.radians(number(degrees))) for f in (math.cos, math.sin))
    frame, i, j = np.eye(4), (axis + 1) % 3, (axis + 2) % 3
    frame[i, i], frame[i, j], frame[j, i], frame[j, j] = c, -s, s, c
    return frame


def moved(x: object = 0.0, y: object = 0.0, z: object = 0.0) -> Floats:
    """The translation, 4 x 4."""
    frame = np.eye(4)
    frame[:3, 3] = number(x), number(y), number(z)
    return sound(frame)


def shifted(frame: object, x: object = 0.0, y: object = 0.0, z: object = 0.0) -> Floats:
    """The pose moved along the axes of its base."""
    found = pose(frame).copy()
    found[:3, 3] += number(x), number(y), number(z)
    return sound(found)


def zyz(
    x: object = 0.0,
    y: object = 0.0,
    z: object = 0.0,
    first: object = 0.0,
    second: object = 0.0,
    third: object = 0.0,
    *external: object,
) -> Floats:
    """The pose whose axes are turned about z, about the new y and about the new z, in degrees."""
    c1, s1, c2, s2, c3, s3 = (
        f(math.radians(number(v))) for v in (first, second, third) for f in (math.cos, math.sin)
    )
    frame = np.array(
        [
            [c1 * c2 * c3 - s1 * s3, -c1 * c2 * s3 - s1 * c3, c1 * s2, number(x)],
            [s1 * c2 * c3 + c1 * s3, -s1 * c2 * s3 + c1 * c3, s1 * s2, number(y)],
            [-s2 * c3, s2 * s3, c2, number(z)],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    return sound(frame)


def as_zyz(frame: object) -> list[float]:
    """[x, y, z, and the angles of zyz]; where y is not turned, or by 180 degrees, the third is 0."""
    r = pose(frame)[:3, :3]
    sine = math.hypot(r[0, 2], r[1, 2])
    first, third = math.atan2(-r[0, 1], r[1, 1]), 0.0
    if sine > 1e-9:
        first, third = math.atan2(r[1, 2], r[0, 2]), math.atan2(r[2, 1], -r[2, 0])
    angles = first, math.atan2(sine, r[2, 2]), third
    return [*map(float, pose(frame)[:3, 3]), *map(math.degrees, angles)]


def three_points(origin: object, on_x: object, on_xy: object, at: object = None) -> Floats:
    """The frame whose x axis goes from one position to the second, the third on the side of y; its origin in
    the fourth, or the first.
    """
    a, b, c, d = (pose(one)[:3, 3] for one in (origin, on_x, on_xy, origin if at is None else at))
    z = np.cross(b - a, c - a)
    if not np.linalg.norm(z) > 1e-9:
        raise Unknown("programs.points_on_a_line", "the points of the frame lie on a line")
    x, z = (b - a) / np.linalg.norm(b - a), z / np.linalg.norm(z)
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = np.column_stack([x, np.cross(z, x), z]), d
    return found


LONGEST_STRING = 10_000


def added(left: Any, right: Any) -> Any:
    """Two poses, the second in the first; two strings; or the sum of numbers."""
    if isinstance(left, np.ndarray):
        return sound(left @ pose(right))
    if isinstance(left, str) and isinstance(right, str):
        if len(left) + len(right) > LONGEST_STRING:
            raise Unknown("programs.string_too_long", "the string is too long")
        return left + right
    return number(number(left) + number(right))


def negative(value: Any) -> Any:
    """A pose's inverse, or the negative number."""
    return np.linalg.inv(value) if isinstance(value, np.ndarray) else -number(value)


def subtracted(left: Any, right: Any) -> Any:
    """A pose behind which another is gone back; or the difference of numbers."""
    if isinstance(left, np.ndarray):
        return added(left, negative(pose(right)))
    return number(number(left) - number(right))


def _numeric(function: Callable[..., Any]) -> Callable[..., float]:
    return lambda *values: number(float(function(*map(number, values))))


def _angle(function: Callable[..., Any]) -> Callable[..., float]:
    return _numeric(lambda *values: math.degrees(function(*values)))


# What many languages have, their angles in degrees.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "dx": lambda frame: float(pose(frame)[0, 3]),
    "dy": lambda frame: float(pose(frame)[1, 3]),
    "dz": lambda frame: float(pose(frame)[2, 3]),
    "distance": lambda a, b: float(np.linalg.norm(pose(a)[:3, 3] - pose(b)[:3, 3])),
    "sin": _numeric(lambda v: math.sin(math.radians(v))),
    "cos": _numeric(lambda v: math.cos(math.radians(v))),
    "tan": _numeric(lambda v: math.tan(math.radians(v))),
    "asin": _angle(math.asin),
    "acos": _angle(math.acos),
    "atan2": _angle(math.atan2),
    "sqrt": _numeric(math.sqrt),
    "abs": _numeric(abs),
    "int": _numeric(math.trunc),
}


# The operators that many languages have between numbers, strings and poses, their words in lower case.
INFIX: dict[str, Infix] = {
    "or": Infix(0, lambda a, b, env: true(a(env)) or true(b(env)), lazy=True),
    "xor": Infix(0, lambda a, b: true(a) != true(b)),
    "and": Infix(1, lambda a, b, env: true(a(env)) and true(b(env)), lazy=True),
    "==": Infix(3, core.alike, once=True),
    "<>": Infix(3, lambda a, b: not core.alike(a, b), once=True),
    **{name: Infix(3, function, once=True) for name, function in COMPARED.items()},
    "+": Infix(4, added),
    "-": Infix(4, subtracted),
    "*": Infix(5, lambda a, b: number(number(a) * number(b))),
    "/": Infix(5, lambda a, b: number(core.divided(a, b))),
    "mod": Infix(5, lambda a, b: math.fmod(number(a), number(b) or core.divided(a, b))),
    "^": Infix(6, core.power),
}
PREFIX: dict[str, Prefix] = {
    "not": Prefix(2, lambda v: not true(v)),
    "-": Prefix(7, negative),
    "+": Prefix(7, number),
}
