"""KRL's circles by an angle: CIRC through, end, CA angle."""

import math

import numpy as np

from ...program import Unknown, circle_through, turned
from .expression import number

MOST = 36_000.0  # degrees: a hundred turns


def angle(reader):
    """The angle (degrees) behind ", CA" where a Reader stands; None where there is none. Raises Unknown."""
    following = [text.lower() for _, text in reader.tokens[reader.at : reader.at + 2]]
    if following != [",", "ca"]:
        return None
    reader.at += 2
    reader.accept("=")
    value = number(reader.expression())
    if not 0.0 < abs(value) <= MOST:
        raise Unknown(
            "programs.krl.circle_angle",
            "the circle's angle (CA) is {angle} degrees; it must be other than 0 and at most {most}",
            angle=f"{value:g}",
            most=MOST,
        )
    return value


def arcs(start, through, end, degrees, turn):
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
