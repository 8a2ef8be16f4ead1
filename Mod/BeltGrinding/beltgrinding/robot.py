"""The robot that runs a program: its model, and what its joints meet on the way.

A job's key ``robot`` says which (job.schema.json). Joint angles are in degrees here, as the
controller shows them, and in radian in the core; frames are 4 x 4 in mm.
"""

import csv
import io
import math

import numpy as np

from . import InputError, core, frames, schemas

JOINTS = 6
EVENTS = (
    "out_of_reach",
    "joint_limit",
    "singularity",
    "wrist_flip",
    "arm_flip",
    "joint_speed",
)
URDF_KEYS = ("origin_mm", "rpy_deg", "axis")
DH_KEYS = ("a_mm", "alpha_deg", "d_mm", "theta_deg", "direction")


def _rules():
    return schemas.schema("job")["properties"]["robot"]


def checked(robot):
    """A copy of a job's ``robot`` with all defaults. Raises InputError naming the key."""
    rules = _rules()
    rules["definitions"] = schemas.schema("job")["definitions"]
    robot = schemas.checked(robot, rules, "robot")
    validate(robot)
    return robot


def checked_model(model):
    """A copy of a ``robot.model`` with all defaults. Raises InputError."""
    model = checked({"model": model})["model"]
    if not model["joints"]:
        raise InputError("model.joints: a robot has six joints")
    return model


def validate(robot):
    """Raises InputError for what the schema cannot say of a robot with all its defaults."""
    model = robot["model"]
    if robot["preset"] and model["joints"]:
        raise InputError("robot: give a preset or a model with joints, not both")
    if len(robot["start_joints_deg"]) not in (0, JOINTS):
        raise InputError(
            f"robot.start_joints_deg: {len(robot['start_joints_deg'])} angles; give six, or none"
        )
    if robot["preset"]:
        load_preset(robot["preset"])
    if model["joints"]:
        try:
            arm(model)
        except (InputError, ValueError) as error:
            raise InputError(f"robot.model: {error}") from None


def load_preset(name):
    """The model (a job's robot.model) of a preset's id. Raises InputError."""
    from . import presets

    return presets.find("robots", name)["model"]


def given(robot):
    """Whether a job's robot (with defaults) is one, whose reach is to be checked."""
    return bool(robot["preset"] or robot["model"]["joints"])


def name(robot):
    """How the robot is called; "" for none."""
    return robot["preset"] or ("own model" if robot["model"]["joints"] else "")


def arm(model):
    """core.RobotArm of a robot.model with its defaults. Raises InputError naming the joint."""
    own, other = (URDF_KEYS, DH_KEYS) if model["convention"] == "urdf" else (DH_KEYS, URDF_KEYS)
    rules = _rules()["properties"]["model"]["properties"]["joints"]["items"]["properties"]
    rows = []
    for number, joint in enumerate(model["joints"], 1):
        strange = [key for key in other if joint[key] != rules[key]["default"]]
        if strange:
            raise InputError(
                f"joint {number}: '{strange[0]}' has no meaning in the convention "
                f"{model['convention']}; it takes {', '.join(own)}"
            )
        row = {
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


def arm_of(robot):
    """core.RobotArm of a job's robot with its defaults, None if it is none. Raises InputError."""
    if not given(robot):
        return None
    return arm(load_preset(robot["preset"]) if robot["preset"] else robot["model"])


def _frame(robot, key):
    try:
        return frames.from_data(robot.get(key))
    except ValueError as error:
        raise InputError(f"robot.{key}: {error}") from None


def pose_function(robot):
    """A function that gives the pose (4, 4) in the frame of the programs of six joint angles in
    degrees; None if the job's robot is none. Raises InputError.
    """
    of = arm_of(robot)
    if of is None:
        return None
    base, tool = _frame(robot, "base_from_robot"), _frame(robot, "flange_from_tcp")
    return lambda joints_deg: base @ of.forward(np.radians(joints_deg)) @ tool


def reach(path, robot, max_travel_mm=1.0, max_angle_deg=1.0, context=None):
    """What the joints do along a core.ToolPath.

    ``robot``: as in a job, or a preset's id. Returns dict(joints (n, 6) in degrees, one row per
    pose, NaN where the robot does not get; events, as a simulation has them; least, greatest (6,)
    in degrees; checks: how many places were looked at). Raises InputError, Cancelled.
    """
    robot = checked({"preset": robot} if isinstance(robot, str) else robot)
    if not given(robot):
        raise InputError("robot: give a preset or a model; without one its reach is not known")
    options = {
        "base_from_robot": _frame(robot, "base_from_robot"),
        "flange_from_tcp": _frame(robot, "flange_from_tcp"),
        "max_travel": float(max_travel_mm),
        "max_angle": math.radians(max_angle_deg),
        "singularity": math.radians(robot["singularity_deg"]),
        "flip": math.radians(robot["flip_deg"]),
    }
    if robot["start_joints_deg"]:
        options["start"] = np.radians(np.array(robot["start_joints_deg"], dtype=float))
    found = arm_of(robot).reach(path, options, context=context)
    for key in ("joints", "least", "greatest"):
        found[key] = np.degrees(found[key])
    return found


def job_reach(job, paths, context=None):
    """``reach`` of each core.ToolPath of a validated job; [] if the job has no robot."""
    if not given(job["robot"]):
        return []
    steps = job["simulation"]
    return [
        reach(path, job["robot"], steps["max_travel_mm"], steps["max_angle_deg"], context)
        for path in paths
    ]


def summary(robot, found):
    """Figures of ``job_reach`` as summary.json has them."""
    if not found:
        return {}
    of = arm_of(robot)
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


def joints_csv(found, paths_lines):
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
