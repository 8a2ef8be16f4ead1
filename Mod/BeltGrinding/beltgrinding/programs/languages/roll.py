"""The roll of poses of which a program gives the tool's axis only (``Motion.free_roll``): where the
belt's travel, x, points across the axis.

A *pass* is a run of feed motions; it ends at a rapid motion, and at a feed motion that crosses over
between a retract and a plunge along the axis. All angles are measured in frames that the axis' least
rotation from pose to pose carries along: at a constant angle the wheel does not twist, neither at the
poses nor between them, since the robot's interpolation is that rotation (Bishop, There is more than one
way to frame a curve, 1975).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from typing import Any

import numpy as np

from ...base.stopping import check
from ...engine import InputError
from ...base.kinds import Array, Floats
from .. import one_frame
from ..program import Motion, Program, ProgramError
from .roll_along import followed, posed, with_chords

RULES = ("hold", "along", "fixed")
DIRECTED = 0.2  # |sum of l exp(2 i angle)| / sum of l; below, a pass has no direction as a whole
REVERSAL = math.cos(math.radians(105.0))  # between two passes; the belt keeps its way of travel
ALONG_AXIS = math.cos(math.radians(25.0))  # of a retract, of a plunge
LEAST_LIFT = 2.0  # mm of a retract and of a plunge
NO_STEP = 1e-9  # mm
PARALLEL = math.sin(
    math.radians(3.0)
)  # a fixed direction so near to the axis says nothing of the roll


def lay(program: Program, rule: str | None = None, direction: Any = None) -> None:
    """Turns the poses with a free roll of a Program about their axes; None: "hold".

    hold: one angle a pass, along its direction as a whole, the way of travel of the pass before kept;
    changed on the longest motion out of contact. along: the belt follows the pass, either way, and
    turns round corners over ``roll_along.TURNING`` mm: poses are added for it, arcs become chords.
    fixed: x is ``direction`` (3,) in the program's base, projected across each axis.

    Raises ProgramError for a rule without meaning here.
    """
    if rule is not None and rule not in RULES:
        raise _wrong(
            program,
            "programs.roll.unknown",
            "the roll '{rule}' is not known; known: {known}",
            rule=str(rule)[:40],
            known=", ".join(RULES),
        )
    if rule == "fixed":
        direction = np.zeros(3) if direction is None else np.asarray(direction, dtype=float)
        length = float(np.linalg.norm(direction)) if direction.shape == (3,) else math.nan
        if not 1e-9 < length < 1e9:
            raise _wrong(
                program,
                "programs.roll.no_direction",
                "the roll 'fixed' needs a direction x, y, z that is not zero",
            )
        direction = direction / length
    elif direction is not None:
        raise _wrong(
            program,
            "programs.roll.direction_unused",
            "a direction is given, but the roll is not 'fixed'",
        )
    if not any(motion.free_roll for motion in program.motions):
        if rule is not None and any(m.pose is not None for m in program.motions):
            raise _wrong(
                program,
                "programs.roll.not_free",
                "the program gives whole orientations: there is no free roll; leave out the rule",
            )
        return
    if rule == "along":
        program.motions = with_chords(program.motions)
    way = _Way(program.motions)
    if rule == "fixed":
        angles, parallel = way.towards(_in_own_bases(program, way.motions, direction))
        if parallel:
            program.problem(
                program.file,
                way.motions[parallel[0]].line,
                "programs.roll.parallel",
                "the roll's direction is along the tool's axis in {count} poses, here first; the roll is "
                "held there",
                count=len(parallel),
            )
    else:
        angles = way.held()
    if rule == "along":
        program.motions = followed(program.motions, way, angles)
    else:
        way.turn(angles)


def _in_own_bases(program: Program, motions: Sequence[Motion], direction: Floats) -> Floats:
    """(n, 3): a direction in the program's reference base, in the bases of the motions."""
    turns: dict[str, Floats] = {}
    for motion in motions:
        if motion.base not in turns:
            turns[motion.base] = direction @ one_frame.turn_of(program, motion)
    return np.array([turns[motion.base] for motion in motions])


def _wrong(program: Program, code: str, text: str, /, **arguments: object) -> InputError:
    return ProgramError(code, text, **arguments).within(
        "programs.in_file", "{file}: ", file=program.file
    )


