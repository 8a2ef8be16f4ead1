"""The robot of a job, its key ``robot`` (job.schema.json): a preset, or a model of its own.

Joint angles are in degrees; frames are 4 x 4 in mm.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import frames, schemas
from ..base.files import at_key
from ..base.kinds import Floats, Json
from ..engine import InputError
from ..geometry.body_names import LINKS
from . import external_axes, library, robot_shape, urdf, urdf_shapes
from .robot_model import JOINTS, arm, checked_model, robot_rules, validate_model

if TYPE_CHECKING:
    from ..engine import core

BASE = "base_from_robot"
CONTROLLERS_OWN = re.compile(r"\w*", re.ASCII)  # numbers and names of a controller's own frames


def checked(robot: Json) -> dict[str, Any]:
    """A copy of a job's ``robot`` with all defaults. Raises InputError naming the key."""
    made: dict[str, Any] = schemas.checked(robot, robot_rules(), "robot")
    validate(made)
    return made


def validate(robot: Json) -> None:
    """Raises InputError for what the schema cannot say of a robot with all its defaults."""
    model = robot["model"]
    if robot["preset"] and (model["joints"] or model["urdf"]):
        raise InputError(
            "presets.preset_and_model",
            "{key}: give a preset or a model with joints, not both",
            key="robot",
        )
    if model["joints"] and model["urdf"]:
        raise InputError(
            "presets.joints_and_urdf",
            "{key}: give joints or a URDF, not both",
            key="robot.model",
        )
    if len(robot["start_joints_deg"]) not in (0, JOINTS):
        raise InputError(
            "presets.start_joints",
            "{key}: {count} angles; give six, or none",
            key="robot.start_joints_deg",
            count=len(robot["start_joints_deg"]),
        )
    for name in ("home_joints_deg", "joint_acceleration_deg_s2", "joint_jerk_deg_s3"):
        if len(robot["program"][name]) not in (0, JOINTS):
            raise InputError(
                "presets.six_angles",
                "{key}: {count} angles; give six, or none",
                key=f"robot.program.{name}",
                count=len(robot["program"][name]),
            )
    if not CONTROLLERS_OWN.fullmatch(robot["program"]["base"]):
        raise InputError(
            "presets.program_base",
            "{key}: '{base}' is no base of a controller; give its number or its name, as 5 or wTable",
            key="robot.program.base",
            base=robot["program"]["base"],
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
    external_axes.validate(robot["external_axes"])
    if model["urdf"]:
        _check_urdf(robot)
    validate_model(model)


def _check_urdf(robot: Json) -> None:
    """Raises InputError for a file that is no arm, or a mesh that is not there."""
    try:
        arm(model_of(robot))
        urdf_shapes.files(robot["model"], robot["packages"])
    except InputError as error:
        raise at_key(error, "robot.model.urdf") from None


def load_preset(name: str) -> dict[str, Any]:
    """The model (a job's robot.model) of a preset's id. Raises InputError."""
    return library.find("robots", name)["model"]


def given(robot: Json) -> bool:
    """Whether a job's robot (with defaults) is one, whose reach is to be checked."""
    return bool(robot["preset"] or robot["model"]["joints"] or robot["model"]["urdf"])


def name(robot: Json) -> str:
    """How the robot is called; "" for none."""
    if robot["model"]["urdf"]:
        return Path(robot["model"]["urdf"]).stem
    return robot["preset"] or ("own model" if robot["model"]["joints"] else "")


def arm_of(robot: Json) -> core.RobotArm | None:
    """core.RobotArm of a job's robot with its defaults, None if it is none. Raises InputError."""
    return arm(model_of(robot)) if given(robot) else None


def home_of(robot: Json) -> Floats:
    """(6,) rad: the home of the programs of a job's robot with its defaults, else joint angles 0."""
    found: Floats = np.radians(robot["program"]["home_joints_deg"] or [0.0] * JOINTS)
    return found


def model_of(robot: Json) -> Json:
    """The robot.model of a job's robot with its defaults, by its joints: its preset's if it has one, or a URDF's."""
    if robot["preset"]:
        return load_preset(robot["preset"])
    model: Json = robot["model"]
    return checked_model(urdf.model_of(model)) if model["urdf"] else model


def links_of(
    robot: Json, wanted: tuple[str, str] = urdf_shapes.COLLISION
) -> list[robot_shape.Link]:
    """[(tubes, hubs)] of a job's robot with its defaults, as ``robot_shape.links`` has them; of a URDF with bodies, or
    a preset with tubes, these, and no hubs, unless the job has its own radii. ``wanted``: which of them (``urdf_shapes``).
    """
    if robot["model"]["urdf"] and not robot["link_radii_mm"]:
        found = urdf_shapes.bodies(robot["model"], robot["packages"], wanted)
        if found is not None:
            return [(one, robot_shape.NOTHING) for one in found]
    if robot["preset"] and not robot["link_radii_mm"]:
        tubes = library.find("robots", robot["preset"]).get("tubes")
        if tubes:
            return robot_shape.measured(tubes)
    of = arm(model_of(robot))
    return robot_shape.links(of, robot_shape.radii(robot, of), model_of(robot)["floor_mm"])


def robot_frame(robot: Json, key: str) -> Floats:
    """(4, 4), mm: the transform under a key of a job's robot; of its base where it stands in the passes, if external
    axes move it or the part. Raises InputError."""
    try:
        found = frames.from_data(robot.get(key))
    except InputError as error:
        raise at_key(error, f"robot.{key}") from None
    axes = robot.get("external_axes", ())
    if key == BASE and axes:
        return external_axes.base_from_robot(axes, external_axes.at(axes, "position"), found)
    return found


def frame_at_zero(robot: Json) -> Floats:
    """(4, 4), mm: the robot's base in the frame of the programs with all external axes at 0. Raises InputError."""
    return robot_frame({**robot, "external_axes": ()}, BASE)


def standing(robot: Json) -> Floats:
    """(4, 4): how what stands in the cell lies in the frame of the programs, which goes with the part on a positioner."""
    axes = robot.get("external_axes", ())
    values = external_axes.at(axes, "position")
    found: Floats = np.linalg.inv(external_axes.displacement(axes, values, external_axes.PART))
    return found


def pose_function(robot: Json) -> Callable[..., Floats] | None:
    """A function that gives the pose (4, 4) in the frame of the programs of six joint angles in degrees, and of values of
    the external axes, which may be missing: those that are coordinated count, the others stand as in the passes. None if
    the job's robot is none. Raises InputError.
    """
    if not given(robot):
        return None
    of = arm(model_of(robot))
    base_of, tool = base_function(robot), robot_frame(robot, "flange_from_tcp")

    def pose(joints_deg: Sequence[float], values: Sequence[float] = ()) -> Floats:
        found: Floats = base_of(values) @ of.forward(np.radians(joints_deg)) @ tool
        return found

    return pose


def base_function(robot: Json) -> Callable[[Sequence[float]], Floats]:
    """A function that gives the robot's base (4, 4) in the frame of the programs for values of the external axes: as in
    ``pose_function``. Raises InputError."""
    axes = robot.get("external_axes", ())
    standing, moving = robot_frame(robot, BASE), external_axes.coordinated(axes)
    if not moving:
        return lambda values: standing
    at_zero, stand = frame_at_zero(robot), external_axes.at(axes, "position")

    def base_of(values: Sequence[float]) -> Floats:
        now = list(stand)
        for k in moving:
            if k < len(values) and np.isfinite(values[k]):
                now[k] = float(values[k])
        return external_axes.base_from_robot(axes, now, at_zero)

    return base_of
