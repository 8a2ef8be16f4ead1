"""A program as a table of its programmed poses, and in figures."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.cells import cell
from ..base.frames import to_quaternions
from ..base.grouping import grouped
from . import one_frame
from .problems import ordered

if TYPE_CHECKING:
    from .program import Program

COLUMNS = "index,motion,x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_s,force_N,tool,base,file,line".split(
    ","
)
SHOWN = 20  # problems in a summary, or kinds of them


def poses_csv(program: Program) -> str:
    """One row for every programmed pose in program order, an arc's auxiliary point with one of its
    own (motion CIRC-AUX); mm and unit quaternions in the motion's base; joint targets have none.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for index, motion in enumerate(program.motions):
        place = [""] * 7
        if motion.pose is not None:
            turn = to_quaternions(motion.pose[None, :3, :3])[0]
            values = [*motion.pose[:3, 3].tolist(), *turn.tolist()]
            place = [f"{value:.9g}" for value in values]
        numbers = (motion.speed_mm_s, motion.force_N)
        told = ["" if number is None else f"{number:.9g}" for number in numbers]
        kind = f"{motion.kind}-AUX" if motion.aux else motion.kind
        names = [cell(name) for name in (motion.tool, motion.base, motion.file)]
        row = [index, kind, *place, *told, *names, motion.line]
        writer.writerow(row)
    return text.getvalue()


def summary(program: Program, everything: bool = False) -> dict[str, Any]:
    """Language, motions by kind, how many of those in the program are read, frames, extents (mm) and problems,
    those that matter most to the path first, as a dict; problems of a kind as one, unless ``everything`` is asked for.
    """
    moved = program.in_one_frame()
    found = ordered(program.problems)
    read, said = program.counted()
    problems = found if everything else grouped(found)[:SHOWN]
    kinds: dict[str, int] = {}
    gaps = 0
    for motion in program.motions:
        if motion.kind == "GAP":
            gaps += 1
        else:
            kinds[motion.kind] = kinds.get(motion.kind, 0) + 1
    known = sum(motion.pose is not None for motion in moved)
    base, tool = one_frame.reference(program)
    places = [m.pose[:3, 3] for m in program.motions if m.pose is not None]
    extents = None
    if places:
        low, high = np.min(places, axis=0), np.max(places, axis=0)
        extents = {axis: [float(low[k]), float(high[k])] for k, axis in enumerate("xyz")}
    return {
        "language": program.language,
        "file": program.file,
        "motions": len(program.motions) - gaps,
        "gaps": gaps,
        "read": read,
        "in_program": said,
        "poses": len(places),
        "kinds": kinds,
        "bases": sorted({m.base for m in program.motions if m.base}),
        "tools": sorted({m.tool for m in program.motions if m.tool}),
        "read_in": {"base": base, "tool": tool, "poses": known},
        "extents_mm": extents,
        "problems": len(found),
        "first_problems": [str(problem) for problem in problems],
    }