class _Way:
    """The poses with a free roll, n of them in program order, and the frames carried along.

    at (n, 3) mm; z, u, v (n, 3): the carried frames; steps (n,) complex: the motion to each pose in
    its frame, u real, mm; lengths (n,) mm; passes: [first, last] motions in contact, ascending.
    """

    def __init__(self, motions: Sequence[Motion]) -> None:
        places = [i for i, m in enumerate(motions) if m.free_roll and m.pose is not None]
        self.places = places
        self.motions = [motions[i] for i in places]
        poses = np.array([m.pose for m in self.motions])
        self.at, self.z = poses[:, :3, 3], poses[:, :3, 2]
        self.u = _carried(self.z, poses[0, :3, 0])
        self.v = np.cross(self.z, self.u)
        delta = np.diff(self.at, axis=0, prepend=self.at[:1])
        self.lengths = np.linalg.norm(delta, axis=1)
        # Half way between the frames of both ends.
        before = np.roll(np.stack([self.u, self.v, self.z]), 1, axis=1)
        mean = 0.5 * (np.stack([self.u, self.v, self.z]) + before)
        across_u, across_v, along = (np.einsum("ij,ij->i", delta, axes) for axes in mean)
        self.steps = across_u + 1j * across_v
        follows = np.diff(np.array(places), prepend=-2) == 1
        self.rapid = np.array([m.kind == "PTP" for m in self.motions]) | ~follows
        # From one frame to another the step is none, and the roll begins anew.
        frames = [(m.base, m.tool) for m in self.motions]
        self.rapid |= np.array([True] + [a != b for a, b in zip(frames, frames[1:])])
        self.rapid |= self._crossing(-along)
        self.passes = _runs(~self.rapid)

    def _crossing(self, lift: Floats) -> Array:
        """Feed motions over from a retract to a plunge; ``lift`` (n,): mm along the axis."""
        crossing = np.zeros(len(lift), dtype=bool)
        steep = (np.abs(lift) > ALONG_AXIS * self.lengths) & (self.lengths > NO_STEP)
        up: Any = None  # [mm of the way up, its last motion]
        for k in range(len(lift)):
            if self.rapid[k]:
                up = None
            elif steep[k]:
                if lift[k] > 0:
                    if up is None or up[1] != k - 1:
                        up = [0.0, k]
                    up = [up[0] + lift[k], k]
                elif up is not None and up[0] >= LEAST_LIFT and k > up[1] + 1:
                    down = k
                    fall = 0.0
                    while down < len(lift) and steep[down] and lift[down] < 0:
                        fall -= lift[down]
                        down += 1
                    if fall >= LEAST_LIFT:
                        crossing[up[1] + 1 : k] = True
                    up = None
                else:
                    up = None
            elif up is not None and up[0] < LEAST_LIFT:
                up = None
        return crossing

    def held(self) -> Floats:
        """(n,) angles in the carried frames, one value a pass."""
        angles = np.empty(len(self.at))
        begin, angle = 0, None
        for first, last in self.passes:
            before, angle = angle, _direction(self.steps[first : last + 1], angle)
            out = self.lengths[begin:first]
            change = begin + int(np.argmax(out)) if len(out) else first
            angles[begin:change] = angle if before is None else before
            angles[change : last + 1] = angle
            begin = last + 1
        if angle is None:  # rapid motions only
            angle = _direction(self.steps, None)
        angles[begin:] = angle
        return angles

    def towards(self, direction: Floats) -> tuple[Floats, list[int]]:
        """((n,) angles of a fixed direction (n, 3), the poses whose axis is along it)."""
        across = (self.u * direction).sum(axis=1) + 1j * (self.v * direction).sum(axis=1)
        parallel = np.flatnonzero(np.abs(across) < PARALLEL)
        angles = np.angle(across)
        good = np.flatnonzero(np.abs(across) >= PARALLEL)
        for k in parallel:
            at = int(np.searchsorted(good, k))
            near = good[max(at - 1, 0)] if len(good) else None
            angles[k] = 0.0 if near is None else angles[near]
        return angles, parallel.tolist()

    def pose(self, k: int, angle: float) -> Floats:
        """4 x 4: the pose k turned."""
        return posed(self.at[k], self.z[k], self.u[k], angle)

    def turn(self, angles: Floats) -> None:
        """Gives the motions their poses."""
        for k, motion in enumerate(self.motions):
            check()
            motion.pose = self.pose(k, float(angles[k]))


def _carried(z: Floats, x: Floats) -> Floats:
    """(n, 3): ``x``, across z[0], carried along the unit vectors z (n, 3) by the least rotation from
    each to the next; where that is a half turn, about what is carried."""
    carried = np.empty_like(z)
    a, u = z[0].tolist(), x.tolist()
    for k, b in enumerate(z.tolist()):
        if b != a:
            check()
            cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
            w = (
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            )
            if 1.0 + cosine > 1e-9:
                along = (u[0] * w[0] + u[1] * w[1] + u[2] * w[2]) / (1.0 + cosine)
                u = [
                    cosine * u[0] + w[1] * u[2] - w[2] * u[1] + along * w[0],
                    cosine * u[1] + w[2] * u[0] - w[0] * u[2] + along * w[1],
                    cosine * u[2] + w[0] * u[1] - w[1] * u[0] + along * w[2],
                ]
            left = u[0] * b[0] + u[1] * b[1] + u[2] * b[2]  # of rounding
            u = [p - left * q for p, q in zip(u, b)]
            length = math.hypot(*u)
            u, a = [p / length for p in u], b
        carried[k] = u
    return carried


def _runs(wanted: Array) -> list[tuple[int, int]]:
    """[first, last] of each run of True in a sequence."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(wanted, dtype=int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2])]


def _direction(steps: Array, before: float | None) -> float:
    """Angle of a pass: of the line along which most of its way lies, in the way of its first long motion,
    or in the other where that would reverse ``before`` (None: the first pass). A pass without such a
    line (a closed contour, a point) keeps ``before``, or begins along its first motion."""
    sizes = np.abs(steps)
    total = float(sizes.sum())
    moving = np.flatnonzero(sizes > NO_STEP)
    if not len(moving):
        return 0.0 if before is None else before
    double = complex((steps[moving] ** 2 / sizes[moving]).sum())
    if abs(double) < DIRECTED * total:
        return cmath.phase(steps[moving[0]]) if before is None else before
    angle = 0.5 * cmath.phase(double)
    ways = (steps[moving] * cmath.exp(-1j * angle)).real
    long = ways[np.abs(ways) >= 0.5 * np.abs(ways).max()]
    angle = angle if long[0] > 0 else angle + math.pi
    reverses = before is not None and math.cos(angle - before) < REVERSAL
    return angle + math.pi if reverses else angle
