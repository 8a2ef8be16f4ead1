"""Functions of ABB RAPID that need no controller; mm and degrees.

They raise Unknown, or what a wrong number or kind of arguments raises in Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...program import Unknown
from .data import (
    A_POS,
    A_POSITION,
    AN_ORIENT,
    about,
    inverse,
    number,
    numbers,
    pose_of,
    product,
    turn,
)


def _offs(point: Any, x: object, y: object, z: object) -> list[Any]:
    if not isinstance(point, list) or len(point) > 4:
        raise Unknown("programs.rapid.no_position", "it is no position with an orientation")
    position = numbers(point[0], 3, A_POSITION)
    return [[p + number(d) for p, d in zip(position, (x, y, z))], *point[1:]]


def _rel_tool(
    point: Any,
    x: object,
    y: object,
    z: object,
    *,
    rx: object = 0.0,
    ry: object = 0.0,
    rz: object = 0.0,
) -> list[Any]:
    # The manual: first about x, then about the new y, then about the new z.
    turns = turn(turn(about(0, number(rx)), about(1, number(ry))), about(2, number(rz)))
    return [*product(pose_of(point), [[number(x), number(y), number(z)], turns]), *point[2:]]


def _orient_zyx(z: object, y: object, x: object) -> list[float]:
    return turn(turn(about(2, number(z)), about(1, number(y))), about(0, number(x)))


def _normalised(q: Any) -> list[float]:
    length = math.sqrt(sum(v * v for v in numbers(q, 4, AN_ORIENT)))
    return [v / length for v in q]


def _distance(a: Any, b: Any) -> float:
    return math.dist(numbers(a, 3, A_POS), numbers(b, 3, A_POS))


def _rounded(value: Any, *, dec: float = 0.0) -> float:
    scale = 10.0 ** min(15, max(0, int(dec)))
    return math.copysign(math.floor(abs(number(value)) * scale + 0.5) / scale, value)


# The controller's own that change nothing they are given.
READING = frozenset(
    """
    crobt cjointt cpos ctool cwobj calcrobt calcjointt robos opmode runmode
    dinput doutput goutput goutputdnum ginput ginputdnum ainput aoutput testdi isstopmoveact isvacant
    clkread gettime cdate ctime timestamp strlen strpart strfind strmatch strmap strorder strtobyte bytetostr
    valtostr numtostr dnumtostr eulerzyx ispers isvar valid present argname bitand bitor bitxor
    bitneg bitlsh bitrsh bitcheck uilistview uimessagebox uinumentry uinumtune uidnumentry uialphaentry uiclientexist
    filesize fsfree isfile cspeedoverride getnextsym maxrobspeed pathlevel robname taskrunmec taskrunrob
    numtodnum dnumtonum defframe defaccframe defdframe validio readmotor
    socketgetstatus readnum readstr readstrbin readbin rmqgetslotname
    """.split()
)


OF_TARGETS = ("offs", "reltool")  # whose first argument is a target
PARTS = ("trans", "rot")  # of a target
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "offs": _offs,
    "reltool": _rel_tool,
    "posemult": lambda a, b: product(pose_of(a), pose_of(b)),
    "poseinv": lambda a: inverse(pose_of(a)),
    "posevect": lambda a, v: product(pose_of(a), [numbers(v, 3, A_POS), [1.0, 0.0, 0.0, 0.0]])[0],
    "orientzyx": _orient_zyx,
    "norient": _normalised,
    "distance": _distance,
    "vectmagn": lambda v: _distance(v, [0.0, 0.0, 0.0]),
    "dotprod": lambda a, b: sum(p * q for p, q in zip(numbers(a, 3, A_POS), numbers(b, 3, A_POS))),
    "abs": lambda v: abs(number(v)),
    "sin": lambda v: math.sin(math.radians(number(v))),
    "cos": lambda v: math.cos(math.radians(number(v))),
    "tan": lambda v: math.tan(math.radians(number(v))),
    "asin": lambda v: math.degrees(math.asin(number(v))),
    "acos": lambda v: math.degrees(math.acos(number(v))),
    "atan": lambda v: math.degrees(math.atan(number(v))),
    "atan2": lambda y, x: math.degrees(math.atan2(number(y), number(x))),
    "sqrt": lambda v: math.sqrt(number(v)),
    "exp": lambda v: math.exp(number(v)),
    "pow": lambda a, b: math.pow(number(a), number(b)),
    "round": _rounded,
    "trunc": lambda v: float(math.trunc(number(v))),
    "dim": lambda a, k: float(len(a)) if k == 1 else float(len(a[0])),
}
