"""What a RAPID program knows while it is followed: its data, where the robot is, its motions."""

import contextlib
import functools
import math
import re

import numpy as np

from ....base.frames import from_quaternions
from ...program import Fact, Motion, Program, Unknown, joint_angles, name_of, shortened
from . import data
from .data import PREDEFINED, inverse, number, pose_of, product
from .expression import Reader, arguments, tokens

TOOL = Fact("programs.rapid.tool", "tool")
WORK_OBJECT = Fact("programs.rapid.work_object", "work object")
NO_VALUE = Fact("programs.rapid.no_value", "this file gives it no value")
ASSIGNED = Fact("programs.assigned_at_run_time", "it is assigned at run time")
OF_TARGETS = ("offs", "reltool")  # functions whose first argument is a target
MAX_TEXT = 200  # characters of a reason
MAX_RESOLVING = 10  # constants defined by constants
NAME = re.compile(
    r"(?:(?P<search>search)|move|(?P<trigg>trigg)|(?P<arc>arc)|paint|(?P<disp>disp))"
    r"(?P<kind>absj|j|l|c)(?:[1-9])?(?:do|ao|go|sync|start|end|(?P<ios>ios))?$"
)
KINDS = {"absj": "PTP", "j": "PTP", "l": "LIN", "c": "CIRC"}


@functools.lru_cache(maxsize=4096)
def spec_of(word):
    """(kind, joint, search, arguments before the target, arguments from speed to tool) of a motion
    instruction in lower case, None for any other."""
    match = NAME.match(word)
    if not match:
        return None
    to_tool = 3 if match["trigg"] and not match["ios"] or match["disp"] else 2
    to_tool = 4 if match["arc"] else 1 if match["search"] else to_tool
    before = 2 if match["search"] else 0
    kind = match["kind"]
    return KINDS[kind], kind == "absj", bool(match["search"]), before, to_tool


SCALARS = ("num", "dnum", "bool", "string")  # of which no frame in words changes when they do


class State:
    """Data by name: [type, value (None: not known), line and text of a value not asked for yet].

    ``copy(value, line)`` is what ``Control`` adds.
    """

    def __init__(self):
        self.globals = {}
        self.locals = None  # of the running routine
        self.records = dict(data.RECORDS)
        self.components = {}  # {type: {component: (place, type)}}, of those asked for
        self.resolving = 0
        self.constants = set()
        self.reasons = {}  # why a value is not known
        self.texts = {}  # frames in words; cleared when data changes
        self.given = {}  # what a person says: {NAME: number, truth value or six of a frame}
        self.points = set()  # names of targets that are not declared, as far as that is seen
        self.wanted = (
            None  # type of what a motion takes while it is looked at; None: nobody is asked
        )

    def value(self, row):
        """The value of an expression's tokens. Raises Unknown."""
        if len(row) == 1 and row[0][0] == "value":
            return row[0][1]
        return Reader(row, self).whole()

    def function(self, name, positional, optional):
        """The value of a program's function; None where there is none of that name."""
        return None

    def entry(self, name):
        if self.locals is not None and name in self.locals:
            return self.locals[name]
        return self.globals.get(name)

    def variable(self, written):
        """(value, type) of data. Raises Unknown."""
        name = written.lower()
        entry = self.entry(name)
        if entry is None and name in PREDEFINED:
            kind, value = PREDEFINED[name]
            return value, kind
        if entry is None:
            told = self.ask(name, "robtarget" if name in self.points else self.wanted)
            if told is not None:
                return told
            raise Unknown(
                "programs.rapid.not_declared", "{name} is not declared in this file", name=written
            )
        if len(entry) == 3:
            self.resolve(entry, name)
        if entry[1] is None:
            told = self.ask(name, entry[0])
            if told is not None:
                return told
            fact = Fact(
                "programs.not_known_since",
                "{name} is not known ({reason})",
                name=written,
                reason=self.reasons.get(name, NO_VALUE),
            )
            raise Unknown(shortened(fact, MAX_TEXT))
        return entry[1], entry[0]

    def ask(self, name, kind):
        """(value, type) that a person gives for data; None: nothing, or nobody is asked."""
        if self.wanted is None or kind not in data.GIVEN:
            return None
        shape = data.GIVEN[kind]
        self.program.asked.setdefault(name.upper(), shape)
        value = self.given.get(name.upper())
        if value is None or isinstance(value, tuple) != (shape == "frame"):
            return None
        if isinstance(value, bool) != (shape == "truth"):
            return None
        return data.from_person(kind, value), kind

    @contextlib.contextmanager
    def asking(self, kind):
        """What is not known meanwhile is asked for: a motion needs it. ``kind``: of data not declared."""
        before, self.wanted = self.wanted, kind
        try:
            yield
        finally:
            self.wanted = before

    def resolve(self, entry, name):
        if self.resolving >= MAX_RESOLVING:
            raise Unknown(
                "programs.rapid.too_many_constants",
                "{name} is defined by too many constants",
                name=name,
            )
        line, text = entry.pop()
        self.resolving += 1
        try:
            entry[1] = self.copy(self.value(tokens(text)), line)
        except Unknown as unknown:
            self.reasons[name] = unknown.fact
        finally:
            self.resolving -= 1

    def component(self, kind, name):
        """(index, type) of a record's component. Raises Unknown."""
        if kind not in self.components:
            names = self.records.get(kind, {})
            self.components[kind] = {one: (k, names[one]) for k, one in enumerate(names)}
        names = self.components[kind]
        if str(name).lower() not in names:
            raise Unknown(
                "programs.rapid.no_component_of_type",
                "{kind} has no component {name}",
                kind=kind,
                name=name,
            )
        return names[name.lower()]

    def store(self, name, value):
        entry = self.entry(name)
        if entry is None:
            entry = self.globals[name] = [PREDEFINED.get(name, ("",))[0], None]
        entry[1:] = [value]
        if entry[0] not in SCALARS:
            self.texts.clear()

    def forget(self, name, why=ASSIGNED):
        """Whoever uses the data from here on reports ``why``."""
        entry = self.entry(name)
        if name in self.constants and entry is self.globals.get(name):
            return
        self.reasons[name] = why
        if entry is not None:
            entry[1:] = [None]
            if entry[0] not in SCALARS:
                self.texts.clear()
        elif name in PREDEFINED and name.startswith("reg"):
            self.globals[name] = ["num", None]


