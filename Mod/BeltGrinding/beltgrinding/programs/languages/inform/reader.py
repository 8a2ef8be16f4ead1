"""Reads Yaskawa (Motoman) INFORM jobs (.jbi): //POS positions and //INST instructions.

Poses are those of the tool TOOL n in the frame of their ///POSTYPE; Rx, Ry, Rz turn about the fixed
X, Y, Z (Rz(Rz) Ry(Ry) Rx(Rx)). Positions in pulses are joint targets, with the pulses a degree that a person
gives; ///ANGLE has degrees. Jobs that are called lie beside the file, NAME.JBI. What only the controller can know
is a Problem.

V= has the unit that the controller's parameter for the speed of linear motions selects; the job file
does not tell it. Post-processors in use write mm/s with one decimal (V=100.0) and warn that the
controller may be set to cm/min instead. By INFORM's manuals mm/s goes in steps of 0.1, cm/min in
whole numbers: V= with a decimal point is read as mm/s, without one as unknown.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...program import Program, Unknown
from ..core.flow import Leave
from ..core.statements import Statements
from ..core.tree import Node
from . import jobs
from .jobs import Job
from .motions import MOVE, Motions
from .variables import CALCULATED

MOTIONS = ("movj", "movl", "movc", "movs", "imov", "smovj", "smovl", "smovc", "smovs")
BLOCKS = {"ifthen": "if_", "if": "if_", "while": "while_", "for": "for_", "switch": "switch_"}
DIVIDING = ("elseif", "else", "case", "default")
# Neither the path nor a number or a position depends on them.
QUIET = frozenset(
    """
    nop dout aout aration aratiof wait timer pause msg cls pulse skillsnd tsync arcon arcof arcset svspot gunchg wvon
    wvof advinit advstop refp pstart pwait acc hsen vstart hand toolon toolof spyon spyof weldon weldof shckset
    shckrst comm setreg label
    """.split()
)
# They set what they name to what is known at run time only: their first operand, or (OTHERS) all.
FIRST = frozenset("sete gets getpos gete cnvrt mulmat invmat mframe mshift".split()) | {
    *CALCULATED
} - {"getarg"}
OTHERS = frozenset("din and or not xor clear getreg latch dialog string cnvset getarg".split())
SHIFTS = frozenset(("sfton", "sftof"))
USES_FRAME = {"mshift", "sfton", "getuframe", "gettool"}  # they name one and leave it as it is
OPERAND = re.compile(r"\w+\s+\S+")
VARIABLE = re.compile(r"(?<![\w])L?PX?(?:(\d{1,6})|\[)", re.ASCII)
FRAME = re.compile(r"\b(UF|TL)#\(([^)]*)\)")
COPY = re.compile(r"SET\s+P(\d{1,6})\s+P(\d{1,6})$", re.ASCII)
FOR = re.compile(r"FOR\s+([^\s=]+)\s*=\s*(\S.*?)\sTO\s+(.+?)(?:\sBY\s+(.+))?$")
JUMP = re.compile(r"JUMP\s+\*(\S+)\s*(IF.*)?$")
OTHER_JOB = re.compile(r"JUMP\s+JOB:\s*(\S+)\s*(IF.*)?$")
CALLED = re.compile(r"JOB:\s*(\S+)")


def read(path: Path | str, values: dict[str, Any] | None = None) -> Program:
    """The Program of a .jbi file. ``values``: what a person gives, {NAME: number}. Raises ProgramError when it
    cannot be read."""
    return _Reader(path, values).followed()


class _Reader(Motions):
    """Follows a job, and those that it calls."""

    LANGUAGE = "Yaskawa INFORM"
    SUFFIXES = jobs.SUFFIXES
    RELATIVE = re.compile(r"IMOV|CALL")
    KEPT = ("job",)
    RETURNING = frozenset(("ret", "end"))
    LEAVING = frozenset(("ret", "end", "break", "continue"))
    BLOCKS = BLOCKS
    CLOSED_BY = {
        "ifthen": ("endif",),
        "if": ("endif",),
        "while": ("endwhile",),
        "for": ("next",),
        "switch": ("endswitch",),
    }
    FOR = FOR
    LEFT_OUT = (
        "programs.inform.motions_left_out",
        "{what}; motions up to line {last} are left out",
    )
    UNREADABLE = (
        "programs.inform.job_unreadable",
        "the job that is called cannot be read ({reason})",
    )
    ELSEWHERE = (
        "programs.inform.job_elsewhere",
        "job {name} is not in this file; motions in it are left out",
    )

    def __init__(self, path: Path | str, values: dict[str, Any] | None = None) -> None:
        super().__init__(path, values)
        self.set_here: dict[int, Any] = {}  # positions P that the program itself has set, or lost
        self.all_set = False  # any may have been

    def load(self, path: Path | str, problem: Callable[..., Any]) -> Job:
        return jobs.load(path, problem)

    def take(self, unit: Job) -> None:
        """Goes on with a job: of its positions P those that no other has otherwise; where two files differ nobody
        knows which holds."""
        self.job = unit
        for (letter, n), position in unit.positions.items():
            if letter != "P" or self.all_set or n in self.set_here:
                continue
            if n in self.variables and self.variables[n] != position:
                self.set_position(n, None)
            else:
                self.variables[n] = position

    def state(self) -> Any:
        return self.numbers(), tuple(map(id, self.set_here.values())), id(self.here)

    def set_position(self, n: int, position: Any) -> None:
        """Position P n from here on; None: not known."""
        self.changes += 1
        self.set_here[n] = position
        if position is None:
            self.variables.pop(n, None)
        else:
            self.variables[n] = position

    def forget_positions(self) -> None:
        self.changes += 1
        self.variables.clear()
        self.all_set = True

    def forget_all(self, line: int) -> None:
        self.forget_positions()
        self.forgets_all()

    def leads_to(self, node: Node) -> str | None:
        match = JUMP.match(node.text) if node.word == "jump" else None
        return match.group(1) if match else None

    def called(self, node: Node) -> str | None:
        """The name of the job that a statement calls; "": one of which nobody knows here what it does."""
        match = OTHER_JOB.match(node.text)
        if node.word == "call" or match:
            match = CALLED.search(node.text)
            return match.group(1).upper() if match else ""
        return "" if node.word.startswith("macro") else None

    def may_change(self, node: Node) -> tuple[bool, dict[str, list[Node]]]:
        name = self.called(node)
        if name is not None:
            return self.may_call(node.line, name)
        if MOVE.match(node.text) or node.text.startswith("+MOV"):
            self.here = None
            return not node.text.startswith("+"), {}
        self.change(node, maybe=True)
        return False, {}

    def change(self, node: Node, maybe: bool = False) -> None:
        """What a statement sets at run time is unknown from here on: variables, frames, a shift of all;
        ``maybe``: it may not run."""
        line, word, text = node.line, node.word, node.text
        if word in QUIET or word in DIVIDING or word in ("jump", "unclosed") or text[:1] in "'*+":
            return
        if word == "for":
            self.forgets_named(text.partition("=")[0])
        if node.body is not None:
            return
        self.forgets_named(text)
        first = OPERAND.match(text) if word in FIRST else None
        for n in VARIABLE.findall(first.group() if first else text):
            if n:
                self.set_position(int(n), None)
            else:  # P[I000]
                self.forget_positions()
        if word == "speed":
            self.speed_set = None
        elif word == "clear":  # as many as it says
            self.forget_all(line)
        if word in FIRST - {"mframe", "mshift"} or word in OTHERS:
            return
        self.may_shift(line, text, maybe)
        for letters, n in () if word in USES_FRAME else FRAME.findall(text):
            kind = "USER" if letters == "UF" else "TOOL"
            every = {one for position in self.job.positions.values() for one in position[1:]}
            words = {f"{kind} {int(n)}"} if n.isdecimal() else every
            for one in words:
                if one.startswith(kind):
                    self.frames[one] = f"{one} after line {line}"

    def does(self, node: Node) -> None:
        line, text, word = node.line, node.text, node.word
        match, copy = MOVE.match(text), COPY.match(text)
        if match:
            self.move(line, *match.groups())
        elif text.startswith("'") or word in QUIET:
            pass
        elif word == "jump":
            self.jump(node)
        elif word in self.RETURNING:
            raise Leave("return", line)
        elif word == "abort":
            raise Leave("exit", line)
        elif word in ("break", "continue"):
            self.leaves_loop(node)
        elif word == "call" or word.startswith("macro"):
            self.calls(node)
        elif copy and int(copy.group(2)) in self.variables:
            self.set_position(int(copy.group(1)), self.variables[int(copy.group(2))])
        elif not self.calculates(word, text):
            self.others(node)

    def others(self, node: Node) -> None:
        """What is not followed, or sets what is known at run time only."""
        line, text, word = node.line, node.text, node.word
        self.change(node)
        if word == "speed":
            self.speed_set = self.speed(line, text[5:])
        elif text.startswith("+"):
            self.note_once(
                line,
                "programs.inform.second_robot",
                "motions of a second robot or station (+MOV) are ignored",
            )
        elif re.match(r"\w*MOV", text):
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        elif word == "mshift" or word not in FIRST | OTHERS | SHIFTS:
            self.problem(
                line,
                "programs.ignored",
                "'{text}' is not understood; it is ignored",
                text=text[:40],
            )

    def jump(self, node: Node) -> None:
        match, other = JUMP.match(node.text), OTHER_JOB.match(node.text)
        if other and not other.group(2):
            self.calls(node)
            raise Leave("return", node.line)
        condition = match.group(2) if match else None
        label = match.group(1) if match else ""
        self.goes_to(node, label, self.condition(condition) if condition else None)

    def calls(self, node: Node) -> None:
        """Follows the job that is called, NAME.JBI beside the file."""
        name = self.called(node) or ""
        if not self.call(node.line, name, self.arguments_of(node.text)):
            match = CALLED.search(node.text)
            self.call_unknown(
                node.line, match.group(1) if match else node.text.partition(" ARG")[0]
            )


STATEMENTS = Statements(
    followed=[
        *(one.upper() for one in (*MOTIONS, *BLOCKS, *DIVIDING, *CALCULATED)),
        *"JUMP CALL RET END ABORT BREAK CONTINUE SPEED ENDIF ENDWHILE NEXT ENDSWITCH".split(),
    ],
    ignored=sorted(one.upper() for one in QUIET),
    asked=sorted(one.upper() for one in (FIRST | OTHERS) - {*CALCULATED, "mshift"}),
    left_out=["MACRO1", *sorted(one.upper() for one in SHIFTS), "MSHIFT", "+MOV"],
)
