"""A program for the whole robot as a file, and whether it reads again as it was planned."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import frames, records
from ..base.kinds import Context, Facts, Floats, Json, known
from ..cell import reach
from ..engine import Fact, InputError, core
from ..job import robot_time
from ..job.settings import Job
from ..job.typed import typed
from ..presets import external_axes, robot as robots
from ..programs.force_device import of_job
from ..programs.program import Motion, Posture, Program
from ..programs.registry import read_program
from ..programs.writers.frames import AS_KNOWN, words_of_cell
from ..programs.writers.sheet import Load, check_external
from ..programs.writers.writer import write_program
from . import whole as wholes
from .moves import Move, Whole

if TYPE_CHECKING:
    from ..programs.writers.frames import Given

CLOSE = 1e-3  # degrees, between the joints that are planned and those that the file reads again
PARTS = 20  # of a motion with coordinated axes, in which the arm is followed
WITH_JOINTS = (".src", ".mod", ".modx", ".script")  # languages whose joint motions are read again


def plan_job(job: Job | Json, context: Context = None) -> Whole:
    """The ``Whole`` of all programs of a validated job, one after the other, from home to home. Raises InputError,
    Cancelled."""
    job, context = typed(job), context or core.RunContext()
    joined = Whole()
    count = len(job.programs)
    for index in range(count):
        part = context.part(index / count, (index + 1) / count)
        one = wholes.plan(job, index, None, part)
        joined.follow(one)
        joined.figures = _summed(joined.figures, one.figures)
    return joined


def _summed(first: Json, second: Json) -> dict[str, Any]:
    found = dict(second)
    for key, value in first.items():
        if key in ("least_limit_margin_deg", "link_clearance_mm"):
            found[key] = min((v for v in (value, second[key]) if v is not None), default=None)
        elif key == "cost_s":
            found[key] = {name: part + second[key][name] for name, part in value.items()}
        else:
            found[key] = value + second[key]
    return found


def program(whole: Whole, job: Job | Json) -> Program:
    """The moves as a ``programs.Program``. A robot without a spherical wrist has no postures."""
    robot = records.plain(typed(job).robot)
    arm = known(robots.arm_of(robot))
    words = words_of_cell(*_frames(robot))
    made = Program("robot", "robot")
    for move, after in zip(whole.moves, [*whole.moves[1:], None]):
        stops = move.kind == "PTP" or after is None or after.kind == "PTP"
        made.motions.append(_motion(move, arm, words, stops))
    return made


def _frames(robot: Json) -> tuple[Floats, Floats]:
    """(base_from_robot, flange_from_tcp); the first with the axes that move in the passes at 0, the others as there."""
    base = robots.base_function(robot)([0.0] * len(robot["external_axes"]))
    return base, robots.robot_frame(robot, "flange_from_tcp")


def _motion(move: Move, arm: core.RobotArm, words: dict[str, str], stops: bool) -> Motion:
    posture = joints = None
    if move.joints_deg is not None:
        joints = tuple(float(one) for one in move.joints_deg)
        if arm.structure == "spherical_wrist":
            posture = Posture(**arm.configuration(np.radians(move.joints_deg)))
    path = move.kind == "LIN"
    zone = 0.0 if stops else (None if move.zone < 0 else move.zone)
    return Motion(
        move.kind, move.frame, move.line, "", move.feed if path else None,
        move.force if path and move.force >= 0 else None, words["tool"], words["base"], zone_mm=zone,
        joints_deg=joints, posture=posture, note=move.note, external=move.external,
    )  # fmt: skip


def write(
    file: Path | str,
    job: Job | Json,
    whole: Whole,
    *,
    form: str = "",
    tools: Given | None = None,
    bases: Given | None = None,
    unsafe: bool = False,
) -> Facts:
    """Writes a ``Whole`` of a validated job as a robot program. Returns what ``write_program`` does. ``tools``, ``bases``:
    as that takes them; None: the base of ``robot.program``, else the numbers of the job's robot. Raises InputError, ``unsafe`` or not where the file would
    not read again as planned; else for a problem of the program, the first named."""
    file, job = Path(file), typed(job)
    if whole.problems and not unsafe:
        raise InputError(
            "robot_program.unsafe",
            "{file} is not written: {problem} ({count} problems in all; --unsafe writes it all the same)",
            file=file,
            problem=whole.problems[0],
            count=len(whole.problems),
        )
    robot = records.plain(job.robot)
    options: dict[str, Any] = {
        "form": form,
        "tools": _frames(robot)[1] if tools is None else tools,
        "bases": base_set(file, job, bases),
        "force_device": of_job(job),
        "pace": robot_time.limits(job).pace,
        "joint_percent": job.robot.program.joint_speed_percent,
        "load": _load(job),
    }
    made = program(whole, job)
    told = [_comment(robot)]
    if unsafe and whole.problems:
        told.insert(0, "UNSAFE: " + "; ".join(str(fact) for fact in whole.problems))
    options["comment"] = "; ".join(filter(None, told))
    file.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=file.parent) as folder:
        tried = Path(folder, file.name)
        notes = write_program(tried, None, made, **options)
        if file.suffix.lower() in WITH_JOINTS and not whole.problems:
            check_joints(tried, job, whole)
        os.replace(tried, file)
    return [*notes]


def base_set(file: Path | str, job: Job | Json, given: Given | None = None) -> Given:
    """What a program of that name sets as its base: ``given`` if it is not None, else the base of ``robot.program``, else
    robot_from_base. Raises InputError for external axes that the language does not write, and for numbers where the part
    moves in the passes."""
    job = typed(job)
    robot = records.plain(job.robot)
    axes = robot["external_axes"]
    if axes:
        check_external(Path(file).suffix.lower())
    if given is None:
        given = job.robot.program.base or np.linalg.inv(_frames(robot)[0])
    each = given.values() if isinstance(given, Mapping) else [given]
    if all(isinstance(one, (str, int)) and one != AS_KNOWN for one in each):
        return given
    for k in external_axes.coordinated(axes):
        if axes[k]["carries"] == external_axes.PART:
            raise InputError(
                "robot_program.base_moves",
                "{key}: {name} carries the part and moves in the passes; only the controller's own base goes with it: couple "
                "one to the axis there, and give its number or name (robot.program.base, or program robot --base)",
                key="robot.external_axes",
                name=external_axes.NAME.format(k + 1),
            )
    return given


def _comment(robot: Json) -> str:
    """What the head says of axes that move in the passes; "" for none."""
    moving = external_axes.coordinated(robot["external_axes"])
    names = ", ".join(external_axes.NAME.format(k + 1) for k in moving)
    return f"{names} moves in the passes: the base is that with it at 0" if moving else ""


def _load(job: Job) -> Load | None:
    load = job.robot.load
    return Load(load.mass_kg, load.centre_mm, load.inertia_kg_m2) if load.mass_kg > 0.0 else None


def joints_of_file(file: Path, job: Job | Json) -> Floats:
    """(n, 6) degrees: the joints at the poses of a program's file, as the job's robot follows it."""
    job = typed(job)
    robot = records.plain(job.robot)
    arrays: dict[str, Any] = read_program(file, force_device=of_job(job)).path_arrays(
        wholes.STEP, robots.pose_function(robot), external=True
    )
    external = arrays.pop("external")
    if external_axes.coordinated(robot["external_axes"]):
        return _followed(job, arrays, external)
    arrays.pop("gaps")
    path = core.ToolPath(**arrays, holding=job.cell.holding)
    steps = job.simulation
    found = reach.reach(path, robot, steps.max_travel_mm, steps.max_angle_deg)
    joints: Floats = found["joints"]
    return joints


def _followed(job: Job, arrays: dict[str, Any], external: Floats) -> Floats:
    """As ``joints_of_file``, where coordinated axes move: pose by pose, the tool straight in the frame that goes with the
    part, the axes evenly."""
    robot = records.plain(job.robot)
    arm = known(robots.arm_of(robot))
    base_of, tool = robots.base_function(robot), robots.robot_frame(robot, "flange_from_tcp")
    found, at = [], np.clip(np.zeros(6), arm.lower, arm.upper)
    frame, values = arrays["frames"][0], external[0]
    for row, joints in enumerate(arrays["joints"]):
        target, to = arrays["frames"][row], external[row]
        if np.isfinite(joints).all():
            at = np.radians(joints)
        else:
            for share in np.linspace(0.0, 1.0, PARTS + 1)[1:]:
                base = base_of(values + share * (to - values))
                pose = np.linalg.inv(base) @ frames.between(frame, target, share)
                rows = arm.inverse(pose @ np.linalg.inv(tool), at)
                lost = np.full(6, math.nan)
                at = rows[np.argmin(np.abs(rows - at).max(axis=1))] if len(rows) else lost
        found.append(np.degrees(at))
        frame, values = target, to
    return np.stack(found)


def check_joints(file: Path, job: Job, whole: Whole) -> None:
    """Raises InputError where a written file does not give the planned joints again."""
    found = joints_of_file(file, job)
    wanted = np.stack([known(move.joints_deg) for move in whole.moves])
    if len(found) != len(wanted):
        raise InputError(
            "robot_program.motions_read_again",
            "{file}: it reads as {found} poses in place of {count}; nothing is written",
            file=file.name,
            found=len(found),
            count=len(wanted),
        )
    apart = np.abs(found - wanted).max(axis=1)
    worst = int(np.argmax(np.where(np.isfinite(apart), apart, math.inf)))
    if not apart[worst] <= CLOSE:
        raise InputError(
            "robot_program.joints_read_again",
            "{file}: read again, its motion {motion} leads to other joint angles than planned, by {apart:.3g} degrees; "
            "nothing is written",
            file=file.name,
            motion=worst,
            apart=apart[worst],
        )


def summary(whole: Whole) -> dict[str, Any]:
    """The figures of a program, as the command line prints them."""
    return {**whole.figures, "problems": [str(fact) for fact in whole.problems]}
