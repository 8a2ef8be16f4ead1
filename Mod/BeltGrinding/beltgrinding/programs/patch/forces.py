"""Forces that a force device sets, written back into a program: its statements, with another number, or more of them.

Which motions a statement governs is looked up in the order of the lines. A program that goes another way round is
found out when what was written is read again (patch.py), and refused.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...base.kinds import known
from ..force_device import KRL, RAPID, URSCRIPT
from .text import plan

if TYPE_CHECKING:
    from ..force_device import ForceDevice
    from ..program import ProgramError
    from .text import Source, Work

LANGUAGES = {KRL: ";", RAPID: "!", URSCRIPT: "#"}  # the sign of their comments
SPLINE = re.compile(r"\s*(END)?SPLINE\b", re.IGNORECASE)


def edit(source: Source, work: Work, device: ForceDevice | None) -> None:
    """Sets the forces that ``work`` asks for by statements of the device; without one, or in a language whose lines are
    numbered, ``work`` stays as it is, and refuses them."""
    language = work.program.language
    if (
        not work.forces
        or device is None
        or device.kind == "controller"
        or language not in LANGUAGES
    ):
        return
    work.by_device = True
    work.forces = {line: device.settable(force) for line, force in work.forces.items()}
    statements: list[tuple[int, str]] = []
    inside: dict[int, bool] = {}
    within = False
    for line in range(1, len(source) + 1):
        text = source.line(line).partition(LANGUAGES[language])[0]
        spline = SPLINE.match(text) if language == KRL else None
        within = within if spline is None else spline[1] is None
        inside[line] = within
        if device.operand(language, text) is not None:
            statements.append((line, "speed"))
        elif line in work.lines and work.program.motions[work.lines[line][-1]].kind != "PTP":
            statements.append((line, "path"))
    statements.append((0, "end"))

    def before(line: int) -> float | None:
        forces = {work.program.motions[i].force_N for i in work.lines[line]}
        return forces.pop() if len(forces) == 1 else None

    def refused(line: int, *_: object, **__: object) -> ProgramError:
        return work.refuse(
            line,
            "programs.patch.force_after",
            "the force that holds after it is not known here, so it cannot be put back; set the force of the next motion "
            "in the program first",
        )

    for what, line, force in plan(statements, work.forces, before, refused):
        text = device.statement(language, force)
        if what == "set":
            begin, end = source.span(line)
            own = source.line(line)
            operand = known(device.operand(language, own.partition(LANGUAGES[language])[0]))
            at = begin + own.rindex(operand)
            source.replace(at, at + len(operand), known(device.operand(language, text)))
            continue
        if language == RAPID and not text.endswith(";"):
            text += ";"
        if language == KRL:
            text = device.triggered(text, inside[line])
        if what == "before":
            source.insert_before(line, text)
        else:
            source.insert_after(line, text)
