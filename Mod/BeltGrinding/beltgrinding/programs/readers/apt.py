"""Reads APT cutter location files: APT-CL and NX CLS (after ISO 4343).

GOTO/x,y,z,i,j,k gives the tool's tip and the axis from the part to the spindle; the pose's z points
into the work (-axis). The rotation about it is free (``roll``). RAPID makes the next motion a rapid one. CIRCLE and
MOVARC with the GOTO or INDIRV after them become arcs. What depends on the post-processor (cycles,
GOHOME, feeds per revolution) is a Problem. A FEDRAT without unit is one per minute.
"""

import contextlib
import math
import re

import numpy as np

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
MAX_CONTINUED = 200  # lines of one statement
INCH = 25.4  # mm
RADIUS_ERROR = 0.05  # mm, between an arc's radius at its start and at its end
NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eEdD][-+]?\d+)?")
FEED_UNITS = {
    "MMPM": 1.0 / 60.0,
    "IPM": INCH / 60.0,
    "FPM": 12.0 * INCH / 60.0,
    "MMPS": 1.0,
    "IPS": INCH,
}
PER_REVOLUTION = ("MMPR", "IPR", "FPR")
TEXT = ("PARTNO", "PPRINT", "REMARK", "TOOL PATH", "END-OF-PATH", "INSERT", "LETTER", "DISPLAY")
# Statements without motion.
HARMLESS = set(
    "CUTTER SPINDL COOLNT TLCOMP CUTCOM LOADTL LOAD SELECT TLDATA MSYS PAINT DELAY SEQNO WPLANE "
    "FINI END MACHIN TOOLNO INTOL OUTTOL TOLER OPSKIP OPSTOP STOP PIVOT HEAD MODE PREFUN AUXFUN "
    "ROTHED CLEARP CLRSRF RETURN THICK MULTAX UNITS RAPID FEDRAT LINTOL GOUGCK PLUNGE MODULE "
    "CUTANG ENDSUB CATEGORY SAFETY INSIST RESET CLAMP".split()
)
MOVING = set("GOHOME HOME CALLSUB CALL COPY INDEX".split())
SHIFTING = set("TRACUT ROTATE ROTABL ORIGIN TRANS".split())
SQUARE = 1e-3  # cosine between the axes of a coordinate system
MAX_WORDS = 200  # characters of a base's


def read(path):
    """The Program of an APT file. Raises ProgramError when it cannot be read at all."""
    text = bytes_of(path, "APT").decode("latin-1")
    reader = _Reader(name_of(path))
    for line, text in reader.statements(lines_of(text, reader.file)):
        check()
        if len(reader.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                reader.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )
        if not reader.statement(line, text):
            break
    reader.finish()
    return reader.program


