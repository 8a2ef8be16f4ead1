"""Poses as CSV (docs/programs.md); arcs as chords, splines as lines."""

from ...base.cells import comment_cells
from ...base.frames import to_quaternions
from ..patch.text import decimal
from ..program import _arc
from .text import MM_DIGITS, SPEED_DIGITS, UNIT_DIGITS, rounded

HEAD = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s,force_N,motion"
ROW = ",".join([f"%.{MM_DIGITS}f"] * 3 + [f"%.{UNIT_DIGITS}f"] * 4)


def text(sheet):
    """The bytes of a .csv file."""
    lines = [f"# {comment_cells(comment)}" for comment in sheet.comments]
    for what, frames in (("tool", sheet.tools), ("base", sheet.bases)):
        lines += [f"# {what} {comment_cells(words)}" for _, words in frames]
    lines.append(HEAD)
    positions = rounded(sheet.positions, MM_DIGITS).tolist()
    quaternions = rounded(sheet.quaternions, UNIT_DIGITS).tolist()
    before = None
    for step in sheet.steps:
        speed = "" if step.speed is None else decimal(step.speed, SPEED_DIGITS)
        force = "" if step.force is None else decimal(step.force, SPEED_DIGITS)
        tail = f",{speed},{force},{'PTP' if step.kind == 'PTP' else 'LIN'}"
        if step.note:
            lines.append(f"# {comment_cells(step.note)}")
        if step.kind == "CIRC" and before is not None:
            ends = _arc(*(sheet.frames[k] for k in (before, step.aux, step.pose)))
            for frame in ends[:-1]:
                turn = to_quaternions(frame[None, :3, :3])[0]
                lines.append(ROW % (*frame[:3, 3].tolist(), *turn.tolist()) + tail)
        lines.append(ROW % (*positions[step.pose], *quaternions[step.pose]) + tail)
        before = step.pose
    return "\n".join([*lines, ""]).encode("ascii")
