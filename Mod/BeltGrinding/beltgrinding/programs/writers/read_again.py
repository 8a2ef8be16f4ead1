"""A new program read again: each motion must have its force."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from ..program import ProgramError
from ..registry import read_program

if TYPE_CHECKING:
    from .sheet import Sheet

CLOSE = 2e-3  # N


def check_forces(sheet: Sheet, data: bytes, name: str) -> None:
    """Raises ProgramError where the text ``data`` of a program, read with the sheet's force device, has another force
    than the step that it was made of."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, name)
        file.write_bytes(data)
        program = read_program(file, force_device=sheet.device)
    found = [m for m in program.motions if not m.aux and m.kind != "GAP"]
    for number, (step, motion) in enumerate(zip(sheet.steps, found)):
        if step.force is None or step.kind == "PTP":
            continue
        if motion.force_N is None or abs(motion.force_N - step.force) > CLOSE:
            raise ProgramError(
                "programs.writers.force_read_again",
                "motion {motion}: the force device's statement for {force:g} N is not read back from the {language} "
                "text (line {line}): it may be a comment there, or another statement; change belt_machine.force_device",
                motion=number,
                force=step.force,
                language=program.language,
                line=motion.line,
            )
    if len(found) != len(sheet.steps):
        raise ProgramError(
            "programs.writers.motions_read_again",
            "the written {language} text reads as {found} motions in place of {count}; change belt_machine.force_device",
            language=program.language,
            found=len(found),
            count=len(sheet.steps),
        )
