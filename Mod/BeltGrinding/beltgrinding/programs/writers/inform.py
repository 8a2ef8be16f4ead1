"""Yaskawa INFORM jobs as text (.jbi). After Yaskawa's operator's manuals, "Job Data Format"."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.frames import to_abc
from ..force_device import INFORM
from ..patch.text import decimal
from ..program import ProgramError
from . import pressing
from .frames import check_all_set, frame_number, undeclared
from .text import identifier, remarks, rounded

if TYPE_CHECKING:
    from .sheet import Sheet

NAME = 32  # characters of a job's name
REMARK = 32
PTP = "VJ=10.00"  # percent
UNNAMED = 1  # number of the user frame and the tool that nobody has named


def text(sheet: Sheet) -> bytes:
    """The bytes of a .jbi file."""
    sheet.refuse_held(INFORM)
    if any(step.kind == "CIRC" for step in sheet.steps):
        raise ProgramError(
            "programs.writers.no_arcs",
            "arcs are not written as {language}: write KRL, RAPID or Fanuc TP, or the arcs as lines",
            language=INFORM,
        )
    for frames in (sheet.bases, sheet.tools):
        check_all_set(frames, INFORM)
    numbers: dict[str, list[int]] = {"base": [], "tool": []}
    heads = []
    for frame in (*sheet.bases, *sheet.tools):
        number = UNNAMED if frame.left_out else frame_number(frame, INFORM)
        if frame.left_out:
            name = f"{'USER' if frame.what == 'base' else 'TOOL'} {number}"
            sheet.notes.append(undeclared(frame, name))
            heads += remarks(f"{name} must be: {frame.told}", REMARK)
        numbers[frame.what].append(number)
    sheet.notes.append(sheet.posture())
    frames_of = sheet.frames_of()
    lines = ["/JOB", f"//NAME {identifier(sheet.name, NAME).upper()}", "//POS"]
    lines.append(f"///NPOS {len(sheet.frames)},0,0,0,0,0")
    before = None
    for k, pose in enumerate(sheet.frames):
        base, tool = frames_of[k]
        if before != (base, tool):
            before = base, tool
            lines += [f"///USER {numbers['base'][base]}", f"///TOOL {numbers['tool'][tool]}"]
            lines += ["///POSTYPE USER", "///RECTAN", "///RCONF 0,0,0,0,0,0,0,0"]
        at = rounded(pose[:3, 3], sheet.digits.mm).tolist()
        turn = rounded(to_abc(pose), sheet.digits.degree).tolist()[::-1]
        values = [f"{v:.{sheet.digits.mm}f}" for v in at]
        values += [f"{v:.{sheet.digits.degree}f}" for v in turn]
        lines.append(f"C{k:05d}={','.join(values)}")
    lines += ["//INST", "///DATE 2000/01/01 00:00", "///ATTR SC,RW,RJ"]
    lines += [f"////FRAME USER {numbers['base'][0]}", "///GROUP1 RB1", "NOP"]
    for comment in sheet.comments:
        heads += remarks(comment, REMARK)
    lines += [f"'{one}" for one in heads]
    pressed = pressing.before(sheet, INFORM, "'")
    for k, (step, head) in enumerate(zip(sheet.steps, pressed)):
        lines += [f"'{one}" for one in remarks(step.note, REMARK)]
        lines += [head] if head else []
        zone = sheet.blend_mm if step.zone is None else step.zone
        stops = zone == 0.0 or k + 1 == len(sheet.steps)
        level = "PL=0" if stops or (step.kind == "PTP" and step.zone is None) else "PL=1"
        if step.kind == "PTP":
            lines.append(f"MOVJ C{step.pose:05d} {PTP} {level}")
        else:
            speed = decimal(sheet.speed_of(step), sheet.digits.speed, 1)
            lines.append(f"MOVL C{step.pose:05d} V={speed} {level}")
    return "\r\n".join([*lines, "END", ""]).encode("ascii")
