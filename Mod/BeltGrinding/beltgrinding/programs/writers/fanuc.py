"""Fanuc TP programs as text (.ls). After Fanuc's operator's manuals; remarks have at most 32 characters."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...base.frames import to_abc
from ...base.kinds import known
from ..force_device import FANUC
from ..patch.text import decimal
from ..program import Joints, Posture
from . import pressing
from .frames import check_all_set, frame_number, taken_for_granted
from .text import identifier, remarks, rounded

if TYPE_CHECKING:
    from .sheet import Sheet

NAME = 32  # characters of a program's name
REMARK = 32
PTP = 10  # percent
FRAMES = {"base": "UFRAME_NUM", "tool": "UTOOL_NUM"}


def text(sheet: Sheet) -> bytes:
    """The bytes of a .ls file. The arm's configuration is not known here: it is that of ``CONFIG`` below."""
    sheet.refuse_held(FANUC)
    for frames in (sheet.bases, sheet.tools):
        check_all_set(frames, FANUC)
    left_out = [frame for frame in (sheet.bases[0], sheet.tools[0]) if frame.left_out]
    unknown = any(step.posture is None for step in sheet.steps)
    sheet.notes += [*taken_for_granted(left_out), *([sheet.posture()] if unknown else [])]
    rows = [f"!{one}" for comment in sheet.comments for one in remarks(comment, REMARK - 1)]
    for frame in left_out:
        rows += [f"!{one}" for one in remarks(f"{frame.what}: {frame.told}", REMARK - 1)]
    pressed = pressing.before(sheet, FANUC, "!")
    used = [-1, -1]
    for k, (step, head) in enumerate(zip(sheet.steps, pressed)):
        rows += [f"!{one}" for one in remarks(step.note, REMARK - 1)]
        for side, frame in enumerate((sheet.bases[step.base], sheet.tools[step.tool])):
            now = (step.base, step.tool)[side]
            if used[side] != now and not frame.left_out:
                rows.append(f"{FRAMES[frame.what]}={frame_number(frame, FANUC)}")
            used[side] = now
        rows += [head] if head else []
        zone = sheet.blend_mm if step.zone is None else step.zone
        stops = zone == 0.0 or k + 1 == len(sheet.steps)
        end = "FINE" if stops else f"CNT{round(100.0 * (step.share or 1.0))}"
        if step.kind == "PTP":
            percent = PTP if sheet.joint_percent is None else max(1, round(sheet.joint_percent))
            rows.append(f"J P[{step.pose + 1}] {percent}% {'FINE' if step.zone is None else end}")
            continue
        speed = f"{decimal(sheet.speed_of(step), sheet.digits.speed)}mm/sec {end}"
        if step.kind == "CIRC":
            rows.append(f"C P[{known(step.aux) + 1}]\r\n    :  P[{step.pose + 1}] {speed}")
        else:
            rows.append(f"L P[{step.pose + 1}] {speed}")
    name = identifier(sheet.name, NAME).upper()
    lines = [f"/PROG  {name}", "/ATTR", "OWNER = MNEDITOR;", f"LINE_COUNT = {len(rows)};"]
    lines += ["DEFAULT_GROUP = 1,*,*,*,*;", "/MN"]
    lines += [f"{k:4d}:{row.rstrip('; ')} ;" for k, row in enumerate(rows, 1)]
    frames_of = sheet.frames_of()
    configurations = _configurations(sheet)
    lines.append("/POS")
    for k, pose in enumerate(sheet.frames):
        base, tool = (
            "F" if frame.left_out else frame_number(frame, FANUC)
            for frame in (sheet.bases[frames_of[k][0]], sheet.tools[frames_of[k][1]])
        )
        at = rounded(pose[:3, 3], sheet.digits.mm).tolist()
        turn = rounded(to_abc(pose), sheet.digits.degree).tolist()[::-1]
        lines += [
            f"P[{k + 1}]{{",
            "   GP1:",
            f"    UF : {base}, UT : {tool},    CONFIG : '{configurations[k]}',",
            "    "
            + ",  ".join(f"{n} = {v:.{sheet.digits.mm}f}  mm" for n, v in zip("XYZ", at))
            + ",",
            "    "
            + ",  ".join(f"{n} = {v:.{sheet.digits.degree}f} deg" for n, v in zip("WPR", turn)),
            "};",
        ]
    return "\r\n".join([*lines, "/END", ""]).encode("ascii")


def _configurations(sheet: Sheet) -> list[str]:
    """CONFIG of each pose: the first of the language where the posture is not known."""
    found = ["N U T, 0, 0, 0"] * len(sheet.frames)
    for step in sheet.steps:
        if step.posture is not None and step.joints is not None:
            found[step.pose] = config(step.posture, step.joints)
    return found


def config(posture: Posture, joints: Joints) -> str:
    """F where axis 5 is at a positive angle (flip), else N; U where the elbow is up; T where the wrist is before axis 1,
    else B; then the whole turns of axes 1, 4 and 6 beyond half a turn."""
    letters = (
        "F" if joints[4] > 0.0 else "N",
        "D" if posture.back else "U",
        "B" if posture.behind else "T",
    )
    turns = (math.floor((joints[k] + 180.0) / 360.0) for k in (0, 3, 5))
    return f"{' '.join(letters)}, {', '.join(map(str, turns))}"
