"""What a report tells of."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..engine import core
from ..simulation.result import Result


class Content(NamedTuple):
    """``shape``, ``verdict``, ``convergence`` and ``bins`` (the time series of ``charts.binned``) are None where there is
    none; ``title``: of the part.
    """

    result: Result
    title: str
    source: str  # where the result lies; '' for a document's
    shape: core.Shape | None
    bins: dict[str, Any] | None
    verdict: dict[str, Any] | None
    convergence: dict[str, Any] | None
    notes: list[Any]  # facts or sentences that are shown on top
