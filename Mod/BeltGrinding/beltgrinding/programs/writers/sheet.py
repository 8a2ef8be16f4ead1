"""What the writer of a language gets."""

from __future__ import annotations

from dataclasses import dataclass, field

from typing import NamedTuple, Optional

import numpy as np

from ...base.kinds import Floats
from ..force_device import ForceDevice
from ..program import Fact, Joints, Posture, ProgramError
from .frames import Frame
from .text import DIGITS, Digits

WITH_EXTERNAL = (".src", ".mod", ".modx")  # languages that have external axes here


def check_external(suffix: str) -> None:
    """Raises ProgramError for a language whose statement for external axes no public source shows."""
    if suffix not in WITH_EXTERNAL:
        raise ProgramError(
            "programs.writers.external",
            "external axes are written as {known} only, not as '{suffix}'",
            known=", ".join(WITH_EXTERNAL),
            suffix=suffix,
        )


@dataclass
class Step:
    """A motion to be written. ``aux``: number of the auxiliary pose, None: no arc."""

    kind: str  # PTP, LIN, CIRC, SPL
    pose: int  # row of the poses
    aux: int | None
    speed: float | None  # mm/s
    force: float | None  # N
    tool: int  # row of the tools
    base: int
    zone: float | None = None  # mm, 0: it stops there; None: the program's blend
    share: float | None = None  # of the feed, kept through the corner; None: by the zone
    note: str = ""  # what a comment before it says
    joints: Optional[Joints] = None  # degrees, where they are known
    posture: Optional[Posture] = None
    external: tuple[float, ...] = ()  # of the external axes, mm or degrees


class Load(NamedTuple):
    """What the flange carries, as controllers want it."""

    mass_kg: float
    centre_mm: tuple[float, float, float]  # of gravity, in the flange
    inertia_kg_m2: tuple[float, float, float]  # about it, along the flange's axes; 0: not known

    def told(self) -> str:
        at = ", ".join(f"{one:g}" for one in self.centre_mm)
        return f"load of the flange: {self.mass_kg:g} kg at {at} mm; set it on the controller"


class Pace(NamedTuple):
    """What a program sets of the robot's time law, where the language has a statement for it."""

    acceleration_mm_s2: float  # along the path
    angular_acceleration_deg_s2: float
    rotation_speed_deg_s: float


@dataclass
class Sheet:
    """What the writer of a language gets."""

    name: str
    comments: list[str]
    steps: list[Step]
    positions: Floats  # (n, 3) mm
    quaternions: Floats  # (n, 4) w, x, y, z
    frames: Floats  # (n, 4, 4)
    tools: list[Frame]  # flange_from_tcp
    bases: list[Frame]  # robot_from_base
    speed_mm_s: float  # where a motion has none
    ptp_speed_mm_s: float
    blend_mm: float
    part_in_hand: bool
    digits: Digits = DIGITS["fine"]
    form: str = (
        ""  # "": corners as the motions say; "spline" or "zones": as ``write_program`` takes it
    )
    device: Optional[ForceDevice] = None  # that the program sets its forces by
    pace: Optional[Pace] = None
    joint_percent: Optional[float] = None  # speed of joint motions; None: the controller's
    load: Optional[Load] = None  # that the program sets; None: it leaves it to the controller
    notes: list[Fact] = field(default_factory=list)  # what the program takes for granted

    def ways(self) -> tuple[Floats, Floats]:
        """(n,) mm from the step before, (n,) mm to the one behind; 0 where there is none."""
        places = self.positions[[step.pose for step in self.steps]]
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        return np.append(0.0, lengths), np.append(lengths, 0.0)

    def refuse_held(self, language: str) -> None:
        """Raises ProgramError where the poses are those of a fixed tool in the part that the robot holds."""
        if self.part_in_hand:
            raise ProgramError(
                "programs.writers.part_in_hand",
                "poses of a fixed tool in a held part (robhold) are not written as "
                "{language}: the path speed would be another one; write RAPID, or the "
                "poses of the part in the room",
                language=language,
            )

    def refuse_external(self, suffix: str) -> None:
        """Raises ProgramError for external axes in a language whose statement for them no public source shows. All at 0, as a controller
        without such axes writes them, are none."""
        if any(any(step.external) for step in self.steps):
            check_external(suffix)

    def posture(self) -> Fact:
        """What a language takes for granted that writes the arm's configuration with each pose."""
        return Fact(
            "programs.writers.posture",
            "the arm's configuration at the positions is not known here: they have the first of the language; set it "
            "at the first position, and check the others on the controller's simulator",
        )

    def frames_of(self) -> list[tuple[int, int]]:
        """(base, tool) of each pose, as rows of ``bases`` and ``tools``."""
        found = [(0, 0)] * len(self.frames)
        for step in self.steps:
            for pose in (step.pose, step.aux):
                if pose is not None:
                    found[pose] = step.base, step.tool
        return found

    def speed_of(self, step: Step) -> float:
        """mm/s of a path motion, never so low that its digits make it none."""
        return max(step.speed or self.speed_mm_s, 10.0**-self.digits.speed)
