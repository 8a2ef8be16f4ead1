"""Expressions of G-code: SINUMERIK's, and those with # and [..] of Fanuc and LinuxCNC.

A block is tokens, too: words as X10 stand beside each other, and behind = or a letter an expression may stand,
which ends where no operator goes on. What the two families of # and [..] compute differently is Unknown.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from typing import Any

from ...program import Unknown
from ..core import expression as core
from ..core.expression import COMPARED, Call, Constant, Infix, Place, Prefix, number, truth

WORD = r"[A-Z]\s*[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?![\d.=(\[]|\s*=)"
NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)(?![\d.])"
SHIFTING = ("AC", "IC", "DC", "ACP", "ACN")


def _alike(left: Any, right: Any) -> bool:
    if isinstance(left, bool) != isinstance(right, bool):
        raise Unknown("programs.number_expected", "a number expected")
    return left == right


def _whole(value: Any) -> int:
    if number(value) != int(value):
        raise Unknown("programs.gcode.whole", "a whole number expected")
    return int(value)


def _natural(value: Any) -> int:
    """A whole number; of negative ones controls make different remainders."""
    if _whole(value) < 0:
        raise Unknown("programs.gcode.negative", "controls differ in what they make of it")
    return int(value)


def _divisor(value: Any) -> int:
    if _natural(value) == 0:
        raise Unknown("programs.division_by_zero", "division by zero")
    return int(value)


def _not_negative(value: Any, function: Callable[[float], float]) -> float:
    """Controls differ in how they round negative numbers, and halves of them."""
    if number(value) < 0.0 and value != int(value):
        raise Unknown("programs.gcode.negative", "controls differ in what they make of it")
    return float(function(value))


def _direction(y: Any, x: Any) -> float:
    return number(math.degrees(math.atan2(number(y), number(x))))


def _of_angle(function: Callable[[float], float]) -> Callable[[Any], float]:
    return lambda value: number(function(math.radians(number(value))))


def _to_angle(function: Callable[[float], float]) -> Callable[[Any], float]:
    return lambda value: number(math.degrees(function(number(value))))


ANGLES = {
    "SIN": _of_angle(math.sin),
    "COS": _of_angle(math.cos),
    "TAN": _of_angle(math.tan),
    "ASIN": _to_angle(math.asin),
    "ACOS": _to_angle(math.acos),
}
COMMON: dict[str, Callable[..., Any]] = {
    **ANGLES,
    "SQRT": lambda v: math.sqrt(number(v)),
    "ABS": lambda v: abs(number(v)),
    "LN": lambda v: math.log(number(v)),
    "EXP": lambda v: number(math.exp(number(v))),
    "ROUND": lambda v: _not_negative(v, lambda w: math.floor(w + 0.5)),
}
SIEMENS: dict[str, Callable[..., Any]] = {
    **COMMON,
    "TRUNC": lambda v: float(math.trunc(number(v))),
    "POT": lambda v: number(number(v) * v),
    "ATAN2": _direction,
    "MINVAL": lambda a, b: min(number(a), number(b)),
    "MAXVAL": lambda a, b: max(number(a), number(b)),
}
BRACKETS: dict[str, Callable[..., Any]] = {
    **COMMON,
    "FIX": lambda v: _not_negative(v, math.floor),
    "FUP": lambda v: _not_negative(v, math.ceil),
}
SUM = {
    "+": Infix(5, lambda a, b: number(number(a) + number(b))),
    "-": Infix(5, lambda a, b: number(number(a) - number(b))),
    "*": Infix(6, lambda a, b: number(number(a) * number(b))),
    "/": Infix(6, core.divided),
    "MOD": Infix(6, lambda a, b: float(_natural(a) % _divisor(b))),
}
SIGNS = {"-": Prefix(8, lambda v: -number(v)), "+": Prefix(8, number)}


class _Words(core.Parser):
    """A parser of what stands in a block; an expression ends where nothing goes on."""

    def literal(self, kind: str, text: str) -> Any:
        return core.finite(float(text), text) if kind == "number" else text

    def word(self, name: str) -> Constant | None:
        return None

    def blank_before(self) -> bool:
        """Whether a blank stands before the next token: E, after a number, may be an exponent."""
        return self.at == 0 or self.tokens[self.at - 1][2] < self.start(self.at)

    def start(self, at: int) -> int:
        _, text, end = self.tokens[at]
        return end - len(text)


class Siemens(_Words):
    TOKEN = re.compile(
        rf"""\s*(?:(?P<number>{NUMBER})|(?P<word>{WORD})|(?P<string>"[^"]*")
            |(?P<name>[A-Z_$][A-Z0-9_]*)|(?P<op>==|<>|<=|>=|<<|[-+*/<>=()\[\],:]))""",
        re.VERBOSE,
    )
    # Comparisons bind most loosely: those of truth values stand in brackets.
    INFIX = {
        "==": Infix(0, _alike, once=True),
        "<>": Infix(0, lambda a, b: not _alike(a, b), once=True),
        **{name: Infix(0, function, once=True) for name, function in COMPARED.items()},
        "OR": Infix(1, core.either, lazy=True),
        "XOR": Infix(2, lambda a, b: truth(a) != truth(b)),
        "AND": Infix(3, core.both, lazy=True),
        **SUM,
        "DIV": Infix(6, lambda a, b: float(_natural(a) // _divisor(b))),
    }
    PREFIX = {"NOT": Prefix(8, lambda v: not truth(v)), **SIGNS}
    FUNCTIONS = SIEMENS

    def operand(self, kind: str, text: str) -> Any:
        if kind == "word":  # R1, or a variable's name
            if not re.fullmatch(r"[A-Z]\d+", text):
                raise Unknown(
                    "programs.value_expected", "a value expected, not '{text}'", text=text
                )
            return Place(text, self.steps())
        return super().operand(kind, text)

    def word(self, name: str) -> Constant | None:
        if name in ("TRUE", "FALSE", "PI"):
            return Constant({"TRUE": True, "FALSE": False, "PI": math.pi}[name])
        return None


class Brackets(_Words):
    TOKEN = re.compile(
        rf"""\s*(?:(?P<number>{NUMBER})|(?P<word>{WORD})|(?P<named>\#\s*<[^<>]*>)
            |(?P<name>[A-Z]+)|(?P<op>\*\*|[-+*/=\[\]\#,]))""",
        re.VERBOSE,
    )
    INFIX = {
        **{
            name: Infix(1, lambda a, b, f=f: f(truth(a), truth(b)))
            for name, f in {
                "AND": lambda a, b: a and b,
                "OR": lambda a, b: a or b,
                "XOR": lambda a, b: a != b,
            }.items()
        },
        "EQ": Infix(3, _alike, once=True),
        "NE": Infix(3, lambda a, b: not _alike(a, b), once=True),
        "LT": Infix(3, COMPARED["<"], once=True),
        "GT": Infix(3, COMPARED[">"], once=True),
        "LE": Infix(3, COMPARED["<="], once=True),
        "GE": Infix(3, COMPARED[">="], once=True),
        **SUM,
        "**": Infix(7, lambda a, b: number(math.pow(number(a), number(b)))),
    }
    PREFIX = SIGNS
    FUNCTIONS = BRACKETS

    def steps(self) -> tuple[Any, ...]:
        return ()

    def operand(self, kind: str, text: str) -> Any:
        if kind == "named":
            return Place("#<" + re.sub(r"\s", "", text[1:])[1:-1] + ">")
        if kind == "op" and text == "#":
            self.depth += 1
            if self.depth > core.DEEPEST:
                raise Unknown("programs.nested_expression", "the expression is nested too deeply")
            inner = self.operand(*self.next())
            self.depth -= 1
            return Place("#", ((inner,),))
        if kind == "op" and text == "[":
            inner = self.infix()
            self.expect("]")
            return inner
        if kind == "name" and self.accept("["):
            inner = [self.infix()]
            self.expect("]")
            if text == "ATAN" and self.accept("/"):
                self.expect("[")
                inner.append(self.infix())
                self.expect("]")
            return Call(text, inner, {})
        if kind != "number":
            raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)
        return Constant(self.literal(kind, text))


class Shifted:
    """The value of AC(..), IC(..), DC(..): absolute or incremental whatever G90 and G91 say."""

    def __init__(self, name: str, expression: Callable[[Any], Any]) -> None:
        self.absolute, self.expression = name != "IC", expression


Word = tuple[str, Any]  # an address, and a number, a Shifted or None
# (address or Place, whether by =, a number, an expression, a Shifted or None)
Assigned = tuple[Any, bool, Any]


@functools.lru_cache(maxsize=4096)  # for loops
def expression_of(parser: type[_Words], text: str) -> Callable[[Any], Any]:
    """The function of an environment that a text is. Raises Unknown."""
    return parser.expression(text)


@functools.lru_cache(maxsize=4096)
def siemens_words(body: str) -> tuple[Assigned, ...]:
    """((address, whether by =, a number, an expression or Shifted), ...) of a block. Raises Unknown."""
    parser = Siemens(body)
    found: list[Assigned] = []
    while parser.at < len(parser.tokens):
        blank = parser.blank_before()
        kind, text = parser.next()
        if kind == "word":
            if text[0] == "E" and not blank:
                raise _exponent()
            found.append((text[0], False, float(text[1:])))
            continue
        if kind != "name":
            raise _unread(text)
        steps = parser.steps()
        if not parser.accept("="):
            if steps:
                raise _unread(text)
            found.append((text, False, None))
            continue
        value = parser.infix()
        if isinstance(value, Call) and value.name in SHIFTING:
            if len(value.arguments) != 1:
                raise _unread(value.name)
            value = Shifted(value.name, value.arguments[0])
        address = Place(text, steps) if steps else text
        found.append((address, True, value.value if isinstance(value, Constant) else value))
    return tuple(found)


@functools.lru_cache(maxsize=4096)
def bracket_words(body: str) -> tuple[Assigned, ...]:
    """As ``siemens_words``, of the family with # and [..]: X#1, X-[#2+1]."""
    parser = Brackets(body)
    found: list[Assigned] = []
    while parser.at < len(parser.tokens):
        blank = parser.blank_before()
        kind, text = parser.next()
        if kind == "word":
            if text[0] == "E" and not blank:
                raise _exponent()
            found.append((text[0], False, float(text[1:])))
            continue
        if kind != "name" or len(text) != 1:
            raise _unread(text)
        by = parser.accept("=")
        value = parser.prefix(8)  # one value, with its sign: arithmetic is in brackets
        found.append((text, by, value.value if isinstance(value, Constant) else value))
    return tuple(found)


def _unread(text: object) -> Unknown:
    return Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=str(text)[:30])


def _exponent() -> Unknown:
    return Unknown("programs.gcode.e_word", "E after a number: an exponent or a word of its own")
