"""Wheels that grind one after the other, each where those before it do not get to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..base.kinds import Array, Context, Json
from ..engine import InputError, core
from . import reachable
from .raster_path import raster


def in_turn(
    steps: Sequence[tuple[Json, Json]], context: Context = None
) -> tuple[list[dict[str, Any] | None], dict[str, Any]]:
    """Raster paths of several wheels one after the other, each where those before it do not get to.

    ``steps``: list of (validated job, settings of its raster), all of the same part and faces. Returns (list of
    what ``raster_path.raster`` gives, None for a wheel that nothing is left for; dict(points, areas, left (n,) bool:
    by all of them)). Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    found: list[dict[str, Any] | None] = []
    left: Array | None = None
    places: Any = None  # of the path before
    for k, (job, settings) in enumerate(steps):
        part = context.part(k / len(steps), (k + 1) / len(steps))
        if left is not None:
            if not left.any():
                found.append(None)
                continue
            settings = {**settings, "region_points": places["points"][left].tolist()}
        laid = raster(job, settings, part)
        if places is not None and len(laid["places"]["points"]) != len(places["points"]):
            raise InputError(
                "raster.other_faces",
                "the wheels that grind in turn need the same part and the same faces",
            )
        found.append(laid)
        places = laid["places"]
        now = places["state"] != reachable.GROUND
        left = now if left is None else left & now
    return found, {"points": places["points"], "areas": places["areas"], "left": left}
