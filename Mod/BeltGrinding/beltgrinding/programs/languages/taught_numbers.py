"""Numbers of taught programs: the registers of Fanuc TP, the variables of Yaskawa INFORM."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

from ..program import Reason, Unknown
from .core import expression as core
from .core.expression import Infix, Prefix, divided, number, truth
from .core.memory import Memory

LARGEST = 1e12
Expression = Callable[[Any], Any]


def joined(decisive: bool) -> Callable[[Expression, Expression, Any], bool]:
    """AND (``decisive`` False) or OR (True) of two conditions: of one that is not known the other may decide."""

    def function(left: Expression, right: Expression, env: Any) -> bool:
        why = None
        for one in (left, right):
            try:
                if truth(one(env)) == decisive:
                    return decisive
            except Unknown as unknown:
                why = why or unknown
        if why is not None:
            raise why
        return not decisive

    return function


def _compared(function: Callable[[float, float], bool]) -> Infix:
    return Infix(1, lambda a, b: function(number(a), number(b)), once=True)


class Parser(core.Parser):
    """AND and OR are not joined with each other: which goes first differs between controllers."""

    INFIX = {
        "AND": Infix(0, joined(False), lazy=True),
        "OR": Infix(0, joined(True), lazy=True),
        "=": _compared(operator.eq),
        "<>": _compared(operator.ne),
        "<": _compared(operator.lt),
        ">": _compared(operator.gt),
        "<=": _compared(operator.le),
        ">=": _compared(operator.ge),
        "+": Infix(2, lambda a, b: number(a) + number(b)),
        "-": Infix(2, lambda a, b: number(a) - number(b)),
        "*": Infix(3, lambda a, b: number(a) * number(b)),
        "/": Infix(3, divided),
        "DIV": Infix(3, lambda a, b: float(math.trunc(divided(a, b)))),
        "MOD": Infix(3, lambda a, b: math.fmod(number(a), number(b) or divided(a, b))),
    }
    PREFIX = {
        "-": Prefix(4, lambda v: -number(v)),
        "+": Prefix(4, number),
        "!": Prefix(4, lambda v: not truth(v)),
    }

    def infix(self, rank: int = 0) -> Expression:
        begin = self.at
        found = super().infix(rank)
        if rank == 0:
            depth, words = 0, set()
            for _, text, _ in self.tokens[begin : self.at]:
                depth += (text in ("(", "[")) - (text in (")", "]"))
                if depth == 0 and text in ("AND", "OR"):
                    words.add(text)
            if len(words) > 1:
                raise Unknown(
                    "programs.not_understood", "'{text}' is not understood", text="AND OR"
                )
        return found

    def word(self, name: str) -> None:
        return None


class Numbers(Memory):
    """Values by name; what the program does not set a person is asked for.

    A language says ``named(place)``, the name of what a Place means (raises Unknown), and ``absent(name)``, the
    Reason why it has no value.
    """

    named: Callable[..., str]
    absent: Callable[..., Reason]
    tick: Callable[..., None]
    line: int
    SHAPE = ""  # what a person is asked for
    causes: dict[str, Reason]  # of names that are set to what is not known
    used: set[str]  # names that a person's value was taken for
    arguments: list[float | Reason]  # of the program that is called

    def value(self, text: str) -> Any:
        """The number or the truth value of an expression. Raises Unknown."""
        value = super().value(text.strip())
        if not isinstance(value, bool) and not abs(number(value)) < LARGEST:
            raise Unknown("programs.fanuc.out_of_range", "'{text}' is out of range", text=text[:30])
        return value

    def number(self, text: str) -> float:
        """The number that an expression is. Raises Unknown."""
        return float(number(self.value(text)))

    def read(self, place: Any) -> Any:
        return self.known(self.named(place))

    def known(self, name: str) -> float:
        """The value of a name. Raises Unknown."""
        value = self.cells(name).get(())
        if value is not None:
            return value
        reason, cause = self.absent(name), self.causes.get(name)
        if cause is not None and cause.wants is not None and cause.wants[0] != name:
            raise Unknown(cause)
        if self.local(name):
            raise Unknown(reason)
        value = self.from_person(name, reason.wanting(name, self.SHAPE))
        if not isinstance(value, float):
            raise Unknown(reason)
        return value

    def from_person(self, name: str, reason: Reason) -> Any:
        """What a person gives for a name, None: nothing. Raises Unknown where that was before a change."""
        if name in self.spent:
            raise Unknown(
                "programs.fanuc.changed",
                "{name} is changed where the program is not followed, after it was needed",
                name=name,
            )
        value = self.values.get(name)
        if value is not None:
            self.used.add(name)
            self.program.need(reason)
        return value

    def sets(self, name: str, text: str) -> None:
        """Gives a name the value of an expression; what cannot be known is not known from here on."""
        try:
            self.keep(name, self.number(text))
        except Unknown as unknown:
            self.forgets(name, Reason(unknown))

    def keep(self, name: str, value: float) -> None:
        self.causes.pop(name, None)
        self.cells(name)[()] = float(value)
        self.changes += 1

    def assign(self, target: str, value: float) -> None:
        self.keep(self.named(self.PARSER.place(target)), value)

    def forgets(self, name: str, reason: Reason | None = None) -> None:
        """A name is not known from here on, for a Reason."""
        self.cells(name).clear()
        self.causes.pop(name, None)
        self.changes += 1
        if reason is not None:
            self.causes[name] = reason
        if name in self.used:
            self.spent.add(name)

    def forgets_all(self) -> None:
        """Another program may have changed all that is not a routine's own."""
        for name in self.data:
            self.forgets(name)

    def numbers(self) -> frozenset[tuple[str, float]]:
        """All values that are known."""
        self.tick(self.line, len(self.data) // 10)
        scopes = (self.data, self.scopes[-1])
        return frozenset((n, v[()]) for scope in scopes for n, v in scope.items() if v)

    def argument(self, n: int) -> float:
        """The n-th of what the call passes. Raises Unknown."""
        if not 1 <= n <= len(self.arguments):
            raise Unknown("programs.fanuc.no_argument", "AR[{n}] is not in the call", n=n)
        value = self.arguments[n - 1]
        if isinstance(value, Reason):
            raise Unknown(value)
        return value

    def passed(self, text: str) -> float | Reason:
        """What a call passes: a number, or the Reason why it is not known."""
        try:
            return self.number(text)
        except Unknown as unknown:
            return Reason(unknown)
