"""Corners of path motions that the controller rounds: the arc lies off both straight ways, and may meet what they do not.

The arc is taken as a parabola from the zone's begin to its end, as far as half the shorter way beside it, which is what
controllers' blends are near to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..base import frames
from ..base.kinds import Floats, Json
from ..engine import core
from ..presets import external_axes
from .moves import Move

LEAST = 0.05  # mm that an arc must leave its corner by to be looked at
PARTS = 8  # of an arc
STEP, TURN = 1.0, 0.02  # mm, rad, between places on it


class Place(NamedTuple):
    """Of an arc."""

    frame: Floats  # (4, 4): base_from_tcp
    external: tuple[float, ...]


def rounded(moves: Sequence[Move], default_mm: float) -> Iterator[tuple[Move, list[Place]]]:
    """(motion, places along its arc, the corner itself left out) of the motions at whose end the controller rounds a
    corner. ``default_mm``: the zone of a motion that gives none."""
    for before, move, after in zip(moves[:-2], moves[1:-1], moves[2:]):
        zone = default_mm if move.zone < 0.0 else move.zone
        if zone == 0.0 or move.kind != "LIN" or after.kind != "LIN" or move.joints_deg is None:
            continue
        a, b, c = (one.frame for one in (before, move, after))
        ways = [float(np.linalg.norm(one[:3, 3] - b[:3, 3])) for one in (a, c)]
        if min(ways) <= 0.0:
            continue
        reach = min(zone, 0.5 * min(ways))
        corner = Place(b, move.external)
        begin, end = (
            _between(corner, Place(one.frame, one.external), reach / way)
            for one, way in zip((before, after), ways)
        )
        if np.linalg.norm(begin.frame[:3, 3] + end.frame[:3, 3] - 2.0 * b[:3, 3]) < 4.0 * LEAST:
            continue
        shares = np.linspace(0.0, 1.0, PARTS + 1)
        yield move, [
            _between(_between(begin, corner, s), _between(corner, end, s), s) for s in shares
        ]


def way(
    scene: core.ArmScene, axes: Sequence[Json], move: Move, places: Sequence[Place]
) -> Floats | None:
    """(n, 6 + k) along an arc, in the posture of its corner, with the job's external ``axes``; None: the arm does
    not get there."""
    assert move.joints_deg is not None
    found, q = [], external_axes.coordinates(axes, move.joints_deg, move.external)
    for number, place in enumerate(places):
        end = external_axes.coordinates(axes, move.joints_deg, place.external)
        part, gets_there = scene.straight_way(q, place.frame, STEP, TURN, end)
        if not gets_there:
            return None
        q = np.asarray(part[-1])
        found.append(np.asarray(part) if number else q[None])
    return np.concatenate(found)


def _between(begin: Place, end: Place, share: float) -> Place:
    values = (a + share * (b - a) for a, b in zip(begin.external, end.external))
    return Place(frames.between(begin.frame, end.frame, share), tuple(values))
