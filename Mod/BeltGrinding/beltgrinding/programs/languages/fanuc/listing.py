"""A Fanuc TP program as a file: its statements, its positions, and where its blocks and labels are."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ...program import ProgramError, name_of
from ..core.tree import Node
from ..taught import lines_in
from ..taught_program import Row
from . import localized
from .positions import Positions, positions_of
from .registers import INDEX

MAX_CONTINUED = 200  # lines of one statement
SUFFIXES = (".ls",)
WORD = re.compile(r"\w*")
LABEL = re.compile(r"LBL\s*\[\s*(\d{1,6})")
THEN = re.compile(r"IF\b(.*)\bTHEN$")
OUTSIDE = (
    r"(?:[^,\[(]|\[(?:[^\[\]]|\[[^\]]*\])*\]|\((?:[^()]|\([^()]*\))*\))"  # no comma but in brackets
)
COMMA = re.compile(rf"IF({OUTSIDE}*),(.*)$")
JUMP = re.compile(rf"\s*JMP\s+LBL\s*{INDEX}$")
IF_JUMP = re.compile(rf"IF({OUTSIDE}*),\s*JMP\s+LBL\s*{INDEX}$")
SIDE = OUTSIDE.replace("^,", "^=,")  # of the first =
SELECT = re.compile(rf"SELECT\s+({SIDE}+)=({OUTSIDE}+),(.*)$")
BRANCH = re.compile(rf"(?:=({OUTSIDE}+)|ELSE),(.*)$")


class Listing:
    """The statements (line, text, whether it ended) and positions of one file.

    Raises ProgramError; ``problem(line, code, form, ...)`` takes notes.
    """

    def __init__(self, path: Path | str, problem: Callable[..., Any]) -> None:
        self.file = name_of(path)
        self.problem = problem
        self.statements: list[tuple[int, str, bool]] = []
        self.continued = 0  # lines of the last one after its first
        self.positions: Positions = {}
        self.nodes: list[Node] | None = None  # once it runs
        self.load(lines_in(path, "TP"))

    def error(self, line: int, code: str, text: str, /, **arguments: object) -> ProgramError:
        return ProgramError.at(self.file, line, code, text, **arguments)

    def load(self, lines: list[str]) -> None:
        """Splits the file into statements and positions."""
        section, begin, ended = "", None, False
        self.german = localized.is_german(lines)
        for number, text in enumerate(lines, 1):
            head = text.strip()
            mark = re.match(r"/(?:PROG|ATTR|APPL|MN|POS|END)\b", head)
            if mark:
                section = mark.group(0)
                if section == "/END":
                    ended = True
                    break
                begin = number if section == "/POS" else begin
            elif section == "/MN" and head:
                self.line_of_mn(number, head)
        if not self.statements and begin is None:
            raise ProgramError(
                "programs.fanuc.no_tp",
                "{file}: is no TP program (it has neither /MN nor /POS)",
                file=self.file,
            )
        if self.statements and not self.statements[-1][2]:
            self.unended(self.statements[-1])
        if not ended:
            self.problem(
                len(lines), "programs.fanuc.no_end", "the file ends without /END; it may be cut"
            )
        if begin is not None:
            end = number - 1 if ended else len(lines)
            self.positions = positions_of(lines[begin:end], begin + 1, self.file, self.problem)

    def line_of_mn(self, number: int, head: str) -> None:
        match = re.match(r"(\d*)\s*:(.*)$", head)
        if not match:
            if head.strip("-; "):
                self.problem(
                    number,
                    "programs.fanuc.no_statement",
                    "'{text}' is no statement; it is left out",
                    text=head[:40],
                )
                self.statements.append((number, "?", True))
            return
        text = match.group(2).strip()
        text = localized.english(text) if self.german else text
        ended = text.endswith(";")
        text = text[:-1].rstrip() if ended else text
        if not match.group(1) and self.statements and not self.statements[-1][2]:
            line, before, _ = self.statements[-1]
            self.continued += 1
            if self.continued > MAX_CONTINUED:
                raise self.error(
                    line, "programs.fanuc.endless_statement", "the statement does not end"
                )
            self.statements[-1] = (line, f"{before} {text}", ended)
            return
        self.continued = 0
        if self.statements and not self.statements[-1][2]:
            self.unended(self.statements[-1])
        self.statements.append((number, text, ended))

    def unended(self, statement: tuple[int, str, bool]) -> None:
        if not statement[1].startswith(("!", "/", "-")):
            raise self.error(
                statement[0], "programs.fanuc.no_semicolon", "the statement does not end with ';'"
            )

    def rows(self) -> Iterator[Row]:
        """Statements as rows of a tree: labels, and what is decided in one line, as blocks."""
        selecting = False
        for line, text, _ in self.statements:
            branch = BRANCH.match(text) if selecting else None
            if selecting and not branch:
                selecting = False
                yield line, "endselect", ""
            if not text or text.startswith(("!", "//", "--")):
                continue
            label, select, comma = LABEL.match(text), SELECT.match(text), COMMA.match(text)
            if branch:
                yield line, *(("case", f"CASE {branch[1]}") if branch[1] else ("default", ""))
                yield from row(line, branch[2])
            elif label:
                yield line, "label", label[1]
            elif select:
                selecting = True
                yield line, "select", f"SELECT {select[1]}"
                yield line, "case", f"CASE {select[2]}"
                yield from row(line, select[3])
            elif comma and not THEN.match(text) and not JUMP.match(comma[2]):
                yield line, "if", f"IF{comma[1]}"
                yield from row(line, comma[2])
                yield line, "endif", ""
            else:
                yield from row(line, text)
        if selecting:
            yield line, "endselect", ""


def row(line: int, text: str) -> Iterator[Row]:
    """The row of a statement that holds no other."""
    text = text.strip()
    word = WORD.match(text).group().lower()  # type: ignore[union-attr] # matches always
    if word == "if" and not THEN.match(text):
        word = "jmp" if IF_JUMP.match(text) else "?"
    elif word in ("else", "endif", "endfor") and text.lower() != word:
        word = "?"
    yield line, word, text
