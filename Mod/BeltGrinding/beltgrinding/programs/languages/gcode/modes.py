"""The modes of G-code: what G words say, and what is not known any more after what is not followed."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ...program import Fact, Unknown, name_of
from ..core.listing import Listing
from ..milling import Milling
from ..set_frames import Frame, standing
from .variables import Variables

INCH = 25.4  # mm
UNITS = {20: INCH, 70: INCH, 700: INCH, 21: 1.0, 71: 1.0, 710: 1.0}  # G words: mm
PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
MOTIONS = {0, 1, 2, 3}
TCP = {43.4: "angles", 43.5: "vector"}
OFFSETS = {54, 55, 56, 57, 58, 59, 500, *range(505, 600), 54.1, 59.1, 59.2, 59.3}
OFFSETS_OF_TOOL = {41, 42, 43, 44}
FEEDS = {93, 94, 95, 96}
MACHINE = {28, 30, 53, 92}  # to the machine's coordinates, or from them
CYCLES = {*range(33, 40), *range(73, 80), *range(81, 90)}
# No motion, and no change of what the coordinates mean.
HARMLESS = {4, 9, 40, 60, 61, 61.1, 62, 63, 64, 80, 94, 99, 98, 601, 602, 603, 641, 642, 643, 644}
HARMLESS |= {5.1, 8, 15, 22, 23, 25, 26, 45, 50, 50.1, 69, 67, 97, 450, 451}
HARMLESS |= {13.1, 103, 187, 460, 461, 462, 604, 605, 645}
LIMITS = {22, 25, 26}  # their X, Y, Z bound the room to move in
AXES_OF_FRAME = {68, 68.2, 51, 51.1, 52, 10, 158, 258, 168}  # their X, Y, Z are no target
FRAMES = {*AXES_OF_FRAME, 16, 7.1, 12.1, 112}
ZONES = {9, 60, 61, 61.1, 62, 63, 64, 641, 642, 643, 644}
FRAMES_END = {69, 50, 50.1, 15, 13.1}
GROUPS = ("mode", "absolute", "scale", "plane", "tcp", "base", "feed_mode")
CODE = re.compile(r"(?<![A-Z])G\s*=?\s*(?:(\d+(?:\.\d+)?)(?![\w.#\[])|)")
# Words with an effect of their own: those of flow and of functions have none on modes and frames.
OTHER = re.compile(r"(?<![A-Z0-9_#])[A-Z_]{2,}\w*")
PLAIN = set(
    "IF THEN ELSE ENDIF WHILE ENDWHILE FOR ENDFOR TO LOOP ENDLOOP REPEAT UNTIL GOTO GOTOF GOTOB GOTOC GOTOS DO END "
    "DEF REAL INT BOOL STRING AND OR XOR NOT DIV MOD SIN COS TAN ASIN ACOS ATAN ATAN2 SQRT POT ABS ROUND TRUNC "
    "FIX FUP EXP LN EQ NE GT GE LT LE AC IC DC ACP ACN".split()
)
# Words of Siemens' that are not followed and change what coordinates mean.
COORDINATE_WORDS = (
    "TOFRAME TOROT PAROT PRESETON TRANSMIT TRACYL TRAANG TRACON TCARR TCOABS TCOFR TOFF OFFN DIAMON DIAMOF CFTCP CUT3DC "
    "CUT3DF MCALL MEAFRAME"
).split()
COORDINATES = re.compile(rf"{'|'.join(COORDINATE_WORDS)}|DIAM|CUT3D|AROT|ATRANS|ROTS|CYCLE9\d\d")
# Assignments to variables of the control's own that set offsets.
OFFSET_VARIABLE = re.compile(r"(#(?:[257]|1[45])\d{3}|\$P_\w+|#\[)\S*\s*=")
FLOWS = re.compile(
    r"(?:IF\b(?!.*\bTHEN\b)|WHILE|FOR|LOOP|REPEAT$|UNTIL|ELSE|END(?:IF|FOR|WHILE|LOOP)?|GOTO[FBCS]?)\b|"
    r"O\s*(?:\d+|<[^<>]*>)\s*(?!CALL)[A-Z]"
)
ASSIGNED = re.compile(r"(#\d+|#<[^<>]*>|#|(?<![A-Z0-9_$])[A-Z_]\w*)(?:\[[^\[\]]*\])?\s*=(?!=)")


def frame_changed(word: str) -> Fact:
    return Fact(
        "programs.gcode.frame_changed", "{word} changes the frame in the control", word=word
    )


class Modes(Milling, Listing):
    """What holds from block to block."""

    dialect: str | None  # as ``units.dialect_of``'s
    variables: Variables

    def __init__(self, path: Path | str, by_m6: bool = False, units: str | None = None) -> None:
        Milling.__init__(self, "G-code", name_of(path))
        Listing.__init__(self, path)
        self.at: list[float | None] = [None, None, None]  # mm, None: unknown
        self.rotary: dict[str, float | None] = {}  # A, B, C in degrees as they stand
        self.mode: int | str | None = None  # 0, 1, 2, 3 of the group of motions, "CIP"
        # mm; None: not known
        self.scale: float | None = {None: None, "mm": 1.0, "inch": INCH}[units]
        self.said = self.basic = False  # a word says the unit; G70, G71: of lengths only
        self.absolute: bool | None = True
        self.plane: int | None = 17
        self.tcp: str | None = None  # of TCP's values, or "unknown"
        self.axis: tuple[float, ...] = (0.0, 0.0, 1.0)
        # The axis by A3, B3, C3, as long as it holds.
        self.vector: tuple[float, ...] | None = None
        self.feed_mode = 94
        self.feed: float | None = None  # mm/s
        self.zone: float | None = None  # mm around a corner, modal
        self.waiting = ""
        self.by_m6 = by_m6  # a T word takes the tool at the M6 only
        self.shifted: Fact | None = None  # why coordinates mean something that is not known here
        self.moved: set[str] = set()  # of X, Y, Z: along which they do
        self.unclear: Fact | None = None  # why modes are not known
        self.frame = Frame()  # that the program sets within the control's
        # Of X, Y, Z: known since a frame changed, but not for an increment.
        self.stands: set[str] = set()
        self.orientation: str | None = None  # ORIWKS or ORIMKS
        self.angles: str | None = None  # ORIEULER or ORIRPY
        self.ended = False  # by % or M99

    def unclear_since(self, line: int, text: str) -> Fact:
        return Fact(
            "programs.gcode.mode_unknown",
            "what '{text}' in line {begun} makes of it is not known",
            text=text[:30],
            begun=line,
        )

    def lose_modes(self, line: int, text: str, codes: bool = True) -> None:
        """No mode (or, without ``codes``, only the frame) is known after something that is not followed."""
        self.unclear = self.unclear_since(line, text)
        self.at = [None, None, None]
        self.rotary = dict.fromkeys(self.rotary)
        if self.vector is not None or self.tcp is not None or self.rotary:
            self.tcp = "unknown"
        self.vector = None
        self.base = f"{self.base.split(' after')[0]} after line {line}".strip()
        self.set_frame(Frame())
        self.orientation = self.angles = None
        if codes:
            self.mode = self.absolute = self.scale = self.plane = self.feed = self.zone = None

    def shift(self, why: Fact | None, axes: Iterable[str] = "XYZ") -> None:
        """Coordinates along ``axes`` mean something else from here on, for the Fact ``why``; None: the part's own
        again."""
        self.moved |= set(axes if why else "")
        self.at = [None if k in self.moved else v for k, v in zip("XYZ", self.at)]
        self.shifted = why
        self.moved = self.moved if why else set()
        if why is None:
            self.set_frame(Frame())

    def set_frame(self, frame: Frame) -> None:
        """The Frame that the program sets from here on; the tool stands where it stood."""
        before, self.frame = self.frame, frame
        self.trace.frame = None if frame.nothing else frame
        self.at, changed = standing(self.at, before, frame)
        self.stands |= changed  # by a setting of the control, G91 counts the shift or not

    def forget(self, line: int, body: str, maybe: bool = False) -> None:
        """What a block that cannot be followed may have changed is unknown afterwards; ``maybe``: it may not run."""
        offset = OFFSET_VARIABLE.match(body)
        if offset:
            self.shift(frame_changed(offset.group(1)))
        for name in ASSIGNED.findall(body):
            self.variables.drop(name)
        if FLOWS.match(body):  # ``Flow.jump_unknown``
            return
        others = [word for word in OTHER.findall(body) if word not in PLAIN]
        kept = [getattr(self, name) for name in GROUPS]
        for match in CODE.finditer(body):
            if not match[1]:
                self.lose_modes(line, body)
                break
            with contextlib.suppress(Unknown):
                self.code(line, float(match[1]))
        for name, before in zip(GROUPS, kept) if maybe else ():
            if getattr(self, name) != before:
                unknown = {
                    "tcp": "unknown",
                    "base": f"{before} or {self.base}",
                    "feed_mode": 0,
                }
                setattr(self, name, unknown.get(name))
                self.unclear = self.unclear_since(line, body)
        calls = others or re.search(r"(?<![A-Z])(?:M9[78]|G6[56]|L\d)", body)
        if (
            COORDINATES.match(body) or others and re.match(r"[A-Z_]{2,}\s+[A-Z]", body)
        ):  # as TRANS X1: a frame, for all one knows
            self.lose_modes(line, body, codes=False)
        if calls:
            self.variables.forget()
        self.at = [None if calls or k in body else v for k, v in zip("XYZ", self.at)]
        for letter in "ABC":
            if (calls and letter in self.rotary) or re.search(
                rf"{letter}[23]?\s*=?\s*[-+.#\dR(\[]", body
            ):
                self.rotary[letter] = self.vector = None
        if "F" in body:
            self.feed = None
        if re.search(r"(?<![A-Z])T(?!RA)", body):
            self.tool = self.waiting = f"T of line {line}"

    def code(self, line: int, code: float) -> int | None:
        """One G word; returns a code that holds for this block only."""
        if code in MOTIONS:
            self.mode = int(code)
        elif code in (58, 59) and self.dialect == "siemens":
            self.shift(frame_changed(f"G{code:g}"))
        elif code in UNITS:
            self.scale, self.said, self.basic = UNITS[int(code)], True, code in (70, 71)
        elif code in (90, 91):
            self.absolute = code == 90
        elif code in PLANES:
            self.plane = int(code)
        elif code in TCP:
            self.tcp = TCP[code]
        elif code == 49:
            self.tcp = self.vector = None
        elif code in OFFSETS:
            self.base = f"G{code:g}"
        elif code in OFFSETS_OF_TOOL:
            if code in (41, 42):
                self.once(
                    code,
                    line,
                    "programs.gcode.offset",
                    "G{code}: the control shifts the path; taken unshifted",
                    code=f"{code:g}",
                )
        elif code in MACHINE:
            return int(code)
        elif code in FRAMES:
            self.frame_lost(line, f"G{code:g}")
        elif code not in HARMLESS and code not in FEEDS:
            if code in CYCLES:
                self.mode = None
            else:
                self.lose_modes(line, f"G{code:g}")
            raise Unknown(
                "programs.gcode.unknown_code", "G{code} is not known here", code=f"{code:g}"
            )
        if code in FRAMES_END:
            self.shift(None)
        if code in (93, 94, 95):
            self.feed_mode, self.feed = int(code), None
        return None

    def frame_lost(self, line: int, word: str, axes: Iterable[str] = "XYZ") -> None:
        """Coordinates along ``axes`` are not known from here on."""
        self.shift(frame_changed(word), axes)
        self.problem(
            line,
            "programs.gcode.motions_left_out",
            "{reason}; the motions in it are left out",
            reason=self.shifted,
        )

    def set_zone(self, codes: list[float], given: dict[str, Any]) -> None:
        """G60, G61: exact stop; G9: in this block; G64 P: within P of the corner (LinuxCNC), which a
        zone of 2 P keeps to at any angle; other modes of continuous path: known to the control."""
        for code in codes:
            if code in (60, 61, 61.1):
                self.zone = 0.0
            elif code == 64 and given.get("P", 0.0) > 0 and self.scale:
                self.zone = 2.0 * self.scale * given.pop("P")
            elif code in (62, 63, 64, 641, 642, 643, 644):
                self.zone = None
        self.trace.zone = 0.0 if 9 in codes else self.zone

    def set_feed(self, line: int, value: float) -> None:
        if self.feed_mode != 94:
            self.once(
                "feed",
                line,
                "programs.gcode.feed_mode",
                "F under G{mode}: the speed in mm/s is not known",
                mode=self.feed_mode,
            )
            self.feed = None
        elif value <= 0:
            self.problem(
                line, "programs.gcode.feed_not_positive", "F is not positive; the last one stays"
            )
        elif self.scale is None:
            self.feed = None
        elif self.basic and self.scale == INCH:
            self.once(
                "basic",
                line,
                "programs.gcode.basic_feed",
                "F under G70 is in the control's own unit: the speed in mm/s is not known",
            )
            self.feed = None
        else:
            self.feed = value * self.scale / 60.0
