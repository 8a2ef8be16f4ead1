"""What a robot program says: motions with poses, and what could not be resolved."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Optional, TypeAlias, TypeVar, cast

import numpy as np

from ..base.frames import to_quaternions
from ..base.kinds import Array, Floats
from ..base.regular_files import read_regular, shown
from ..base.stopping import check
from ..engine import Fact as Fact, InputError
from . import one_frame

Told: TypeAlias = "Fact | str"  # a Fact, or a code with the English form and its arguments
# As a Reason has it: a Fact, or what one is made of.
Why: TypeAlias = "Fact | tuple[str, str, dict[str, Any]]"
Joints: TypeAlias = "tuple[float, ...]"  # six angles, degrees
# Centre, x axis to the start, y axis, radius mm, angle to the end.
Circle: TypeAlias = "tuple[Floats, Floats, Floats, float, float]"

CHORD_ERROR = 0.01  # mm, of an arc resolved into chords
PASSING_ERROR = 0.05  # mm, that the way of a spline may pass beside its points
MAX_CHORDS = 10_000
MAX_ANGLE = 1e6  # of a joint; more is no angle
MAX_COORDINATE = 1e7  # mm; beyond, a file is damaged
MAX_FILE = 256 << 20  # bytes of a program's file
MAX_LINE = 1_000_000  # characters
MAX_POSES = 2_000_000  # of a program's path, chords of arcs among them
MAX_UNROLLED = 60_000  # units of work in loops, beyond what the files allow: about a second
SKIPPED = 8  # statements that are only looked through cost as much as one that is followed
LOOPED = 4  # a file allows so many times its own work: loops over its points are as long as it


class ProgramError(InputError):
    """A program that cannot be read; the message names file and line and what to do."""

    @classmethod
    def at(cls, file: str, line: int, code: str, text: str, /, **arguments: object) -> ProgramError:
        """The error in a line of a file."""
        return cls(code, text, **arguments).in_line(file, line)

    @classmethod
    def of(cls, error: InputError) -> ProgramError:
        """Another InputError as one of a program."""
        own = cls.__new__(cls)
        own.__dict__.update(error.__dict__)
        own.args = error.args
        return own

    def in_line(self, file: str, line: int) -> ProgramError:
        """The error with its place before it."""
        error = self.within("programs.at", "{file}:{line}: ", file=file, line=line)
        assert isinstance(error, ProgramError)  # of its own class
        return error


class Problem(Fact):
    """Something in a program that cannot be known here; only what depends on it is left out.

    str() begins with its place, "FILE:LINE: ". ``message``: the Fact without the place.
    """

    file: str
    line: int
    message: Fact

    def __new__(
        cls, file: str, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> Problem:
        """``told``: a Fact, or a code with the English form and its arguments."""
        message = cast(Fact, told) if text is None else Fact(told, text, **arguments)
        self = str.__new__(cls, f"{file}:{line}: {message}")
        self.file, self.line, self.message = file, line, message
        self.code, self.text, self.arguments = message.code, message.text, message.arguments
        return self

    @property
    def context(self) -> list[tuple[str, str, dict[str, Any]]]:  # type: ignore[override] # follows from its place
        """As an InputError's."""
        return [("programs.at", "{file}:{line}: ", {"file": self.file, "line": self.line})]


R = TypeVar("R", bound="Reason")