class _Reader:
    def __init__(self, name):
        self.program = Program("APT", name)
        self.file = name
        self.trace = Tracer(self.program)
        self.scale = 1.0  # mm a unit
        self.axis = (0.0, 0.0, 1.0)
        self.rapid = False
        self.speed = None  # mm/s
        self.circle = None  # (line, centre, normal, radius) waiting for its end
        self.tool = self.base = ""
        self.system, self.shifts = "", {}  # what the base is made of
        self.told = set()
        self.line = 1
        self.ended = False  # FINI, or NX's END-OF-PATH without motions after it

    def problem(self, line, told, text=None, /, **arguments):
        self.program.problem(self.file, line, told, text, **arguments)

    def statements(self, lines):
        """(line number of its beginning, text) without comments, continuations joined."""
        begun, parts = None, []
        for line, text in enumerate(lines, 1):
            text, comment, _ = text.partition("$$")
            text = text.strip()
            if not text and not parts:
                continue
            begun = begun or line
            if text.endswith("$") and not comment:
                parts.append(text[:-1])
                if len(parts) > MAX_CONTINUED:
                    raise ProgramError.at(
                        self.file,
                        begun,
                        "programs.apt.endless_statement",
                        "the statement does not end",
                    )
                continue
            yield begun, "".join([*parts, text]).strip()
            begun, parts = None, []
        if parts:
            self.problem(
                begun,
                "programs.apt.continued",
                "the last statement is continued, but the file ends",
            )

    def statement(self, line, text):
        """Follows one statement; False at the program's end."""
        self.line = line
        if text.upper().startswith(TEXT):
            self.ended = self.ended or text.upper().startswith("END-OF-PATH")
            return True
        word, _, rest = text.partition("/")
        word = word.strip().upper()
        values = [v.strip() for v in rest.split(",")] if rest.strip() else []
        if word == "FINI":
            self.ended = True
            return False
        self.ended = self.ended and word not in ("GOTO", "GODLTA", "MOVARC")
        try:
            if self.circle and word not in ("GOTO", "FEDRAT", "PAINT"):
                self.circle = None
                raise Unknown(
                    "programs.apt.arc_before_without_end",
                    "the arc before it has no GOTO as its end",
                )
            if word in ("GOTO", "FROM"):
                self.goto(line, word, values)
            elif word == "GODLTA":
                self.delta(line, values)
            elif word in ("CIRCLE", "MOVARC"):
                self.arc(line, word, values)
            elif word == "RAPID":
                self.rapid = True
            elif word == "FEDRAT":
                self.feed(line, values)
            elif word == "UNITS":
                self.units(line, values)
            elif word == "MULTAX":
                if values and values[0].upper() == "OFF":
                    self.axis = (0.0, 0.0, 1.0)
            elif word in ("LOADTL", "LOAD"):
                self.tool = rest.strip()
            elif word == "MSYS":
                self.machine_system(rest.strip(), values)
            elif word in SHIFTING:
                self.shift(word, rest.strip(), values)
            elif word in ("TLCOMP", "CUTCOM") and values and values[0].upper() != "OFF":
                self.once(
                    word,
                    line,
                    "programs.apt.offset",
                    "{word}: the control shifts the path; it is taken unshifted",
                    word=word,
                )
            elif re.match(r"CYCLE", word):
                if not values or values[0].upper() not in ("OFF", "ON"):
                    self.lost(
                        line,
                        "programs.apt.cycle",
                        "{word} is a cycle of the control; its motions are left out",
                        word=word,
                    )
            elif word in MOVING:
                self.lost(
                    line,
                    "programs.apt.machine",
                    "{word} depends on the machine; its motions are left out",
                    word=word,
                )
            elif word not in HARMLESS:
                raise Unknown("programs.apt.unknown_statement", "the statement is not known here")
        except Unknown as unknown:
            self.lost(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word[:40] or text[:40],
                reason=unknown.fact,
            )
        return True

    def lost(self, line, told, text=None, /, **arguments):
        self.problem(line, told, text, **arguments)
        self.trace.gap(line)

    def once(self, key, line, told, text=None, /, **arguments):
        if key not in self.told:
            self.told.add(key)
            self.problem(line, told, text, **arguments)

    def finish(self):
        if self.circle:
            self.problem(
                self.circle[0],
                "programs.apt.arc_without_end",
                "the arc has no GOTO as its end; it is left out",
            )
        if not self.ended:
            self.problem(
                self.line, "programs.apt.no_fini", "the file ends without FINI; it may be cut off"
            )

    @staticmethod
    def numbers(values, *counts):
        if len(values) not in counts:
            expected = str(counts[0])
            for count in counts[1:]:
                expected = Fact("programs.or", "{one} or {other}", one=expected, other=str(count))
            raise Unknown(
                "programs.apt.count",
                "it has {count} values, not {expected}",
                count=len(values),
                expected=expected,
            )
        result = []
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

    def point(self, values):
        point = tuple(self.scale * v for v in values)
        if max(map(abs, point)) > MAX_COORDINATE:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        return point

    def goto(self, line, word, values):
        circle, self.circle = self.circle, None
        rapid, self.rapid = self.rapid or word == "FROM", False
        self.once("UNITS", line, "programs.apt.no_units", "UNITS is not given; mm are assumed")
        numbers = self.numbers(values, 3, 6)
        position = self.point(numbers[:3])
        axis = self.axis
        if len(numbers) == 6:
            axis = unit(numbers[3:])
            if axis is None or abs(math.hypot(*numbers[3:]) - 1.0) > 0.01:
                raise Unknown("programs.apt.tool_axis", "the tool axis i, j, k is not of length 1")
        if circle and not rapid:
            self.end_arc(line, circle, position, axis)
        else:
            speed = None if rapid else self.speed
            self.trace.move(
                "PTP" if rapid else "LIN",
                position,
                axis,
                line,
                speed,
                tool=self.tool,
                base=self.base,
            )
        self.axis = axis

    def delta(self, line, values):
        numbers = self.numbers(values, 1, 3)
        if self.trace.position is None:
            raise Unknown(
                "programs.apt.relative_to_unknown", "it is relative to a position that is not known"
            )
        if len(numbers) == 1:  # along the tool's axis
            numbers = [numbers[0] * a for a in self.axis]
        step = self.point(numbers)
        position = tuple(a + b for a, b in zip(self.trace.position, step))
        kind, speed = ("PTP", None) if self.rapid else ("LIN", self.speed)
        self.trace.move(kind, position, self.axis, line, speed, tool=self.tool, base=self.base)
        self.rapid = False

    def arc(self, line, word, values):
        # NX: CIRCLE/x,y,z,i,j,k,radius,tolerance,...; MOVARC/x,y,z,i,j,k,radius[,ANGLE,degrees]
        numbers = self.numbers(values[:7], 7)
        normal = unit(numbers[3:6])
        if normal is None or numbers[6] <= 0:
            raise Unknown("programs.apt.axis_or_radius", "its axis or its radius is zero")
        centre, radius = self.point(numbers[:3]), self.scale * numbers[6]
        if word == "CIRCLE" or len(values) == 7:
            if len(values) > 7:
                self.numbers(values[7:], *range(1, 10))
            self.circle = (line, centre, normal, radius)
            return
        if values[7].upper() != "ANGLE":
            raise Unknown(
                "programs.not_understood", "'{text}' is not understood", text=values[7][:30]
            )
        angle = math.radians(self.numbers(values[8:], 1)[0])
        if not 0 < abs(angle) <= 2 * math.pi + 1e-9:
            raise Unknown("programs.apt.angle", "its angle is not within one turn")
        if self.trace.position is None:
            raise Unknown(
                "programs.apt.position_before_unknown", "the position before it is not known"
            )
        end = _turned(self.trace.position, centre, normal, angle)
        if angle < 0:
            normal = tuple(-v for v in normal)
        self.end_arc(line, (line, centre, normal, radius), end, self.axis)
        self.rapid = False

    def end_arc(self, line, circle, end, axis):
        _, centre, normal, radius = circle
        start = self.trace.position
        if start is None:
            raise Unknown(
                "programs.arc_from_nowhere", "an arc begins at a position that is not known"
            )
        for point in (start, end):
            offset = [a - b for a, b in zip(point, centre)]
            along = sum(a * b for a, b in zip(offset, normal))
            across = math.sqrt(max(0.0, sum(v * v for v in offset) - along * along))
            if abs(across - radius) > max(RADIUS_ERROR, 1e-3 * radius):
                raise Unknown(
                    "programs.apt.arc_off_circle", "the arc's start or end is not on its circle"
                )
        full = math.dist(start, end) < 1e-6
        points = [*arc_through(start, centre, end, normal, full), end]
        self.trace.arcs(points, axis, line, self.speed, tool=self.tool, base=self.base)

    def feed(self, line, values):
        unit_name = next((v.upper() for v in values if v.upper() in FEED_UNITS), None)
        per_turn = any(v.upper() in PER_REVOLUTION for v in values)
        others = [v for v in values if NUMBER.fullmatch(v)]
        if values and values[0].upper() == "RAPID":
            self.rapid = True
            return
        if len(others) != 1 or len(values) > 2:
            self.speed = None
            self.problem(
                line,
                "programs.apt.fedrat_not_understood",
                "FEDRAT is not understood; the speed is not known",
            )
        elif per_turn:
            self.speed = None
            self.problem(
                line,
                "programs.apt.per_revolution",
                "a feed per revolution: the speed in mm/s is not known",
            )
        elif len(values) == 2 and unit_name is None:
            self.speed = None
            self.problem(
                line,
                "programs.apt.fedrat_unit",
                "FEDRAT's unit in '{values}' is not known",
                values=", ".join(values)[:40],
            )
        else:
            value = self.numbers(others, 1)[0]
            factor = FEED_UNITS[unit_name] if unit_name else self.scale / 60.0
            self.speed = value * factor if 0 < value < 1e9 else None
            self.rapid = False
            if self.speed is None:
                self.problem(
                    line,
                    "programs.apt.fedrat_not_positive",
                    "FEDRAT is not positive; the speed is not known",
                )

    def shift(self, word, rest, values):
        """ORIGIN, TRANS, TRACUT, ...: coordinates after it are others, which the post-processor knows."""
        off = not values or values[0].upper() in ("OFF", "NOMORE")
        with contextlib.suppress(Unknown):
            off = off or word in ("ORIGIN", "TRANS") and not any(self.numbers(values, 3))
        self.shifts.pop(word, None)
        if not off:
            self.shifts[word] = rest
        self.set_base()

    def set_base(self):
        """The base in words: the coordinate system, and what shifts it."""
        words = [f"MSYS {self.system}"] if self.system else []
        words += [f"{word} {rest}" for word, rest in self.shifts.items()]
        self.base = " ".join(words)[:MAX_WORDS]

    def machine_system(self, rest, values):
        """MSYS/x,y,z,i,j,k,i,j,k: origin, x and y of the coordinates to come in those of the part (NX)."""
        self.system = rest
        self.set_base()
        if self.shifts:
            return
        try:
            numbers = self.numbers(values, 9)
            x, y = (unit(numbers[at : at + 3]) for at in (3, 6))
            if x is None or y is None or abs(sum(a * b for a, b in zip(x, y))) > SQUARE:
                return
            frame = np.eye(4)
            frame[:3, 0], frame[:3, 1], frame[:3, 2] = x, y, np.cross(x, y)
            frame[:3, 3] = self.point(numbers[:3])
        except Unknown:
            return  # of this base nothing is known
        self.program.base_frames[self.base] = frame

    def units(self, line, values):
        name = values[0].upper() if len(values) == 1 else ""
        scales = {"MM": 1.0, "INCHES": INCH, "INCH": INCH, "IN": INCH, "CM": 10.0}
        if name not in scales:
            raise ProgramError.at(
                self.file,
                line,
                "programs.apt.units",
                "UNITS/{unit} is unknown; use MM or INCHES",
                unit=name[:20],
            )
        self.scale = scales[name]
        self.told.add("UNITS")


def _turned(point, centre, normal, angle):
    """``point`` turned by ``angle`` (rad) about the line through ``centre`` along ``normal``."""
    v = [a - b for a, b in zip(point, centre)]
    n, c, s = normal, math.cos(angle), math.sin(angle)
    along = sum(a * b for a, b in zip(n, v))
    cross = (n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2], n[0] * v[1] - n[1] * v[0])
    return tuple(
        o + c * a + s * b + (1.0 - c) * along * d for o, a, b, d in zip(centre, v, cross, n)
    )
