"""Profiles of a section in its plane: pieces joined end to end, their arcs, where they cross themselves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..base.kinds import Floats, Json

JOINED = (
    1e-3  # mm between pieces that meet; neighbours that are sampled apart: of the pieces' own steps
)
STEPS = 0.75
MIDDLE = (0.25, 0.75)  # of the turning, on which the circle is fitted
LEAST_POINTS = 4
ROUND = 0.03  # of the radius: a profile that is further off the circle is no arc
ROUNDS = 20  # of Gauss and Newton
SHARP = 1e-3  # mm: a smaller radius is none


def axes(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors of a plane, so that first x second is its ``normal``."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


def chains(pieces: Iterable[Json]) -> list[dict[str, Any]]:
    """Pieces that meet end to end, joined: dicts of points (n, 3), normals (n, 3), rays (n, 3), height (n,),
    stock (n,), face (n,), closed."""
    parts = []
    for piece in pieces:
        step = np.median(np.linalg.norm(np.diff(piece["point"], axis=0), axis=1))
        parts.append(
            {
                "points": piece["point"],
                "normals": piece["normal"],
                "rays": piece["ray"],
                "height": piece["height"],
                "stock": piece["stock_height"],
                "face": np.full(len(piece["s"]), piece["face"]),
                "reach": max(JOINED, STEPS * step),
                "closed": piece["closed"],
            }
        )
    chains = []
    while parts:
        chain = parts.pop(0)
        while not chain["closed"]:  # what begins where it ends, and what ends where it begins
            after = _nearest(chain["points"][-1], [one["points"][0] for one in parts])
            before = _nearest(chain["points"][0], [one["points"][-1] for one in parts])
            ring = np.linalg.norm(chain["points"][0] - chain["points"][-1]) < chain["reach"]
            if after[1] < chain["reach"]:
                chain = _joined(chain, parts.pop(after[0]))
            elif before[1] < chain["reach"]:
                chain = _joined(parts.pop(before[0]), chain)
            elif ring and len(chain["points"]) > 2:
                chain["closed"] = True
            else:
                break
        chains.append(chain)
    return chains


def _nearest(point: Floats, others: Sequence[Floats]) -> tuple[int, float]:
    """(number of the nearest, its distance) among points that are no closed piece's."""
    if not others:
        return 0, math.inf
    distance = np.linalg.norm(np.array(others) - point, axis=1)
    k = int(np.argmin(distance))
    return k, float(distance[k])


def _joined(one: Json, other: Json) -> dict[str, Any]:
    return {
        **{
            name: np.concatenate([one[name], other[name]])
            for name in ("points", "normals", "rays", "height", "stock", "face")
        },
        "reach": max(one["reach"], other["reach"]),
        "closed": False,
    }


def angle(one: Floats, other: Floats) -> Floats:
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.abs(np.arctan2(cross, (one * other).sum(axis=1)))


def without_loops(line: Floats) -> Floats:
    """A polyline (n, 2) without the loops in which it crosses itself."""
    i = 0
    while i + 3 < len(line):
        a, b = line[i], line[i + 1]
        starts, ends = line[i + 2 : -1], line[i + 3 :]
        way, others = b - a, ends - starts
        crossed = way[0] * others[:, 1] - way[1] * others[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = starts - a
            t = (offset[:, 0] * others[:, 1] - offset[:, 1] * others[:, 0]) / crossed
            u = (offset[:, 0] * way[1] - offset[:, 1] * way[0]) / crossed
        met = np.flatnonzero((t > 0) & (t <= 1) & (u >= 0) & (u < 1))
        if len(met):
            k = int(met[-1])
            line = np.concatenate([line[: i + 1], [a + t[k] * way], line[i + 3 + k :]])
        i += 1
    return line


def radius(line: Floats, first: Floats, last: Floats) -> tuple[float | None, float | None]:
    """(radius, root mean square of what the points are off) of a ground profile between two sides of the
    given normals; (0.0, None): sharp, (None, None): it does not turn, (None, ...): it is no arc."""
    whole = float(angle(first[None], last[None])[0])
    points = middle(line, first, last)
    if points is None:
        return None, None
    if not len(points):
        return 0.0, None  # from one side to the other without anything between
    if len(points) < LEAST_POINTS:
        arc = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        found = float(arc / ((MIDDLE[1] - MIDDLE[0]) * whole))
        return (found if found > SHARP else 0.0), None
    _, found, residual = circle(points)
    return (found if residual < ROUND * found else None), residual


def middle(
    line: Floats, first: Floats, last: Floats, part: tuple[float, float] = MIDDLE
) -> Floats | None:
    """The points (k, 2) of a profile (n, 2) where it turns by ``part`` of the way between two sides of the given
    normals; (0, 2): it turns in one place, None: it does not turn."""
    ways = np.diff(line, axis=0)
    length = np.linalg.norm(ways, axis=1)
    keep = length > 1e-7
    line = np.concatenate([line[:1], line[1:][keep]])
    ways = ways[keep] / length[keep, None]
    if len(ways) < 2:
        return None
    # The way's direction goes with the normal's: from the first side's to the last's.
    sense = np.sign(first[0] * last[1] - first[1] * last[0]) or 1.0
    whole = float(angle(first[None], last[None])[0])
    start = -np.array([-first[1], first[0]]) if sense < 0 else np.array([-first[1], first[0]])
    turned = sense * np.arctan2(
        start[0] * ways[:, 1] - start[1] * ways[:, 0], (ways * start).sum(axis=1)
    )
    if not whole > 0:
        return None
    inside = np.flatnonzero((turned > part[0] * whole) & (turned < part[1] * whole))
    return line[inside[0] : inside[-1] + 2] if len(inside) else line[:0]


def circle(points: Floats, weights: Floats | float = 1.0) -> tuple[Floats, float, float]:
    """(centre (2,), radius, root mean square of the distances) of the circle that fits points (n, 2) best.
    ``weights``: (n,) of their distances' squares; the root mean square is of all alike."""
    origin = points.mean(axis=0)
    p = points - origin
    root = np.sqrt(np.broadcast_to(weights, len(p)))
    solved, *_ = np.linalg.lstsq(
        root[:, None] * np.column_stack([2.0 * p, np.ones(len(p))]),
        root * (p**2).sum(axis=1),
        rcond=None,
    )
    centre, found = solved[:2], math.sqrt(max(solved[2] + solved[:2] @ solved[:2], 0.0))
    for _ in range(ROUNDS):  # from the algebraic circle, which is too small on short arcs
        away = p - centre
        distance = np.linalg.norm(away, axis=1)
        if not (distance > 0).all():
            break
        matrix = np.column_stack([-away / distance[:, None], -np.ones(len(p))])
        change, *_ = np.linalg.lstsq(root[:, None] * matrix, root * (found - distance), rcond=None)
        centre, found = centre + change[:2], found + float(change[2])
        if np.abs(change).max() < 1e-9:
            break
    residual = float(np.sqrt(np.mean((np.linalg.norm(p - centre, axis=1) - found) ** 2)))
    return centre + origin, abs(found), residual
