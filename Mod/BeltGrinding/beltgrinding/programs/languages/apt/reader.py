"""Reads APT cutter location files: APT-CL and NX CLS (after ISO 4343).

GOTO/x,y,z,i,j,k gives the tool's tip and the axis from the part to the spindle; the pose's z points
into the work (-axis). The rotation about it is free (``roll``). RAPID makes the next motion a rapid one. CIRCLE and
MOVARC with the GOTO or INDIRV after them become arcs. What depends on the post-processor (cycles,
GOHOME, feeds per revolution) is a Problem. The unit of length is that of UNITS; without it that of the feeds, where
they name one; else it is asked for. A FEDRAT without unit has that of the FEDRAT before, else lengths per minute.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from ....base.kinds import known
from ...program import Program, ProgramError, Unknown, bytes_of, lines_of, name_of
from ..core.flow import Working
from ..core.statements import Statements
from ..tool_axis import unit
from .arcs import Arcs
from .words import AXIS_WORD, BLOCKS, HARMLESS, MOVING, NUMBER, REMARK, SHIFTING, TEXT

MAX_CONTINUED = 200  # lines of one statement
LEAST_MATRIX = 9  # numbers of a statement that may tell how coordinates lie
COORDINATES = re.compile(r"->\s*(?=CSYS\s*/)", re.IGNORECASE)  # of Creo, within a comment
OFF = ("OFF", "ON", "INIT")  # of CYCLE: no cycle of its own
# Statements by their words: the methods that follow them.
METHODS = {
    **dict.fromkeys(("GOTO", "FROM"), "goto"),
    "GODLTA": "delta",
    **dict.fromkeys(("CIRCLE", "MOVARC"), "arc"),
    "GOFWD": "contour",
    "RAPID": "go_rapid",
    "FEDRAT": "feed",
    **dict.fromkeys(("UNITS", "UNIT"), "units"),
    "MULTAX": "many_axes",
    "TLAXIS": "axis_set",
    **dict.fromkeys(("INDIRV", "INDIRP"), "direction"),
    "PSIS": "part_surface",
    "AUTOPS": "part_by_itself",
    **dict.fromkeys(("LOADTL", "LOAD"), "load"),
    "MSYS": "machine_system",
    "TRNTYP": "coordinates_of",
    **dict.fromkeys(SHIFTING, "shift"),
    **dict.fromkeys(("TLCOMP", "CUTCOM"), "offset"),
    "CYCLE": "cycle_of_control",
    **dict.fromkeys(MOVING, "of_machine"),
}
ENDS = ("FINI", "END-OF-PATH")
LEFT_OUT = ("CYCLE", *MOVING, *BLOCKS)
NOTED = ("TLCOMP", "CUTCOM")  # taken without what they do, with a word


STATEMENTS = Statements(
    followed=sorted({*METHODS, *ENDS, "TLON"} - {*LEFT_OUT, *NOTED, *SHIFTING} | {"CSYS"}),
    ignored=sorted({*HARMLESS, *TEXT} - {*METHODS, *ENDS, "TLON", "GOFWD"}),
    asked=sorted({*SHIFTING} - {"CSYS"}),
    left_out=sorted(LEFT_OUT),
)


def read(path: Path | str, units: str | None = None) -> Program:
    """The Program of an APT file. ``units``: "mm" or "inch", where it does not say them itself. Raises
    ProgramError when it cannot be read at all."""
    text = bytes_of(path, "APT").decode("latin-1")
    reader = _Reader(name_of(path), units)
    statements = list(reader.statements(lines_of(text, reader.file)))
    reader.look_at_feeds(statements)
    for line, text in statements:
        reader.tick(line, 0)
        if not reader.statement(line, text):
            break
    reader.finish()
    return reader.program


class _Reader(Working, Arcs):
    """Follows a file from top to bottom."""

    AGAIN = True

    def __init__(self, name: str, units: str | None = None) -> None:
        super().__init__("APT", name, units)
        self.axis: tuple[float, ...] | None = (0.0, 0.0, 1.0)
        self.cycle = False  # of the control, at each GOTO
        self.line = 1
        self.ended = False  # FINI, or NX's END-OF-PATH without motions after it
        self.until: str | None = None  # the word that ends statements that are left out

    def statements(self, lines: Iterable[str]) -> Iterator[tuple[int, str]]:
        """(line number of its beginning, text) without comments, continuations joined."""
        begun: int | None = None
        parts: list[str] = []
        remark = False
        for line, text in enumerate(lines, 1):
            text, comment, more = text.partition("$$")
            text = text.strip()
            if remark and not comment:  # of a comment that is continued
                remark = text.endswith("$")
                continue
            if more.startswith("->"):
                within = COORDINATES.match(more)
                remark = not within and more.rstrip().endswith("$")
                text, comment = (more[within.end() :].strip(), "") if within else (text, comment)
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
                known(begun),
                "programs.apt.continued",
                "the last statement is continued, but the file ends",
            )

    def statement(self, line: int, text: str) -> bool:
        """Follows one statement; False at the program's end."""
        self.line = line
        if text.upper().startswith(TEXT):
            if text.upper().startswith("END-OF-PATH"):
                self.ended, self.cycle = True, False
            if (
                text.upper().startswith("INSERT")
                and not REMARK.search(text, 6)
                and AXIS_WORD.search(text.upper(), 6)
            ):
                self.lost(
                    line,
                    "programs.apt.insert",
                    "INSERT hands a block with axis words to the control; what it moves is left out",
                )
            return True
        word, _, rest = text.partition("/")
        words = [one.strip() for one in word.upper().split(",")]
        rapid = len(words) > 1 and words[0] == "RAPID"
        word = ",".join(words[rapid:])
        values = [v.strip() for v in rest.split(",")] if rest.strip() else []
        if self.until is not None and word != "FINI":
            self.until = None if word == self.until else self.until
            return True
        block = word.rpartition("=")[2].strip()
        if block in BLOCKS:
            self.until = BLOCKS[block]
            self.lost(
                line,
                "programs.apt.block",
                "{word} is not followed; what it holds is left out",
                word=block,
            )
            return True
        if word == "FINI":
            self.ended = True
            return False
        self.ended = self.ended and words[-1] not in ("GOTO", "GODLTA", "MOVARC", "GOFWD")
        self.rapid = self.rapid or rapid
        if words[0] in ("TLON", "TLLFT", "TLRGT"):
            self.tool_on = words[0] == "TLON"
        try:
            self.arc_before(word)
            key = "GOFWD" if words[-1] == "GOFWD" else "CYCLE" if word.startswith("CYCLE") else word
            if key in METHODS:
                getattr(self, METHODS[key])(line, word, rest.strip(), values)
            elif word not in HARMLESS:
                raise Unknown("programs.apt.unknown_statement", "the statement is not known here")
        except Unknown as unknown:
            if word in ("GOTO", "FROM") and len(values) > 3:
                self.axis = self.axis_of(values[3:])
            elif (
                words[-1] not in HARMLESS
                and sum(map(bool, map(NUMBER.fullmatch, values))) >= LEAST_MATRIX
            ):
                self.shifts[word] = rest.strip()  # for all one knows, other coordinates
                self.set_base()
            if unknown.fact is self.why:  # of all motions, told once
                self.once(self.why, line, self.why)
                self.trace.gap(line)
                return True
            self.lost(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word[:40] or text[:40],
                reason=unknown.fact,
            )
        return True

    def finish(self) -> None:
        self.arc_before("FEDRAT")
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

    def go_rapid(self, line: int, word: str, rest: str, values: list[str]) -> None:
        self.rapid = True

    def many_axes(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """MULTAX: OFF takes the axis back to z."""
        if values and values[0].upper() == "OFF":
            self.axis = (0.0, 0.0, 1.0)

    def axis_set(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """TLAXIS."""
        self.axis = None
        self.axis = unit(self.numbers(values, 3))

    def load(self, line: int, word: str, rest: str, values: list[str]) -> None:
        self.cycle, self.tool = False, rest

    def offset(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """TLCOMP and CUTCOM."""
        if values and values[0].upper() != "OFF":
            self.once(
                word,
                line,
                "programs.apt.offset",
                "{word}: the control shifts the path; it is taken unshifted",
                word=word,
            )

    def cycle_of_control(self, line: int, word: str, rest: str, values: list[str]) -> None:
        self.cycle = not values or values[0].upper() not in OFF
        if self.cycle:
            self.lost(
                line,
                "programs.apt.cycle",
                "{word} is a cycle of the control; its motions are left out",
                word=word,
            )

    def of_machine(self, line: int, word: str, rest: str, values: list[str]) -> None:
        self.lost(
            line,
            "programs.apt.machine",
            "{word} depends on the machine; its motions are left out",
            word=word,
        )

    def goto(self, line: int, word: str, rest: str, values: list[str]) -> None:
        rapid, self.rapid = self.rapid or word == "FROM", False
        try:
            numbers = self.numbers(values, 3, 6)
            position = self.point(numbers[:3])
            axis = self.tool_axis() if len(numbers) == 3 else None
            if len(numbers) == 6:
                axis = unit(numbers[3:])
                if axis is None or abs(math.hypot(*numbers[3:]) - 1.0) > 0.01:
                    raise Unknown(
                        "programs.apt.tool_axis", "the tool axis i, j, k is not of length 1"
                    )
            arc = self.goto_after_arc(position)
        finally:
            circle, self.circle = self.circle, None
        if self.cycle:
            self.trace.gap(line)
        elif arc and not rapid:
            self.end_arc(line, known(circle), position, known(axis))
        else:
            self.line_to(line, position, known(axis), rapid)
        self.axis = axis

    def line_to(
        self, line: int, position: Sequence[float], axis: Sequence[float], rapid: bool
    ) -> None:
        """Adds a motion on a line, or a rapid one; it gives the direction of a contour motion after it."""
        before = self.trace.position
        kind, speed = ("PTP", None) if rapid else ("LIN", self.speed)
        self.trace.move(kind, position, axis, line, speed, tool=self.tool, base=self.base)
        self.forward = before and unit([a - b for a, b in zip(position, before)])

    def tool_axis(self) -> tuple[float, ...]:
        """The axis as it stands. Raises Unknown."""
        if self.axis is None:
            raise Unknown(
                "programs.apt.axis_unknown", "the tool axis is that of a GOTO that is left out"
            )
        return self.axis

    def axis_of(self, values: Sequence[str]) -> tuple[float, ...] | None:
        """The axis that a GOTO which is left out gives: that in force where its direction says none, None where it
        cannot be read."""
        try:
            return unit(self.numbers(values, 3)) or self.axis
        except Unknown:
            return None

    def delta(self, line: int, word: str, rest: str, values: list[str]) -> None:
        numbers = self.numbers(values, 1, 3)
        axis = self.tool_axis()
        if self.trace.position is None:
            raise Unknown(
                "programs.apt.relative_to_unknown", "it is relative to a position that is not known"
            )
        if len(numbers) == 1:  # along the tool's axis
            numbers = [numbers[0] * a for a in axis]
        step = self.point(numbers)
        position = tuple(a + b for a, b in zip(self.trace.position, step))
        rapid, self.rapid = self.rapid, False
        self.line_to(line, position, axis, rapid)
