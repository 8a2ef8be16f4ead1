"""Robot languages in and out. No FreeCAD and no simulator in here.

What a macro calls; the modules of the package import each other, not this.
"""

from .patch.patch import patch as patch_program
from .program import Motion, Problem, Program, ProgramError
from .registry import READERS, file_pattern, read_program
from .writers.writer import write_program

__all__ = [
    "READERS",
    "Motion",
    "Problem",
    "Program",
    "ProgramError",
    "file_pattern",
    "patch_program",
    "read_program",
    "write_program",
]
