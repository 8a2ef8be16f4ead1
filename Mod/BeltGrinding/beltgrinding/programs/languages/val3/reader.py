"""Reads Stäubli VAL3: a program (.pgx) with the data (.dtx) and the other programs beside it.

Poses are those of the tool in the point's frame, as programmed; ``base`` names that frame and gives
its pose in the world through the chain of frames. ``val3_data`` says how x, y, z, rx, ry, rz are
meant. Data have the values the .dtx gives. A motion's speed is the mdesc's tvel; vel is a share of
the joints' speed and no path speed. What only the controller can know is a Problem. A .dtx without
a program gives its points as PTP targets, over which nothing is ground.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ....base.files import cannot_be_read
from ....base.regular_files import shown
from ....base.stopping import check
from ...program import Fact, Motion, Program, ProgramError, Unknown, name_of
from . import data
from ..core.flow import Leave
from ..core.statements import Statements
from ..core.tree import Node, every
from .control import ASSIGN, CALL, HARMLESS, INSTRUCTION, MOTION, MOVES
from .data import Array, Missing, number, six
from .dtx import MAX_SIZE
from .expression import place, split
from .motion import ALTERED, KINDS, Motions
from .project import Project, Routine, routines
from .state import PER_VALUE, State

MAX_CALLS = 20
TASKS = ("taskCreate", "taskCreateSync")
SAYING = (
    "putln",
    "put",
    "wait",
    "title",
    "popupmsg",
    "logmsg",
)  # with any arguments
CHANGES = ("link", "resize")


def read(path: Path | str) -> Program:
    """The Program of a .pgx, or of a .dtx. Raises ProgramError when it cannot be read at all."""
    path = Path(path)
    try:
        if path.suffix.lower() == ".dtx":
            beside = path.with_suffix(".pgx")
            if not beside.is_file():
                return _points(path)
            path = beside
        interpreter = _Interpreter(Project(path))
        interpreter.run()
    except OSError as error:
        raise ProgramError.of(cannot_be_read(shown(path), error)) from None
    return interpreter.finish()


def _points(path: Path) -> Program:
    state = State(Project(path))
    state.globals = state.project.data()
    state.project.project()
    for file, line, message in state.project.notes:
        state.file = file
        state.problem(line, message)
    state.file = name_of(path)
    state.problem(
        1,
        "programs.val3.no_program_beside",
        "the file holds data, no program, and no .pgx of its name is beside it: its points are read as PTP targets in "
        "their order; give the .pgx that moves to them",
    )
    for name, array in state.globals.items():
        if data.POSED.get(array.kind) != "point" or isinstance(array.items, Missing):
            continue
        keys = array.items if isinstance(array.items, dict) else range(len(array.items))
        for key in keys:
            check()
            if array.items[key] is None:  # never taught
                continue
            line = getattr(array.items[key], "line", 1)
            try:
                point = state.item(array, key if isinstance(key, str) else float(key), name)
                row = six(point.get("trsf"))
                if isinstance(point.father, Missing):
                    raise Unknown(point.father.why)
            except Unknown as unknown:
                state.problem(
                    line,
                    "programs.val3.point_left_out",
                    "{name}[{index}] is left out: {reason}",
                    name=name,
                    index=key,
                    reason=unknown.fact,
                )
                state.gap(line)
                continue
            motion = Motion("PTP", None, line, state.file)
            motion.base = state.described(point.father, "world")
            state.program.motions.append(motion)
            state.rows.append((motion, row))
    return state.finish()


class _Interpreter(Motions):
    """Follows a program from begin to end with the values it can know."""

    def __init__(self, project: Project) -> None:
        super().__init__(project)
        self.calls = 0

    def run(self) -> None:
        # The program itself first: what is wrong with it is the more important message.
        name = self.project.path.stem
        found = self.project.routine(name) if self.project.path.is_file() else None
        if found is None:
            found_all = routines(self.project.path)
            self.project.routines.update({r.name: r for r in found_all})
            found = self.project.routines.get(name) or found_all[0]
        self.globals = self.project.data()
        given = [a.items for a in self.globals.values() if not isinstance(a.items, Missing)]
        self.rounds -= PER_VALUE * sum(sum(v is not None for v in values) for values in given)
        self.project.project()
        for file, line, message in self.project.notes:
            self.file = file
            self.problem(line, message)
        self.file = found.file
        scope = {
            name: Array(
                kind,
                Missing(
                    "programs.val3.parameter",
                    "{name} is a parameter that the caller gives",
                    name=name,
                ),
            )
            for name, kind, _ in found.parameters
        }
        try:
            self.routine(found, scope)
        except Leave:
            pass
        self.file = found.file
        if not self.rows:
            moves = any(MOVES.search(n.text) for n in every(found.body))
            why = (
                Fact("programs.val3.not_known_here", "what its motions depend on is not known here")
                if moves or self.program.motions
                else Fact("programs.val3.no_motion", "it commands no motion (movej, movel, movec)")
            )
            self.problem(
                found.line,
                "programs.val3.no_pose",
                "the program {name} gives no pose: {reason}",
                name=found.name,
                reason=why,
            )

    def routine(self, routine: Routine, scope: dict[str, Array]) -> None:
        for name, kind, size in routine.local_data:
            items: Any = (
                [None] * size
                if 0 < size <= MAX_SIZE
                else Missing("programs.val3.no_size", "{name} has no size", name=name)
            )
            scope[name] = Array(kind, items)
            self.tick(self.line, size // 8)
        self.rounds -= routine.work
        routine.work = 0  # a second call is work beyond what the file has
        outer = self.file, self.scope
        self.file, self.scope = routine.file, scope
        try:
            self.block(routine.body)
        except Leave as end:
            if end.word == "exit":
                raise
            if end.word == "break":
                self.problem(
                    end.line,
                    "programs.val3.break",
                    "break leaves no switch; what follows in the program is left out",
                )
                self.gap(end.line)
        finally:
            self.file, self.scope = outer

    def statement(self, node: Node) -> None:
        word = node.word
        match = MOTION.match(node.text)
        if match:
            self.motion(node, *match.groups())
        elif word == "call":
            self.call(node)
        elif word == "return":
            raise Leave("return", node.line)
        elif word == "break":
            raise Leave("break", node.line)
        elif word in map(str.lower, TASKS):
            self.problem(
                node.line,
                "programs.val3.task",
                "a task runs beside the program; open the task's own program",
            )
            self.gap(node.line)
        elif match := ASSIGN.match(node.text):
            self.assignment(node, *match.groups())
        else:
            self.instruction(node)

    def assignment(self, node: Node, target: str, text: str) -> None:
        try:
            self.assign(target, self.value(text))
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.unknown(target, unknown.fact)

    def instruction(self, node: Node) -> None:
        match = INSTRUCTION.match(node.text)
        if not match:
            if node.word not in SAYING:
                self.problem(
                    node.line,
                    "programs.not_understood",
                    "'{text}' is not understood",
                    text=node.text[:40],
                )
                if MOVES.search(node.text):
                    self.gap(node.line)
                else:
                    self.lose(node.text)
            return
        word, text = match.groups()
        if word in CHANGES:
            self.change(node, word, text)
        elif word not in HARMLESS:
            message = Fact(
                "programs.val3.instruction",
                "{word}() is known to the controller only; what it changes is not known",
                word=word,
            )
            self.problem(node.line, message, once=("instruction", word))
            self.handed(text)

    def change(self, node: Node, word: str, text: str) -> None:
        """link(point, frame): the point, frame or tool belongs to another frame from here on."""
        try:
            row = split(text)
            if word == "link" and len(row) == 2:
                value, father = self.value(row[0]), self.value(row[1])
                kinds = {getattr(value, "kind", ""), getattr(father, "kind", "")}
                if father is value or not kinds <= {"point", "frame"}:
                    raise Unknown(
                        "programs.val3.point_and_frame_expected", "a point and a frame expected"
                    )
                value.father = None if row[1] == "world" else father
                self.texts.clear()
                return
            array, size = self.array(row[0]), number(self.value(row[-1]))
            if isinstance(array.items, dict) or not 1 <= size <= MAX_SIZE:
                raise Unknown("programs.val3.size", "the size is not sensible")
            self.rounds += int(size) // 8
            array.items[int(size) :] = [None] * max(0, int(size) - len(array.items))
        except (Unknown, IndexError) as unknown:
            self.problem(
                node.line,
                "programs.val3.not_followed",
                "{word} is not followed: {reason}",
                word=word,
                reason=getattr(unknown, "fact", str(unknown)),
            )
            self.lose(text)

    def call(self, node: Node) -> None:
        match = CALL.match(node.text)
        name = match[1] if match else node.text[4:30].strip()
        try:
            row = split(match[2] or "") if match else []
            if ":" in name:
                raise Unknown("programs.val3.library", "it belongs to a library")
            if self.calls >= MAX_CALLS:
                raise Unknown("programs.calls_itself", "it calls itself too deeply")
            try:
                routine = self.project.routine(name)
            except ProgramError as error:
                raise Unknown(error.fact) from None
            if routine is None:
                raise Unknown(
                    "programs.val3.no_program_of_name",
                    "there is no {name}.pgx beside it",
                    name=name,
                )
            if len(row) != len(routine.parameters):
                raise Unknown(
                    "programs.val3.parameters",
                    "it has {count} parameters, not {given}",
                    count=len(routine.parameters),
                    given=len(row),
                )
        except Unknown as unknown:
            message = Fact(
                "programs.val3.call_left_out",
                "call {name} is left out: {reason}; motions in it are left out",
                name=name,
                reason=unknown.fact,
            )
            self.problem(node.line, message)
            self.gap(node.line)
            self.handed(match[2] or "" if match else node.text)
            return
        scope: dict[str, Array] = {}
        back: list[tuple[str, str]] = []
        for (parameter, kind, by_reference), text in zip(routine.parameters, row):
            scope[parameter] = self.parameter(kind, text)
            if by_reference:
                try:
                    scope[parameter] = self.array_at(place(text))
                    continue
                except Unknown:
                    pass
            if by_reference:
                back.append((parameter, text))
        self.calls += 1
        try:
            self.routine(routine, scope)
        finally:
            self.calls -= 1
        for parameter, text in back:
            items = scope[parameter].items
            value = items if isinstance(items, Missing) else items[0]
            try:
                self.assign(text, value)
            except Unknown as unknown:
                self.unknown(text, unknown.fact)

    def parameter(self, kind: str, text: str) -> Array:
        try:
            return Array(kind, [data.as_kind(kind, self.value(text))])
        except Unknown as unknown:
            return Array(kind, Missing(unknown.fact))


STATEMENTS = Statements(
    followed=[*KINDS, *_Interpreter.BLOCKS, *CHANGES, "call", "return", "break"],
    ignored=sorted(HARMLESS),
    left_out=[*TASKS, *ALTERED],
)
