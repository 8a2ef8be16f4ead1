"""Simple solids as points and triangles, for collisions and for what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


Mesh = tuple[NDArray[np.float64], NDArray[Any]]  # points, triangles


def box(
    low: Sequence[float] | NDArray[np.float64], high: Sequence[float] | NDArray[np.float64]
) -> Mesh:
    """(points (8, 3), triangles (12, 3)) between two corners."""
    corners = np.array([[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, triangles(quads)


def prism() -> NDArray[Any]:
    """Triangles (12, 3) between four corners at one end and four at the other."""
    sides = [[k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)]
    return triangles([[3, 2, 1, 0], [4, 5, 6, 7], *sides])


def triangles(quads: Sequence[Sequence[int]] | NDArray[Any]) -> NDArray[Any]:
    """(2 n, 3): two of each quad."""
    return np.array([t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])


def strip(upper: NDArray[np.float64], lower: NDArray[np.float64], half: float) -> Mesh:
    """(points (4 n, 3), triangles) of what lies between two lines [x, z] (n, 2) of which the upper one has the greater z,
    both with ascending x, ``half`` wide to both sides of y = 0."""
    count = len(upper)
    rings = [(upper, -half), (upper, half), (lower, half), (lower, -half)]
    points = [np.stack([line[:, 0], np.full(count, y), line[:, 1]], axis=1) for line, y in rings]
    i, found = np.arange(count - 1), [[[0, count, 2 * count, 3 * count]]]
    for k in range(4):
        a, b = k * count, (k + 1) % 4 * count
        found.append(np.stack([a + i, a + i + 1, b + i + 1, b + i], axis=1))
    last = count - 1
    found.append([[last, last + 3 * count, last + 2 * count, last + count]])
    return np.concatenate(points), triangles(np.concatenate(found))
