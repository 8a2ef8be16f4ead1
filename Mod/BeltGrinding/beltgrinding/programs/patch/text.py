"""What the patches of all languages share: a file's bytes with edits, changes by statement."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from ...base.kinds import Floats
from ...base.kinds import known
from ..program import Program, ProgramError

LINE_END = re.compile(r"\r\n|\n|\r")
SMALL = 1e-9  # mm; a displacement below is none
COORDINATE_DIGITS = 4  # decimals of mm that an edited coordinate has at least

Statements: TypeAlias = "Sequence[tuple[int, str]]"  # in the file's order, each with its role


def decimal(value: float, digits: int, least: int = 0) -> str:
    """A number without exponent: at most ``digits`` decimals, zeros at its end cut to ``least``."""
    text = f"{value:.{digits}f}"
    if "." in text:
        head, tail = text.split(".")
        tail = tail.rstrip("0").ljust(least, "0")
        text = f"{head}.{tail}" if tail else head
    return text[1:] if re.fullmatch(r"-0\.?0*", text) else text


def decimals(text: str) -> int:
    """How many decimals a number is written with."""
    return len(text.partition(".")[2]) if "e" not in text.lower() else 0


def moved(text: str, step: float, digits: int = COORDINATE_DIGITS) -> str:
    """A written coordinate moved by ``step``, with at least as many decimals as it had."""
    had = decimals(text)
    return decimal(float(text) + step, max(had, digits), had)


class Overlap(Exception):
    """Two edits of one place."""


class Source:
    """A file as text of which one character is one byte (Latin-1), its lines from 1, its edits."""

    def __init__(self, data: bytes, ends: Sequence[tuple[int, int]] | None = None) -> None:
        self.text = data.decode("latin-1")
        if ends is None:
            ends = [match.span() for match in LINE_END.finditer(self.text)]
        self.starts = [0, *(end for _, end in ends)]
        self.stops = [*(begin for begin, _ in ends), len(self.text)]
        self.edits: list[tuple[int, int, str]] = []
        counts: dict[str, int] = {}
        for begin, end in ends[:1000]:
            counts[self.text[begin:end]] = counts.get(self.text[begin:end], 0) + 1
        self.end = max(counts, key=lambda end: counts[end]) if counts else "\n"

    def __len__(self) -> int:
        return len(self.starts)

    def span(self, line: int) -> tuple[int, int]:
        """(begin, end) of a line without its end."""
        return self.starts[line - 1], self.stops[line - 1]

    def line(self, line: int) -> str:
        begin, end = self.span(line)
        return self.text[begin:end]

    def replace(self, begin: int, end: int, text: str) -> None:
        if self.text[begin:end] != text:
            self.edits.append((begin, end, text))

    def insert_before(self, line: int, text: str) -> None:
        """A line of its own before ``line``, as far indented and ended as that one."""
        begin = self.starts[line - 1]
        self.edits.append((begin, begin, self._indent(line) + text + self._end(line)))

    def insert_after(self, line: int, text: str) -> None:
        """A line of its own after ``line``."""
        stop = self.stops[line - 1]
        self.edits.append((stop, stop, self._end(line) + self._indent(line) + text))

    def _indent(self, line: int) -> str:
        text = self.line(line)
        return text[: len(text) - len(text.lstrip(" \t"))]

    def _end(self, line: int) -> str:
        if line < len(self):
            return self.text[self.stops[line - 1] : self.starts[line]]
        return self.end

    def result(self) -> bytes:
        """The bytes with all edits. Raises Overlap."""
        parts: list[str] = []
        at = 0
        for begin, end, text in sorted(self.edits, key=lambda edit: edit[:2]):
            if begin < at:
                raise Overlap
            parts += [self.text[at:begin], text]
            at = end
        return "".join([*parts, self.text[at:]]).encode("latin-1")


@dataclass
class Shift:
    """The displacement of one target: ``base`` (3,) and ``tool_z`` in mm, of ``motions``."""

    base: Floats
    tool_z: float
    motions: list[int]


@dataclass
class Work:
    """What is to be changed, by the line of a motion's statement."""

    program: Program
    steps: Floats  # (motions, 3) mm in the base
    lines: dict[int, list[int]]  # motions of each line
    before: list[int]  # the motion that ended before each one, -1: none
    speeds: dict[int, float] = field(default_factory=dict)  # mm/s
    forces: dict[int, float] = field(default_factory=dict)  # N
    shifts: dict[int, dict[int, Shift]] = field(default_factory=dict)  # by target: 0, 1
    by_device: bool = False  # the forces are set by a force device

    def refuse(self, line: int, code: str, text: str, /, **arguments: object) -> ProgramError:
        """The ProgramError of a change in a line."""
        return ProgramError.at(self.program.file, line, code, text, **arguments)

    def targets(self) -> Iterator[tuple[int, int, Shift]]:
        """(line, target, shift) in the order of the lines."""
        for line in sorted(self.shifts):
            for target, shift in sorted(self.shifts[line].items()):
                yield line, target, shift

    def in_base(self, shift: Shift) -> Floats | None:
        """(3,) mm in the base; None: the executions of the statement differ."""
        steps = self.steps[shift.motions]
        return steps[0] if len(steps) == 1 or np.abs(steps - steps[0]).max() < SMALL else None

    def in_tool(self, shift: Shift) -> Floats | None:
        """(3,) mm in the tool's frame; None: the executions of the statement differ."""
        if not any(shift.base):
            return np.array([0.0, 0.0, shift.tool_z])
        turns = np.array([known(self.program.motions[i].pose)[:3, :3] for i in shift.motions])
        steps = np.einsum("nji,nj->ni", turns, self.steps[shift.motions])
        return steps[0] if np.abs(steps - steps[0]).max() < SMALL else None

    def inherited(self, shift: Shift, line: int) -> Floats:
        """(3,) mm that a relative target is displaced already, by the motion before it."""
        rows = [
            self.steps[self.before[i]] if self.before[i] >= 0 else np.zeros(3)
            for i in shift.motions
        ]
        if np.abs(np.array(rows) - rows[0]).max() >= SMALL:
            raise self.refuse(
                line,
                "programs.patch.displaced_differently",
                "it is relative to motions that are displaced differently",
            )
        return rows[0]

    def speed_before(self, line: int) -> float | None:
        """mm/s that the motions of a line had; None where it is not known or not one."""
        speeds = {self.program.motions[i].speed_mm_s for i in self.lines[line]}
        return speeds.pop() if len(speeds) == 1 else None

    def no_force(self) -> None:
        for line in () if self.by_device else self.forces:
            raise self.refuse(
                line,
                "programs.patch.no_force",
                "{language} has no pressing force that is read here; set it in the force "
                "controller's own instruction",
                language=self.program.language,
            )

    def relative(self, line: int, shift: Shift, what: str) -> None:
        """Raises where a relative motion is to go elsewhere than the one before takes it."""
        step = self.in_base(shift)
        if step is None or np.abs(step - self.inherited(shift, line)).max() >= SMALL:
            raise self.refuse(
                line,
                "programs.patch.relative",
                "{what} is relative to the motion before it; offset that by the same",
                what=what,
            )


