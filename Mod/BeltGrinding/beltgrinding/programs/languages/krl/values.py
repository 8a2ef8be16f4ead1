"""What a KRL program knows of its variables.

A value is a truth value, a whole number (int), a REAL (float), a number of which it is not known which of both
(Either), a text (an enumeration's with #, a string's with its quotes), or Members: the components of a structure
by name, or the elements of an array by their indices, a tuple. A path is a name and its steps: ``f[2].x`` is
("f", ((2,), "x")). What is not known is Lost, which is another thing than what has no value yet (None).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from ...program import Unknown, Why
from .types import Structures, component_kind, holds

Steps: TypeAlias = tuple[Any, ...]  # a component's name, or a tuple of indices

MAX_COMPONENTS = 100  # of a structure
LARGEST = 2**31  # of an INT
CHANGING = ("$timer", "$cycflag", "$in", "$anin", "$pos_", "$axis_act", "$distance", "$sen_")


class Either(float):
    """A whole number that is an INT or a REAL: its variable is declared elsewhere."""


class Lost:
    """What is not known any more. ``told``: why, as a Reason takes it; ``words``: of a frame, its name."""

    __slots__ = ("told", "words")

    def __init__(self, told: Why, words: str = "") -> None:
        self.told, self.words = told, words


class Members(dict[Any, Any]):
    """Components or elements; ``rest``: what those are that are not named (None or Lost)."""

    __slots__ = ("rest",)

    def __init__(self, members: Any = (), rest: Lost | None = None) -> None:
        super().__init__(members)
        self.rest = rest


class Scope:
    """The variables of a routine, or of the module: values and types by name. ``own``: the names that are a
    routine's; None: the module's, all that are no routine's."""

    def __init__(
        self, own: frozenset[str] | None = None, kinds: Mapping[str, str] | None = None
    ) -> None:
        self.own: Any = own
        self.values: dict[str, Any] = {}
        self.kinds = dict(kinds or {})


