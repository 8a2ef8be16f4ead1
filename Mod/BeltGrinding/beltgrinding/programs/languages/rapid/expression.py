"""Expressions of ABB RAPID. Their environment, the interpreter, also gives variable(name) -> (value, type) and
component(type, name) -> (index, type)."""

from __future__ import annotations

import functools
import json
import math
import re
from typing import Any

from ...program import Unknown
from ..core.values import Environment, Evaluated
from ..core import expression as core
from ..core.expression import COMPARED, Arguments, Constant, Infix, Place, Prefix, truth
from .data import A_POS, AN_ORIENT, MAX_RECORD, bounded_size, cross, number, numbers, turn

BASES = {"x": 16, "b": 2, "o": 8}


def _alike(left: Any, right: Any) -> bool:
    if bounded_size(left, MAX_RECORD) > MAX_RECORD:
        raise Unknown("programs.rapid.arrays_not_compared", "arrays are not compared")
    return left == right


def _sum(left: Any, right: Any, sign: float = 1.0) -> Any:
    if isinstance(left, str) and isinstance(right, str) and sign > 0:
        if len(left) + len(right) > 10_000:
            raise Unknown("programs.string_too_long", "the string is too long")
        return left + right
    if isinstance(left, list):
        return [a + sign * b for a, b in zip(numbers(left, 3, A_POS), numbers(right, 3, A_POS))]
    return number(left) + sign * number(right)


def times(a: Any, b: Any) -> Any:
    """The operator *: numbers, a number and a pos, two pos (vector product), two orient."""
    if isinstance(a, list) and isinstance(b, list):
        if len(a) == len(b) == 4:
            return turn(numbers(a, 4, AN_ORIENT), numbers(b, 4, AN_ORIENT))
        return cross(numbers(a, 3, A_POS), numbers(b, 3, A_POS))
    if isinstance(a, list) or isinstance(b, list):
        vector, factor = (a, b) if isinstance(a, list) else (b, a)
        return [v * number(factor) for v in numbers(vector, 3, A_POS)]
    return number(a) * number(b)


def _divided(value: Any, divisor: object) -> Any:
    if isinstance(value, list):
        return [core.divided(v, divisor) for v in numbers(value, 3, A_POS)]
    return core.divided(value, divisor)


def _whole(value: object, divisor: object) -> float:
    return float(math.trunc(core.divided(value, divisor)))


class Handed:
    """An optional argument that is given if one of the routine's own is: \\Name?Own."""

    def __init__(self, place: Place) -> None:
        self.place = place

    def __call__(self, env: Environment) -> Any:
        return self.place(env)


