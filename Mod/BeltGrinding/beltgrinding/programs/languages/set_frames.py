"""Frames that a milling program sets within the one it begins in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...base.kinds import Floats

IDENTITY = np.eye(3)


def _alike(rotation: Floats) -> bool:
    """Whether a rotation turns nothing."""
    return float(np.abs(rotation - IDENTITY).max()) <= 1e-12


class Frame:
    """Where a program's coordinates are in those that it begins with: rotation (3, 3), origin (3,) in mm."""

    def __init__(self, rotation: Floats | None = None, origin: Any = (0.0, 0.0, 0.0)) -> None:
        self.rotation: Floats = np.eye(3) if rotation is None else rotation
        self.turns = rotation is not None and not _alike(rotation)
        self.origin: Floats = np.asarray(origin, dtype=float)

    def __matmul__(self, other: Frame) -> Frame:
        return Frame(self.rotation @ other.rotation, self.point(other.origin))

    def point(self, position: Any) -> Floats:
        """Where ``position`` is."""
        return self.origin + self.rotation @ np.asarray(position, dtype=float)

    def seen(self, position: Any) -> Floats:
        """``position`` of the first coordinates in these."""
        return self.rotation.T @ (np.asarray(position, dtype=float) - self.origin)

    def direction(self, vector: Any) -> tuple[float, ...]:
        """A direction in these coordinates in the first ones."""
        return tuple(map(float, self.rotation @ np.asarray(vector, dtype=float)))

    @property
    def keeps_z(self) -> bool:
        """Whether its z is that of the first coordinates."""
        return bool(self.rotation[2, 2] > 1.0 - 1e-12)

    @property
    def nothing(self) -> bool:
        return not self.turns and not self.origin.any()


def about(axis: int, degrees: float) -> Floats:
    """The rotation (3, 3) about axis 0, 1 or 2."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rotation = np.eye(3)
    rotation[u, u], rotation[u, v], rotation[v, u], rotation[v, v] = c, -s, s, c
    return rotation


def standing(
    at: Sequence[float | None], before: Frame, after: Frame
) -> tuple[list[float | None], set[str]]:
    """(where a tool that stands at ``at`` in one Frame is in another, the letters of what changed); None: not known."""
    known = [v is not None for v in at]
    if before.turns or after.turns:
        known = [all(known)] * 3
    there = after.seen(before.point([v or 0.0 for v in at]))
    found = [float(v) if k else None for v, k in zip(there, known)]
    changed = {
        letter
        for letter, a, b in zip("XYZ", at, found)
        if a is not None and b is not None and abs(a - b) > 1e-9
    }
    return [
        a if b is not None and n not in changed else b for n, a, b in zip("XYZ", at, found)
    ], changed
