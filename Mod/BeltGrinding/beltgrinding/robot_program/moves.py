"""What a program for the whole robot is made of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

from ..base.kinds import Facts, Floats


@dataclass
class Move:
    """A motion of the program. ``joints_deg``: six angles at its end, None: not known, the arm does not get there."""

    kind: str  # PTP: by joints; LIN
    frame: Floats  # base_from_tcp at its end, mm
    joints_deg: Optional[Floats]
    feed: float = 0.0  # mm/s; PTP: not used
    force: float = -1.0  # N
    zone: float = 0.0  # mm; -1: the job's default
    line: int = 0
    note: str = ""
    external: tuple[float, ...] = ()  # where the external axes are at its end, mm or degrees


@dataclass
class Whole:
    """A program for the whole robot. ``problems``: for which it must not run; ``notes``: what is to be known of it."""

    moves: list[Move] = field(default_factory=list)
    problems: Facts = field(default_factory=list)
    notes: Facts = field(default_factory=list)
    figures: dict[str, Any] = field(default_factory=dict)
