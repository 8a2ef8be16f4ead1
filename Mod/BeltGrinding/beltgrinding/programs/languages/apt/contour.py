"""Where a contour motion of APT ends: TLON,GOFWD along a circle up to a check surface.

CATIA writes an arc so, with the tangent before it (INDIRV) and a line, or a plane, from the centre through the
end; NCL with planes. Lengths in mm, points and unit vectors as arrays (3,). Raises Unknown for what does not say
one motion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....base.kinds import Floats, known

from ...program import MAX_COORDINATE, Unknown
from .words import NUMBER

TOKEN = re.compile(rf"\s*({NUMBER.pattern}|[A-Z][A-Z0-9]*|[(),/])", re.IGNORECASE)
DEEPEST = 6  # of parentheses
SAME = 2e-3  # mm: how exactly files write points
RADIUS_ERROR = 0.05  # mm, between an arc's radius at its start and at its end
LEVEL = 1e-3  # of a unit vector across a plane
SIDEWAYS = 0.1  # the least part of the direction along the circle
TURN = 2.0 * math.pi


class _Doubtful(Unknown):
    def __init__(self) -> None:
        super().__init__(
            "programs.apt.surface", "its curves and surfaces are not of a kind that is followed"
        )


@dataclass
class Surface:
    """A plane, or a line that stands for the plane through it across that of the motion."""

    point: Any  # Floats; None: not known
    normal: Floats | None  # None: a line
    through: Floats | None = None  # a line's other point, or where the plane's definition ends


@dataclass
class Circle:
    centre: Floats
    normal: Floats | None  # None: the motion tells its plane
    radius: float


def parsed(text: str) -> list[Any]:
    """The items of a statement's text: numbers, words, and (word, items) in parentheses."""
    at, text = 0, text.rstrip()
    stack: list[list[Any]] = [[]]
    expect = True
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise _Doubtful()
        at, token = match.end(), match.group(1).upper()
        if token == ",":
            if expect:
                raise _Doubtful()
            expect = True
        elif token == "(":
            if not expect or len(stack) > DEEPEST:
                raise _Doubtful()
            stack.append([])
        elif token == ")":
            inside = stack.pop()
            if not stack or not isinstance(inside[0] if inside else None, str):
                raise _Doubtful()
            stack[-1].append((inside[0], inside[1:]))
            expect = False
        elif token == "/":
            if len(stack[-1]) != 1 or not isinstance(stack[-1][0], str):
                raise _Doubtful()
            expect = True
        else:
            if not expect:
                raise _Doubtful()
            stack[-1].append(token if token[0].isalpha() else float(token.replace("D", "E")))
            expect = False
    if len(stack) != 1:
        raise _Doubtful()
    return stack[0]


def _numbers(items: Sequence[Any], *counts: int) -> Floats:
    if len(items) not in counts or not all(isinstance(v, float) for v in items):
        raise _Doubtful()
    if max(items) > MAX_COORDINATE or min(items) < -MAX_COORDINATE:
        raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
    return np.array(items)


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    if not 1e-6 < length < 1e9:
        raise _Doubtful()
    return vector / length


def _of(word: str, item: Any, *counts: int) -> Floats:
    """The numbers of an item (word, items)."""
    if not isinstance(item, tuple) or item[0] != word:
        raise _Doubtful()
    return _numbers(item[1], *counts)


def circle(item: Any, scale: float) -> Circle:
    """The Circle of (CIRCLE/x,y,z,r), of (CIRCLE/CANON,x,y,z,i,j,k,r) or of CYLNDR; ``scale``: mm a unit."""
    if not isinstance(item, tuple) or item[0] not in ("CIRCLE", "CYLNDR"):
        raise _Doubtful()
    values = item[1]
    if item[0] == "CIRCLE" and values[:1] == ["CANON"]:
        values = values[1:]
    values = _numbers(values, *((7,) if item[0] == "CYLNDR" else (4, 7)))
    normal = _unit(values[3:6]) if len(values) == 7 else None
    if values[-1] <= 0.0:
        raise Unknown("programs.apt.axis_or_radius", "its axis or its radius is zero")
    return Circle(scale * values[:3], normal, scale * float(values[-1]))


def surface(item: Any, scale: float) -> Surface:
    """The Surface of a LINE or a PLANE."""
    if not isinstance(item, tuple):
        raise _Doubtful()
    word, values = item
    if word == "LINE":
        values = scale * _numbers(values, 6)
        return Surface(values[:3], None, values[3:])
    if word != "PLANE" or not values:
        raise _Doubtful()
    if isinstance(values[0], float):  # i,j,k,d
        values = _numbers(values, 4)
        size = float(np.linalg.norm(values[:3]))
        normal = _unit(values[:3])
        return Surface(scale * values[3] / size * normal, normal)
    if len(values) == 3 and values[1] == "PERPTO":
        return Surface(scale * _of("POINT", values[0], 3), _unit(_of("VECTOR", values[2], 3)))
    if len(values) == 4 and values[0] == "PERPTO":
        across = surface(values[1], scale).normal
        if across is None:
            raise _Doubtful()
        first, second = (scale * _of("POINT", one, 3) for one in values[2:])
        return Surface(first, _unit(np.cross(across, second - first)), second)
    raise _Doubtful()


def statement(items: Sequence[Any], scale: float) -> tuple[Circle, Surface, int, bool]:
    """(Circle, Surface, which intersection, whether the path touches it there) of GOFWD's items."""
    if len(items) == 3:
        drive, how, check = items
        count = 1.0
    elif len(items) == 5 and items[3] == "INTOF":
        drive, how, count, _, check = items
    else:
        raise _Doubtful()
    if how in ("TO", "PAST"):
        raise Unknown(
            "programs.apt.cutter_side", "where it ends depends on the cutter, not on its tip"
        )
    if how not in ("ON", "TANTO") or count not in (1.0, 2.0):
        raise _Doubtful()
    return circle(drive, scale), surface(check, scale), int(count), how == "TANTO"


