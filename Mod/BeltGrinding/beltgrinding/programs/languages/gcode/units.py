"""The text of G-code: its dialect, its comments, where its blocks and subprograms begin and end."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...program import bytes_of, lines_of, name_of
from ..core import listing

COMMENT = re.compile(r"\([^()]*\)|;.*")
STRINGS = re.compile(r"^((?:[^\";]|\"[^\"]*\")*);.*")  # in SINUMERIK brackets are no comments
NUMBERED = re.compile(r"(?:[N:]\s*\d+|O\d+(?!\s*(?:[A-Z\d]|\[)))\s*")
LABEL = re.compile(r"([A-Z_]\w+):(?!=)\s*")
# What only one dialect has, outside of comments.
SIEMENS = re.compile(
    r"^[^;(\n]*?(?:(?<![\w<])(?:TRAORI|GOTO[FBCS]|DEF\s+(?:REAL|INT|BOOL)|ORI(?:WKS|MKS)|CIP|M17|CYCLE8\d\d|A?TRANS|A?ROT|"
    r"R\d+\s*=|(?:[ABC][23]|CR|TURN)\s*=)|=\s*(?:AC|IC|DC)\s*\()|^%_N_\w+_[MS]PF",
    re.MULTILINE,
)
BRACKETS = re.compile(r"^[^;(\n]*?#\s*[\d<\[#]", re.MULTILINE)
OWORDS = (
    "SUB ENDSUB CALL IF ELSEIF ELSE ENDIF WHILE ENDWHILE DO REPEAT ENDREPEAT BREAK CONTINUE RETURN"
).split()
OWORD = re.compile(rf"O\s*(\d+|<[^<>]*>)\s*({'|'.join(OWORDS)})\b\s*(.*)")
LINUXCNC = re.compile(rf"^[ \t]*{OWORD.pattern}", re.MULTILINE)
ARCHIVE = re.compile(r"%_N_(\w+)_([MS]PF)\b")

# Blocks that belong together in SINUMERIK: (what opens, what closes).
_CLOSES = {
    "ENDIF": "IF",
    "ENDWHILE": "WHILE",
    "ENDFOR": "FOR",
    "ENDLOOP": "LOOP",
    "UNTIL": "REPEAT",
}
SIEMENS_BLOCKS = (*_CLOSES, *_CLOSES.values(), "ELSE")
_SIEMENS = re.compile(rf"({'|'.join(SIEMENS_BLOCKS)})\b(.*)")
JUMPS = re.compile(r"\bGOTO[FBCS]?\b")
_LOOP = re.compile(r"(?:WHILE\b.*\bDO|(END))\s*(\d+)$")
_O_CLOSES = {
    "ENDSUB": ("SUB",),
    "ENDIF": ("IF",),
    "ENDWHILE": ("WHILE",),
    "ENDREPEAT": ("REPEAT",),
    "WHILE": ("DO",),
}


def dialect_of(text: str, suffix: str) -> str | None:
    """ "siemens", "linuxcnc", "brackets" (Fanuc and its like, or LinuxCNC) or None, where nothing tells it."""
    if suffix in (".mpf", ".spf"):
        return "siemens"
    if suffix == ".ngc":
        return "linuxcnc"
    upper = text.upper()
    siemens = SIEMENS.search(upper) is not None
    if LINUXCNC.search(upper):
        return None if siemens else "linuxcnc"
    if BRACKETS.search(upper):
        return None if siemens else "brackets"
    return "siemens" if siemens else None


def bare(text: str, dialect: str | None) -> str:
    """A line in capitals, without comments and blanks around."""
    if dialect == "siemens":
        if ";" in text:
            text = STRINGS.sub(r"\1", text)
        text = text.strip()
        if "  " in text or "\t" in text:  # patterns need not look at each blank
            text = " ".join(text.split())
        if text[:1] == "(" and text[-1:] == ")":
            return ""
        return text.upper()
    count = 1 if "(" in text or ";" in text else 0
    for _ in range(10 * count):  # comments within comments
        text, count = COMMENT.subn(" ", text)
        if not count:
            break
    return text.strip().upper()


def unnumbered(text: str) -> str:
    """A bare line without its number and its label."""
    number = NUMBERED.match(text)
    text = text[number.end() :] if number else text
    label = LABEL.match(text) if ":" in text else None
    return text[label.end() :] if label else text


class Unit(listing.Unit):
    """The lines of one file, or of a program in it."""

    def __init__(
        self,
        file: str,
        lines: list[str],
        dialect: str | None,
        begin: int = 0,
        end: int | None = None,
    ) -> None:
        super().__init__(file, lines, begin, end)
        self.dialect = dialect
        self.known = False
        self.labels: dict[str, list[int]] = {}
        self.blocks: dict[int, list[int]] = {}  # the lines that belong to that of an IF or a loop
        self.subs: dict[str, int] = {}
        self.loops: dict[str, list[list[int]]] = {}

    def look(self) -> Unit:
        """Finds, once, labels and what belongs together."""
        if not self.known:
            self.known = True
            stack: list[Any] = []
            for k in range(self.begin, self.end):
                text = bare(self.lines[k], self.dialect)
                if not text:
                    continue
                self._label(k, text)
                self._structure(k, unnumbered(text), stack)
        return self

    def _label(self, k: int, text: str) -> None:
        number = re.match(r"N\s*0*(\d+)", text)
        if number:
            self.labels.setdefault("N" + number[1], []).append(k)
        program = re.match(r"[O:]\s*0*(\d+)(?!\s*(?:[A-Z\d]|\[))", text)
        if program:
            self.subs.setdefault(program[1], k)
        label = LABEL.match(re.sub(r"^N\s*\d+\s*", "", text))
        if label:
            self.labels.setdefault(label[1], []).append(k)

    def _structure(self, k: int, text: str, stack: list[Any]) -> None:
        found = OWORD.match(text)
        if found:
            kind, label = found[2], found[1].replace(" ", "")
            self._place(k, kind, label, stack, _O_CLOSES.get(kind, ()), kind in ("ELSE", "ELSEIF"))
            if kind == "SUB":
                self.subs.setdefault(label, k)
            return
        found = _LOOP.match(text)
        if found:
            kind = "ENDDO" if found[1] else "WHILEDO"
            self._place(k, kind, found[2], stack, ("WHILEDO",) if found[1] else (), False)
            return
        found = _SIEMENS.match(text)
        if not found or self.dialect != "siemens":
            return
        kind = found[1]
        if kind == "IF" and JUMPS.search(text) or kind == "REPEAT" and found[2].strip():
            return
        opened = (_CLOSES[kind],) if kind in _CLOSES else ()
        self._place(k, kind, "", stack, opened, kind == "ELSE")

    def _place(
        self, k: int, kind: str, label: str, stack: list[Any], closes: Sequence[str], middle: bool
    ) -> None:
        if kind in ("CALL", "BREAK", "CONTINUE", "RETURN"):
            return
        top = stack[-1] if stack else None
        if middle:
            if top and top[0] == "IF" and top[1] == label:
                top[2].append(k)
                self.blocks[k] = top[2]
            return
        if top and top[0] in closes and top[1] == label:
            top[2].append(k)
            self.blocks[k] = top[2]
            self.blocks[top[2][0]] = top[2]
            self.loops.setdefault(label, []).append(top[2])
            stack.pop()
        elif kind in ("IF", "WHILE", "FOR", "LOOP", "REPEAT", "SUB", "DO", "WHILEDO"):
            stack.append((kind, label, [k]))

    def around(self, at: int, label: str) -> list[int] | None:
        """The parts of the loop with a label that a line is in; None: in none."""
        for parts in self.loops.get(label, ()):
            if parts[0] < at < parts[-1]:
                return parts
        return None

    def find(self, label: str, line: int, ahead: bool = True, behind: bool = True) -> int | None:
        """The index of the line with a label, seen from an index; None: there is none."""
        places = self.look().labels.get(label, [])
        later = [k for k in places if k > line] if ahead else []
        before = [k for k in places if k <= line] if behind else []
        return later[0] if later else before[-1] if before else None


def load(path: Path | str, language: str = "G-code") -> tuple[Unit, dict[str, Unit], str]:
    """(main Unit, Units in the same file by name, the text)"""
    text = bytes_of(path, language).decode("latin-1")
    lines = lines_of(text, name_of(path))
    dialect = dialect_of(text, Path(path).suffix.lower())
    starts = [
        (k, found[1], found[2])
        for k, line in enumerate(lines)
        if line.startswith("%_N_") and (found := ARCHIVE.match(line.upper()))
    ]
    if len(starts) < 2:
        return Unit(name_of(path), lines, dialect), {}, text
    ends = [k for k, _, _ in starts[1:]] + [len(lines)]
    units = {
        name: Unit(name_of(path), lines, dialect, k, end) for (k, name, _), end in zip(starts, ends)
    }
    main = next((name for _, name, kind in starts if kind == "MPF"), starts[0][1])
    return units[main], units, text
