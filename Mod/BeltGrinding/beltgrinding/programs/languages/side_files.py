"""Which files beside a program its reader looks at: the poses depend on them as on the program itself."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .core.beside import called


def side_files(path: Path | str) -> list[Path]:
    """Sorted paths of the files in the folder of the program ``path`` that reading it takes values, data or
    routines from, NAME.values.json aside: of KRL data lists and the modules that it calls, of RAPID the other modules
    and the .pgf that lists them, of VAL3 the application and its user types, of the others the programs that are called. None where
    there is no such folder.
    """
    path = Path(path)
    of_language = _OF.get(path.suffix.lower())
    if of_language is None:
        return []
    try:
        return sorted({p for p in of_language(path) if p != path})
    except (OSError, ValueError):  # a name that no file can have
        return []


def _krl(path: Path) -> list[Path]:
    from .krl import data_lists

    found = called(path, (".src",))
    own = [data_lists.own(one) for one in (path, *found)]
    return [*found, *filter(None, own), *(one for one, _ in data_lists.others(path)[0])]


def _rapid(path: Path) -> list[Path]:
    from .rapid import modules

    return modules.looked_at(path)


def _val3(path: Path) -> list[Path]:
    from .val3.project import Project

    project = Project(path)  # all of the folder is one application
    types = [
        one for file in project.files_of_types.values() for one in (file, file.with_suffix(".pjx"))
    ]
    return [p for suffix in (".pgx", ".dtx", ".pjx") for p in project.of_suffix(suffix)] + types


def _called(*suffixes: str) -> Callable[[Path], list[Path]]:
    return lambda path: called(path, suffixes)


_OF: dict[str, Callable[[Path], list[Path]]] = {".src": _krl, ".pgx": _val3, ".dtx": _val3}
_OF.update(dict.fromkeys((".mod", ".modx", ".prg", ".sys"), _rapid))
_OF.update({".jbi": _called(".jbi"), ".ls": _called(".ls"), ".h": _called(".h")})
_OF.update(dict.fromkeys((".as", ".pg"), _called(".as", ".pg")))
_MILLING = (".mpf", ".spf", ".ngc", ".nc", ".gcode", ".tap")
_OF.update(dict.fromkeys(_MILLING, _called(".spf", ".mpf", ".ngc", ".nc")))
