"""From where a place of the part is seen: directions of a camera with a line of sight."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats

if TYPE_CHECKING:
    from ..engine import core

DIRECTIONS = 200  # that are tried
MOST_POINTS = 1500  # of those that are to be seen; so many are tried
ALONG_AXIS = 0.94  # a direction this near to an axis shows a body as a flat figure
LEVEL = 0.35  # the height, as the sine of its angle, from which one looks at a thing on a table
TO_LEVEL = 0.12  # what leaving it costs, of the area seen
FROM_BELOW = 0.15  # and what looking from below costs, added
APART = 0.5  # cosine between two directions that show two sides


def around() -> Floats:
    """(n, 3) unit vectors all around, evenly spread (Fibonacci's sphere)."""
    k = np.arange(DIRECTIONS) + 0.5
    z = 1.0 - 2.0 * k / DIRECTIONS
    angle = np.pi * (1.0 + 5.0**0.5) * k
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


def thinned(count: int, most: int = MOST_POINTS) -> Array:
    """Indices of at most ``most`` of ``count``, evenly spread."""
    return np.linspace(0, count - 1, min(count, most)).astype(int)


def _cost(directions: Floats) -> Floats:
    """(n,) of the area seen: how far a camera in the directions is from where one would stand."""
    z = directions[:, 2]
    return TO_LEVEL * np.abs(z - LEVEL) + FROM_BELOW * (z < -0.1)


class Sides:
    """The directions that show the most of a surface: a first one, and one of what is left.

    ``renderer``: core.Renderer of all that may stand in the way; ``points``, ``normals`` (n, 3) and
    ``areas`` (n,) of the surface; ``slack``: mm around a point within which nothing hides it. Upright is
    z.
    """

    def __init__(
        self, renderer: core.Renderer, points: Array, normals: Array, areas: Array, slack: float
    ) -> None:
        chosen = thinned(len(points))
        ways = around()
        self.ways = ways[np.abs(ways).max(axis=1) < ALONG_AXIS]
        facing = np.clip(normals[chosen] @ self.ways.T, 0.0, None)
        seen = renderer.seen(points[chosen], self.ways, slack, facing > 0.0)
        weights = np.asarray(areas, dtype=float)[chosen]
        weights /= max(weights.sum(), 1e-300)
        self.shown = weights[:, None] * seen * facing  # area in the picture, by point and direction

    def front(self) -> Floats:
        """Unit vector to the camera that sees most of the area."""
        return self.ways[self._front()]

    def _front(self) -> int:
        return int(np.argmax(self.shown.sum(axis=0) - _cost(self.ways)))

    def back(self) -> Floats:
        """Unit vector to the camera that sees most of what the first one does not."""
        front = self._front()
        new = np.clip(self.shown - 2.0 * self.shown[:, [front]], 0.0, None)
        worth = new.sum(axis=0) + 0.3 * self.shown.sum(axis=0) - _cost(self.ways)
        worth[self.ways @ self.ways[front] > APART] = -np.inf
        return self.ways[int(np.argmax(worth))]


def towards(
    renderer: core.Renderer,
    points: Array,
    normals: Array,
    preferred: ArrayLike,
    slack: float,
    liking: float = 0.5,
) -> tuple[Floats, float]:
    """(direction, share): a unit vector to a camera that sees ``points`` (n, 3) with ``normals``, and the
    share of them that it sees. ``preferred``: where it should stand, as far as it can, and ``liking`` how
    much of the area that is worth. The first point counts as much as all others.
    """
    points, normals = np.atleast_2d(points), np.atleast_2d(normals)
    preferred = np.asarray(preferred, dtype=float) / np.linalg.norm(preferred)
    ways = np.vstack([preferred, around()])
    facing = np.asarray(normals, dtype=float) @ ways.T
    seen = renderer.seen(points, ways, slack, facing > 0.05).astype(bool)
    weights = np.full(len(points), 0.5 / max(len(points) - 1, 1))
    weights[0] = 0.5 if len(points) > 1 else 1.0
    # At 45 degrees a place is seen as well as one could wish.
    worth = weights @ (seen * np.clip(1.4 * facing, 0.0, 1.0))
    worth += liking * (ways @ preferred) - _cost(ways)
    best = int(np.argmax(worth))
    return ways[best], float(weights @ seen[:, best])
