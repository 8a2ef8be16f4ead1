"""The data lists (.dat) whose values a KRL module sees: its own, and what others in its folder make global.

A module's own list has its file's name, or tells its name in DEFDAT. Of a list that is PUBLIC all see what is
declared GLOBAL, and of $CONFIG all that is no system variable (KUKA System Software, operating and programming
instructions for system integrators, data lists).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Optional, TypeAlias

from ....base.stopping import check
from ...program import ProgramError, bytes_of, lines_of, name_of

Rows: TypeAlias = list[tuple[int, str]]  # line numbers and statements

MAX_LISTS = 400  # of a folder
MAX_BYTES = 64 << 20  # of all of them
HEAD = re.compile(
    r"^\s*(?:GLOBAL\s+)?DEFDAT\s+([$\w]+)[ \t]*(PUBLIC\b)?", re.IGNORECASE | re.MULTILINE
)
GLOBAL = re.compile(
    r"^(?:(?:DECL|CONST)\s+)*GLOBAL\s+(?:(?:DECL|CONST)\s+)*\w+\s+(.*)$", re.IGNORECASE
)
NAME = re.compile(r"^(?:(?:GLOBAL|DECL|CONST)\s+)*(?:\w+\s+)?([$\w]+)[\w.]*\s*(?:\[[^\]]*\]\s*)?=")


def statements(path: Path | str) -> Rows:
    """(line number, statement) of a KRL file without comments, folds and header lines. Raises ProgramError."""
    return statements_of(bytes_of(path, "KRL").decode("latin-1"), name_of(path))


def statements_of(text: str, name: str) -> Rows:
    """As ``statements``, of a text."""
    result: Rows = []
    for line, text in enumerate(lines_of(text, name), 1):
        check()
        text = re.sub(r'("[^"]*")|;.*', lambda m: m.group(1) or "", text).strip()
        if text and not text.startswith("&"):
            result.append((line, text))
    return result


def own(path: Path) -> Path | None:
    """The list that lies beside a module under its name, or None."""
    return next((p for p in _lists(path) if p.stem.lower() == path.stem.lower()), None)


def others(path: Path) -> tuple[list[tuple[Path, Rows]], bool]:
    """([(path, statements that count)] of the other lists in the folder of a module, the one that is its own by
    DEFDAT last; whether there were more than are read)."""
    found: list[tuple[Path, Rows]] = []
    mine: list[tuple[Path, Rows]] = []
    size, beside = 0, own(path)
    for count, one in enumerate(p for p in _lists(path) if p != beside):
        try:
            data = bytes_of(one, "KRL")
            size += len(data)
            if count >= MAX_LISTS or size > MAX_BYTES:
                return found + mine, True
            text = data.decode("latin-1")
            head = HEAD.search(text)
            if head is None:
                continue
            name = head.group(1).lower()
            if beside is None and name == path.stem.lower():
                mine = [(one, statements_of(text, name_of(one)))]
            elif name == "$config":
                found.append((one, _named(statements_of(text, name_of(one)), None)))
            elif head.group(2):
                rows = statements_of(text, name_of(one))
                shared = _shared(rows)
                if shared:
                    found.append((one, _named(rows, shared)))
        except ProgramError:
            continue  # another module's: what it would have told is reported where it is missed
    return found + mine, False


def _lists(path: Path) -> list[Path]:
    if not path.parent.is_dir():
        return []
    return [p for p in sorted(path.parent.glob("*")) if p.suffix.lower() == ".dat"]


def _shared(rows: Rows) -> set[str]:
    """The names that a list declares GLOBAL, in lower case."""
    names: set[str] = set()
    for _, text in rows:
        match = GLOBAL.match(text)
        if match:
            declared = match.group(1).partition("=")[0]
            names.update(re.findall(r"[$\w]+", re.sub(r"\[[^\]]*\]", "", declared.lower())))
    return names


def _named(rows: Rows, names: Collection[str] | None) -> Rows:
    """The rows that give a value to one of ``names``, or to any (None), system variables left out."""
    found = []
    for row in rows:
        match = NAME.match(row[1])
        name = match.group(1).lower() if match else "$"
        if not name.startswith("$") and (names is None or name in names):
            found.append(row)
    return found
