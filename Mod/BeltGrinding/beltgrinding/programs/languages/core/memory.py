"""The variables of a program: what is known of them, where they live, and what a person gives for them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

from ....base.kinds import Json
from ....base.frames import from_abc
from ...program import Program, Unknown
from .expression import Call, Place, applied, number


Key: TypeAlias = tuple[float, ...]  # the indices of an element
Data: TypeAlias = dict[str, dict[Key, Any]]  # {name: {indices: value}}


class Memory:
    """Variables without declarations. ``local(name)``: whether one is a routine's own; ``PARSER``: the
    language's; ``FUNCTIONS``: {name: function}."""

    program: Program
    changes: int
    PARSER: Any = None
    FUNCTIONS: Mapping[str, Callable[..., Any]] = {}

    def __init__(self, data: Data, values: Json | None) -> None:
        """``data``: {name: {indices: value}} of the global ones; ``values``: {NAME: number, truth value or six of a
        frame} that a person gives."""
        self.data, self.values = data, values or {}
        self.scopes: list[Data] = [{}]  # of the routines' own
        # Names that the program has changed: what a person gives is no longer meant.
        self.spent: set[str] = set()
        self.expression = functools.lru_cache(maxsize=4096)(self.PARSER.expression)  # for loops
        self.listed = functools.lru_cache(maxsize=4096)(lambda text: self.PARSER.list(text)[0])

    def local(self, name: str) -> bool:
        return False

    def given(self, name: str) -> bool:
        """Whether a person may give a global variable's value."""
        return True

    def value(self, text: str) -> Any:
        return self.expression(text)(self)

    def cells(self, name: str) -> dict[Key, Any]:
        """{indices: value} of a variable."""
        return (self.scopes[-1] if self.local(name) else self.data).setdefault(name, {})

    def key(self, place: Place) -> Key:
        """The numbers of a Place's index."""
        if len(place.steps) > 1 or any(isinstance(step, str) for step in place.steps):
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        return tuple(number(one(self)) for step in place.steps for one in step)

    def read(self, place: Place) -> Any:
        key, name = self.key(place), place.name
        value = self.cells(name).get(key)
        if value is not None:
            return value
        shown = name.upper() + (f"[{','.join(f'{k:g}' for k in key)}]" if key else "")
        unknown = Unknown(
            "programs.no_value_here", "{name} has no value that is known here", name=shown
        )
        if self.local(name) or name in self.spent or not self.given(name):
            raise unknown
        value = self.values.get(shown)
        unknown.wanting(shown, "")
        if value is None:
            raise unknown
        self.program.need(unknown)
        return from_abc(value[:3], value[3:]) if isinstance(value, tuple) else value

    def store(self, name: str, key: Key, value: Any) -> None:
        self.cells(name)[key] = value
        self.spent.add(name)
        self.changes += 1

    def assign(self, target: str, value: Any) -> None:
        """Puts a value where a text says."""
        place = self.PARSER.place(target)
        self.store(place.name, self.key(place), value)

    def put(self, target: str, function: Callable[[], Any]) -> None:
        """Puts what a function gives where a text says; what cannot be known is not known from here on."""
        try:
            self.assign(target, function())
        except Unknown:  # whoever uses it reports it
            self.lose(self.names(target))

    def spread(self, target: str, function: Callable[[], Iterable[Any]]) -> None:
        """Puts the values that a function gives into an array from the element on that a text says, or the first."""
        place = self.PARSER.place(target)
        try:
            *outer, first = self.key(place) or (0.0,)
            for k, value in enumerate(function()):
                self.store(place.name, (*outer, first + k), value)
        except Unknown:  # whoever uses them reports it
            self.lose([place.name])

    def names(self, text: str) -> set[str]:
        """The names in a text, as the variables have them."""
        try:
            return {word for kind, word, _ in self.PARSER.scanned(text) if kind == "name"}
        except Unknown:
            return set(self.data) | set(self.scopes[-1])  # whichever is meant

    def lose(self, names: Iterable[str]) -> None:
        """Variables, whichever of their elements, are not known from here on."""
        self.changes += 1
        for name in names:
            self.cells(name).clear()
            self.spent.add(name)

    def function(self, call: Call) -> Any:
        if call.name in self.FUNCTIONS:
            return applied(self.FUNCTIONS, call.name, *call.values(self), call.name.upper())
        raise Unknown(
            "programs.called_function_of_controller",
            "the function {name}() is known to the controller only",
            name=call.name.upper(),
        )

    def bound(
        self, parameters: Iterable[str], texts: Iterable[str]
    ) -> tuple[Data, list[tuple[str, Place]]]:
        """(the scope of a routine that is called with texts, [(parameter, Place)] that get a value back)."""
        scope: Data = {}
        back: list[tuple[str, Place]] = []
        for parameter, text in zip(parameters, texts):
            if not text.strip():
                continue
            one = self.expression(text)
            if isinstance(one, Place) and one.steps == ((),):  # a whole array
                scope[parameter] = self.cells(one.name)
                self.spent.add(one.name)
                continue
            if isinstance(one, Place):
                back.append((parameter, one))
            try:
                scope[parameter] = {(): one(self)}
            except Unknown:  # whoever uses it reports it
                pass
        return scope, back

    def returned(self, scope: Data, back: Iterable[tuple[str, Place]]) -> None:
        """Gives the variables in a call what the routine has made of them."""
        for parameter, place in back:
            value = scope.get(parameter, {}).get(())
            if value is None:
                self.lose([place.name])
            else:
                self.store(place.name, self.key(place), value)
