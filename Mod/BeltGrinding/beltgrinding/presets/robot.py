"""The robot of a job, its key ``robot`` (job.schema.json): a preset, or a model of its own.

Joint angles are in degrees; frames are 4 x 4 in mm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import frames, schemas
from ..base.files import at_key
from ..base.kinds import Floats, Json
from ..engine import InputError
from ..geometry.body_names import LINKS
from . import library, robot_shape
from .robot_model import JOINTS, arm, robot_rules, validate_model

if TYPE_CHECKING:
    from ..engine import core


def checked(robot: Json) -> dict[str, Any]:
    """A copy of a job's ``robot`` with all defaults. Raises InputError naming the key."""
    made: dict[str, Any] = schemas.checked(robot, robot_rules(), "robot")
    validate(made)
    return made


def validate(robot: Json) -> None:
    """Raises InputError for what the schema cannot say of a robot with all its defaults."""
    model = robot["model"]
    if robot["preset"] and model["joints"]:
        raise InputError(
            "presets.preset_and_model",
            "{key}: give a preset or a model with joints, not both",
            key="robot",
        )
    if len(robot["start_joints_deg"]) not in (0, JOINTS):
        raise InputError(
            "presets.start_joints",
            "{key}: {count} angles; give six, or none",
            key="robot.start_joints_deg",
            count=len(robot["start_joints_deg"]),
        )
    for name in ("home_joints_deg", "joint_acceleration_deg_s2"):
        if len(robot["program"][name]) not in (0, JOINTS):
            raise InputError(
                "presets.six_angles",
                "{key}: {count} angles; give six, or none",
                key=f"robot.program.{name}",
                count=len(robot["program"][name]),
            )
    if len(robot["link_radii_mm"]) not in (0, len(LINKS)):
        raise InputError(
            "presets.link_radii",
            "{key}: {count} radii; give seven, foot to flange, or none",
            key="robot.link_radii_mm",
            count=len(robot["link_radii_mm"]),
        )
    if robot["preset"]:
        load_preset(robot["preset"])
    if robot["controller"]:
        library.find("controllers", robot["controller"])
    validate_model(model)


def load_preset(name: str) -> dict[str, Any]:
    """The model (a job's robot.model) of a preset's id. Raises InputError."""
    return library.find("robots", name)["model"]


def given(robot: Json) -> bool:
    """Whether a job's robot (with defaults) is one, whose reach is to be checked."""
    return bool(robot["preset"] or robot["model"]["joints"])


def name(robot: Json) -> str:
    """How the robot is called; "" for none."""
    return robot["preset"] or ("own model" if robot["model"]["joints"] else "")


def arm_of(robot: Json) -> core.RobotArm | None:
    """core.RobotArm of a job's robot with its defaults, None if it is none. Raises InputError."""
    return arm(model_of(robot)) if given(robot) else None


def model_of(robot: Json) -> Json:
    """The robot.model of a job's robot with its defaults, its preset's if it has one."""
    return load_preset(robot["preset"]) if robot["preset"] else robot["model"]


def links_of(robot: Json) -> list[robot_shape.Link]:
    """[(tubes, hubs)] of a job's robot with its defaults, as ``robot_shape.links`` has them."""
    of = arm(model_of(robot))
    return robot_shape.links(of, robot_shape.radii(robot, of), model_of(robot)["floor_mm"])


def robot_frame(robot: Json, key: str) -> Floats:
    """(4, 4), mm: the transform under a key of a job's robot. Raises InputError."""
    try:
        return frames.from_data(robot.get(key))
    except InputError as error:
        raise at_key(error, f"robot.{key}") from None


def pose_function(robot: Json) -> Callable[[Sequence[float]], Floats] | None:
    """A function that gives the pose (4, 4) in the frame of the programs of six joint angles in
    degrees; None if the job's robot is none. Raises InputError.
    """
    if not given(robot):
        return None
    of = arm(model_of(robot))
    base, tool = robot_frame(robot, "base_from_robot"), robot_frame(robot, "flange_from_tcp")
    return lambda joints_deg: base @ of.forward(np.radians(joints_deg)) @ tool
