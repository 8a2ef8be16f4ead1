"""The robot's arm against itself: presets in postures as they grind in, URDFs, whole programs followed."""

import numpy as np
import pytest
from test_robot_program import KUKA, cell
from test_urdf import body, robot as urdf_robot, urdf

from beltgrinding.cell import arm_check, collision
from beltgrinding.engine import core
from beltgrinding.presets import library, robot as robots

FOLDED = [90, 20, 140, 0, 0, 0]  # of the KR 6: the wrist lies in the foot
EYE = np.eye(4)


def path_of(frames):
    count = len(frames)
    return core.ToolPath(
        frames=np.stack(frames), feeds=np.full(count, 100.0), forces=np.full(count, -1.0),
        rapid=np.zeros(count, dtype=bool), lines=np.zeros(count, dtype=np.int32),
    )  # fmt: skip


def scene(robot):
    path = path_of([EYE, EYE])
    return core.ArmScene(robots.arm_of(robot), path, collision.arm_bodies(robot), EYE, EYE)


def in_front(arm, floor, random):
    """A place of the flange before the robot that looks away from it, down or aside."""
    size, frame = arm.length, np.eye(4)
    frame[:3, 3] = random.uniform([0.45, -0.5, 0.3], [1.0, 0.5, 1.1]) * size + [0, 0, floor]
    z = random.uniform([-0.3, -0.7, -1.0], [1.0, 0.7, 0.3])
    z /= np.linalg.norm(z)
    x = np.cross(z, random.normal(size=3))
    x /= np.linalg.norm(x)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    return frame


@pytest.mark.parametrize("preset", [one["id"] for one in library.robots()])
def test_no_preset_meets_itself_where_robots_work(preset):
    robot = robots.checked({"preset": preset})
    arm, of = robots.arm_of(robot), scene(robot)
    floor, random = robots.model_of(robot)["floor_mm"], np.random.default_rng(1)
    found, met = 0, []
    for _ in range(400):
        for q in arm.inverse(in_front(arm, floor, random), np.zeros(6)):
            if (q >= arm.lower).all() and (q <= arm.upper).all():
                found += 1
                met += [one for one in [of.within(q, 0.0) or of.inside(q)] if one]
    assert found > 300
    if not preset.startswith("ur"):
        assert not met
    else:  # whose wrists go round, through the forearm too: so do their makers' meshes
        assert {one[:2] for one in met} <= {("robot link 3", "robot link 6")}
        assert len(met) < 0.02 * found
    if preset != "kuka_kr210_r2700_extra":  # whose limits hardly let it
        # And it is looked at: somewhere the arm folds into itself.
        postures = random.uniform(arm.lower, arm.upper, (500, 6))
        assert any(of.within(q, 0.0) for q in postures)


def test_a_urdfs_own_bodies_are_looked_at(tmp_path):
    foot = body('<box size="0.3 0.3 0.3"/>', origin='<origin xyz="0 0 0.15"/>')
    parts = {0: foot, 4: body('<box size="0.1 0.1 0.1"/>', origin='<origin xyz="0.4 0 0"/>')}
    robot = urdf_robot(tmp_path, urdf(parts))
    of = scene(robot)
    assert of.within(np.radians(FOLDED), 0.0)[:2] == ("robot foot", "robot link 4")
    assert of.within(np.zeros(6), 0.0) is None
    assert collision.links_left_out(robot, collision.arm_bodies(robot)) == []
    # Where a body is so rough that it always touches, the pair is left out, and named.
    rough = {**parts, 3: body('<sphere radius="1.2"/>')}
    robot = urdf_robot(tmp_path, urdf(rough))
    fact = collision.links_left_out(robot, collision.arm_bodies(robot))
    assert [(one.code, one.arguments["pairs"]) for one in fact] == [("cell.links_left_out", "0/3")]
    assert scene(robot).within(np.zeros(6), 0.0) is None


def test_a_whole_program_is_followed_against_the_arm_itself():
    robot = {**KUKA, "start_joints_deg": FOLDED}
    job = cell(robot)
    arm = robots.arm_of(job["robot"])
    base = robots.robot_frame(job["robot"], "base_from_robot")
    tool = robots.robot_frame(job["robot"], "flange_from_tcp")

    def told(joints):
        frames = [
            base @ arm.forward(np.radians([joints[0] + k, *joints[1:]])) @ tool for k in range(10)
        ]
        given = {**job["robot"], "start_joints_deg": joints}
        found = arm_check.follow(path_of(frames), given, job)
        return [e["bodies"] for e in found["events"] if e["kind"] == "collision"], found["pairs"]

    met, pairs = told(FOLDED)
    assert ["robot foot", "robot link 4"] in met
    assert {"bodies", "distance"} <= set(pairs[0])
    met, pairs = told([60, -90, 90, 0, 60, 0])
    assert met == []
    least = {tuple(one["bodies"]): one["distance"] for one in pairs}
    assert least["robot foot", "robot link 4"] > 100.0
