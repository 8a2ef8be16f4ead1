"""Forces that a force device sets, written back into a program: its statements, with another number, or more of them.

Which motions a statement governs is looked up in the order of the lines. A program that goes another way round is
found out when what was written is read again (patch.py), and refused.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...base.kinds import known
from ..force_device import FANUC, INFORM, KRL, RAPID, URSCRIPT
from .text import plan

if TYPE_CHECKING:
    from ..force_device import ForceDevice
    from ..program import ProgramError
    from .text import Source, Work

COMMENTS = {KRL: ";", RAPID: "!", URSCRIPT: "#", FANUC: "!", INFORM: "'"}  # their sign
NUMBER = re.compile(r"\s*(\d+)\s*:")  # of a Fanuc line
LINE_COUNT = re.compile(r"\s*LINE_COUNT\s*=\s*(\d+)")
SPLINE = re.compile(r"\s*(END)?SPLINE\b", re.IGNORECASE)


def edit(source: Source, work: Work, device: ForceDevice | None) -> None:
    """Sets the forces that ``work`` asks for by statements of the device; without one, or where the controller's own
    instructions set them, ``work`` stays as it is, and refuses them."""
    language = work.program.language
    if not work.forces or device is None or device.kind == "controller" or language not in COMMENTS:
        return
    work.by_device = True
    work.forces = {line: device.settable(force) for line, force in work.forces.items()}
    statements: list[tuple[int, str]] = []
    inside: dict[int, bool] = {}
    within = False
    for line in range(1, len(source) + 1):
        text = _statement(language, source.line(line))
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

    inserted: list[tuple[int, str]] = []  # (line that each comes before, statement)
    for what, line, force in plan(statements, work.forces, before, refused):
        text = device.statement(language, force)
        if what == "set":
            begin, end = source.span(line)
            own = source.line(line)
            operand = known(device.operand(language, _statement(language, own)))
            at = begin + own.rindex(operand)
            source.replace(at, at + len(operand), known(device.operand(language, text)))
            continue
        if language == RAPID and not text.endswith(";"):
            text += ";"
        if language == KRL:
            text = device.triggered(text, inside[line])
        if language == FANUC:
            inserted.append((line + (what == "after"), text.rstrip("; ")))
        elif what == "before":
            source.insert_before(line, text)
        else:
            source.insert_after(line, text)
    if inserted:
        _insert_numbered(source, inserted)


def _statement(language: str, line: str) -> str:
    """A line without its number and its comment."""
    if language == FANUC:
        line = NUMBER.sub("", line, count=1)
    return line.partition(COMMENTS[language])[0]


def _insert_numbered(source: Source, inserted: Sequence[tuple[int, str]]) -> None:
    """Puts statements into a Fanuc program, whose lines have numbers and are counted in its head."""
    waiting = sorted(inserted, key=lambda one: one[0])
    last = more = 0
    for line in range(1, len(source) + 1):
        begin, text = source.span(line)[0], source.line(line)
        count = LINE_COUNT.match(text)
        if count:
            lines = str(int(count[1]) + len(inserted))
            source.replace(begin + count.start(1), begin + count.end(1), lines)
        number = NUMBER.match(text)
        numbered = number is not None or text.lstrip().startswith("/")  # its end
        while waiting and waiting[0][0] <= line and numbered:
            at = f"{last + more + 1:4d}:"
            source.edits.append((begin, begin, f"{at}{waiting.pop(0)[1]} ;{source.end}"))
            more += 1
        if number is not None:
            last = int(number[1])
            if more:
                source.replace(begin, begin + number.end(), f"{last + more:4d}:")
