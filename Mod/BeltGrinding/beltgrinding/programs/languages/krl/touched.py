"""What statements may change that may have run, run beside the program, or are not understood: it is not known
behind them."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from typing import NoReturn

from ....base.kinds import known
from ...program import SKIPPED, Unknown, Why
from .parts import Body, Parts
from .blocks import (
    ASSIGN,
    CALL,
    CLOSED,
    LABEL,
    LEAVING,
    LOOPS,
    MOTION,
    NOT_MOVING,
    OPENING,
    PARTS,
    SYSTEM,
    word_of,
)
from .expression import FUNCTIONS, Parser, place
from .flow import FOR
from .settings import NAMES
from .turning import NAMES as TURNING
from .types import declaration
from .values import Scope

CALLED = re.compile(r"(?<![\w$.#])([A-Za-z_]\w*)\s*\(")
TEXTS = re.compile(r'"[^"]*"')
ACTION = re.compile(r"\bDO\s", re.IGNORECASE)
PRIORITY = re.compile(r"\sPRIO\s*=.*", re.IGNORECASE)
BESIDE = ("trigger", "interrupt", "anin", "anout", "signal")  # begin what runs beside the program
BEHIND_ON = re.compile(r"^\w+\s+ON\s+(\$?\w+)", re.IGNORECASE)
SIGNAL = re.compile(r"^SIGNAL\s+(\w+)", re.IGNORECASE)
# Words that begin a statement that neither moves nor changes a variable.
QUIET = set(
    "ext extp extfct extfctp ini import wait halt continue brake resume pulse copen cclose time_block const_vel "
    "defdat enddat channel on confirm struc enum global decl int real bool char frame pos e3pos e6pos axis e3axis "
    "e6axis fdat ldat pdat cwrite swrite".split()
)
STRUCTURE = {*LEAVING, *PARTS, "spline", "endspline"}
# What stands before a bracket and changes nothing.
PASSIVE = {*FUNCTIONS, *(NOT_MOVING - SYSTEM), *Parser.INFIX, *Parser.PREFIX, "to", "step", "then"}


class Blind:
    """An environment in which nothing is known. ``told``: why, as a Reason takes it."""

    def __init__(self, told: Why) -> None:
        self.told = told

    def read(self, place: object) -> NoReturn:
        raise Unknown(self.told)

    function = read


class Touched(Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    def may_set(self, line: int) -> Why:
        """Why something is not known that a statement sets that may have run, as a Reason takes it."""
        return (
            "programs.krl.may_be_set",
            "whether line {line} changes it is decided at run time",
            {"line": line},
        )

    def forget(self, line: int, body: Body, inside: bool = False, quiet: bool = False) -> None:
        """What a block changes that may or may not run is unknown afterwards. ``inside``: it is a loop's, which
        an EXIT in it leaves; ``quiet``: it is told already that it may be left."""
        routine, begin, end = body
        outermost = not self.forgetting
        quiet = quiet or bool(self.called)
        self.forgetting += 1
        try:
            self.tick(line, 1 + routine.work(begin, max(begin, end)) // SKIPPED)
            depth = int(inside)
            for at in range(begin, end):
                line, text = routine.statements[at]
                word = word_of(text)
                depth += (word in LOOPS) - (CLOSED.get(word) in LOOPS)
                if word == "exit" and depth == 0:
                    self.doubt = True
                elif quiet:
                    pass
                elif word == "return":
                    self.may_leave(line, "RETURN")
                elif word == "goto" and (id(routine), at) not in self.forgotten:
                    self.forgotten.add((id(routine), at))
                    self.may_jump(line, text, routine, at)
                self.touch(line, text, word, self.may_set(line))
        finally:
            self.forgetting -= 1
            if outermost:
                self.forgotten.clear()

    def touch(self, line: int, text: str, word: str, told: Why) -> None:
        """Makes unknown what a statement may change; ``told``: why, as a Reason takes it."""
        self.may_set_force(line, text)
        if MOTION.match(text):
            self.here = None
            self.lose_calls(line, text, told)
            return
        if word in BESIDE or text.lower().startswith("global interrupt"):
            self.run_beside(line, text, word)
            return
        match, call = ASSIGN.match(text), CALL.match(text)
        if word in OPENING or word in CLOSED:
            counter = FOR.match(text)
            if counter:
                self.lose(line, counter.group(1).lower(), (), told)
            self.lose_calls(line, text, told)
        elif match:
            self.lose_calls(line, text, told)
            self.lose_target(line, match["path"], told)
        elif call and call.group(1).lower() == "bas":
            self.touch_bas(line, call.group(2).partition(",")[0].strip().lower(), told)
        elif call:
            self.lose_calls(line, text, told)
        elif not (word in QUIET or word in STRUCTURE or LABEL.match(text) or declaration(text)):
            self.lose_names(line, text, told)

    def lose_target(self, line: int, text: str, told: Why) -> None:
        """What an assignment to a path changes where its indices may have changed, too."""
        try:
            target = place(text)
        except Unknown:
            self.lose_names(line, text, told)
            return
        try:
            name, steps = self.path(target, Blind(told))
        except Unknown:
            name, steps = self.covered
        if name in TURNING:
            self.problem(
                line,
                "programs.krl.setting_lost",
                "whether {name} is set here is decided at run time; behind it the program is read as "
                "if it were not set",
                name=name.upper(),
            )
            return
        self.lose(line, "$ipo_mode" if name == "$ipo_frame" else name, steps, told)

    def lose_names(self, line: int, text: str, told: Why) -> None:
        """All variables that a text names."""
        for name in {one.lower() for one in NAMES.findall(TEXTS.sub("", text))}:
            self.lose(line, name, (), told)

    def lose_calls(self, line: int, text: str, told: Why) -> None:
        """What the calls in a statement may change: what they are passed, and what routines of this file do."""
        if "(" not in text:
            return
        text, done = TEXTS.sub('""', text), 0
        names: set[str] = set()
        for match in CALLED.finditer(text):
            name = match.group(1).lower()
            if name in PASSIVE and name not in self.routines:
                continue
            names.add(name)
            if match.start() >= done:  # what is within it is touched with it
                passed = _within(text, match.end())
                done = match.end() + len(passed)
                self.lose_names(line, passed, told)
        for name in sorted(names):
            if name in self.routines:
                self.forget_routine(line, name)
            elif name not in SYSTEM and not self.forgetting:
                self.elsewhere(line, name)

    def forget_routine(self, line: int, name: str) -> None:
        """What a routine of this file may change."""
        if ("routine", name) in self.forgotten:
            return
        routine, outermost = self.routines[name], not self.forgetting
        self.forgotten.add(("routine", name))
        outer, self.values.local = self.values.local, Scope(routine.own, routine.kinds)
        self.called += 1
        doubt = self.doubt
        try:
            with self.at_home(known(routine.home)):
                self.forget(line, (routine, 0, len(routine.statements)), inside=True)
        finally:
            self.values.local, self.doubt = outer, doubt
            self.called -= 1
            if outermost:
                self.forgotten.clear()
        if routine.moves(0, len(routine.statements)) and not self.forgetting:
            self.gap(line)

    def run_beside(self, line: int, text: str, word: str) -> None:
        """An INTERRUPT, a TRIGGER and their like: what they change may be changed at any time from here on."""
        told = (
            "programs.krl.changed_beside",
            "line {line} lets something change it at any time",
            {"line": line},
        )
        signal, on, action = SIGNAL.match(text), BEHIND_ON.match(text), ACTION.search(text)
        if signal:
            self.values.always[signal.group(1).lower()] = told
        elif word in ("anin", "anout"):
            if on:
                self.values.lose_always(on.group(1).lower(), told)
        elif action:
            with self.for_ever():
                self.lose_action(line, PRIORITY.sub("", text[action.end() :]).strip(), word, told)

    @contextlib.contextmanager
    def for_ever(self) -> Iterator[None]:
        outer, self.beside = self.beside, True
        try:
            yield
        finally:
            self.beside = outer

    def lose_action(self, line: int, text: str, word: str, told: Why) -> None:
        match, call = ASSIGN.match(text), CALL.match(text)
        if match:
            self.lose_target(line, match["path"], told)
        name = call.group(1).lower() if call else ""
        routine = self.routines.get(name)
        moves = routine and routine.moves(0, len(routine.statements))
        here = self.here
        self.forgetting += 1  # it does not move the robot here
        try:
            self.lose_calls(line, text, told)
        finally:
            self.forgetting -= 1
            if not self.forgetting:
                self.forgotten.clear()
        self.here = here
        unknown = name and routine is None and name not in NOT_MOVING
        if (moves or unknown) and word != "trigger" and ("beside", name) not in self.missing:
            self.missing.add(("beside", name))
            self.problem(
                line,
                "programs.krl.interrupt",
                "an interrupt may call {name}() at any time; its motions are not in what is read",
                name=name,
            )


def _within(text: str, at: int) -> str:
    """The text from ``at`` to the bracket that closes what is open there."""
    depth = 1
    for k in range(at, len(text)):
        depth += (text[k] == "(") - (text[k] == ")")
        if depth == 0:
            return text[at:k]
    return text[at:]
