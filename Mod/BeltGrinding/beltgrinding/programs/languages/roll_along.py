"""The roll that follows a pass: the belt travels along it, either way, and turns round its corners.

The angle of a pose is the mean of the directions within TURNING / 2 before and behind it. A reversal is
no turn, and a step-over between two lines of like direction is none either. Where the angle changes
poses are added, so that the wheel does not twist along the lines between.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...base.stopping import check
from ...base.kinds import Array, Floats, known
from ..program import Motion, _arc, check_count

TURNING = 20.0  # mm of way over which the roll turns round a corner
CORNER = math.radians(45.0)  # between two motions; less is a curve
LIKE = math.radians(30.0)  # directions of the lines on both sides of a step-over
LEAST_TURN = math.radians(1.0)  # less at a corner needs no poses of its own
APART = 0.01  # mm between a pose that is added and one of the program
ACROSS = 0.1  # of a motion's length: a plunge has no direction across the axis


def with_chords(motions: Iterable[Motion]) -> list[Motion]:
    """The motions, arcs with a free roll as chords: along an arc the roll turns all the while."""
    found: list[Motion] = []
    previous: Motion | None = None
    through: Motion | None = None
    for motion in motions:
        if motion.aux and motion.free_roll:
            through = motion
            continue
        if through is not None and previous is not None and motion.pose is not None:
            *chords, last = _arc(known(previous.pose), known(through.pose), motion.pose)
            check_count(len(found) + len(chords), motion)
            for pose in chords:
                found.append(replace(motion, kind="LIN", pose=pose, zone_mm=math.inf))
            motion = replace(motion, kind="LIN", pose=last)
        through = None
        found.append(motion)
        previous = motion if motion.pose is not None else None
    return found


def followed(motions: Sequence[Motion], way: Any, angles: Floats) -> list[Motion]:
    """The motions turned, with those added that hold the roll on the lines.

    ``way``: a ``roll._Way`` of the motions; ``angles``: its ``held()``, for the reversals' sake: a pass
    begins in the way of travel that is nearer to them.
    """
    added: dict[int, list[tuple[float, float]]] = {}
    before: float | None = None
    own = np.array(angles)
    begin = 0
    for first, last in way.passes:
        check()
        course = _Course(way, first, last, angles[first] if before is None else before)
        for k in range(first, last + 1):
            own[k], inserted = course.angle(course.ends[k - first + 1]), course.inserted(k - first)
            added[way.places[k]] = [(share, course.angle(s)) for s, share in inserted]
        start = course.angle(0.0)
        out = way.lengths[begin:first]
        change = begin + int(np.argmax(out)) if len(out) else first
        own[begin:change] = start if before is None else before
        own[change:first] = start
        before, begin = float(own[last]), last + 1
    if before is not None:
        own[begin:] = before
    return _merged(motions, way, own, added)


def _merged(
    motions: Sequence[Motion], way: Any, own: Floats, added: dict[int, list[tuple[float, float]]]
) -> list[Motion]:
    found: list[Motion] = []
    k = 0
    for i, motion in enumerate(motions):
        if k >= len(way.places) or way.places[k] != i:
            found.append(motion)
            continue
        for share, angle in added.get(i, ()):
            z = (1.0 - share) * way.z[k - 1] + share * way.z[k]
            z = way.z[k] if np.linalg.norm(z) < 1e-6 else z / np.linalg.norm(z)
            u = (1.0 - share) * way.u[k - 1] + share * way.u[k]
            u = u - (u @ z) * z
            u = way.u[k] if np.linalg.norm(u) < 1e-6 else u / np.linalg.norm(u)
            at = (1.0 - share) * way.at[k - 1] + share * way.at[k]
            pose = posed(at, z, u, angle)
            found.append(replace(motion, pose=pose, zone_mm=math.inf))
        motion.pose = posed(way.at[k], way.z[k], way.u[k], float(own[k]))
        found.append(motion)
        k += 1
    return found


class _Course:
    """A pass by its length of way, s from 0 at its start, mm: directions of its motions, smoothed."""

    def __init__(self, way: Any, first: int, last: int, near: float) -> None:
        self.lengths = way.lengths[first : last + 1]
        self.ends = np.concatenate([[0.0], np.cumsum(self.lengths)])
        steps = way.steps[first : last + 1]
        self.directions = _unfolded(steps, self.lengths, near)
        turns = np.concatenate([[0.0], np.cumsum(self.directions * self.lengths)])
        self._sum = turns  # of the directions up to the ends
        corners = np.flatnonzero(np.abs(np.diff(self.directions)) > LEAST_TURN) + 1
        around = self.ends[corners][:, None] + 0.5 * TURNING * np.array([-1.0, 1.0])
        self.knots = np.sort(around.ravel())

    def angle(self, s: float) -> float:
        """The smoothed direction at s."""
        low = max(0.0, s - 0.5 * TURNING)
        high = min(float(self.ends[-1]), s + 0.5 * TURNING)
        if high - low < 1e-9:
            return float(self.directions[0])
        a, b = np.interp([low, high], self.ends, self._sum)
        return float(b - a) / (high - low)

    def inserted(self, k: int) -> list[tuple[float, float]]:
        """[(s, share of the motion k)] where poses are added on it."""
        begin, end = self.ends[k], self.ends[k + 1]
        low, high = np.searchsorted(self.knots, [begin + APART, end - APART])
        found: list[tuple[float, float]] = []
        for s in self.knots[low:high].tolist():
            if not found or s > found[-1][0] + APART:
                found.append((s, (s - begin) / (end - begin)))
        return found


def _unfolded(steps: Array, lengths: Floats, near: float) -> Floats:
    """(n,) directions of the motions, angles in the carried frames, without jumps by half turns: on a
    curve they go on, behind a corner the belt travels the way that is nearer; plunges and step-overs
    take those of their neighbours."""
    flat = np.abs(steps) > np.maximum(ACROSS * lengths, 1e-9)
    count = len(steps)
    raw = np.angle(steps)
    lines: list[
        tuple[list[int], list[float]]
    ] = []  # [indices, unwrapped angles] of curves between corners
    for k in np.flatnonzero(flat).tolist():
        if lines and abs(_wrapped(raw[k] - raw[lines[-1][0][-1]])) <= CORNER:
            indices, values = lines[-1]
            values.append(values[-1] + _wrapped(raw[k] - values[-1]))
            indices.append(k)
        else:
            lines.append(([k], [float(raw[k])]))
    if not lines:
        return np.full(count, near)
    sizes = [float(lengths[indices].sum()) for indices, _ in lines]
    directions = np.full(count, np.nan)
    last = near
    skip = _step_overs(lines, sizes)
    for (indices, values), over in zip(lines, skip):
        if over:
            directions[indices] = last
            continue
        turn = math.pi * round((last - values[0]) / math.pi)
        directions[indices] = np.array(values) + turn
        last = values[-1] + turn
    known = np.flatnonzero(~np.isnan(directions))
    at = np.searchsorted(known, np.arange(count), side="right") - 1
    return directions[known[np.maximum(at, 0)]]


def _step_overs(
    lines: Sequence[tuple[list[int], list[float]]], sizes: Sequence[float]
) -> list[bool]:
    """Which of the lines lead over from one to another of like direction, shorter than both."""
    found = [False] * len(lines)
    for k in range(1, len(lines) - 1):
        turn = lines[k + 1][1][0] - lines[k - 1][1][-1]
        like = abs(turn - math.pi * round(turn / math.pi)) <= LIKE
        found[k] = like and not found[k - 1] and sizes[k] < min(sizes[k - 1], sizes[k + 1])
    return found


def _wrapped(angle: float) -> float:
    return cmath.phase(cmath.rect(1.0, angle))


def posed(at: Floats, z: Floats, u: Floats, angle: float) -> Floats:
    """4 x 4 at ``at`` with the axis z, x at ``angle`` from u about it."""
    x = math.cos(angle) * u + math.sin(angle) * np.cross(z, u)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = x, np.cross(z, x), z, at
    return pose
