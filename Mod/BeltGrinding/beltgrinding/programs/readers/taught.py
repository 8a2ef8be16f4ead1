"""What the readers of taught programs (Fanuc TP, Yaskawa INFORM) share: text, numbers, the path."""

import math
import re

import numpy as np

from ...base import frames
from ..program import Fact, Motion, Program, ProgramError, bytes_of, lines_of, name_of

MAX_MOTIONS = 1_000_000
LARGEST = 1e6  # mm or degrees; beyond it a number is damaged, not taught
DIGITS = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)"
NUMBER = DIGITS + r"(?![\w.])"


def lines_in(path, language):
    """Lines of a text file, whatever ends them. Raises ProgramError."""
    # No more than ASCII has meaning; comments come in any code page.
    return lines_of(bytes_of(path, language).decode("latin-1"), name_of(path))


def sound_number(text, limit=LARGEST):
    """The number that ``text`` is, None where it is none or beyond ``limit``."""
    value = float(text) if re.fullmatch(NUMBER, text, re.ASCII) else math.nan
    return value if abs(value) <= limit else None


def pose_of(components):
    """4 x 4 of x, y, z in mm and rotations about fixed x, y, z in degrees: Rz Ry Rx."""
    x, y, z, rx, ry, rz = components
    return frames.from_abc((x, y, z), (rz, ry, rx))


class TaughtPath:
    """Collects a program's motions; arcs of three or more taught points become arcs' halves."""

    def __init__(self, language, path):
        self.file = name_of(path)
        self.program = Program(language, self.file)
        self.run = []  # points of an arc taught one a statement
        self.joined = False  # the first of them is the arc before's last

    def problem(self, line, told, text=None, /, **arguments):
        self.program.problem(self.file, line, told, text, **arguments)

    def add(self, motion):
        """Appends a motion."""
        self.close_arc()
        self._append(motion)

    def add_arc_point(self, motion):
        """Appends one point of an arc taught one point a statement."""
        if self.run and (self.run[-1].base, self.run[-1].tool) != (motion.base, motion.tool):
            self.close_arc()
        self.run.append(motion)

    def continue_arc(self, motion):
        """Begins the next arc at the point just reached."""
        self.run, self.joined = [motion], True

    def gap(self, line):
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.close_arc()
        self.program.gap(line, self.file, again=False)

    def close_arc(self):
        """Ends an arc: its first point is reached on a line, the others along circles through
        three neighbours. Half-way points on the circle keep each point's own orientation."""
        run, self.run = self.run, []
        joined, self.joined = self.joined, False
        for k, motion in enumerate(run):
            middle = None
            if k == 0 and joined:
                continue
            if k > 0 and len(run) >= 3:
                third = run[k + 1] if k + 1 < len(run) else run[k - 2]
                middle = _half_way(*(m.pose[:3, 3] for m in (run[k - 1], motion, third)))
            if middle is None:
                motion.kind = "LIN"
            else:
                aux = Motion("CIRC", motion.pose.copy(), motion.line, self.file, motion.speed_mm_s)
                aux.pose[:3, 3] = middle
                aux.base, aux.tool, aux.aux = motion.base, motion.tool, True
                motion.kind = "CIRC"
                self._append(aux)
            self._append(motion)

    def _append(self, motion):
        if len(self.program.motions) >= MAX_MOTIONS:
            raise ProgramError.at(
                self.file,
                motion.line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )
        self.program.motions.append(motion)


def _half_way(start, end, third):
    """Half-way from start to end on the circle through all three, on the arc without the third
    point; None when they lie on a line."""
    u, v = end - start, third - start
    normal = np.cross(u, v)
    size = float(normal @ normal)
    if size <= 1e-18 * max(u @ u, v @ v) ** 2:
        return None
    centre = start + np.cross((u @ u) * v - (v @ v) * u, normal) / (2.0 * size)
    away = -(v - u * float(u @ v) / float(u @ u))
    return centre + away * float(np.linalg.norm(start - centre) / np.linalg.norm(away))
