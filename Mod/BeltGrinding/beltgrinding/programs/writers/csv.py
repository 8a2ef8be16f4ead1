"""Poses as CSV (docs/programs.md); arcs as chords, splines as lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.cells import comment_cells
from ...base.frames import in_words, to_quaternions
from ...base.kinds import known
from ..patch.text import decimal
from ..program import _arc
from .text import rounded, rounded_quaternions

if TYPE_CHECKING:
    from .frames import Frame
    from .sheet import Sheet

FORCE_DIGITS = 6  # and of zones, mm
HEAD = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s,force_N,motion"


def text(sheet: Sheet) -> bytes:
    """The bytes of a .csv file."""
    digits = sheet.digits
    row = ",".join([f"%.{digits.mm}f"] * 3 + [f"%.{digits.unit}f"] * 4)
    lines = [f"# {comment_cells(comment)}" for comment in sheet.comments]
    tool, base = 0, 0
    lines += _told(sheet.tools[0]) + _told(sheet.bases[0])
    zones = any(step.zone is not None for step in sheet.steps)
    lines.append(HEAD + (",zone_mm" if zones else ""))
    positions = rounded(sheet.positions, digits.mm).tolist()
    quaternions = rounded_quaternions(sheet.quaternions, digits.unit).tolist()
    before = None
    for step in sheet.steps:
        speed = "" if step.speed is None else decimal(sheet.speed_of(step), digits.speed)
        force = "" if step.force is None else decimal(step.force, FORCE_DIGITS)
        tail = f",{speed},{force},{'PTP' if step.kind == 'PTP' else 'LIN'}"
        if zones:
            tail += "," if step.zone is None else f",{decimal(step.zone, FORCE_DIGITS)}"
        if step.note:
            lines.append(f"# {comment_cells(step.note)}")
        if step.tool != tool:
            tool = step.tool
            lines += _told(sheet.tools[tool])
        if step.base != base:
            base = step.base
            lines += _told(sheet.bases[base])
        if step.kind == "CIRC" and before is not None:
            ends = _arc(*(sheet.frames[k] for k in (before, known(step.aux), step.pose)))
            for frame in ends[:-1]:
                turn = rounded_quaternions(to_quaternions(frame[None, :3, :3]), digits.unit)[0]
                lines.append(row % (*frame[:3, 3].tolist(), *turn.tolist()) + tail)
        lines.append(row % (*positions[step.pose], *quaternions[step.pose]) + tail)
        before = step.pose
    return "\n".join([*lines, ""]).encode("ascii")


def _told(frame: Frame) -> list[str]:
    """Comments: the frame of the rows that follow. The table itself has none."""
    words = frame.told if frame.name is None else f"{frame.name} ({frame.told})"
    lines = [f"# {frame.what}: {comment_cells(words)}"]
    if frame.given and frame.words:
        lines.append(f"# {frame.what}: {comment_cells(in_words(known(frame.pose)))}")
    return lines