def arc(
    drive: Circle,
    check: Surface,
    count: int,
    touching: bool,
    start: Sequence[float],
    forward: Sequence[float],
    part: Surface | None,
) -> tuple[Floats, Floats, Floats, bool]:
    """(centre, normal, end, whether it is a full turn): counterclockwise about the unit normal.

    ``start``: the tip before; ``forward``: a direction in which it goes on; ``part``: the Surface that the tip
    stays on, None: the plane of the arc.
    """
    begin, ahead = np.array(start), _unit(np.array(forward))
    radius = drive.radius
    spoke = begin - drive.centre
    normal = _normal(drive, spoke, ahead)
    centre = drive.centre + (spoke @ normal) * normal
    spoke = begin - centre
    if abs(float(np.linalg.norm(spoke)) - radius) > max(RADIUS_ERROR, 1e-3 * radius):
        raise Unknown("programs.apt.arc_off_circle", "the arc's start or end is not on its circle")
    if part is not None and (
        part.normal is None
        or float(np.linalg.norm(np.cross(part.normal, normal))) > LEVEL
        or abs(float((begin - part.point) @ part.normal)) > RADIUS_ERROR
    ):
        raise Unknown("programs.apt.off_part", "the arc does not lie in the part surface (PSIS)")
    x = _unit(spoke)
    y = np.cross(normal, x)
    if abs(float(y @ ahead)) < SIDEWAYS:
        raise Unknown(
            "programs.apt.no_sense", "INDIRV or INDIRP do not say which way round the arc goes"
        )
    if y @ ahead < 0.0:
        normal, y = -normal, -y
    angle = _angle(check, count, touching, centre, radius, (x, y, normal))
    full = angle == TURN
    end = centre + radius * (math.cos(angle) * x + math.sin(angle) * y)
    return centre, normal, begin if full else end, full


def _normal(drive: Circle, spoke: Floats, forward: Floats) -> Floats:
    """The unit normal of a circle's plane. One without axis is level (a cylinder along z, by APT), or, as CATIA
    writes them, in the plane of its radius and its tangent."""
    if drive.normal is not None:
        return drive.normal
    allowed = max(RADIUS_ERROR, 1e-3 * drive.radius)
    if abs(forward[2]) < LEVEL and abs(math.hypot(spoke[0], spoke[1]) - drive.radius) <= allowed:
        return np.array([0.0, 0.0, 1.0])
    if (
        abs(float(np.linalg.norm(spoke)) - drive.radius) > allowed
        or abs(float(spoke @ forward)) > 0.02 * drive.radius
    ):
        raise Unknown("programs.apt.arc_off_circle", "the arc's start or end is not on its circle")
    return _unit(np.cross(spoke, forward))


def _angle(
    check: Surface,
    count: int,
    touching: bool,
    centre: Floats,
    radius: float,
    axes: tuple[Floats, Floats, Floats],
) -> float:
    """The angle from the start to the end of the arc, in (0, TURN]."""
    x, y, normal = axes
    across = check.normal
    if across is None:
        across = _unit(np.cross(normal, known(check.through) - check.point))
    a, b = float(across @ x), float(across @ y)
    size = math.hypot(a, b)
    if size < 1e-6:
        raise _Doubtful()
    share = float(across @ (check.point - centre)) / (size * radius)
    middle = math.atan2(b, a)
    if abs(abs(share) - 1.0) < 1e-6 or touching and abs(abs(share) - 1.0) < 1e-3:
        found = [_ahead(middle + (math.pi if share < 0.0 else 0.0), radius)]
    elif touching or abs(share) > 1.0:
        raise Unknown("programs.apt.no_crossing", "the arc does not reach its check surface")
    else:
        half = math.acos(share)
        found = sorted(_ahead(middle + sign * half, radius) for sign in (-1.0, 1.0))
    if len(found) < count:
        raise Unknown("programs.apt.no_crossing", "the arc does not reach its check surface")
    counted = found[count - 1]
    written = _written(check, centre, radius, axes)
    if written is None or abs(counted - written) * radius <= RADIUS_ERROR:
        return counted
    if TURN in found:  # whether the start counts is not said
        return written
    raise Unknown(
        "programs.apt.end_contradicts",
        "its end is another one than that of its check line",
    )


def _ahead(angle: float, radius: float) -> float:
    """An angle in (0, TURN]: the start itself is reached after a whole turn."""
    angle %= TURN
    return TURN if min(angle, TURN - angle) * radius <= SAME else angle


def _written(
    check: Surface, centre: Floats, radius: float, axes: tuple[Floats, Floats, Floats]
) -> float | None:
    """The angle of the end that a check surface from the centre to the end names; None where it names none.
    Raises Unknown where that lies off the arc's plane."""
    if check.through is None:
        return None
    x, y, normal = axes
    first, end = check.point - centre, check.through - centre
    flat = end - (end @ normal) * normal
    if (
        float(np.linalg.norm(first - (first @ normal) * normal)) > RADIUS_ERROR
        or abs(float(np.linalg.norm(flat)) - radius) > RADIUS_ERROR
    ):
        return None
    if abs(float(end @ normal)) > RADIUS_ERROR:
        raise Unknown("programs.apt.off_plane", "its end does not lie in the plane of the arc")
    return _ahead(math.atan2(float(flat @ y), float(flat @ x)), radius)
