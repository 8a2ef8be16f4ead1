"""The motions of a RAPID program: their targets, speeds, zones and forces."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ....base.kinds import Json
from ....base.frames import from_quaternions
from ... import force_device
from ...program import Fact, Motion, Program, Reason, Unknown, joint_angles
from ..core.values import Evaluated
from . import data
from .data import number, pose_of, product
from .expression import Handed, arguments, name_of as named, one_word
from .frames import Frames
from .state import NO_VALUE

# Optional arguments of motions that do not move their targets, or are followed.
OPTIONS = frozenset(
    "conc id v t z inpos wobj corr tload noeoffs stop pstop sstop sup flanks posflank negflank highlevel "
    "lowlevel start seamname weave track advance locked leader dist gunpos time dopt do "
    "t1 t2 t3 t4 t5 t6 t7 t8 triggdata1 triggdata2 triggdata3 all off".split()
)
NAME = re.compile(
    r"(?:(?P<search>search)|move|(?P<trigg>trigg)|(?P<arc>arc)|paint|(?P<disp>disp)|(?P<force>fcpress)1?|(?P<fc>fcspeed))"
    r"(?P<kind>absj|j|l|c|(?=end))(?:[1-9])?(?:do|ao|go|sync|(?P<start>start)|(?P<end>end)|(?P<ios>ios))?$"
)
# Of the manual; what begins and ends as these do is read as well.
MOVES = """
    MoveJ MoveL MoveC MoveAbsJ MoveJDO MoveLDO MoveCDO MoveJAO MoveLAO MoveCAO MoveJGO MoveLGO MoveCGO MoveJSync
    MoveLSync MoveCSync TriggJ TriggL TriggC TriggJIOs TriggLIOs SearchL SearchC ArcLStart ArcL ArcLEnd ArcCStart
    ArcC ArcCEnd PaintL PaintC DispL DispC FCPress1LStart FCPressL FCPressC FCPressEnd
