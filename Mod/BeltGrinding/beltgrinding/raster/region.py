"""Passes on a part of the faces only: near points that are given, from a result or from what another wheel left."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from ..inspection import verdict
from ..job.settings import Job
from ..job.typed import typed
from ..simulation.result import Result
from . import reachable
from .clearing import as_one, begins, finer, part_of, runs
from .kinds import Levels, Piece

MOST_POINTS = 5_000  # of a region that is made of samples
FINE = 0.25  # of the margin: from place to place that is looked at along a pass
FINEST = 0.05  # mm, of the same
NEAREST = 0.99  # of a region's points must lie by the faces, or it is another part's
APART = 2.0  # of the margin: farther than that off the faces is elsewhere
MOST_CUBES = 1e6  # along one side: the numbers of all fit into 64 bits


def of_result(
    folder: Path | str, above_mm: float | None = None, clusters: Sequence[int] = ()
) -> tuple[Floats, float]:
    """(points (n, 3) mm, margin mm that their spacing asks for) where a result has too much left.

    ``folder``: of a run; ``above_mm``: more is too much, None: above its tolerance; ``clusters``: numbers, from 1, of
    its verdict's clusters, in place of that. Raises InputError where nothing is left, or a cluster is cut too deep.
    """
    result = Result.read(folder)
    field, job = result.field, result.job
    return of_field(field, job, above_mm, clusters, str(folder))


def of_field(
    field: core.HeightField,
    job: Job | Json,
    above_mm: float | None = None,
    clusters: Sequence[int] = (),
    where: str = "",
) -> tuple[Floats, float]:
    """The same of a ground core.HeightField of a job; ``where``: what it is called in errors."""
    job, height = typed(job), field.height.astype(float)
    if clusters:
        mines = []
        for number in clusters:
            mine = verdict.cluster_samples(job, field, number)
            if not len(mine):
                raise InputError(
                    "raster.no_such_cluster",
                    "{where}: the verdict has no cluster {number}",
                    where=where,
                    number=number,
                )
            if np.mean(height[mine]) < np.mean(job.inspection.tolerance_mm):
                raise InputError(
                    "raster.cluster_below",
                    "{where}: cluster {number} is cut too deep: there is nothing to come off",
                    where=where,
                    number=number,
                )
            mines.append(mine)
        chosen: Array = np.concatenate(mines)
    else:
        limit = job.inspection.tolerance_mm[1] if above_mm is None else above_mm
        chosen = np.flatnonzero(np.isfinite(height) & (height > limit) & (field.areas > 0))
        if not len(chosen):
            raise InputError(
                "raster.nothing_left",
                "{where}: nothing is left above {limit:.4g} mm: no passes are needed",
                where=where,
                limit=limit,
            )
    area = float(field.areas[chosen].sum())
    some = chosen[np.unique(np.linspace(0, len(chosen) - 1, MOST_POINTS).astype(int))]
    return field.points[some], 1.5 * math.sqrt(area / len(some))


def margin_of(settings: Json, width: float) -> float:
    """mm round a region's points; ``width``: of the contact, mm."""
    return settings["region_mm"] or 0.5 * width


def check(points: Floats, faces: Floats, margin: float) -> None:
    """Raises InputError if a region's points do not lie on faces that have ``faces`` (m, 3) points, mm."""
    off = reachable.nearest_distance(points, faces)
    far = weighted_quantile(off, np.ones(len(off)), NEAREST)
    spacing = weighted_quantile(
        reachable.nearest_distance(faces[:50], faces[50:]), np.ones(50), 0.9
    )
    if far > APART * max(margin, spacing):
        raise InputError(
            "raster.region_elsewhere",
            "{key}: the region lies up to {far:.3g} mm off the faces; is it of another part, or of other faces?",
            key="raster.region_points",
            far=far,
        )


def beside(places: Floats, points: Floats, margin: float) -> Array:
    """(n,) bool of ``places`` (n, 3): whether they may lie within ``margin`` mm of one of ``points`` (m, 3), by cubes as
    large as that: all that do, and some that lie a little farther."""
    low = np.minimum(places.min(axis=0), points.min(axis=0))
    size = np.maximum(places.max(axis=0), points.max(axis=0)) - low
    margin = max(margin, float(size.max()) / MOST_CUBES)
    low, sizes = low - 2.0 * margin, (size / margin).astype(np.int64) + 5

    def cubes(some: Floats) -> Array:
        return ((some - low) / margin).astype(np.int64)

    def keys(some: Array) -> Array:
        return np.ravel_multi_index(tuple(some.T), tuple(sizes))

    around = np.stack(np.meshgrid(*[(-1, 0, 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    taken = np.unique(keys(np.unique(cubes(points), axis=0)[:, None] + around).ravel())
    return np.isin(keys(cubes(places)), taken)


def restricted(levels: Levels, points: Floats, margin: float) -> Levels:
    """The pieces of passes by level, as ``clearing.cleared`` takes them, cut to where they are no farther than
    ``margin`` mm from one of ``points`` (n, 3). Shorter gaps than that are kept."""
    result, step = [], max(FINE * margin, FINEST)
    flat = finer([piece for pieces in levels for piece in pieces], step)
    if not flat:
        return levels
    all_near = reachable.nearest_distance(as_one(flat)["points"], points) <= margin
    parts = iter(zip(flat, np.split(all_near, begins(flat)[1:])))
    for pieces in levels:
        kept = []
        for piece, (fine, near) in zip(pieces, parts):
            for gap in runs(~near):
                inner = gap[0] > 0 and gap[-1] < len(near) - 1
                if inner and len(gap) * step < margin:
                    near[gap] = True
            if near.all():
                kept.append(piece)
                continue
            for run in runs(near):
                own = fine["own"][run]
                own[[0, -1]] = True
                if own.sum() < 2:
                    continue
                part: Piece = {**piece, **part_of(fine, run[own]), "closed": False}
                part.pop("own", None)
                part["cut"] = (run[0] > 0, run[-1] < len(near) - 1)
                kept.append(part)
        result.append(kept)
    return result
