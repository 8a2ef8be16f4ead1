"""Expressions of VAL3.

The environment gives, beside what core.expression asks for, array(name) -> Array.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from typing import Any

from ...program import Unknown
from ..core.values import Environment
from ..core import expression as core
from ..core.expression import COMPARED, Infix, Place, Prefix, truth
from .data import WORDS, Missing, Record, as_kind, inverse, number, product, six, trsf
from .functions import FUNCTIONS

MAX_TEXT = 10_000


def _equal(left: Any, right: Any) -> bool:
    if type(left) is not type(right) or isinstance(left, (list, Record)):
        raise Unknown("programs.val3.not_compared", "these values are not compared")
    return left == right


def _sum(a: Any, b: Any) -> Any:
    if not (isinstance(a, str) and isinstance(b, str)):
        return number(number(a) + number(b))
    if len(a) + len(b) > MAX_TEXT:
        raise Unknown("programs.string_too_long", "the string is too long")
    return a + b


def _joined(a: Any, b: Any) -> Any:
    if not (isinstance(a, str) and isinstance(b, str)):
        raise Unknown("programs.val3.join", "'&' joins strings")
    return _sum(a, b)


def _times(a: Any, b: Any) -> Any:
    if isinstance(a, Record) or isinstance(b, Record):
        return trsf(product(six(as_kind("trsf", a)), six(as_kind("trsf", b))))
    return number(number(a) * number(b))


def _inverted(value: Any) -> Any:
    return not value if isinstance(value, bool) else trsf(inverse(six(as_kind("trsf", value))))


class Size:
    """size(array), which is no array's item."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __call__(self, env: Environment) -> float:
        items = env.array(self.name).items
        if isinstance(items, Missing):
            raise Unknown(items.why)
        return float(len(items))


class Parser(core.Parser):
    TOKEN = re.compile(
        r"""\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?(?![\w.]))
            |(?P<string>"[^"\n]*")
            |(?P<name>[^\W\d]\w*(?::\w+)?)
            |(?P<op>==|!=|<>|<=|>=|&&|\|\||[-+*/%&!(){}\[\],.<>]))""",
        re.VERBOSE,
    )
    INFIX = {
        **dict.fromkeys(("or", "||"), Infix(0, core.either, lazy=True)),
        "xor": Infix(0, lambda a, b: truth(a) != truth(b)),
        **dict.fromkeys(("and", "&&"), Infix(1, core.both, lazy=True)),
        "==": Infix(3, _equal, once=True),
        **dict.fromkeys(("!=", "<>"), Infix(3, lambda a, b: not _equal(a, b), once=True)),
        **{name: Infix(3, function, once=True) for name, function in COMPARED.items()},
        "+": Infix(4, _sum),
        "-": Infix(4, lambda a, b: number(number(a) - number(b))),
        "&": Infix(4, _joined),
        "*": Infix(5, _times),
        "/": Infix(5, lambda a, b: number(core.divided(a, b))),
        "%": Infix(5, lambda a, b: math.fmod(a, b) if core.divided(a, b) is not None else 0.0),
    }
    PREFIX = {
        "not": Prefix(2, lambda v: not truth(v)),
        "-": Prefix(6, lambda v: -number(v)),
        "+": Prefix(6, number),
        "!": Prefix(6, _inverted),
    }

    def opened(self, text: str) -> Any:
        if text != "{":
            return super().opened(text)
        parts = self.series("}")
        return lambda env: [part(env) for part in parts]

    def operand(self, kind: str, text: Any) -> Any:
        found = super().operand(kind, text)
        one = found.arguments if isinstance(found, core.Call) and text == "size" else []
        return Size(one[0].name) if len(one) == 1 and plain(one[0]) else found

    def steps(self) -> tuple[Any, ...]:
        found = super().steps()
        if any(isinstance(a, tuple) and isinstance(b, tuple) for a, b in zip(found, found[1:])):
            raise Unknown("programs.val3.index_twice", "two indices in a row are not understood")
        return found


def plain(argument: object) -> bool:
    """Whether an argument is a mere name."""
    return isinstance(argument, Place) and not argument.steps


expression = functools.lru_cache(maxsize=4096)(Parser.expression)  # for loops
place = functools.lru_cache(maxsize=4096)(Parser.place)


def split(text: str) -> list[str]:
    """The arguments in the text of an argument list. Raises Unknown where brackets do not match."""
    if not text.strip():
        return []
    parts: list[str] = []
    depth, start, quoted = 0, 0, False
    for at, c in enumerate(text):
        if c == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
            if depth < 0:
                break
        elif c == "," and depth == 0:
            parts.append(text[start:at].strip())
            start = at + 1
    if depth or quoted:
        raise Unknown("programs.brackets", "the brackets do not match")
    parts.append(text[start:].strip())
    if not all(parts):
        raise Unknown("programs.argument_missing", "an argument is missing")
    return parts


def key_of(step: Sequence[Any], env: Environment) -> Any:
    """The key of an index."""
    if len(step) != 1:
        raise Unknown("programs.val3.dimensions", "arrays of several dimensions are not supported")
    return step[0](env)


def path_of(found: Place, env: Environment) -> list[list[Any]]:
    """[(name, key)] of the data and the fields that a Place names; a key None: none is written."""
    path: list[list[Any]] = [[found.name, None]]
    for step in found.steps:
        if isinstance(step, str):
            path.append([step, None])
        else:
            path[-1][1] = key_of(step, env)
    return path


def read(found: Place, env: Environment) -> Any:
    """The value of a Place."""
    (name, key), *fields = path_of(found, env)
    try:
        array = env.array(name)
    except Unknown:
        if name in WORDS and not found.steps:
            return name
        raise
    value = env.item(array, 0.0 if key is None else key, name)
    for field, key in fields:
        value = env.part(value, field, key, name)
    if isinstance(value, Missing):
        raise Unknown(value.why)
    return value


def function(call: core.Call, env: Environment) -> Any:
    """The value of a function that needs no controller; None: there is none of its name."""
    if call.name not in FUNCTIONS:
        return None
    return core.applied(FUNCTIONS, call.name, *call.values(env), call.name)
