"""Reads Heidenhain conversational programs (Klartext, .h) of TNC controls.

X, Y, Z are the tool's tip. The tool's axis is Z; under M128 or FUNCTION TCPM that of the rotary words, as in G-code:
Rz(C) Rx(A) [0,0,1], or Rz(C) Ry(B) [0,0,1]; with AXIS SPAT Rz(C) Ry(B) Rx(A) [0,0,1]; or TX, TY, TZ of LN; in a tilted
plane its normal, once the rotary axes stand there. The pose's z points into the work (-axis); the rotation about it
is free (``roll``). What needs the machine's kinematics, its tables or cycles is a Problem, and the motions that depend
on it are left out.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ....base.regular_files import shown
from ...program import Fact, Program, ProgramError, Unknown
from ..core import statements
from ..core.listing import END, RETURN, no_subprogram
from .expression import FN, FN_IF, FN_ONE
from .moves import KINEMATICS, NOT_TILTED, ONTO_PLANE, PLANES
from .placement import TILTED
from .statements import (
    CALLING,
    DEFINED,
    FOLLOWED_CYCLES,
    IGNORED,
    MACHINE,
    NO_MOTION,
    OF_FRAMES,
    OF_STATE,
    PLAIN,
    Statements,
)
from .units import BEGIN, Unit

MOTIONS = "L LN LP C CR CT CP CTP".split()
MOTION = re.compile(rf"({'|'.join(MOTIONS)})(?=\s|$)\s*(.*)")
JUMP = re.compile(
    r"FN\s*(?:9|10|11|12)\s*:\s*IF\s*(.+?)\s+(EQU|NEQU|NE|GT|LT)\s+(.+?)\s+GOTO\s+LBL\s*(\S+)$"
)
FREE = "FLT FL FCT FC FPOL FSELECT FEND APPR DEP".split()  # geometry that is not followed
# Statements other than motions, by how they begin: the methods that follow them.
OTHERS = {
    "LBL": "label",
    "CYCL CALL": "call",
    "CALL": "call",
    "FN": "function_of",
    "CC": "centre",
    "RND": "cut",
    "CHF": "cut",
    "TOOL CALL": "tool_call",
    "CYCL DEF": "cycle",
    "TRANS DATUM": "datum",
    "PLANE": "plane",
    "FUNCTION": "function",
    "PRESET SELECT": "select",
    **dict.fromkeys(FREE, "free"),
}
FLOW = ("LBL", "CYCL CALL", "CALL", "FN")  # say where to go on
OTHER = re.compile(rf"({'|'.join(OTHERS)})(?![A-Z])")


STATEMENTS = statements.Statements(
    followed=[
        *MOTIONS,
        *(
            word
            for word in OTHERS
            if word not in (*FREE, "FN", "CYCL CALL", "CYCL DEF", "PLANE", "FUNCTION")
        ),
        *(f"FN {n}" for n in sorted({0, *range(9, 13), *map(int, (*FN, *FN_ONE))})),
        *(f"PLANE {kind}" for kind in (*TILTED, "RESET")),
        *(f"CYCL DEF {n}" for n in FOLLOWED_CYCLES),
        "FUNCTION TCPM",
        "FUNCTION RESET TCPM",
        *(f"M{n}" for n in OF_STATE),
    ],
    ignored=[
        *IGNORED,
        *(f"M{n}" for n in sorted(PLAIN)),
        *(f"CYCL DEF {n}" for n in sorted(DEFINED)),
    ],
    left_out=[
        *FREE,
        "CYCL CALL",
        *(f"CYCL DEF {n}" for n in OF_FRAMES if n not in FOLLOWED_CYCLES),
        *(f"M{n}" for n in (*CALLING, *MACHINE)),
    ],
)


def read(path: Path | str) -> Program:
    """The Program of a .h file. Raises ProgramError where it is none."""
    unit = Unit(path)
    if unit.begin < 0:
        raise ProgramError(
            "programs.klartext.no_begin",
            "{file}: holds no BEGIN PGM, so it is no Klartext program (headers of C have the same suffix); give another file",
            file=shown(Path(path).name),
        )
    reader = Reader(path, unit)
    if reader.follow(unit, unit.begin) == RETURN:
        reader.problem(
            unit.last,
            "programs.klartext.no_end",
            "the file ends without END PGM; it may be cut off",
        )
    return reader.program


class Reader(Statements):
    """Follows the statements of units."""

    labelled = False  # in a subprogram that LBL 0 ends

    def __init__(self, path: Path | str, unit: Unit) -> None:
        super().__init__(path)
        self.unit = unit
        self.counts: dict[tuple[str, int], int] = {}
        self.scale = 25.4 if unit.inch else 1.0
        if unit.inch is None:
            self.problem(
                unit.number(unit.begin),
                "programs.klartext.no_unit",
                "BEGIN PGM says neither MM nor INCH; mm is taken",
            )

    def step(self, at: int, text: str) -> int | None:
        line = self.unit.number(at)
        if text.startswith("/"):
            self.drop_corner()
            self.lost(
                line,
                "programs.gcode.block_skip",
                "a block with / is skipped or not by a switch; it is left out",
            )
            self.lose(line, text)
            return None
        try:
            match = MOTION.match(text)
            if match:
                return None if self.motion(line, match[1], match[2]) else END
            return self.other(at, line, text)
        except Unknown as unknown:
            fact = unknown.fact
            self.drop_corner()
            self.lost(
                line,
                "programs.gcode.block_left_out",
                "the block is left out: {reason}",
                reason=fact,
            )
            self.lose(line, text)
        return None

    def motion(self, line: int, kind: str, text: str) -> bool:
        """A block that moves; False at the program's end."""
        onto_plane = "Q12" in text and ONTO_PLANE.search(text)
        try:
            given, functions = self.words(ONTO_PLANE.sub("", text) if onto_plane else text)
        except Unknown as unknown:
            self.drop_corner()
            self.left_out(line, unknown.fact)
            self.untold(line, text)
            return True
        going = self.functions(line, functions, given)
        if MACHINE & {*functions}:
            self.at = [None] * 3
            self.rotary = {
                letter: None for letter in "ABC" if letter in given or letter in self.rotary
            }
            self.set_feed(line, given)
            self.drop_corner()
            self.lost(
                line,
                "programs.klartext.machine_coordinates",
                "M{number} goes to the machine's coordinates; it is left out",
                number=next(n for n in functions if n in MACHINE),
            )
            return going
        moves = {n.lstrip("I") for n in given} & {*"XYZABC", "PR", "PA", "TX", "TY", "TZ"}
        if not moves and kind != "C" and not onto_plane:
            self.set_feed(line, given)
        else:
            try:
                self.go(line, kind, given, bool(onto_plane))
            except Unknown as unknown:
                self.drop_corner()
                self.left_out(line, unknown.fact)
                if kind in ("LP", "CP", "CTP") and self.polar is None:
                    self.at = [None] * 3
        if 99 in functions or self.cycle_everywhere:
            self.cycle_called(line)
        return going

    def left_out(self, line: int, fact: Fact) -> None:
        known = fact is KINEMATICS or fact is NOT_TILTED or fact in self.placement.why.values()
        known = known or fact in self.shifted.values()
        self.lost(
            line,
            "programs.motion_left_out",
            "the motion is left out: {reason}",
            reason=fact,
            key=fact if known else None,
        )

    def untold(self, line: int, text: str) -> None:
        """What a motion's block that cannot be read may have changed is not known."""
        self.at = [None] * 3
        self.polar = None
        for letter in "ABC":
            if letter in text:
                self.rotary[letter] = self.vector = None
        if re.search(r"T[XYZ]|N[XYZ]", text):
            self.rotary, self.vector = dict.fromkeys("ABC"), None
        if "F" in text:
            self.feed = None
        if re.search(r"M\s*(?:12[89]|11[45]|Q|\D|$)", text) or "M" in text:
            self.tcpm = "unknown"

    def cycle_called(self, line: int) -> None:
        self.at = [*self.at[:2], None]
        self.drop_corner()
        self.lost(
            line,
            "programs.klartext.cycle_called",
            "a cycle is called here; its motions are left out",
        )

    def other(self, at: int, line: int, text: str) -> int | None:
        """A statement that is no motion's block. Raises Unknown."""
        if BEGIN.match(text) or NO_MOTION.match(text):
            return None
        if text.startswith("END PGM"):
            return RETURN if self.depth else END
        if re.match(r"M\s*\d", text):
            return None if self.motion(line, "L", text) else END
        if re.match(r"Q[LRS]?\d+\s*=", text):
            self.assignment(line, text)
            return None
        match = OTHER.match(text)
        if not match:
            raise Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=text[:30])
        found: Any = getattr(self, OTHERS[match[1]])
        if match[1] in FLOW:
            following: int | None = found(at, line, text)
            return following
        found(line, text)
        return None

    def label(self, at: int, line: int, text: str) -> int | None:
        ends = self.depth and self.labelled and re.match(r"LBL\s*0$", text)
        return RETURN if ends else None

    def function_of(self, at: int, line: int, text: str) -> int | None:
        """FN: a jump, or what is assigned."""
        if re.match(r"FN\s*(?:9|1[0-2])\s*:", text):
            return self.jump(at, line, text)
        self.assignment(line, text)
        return None

    def select(self, line: int, text: str) -> None:
        """PRESET SELECT."""
        found = re.search(r"#\s*(\d+)", text)
        self.preset(found[1] if found else None, line)

    def centre(self, line: int, text: str) -> None:
        """CC: the pole, in the plane of the axes that it names."""
        self.pole = self.polar = None
        try:
            given, functions = self.words(text[2:])
            names = {name.lstrip("I") for name in given}
            plane = PLANES.get("".join(sorted(names)) or "XY")
            if plane is None or functions or len(given) not in (0, 2):
                raise Unknown("programs.klartext.no_pole", "there is no CC that is known")
            kept = set(self.stands)
            target: list[Any] = self.cartesian(given)
            self.stands = kept
        except Unknown as unknown:
            self.lost(
                line,
                "programs.gcode.block_left_out",
                "the block is left out: {reason}",
                reason=unknown.fact,
            )
            return
        if None not in (target[plane[0]], target[plane[1]]):
            self.pole = (plane, (target[plane[0]], target[plane[1]]))

    def free(self, line: int, text: str) -> None:
        """FK contours, APPR and DEP: their geometry is not followed."""
        self.drop_corner()
        target: list[Any] = [None] * 3
        if text.startswith("APPR"):
            words = dict(re.findall(r"\s([XYZ])\s*([-+]?\d+(?:[.,]\d*)?)(?![\w.,])", text))
            for k, letter in enumerate("XYZ"):
                if letter in words:
                    target[k] = self.scale * float(words[letter].replace(",", "."))
                    self.stands.discard(letter)
                elif not re.search(rf"\bI?{letter}|P[RA]", text[4:]):
                    target[k] = self.at[k]
        self.at, self.polar = target, None
        if "F" in text[2:]:
            self.feed = None
        self.lost(
            line,
            "programs.klartext.free",
            "{word} is not followed; its motions are left out",
            word=text.split(None, 1)[0],
        )

    # Flow

    def jump(self, at: int, line: int, text: str) -> int | None:
        match = JUMP.match(text)
        label = match and match[4]
        target = self.unit.labels.get(label) if label else None
        try:
            if not match or target is None:
                raise Unknown(
                    "programs.gcode.no_label", "there is no label {name}", name=label or ""
                )
            left, right = (self.parameters.value(match[n]) for n in (1, 3))
            return target if FN_IF[match[2]](left, right) else None
        except Unknown as unknown:
            self.lost(
                line,
                "programs.gcode.block_left_out",
                "the block is left out: {reason}",
                reason=unknown.fact,
            )
            self.lose(line, text)
            if target is None or target <= at:
                return None
            self.lose(self.unit.number(target), text)
            return target

    def call(self, at: int, line: int, text: str) -> int | None:
        self.drop_corner()
        match = re.match(r"CALL\s+LBL\s*(\S+)(?:\s+REP\s*(\S*))?$", text)
        if match:
            return self.call_label(at, match[1], match[2])
        match = re.match(r"CALL\s+PGM\s+\"?(.+?)\"?$", text)
        if match:
            name = re.split(r"[\\/:]", match[1])[-1]
            return self.run(line, self.program_beside(name), None)
        if re.match(r"CYCL CALL|CALL SELECTED PATTERN", text):
            self.at = [None] * 3
            self.cycle_called(line)
            return None
        raise Unknown("programs.klartext.call", "what is called is not known")

    def call_label(self, at: int, label: str, times: str | None) -> int | None:
        target = self.unit.labels.get(label)
        if target is None:
            raise Unknown("programs.gcode.no_label", "there is no label {name}", name=label)
        if times is None:
            return self.run(self.unit.number(at), self.unit, target + 1)
        count = re.match(r"(\d+)(?:/\d+)?$", times)
        if not count or target > at:
            raise Unknown("programs.klartext.call", "what is called is not known")
        left = self.counts.get((self.unit.file, at), int(count[1]))
        if left == 0:
            self.counts.pop((self.unit.file, at))
            return None
        self.counts[self.unit.file, at] = left - 1
        return target

    def run(self, line: int, unit: Unit, at: int | None) -> int | None:
        """Follows a subprogram, or the program of another file (``at`` None)."""
        labelled, scale = self.labelled, self.scale
        if at is None:
            self.scale = 25.4 if unit.inch else 1.0
        self.labelled = at is not None
        try:
            done = self.routine(line, unit, unit.begin if at is None else at)
        finally:
            self.labelled, self.scale = labelled, scale
        return END if done == END else None

    def program_beside(self, name: str) -> Unit:
        unit = self.beside(name.upper().removesuffix(".H"), (".h",), Unit)
        if unit.begin < 0:
            raise no_subprogram(name)
        return unit
