"""Other RAPID modules in a program's folder: what they declare for all, and what is theirs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...program import ProgramError, name_of
from ..core.tree import Node
from .text import tree

SUFFIXES = (".mod", ".modx", ".sys")
MAX_MODULES = 100
MAX_BYTES = 16 << 20  # of all of them
LISTED = re.compile(r"<Module>\s*([^<]+?)\s*</Module>", re.IGNORECASE)
LOCAL = re.compile(r"\s*LOCAL\b", re.IGNORECASE)


class Home:
    """Where a routine's statements stand: the file's name, the module's own data, and by name the routines
    and functions that are seen from there."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.data: dict[str, Any] = {}
        self.routines: dict[str, Any] = {}
        self.functions: dict[str, Any] = {}


def others(path: Path) -> list[tuple[str, list[Node]]]:
    """[(file's name, outermost nodes)] of the other modules in the folder of ``path``: those of the .pgf that
    lists it, or all. Damaged ones are left out: what they would have told is reported where it is missed.
    """
    found = []
    for one in _modules(path)[0]:
        try:
            found.append((name_of(one), tree(one)))
        except (ProgramError, OSError, RecursionError):
            continue
    return found


def looked_at(path: Path) -> list[Path]:
    """The files whose content decides what ``others`` gives: the modules, and the .pgf that lists them."""
    found, listing = _modules(path)
    return found + ([listing] if listing else [])


def _modules(path: Path) -> tuple[list[Path], Path | None]:
    """(paths of the other modules, at most ``MAX_MODULES`` of ``MAX_BYTES``; the .pgf that lists them or None)."""
    if not path.parent.is_dir():
        return [], None
    near = sorted(path.parent.glob("*"))
    found: list[Path] = []
    size = 0
    listing, wanted = _listed(path, near)
    for one in near:
        if one.suffix.lower() not in SUFFIXES or one.name.lower() == path.name.lower():
            continue
        if wanted is not None and one.name.lower() not in wanted:
            continue
        try:
            size += one.stat().st_size
        except OSError:
            continue
        if len(found) >= MAX_MODULES or size > MAX_BYTES:
            break
        found.append(one)
    return found, listing


def files(path: Path) -> list[Path]:
    """The files that reading ``path`` may look at."""
    near = sorted(path.parent.glob("*")) if path.parent.is_dir() else []
    return [
        p for p in near if p.suffix.lower() in (*SUFFIXES, ".pgf") and p != path and p.is_file()
    ]


def _listed(path: Path, near: Sequence[Path]) -> tuple[Path | None, set[str] | None]:
    """(the .pgf that names this module, the names in it in lower case); (None, None) without such a file."""
    for one in near:
        if one.suffix.lower() == ".pgf":
            try:
                text = one.read_bytes()[:100_000].decode("latin-1")
            except OSError:
                continue
            names = {
                name.replace("\\", "/").rsplit("/", 1)[-1].lower() for name in LISTED.findall(text)
            }
            if path.name.lower() in names:
                return one, names
    return None, None
