"""The files that a robot program is read with: they go along where it is written elsewhere."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...base.files import cannot_be_written, write_whole
from ...base.regular_files import shown
from ..given import beside as values_beside
from ..languages.side_files import side_files
from ..program import ProgramError, bytes_of, name_of


def own(path: Path) -> list[Path]:
    """Those that are this program's alone: without them it has other poses, or none."""
    named = [one for one in side_files(path) if one.stem.lower() == path.stem.lower()]
    return [one for one in (values_beside(path), *named) if one.is_file()]


def others(path: Path) -> list[Path]:
    """Those of other programs, or of the controller, that its reading may look at."""
    mine = own(path)
    return [one for one in side_files(path) if one not in mine]


def put(files: Iterable[Path], path: Path, output: Path) -> None:
    """Copies what goes along with ``path`` beside ``output``; what is the program's own follows its name. Raises ProgramError
    where another file has a name."""
    mine = own(path)
    for file in files:
        named = output.stem + file.name[len(path.stem) :] if file in mine else file.name
        copy, data = output.with_name(named), bytes_of(file, name_of(file))
        if not copy.exists():
            write(copy, data)
        elif bytes_of(copy, name_of(copy)) != data:
            raise ProgramError(
                "programs.patch.beside_differs",
                "{file}: is there already and differs from {name}",
                file=shown(copy),
                name=name_of(file),
            )


def write(path: Path, data: bytes) -> None:
    """Writes a file whole, its folder too. Raises ProgramError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)
    except OSError as error:
        raise ProgramError.of(cannot_be_written(shown(path), error)) from None
