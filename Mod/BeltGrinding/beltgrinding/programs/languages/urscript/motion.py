"""The motions of a URScript program: targets, speeds, blends, the tool, forces, and what shifts targets."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

from ....base.kinds import Floats
from ...program import Motion, Reason, Unknown, joint_angles
from ..core.expression import Call
from ..core.values import Evaluated
from .expression import element, number
from .pose import InReference, Pose, a_pose
from .scopes import CALLED, Scopes

DEFAULT_SPEED = 0.25  # m/s, without v
# Functions of the controller that are not followed: which change nothing, the tool, or where targets lie.
READS = re.compile(r"(?:get|is|read|to|str|zero|rtde)_|modbus_get|force$")
SETS_TOOL = re.compile(r"tcp|set_tool_frame")
SHIFT = re.compile(
    r"path_offset_|track_conveyor|(?:set|use|select|activate)_\w*(?:frame|coord)|shift|mirror"
)
SHIFTS = "path_offset_enable path_offset_set track_conveyor_linear track_conveyor_circular".split()
SHIFT_ENDS = re.compile(r"_(?:disable|off|stop|end|reset)$")
IN_REFERENCE = "ref_frame"  # the base of poses in a ref_frame that the file does not assign
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


def in_mm(pose: Pose) -> Floats:
    """4 x 4 in mm of a Pose."""
    frame = pose.frame.copy()
    frame[:3, 3] *= 1000.0
    return frame


class Motions(Scopes):
    """Adds the motions."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        # Of the frame all poses are given in, 4 x 4 in metres; False: there is none; None: not yet looked for
        self.inverse: Any = None
        self.base = self.tool = ""
        self.here: Floats | None = None  # position in mm, None: unknown
        self.displaced: Reason | None = (
            None  # the Reason why targets may lie elsewhere than they say
        )
        self.force: float | None = None  # N, of force_mode

    def gap(self, line: int) -> None:
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.here = None
        self.program.gap(line, self.file)

    def touch(self, line: int, text: str, maybe: bool = False) -> None:
        """What functions of the controller that a text calls make of the motions after it; ``maybe``: it may not run."""
        for name in CALLED.findall(text):
            if name in self.routines or READS.match(name):
                continue
            if name.startswith("stop_conveyor") or SHIFT.search(name) and SHIFT_ENDS.search(name):
                self.displaced = self.displaced if maybe else None
            elif SHIFT.search(name):
                self.displaced = Reason(
                    "programs.may_shift",
                    "'{text}' in line {begun} may shift it",
                    text=name[:30],
                    begun=line,
                )
            elif name in ("force_mode", "end_force_mode"):
                self.force = None
                if maybe:
                    self.problem(
                        line,
                        "programs.force_at_run_time",
                        "whether {what} runs is decided at run time; the motions after it are read without it",
                        what=name,
                    )
            elif SETS_TOOL.search(name):
                self.tool = f"as line {line} may set it"

    def set_tool(self, line: int, call: Call) -> None:
        try:
            pose = a_pose(call.arguments[0](self) if call.arguments else None)
            self.tool = str(pose)
            self.program.tool_frames[self.tool] = in_mm(pose)
        except Unknown as unknown:
            self.tool = f"as line {line} sets it"
            self.problem(
                line,
                "programs.urscript.tool",
                "the tool of set_tcp is not known: {reason}",
                reason=unknown.fact,
            )

    def start_force(self, line: int, call: Call) -> None:
        self.force = self.force_of(line, call)

    def end_force(self, line: int, call: Call) -> None:
        self.force = None

    def force_of(self, line: int, call: Call) -> float | None:
        """N of force_mode(frame, selection, wrench, ...) along the axes that it selects; None: not known."""
        try:
            if len(call.arguments) < 3:
                raise Unknown(
                    "programs.urscript.arguments", "its arguments are too many or too few"
                )
            selected, wrench = (one(self) for one in call.arguments[1:3])
            forces = [number(element(wrench, k)) for k in range(3) if element(selected, k)]
            return math.hypot(*forces) or None
        except Unknown as unknown:
            self.problem(
                line,
                "programs.force_unknown",
                "the force of {what} is not known: {reason}; that of the job is taken",
                what=call.name,
                reason=unknown.fact,
            )
            return None

    def motion(self, line: int, name: str, call: Call) -> None:
        self.reached(line)
        if self.displaced:
            raise Unknown(self.displaced)
        names = PARAMETERS[name]
        given = dict(zip(names, call.arguments))
        for key, value in call.named.items():
            if key in given or (key not in names and key != "pose"):
                raise Unknown(
                    "programs.urscript.argument",
                    "the argument {name} is not understood",
                    name=key,
                )
            given[key if key in names else names[0]] = value
        targets = names[:2] if name == "movec" else names[:1]
        if len(call.arguments) > len(names) or any(target not in given for target in targets):
            raise Unknown("programs.urscript.arguments", "its arguments are too many or too few")
        values = [given[target](self) for target in targets]
        if name == "movec" and "mode" in given and given["mode"](self) != 0:
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
            motion.force_N = None if motion.kind == "PTP" else self.force
            self.program.motions.append(motion)
        self.here = frames[-1][:3, 3]

    def in_base(self, pose: Pose) -> Floats:
        """4 x 4 in mm in the frame all poses are given in."""
        inside = isinstance(pose, InReference)
        if self.inverse is None:
            reference = self.scopes[-1].get("ref_frame", self.scopes[0].get("ref_frame"))
            if isinstance(reference, Pose):
                self.inverse, self.base = reference.inverse().frame, f"ref_frame {reference}"
                self.program.base_frames[self.base] = in_mm(reference)
            else:
                self.inverse, self.base = False, IN_REFERENCE if inside else ""
        if inside != (self.base == IN_REFERENCE):
            InReference(pose.frame).components()
        frame = pose.frame.copy() if self.inverse is False else self.inverse @ pose.frame
        frame[:3, 3] *= 1000.0
        return frame

    def zone(self, line: int, given: Mapping[str, Evaluated]) -> float | None:
        """mm by the blend radius r, without it 0 (an exact stop); None: not known."""
        try:
            return max(0.0, 1000.0 * number(given["r"](self))) if "r" in given else 0.0
        except Unknown as unknown:
            self.problem(
                line,
                "programs.urscript.blend_radius",
                "the blend radius is not known: {reason}",
                reason=unknown.fact,
            )
            return None

    def speed(
        self, line: int, name: str, given: Mapping[str, Evaluated], frames: Sequence[Floats]
    ) -> float | None:
        """mm/s by t (before v) or v; None: not known."""
        try:
            if name == "optimovel":
                raise Unknown(
                    "programs.urscript.optimovel", "optimovel takes a part of what the robot can"
                )
            time = number(given["t"](self)) if "t" in given else 0.0
            if time > 0 and self.here is None:
                raise Unknown(
                    "programs.urscript.time_from_unknown",
                    "t is given, and the position before is not known",
                )
            if time > 0 and self.here is not None:
                length = math.dist(self.here, frames[-1][:3, 3])
                return number(length / time) if length > 0 else None
            speed = number(given["v"](self)) if "v" in given else DEFAULT_SPEED
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
