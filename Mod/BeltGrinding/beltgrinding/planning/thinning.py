"""Fewer samples for the solver: no denser than the contact can tell apart."""

from __future__ import annotations

import numpy as np

from ..base.kinds import Floats, Json
from ..engine import core
from ..job.settings import Job
from ..job.typed import typed

PER_CELL = 1.5  # samples along a cell of the contact: as the simulation wants them at least


class Thinned:
    """One sample stands for all in a cube of space, on its side of the part, with the area of all. What a motion removes
    changes no faster than from cell to cell of the contact's grid, so that a plan needs no more."""

    def __init__(self, field: core.HeightField, job: Job | Json, weight: Floats) -> None:
        """``weight`` (samples,): their areas mm2, 0 of those that do not count."""
        size = max(typed(job).belt_machine.contact_spacing_mm, PER_CELL * field.spacing) / PER_CELL
        self.kept, self.weight = np.arange(field.size), weight
        if size <= PER_CELL * field.spacing:
            return  # each would stand for one or two
        places = np.floor(np.asarray(field.points, dtype=float) / size).astype(np.int64)
        sides = (np.asarray(field.normals) > 0.0).astype(np.int64)
        keys = np.zeros(field.size, dtype=np.int64)
        for column in (*places.T, *sides.T):
            column = column - column.min()
            keys = keys * (int(column.max()) + 1) + column
        # The largest of a cube stands for it: none that does not count stands for others.
        order = np.lexsort((-weight, keys))
        first = np.append(True, np.diff(keys[order]) != 0)
        rising = np.argsort(order[first])
        self.kept = order[first][rising]
        self.weight = np.add.reduceat(weight[order], np.flatnonzero(first))[rising]

    def influence(self, influence: core.Influence, samples: int) -> core.Influence:
        """That on the samples that are kept, of ``samples``."""
        if len(self.kept) == samples:
            return influence
        number = np.full(samples, -1)
        number[self.kept] = np.arange(len(self.kept))
        found = number[influence.sample]
        mine = found >= 0
        before = np.append(0, np.cumsum(mine))
        return core.Influence(
            before[influence.first.astype(int)], found[mine], influence.depth[mine]
        )