""".split()
PRESSING = ("fx", "fy", "fz")  # of FCPress1LStart
KINDS = {"absj": "PTP", "j": "PTP", "l": "LIN", "c": "CIRC", "": "LIN"}


ROBTARGET = 4  # components: place, turn, configuration, external axes
NO_AXIS = 9e9  # of an external axis that is not there


class Spec(NamedTuple):
    """How a motion instruction is written, as ``spec_of`` says."""

    kind: str
    joint: bool
    search: bool
    before: int
    to_tool: int
    force: bool | None


@functools.lru_cache(maxsize=4096)
def spec_of(word: str) -> Spec | None:
    """The Spec of a motion instruction in lower case: ``before``: arguments before the target; ``to_tool``: from
    speed to tool; ``force``: whether the force in N stands behind the speed, None: no pressing at all. None for
    any other instruction."""
    match = NAME.match(word)
    if not match:
        return None
    to_tool = 3 if match["trigg"] and not match["ios"] or match["disp"] else 2
    to_tool = 4 if match["arc"] else 1 if match["search"] else to_tool
    before = 2 if match["search"] else 0
    kind = match["kind"]
    force = None
    if match["force"]:  # the force of the start is that at which contact is found
        to_tool, force = (1 if match["end"] else 3), not (match["start"] or match["end"])
    return Spec(KINDS[kind], kind == "absj", bool(match["search"]), before, to_tool, force)


class MotionRunner(Frames):
    """Collects the motions of a program."""

    reached: Callable[[int], None]

    def __init__(self, path: Path | str, given: Json | None = None) -> None:
        super().__init__(path, given)
        # (motion, position, quaternion), made frames all at once
        self.poses: list[tuple[Motion, list[float], list[float]]] = []
        self.override: float | None = 1.0  # VelSet; None: not known
        self.most = math.inf  # mm/s, by VelSet
        self.displacement: Any = None  # PDispSet; False: known to the controller only

    def finish(self) -> Program:
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

    def motion(self, line: int, text: str, spec: Spec) -> None:
        self.reached(line)
        kind, joint, search, before, to_tool, force = spec
        try:
            row, options = arguments(text)
            options = {k: v for k, v in options.items() if not self.is_left_away(v)}
            count = 2 if kind == "CIRC" else 1
            speed_at = before + count
            if len(row) <= speed_at + to_tool:
                raise Unknown("programs.rapid.few_arguments", "it has too few arguments")
            odd = options.keys() - OPTIONS
            if odd and force is None:
                raise Unknown("programs.rapid.option", "\\{name} is not known here", name=min(odd))
            tool, wobj = self.frames_of(line, row[speed_at + to_tool], options.get("wobj"))
            targets = [self.target(r, joint) for r in row[before : before + count]]
            if joint:
                if not data.is_joints(targets[0]):
                    raise Unknown("programs.rapid.no_joint_target", "its target is no joint target")
                self.speed(line, kind, row[speed_at], options, None)
                self.forget_position()
                motion = Motion(kind, None, line, self.file)
                motion.joints_deg = joint_angles(targets[0][0])
                motion.external = _external(targets[0][1])
                self.add(motion, tool, wobj)
                return
            programmed = [pose_of(target) for target in targets]
            poses = [self.displaced(pose) for pose in programmed]
            length = None
            if kind == "LIN" and self.here is not None and self.here[1:] == (tool, wobj):
                length = math.dist(self.here[0][0], programmed[0][0])
            speed = self.speed(line, kind, row[speed_at], options, length)
            zone: float | None = 0.0
            if not search and to_tool > 1:
                zone = self.zone(line, row[speed_at + to_tool - 1], options)
            pressed = number(row[speed_at + 1](self)) if force else None
            if force is False and getattr(force_device.in_use(), "kind", "") == "controller":
                along = [number(options[name](self)) for name in PRESSING if options.get(name)]
                pressed = math.hypot(*along)
            for k, pose in enumerate(poses):
                motion = Motion(kind, None, line, self.file, speed, aux=k < count - 1)
                motion.zone_mm, motion.force_N = zone, pressed
                if len(targets[k]) == ROBTARGET:
                    motion.external = _external(targets[k][3])
                self.add(motion, tool, wobj)
                self.poses.append((motion, pose[0], pose[1]))
            stood, self.here = self.here, ([*programmed[-1], *targets[-1][2:]], tool, wobj)
            self.changes += self.asked and self.here != stood
            if search:
                self.found(line, row[1], options)
        except Unknown as unknown:
            self.program.need(unknown)
            self.lose_functions({word.lower() for word in re.findall(r"\w+", text)})
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=text.split()[0],
                reason=unknown.fact,
            )
            self.gap(line)

    def is_left_away(self, argument: object) -> bool:
        """Whether an optional argument is one that hangs on another, which is not given. Raises Unknown."""
        return isinstance(argument, Handed) and not self.is_given(argument.place)

    def target(self, argument: Evaluated, joint: bool) -> Any:
        """The value of a target. Raises Unknown."""
        if joint:
            return argument(self)
        with self.asking("robtarget" if one_word(argument) else "num"):
            return argument(self)

    def add(self, motion: Motion, tool: str, wobj: str) -> None:
        motion.tool, motion.base = self.described(tool, 1), self.described(wobj, 3)
        self.program.motions.append(motion)

    def found(self, line: int, point: object, options: Mapping[str, Any]) -> None:
        """A search writes where it found something, and may stop there."""
        self.touched([point])
        if options.keys() & {"stop", "pstop", "sstop"}:
            self.problem(
                line,
                "programs.rapid.search",
                "where the search stops is known at run time; its target is taken",
            )
            self.forget_position()

    def displaced(self, pose: data.Pose) -> data.Pose:
        if self.displacement is False:
            raise Unknown(
                "programs.rapid.displacement",
                "the program displacement is known to the controller only",
            )
        if self.displacement is None:
            return pose
        return pose_of(product(self.displacement, pose))

    def is_vmax(self, argument: object) -> bool:
        """Whether a speed is the robot's own, and nobody says which."""
        if named(argument).lower() != "vmax" or self.entry("vmax") is not None:
            return False
        try:
            self.from_person("vmax", "speeddata", Reason(NO_VALUE))
            return False
        except Unknown as unknown:
            self.program.need(unknown)
            return True

    def speed(
        self, line: int, kind: str, row: Any, options: Mapping[str, Any], length: float | None
    ) -> float | None:
        """mm/s of a motion; None: not known here."""
        try:
            if options.get("t"):
                seconds = number(options["t"](self))
                if length and seconds > 0:
                    return number(length / seconds)
                raise Unknown(
                    "programs.rapid.length_unknown",
                    "the length of the way that takes the time \\T is not known",
                )
            if options.get("v"):
                speed = number(options["v"](self))
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
                with self.asking("speeddata" if one_word(row) else "num"):
                    value = row(self)
                if not isinstance(value, list) or len(value) != 4:
                    raise Unknown("programs.rapid.no_speeddata", "it is no speeddata")
                speed = number(value[0])
            if self.override is None:
                raise Unknown(
                    "programs.rapid.velset", "how VelSet changes it is known at run time only"
                )
            speed = min(speed * self.override, self.most)
            if speed > 0:
                return speed
            raise Unknown("programs.not_positive", "it is not positive")
        except Unknown as unknown:
            if kind != "PTP":
                self.program.need(unknown)
                what = Fact(
                    "programs.rapid.speed_unknown",
                    "the speed is not known: {reason}; the default speed is used",
                    reason=unknown.fact,
                )
                self.problem(line, what, once=what)
            return None

    def zone(self, line: int, row: Any, options: Mapping[str, Any]) -> float | None:
        """mm of the zone around the target within which the corner is rounded; 0: stop point (fine,
        \\Inpos); None: not known here."""
        try:
            if "inpos" in options:
                return 0.0
            with self.asking("zonedata" if one_word(row) else "num"):
                value = row(self)
            if not isinstance(value, list) or len(value) != 7 or not isinstance(value[0], bool):
                raise Unknown("programs.rapid.no_zonedata", "it is no zonedata")
            if value[0]:
                return 0.0
            size = number(options["z"](self)) if options.get("z") else number(value[1])
            return max(0.0, size)
        except Unknown as unknown:
            self.program.need(unknown)
            what = Fact(
                "programs.rapid.zone_unknown",
                "the zone is not known: {reason}",
                reason=unknown.fact,
            )
            self.problem(line, what, once=what)
            return None

    def setting(self, line: int, word: str, text: str) -> None:
        """VelSet percent, mm/s; PDispSet pose; PDispOn; PDispOff."""
        try:
            row = arguments(text)[0]
            if word == "velset":
                percent, most = (number(one(self)) for one in row)
                self.override, self.most = percent / 100.0, most
            elif word == "pdispset":
                self.displacement = pose_of(row[0](self))
            else:
                self.displacement = None if word == "pdispoff" else False
        except (Unknown, ValueError, IndexError) as error:
            self.displacement = False if word == "pdispset" else self.displacement
            self.override = None if word == "velset" else self.override
            self.problem(
                line,
                "programs.unknown_because",
                "{name} is not known: {reason}",
                name=text.split()[0],
                reason=getattr(error, "fact", str(error)),
            )


def _external(values: Any) -> tuple[float, ...]:
    """eax_a, eax_b .. of an extjoint, as far as they are there one after the other."""
    found: list[float] = []
    for value in values if isinstance(values, list) else []:
        if not isinstance(value, float) or not abs(value) < NO_AXIS:
            break
        found.append(value)
    return tuple(found)
