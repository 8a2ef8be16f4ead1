"""The text of Klartext: its statements and labels."""

from __future__ import annotations

import re
from pathlib import Path

from ...program import bytes_of, lines_of, name_of
from ..core import listing

MAX_JOINED = 200  # lines of a statement
BEGIN = re.compile(r"(?:\d+\s+)?BEGIN\s+PGM\b\s*(.*)")
NUMBER = re.compile(r"\d+\s+(?=\S)|\d+$")
STRINGS = re.compile(r"^((?:[^\";]|\"[^\"]*\")*);.*")


class Unit(listing.Unit):
    """A program's file: its statements, with those that go on joined, and its labels."""

    def __init__(self, path: Path | str) -> None:
        super().__init__(name_of(path), [], -1)
        lines = lines_of(bytes_of(path, "Klartext").decode("latin-1"), self.file)
        self.numbers: list[int] = []
        self.inch: bool | None = None
        self.labels: dict[str, int] = {}
        at = 0
        while at < len(lines):
            line, text = at + 1, _bare(lines[at])
            parts = [text.rstrip("~")]
            while text.endswith("~") and at + 1 < len(lines) and len(parts) < MAX_JOINED:
                at += 1
                text = _bare(lines[at], numbered=False)
                parts.append(text.rstrip("~"))
            at += 1
            text = " ".join(parts).strip() if len(parts) > 1 else parts[0].strip()
            if text:
                self._take(line, text)
        self.end, self.last = len(self.lines), len(lines)

    def number(self, at: int) -> int:
        return self.numbers[at]

    def _take(self, line: int, text: str) -> None:
        if self.begin < 0:
            found = BEGIN.match(text)
            if found:
                self.begin = len(self.lines)
                unit = found[1].split()[-1:] or [""]
                self.inch = {"MM": False, "INCH": True}.get(unit[0])
        found = re.match(r"LBL\s*(\S+)", text)
        if found and found[1] != "0":
            self.labels.setdefault(found[1], len(self.lines))
        self.lines.append(text)
        self.numbers.append(line)


def _bare(text: str, numbered: bool = True) -> str:
    """A line in capitals, without its number, comment and blanks around; ~ stays at its end."""
    goes_on = text.rstrip().endswith("~")
    if ";" in text:
        text = STRINGS.sub(r"\1", text)
    text = text.strip().upper()
    if "  " in text or "\t" in text:  # patterns need not look at each blank
        text = " ".join(text.split())
    if numbered:
        text = NUMBER.sub("", text, count=1) if NUMBER.match(text) else text
    return text if not goes_on or text.endswith("~") else text + "~"