class Reason:
    """Why something is not known: a Fact that is made when it is asked for, since most never are.

    Made of a Fact, of another Reason, or of a code, the English form and its arguments. ``wants``: (NAME,
    what it is, as in ``Program.asked``) of what a person may give in place of what is not known; None:
    nothing. What depends on it is not known for the same Reason, so that the first cause is told and asked for.
    """

    def __init__(
        self, told: Why | Reason | str, text: str | None = None, /, **arguments: object
    ) -> None:
        self.wants: tuple[str, str] | None = None
        self.told: Why
        if isinstance(told, Reason):
            self.wants, self.told = told.wants, told.told
        else:
            self.told = cast(Why, told) if text is None else (cast(str, told), text, arguments)

    def wanting(self: R, name: str, shape: str) -> R:
        """Itself, with what a person may give."""
        self.wants = name.upper(), shape
        return self

    def after(self: R, other: Reason) -> R:
        """Itself, with what a person may give for another Reason that it follows from."""
        self.wants = other.wants
        return self

    @property
    def fact(self) -> Fact:
        if isinstance(self.told, tuple):
            code, text, arguments = self.told
            self.told = Fact(code, text, **arguments)
        return self.told


class Unknown(Reason, Exception):
    """What only the controller can know; ``fact`` says what."""

    def __str__(self) -> str:
        return str(self.fact)


CHAINED = ("programs.not_known_since", "programs.unknown_because")  # {name} for a {reason}


def shortened(fact: Fact, most: int) -> Fact:
    """A fact in at most ``most`` characters; of reasons that hang on each other the first cause remains."""
    first: Any = fact.arguments.get("reason")
    reason = first
    while getattr(reason, "code", "") in CHAINED:
        first, reason = reason, reason.arguments["reason"]
    if fact.code in CHAINED and first is not fact.arguments["reason"]:
        fact = Fact(fact.code, fact.text, **{**fact.arguments, "reason": first})
    if len(fact) <= most:
        return fact
    arguments = {k: v[:most] if isinstance(v, str) else v for k, v in fact.arguments.items()}
    short = str.__new__(Fact, fact[:most])
    short.code, short.text, short.arguments = fact.code, fact.text, arguments
    return short


# The pose (4, 4) of six joint angles in degrees, and of external axes in mm or degrees, () where a motion has none.
PoseOf: TypeAlias = Callable[[Sequence[float], Sequence[float]], Floats]


@dataclass(frozen=True)
class Posture:
    """Which of the eight configurations an arm with a spherical wrist is in, as the core's RobotArm.configuration has it."""

    behind: bool  # the wrist is behind axis 1
    below: bool  # joint 3 is turned less than where the arm is stretched
    back: bool  # the wrist lies behind the upper arm, against all angles 0
    flipped: bool  # joint 5 is turned to less than where axes 4 and 6 are one line


@dataclass
class Motion:
    """One programmed target. ``pose``: 4 x 4 base_from_tcp in mm, None for a joint target."""

    kind: str  # PTP, LIN, CIRC, SPL; GAP: a mark where motions are left out
    pose: Optional[Floats]
    line: int
    file: str
    speed_mm_s: Optional[float] = None
    force_N: Optional[float] = None
    tool: str = ""
    base: str = ""
    aux: bool = False  # an arc's auxiliary point: on the way, orientation without meaning
    # mm from the target within which the corner is rounded; 0: the robot stands still there; inf:
    # it passes through, the target is no corner; None: not known (the job's default zone)
    zone_mm: Optional[float] = None
    # Of the feed, that the robot keeps through the corner, which is rounded as far as that takes (Fanuc's CNT)
    corner_share: Optional[float] = None
    # How the tool turns on the way: from the start's orientation to the target's; "path": so against an
    # arc's tangent; "hold": it keeps the start's; "hold path": it keeps that against the tangent
    turn: str = ""
    joints_deg: Optional[
        Joints
    ] = None  # of a joint target: six angles as the controller shows them
    free_roll: bool = (
        False  # the program gives the tool's axis only: a rule turns the pose about it
    )
    # With a pose and ``joints_deg`` it is known how the arm stands there: a PTP is written as a joint motion, a path
    # motion with the posture that its language has for it.
    posture: Optional[Posture] = None
    note: str = ""  # what a comment before it says
    external: tuple[float, ...] = ()  # where the external axes are at its end, mm or degrees


