"""The files that a robot program is read with: they go along where it is written elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from ...base.files import cannot_be_written, write_whole
from ...base.regular_files import shown
from ..given import beside as values_beside
from ..languages.krl.data_lists import others as krl_lists, own as krl_list
from ..languages.rapid import modules as rapid_modules
from ..program import ProgramError, bytes_of, name_of


def own(path: Path, language: str) -> list[Path]:
    """Those that are this program's alone: without them it has other poses, or none."""
    found = [values_beside(path)]
    if language == "KUKA KRL" and (data := krl_list(path)):
        found.append(data)
    return [one for one in found if one.is_file()]


def others(path: Path, language: str) -> Sequence[Path]:
    """Those of other programs, or of the controller, that its reading may look at."""
    if language == "KUKA KRL":
        return [other for other, _ in krl_lists(path)[0]]
    return rapid_modules.files(path) if language == "ABB RAPID" else []


def put(files: Iterable[Path], path: Path, output: Path) -> None:
    """Copies what goes along with ``path`` beside ``output``; what is the program's own follows its name. Raises ProgramError
    where another file has a name."""
    mine = own(path, "KUKA KRL")
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
