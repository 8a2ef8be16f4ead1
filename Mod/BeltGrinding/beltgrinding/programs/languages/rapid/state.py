"""What a RAPID program knows while it is followed: its data."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias

from ....base.kinds import Json
from ...program import SKIPPED, Fact, Program, Reason, Unknown
from ..core.expression import Call, Place, applied
from . import data
from .data import PREDEFINED, number
from .expression import expression, name_of as named, one_word
from .functions import FUNCTIONS, OF_TARGETS, PARTS, READING

NO_VALUE = Fact("programs.rapid.no_value", "this file gives it no value")
NOT_KNOWN = "programs.not_known_since"  # said once, of the first
ASSIGNED = Fact("programs.assigned_at_run_time", "it is assigned at run time")
MAX_RESOLVING = 10  # constants defined by constants
AGAIN = Fact("programs.rapid.again", "it is assigned at run time more than once")
FRAMES = ("tooldata", "wobjdata")
SCALARS = ("num", "dnum", "bool", "string")  # of which no frame in words changes when they do


Entry: TypeAlias = list[Any]  # of data, as State has it


class State:
    """Data by name: [type, value (None, or a Reason: not known), line and text of a value not asked for yet].

    ``copy(value, line)`` is what ``Control`` adds.
    """

    program: Program
    file: str
    rounds: int
    changes: int
    said: set[Any]
    tick: Callable[..., None]
    copy: Callable[..., Any]
    position: Callable[..., Any]

    def __init__(self) -> None:
        self.globals: dict[str, Entry] = {}
        self.locals: dict[str, Entry] | None = None  # of the running routine
        self.records = dict(data.RECORDS)
        # {type: {component: (place, type)}}, of those asked for
        self.components: dict[str | None, dict[str, tuple[int, str]]] = {}
        self.resolving = 0
        self.constants: set[str] = set()
        self.texts: dict[tuple[str, int], str] = {}  # frames in words; cleared when data changes
        self.given: Json = {}  # what a person says: {NAME: number, truth value or six of a frame}
        self.calls = 0  # of routines in each other
        # Names of targets that are not declared, as far as that is seen
        self.points: set[str] = set()
        # Type of data that are not declared, where the expression tells it
        self.wanted: str | None = None
        self.changed: dict[str, int] = {}  # lines in which frames became unknown
        self.line = 1  # that which runs
        self.used: set[str] = set()  # names that a person's values were taken for
        self.spent: set[str] = set()  # no longer

    def value(self, text: str) -> Any:
        """The value of an expression's text. Raises Unknown."""
        return expression(text)(self)

    def read(self, place: Place) -> Any:
        """The value of a Place: name{i,j}.part. Raises Unknown."""
        if place.steps and str(place.steps[0]).lower() in PARTS:
            self.points.add(place.name.lower())
        value, kind = self.variable(place.name)
        for at, kind in self.steps_of(place, kind):
            value = value[self.element(value, at, place.name)]
        return value

    def steps_of(self, place: Place, kind: str | None) -> Iterator[tuple[int, Any]]:
        """(index, from 1 on, and type) of each step into data of a type. Raises Unknown."""
        for step in place.steps:
            if isinstance(step, str):
                at, kind = self.component(kind, step)
                yield at + 1, kind
            else:
                for index in step:
                    yield int(number(index(self))), kind

    @staticmethod
    def element(value: Any, index: int, name: str) -> int:
        if not isinstance(value, list) or not 1 <= index <= len(value):
            raise Unknown(
                "programs.no_element", "{name} has no element {index}", name=name, index=index
            )
        return index - 1

    def function(self, call: Call) -> Any:
        """The value of a function. Raises Unknown; what the controller's own may change is not known then."""
        name = call.name.lower()
        if name == "crobt":
            return self.position(call.named)
        if name == "present" and len(call.arguments) == 1:
            return self.is_given(call.arguments[0])
        own = self.own_function(call)
        if own is not None:
            return own
        if name not in FUNCTIONS:
            if name not in READING:
                self.touched([*call.arguments, *call.named.values()])
            raise Unknown(
                "programs.function_of_controller",
                "the function {name} is known to the controller only",
                name=call.name,
            )
        if name in OF_TARGETS and call.arguments:
            self.points.add(named(call.arguments[0]).lower())
        return applied(FUNCTIONS, name, *call.values(self), call.name)

    def is_given(self, argument: object) -> bool:
        """Whether the running routine was given an optional argument. Raises Unknown."""
        entry = (self.locals or {}).get(named(argument).lower())
        if entry is None or not self.calls:
            raise Unknown(
                "programs.rapid.given_by_caller",
                "whether {name} is given, the caller decides",
                name=named(argument) or "it",
            )
        return entry[1] is not None

    def own_function(self, call: Call) -> Any:
        """The value of a program's function; None where there is none of that name."""
        return None

    def lose_functions(self, names: set[str]) -> None:
        """What functions of the program may have changed is not known."""

    def entry(self, name: str) -> Entry | None:
        if self.locals is not None and name in self.locals:
            return self.locals[name]
        return self.globals.get(name)

    def variable(self, written: str) -> tuple[Any, Any]:
        """(value, type) of data. Raises Unknown."""
        name = written.lower()
        entry = self.entry(name)
        if entry is None and name in PREDEFINED:
            kind, value = PREDEFINED[name]
            return value, kind
        if entry is None:
            wanted = "robtarget" if name in self.points else self.wanted
            return self.from_person(
                name,
                wanted,
                Reason(
                    "programs.rapid.not_declared",
                    "{name} is not declared in this file",
                    name=written,
                ),
            )
        if len(entry) == 3:
            self.resolve(entry, name)
        if entry[1] is None or isinstance(entry[1], Reason):
            return self.from_person(name, entry[0], self.first_cause(written, entry))
        return entry[1], entry[0]

    def first_cause(self, written: str, entry: Entry) -> Reason:
        """Why data are not known: what they were made of, or themselves where nothing else can be given."""
        why = entry[1]
        if why is not None and (why.wants is not None or why.fact.code == NOT_KNOWN):
            return why
        fact = NO_VALUE if why is None else why.fact
        return Reason(
            "programs.not_known_since", "{name} is not known ({reason})", name=written, reason=fact
        )

    def from_person(self, name: str, kind: str | None, reason: Reason) -> tuple[Any, str]:
        """(value, type) that a person gives for data. Raises Unknown for ``reason``, which wants them unless they
        are a routine's own, or of a type that cannot be given."""
        own = self.locals is not None and name in self.locals
        if own or kind is not None and kind not in data.GIVEN:
            raise Unknown(reason)
        if reason.wants is not None and reason.wants[0] != name.upper():
            raise Unknown(reason)  # of another name
        if name in self.spent:
            raise Unknown(
                "programs.not_known_since",
                "{name} is not known ({reason})",
                name=name,
                reason=AGAIN,
            )
        shape = data.GIVEN.get(kind or "", "")
        value = self.given.get(name.upper())
        truth = isinstance(value, bool)
        of_shape = "frame" if isinstance(value, tuple) else "truth" if truth else "number"
        if value is None or shape and shape != of_shape:
            raise Unknown(reason).wanting(name, shape)
        self.used.add(name)
        self.program.asked.setdefault(name.upper(), shape)
        return (
            data.from_person(kind or data.KIND_OF[of_shape], value),
            kind or data.KIND_OF[of_shape],
        )

    def settle(self, name: str) -> None:
        """Finds the value that data are declared with; whoever uses what is not known reports it."""
        entry = self.entry(name)
        if entry is not None and len(entry) == 3:
            self.resolve(entry, name)

    @contextlib.contextmanager
    def asking(self, kind: str | None) -> Iterator[None]:
        """Data that are not declared are of the type ``kind`` meanwhile."""
        before, self.wanted = self.wanted, kind
        try:
            yield
        finally:
            self.wanted = before

    def resolve(self, entry: Entry, name: str) -> None:
        if self.resolving >= MAX_RESOLVING:
            raise Unknown(
                "programs.rapid.too_many_constants",
                "{name} is defined by too many constants",
                name=name,
            )
        line, text = entry.pop()
        self.resolving += 1
        try:
            found = expression(text)
            with self.asking(self.kind_of(found, entry[0])):
                entry[1] = self.copy(found(self), line)
        except Unknown as unknown:
            entry[1] = Reason(unknown)
        finally:
            self.resolving -= 1

    @staticmethod
    def kind_of(argument: object, kind: str | None) -> str | None:
        """The type of data not declared in an expression of the type ``kind``; None: it does not tell."""
        return kind if one_word(argument) else None

    def component(self, kind: str | None, name: object) -> tuple[int, str]:
        """(index, type) of a record's component. Raises Unknown."""
        if kind not in self.components:
            names = self.records.get(kind or "", {})
            self.components[kind] = {one: (k, names[one]) for k, one in enumerate(names)}
        found = self.components[kind]
        if str(name).lower() not in found:
            raise Unknown(
                "programs.rapid.no_component_of_type",
                "{kind} has no component {name}",
                kind=kind,
                name=name,
            )
        return found[str(name).lower()]

    def store(self, name: str, value: Any) -> None:
        entry = self.entry(name)
        if entry is None:
            entry = self.globals[name] = [PREDEFINED.get(name, ("",))[0], None]
        entry[1:] = [value]
        self.changes += 1
        if entry[0] not in SCALARS:
            self.texts.clear()
        if entry[0] in FRAMES:
            self.another(name)

    def another(self, name: str) -> None:
        """A name stands for another frame: a motion in it says anew what is wrong with it."""
        self.rounds += len(self.said) // SKIPPED
        self.said = {one for one in self.said if one != name and name not in one}

    def forget(self, name: str, why: Fact | Reason = ASSIGNED) -> None:
        """Whoever uses the data from here on reports ``why``, a Fact or a Reason."""
        entry = self.entry(name)
        self.changes += entry is not None and not isinstance(entry[1], Reason)
        if name in self.constants and entry is self.globals.get(name):
            return
        if name in self.used:  # the value given was that until now
            self.spent.add(name)
        if entry is not None:
            entry[1:] = [Reason(why)]
            if entry[0] not in SCALARS:
                self.texts.clear()
            if entry[0] in FRAMES:
                self.changed[name] = self.line
                self.another(name)
        elif name in PREDEFINED and name.startswith("reg"):
            self.globals[name] = ["num", Reason(why)]

    def touched(self, arguments: Iterable[object]) -> None:
        """What is handed to something that is not followed may be changed there."""
        for one in arguments:
            if isinstance(one, Place):
                self.forget(one.name.lower())
