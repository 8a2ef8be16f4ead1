"""What the readers of taught programs (Fanuc TP, Yaskawa INFORM) share: text, numbers, the path."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...base import frames
from ...base.kinds import Floats, known
from ..program import Motion, Program, Reason, bytes_of, lines_of, name_of

LARGEST = 1e6  # mm or degrees; beyond it a number is damaged, not taught
DIGITS = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)"
NUMBER = DIGITS + r"(?![\w.])"
# Words of instructions that are not followed and shift the motions after them, and of those that end it.
SHIFT = re.compile(r"(?<!M)SHIFT|SFT|OFFSET|OFST|TRACK|MIRROR|^SYSTART|^COMARCO", re.IGNORECASE)
SHIFT_ENDS = re.compile(r"END\b|OFF?\b|RESET|CANCEL|STOP", re.IGNORECASE)


def lines_in(path: Path | str, language: str) -> list[str]:
    """Lines of a text file, whatever ends them. Raises ProgramError."""
    # No more than ASCII has meaning; comments come in any code page.
    return lines_of(bytes_of(path, language).decode("latin-1"), name_of(path))


def sound_number(text: str, limit: float = LARGEST) -> float | None:
    """The number that ``text`` is, None where it is none or beyond ``limit``."""
    value = float(text) if re.fullmatch(NUMBER, text, re.ASCII) else math.nan
    return value if abs(value) <= limit else None


def pose_of(components: Sequence[float]) -> Floats:
    """4 x 4 of x, y, z in mm and rotations about fixed x, y, z in degrees: Rz Ry Rx."""
    x, y, z, rx, ry, rz = components
    return frames.from_abc((x, y, z), (rz, ry, rx))


class TaughtPath:
    """Collects motions; arcs of three or more taught points become arcs' halves."""

    program: Program
    here: Any  # where the robot is, None: not known

    def begin_path(self) -> None:
        self.arc: list[Motion] = []  # points of an arc taught one a statement
        self.joined = False  # the first of them is the arc before's last
        self.broken = False  # a point of the arc is not known: how it goes on is neither
        self.displaced: Reason | None = None  # why targets may lie elsewhere than they are taught
        self.call_line: int | None = None  # in the first file, of the call that is followed

    def place(self, line: int) -> int:
        """The line in the first file at which a motion stands: that of the call where another is followed."""
        return line if self.call_line is None else self.call_line

    def may_shift(self, line: int, text: str, maybe: bool = False) -> None:
        """What an instruction that is not followed makes of the targets after it; ``maybe``: it may not run."""
        if not SHIFT.search(text):
            return
        if not SHIFT_ENDS.search(text):
            self.displaced = Reason(
                "programs.may_shift",
                "'{text}' in line {begun} may shift it",
                text=text[:30],
                begun=line,
            )
        elif not maybe:
            self.displaced = None

    def add(self, motion: Motion) -> None:
        """Appends a motion."""
        self.close_arc()
        self.broken = False
        self.program.motions.append(motion)

    def add_arc_point(self, motion: Motion) -> None:
        """Appends one point of an arc taught one point a statement."""
        if self.broken:
            self.program.gap(motion.line, self.program.file, again=False)
            return
        if self.arc and (self.arc[-1].base, self.arc[-1].tool) != (motion.base, motion.tool):
            self.close_arc()
        self.arc.append(motion)

    def break_arc(self) -> None:
        """A point of an arc that may be under way is not known: only the one it begins at is left of it."""
        self.broken = True
        del self.arc[1:]

    def continue_arc(self, motion: Motion) -> None:
        """Begins the next arc at the point just reached."""
        self.arc, self.joined = [motion], True

    def gap(self, line: int) -> None:
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.close_arc()
        self.here = None
        self.program.gap(self.place(line), self.program.file, again=False)

    def close_arc(self) -> None:
        """Ends an arc: its first point is reached on a line, the others along circles through
        three neighbours. Half-way points on the circle keep each point's own orientation."""
        arc, self.arc = self.arc, []
        joined, self.joined = self.joined, False
        for k, motion in enumerate(arc):
            middle = None
            if k == 0 and joined:
                continue
            if k > 0 and len(arc) >= 3:
                third = arc[k + 1] if k + 1 < len(arc) else arc[k - 2]
                middle = _half_way(*(known(m.pose)[:3, 3] for m in (arc[k - 1], motion, third)))
            if middle is None:
                motion.kind = "LIN"
            else:
                pose = known(motion.pose).copy()
                pose[:3, 3] = middle
                aux = Motion("CIRC", pose, motion.line, motion.file, motion.speed_mm_s)
                aux.base, aux.tool, aux.aux = motion.base, motion.tool, True
                motion.kind = "CIRC"
                self.program.motions.append(aux)
            self.program.motions.append(motion)


def _half_way(start: Floats, end: Floats, third: Floats) -> Floats | None:
    """Half-way from start to end on the circle through all three, on the arc without the third
    point; None when they lie on a line."""
    u, v = end - start, third - start
    normal = np.cross(u, v)
    size = float(normal @ normal)
    if size <= 1e-18 * max(float(u @ u), float(v @ v)) ** 2:
        return None
    centre = start + np.cross((u @ u) * v - (v @ v) * u, normal) / (2.0 * size)
    away = -(v - u * float(u @ v) / float(u @ u))
    return centre + away * float(np.linalg.norm(start - centre) / np.linalg.norm(away))
