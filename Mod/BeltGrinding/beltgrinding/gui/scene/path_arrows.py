"""Arrows along a path of the wheel: which way it goes, where it grinds."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ..common.kinds import Array, Node, Rgb, Surface
from .shapes3d import separator, triangles, unpickable

SIZE, THICK = (
    0.02,
    0.3,
)  # length of an arrow, of the extents where it grinds; its radius, of its length
APART = 6.0  # lengths of an arrow from one to the next
MOST = 400
AROUND = 6  # corners of an arrow's base


def arrows(points: Array, rapid: Array, colour: Rgb) -> Node:
    """Coin node of arrows on the pieces of a line where it is not rapid. ``points``: (n, 3) mm; ``rapid``:
    (n,) whether the way to the point is; ``colour``: rgb."""
    points = np.asarray(points, dtype=float)
    root = separator()
    if len(points) < 2:
        return root
    rapid = np.asarray(rapid, dtype=bool)
    grinding = points[~rapid] if not rapid.all() else points
    length = SIZE * float(np.linalg.norm(np.ptp(grinding, axis=0)))
    places, ways = placed(points, rapid, length)
    if not len(places):
        return root
    corners, faces = cones(places, ways, length)
    light, tone = coin.SoLightModel(), coin.SoBaseColor()
    light.model = coin.SoLightModel.BASE_COLOR
    tone.rgb = tuple(colour[:3])
    for node in (unpickable(), light, tone, triangles(corners, faces)):
        root.addChild(node)
    return root


def placed(points: Array, rapid: Array, length: float) -> tuple[Array, Array]:
    """(places (k, 3), unit directions (k, 3)): one in the middle of each piece between rapid moves, and
    more of them, evenly, where it is long."""
    steps = points[1:] - points[:-1]
    lengths = np.linalg.norm(steps, axis=1)
    grinds = ~rapid[1:] & (lengths > 0.0)
    places, ways = [], []
    total = float(lengths[grinds].sum())
    apart = max(APART * length, total / MOST, 1e-9)
    borders = np.flatnonzero(np.diff(np.concatenate([[False], grinds, [False]]).astype(int)))
    for first, last in zip(borders[::2], borders[1::2]):
        ends = np.concatenate([[0.0], np.cumsum(lengths[first:last])])
        if ends[-1] < length:
            continue  # too short to carry one
        count = max(int(ends[-1] / apart), 1)
        for at in (np.arange(count) + 0.5) / count * ends[-1]:
            k = min(int(np.searchsorted(ends, at, side="right")) - 1, last - first - 1)
            way = steps[first + k] / lengths[first + k]
            places.append(points[first + k] + (at - ends[k]) * way)
            ways.append(way)
    chosen = np.linspace(0, len(places) - 1, min(len(places), MOST)).astype(int)
    return np.array(places)[chosen].reshape(-1, 3), np.array(ways)[chosen].reshape(-1, 3)


def cones(places: Array, ways: Array, length: float) -> Surface:
    """(points, triangles) of cones of a length, mm, whose middles lie at ``places`` and whose tips point
    along ``ways``."""
    # A direction across: with the axis along which the way goes least.
    other = np.eye(3)[np.abs(ways).argmin(axis=1)]
    across = np.cross(ways, other)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    third = np.cross(ways, across)
    angles = 2.0 * np.pi * np.arange(AROUND) / AROUND
    radius = THICK * length
    ring = radius * (
        np.cos(angles)[None, :, None] * across[:, None]
        + np.sin(angles)[None, :, None] * third[:, None]
    )
    base = places - 0.5 * length * ways
    tip = places + 0.5 * length * ways
    points = np.concatenate([tip[:, None], base[:, None], base[:, None] + ring], axis=1)
    k = np.arange(AROUND)
    one = np.concatenate(
        [
            np.column_stack([0 * k, 2 + k, 2 + (k + 1) % AROUND]),
            np.column_stack([0 * k + 1, 2 + (k + 1) % AROUND, 2 + k]),
        ]
    )
    starts = (AROUND + 2) * np.arange(len(places))
    return points.reshape(-1, 3), (starts[:, None, None] + one).reshape(-1, 3)
