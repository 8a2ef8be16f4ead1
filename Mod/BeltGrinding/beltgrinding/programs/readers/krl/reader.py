"""Reads KUKA KRL: a module's .src with the .dat beside it.

Poses are those of $TOOL in $BASE; A, B, C turn about Z, Y', X'' (Rz(A) Ry(B) Rx(C)), as in KUKA's
System Software operating manuals. What only the controller can know is a Problem.
"""

import contextlib
import copy
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from ....base.stopping import check
from ...program import (
    LOOPED,
    MAX_COORDINATE,
    MAX_UNROLLED,
    SKIPPED,
    Fact,
    Motion,
    Program,
    ProgramError,
    Unknown,
    joint_angles,
    name_of,
    work_of,
)
from . import circles, data_lists
from .blocks import MOTION, OPENING, Routine, word_of
from .expression import FRAME, MAX_COMPONENTS, Reader, components_of, frame_of, number
from .turning import Turning
from .values import Values

MAX_MOTIONS = 1_000_000
MAX_CALLS = 20
MAX_NESTING = 60
MAX_NAME = 60  # characters of a frame's
FRAMES = ("$tool", "$base")
SETTINGS = ("$ori_type", "$circ_type", "$ipo_mode", "$ipo_frame")
MAX_SPEED = 1e6  # m/s; beyond, the file is damaged
ASSIGN = re.compile(
    r"^(?:(?:GLOBAL|DECL|CONST)\s+)*(?:(\w+)\s+)?([$\w.]+)\s*(?:(\[[^\]]*\])\s*)?=(?!=)(.*)$", re.I
)
FOR = re.compile(r"^FOR\s+(\w+)\s*=\s*(\S.*?)\sTO\s+(.+?)(?:\sSTEP\s+(.+))?$", re.IGNORECASE)
CALL = re.compile(r"^([A-Za-z_]\w*)\s*\((.*)\)$")
SPEED = re.compile(r"(?:\$VEL\.CP\s*=|SVEL_CP\s*\()\s*([^,)\s]+)", re.IGNORECASE)
SETS_SPEED = re.compile(r"\$VEL(?:\.CP)?\s*=|BAS\s*\(\s*#(?:CP_PARAMS|VEL_CP)\b", re.IGNORECASE)
APPROXIMATION = re.compile(r"\bC_(?:DIS|SPL|VEL|ORI|PTP)\b", re.IGNORECASE)
# Words that begin a statement without a motion and without a value that a path depends on.
QUIET = set(
    "decl int real bool char frame pos e3pos e6pos axis e3axis e6axis fdat ldat pdat struc enum "
    "global ext extp extfct extfctp signal ini import wait halt interrupt trigger continue brake "
    "resume pulse anin anout cwrite cread copen cclose endspline time_block const_vel defdat "
    "enddat channel sread swrite on confirm".split()
)
LABEL = re.compile(r"\w+\s*:(?!=)|[{}()\]]*$")
HARMLESS = {"bas", "msgquit", "ir_stopm", "varstate", "msgnotify"}


def read(path, values=None):
    """The Program of a .src file; ``values``: what a person gives, {NAME: number, truth value, or six of a
    frame}. Raises ProgramError when it cannot be read at all."""
    path = Path(path)
    interpreter = _Interpreter(name_of(path), values)
    interpreter.read_lists(path)
    try:
        interpreter.run(data_lists.statements(path))
    except RecursionError:
        raise ProgramError(
            "programs.krl.nested",
            "{file}: calls and blocks are nested too deeply",
            file=interpreter.file,
        ) from None
    return interpreter.program


class _Leave(Exception):
    """EXIT of a loop, or RETURN from a routine; the word says which."""


