"""Reads URScript of Universal Robots.

Metres, radians and rotation vectors in the file; mm in the Program. Meaning of the functions as in
Universal Robots' "The URScript Programming Language" (movel without v: 0.25 m/s). Poses are those
of the TCP in ``ref_frame``, the variable that post-processors put a workpiece's frame in, as it
stands at the first Cartesian target; where it is not assigned, in the robot's base. Targets in
another frame are converted, so all poses of a Program are in one frame. Joint targets have no pose.
What only the controller can know is a Problem.
"""

import ast
import contextlib
import math
import re
import warnings

import numpy as np

from ....base.stopping import check
from ...program import (
    LOOPED,
    MAX_UNROLLED,
    SKIPPED,
    Fact,
    Motion,
    Program,
    ProgramError,
    Unknown,
    bytes_of,
    joint_angles,
    lines_of,
    name_of,
    work_of,
)
from .expression import InReference, Pose, a_pose, evaluate, number, parse, pose_of

MAX_MOTIONS = 1_000_000
MAX_IDLE = 25_000  # units of work since the last motion, in a loop
MAX_CALLS = 20
MAX_NESTING = 20
ELEMENTS = 50  # of a list, which are copied in a unit of work
DEFAULT_SPEED = 0.25  # m/s, without v
MOVE = re.compile(r"\b(?:move[jlpc]|optimove[jl]|servo[jc]|speed[jl])\s*\(")
ASSIGN = re.compile(r"^(?:(global|local)\s+)?([A-Za-z_]\w*)\s*(?:(\[.*?\])\s*)?=(?!=)\s*(.+)$")
DEFINE = re.compile(r"^def\s+([A-Za-z_]\w*)\s*\((.*)\)\s*:?$")
IN_REFERENCE = "ref_frame"  # the base of poses in a ref_frame that the file does not assign
COMMENT = re.compile(r'("[^"]*")|#.*')
PARAMETERS = {
    "movej": ("q", "a", "v", "t", "r"),
    "movel": ("pose", "a", "v", "t", "r"),
    "movep": ("pose", "a", "v", "r"),
    "movec": ("pose_via", "pose_to", "a", "v", "r", "mode"),
    "optimovej": ("goal", "a", "v", "r"),
    "optimovel": ("goal", "a", "v", "r"),
}
KINDS = {"movej": "PTP", "movel": "LIN", "movep": "LIN", "movec": "CIRC"}
KINDS |= {"optimovej": "PTP", "optimovel": "LIN"}
HARMLESS = re.compile(
    r"^(?:(?:set|get|is|write|read|socket|modbus|rtde|rpc|popup|textmsg|zero|request|enter|exit|"
    r"tool|reset|str|to|encoder)_\w+|textmsg|popup|sleep|sync|stopj|stopl|unlock|"
    r"end_(?:force|freedrive|teach|screw_driving)_mode|varmsg)$"
)


