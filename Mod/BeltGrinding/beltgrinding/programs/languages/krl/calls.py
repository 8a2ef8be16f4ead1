"""Calls of KRL routines and functions: of this file with what they are passed, of the system, and of others."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeAlias

from ....base.kinds import known
from ...program import Unknown
from .parts import Parts
from .blocks import CALL, HARMLESS, SYSTEM
from ..core.expression import Call, Place, applied
from .expression import FUNCTIONS, expression, unknown_function
from .values import Lost, Members, Scope, written

MAX_CALLS = 20


Passed: TypeAlias = tuple[Any, Any]  # of an argument: its path or None; its value, Lost or None


class Calls(Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    def call(self, line: int, text: str) -> None:
        """Follows a statement that is a call."""
        name, arguments = known(CALL.match(text)).groups()
        name = name.lower()
        if name == "bas":
            self.bas(line, arguments)
            return
        try:
            called: Any = expression(text)
            passed = [self.argument(one) for one in called.arguments]
        except Unknown:
            if name not in HARMLESS:
                self.not_understood(line, text)
            return
        if name in self.routines:
            self.enter(line, name, passed)
        elif name not in HARMLESS:
            self.lose_passed(line, passed)
            if name not in SYSTEM:
                self.elsewhere(line, name)

    def elsewhere(self, line: int, name: str) -> None:
        """A call of what is in no file here: it may move the robot."""
        if name not in self.missing:
            self.missing.add(name)
            self.problem(
                line,
                "programs.krl.call_elsewhere",
                "{name}() is not in this file; motions in it are left out, and frames, speeds and variables that "
                "it is not passed are taken to stay as they are",
                name=name,
            )
        self.gap(line)

    def function(self, call: Call) -> Any:
        """The value of a function. Raises Unknown."""
        name = call.name.lower()
        if name in FUNCTIONS and name not in self.routines and None not in call.arguments:
            return applied(FUNCTIONS, name, *call.values(self), call.name)
        passed = [self.argument(one) for one in call.arguments]
        if name in self.routines:
            value = self.enter(self.line, name, passed)
            if value is None:
                raise unknown_function(name)
            return value
        if name in SYSTEM:
            return self.system_function(name, passed)
        raise unknown_function(name)

    def argument(self, one: Any) -> Passed:
        """(path or None, value, Lost or None) of an argument."""
        if isinstance(one, Place):
            try:
                path = self.path(one)
            except Unknown as unknown:
                return self.covered, Lost(unknown.told)
            value = self.values.peek(*path)
            if value is None and self.given.get(written(*path)):
                value = self.ask(written(*path))
            return path, value
        try:
            return None, one and one(self)
        except Unknown as unknown:
            return None, Lost(unknown.told)

    def lose_passed(self, line: int, passed: Iterable[Passed]) -> None:
        for path, _ in passed:
            if path is not None:
                self.lose(line, *path, self.touches(line))

    def enter(self, line: int, name: str, passed: list[Passed]) -> Any:
        """Runs a routine of this file with what it is passed; gives what it returns, Lost, or None."""
        routine = self.routines[name]
        refused = routine.parameters is None or len(passed) > len(routine.parameters)
        if refused or self.calls >= MAX_CALLS:
            if refused:
                self.problem(
                    line,
                    "programs.krl.arguments",
                    "{name}() does not take what it is passed here; its motions are left out",
                    name=name,
                )
            else:
                self.problem(
                    line,
                    "programs.krl.calls_itself",
                    "{name} calls itself too deeply; its motions are left out",
                    name=name,
                )
            self.lose_passed(line, passed)
            self.forget_routine(line, name)
            self.gap(line)
            return None
        self.tick(line, 1 + sum(len(v) // 8 for _, v in passed if isinstance(v, Members)))
        scope = Scope(routine.own, routine.kinds)
        for (parameter, _), (_, value) in zip(known(routine.parameters), passed):
            if value is not None:
                scope.values[parameter] = self.values.held(value, routine.kinds.get(parameter))
        outer, self.values.local, file_line = self.values.local, scope, self.line
        before, own = len(self.program.motions), self.values.home is None
        self.calls += 1
        try:
            with self.at_home(known(routine.home)):
                text = self.routine(routine)
                result = self.value_or_lost(text[6:]) if text[6:].strip() else None
        finally:
            self.calls -= 1
            self.values.local, self.line = outer, file_line
        if (
            own and known(routine.home).scope is not None
        ):  # to who looks at this file they are the call's
            for motion in self.program.motions[before:]:
                motion.line, motion.file = line, self.file
        for (parameter, by_value), (path, _) in zip(known(routine.parameters), passed):
            if path is not None and not by_value and parameter in scope.values:
                self.store(line, *path, scope.values[parameter])
        return self.values.held(result, routine.kind or None)
