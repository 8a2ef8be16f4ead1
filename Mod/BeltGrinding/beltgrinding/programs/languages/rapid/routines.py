"""Calls of a RAPID program's routines and functions."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any

from ...program import Fact, Reason, Told, Unknown
from .state import Entry
from ..core.expression import Call, Place
from ..core.flow import Jump, Leave
from ..core.tree import Node, every
from .expression import Handed, passed
from .loading import Loading, Parameter

MAX_CALLS = 20


class Undecided(Reason, Exception):
    """What a function gives is decided at run time; ``fact`` says why."""


class Routines(Loading):
    """Runs procedures, and functions for their values."""

    def problem(
        self,
        line: int,
        told: Told,
        text: str | None = None,
        /,
        once: Hashable = None,
        **arguments: object,
    ) -> None:
        if self.evaluating:
            raise Undecided(told if text is None else Fact(told, text, **arguments))
        super().problem(line, told, text, once=once, **arguments)

    def skip(self, nodes: Sequence[Node], line: int, message: Fact, why: Reason) -> None:
        if self.evaluating:
            raise Undecided(why)
        super().skip(nodes, line, message, why)

    def own_function(self, call: Call) -> Any:
        """The value of a function of the program, or None where there is none of that name. Raises
        Unknown where it is decided at run time."""
        name, positional, optional = call.name.lower(), call.arguments, call.named
        if name not in self.functions:
            return None
        head, parameters, body = self.functions[name]
        written = head.text.split("(")[0].split()[-1]
        inner, back = self.passed(parameters, positional, optional, head.line)
        self.touched([place for place, _ in back])
        required = [one for one in parameters if not one.optional]
        if self.calls >= MAX_CALLS or back or len(positional) != len(required):
            raise Unknown(
                "programs.rapid.function_call", "the call of {name} is not followed", name=written
            )
        self.tick(head.line, 2)
        reason = next((e[1] for e in inner.values() if isinstance(e[1], Reason)), None)
        if reason is not None:
            raise Unknown(reason)
        kept = self.locals
        self.calls, self.evaluating = self.calls + 1, self.evaluating + 1
        try:
            with self.within(self.homes.get(id(head))):
                self.locals = inner
                self.block(body)
        except Leave as leave:
            if leave.value is not None:
                return leave.value
        except Undecided as undecided:
            reason = undecided
        except Jump:
            pass
        finally:
            self.calls, self.evaluating = self.calls - 1, self.evaluating - 1
            self.locals = kept
        self.lose_functions({name})
        reason = reason or Reason("programs.rapid.no_return", "no RETURN is reached")
        raise Unknown(
            "programs.rapid.function_unknown",
            "what {name} gives is not known: {reason}",
            name=written,
            reason=reason.fact,
        ).after(reason)

    def lose_functions(self, names: set[str]) -> None:
        """What the program's functions among ``names`` may have changed is not known."""
        functions = names & self.functions.keys()
        for node in every([node for name in functions for node in self.functions[name][2]]):
            for word in re.findall(r"\w+", node.text):
                if word.lower() in self.globals:
                    self.forget(word.lower())

    def routine(self, node: Node, body: Sequence[Node]) -> None:
        try:
            self.block(body)
        except Leave as leave:
            if leave.word == "exit":
                raise
        except Jump as jump:
            self.no_label(jump)

    def passed(
        self,
        parameters: Iterable[Parameter],
        given: Sequence[Any],
        options: Mapping[str, Any],
        line: int,
    ) -> tuple[dict[str, Entry], list[tuple[Place, str]]]:
        """(data of a routine's parameters by name, [(Place, name)] of what it may give back)."""
        inner: dict[str, Entry] = {}
        back: list[tuple[Place, str]] = []
        given = list(given)
        for one in parameters:
            argument = options.get(one.name) if one.optional else given.pop(0) if given else None
            inner[one.name] = [one.kind, None]
            if argument is None:  # a switch is given without a value
                inner[one.name][1] = True if one.optional and one.name in options else None
                continue
            if isinstance(argument, Handed):
                if not self.is_given(argument.place):
                    continue
                argument = argument.place
            try:
                with self.asking(self.kind_of(argument, one.kind)):
                    inner[one.name][1] = self.copy(argument(self), line)
            except Unknown as unknown:
                inner[one.name][1] = Reason(unknown)
            if one.by_reference and isinstance(argument, Place):
                back.append((argument, one.name))
        return inner, back

    def call(self, node: Node) -> None:
        head, parameters, body = self.routines[node.word]
        if self.calls >= MAX_CALLS:
            self.problem(
                node.line,
                "programs.rapid.calls_itself",
                "{word} calls itself too deeply; it is left out",
                word=node.word,
            )
            self.gap(node.line)
            return
        self.tick(node.line, 2)
        own = self.locals
        try:
            inner, back = self.passed(parameters, *passed(node.text), node.line)
        except Unknown:
            inner, back = self.passed(parameters, [], {}, node.line)
        home, before = self.homes.get(id(head)), len(self.program.motions)
        away = self.own is not None
        self.calls += 1
        try:
            with self.within(home):
                self.locals = inner
                self.texts.clear()
                self.routine(head, body)
        finally:
            self.calls, self.locals = self.calls - 1, own
            self.texts.clear()
            if home is not None and not away:  # to who looks at this file they are the call's
                for motion in self.program.motions[before:]:
                    motion.line, motion.file = node.line, self.file
        for place, name in back:
            value = inner[name][1]
            if isinstance(value, Reason):
                self.forget(place.name.lower(), value)
            elif not place.steps and value is not None:
                self.store(place.name.lower(), value)
            else:
                self.forget(place.name.lower())
