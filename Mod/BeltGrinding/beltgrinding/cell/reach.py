"""What a robot's joints meet along a program. Joint angles are in degrees; frames are 4 x 4 in mm."""

from __future__ import annotations

import copy
import csv
import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import kept, records
from ..base.kinds import Array, Context, Facts, Json, known
from ..engine import Fact, InputError
from ..job import robot_time
from ..job.settings import Job, Simulation
from ..job.typed import typed
from ..presets import external_axes
from ..presets.robot import arm_of, checked, given, model_of, name, robot_frame
from ..presets.robot_model import JOINTS
from . import tool_path

if TYPE_CHECKING:
    from ..engine import core

MOMENT_BYTES, EVENT_BYTES = 200, 4000  # in memory, about
EVENTS = (
    "out_of_reach",
    "joint_limit",
    "singularity",
    "wrist_flip",
    "arm_flip",
    "joint_speed",
)


def reach(
    path: core.ToolPath,
    robot: Json | str,
    max_travel_mm: float = 1.0,
    max_angle_deg: float = 1.0,
    context: Context = None,
    turn_speed_deg_s: float | None = None,
) -> dict[str, Any]:
    """What the joints do along a core.ToolPath.

    ``robot``: as in a job, or a preset's id. ``turn_speed_deg_s``: at which the controller turns the tool at most, None:
    that of the robot's controller. Returns dict(joints (n, 6) in degrees, one row per
    pose, NaN where the robot does not get; events, as a simulation has them; least, greatest (6,)
    in degrees; checks: how many places were looked at). Raises InputError, Cancelled.
    """
    wanted = checked({"preset": robot} if isinstance(robot, str) else robot)
    refuse_coordinated(wanted)
    if not given(wanted):
        raise InputError(
            "cell.no_robot",
            "{key}: give a preset or a model; without one its reach is not known",
            key="robot",
        )
    turning = turn_speed_deg_s or robot_time.turn_speed(wanted["controller"])
    found = follow(
        known(arm_of(wanted)), path, wanted, max_travel_mm, max_angle_deg, turning, context
    )
    for key in ("joints", "least", "greatest"):
        found[key] = np.degrees(found[key])
    return found


def refuse_coordinated(robot: Json) -> None:
    """Raises InputError for a job's robot (with its defaults) with external axes that move in the passes."""
    moving = external_axes.coordinated(robot["external_axes"])
    if moving:
        raise InputError(
            "cell.reach_coordinated",
            "{key}: {names} moves in the passes, which only a program for the whole robot plans: see there what it reaches, "
            "or make the axis indexed",
            key="robot.external_axes",
            names=_names(moving),
        )


def warnings(job: Job) -> Facts:
    """What is to be known of ``job_reach`` of a validated job."""
    robot = records.plain(job.robot)
    moving = external_axes.coordinated(robot["external_axes"]) if given(robot) else []
    if not moving:
        return []
    return [
        Fact(
            "cell.arm_not_followed",
            "{names} moves in the passes: neither the arm's reach nor its collisions are looked at here; the program for the "
            "whole robot does",
            names=_names(moving),
        )
    ]


def _names(axes: Sequence[int]) -> str:
    return ", ".join(external_axes.NAME.format(k + 1) for k in axes)


def follow(
    arm: core.RobotArm,
    path: core.ToolPath,
    robot: Json,
    max_travel_mm: float,
    max_angle_deg: float,
    turn_speed_deg_s: float,
    context: Context = None,
) -> dict[str, Any]:
    """As ``reach``, but in radian, by the arm of a robot that has all its defaults."""
    options = {
        "base_from_robot": robot_frame(robot, "base_from_robot"),
        "flange_from_tcp": robot_frame(robot, "flange_from_tcp"),
        "max_travel": float(max_travel_mm),
        "max_angle": math.radians(max_angle_deg),
        "singularity": math.radians(robot["singularity_deg"]),
        "flip": math.radians(robot["flip_deg"]),
        "turn_speed": math.radians(turn_speed_deg_s),
    }
    if robot["start_joints_deg"]:
        options["start"] = np.radians(np.array(robot["start_joints_deg"], dtype=float))
    return arm.reach(path, options, context=context)


def job_reach(
    job: Job | Json, paths: Sequence[core.ToolPath], context: Context = None
) -> list[dict[str, Any]]:
    """``reach`` of each core.ToolPath of a validated job; [] if the job has no robot, or axes that move in the passes
    (``warnings``). Kept for the next of the
    same ways and times."""
    job = typed(job)
    robot = records.plain(job.robot)
    if not given(robot) or external_axes.coordinated(robot["external_axes"]):
        return []
    turning = robot_time.limits(job).rotation_speed_deg_s
    return [_kept_reach(path, robot, job.simulation, turning, context) for path in paths]


def _kept_reach(
    path: core.ToolPath, robot: Json, steps: Simulation, turning: float, context: Context
) -> dict[str, Any]:
    wanted = robot, steps.max_travel_mm, steps.max_angle_deg
    look = lambda: reach(path, *wanted, context, turning)
    timed, _ = tool_path.digests(path)
    if timed is None:
        return look()
    parts = lambda: (timed, wanted, turning, model_of(robot))
    found = kept.get("reach", parts, look, _found_bytes)
    return {**found, "events": copy.deepcopy(found["events"])}


def _found_bytes(found: Json) -> float:
    return MOMENT_BYTES * len(found["arm"]) + EVENT_BYTES * len(found["events"])


def summary(robot: Json, found: Sequence[Json]) -> dict[str, Any]:
    """Figures of ``job_reach`` as summary.json has them."""
    if not found:
        return {}
    of = known(arm_of(robot))
    least = np.fmin.reduce([one["least"] for one in found])
    greatest = np.fmax.reduce([one["greatest"] for one in found])
    poses = sum(len(one["joints"]) for one in found)
    figures = {
        "name": name(robot),
        "inverse_kinematics": of.structure,
        "poses": poses,
        "reached_poses": sum(int(np.isfinite(one["joints"]).all(axis=1).sum()) for one in found),
    }
    if np.isfinite(least).all():
        lower, upper = np.degrees(of.lower), np.degrees(of.upper)
        margin = np.minimum(least - lower, upper - greatest)
        figures["joint_range_deg"] = np.stack([least, greatest], axis=1).tolist()
        figures["least_margin_deg"] = float(margin.min())
        figures["least_margin_joint"] = int(margin.argmin()) + 1
    return figures


def joints_csv(found: Sequence[Json], paths_lines: Sequence[Array]) -> str:
    """CSV of the joints at every pose: program and pose from 1, source line, six angles in degrees,
    which are empty where the robot does not get.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["program", "pose", "line", *(f"j{k}_deg" for k in range(1, JOINTS + 1))])
    for program, (one, lines) in enumerate(zip(found, paths_lines), 1):
        for pose, (joints, line) in enumerate(zip(one["joints"], lines), 1):
            angles = [f"{q:.6f}" if np.isfinite(q) else "" for q in joints]
            writer.writerow([program, pose, int(line), *angles])
    return text.getvalue()
