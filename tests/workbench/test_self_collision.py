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
# Share of these postures in which the collision meshes of Universal_Robots_ROS2_Description cross, which the tubes surround:
# measured; in none of 95 such postures were the tubes free.
MESHES_MEET = {"ur5e": 0.032, "ur10e": 0.065}


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
        assert MESHES_MEET[preset] < len(met) / found < 0.14
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


# Extents of the collision meshes in Universal_Robots_ROS2_Description (14 October 2024), mm, in the robot's base at joint
# angles 0: foot, links 1 to 6.
MEASURED = {
    "ur5e": (
        (-75.5, -75.5, 0.0, 75.5, 75.5, 99.1), (-60.1, -74.4, 98.6, 60.1, 60.1, 234.0),
        (-484.6, -209.9, 102.4, 60.6, -60.2, 222.6), (-856.1, -60.4, 104.5, -366.6, 49.5, 220.3),
        (-856.5, -171.9, 108.9, -777.8, -59.7, 218.8), (-856.5, -186.4, 23.7, -777.8, -76.6, 108.9),
        (-854.7, -233.0, 19.3, -779.6, -187.1, 100.8),
    ),
    "ur10e": (
        (-95.0, -94.9, 0.0, 94.9, 94.9, 99.3), (-76.4, -94.6, 99.0, 76.4, 76.4, 274.6),
        (-672.4, -269.4, 104.3, 76.7, -94.8, 257.1), (-1230.3, -106.0, 122.7, -553.9, 18.8, 238.7),
        (-1231.2, -221.3, 114.1, -1137.3, -105.9, 238.2), (-1231.2, -242.1, 14.4, -1137.2, -117.2, 114.3),
        (-1228.7, -290.6, 9.3, -1139.9, -241.8, 106.7),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MEASURED)
def test_a_measured_arm_is_as_large_as_its_meshes(name):
    robot = robots.checked({"preset": name})
    bodies = collision.arm_bodies(robot)
    assert [one["link"] for one in bodies] == list(range(7))
    for one, extents in zip(bodies, np.array(MEASURED[name])):
        points = one["mesh"].vertices
        assert (points.min(axis=0) <= extents[:3] + 0.1).all(), one["name"]
        assert (points.max(axis=0) >= extents[3:] - 0.1).all(), one["name"]
        spare = np.concatenate([extents[:3] - points.min(axis=0), points.max(axis=0) - extents[3:]])
        assert spare.max() < 60.0, one["name"]  # nor much larger
    # Radii of the job go before it; an elbow that is folded back meets the arm.
    thin = robots.links_of({**robot, "link_radii_mm": [1.0] * 7})
    assert np.ptp(thin[0][0][0][:, 0]) < 3.0
    of = scene(robot)
    assert of.within(np.radians([0, -90, 90, -90, -90, 0]), 0.0) is None
    assert of.within(np.radians([0, -90, 170, -90, -90, 0]), 0.0) is not None


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
