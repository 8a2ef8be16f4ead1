"""Expressions of KUKA KRL over what is known. Of their environment, the interpreter, ``zeroed`` becomes true where
components of a frame are taken as 0."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Sequence
from typing import Any

from ....base.kinds import Floats
from ....base.frames import from_abc, to_abc
from ...program import Unknown
from ..core.values import Environment, Evaluated
from ..core import expression as core
from ..core.expression import Arguments, Constant, Infix, Prefix
from .numbers import compared, integer, literal, number, of_both, quotient, truth, whole
from .types import TARGET
from .values import MAX_COMPONENTS, Lost, Members

FRAME = ("x", "y", "z", "a", "b", "c")
MAX_LENGTH = 1e12  # mm; products of frames stay finite


def _of_numbers(function: Callable[..., float]) -> Callable[..., float]:
    return lambda *values: float(function(*map(number, values)))


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": _of_numbers(lambda v: math.sin(math.radians(v))),
    "cos": _of_numbers(lambda v: math.cos(math.radians(v))),
    "tan": _of_numbers(lambda v: math.tan(math.radians(v))),
    "acos": _of_numbers(lambda v: math.degrees(math.acos(v))),
    "asin": _of_numbers(lambda v: math.degrees(math.asin(v))),
    "atan2": _of_numbers(lambda y, x: math.degrees(math.atan2(y, x))),
    "sqrt": _of_numbers(math.sqrt),
    "abs": lambda v: of_both(number(v), v, abs(v)),
}


def frame_of(value: Any) -> Floats:
    """4 x 4 of an aggregate with all six components."""
    missing = [name for name in FRAME if name not in value]
    if missing:
        raise lacking(value, missing)
    x, y, z, a, b, c = (number(value[k]) for k in FRAME)
    if max(abs(x), abs(y), abs(z)) > MAX_LENGTH:
        raise Unknown("programs.krl.frame_out_of_bounds", "the frame is out of all bounds")
    return from_abc((x, y, z), (a, b, c))


def check_target(value: Any) -> None:
    """Raises Unknown of an aggregate with a component that no target has."""
    strange = [name for name in value if name not in TARGET]
    if strange:
        raise Unknown(
            "programs.krl.no_target_component",
            "{name} is no component of a target",
            name=str(strange[0]).upper()[:40],
        )


def lacking(value: Any, missing: Sequence[str]) -> Unknown:
    """The Unknown of an aggregate that does not tell some components."""
    if isinstance(getattr(value, "rest", None), Lost):
        return Unknown(value.rest.told)
    return Unknown(
        "programs.krl.frame_incomplete",
        "the frame has no {names}",
        names=", ".join(missing).upper(),
    )


def components_of(frame: Floats) -> Members:
    """Aggregate of a 4 x 4."""
    return Members(zip(FRAME, [*map(float, frame[:3, 3]), *to_abc(frame)]))


def _whole_frame(value: Any, env: Environment) -> Any:
    """A frame whose components that an aggregate does not name are 0."""
    check_target(value)
    named = [name for name in FRAME if name in value]
    if len(named) == len(FRAME) or not named or value.rest is not None:
        return value
    env.zeroed = True
    return Members({**dict.fromkeys(FRAME, 0.0), **value})


def _within(left: Any, right: Any, env: Environment) -> Members:
    """The geometric operator: a frame followed by a frame in it."""
    left, right = left(env), right(env)
    if not isinstance(left, dict) or not isinstance(right, dict):
        raise Unknown("programs.krl.two_frames", "the operator ':' needs two frames")
    return components_of(frame_of(_whole_frame(left, env)) @ frame_of(_whole_frame(right, env)))


def _comparing(operator: str) -> Infix:
    return Infix(0, lambda a, b: compared(operator, a, b), once=True)


def _bits(rank: int, function: Callable[[int, int], int]) -> Infix:
    return Infix(rank, lambda a, b: whole(function(integer(a), integer(b))))


class Parser(core.Parser):
    TOKEN = re.compile(
        r"""\s*(?:(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))
            |(?P<string>"[^"]*")
            |(?P<bits>'(?:[hH][0-9a-fA-F]{1,8}|[bB][01]{1,32})')
            |(?P<enum>\#\w+)
            |(?P<name>\$?[A-Za-z_][\w$]*)
            |(?P<op><=|>=|<>|==|[-+*/:(){}\[\],=<>'.]))""",
        re.VERBOSE,
    )
    # KUKA's ranks: the last binds closest.
    INFIX = {
        **{operator: _comparing(operator) for operator in ("==", "<>", "<", ">", "<=", ">=")},
        "or": Infix(1, lambda a, b: truth(a) | truth(b)),
        "b_or": _bits(1, lambda a, b: a | b),
        "exor": Infix(2, lambda a, b: truth(a) != truth(b)),
        "b_exor": _bits(2, lambda a, b: a ^ b),
        "and": Infix(3, lambda a, b: truth(a) & truth(b)),
        "b_and": _bits(3, lambda a, b: a & b),
        "+": Infix(4, lambda a, b: of_both(number(a), number(b), a + b)),
        "-": Infix(4, lambda a, b: of_both(number(a), number(b), a - b)),
        "*": Infix(5, lambda a, b: of_both(number(a), number(b), a * b)),
        "/": Infix(5, lambda a, b: quotient(number(a), number(b))),
        ":": Infix(6, _within, lazy=True),
    }
    PREFIX = {
        "-": Prefix(7, lambda v: of_both(number(v), v, -v)),
        "+": Prefix(7, number),
        "not": Prefix(7, lambda v: not truth(v)),
        "b_not": Prefix(7, lambda v: ~integer(v)),
    }
    fold = staticmethod(str.lower)

    def literal(self, kind: str, text: str) -> Any:
        if kind == "number":
            return literal(text)
        if kind == "bits":
            return whole(int(text[2:-1], 16 if text[1] in "hH" else 2))
        return text if kind == "string" else text.lower()

    def arguments(self, end: str | None) -> Arguments:
        """What is passed; None where nothing stands."""
        passed: list[Any] = []
        while not (self.accept(end) if end else self.at >= len(self.tokens)):
            if passed:
                self.expect(",")
            passed.append(None if self.peek() in (",", end) else self.infix())
        return passed, {}

    def opened(self, text: str) -> Any:
        """{[TYPE:] name value, ...}; names in lower case."""
        if text != "{":
            return super().opened(text)
        found: dict[str, Any] = {}
        if self.at + 1 < len(self.tokens) and self.tokens[self.at + 1][1] == ":":
            self.at += 2
        while not self.accept("}"):
            if found:
                self.expect(",")
            kind, name = self.next()
            if kind != "name":
                raise Unknown(
                    "programs.krl.component_expected",
                    "a component's name expected, not '{name}'",
                    name=name,
                )
            if self.peek() == "[":
                self.at += 1
                self.series("]")
            name = name.lower()
            if name in found:
                raise Unknown(
                    "programs.krl.component_twice",
                    "the component {name} occurs twice",
                    name=name.upper(),
                )
            found[name] = self.component()
            if len(found) > MAX_COMPONENTS:
                raise Unknown(
                    "programs.krl.components",
                    "the aggregate has more than {limit} components",
                    limit=MAX_COMPONENTS,
                )
        parts = list(found.items())
        if all(type(part) is Constant for part in found.values()):
            pairs = [(name, part.value) for name, part in parts]
            return lambda env: Members(pairs)
        return lambda env: Members([(name, part(env)) for name, part in parts])

    def component(self) -> Any:
        """An expression; most are a mere number, which needs no look for operators."""
        tokens, at = self.tokens, self.at
        if at + 2 < len(tokens):
            negative = tokens[at][1] == "-"
            at += negative
            if tokens[at][0] == "number" and tokens[at + 1][1] in (",", "}"):
                self.at = at + 1
                value = literal(tokens[at][1])
                return Constant(-value if negative else value)
        return self.infix()


KEPT = 1000  # characters of a statement whose expression is kept, for loops
_kept = functools.lru_cache(maxsize=256)(Parser.expression)
place = functools.lru_cache(maxsize=256)(Parser.place)


def expression(text: str) -> Evaluated:
    """The function of an environment that a text is, not to be changed. Raises Unknown."""
    return _kept(text) if len(text) <= KEPT else Parser.expression(text)


def unknown_function(text: str) -> Unknown:
    return Unknown(
        "programs.function_of_controller",
        "the function {name} is known to the controller only",
        name=text,
    )
