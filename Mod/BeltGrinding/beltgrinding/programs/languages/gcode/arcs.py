"""The arcs of G-code: by centre, by radius, through a point, with several turns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ....base.kinds import known
from ...program import Unknown
from ..tool_axis import arc_through, centre_by_radius, checked_arc, helix_through
from .expression import Shifted
from .modes import PLANES, Modes

Place = Sequence[Any]  # mm; None: not known
Given = Mapping[str, Any]  # of a block's words
FROM_NOWHERE = ("programs.arc_from_nowhere", "an arc begins at a position that is not known")


class Arcs(Modes):
    """Adds arcs."""

    def through(
        self, line: int, start: Place, end: Place, axis: Sequence[float], given: Given
    ) -> None:
        """CIP: the circle through a point on the way."""
        point = list(start)
        for k, letter in enumerate(("I1", "J1", "K1")):
            if letter not in given:
                continue
            step = self.scale * given[letter]
            point[k] = step if self.absolute or start[k] is None else start[k] + step
        if None in start or not {"I1", "J1", "K1"} & {*given}:
            raise Unknown(*FROM_NOWHERE)
        self.trace.arcs(
            [tuple(point), tuple(end)], axis, self.inside or line, self.feed, self.base, self.tool
        )

    def arc(self, line: int, start: Place, end: Place, axis: Sequence[float], given: Given) -> None:
        if None in start:
            raise Unknown(*FROM_NOWHERE)
        if self.plane is None:
            raise Unknown(known(self.unclear))
        u, v, w = PLANES[self.plane]
        begin, target = (start[u], start[v]), (end[u], end[v])
        length = math.dist(begin, target)
        turns = given.get("TURN", 0.0)
        if "P" in given or turns != int(turns) or not 0 <= turns <= 999:
            raise Unknown("programs.gcode.turns", "an arc of several turns is not supported")
        middle: Any
        named = "CR" if self.dialect == "siemens" else "R"
        if named in given:
            middle = centre_by_radius(begin, target, self.scale * given[named], self.mode == 3)
        elif not {"IJK"[u], "IJK"[v]} & {*given}:
            raise Unknown("programs.gcode.no_centre", "the arc has neither centre nor radius")
        else:
            middle = [self.middle(k, start, given.get("IJK"[k], 0.0)) for k in (u, v)]
        checked_arc(begin, middle, target)
        centre = list(start)
        centre[u], centre[v] = middle
        sign = 1.0 if self.mode == 3 else -1.0
        place = (axis, self.inside or line, self.feed, self.base, self.tool)
        if turns or abs(end[w] - start[w]) > 1e-9:
            first, last = (math.atan2(p[1] - middle[1], p[0] - middle[0]) for p in (begin, target))
            angle = sign * (last - first) % (2.0 * math.pi)
            angle = 2.0 * math.pi if length < 1e-9 else angle
            whole = turns if self.dialect == "siemens" else 0.0
            if length < 1e-9 and whole:  # TURN counts the full circles beside the programmed one
                raise Unknown("programs.gcode.turns", "an arc of several turns is not supported")
            angle = sign * (angle + 2.0 * math.pi * whole)
            self.trace.helix(helix_through(start, centre, end, (u, v, w), angle), *place)
            return
        normal = [0.0, 0.0, 0.0]
        normal[w] = sign
        points = [*arc_through(start, centre, end, normal, length < 1e-9), tuple(end)]
        self.trace.arcs(points, *place)

    def middle(self, k: int, start: Sequence[float], value: float | Shifted) -> float:
        """A coordinate of an arc's centre, which I, J, K give from its start, mm."""
        if isinstance(value, Shifted):
            along = known(self.scale) * self.variables.value(value.expression)
            return along if value.absolute else start[k] + along
        return start[k] + known(self.scale) * value
