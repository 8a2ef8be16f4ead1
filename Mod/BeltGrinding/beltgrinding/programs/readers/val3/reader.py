"""Reads Stäubli VAL3: a program (.pgx) with the data (.dtx) and the other programs beside it.

Poses are those of the tool in the point's frame, as programmed; ``base`` names that frame and gives
its pose in the world through the chain of frames. ``val3_data`` says how x, y, z, rx, ry, rz are
meant. Data have the values the .dtx gives. A motion's speed is the mdesc's tvel; vel is a share of
the joints' speed and no path speed. What only the controller can know is a Problem. A .dtx without
a program gives its points as PTP targets, over which nothing is ground.
"""

from pathlib import Path

from ....base.files import cannot_be_read
from ....base.regular_files import shown
from ....base.stopping import check
from ...program import Fact, Motion, ProgramError, Unknown, name_of
from . import data
from .control import ASSIGN, CALL, HARMLESS, INSTRUCTION, MOTION, MOVES, NAME, Break, Control
from .data import Array, Missing, Record, number, six
from .expression import split
from .project import Project, routines
from .state import PER_VALUE, State

NO_TVEL = Fact(
    "programs.val3.no_tvel", "the mdesc sets no tvel, and vel is a share of the joints' speed"
)
MAX_CALLS = 20
KINDS = {"movej": "PTP", "movel": "LIN", "movec": "CIRC"}


def read(path):
    """The Program of a .pgx, or of a .dtx. Raises ProgramError when it cannot be read at all."""
    path = Path(path)
    interpreter = None
    try:
        if path.suffix.lower() == ".dtx":
            beside = path.with_suffix(".pgx")
            if not beside.is_file():
                return _points(path)
            path = beside
        interpreter = _Interpreter(Project(path))
        interpreter.run()
    except RecursionError:
        error = ProgramError("programs.val3.nested", "values or calls are nested too deeply")
        if interpreter is None:
            raise error.within("programs.in_file", "{file}: ", file=name_of(path)) from None
        raise error.in_line(interpreter.file, interpreter.line) from None
    except OSError as error:
        raise ProgramError.of(cannot_be_read(shown(path), error)) from None
    return interpreter.finish()


def _points(path):
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
        "there is no program of this name beside it; its points are given as PTP targets",
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


class _Return(Exception):
    """The program ends here."""


