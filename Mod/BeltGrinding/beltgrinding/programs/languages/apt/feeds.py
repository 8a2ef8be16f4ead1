"""What UNITS and FEDRAT of an APT file say: the unit of length, and speeds."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence

from ...program import MAX_COORDINATE, Fact, ProgramError, Unknown
from ..milling import Milling
from ..tool_axis import NO_UNITS
from .words import FEED_UNITS, INCH, LENGTHS, MINUTE, NUMBER

INCHES = Fact("programs.inches", "inches")


class Feeds(Milling):
    """The units of a file as its statements tell them."""

    def __init__(self, language: str, name: str, units: str | None) -> None:
        """``units``: "mm", "inch" or None, of a file that does not say it."""
        super().__init__(language, name)
        self.given = LENGTHS[units.upper()] if units else None
        self.scale: float | None = None  # mm a unit; None: not known
        self.why: Fact = NO_UNITS
        # (line, mm) of the last UNITS, as long as nothing moves after it.
        self.said: tuple[int, float] | None = None
        self.rapid = False
        self.speed: float | None = None  # mm/s
        self.per: tuple[float | None, float | None] = (None, MINUTE)  # the last FEDRAT's unit

    @staticmethod
    def numbers(values: Sequence[str], *counts: int) -> list[float]:
        if len(values) not in counts:
            expected: Fact | str = str(counts[0])
            for count in counts[1:]:
                expected = Fact("programs.or", "{one} or {other}", one=expected, other=str(count))
            raise Unknown(
                "programs.apt.count",
                "it has {count} values, not {expected}",
                count=len(values),
                expected=expected,
            )
        result: list[float] = []
        for value in values:
            if not NUMBER.fullmatch(value):
                raise Unknown("programs.apt.no_number", "'{value}' is no number", value=value[:30])
            result.append(float(value.replace("D", "E").replace("d", "e")))
            if not math.isfinite(result[-1]):
                raise Unknown(
                    "programs.apt.number_too_large",
                    "'{value}' is too large a number",
                    value=value[:30],
                )
        return result

    def unit(self) -> float:
        """mm of a unit. Raises Unknown where nobody says it."""
        if self.scale is None:
            self.program.asks_units = True
            if self.given is None:
                raise Unknown(self.why)
            return self.given
        return self.scale

    def point(self, values: Iterable[float]) -> tuple[float, ...]:
        self.said = None
        scale = self.unit()
        self.program.units_mm.add(scale)
        return self.point_mm(tuple(scale * v for v in values))

    @staticmethod
    def point_mm(point: tuple[float, ...]) -> tuple[float, ...]:
        """A point in mm. Raises Unknown where it cannot be one."""
        if max(point) > MAX_COORDINATE or min(point) < -MAX_COORDINATE:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        return point

    def feed(self, line: int, word: str, rest: str, values: list[str]) -> None:
        names = [v.upper() for v in values if not NUMBER.fullmatch(v)]
        if names[:1] == ["RAPID"]:
            self.rapid = True
            return
        others = [v for v in values if NUMBER.fullmatch(v)]
        self.speed = None
        if len(others) != 1 or len(values) > 2:
            self.problem(
                line,
                "programs.apt.fedrat_not_understood",
                "FEDRAT is not understood; the speed is not known",
            )
            return
        if names and names[0] not in FEED_UNITS:
            self.problem(
                line,
                "programs.apt.fedrat_unit",
                "FEDRAT's unit in '{values}' is not known",
                values=", ".join(values)[:40],
            )
            return
        self.per = FEED_UNITS[names[0]] if names else self.per
        length, seconds = self.per
        if seconds is None:
            self.problem(
                line,
                "programs.apt.per_revolution",
                "a feed per revolution: the speed in mm/s is not known",
            )
            return
        value = self.numbers(others, 1)[0]
        self.rapid = False
        if not 0 < value < 1e9:
            self.problem(
                line,
                "programs.apt.fedrat_not_positive",
                "FEDRAT is not positive; the speed is not known",
            )
        elif length or self.scale or self.given:  # else no motion is read either
            self.speed = value * (length or self.unit()) / seconds

    def look_at_feeds(self, statements: Iterable[tuple[int, str]]) -> None:
        """Takes the unit of length that the feeds name, until UNITS says it, if they name one only."""
        found: dict[float, tuple[int, str]] = {}
        for line, text in statements:
            if text[:6].upper() == "FEDRAT":
                for word in re.findall(r"[A-Z]+", text[6:].upper()):
                    length = FEED_UNITS.get(word, (None,))[0]
                    if length:
                        found.setdefault(INCH if word[0] in "IF" else 1.0, (line, word))
            elif re.match(r"UNITS?\s*/", text, re.IGNORECASE):
                break
            elif text[:4].upper() == "FINI":
                break
        if len(found) == 1 and self.given is None:
            self.scale, (line, word) = next(iter(found.items()))
            self.problem(
                line,
                "programs.apt.units_of_feeds",
                "UNITS is not given; lengths are in {unit}, as the feed in {word} says",
                unit=INCHES if self.scale == INCH else "mm",
                word=word,
            )

    def units(self, line: int, word: str, rest: str, values: list[str]) -> None:
        name = values[0].upper() if len(values) == 1 else ""
        if name not in LENGTHS:
            raise ProgramError.at(
                self.file,
                line,
                "programs.apt.units",
                "UNITS/{unit} is unknown; use MM or INCHES",
                unit=name[:20],
            )
        before, self.said = self.said, (line, LENGTHS[name])
        self.scale = LENGTHS[name]
        if before and before[1] != self.scale:
            self.scale, self.said = None, before
            self.why = Fact(
                "programs.units_contradict",
                "two units of length are set one after the other (lines {first} and {second}); the motions are left "
                'out until you give the one that holds: --units mm or --units inch, or "units" in the values file',
                first=before[0],
                second=line,
            )
