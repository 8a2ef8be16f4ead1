"""Other modules (.src) of a KRL program's folder: a module's own routine has its file's name and is seen from
everywhere; its other routines, and the data of its own list, are its own (KUKA System Software, operating and
programming instructions for system integrators, subprograms)."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any

from ...program import ProgramError, name_of
from .values import Scope
from ..core.beside import called
from . import data_lists

MAX_STATEMENTS = 1_000_000  # of all of them


class Home:
    """Where routines stand: the file's name, the Scope of its own data (None: of the module that runs), the
    routines that are seen from there by name."""

    def __init__(self, file: str, scope: Scope | None = None) -> None:
        self.file, self.scope = file, scope
        self.routines: dict[str, Any] = {}  # Routine, which knows its Home


def beside(path: Path) -> list[tuple[Path, data_lists.Rows]]:
    """[(path, statements)] of the modules in the folder of ``path`` that it calls, and those that these call in
    turn. A damaged one is left out: its motions are then told as missing."""
    found: list[tuple[Path, data_lists.Rows]] = []
    size = 0
    for other in called(path, (".src",)):
        with contextlib.suppress(ProgramError):
            rows = data_lists.statements(other)
            size += len(rows)
            if size <= MAX_STATEMENTS:
                found.append((other, rows))
    return sorted(found, key=lambda one: name_of(one[0]))