def plan(
    statements: Statements,
    wanted: Mapping[int, float],
    before: Callable[[int], float | None],
    refuse: Callable[..., ProgramError],
) -> list[tuple[str, int, float]]:
    """Where a modal speed is to be set so that only the motions wanted get theirs.

    statements: (key, role) in the file's order. Roles: path (a motion that the modal speed
    governs), both (a path that sets the speed itself), speed (sets it), plain (does not matter),
    barrier (the run of statements may part or join), lost (the same, and the speed is not known
    after it), end (of the program). wanted: mm/s by key. before(key): mm/s it had, None: unknown.

    Returns a list of (what, key, mm/s); what: set (in that statement), before (in front of it, the
    new speed), after (behind it, the old one again).
    """
    result: list[tuple[str, int, float]] = []
    new: float | None = None
    last, known = 0, True

    def restore() -> None:
        old = before(last)
        if old is None or not known:
            raise refuse(
                last,
                "programs.patch.speed_after",
                "the speed that holds after it is not known here, so it cannot be put "
                "back; set the speed of the next motion in the program first",
            )
        result.append(("after", last, old))

    for at, (key, role) in enumerate(statements):
        if role in ("path", "both") and key in wanted:
            if role == "both":
                result.append(("set", key, wanted[key]))
                known = True
            elif wanted[key] != new:
                result.append(("before", key, wanted[key]))
            new, last = wanted[key], key
        elif role == "both":
            new, known = None, True
        elif role == "speed":
            new, known = _governed(statements, at, wanted), True
            if new is not None:
                result.append(("set", key, new))
        elif role in ("path", "barrier", "lost"):
            if new is not None:
                restore()
            new, known = None, known and role != "lost"
    return result


def _governed(statements: Statements, at: int, wanted: Mapping[int, float]) -> float | None:
    """The new speed if the speed set at ``at`` governs nothing but motions that all get it."""
    found = None
    for k in range(at + 1, len(statements)):
        key, role = statements[k]
        if role in ("speed", "both", "end"):
            break
        if role == "plain":
            continue
        if role != "path" or key not in wanted or wanted[key] != (found or wanted[key]):
            return None
        found = wanted[key]
    return found
