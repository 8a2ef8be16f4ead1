"""Passes round faces: rings on closed faces, and the helix on surfaces of revolution."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.kinds import Array, Floats, Json
from ..engine import InputError

ROUND = 0.05  # sine, root mean square, between normals and the planes through an axis of revolution
ALONG_AXIS = 0.7  # share of a normal along the axis, on the mean: faces that lie across it rather than along it
TURNS = 0.05  # of the area, at least, that must lie both ways for a profile that turns
BINS = 400  # of the profile
CLOSED = 0.9  # of a full turn that faces round an axis take
SECTORS = 72


class Axis:
    """The axis round which faces go: ``place`` (3,) mm, ``way`` (3,) unit, ``revolution``: bool, they are a surface of
    revolution; ``turn``: the share of a full turn that they take about it.
    """

    def __init__(self, points: Floats, normals: Floats, areas: Floats) -> None:
        """By the lines along the normals (n, 3) at points (n, 3), mm: those of a surface of revolution all meet its
        axis, least squares of n (a x x + b) over axes (Pottmann, Randrup: Rotational and helical surface
        approximation for reverse engineering, Computing 60, 1998). Else the direction that they have least of.
        """
        weight = areas.astype(float) / areas.sum()
        middle = (points * weight[:, None]).sum(axis=0)
        moved = points - middle
        size = math.sqrt((moved**2).sum(axis=1) @ weight)
        x = moved / max(size, 1e-12)
        rows = np.hstack([np.cross(x, normals), normals])
        matrix = (rows * weight[:, None]).T @ rows
        self.place, self.way, self.revolution = middle, np.zeros(3), False
        # Without b: what of the equation b can take up is taken out (Schur complement).
        a, b, c = matrix[:3, :3], matrix[:3, 3:], matrix[3:, 3:]
        back = np.linalg.pinv(c, rcond=1e-9, hermitian=True) @ b.T
        mean = normals.T @ weight
        spread = np.linalg.eigh((normals * weight[:, None]).T @ normals)[1].T

        def revolved(ways: Iterable[Floats]) -> list[tuple[float, Axis]]:
            """(unevenness, Axis) of those of the ways that are an axis of revolution."""
            found = []
            for way in ways:
                shift = -back @ way
                shift -= (shift @ way) * way  # a rotation, no screw
                place = middle + size * np.cross(way, shift)
                if self._error(points, normals, weight, place, way) < ROUND:
                    one = copy.copy(self)
                    one.place, one.way, one.revolution = place, way, True
                    found.append((one._settle(points, weight), one))
            return found

        found = revolved(np.linalg.eigh(a - b @ back)[1].T)
        if len(found) > 1:
            # A sphere has all axes: the one that the faces lie evenly round is wanted.
            found += revolved(spread)
            if np.linalg.norm(mean) > ROUND:
                found += revolved([mean / np.linalg.norm(mean)])
        self.turn = 0.0
        if found:
            self.__dict__ = min(found, key=lambda one: one[0])[1].__dict__
        if self.turn < CLOSED:
            # A bent tube may be a piece of a torus, round whose axis it does not go.
            tube = copy.copy(self)
            tube.place, tube.revolution, tube.way = middle, False, spread[0]
            tube._settle(points, weight)
            looks = np.sort(tube.angles(normals + middle))
            gap = np.diff(looks, append=looks[0] + 2.0 * math.pi).max()
            if gap > math.pi:  # a dome lies round about its middle, but does not look every way
                tube.turn = min(tube.turn, 1.0 - gap / (2.0 * math.pi))
            if not self.revolution or tube.turn >= CLOSED:
                self.__dict__ = tube.__dict__

    def _settle(self, points: Floats, weight: Floats) -> float:
        """Turns the axis up, and finds the share of a turn that the points take. Returns how unevenly they lie round
        it: the standard deviation of the sectors' weights."""
        k = int(np.argmax(abs(self.way)))
        self.way = self.way * (1.0 if self.way[k] > 0 else -1.0)
        angles, radius = self.angles(points), self.radii(points)
        off = radius > 1e-3 * max(radius.max(), 1e-12)
        self.turn = _turn(angles[off])
        return np.bincount(_sectors(angles), weight, SECTORS).std()

    @staticmethod
    def _error(
        points: Floats, normals: Floats, weight: Floats, place: Floats, way: Floats
    ) -> float:
        """Root mean square of the sine between the normals and the planes through an axis."""
        off = points - place
        tangent = np.cross(way, off)
        length = np.linalg.norm(tangent, axis=1)
        sound = length > 1e-3 * length.max()
        sine = (normals[sound] * tangent[sound]).sum(axis=1) / length[sound]
        return math.sqrt((sine**2) @ weight[sound] / weight[sound].sum())

    def heights(self, points: Floats) -> Floats:
        """mm (n,) along the axis."""
        return (points - self.place) @ self.way

    def radii(self, points: Floats) -> Floats:
        """mm (n,) from the axis."""
        return np.linalg.norm(np.cross(points - self.place, self.way), axis=1)

    def angles(self, points: Floats) -> Floats:
        """rad (n,) about the axis, -pi to pi."""
        first = np.cross(self.way, np.eye(3)[int(np.argmin(abs(self.way)))])
        first /= np.linalg.norm(first)
        off = points - self.place
        return np.arctan2(off @ np.cross(self.way, first), off @ first)