@dataclass
class Program:
    """All motions of a program, in order."""

    language: str
    file: str
    motions: list[Motion] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    # The frames that motions name, as far as the program tells them: 4 x 4 in mm, bases in the robot's
    # own base and tools in its flange; where the robot holds the part (``held``: the words of such
    # bases) bases in the flange and tools in the robot's base.
    base_frames: dict[str, Floats] = field(default_factory=dict)
    tool_frames: dict[str, Floats] = field(default_factory=dict)
    held: set[str] = field(default_factory=set)
    # Names that only the controller knows and the program asks for, {NAME: "frame", "number", "truth", or ""
    # where the program does not tell which}, whether a person gave them (``programs.given``) or not.
    asked: dict[str, str] = field(default_factory=dict)
    given: set[str] = field(default_factory=set)  # of those names, and "units": what a person gave
    asks_units: bool = (
        False  # the file does not say its unit of length, whether a person gave it or not
    )
    units_mm: set[float] = field(
        default_factory=set
    )  # lengths of its units, where a file may be in others than mm
    lost: int = 0  # motions, or statements that may move, that are left out
    left_out: list[tuple[str, int]] = field(default_factory=list)  # (file, line) of each
    told: set[one_frame.Place] = field(default_factory=set)  # problems that path_arrays has found

    def gap(self, line: int, file: str, again: bool = True) -> None:
        """Marks that motions are left out here: the path beyond must not be joined over it. ``again``:
        also where one is marked already."""
        if self.left_out[-1:] != [(file, line)]:  # once a statement
            self.lost += 1
            self.left_out.append((file, line))
        if again or not self.motions or self.motions[-1].kind != "GAP":
            self.motions.append(Motion("GAP", None, line, file))

    def need(self, reason: Reason) -> None:
        """Asks for what a Reason wants: something that a path consists of depends on it."""
        if reason.wants is not None:
            self.asked.setdefault(*reason.wants)

    def in_one_frame(self) -> list[Motion]:
        """The motions with all poses in one frame (``one_frame``); what is left out becomes a problem, once."""
        motions, problems = one_frame.motions(self)
        for file, line, fact in problems:
            if (file, line, fact) not in self.told:
                self.told.add((file, line, fact))
                self.problem(file, line, fact)
        return motions

    def check_holding(self, holding: str | None) -> None:
        """Adds a problem where the cell holds part and tool otherwise than the program does."""
        for file, line, fact in one_frame.holding_problems(self, holding):
            self.problem(file, line, fact)

    def tell_joints(self) -> None:
        """Adds a problem, once, where feed motions go to joint targets."""
        by_joints = [m for m in self.motions if m.kind != "PTP" and m.joints_deg is not None]
        if not by_joints:
            return
        fact = Fact(
            "programs.joints_without_robot",
            "{count} motions on a path, the first here, go to joint positions and are left out: where these lie "
            "the robot's model says, which the job gives",
            count=len(by_joints),
        )
        place = self.file, by_joints[0].line, fact
        if place not in self.told:
            self.told.add(place)
            self.problem(*place)

    def counted(self) -> tuple[int, int]:
        """(motions that are read, motions in the program): poses and joint targets, and with them what is left
        out."""
        read = sum(m.kind != "GAP" and not m.aux for m in self.in_one_frame())
        said = sum(m.kind != "GAP" and not m.aux for m in self.motions)
        return read, said + self.lost

    def problem(
        self, file: str, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        """Adds a Problem; the arguments are those of its class."""
        self.problems.append(Problem(file, line, told, text, **arguments))

    def path_arrays(
        self, default_speed_mm_s: float, pose_of: PoseOf | None = None, external: bool = False
    ) -> dict[str, Array]:
        """Poses as the simulator takes them: dict of frames (n, 4, 4) in mm, feeds (n,) in mm/s,
        forces (n,) in N (-1: none), rapid (n,) bool, lines (n,) int, zones (n,) in mm (0: exact
        stop, -1: not known, below: as ``zone_of_share``, ``ON_CURVE``), gaps (n,) int: the line from which on motions are left out before this
        pose, 0: none. All poses are in one frame (``one_frame``); what cannot be brought into it is
        left out and becomes a problem. Arcs become chords of ``CHORD_ERROR``, rounded where they meet; after a
        joint target, and after a gap, the robot arrives by a rapid motion. Between points of a spline there is no
        stop.
        With ``pose_of``, which gives the pose (4, 4) of six joint angles in degrees and of external axes, joint
        targets are poses too, and there is joints (n, 6) in degrees, NaN where none are given. With ``external`` there is
        external (n, k): where these axes are, mm or degrees; NaN before the first that are given.
        """
        motions = self.in_one_frame()
        if pose_of is None:
            self.tell_joints()
        else:
            motions = [
                m if m.joints_deg is None else replace(m, pose=pose_of(m.joints_deg, m.external))
                for m in motions
            ]
        rows: list[list[Any]] = []
        previous: Floats | None = None
        aux: Floats | None = None
        lost, gap = False, 0
        axes: tuple[float, ...] = ()
        for motion, following in zip(motions, [*motions[1:], None]):
            check()
            axes = motion.external or axes
            if motion.pose is None:
                gap = gap or (0 if motion.kind == "PTP" else motion.line)
                aux, lost = None, True  # where the joint target is, only the robot's geometry tells
                if rows:  # nor in which direction a corner before it would be rounded
                    rows[-1][-1] = 0.0
                continue
            if motion.aux:
                aux = motion.pose
                continue
            rapid = motion.kind == "PTP" or lost or previous is None
            poses = [motion.pose]
            if previous is None or rapid:
                pass
            elif aux is not None:
                poses = _arc(previous, aux, motion.pose, motion.turn)
            elif motion.turn.startswith("hold"):
                poses = [through_with(motion.pose, previous)]
            speed = motion.speed_mm_s or default_speed_mm_s
            force = -1.0 if motion.force_N is None else motion.force_N
            joints = motion.joints_deg or (math.nan,) * 6
            rows += [
                [pose, speed, force, rapid, motion.line, joints, axes, 0, math.inf]
                for pose in poses
            ]
            rows[-len(poses)][-2] = gap
            check_count(len(rows), motion)
            rows[-1][-1] = _zone(motion, following)
            previous, aux, lost, gap = poses[-1], None, False, 0
        columns: list[Sequence[Any]] = list(zip(*rows)) if rows else [[] for _ in range(9)]
        frames = np.array(columns[0], dtype=float).reshape(-1, 4, 4)
        arrays = {
            "frames": frames,
            "feeds": np.array(columns[1], dtype=float),
            "forces": np.array(columns[2], dtype=float),
            "rapid": np.array(columns[3], dtype=bool),
            "lines": np.array(columns[4], dtype=int),
            "gaps": np.array(columns[7], dtype=int),
            "zones": _finite(np.array(columns[8], dtype=float), frames),
        }
        if pose_of is not None:
            arrays["joints"] = np.array(columns[5], dtype=float).reshape(-1, 6)
        if external:
            most = max(map(len, columns[6]), default=0)
            full = [[*one, *[math.nan] * (most - len(one))] for one in columns[6]]
            arrays["external"] = np.array(full, dtype=float).reshape(len(full), most)
        return arrays


def check_count(count: int, motion: Motion) -> None:
    """Raises ProgramError in the line of a Motion with which a path has too many poses."""
    if count > MAX_POSES:
        raise ProgramError.at(
            motion.file,
            motion.line,
            "programs.too_many_poses",
            "the path has more than {limit} poses, chords of its arcs among them; split "
            "the program, or give smaller arcs",
            limit=MAX_POSES,
        )


def joint_angles(values: Iterable[object], scale: float = 1.0) -> Joints | None:
    """Six angles times ``scale`` (to degrees) for ``Motion.joints_deg``; None unless all are finite
    numbers.
    """
    numbers = [v for v in values if isinstance(v, (int, float)) and not isinstance(v, bool)]
    if len(numbers) != 6 or not all(abs(v) < MAX_ANGLE for v in numbers):
        return None
    return tuple(scale * float(v) for v in numbers)


def work_of(text: str) -> int:
    """Units of work that following a statement takes: one, and more for a long one."""
    return 1 + len(text) // 25


ON_CURVE = -3.0  # the zone, as paths have it, of a spline's point, through which the robot passes


def zone_of_share(share: float) -> float:
    """The zone, as paths have it, of a corner through which the robot keeps a share (above 0, at most 1) of its feed."""
    return -1.0 - share


def share_of_zone(zone: float) -> float | None:
    """The share that ``zone_of_share`` has made a zone of; None for a length or a zone that is not known."""
    return -1.0 - zone if ON_CURVE < zone < -1.0 else None


def corner_of(zone: float) -> dict[str, Any]:
    """The arguments of a ``Motion`` for a zone as paths have it."""
    share = share_of_zone(zone)
    if share is not None:
        return {"corner_share": share}
    return {"zone_mm": zone} if zone >= 0.0 else {}


def _zone(motion: Motion, following: Motion | None) -> float:
    """mm; -1: not known; below: as ``zone_of_share``; ``ON_CURVE``; inf: the robot passes through a chord's end."""
    joined = following is not None and motion.kind == following.kind == "SPL"
    if joined and (motion.zone_mm is None or math.isinf(motion.zone_mm)):
        return ON_CURVE
    if motion.zone_mm is not None:
        return motion.zone_mm
    return zone_of_share(motion.corner_share) if motion.corner_share else -1.0


def _finite(zones: Floats, frames: Floats) -> Floats:
    """Passing through as a length: the neighbouring poses' distance, but no further than the rounded
    corner, which lies zone |v - u| / 4 inside (u, v: the directions), stays within
    ``PASSING_ERROR`` of the pose."""
    passing = np.isinf(zones)
    if not passing.any():
        return zones
    steps = np.diff(frames[:, :3, 3], axis=0)
    ways = np.linalg.norm(steps, axis=1)
    steps /= np.maximum(ways, 1e-9)[:, None]
    reach = np.full(len(zones), CHORD_ERROR)  # where the robot only turns, any length will do
    reach[1:] = np.maximum(reach[1:], ways)
    reach[:-1] = np.maximum(reach[:-1], ways)
    bend = np.linalg.norm(np.diff(steps, axis=0), axis=1)
    reach[1:-1] = np.minimum(reach[1:-1], 4.0 * PASSING_ERROR / np.maximum(bend, 1e-9))
    return np.where(passing, reach, zones)


def bytes_of(path: Path | str, language: str) -> bytes:
    """The bytes of a program's text. Raises ProgramError where there are none, or it is no text."""
    try:
        raw = read_regular(path, MAX_FILE)
    except InputError as error:
        raise ProgramError.of(error) from None
    if b"\0" in raw:
        raise ProgramError(
            "programs.zero_bytes",
            "{file}: is no {language} text (it holds zero bytes); save it as text",
            file=shown(path),
            language=language,
        )
    return raw


def lines_of(text: str, file: str) -> list[str]:
    """The lines of a program's text, whatever ends them. Raises ProgramError for one without end:
    what looks at a line must not take long, so that reading can be cancelled.
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if len(text) > MAX_LINE:
        for line, one in enumerate(lines, 1):
            if len(one) > MAX_LINE:
                raise ProgramError.at(
                    file,
                    line,
                    "programs.long_line",
                    "the line has more than {limit} characters; break it into several",
                    limit=MAX_LINE,
                )
    return lines


def name_of(path: Path | str) -> str:
    """How a program's file is named in messages."""
    return shown(Path(path).name)


def _arc(start: Floats, through: Floats, end: Floats, turn: str = "") -> list[Floats]:
    """Poses after ``start`` on the circle through three points; ``turn``: as a Motion's."""
    circle = circle_through(start, through, end)
    if circle is None:
        halfway = through_with(through, start)  # on a line
        return [halfway, through_with(end, start) if turn.startswith("hold") else end]
    centre, x_axis, y_axis, radius, angle = circle
    step = 2.0 * math.acos(max(-1.0, 1.0 - CHORD_ERROR / radius)) if radius > CHORD_ERROR else 1.0
    count = min(MAX_CHORDS, max(2, math.ceil(angle / step)))
    shares = np.arange(1, count + 1) / count
    at = shares[:, None] * angle
    poses = np.zeros((count, 4, 4))
    poses[:, :3, :3] = turned(start, end, circle, turn, shares)
    poses[:, :3, 3] = centre + radius * (np.cos(at) * x_axis + np.sin(at) * y_axis)
    poses[:, 3, 3] = 1.0
    last = poses[-1] if turn.startswith("hold") else end
    return [*poses[:-1], through_with(end, last)]


def circle_through(start: Floats, through: Floats, end: Floats) -> Circle | None:
    """(centre, x axis to the start, y axis, radius, angle to the end by way of ``through``) of the
    circle through three poses, mm and radians; None where they lie on a line."""
    a, b, c = (pose[:3, 3] for pose in (start, through, end))
    u, v = b - a, c - a
    normal = np.cross(u, v)
    size = float(normal @ normal)
    if size < 1e-18 * max(float(u @ u), float(v @ v), 1e-300) ** 2 or size == 0.0:
        return None
    centre = a + np.cross((u @ u) * v - (v @ v) * u, normal) / (2.0 * size)
    radius = float(np.linalg.norm(a - centre))
    x_axis = (a - centre) / radius
    y_axis = np.cross(normal / math.sqrt(size), x_axis)
    angle = math.atan2((c - centre) @ y_axis, (c - centre) @ x_axis) % (2.0 * math.pi)
    return centre, x_axis, y_axis, radius, angle


def turned(start: Floats, end: Floats, circle: Circle, turn: str, shares: Floats) -> Floats:
    """Rotations (n, 3, 3) at ``shares`` (n,) of a circle (as ``circle_through``), by a Motion's ``turn``."""
    _, x_axis, y_axis, _, angle = circle
    first, last = start[:3, :3], end[:3, :3]
    if "path" not in turn:
        return first @ powers(np.eye(3) if turn == "hold" else first.T @ last, shares)
    plane = np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])
    about = np.zeros((len(shares) + 1, 3, 3))  # the turns of the tangent, and the whole
    at = angle * np.append(shares, 1.0)
    about[:, 0, 0] = about[:, 1, 1] = np.cos(at)
    about[:, 1, 0], about[:, 0, 1], about[:, 2, 2] = np.sin(at), -np.sin(at), 1.0
    about = plane @ about @ plane.T
    own = np.eye(3) if turn == "hold path" else first.T @ about[-1].T @ last
    return about[:-1] @ first @ powers(own, shares)


def through_with(through: Floats, orientation: Floats) -> Floats:
    """The position of ``through`` with the orientation of another pose."""
    pose = through.copy()
    pose[:3, :3] = orientation[:3, :3]
    return pose


def powers(rotation: Floats, shares: Floats) -> Floats:
    """The rotations (n, 3, 3) by ``shares`` (n,) of the angle of ``rotation`` (3, 3): slerp from the
    identity."""
    quaternion = to_quaternions(rotation[None])[0]
    sine = float(np.linalg.norm(quaternion[1:]))
    if sine < 1e-12:
        return np.broadcast_to(np.eye(3), (len(shares), 3, 3))
    turns = 2.0 * math.atan2(sine, quaternion[0]) * shares[:, None, None]
    x, y, z = quaternion[1:] / sine
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(turns) * k + (1 - np.cos(turns)) * (k @ k)
