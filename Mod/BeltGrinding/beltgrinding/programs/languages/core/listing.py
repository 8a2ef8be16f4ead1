"""The way through a program by the index of its statements, as the controls of machine tools go it.

A jump may lead to any of them, into a loop or out of a branch, and a block whose end is missing is a statement
like others: there is no tree (``flow``) of such a program.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Optional, TypeVar

from ...program import LOOPED, Program, Unknown, work_of
from .beside import near
from .flow import Working

DEEPEST = 20  # subprograms in each other
END, RETURN = -1, -2  # in place of the index of the next statement


class Unit:
    """A program of a file: its statements ``lines[begin:end]``, texts."""

    def __init__(self, file: str, lines: list[str], begin: int = 0, end: int | None = None) -> None:
        self.file, self.lines, self.begin = file, lines, begin
        self.end = len(lines) if end is None else end

    def number(self, at: int) -> int:
        """The line of a statement in the file."""
        return at + 1

    @property
    def work(self) -> int:
        return sum(map(work_of, self.lines[self.begin : self.end]))


U = TypeVar("U", bound=Unit)


class Listing(Working):
    """Follows the statements of Units. ``step(at, text)``, which a language adds, follows one and gives the index of
    the next, None (the one behind it), END or RETURN. ``program``, ``problem``, ``file`` are the reader's.
    """

    program: Program
    file: str
    unit: Any  # Unit that is followed
    inside: Optional[int] = None  # the line of the call that motions of another file stand at
    depth = 0
    repeated = False  # statements come again

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.others: dict[str, Any] = {}  # Units by name, None: there is none

    def step(self, at: int, text: str) -> int | None:
        raise NotImplementedError

    def follow(self, unit: Unit, at: int, end: int | None = None) -> int:
        """Follows a Unit from a statement on; END, or RETURN to who called. Of a part of it, to before ``end``, that
        index where it comes to it. Raises Unknown for a jump out of a part."""
        before, own = getattr(self, "unit", unit), self.file
        self.unit, self.file = unit, unit.file
        begin, last = at, unit.end if end is None else end
        lines = unit.lines
        try:
            while at < last:
                text = lines[at]
                self.tick(unit.number(at), work_of(text) if self.repeated else 0)
                following = self.step(at, text)
                if following is None:
                    at += 1
                elif following < 0:
                    return following
                else:
                    if following <= at:
                        self.repeat(unit)
                    at = following
                    if end is not None and not begin <= at <= end:
                        raise Unknown(
                            "programs.gcode.out_of_part",
                            "a jump leads out of the part that is repeated",
                        )
            return RETURN if end is None else last
        finally:
            self.unit, self.file = before, own

    def repeat(self, unit: Unit) -> None:
        """From here on statements come again: what they cost is counted."""
        if not self.repeated:
            self.repeated, self.rounds = True, -LOOPED * unit.work

    def routine(self, line: int, unit: Unit, at: int) -> int:
        """Follows a subprogram that is called in a line; END, or RETURN. Raises Unknown."""
        if self.depth >= DEEPEST:
            raise Unknown(
                "programs.gcode.deep_calls",
                "subprograms call each other more than {most} deep",
                most=DEEPEST,
            )
        self.repeat(self.unit)
        inside = self.inside
        if unit.file != self.program.file and inside is None:
            self.inside = line
        self.depth += 1
        try:
            return self.follow(unit, at)
        finally:
            self.depth -= 1
            self.inside = inside

    def beside(self, name: str, suffixes: Sequence[str], load: Callable[[Path], U | None]) -> U:
        """The Unit of a program beside this one. Raises Unknown."""
        if name not in self.others:
            path = near(self.path, suffixes).get(name.upper())
            self.others[name] = unit = path and load(path)
            if unit:
                self.rounds -= LOOPED * unit.work
        found: U | None = self.others[name]
        if found is None:
            raise no_subprogram(name)
        return found


def no_subprogram(name: str) -> Unknown:
    return Unknown(
        "programs.gcode.no_subprogram",
        "the subprogram {name} is neither in the file nor beside it",
        name=name,
    )
