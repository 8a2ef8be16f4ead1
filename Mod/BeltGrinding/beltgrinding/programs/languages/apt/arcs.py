"""The arcs of an APT file: CIRCLE and MOVARC with what ends them, and contour motions (TLON,GOFWD)."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence

from ....base.kinds import known
from ...program import Unknown
from ..tool_axis import arc_through, unit
from . import contour
from .contour import RADIUS_ERROR
from .systems import Systems

Point = Sequence[float]
# (line, centre, normal, radius or None, angle or None)
Circle = tuple[int, tuple[float, ...], tuple[float, ...], float | None, float | None]

ENDING = ("GOTO", "FEDRAT", "PAINT")  # what may follow a CIRCLE
NAMES = ("CENTER", "AXIS", "RADIUS")  # of MOVARC's values, where it has them
SENSES = {"CLOCKWISE": -1.0, "CLW": -1.0, "COUNTERCLOCKWISE": 1.0, "CCLW": 1.0}


class Arcs(Systems):
    """The arc that waits for its end, and the direction of the next contour motion."""

    def __init__(self, language: str, name: str, units: str | None) -> None:
        super().__init__(language, name, units)
        self.circle: Circle | None = None  # waiting for its end
        # Direction of INDIRV, or of the motion before.
        self.forward: tuple[float, ...] | None = None
        self.part: contour.Surface | None = None  # of PSIS
        self.tool_on = False  # TLON: the tip is on the drive surface

    def tool_axis(self) -> tuple[float, ...]:
        raise NotImplementedError

    def arc(self, line: int, word: str, rest: str, values: list[str]) -> None:
        # NX: CIRCLE/x,y,z,i,j,k,radius,tolerance,...; MOVARC/x,y,z,i,j,k,radius[,ANGLE,degrees]
        values = [v for v in values if v.upper() not in NAMES]
        sense = 1.0
        if len(values) > 6 and values[-1].upper() in SENSES:
            sense = SENSES[values.pop().upper()]
        numbers = self.numbers(values[:7], 7, 6)
        normal = unit(numbers[3:6])
        if normal is None or min(numbers[6:], default=1.0) <= 0:
            raise Unknown("programs.apt.axis_or_radius", "its axis or its radius is zero")
        normal = tuple(sense * v for v in normal)
        centre = self.point(numbers[:3])
        # Without a radius it is the start's distance from the axis.
        radius = self.unit() * numbers[6] if len(numbers) == 7 else None
        angle = None
        if len(values) > 7 and values[7].upper() == "ANGLE":
            angle = math.radians(self.numbers(values[8:], 1)[0])
            if not 0 < abs(angle) <= 2 * math.pi + 1e-9:
                raise Unknown("programs.apt.angle", "its angle is not within one turn")
        elif len(values) > 7 and word == "MOVARC":
            raise Unknown(
                "programs.not_understood", "'{text}' is not understood", text=values[7][:30]
            )
        elif len(values) > 7:
            self.numbers(values[7:], *range(1, 10))
        self.circle = (line, centre, normal, radius, angle)

    def arc_before(self, word: str) -> None:
        """An arc that waits where a statement other than its end comes."""
        if not self.circle or word in ("GOTO", "PAINT"):
            return
        if self.circle[-1] is not None:
            self.arc_by_angle()
        elif word not in ENDING:
            self.circle = None
            raise Unknown(
                "programs.apt.arc_before_without_end", "the arc before it has no GOTO as its end"
            )

    def arc_by_angle(self) -> None:
        """Ends an arc of which the angle is given."""
        circle, self.circle = known(self.circle), None
        try:
            end, _ = self.ends_by_angle(circle)
            self.end_arc(circle[0], circle, end, self.tool_axis())
        except Unknown as unknown:
            self.lost(
                circle[0],
                "programs.left_out",
                "{what} is left out: {reason}",
                what="MOVARC",
                reason=unknown.fact,
            )

    def ends_by_angle(self, circle: Circle) -> list[tuple[float, ...]]:
        """The ends of an arc turned by its angle, and by it the other way."""
        _, centre, normal, _, angle = circle
        if self.trace.position is None:
            raise Unknown(
                "programs.apt.position_before_unknown", "the position before it is not known"
            )
        return [
            _turned(self.trace.position, centre, normal, sign * known(angle))
            for sign in (1.0, -1.0)
        ]

    def goto_after_arc(self, position: Point) -> bool:
        """Whether a GOTO ends the arc that waits; else that ends by its angle. Raises Unknown."""
        if self.circle is None:
            return False
        if self.circle[-1] is None:
            return True
        ends = self.ends_by_angle(self.circle) if self.trace.position is not None else []
        near = [math.dist(end, position) <= RADIUS_ERROR for end in ends]
        if near[1:] == [True] and not near[0]:
            self.circle = None
            raise Unknown(
                "programs.apt.angle_contradicts",
                "the angle of the arc before it leads the other way round",
            )
        if near[:1] != [True]:
            self.arc_by_angle()
            return False
        return True

    def end_arc(self, line: int, circle: Circle, end: Point, axis: Point) -> None:
        """Adds the arc from where the tool is to ``end``. Raises Unknown."""
        _, centre, normal, radius, angle = circle
        start = self.trace.position
        if start is None:
            raise Unknown(
                "programs.arc_from_nowhere", "an arc begins at a position that is not known"
            )
        for point in (start, end):
            offset = [a - b for a, b in zip(point, centre)]
            along = sum(a * b for a, b in zip(offset, normal))
            across = math.sqrt(max(0.0, sum(v * v for v in offset) - along * along))
            radius = across if radius is None else radius
            if abs(across - radius) > max(RADIUS_ERROR, 1e-3 * radius):
                raise Unknown(
                    "programs.apt.arc_off_circle", "the arc's start or end is not on its circle"
                )
        if angle is not None and angle < 0:
            normal = tuple(-v for v in normal)
        self.draw_arc(line, centre, normal, end, math.dist(start, end) < 1e-6, axis)

    def draw_arc(
        self, line: int, centre: Point, normal: Point, end: Point, full: bool, axis: Point
    ) -> None:
        """Adds an arc counterclockwise about ``normal``."""
        points = [*arc_through(known(self.trace.position), centre, end, normal, full), end]
        self.trace.arcs(points, axis, line, self.speed, tool=self.tool, base=self.base)
        spoke = [a - b for a, b in zip(end, centre)]
        n = normal
        self.forward = (
            n[1] * spoke[2] - n[2] * spoke[1],
            n[2] * spoke[0] - n[0] * spoke[2],
            n[0] * spoke[1] - n[1] * spoke[0],
        )

    def direction(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """INDIRV/i,j,k and INDIRP/x,y,z: where the next contour motion goes."""
        self.forward = None
        numbers = self.numbers(values, 3)
        if word == "INDIRP":
            if self.trace.position is None:
                raise Unknown(
                    "programs.apt.relative_to_unknown",
                    "it is relative to a position that is not known",
                )
            numbers = [a - b for a, b in zip(self.point(numbers), self.trace.position)]
        self.forward = unit(numbers)

    def part_by_itself(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """AUTOPS."""
        self.part = None

    def part_surface(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """PSIS/(PLANE/...): the surface that the tip stays on."""
        self.part = contour.Surface(None, None)  # not known
        with contextlib.suppress(Unknown):  # the motions along it say so
            (item,) = contour.parsed(rest)[:1] or [None]
            self.part = contour.surface(item, self.unit())

    def contour(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """GOFWD/drive,ON,check: an arc up to a line or a plane. Raises Unknown."""
        rapid, self.rapid = self.rapid, False
        forward, self.forward = self.forward, None
        if not self.tool_on:
            raise Unknown(
                "programs.apt.tool_beside",
                "the tool goes beside its curve: where its tip is depends on the cutter",
            )
        if self.trace.position is None:
            raise Unknown(
                "programs.arc_from_nowhere", "an arc begins at a position that is not known"
            )
        if forward is None:
            raise Unknown(
                "programs.apt.no_sense",
                "INDIRV or INDIRP do not say which way round the arc goes",
            )
        drive, check, count, touching = contour.statement(contour.parsed(rest), self.unit())
        centre, normal, end, full = contour.arc(
            drive, check, count, touching, self.trace.position, forward, self.part
        )
        target = self.point_mm(tuple(end.tolist()))
        axis = self.tool_axis()
        if rapid:
            self.trace.move("PTP", target, axis, line, None, tool=self.tool, base=self.base)
        else:
            self.draw_arc(line, tuple(centre.tolist()), tuple(normal.tolist()), target, full, axis)


def _turned(point: Point, centre: Point, normal: Point, angle: float) -> tuple[float, ...]:
    """``point`` turned by ``angle`` (rad) about the line through ``centre`` along ``normal``."""
    v = [a - b for a, b in zip(point, centre)]
    n, c, s = normal, math.cos(angle), math.sin(angle)
    along = sum(a * b for a, b in zip(n, v))
    cross = (n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2], n[0] * v[1] - n[1] * v[0])
    return tuple(
        o + c * a + s * b + (1.0 - c) * along * d for o, a, b, d in zip(centre, v, cross, n)
    )
