"""What a search tries besides the rules: other directions, belt angles, leans and, by chance, what is a little different."""

from __future__ import annotations

import math
import zlib
from collections.abc import Collection
from typing import Any

import numpy as np

from ..base.kinds import Floats, Json
from .rough import MATTERS, Move, Tried

TURN_DEG = 22.5  # from the best direction, and from the best belt angle
HALF_TURN = 180.0  # degrees of the belt's angle: the belt's travel the other way round is the same to the part
LESS_LEAN = 1.0 / 3.0  # of the lean
GUESS = 0.3  # of what stays out for other reasons: a turn may mend it
NEIGHBOURS = 10  # by chance, after all else
# Their standard deviations: of the contact's length, of the step-over's logarithm, degrees.
RUN_OUT, STEP_OVER, TURNED_DEG = 0.1, 0.2, 12.0
CHANGED = 0.5  # of the settings, in each neighbour


class Moves:
    """Calls give [(of the area, that it may mend, Move)] of a ``Tried``. ``fixed``: settings of the raster that stay; ``lap``:
    others by chance; ``reachable``: of the area, by what the geometry says: what no belt angle gets to, none mends.
    """

    def __init__(self, fixed: Collection[str] = (), lap: int = 0, reachable: float = 1.0) -> None:
        self.fixed, self.lap, self.reachable = frozenset(fixed), lap, reachable

    def __call__(self, one: Tried) -> list[tuple[float, Move]]:
        shares = one.shares
        more = max(shares["no_room"] - (1.0 - self.reachable), 0.0)
        unreached = more + shares["no_motion"] + shares["fringe"]
        left = unreached + GUESS * (shares["shared"] + shares["border"])
        found: list[tuple[float, Move]] = []
        if left > MATTERS:
            found += [(left, move) for move in self._turned(one)]
            found += [(0.9 * left, move) for move in self._angles(one)]
        if one.wanted["max_tilt_deg"] > 0.0 and shares["shared"] + shares["fringe"] > MATTERS:
            lean = round(LESS_LEAN * one.wanted["max_tilt_deg"], 1)
            found += self._changed(one, 0.1 * left, "lean", "max_tilt_deg", lean)
        if sum(shares.values()) > MATTERS:
            found += [(0.0, move) for move in self._near(one)]
        return found

    def _near(self, one: Tried) -> list[Move]:
        """Passes by chance, the same on every machine: rules leave out what lies between their steps."""
        wanted = one.wanted
        seed = zlib.crc32(repr(sorted(wanted.items())).encode())
        by = np.random.default_rng((seed, self.lap))
        moves: list[Move] = []
        for _ in range(NEIGHBOURS):
            by_run_out, by_step_over, by_angle, by_turn = by.normal(size=4)
            changed = {
                "run_out_mm": round(wanted["run_out_mm"] + RUN_OUT * one.length_mm * by_run_out, 3),
                "step_over_mm": round(one.step_over_mm * math.exp(STEP_OVER * by_step_over), 3),
                "belt_angle_deg": round(
                    half_turn(wanted["belt_angle_deg"] + TURNED_DEG * by_angle), 1
                ),
            }
            if self._turns(one):
                way = turned(wanted["direction"], one.looks, TURNED_DEG * by_turn)
                changed["direction"] = way
            taken = by.random(len(changed)) < CHANGED
            kept = {
                key: value
                for (key, value), yes in zip(changed.items(), taken)
                if yes and key not in self.fixed
            }
            if kept:
                moves.append(("near", one.machine, {**wanted, **kept}))
        return moves

    def _changed(
        self, one: Tried, share: float, name: str, key: str, value: Any
    ) -> list[tuple[float, Move]]:
        if key in self.fixed:
            return []
        return [(share, (name, one.machine, {**one.wanted, key: value}))]

    def _turns(self, one: Tried) -> bool:
        """Whether its direction may be turned, and there is something to turn it about."""
        if {"along", "direction"} & self.fixed:
            return False
        return one.wanted["along"] == "direction" and bool(one.looks.any())

    def _turned(self, one: Tried) -> list[Move]:
        if not self._turns(one):
            return []
        ways = [turned(one.wanted["direction"], one.looks, sign * TURN_DEG) for sign in (1.0, -1.0)]
        return [("direction", one.machine, {**one.wanted, "direction": way}) for way in ways]

    def _angles(self, one: Tried) -> list[Move]:
        if "belt_angle_deg" in self.fixed:
            return []
        now = one.wanted["belt_angle_deg"]
        return [
            ("belt_angle", one.machine, {**one.wanted, "belt_angle_deg": half_turn(now + turn)})
            for turn in (TURN_DEG, -TURN_DEG)
        ]


def half_turn(angle: float) -> float:
    """Degrees between -90, which it is not, and 90: of the belt's travel, one way or the other."""
    return HALF_TURN / 2.0 - (HALF_TURN / 2.0 - angle) % HALF_TURN


def turned(direction: Json | list[float], about: Floats, degrees: float) -> list[float]:
    """The part of a direction (3,) across the unit vector ``about``, turned about it."""
    way = np.asarray(direction, dtype=float)
    way = way - (way @ about) * about
    way /= max(float(np.linalg.norm(way)), 1e-12)
    a = math.radians(degrees)
    found = math.cos(a) * way + math.sin(a) * np.cross(about, way)
    return [float(value) for value in np.round(found, 4) + 0.0]
