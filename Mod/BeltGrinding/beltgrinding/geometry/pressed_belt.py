"""How a free belt or a platen's belt lies over a part at a pose, for what is drawn: a string pulled tight over the part's
section. It is no contact: the belt's stiffness and the force are not in it.

All is in the contact frame (geometry/free_run.py), mm.
"""

from __future__ import annotations


import numpy as np
from numpy.typing import ArrayLike

from ..base import records
from ..base.kinds import Array, Floats, Json, known
from ..job.settings import BeltMachine
from . import free_run

DEEPEST = 0.5  # of the free length
MOST = 2000  # places at which the section is looked at
LEAST = 1e-3  # mm: shallower, the belt is as it touches nothing


def slab(points: ArrayLike, triangles: Array, half: float) -> Floats:
    """Points [x, z] (k, 2) whose hull is that of a mesh's part with abs(y) <= ``half``, seen along y. points (n, 3),
    triangles (m, 3)."""
    points = np.asarray(points, dtype=float)
    found = [points[np.abs(points[:, 1]) <= half]]
    for y in (-half, half):
        below = points[:, 1] < y
        corners = below[triangles].sum(axis=1)
        across = triangles[(corners > 0) & (corners < 3)]  # of a fine mesh, few
        edges = np.concatenate([across[:, [0, 1]], across[:, [1, 2]], across[:, [2, 0]]])
        edges = edges[below[edges[:, 0]] != below[edges[:, 1]]]
        a, b = points[edges[:, 0]], points[edges[:, 1]]
        share = ((y - a[:, 1]) / (b[:, 1] - a[:, 1]))[:, None]
        found.append(a + share * (b - a))
    return np.concatenate(found)[:, [0, 2]]


def pushed(machine: BeltMachine | Json, section: Floats) -> tuple[Floats, Floats] | None:
    """(x (n,), mm (n,)) by which the belt's face lies behind where it touches nothing, ascending x, 0 at both ends; None where
    the part does not reach through it. A free belt is pulled tight from roller to roller, one on a platen lies on that
    beside the part. ``machine``: a job's belt_machine; ``section``: of ``slab``.
    """
    machine = records.made(BeltMachine, machine)
    first, last = free_run.line(machine, free_run.ends(machine))[:, 0]
    x, z = section[(section[:, 0] > first) & (section[:, 0] < last)].T
    depth = -z - _behind(machine, x)
    # What lies deeper is not pressed in there: the belt runs through a ring.
    near = depth <= DEEPEST * known(machine.free_run).length_mm
    x, depth = x[near], depth[near]
    if not (depth > LEAST).any():
        return None
    if machine.kind != "platen":
        ends = [[first, 0.0], [last, 0.0]]
        over = np.stack([x, depth], axis=1)[depth > 0.0]
        hull = _upper_hull(np.concatenate([over, ends]))
        return hull[:, 0], np.maximum(hull[:, 1], 0.0)
    hull = _upper_hull(np.stack([x, depth], axis=1))
    x, depth = hull.T
    if len(x) > 1:  # and where it goes through the face
        through = np.flatnonzero((depth[:-1] > 0.0) != (depth[1:] > 0.0))
        share = depth[through] / (depth[through] - depth[through + 1])
        x = np.r_[x, x[through] + share * (x[through + 1] - x[through])]
        depth = np.r_[depth, np.zeros(len(through))]
        order = np.argsort(x, kind="stable")
        x, depth = x[order], depth[order]
    beside = [first, x[0] - LEAST], [x[-1] + LEAST, last]
    return np.r_[beside[0], x, beside[1]], np.r_[0.0, 0.0, np.maximum(depth, 0.0), 0.0, 0.0]


def _behind(machine: BeltMachine, x: Floats) -> Floats:
    """mm (n,) that the face lies behind the plane z = 0 at x (n,)."""
    line = free_run.line(machine, free_run.face(machine))
    return -np.interp(x, *line.T)


def _upper_hull(points: Floats) -> Floats:
    """Corners of the hull of points [x, height] (n, 2) that are seen from above, by ascending x (Andrew's monotone chain)."""
    order = np.lexsort((-points[:, 1], points[:, 0]))
    points = points[order]
    points = points[np.r_[True, np.diff(points[:, 0]) > 0.0]]  # the highest at each x
    if len(points) > MOST:  # and of each of many stretches
        stretch = (np.arange(len(points)) * MOST) // len(points)
        order = np.lexsort((-points[:, 1], stretch))
        points = points[order[np.r_[True, np.diff(stretch[order]) > 0]]]
    hull: list[Floats] = []
    for p in points:
        while len(hull) > 1 and _turns_left(hull[-2], hull[-1], p):
            hull.pop()
        hull.append(p)
    return np.array(hull)


def _turns_left(a: Floats, b: Floats, c: Floats) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) >= (b[1] - a[1]) * (c[0] - a[0])
