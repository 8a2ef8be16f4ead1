"""What the writer of a language gets."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...base.kinds import Floats
from ..program import Fact
from .frames import Frame


@dataclass
class Step:
    """A motion to be written. ``aux``: number of the auxiliary pose, None: no arc."""

    kind: str  # PTP, LIN, CIRC, SPL
    pose: int  # row of the poses
    aux: int | None
    speed: float | None  # mm/s
    force: float | None  # N
    tool: int  # row of the tools
    base: int
    zone: float | None = None  # mm, 0: it stops there; None: the program's blend
    note: str = ""  # what a comment before it says


@dataclass
class Sheet:
    """What the writer of a language gets."""

    name: str
    comments: list[str]
    steps: list[Step]
    positions: Floats  # (n, 3) mm
    quaternions: Floats  # (n, 4) w, x, y, z
    frames: Floats  # (n, 4, 4)
    tools: list[Frame]  # flange_from_tcp
    bases: list[Frame]  # robot_from_base
    speed_mm_s: float  # where a motion has none
    ptp_speed_mm_s: float
    blend_mm: float
    part_in_hand: bool
    notes: list[Fact] = field(default_factory=list)  # what the program takes for granted