def read(path):
    """The Program of a .script file. Raises ProgramError when it cannot be read at all."""
    raw = bytes_of(path, "URScript")
    text = raw.decode("utf-8-sig", errors="replace")
    interpreter = Interpreter(name_of(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's own advice on the expressions
            interpreter.run(interpreter.tree(lines_of(text, interpreter.file)))
    except RecursionError:
        raise ProgramError.at(
            interpreter.file,
            interpreter.line,
            "programs.nested_calls",
            "calls are nested too deeply",
        ) from None
    return interpreter.program


def assigned(text):
    """The name of what a statement assigns, or None."""
    match = ASSIGN.match(text)
    return match and match.group(2)


class _Block:
    """A statement, or one with blocks in it: ``parts`` holds (line, condition, statements)."""

    def __init__(self, kind, line, text):
        self.kind, self.line, self.text, self.closed = kind, line, text, True
        self.parts = [] if kind == "statement" else [(line, text, [])]


class Interpreter:
    """Follows a program from top to bottom with the values it can know."""

    def __init__(self, name):
        self.program = Program("URScript", name)
        self.file = name
        self.scopes = [{}]  # the global one first; the innermost last
        self.routines = {}
        self.rounds = self.line = 0  # rounds: units of work; below 0: what the file allows
        self.called = False
        self.calls = 0  # of routines in each other
        self.missing = set()
        self.free_reference = True  # the file gives ref_frame no value: another one does
        self.inverse = None  # of the frame all poses are given in, 4 x 4 in metres
        self.base = self.tool = ""
        self.here = self.returned = None  # here: position in mm, None: unknown

    def problem(self, line, told, text=None, /, **arguments):
        self.program.problem(self.file, line, told, text, **arguments)

    def gap(self, line):
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.here = None
        self.program.gap(line, self.file)

    def tree(self, lines):
        """List of _Block. A block without its end, or the other way round, is a Problem."""
        root, open_blocks = [], []
        for line, text in enumerate(lines, 1):
            check()
            text = COMMENT.sub(lambda m: m.group(1) or "", text).strip()
            if not text:
                continue
            self.rounds -= LOOPED * work_of(text)
            word = re.match(r"\w*", text).group(0)
            if "ref_frame" in text and (word == "def" or assigned(text) == "ref_frame"):
                self.free_reference = False
            inner = open_blocks[-1].parts[-1][2] if open_blocks else root
            if word in ("def", "while", "if", "thread", "sec"):
                if len(open_blocks) >= MAX_NESTING:
                    raise ProgramError.at(
                        self.file, line, "programs.nested_blocks", "blocks are nested too deeply"
                    )
                condition = text if word == "def" else text[len(word) :].rstrip(": \t")
                block = _Block(word, line, condition)
                inner.append(block)
                open_blocks.append(block)
            elif word in ("elif", "else") and open_blocks and open_blocks[-1].kind == "if":
                condition = text[4:].rstrip(": \t") if word == "elif" else None
                open_blocks[-1].parts.append((line, condition, []))
            elif word == "end" and text == "end" and open_blocks:
                open_blocks.pop()
            elif word in ("end", "elif", "else"):
                self.problem(
                    line,
                    "programs.urscript.no_beginning",
                    "'{text}' has no beginning, or is not understood",
                    text=text[:40],
                )
            else:
                inner.append(_Block("statement", line, text))
        for block in open_blocks:
            block.closed = False
            self.problem(
                block.line,
                "programs.urscript.no_end",
                "{word} has no end; the file may be cut off",
                word=block.kind,
            )
        return root

    def run(self, blocks):
        self.block(blocks)
        if self.routines and not self.called:  # the controller runs what it is sent
            self.invoke(next(iter(self.routines)), [])

    def block(self, blocks):
        """Runs statements; how they end: None, break, continue, return or halt."""
        for block in blocks:
            self.tick(block.line, work_of(block.text))
            end = None
            if block.kind == "statement":
                end = self.statement(block.line, block.text)
            elif block.kind == "if":
                end = self.branch(block)
            elif block.kind == "while":
                end = self.loop(block)
            elif block.kind == "def":
                self.define(block)
            else:
                self.skip(
                    block,
                    Fact(
                        "programs.urscript.beside",
                        "a {kind} runs beside the program",
                        kind=block.kind,
                    ),
                )
            if end:
                return end
        return None

    def tick(self, line, work):
        check()
        self.rounds, self.line = self.rounds + work, line
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                self.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )

    def define(self, block):
        match = DEFINE.match(block.text)
        if not match:
            self.skip(block, Fact("programs.urscript.def", "the def is not understood"))
            return
        names = [p.partition("=") for p in match.group(2).split(",") if p.strip()]
        defaults = [(name.strip(), default) for name, _, default in names]
        self.routines.setdefault(match.group(1), (defaults, block.parts[0][2]))

    def skip(self, block, why):
        """Leaves a block out: its motions are a gap, what it assigns is unknown afterwards."""
        if self.forget(block) or MOVE.search(block.text):
            self.problem(
                block.line,
                "programs.motions_left_out",
                "{what}; its motions are left out",
                what=why,
            )
            self.gap(block.line)

    def forget(self, block):
        moves = False
        for line, _, blocks in block.parts:
            self.tick(line, 1 + sum(work_of(b.text) for b in blocks) // SKIPPED)
            for inner in blocks:
                if inner.kind != "statement":
                    moves |= self.forget(inner)
                    continue
                match = ASSIGN.match(inner.text)
                if match:
                    for scope in self.scopes:
                        scope.pop(match.group(2), None)
                called = re.match(r"\w+", inner.text)
                moves |= bool(MOVE.search(inner.text)) or (
                    called is not None and called.group(0) in self.routines
                )
        return moves

    def branch(self, block):
        for k, (line, condition, blocks) in enumerate(block.parts):
            if condition is not None:
                self.tick(line, work_of(condition) if k else 0)
                try:
                    known = self.truth(condition)
                except Unknown as unknown:
                    self.skip(
                        block,
                        Fact(
                            "programs.at_run_time",
                            "{word} is decided at run time ({reason})",
                            reason=unknown.fact,
                            word="if",
                        ),
                    )
                    return None
                if not known:
                    continue
            return self.block(blocks)
        return None

    def loop(self, block):
        _, condition, blocks = block.parts[0]
        once = condition.strip(" ()\t") in ("True", "true") or not block.closed
        count, start = len(self.program.motions), self.rounds
        while True:
            try:
                if not self.truth(condition):
                    return None
            except Unknown as unknown:
                self.skip(
                    block,
                    Fact(
                        "programs.at_run_time",
                        "{word} is decided at run time ({reason})",
                        reason=unknown.fact,
                        word="while",
                    ),
                )
                return None
            self.tick(block.line, work_of(condition))
            if len(self.program.motions) > count:
                count, start = len(self.program.motions), self.rounds
            if self.rounds > min(MAX_UNROLLED, start + MAX_IDLE):
                raise ProgramError.at(
                    self.file, block.line, "programs.endless_program", "the loop does not end"
                )
            end = self.block(blocks)
            if end == "break":
                return None
            if end in ("return", "halt"):
                return end
            if once:
                if any(MOVE.search(b.text or "") for b in blocks):
                    self.problem(
                        block.line,
                        "programs.endless",
                        "an endless {word} is followed once",
                        word="while",
                    )
                return None

    def truth(self, condition):
        value = self.evaluate(condition)
        if not isinstance(value, bool):
            raise Unknown("programs.no_truth_value", "the condition is no truth value")
        return value

    def lookup(self, name):
        for scope in (self.scopes[-1], self.scopes[0]):
            if name in scope:
                return scope[name]
        if name in ("true", "false"):
            return name == "true"
        if name == "ref_frame" and self.free_reference:
            if "ref_frame" not in self.missing:
                self.missing.add("ref_frame")
                self.problem(
                    self.line,
                    "programs.urscript.ref_frame_elsewhere",
                    "ref_frame has no value that this file gives; the poses are kept as they are in it",
                )
            return InReference(np.eye(4))
        raise Unknown(
            "programs.urscript.no_value", "{name} has no value that this file gives", name=name
        )

    def evaluate(self, text):
        return evaluate(parse(text), self.lookup, self.function)

    def node(self, node):
        return evaluate(node, self.lookup, self.function)

    def function(self, name, node):
        if name in self.routines:
            value = self.invoke(name, node.args, node.keywords)
            if value is not None:
                return value
            raise Unknown(
                "programs.urscript.no_return_value",
                "{name}() returns no value that is known here",
                name=name,
            )
        raise Unknown(
            "programs.called_function_of_controller",
            "the function {name}() is known to the controller only",
            name=name,
        )

    def invoke(self, name, arguments, keywords=()):
        """Runs a routine of this file; its value, None where it has none."""
        self.called = True
        if self.calls >= MAX_CALLS:
            raise Unknown(
                "programs.urscript.calls_itself", "{name} calls itself too deeply", name=name
            )
        self.tick(self.line, 1)
        parameters, blocks = self.routines[name]
        if len(arguments) > len(parameters) or keywords:
            raise Unknown(
                "programs.urscript.wrong_arguments",
                "{name}() does not take these arguments",
                name=name,
            )
        scope = {}
        self.calls += 1  # a default may call the routine itself
        try:
            for k, (parameter, default) in enumerate(parameters):
                with contextlib.suppress(Unknown):  # whoever uses it reports it
                    scope[parameter] = (
                        self.node(arguments[k]) if k < len(arguments) else self.evaluate(default)
                    )
            self.scopes.append(scope)
            self.returned = None
            try:
                self.block(blocks)
            finally:
                self.scopes.pop()
        finally:
            self.calls -= 1
        value, self.returned = self.returned, None
        return value

    def assign(self, match, line):
        where, name, index, text = match.groups()
        outer, inner = self.scopes[0], self.scopes[-1]
        scope = outer if where == "global" or (name in outer and name not in inner) else inner
        try:
            value = self.evaluate(text)
            if isinstance(value, list):
                self.tick(line, len(value) // ELEMENTS)
                value = list(value)
            if index:
                at, inside = self.evaluate(index[1:-1]), self.lookup(name)
                values = inside.components() if isinstance(inside, Pose) else inside
                values = list(values) if isinstance(values, list) else []
                self.tick(line, len(values) // ELEMENTS)
                if type(at) is not int or not 0 <= at < len(values):
                    raise Unknown(
                        "programs.no_element",
                        "{name} has no element {index}",
                        name=name,
                        index=index,
                    )
                values[at] = value
                value = pose_of(values) if isinstance(inside, Pose) else values
            scope[name] = value
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            for known in (inner, outer):
                known.pop(name, None)
            if name == "ref_frame":
                self.problem(
                    line,
                    "programs.urscript.ref_frame",
                    "ref_frame is not known: {reason}",
                    reason=unknown.fact,
                )
            elif MOVE.search(text):
                self.problem(
                    line,
                    "programs.motion_left_out",
                    "the motion is left out: {reason}",
                    reason=unknown.fact,
                )
                self.gap(line)

    def statement(self, line, text):
        if text in ("break", "continue", "halt"):
            return text
        if re.match(r"return\b", text):
            with contextlib.suppress(Unknown):
                self.returned = self.evaluate(text[6:])
            return "return"
        match = ASSIGN.match(text)
        if match:
            self.assign(match, line)
            return None
        try:
            tree = parse(text)
            if not isinstance(tree, ast.Call) or not isinstance(tree.func, ast.Name):
                raise Unknown("programs.urscript.statement", "the statement is not understood")
            name = tree.func.id
            if name in PARAMETERS:
                self.motion(line, name, tree)
            elif name == "set_tcp":
                self.set_tool(line, tree)
            elif name in self.routines:
                self.invoke(name, tree.args, tree.keywords)
            elif not HARMLESS.match(name):
                if name not in self.missing:
                    self.missing.add(name)
                    self.problem(
                        line,
                        "programs.urscript.unknown_call",
                        "{name}() is not known here; motions in it are left out",
                        name=name,
                    )
                self.gap(line)
        except Unknown as unknown:
            word = re.match(r"\w*", text).group(0) or text[:40]
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word,
                reason=unknown.fact,
            )
            self.gap(line)
        return None

    def set_tool(self, line, tree):
        try:
            pose = a_pose(self.node(tree.args[0]) if tree.args else None)
            self.tool = str(pose)
            self.program.tool_frames[self.tool] = pose.frame.copy()
            self.program.tool_frames[self.tool][:3, 3] *= 1000.0
        except Unknown as unknown:
            self.tool = f"as line {line} sets it"
            self.problem(
                line,
                "programs.urscript.tool",
                "the tool of set_tcp is not known: {reason}",
                reason=unknown.fact,
            )

    def motion(self, line, name, tree):
        names = PARAMETERS[name]
        given = dict(zip(names, tree.args))
        for keyword in tree.keywords:
            if keyword.arg in given or (keyword.arg not in names and keyword.arg != "pose"):
                raise Unknown(
                    "programs.urscript.argument",
                    "the argument {name} is not understood",
                    name=keyword.arg,
                )
            given[keyword.arg if keyword.arg in names else names[0]] = keyword.value
        targets = names[:2] if name == "movec" else names[:1]
        if len(tree.args) > len(names) or any(target not in given for target in targets):
            raise Unknown("programs.urscript.arguments", "its arguments are too many or too few")
        values = [self.node(given[target]) for target in targets]
        if name == "movec" and "mode" in given and self.node(given["mode"]) != 0:
            raise Unknown(
                "programs.urscript.mode_1",
                "mode 1 turns the tool with the arc; only mode 0 is supported",
            )
        if isinstance(values[0], list) and name != "movec":
            if len(values[0]) != 6:
                raise Unknown(
                    "programs.urscript.joints", "it has {count} joints", count=len(values[0])
                )
            for joint in values[0]:
                number(joint)
            if KINDS[name] != "PTP":
                raise Unknown("programs.joint_target", "its target is a joint position")
            self.here = None
            motion = Motion("PTP", None, line, self.file, tool=self.tool)
            motion.joints_deg = joint_angles(values[0], math.degrees(1.0))
            self.program.motions.append(motion)
            return
        frames = [self.in_base(a_pose(value)) for value in values]
        speed = None if KINDS[name] == "PTP" else self.speed(line, name, given, frames)
        zone = self.zone(line, given)
        for frame in frames:
            motion = Motion(KINDS[name], frame, line, self.file, speed, zone_mm=zone)
            motion.tool, motion.base, motion.aux = self.tool, self.base, frame is not frames[-1]
            self.program.motions.append(motion)
        self.here = frames[-1][:3, 3]

    def in_base(self, pose):
        """4 x 4 in mm in the frame all poses are given in."""
        inside = isinstance(pose, InReference)
        if self.inverse is None:
            reference = self.scopes[-1].get("ref_frame", self.scopes[0].get("ref_frame"))
            if isinstance(reference, Pose):
                self.inverse, self.base = reference.inverse().frame, f"ref_frame {reference}"
            else:
                self.inverse, self.base = False, IN_REFERENCE if inside else ""
        if inside != (self.base == IN_REFERENCE):
            InReference(pose.frame).components()
        frame = pose.frame.copy() if self.inverse is False else self.inverse @ pose.frame
        frame[:3, 3] *= 1000.0
        return frame

    def zone(self, line, given):
        """mm by the blend radius r, without it 0 (an exact stop); None: not known."""
        try:
            return max(0.0, 1000.0 * number(self.node(given["r"]))) if "r" in given else 0.0
        except Unknown as unknown:
            self.problem(
                line,
                "programs.urscript.blend_radius",
                "the blend radius is not known: {reason}",
                reason=unknown.fact,
            )
            return None

    def speed(self, line, name, given, frames):
        """mm/s by t (before v) or v; None: not known."""
        try:
            if name == "optimovel":
                raise Unknown(
                    "programs.urscript.optimovel", "optimovel takes a part of what the robot can"
                )
            time = number(self.node(given["t"])) if "t" in given else 0.0
            if time > 0 and self.here is None:
                raise Unknown(
                    "programs.urscript.time_from_unknown",
                    "t is given, and the position before is not known",
                )
            if time > 0:
                length = math.dist(self.here, frames[-1][:3, 3])
                return number(length / time) if length > 0 else None
            speed = number(self.node(given["v"])) if "v" in given else DEFAULT_SPEED
            if speed <= 0:
                raise Unknown("programs.urscript.speed_not_positive", "v is not positive")
            return number(1000.0 * speed)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.path_speed_unknown",
                "the path speed is not known: {reason}",
                reason=unknown.fact,
            )
            return None
