"""Reads 5-axis G-code with tool-centre-point control (ISO 6983; Fanuc's and Siemens' words).

Under G43.4 or TRAORI X, Y, Z are the tool's tip in the part and the rotary words give the axis from
the part to the spindle: Rz(C) Rx(A) [0,0,1], or Rz(C) Ry(B) [0,0,1]; under G43.5 I, J, K are the
axis itself, and so are A3, B3, C3 under TRAORI. The pose's z points into the work (-axis); the
rotation about it is free (``roll``). Without rotary words the axis is Z, and no TCP control is needed. What needs the machine's kinematics or the control's memory
is a Problem, and the motions that depend on it are left out.
A file that does not say G20 or G21, G90 or G91, is taken in mm and as absolute.
"""

import math
import re

from ...base.stopping import check
from ..program import (
    MAX_COORDINATE,
    Fact,
    Program,
    ProgramError,
    Unknown,
    bytes_of,
    lines_of,
    name_of,
)
from .tool_axis import Tracer, arc_through, unit

MAX_MOTIONS = 1_000_000
INCH = 25.4  # mm
RADIUS_ERROR = 0.05  # mm, between an arc's radius at its start and at its end
COMMENT = re.compile(r"\([^()]*\)|;.*")
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)"
# What follows a number may be a function's name; without a limit, each word would look at all after it.
WORD = re.compile(rf"\s*([A-Z])\s*(?:=\s*)?({NUMBER})(?![\d.]|[A-Z]\w{{0,40}}\s{{0,40}}\()")
VECTOR = re.compile(rf"(?<![A-Z0-9])([ABC])3\s*=\s*({NUMBER})(?![\w.])")
MACRO = re.compile(r"#|\[|\b(?:IF|WHILE|GOTO|GOTOF|GOTOB|FOR|REPEAT|DEF|R\d+\s*=|Q\d+|CALL)\b|\$")
CHANGE = re.compile(r"(?<![A-Za-z0-9.])[Mm]0?6(?![\d.])")
PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
OFFSETS = {54, 55, 56, 57, 58, 59, 500, *range(505, 600), 54.1, 59.1, 59.2, 59.3}
# No motion, and no change of what the coordinates mean.
HARMLESS = {4, 9, 40, 60, 61, 61.1, 62, 63, 64, 80, 94, 99, 98, 601, 602, 603, 641, 642, 643, 644}
HARMLESS |= {5.1, 8, 15, 22, 23, 25, 26, 45, 50, 50.1, 69, 67, 97, 450, 451, 710, 700}
NAMED = re.compile(
    r"^(?:ORI\w+|CUT2D\w*|SOFT|BRISK|COMP\w+|FFWO[NF]|FIFOCTRL|UPATH|SPATH|MSG|STOPRE|"
    r"WORKPIECE|T\s*(?:=\s*)?\"[^\"]*\"|D\d+|CYCLE832)$"
)
# Reasons that hold for many motions of a file, made once.
MACHINE_COORDINATES = Fact(
    "programs.gcode.kinematics",
    "rotary axes without G43.4 or TRAORI are machine coordinates: the machine's kinematics is "
    "needed; post-process with tool-centre-point control",
)
A_AND_B = Fact("programs.gcode.a_and_b", "A and B together depend on the machine's kinematics")
KINEMATICS = {fact.code for fact in (MACHINE_COORDINATES, A_AND_B)}
FRAMES = re.compile(r"A?(?:TRANS|ROT|SCALE|MIRROR)S?\b|CYCLE800\b")


def read(path):
    """The Program of a G-code file. Raises ProgramError when it cannot be read at all."""
    text = bytes_of(path, "G-code").decode("latin-1")
    reader = _Reader(name_of(path), CHANGE.search(text) is not None)
    for line, text in enumerate(lines_of(text, reader.file), 1):
        check()
        if len(reader.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                reader.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )
        if not reader.block(line, text):
            break
    else:
        reader.finish(line)
    return reader.program


def _frame_changed(word):
    return Fact(
        "programs.gcode.frame_changed", "{word} changes the frame in the control", word=word
    )


