"""What milling programs have in common: motions of a tool's tip and axis, and the Problems with them."""

from __future__ import annotations

from collections.abc import Hashable

from ..program import Program, Told
from .tool_axis import Tracer


class Milling:
    """A program that is read, and what of it is not."""

    AGAIN = False  # as ``Tracer.gap`` takes it

    def __init__(self, language: str, name: str) -> None:
        self.program = Program(language, name)
        self.file = name
        self.trace = Tracer(self.program)
        self.inside: int | None = None  # the line of the call that what is read belongs to
        self.repeated = False  # lines come again
        self.told: set[Hashable] = set()
        self.base = self.tool = ""

    def problem(
        self, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        if self.repeated:  # of the rounds of a loop, the first tells it
            key = (self.file, line, told)
            if key in self.told:
                return
            self.told.add(key)
        self.program.problem(self.file, line, told, text, **arguments)

    def once(
        self, key: Hashable, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        """A Problem that many lines have, told of the first."""
        if key not in self.told:
            self.told.add(key)
            self.problem(line, told, text, **arguments)

    def lost(
        self,
        line: int,
        told: Told,
        text: str | None = None,
        /,
        key: Hashable = None,
        **arguments: object,
    ) -> None:
        """A motion is left out; where it ends is kept only as far as its words are known. ``key``: as ``once``'s."""
        if key is None:
            self.problem(line, told, text, **arguments)
        else:
            self.once(key, line, told, text, **arguments)
        self.trace.gap(self.inside or line, self.AGAIN)
