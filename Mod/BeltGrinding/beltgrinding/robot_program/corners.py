"""Corners of path motions that the controller rounds: the arc lies off both straight ways, and may meet what they do not.

The arc is taken as a parabola from the zone's begin to its end, as far as half the shorter way beside it, which is what
controllers' blends are near to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..base import frames
from ..base.kinds import Floats
from ..engine import core
from .moves import Move

LEAST = 0.05  # mm that an arc must leave its corner by to be looked at
PARTS = 8  # of an arc
STEP, TURN = 1.0, 0.02  # mm, rad, between places on it


def rounded(moves: Sequence[Move], default_mm: float) -> Iterator[tuple[Move, list[Floats]]]:
    """(motion, base_from_tcp (4, 4) of the places along its arc, the corner itself left out) of the motions at whose end
    the controller rounds a corner. ``default_mm``: the zone of a motion that gives none."""
    for before, move, after in zip(moves[:-2], moves[1:-1], moves[2:]):
        zone = default_mm if move.zone < 0.0 else move.zone
        if zone == 0.0 or move.kind != "LIN" or after.kind != "LIN" or move.joints_deg is None:
            continue
        a, b, c = (one.frame for one in (before, move, after))
        ways = [float(np.linalg.norm(one[:3, 3] - b[:3, 3])) for one in (a, c)]
        if min(ways) <= 0.0:
            continue
        reach = min(zone, 0.5 * min(ways))
        begin, end = (_between(b, one, reach / way) for one, way in zip((a, c), ways))
        if np.linalg.norm(begin[:3, 3] + end[:3, 3] - 2.0 * b[:3, 3]) < 4.0 * LEAST:
            continue
        shares = np.linspace(0.0, 1.0, PARTS + 1)
        yield move, [_between(_between(begin, b, s), _between(b, end, s), s) for s in shares]


def way(scene: core.ArmScene, move: Move, places: Sequence[Floats]) -> Floats | None:
    """(n, 6) rad along an arc, in the posture of its corner; None: the arm does not get there."""
    assert move.joints_deg is not None
    found, q = [], np.radians(move.joints_deg)
    for number, place in enumerate(places):
        part, gets_there = scene.straight_way(q, place, STEP, TURN)
        if not gets_there:
            return None
        q = np.asarray(part[-1])
        found.append(np.asarray(part) if number else q[None])
    return np.concatenate(found)


def _between(begin: Floats, end: Floats, share: float) -> Floats:
    frame = begin.copy()
    frame[:3, 3] += share * (end[:3, 3] - begin[:3, 3])
    vector = frames.rotation_vectors((begin[:3, :3].T @ end[:3, :3])[None])[0]
    frame[:3, :3] = begin[:3, :3] @ frames.rotation(share * vector)
    return frame
