"""Yaskawa INFORM jobs as text (.jbi). After Yaskawa's operator's manuals, "Job Data Format"."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.frames import to_abc
from ..force_device import INFORM
from ..patch.text import decimal
from ..program import Joints, Posture, ProgramError
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
    if any(step.posture is None for step in sheet.steps):
        sheet.notes.append(sheet.posture())
    types = _types(sheet)
    frames_of = sheet.frames_of()
    lines = ["/JOB", f"//NAME {identifier(sheet.name, NAME).upper()}", "//POS"]
    lines.append(f"///NPOS {len(sheet.frames)},0,0,0,0,0")
    before = known_type = None
    for k, pose in enumerate(sheet.frames):
        base, tool = frames_of[k]
        if before != (base, tool):
            before, known_type = (base, tool), None
            lines += [f"///USER {numbers['base'][base]}", f"///TOOL {numbers['tool'][tool]}"]
            lines += ["///POSTYPE USER", "///RECTAN"]
        if known_type != types[k]:
            known_type = types[k]
            lines.append(f"///RCONF {known_type}")
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


def _types(sheet: Sheet) -> list[str]:
    """RCONF of each pose: zeros where the posture is not known."""
    found = ["0,0,0,0,0,0,0,0"] * len(sheet.frames)
    for step in sheet.steps:
        if step.posture is not None and step.joints is not None:
            found[step.pose] = ",".join(map(str, rconf(step.posture, step.joints))) + ",0,0"
    return found


def rconf(posture: Posture, joints: Joints) -> tuple[int, ...]:
    """The manipulator type of a position: 1 where the R axis is more than a quarter turn off (no flip), the elbow is below
    the line from shoulder to wrist (lower arm), the wrist is behind axis S (rear), and the axes R, T and S are turned
    beyond half a turn."""
    s, r, t = joints[0], joints[3], joints[5]
    flip = -90.0 < (r + 180.0) % 360.0 - 180.0 <= 90.0
    beyond = [int(not -180.0 < one <= 180.0) for one in (r, t, s)]
    return int(not flip), int(posture.back != posture.behind), int(posture.behind), *beyond