class Values:
    """The variables by name, those of the routine that runs before the module's."""

    def __init__(self) -> None:
        self.module, self.local = Scope(), Scope(frozenset())
        # The Scope of another module's own data while its routine runs
        self.home: Scope | None = None
        # Names of the module's that no other module sees
        self.private: frozenset[str] = frozenset()
        self.structures: Structures = {}  # of STRUC
        self.versions: dict[str, int] = {}  # how often a name was changed
        self.changes = 0
        self.always: dict[str, Why] = {}  # {name: why} of what changes at any time

    def scope(self, name: str) -> Scope:
        if name in self.local.own:
            return self.local
        if self.home is None:
            return self.module
        if name in self.home.own:
            return self.home
        return Scope() if name in self.private else self.module

    def peek(self, name: str, steps: Steps = ()) -> Any:
        """The value, Lost, or None; a component of what is Lost is Lost."""
        value = self.scope(name).values.get(name)
        for step in steps:
            if not isinstance(value, Members):
                return value if isinstance(value, Lost) else None
            value = value.get(step, value.rest)
        return value

    def look(self, name: str, steps: Steps = ()) -> Any:
        """The value, or None where none was given yet. Raises Unknown where it is Lost."""
        value = self.peek(name, steps)
        if isinstance(value, Lost):
            raise Unknown(value.told)
        return value

    def kind(self, name: str, steps: Steps = ()) -> str | None:
        """The type of what a path names, in lower case; None: not declared here."""
        kind = self.scope(name).kinds.get(name) or SYSTEM.get(name)
        for step in steps:
            if isinstance(step, str):
                kind = component_kind(kind, step, self.structures)
        return kind

    def assign(self, name: str, steps: Steps, value: Any) -> None:
        """Gives a copy of a value, or Lost, to what a path names, as its type holds it."""
        scope = self.scope(name)
        self.versions[name] = self.versions.get(name, 0) + 1
        self.changes += 1
        if name in self.always or name.startswith(CHANGING):
            told: Why = self.always.get(name) or (
                "programs.krl.changes_itself",
                "{name} changes by itself",
                {"name": name.upper()},
            )
            steps, value = (), Lost(told)
        kind: str | None = None
        known = True
        for k, step in enumerate(steps):
            if isinstance(step, str):
                owner = self.kind(name, steps[:k])
                known = known and holds(owner, step, self.structures)
        if not known:  # there is no such component: it may be any
            steps = steps[: next(k for k, step in enumerate(steps) if isinstance(step, str))]
            value = Lost(
                (
                    "programs.krl.component_unknown",
                    "an assignment to a component of {name} is not understood",
                    {"name": name.upper()},
                )
            )
        else:
            kind = self.kind(name, steps)
        value = self.held(value, kind)
        scope.values[name] = self._placed(scope.values.get(name), name, steps, value)

    def _placed(self, at: Any, name: str, steps: Steps, value: Any) -> Any:
        if not steps:
            return value
        step = steps[0]
        if not isinstance(at, Members):
            rest = at if isinstance(at, Lost) else None
            if at is None and isinstance(step, str) and name not in self.local.own:
                rest = Lost(no_value(name))  # its other components are the controller's
            at = Members((), rest)
        if isinstance(step, str) and step not in at and len(at) >= MAX_COMPONENTS:
            at.rest = Lost(
                (
                    "programs.krl.components",
                    "the aggregate has more than {limit} components",
                    {"limit": MAX_COMPONENTS},
                )
            )
            return at
        at[step] = self._placed(at.get(step, at.rest), name, steps[1:], value)
        return at

    def lose(self, name: str, told: Why, steps: Steps = ()) -> None:
        """What a path names is not known from here on."""
        self.assign(name, steps, Lost(told))

    def lose_always(self, name: str, told: Why) -> None:
        """Nor does an assignment tell it: something that runs beside changes it."""
        self.always[name] = told
        self.lose(name, told)

    def drop(self, name: str) -> None:
        """As if nothing had been assigned."""
        self.scope(name).values.pop(name, None)
        self.versions[name] = self.versions.get(name, 0) + 1

    def save(self, name: str) -> Any:
        """What restore() brings back."""
        return self.held(self.peek(name), self.kind(name))

    def restore(self, name: str, value: Any) -> None:
        if value is None:
            self.drop(name)
        else:
            self.assign(name, (), value)

    def held(self, value: Any, kind: str | None) -> Any:
        """A copy of a value as a variable of a type holds it."""
        if isinstance(value, Members):
            copy = Members((), value.rest)
            for step, one in value.items():
                copy[step] = self.held(
                    one,
                    component_kind(kind, step, self.structures) if isinstance(step, str) else kind,
                )
            return copy
        if isinstance(value, Lost) or value is None:
            return value
        truth, text = isinstance(value, bool), isinstance(value, str)
        if kind is None:
            return Either(value) if type(value) is int else value
        if kind == "bool" and truth or kind not in ("int", "real", "bool"):
            return value
        if truth or text or kind == "bool":
            return Lost(
                (
                    "programs.krl.other_type",
                    "its value does not fit a variable of the type {kind}",
                    {"kind": kind.upper()},
                )
            )
        if kind == "real":
            return float(value)
        whole = whole_of(value)
        return (
            whole
            if abs(whole) < LARGEST
            else Lost(("programs.krl.int_bounds", "a whole number is out of the bounds of INT", {}))
        )


# Structures of the controller, by their types (types.py).
SYSTEM = {
    "$base": "frame", "$tool": "frame", "$vel": "cp", "$acc": "cp", "$apo": "apo", "$load": "load",
}  # fmt: skip


def whole_of(value: float) -> int:
    """A number as INT holds it: rounded, halves away from zero."""
    if type(value) is int or abs(value) >= LARGEST:
        return int(value)
    return int(value + 0.5) if value >= 0 else -int(0.5 - value)


def no_value(name: str, index: str = "") -> tuple[str, str, dict[str, Any]]:
    """Why a name is not known that was given no value, as a Reason takes it."""
    return (
        "programs.krl.no_value",
        "{name}{index} has no value that this file or its .dat gives",
        {"name": name.upper(), "index": index},
    )


def written(name: str, steps: Steps) -> str:
    """A path as it is written, in upper case."""
    parts = [name]
    for step in steps:
        parts.append(f".{step}" if isinstance(step, str) else f"[{','.join(map(str, step))}]")
    return "".join(parts).upper()
