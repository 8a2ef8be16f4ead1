"""The outline of a blade's section: its edges and their circles, chord, thicknesses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..base.kinds import Floats
from . import profile

ROUND, SHARP, NOT_ROUND, FEW, OPEN, MISSED = (
    "round",
    "sharp",
    "not_round",
    "few_samples",
    "open",
    "missed",
)
FITTED = (0.1, 0.9)  # of the turning from one flank to the other, on which the circle is fitted
CHOSEN = 3  # times, the points of that: first by the outline's turning, then by the circle
LEAST_POINTS = 7  # of it: with fewer the radius is not told
LEAST_TURN = math.radians(60.0)  # from one flank to the other: less is no edge
DEEPEST = 0.25  # of the chord, at which the flanks begin at the latest
FLANK = 1.5  # times that depth: where the flanks' directions are taken
GROSS = 0.15  # of the radius: a first circle that is further off tells no points
SPAN = (0.7, 1.3)  # of that turning: what an arc turns between its first and last point
OUTLIER = 3.0  # standard deviations from the circle; further points count for less
TO_DEVIATION = 1.4826  # from the median of absolute values, of normal ones
LEAST_SPREAD = 1e-4  # mm
REWEIGHTED = 5  # times
AXIS_ROUNDS = 20
STATIONS = 33  # along the chord, where the largest circle is looked for, finer in each round
FINER = 3
ACROSS = 8  # steps of Newton towards the middle between both sides


End: TypeAlias = (
    "tuple[Floats, float]"  # unit vector out of the part, how long the part is that way, mm
)


@dataclass(frozen=True)
class Nose:
    """The edge of an outline: its tip and, where it is round, its circle."""

    state: str
    tip: Floats  # (2,) mm
    out: Floats  # (2,) unit vector, along the middle line out of the part
    centre: Floats | None = None
    radius: float | None = None
    residual: float | None = None


class Outline:
    """A profile in its plane: (n, 2) mm, open or closed."""

    def __init__(self, points: Floats, closed: bool) -> None:
        self.closed = closed
        keep = np.append(np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9, True)
        self.points = points[keep]
        if closed and np.linalg.norm(self.points[0] - self.points[-1]) > 1e-9:
            self.points = np.concatenate([self.points, self.points[:1]])

    def ends(self) -> list[End]:
        """[(unit vector out of the part, how long the part is that way)] of its edges: two of a closed
        outline, one or none of an open one."""
        p = self.points
        if self.closed:
            a, b = _farthest(p)
            way = p[a] - p[b]
            long = float(np.linalg.norm(way))
            return [(way / long, long), (-way / long, long)]
        middle = 0.5 * (p[0] + p[-1])
        tip = int(np.argmax(np.linalg.norm(p - middle, axis=1)))
        way = p[tip] - middle
        long = float(np.linalg.norm(way))
        if not long > 0.0 or np.linalg.norm(p[0] - p[-1]) > 2.0 * long:
            return []
        return [(way / long, long)]

    def _sides(self, out: Floats) -> tuple[Floats, Floats]:
        """Both ways along the outline from its tip in the direction ``out``: (k, 2) each, tip first."""
        p = self.points[:-1] if self.closed else self.points
        tip = int(np.argmax(p @ out))
        if not self.closed:
            return p[tip:], p[tip::-1]
        turned = np.roll(p, -tip, axis=0)
        half = len(p) // 2 + 1
        return turned[:half], np.concatenate([turned[:1], turned[:0:-1]])[:half]

    def _across(self, out: Floats, depth: float, tip: float) -> tuple[Floats, Floats] | None:
        """Where the line square to ``out``, ``depth`` below ``tip``, meets both sides first."""
        found = []
        for side in self._sides(out):
            below = tip - side @ out
            beyond = np.flatnonzero(below >= depth)
            if not len(beyond) or beyond[0] == 0:
                return None
            k = int(beyond[0])
            share = (depth - below[k - 1]) / (below[k] - below[k - 1])
            found.append((1.0 - share) * side[k - 1] + share * side[k])
        return found[0], found[1]

    def nose(self, out: Floats, long: float) -> Nose:
        """The edge at the end ``out`` of an outline that is ``long`` mm that way."""
        tip = float((self.points @ out).max())
        at = self.points[int(np.argmax(self.points @ out))]
        depth = self._flanks_begin(out, tip, long)
        here, there = (self._across(out, d, tip) for d in (depth, FLANK * depth))
        if here is None or there is None:
            return Nose(OPEN, at, out)
        normals = []
        for way in (there[0] - here[0], here[1] - there[1]):  # both counter-clockwise
            way = way / np.linalg.norm(way)
            normals.append(np.array([way[1], -way[0]]))
        return self._round(at, out, depth, here, normals, tip)

    def _flanks_begin(self, out: Floats, tip: float, long: float) -> float:
        """The depth below the tip, mm, at which the edge is as thick as it is deep."""
        sides = self._sides(out)
        square = np.array([-out[1], out[0]])
        depths = [np.maximum.accumulate(tip - side @ out) for side in sides]
        places = np.unique(np.concatenate(depths))
        places = places[(places > 0.0) & (places <= DEEPEST * long)]
        if not len(places):
            return DEEPEST * long
        one, other = (np.interp(places, depth, side @ square) for depth, side in zip(depths, sides))
        thin = np.flatnonzero(np.abs(one - other) <= places)
        return float(places[thin[0]]) if len(thin) else DEEPEST * long

    def _round(
        self,
        at: Floats,
        out: Floats,
        depth: float,
        here: tuple[Floats, Floats],
        normals: list[Floats],
        tip: float,
    ) -> Nose:
        one, other = self._sides(out)
        inside = [side[tip - side @ out < depth] for side in (one, other)]
        line = np.concatenate([here[1][None], inside[1][:0:-1], inside[0], here[0][None]])
        line = profile.without_loops(line)
        first, last = normals[1], normals[0]
        whole = float(profile.angle(first[None], last[None])[0])
        middle = out if whole > math.pi - 1e-3 else first + last
        middle = middle / np.linalg.norm(middle)
        found = profile.middle(line, first, last, FITTED) if whole > LEAST_TURN else None
        if found is None:
            return Nose(NOT_ROUND, at, middle)
        points: Floats = found
        if not len(points) and len(line) >= 2 * LEAST_POINTS:
            return Nose(SHARP, at, middle, None, 0.0)
        half = 0.5 * (FITTED[1] - FITTED[0]) * whole
        for _ in range(CHOSEN):
            if len(points) < LEAST_POINTS:
                return Nose(FEW, at, middle)
            centre, radius, residual, spread = _robust_circle(points)
            arms = points[[0, -1]] - centre
            spanned = float(profile.angle(arms[:1], arms[1:])[0])
            if spread > GROSS * radius or not SPAN[0] < 0.5 * spanned / half < SPAN[1]:
                return Nose(NOT_ROUND, at, middle, None, None, residual)
            points = line[profile.angle(line - centre, middle[None]) <= half]
        if spread > profile.ROUND * radius:
            return Nose(NOT_ROUND, at, middle, None, None, residual)
        return Nose(ROUND, at, middle, centre, radius, residual)

    def thickness_at(self, nose: Nose, distance: float, long: float) -> float | None:
        """Across the edge's middle line, ``distance`` from its tip, mm; None beyond the middle of the chord, or
        where the outline does not reach. The middle line goes through the middles at half of the distance and at
        all of it."""
        if distance > 0.5 * long:
            return None
        out, across = nose.out, None
        for _ in range(AXIS_ROUNDS):
            tip = _tip(self.points, nose, out)
            half, across = (self._across(out, d, tip) for d in (0.5 * distance, distance))
            if half is None or across is None:
                return None
            way = half[0] + half[1] - across[0] - across[1]
            way = way / np.linalg.norm(way)
            if np.linalg.norm(way - out) < 1e-9:
                break
            out = way
        return None if across is None else float(np.linalg.norm(across[0] - across[1]))

    def chord(self, noses: Sequence[Nose]) -> float:
        """The greatest distance between points, mm; of a round edge its circle's in place of its samples'."""
        circles = [(nose.centre, nose.radius) for nose in noses if nose.centre is not None]
        if not circles:
            a, b = _farthest(self.points)
            return float(np.linalg.norm(self.points[a] - self.points[b]))
        long = sum(radius or 0.0 for _, radius in circles)
        others = circles[1][0] if len(circles) == 2 else self.points
        return long + float(np.linalg.norm(others - circles[0][0], axis=-1).max())

    def greatest_thickness(self) -> float:
        """The diameter of the largest circle inside, mm; its middle is looked for ever finer along the chord."""
        p = self.points[:-1]
        a, b = _farthest(p)
        along = (p[b] - p[a]) / np.linalg.norm(p[b] - p[a])
        turned = np.roll(p, -a, axis=0) @ np.column_stack([along, [-along[1], along[0]]])
        k = (b - a) % len(p)
        sides = (turned[: k + 1], np.concatenate([turned[k:], turned[:1]]))
        low, high = float(turned[0, 0]), float(turned[k, 0])
        best = 0.0
        for _ in range(FINER):
            stations = np.linspace(low, high, STATIONS + 2)[1:-1]
            room = _largest_at(sides, stations)
            best = max(best, float(room.max()))
            low, high = stations[room.argmax()] + np.array([-1, 1]) * (stations[1] - stations[0])
        return 2.0 * best


def _robust_circle(points: Floats) -> tuple[Floats, float, float, float]:
    """As ``profile.circle``, but points far off count for less (Huber); and the root mean square by what they
    count."""
    weights = np.ones(len(points))
    for _ in range(REWEIGHTED):
        centre, radius, residual = profile.circle(points, weights)
        off = np.abs(np.linalg.norm(points - centre, axis=1) - radius)
        limit = OUTLIER * max(TO_DEVIATION * float(np.median(off)), LEAST_SPREAD)
        weights = np.minimum(1.0, limit / np.maximum(off, limit))
    return centre, radius, residual, math.sqrt(float(np.average(off**2, weights=weights)))


def _farthest(p: Floats) -> tuple[int, int]:
    """Numbers of two points of (n, 2) that are as far apart as any: each the farthest from the other, from the
    corners of the box on."""
    found, best = (0, 0), -1.0
    for start in {int(k) for k in (*p.argmin(axis=0), *p.argmax(axis=0))}:
        a, long = start, -1.0
        while True:
            distance = np.linalg.norm(p - p[a], axis=1)
            b = int(np.argmax(distance))
            if distance[b] <= long:
                break
            a, long, last = b, float(distance[b]), a
        if long > best:
            found, best = (last, a), long
    return found


def _tip(points: Floats, nose: Nose, out: Floats) -> float:
    """How far the outline reaches along ``out``: that of the circle where the edge is round."""
    if nose.centre is not None and nose.radius is not None:
        return float(nose.centre @ out) + nose.radius
    return float((points @ out).max())


def _largest_at(sides: tuple[Floats, Floats], stations: Floats) -> Floats:
    """(k,) radius of the largest circle between two sides (n, 2) of an outline, the lower one first, with its
    centre at each first coordinate."""
    low, high = (
        np.interp(stations, np.maximum.accumulate(side[:, 0]), side[:, 1])
        for side in (sides[0], sides[1][::-1])
    )
    y = 0.5 * (low + high)
    for _ in range(ACROSS):  # as far from one side as from the other
        below, above = (_distance(np.column_stack([stations, y]), side) for side in sides)
        y = np.clip(y + 0.5 * (above - below), low, high)
    return np.minimum(below, above)


def _distance(places: Floats, line: Floats) -> Floats:
    """(k,) distance of places (k, 2) from a line (n, 2) of straight pieces."""
    start, way = line[:-1], np.diff(line, axis=0)
    away = places[:, None] - start
    share = np.clip((away * way).sum(axis=2) / (way**2).sum(axis=1), 0.0, 1.0)
    return np.sqrt(((away - share[..., None] * way) ** 2).sum(axis=2).min(axis=1))
