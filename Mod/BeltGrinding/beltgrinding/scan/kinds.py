"""What scans are compared with, which a layer above makes, and names of types that stand in many signatures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from ..base.kinds import Floats, Json

if TYPE_CHECKING:
    from ..engine import core
    from .file import Scan

Start: TypeAlias = "Floats | str | None"  # work_from_scan (4, 4), "principal", or as it lies
Fitted: TypeAlias = "Callable[[Scan], Json | None]"  # about how a Scan fits
Register: TypeAlias = Callable[
    [Floats, int, int], Json
]  # by a matrix, with so many points and rounds


class Ground(Protocol):
    """A job and its field."""

    @property
    def job(self) -> Json:
        ...

    @property
    def field(self) -> core.HeightField:
        ...


class Kept(Protocol):
    """A result that lies in a folder."""

    @property
    def summary(self) -> Json:
        ...

    def update(
        self,
        verdict: bool = False,
        measured: bool = False,
        others: Mapping[str, bytes] | None = None,
    ) -> Any:
        ...
