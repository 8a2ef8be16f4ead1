"""KRL's circles by an angle: CIRC through, end, CA angle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ....base.kinds import Floats
from ...program import Unknown, circle_through, turned
from ..core.expression import Parser
from .numbers import number

MOST = 36_000.0  # degrees: a hundred turns


def angle_behind(parser: Parser) -> Any:
    """The expression behind ", CA" where a Parser stands; None where there is none. Raises Unknown."""
    following = [str(text).lower() for _, text, _ in parser.tokens[parser.at : parser.at + 2]]
    if following != [",", "ca"]:
        return None
    parser.at += 2
    parser.accept("=")
    return parser.infix()


def angle(value: object) -> float:
    """Degrees of an arc's angle. Raises Unknown."""
    degrees = number(value)
    if not 0.0 < abs(degrees) <= MOST:
        raise Unknown(
            "programs.krl.circle_angle",
            "the circle's angle (CA) is {angle} degrees; it must be other than 0 and at most {most}",
            angle=f"{degrees:g}",
            most=MOST,
        )
    return degrees


def arcs(
    start: Floats, through: Floats, end: Floats, degrees: float, turn: str
) -> list[tuple[Floats, Floats]]:
    """[(auxiliary pose, end pose)] of at most half a turn each: the way from ``start`` on the circle through
    three poses by an angle, towards ``through`` where it is positive. It ends with ``end``'s orientation;
    ``turn``: as a Motion's. Raises Unknown.
    """
    circle = circle_through(start, through, end)
    if circle is None:
        raise Unknown(
            "programs.krl.circle_on_a_line", "its points lie on a line, which is no circle"
        )
    centre, x_axis, y_axis, radius, _ = circle
    whole = math.radians(abs(degrees))
    y_axis = y_axis * math.copysign(1.0, degrees)
    count = max(1, math.ceil(abs(degrees) / 180.0 - 1e-9))
    shares = np.arange(1, 2 * count + 1) / (2 * count)
    rotations = turned(start, end, (centre, x_axis, y_axis, radius, whole), turn, shares)
    poses = np.zeros((2 * count, 4, 4))
    at = whole * shares[:, None]
    poses[:, :3, :3] = rotations
    poses[:, :3, 3] = centre + radius * (np.cos(at) * x_axis + np.sin(at) * y_axis)
    poses[:, 3, 3] = 1.0
    return list(zip(poses[0::2], poses[1::2]))