def _sectors(angles: Floats) -> NDArray[np.int_]:
    """Number of the sector (n,) in which angles (n,) rad, -pi to pi, lie."""
    return ((angles + math.pi) / (2.0 * math.pi) * SECTORS).astype(int) % SECTORS


def _turn(angles: Floats) -> float:
    """The share of a full turn that angles (n,) rad take."""
    return len(np.unique(_sectors(angles))) / SECTORS


def sheet(points: Floats, normals: Floats, triangles: Array, areas: Floats) -> dict[str, Any]:
    """dict(scalars (m, 3), angles (n,) rad or None, profile (n,) mm or None) of faces, triangles (m, 3) on points
    (n, 3) with normals and areas, mm: the scalar does not change round them. A helix has angles and the length along
    the profile of a surface of revolution. Raises InputError for faces that do not go round.
    """
    axis = Axis(points, normals, areas)
    if axis.turn < 0.5:
        raise InputError(
            "raster.not_round",
            "the faces do not go round: they take {share:.0f} % of a turn about their axis; choose all faces round "
            "it, or lay the passes along u, v or a direction",
            share=100.0 * axis.turn,
        )
    across = abs(normals @ axis.way)
    weight = areas.astype(float) / areas.sum()
    flat = across @ weight > ALONG_AXIS
    scalar = axis.radii(points) if flat else axis.heights(points)
    found = {"scalars": scalar[triangles], "angles": None, "profile": None}
    turns = weight[across > 0.95].sum() > TURNS and weight[across < 0.5].sum() > TURNS
    if axis.revolution and not turns:
        other = axis.heights(points) if flat else axis.radii(points)
        found["angles"] = axis.angles(points)
        found["profile"] = _along_profile(scalar, other, weight)
    return found


def _along_profile(place: Floats, other: Floats, weight: Floats) -> Floats:
    """mm (n,) along the profile of a surface of revolution, from the two coordinates of its points."""
    edges = np.linspace(place.min(), place.max(), min(BINS, max(len(place) // 50, 2)) + 1)
    k = np.clip(np.digitize(place, edges) - 1, 0, len(edges) - 2)
    total = np.bincount(k, weight, len(edges) - 1)
    means = [np.bincount(k, weight * a, len(edges) - 1) for a in (place, other)]
    known = total > 0
    x, y = (a[known] / total[known] for a in means)
    if len(x) < 2:
        return place - place.min()
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    slopes = (s[1] - s[0]) / (x[1] - x[0]), (s[-1] - s[-2]) / (x[-1] - x[-2])
    found = np.interp(place, x, s)
    found += np.minimum(place - x[0], 0.0) * slopes[0] + np.maximum(place - x[-1], 0.0) * slopes[1]
    return found


def helix(sheets: Sequence[Json], pitch: float) -> list[dict[str, Any]]:
    """Sheets whose level lines are one helix of ``pitch`` mm along the profile. Raises InputError where a sheet has
    none."""
    found = []
    for one in sheets:
        if one.get("angles") is None:
            raise InputError(
                "raster.no_helix",
                "{key}: a helix needs a surface of revolution whose profile does not turn from along its axis to "
                "across; take rings (order zigzag or one_way), or fewer faces",
                key="raster.order",
            )
        profile = one["profile"]
        length = profile.max() - profile.min()
        rise = length / max(math.ceil(length / pitch - 1e-9), 1)
        scalars = (profile - rise * one["angles"] / (2.0 * math.pi)) % rise
        found.append({**one, "scalars": scalars[one["triangles"]], "period": rise})
    return found
