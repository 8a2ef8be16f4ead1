"""The variables and routines of a URScript program, in the scopes in which it has them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from ...program import SKIPPED, Program, Told, Unknown, work_of
from ..core.tree import Node
from ..core.expression import Call, Place, applied
from ..core.flow import Flow, Leave
from .expression import FUNCTIONS, expression, within
from .pose import InReference, Pose, pose_of

MAX_CALLS = 20
ELEMENTS = 50  # of a list, which are copied in a unit of work
MOVES = "movej movel movep movec optimovej optimovel servoj servoc speedj speedl".split()
MOVE = re.compile(rf"\b(?:{'|'.join(MOVES)})\s*\(")
ASSIGN = re.compile(r"^(?:(global|local)\s+)?([A-Za-z_]\w*)\s*(?:(\[.*?\])\s*)?=(?!=)\s*(.+)$")
TARGET = re.compile(r"\[[^\[\]]*\]")  # an index of what is assigned
CALLED = re.compile(r"(?<![\w.])([A-Za-z_]\w*)\s*\(")


class Scopes(Flow):
    """Variables by name, the global ones and those of the routines that run."""

    touch: Callable[..., None]

    def __init__(self, name: str) -> None:
        self.program, self.file = Program("URScript", name), name
        self.scopes: list[dict[str, Any]] = [{}]  # the global one first; the innermost last
        # (parameters and their defaults, statements) by name
        self.routines: dict[str, tuple[list[tuple[str, str]], list[Node]]] = {}
        self.line = 0
        self.called = False
        self.calls = 0  # of routines in each other
        self.missing: set[str] = set()
        self.free_reference = True  # the file gives ref_frame no value: another one does
        self.returned: Any = None
        self.beside: set[str] = set()  # names that a thread assigns, whenever it does

    def problem(
        self, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        self.program.problem(self.file, line, told, text, **arguments)

    def lose(self, names: set[str]) -> None:
        """Variables are not known from here on, whichever is meant."""
        for scope in self.scopes:
            for name in names & scope.keys():
                del scope[name]
                self.changes += 1

    @staticmethod
    def names_of(text: str) -> set[str]:
        """The names that a statement assigns, understood or not."""
        match = ASSIGN.match(text)
        if match:
            return {match.group(2)}
        left, equals, _ = TARGET.sub("", text).partition("=")
        return set(re.findall(r"[A-Za-z_]\w*", left)) if equals and "(" not in left else set()

    def assigned_in(self, nodes: Iterable[Node]) -> set[str]:
        """The names that statements assign, those of routines they call among them."""
        names: set[str] = set()
        entered: set[str] = set()
        stack = list(nodes)
        while stack:
            node = stack.pop()
            self.tick(node.line, work_of(node.text) // SKIPPED)
            stack += node.body or []
            if node.body is None:
                names |= self.names_of(node.text)
            for name in self.called_in(node.text) - entered:
                entered.add(name)
                stack += self.routines[name][1]
        return names

    def called_in(self, text: str) -> set[str]:
        """Routines of this file that a text calls."""
        return {name for name in CALLED.findall(text) if name in self.routines}

    def lose_calls(self, text: str) -> None:
        """What routines assign that a statement calls which is not followed: as far as it is, nobody knows."""
        for name in self.called_in(text):
            self.lose(self.assigned_in(self.routines[name][1]))

    def lookup(self, name: str) -> Any:
        for scope in (self.scopes[-1], self.scopes[0]):
            if name in scope:
                return scope[name]
        if name in ("true", "false"):
            return name == "true"
        if name == "ref_frame" and self.free_reference:
            if "ref_frame" not in self.missing:
                self.missing.add("ref_frame")
                self.problem(
                    self.line,
                    "programs.urscript.ref_frame_elsewhere",
                    "ref_frame has no value that this file gives; the poses are kept as they are in it",
                )
            return InReference(np.eye(4))
        raise Unknown(
            "programs.urscript.no_value", "{name} has no value that this file gives", name=name
        )

    def value(self, text: str) -> Any:
        return expression(text)(self)

    def read(self, place: Place) -> Any:
        """The value of a Place. Raises Unknown."""
        return within(lambda env: env.lookup(place.name), place.steps, self)

    def function(self, call: Call) -> Any:
        """The value of a function. Raises Unknown."""
        name = call.name
        if name in FUNCTIONS and name not in self.routines:
            return applied(FUNCTIONS, name, *call.values(self), name)
        if name in self.routines:
            value = self.invoke(call)
            if value is not None:
                return value
            raise Unknown(
                "programs.urscript.no_return_value",
                "{name}() returns no value that is known here",
                name=name,
            )
        raise Unknown(
            "programs.called_function_of_controller",
            "the function {name}() is known to the controller only",
            name=name,
        )

    def invoke(self, call: Call) -> Any:
        """Runs a routine of this file; its value, None where it has none."""
        self.called, name = True, call.name
        if self.calls >= MAX_CALLS:
            raise Unknown(
                "programs.urscript.calls_itself", "{name} calls itself too deeply", name=name
            )
        self.tick(self.line, 1)
        parameters, nodes = self.routines[name]
        names = [parameter for parameter, _ in parameters]
        given = dict(zip(names, call.arguments))
        if (
            len(call.arguments) > len(names)
            or given.keys() & call.named.keys()
            or call.named.keys() - set(names)
        ):
            raise Unknown(
                "programs.urscript.wrong_arguments",
                "{name}() does not take these arguments",
                name=name,
            )
        scope: dict[str, Any] = {}
        self.calls += 1  # a default may call the routine itself
        try:
            given.update(call.named)
            for parameter, default in parameters:
                try:
                    value = given.get(parameter)
                    scope[parameter] = self.value(default) if value is None else value(self)
                except Unknown:  # whoever uses it reports it
                    self.lose_calls(default)
            self.scopes.append(scope)
            self.returned = None
            try:
                self.block(nodes)
            except Leave as leave:
                if leave.word == "exit":
                    raise
            finally:
                self.scopes.pop()
        finally:
            self.calls -= 1
        value, self.returned = self.returned, None
        return value

    def assignment(self, match: re.Match[str], line: int) -> None:
        where, name, index, text = match.groups()
        outer, inner = self.scopes[0], self.scopes[-1]
        known = name in outer and name not in inner and where != "local"
        scope = outer if where == "global" or known else inner
        if where is None and scope is inner:  # whether it is that of a routine around is not known
            for between in self.scopes[1:-1]:
                between.pop(name, None)
        try:
            if name in self.beside and where != "local":
                raise Unknown(
                    "programs.urscript.thread_assigns", "a thread assigns {name} as well", name=name
                )
            value = self.value(text)
            if isinstance(value, list):
                self.tick(line, len(value) // ELEMENTS)
                value = list(value)
            if index:
                at, inside = self.value(index[1:-1]), self.lookup(name)
                values = inside.components() if isinstance(inside, Pose) else inside
                values = list(values) if isinstance(values, list) else []
                self.tick(line, len(values) // ELEMENTS)
                if type(at) is not int or not 0 <= at < len(values):
                    raise Unknown(
                        "programs.no_element",
                        "{name} has no element {index}",
                        name=name,
                        index=index,
                    )
                values[at] = value
                value = pose_of(values) if isinstance(inside, Pose) else values
            scope[name] = value
            self.changes += 1
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.changes += name in inner or name in outer
            self.touch(line, text)
            for one in (inner, outer):
                one.pop(name, None)
            self.lose_calls(text)
            if name == "ref_frame":
                self.problem(
                    line,
                    "programs.urscript.ref_frame",
                    "ref_frame is not known: {reason}",
                    reason=unknown.fact,
                )
            elif MOVE.search(text):
                self.problem(
                    line,
                    "programs.motion_left_out",
                    "the motion is left out: {reason}",
                    reason=unknown.fact,
                )
                self.gap(line)
