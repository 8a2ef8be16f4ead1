"""States of earlier runs on their way, kept in this process, from which a run goes on whose programs begin the same:
what it gives is the same, to the last bit.

The engine compares the programs, step by step as it sees them (src/simulation, `Checkpoints`); what else the grinding
depends on is compared here: the field, the settings and what is to be kept of the run.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..base import kept
from ..base.kinds import Json
from ..engine import core

if TYPE_CHECKING:
    from ..job.engine_input import EngineInput

STAGE = "grinding"
SHARE = 0.5  # of the most that one kept value may take: the old states and the new ones together take that
OF_FIELD = ("points", "normals", "rays", "areas", "stock_height", "height", "faces", "flags") + (
    "triangles",  # which say what a sample on a border stands for
)


class RunCheckpoints:
    """Those of one run, program by program."""

    def __init__(
        self,
        field: core.HeightField,
        settings: EngineInput,
        recorded: bool,
        programs: int,
        wanted: bool = True,
        between: Sequence[object] = (),
    ) -> None:
        """``settings``: what core.simulate takes for the first program, plain data; ``recorded``: the run has a
        recording; ``programs``: how many there are; ``wanted``: else none are kept; ``between``: what happens before
        each program, plain data."""
        self._most = SHARE * kept.largest() / programs if wanted else 0.0  # bytes of a program's
        self._programs: list[core.Checkpoints] = []
        self._resumed, self._same = 0, True
        if self._most < 1.0:
            return
        arrays = [np.asarray(getattr(field, name)) for name in OF_FIELD]
        left = dict(field.finish or {})  # by an earlier run
        self._key = kept.digest(
            arrays, left, field.spacing, field.depth, settings, recorded, between
        )
        self._before = kept.find(STAGE, self._key) or []

    def next(self) -> core.Checkpoints | None:
        """core.Checkpoints for the next program; None where nothing is to be kept."""
        if self._most < 1.0:
            return None
        at = len(self._programs)
        # A program begins as it did if all before it did and ended the same.
        same = self._same and at < len(self._before)
        most = int(self._most)
        self._programs.append(self._before[at].within(most) if same else core.Checkpoints(most))
        return self._programs[-1]

    def ended(self, result: Json) -> None:
        """``result``: that of the program, of core.simulate."""
        self._resumed += result["resumed"]
        self._same = self._same and result["unchanged"]

    def keep(self) -> None:
        """Keeps them for the next run, those of a program that was cancelled on its way as well."""
        if self._programs:
            size = sum(one.bytes for one in self._programs)
            kept.put(STAGE, self._key, self._programs, size, self._resumed > 0)