class MotionRunner(State):
    """Collects the motions of a program."""

    def __init__(self, path, given=None):
        super().__init__()
        self.given = given or {}
        self.file = name_of(path)
        self.program = Program("ABB RAPID", self.file)
        self.poses = []  # (motion, position, quaternion), made frames all at once
        self.said = set()
        self.override, self.most = 1.0, math.inf  # VelSet: factor, mm/s
        self.displacement = None  # PDispSet; False: known to the controller only
        self.here = None  # target, tool, work object; None: not known
        self.frames = {1: {}, 3: {}}  # of tools and work objects in words: position, quaternion
        self.written = {}  # names of tools and work objects as the program writes them

    def problem(self, line, told, text=None, /, once=None, **arguments):
        """Says something once, however often a loop comes by."""
        fact = told if text is None else Fact(told, text, **arguments)
        key = once or (line, fact)
        if key not in self.said:
            self.said.add(key)
            self.program.problem(self.file, line, fact)

    def forget_position(self):
        self.here = None

    def gap(self, line):
        """The path beyond must not be joined over the gap as if nothing were missing."""
        self.forget_position()
        self.program.gap(line, self.file, again=False)

    def finish(self):
        """The Program with all poses."""
        if self.poses:
            positions, quaternions = (np.array([row[k] for row in self.poses]) for k in (1, 2))
            frames = from_quaternions(positions, quaternions)
            for (motion, _, _), frame in zip(self.poses, frames):
                motion.pose = frame
        for at, kept in ((1, self.program.tool_frames), (3, self.program.base_frames)):
            for words, (position, quaternion) in self.frames[at].items():
                kept[words] = from_quaternions(np.array([position]), np.array([quaternion]))[0]
        return self.program

    def motion(self, line, text, spec):
        kind, joint, search, before, to_tool = spec
        try:
            row, options = arguments(tokens(text)[1:])
            count = 2 if kind == "CIRC" else 1
            speed_at = before + count
            if len(row) <= speed_at + to_tool:
                raise Unknown("programs.rapid.few_arguments", "it has too few arguments")
            tool, wobj = self.frames_of(line, row[speed_at + to_tool], options.get("wobj"))
            targets = [self.target(r, joint) for r in row[before : before + count]]
            if joint:
                if not data.is_joints(targets[0]):
                    raise Unknown("programs.rapid.no_joint_target", "its target is no joint target")
                self.speed(line, kind, row[speed_at], options, None)
                self.forget_position()
                motion = Motion(kind, None, line, self.file)
                motion.joints_deg = joint_angles(targets[0][0])
                self.add(motion, tool, wobj)
                return
            programmed = [pose_of(target) for target in targets]
            poses = [self.displaced(pose) for pose in programmed]
            length = None
            if kind == "LIN" and self.here is not None and self.here[1:] == (tool, wobj):
                length = math.dist(self.here[0][0], programmed[0][0])
            speed = self.speed(line, kind, row[speed_at], options, length)
            zone = 0.0 if search else self.zone(line, row[speed_at + to_tool - 1], options)
            for k, pose in enumerate(poses):
                motion = Motion(kind, None, line, self.file, speed, aux=k < count - 1)
                motion.zone_mm = zone
                self.add(motion, tool, wobj)
                self.poses.append((motion, *pose))
            self.here = ([*programmed[-1], *targets[-1][2:]], tool, wobj)
            if search:
                self.found(line, row[1], options)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=text.split()[0],
                reason=unknown.fact,
            )
            self.gap(line)

    def target(self, row, joint):
        """The value of a target's tokens. Raises Unknown."""
        if joint:
            return self.value(row)
        with self.asking("robtarget" if len(row) == 1 else "num"):
            # Offs(p, x, y, z): the first is a target, where it is not declared, the others are numbers.
            if len(row) > 3 and (row[1][1], row[3][1]) == ("(", ",") and row[2][0] == "name":
                if str(row[0][1]).lower() in OF_TARGETS:
                    self.points.add(row[2][1].lower())
            return self.value(row)

    def add(self, motion, tool, wobj):
        motion.tool, motion.base = self.described(tool, 1), self.described(wobj, 3)
        self.program.motions.append(motion)

    def found(self, line, point, options):
        """A search writes where it found something, and may stop there."""
        if len(point) == 1:
            self.forget(str(point[0][1]).lower())
        if options.keys() & {"stop", "pstop", "sstop"}:
            self.problem(
                line,
                "programs.rapid.search",
                "where the search stops is known at run time; its target is taken",
            )
            self.forget_position()

    def displaced(self, pose):
        if self.displacement is False:
            raise Unknown(
                "programs.rapid.displacement",
                "the program displacement is known to the controller only",
            )
        if self.displacement is None:
            return pose
        return pose_of(product(self.displacement, pose))

    def is_vmax(self, row):
        """Whether a speed is the robot's own, and nobody says which."""
        if len(row) != 1 or str(row[0][1]).lower() != "vmax" or self.entry("vmax") is not None:
            return False
        with self.asking("speeddata"):
            return self.ask("vmax", "speeddata") is None

    def speed(self, line, kind, row, options, length):
        """mm/s of a motion; None: not known here."""
        try:
            if options.get("t"):
                seconds = number(self.value(options["t"]))
                if length and seconds > 0:
                    return number(length / seconds)
                raise Unknown(
                    "programs.rapid.length_unknown",
                    "the length of the way that takes the time \\T is not known",
                )
            if options.get("v"):
                speed = number(self.value(options["v"]))
            elif self.is_vmax(row):
                if kind != "PTP":
                    self.problem(
                        line,
                        "programs.rapid.vmax",
                        "vmax is the robot's own; the default speed is used",
                        once="vmax",
                    )
                return None
            else:
                with self.asking("speeddata" if len(row) == 1 else "num"):
                    value = self.value(row)
                if not isinstance(value, list) or len(value) != 4:
                    raise Unknown("programs.rapid.no_speeddata", "it is no speeddata")
                speed = number(value[0])
            speed = min(speed * self.override, self.most)
            if speed > 0:
                return speed
            raise Unknown("programs.not_positive", "it is not positive")
        except Unknown as unknown:
            if kind != "PTP":
                what = Fact(
                    "programs.rapid.speed_unknown",
                    "the speed is not known: {reason}; the default speed is used",
                    reason=unknown.fact,
                )
                self.problem(line, what, once=what)
            return None

    def zone(self, line, row, options):
        """mm of the zone around the target within which the corner is rounded; 0: stop point (fine,
        \\Inpos); None: not known here."""
        try:
            if "inpos" in options:
                return 0.0
            with self.asking("zonedata" if len(row) == 1 else "num"):
                if len(row) == 1 and row[0][0] == "name":
                    value = self.variable(row[0][1])[0]
                else:
                    value = self.value(row)
            if not isinstance(value, list) or len(value) != 7 or not isinstance(value[0], bool):
                raise Unknown("programs.rapid.no_zonedata", "it is no zonedata")
            if value[0]:
                return 0.0
            size = number(self.value(options["z"])) if options.get("z") else number(value[1])
            return max(0.0, size)
        except Unknown as unknown:
            what = Fact(
                "programs.rapid.zone_unknown",
                "the zone is not known: {reason}",
                reason=unknown.fact,
            )
            self.problem(line, what, once=what)
            return None

    def frames_of(self, line, tool_row, wobj_row):
        """Names of tool and work object, after a look whether they go together."""
        names = []
        for row, what in ((tool_row, TOOL), (wobj_row or (("name", "wobj0"),), WORK_OBJECT)):
            if len(row) != 1 or row[0][0] != "name":
                raise Unknown(
                    "programs.rapid.not_by_name", "its {what} is not given by a name", what=what
                )
            names.append(row[0][1].lower())
            self.written.setdefault(names[-1], row[0][1])
        if (key := tuple(names)) not in self.said:
            self.said.add(key)
            holds = []
            for name, kind in zip(names, ("tooldata", "wobjdata")):
                try:
                    holds.append(self.frame_data(self.written[name], kind)[0])
                except Unknown as unknown:
                    self.problem(
                        line,
                        "programs.rapid.kept_as_programmed",
                        "{reason}; the poses are kept as programmed",
                        reason=unknown.fact,
                        once=name,
                    )
            if len(holds) == 2 and holds[0] is holds[1]:
                fact = (
                    Fact(
                        "programs.rapid.both_held",
                        "{tool} and {wobj}: both are held by the robot (robhold)",
                        tool=names[0],
                        wobj=names[1],
                    )
                    if holds[0]
                    else Fact(
                        "programs.rapid.neither_held",
                        "{tool} and {wobj}: neither is held by the robot (robhold)",
                        tool=names[0],
                        wobj=names[1],
                    )
                )
                self.problem(line, fact)
        return key

    def frame_data(self, name, kind):
        value, found = self.variable(name)
        if found != kind or len(value) < 3 or not isinstance(value[0], bool):
            raise Unknown("programs.rapid.wrong_type", "{name} is no {kind}", name=name, kind=kind)
        return value

    def described(self, name, at):
        """A tool (at 1) or a work object (at 3) in words."""
        if (name, at) not in self.texts:
            text = self.written.get(name, name)
            try:
                value = self.frame_data(name, "tooldata" if at == 1 else "wobjdata")
                pose = pose_of(value[at])
                if at == 3:
                    pose = pose_of(product(pose, pose_of(value[4])))
                text = f"{text} {data.components(pose)}"
                if value[0] == (at == 3):
                    text += " held by the robot" if at == 3 else " fixed in the room"
                if (
                    at == 1 or value[1] and not value[2]
                ):  # one that a mechanical unit moves is nowhere
                    self.frames[at][text] = pose
                if at == 3 and value[0]:
                    self.program.held.add(text)
            except (Unknown, IndexError):
                pass
            self.texts[name, at] = text
        return self.texts[name, at]

    def position(self, options):
        """The robtarget CRobT gives: the last one, in another tool or work object if asked for."""
        if self.here is None:
            raise Unknown("programs.rapid.place_unknown", "where the robot is then is not known")
        target, tool, wobj = self.here
        names = []
        for key, own in (("tool", tool), ("wobj", wobj)):
            row = options.get(key)
            names.append(row[0][1].lower() if row and row[0][0] == "name" else own)
        if names == [tool, wobj]:
            return target
        old, new = self.flange(tool, wobj), self.flange(*names)
        if old[2] or new[2]:
            raise Unknown(
                "programs.rapid.crobt",
                "CRobT in another tool or work object than the part's in the robot",
            )
        flange = product(product(old[1], pose_of(target)), inverse(old[0]))
        return [*product(product(inverse(new[1]), flange), new[0]), *target[2:]]

    def flange(self, tool, wobj):
        held, work = self.frame_data(tool, "tooldata"), self.frame_data(wobj, "wobjdata")
        if len(work) != 5 or not work[1]:
            raise Unknown(
                "programs.rapid.mechanical_unit", "{name} is moved by a mechanical unit", name=wobj
            )
        room = product(pose_of(work[3]), pose_of(work[4]))
        return pose_of(held[1]), room, work[0] or not held[0]

    def setting(self, line, word, text):
        """VelSet percent, mm/s; PDispSet pose; PDispOn; PDispOff."""
        try:
            row = arguments(tokens(text)[1:])[0]
            if word == "velset":
                percent, most = (number(self.value(r)) for r in row)
                self.override, self.most = percent / 100.0, most
            elif word == "pdispset":
                self.displacement = pose_of(self.value(row[0]))
            else:
                self.displacement = None if word == "pdispoff" else False
        except (Unknown, ValueError, IndexError) as error:
            self.displacement = False if word == "pdispset" else self.displacement
            self.problem(
                line,
                "programs.unknown_because",
                "{name} is not known: {reason}",
                name=text.split()[0],
                reason=getattr(error, "fact", str(error)),
            )
