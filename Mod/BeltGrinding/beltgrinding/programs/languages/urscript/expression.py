"""Expressions of URScript: numbers, lists, poses p[..]."""

from __future__ import annotations

import functools
import json
import math
import re
from collections.abc import Callable, Sequence
from typing import Any

from ...program import Unknown
from ..core.values import Environment, Evaluated
from ..core import expression as core
from ..core.expression import (
    COMPARED,
    Constant,
    Infix,
    Place,
    Prefix,
    Token,
    number as number,
    truth,
)
from .pose import Pose, a_pose, added, chained, pose_of


def _divided(left: Any, right: Any) -> float:
    if isinstance(left, int) and isinstance(right, int) and right and left % right:
        # rounded or not: versions of the controller differ
        raise Unknown(
            "programs.urscript.remainder", "a quotient of two whole numbers leaves a remainder"
        )
    whole = isinstance(left, int) and isinstance(right, int)
    return int(core.divided(left, right)) if whole else number(core.divided(left, right))


def _remainder(left: Any, right: Any) -> float:
    if not (number(left) >= 0 and number(right) > 0):
        raise Unknown("programs.urscript.operator", "the operator is not understood")
    return number(left % right)


def _alike(left: object, right: object) -> bool:
    if not all(isinstance(v, (bool, int, float, str)) for v in (left, right)):
        raise Unknown("programs.urscript.not_compared", "lists and poses are not compared")
    return left == right


def _length(value: object) -> int:
    if not isinstance(value, list):
        raise Unknown("programs.urscript.no_index", "only lists and poses have an index")
    return len(value)


def _of_numbers(function: Callable[..., float]) -> Callable[..., float]:
    return lambda *values: number(function(*map(number, values)))


NUMERIC: dict[str, Callable[..., float]] = {
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "sqrt": math.sqrt,
    "pow": math.pow,
    "log": lambda base, value: math.log(value, base),
    "d2r": math.radians,
    "r2d": math.degrees,
    "floor": math.floor,
    "ceil": math.ceil,
    "abs": abs,
}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: _of_numbers(function) for name, function in NUMERIC.items()},
    "pose_trans": chained,
    "pose_add": added,
    "pose_inv": lambda pose: a_pose(pose).inverse(),
    "length": _length,
    "get_list_length": _length,
}


def element(value: Any, index: object) -> Any:
    """The element of a list, or the component of a pose. Raises Unknown."""
    if isinstance(value, Pose):
        value = value.components()
    _length(value)
    if type(index) is not int or not 0 <= index < len(value):
        raise Unknown(
            "programs.urscript.no_list_element",
            "the list of {count} has no element [{at}]",
            count=len(value),
            at=index,
        )
    return value[index]


class Parser(core.Parser):
    TOKEN = re.compile(
        r"""\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?(?![\w.]))
            |(?P<string>"[^"]*")
            |(?P<name>[^\W\d]\w*(?:\.[^\W\d]\w*)*)
            |(?P<op>==|!=|<=|>=|[-+*/%<>=()\[\],.]))""",
        re.VERBOSE,
    )
    INFIX = {
        "or": Infix(0, core.either, lazy=True),
        "xor": Infix(0, lambda a, b: truth(a) != truth(b)),
        "and": Infix(1, core.both, lazy=True),
        "==": Infix(3, _alike, once=True),
        "!=": Infix(3, lambda a, b: not _alike(a, b), once=True),
        **{name: Infix(3, function, once=True) for name, function in COMPARED.items()},
        "+": Infix(4, lambda a, b: number(number(a) + number(b))),
        "-": Infix(4, lambda a, b: number(number(a) - number(b))),
        "*": Infix(5, lambda a, b: number(number(a) * number(b))),
        "/": Infix(5, _divided),
        "%": Infix(5, _remainder),
    }
    PREFIX = {
        "not": Prefix(2, lambda v: not truth(v)),
        "-": Prefix(6, lambda v: -number(v)),
        "+": Prefix(6, number),
    }
    NAMING = "="
    LITERALS = json.JSONDecoder()

    @classmethod
    def indexes(cls, before: list[Token]) -> bool:
        kind, text, _ = before[-1] if before else ("", "", 0)
        return kind == "value" or text in (")", "]") or kind == "name" and text != "p"

    def literal(self, kind: str, text: str) -> Any:
        if kind == "number" and text.isdigit():
            return number(int(text[:20]))
        return super().literal(kind, text)

    def word(self, name: str) -> Any:
        if name in ("True", "False"):
            return Constant(name == "True")
        if name == "p" and (self.peek() == "[" or self.kind() == "value"):
            inner = self.operand(*self.next())
            return lambda env: pose_of(inner(env))
        return super().word(name)

    def opened(self, text: str) -> Any:
        if text != "[":
            return super().opened(text)
        parts = self.series("]")
        return lambda env: [part(env) for part in parts]

    def operand(self, kind: str, text: Any) -> Any:
        found = super().operand(kind, text)
        steps = () if isinstance(found, Place) else self.steps()
        return functools.partial(within, found, steps) if steps else found


def within(value: Evaluated, steps: Sequence[Any], env: Environment) -> Any:
    """The element of what an expression gives, by the steps into it. Raises Unknown."""
    found = value(env)
    for step in steps:
        if len(step) != 1 or isinstance(step, str):
            raise Unknown("programs.urscript.expression", "the expression is not understood")
        found = element(found, step[0](env))
    return found


expression = functools.lru_cache(maxsize=4096)(Parser.expression)  # for loops