class Parser(core.Parser):
    TOKEN = re.compile(
        r"""\s*(?:(?P<number>(?:0[xX][0-9a-fA-F]+|0[bB][01]+|0[oO][0-7]+
                |(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(?![\w.]))
            |(?P<string>"(?:[^"\n]|"")*")
            |(?P<name>[^\W\d]\w*)
            |(?P<op>:=|<=|>=|<>|[-+*/:(){}\[\],.=<>\\?]))""",
        re.VERBOSE,
    )
    INFIX = {
        "or": Infix(0, lambda a, b: truth(a) | truth(b)),
        "xor": Infix(0, lambda a, b: truth(a) != truth(b)),
        "and": Infix(1, lambda a, b: truth(a) & truth(b)),
        "=": Infix(2, _alike, once=True),
        "<>": Infix(2, lambda a, b: not _alike(a, b), once=True),
        **{name: Infix(2, function, once=True) for name, function in COMPARED.items()},
        "+": Infix(3, _sum),
        "-": Infix(3, lambda a, b: _sum(a, b, -1.0)),
        "*": Infix(4, times),
        "/": Infix(4, _divided),
        "div": Infix(4, _whole),
        "mod": Infix(4, lambda a, b: number(a) - _whole(a, b) * b),
    }
    PREFIX = {
        "not": Prefix(1, lambda v: not truth(v)),
        "-": Prefix(5, lambda v: times(-1.0, v)),
        "+": Prefix(5, number),
    }
    INDEX = "{}"
    LITERALS = json.JSONDecoder(parse_int=float)
    fold = staticmethod(str.lower)

    def literal(self, kind: str, text: str) -> Any:
        if kind == "string":
            return text[1:-1].replace('""', '"')
        if kind == "number" and text[0] == "0" and text[1:2].lower() in BASES:
            try:
                return float(int(text[2:], BASES[text[1].lower()]))
            except OverflowError:
                return core.finite(math.inf, text)
        return super().literal(kind, text)

    def opened(self, text: str) -> Any:
        if text != "[":
            return super().opened(text)
        parts = [self.infix()]
        while not self.accept("]"):
            self.expect(",")
            parts.append(self.infix())
        return lambda env: [part(env) for part in parts]

    def arguments(self, end: str | None) -> Arguments:
        positional: list[Any] = []
        named: dict[str, Any] = {}
        tokens, count = self.tokens, len(self.tokens)
        kind: Any
        text: Any
        while not (self.accept(end) if end else self.at >= count):
            kind, text, _ = tokens[self.at] if self.at < count else ("", None, 0)
            following = tokens[self.at + 1][1] if self.at + 1 < count else None
            if kind == "op" and text == "\\":
                self.at += 1
                name, value = self.optional()
                named[name] = value
            elif kind == "value" and following in (",", "\\"):
                self.at += 1
                positional.append(Constant(text))
            elif kind == "name" and following in (",", "\\") and self.word(text.lower()) is None:
                self.at += 1  # most are one token, which needs no look for operators
                positional.append(Place(text))
            else:
                positional.append(self.infix())
            text = tokens[self.at][1] if self.at < count else None
            if text == ",":
                self.at += 1
                if self.peek() in (end, ","):
                    raise Unknown("programs.argument_missing", "an argument is missing")
            elif text not in (end, "\\"):
                self.expect(",")
        return positional, named

    def optional(self) -> tuple[str, Any]:
        """(name in lower case, expression or None) of an optional argument behind its stroke."""
        kind, name = self.next() if self.peek() is not None else ("", "")
        if kind != "name":
            raise Unknown(
                "programs.rapid.no_optional_name", "the name of an optional argument is missing"
            )
        if self.accept(":="):
            if self.peek() in (None, ",", ")", "\\"):
                raise Unknown(
                    "programs.rapid.no_optional_value",
                    "the value of \\{name} is missing",
                    name=name,
                )
            return name.lower(), self.infix()
        if self.accept("?"):
            return name.lower(), Handed(self.path())
        if self.peek() not in (None, ",", ")", "\\"):
            raise Unknown(
                "programs.rapid.assignment_expected", "':=' expected after \\{name}", name=name
            )
        return name.lower(), None


expression = functools.lru_cache(maxsize=4096)(Parser.expression)
place = functools.lru_cache(maxsize=4096)(Parser.place)


@functools.lru_cache(maxsize=4096)
def arguments(text: str) -> Arguments:
    """(expressions, optional ones by name in lower case) of an instruction's text without its first word."""
    parser = Parser(text)
    parser.at = 1
    return parser.arguments(None)


@functools.lru_cache(maxsize=4096)
def passed(text: str) -> Arguments:
    """As ``arguments``, of a call, which may have brackets: not RAPID, yet found in programs."""
    parser = Parser(text)
    bracketed = (
        len(parser.tokens) > 2 and parser.tokens[1][1] == "(" and parser.tokens[-1][1] == ")"
    )
    parser.at = 1 + bracketed
    return parser.arguments(")" if bracketed else None)


@functools.lru_cache(maxsize=4096)
def first(text: str) -> tuple[Evaluated, str]:
    """(expression behind a statement's first word, what follows it)."""
    parser = Parser(text)
    parser.at = 1
    found = parser.infix()
    return found, text[parser.tokens[parser.at - 1][2] :].strip()


def name_of(argument: object) -> str:
    """The name that an argument is and no more, as it is written; "" where it is not."""
    return argument.name if isinstance(argument, Place) and not argument.steps else ""


def one_word(argument: object) -> bool:
    """Whether an argument is one token, whose type the place where it stands tells."""
    return isinstance(argument, Constant) or bool(name_of(argument))
