"""The robot languages that are read: each is one module with ``read(path) -> Program``, registered in
``READERS`` by its suffix.
"""

import contextlib
import gc
import os
from pathlib import Path

from ..base.regular_files import open_regular, shown
from ..engine import InputError
from . import given
from .given import beside as values_beside  # noqa: F401
from .given import parsed as check_values  # noqa: F401
from .program import MAX_FILE, ProgramError
from .readers.roll import lay
from .readers.side_files import side_files  # noqa: F401
from .readers.speeds import told as told_problems  # noqa: F401


def _krl(path, values=None):
    from .readers.krl import reader as krl

    return krl.read(path, values)


def _csv(path):
    from .readers import csv as csv_program

    return csv_program.read(path)


def _rapid(path, values=None):
    from .readers.rapid import reader as rapid

    return rapid.read(path, values)


def _urscript(path):
    from .readers.urscript import reader as urscript

    return urscript.read(path)


def _apt(path):
    from .readers import apt

    return apt.read(path)


def _gcode(path):
    from .readers import gcode

    return gcode.read(path)


def _fanuc(path, values=None):
    from .readers.fanuc import reader as fanuc

    return fanuc.read(path, values)


def _inform(path):
    from .readers.inform import reader as inform

    return inform.read(path)


def _val3(path):
    from .readers.val3 import reader as val3

    return val3.read(path)


def _urp(path):
    from .readers.urp import reader as urp

    return urp.read(path)


READERS = {
    ".src": _krl,
    ".csv": _csv,
    ".mod": _rapid,
    ".modx": _rapid,
    ".prg": _rapid,
    ".sys": _rapid,
    ".script": _urscript,
    ".ls": _fanuc,
    ".jbi": _inform,
    ".apt": _apt,
    ".cls": _apt,
    ".cl": _apt,
    ".pgx": _val3,
    ".dtx": _val3,
    ".urp": _urp,
    ".nc": _gcode,
    ".ngc": _gcode,
    ".gcode": _gcode,
    ".mpf": _gcode,
    ".tap": _gcode,
}


WITH_VARIABLES = (_krl, _fanuc, _rapid)  # which take variables that a person gives


def file_pattern():
    """What a file dialog shows: "*.src *.csv ..."; suffixes in upper case as well."""
    return " ".join(f"*{s} *{s.upper()}" for s in sorted(READERS))


@contextlib.contextmanager
def _no_collection():
    """Reading makes many objects that stay and hardly a cycle: looking for garbage all the while
    takes a third of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def read_program(path, roll=None, roll_direction=None, values=None):
    """The Program in the file ``path``, its language told by the suffix. Raises ProgramError.

    ``roll``, ``roll_direction``: how poses with a free roll are turned (``readers.roll.lay``).
    ``values``: what only the controller knows (``given``), as the content of a values file (a dict) or as
    its file; without it NAME.values.json beside the program, where there is one.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        known = ", ".join(sorted(READERS))
        raise ProgramError(
            "programs.unknown_suffix",
            "{file}: no robot language is known by '{suffix}'; known: {known}",
            file=shown(path),
            suffix=shown(path.suffix),
            known=known,
        )
    try:
        open_regular(path, MAX_FILE).close()  # before anything looks at what lies beside it
    except InputError as error:
        raise ProgramError.of(error) from None
    if isinstance(values, dict):
        side = Path(f"{path.name}: values")
        known = given.parsed(values, shown(side.name))
    else:
        side = Path(values) if values else given.beside(path)
        known = given.load(side) if values or os.path.isfile(side) else None
    with _no_collection():
        if known and reader in WITH_VARIABLES:
            program = reader(path, known["variables"])
        else:
            program = reader(path)
        if known:
            given.apply(program, known, shown(side.name))
        lay(program, roll, roll_direction)
    if not program.motions and not program.problems:
        program.problem(
            program.file,
            1,
            "programs.no_motion",
            "no instruction of the program moves the robot; there is no pose to read",
        )
    return program
