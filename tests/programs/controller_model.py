"""A model of a robot's controller that executes the blocks of a written program (``controller_text``), independent of the
simulation's time law: it lays the way out densely, limits the speed on a fine grid with the look-ahead of its blocks, and
gives the set points of its interpolation cycle.

Rules, after public manuals: a corner is rounded from its zone before the point to its zone behind it, at most half of the
shorter block, with constant acceleration (a parabola); CNT rounds as far as the share of the speed takes; a spline passes
through its points on a smooth curve and is one block; each block but a rounded one ends at rest; the robot must be able
to stop at the end of the last block that it looks ahead to. The force is set when a block begins.
"""

import math
from dataclasses import dataclass

import numpy as np

GRID = 0.004  # mm, between places at which the speed is limited
FINEST = 400  # places of a block at least


@dataclass(frozen=True)
class Sample:
    """What the robot does at a cycle."""

    time: float  # s from the run's begin
    place: np.ndarray  # (3,) mm
    force: float
    block: int  # number in the program


def runs(blocks):
    """[(first, last)]: numbers of blocks between joint motions."""
    found, begin = [], None
    for k, block in enumerate(blocks):
        if block.kind == "joint":
            if begin is not None:
                found.append((begin, k - 1))
            begin = k + 1
    return (
        found + [(begin, len(blocks) - 1)] if begin is not None and begin < len(blocks) else found
    )


def turn_of(a, b):
    """(3,) radians: the rotation from pose a to pose b as a vector."""
    r = b[:3, :3] @ a[:3, :3].T
    axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    sine, cosine = np.linalg.norm(axis) / 2.0, (np.trace(r) - 1.0) / 2.0
    if sine < 1e-12:
        return np.zeros(3)
    return axis / (2.0 * sine) * math.atan2(sine, cosine)