class _Interpreter:
    """Follows a program from top to bottom with the values it can know."""

    def __init__(self, name, given=None):
        self.program = Program("KUKA KRL", name)
        self.given = given or {}  # where neither the program nor a data list tells
        self.file = name
        self.values = Values()
        self.named = {}  # $tool, $base: the controller's own, by name
        self.in_words = {}  # of $TOOL and $BASE: the aggregate, its values' types, the words
        self.here = None  # components of the current pose, None: unknown
        self.speed = self.around = None  # around: before the spline block
        self.spline = False  # within a SPLINE block
        self.routines = {}
        self.calls = self.depth = 0
        self.rounds = 0  # units of work; below 0: what the files allow
        self.missing = set()
        self.held = False  # $IPO_MODE is #TCP
        self.turning = Turning(self.values)

    def problem(self, line, told, text=None, /, **arguments):
        self.program.problem(self.file, line, told, text, **arguments)

    def component(self, name, component):
        """The component's value; None where it, or the aggregate, is not known."""
        value = self.values.get((name, ()))
        return value.get(component) if isinstance(value, dict) else None

    def lookup(self, name, indices):
        if name == "$nullframe":
            return dict.fromkeys(FRAME, 0.0)
        if (name, indices) in self.values:
            return self.values[name, indices]
        head, _, component = name.rpartition(".")
        inner = self.values.get((head, ()))
        if isinstance(inner, dict) and component in inner:
            return inner[component]
        index = f"[{','.join(map(str, indices))}]" if indices else ""
        given = self.ask(f"{name}{index}".upper())
        if given is not None:
            return given
        raise Unknown(
            "programs.krl.no_value",
            "{name}{index} has no value that this file or its .dat gives",
            name=name.upper(),
            index=index,
        )

    def ask(self, name, kind=""):
        """What a person gives for a name; None: nothing."""
        value = self.given.get(name)
        self.program.asked.setdefault(name, kind)
        return dict(zip(FRAME, value)) if isinstance(value, tuple) else value

    def evaluate(self, text):
        reader = Reader(text, self.lookup)
        value = reader.expression()
        if reader.peek() is not None:
            raise Unknown(
                "programs.not_understood_there",
                "'{found}' is not understood there",
                found=reader.peek(),
            )
        return value

    def assign(self, match, line):
        _, name, index, text = match.groups()
        name = name.lower()
        if name in ("$ipo_mode", "$ipo_frame"):
            self.held = text.strip().lower() == "#tcp"
            return
        try:
            indices = ()
            if index and index.strip("[] "):
                indices = tuple(int(number(self.evaluate(i))) for i in index[1:-1].split(","))
        except Unknown as unknown:
            self.problem(
                line,
                "programs.krl.index",
                "the index of {name} is not known: {reason}",
                name=name.upper(),
                reason=unknown.fact,
            )
            return
        try:
            value = self.evaluate(text)
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.values.pop((name, indices), None)
            if name in ("$vel.cp", "$base", "$tool"):
                self.problem(
                    line,
                    "programs.unknown_because",
                    "{name} is not known: {reason}",
                    name=name.upper(),
                    reason=unknown.fact,
                )
                self.speed = None if name == "$vel.cp" else self.speed
            if name in FRAMES:
                self.named[name] = " ".join(text.split())[:MAX_NAME].upper()
            self.touch(name, line)
            return
        if isinstance(value, dict):
            value = copy.deepcopy(value)  # a component that is set later is this variable's only
        self.values[name, indices] = value
        self.touch(name, line)
        self.named.pop(name, None)
        head, _, component = name.rpartition(".")
        inner = self.values.get((head, ())) if head else None
        if isinstance(inner, dict) and (component in inner or len(inner) < MAX_COMPONENTS):
            inner[component] = value
        if name == "$vel.cp":
            self.set_speed(value, line)
        elif name == "$vel" and isinstance(value, dict) and "cp" in value:
            self.set_speed(value["cp"], line)

    def touch(self, name, line):
        """A component of $TOOL or $BASE is set: where only their name is known, they are another now."""
        head, _, component = name.rpartition(".")
        if head not in FRAMES:
            return
        inner, value = self.values.get((head, ())), self.values.get((name, ()))
        if not isinstance(inner, dict) or component not in inner or not isinstance(value, float):
            self.values.pop((head, ()), None)
            self.named[head] = f"{head} as line {line} sets it".upper()

    def set_speed(self, metres_per_second, line):
        if isinstance(metres_per_second, float) and 0 < metres_per_second < MAX_SPEED:
            self.speed = 1000.0 * metres_per_second
        else:
            self.problem(
                line,
                "programs.krl.speed_no_number",
                "the path speed is no sensible number; the last one stays",
            )

    def read_lists(self, path):
        """Takes the values of the data lists that a module sees, its own last."""
        shared, more = data_lists.others(path)
        if more:
            self.problem(
                1,
                "programs.krl.many_lists",
                "the folder has too many .dat files; some are not read",
            )
        origin = {}
        for one, rows in shared:
            told = len(self.program.problems)
            before = dict(self.values)
            self.read_data(rows, name_of(one))
            del self.program.problems[told:]  # those of other modules
            for key in [k for k, v in self.values.items() if before.get(k, v) != v]:
                self.problem(
                    1,
                    "programs.krl.defined_twice",
                    "{name} is not the same in {one} and {other}; neither is taken",
                    name=key[0].upper(),
                    one=origin.get(key, ""),
                    other=name_of(one),
                )
                self.values.pop(key)
            origin.update({k: name_of(one) for k in self.values if k not in origin})
        self.program.asked.clear()
        data = data_lists.own(path)
        if data is not None:
            self.read_data(data_lists.statements(data), name_of(data))

    def read_data(self, statements, name):
        own, self.file = self.file, name
        for line, text in statements:
            self.rounds -= LOOPED * work_of(text)
            match = ASSIGN.match(text)
            if match:
                self.assign(match, line)
        self.file = own

    def run(self, statements):
        body, name = [], None
        order = []
        for line, text in statements:
            self.rounds -= LOOPED * work_of(text)
            word = word_of(text)
            if word in ("def", "deffct") or text.lower().startswith("global def"):
                match = re.search(r"(\w+)\s*\(", text)
                name, body = (match.group(1).lower() if match else f"?{line}"), []
                self.routines[name] = body
                order.append(body)
            elif word in ("end", "endfct"):
                name = None
            elif name is not None:
                body.append((line, text))
            elif not order:  # an excerpt without its DEF
                name, body = "", [(line, text)]
                order.append(body)
        self.routines = {key: Routine(body) for key, body in self.routines.items()}
        if order:
            first = next((r for r in self.routines.values() if r.statements is order[0]), None)
            self.routine(first or Routine(order[0]))
        if name:
            self.problem(
                statements[-1][0],
                "programs.krl.no_end",
                "the routine has no END; the file may be cut off",
            )

    def routine(self, routine):
        try:
            self.block(routine, 0, len(routine.statements))
        except _Leave as leave:
            if leave.args[0] != "return":
                self.problem(
                    leave.args[1],
                    "programs.krl.exit",
                    "EXIT is in no loop; what follows it is left out",
                )

    def tick(self, line, work):
        check()
        self.rounds += work
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                self.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )

    def block(self, routine, at, end):
        """Runs a routine's statements from ``at`` to before ``end``."""
        while at < end:
            line, text = routine.statements[at]
            self.tick(line, work_of(text))
            word = word_of(text)
            if word not in OPENING:
                self.statement(line, text, word)
                at += 1
                continue
            last = routine.closing.get(at, end)
            if last >= end:
                self.problem(
                    line,
                    "programs.krl.no_block_end",
                    "{word} has no {end}",
                    word=word.upper(),
                    end=OPENING[word].upper(),
                )
                return
            if self.depth >= MAX_NESTING:
                raise ProgramError.at(
                    self.file, line, "programs.nested_blocks", "blocks are nested too deeply"
                )
            self.depth += 1
            try:
                self.structure(word, line, text, (routine, at + 1, last))
            finally:
                self.depth -= 1
            at = last + 1

    def structure(self, word, line, text, body):
        """``body``: the routine, the first statement in the block, the one that ends it."""
        if word == "for":
            self.loop(line, text, body)
        elif word == "if":
            self.branch(line, text, body)
        elif word == "loop":
            self.skipped(
                line,
                Fact("programs.endless", "an endless {word} is followed once", word="LOOP"),
                body,
            )
            self.within(body)
        else:
            self.skipped(
                line,
                Fact(
                    "programs.krl.at_run_time",
                    "{word} is decided at run time; its motions are left out",
                    word=word.upper(),
                ),
                body,
            )
            self.forget(body)

    def within(self, body):
        """Runs a loop's statements; False after EXIT."""
        try:
            self.block(*body)
        except _Leave as leave:
            if leave.args[0] != "exit":
                raise
            return False
        return True

    def skipped(self, line, message, body):
        routine, begin, end = body
        if routine.moves(begin, end):
            self.problem(line, message)
            if message.code != "programs.endless":
                self.gap(line)

    def gap(self, line):
        """What is left out: the path beyond must not be joined over it."""
        self.here = None
        self.program.gap(line, self.file)

    def forget(self, body):
        """What a block assigns that may or may not run is unknown afterwards."""
        routine, begin, end = body
        self.tick(routine.statements[begin - 1][0], routine.work(begin, end) // SKIPPED)
        for k in range(begin, end):
            line, text = routine.statements[k]
            match = ASSIGN.match(text)
            if match and match.group(2).lower() not in SETTINGS:
                self.values.forget(match.group(2).lower())
                if match.group(2).lower() in FRAMES:
                    self.named[match.group(2).lower()] = f"as line {line} may set it"
            if match and match.group(2).lower() in SETTINGS:
                self.problem(
                    line,
                    "programs.krl.setting_lost",
                    "whether {name} is set here is decided at run time; behind it the program is read as "
                    "if it were not set",
                    name=match.group(2).upper(),
                )
            if SETS_SPEED.match(text) and self.speed is not None:
                self.problem(
                    line,
                    "programs.krl.speed_lost",
                    "the path speed is not known after this; the default is used",
                )
                self.speed = None
            if not match and MOTION.match(text):
                self.here = None

    def branch(self, line, text, body):
        routine, begin, end = body
        split = routine.elses.get(begin - 1, end)
        condition = re.sub(r"(?i)^IF\b|\bTHEN\s*$", "", text)
        try:
            known = self.evaluate(condition)
            if not isinstance(known, bool):
                raise Unknown("programs.no_truth_value", "the condition is no truth value")
        except Unknown as unknown:
            self.skipped(
                line,
                Fact(
                    "programs.decided_at_run_time",
                    "{word} is decided at run time ({reason}); its motions are left out",
                    reason=unknown.fact,
                    word="IF",
                ),
                body,
            )
            self.forget(body)
            return
        if known:
            self.block(routine, begin, split)
        else:
            self.block(routine, split + 1, end)

    def loop(self, line, text, body):
        match = FOR.match(text)
        try:
            if not match:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            name = match.group(1).lower()
            first, last = (int(number(self.evaluate(match.group(k)))) for k in (2, 3))
            step = int(number(self.evaluate(match.group(4)))) if match.group(4) else 1
            if step == 0:
                raise Unknown("programs.step_is_zero", "its {word} is 0", word="STEP")
        except Unknown as unknown:
            self.skipped(
                line,
                Fact(
                    "programs.no_static_bounds",
                    "{word} has no static bounds ({reason}); its motions are left out",
                    reason=unknown.fact,
                    word="FOR",
                ),
                body,
            )
            self.forget(body)
            return
        for value in range(first, last + (1 if step > 0 else -1), step):
            self.tick(line, 1)
            self.values[name, ()] = float(value)
            if not self.within(body):
                break

    def statement(self, line, text, word):
        motion = MOTION.match(text)
        if motion:
            self.motion(line, motion.group(1).upper(), motion.group(2))
            return
        if word == "spline":
            self.around, self.spline = self.speed, True
            self.turning.block = text
            found = SPEED.search(text)
            if found:
                self.speed_text(found.group(1), line)
            return
        if word == "endspline":  # WITH holds within the block
            self.speed, self.spline = self.around, False
            self.turning.block = ""
            if self.program.motions:  # its own word rounds the block's last corner
                self.program.motions[-1].zone_mm = self.zone(text)
            return
        match = ASSIGN.match(text)
        if (
            match
            and word not in ("trigger", "wait", "interrupt", "global", "decl")
            or (match and word in ("global", "decl") and "=" in text and "when" not in text.lower())
        ):
            self.assign(match, line)
            return
        call = CALL.match(text)
        if call:
            self.call(line, call.group(1).lower(), call.group(2))
        elif word in ("return", "exit"):
            raise _Leave(word, line)
        elif word not in QUIET and not LABEL.match(text) and text[:40] not in self.missing:
            self.missing.add(text[:40])
            self.problem(
                line,
                "programs.ignored",
                "'{text}' is not understood; it is ignored",
                text=text[:40],
            )
            self.speed = None if word == "bas" else self.speed

    def speed_text(self, text, line):
        try:
            self.set_speed(self.evaluate(text), line)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.krl.speed_stays",
                "the path speed is not known: {reason}; the last one stays",
                reason=unknown.fact,
            )

    def call(self, line, name, arguments):
        if name == "bas":
            what, _, value = arguments.partition(",")
            if what.strip().lower() in ("#cp_params", "#ptp_params"):
                self.take_fdat()
            if what.strip().lower() in ("#cp_params", "#vel_cp"):
                self.speed_text(value, line)
                self.turning.take(self.values.get(("ldat_act", ())))
                distance = self.component("ldat_act", "apo_dist")
                if isinstance(distance, float):  # what BAS makes of an inline form's CONT
                    self.values["$apo.cdis", ()] = distance
            elif what.strip().lower() == "#initmov":
                self.turning.reset()
            elif what.strip().lower() in ("#tool", "#base"):
                self.set_frame(what.strip()[1:].lower(), value.strip())
        elif name in self.routines and not arguments.strip():
            if self.calls >= MAX_CALLS:
                self.problem(
                    line,
                    "programs.krl.calls_itself",
                    "{name} calls itself too deeply; its motions are left out",
                    name=name,
                )
                self.gap(line)
                return
            self.tick(line, 1)
            self.calls += 1
            self.routine(self.routines[name])
            self.calls -= 1
        elif name not in HARMLESS and name not in self.missing:
            self.missing.add(name)
            self.problem(
                line,
                "programs.krl.call_elsewhere",
                "{name}() is not in this file; motions in it are left out",
                name=name,
            )
            self.gap(line)
        elif name not in HARMLESS:
            self.gap(line)

    def set_frame(self, what, index):
        """BAS(#TOOL, n), BAS(#BASE, n): as $TOOL=TOOL_DATA[n]."""
        with contextlib.suppress(Unknown):
            index = f"{number(self.evaluate(index)):.0f}"
        self.take_frame(f"${what}", what, index)

    def take_frame(self, name, what, index):
        """$TOOL or $BASE (``name``) from TOOL_DATA or BASE_DATA (``what``: tool, base) number ``index``, a
        text; 0: $NULLFRAME."""
        self.values.pop((name, ()), None)
        self.named.pop(name, None)
        number_ = int(index) if re.fullmatch(r"\d{1,3}", index, re.ASCII) else None
        known = self.values.get((f"{what}_data", (number_,)))
        if number_ and not isinstance(known, dict):
            known = self.ask(f"{what}_data[{number_}]".upper(), "frame")
        if number_ == 0:
            self.values[name, ()] = dict.fromkeys(FRAME, 0.0)
        elif isinstance(known, dict):
            self.values[name, ()] = dict(known)
        else:
            self.named[name] = f"{what}_data[{index}]".upper()[:MAX_NAME]

    def take_fdat(self):
        """The frames of an inline form, FDAT_ACT, as BAS takes them. With the tool in the room (IPO_FRAME
        #TCP) that is one of BASE_DATA, and the part in the robot one of TOOL_DATA."""
        given = self.values.get(("fdat_act", ()))
        if not isinstance(given, dict):
            return
        numbers = {what: given.get(f"{what}_no") for what in ("tool", "base")}
        if not all(
            isinstance(n, float) and 0 <= n < 1000 and n == int(n) for n in numbers.values()
        ):
            return
        self.held = str(given.get("ipo_frame", "")).lower().lstrip("#") == "tcp"
        tool, base = ("base", "tool") if self.held else ("tool", "base")
        self.take_frame("$tool", tool, f"{numbers[tool]:.0f}")
        self.take_frame("$base", base, f"{numbers[base]:.0f}")

    def motion(self, line, kind, text, whole=None):
        """``whole``: the statement with what stands behind WITH."""
        whole = whole or text
        try:
            text, *options = re.split(r"(?i)\bWITH\b", text, maxsplit=1)
            own = SPEED.search(options[0]) if options else None
            if own:
                self.own_speed(line, kind, text, own.group(1), whole)
                return
            reader = Reader(text, self.lookup)
            targets = [reader.expression()]
            if "CIRC" in kind:
                reader.expect(",")
                targets.append(reader.expression())
            angle = circles.angle(reader) if "CIRC" in kind else None
            rest = [t for _, t in reader.tokens[reader.at :]]
            zone = math.inf if self.spline else self.zone(whole)
            turn = "" if "PTP" in kind else self.turning.of(whole, line, self.problem)
            start, first = self.here, len(self.program.motions)
            for aux, target in [(True, t) for t in targets[:-1]] + [(False, targets[-1])]:
                self.target(line, kind, target, aux, [t.lower() for t in rest])
                self.program.motions[-1].turn = turn
                self.program.motions[-1].zone_mm = zone
            if angle is not None:
                self.by_angle(line, first, start, angle)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=kind,
                reason=unknown.fact,
            )
            self.gap(line)

    def by_angle(self, line, first, start, angle):
        """An arc, the motions from number ``first`` on, that ends behind an angle (CA) instead of at its
        second point."""
        through, end = self.program.motions[first:]
        del self.program.motions[first:]
        if start is None or any(name not in start for name in FRAME):
            raise Unknown(
                "programs.krl.circle_start",
                "where a circle by an angle (CA) ends depends on the pose before, which is not known",
            )
        begin = frame_of(start)
        found = circles.arcs(begin, through.pose, end.pose, angle, end.turn)
        if np.abs(begin[:3, :3] - end.pose[:3, :3]).max() > 1e-3 and "hold" not in end.turn:
            self.problem(
                line,
                "programs.krl.circle_turn",
                "the circle ends at its angle (CA) with the orientation of its second point, as here; "
                "a controller that is set to extrapolate it turns further",
            )
        for middle, last in found:
            self.program.motions.append(replace(through, pose=middle))
            self.program.motions.append(replace(end, pose=last, zone_mm=math.inf))
        self.program.motions[-1].zone_mm = end.zone_mm
        self.here = components_of(found[-1][1])

    def own_speed(self, line, kind, text, speed, whole):
        """A motion with a speed of its own."""
        before = self.speed
        self.speed_text(speed, line)
        self.motion(line, kind, text, whole)
        self.speed = before

    def target(self, line, kind, target, aux, rest):
        if not isinstance(target, dict):
            raise Unknown("programs.krl.no_pose", "its target is no pose")
        simple = {"SPTP": "PTP", "SLIN": "LIN", "SCIRC": "CIRC"}.get(
            kind.replace("_REL", ""), kind.replace("_REL", "")
        )
        motion = Motion(simple, None, line, self.file, aux=aux)
        motion.tool, motion.base = self.frames_now()
        if any(f"a{k}" in target for k in range(1, 7)):
            if simple != "PTP":
                raise Unknown("programs.joint_target", "its target is a joint position")
            self.here = None
            motion.joints_deg = joint_angles([target.get(f"a{k}") for k in range(1, 7)])
            self.program.motions.append(motion)
            return
        given = {name: number(target[name]) for name in FRAME if name in target}
        if not given:
            raise Unknown("programs.krl.no_component", "its target names no component of a pose")
        components = given if kind.endswith("_REL") else {**(self.here or {}), **given}
        if kind.endswith("_REL"):
            components = self.relative(given, rest)
        elif aux and self.here is None:
            components = {**dict.fromkeys("abc", 0.0), **given}
        missing = [name.upper() for name in FRAME if name not in components]
        if missing:
            raise Unknown(
                "programs.krl.not_given",
                "{names} is not given, and the pose before is not known",
                names=", ".join(missing),
            )
        motion.pose = frame_of(components)
        if np.abs(motion.pose[:3, 3]).max() > MAX_COORDINATE:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        motion.speed_mm_s = None if simple == "PTP" else self.speed
        if not aux:
            self.here = components
        self.program.motions.append(motion)

    def zone(self, text):
        """mm by the approximation in a statement: without one the robot stops; C_DIS and C_SPL
        begin at $APO.CDIS; the others (C_VEL, C_ORI, C_PTP) name no length: not known.
        """
        words = {word.lower() for word in APPROXIMATION.findall(text)}
        if not words:
            return 0.0
        if words & {"c_dis", "c_spl"} and "$apo" not in text.lower():  # WITH $APO: not followed
            distance = self.values.get(("$apo.cdis", ()))
            if distance is None:
                distance = self.component("$apo", "cdis")
            known = isinstance(distance, float) and math.isfinite(distance)
            return max(0.0, distance) if known else None
        return None

    def relative(self, given, rest):
        if self.here is None:
            raise Unknown(
                "programs.krl.relative_to_unknown", "it is relative to a pose that is not known"
            )
        if "#tool" in rest:
            step = {**dict.fromkeys(FRAME, 0.0), **given}
            return components_of(frame_of(self.here) @ frame_of(step))
        return {name: self.here[name] + given.get(name, 0.0) for name in FRAME}

    def components_in_words(self, name, value):
        """The numbers of an aggregate; most motions are in the frame of the one before."""
        kinds = [*map(type, value.values())]  # TRUE is 1.0
        last = self.in_words.get(name)
        if last is None or last[:2] != (value, kinds):
            told = " ".join(
                f"{k.upper()} {v:.9g}" for k, v in value.items() if isinstance(v, float)
            )
            last = self.in_words[name] = dict(value), kinds, told
        return last[2]

    def frames_now(self):
        """The words of $TOOL and $BASE; what they are is kept in the program."""
        program, words = self.program, []
        for name, kept in (("$tool", program.tool_frames), ("$base", program.base_frames)):
            value = self.values.get((name, ()))
            if not isinstance(value, dict):
                told = self.named.get(name, "")
            else:
                told = self.components_in_words(name, value)
            if self.held:  # $IPO_MODE is #TCP: the part is on the flange
                side = "fixed in the room" if name == "$tool" else "held by the robot"
                told = f"{told} {side}".strip()
            if isinstance(value, dict) and told not in kept:
                if all(isinstance(value.get(k), float) for k in FRAME):
                    kept[told] = frame_of({k: value[k] for k in FRAME})
            words.append(told)
        if self.held:
            program.held.add(words[1])
        return words
