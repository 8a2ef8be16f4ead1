"""What a search tries besides the rules: other directions, belt angles, leans and narrower wheels."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import numpy as np

from ..base.kinds import Floats, Json
from .rough import MATTERS, Move, Tried

TURN_DEG = 22.5  # from the best direction, and from the best belt angle
HALF_TURN = 180.0  # degrees of the belt's angle: the belt's travel the other way round is the same to the part
LESS_LEAN = 1.0 / 3.0  # of the lean
GUESS = 0.3  # of what stays out for other reasons: a turn may mend it


class Moves:
    """Calls give [(of the area, that it may mend, Move)] of a ``Tried``. ``fixed``: settings of the raster that stay."""

    def __init__(self, fixed: Collection[str] = ()) -> None:
        self.fixed = frozenset(fixed)

    def __call__(self, one: Tried) -> list[tuple[float, Move]]:
        shares = one.shares
        unreached = shares["no_room"] + shares["no_motion"] + shares["fringe"]
        left = unreached + GUESS * (shares["shared"] + shares["border"])
        found: list[tuple[float, Move]] = []
        if left > MATTERS:
            found += [(left, move) for move in self._turned(one)]
            found += [(0.9 * left, move) for move in self._angles(one)]
        if one.wanted["max_tilt_deg"] > 0.0 and shares["shared"] + shares["fringe"] > MATTERS:
            lean = round(LESS_LEAN * one.wanted["max_tilt_deg"], 1)
            found += self._changed(one, 0.1 * left, "lean", "max_tilt_deg", lean)
        return found

    def _changed(
        self, one: Tried, share: float, name: str, key: str, value: Any
    ) -> list[tuple[float, Move]]:
        if key in self.fixed:
            return []
        return [(share, (name, one.machine, {**one.wanted, key: value}))]

    def _turned(self, one: Tried) -> list[Move]:
        if "direction" in self.fixed or "along" in self.fixed:
            return []
        if one.wanted["along"] != "direction" or not one.looks.any():
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