class Run:
    """The blocks ``first`` to ``last`` of a program, from rest to rest."""

    def __init__(self, blocks, first, last, cycle, look_ahead):
        self.blocks, self.first, self.cycle = blocks[first : last + 1], first, cycle
        self.nodes = [blocks[first - 1].pose, *(one.pose for one in self.blocks)]
        self.points = np.array([pose[:3, 3] for pose in self.nodes])
        ways = np.diff(self.points, axis=0)
        self.lengths = np.linalg.norm(ways, axis=1)
        self.directions = ways / self.lengths[:, None]
        turns = [turn_of(a, b) for a, b in zip(self.nodes, self.nodes[1:])]
        self.turns = np.array(turns) / self.lengths[:, None]  # radians a mm
        self.look_ahead = look_ahead
        self.zones = [0.0, *(self._zone(k) for k in range(len(self.blocks) - 1)), 0.0]
        self._lay_out()
        self._limit()

    def _most(self, k):
        """mm/s and mm/s2 of block k; of a spline's without what its turning wants (``_swing``)."""
        block, rate = self.blocks[k], np.linalg.norm(self.turns[k])
        speed, most = block.feed, block.acceleration
        if rate > 0.0 and block.kind != "spline":
            speed = min(speed, math.radians(block.turning) / rate)
            most = min(most, math.radians(block.angular) / rate)
        return speed, most

    def _bend(self, k):
        """s2/mm: what a corner between blocks k and k + 1 takes of zone for the square of a speed."""
        block = self.blocks[k]
        way = np.linalg.norm(self.directions[k + 1] - self.directions[k]) / block.acceleration
        turn = np.linalg.norm(self.turns[k + 1] - self.turns[k]) / math.radians(block.angular)
        return 0.5 * max(way, turn)

    def _zone(self, k):
        """mm of the corner behind block k; inf within a spline."""
        block, half = self.blocks[k], 0.5 * min(self.lengths[k], self.lengths[k + 1])
        if block.kind == "spline":
            return math.inf if block.zone == math.inf else 0.0
        if block.share:
            speed = block.share * min(self._most(k)[0], self._most(k + 1)[0])
            return min(half, max(1e-6, self._bend(k) * speed * speed))
        return min(half, block.zone)

    def _tangent(self, k):
        """(3,) of the spline at node k: the mean of both directions, each by its own length."""
        if not 0 < k < len(self.nodes) - 1 or self.zones[k] != math.inf:
            at = min(k, len(self.lengths) - 1)
            if k > 0 and (k == len(self.nodes) - 1 or self.blocks[k - 1].kind == "spline"):
                at = k - 1
            return self.directions[at]
        a, b = self.lengths[k - 1], self.lengths[k]
        return (a * self.directions[k - 1] + b * self.directions[k]) / (a + b)

    def _place(self, k, u):
        """(3,) mm at u mm along block k."""
        length, a, b = self.lengths[k], self.points[k], self.points[k + 1]
        if self.blocks[k].kind == "spline":
            t = u / length
            m, n = length * self._end_tangent(k, 0), length * self._end_tangent(k, 1)
            h = (
                2 * t**3 - 3 * t**2 + 1,
                t**3 - 2 * t**2 + t,
                3 * t**2 - 2 * t**3,
                t**3 - t**2,
            )
            return h[0] * a + h[1] * m + h[2] * b + h[3] * n
        before, behind = self.zones[k], self.zones[k + 1]
        place = a + u * self.directions[k]
        if u < before:
            place = place + (before - u) ** 2 / (4 * before) * (
                self.directions[k] - self.directions[k - 1]
            )
        left = length - u
        if left < behind:
            place = place + (behind - left) ** 2 / (4 * behind) * (
                self.directions[k + 1] - self.directions[k]
            )
        return place

    def _end_tangent(self, k, end):
        """The tangent of a spline's block at its begin or end: along the block where the spline begins or ends."""
        return self._tangent(k + end) if self.zones[k + end] == math.inf else self.directions[k]

    def _lay_out(self):
        """The way on a grid: path coordinate, places, number of the block."""
        s, places, owner, begin = [], [], [], 0.0
        for k, length in enumerate(self.lengths):
            count = max(FINEST, math.ceil(length / GRID))
            own = (np.arange(count) + 0.5) / count * length
            edges = np.arange(count + 1) / count * length
            at = np.array([self._place(k, u) for u in edges])
            if self.blocks[k].kind == "spline":  # the speed is that along the curve
                step = np.linalg.norm(np.diff(at, axis=0), axis=1)
            else:
                step = np.full(count, length / count)
            s.append(step)
            places.append(at[:-1])
            owner += [k] * count
            begin += length
            del own
        self.steps = np.concatenate(s)
        self.places = np.vstack([*places, self.points[-1:]])
        self.owner = np.array(owner)

    def _limit(self):
        """Times at the places of the grid."""
        most = [self._most(k) for k in range(len(self.blocks))]
        speed = np.array([one[0] for one in most])[self.owner]
        acceleration = np.array([one[1] for one in most])[self.owner]
        inside = np.concatenate([(np.arange(n) + 0.5) / n for n in np.bincount(self.owner)])
        along = inside * self.lengths[self.owner]
        for k in range(1, len(self.blocks)):  # corners
            zone = self.zones[k]
            if zone == math.inf or zone == 0.0:
                continue
            bend = self._bend(k - 1)
            corner = math.sqrt(zone / bend) if bend > 0.0 else math.inf
            near = ((self.owner == k) & (along < zone)) | (
                (self.owner == k - 1) & (self.lengths[k - 1] - along < zone)
            )
            speed[near] = np.minimum(speed[near], corner)
        self._curve(speed)
        self._swing(speed, acceleration)
        square = np.minimum(np.append(speed, 0.0), np.append(0.0, speed)) ** 2  # at the places
        first = np.flatnonzero(np.diff(self.owner, prepend=-1))
        for k in range(1, len(self.blocks)):
            if self.zones[k] == 0.0:
                square[first[k]] = 0.0
        gain = 2.0 * acceleration * self.steps
        square = np.minimum(square, self._seen(gain, first))
        for k in range(len(gain)):
            square[k + 1] = min(square[k + 1], square[k] + gain[k])
        for k in range(len(gain) - 1, -1, -1):
            square[k] = min(square[k], square[k + 1] + gain[k])
        v = np.sqrt(square)
        self.times = np.append(0.0, np.cumsum(2.0 * self.steps / (v[1:] + v[:-1])))
        self.node_times = np.append(self.times[first], self.times[-1])

    def _curve(self, speed):
        """Lowers the speed where a spline's own curvature wants it."""
        spline = np.array([block.kind == "spline" for block in self.blocks])
        if not spline.any():
            return
        way = np.diff(self.places, axis=0)
        unit = way / np.linalg.norm(way, axis=1)[:, None]
        bend = np.linalg.norm(np.diff(unit, axis=0), axis=1) / (
            0.5 * (self.steps[1:] + self.steps[:-1])
        )
        bend = np.maximum(np.append(bend, 0.0), np.append(0.0, bend))
        most = np.array([block.acceleration for block in self.blocks])[self.owner]
        joined = np.array([zone == math.inf for zone in self.zones])
        first = np.flatnonzero(np.diff(self.owner, prepend=-1))
        ends = np.append(first, len(speed))[~joined]  # where the robot stops: no curve there
        bend[ends[ends < len(speed)]] = bend[ends[ends > 0] - 1] = 0.0
        own = spline[self.owner] & (bend > 1e-9)
        speed[own] = np.minimum(speed[own], np.sqrt(most[own] / bend[own]))

    def _swing(self, speed, acceleration):
        """Lowers speed and acceleration where a spline's turning wants it: its rotation vector goes as its places do."""
        for k, block in enumerate(self.blocks):
            if block.kind != "spline":
                continue
            own, length, rate = self.owner == k, self.lengths[k], self.turns[k]
            begin, end = (self._end_rate(k, side) - rate for side in (0, 1))
            t = np.linspace(0.0, 1.0, own.sum() + 1)[:, None]
            rates = rate + (3 * t * t - 4 * t + 1) * begin + (3 * t * t - 2 * t) * end
            change = np.linalg.norm(np.diff(rates, axis=0), axis=1) / (length / own.sum())
            turning = np.linalg.norm(0.5 * (rates[1:] + rates[:-1]), axis=1)
            far = np.full(own.sum(), math.inf)
            most = np.divide(
                math.radians(block.turning), turning, out=far.copy(), where=turning > 0
            )
            swing = np.divide(math.radians(block.angular), change, out=far.copy(), where=change > 0)
            raised = np.divide(math.radians(block.angular), turning, out=far, where=turning > 0)
            speed[own] = np.minimum(np.minimum(speed[own], most), np.sqrt(swing))
            acceleration[own] = np.minimum(acceleration[own], raised)

    def _end_rate(self, k, side):
        """(3,) radians a mm at the begin (0) or the end (1) of a spline's block, as ``_tangent`` has it for places."""
        node = k + side
        if self.zones[node] != math.inf:
            return self.turns[k]
        a, b = self.lengths[node - 1], self.lengths[node]
        return (a * self.turns[node - 1] + b * self.turns[node]) / (a + b)

    def _seen(self, gain, first):
        """The squares of the speeds from which the robot can stop at the end of the last block that it looks ahead to."""
        ends, number = [], -1  # blocks as it counts them: a spline is one
        for k, block in enumerate(self.blocks):
            joined = k > 0 and block.kind == "spline" and self.zones[k] == math.inf
            number += not joined
            ends.append(number)
        counted = np.array(ends)
        whole = np.append(0.0, np.cumsum(gain))
        last = np.array([np.flatnonzero(counted <= c + self.look_ahead)[-1] for c in counted])
        end_of = np.append(first[1:], len(gain))
        return np.append(whole[end_of[last[self.owner]]], whole[-1]) - whole

    def samples(self):
        """Set points, one a cycle."""
        times = np.append(np.arange(0.0, self.times[-1], self.cycle), self.times[-1])
        places = np.stack(
            [np.interp(times, self.times, self.places[:, i]) for i in range(3)], axis=1
        )
        at = np.minimum(np.searchsorted(self.times, times, side="right") - 1, len(self.owner) - 1)
        return [
            Sample(t, place, self.blocks[self.owner[k]].force, self.first + int(self.owner[k]))
            for t, place, k in zip(times, places, at)
        ]
