"""What a search for feeds simulates: each try with its figures, told as it is found."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any


from ..base.kinds import Floats, Json
from ..simulation import run as runs
from .step import figures

if TYPE_CHECKING:
    from ..engine import core
    from .commands import Commands
    from ..simulation.result import Result


@dataclass
class Trial:
    """Feeds and forces that were simulated."""

    figures: dict[str, Any]  # as ``step.figures``
    feeds: Floats  # (commands,) mm/s
    factors: Floats  # (commands,) on the forces
    result: Result  # with its influence
    job: dict[str, Any]


class Trials:
    """Simulates each try and keeps its figures."""

    def __init__(
        self,
        commands: Commands,
        settings: Json,
        told: Callable[[dict[str, Any]], object] | None,
        context: core.RunContext,
    ) -> None:
        """``told(figures)``: is called after each, or None."""
        self.settings, self.context = settings, context
        self.rounds: list[dict[str, Any]] = []  # the figures of all
        self._told = told
        self._since = time.perf_counter()
        self.begin(commands)

    def begin(self, commands: Commands) -> None:
        """Takes ``commands`` for all that follow; the next to be simulated is their ``first``."""
        self.commands = commands
        self.first: Trial | None = None

    def simulate(
        self,
        feeds: Floats,
        factors: Floats,
        part: core.RunContext | None = None,
        forces: bool = False,
    ) -> Trial:
        """The ``Trial`` of feeds and factors (commands,). ``part``: of the context; ``forces``: with the influence of
        these."""
        job = self.commands.with_feeds(feeds, factors)
        part = part or self.context.part(1.0, 1.0)
        result = runs.run(job, part, influence=True, shifts=True, forces=forces)
        trial = Trial(figures(result, self.settings), feeds, factors, result, job)
        self.first = self.first or trial
        return trial

    def tell(self, trial: Trial, **more: object) -> Trial:
        """Adds ``more`` to a trial's figures, and the seconds since the one before; tells them. Returns the trial."""
        now = time.perf_counter()
        trial.figures.update(more, seconds=now - self._since)
        self._since = now
        self.rounds.append(trial.figures)
        if self._told is not None:
            self._told(trial.figures)
        return trial

    def forget(self, trial: Trial) -> None:
        """Drops what is large of a trial that nothing is planned from any more; ``first`` may be given back, and stays."""
        if trial is not self.first:
            trial.result.influence = trial.result.force_influence = None
