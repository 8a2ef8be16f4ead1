"""Edges that are not to be rounded: passes end where their contact would come too near to the border of the faces."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..base.kinds import Array, Context, Floats, Json
from ..engine import InputError, core
from . import passes
from .clearing import Clearing, finer, part_of, runs
from .kinds import Levels, Piece
from .reachable import nearest_distance

SAME = 0.05  # of the sampling: border samples of two faces so near are of an edge between them
FINE = 0.1  # of half the contact, with what is kept: that way from place to place that is looked at
BLOCK = 256  # places at once


def border(shape: core.Shape, faces: Sequence[int], spacing: float, context: Context) -> Floats:
    """Points (n, 3), ``spacing`` mm apart at most, on the border of all faces together: on no edge between two of them."""
    field, _ = core.sample_faces(shape, faces, spacing, context=context)
    mine = np.flatnonzero((np.asarray(field.flags) & core.ON_BOUNDARY) != 0)
    points, owner = np.asarray(field.points, dtype=float)[mine], np.asarray(field.faces)[mine]
    inner = np.zeros(len(points), dtype=bool)
    for face in np.unique(owner):
        own = owner == face
        if not own.all():
            inner[own] = nearest_distance(points[own], points[~own]) <= SAME * spacing
    return points[~inner]


class Kept:
    """Ends passes where the contact would come nearer than ``keep_edge_mm`` to the border of faces (from 0)."""

    def __init__(
        self,
        shape: core.Shape,
        faces: Sequence[int],
        spacing: float,
        sizes: Sequence[tuple[float | None, float | None]],
        settings: Json,
        clearing: Clearing,
    ) -> None:
        """``spacing``: mm of the samples; ``sizes``: mm along and across the passes that the contact may have, None: not
        known; the greatest holds. Raises InputError, Cancelled."""
        self._clearing, self._keep = clearing, settings["keep_edge_mm"]
        self._points = border(shape, faces, min(spacing, self._keep), clearing.context)
        halves = [0.5 * max(size or 0.0 for size in some) for some in zip(*sizes)]
        turn = abs(math.sin(math.radians(settings["belt_angle_deg"])))
        # Along and across the belt's travel.
        self._halves = np.array(halves if turn < math.sqrt(0.5) else halves[::-1]) + self._keep
        self._fine = FINE * float(self._halves.min())

    def spared(self, levels: Levels) -> Levels:
        """Pieces of passes without what comes too near; ends that are new have a ``cut``."""
        found = [[part for piece in pieces for part in self._parts(piece)] for pieces in levels]
        return [pieces for pieces in found if pieces]

    def _parts(self, piece: Piece) -> list[Piece]:
        (fine,) = finer([piece], self._fine)
        free = ~self._near(self._clearing.frames(fine))
        if free.all():
            return [piece]
        if piece["closed"] and free.any():  # its beginning is no end
            turn = int(np.argmin(free))
            order = np.append(np.roll(np.arange(len(free) - 1), -turn), turn)
            fine, free = part_of(fine, order), free[order]
        parts = []
        for run in runs(free):
            before, after = (True, True) if piece["closed"] else piece.get("cut", passes.UNCUT)
            cut = (run[0] > 0 or before, run[-1] < len(free) - 1 or after)
            part = {**piece, **part_of(fine, run), "closed": False, "cut": cut}
            part.pop("own", None)
            if len(run) > 1:
                parts.append(part)
        return parts

    def _near(self, frames: Floats) -> Array:
        """(n,) bool: a border point lies below the contact at a frame, widened by what is kept."""
        near = np.zeros(len(frames), dtype=bool)
        deep = float(self._halves.max())
        for k in range(0, len(frames), BLOCK):
            some = frames[k : k + BLOCK]
            way = self._points[None] - some[:, None, :3, 3]
            x, y, z = (abs(np.einsum("nkx,nx->nk", way, some[:, :3, axis])) for axis in (0, 1, 2))
            below = (x < self._halves[0]) & (y < self._halves[1]) & (z < deep)
            near[k : k + BLOCK] = below.any(axis=1)
        return near

    def refuse(self, levels: Levels) -> None:
        """Raises InputError where no pass is left."""
        if not any(levels):
            raise InputError(
                "raster.no_pass_beside_edges",
                "{key}: no pass is left whose contact stays {keep:g} mm off the border of the faces; lower it or the force, or "
                "take a narrower wheel",
                key="raster.keep_edge_mm",
                keep=self._keep,
            )
