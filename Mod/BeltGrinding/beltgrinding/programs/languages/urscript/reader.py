"""Reads URScript of Universal Robots.

Metres, radians and rotation vectors in the file; mm in the Program. Meaning of the functions as in
Universal Robots' "The URScript Programming Language" (movel without v: 0.25 m/s). Poses are those
of the TCP in ``ref_frame``, the variable that post-processors put a workpiece's frame in, as it
stands at the first Cartesian target; where it is not assigned, in the robot's base. Targets in
another frame are converted, so all poses of a Program are in one frame. Joint targets have no pose.
What only the controller can know is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from ....base.kinds import known
from ....base.stopping import check
from ...program import LOOPED, Fact, Program, Reason, Unknown, bytes_of, lines_of, name_of, work_of
from ..core.expression import Call
from ..core.flow import Leave
from ..core.lines import joined
from ..core.statements import Statements
from ..core.tree import Node, grown
from .expression import expression
from .motion import PARAMETERS, SHIFTS, Motions
from .scopes import ASSIGN, MOVE, MOVES

CLOSED_BY = dict.fromkeys(("def", "thread", "sec", "while", "if"), ("end",))
DEFINE = re.compile(r"^def\s+([A-Za-z_]\w*)\s*\((.*)\)\s*:?$")
# A line that begins so does not go on from the one before.
BEGINS = re.compile(
    r"(?:def|thread|sec|while|if|elif|else|end|return|global|local|break|continue|halt)\b|(?:move|servo|speed)[jlpc]\s*\("
    r"|[A-Za-z_]\w*\s*=(?!=)\s*(?:p\s*)?\["
)
COMMENT = re.compile(r'("[^"]*")|#.*')
# Functions that neither move the robot nor shift where motions lie, and how the names of many begin.
QUIET = (
    "textmsg popup sleep sync stopj stopl unlock varmsg end_freedrive_mode end_teach_mode end_screw_driving_mode"
).split()
BEGINNINGS = (
    "set get is write read socket modbus rtde rpc popup textmsg zero request enter exit tool reset str to encoder "
    "force_mode_set"
).split()
HARMLESS = re.compile(rf"(?:{'|'.join(QUIET)}|(?:{'|'.join(BEGINNINGS)})_\w+|\w+(?:\.\w+)+)$")
SETTING = {"set_tcp": "set_tool", "force_mode": "start_force", "end_force_mode": "end_force"}
LEFT = ("break", "continue", "halt")


def read(path: Path | str) -> Program:
    """The Program of a .script file. Raises ProgramError when it cannot be read at all."""
    raw = bytes_of(path, "URScript")
    text = raw.decode("utf-8-sig", errors="replace")
    interpreter = Interpreter(name_of(path))
    interpreter.run(interpreter.tree(lines_of(text, interpreter.file)))
    return interpreter.program


def assigned(text: str) -> str | None:
    """The name of what a statement assigns, or None."""
    match = ASSIGN.match(text)
    return match.group(2) if match else None


class Interpreter(Motions):
    """Follows a program from top to bottom with the values it can know."""

    BLOCKS = {"if": "if_", "while": "while_"}
    OTHERWISE = ("elif", "else")
    LEAVING = frozenset(("break", "return", "halt"))
    RETURNING = LEAVING - {"break"}

    def tree(self, lines: Iterable[str]) -> list[Node]:
        """The Nodes of a file. A block without its end, or the other way round, is a Problem."""
        rows = []
        for line, text in enumerate(lines, 1):
            text = COMMENT.sub(lambda m: m.group(1) or "", text).strip()
            if text:
                rows.append((line, text))

        def stray(line: int, word: str, text: str, node: Node | None) -> None:
            self.problem(
                line,
                "programs.urscript.no_beginning",
                "'{text}' has no beginning, or is not understood",
                text=text[:40],
            )

        def unclosed(node: Node, line: int) -> None:
            self.problem(
                node.line,
                "programs.urscript.no_end",
                "{word} has no end; the file may be cut off",
                word=node.word,
            )

        words = self.words(joined(rows, BEGINS.match))
        return grown(words, CLOSED_BY, self.file, stray, unclosed)

    def words(self, rows: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str, str]]:
        """(line, first word, text) of statements; "end" as such closes a block."""
        for line, text in rows:
            check()
            self.rounds -= LOOPED * work_of(text)
            word = known(re.match(r"\w*", text)).group(0)
            if "ref_frame" in text and (word == "def" or assigned(text) == "ref_frame"):
                self.free_reference = False
            yield line, "?" if word == "end" and text != "end" else word, text

    def run(self, nodes: Sequence[Node]) -> None:
        try:
            self.block(nodes)
            if self.routines and not self.called:  # the controller runs what it is sent
                self.invoke(Call(next(iter(self.routines)), [], {}))
        except Leave:
            pass

    def beside_it(self, node: Node) -> None:
        """A thread, which runs beside the program."""
        if node.word == "thread":
            self.beside |= self.assigned_in(known(node.body))
        self.leave_out(
            node,
            Fact(
                "programs.urscript.beside",
                "a {kind} runs beside the program",
                kind=node.word,
            ),
        )

    def define(self, node: Node) -> None:
        match = DEFINE.match(node.text)
        if not match:
            self.leave_out(node, Fact("programs.urscript.def", "the def is not understood"))
            return
        names = [p.partition("=") for p in match.group(2).split(",") if p.strip()]
        defaults = [(name.strip(), default) for name, _, default in names]
        self.routines.setdefault(match.group(1), (defaults, known(node.body)))

    def leave_out(self, node: Node, why: Fact) -> None:
        """Leaves a block out: its motions are a gap, what it assigns is unknown afterwards."""
        message = Fact("programs.motions_left_out", "{what}; its motions are left out", what=why)
        self.skip(known(node.body), node.line, message, Reason(why))

    def may_change(self, node: Node) -> tuple[bool, Mapping[str, Sequence[Node]]]:
        self.lose_calls(node.text)
        if node.body is not None or node.word in self.OTHERWISE:
            return bool(MOVE.search(node.text)), {}
        self.lose(self.names_of(node.text))
        self.touch(node.line, node.text, maybe=True)
        return bool(MOVE.search(node.text)) or node.word in self.routines, {}

    def statement(self, node: Node) -> None:
        line, text = node.line, node.text
        if node.word in ("def", "thread", "sec") and node.body is not None:
            self.define(node) if node.word == "def" else self.beside_it(node)
            return
        if text in LEFT:
            raise Leave("exit" if text == "halt" else text, line)
        if node.word == "return":
            try:
                self.returned = self.value(text[6:])
            except Unknown:
                self.lose_calls(text[6:])
            raise Leave("return", line)
        match = ASSIGN.match(text)
        if match:
            self.assignment(match, line)
            return
        try:
            call = expression(text)
            if not isinstance(call, Call):
                raise Unknown("programs.urscript.statement", "the statement is not understood")
            name = call.name
            if name in PARAMETERS:
                self.motion(line, name, call)
            elif name in SETTING:
                getattr(self, SETTING[name])(line, call)
            elif name in self.routines:
                self.invoke(call)
            else:
                self.touch(line, text)
                self.not_known(line, name)
        except Unknown as unknown:
            self.touch(line, text)
            self.lose_calls(text)
            self.lose(self.names_of(text))
            word = known(re.match(r"\w*", text)).group(0) or text[:40]
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word,
                reason=unknown.fact,
            )
            self.gap(line)

    def not_known(self, line: int, name: str) -> None:
        """A call of what is no routine here, and may move the robot."""
        if HARMLESS.match(name):
            return
        if name not in self.missing:
            self.missing.add(name)
            self.problem(
                line,
                "programs.urscript.unknown_call",
                "{name}() is not known here; motions in it are left out",
                name=name,
            )
        self.gap(line)


STATEMENTS = Statements(
    followed=[*PARAMETERS, *SETTING, *Interpreter.BLOCKS, *LEFT, "def", "return"],
    ignored=[*QUIET, *(f"{beginning}_*" for beginning in BEGINNINGS), "OBJECT.METHOD"],
    left_out=[*(name for name in MOVES if name not in PARAMETERS), *SHIFTS, "thread", "sec"],
)
