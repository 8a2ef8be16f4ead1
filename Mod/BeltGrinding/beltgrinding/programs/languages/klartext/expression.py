"""Q parameters and formulas of Klartext."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from typing import Any

from ...program import Unknown
from ..core import expression as core
from ..core.expression import COMPARED, Constant, Infix, Place, Prefix, number

NOT_KNOWN = ("programs.klartext.parameter", "{name} is known to the control only")


def _power(left: Any, right: Any) -> float:
    if number(left) < 0.0:  # whether the sign is raised, too, the manual does not say
        raise Unknown("programs.gcode.negative", "controls differ in what they make of it")
    return number(math.pow(left, number(right)))


def _of(function: Callable[[float], float]) -> Callable[[Any], float]:
    def value(argument: Any) -> float:
        try:
            return number(float(function(number(argument))))
        except (ValueError, OverflowError):
            raise Unknown(
                "programs.not_computable",
                "{text} cannot be evaluated for these arguments",
                text=f"{argument:g}",
            ) from None

    return value


FUNCTIONS: dict[str, Callable[[float], float]] = {
    "SIN": lambda v: math.sin(math.radians(v)),
    "COS": lambda v: math.cos(math.radians(v)),
    "TAN": lambda v: math.tan(math.radians(v)),
    "ASIN": lambda v: math.degrees(math.asin(v)),
    "ACOS": lambda v: math.degrees(math.acos(v)),
    "ATAN": lambda v: math.degrees(math.atan(v)),
    "SQ": lambda v: v * v,
    "SQRT": math.sqrt,
    "LN": math.log,
    "LOG": math.log10,
    "EXP": math.exp,
    "NEG": lambda v: -v,
    "INT": math.trunc,
    "ABS": abs,
    "FRAC": lambda v: v - math.trunc(v),
}


class Parser(core.Parser):
    TOKEN = re.compile(
        r"\s*(?:(?P<number>(?:\d+(?:[.,]\d*)?|[.,]\d+)(?![\w.,]))|(?P<name>[A-Z]+\d*)|(?P<op>[-+*/^()]))"
    )
    INFIX = {
        "+": Infix(5, lambda a, b: number(number(a) + number(b))),
        "-": Infix(5, lambda a, b: number(number(a) - number(b))),
        "*": Infix(6, lambda a, b: number(number(a) * number(b))),
        "/": Infix(6, core.divided),
        "^": Infix(7, _power),
    }
    PREFIX = {
        "-": Prefix(8, lambda v: -number(v)),
        "+": Prefix(8, number),
        **{name: Prefix(8, _of(function)) for name, function in FUNCTIONS.items()},
    }

    def literal(self, kind: str, text: str) -> float:
        return core.finite(float(text.replace(",", ".")), text)

    def word(self, name: str) -> Constant | None:
        return Constant(math.pi) if name == "PI" else None

    def steps(self) -> tuple[Any, ...]:
        return ()

    def operand(self, kind: str, text: str) -> Any:
        if kind == "name" and text != "PI" and not re.fullmatch(r"Q[LR]?\d+", text):
            raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)
        return super().operand(kind, text)


expression = functools.lru_cache(maxsize=4096)(Parser.expression)  # for loops
# FN n: a function of two values, by what stands between them, or of one.
FN: dict[str, tuple[str, Callable[..., float]]] = {
    "1": ("+", lambda a, b: a + b),
    "2": ("-", lambda a, b: a - b),
    "3": ("*", lambda a, b: a * b),
    "4": ("DIV", core.divided),
    "8": ("LEN", math.hypot),
}
FN_ONE = {"5": ("SQRT", "SQRT"), "6": ("SIN", "SIN"), "7": ("COS", "COS")}
FN_IF = {
    "EQU": lambda a, b: a == b,
    "NEQU": lambda a, b: a != b,
    "NE": lambda a, b: a != b,
    "GT": COMPARED[">"],
    "LT": COMPARED["<"],
}


class Parameters:
    """Values of Q parameters: those that the program assigns."""

    def __init__(self) -> None:
        self.all: dict[str, float] = {}

    def read(self, place: Place) -> float:
        if place.name not in self.all:
            raise Unknown(*NOT_KNOWN, name=place.name)
        return self.all[place.name]

    def function(self, call: core.Call) -> float:
        raise Unknown(*NOT_KNOWN, name=call.name)

    def value(self, text: str) -> float:
        """The number that a text is: a number, a parameter or a formula. Raises Unknown."""
        try:
            return float(text)
        except ValueError:
            pass
        if not text.isascii():
            raise Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=text[:30])
        return float(number(expression(text.strip())(self)))

    def assign(self, statement: str) -> bool:
        """Follows "Q1 = ..." or "FN n: Q1 = ..."; what cannot be known is unknown, and whoever uses it says so."""
        match = re.match(r"(?:FN\s*(\d+)\s*:)?\s*(Q[LR]?\d+)\s*=\s*(.*)$", statement)
        if not match:
            for name in re.findall(r"(Q[LRS]?\d+)\s*=", statement):
                self.all.pop(name, None)
            return False
        function, name, text = match.groups()
        self.all.pop(name, None) if function else None
        try:
            self.all[name] = self._of(function, text)
        except Unknown:
            self.all.pop(name, None)
        return True

    def _of(self, function: str | None, text: str) -> float:
        if function in (None, "0"):
            return self.value(text)
        if function in FN_ONE:
            word, name = FN_ONE[function]
            if not text.startswith(word):
                raise Unknown(*NOT_KNOWN, name=text)
            return Parser.PREFIX[name].function(self.value(text[len(word) :]))
        between, joined = FN.get(function or "", ("", None))
        parts = text.split(f" {between} ") if between else []
        if len(parts) != 2 or joined is None:
            raise Unknown(*NOT_KNOWN, name=text)
        return float(number(joined(*map(self.value, parts))))
