"""The robot: presets against their dimensions, and what its joints meet along a job's programs."""

import copy
import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.base import frames
from beltgrinding.job import poses
from beltgrinding.presets import library as presets, robot_model, robot as robots
from beltgrinding.cell import reach
from beltgrinding.job import load as jobs
from beltgrinding.cell import tool_path as tool_paths

ROOT = Path(__file__).resolve().parents[2]

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
FILE = ROOT / "Resources" / "presets" / "robots.json"
ROBOTS = json.loads(FILE.read_text(encoding="utf-8"))["robots"]
IDS = [one["id"] for one in ROBOTS]
# mm from axis 1 to the middle of the wrist at most, as the makers' data sheets have it.
DATA_SHEETS = {
    "kuka_kr6_r900": 901.5,
    "kuka_kr16_2": 1610,
    "kuka_kr210_r2700_extra": 2696,
    "abb_irb1200_5_90": 901,
    "abb_irb4600_60_205": 2050,
    "fanuc_m20ia": 1811,
    "yaskawa_gp25": 1730,
    "staubli_tx90": 900,
}
# The flange's position at all angles 0, from the dimensions in the data sheets' drawings.
AT_ZERO = {
    "kuka_kr6_r900": (25 + 455 + 420 + 80, 0, 400 + 35),
    "kuka_kr16_2": (260 + 680 + 670 + 158, 0, 675 - 35),
    "kuka_kr210_r2700_extra": (350 + 1150 + 1200 + 215, 0, 675 - 41),
    "abb_irb1200_5_90": (451 + 82, 0, 399.1 + 448 + 42),
    "abb_irb4600_60_205": (175 + 960 + 135, 0, 495 + 900 + 175),
    "fanuc_m20ia": (150 + 835 + 100, 0, 790 + 250),
    "yaskawa_gp25": (150 + 795 + 100, 0, 760 + 200),
    "staubli_tx90": (50, 50, 425 + 425 + 100),
    "ur5e": (-817.2, -133.3 - 99.6, 162.5 - 99.7),
    "ur10e": (-612.7 - 571.55, -174.15 - 116.55, 180.7 - 119.85),
}


