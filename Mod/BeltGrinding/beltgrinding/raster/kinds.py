"""Names of types that stand in many signatures of raster paths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Protocol, TypeAlias

from ..base.kinds import Array, Floats
from ..job.robot_time import Limits

# Of a pass, as the core's lines: points, normals, tangents (n, 3), closed, and what it got since.
Piece: TypeAlias = dict[str, Any]
Levels: TypeAlias = Sequence[Sequence[Piece]]  # of each level line its pieces
Extents: TypeAlias = tuple[float, float, Optional[float]]  # mm along and across a contact; its gap


class Room(Protocol):
    """What passes ask of ``clearing.Clearing``, which lays on what they have."""

    def fits_upright(self, frames: Floats) -> Array:
        ...

    def cut(self, strokes: list[Piece]) -> list[Piece]:
        ...

    def heights(self, frames: Floats, most: float) -> Floats:
        ...


class Ramps(Protocol):
    """What passes ask of ``entry.Entry``: how the wheel comes on the faces and off them."""

    force: Any  # N; None under position control
    lead: float
    block: float  # mm
    border: float  # of the force, at borders; 0: it grows evenly from outside
    limits: Limits

    def leads(self, frames: Floats, outwards: Floats, most: Floats, clearing: Room) -> Floats:
        ...

    def ramp(self, lead: float = 0.0) -> float:
        ...

    def ramps(self, leads: Sequence[float], length: float) -> Floats:
        ...

    def shares(self, places: Floats, leads: Sequence[float], length: float) -> Floats:
        ...
