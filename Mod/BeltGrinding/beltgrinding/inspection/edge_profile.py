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
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core
from . import profile

LARGEST = 3.0  # mm, radius of an edge's design unless told otherwise
LEAST_TURN = math.radians(30.0)
REACH = 1.0  # of the edge's own length, on both sides of it
LEAST_REACH = 1.0  # mm
STATIONS = 24  # sections of an edge zone
NEIGHBOURS = 2.0  # radii of the zone within which normals tell an edge's direction
FLAT = 1e-3  # a smaller share of the normals' spread: no edge


def edges(section: Json, largest: float = LARGEST) -> list[dict[str, Any]]:
    """The edges that a section meets, in its order: dicts of ``point`` (3,) mm, the design's tip;
    ``turn_deg``; ``design_radius_mm``; ``radius_mm``, 0.0: sharp, None: not known, or no arc; ``residual_mm``, root mean
    square of the fit; ``chord_loss_mm``, None where stock was missed; ``faces`` from 1.
    """
    normal = np.asarray(section["normal"], dtype=float)
    axes = np.column_stack(profile.axes(normal))
    found = []
    for chain in profile.chains(section["pieces"]):
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
            for edge in edges(cut, max(radius, profile.SHARP))
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
    turn = profile.angle(normals[:-1], normals[1:])
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
            ground = profile.without_loops(ground)
            one["chord_loss_mm"] = float(points[tip] @ bisector - (ground @ bisector).max())
            one["radius_mm"], one["residual_mm"] = profile.radius(ground, normals[a], normals[b])
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


def _runs(marked: Array) -> list[tuple[int, int]]:
    edge = np.flatnonzero(np.diff(np.concatenate([[0], marked.astype(int), [0]])))
    return list(zip(edge[::2], edge[1::2]))
