"""The motions of Klartext: lines, arcs, polar coordinates."""

from __future__ import annotations

import math
import re
from collections.abc import Hashable, Mapping
from typing import Any

from ....base.kinds import known
from ...program import MAX_COORDINATE, Fact, Told, Unknown
from ..set_frames import standing
from ..tool_axis import (
    arc_through,
    axis_by_angles,
    centre_by_radius,
    checked_arc,
    helix_through,
    unit,
)
from .corners import Corners, Point
from .placement import Placement, spatial

Given = Mapping[str, Any]  # of a block's words
PLANES = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (2, 0, 1)}  # a pole's: its axes, and that across
VALUE = r"(?:[-+]\s*)?(?:(?:\d+(?:[.,]\d*)?|[.,]\d+)(?![\d.,])|Q[LR]?\d+)"
WORD = re.compile(
    rf"\s*(?:(R0|RL|RR)(?!\w)|(DR[-+])(?![\d.,Q])|F\s*(MAX|AUTO)(?!\w)|(I?P[RA]|I?[XYZABC]|[NT][XYZ]|M|FZ|FU|F|R|LA|MB)\s*"
    rf"({VALUE})(?!\w)|(MB\s*MAX|[RFMABC])(?!\S))"
)
# M functions that have words of their own behind them.
WITH_WORDS = {
    118: "XYZ",
    103: "F",
    120: ("LA",),
    128: "F",
    140: ("F", "MB"),
    **dict.fromkeys((94, 116, 138), "ABC"),
}
ONTO_PLANE = re.compile(
    r"(?<!\S)(?:A\s*\+?Q120|B\s*\+?Q121|C\s*\+?Q122)(?!\S)"
)  # as PLANE computes them
KINEMATICS = Fact(
    "programs.klartext.kinematics",
    "rotary axes without M128 or FUNCTION TCPM are machine coordinates: the machine's kinematics is needed; "
    "post-process with tool-centre-point control",
)
NOT_TILTED = Fact(
    "programs.klartext.stay", "the angles of the rotary axes in the tilted plane are not known"
)


