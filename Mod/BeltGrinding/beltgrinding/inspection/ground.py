"""What a verdict and a section read of a result, which a layer above makes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from ..base.kinds import Array, Json

if TYPE_CHECKING:
    from ..cell.motions import Motions
    from ..engine import core


class Ground(Protocol):
    """A ground field and the job that it was ground by."""

    job: dict[str, Any]
    field: core.HeightField


class Told(Ground, Protocol):
    """Adds what the run reports; ``simulation.result.Result`` is one."""

    events: list[dict[str, Any]]
    steps: dict[str, Array] | None
    summary: dict[str, Any]
    verdict: dict[str, Any] | None


class Judged(Told, Protocol):
    """And what a verdict needs to know of the run."""

    motions: Motions | None

    def judged_by(self) -> Json:
        """The ``inspection`` whose limits the verdict is by."""
