"""Where the robot is and goes: the current pose, base and tool, arcs, speeds and zones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional, TypeAlias

import numpy as np

from ....base.kinds import Floats
from ....base.frames import in_words
from ...program import Fact, Motion, Program, Unknown, joint_angles
from .poses import Joints, pose

NO_SPEED = Fact("programs.speed_open", "the program gives none")
PER_UNIT = {"mm/s": 1.0, "mm/min": 1.0 / 60.0, "cm/min": 1.0 / 6.0}
A_SHARE = Fact("programs.speed_share", "it is a share of what the robot can")


Named: TypeAlias = tuple[
    str, Optional[Floats]
]  # a frame's words, and its 4 x 4 where that is known


class Moving:
    """Adds motions. ``speed``: (number, unit), None: not known; a unit of ``PER_UNIT``, "s" the seconds of a
    motion, or any other, which is not known; ``zone``: mm, None: not known."""

    program: Program
    file: str
    changes: int
    value: Callable[..., Any]
    problem: Callable[..., None]
    gap: Callable[..., None]

    def __init__(self) -> None:
        self.base: Named = ("", None)
        self.tool: Named = ("", None)
        self.here: Floats | None = None  # the pose in the base
        self.stands = False  # whether the robot stands there
        self.through: tuple[int, Floats] | None = None  # (line, pose) of the point on an arc
        self.asked = (
            False  # whether the program has asked for the pose: a loop's passes may differ by it
        )

    def current(self, standing: bool = False) -> Floats:
        """The pose that the motion before ends in; ``standing``: that the robot has come to."""
        if self.here is None or standing and not self.stands:
            raise Unknown("programs.position_unknown", "where the robot is then is not known")
        return self.here

    def asked_for(self, standing: bool) -> Floats:
        """As ``current``, by an expression."""
        self.asked = True
        return self.current(standing)

    def frame(self, which: str, line: int, text: str, plain: bool) -> None:
        """Sets "base" or "tool" to a text's value: the current pose goes over into it. ``plain``: whether the
        text names what a person may give."""
        old: Named = getattr(self, which)
        known: dict[str, Floats] = getattr(self.program, f"{which}_frames")
        new: Named
        try:
            found = pose(self.value(text))
            words = "NULL" if np.array_equal(found, np.eye(4)) else in_words(found)
            new = words, found
            known[words] = found.copy()
        except Unknown as unknown:
            self.program.need(unknown)
            if not plain:
                self.problem(
                    line,
                    "programs.unknown_because",
                    "{name} is not known: {reason}",
                    name=which.upper(),
                    reason=unknown.fact,
                )
            new = (text.upper() if plain else f"as line {line} sets it"), None
        setattr(self, which, new)
        if self.here is None or new[0] == old[0]:
            return
        if new[1] is None or old[1] is None:
            self.here = None
        elif which == "base":
            self.here = np.linalg.inv(new[1]) @ old[1] @ self.here
        else:
            self.here = self.here @ np.linalg.inv(old[1]) @ new[1]

    def frame_unknown(self, which: str, line: int) -> None:
        """A frame that a statement may set, or not."""
        setattr(self, which, (f"as line {line} may set it", None))
        self.here = None

    def goes(
        self,
        kind: str,
        line: int,
        target: Any,
        speed: tuple[float, str] | None = None,
        zone: float | None = None,
    ) -> None:
        """A motion "PTP", "LIN" or "CIRC" to a pose or Joints."""
        if kind != "CIRC":
            self.ends_arc()
        if isinstance(target, Joints):
            if kind != "PTP":
                raise Unknown("programs.joint_target", "its target is a joint position")
            motion = Motion("PTP", None, line, self.file, tool=self.tool[0])
            motion.joints_deg = joint_angles(target[:6])
            self.program.motions.append(motion)
            self.here, self.stands = None, False
            return
        target = pose(target).copy()
        if kind == "CIRC":
            if self.through is None:
                raise Unknown("programs.no_point_on_arc", "the point on the arc is not known")
            first, middle = self.through
            self.through = None
            self._add(kind, first, middle, None, zone, aux=True)
        mm_s = None if kind == "PTP" else self._mm_s(line, target, speed)
        self._add(kind, line, target, mm_s, zone)
        self.changes += self.asked and (self.here is None or not np.array_equal(self.here, target))
        self.here, self.stands = target, False

    def _add(
        self,
        kind: str,
        line: int,
        target: Floats,
        mm_s: float | None,
        zone: float | None,
        aux: bool = False,
    ) -> None:
        motion = Motion(kind, target, line, self.file, mm_s, zone_mm=zone, aux=aux)
        motion.base, motion.tool = self.base[0], self.tool[0]
        self.program.motions.append(motion)

    def middle(self, line: int, target: object) -> None:
        """The point on an arc, which the next motion ends."""
        self.ends_arc()
        self.through = line, pose(target).copy()

    def ends_arc(self) -> None:
        """A point of an arc that nothing ends is left out."""
        if self.through is not None:
            line = self.through[0]
            self.problem(
                line,
                "programs.no_end_of_arc",
                "the arc is left out: its end does not follow at once",
            )
            self.gap(line)

    def stops(self) -> None:
        """The robot comes to stand where the motion before ends."""
        self.stands = self.here is not None
        if self.here is not None:
            self.program.motions[-1].zone_mm = 0.0

    def _mm_s(self, line: int, target: Floats, speed: tuple[float, str] | None) -> float | None:
        value, unit = speed or (0.0, "")
        reason = NO_SPEED
        if value > 0.0 and unit in PER_UNIT:
            return value * PER_UNIT[unit]
        if value > 0.0 and unit == "s" and self.here is not None:
            length = float(np.linalg.norm(target[:3, 3] - self.here[:3, 3]))
            if length > 0.0:
                return length / value
        if speed and unit not in (*PER_UNIT, "s"):
            reason = A_SHARE
        self.problem(
            line,
            "programs.path_speed_unknown",
            "the path speed is not known: {reason}",
            reason=reason,
        )
        return None
