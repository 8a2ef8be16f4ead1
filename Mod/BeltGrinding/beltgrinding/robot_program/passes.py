"""The passes of a path, each from the pose that a rapid motion leads to, and the order of the least way between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.kinds import Array, Floats

LEVER = 300.0  # mm: a turn of the tool counts as the way of a point so far from it
SWEEPS = 50  # of 2-opt, at most


class Pass(NamedTuple):
    """Poses of a path, both from 0."""

    first: int
    last: int


def split(rapid: Array) -> tuple[list[Pass], int]:
    """(passes, number of rapid poses that are none): ``rapid`` (n,) bool of a path's poses. A rapid pose that no
    path motion follows only leads the robot on its way."""
    begins = [k for k in range(len(rapid)) if k == 0 or rapid[k]]
    ends = [*(k - 1 for k in begins[1:]), len(rapid) - 1]
    found = [Pass(a, b) for a, b in zip(begins, ends) if b > a]
    return found, len(begins) - len(found)


def least_way(frames: Floats, passes: list[Pass], home: Floats) -> list[int]:
    """Numbers of the passes in the order of a short way from home through all of them and back: always the nearest
    one next, then blocks turned round while that is shorter (2-opt). A pass keeps its direction. ``frames`` (n, 4, 4),
    ``home`` (4, 4): base_from_tcp, mm."""
    ends = np.stack([home, *(frames[one.last] for one in passes)])
    begins = np.stack([home, *(frames[one.first] for one in passes)])
    way = _distances(ends, begins)
    order, left = [0], set(range(1, len(begins)))
    while left:
        order.append(min(left, key=lambda k: (way[order[-1], k], k)))
        left.remove(order[-1])
    order.append(0)
    return [k - 1 for k in _two_opt(np.array(order), way)[1:-1].tolist()]


def length(order: Array, way: Floats) -> float:
    return float(way[order[:-1], order[1:]].sum())


def _two_opt(order: Array, way: Floats) -> Array:
    for _ in range(SWEEPS):
        gained = False
        for i in range(1, len(order) - 2):
            # Blocks from i to every j, turned round: the ways within them are those back.
            js = np.arange(i + 1, len(order) - 1)
            on = np.cumsum(way[order[i:-2], order[i + 1 : -1]])
            back = np.cumsum(way[order[i + 1 : -1], order[i:-2]])
            before = way[order[i - 1], order[i]] + on + way[order[js], order[js + 1]]
            after = way[order[i - 1], order[js]] + back + way[order[i], order[js + 1]]
            gains = before - after
            best = int(np.argmax(gains))
            if gains[best] > 1e-9:
                j = js[best]
                order[i : j + 1] = order[i : j + 1][::-1].copy()
                gained = True
        if not gained:
            break
    return order


def _distances(ends: Floats, begins: Floats) -> Floats:
    """(n, n) mm from each end to each begin, turns counted."""
    apart = np.linalg.norm(ends[:, None, :3, 3] - begins[None, :, :3, 3], axis=2)
    traces = np.einsum("aij,bij->ab", ends[:, :3, :3], begins[:, :3, :3])
    turns = np.arccos(np.clip(0.5 * (traces - 1.0), -1.0, 1.0))
    return apart + LEVER * turns
