"""What a reader tells of a program: problems, each once, and gaps."""

from __future__ import annotations

from collections.abc import Hashable

from ...program import Fact, Program, Told


class Telling:
    """Says each thing once, however often a loop comes by."""

    program: Program
    file: str

    def __init__(self) -> None:
        self.said: set[Hashable] = set()

    def problem(
        self,
        line: int,
        told: Told,
        text: str | None = None,
        /,
        once: Hashable = None,
        **arguments: object,
    ) -> None:
        """``once``: what makes two of them the same, beside the place and the words."""
        fact = told if isinstance(told, Fact) else Fact(told, text or "", **arguments)
        if once in self.said or (key := once or (self.file, line, fact)) in self.said:
            return
        self.said.add(key)
        self.program.problem(self.file, line, fact)

    def gap(self, line: int) -> None:
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.program.gap(line, self.file, again=False)
