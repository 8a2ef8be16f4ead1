"""The motions of G-code: what the words of a block move."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ....base.kinds import known
from ...program import MAX_COORDINATE, Fact, Unknown
from ..set_frames import about
from ..tool_axis import A_AND_B, MACHINE_COORDINATES, NO_UNITS, axis_by_angles, unit
from .arcs import Arcs
from .expression import Shifted, Word, bracket_words, siemens_words
from .modes import AXES_OF_FRAME, LIMITS, MOTIONS

# What follows a number may be a function's name; without a limit, each word would look at all after it.
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)"
WORD = re.compile(rf"\s*([A-Z])\s*(?:=\s*)?({NUMBER})(?![\d.]|[A-Z]\w{{0,40}}\s{{0,40}}\()")
# Of a block of SINUMERIK's in which every value is a number, as most are: its words, and one of them.
ONE = rf"\s*(?:([A-KM-Z])\s*(?={NUMBER}(?:\s|[A-DF-Z]|$))|([ABC][23]|[A-KM-Z]|CR|TURN|[IJK]1)\s*=\s*(?={NUMBER}(?:\s+[A-Z]|\s*$)))({NUMBER})"
QUICK, ALL_QUICK = re.compile(ONE), re.compile(rf"(?:{ONE})+\s*")
COMPUTED = re.compile(r"[=#\[(]|(?<![A-Z])[A-Z]{2}")  # a block with more than letters and numbers
BARE = ("CIP", "ORIWKS", "ORIMKS", "ORIEULER", "ORIRPY")
# Words that change neither the path nor a value; MORE: with others behind the same beginning.
NAMED = (
    "ORIAXES ORIVECT ORIPLANE ORIMACHAX ORIVIRT1 ORIVIRT2 ORICURVE ORIPATH ORIPATHS ORISON ORISOF ORION ORIOF ORIRESET "
    "ORIROTA ORIROTC ORIROTR ORIROTT ORIROTS SOFT BRISK DRIVE FFWON FFWOF FIFOCTRL UPATH SPATH STOPRE WALIMON WALIMOF "
    "COMPON COMPOF COMPCURV COMPCAD CUT2D CUT2DF CFC CFIN NORM KONT CDOF CDON"
).split()
MORE = re.compile(rf"(?:{'|'.join(NAMED)}|COMP\w+|CUT2D\w*|ORIVIRT[12X]\w*)$")
TURNING = {letter + of: None for of in "32" for letter in "ABC"}.keys()  # in this order
MEANT = {"CR", "TURN", *TURNING, "I1", "J1", "K1", *"XYZABCIJKFSTDHMGPRQE"}
AXES, CENTRE = frozenset("XYZABC"), frozenset("IJK")
NO_TARGET = {*LIMITS, *AXES_OF_FRAME}
# Reasons that hold for many motions of a file, made once.
TILTED = Fact(
    "programs.gcode.tilted",
    "only the control knows the orientation of the tool in a turned frame; write A3, B3, C3 with ORIWKS",
)
KINEMATICS = {fact.code for fact in (MACHINE_COORDINATES, A_AND_B, TILTED)}


class Moves(Arcs):
    """Takes the words of blocks; what moves becomes motions."""

    def split(self, body: str) -> Sequence[Word]:
        """[(address, value)] of a block; every character belongs to a word. A value is a number, or a Shifted of
        an expression. Raises Unknown."""
        if self.dialect and COMPUTED.search(body):
            return self.computed(body)
        return self.plain(body)

    @staticmethod
    def plain(body: str) -> list[Word]:
        """``split`` of a block of letters and numbers."""
        words: list[Word] = []
        at = 0
        while at < len(body):
            match = WORD.match(body, at)
            if not match:
                raise Unknown(
                    "programs.cannot_be_parsed", "cannot read '{text}'", text=body[at:].strip()[:30]
                )
            letter, value = match.group(1), float(match.group(2))
            if abs(value) > MAX_COORDINATE:
                raise Unknown("programs.out_of_bounds", "{what} is out of all bounds", what=letter)
            if letter == "E" and at and body[at - 1 : at].strip() and body[at] == "E":
                raise Unknown(
                    "programs.gcode.e_word", "E after a number: an exponent or a word of its own"
                )
            words.append((letter, value))
            at = match.end()
        return words

    @staticmethod
    def quick(body: str) -> list[Word] | None:
        """The words of a block of SINUMERIK's in which every value is a number; None: it is none."""
        if not ALL_QUICK.fullmatch(body):
            return None
        words = [(a or b, float(value)) for a, b, value in QUICK.findall(body)]
        return words if all(abs(value) <= MAX_COORDINATE for _, value in words) else None

    def computed(self, body: str) -> list[Word]:
        """``split`` of a block with expressions."""
        siemens = self.dialect == "siemens"
        words: list[Word] = []
        for address, by, value in (siemens_words if siemens else bracket_words)(body):
            if value is None and (address in BARE or MORE.match(address)):
                words.append((address, None))
                continue
            if value is None or not isinstance(address, str) or address not in MEANT:
                raise Unknown(
                    "programs.cannot_be_parsed", "cannot read '{text}'", text=str(address)[:30]
                )
            if not isinstance(value, Shifted):
                value = float(self.variables.value(value))
                if abs(value) > MAX_COORDINATE:
                    raise Unknown(
                        "programs.out_of_bounds", "{what} is out of all bounds", what=address
                    )
            elif address not in "XYZABCIJK":
                raise Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=address)
            words.append((address, value))
        return words

    def turn(self, given: dict[str, Any]) -> bool:
        """Takes the tool's axis from A3, B3, C3 (any length; left out: 0), or from A2, B2, C2; True where it is
        given."""
        if TURNING.isdisjoint(given):
            return False
        parts = [letter for letter in TURNING if letter in given]
        if len({part[1] for part in parts}) > 1 or self.tcp != "angles":
            raise Unknown("programs.gcode.vector", "A3, B3, C3 are no direction, or without TRAORI")
        a, b, c = (given.pop(letter + parts[0][1], 0.0) for letter in "ABC")
        if parts[0][1] == "3":
            axis = unit([a, b, c])
        elif self.angles == "ORIRPY":
            axis = tuple((about(2, c) @ about(1, b) @ about(0, a))[:, 2])
        elif self.angles == "ORIEULER":
            axis = tuple((about(2, a) @ about(0, b))[:, 2])
        else:
            raise Unknown(
                "programs.gcode.which_angles",
                "A2, B2, C2 are Euler or RPY angles by ORIEULER or ORIRPY, which the program does not say",
            )
        if axis is None:
            raise Unknown("programs.gcode.vector", "A3, B3, C3 are no direction, or without TRAORI")
        self.vector = axis
        return True

    def words(self, line: int, words: Iterable[Word]) -> bool:
        """Follows the words of a block; False at the program's end."""
        given: dict[str, Any] = {}
        codes: list[float] = []
        going, changes = True, False
        for letter, value in words:
            if letter == "G":
                codes.append(value)
            elif letter == "M":
                going = going and value not in (2, 30)
                changes = changes or value == 6
                if value in (98, 97):
                    raise Unknown(
                        "programs.gcode.subprogram", "a subprogram's motions are not in this block"
                    )
            elif letter in given:
                raise Unknown("programs.gcode.word_twice", "{letter} occurs twice", letter=letter)
            elif letter in "UVWL":
                raise Unknown(
                    "programs.gcode.meaning",
                    "the meaning of {letter} is known to the control only",
                    letter=letter,
                )
            elif value is None:
                self.bare(letter)
            else:
                given[letter] = value
        if "T" in given:
            self.waiting = f"T{given['T']:g}"
        if changes or not self.by_m6:  # a T before its M6 only fetches the tool
            self.tool = self.waiting
        if 4 in codes:  # dwell: X and F are times
            for code in codes:
                self.code(line, code)
            return going
        once = None
        for code in codes:
            once = self.code(line, code) or once
        turned = self.turn(given)
        if 54.1 in codes and "P" in given:
            self.base = f"G54.1 P{given.pop('P'):g}"
        if "F" in given:
            self.set_feed(line, given["F"])
        self.set_zone(codes, given)
        if not NO_TARGET.isdisjoint(codes) and MOTIONS.isdisjoint(codes):
            return going
        if once == 92:
            if not AXES.isdisjoint(given):
                self.shift(
                    Fact("programs.gcode.origin", "G92 sets an origin that is not known here")
                )
            return going
        moves = (
            turned
            or not AXES.isdisjoint(given)
            or not CENTRE.isdisjoint(given)
            and (self.mode in (2, 3, "CIP") or self.tcp)
        )
        if moves and once not in (28, 30, 53):
            self.move(line, given)
        elif once in (28, 30) or moves:
            self.at = [None, None, None]
            self.lost(
                line,
                "programs.gcode.machine_coordinates",
                "G{code} goes to the machine's coordinates; it is left out",
                code=once,
            )
        return going

    def bare(self, word: str) -> None:
        """A word without a value."""
        if word == "CIP":
            self.mode = "CIP"
        elif word in ("ORIWKS", "ORIMKS"):
            self.orientation = word
        elif word in ("ORIEULER", "ORIRPY"):
            self.angles = word

    def meant(self, value: float | Shifted) -> tuple[bool | None, float]:
        """(whether a word's value is absolute, None: not known; its number)"""
        if isinstance(value, Shifted):
            return value.absolute, self.variables.value(value.expression)
        return self.absolute, value

    def target(self, k: int, letter: str, value: float | Shifted) -> float | None:
        """Where an axis goes, mm; None: not known."""
        absolute, value = self.meant(value)
        if absolute is None or self.scale is None:
            return None
        if absolute:
            self.stands.discard(letter)
            return self.scale * value
        before = self.at[k]
        if before is None or letter in self.stands:
            return None
        return before + self.scale * value

    def move(self, line: int, given: Mapping[str, Any]) -> None:
        target: list[Any] = list(self.at)
        for k, letter in enumerate("XYZ"):
            if letter in given:
                target[k] = self.target(k, letter, given[letter])
        for letter in "ABC":
            if letter in given:
                absolute, value = self.meant(given[letter])
                before: Any = 0.0 if absolute else self.rotary.get(letter, 0.0)
                known = absolute is not None and before is not None
                self.vector, self.rotary[letter] = None, before + value if known else None
        start, self.at = self.at, target
        try:
            axis = self.tool_axis(given)
            if self.shifted:
                raise Unknown(self.shifted)
            if self.mode is None:
                raise Unknown("programs.gcode.no_mode", "no G0, G1, G2 or G3 is in force")
            if self.unclear and None in (self.absolute, self.scale):
                raise Unknown(self.unclear)
            self.program.asks_units = self.program.asks_units or not self.said
            if self.scale is None:
                raise Unknown(NO_UNITS)
            self.program.units_mm.add(self.scale)
            missing = [letter for letter, v in zip("XYZ", target) if v is None]
            if missing:
                raise Unknown(
                    "programs.gcode.not_known", "{names} is not known", names=", ".join(missing)
                )
            if max(target) > MAX_COORDINATE or min(target) < -MAX_COORDINATE:
                raise Unknown(
                    "programs.position_out_of_bounds", "the position is out of all bounds"
                )
            if self.mode == "CIP":
                self.through(line, start, target, axis, given)
            elif self.mode in (2, 3):
                self.arc(line, start, target, axis, given)
            else:
                kind, speed = ("LIN", self.feed) if self.mode else ("PTP", None)
                self.trace.move(
                    kind, target, axis, self.inside or line, speed, self.base, self.tool
                )
        except Unknown as unknown:
            # A thousand motions left out for one reason are one Problem.
            fact = unknown.fact
            if fact is NO_UNITS:
                self.lost(line, fact, key=fact)
                return
            once = self.shifted or fact is self.unclear or fact.code in KINEMATICS
            key = fact if once else None
            self.lost(
                line,
                "programs.motion_left_out",
                "the motion is left out: {reason}",
                reason=fact,
                key=key,
            )

    def tool_axis(self, given: Mapping[str, Any]) -> tuple[float, ...]:
        """The tool's axis in the program's first coordinates."""
        axis, of_frame = self.axis_there(given)
        if not self.frame.turns:
            return axis
        if of_frame and self.orientation is not None:
            return self.frame.direction(axis) if self.orientation == "ORIWKS" else axis
        if of_frame or any(self.rotary.values()) or not self.frame.keeps_z:
            raise Unknown(TILTED)
        return axis

    def axis_there(self, given: Mapping[str, Any]) -> tuple[tuple[float, ...], bool]:
        """(the tool's axis, whether it is a direction in the frame)"""
        if self.tcp == "unknown" and self.vector is None and not self.rotary:
            raise Unknown(known(self.unclear))
        if self.tcp == "vector":
            if self.mode in (0, 1) and any(letter in given for letter in "IJK"):
                axis = unit([given.get(letter, 0.0) for letter in "IJK"])
                if axis is None:
                    raise Unknown("programs.gcode.zero_axis", "I, J, K of the tool's axis are zero")
                self.axis = axis
            return self.axis, True
        if self.vector is not None:
            return self.vector, True
        unknown = [letter for letter, v in self.rotary.items() if v is None]
        if unknown:
            raise Unknown(
                "programs.gcode.not_known", "{names} is not known", names=", ".join(unknown)
            )
        if not any(self.rotary.values()):
            return (0.0, 0.0, 1.0), False
        if self.tcp is None:
            raise Unknown(MACHINE_COORDINATES)
        if self.tcp == "unknown":
            raise Unknown(known(self.unclear))
        return axis_by_angles(self.rotary), False
