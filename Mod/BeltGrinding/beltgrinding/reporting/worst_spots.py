"""The worst spots of a result: where a report looks closer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Json
from ..engine import core

MOST = 6
LARGEST = 4  # of them are the largest clusters, the others the worst of the rest
APART = 0.25  # of the field's extents: what lies nearer belongs to the same spot


def worst(
    field: core.HeightField, tolerance: Sequence[Any], verdict: Json | None = None
) -> list[dict[str, Any]]:
    """List of dicts: ``number`` (that of the verdict's cluster, or from 1), ``sample``, ``point``,
    ``normal`` (mm, work), ``deviation`` and ``beyond`` (mm past the limit), ``face`` (from 1), ``extent`` (mm; 0: not
    known) and, of a verdict's cluster, ``cluster`` (the cluster's dict). At most ``MOST``; none where
    all is in tolerance.
    """
    if verdict is not None:
        found = verdict["clusters"]
        rest = sorted(found[LARGEST:], key=lambda one: -one["worst"]["beyond_mm"])
        chosen = found[:LARGEST] + rest[: MOST - LARGEST]
        return [_of_cluster(one, field) for one in sorted(chosen, key=lambda one: one["number"])]
    lower, upper = tolerance
    beyond = np.maximum(field.height - upper, lower - field.height)
    beyond[(field.flags & core.MISSED) != 0] = 0.0
    apart = APART * float(np.linalg.norm(np.ptp(field.points, axis=0)))
    found = []
    while len(found) < MOST:
        k = int(np.argmax(beyond))
        if not beyond[k] > 0.0:
            break
        spot = _spot(field, k, float(field.height[k]), float(beyond[k]))
        found.append({"number": len(found) + 1, **spot})
        # A lane of excess is one spot, however long; a gouge beside it is another.
        same = np.sign(field.height) == np.sign(field.height[k])
        near = np.linalg.norm(field.points - field.points[k], axis=1) < apart
        beyond[near & same] = 0.0
    return found


def _spot(
    field: core.HeightField, k: int, deviation: float, beyond: float, extent: float = 0.0
) -> dict[str, Any]:
    return {
        "sample": k,
        "point": field.points[k].tolist(),
        "normal": field.normals[k].astype(float).tolist(),
        "deviation": deviation,
        "beyond": beyond,
        "face": int(field.faces[k]) + 1,
        "extent": extent,
    }


def _of_cluster(cluster: Json, field: core.HeightField) -> dict[str, Any]:
    k = int(cluster["worst"]["sample"])
    spot = _spot(field, k, cluster["worst"]["value_mm"], cluster["worst"]["beyond_mm"])
    extent = max(cluster["extent_mm"], cluster["width_mm"])
    return {
        "number": cluster["number"],
        **spot,
        "extent": float(extent),
        "cluster": cluster,
    }
