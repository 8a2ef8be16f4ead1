"""The motions of an INFORM job: where MOVJ, MOVL, MOVC, MOVS and IMOV lead, and how fast."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...program import Fact, Motion, Reason, Unknown, joint_angles
from ..taught import NUMBER, pose_of
from ..taught_program import Taught
from .jobs import Job
from .positions import Joints
from .variables import Variables

MOVE = re.compile(r"(S?MOV[JLCS]|IMOV)(?=\s|$)\s*(.*)$")
KINDS = {"MOVJ": "PTP", "MOVL": "LIN", "MOVS": "SPL"}
POSITION = re.compile(r"(?:(C|P)(\d{1,6})|P\[([^\[\]]*)\])(?=\s|$)\s*(.*)$", re.ASCII)
OTHER = re.compile(r"(?:BC|EC|BP|EX)\d{1,6}(?=\s|$)", re.ASCII)
SPEED = re.compile(r"(?:^|\s)(V|VR|VE)=(\S*)")
SHIFTED = re.compile(r"\b(SRCH|UNTIL)\b")
# What a motion's tags are: those of its position, speed, end and of what goes on beside it.
TAGS = re.compile(
    r"(?:^|\s)(?:(?:V|VR|VE|VJ|PL|CR|ACC|DEC|EV|ROTV|S|Q|SPD)=\S*|FPT|NWAIT|CONT|BF|RF|TF|UF#\(\d+\)|WGO#?\S*"
    r"|//.*|'.*|(?:BC|EC|BP|EX)\d+|\+MOV[JLC](?=\s)|UNTIL\b.*|SRCH\b.*)(?=\s|$)",
    re.ASCII,
)
AXES = "SLURBT"
PULSES = "PULSES_PER_DEGREE_"  # what a person gives, for each axis


def zeither(rest: str) -> float | None:
    """mm by a motion's tags: PL=0 stops; CR is a corner radius in mm (exact where the path turns by
    90 degrees); the other position levels are parameters of the controller, so not known.
    """
    match = re.search(r"(?:^|\s)(?:(PL=0(?:\.0*)?)|CR=(\d{1,5}(?:\.\d{0,6})?))(?=\s|$)", rest)
    if not match:
        return None
    return 0.0 if match.group(1) else float(match.group(2))


class Motions(Variables, Taught):
    """Adds the motions of the job that is followed (``job``)."""

    NO_ARC = re.compile(r"(?:MOV[JLS]|IMOV)\b")
    job: Job

    def __init__(self, path: Path | str, values: dict[str, Any] | None = None) -> None:
        super().__init__(path, values)
        self.variables: dict[int, Any] = {}  # positions P by number
        self.speed_set: float | None = None  # by SPEED, mm/s
        self.here = None  # (components, base) of the current pose, None: unknown
        self.frames: dict[str, str] = {}  # words of frames that an instruction may have changed

    def move(self, line: int, kind: str, rest: str) -> None:
        """Follows a motion. Raises Unknown."""
        if self.displaced:
            raise Unknown(self.displaced)
        if kind.startswith("S"):
            if self.job.groups > 1 or "+MOV" in rest:
                raise Unknown(
                    "programs.inform.moves_together",
                    "it moves along with a second robot or a station",
                )
            kind = kind[1:]
        match = POSITION.match(rest)
        if not match:
            raise Unknown("programs.inform.position_elsewhere", "its position is not in this file")
        letter, digits, index, rest = match.groups()
        digits = digits or f"{self.whole(self.value(index)):03}"
        letter, n = letter or "P", int(digits)
        position = self.job.positions.get((letter, n)) if letter == "C" else self.variables.get(n)
        if position is None:
            position = self.position_of_person(letter, n, digits)
        components: Any = position[0]
        words = position[1:]
        base, tool = (self.frames.get(word, word) for word in words)
        if isinstance(components, Reason):
            raise Unknown(
                "programs.inform.position_unknown",
                "{letter}{number} {reason}",
                letter=letter,
                number=digits,
                reason=components.fact,
            )
        shifted = SHIFTED.search(rest)
        if shifted:
            raise Unknown(
                "programs.known_at_run_time",
                "what {word} does is known at run time only",
                word=shifted.group(1),
            )
        odd = TAGS.sub("", rest)
        while odd != TAGS.sub("", odd):  # what stood between two of them has to have its blank
            odd = TAGS.sub("", odd)
        if odd.strip():
            raise Unknown(
                "programs.not_understood", "'{text}' is not understood", text=odd.strip()[:30]
            )
        joints = None
        if isinstance(components, Joints):
            joints = self.degrees(components)
            if kind in ("MOVC", "IMOV"):
                raise Unknown(
                    "programs.inform.arc_of_joints",
                    "an arc through joint positions, or a step by them, is not followed",
                )
        if kind == "IMOV":
            components, base = self.step(components, rest)
        pose = pose_of(components) if joints is None else None
        simple = KINDS.get(kind, "LIN")
        motion = Motion(simple, pose, self.place(line), self.program.file, tool=tool, base=base)
        motion.joints_deg = joints
        motion.zone_mm = zeither(rest)
        if kind != "MOVJ":
            motion.speed_mm_s = self.speed(line, OTHER.sub("", rest))
        self.here = (components, base) if joints is None else None
        if kind != "MOVC":
            self.add(motion)
            return
        self.add_arc_point(motion)
        if self.broken:
            self.here = None
            self.broken = not re.search(r"\bFPT\b", rest)
            return
        if re.search(r"\bFPT\b", rest):  # the point at which one arc ends and the next begins
            self.close_arc()
            self.continue_arc(motion)

    def position_of_person(self, letter: str, n: int, digits: str) -> Any:
        """(components, base, tool) of a position that the job does not know, as a person gives P; in the frames of
        the job's own P, or of its first position. Raises Unknown."""
        reason = Reason(
            "programs.inform.no_value",
            "{letter}{number} has no value that this file gives",
            letter=letter,
            number=digits,
        )
        if letter == "P":
            reason.wanting(f"P{n:03}", "frame")
        six = self.values.get(f"P{n:03}") if letter == "P" else None
        if not isinstance(six, tuple):
            raise Unknown(reason)
        self.program.need(reason)
        x, y, z, a, b, c = six
        positions: Any = self.job.positions
        words = positions.get((letter, n)) or next(iter(positions.values()), (None, "", ""))
        return ([x, y, z, c, b, a], *words[1:])

    def degrees(self, joints: Joints) -> Any:
        """Six angles in degrees of Joints. Raises Unknown, and asks for pulses a degree."""
        values: Sequence[float] = joints.values
        if joints.kind == "PULSE":
            ratios: list[Any] = []
            reason: Reason | None = None
            for axis in AXES:
                name = PULSES + axis
                why = Reason(
                    "programs.inform.pulses",
                    "it is given in pulses; how many make a degree of axis {axis} is the robot's: give {name}",
                    axis=axis,
                    name=name,
                ).wanting(name, "number")
                self.program.need(why)
                ratios.append(self.values.get(name))
                if not isinstance(ratios[-1], float) or abs(ratios[-1]) < 1e-3:
                    reason = reason or why
            if reason is not None:
                raise Unknown(reason)
            values = [value / ratio for value, ratio in zip(values, ratios)]
        angles = joint_angles(list(values))
        if angles is None:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        return angles

    def step(self, components: Sequence[float], rest: str) -> tuple[list[float], str]:
        """(components, base) after an IMOV from the current pose. Raises Unknown."""
        frame = re.search(r"(?:^|\s)(BF|RF|TF|UF#\((\d+)\))(?:\s|$)", rest)
        if self.here is None or not frame or any(components[3:]):
            raise Unknown(
                "programs.inform.imov", "IMOV adds to a pose or frame that is not known, or turns"
            )
        here, base = self.here
        if frame.group(1) == "TF":
            moved = pose_of(here)[:3] @ [*components[:3], 1.0]
        elif base == {"BF": "BASE", "RF": "ROBOT"}.get(frame.group(1), f"USER {frame.group(2)}"):
            moved = np.add(here[:3], components[:3])
        else:
            raise Unknown(
                "programs.inform.imov_frame",
                "IMOV is along {frame}, the pose is in {base}",
                frame=frame.group(1),
                base=base or Fact("programs.inform.no_frame", "no frame"),
            )
        return [*moved, *here[3:]], base

    def speed(self, line: int, rest: str) -> float | None:
        """mm/s of a path motion, None (and a Problem) when it is not known."""
        match = SPEED.search(rest)
        if not match:
            if re.search(r"VJ=", rest):
                return None
            if self.speed_set is None:
                self.problem(
                    line,
                    "programs.inform.no_speed",
                    "the path speed is not known: neither V= nor SPEED gives it",
                )
            return self.speed_set
        name, text = match.groups()
        if name != "V":
            self.problem(
                line,
                "programs.inform.no_path_speed",
                "the path speed is not known: {name}= is no path speed",
                name=name,
            )
        elif not re.fullmatch(NUMBER, text, re.ASCII):
            self.problem(
                line,
                "programs.inform.speed_no_number",
                "the path speed is not known: V={text} is no number",
                text=text[:20],
            )
        elif "." not in text:
            self.note_once(
                line,
                "programs.inform.speed_unit",
                "V= without a decimal point may be mm/s or cm/min; such speeds are not known",
            )
        elif not 0.0 < float(text) < 1e5:
            self.problem(
                line,
                "programs.inform.speed_out_of_range",
                "the path speed V={text} is out of range",
                text=text[:20],
            )
        else:
            return float(text)
        return None
