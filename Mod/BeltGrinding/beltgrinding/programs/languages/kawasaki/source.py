"""The text of a Kawasaki AS file: its programs and the data behind them."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ....base.kinds import known
from ....base.regular_files import shown
from ....base.stopping import check
from ...program import ProgramError, Unknown, bytes_of, lines_of, name_of
from ..core.memory import Data
from ..core import beside
from ..core.poses import Joints, zyz

SUFFIXES = (".as", ".pg")
SECTION = re.compile(r"\s*\.([A-Za-z]\w*)(.*)")
HEAD = re.compile(r"\s*([\w.]+)\s*(?:\(([^)]*)\))?")
COMMENT = re.compile(r'("[^"]*")|;.*')
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?=[\s,;]|$)")
DATUM = re.compile(r"\s*([#$]?[A-Za-z_][\w.]*)\s*(?:\[\s*(\d[\d,\s]*)\])?\s*=?\s*(.*)")
LABEL = re.compile(
    r"(?:(\d+)(?![\w.])|(?!(?:any|value)\b)([A-Za-z_][\w.]*)\s*:(?!=))\s*(.*)", re.IGNORECASE
)
WORD = re.compile(r"[.$#&]*[A-Za-z_][\w.]*(?:/[A-Za-z]+)?")
MOVES = "jmove lmove c1move c2move jappro lappro jdepart ldepart draw tdraw joint linear".split()
LOST = "align drive home home2 hmove xmove cir cir1 cir2".split()
MOVE = re.compile(rf"(?:{'|'.join(MOVES + LOST)})\b(?!\s*=)", re.IGNORECASE)
CALL = re.compile(r"^\s*(?:\d+\s+)?CALL\s+([\w.]+)", re.IGNORECASE | re.MULTILINE)
READS: dict[str, tuple[int, Callable[..., Any]]] = {
    "trans": (6, zyz),
    "joints": (6, lambda *v: Joints(v)),
    "reals": (1, float),
}


class Source:
    """``programs``: {name: (line, rows)}, a row (line, text) without its comment; ``parameters``: {name: names};
    ``data``: {name: {indices: value}}. Names are in lower case. Raises ProgramError where no program is in it.
    """

    def __init__(self, path: Path | str, data: Data | None = None) -> None:
        self.path, self.file = Path(path), name_of(path)
        self.programs: dict[str, tuple[int, list[tuple[int, str]]]] = {}
        self.parameters: dict[str, list[str]] = {}
        self.data: Data = {} if data is None else data
        self.others: dict[str, Source | None] = {}
        text = bytes_of(path, "Kawasaki AS").decode("utf-8-sig", errors="replace")
        section = ""
        rows: list[tuple[int, str]] = []
        for line, one in enumerate(lines_of(text, self.file), 1):
            check()
            match = SECTION.match(one)
            word, rest = (match[1].lower(), match[2]) if match else ("", "")
            if word == "end" and not rest.strip(" ;"):
                section = ""
            elif word == "program":
                section, rows = word, self.begin(line, rest)
            elif section == "program":
                one = " ".join(COMMENT.sub(lambda m: m[1] or "", one).split())
                if one:
                    rows.append((line, one))
            elif match:
                section = word
            elif section in READS:
                self.datum(one, *READS[section])
        if not self.programs:
            raise ProgramError(
                "programs.kawasaki.no_program",
                "{file}: holds no .PROGRAM of Kawasaki AS; give the file that commands the motions",
                file=shown(path),
            )

    def begin(self, line: int, text: str) -> list[tuple[int, str]]:
        match = HEAD.match(text)
        rows: list[tuple[int, str]] = []
        if match:
            names = re.findall(r"[.$#\w]+", (match[2] or "").lower())
            self.programs.setdefault(match[1].lower(), (line, rows))
            self.parameters.setdefault(match[1].lower(), names)
        return rows

    def datum(self, text: str, count: int, made: Callable[..., Any]) -> None:
        """A line of a section of data; one that is not understood gives none."""
        match = DATUM.match(text)
        values = [float(one) for one in NUMBER.findall(match[3])] if match else []
        if match and len(values) >= count:
            key = tuple(float(one) for one in (match[2] or "").split(",") if one.strip())
            with contextlib.suppress(Unknown):
                self.data.setdefault(match[1].lower(), {}).setdefault(key, made(*values[:count]))

    def rows(self, name: str) -> Iterator[tuple[int, str, str]]:
        """(line, word, text) of a program's statements; labels are statements of their own, ANY is "default"."""
        for line, text in known(self.find(name)).programs[name][1]:
            label = LABEL.match(text)
            if label:
                yield line, "label", (label[1] or label[2]).lower()
                text = label[3]
                if not text:
                    continue
            first = WORD.match(text)
            word = (first[0] if first else text[:1]).lower()
            word = {"any": "default"}.get(word, word)
            if word == "if" and re.search(r"\bgo\s?to\b", text, re.IGNORECASE):
                word = "goto"
            yield line, word, text

    def start(self) -> str:
        """The name of the program that reading begins with: that of the file, MAIN, or the first that no other calls."""
        called = {}
        for name, (_, rows) in self.programs.items():
            called[name] = {one.lower() for _, text in rows for one in CALL.findall(text)}
        return beside.first(called, (self.path.stem.lower(), "main"))

    def find(self, name: str) -> Source | None:
        """The Source of a program: this, or the file of its name beside it; None: there is none."""
        if name in self.programs:
            return self
        if name not in self.others:
            self.others[name] = None
            path = beside.near(self.path, SUFFIXES).get(name.upper())
            other = path and Source(path, self.data)
            if other and name in other.programs:
                other.others = self.others
                self.others[name] = other
        return self.others[name]