class Moves(Corners):
    """The words of a block, and where it goes."""

    def lost(
        self,
        line: int,
        told: Told,
        text: str | None = None,
        /,
        key: Hashable = None,
        **arguments: object,
    ) -> None:
        super().lost(line, told, text, key=key, **arguments)
        self.tangent = self.before = None

    def placed(self) -> None:
        """The frame has changed: the tool stands where it stood."""
        before = self.trace.frame or Placement().frame
        frame = self.placement.frame
        if not frame.nothing or self.trace.frame is not None:
            self.at, changed = standing(self.at, before, frame)
            self.stands |= changed
        self.trace.frame = None if frame.nothing else frame
        self.pole = self.polar = self.tangent = self.before = None

    # Words

    def words(self, text: str) -> tuple[Given, list[int]]:
        """({word: value}, [M]) of a motion's block. Raises Unknown."""
        given: dict[str, Any] = {}
        functions: list[int] = []
        at, last = 0, None
        text = text.rstrip()
        while at < len(text):
            match = WORD.match(text, at)
            if not match:
                raise Unknown(
                    "programs.cannot_be_parsed", "cannot read '{text}'", text=text[at:].strip()[:30]
                )
            at = match.end()
            name, value = self._word(match)
            if name is None:
                if match[6] in "ABC" and last not in (94, 116, 138):
                    raise Unknown(
                        "programs.cannot_be_parsed", "cannot read '{text}'", text=match[6]
                    )
                continue
            if name == "M":
                functions.append(int(value))
                last = value
            elif last in WITH_WORDS:
                if name not in WITH_WORDS[last]:
                    raise Unknown(
                        "programs.klartext.after_m",
                        "what belongs to M{number} is not known",
                        number=f"{last:g}",
                    )
            elif name in given:
                raise Unknown("programs.gcode.word_twice", "{letter} occurs twice", letter=name)
            else:
                given[name] = value
        return given, functions

    def _word(self, match: re.Match[str]) -> tuple[Any, Any]:
        compensation, turn, feed, name, text, empty = match.groups()
        if compensation:
            return "COMP", compensation
        if turn:
            return "DR", 1.0 if turn == "DR+" else -1.0
        if feed:
            return "F", feed
        if empty:
            return None, None
        value = self.parameters.value(text)
        if abs(value) > MAX_COORDINATE:
            raise Unknown("programs.out_of_bounds", "{what} is out of all bounds", what=name)
        return name, value

    def set_feed(self, line: int, given: Given) -> bool:
        """Takes the feed of a block; True where it goes at FMAX."""
        if "FZ" in given or "FU" in given:
            self.feed = None
        value = given.get("F")
        if value == "AUTO":
            self.feed = self.of_tool
        elif value is not None and value != "MAX":
            self.feed = self.feed_of(line, value)
        return value == "MAX"

    def feed_of(self, line: int, value: float) -> float | None:
        """mm/s; None: not known."""
        if value <= 0:
            self.problem(
                line, "programs.gcode.feed_not_positive", "F is not positive; the last one stays"
            )
            return self.feed
        if self.scale != 1.0 or self.per_turn:
            self.once(
                "feed",
                line,
                "programs.klartext.feed",
                "F in an INCH program, or after M136: the speed in mm/s is not known",
            )
            return None
        return value / 60.0

    # Targets

    def cartesian(self, given: Given) -> list[float | None]:
        """Where X, Y, Z, IX, IY, IZ of a block go, mm; None in it: not known."""
        target = list(self.at)
        for k, letter in enumerate("XYZ"):
            if letter in given and "I" + letter in given:
                raise Unknown("programs.gcode.word_twice", "{letter} occurs twice", letter=letter)
            if letter in given:
                target[k] = self.scale * given[letter]
                self.stands.discard(letter)
            elif "I" + letter in given:
                known = target[k] is not None and letter not in self.stands
                target[k] = target[k] + self.scale * given["I" + letter] if known else None
        return target

    def polar_target(self, given: Given) -> tuple[list[float | None], tuple[float, float]]:
        """Where PR, PA, IPR, IPA go about the pole. Raises Unknown."""
        if self.pole is None:
            raise Unknown("programs.klartext.no_pole", "there is no CC that is known")
        radius, angle = self.polar or (None, None)
        for name, scale in (("PR", self.scale), ("PA", 1.0)):
            value = radius if name == "PR" else angle
            if name in given:
                value = scale * given[name]
            elif "I" + name in given:
                value = None if value is None else value + scale * given["I" + name]
            radius, angle = (value, angle) if name == "PR" else (radius, value)
        if radius is None or angle is None:
            raise Unknown("programs.klartext.polar", "PR or PA is not known")
        target = self.about_pole(given, radius, math.radians(angle))
        return target, (radius, angle)

    def about_pole(self, given: Given, radius: float, angle: float) -> list[float | None]:
        """The place at a radius in mm and an angle in rad about the pole; along the axis across it as given."""
        plane, pole = known(self.pole)
        across = "XYZ"[plane[2]]
        if {n.lstrip("I") for n in given} & {*"XYZ"} - {across}:
            raise Unknown("programs.klartext.polar", "PR or PA is not known")
        target = self.cartesian(given)
        target[plane[0]] = pole[0] + radius * math.cos(angle)
        target[plane[1]] = pole[1] + radius * math.sin(angle)
        self.stands -= {"XYZ"[plane[0]], "XYZ"[plane[1]]}
        return target

    def turn_axes(self, given: Given) -> None:
        """Takes the rotary words."""
        for letter in "ABC":
            if letter in given:
                self.rotary[letter], self.vector, self.stance = given[letter], None, ""
            elif "I" + letter in given:
                known = self.rotary.get(letter)
                self.rotary[letter] = None if known is None else known + given["I" + letter]
                self.vector, self.stance = None, ""

    def take_vector(self, given: Given) -> None:
        """The axis of an LN block: TX, TY, TZ under TCPM, without them the surface's normal."""
        names = [n for n in ("TX", "TY", "TZ") if n in given] or [
            n for n in ("NX", "NY", "NZ") if n in given
        ]
        if not self.tcpm:  # T is ignored then
            return
        axis = unit([given.get(names[0][0] + letter, 0.0) for letter in "XYZ"]) if names else None
        if axis is None or self.tcpm == "unknown":
            raise Unknown("programs.klartext.vector", "TX, TY, TZ are no direction")
        self.vector, self.rotary, self.stance = axis, dict.fromkeys("ABC"), ""

    def axis(self) -> tuple[float, ...]:
        """The tool's axis in the program's first coordinates. Raises Unknown."""
        plane = self.placement.plane
        if self.stance == "unknown":
            raise Unknown(NOT_TILTED)
        if self.stance == "plane" and plane is not None:
            return tuple(map(float, plane[:, 2]))
        if self.vector is not None:
            if plane is not None or self.placement.angle:
                raise Unknown(NOT_TILTED)
            return self.vector
        if None in self.rotary.values():
            names = ", ".join(n for n, v in self.rotary.items() if v is None)
            raise Unknown("programs.gcode.not_known", "{names} is not known", names=names)
        if plane is not None:
            raise Unknown(NOT_TILTED)
        if not any(self.rotary.values()):
            return (0.0, 0.0, 1.0)
        if self.tcpm is None:
            raise Unknown(KINEMATICS)
        if self.tcpm == "unknown" or self.placement.angle:
            raise Unknown(NOT_TILTED)
        if self.tcpm == "spatial":
            return tuple(
                map(float, spatial(*(known(self.rotary.get(n, 0.0)) for n in "ABC"))[:, 2])
            )
        return axis_by_angles(self.rotary)

    # Motions

    def go(self, line: int, kind: str, given: Given, onto_plane: bool) -> None:
        """One motion of a block whose words are read. Raises Unknown."""
        start: Any
        target: Any
        polar: Any
        swept: Any
        if kind in ("LP", "CP", "CTP"):
            helical = kind == "CP" and "IPA" in given
            target, polar = (None, None) if kind == "CP" else self.polar_target(given)
            if kind == "CP":
                target, polar, swept = self.swept(given, helical)
        else:
            target, polar, swept = self.cartesian(given), None, None
        start, self.at = self.at, target
        self.polar = polar
        rapid = self.set_feed(line, given)
        if kind == "LN":
            self.take_vector(given)
        self.turn_axes(given)
        if onto_plane and self.placement.plane is not None:
            self.stance = "plane"
        missing = [letter for letter, v in zip("XYZ", target) if v is None]
        why = self.placement.unknown or next(iter(self.shifted.values()), None)
        if why:
            raise Unknown(why)
        axis = self.axis()
        if missing:
            raise Unknown(
                "programs.gcode.not_known", "{names} is not known", names=", ".join(missing)
            )
        if max(target) > MAX_COORDINATE or min(target) < -MAX_COORDINATE:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        place = (axis, self.inside or line, None if rapid else self.feed, self.base, self.tool)
        if kind in ("L", "LP", "LN"):
            start = self.round_corner(line, start, target, rapid, place)
            self.trace.move("PTP" if rapid else "LIN", target, *place)
            self.before = None if rapid or None in start else start
            self.tangent = (
                None if None in start else unit([target[0] - start[0], target[1] - start[1], 0.0])
            )
            return
        self.drop_corner()
        if None in start:
            raise Unknown(
                "programs.arc_from_nowhere", "an arc begins at a position that is not known"
            )
        self.arc(kind, given, start, target, swept if kind == "CP" else None, place)

    def swept(self, given: Given, helical: bool) -> tuple[Any, Any, float]:
        """(end, polar, angle in rad) of CP about the pole."""
        plane, pole = self.pole or (PLANES["XY"], None)
        at: list[Any] = self.at
        if pole is None or None in (at[plane[0]], at[plane[1]]):
            raise Unknown("programs.klartext.no_pole", "there is no CC that is known")
        x, y = at[plane[0]] - pole[0], at[plane[1]] - pole[1]
        radius, begin = math.hypot(x, y), math.degrees(math.atan2(y, x))
        sign = given.get("DR", 0.0)
        if helical:
            angle = given["IPA"]
            if angle * sign < 0 or not angle:
                raise Unknown("programs.klartext.sense", "IPA and DR do not turn the same way")
        elif "PA" in given and sign:
            angle = sign * ((sign * (given["PA"] - begin)) % 360.0)
            angle = angle if abs(angle) > 1e-9 else 360.0 * sign
        else:
            raise Unknown("programs.klartext.sense", "IPA and DR do not turn the same way")
        end = math.radians(begin + angle)
        target = self.about_pole(given, radius, end)
        return target, (radius, begin + angle), math.radians(angle)

    def arc(
        self,
        kind: str,
        given: Given,
        start: Point,
        end: Point,
        swept: float | None,
        place: tuple[Any, ...],
    ) -> None:
        sign = given.get("DR", 0.0)
        plane, pole = self.pole if self.pole and kind in ("C", "CP") else (PLANES["XY"], None)
        u, v, w = plane
        begin, target = (start[u], start[v]), (end[u], end[v])
        length = math.dist(begin, target)
        if kind in ("CT", "CTP"):
            middle, sign = self.tangential(begin, target)
        elif kind == "CR":
            if "R" not in given or not sign:
                raise Unknown("programs.gcode.no_centre", "the arc has neither centre nor radius")
            middle = centre_by_radius(begin, target, self.scale * given["R"], sign > 0)
        elif pole is None or not sign and swept is None:
            raise Unknown("programs.klartext.no_pole", "there is no CC that is known")
        else:
            middle = pole
        checked_arc(begin, middle, target)
        centre = list(start)
        centre[u], centre[v] = middle
        climbs = abs(end[w] - start[w]) > 1e-9
        if swept is not None:
            sign = math.copysign(1.0, swept)
        if swept is not None and (climbs or abs(swept) > 2.0 * math.pi + 1e-9):
            self.trace.helix(helix_through(start, centre, end, plane, swept), *place)
        elif climbs:
            raise Unknown(
                "programs.klartext.climbing", "an arc that climbs is written as CP with IPA"
            )
        else:
            full = length < 1e-9 if swept is None else abs(abs(swept) - 2.0 * math.pi) < 1e-9
            normal = [0.0, 0.0, 0.0]
            normal[w] = sign
            points = arc_through(start, centre, end, normal, full)
            self.trace.arcs([*points, tuple(end)], *place)
        self.before = self.tangent = None
        if w == 2:
            self.tangent = unit(
                [-sign * (target[1] - middle[1]), sign * (target[0] - middle[0]), 0.0]
            )

    def tangential(self, begin: Point, end: Point) -> tuple[Point, float]:
        """(centre, 1 counterclockwise or -1) of the arc that goes on from where the tool comes. Raises Unknown."""
        way = (end[0] - begin[0], end[1] - begin[1])
        tangent = self.tangent or (0.0, 0.0)
        across = way[1] * tangent[0] - way[0] * tangent[1]
        if abs(across) < 1e-9:
            raise Unknown("programs.klartext.tangent", "from where the arc comes is not known")
        reach = (way[0] ** 2 + way[1] ** 2) / (2.0 * across)
        middle = (begin[0] - reach * tangent[1], begin[1] + reach * tangent[0])
        return middle, math.copysign(1.0, reach)
