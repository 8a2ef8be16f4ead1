"""The ground profile at edges: the radius that is left and how much of the chord is lost.

An edge is where a section's design turns outwards by 30 degrees or more on a radius below a limit, be it
round or sharp; pieces of neighbouring faces that meet there are one profile. Its *bisector* is the mean of
the normals on both sides of it. The *chord loss* is how much further the design reaches along the bisector
than the ground profile. The *radius* is that of the circle that fits the ground profile best (geometric
least squares) where it turns from a quarter to three quarters of the way from one side to the other. Where
both sides of a sharp edge were ground, the profile ends where they cross.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core

LARGEST = 3.0  # mm, radius of an edge's design unless told otherwise
LEAST_TURN = math.radians(30.0)
JOINED = (
    1e-3  # mm between pieces that meet; neighbours that are sampled apart: of the pieces' own steps
)
STEPS = 0.75
REACH = 1.0  # of the edge's own length, on both sides of it
LEAST_REACH = 1.0  # mm
MIDDLE = (0.25, 0.75)  # of the turning, on which the circle is fitted
LEAST_POINTS = 4
ROUND = 0.03  # of the radius: a profile that is further off the circle is no arc
ROUNDS = 20  # of Gauss and Newton
SHARP = 1e-3  # mm: a smaller radius is none
STATIONS = 24  # sections of an edge zone
NEIGHBOURS = 2.0  # radii of the zone within which normals tell an edge's direction
FLAT = 1e-3  # a smaller share of the normals' spread: no edge


def edges(section: Json, largest: float = LARGEST) -> list[dict[str, Any]]:
    """The edges that a section meets, in its order: dicts of ``point`` (3,) mm, the design's tip;
    ``turn_deg``; ``design_radius_mm``; ``radius_mm``, 0.0: sharp, None: not known, or no arc; ``residual_mm``, root mean
    square of the fit; ``chord_loss_mm``, None where stock was missed; ``faces`` from 1.
    """
    normal = np.asarray(section["normal"], dtype=float)
    axes = np.column_stack(_axes(normal))
    found = []
    for chain in _chains(section["pieces"]):
        found += _edges_of(chain, axes, largest)
    return found


def text(edge: Json) -> str:
    """An edge of ``edges`` in words."""
    x, y, z = edge["point"]
    told = f"edge at ({x:.1f}, {y:.1f}, {z:.1f}): radius "
    told += "not known" if edge["radius_mm"] is None else f"{edge['radius_mm']:.3f} mm"
    told += f" (design {edge['design_radius_mm']:.3f} mm), chord loss "
    loss = edge["chord_loss_mm"]
    return told + ("not known" if loss is None else f"{loss:.3f} mm")


def of_zone(
    field: core.HeightField, samples: Array, radius: float, stations: int = STATIONS
) -> dict[str, Any] | None:
    """What the edges of an edge zone are like: of sections across it at up to ``stations`` of its ``samples``,
    dict(sections, design_radius_mm, radius_mm, chord_loss_mm; the last three of min, mean and max, or
    None); None where no section meets an edge below ``radius`` mm.
    """
    if not len(samples):
        return None
    points = field.points[samples]
    normals = field.normals[samples].astype(float)
    found = []
    for k in _spread_out(points, stations):
        near = ((points - points[k]) ** 2).sum(axis=1) < (NEIGHBOURS * radius) ** 2
        spread, ways = np.linalg.eigh(normals[near].T @ normals[near])
        if not spread[1] > FLAT * spread[2] or spread[0] > 0.5 * spread[1]:
            continue  # a plane, or a tip that is round all about
        try:
            cut = core.section_by_plane(field, points[k], ways[:, 0])
        except InputError:
            continue  # at the very end of the faces, which the plane touches
        here = [
            (float(np.linalg.norm(np.asarray(edge["point"]) - points[k])), edge)
            for edge in edges(cut, max(radius, SHARP))
        ]
        if here and min(here, key=lambda one: one[0])[0] < NEIGHBOURS * radius:
            found.append(min(here, key=lambda one: one[0])[1])
    if not found:
        return None
    return {
        "sections": len(found),
        **{
            name: _figures([edge[name] for edge in found])
            for name in ("design_radius_mm", "radius_mm", "chord_loss_mm")
        },
    }


def _figures(values: Iterable[float | None]) -> dict[str, float] | None:
    known = [value for value in values if value is not None]
    if not known:
        return None
    return {"min": min(known), "mean": float(np.mean(known)), "max": max(known)}


def _spread_out(points: Floats, count: int) -> list[int]:
    """Numbers of up to ``count`` points, each as far as can be from those before it."""
    chosen = [int(np.argmin(points @ np.ones(3)))]
    distance = ((points - points[chosen[0]]) ** 2).sum(axis=1)
    while len(chosen) < min(count, len(points)) and distance.max() > 0:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
    return chosen


def _axes(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors of a plane, so that first x second is its ``normal``."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


def _chains(pieces: Iterable[Json]) -> list[dict[str, Any]]:
    """Pieces that meet end to end, joined: dicts of points (n, 3), normals (n, 3), rays (n, 3), height (n,), face (n,)."""
    parts = []
    for piece in pieces:
        step = np.median(np.linalg.norm(np.diff(piece["point"], axis=0), axis=1))
        parts.append(
            {
                "points": piece["point"],
                "normals": piece["normal"],
                "rays": piece["ray"],
                "height": piece["height"],
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
            for name in ("points", "normals", "rays", "height", "face")
        },
        "reach": max(one["reach"], other["reach"]),
        "closed": False,
    }


def _edges_of(chain: Json, axes: Floats, largest: float) -> list[dict[str, Any]]:
    points, normals = chain["points"] @ axes, chain["normals"] @ axes
    rays = chain["rays"] @ axes
    length = np.linalg.norm(normals, axis=1)
    sound = length > 0.1  # a surface that lies in the section's plane has no profile
    points, height, face = points[sound], chain["height"][sound], chain["face"][sound]
    normals = normals[sound] / length[sound, None]
    rays = rays[sound]
    whole = chain["points"][sound]
    if len(points) < 3:
        return []
    ring = len(points) if chain["closed"] else 0
    if chain["closed"]:  # round once more, so that an edge at its beginning is met whole
        points, normals, rays = (np.concatenate([a, a]) for a in (points, normals, rays))
        height = np.concatenate([height, height])
        face, whole = np.concatenate([face, face]), np.concatenate([whole, whole])
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    turn = _angle(normals[:-1], normals[1:])
    ways = points[1:] - points[:-1]
    # Outwards the normal turns with the way: its change points along it.
    convex = np.sign(((normals[1:] - normals[:-1]) * ways).sum(axis=1))
    apart = step < 1e-9
    convex[apart] = _at_corners(points, normals, apart)
    sharp = (turn * largest > step) & (convex > 0) & (turn > 1e-6)
    s = np.concatenate([[0.0], np.cumsum(step)])
    found = []
    for a, b in _runs(sharp):
        total = float(turn[a:b].sum())
        if total < LEAST_TURN or (ring and not (ring // 2 <= 0.5 * (a + b) < ring + ring // 2)):
            continue
        bisector = normals[a] + normals[b]
        if np.linalg.norm(bisector) < 1e-3:  # a half circle: along its middle
            bisector = normals[(a + b) // 2]
        bisector = bisector / np.linalg.norm(bisector)
        reach = max(REACH * (s[b] - s[a]), LEAST_REACH)
        low, high = np.searchsorted(s, s[a] - reach), np.searchsorted(s, s[b] + reach, "right")
        ground = points[low:high] + height[low:high, None] * rays[low:high]
        tip = a + int(np.argmax(points[a : b + 1] @ bisector))
        one = {
            "point": whole[tip].tolist(),
            "turn_deg": math.degrees(total),
            "design_radius_mm": float((s[b] - s[a]) / total),
            "radius_mm": None,
            "residual_mm": None,
            "chord_loss_mm": None,
            "faces": sorted({int(number) + 1 for number in face[a : b + 1]}),
        }
        if not np.isnan(ground).any():
            ground = _without_loops(ground)
            one["chord_loss_mm"] = float(points[tip] @ bisector - (ground @ bisector).max())
            one["radius_mm"], one["residual_mm"] = _radius(ground, normals[a], normals[b])
        found.append(one)
    return found


def _at_corners(points: Floats, normals: Floats, apart: Array) -> Floats:
    """Whether the profile turns outwards where two pieces meet in one point: by the ways on both sides."""
    signs = np.zeros(int(apart.sum()))
    for k, i in enumerate(np.flatnonzero(apart)):
        if i == 0 or i + 2 >= len(points):
            continue
        on = points[i + 2] - points[i + 1]
        signs[k] = 1.0 if normals[i] @ on < 0 else -1.0
    return signs


def _angle(one: Floats, other: Floats) -> Floats:
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.abs(np.arctan2(cross, (one * other).sum(axis=1)))


def _runs(marked: Array) -> list[tuple[int, int]]:
    edge = np.flatnonzero(np.diff(np.concatenate([[0], marked.astype(int), [0]])))
    return list(zip(edge[::2], edge[1::2]))


def _without_loops(line: Floats) -> Floats:
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


def _radius(line: Floats, first: Floats, last: Floats) -> tuple[float | None, float | None]:
    """(radius, root mean square of what the points are off) of a ground profile between two sides of the
    given normals; (0.0, None): sharp, (None, None): it does not turn, (None, ...): it is no arc."""
    ways = np.diff(line, axis=0)
    length = np.linalg.norm(ways, axis=1)
    keep = length > 1e-7
    line = np.concatenate([line[:1], line[1:][keep]])
    ways = ways[keep] / length[keep, None]
    if len(ways) < 2:
        return None, None
    # The way's direction goes with the normal's: from the first side's to the last's.
    sense = np.sign(first[0] * last[1] - first[1] * last[0]) or 1.0
    whole = float(_angle(first[None], last[None])[0])
    start = -np.array([-first[1], first[0]]) if sense < 0 else np.array([-first[1], first[0]])
    turned = sense * np.arctan2(
        start[0] * ways[:, 1] - start[1] * ways[:, 0], (ways * start).sum(axis=1)
    )
    if not whole > 0:
        return None, None
    inside = np.flatnonzero((turned > MIDDLE[0] * whole) & (turned < MIDDLE[1] * whole))
    if not len(inside):
        return 0.0, None  # from one side to the other without anything between
    points = line[inside[0] : inside[-1] + 2]
    if len(points) < LEAST_POINTS:
        arc = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        radius = float(arc / ((MIDDLE[1] - MIDDLE[0]) * whole))
        return (radius if radius > SHARP else 0.0), None
    radius, residual = _circle(points)
    return (radius if residual < ROUND * radius else None), residual


def _circle(points: Floats) -> tuple[float, float]:
    """(radius, root mean square of the distances) of the circle that fits points (n, 2) best."""
    middle = points.mean(axis=0)
    p = points - middle
    solved, *_ = np.linalg.lstsq(
        np.column_stack([2.0 * p, np.ones(len(p))]), (p**2).sum(axis=1), rcond=None
    )
    centre, radius = solved[:2], math.sqrt(max(solved[2] + solved[:2] @ solved[:2], 0.0))
    for _ in range(ROUNDS):  # from the algebraic circle, which is too small on short arcs
        away = p - centre
        distance = np.linalg.norm(away, axis=1)
        if not (distance > 0).all():
            break
        matrix = np.column_stack([-away / distance[:, None], -np.ones(len(p))])
        change, *_ = np.linalg.lstsq(matrix, radius - distance, rcond=None)
        centre, radius = centre + change[:2], radius + float(change[2])
        if np.abs(change).max() < 1e-9:
            break
    residual = float(np.sqrt(np.mean((np.linalg.norm(p - centre, axis=1) - radius) ** 2)))
    return abs(radius), residual
