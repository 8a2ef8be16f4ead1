"""Reads KUKA KRL: a module's .src with the .dat beside it.

Poses are those of $TOOL in $BASE; A, B, C turn about Z, Y', X'' (Rz(A) Ry(B) Rx(C)), as in KUKA's
System Software operating manuals. What only the controller can know is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ....base.kinds import Json
from ...program import Program, ProgramError, Told, Unknown, Why, name_of
from ..core.values import Evaluated
from .data_lists import Rows
from . import data_lists, modules
from .blocks import (
    ASSIGN,
    CALL,
    CLOSED,
    HARMLESS,
    LEAVING,
    MOTION,
    MOTIONS,
    OPENING,
    PARTS,
    SYSTEM,
    Block,
    word_of,
)
from .calls import Calls
from .expression import FRAME, Parser, expression, place
from ..core.expression import Place
from ..core.statements import Statements
from .numbers import integer
from ..core.flow import Leave
from .flow import Flow
from .motions import Motions
from .settings import FRAMES, Settings
from .sources import Sources
from .touched import BESIDE, QUIET, Touched
from .turning import Turning
from .types import declaration
from .values import Either, Lost, Members, Scope, Steps, Values, no_value, written


def read(path: Path | str, values: Json | None = None) -> Program:
    """The Program of a .src file; ``values``: what a person gives, {NAME: number, truth value, or six of a
    frame}. Raises ProgramError when it cannot be read at all."""
    path = Path(path)
    interpreter = _Interpreter(name_of(path), values)
    interpreter.read_lists(path)
    statements = data_lists.statements(path)
    interpreter.read_modules(modules.beside(path))
    interpreter.run(statements)
    return interpreter.program


class _Interpreter(Flow, Calls, Touched, Settings, Motions, Sources):
    """Follows a program from top to bottom with the values it can know."""

    def __init__(self, name: str, given: Json | None = None) -> None:
        self.program = Program("KUKA KRL", name)
        self.given = given or {}  # where neither the program nor a data list tells
        self.file, self.line = name, 1
        self.values = Values()
        self.turning = Turning(self.values)
        self.frame_names, self.frame_counts = {}, {}  # words of frames that are not known
        self.in_words = {}  # of $TOOL and $BASE: the version, the words, the aggregate
        self.here = self.here_frames = None
        self.last_components = None
        self.spline = False  # within a SPLINE block; None: it may be
        self.block_saved, self.block_reason = (
            [],
            None,
        )  # what its WITH set, or why that is not known
        self.home = modules.Home(name)  # where the routine stands that runs
        self.homes = {}  # of other modules: {name: Home}
        super().__init__()
        self.calls = 0
        self.missing = set()  # what was told once
        self.joins = {}  # labels that a GOTO may have led to: {(routine, place): since where}
        self.forgetting = self.called = 0
        self.zeroed = False
        self.covered = None  # of a path that is not known, what is before the index that is not
        self.forgotten = set()
        self.beside = False

    def problem(
        self, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        self.program.problem(self.file, line, told, text, **arguments)

    def gap(self, line: int) -> None:
        """What is left out: the path beyond must not be joined over it."""
        self.here = None
        self.program.gap(line, self.file)

    def lookup(self, name: str, steps: Steps) -> Any:
        if name == "$nullframe":
            return Members(dict.fromkeys(FRAME, 0.0))
        value = self.values.look(name, steps)
        if value is None:
            value = self.given_for(name, steps)
        if value is None:
            raise Unknown(no_value(written(name, steps)))
        return value

    def given_for(self, name: str, steps: Steps, kind: str = "") -> Any:
        """What a person gives for a path, or for the frame whose component it is; None: nothing."""
        if steps and steps[-1] in FRAME and name not in self.values.local.own:
            whole = written(name, steps[:-1])
            if (
                isinstance(self.given.get(whole), tuple)
                and self.values.peek(name, steps[:-1]) is None
            ):
                return self.ask(whole, "frame")[steps[-1]]
        return self.ask(written(name, steps), kind)

    def ask(self, name: str, kind: str = "") -> Any:
        """What a person gives for a name; None: nothing."""
        value = self.given.get(name)
        self.program.asked.setdefault(name, kind)
        if isinstance(value, tuple):
            return Members(zip(FRAME, value))
        if isinstance(value, float) and value == int(value):
            return Either(value)
        return value

    def evaluate(self, text: str) -> Any:
        """The value of an expression. Raises Unknown; what its calls may change is not known then."""
        try:
            value = self.computed(expression(text))
        except Unknown as unknown:
            self.lose_calls(self.line, text, unknown.told)
            raise
        if isinstance(value, Lost):
            raise Unknown(value.told)
        return value

    def computed(self, function: Evaluated) -> Any:
        """What an expression gives; components that it takes as 0 are told."""
        self.zeroed = False
        value = function(self)
        if self.zeroed:
            self.say_zeroed(self.line)
        return value

    def read(self, place: Place) -> Any:
        """The value of a Place. Raises Unknown."""
        value = self.lookup(*self.path(place))
        if isinstance(value, Lost):
            raise Unknown(value.told)
        return value

    def path(self, place: Place, environment: Any = None) -> tuple[str, Steps]:
        """(name, steps) of a Place. Raises Unknown where an index is not known; ``covered`` is then the path
        before it."""
        name = place.name.lower()
        steps: list[Any] = []
        try:
            for step in place.steps:
                if isinstance(step, str):
                    steps.append(step.lower())
                elif step:
                    steps.append(tuple(integer(index(environment or self)) for index in step))
        except Unknown:
            self.covered = name, tuple(steps)
            raise
        return name, tuple(steps)

    def value_or_lost(self, text: str) -> Any:
        try:
            return self.evaluate(text)
        except Unknown as unknown:
            return Lost(unknown.told)

    def values_in(self, text: str) -> Iterator[Any]:
        """The values of a list, one after the other."""
        for one in Parser.list(text)[0]:
            yield one and one(self)

    def assign(self, match: re.Match[str], line: int) -> None:
        """Follows an assignment, a match of ASSIGN."""
        text, target = match["value"], None
        try:
            target = place(match["path"])
            name, steps = self.path(target)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.krl.index",
                "the index of {name} is not known: {reason}",
                name=match["path"].partition("[")[0].strip().upper()[:40],
                reason=unknown.fact,
            )
            told = self.touches(line)
            if target is None:
                self.lose_names(line, match["path"], told)
            else:
                name, steps = self.covered
                self.lose(line, name, steps, told)
            self.lose_calls(line, f"{match['path']} {text}", told)
            return
        value = None
        if name in FRAMES and not steps:
            value = self.whole_frame(text)
        if value is None:
            value = self.value_or_lost(text)
        if steps and steps[-1] in FRAME and self.values.peek(name) is None and name not in FRAMES:
            given = (
                self.ask(written(name, ()), "frame") if name not in self.values.local.own else None
            )
            if isinstance(given, Members) and len(steps) == 1:
                self.values.assign(name, (), given)
        self.store(line, name, steps, value, text)

    def whole_frame(self, text: str) -> Any:
        """The frame where a text is a path and no more, by its name if only the controller knows it; else None."""
        try:
            found = expression(text)
            if not isinstance(found, Place) or found.name.lower() == "$nullframe":
                return None
            return self.frame_value(*self.path(found))
        except Unknown:
            return None

    def touches(self, line: int) -> Why:
        return (
            "programs.krl.touched",
            "line {line} may change it, and what it does is not known",
            {"line": line},
        )

    def run(self, statements: Rows) -> None:
        first, name = self.divide(statements, self.home)
        for stem, home in self.homes.items():
            if stem in home.routines:
                self.home.routines.setdefault(stem, home.routines[stem])
        if first:
            self.values.local = Scope(first.own, first.kinds)
            try:
                self.routine(first)
            except Leave:
                return
            except ProgramError:
                if self.overlong() is None:
                    raise
                told = "programs.endless", "an endless {word} is followed once"
                self.problem(self.line, *told, word="GOTO")
                self.gap(self.line)
                return
        if name:
            self.problem(
                statements[-1][0],
                "programs.krl.no_end",
                "the routine has no END; the file may be cut off",
            )

    def statement(self, node: Block) -> None:
        line, text, word = node.line, node.text, node.word
        self.before(node)
        if word == "label" or not node.closed:
            return
        motion = MOTION.match(text)
        if motion:
            self.motion(line, motion.group(1).upper(), motion.group(2))
            return
        match = ASSIGN.match(text)
        if word == "spline":
            self.enter_spline(line, text)
        elif word == "endspline":  # WITH holds within the block
            self.end_spline(line, text)
        elif word in BESIDE or text.lower().startswith("global interrupt"):
            self.run_beside(line, text, word)
        elif word == "goto":
            self.jump(node)
        elif word in ("return", "exit"):
            raise Leave("break" if word == "exit" else word, line, text)
        elif match and word not in ("wait", "struc", "enum"):
            self.assign(match, line)
        elif CALL.match(text):
            self.call(line, text)
        elif not (word in QUIET or declaration(text) or not text.strip("{}()]")):
            self.not_understood(line, text)

    def not_understood(self, line: int, text: str) -> None:
        """A statement of which nothing is known: all that it names may be changed, and the robot moved; the end of
        a block that does not begin here does neither."""
        if text[:40] not in self.missing:
            self.missing.add(text[:40])
            self.problem(
                line,
                "programs.ignored",
                "'{text}' is not understood; it is ignored",
                text=text[:40],
            )
        if word_of(text) in CLOSED or word_of(text) in PARTS:
            return
        told = self.touches(line)
        self.lose_names(line, text, told)
        for name, _ in self.block_saved:  # it may have been the block's end
            self.values.lose(name, told)
        self.spline = None
        self.gap(line)


STATEMENTS = Statements(
    followed=[
        *MOTIONS,
        *(
            one.upper()
            for one in (*OPENING, *CLOSED, *PARTS, *LEAVING, *BESIDE, "spline", "endspline", "bas")
        ),
    ],
    ignored=sorted(one.upper() for one in QUIET | HARMLESS - {"bas"}),
    asked=sorted(one.upper() for one in SYSTEM - QUIET),
)
