"""The robot languages that are read: each is a module or a package's ``reader`` with ``read(path) -> Program``,
registered in ``READERS`` by its suffixes.
"""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json
from ..base.regular_files import open_regular, shown
from ..engine import InputError
from . import force_device as devices, given, left_out
from .problems import LOST, grade, ordered
from .program import MAX_FILE, ProgramError, bytes_of, lines_of, name_of
from .languages.roll import lay
from .languages.side_files import side_files as side_files
from .languages import speeds

if TYPE_CHECKING:
    from .program import Problem, Program

values_beside, check_values = given.beside, given.parsed


@dataclass(frozen=True)
class Reader:
    """A language by the name of its package or module, imported when a program of it is read; ``takes``: what a
    person may give it."""

    name: str
    takes: str = ""  # "variables"; "units" of length where the file does not say them

    def __call__(self, path: Path, known: Mapping[str, Any] | None = None) -> Program:
        """The Program of a file; ``known``: what ``given`` has read."""
        module = import_module(f"{__package__}.languages.{self.name}")
        if hasattr(module, "__path__"):
            module = import_module(f"{module.__name__}.reader")
        given_to = (known[self.takes],) if known and self.takes else ()
        program: Program = module.read(path, *given_to)
        return program


_LANGUAGES = {
    Reader("krl", "variables"): (".src",),
    Reader("csv"): (".csv",),
    Reader("rapid", "variables"): (".mod", ".modx", ".prg", ".sys"),
    Reader("urscript"): (".script",),
    Reader("fanuc", "variables"): (".ls",),
    Reader("inform", "variables"): (".jbi",),
    Reader("apt", "units"): (".apt", ".aptsource", ".ncl", ".cls", ".cl"),
    Reader("val3"): (".pgx", ".dtx"),
    Reader("urp"): (".urp",),
    Reader("kawasaki", "variables"): (".as", ".pg"),
    Reader("gcode", "units"): (".nc", ".ngc", ".gcode", ".mpf", ".spf", ".tap"),
    Reader("klartext"): (".h",),
}
READERS = {suffix: reader for reader, suffixes in _LANGUAGES.items() for suffix in suffixes}


# Files that hold what a program of the other suffix uses: nothing in them moves the robot.
DATA_OF = {".dat": ".src", ".pjx": ".pgx", ".pgf": ".mod", ".lsb": ".src", ".xfu": ".pgx"}


def told_problems(program: Program, speed_mm_s: float | None) -> list[Problem]:
    """The Problems of a Program as ``languages.speeds.told`` gives them, what matters most to the path first."""
    return ordered(speeds.told(program, speed_mm_s))


def file_pattern() -> str:
    """What a file dialog shows: "*.src *.csv ..."; suffixes in upper case as well."""
    return " ".join(f"*{s} *{s.upper()}" for s in sorted(READERS))


@contextlib.contextmanager
def _no_collection() -> Iterator[None]:
    """Reading makes many objects that stay and hardly a cycle: looking for garbage all the while
    takes a third of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def read_program(
    path: Path | str,
    roll: str | None = None,
    roll_direction: Sequence[float] | None = None,
    values: Json | Path | str | None = None,
    units: str | None = None,
    force_device: devices.Given = None,
) -> Program:
    """The Program in the file ``path``, its language told by the suffix. Raises ProgramError.

    ``roll``, ``roll_direction``: how poses with a free roll are turned (``languages.roll.lay``).
    ``values``: what only the controller knows (``given``), as the content of a values file (a dict) or as
    its file; without it NAME.values.json beside the program, where there is one. ``units``: "mm" or "inch" of a
    file that does not say it, before that of the values. ``force_device``: whose statements set the pressing force
    (``force_device.device_of``); None: the forces are those that the language itself has.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None and path.suffix.lower() in DATA_OF:
        raise ProgramError(
            "programs.data_only",
            "{file}: holds data, no motion; give {program} instead",
            file=shown(path),
            program=shown(path.stem + DATA_OF[path.suffix.lower()]),
        )
    if reader is None:
        raise ProgramError(
            "programs.unknown_suffix",
            "{file}: no robot language is known by '{suffix}'; known: {known}",
            file=shown(path),
            suffix=shown(path.suffix),
            known=", ".join(sorted(READERS)),
        )
    try:
        open_regular(path, MAX_FILE).close()  # before anything looks at what lies beside it
    except InputError as error:
        raise ProgramError.of(error) from None
    known: dict[str, Any] | None
    if isinstance(values, Mapping):
        side = Path(f"{path.name}: values")
        known = given.parsed(values, shown(side.name))
    else:
        side = Path(values) if values else given.beside(path)
        known = given.load(side) if values or os.path.isfile(side) else None
    if units:
        known = {**(known or given.parsed({}, "")), "units": units}
    with _no_collection(), devices.reading(devices.device_of(force_device)):
        try:
            program = reader(path, known)
        except RecursionError:
            nested = ProgramError("programs.nested_calls", "calls are nested too deeply")
            raise nested.within("programs.in_file", "{file}: ", file=name_of(path)) from None
        if known:
            given.apply(program, known, shown(side.name))
        lay(program, roll, roll_direction)
    if program.left_out and path.suffix.lower() in left_out.WORDS:
        text = bytes_of(path, program.language).decode("latin-1")
        program.lost += left_out.more(program, path.suffix.lower(), lines_of(text, program.file))
    if not program.motions and all(grade(problem) != LOST for problem in program.problems):
        program.problem(
            program.file,
            1,
            "programs.no_motion",
            "no instruction of the program moves the robot; give the file that commands the motions",
        )
    return program