class _Interpreter(Control):
    """Follows a program from begin to end with the values it can know."""

    def __init__(self, project):
        super().__init__(project)
        self.calls = 0

    def run(self):
        # The program itself first: what is wrong with it is the more important message.
        name = self.project.path.stem
        found = self.project.routine(name) if self.project.path.is_file() else None
        if found is None:
            every = routines(self.project.path)
            self.project.routines.update({r.name: r for r in every})
            found = self.project.routines.get(name) or every[0]
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
        self.routine(found, scope)
        self.file = found.file
        if not self.rows:
            moves = any(MOVES.search(n.text) for n in _every(found.body))
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

    def routine(self, routine, scope):
        for name, kind, size in routine.local_data:
            items = (
                [None] * size
                if 0 < size <= data.MAX_SIZE
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
        except _Return:
            pass
        except Break as end:
            self.problem(
                end.line,
                "programs.val3.break",
                "break leaves no switch; what follows in the program is left out",
            )
            self.gap(end.line)
        finally:
            self.file, self.scope = outer

    def statement(self, node):
        word = node.word
        if node.body is not None:
            getattr(self, word + "_")(node)
            return
        match = MOTION.match(node.text)
        if match:
            self.motion(node, *match.groups())
        elif word == "call":
            self.call(node)
        elif word == "return":
            raise _Return
        elif word == "break":
            raise Break(node.line)
        elif word == "taskcreate" or word == "taskcreatesync":
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

    def motion(self, node, target, word, text):
        try:
            if word not in KINDS:
                raise Unknown(
                    "programs.val3.motion_at_run_time",
                    "this motion is decided at run time, or is not known",
                )
            row = split(text)
            count = 2 if word == "movec" else 1
            if len(row) != count + 2:
                raise Unknown(
                    "programs.val3.arguments",
                    "it has {count} arguments instead of {expected}",
                    count=len(row),
                    expected=count + 2,
                )
            targets = [self.value(part) for part in row[:count]]
            self.move(node.line, KINDS[word], targets, row[count], row[count + 1])
        except Unknown as unknown:
            self.problem(
                node.line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word,
                reason=unknown.fact,
            )
            self.gap(node.line)
        if target:
            self.unknown(
                target.strip(),
                Fact("programs.val3.motion_number", "it numbers a motion at run time"),
            )

    def move(self, line, kind, targets, tool, mdesc):
        end = targets[-1]
        if (
            isinstance(end, list) and kind == "PTP"
        ):  # {..} without a type: joints, as many as it has
            end = data.as_kind("jointRs" if len(end) == 4 else "joint", end)
        if isinstance(end, Record) and end.kind == "joint":
            if kind != "PTP":
                raise Unknown("programs.joint_target", "its target is a joint position")
            for name in end.fields:
                number(end.get(name))
            motion = Motion("PTP", None, line, self.file, tool=self.tool(line, tool))
            self.program.motions.append(motion)
            return
        rows = []
        for point in targets:
            if not isinstance(point, Record) or point.kind != "point":
                raise Unknown("programs.val3.no_point", "its target is no point")
            row = six(point.get("trsf"))
            if isinstance(point.father, Missing):
                raise Unknown(point.father.why)
            if point.father is None and not any(row):
                raise Unknown(
                    "programs.val3.not_taught",
                    "the point has no value: it was not taught, or the .dtx is not whole",
                )
            if isinstance(getattr(end, "father", None), Missing):
                raise Unknown(end.father.why)
            if point.father is not end.father:  # an arc's point in another frame
                home = data.in_world(end.father) if end.father else (0.0,) * 6
                row = data.product(data.inverse(home), data.in_world(point))
            rows.append(row)
        base, held = self.described(end.father, "world"), self.tool(line, tool)
        speed = self.speed(line, kind, mdesc)
        for k, row in enumerate(rows):
            motion = Motion(kind, None, line, self.file, speed, tool=held, base=base)
            motion.aux = k < len(rows) - 1
            self.program.motions.append(motion)
            self.rows.append((motion, row))

    def tool(self, line, text):
        try:
            value = self.value(text)
            if not isinstance(value, Record) or value.kind != "tool":
                raise Unknown("programs.val3.no_tool", "it is no tool")
            return self.described(value, "flange")
        except Unknown as unknown:
            self.problem(
                line,
                "programs.val3.tool_unknown",
                "the tool {text} is not known: {reason}",
                text=text[:40],
                reason=unknown.fact,
                once=("tool", text),
            )
            return text[:40]

    def speed(self, line, kind, text):
        """mm/s; None for a joint motion or where no path speed is set."""
        if kind == "PTP":
            return None
        try:
            value = self.value(text)
            if not isinstance(value, Record) or value.kind != "mdesc":
                raise Unknown("programs.val3.no_mdesc", "{text} is no mdesc", text=text[:40])
            speed = number(value.get("tvel"))
            if speed <= 0:
                raise Unknown("programs.val3.speed_not_positive", "tvel is not positive")
            if speed < data.NO_LIMIT:
                return speed * self.project.unit
            raise Unknown(NO_TVEL)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.val3.speed_unknown",
                "the path speed of {text} is not known: {reason}; the default is used",
                text=text[:40],
                reason=unknown.fact,
                once=("speed", text, unknown.fact),
            )
            return None

    def assignment(self, node, target, text):
        try:
            self.assign(target, self.value(text))
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.unknown(target, unknown.fact)

    def instruction(self, node):
        match = INSTRUCTION.match(node.text)
        if not match:
            if node.word not in ("putln", "put", "wait", "title", "popupmsg", "logmsg"):
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
        if word in ("link", "resize"):
            self.change(node, word, text)
        elif word not in HARMLESS:
            message = Fact(
                "programs.val3.instruction",
                "{word}() is known to the controller only; what it changes is not known",
                word=word,
            )
            self.problem(node.line, message, once=("instruction", word))
            self.handed(text)

    def change(self, node, word, text):
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
            if isinstance(array.items, dict) or not 1 <= size <= data.MAX_SIZE:
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

    def call(self, node):
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
        scope, back = {}, []
        for (parameter, kind, by_reference), text in zip(routine.parameters, row):
            scope[parameter] = self.parameter(kind, text)
            if by_reference and NAME.fullmatch(text) and scope[parameter].items is not None:
                try:
                    scope[parameter] = self.array(text)
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

    def parameter(self, kind, text):
        try:
            return Array(kind, [data.as_kind(kind, self.value(text))])
        except Unknown as unknown:
            return Array(kind, Missing(unknown.fact))


def _every(nodes):
    stack = list(nodes)
    while stack:
        node = stack.pop()
        stack += node.body or []
        yield node