def rotation(axis, angle):
    """3 x 3, after Rodrigues; written here so that it is not the program's own."""
    x, y, z = np.array(axis, dtype=float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def moved(x=0.0, y=0.0, z=0.0, turn=None):
    frame = np.eye(4)
    frame[:3, 3] = x, y, z
    if turn is not None:
        frame[:3, :3] = turn
    return frame


def links(preset, q):
    """Frames of the six joints and the flange at q (6,) in radian, link by link from the file."""
    model = preset["model"]
    theta = np.array(q, dtype=float)
    theta[2] += model.get("coupling", 0) * theta[1]
    at, found = np.eye(4), []
    for joint, angle in zip(model["joints"], theta):
        if model.get("convention", "urdf") == "urdf":
            assert "rpy_deg" not in joint
            at = at @ moved(*joint["origin_mm"]) @ moved(turn=rotation(joint["axis"], angle))
            found.append(at)
        else:
            found.append(at)
            at = at @ moved(turn=rotation((0, 0, 1), angle)) @ moved(z=joint["d_mm"])
            twist = rotation((1, 0, 0), math.radians(joint["alpha_deg"]))
            at = at @ moved(joint["a_mm"]) @ moved(turn=twist)
    if "joint6_from_flange" in model:
        a, b, c = (math.radians(angle) for angle in model["joint6_from_flange"]["abc_deg"])
        turn = rotation((0, 0, 1), a) @ rotation((0, 1, 0), b) @ rotation((1, 0, 0), c)
        at = at @ moved(*model["joint6_from_flange"]["position_mm"], turn=turn)
    return [*found, at]


def limits(preset):
    joints = preset["model"]["joints"]
    return np.radians([[j["lower_deg"], j["upper_deg"]] for j in joints]).T


def test_the_file_is_right_and_names_its_sources():
    assert presets.problems() == []
    data = json.loads(FILE.read_text(encoding="utf-8"))
    assert {one["source"] for one in data["robots"]} == set(data["sources"])
    assert [one["id"] for one in presets.robots()] == IDS
    makers = {one["name"].split()[0] for one in data["robots"]}
    assert {"KUKA", "ABB", "Fanuc", "Yaskawa", "Universal", "Stäubli"} == makers
    for one in data["robots"]:
        assert all(joint["max_speed_deg_s"] > 0 for joint in one["model"]["joints"])


def test_the_users_own_robots_are_read_and_wrong_ones_named(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    folder = tmp_path / "beltgrinding" / "presets"
    folder.mkdir(parents=True)
    model = ROBOTS[0]["model"]
    own = {"id": "ours", "name": "Ours", "source": "book", "model": model}
    short = {**own, "id": "short", "model": {"joints": model["joints"][:5]}}
    rumour = {**own, "id": "rumour", "source": "rumour"}
    typo = {**own, "id": "typo", "model": {"joint": []}}
    none = {**own, "id": "none", "model": {}}
    data = {
        "schema": 1,
        "sources": {"book": {"author": "A", "title": "B"}},
        "robots": [own, short, rumour, typo, none],
    }
    (folder / "ours.json").write_text(json.dumps(data))
    assert presets.robots()[-1]["id"] == "ours"
    assert robot_model.arm(robots.load_preset("ours")).structure == "spherical_wrist"
    told = [str(problem) for problem in presets.problems()]
    assert len(told) == 4
    for text, where in zip(told, ("6 joints, not 5", "'rumour' is not", "'joints'", "six joints")):
        assert "ours.json: robots." in text and where in text


@pytest.mark.parametrize("preset", ROBOTS, ids=IDS)
def test_a_preset_has_the_dimensions_of_the_data_sheet(preset):
    flange = links(preset, np.zeros(6))[6][:3, 3]
    assert flange == pytest.approx(AT_ZERO[preset["id"]], abs=1e-9)
    if preset["id"] not in DATA_SHEETS:
        return
    low, high = (side[1:3] for side in limits(preset))
    best, span, centre = 0.0, (high - low) / 2, (high + low) / 2
    for _ in range(4):  # finer around the best
        for q2 in np.clip(np.linspace(-1, 1, 21) * span[0] + centre[0], low[0], high[0]):
            for q3 in np.clip(np.linspace(-1, 1, 21) * span[1] + centre[1], low[1], high[1]):
                wrist = links(preset, [0, q2, q3, 0, 0, 0])[4][:3, 3]
                if math.hypot(wrist[0], wrist[1]) > best:
                    best, found = math.hypot(wrist[0], wrist[1]), np.array([q2, q3])
        span, centre = span / 5, found
    assert best == pytest.approx(DATA_SHEETS[preset["id"]], abs=2.0)


@pytest.mark.parametrize("preset", ROBOTS, ids=IDS)
def test_forward_agrees_with_the_links_one_by_one(preset):
    arm = robot_model.arm(robots.load_preset(preset["id"]))
    random = np.random.default_rng(1)
    for q in random.uniform(*limits(preset), (50, 6)):
        assert arm.forward(q) == pytest.approx(links(preset, q)[6], abs=1e-9)


@pytest.mark.parametrize("preset", ROBOTS, ids=IDS)
def test_inverse_gives_all_that_forward_takes_back(preset):
    arm = robot_model.arm(robots.load_preset(preset["id"]))
    assert arm.structure == (
        "parallel_elbow" if "dh" in str(preset["model"]) else "spherical_wrist"
    )
    random, most, worst = np.random.default_rng(2), 0, 0.0
    for q in random.uniform(*limits(preset), (400, 6)):
        pose = links(preset, q)[6]
        found = arm.inverse(pose, q)
        most = max(most, len(found))
        worst = max(worst, max(np.abs(arm.forward(one) - pose).max() for one in found))
        assert np.abs(found - q).max(axis=1).min() < 1e-6
        turns = (found[:, None] - found[None]) / (2 * math.pi)
        apart = np.abs(turns - np.round(turns)).max(axis=2)
        assert (apart[~np.eye(len(found), dtype=bool)] > 1e-6).all()
    assert most == 8 and worst < 1e-6


def test_a_fanuc_measures_its_third_joint_from_the_ground():
    arm = robot_model.arm(robots.load_preset("fanuc_m20ia"))
    for q2 in (-0.5, 0.0, 1.0):
        forward = arm.forward(np.array([0, q2, 0, 0, 0, 0]))[:3, :3] @ [0, 0, 1]
        assert forward == pytest.approx([1, 0, 0])


def pose_row(frame, **more):
    w, x, y, z = frames.to_quaternions(frame[None, :3, :3])[0].tolist()
    x_mm, y_mm, z_mm = frame[:3, 3].tolist()
    keys = {"x_mm": x_mm, "y_mm": y_mm, "z_mm": z_mm, "qw": w, "qx": x, "qy": y, "qz": z}
    return {**keys, **more}


def square():
    """A faceted square of 60 mm in x-y."""
    corners = np.array([[0, 0, 0], [60, 0, 0], [60, 60, 0], [0, 60, 0]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    return core.shape_from_mesh(core.TriangleMesh(corners, triangles))


def cell(**keys):
    """A job over a plate that lies in front of a KR 16, whose flange carries a wheel."""
    down = frames.from_abc([0, 0, 0.2], [0, 0, 180])
    rows = []
    for x in (10.0, 50.0):
        frame = down.copy()
        frame[:2, 3] = x, 30.0
        rows.append(pose_row(frame, feed_mm_s=30, line=len(rows) + 7))
    # The base frame of the program lies 1000 mm before and 200 mm above the robot's.
    base = {"position_mm": [-1000, 0, -200]}
    return {
        "design": {"brep": square().write_brep()},
        "sampling": {"spacing_mm": 1.0},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "robot": {
            "preset": "kuka_kr16_2",
            "base_from_robot": base,
            "flange_from_tcp": {"position_mm": [0, 0, 150]},
            **keys,
        },
        "programs": [{"poses": rows}],
    }


def test_a_job_within_reach_has_no_events_of_the_robot():
    result = beltgrinding.run(cell())
    assert not set(result.summary["events"]) & set(reach.EVENTS)
    figures = result.summary["robot"]
    assert figures["name"] == "kuka_kr16_2" and figures["poses"] == figures["reached_poses"] == 2
    assert figures["inverse_kinematics"] == "spherical_wrist"
    assert 0 < figures["least_margin_deg"] < 350
    assert result.summary["wall_time_s"]["reach"] > 0


def test_joints_lead_back_to_the_poses():
    job = jobs.validate(cell())
    path = tool_paths.tool_path(job, 0, [])
    (found,) = reach.job_reach(job, [path])
    assert found["joints"].shape == (2, 6)
    back = np.array([robots.pose_function(job["robot"])(q) for q in found["joints"]])
    wanted = poses.program_arrays(job["programs"][0], "", [])["frames"]
    assert back == pytest.approx(wanted, abs=1e-9)


def test_without_a_robot_nothing_is_checked():
    job = cell()
    del job["robot"]
    result = beltgrinding.run(job)
    assert result.summary["robot"] == {} and "singularity" not in result.summary["events"]


def test_a_job_out_of_reach_says_so_and_grinds_all_the_same():
    job = cell(base_from_robot={"position_mm": [-2500, 0, -200]})
    result = beltgrinding.run(job)
    assert result.summary["removed_volume_mm3"] > 1
    events = [event for event in result.events if event["kind"] == "out_of_reach"]
    assert len(events) == 1
    event = events[0]
    assert event["program"] == 0 and event["pose"] == 0 and event["line"] == 7
    assert event["value"] > 500 and "mm are missing" in event["message"]
    assert event["duration"] == pytest.approx(40 / 30)
    assert result.summary["robot"]["reached_poses"] == 0
    json.dumps(result.summary, allow_nan=False)


def test_an_own_model_is_taken_like_a_preset():
    model = copy.deepcopy(next(one for one in ROBOTS if one["id"] == "kuka_kr16_2")["model"])
    own = jobs.validate(cell(preset="", model=model))
    (a,) = reach.job_reach(own, [tool_paths.tool_path(own, 0, [])])
    known = jobs.validate(cell())
    (b,) = reach.job_reach(known, [tool_paths.tool_path(known, 0, [])])
    assert (a["joints"] == b["joints"]).all()
    model["joints"][5]["upper_deg"] = 100
    model["joints"][5]["lower_deg"] = 90
    narrow = jobs.validate(cell(preset="", model=model))
    (c,) = reach.job_reach(narrow, [tool_paths.tool_path(narrow, 0, [])])
    (event,) = c["events"]
    assert event["kind"] == "joint_limit" and "joint 6" in event["message"]


def test_the_start_chooses_the_configuration():
    job = jobs.validate(cell())
    path = tool_paths.tool_path(job, 0, [])
    arm = robots.arm_of(job["robot"])
    first = np.radians(reach.job_reach(job, [path])[0]["joints"][0])
    other = next(
        q
        for q in arm.inverse(arm.forward(first), np.zeros(6))
        if np.abs(q - first).max() > 1 and (q > arm.lower).all() and (q < arm.upper).all()
    )
    job["robot"]["start_joints_deg"] = np.degrees(other + 0.01).tolist()
    found = reach.job_reach(job, [path])[0]
    assert np.radians(found["joints"][0]) == pytest.approx(other, abs=1e-9)


@pytest.mark.parametrize(
    "keys, message",
    [
        ({"preset": "kuka_kr16"}, "did you mean 'kuka_kr16_2'"),
        ({"presets": "x"}, "did you mean 'preset'"),
        ({"start_joints_deg": [0, 0]}, "2 angles; give six"),
        ({"model": {"joints": [{"lower_deg": -9, "upper_deg": 9}]}}, "not both"),
        (
            {"preset": "", "model": {"joints": [{"lower_deg": -9, "upper_deg": 9}]}},
            "6 joints, not 1",
        ),
        (
            {"preset": "", "model": {"joints": 6 * [{"lower_deg": 9, "upper_deg": -9}]}},
            "joint 1: its lower limit",
        ),
        (
            {
                "preset": "",
                "model": {"joints": 6 * [{"lower_deg": -9, "upper_deg": 9, "a_mm": 5}]},
            },
            "'a_mm' has no meaning in the convention urdf",
        ),
        (
            {
                "preset": "",
                "model": {
                    "convention": "standard_dh",
                    "joints": 6 * [{"lower_deg": -9, "upper_deg": 9, "rpy_deg": [0, 0, 9]}],
                },
            },
            "'rpy_deg' has no meaning in the convention standard_dh",
        ),
        ({"flip_deg": 0}, "flip_deg"),
    ],
)
def test_a_wrong_robot_is_named(keys, message):
    with pytest.raises(InputError, match=message):
        jobs.validate(cell(**keys))


def test_a_wrong_frame_of_the_robot_is_named():
    job = jobs.validate(cell(flange_from_tcp={"quaternion_wxyz": [1, 1, 0, 0]}))
    with pytest.raises(InputError, match="robot.flange_from_tcp: the quaternion"):
        reach.job_reach(job, [tool_paths.tool_path(job, 0, [])])


PROGRAMS = {
    "p.src": """DEF p()
$VEL.CP=0.1
PTP {A1 10, A2 -80, A3 90, A4 20, A5 60, A6 30, E1 0}
LIN {X 0, Y 0, Z 0, A 0, B 0, C 180}
LIN {X 20, Y 0, Z 0, A 0, B 0, C 180}
END
""",
    "p.mod": """MODULE m
CONST jointtarget home := [[10, -80, 90, 20, 60, 30], [9E9, 9E9, 9E9, 9E9, 9E9, 9E9]];
PROC main()
MoveAbsJ home, v100, fine, tool0;
MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0;
MoveL [[20,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0;
ENDPROC
ENDMODULE
""",
    "p.script": """def p():
movej([d2r(10), d2r(-80), d2r(90), d2r(20), d2r(60), d2r(30)])
movel(p[0, 0, 0, 3.141592653589793, 0, 0])
movel(p[0.02, 0, 0, 3.141592653589793, 0, 0])
end
""",
}


@pytest.mark.parametrize("file", PROGRAMS)
def test_joint_targets_are_poses_once_the_robot_is_known(file, tmp_path):
    (tmp_path / file).write_text(PROGRAMS[file])
    home = [10, -80, 90, 20, 60, 30]
    # The robot stands where its home is near the program's first pose.
    arm = robot_model.arm(robots.load_preset("kuka_kr16_2"))
    wanted = frames.from_abc([0, 0, 50], [0, 0, 180]) @ np.linalg.inv(arm.forward(np.radians(home)))
    turn = frames.to_quaternions(wanted[None, :3, :3])[0].tolist()
    base = {"position_mm": wanted[:3, 3].tolist(), "quaternion_wxyz": turn}
    job = cell(base_from_robot=base)
    del job["robot"]["flange_from_tcp"]
    job["programs"] = [{"file": str(tmp_path / file)}]
    job = jobs.validate(job)
    warnings = []
    path = tool_paths.tool_path(job, 0, warnings)
    assert len(path) == 3 and warnings == []
    assert path.work_from_contact()[0][:3, 3] == pytest.approx([0, 0, 50], abs=1e-9)
    (found,) = reach.job_reach(job, [path])
    assert found["joints"][0] == pytest.approx(home, abs=1e-6)  # as programmed, not the best
    assert np.abs(found["joints"][1] - home).max() < 30
    job["robot"] = jobs.validate({**cell(), "robot": {}})["robot"]
    assert len(tool_paths.tool_path(job, 0, warnings)) == 2


def run(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", "reach", *map(str, arguments)],
        cwd=ROOT / "Mod" / "BeltGrinding",
        env={**os.environ, "XDG_CONFIG_HOME": str(folder)},
        capture_output=True,
        text=True,
    )


def test_the_command_line_writes_the_joints(tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(cell()))
    done = run(tmp_path, tmp_path / "job.json", "-o", tmp_path / "joints.csv")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["events"] == [] and told["reached_poses"] == 2
    rows = list(csv.DictReader((tmp_path / "joints.csv").open()))
    assert [(row["program"], row["pose"], row["line"]) for row in rows] == [
        ("1", "1", "7"),
        ("1", "2", "8"),
    ]
    job = jobs.validate(cell())
    angles = [[float(row[f"j{k}_deg"]) for k in range(1, 7)] for row in rows]
    found = robots.pose_function(job["robot"])(angles[0])
    assert found[:3, 3] == pytest.approx([10, 30, 0.2], abs=1e-3)
    bare = cell()
    del bare["robot"]
    (tmp_path / "bare.json").write_text(json.dumps(bare))
    wrong = run(tmp_path, tmp_path / "bare.json")
    assert wrong.returncode == 2 and "names no robot" in wrong.stderr
    nowhere = run(tmp_path, tmp_path / "job.json", "-o", tmp_path / "no" / "joints.csv")
    assert nowhere.returncode == 2 and "cannot be written" in nowhere.stderr


def test_unreached_poses_are_empty_in_the_table(tmp_path):
    job = cell(base_from_robot={"position_mm": [-2500, 0, -200]})
    (tmp_path / "job.json").write_text(json.dumps(job))
    done = run(tmp_path, tmp_path / "job.json", "-o", tmp_path / "joints.csv")
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader((tmp_path / "joints.csv").open()))
    assert [row["j1_deg"] for row in rows] == ["", ""]
    assert "joint_range_deg" not in json.loads(done.stdout)


CRS = SHARED / "data" / "programs" / "same_path_crs_part5" / "crs_part5.src"


@pytest.mark.slow
@pytest.mark.skipif(not CRS.is_file(), reason=f"no shared data at {SHARED}")
def test_a_real_program_of_423_targets_beside_a_large_robot():
    """A place for the robot beside the part, found by trying, and one that is 500 mm higher."""
    arrays = poses.program_arrays({"file": str(CRS)}, "", [])
    path = core.ToolPath(**arrays)

    def found(height):
        return reach.reach(
            path,
            {
                "preset": "kuka_kr210_r2700_extra",
                "base_from_robot": {"position_mm": [-830, -1385, height], "abc_deg": [63, 0, 0]},
                "flange_from_tcp": {"position_mm": [12.5, 0, 287.35]},
            },
        )

    good = found(-470)
    assert good["events"] == []
    assert len(good["joints"]) >= 423 and np.isfinite(good["joints"]).all()
    job = {"base_from_robot": {"position_mm": [-830, -1385, -470], "abc_deg": [63, 0, 0]}}
    job = robots.checked(
        {
            "preset": "kuka_kr210_r2700_extra",
            "flange_from_tcp": {"position_mm": [12.5, 0, 287.35]},
            **job,
        }
    )
    back = np.array([robots.pose_function(job)(q) for q in good["joints"]])
    assert back == pytest.approx(arrays["frames"], abs=1e-6)
    high = found(50)
    kinds = {event["kind"] for event in high["events"]}
    assert {"joint_limit", "singularity", "joint_speed"} <= kinds
    lines = {event["line"] for event in high["events"]}
    assert min(lines) > 0
    # Where an event says that a limit is passed, an angle at a pose nearby does so.
    limit = max(
        (event for event in high["events"] if event["kind"] == "joint_limit"),
        key=lambda event: event["duration"],
    )
    assert limit["duration"] > 1 and limit["value"] > 0
