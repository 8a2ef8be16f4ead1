"""Functions of VAL3 that need no controller: numbers, and points and trsf in their frames.

They raise Unknown, or what a wrong number or kind of arguments raises in Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...program import Unknown
from ..core.expression import truth
from .data import Missing, Record, Six, as_kind, in_world, inverse, number, product, six, trsf


def _degrees(function: Callable[[float], float]) -> Callable[[float], float]:
    return lambda v: function(math.radians(v))


NUMERIC: dict[str, Callable[..., float]] = {
    "abs": abs,
    "sqrt": math.sqrt,
    "exp": math.exp,
    "ln": math.log,
    "log": math.log10,
    "power": math.pow,
    "sin": _degrees(math.sin),
    "cos": _degrees(math.cos),
    "tan": _degrees(math.tan),
    "asin": lambda v: math.degrees(math.asin(v)),
    "acos": lambda v: math.degrees(math.acos(v)),
    "atan": lambda v: math.degrees(math.atan(v)),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "roundUp": math.ceil,
    "roundDown": math.floor,
    "round": lambda v: math.floor(v + 0.5),
    "min": min,
    "max": max,
    "limit": lambda v, low, high: min(max(v, low), high),
}


def _numeric(function: Callable[..., float]) -> Callable[..., float]:
    return lambda *values: number(float(function(*map(number, values))))


def _point(value: object) -> Record:
    if not isinstance(value, Record) or value.kind != "point":
        raise Unknown("programs.val3.point_expected", "a point expected")
    return value


def _moved(point: Record, values: Six) -> Record:
    result = Record("point", dict(point.fields), point.father)
    result.fields["trsf"] = trsf(values)
    return result


def _appro(point: Any, change: Any) -> Record:
    """The point moved by a trsf given in its own axes."""
    return _moved(_point(point), product(six(point.get("trsf")), six(as_kind("trsf", change))))


def _frame(value: object) -> Six:
    """Six components of a frame in the world."""
    if not isinstance(value, Record) or value.kind != "frame":
        raise Unknown("programs.val3.frame_expected", "a frame expected")
    return in_world(value)


def _father(point: Record) -> Six:
    if isinstance(point.father, Missing):
        raise Unknown(point.father.why)
    return (0.0,) * 6 if point.father is None else in_world(point.father)


def _compose(point: Any, frame: Any, change: Any) -> Record:
    """The point moved by a trsf given in the axes of a frame; it stays in its own frame."""
    own, reference = six(_point(point).get("trsf")), _frame(frame)
    change = six(as_kind("trsf", change))
    father = _father(point)
    to_reference = product(inverse(father), reference)
    return _moved(
        point, product(product(product(to_reference, change), inverse(to_reference)), own)
    )


def _position(point: object, frame: object) -> Record:
    return trsf(product(inverse(_frame(frame)), in_world(_point(point))))


def _distance(a: Any, b: Any) -> float:
    if getattr(a, "kind", "") == "point" and getattr(b, "kind", "") == "point":
        return math.dist(in_world(a)[:3], in_world(b)[:3])
    return math.dist(six(as_kind("trsf", a))[:3], six(as_kind("trsf", b))[:3])


def _selected(condition: Any, a: Any, b: Any) -> Any:
    return a if truth(condition) else b


FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: _numeric(function) for name, function in NUMERIC.items()},
    "appro": _appro,
    "compose": _compose,
    "position": _position,
    "distance": _distance,
    "sel": _selected,
}