class _Reader:
    def __init__(self, name, by_m6=False):
        self.program = Program("G-code", name)
        self.file = name
        self.trace = Tracer(self.program)
        self.at = [None, None, None]  # mm, None: unknown
        self.rotary = {}  # A, B, C in degrees as they stand
        self.mode = None  # 0, 1, 2, 3 of the group of motions
        self.scale = 1.0
        self.absolute = True
        self.plane = 17
        self.tcp = None  # None, "angles" or "vector"
        self.axis = (0.0, 0.0, 1.0)
        self.vector = None  # the axis by A3, B3, C3, as long as it holds
        self.feed_mode = 94
        self.feed = None  # mm/s
        self.zone = None  # mm around a corner, modal
        self.base = self.tool = self.waiting = ""
        self.by_m6 = by_m6  # a T word takes the tool at the M6 only
        self.shifted = None  # why coordinates mean something that is not known here
        self.told = set()
        self.ended = False  # by % or M99

    def problem(self, line, told, text=None, /, **arguments):
        self.program.problem(self.file, line, told, text, **arguments)

    def once(self, key, line, told, text=None, /, **arguments):
        if key not in self.told:
            self.told.add(key)
            self.problem(line, told, text, **arguments)

    def lost(self, line, told, text=None, /, key=None, **arguments):
        """A motion is left out; where it ends is kept only as far as its words are known."""
        if key is None or key not in self.told:
            self.problem(line, told, text, **arguments)
        self.told.add(key)
        motions = self.program.motions
        if not motions or motions[-1].pose is not None:
            self.trace.gap(line)

    def finish(self, line):
        """At the file's last line, without M2 or M30."""
        if not self.ended:
            self.problem(
                line,
                "programs.gcode.no_end",
                "the file ends without M30, M2 or %; it may be cut off",
            )

    def block(self, line, text):
        """Follows one line; False at the program's end."""
        count = 1 if "(" in text or ";" in text else 0
        for _ in range(10 * count):  # comments within comments
            text, count = COMMENT.subn(" ", text)
            if not count:
                break
        text = text.strip().upper()
        if text.startswith("%") and self.program.motions:
            self.ended = True
        if not text or text.startswith(("%", "/")):
            if text.startswith("/"):
                self.lost(
                    line,
                    "programs.gcode.block_skip",
                    "a block with / is skipped or not by a switch; it is left out",
                )
                self.forget(text)
            return True
        body = re.sub(r"^(?:[N:]\s*\d+|O\d+)\s*", "", text)
        if body in ("RET", "M17"):  # Siemens' ends of a subprogram
            return False
        self.ended = body == "M99"
        try:
            if MACRO.search(body):
                raise Unknown(
                    "programs.gcode.macro", "variables and macros are known to the control only"
                )
            frame = FRAMES.match(body)
            if frame:
                self.shifted = None
                if body not in ("TRANS", "ROT", "SCALE", "MIRROR"):
                    self.shifted = _frame_changed(frame.group(0))
                    self.problem(
                        line,
                        "programs.gcode.motions_left_out",
                        "{reason}; the motions in it are left out",
                        reason=self.shifted,
                    )
            elif body == "TRAORI":
                self.tcp, self.vector = "angles", None
            elif body == "TRAFOOF":
                self.tcp = self.vector = None
            elif body and not NAMED.match(body):
                turned = self.turn(body)
                return self.words(line, self.split(VECTOR.sub(" ", body).strip()), turned)
        except Unknown as unknown:
            self.lost(
                line,
                "programs.gcode.block_left_out",
                "the block is left out: {reason}",
                reason=unknown.fact,
            )
            self.forget(body)
        return True

    def forget(self, body):
        """What a block that cannot be followed may have changed is unknown afterwards."""
        if re.match(r"#\w+\s*=", body):
            return
        jumps = re.search(r"M9[78]|[A-Z]{2}", body)
        self.at = [None if jumps or k in body else v for k, v in zip("XYZ", self.at)]
        for letter in "ABC":
            if letter in body and not jumps:
                self.rotary[letter] = self.vector = None
        if "F" in body:
            self.feed = None
        if "G" in body:
            self.mode = None

    @staticmethod
    def split(body):
        """List of (letter, value) of a block; every character belongs to a word."""
        words, at = [], 0
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

    def turn(self, body):
        """Takes the tool's axis from A3, B3, C3 (any length; left out: 0); True where it is given."""
        parts = VECTOR.findall(body)
        if not parts:
            return False
        values = {letter: float(text) for letter, text in parts}
        axis = unit([values.get(letter, 0.0) for letter in "ABC"])
        if len(values) < len(parts) or axis is None or self.tcp != "angles":
            raise Unknown("programs.gcode.vector", "A3, B3, C3 are no direction, or without TRAORI")
        self.vector = axis
        return True

    def words(self, line, words, turned):
        given, codes, going, changes = {}, [], True, False
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
            else:
                given[letter] = value
        if "T" in given:
            self.waiting = f"T{given['T']:g}"
        if changes or not self.by_m6:  # a T before its M6 only fetches the tool
            self.tool = self.waiting
        once = None
        for code in codes:
            once = self.code(line, code) or once
        if "F" in given:
            self.set_feed(line, given["F"])
        self.set_zone(codes, given)
        if 4 in codes:  # dwell: X and F are times
            return going
        if once == 92:
            if any(letter in given for letter in "XYZABC"):
                self.shifted = Fact(
                    "programs.gcode.origin", "G92 sets an origin that is not known here"
                )
            return going
        moves = (
            turned
            or any(letter in given for letter in "XYZABC")
            or (any(letter in given for letter in "IJK") and (self.mode in (2, 3) or self.tcp))
        )
        if moves:
            if once in (28, 30, 53):
                self.at = [None, None, None]
                self.lost(
                    line,
                    "programs.gcode.machine_coordinates",
                    "G{code} goes to the machine's coordinates; it is left out",
                    code=once,
                )
            else:
                self.move(line, given)
        elif once in (28, 30):
            self.at = [None, None, None]
            self.lost(
                line,
                "programs.gcode.machine_coordinates",
                "G{code} goes to the machine's coordinates; it is left out",
                code=once,
            )
        return going

    def code(self, line, code):
        """One G word; returns a code that holds for this block only."""
        if code in (0, 1, 2, 3):
            self.mode = int(code)
        elif code in (20, 21, 70, 71):
            self.scale = INCH if code in (20, 70) else 1.0
        elif code in (90, 91):
            self.absolute = code == 90
        elif code in PLANES:
            self.plane = int(code)
        elif code in (43.4, 43.5):
            self.tcp = "angles" if code == 43.4 else "vector"
        elif code == 49:
            self.tcp = self.vector = None
        elif code in OFFSETS:
            self.base = f"G{code:g}"
        elif code in (41, 42, 43, 44):
            if code in (41, 42):
                self.once(
                    code,
                    line,
                    "programs.gcode.offset",
                    "G{code}: the control shifts the path; taken unshifted",
                    code=f"{code:g}",
                )
        elif code in (93, 95, 96):
            pass
        elif code in (28, 30, 53, 92):
            return int(code)
        elif code in (68, 68.2, 51, 51.1, 52, 10, 158, 258, 168):
            self.shifted = _frame_changed(f"G{code:g}")
            self.problem(
                line,
                "programs.gcode.motions_left_out",
                "{reason}; the motions in it are left out",
                reason=self.shifted,
            )
        elif code not in HARMLESS:
            self.mode = None if 33 <= code <= 39 or 73 <= code <= 89 else self.mode
            raise Unknown(
                "programs.gcode.unknown_code", "G{code} is not known here", code=f"{code:g}"
            )
        if code in (69, 50, 50.1):
            self.shifted = None
        if code in (93, 94, 95):
            self.feed_mode, self.feed = int(code), None
        return None

    def set_zone(self, codes, given):
        """G60, G61: exact stop; G9: in this block; G64 P: within P of the corner (LinuxCNC), which a
        zone of 2 P keeps to at any angle; other modes of continuous path: known to the control."""
        for code in codes:
            if code in (60, 61, 61.1):
                self.zone = 0.0
            elif code == 64 and given.get("P", 0.0) > 0:
                self.zone = 2.0 * self.scale * given.pop("P")
            elif code in (62, 63, 64, 641, 642, 643, 644):
                self.zone = None
        self.trace.zone = 0.0 if 9 in codes else self.zone

    def set_feed(self, line, value):
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
        else:
            self.feed = value * self.scale / 60.0

    def move(self, line, given):
        target = list(self.at)
        for k, letter in enumerate("XYZ"):
            if letter in given and self.absolute:
                target[k] = self.scale * given[letter]
            elif letter in given:
                target[k] = None if target[k] is None else target[k] + self.scale * given[letter]
        for letter in "ABC":
            if letter in given:
                self.vector = None
                turn = 0.0 if self.absolute else self.rotary.get(letter)
                self.rotary[letter] = None if turn is None else turn + given[letter]
        start, self.at = self.at, target
        try:
            axis = self.tool_axis(given)
            if self.shifted:
                raise Unknown(self.shifted)
            if self.mode is None:
                raise Unknown("programs.gcode.no_mode", "no G0, G1, G2 or G3 is in force")
            missing = [letter for letter, v in zip("XYZ", target) if v is None]
            if missing:
                raise Unknown(
                    "programs.gcode.not_known", "{names} is not known", names=", ".join(missing)
                )
            if max(map(abs, target)) > MAX_COORDINATE:
                raise Unknown(
                    "programs.position_out_of_bounds", "the position is out of all bounds"
                )
            if self.mode in (2, 3):
                self.arc(line, start, target, axis, given)
            else:
                kind, speed = ("LIN", self.feed) if self.mode else ("PTP", None)
                self.trace.move(kind, target, axis, line, speed, self.base, self.tool)
        except Unknown as unknown:
            # A thousand motions left out for one reason are one Problem.
            fact = unknown.fact
            key = fact if self.shifted or fact.code in KINEMATICS else None
            self.lost(
                line,
                "programs.motion_left_out",
                "the motion is left out: {reason}",
                reason=fact,
                key=key,
            )

    def tool_axis(self, given):
        if self.tcp == "vector":
            if self.mode in (0, 1) and any(letter in given for letter in "IJK"):
                axis = unit([given.get(letter, 0.0) for letter in "IJK"])
                if axis is None:
                    raise Unknown("programs.gcode.zero_axis", "I, J, K of the tool's axis are zero")
                self.axis = axis
            return self.axis
        if self.vector is not None:
            return self.vector
        unknown = [letter for letter, v in self.rotary.items() if v is None]
        if unknown:
            raise Unknown(
                "programs.gcode.not_known", "{names} is not known", names=", ".join(unknown)
            )
        if not any(self.rotary.values()):
            return (0.0, 0.0, 1.0)
        if self.tcp is None:
            raise Unknown(MACHINE_COORDINATES)
        a, b, c = (math.radians(self.rotary.get(letter, 0.0)) for letter in "ABC")
        if a and b:
            raise Unknown(A_AND_B)
        x, y, z = math.sin(b), -math.sin(a), math.cos(a) * math.cos(b)
        return (math.cos(c) * x - math.sin(c) * y, math.sin(c) * x + math.cos(c) * y, z)

    def arc(self, line, start, end, axis, given):
        if None in start:
            raise Unknown(
                "programs.arc_from_nowhere", "an arc begins at a position that is not known"
            )
        u, v, w = PLANES[self.plane]
        chord = (end[u] - start[u], end[v] - start[v])
        length = math.hypot(*chord)
        if "P" in given or "TURN" in given:
            raise Unknown("programs.gcode.turns", "an arc of several turns is not supported")
        centre = list(start)
        if "R" in given:
            radius = self.scale * given["R"]
            if length < 1e-9 or length > 2.0 * abs(radius) + 2.0 * RADIUS_ERROR:
                raise Unknown("programs.gcode.radius", "R does not fit the arc's ends")
            height = math.sqrt(max(0.0, radius * radius - length * length / 4.0)) / length
            side = height if (self.mode == 3) == (radius > 0) else -height
            centre[u] += chord[0] / 2.0 - side * chord[1]
            centre[v] += chord[1] / 2.0 + side * chord[0]
        else:
            for k, letter in ((u, "IJK"[u]), (v, "IJK"[v])):
                centre[k] += self.scale * given.get(letter, 0.0)
        radii = [math.hypot(p[u] - centre[u], p[v] - centre[v]) for p in (start, end)]
        if radii[0] < 1e-9 or abs(radii[0] - radii[1]) > max(RADIUS_ERROR, 1e-3 * radii[0]):
            raise Unknown(
                "programs.gcode.arc_ends", "the arc's ends are not at one distance from its centre"
            )
        normal = [0.0, 0.0, 0.0]
        normal[w] = 1.0 if self.mode == 3 else -1.0
        points = [*arc_through(start, centre, end, normal, length < 1e-9), tuple(end)]
        if abs(end[w] - start[w]) > 1e-9:  # a helix: three points are no arc of it
            raise Unknown("programs.gcode.helix", "a helix is not supported")
        self.trace.arcs(points, axis, line, self.feed, self.base, self.tool)
