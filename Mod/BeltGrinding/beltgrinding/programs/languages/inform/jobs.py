"""INFORM jobs as files: their sections, their statements, and the jobs beside one that it calls."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...program import ProgramError, name_of
from ..core.tree import Node
from ..taught import lines_in
from ..taught_program import Row
from .positions import Positions, positions_of

SUFFIXES = (".jbi",)
WORD = re.compile(r"\w*")
BEHIND = re.compile(r"\sIF(?:EXPRESS)?\s")
CONDITIONED = (
    "CALL",
    "RET",
    "END",
    "PAUSE",
    "ABORT",
    "BREAK",
    "CONTINUE",
)  # may have IF behind them


@dataclass
class Job:
    """A job's positions and instructions."""

    file: str
    statements: list[tuple[int, str]]  # line, text
    positions: Positions
    groups: int = 1  # robots and stations that its motions are of
    nodes: list[Node] | None = None  # once it runs

    def rows(self) -> Iterator[Row]:
        """Statements as rows of a tree: labels, and what a condition behind it decides, as blocks."""
        for k, (line, text) in enumerate(self.statements):
            word = known_word(text)
            condition = BEHIND.search(text) if word.upper() in CONDITIONED else None
            if text.startswith("*"):
                yield line, "label", text.split()[0][1:]
            elif condition:
                yield line, "if", text[condition.start() + 1 :]
                yield line, word, text[: condition.start()]
                yield line, "endif", ""
            elif re.match(r"SMOV", text) and self.statements[k + 1][1].startswith("+"):
                yield line, word, f"{text} +MOV"
            else:
                yield line, word, text


def known_word(text: str) -> str:
    """The first word of an instruction in lower case, without the EXP of a condition with an expression."""
    word = WORD.match(text).group().lower()  # type: ignore[union-attr] # matches always
    return word[:-3] if word in ("ifthenexp", "elseifexp", "whileexp") else word


def load(path: Path | str, problem: Callable[..., Any]) -> Job:
    """The Job in a file. Raises ProgramError; ``problem(line, code, form, ...)`` takes notes."""
    file, lines = name_of(path), lines_in(path, "INFORM")
    first = next((k for k, text in enumerate(lines) if text.strip()), 0)
    if not lines[first].strip().upper().startswith("/JOB"):
        raise ProgramError.at(
            file,
            first + 1,
            "programs.inform.no_job",
            "is no INFORM job (it begins without /JOB)",
        )
    section, groups, ended = "", 0, False
    positions: list[tuple[int, str]] = []
    statements: list[tuple[int, str]] = []
    for number, text in enumerate(lines, 1):
        text = text.strip()
        head = re.match(r"//(\w+)", text)
        if head:
            section = head.group(1)
        elif section == "POS" and text:
            positions.append((number, text))
        elif section == "INST" and text.startswith("///GROUP"):
            groups += 1
        elif section == "INST" and text and not text.startswith("/"):
            statements.append((number, text))
            ended = text == "END"
            if ended:
                break
    if not ended:
        # A line cut off in a number looks like a whole one.
        raise ProgramError.at(
            file,
            len(lines),
            "programs.inform.cut",
            "the job is cut, its END is missing; transfer it again",
        )
    return Job(file, statements, positions_of(positions, file, problem), groups)
