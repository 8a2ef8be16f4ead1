"""What holds from block to block of Klartext, and how a corner is cut: RND and CHF between two lines."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ....base.kinds import known
from ...program import Fact, Unknown, name_of
from ..core.listing import Listing
from ..milling import Milling
from ..tool_axis import unit
from .expression import Parameters
from .placement import Placement

Place = Sequence[Any]  # mm, None: not known
Point = Sequence[float]


class Corners(Milling, Listing):
    """What holds from block to block."""

    def __init__(self, path: Path | str) -> None:
        Milling.__init__(self, "Klartext", name_of(path))
        Listing.__init__(self, path)
        self.parameters = Parameters()
        self.placement = Placement()
        self.at: list[float | None] = [None, None, None]  # mm in the frame that is set
        # Letters of axes whose place is not that which was programmed.
        self.stands: set[str] = set()
        self.rotary: dict[str, float | None] = {}  # degrees
        self.vector: tuple[float, ...] | None = None  # the tool's axis by TX, TY, TZ
        self.stance = ""  # "plane": it stands on the tilted plane; "unknown"
        self.tcpm: str | None = None  # "angles", "spatial", "unknown"
        self.scale = 1.0
        self.feed: float | None = None  # mm/s
        self.of_tool: float | None = None
        self.per_turn = False
        # A plane's axes and the pole in it; radius in mm and angle in degrees about it.
        self.pole: tuple[tuple[int, int, int], tuple[float, float]] | None = None
        self.polar: tuple[float, float] | None = None
        self.tangent: tuple[float, ...] | None = None  # of the motion before, in the plane
        self.before: Point | None = None  # where the line before began
        # (mm, line, whether it is rounded, mm/s of what cuts it)
        self.corner: tuple[float, int, bool, float | None] | None = None
        # {what: why coordinates are unknown} beside the placement.
        self.shifted: dict[str, Fact] = {}
        self.cycle_everywhere = False  # M89

    def feed_of(self, line: int, value: float) -> float | None:
        raise NotImplementedError

    def drop_corner(self) -> None:
        """RND or CHF between others than two lines: the tool does not get to the corner."""
        if self.corner:
            line, self.corner = self.corner[1], None
            self.cut_corner(line)

    def cut(self, line: int, text: str) -> None:
        """RND and CHF."""
        match = re.match(r"(RND|CHF)\s+R?\s*(\S+)(?:\s+F\s*(\S+))?$", text)
        value = speed = None
        try:
            if match:
                value = self.scale * self.parameters.value(match[2])
                speed = (
                    self.feed
                    if not match[3]
                    else self.feed_of(line, self.parameters.value(match[3]))
                )
        except Unknown:  # of the feed: it is not known
            pass
        if match and value is not None and value > 0.0 and not self.corner:
            self.corner = (value, line, match[1] == "RND", speed)
            return
        self.corner = None
        self.cut_corner(line)

    def cut_corner(self, line: int) -> None:
        """The motion to a corner that is not reached, and what cuts it, are left out."""
        motions = self.program.motions
        if motions and motions[-1].pose is not None:
            motions.pop()
        self.lost(
            line,
            "programs.klartext.corner",
            "how this corner is cut is not followed; the motion to it is left out",
        )

    def round_corner(
        self, line: int, start: Place, end: Point, rapid: bool, place: tuple[Any, ...]
    ) -> Place:
        """The start of a line; behind RND or CHF that where the corner's arc or chamfer ends, which is appended."""
        if not self.corner:
            return start
        (size, at, rounded, speed), self.corner = self.corner, None
        ways = None
        if None not in start and not rapid and self.before is not None:
            ways = _legs(self.before, start, end)
        if ways is not None:
            u, v, room, half = ways
            reach = size / math.tan(half) if rounded else size
        if ways is None or reach > room + 1e-9:
            self.cut_corner(at)
            return [None] * 3
        first, last = ([s + reach * d for s, d in zip(start, way)] for way in (u, v))
        corner = self.program.motions.pop()
        again = (place[0], corner.line, corner.speed_mm_s, corner.base, corner.tool)
        self.trace.move("LIN", first, *again)
        way = (place[0], self.inside or at, speed, *again[3:])
        if rounded:
            middle = known(unit([p + q for p, q in zip(u, v)]))
            depth = size / math.sin(half) - size
            through = [s + depth * d for s, d in zip(start, middle)]
            self.trace.arcs([through, last], *way)
        else:
            self.once(
                "CHF",
                at,
                "programs.klartext.chamfer",
                "CHF: its length is taken along each of both lines, from the corner",
            )
            self.trace.move("LIN", last, *way)
        return last


def _legs(before: Point, corner: Point, end: Point) -> tuple[Any, ...] | None:
    """(unit vectors back and on from a corner, the length of the shorter leg, half the angle between them); None
    where they are no corner in a plane."""
    back, on = ([p - q for p, q in zip(one, corner)] for one in (before, end))
    u, v = unit(back), unit(on)
    if u is None or v is None or abs(back[2]) + abs(on[2]) > 1e-9:
        return None
    half = 0.5 * math.acos(max(-1.0, min(1.0, sum(p * q for p, q in zip(u, v)))))
    if not 1e-6 < half < math.pi / 2.0 - 1e-6:
        return None
    return u, v, min(math.hypot(*back), math.hypot(*on)), half
