"""The model of a robot arm as plain data (a job's ``robot.model``), checked and made into the engine's arm.

Angles are in degrees here, as the controller shows them, and in radian in the core.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..base import frames, schemas
from ..base.files import at_key
from ..base.kinds import Json
from ..engine import InputError, core

JOINTS = 6
URDF_KEYS = ("origin_mm", "rpy_deg", "axis")
DH_KEYS = ("a_mm", "alpha_deg", "d_mm", "theta_deg", "direction")


def robot_rules() -> dict[str, Any]:
    """The schema of a job's ``robot``, by itself."""
    job = schemas.schema("job")
    return {**job["properties"]["robot"], "definitions": job["definitions"]}


def checked_model(model: Json) -> dict[str, Any]:
    """A copy of a ``robot.model`` with all defaults. Raises InputError."""
    made: dict[str, Any] = schemas.checked({"model": model}, robot_rules(), "robot")["model"]
    validate_model(made)
    if not made["joints"]:
        raise InputError("presets.six_joints", "{key}: a robot has six joints", key="model.joints")
    return made


def validate_model(model: Json) -> None:
    """Raises InputError for what the schema cannot say of a ``robot.model``; none is sound, too."""
    if model["joints"]:
        try:
            arm(model)
        except InputError as error:
            raise at_key(error, "robot.model") from None


def arm(model: Json) -> core.RobotArm:
    """core.RobotArm of a robot.model with its defaults. Raises InputError naming the joint."""
    own, other = (URDF_KEYS, DH_KEYS) if model["convention"] == "urdf" else (DH_KEYS, URDF_KEYS)
    rules = robot_rules()["properties"]["model"]["properties"]["joints"]["items"]["properties"]
    rows = []
    for number, joint in enumerate(model["joints"], 1):
        strange = [key for key in other if joint[key] != rules[key]["default"]]
        if strange:
            raise InputError(
                "presets.joint_key",
                "joint {joint}: '{key}' has no meaning in the convention {convention}; it takes "
                "{keys}",
                joint=number,
                key=strange[0],
                convention=model["convention"],
                keys=", ".join(own),
            )
        row: dict[str, Any] = {
            "lower": math.radians(joint["lower_deg"]),
            "upper": math.radians(joint["upper_deg"]),
            "max_speed": math.radians(joint["max_speed_deg_s"]),
        }
        if model["convention"] == "urdf":
            roll, pitch, yaw = joint["rpy_deg"]
            row["parent_from_joint"] = frames.from_abc(joint["origin_mm"], (yaw, pitch, roll))
            row["axis"] = np.array(joint["axis"], dtype=float)
        else:
            row["a"], row["d"] = float(joint["a_mm"]), float(joint["d_mm"])
            row["alpha"] = math.radians(joint["alpha_deg"])
            row["offset"] = math.radians(joint["theta_deg"])
            row["direction"] = float(joint["direction"])
        rows.append(row)
    flange = frames.from_data(model.get("joint6_from_flange"))
    return core.RobotArm(model["convention"], rows, flange, float(model["coupling"]))
