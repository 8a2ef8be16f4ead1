"""Programs for the whole robot: from home to home, free, within limits, read again; checked by KDL."""

import json
import math
import re
import subprocess

import numpy as np
import pytest
import PyKDL
from test_collision import brep
from test_raster import X, job_of, plate
from test_robot import pose_row

from beltgrinding.base import frames
from beltgrinding.cli import robot_program as command
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, poses
from beltgrinding.job.workpiece import read_design
from beltgrinding.planning import commands, rounds
from beltgrinding.presets import library, robot as robots
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers import fanuc, inform, krl, rapid
from beltgrinding.programs.program import Posture
from beltgrinding.raster import raster_path as raster
from beltgrinding.robot_program import (
    corners,
    lifts,
    linking,
    passes,
    scenes,
    whole as wholes,
    write as writing,
)
from beltgrinding.job.typed import typed
from support.freecad import ROOT

HOME = [60, -90, 90, 0, 60, 0]  # to the side: the post stands between it and the plate
POST = {"name": "post", "frame": "base", "brep": brep([-70, -290, -350], [-10, -230, 350])}
TOOL = {"position_mm": [0, 0, 150]}
KUKA = {
    "preset": "kuka_kr6_r900",
    "base_from_robot": {"position_mm": [-450, 30, -350]},
    "flange_from_tcp": TOOL,
}
UR = {"preset": "ur10e", "base_from_robot": {"position_mm": [-550, 30, -300]}, "flange_from_tcp": TOOL}  # fmt: skip


def cell(robot=KUKA, bodies=(), laid=None, **program):
    """A validated job: a plate under three passes of a wheel in the robot's hand."""
    wanted = {**robot, "program": {"home_joints_deg": HOME, **program}}
    job = job_of(plate(), robot=wanted, cell={"bodies": list(bodies)})
    laid = laid or raster.raster(job, {**X, "step_over_mm": 20, "feed_mm_s": 40})
    listed = poses.list_poses(laid)
    return {**job, "programs": [{"name": "raster", "poses": listed, "unresolved": 0}]}


@pytest.fixture(scope="module")
def laid():
    return raster.raster(job_of(plate()), {**X, "step_over_mm": 20, "feed_mm_s": 40})


def chain(preset, tool):
    """KDL's chain of a preset, metres for millimetres left out: it knows no unit."""
    made = PyKDL.Chain()
    model = library.find("robots", preset)["model"]
    for joint in model["joints"]:
        at, axis = PyKDL.Vector(*joint["origin_mm"]), PyKDL.Vector(*joint["axis"])
        made.addSegment(
            PyKDL.Segment(PyKDL.Joint("", at, axis, PyKDL.Joint.RotAxis), PyKDL.Frame(at))
        )
    flange = frames.from_data(model.get("joint6_from_flange")) @ tool
    turn = PyKDL.Rotation(*flange[:3, :3].ravel().tolist())
    end = PyKDL.Frame(turn, PyKDL.Vector(*flange[:3, 3].tolist()))
    made.addSegment(PyKDL.Segment(PyKDL.Joint(PyKDL.Joint.Fixed), end))
    return made


def forward(of, joints_deg):
    q = PyKDL.JntArray(6)
    for k, angle in enumerate(joints_deg):
        q[k] = math.radians(angle)
    found = PyKDL.Frame()
    PyKDL.ChainFkSolverPos_recursive(of).JntToCart(q, found)
    frame = np.eye(4)
    frame[:3, :3] = [[found.M[i, k] for k in range(3)] for i in range(3)]
    frame[:3, 3] = list(found.p)
    return frame


def numbers(text, names):
    return [float(re.search(rf"[{{,]{n} ([-+.\dE]+)", text)[1]) for n in names]


def finer(job, whole):
    """No body meets another at places ten times as close as the program was planned by: 0.1 mm and 0.1 degrees."""
    job = typed(job)
    from beltgrinding.cell import tool_path
    from beltgrinding.job.workpiece import read_design

    path = tool_path.tool_path(job, 0, [])
    of = scenes.of_job(job, read_design(job.design), path, [], None)
    at = None
    for move in whole.moves:
        q = np.radians(move.joints_deg)
        if at is not None and move.kind == "PTP":
            count = max(1, math.ceil(np.degrees(np.abs(q - at)).max() / 0.1))
            for k in range(count + 1):
                assert of.links.within(at + (q - at) * k / count, 0.0) is None
        elif at is not None:
            way, gets_there = of.passes.straight_way(at, move.frame, 0.1, 0.002)
            assert gets_there and np.abs(way[-1] - q).max() < 1e-6
            assert all(of.passes.within(one, 0.0) is None for one in way[::4])
        at = q


def test_a_program_goes_from_home_to_home_and_kdl_agrees(laid, tmp_path):
    job, file = cell(laid=laid, bodies=[POST]), tmp_path / "whole.src"
    whole = writing.plan_job(job)
    assert not whole.problems and whole.figures["passes"] == len(laid["passes"])
    assert whole.figures["links_round"] >= 1  # the post stands in the way
    assert whole.figures["link_clearance_mm"] == pytest.approx(5.0)
    writing.write(file, job, whole)
    text = file.read_text()
    motions = re.findall(r"^(PTP|LIN) (\{.*\})", text, re.MULTILINE)
    assert len(motions) == len(whole.moves)
    for kind, target in (motions[0], motions[-1]):
        assert kind == "PTP" and numbers(target, [f"A{k}" for k in range(1, 7)]) == HOME
    assert [text.count(f"; pass {k}\n") for k in range(1, len(laid["passes"]) + 1)] == [1] * len(
        laid["passes"]
    )
    tool, base = (
        frames.from_abc(*np.split(np.array(numbers(re.search(rf"^\{v}=(.*)", text, re.M)[1].replace("FRAME: ", ""), "XYZABC")), 2))
        for v in ("$TOOL", "$BASE")
    )  # fmt: skip
    assert tool[:3, 3] == pytest.approx([0, 0, 150]) and base[:3, 3] == pytest.approx(
        [450, -30, 350]
    )
    of = chain("kuka_kr6_r900", tool)
    for move, (kind, target) in zip(whole.moves, motions):
        if kind == "PTP":
            joints = numbers(target, [f"A{k}" for k in range(1, 7)])
            assert joints == pytest.approx(move.joints_deg, abs=1e-5)
            continue
        values = np.array(numbers(target, "XYZABC"))
        written = base @ frames.from_abc(values[:3], values[3:])
        assert np.abs(forward(of, move.joints_deg) - written).max() < 1e-4
        status, turn = (int(one) for one in numbers(target, "ST"))
        assert turn == sum(2**k for k, one in enumerate(move.joints_deg) if one < 0)
        assert bool(status & 4) == (move.joints_deg[4] < 0)
        assert not status & 1  # the wrist is before axis 1
        assert bool(status & 2) == (move.joints_deg[2] > math.degrees(math.atan2(35, 420)))
    again = writing.joints_of_file(file, job)
    wanted = np.stack([move.joints_deg for move in whole.moves])
    assert np.abs(again - wanted).max() < 1e-3
    finer(job, whole)


@pytest.mark.slow
def test_the_same_seed_plans_the_same_program(laid):
    job = cell(laid=laid, bodies=[POST])
    moves = [writing.plan_job(job).moves for _ in range(2)]
    for one, other in zip(*moves, strict=True):
        assert one.kind == other.kind and (one.frame == other.frame).all()
        assert (one.joints_deg == other.joints_deg).all()


ABB = {**KUKA, "preset": "abb_irb1200_5_90"}
FANUC = {**KUKA, "preset": "fanuc_m20ia", "base_from_robot": {"position_mm": [-900, 30, -400]}}
YASKAWA = {**FANUC, "preset": "yaskawa_gp25"}


@pytest.mark.parametrize(
    "name, robot, home",
    [
        ("whole.mod", ABB, [60, 0, 0, 0, 60, 0]),
        ("whole.script", KUKA, HOME),
        ("whole.ls", FANUC, [60, 0, 0, 0, -60, 0]),
        ("whole.jbi", YASKAWA, [60, 0, 0, 0, -60, 0]),
    ],
)
def test_other_languages_have_their_joints_and_configurations(name, robot, home, laid, tmp_path):
    job, file = cell(robot, laid=laid, home_joints_deg=home), tmp_path / name
    whole = writing.plan_job(job)
    assert not whole.problems
    frame = {"tools": "1", "bases": "1"} if name.endswith(("ls", "jbi")) else {}
    writing.write(file, job, whole, **frame)
    text = file.read_text()
    if name == "whole.mod":
        assert text.count("MoveAbsJ [[") == sum(move.kind == "PTP" for move in whole.moves)
        linear = [m for m in whole.moves if m.kind == "LIN"]
        written = re.findall(r"MoveL .*?\],\[([-\d,]+)\],\[9", text)
        assert len(written) == len(linear)
        for move, found in zip(linear, written):
            cf = [math.floor(move.joints_deg[k] / 90) for k in (0, 3, 5)]
            # Before axis 1, before the lower arm.
            assert [int(one) for one in found.split(",")] == [*cf, int(move.joints_deg[4] < 0)]
    if name == "whole.jbi":
        types, now = [], None
        for line in text.splitlines():
            now = line[9:] if line.startswith("///RCONF") else now
            types += [now] if re.match(r"C\d+=", line) else []
        assert len(types) == len(whole.moves)
        for move, one in zip(whole.moves, types):  # before axis 1, the elbow up
            s, r, t = (move.joints_deg[k] for k in (0, 3, 5))
            turned = [int(abs(angle) > 180) for angle in (r, t, s)]
            flip = int(math.cos(math.radians(r)) < 0)
            assert [int(k) for k in one.split(",")] == [flip, 0, 0, *turned, 0, 0]
    if name == "whole.script":
        assert text.count("movej([") == sum(move.kind == "PTP" for move in whole.moves)
    if name.endswith((".mod", ".script")):
        wanted = np.stack([move.joints_deg for move in whole.moves])
        assert np.abs(writing.joints_of_file(file, job) - wanted).max() < 1e-3
    if name == "whole.ls":
        assert set(re.findall("CONFIG : '(. . .),", text)) == {"N U T"}
        turns = re.findall("CONFIG : '. . ., (.*)'", text)
        assert [int(one.split(",")[2]) for one in turns] == [
            math.floor((move.joints_deg[5] + 180) / 360) for move in whole.moves
        ]
    assert len(read_program(file).motions) == len(whole.moves)


def test_configurations_in_the_languages_words():
    front = Posture(behind=False, below=False, back=False, flipped=False)
    assert krl.status_and_turn(front, (1, -1, 1, -1, 1, 1)) == (2, 10)
    assert krl.status_and_turn(Posture(True, True, True, True), (1, 1, 1, 1, -1, 1)) == (5, 16)
    assert rapid.confdata(front, (10, 0, 0, -10, 5, 100)) == (0, -1, 1, 0)
    assert rapid.confdata(Posture(True, True, True, True), (-100, 0, 0, 190, -5, -190)) == (
        -2,
        2,
        -3,
        7,
    )
    assert inform.rconf(front, (0, 0, 0, 0, 5, 0)) == (0, 0, 0, 0, 0, 0)
    assert inform.rconf(front, (-190, 0, 0, 120, 5, 185)) == (1, 0, 0, 0, 1, 1)
    assert inform.rconf(Posture(True, False, True, False), (0, 0, 0, -300, 5, 180)) == (0, 0, 1, 1, 0, 0)  # fmt: skip
    assert inform.rconf(Posture(False, True, True, False), (0, 0, 0, -90, 5, -180)) == (1, 1, 0, 0, 1, 0)  # fmt: skip
    assert fanuc.config(front, (0, 0, 0, 200, -5, -200)) == "N U T, 0, 1, -1"


def test_arms_of_universal_robots_are_planned_too(laid, tmp_path):
    job = cell(UR, laid=laid, home_joints_deg=[0, -90, -90, -90, 90, 0])
    whole = writing.plan_job(job)
    assert not whole.problems
    file = tmp_path / "whole.script"
    writing.write(file, job, whole)
    wanted = np.stack([move.joints_deg for move in whole.moves])
    assert np.abs(writing.joints_of_file(file, job) - wanted).max() < 1e-3


def run(*arguments):
    return subprocess.run(
        [ROOT / "tools" / "beltgrind", "program", "robot", *map(str, arguments)],
        capture_output=True,
        text=True,
    )


@pytest.mark.slow
def test_what_collides_or_is_out_of_reach_is_not_written(laid, tmp_path):
    block = {"name": "block", "frame": "part", "brep": brep([45, 0, 20], [55, 60, 120])}
    given = tmp_path / "job.json"
    given.write_text(json.dumps(jobs_plain(cell(laid=laid, bodies=[block]))))
    file = tmp_path / "whole.src"
    done = run(given, "-o", file)
    assert done.returncode == 2 and not file.exists()
    assert "wheel and block" in done.stderr or "block and wheel" in done.stderr
    assert "pass 1" in done.stderr and "--unsafe" in done.stderr
    done = run(given, "-o", file, "--unsafe")
    assert done.returncode == 0 and "UNSAFE" in file.read_text()
    far = {**KUKA, "base_from_robot": {"position_mm": [-1450, 30, -350]}}
    whole = writing.plan_job(cell(far, laid=laid))
    assert {fact.code for fact in whole.problems} == {"robot_program.out_of_reach"}
    with pytest.raises(InputError, match="out of the robot's reach"):
        writing.write(tmp_path / "far.src", cell(far, laid=laid), whole)
    assert not (tmp_path / "far.src").exists()


class Said:
    """The command line's options and messages, as far as a program in place of another needs them."""

    form, unsafe, force = "spline", False, False

    def __init__(self):
        self.messages, self.warnings = self, []

    def print_warnings(self, facts):
        self.warnings += facts

    print_written = print_warnings


def test_grind_puts_it_in_place_of_the_passes_or_leaves_those(laid, tmp_path):
    file, said = tmp_path / "raster.src", Said()
    file.write_text("the passes alone")
    job = cell(laid=laid)
    command.in_place_of(file, job, said)
    text = file.read_text()
    assert text.count("SPLINE\n") == 2 * len(laid["passes"])  # SPLINE and ENDSPLINE
    assert text.count("PTP {A1 60,") == 2
    wanted = np.stack([move.joints_deg for move in writing.plan_job(job).moves])
    assert np.abs(writing.joints_of_file(file, job) - wanted).max() < 1e-3
    block = {"name": "block", "frame": "part", "brep": brep([45, 0, 20], [55, 60, 120])}
    file.write_text("the passes alone")
    with pytest.raises(
        InputError, match="raster.src has the passes alone.* is not written: .*block"
    ):
        command.in_place_of(file, cell(laid=laid, bodies=[block]), said)
    assert file.read_text() == "the passes alone"
    assert any("block" in str(fact) for fact in said.warnings)


def test_a_plan_has_it_beside_its_programs(laid, tmp_path):
    job = cell(laid=laid)
    assert command.beside(tmp_path, ["raster.mod"], job, Said()) == tmp_path / "whole_robot.mod"
    assert "MoveAbsJ [[60,-90,90,0,60,0]" in (tmp_path / "whole_robot.mod").read_text()
    assert command.beside(tmp_path, ["raster.csv"], job, Said()).suffix == ".src"
    assert command.beside(tmp_path, [], cell(laid=laid, home_joints_deg=[]), Said()) is None
    (tmp_path / "whole_robot.src").write_text("of another")
    with pytest.raises(InputError, match="is there already"):
        command.beside(tmp_path, [], job, Said())


def jobs_plain(job):
    """What a job's file has of a validated job."""
    keys = ("design", "robot", "cell", "programs", "belt_machine")
    return {key: job[key] for key in keys}


def test_a_home_that_cannot_be_gets_one_line(laid):
    wall = {"name": "wall", "frame": "base", "brep": brep([-200, -300, 0], [-190, 300, 900])}
    with pytest.raises(InputError, match="home_joints_deg: .*wall.* are in each other"):
        writing.plan_job(cell(laid=laid, bodies=[wall], home_joints_deg=[0, -20, 20, 0, 60, 0]))
    with pytest.raises(InputError, match="joint 2 at 80.0 deg is beyond its limits"):
        writing.plan_job(cell(laid=laid, home_joints_deg=[0, 80, 90, 0, 60, 0]))
    with pytest.raises(InputError, match="needs a robot, and where it begins"):
        writing.plan_job(cell(laid=laid, home_joints_deg=[]))
    with pytest.raises(InputError, match="five|5 angles"):
        jobs.validate({**jobs_plain(cell(laid=laid)), "robot": {**KUKA, "program": {"home_joints_deg": [0] * 5}}})  # fmt: skip


def test_a_home_folded_into_itself_is_refused(laid):
    with pytest.raises(InputError, match="home_joints_deg: robot foot and robot link 4 are in"):
        writing.plan_job(cell(laid=laid, home_joints_deg=[90, 20, 140, 0, 0, 0]))
    with pytest.raises(InputError, match=r"safe_joints_deg\[0\]: robot foot and robot link 4 are"):
        writing.plan_job(cell(laid=laid, safe_joints_deg=[[90, 20, 140, 0, 0, 0]]))


def test_joints_accelerations_lower_feeds(laid):
    free = writing.plan_job(cell(laid=laid))
    slow = writing.plan_job(cell(laid=laid, joint_acceleration_deg_s2=[30] * 6))
    assert free.figures["slower"] == 0 and slow.figures["slower"] > 0
    feeds = [[m.feed for m in one.moves if m.kind == "LIN"] for one in (free, slow)]
    assert len(feeds[0]) == len(feeds[1])
    assert all(b <= a * (1 + 1e-9) for a, b in zip(*feeds)) and min(feeds[1]) < min(feeds[0])


def test_a_jerk_of_the_joints_lowers_feeds_and_is_kept(laid):
    most = 20.0  # degrees/s3
    free, slow = (
        wholes.plan(cell(laid=laid, joint_jerk_deg_s3=given), 0) for given in ([], [most] * 6)
    )

    def jerks(whole):
        """degrees/s3, by third differences over the four poses about each inner motion of a pass."""
        found, run = [], []
        for move in [*whole.moves, None]:
            if move is not None and move.kind == "LIN" and move.force >= 0.0:
                run.append(move)
                continue
            if len(run) > 3:
                at = np.stack([one.frame[:3, 3] for one in run])
                feeds = np.array([one.feed for one in run[1:]])
                seconds = np.linalg.norm(np.diff(at, axis=0), axis=1) / feeds
                speeds = np.diff([one.joints_deg for one in run], axis=0) / seconds[:, None]
                between = 0.5 * (seconds[1:] + seconds[:-1])
                turns = np.diff(speeds, axis=0) / between[:, None]
                found += np.abs(np.diff(turns, axis=0) / seconds[1:-1, None]).max(axis=1).tolist()
            run = []
        return np.array(found)

    assert free.figures["slower"] == 0 and slow.figures["slower"] > 0
    assert jerks(free).max() > 1.5 * most
    assert 0.5 * most < jerks(slow).max() < 1.02 * most


def test_plans_keep_to_what_the_joints_can_follow(laid):
    settings = rounds.validate({"feed_max_mm_s": 400})
    ranges = []
    for own in ({}, {"joint_acceleration_deg_s2": [20] * 6}):
        job, wanted = rounds.in_time(cell(laid=laid, **own), settings)
        ranges.append(commands.Commands(job, wanted).feed_range[1])
    assert (ranges[1] <= ranges[0] + 1e-9).all() and (ranges[1] < 0.8 * ranges[0]).any()


def test_passes_in_the_order_of_the_least_way():
    at = [40, 0, 30, 10, 20]  # mm, where passes of 100 mm lie side by side
    made = np.tile(np.eye(4), (2 * len(at), 1, 1))
    for k, y in enumerate(at):
        made[2 * k : 2 * k + 2, 1, 3] = y
        made[2 * k, 0, 3], made[2 * k + 1, 0, 3] = (0, 100) if (y // 10) % 2 == 0 else (100, 0)
    rapid = np.tile([True, False], len(at))
    found, lone = passes.split(rapid)
    assert lone == 0 and [tuple(one) for one in found] == [(0, 1), (2, 3), (4, 5), (6, 7), (8, 9)]
    home = np.eye(4)
    home[1, 3] = -10
    assert [at[k] for k in passes.least_way(made, found, home)] == [0, 10, 20, 30, 40]
    assert passes.split(np.array([True, True, False, True])) == ([passes.Pass(1, 2)], 2)


def test_two_opt_finds_what_the_nearest_misses():
    gained = []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        made = np.tile(np.eye(4), (24, 1, 1))
        made[:, :2, 3] = np.repeat(rng.uniform(0, 1000, (12, 2)), 2, axis=0)
        found, _ = passes.split(np.tile([True, False], 12))
        order = passes.least_way(made, found, np.eye(4))
        assert sorted(order) == list(range(12))

        def way(numbers):
            at = [np.zeros(3), *(made[2 * k, :3, 3] for k in numbers), np.zeros(3)]
            return sum(np.linalg.norm(b - a) for a, b in zip(at, at[1:]))

        greedy, left, here = [], set(range(12)), np.zeros(3)
        while left:
            greedy.append(min(left, key=lambda k: np.linalg.norm(made[2 * k, :3, 3] - here)))
            here = made[2 * greedy[-1], :3, 3]
            left.remove(greedy[-1])
        gained.append(way(greedy) - way(order))
    assert min(gained) > -1e-6 and max(gained) > 10.0


def test_roll_is_used_for_the_arms_sake(laid):
    held = writing.plan_job(cell(laid=laid))
    free = writing.plan_job(cell(laid=laid, roll_deg=30))
    costs = [sum(one.figures["cost_s"].values()) for one in (held, free)]
    assert costs[1] < costs[0]
    # The wheel's axis stays where it is: its middle, 40 mm behind the contact, has not moved.
    count = 0
    for a, b in zip((m for m in held.moves if m.kind == "LIN"), (m for m in free.moves if m.kind == "LIN")):  # fmt: skip
        centres = [one.frame[:3, 3] - 40.0 * one.frame[:3, 2] for one in (a, b)]
        assert centres[0] == pytest.approx(centres[1], abs=1e-6)
        assert a.frame[:3, 1] == pytest.approx(b.frame[:3, 1], abs=1e-9)
        count += np.abs(a.frame[:3, 2] - b.frame[:3, 2]).max() > 1e-3
    assert count


def test_a_part_in_hand_is_led_along_a_wheel_that_stands(tmp_path):
    """The wheel stands before the robot, its contact's z up and towards the robot; a plate at the flange."""
    robot = {"preset": "kuka_kr6_r900", "program": {"home_joints_deg": [0, -110, 120, 0, 40, 0]}}
    parts = {
        "robot": robot,
        "cell": {
            "holding": "part_in_hand",
            "tcp_from_work": {"position_mm": [-50, -30, 20]},
            "base_from_contact": {"position_mm": [520, 0, 420], "abc_deg": [0, -50, 0]},
        },
    }
    job = job_of(plate(), **parts)
    laid = raster.raster(job, {**X, "step_over_mm": 20, "feed_mm_s": 40})
    listed = poses.list_poses(laid)
    job = {**job, "programs": [{"name": "raster", "poses": listed, "unresolved": 0}]}
    whole = writing.plan_job(job)
    assert not whole.problems and whole.figures["passes"] == len(laid["passes"])
    finer(job, whole)
    file = tmp_path / "whole.mod"
    writing.write(file, job, whole)
    wanted = np.stack([move.joints_deg for move in whole.moves])
    assert np.abs(writing.joints_of_file(file, job) - wanted).max() < 1e-3
    of = chain("kuka_kr6_r900", np.eye(4))
    linear = [move for move in whole.moves if move.kind == "LIN"]
    assert max(np.abs(forward(of, m.joints_deg) - m.frame).max() for m in linear) < 1e-4


def turning(turns):
    """Poses on the plate's middle that turn about its normal by ``turns`` degrees, ten at a time."""
    rows = []
    for k, angle in enumerate([0, *range(0, turns + 1, 10), turns]):
        half = math.radians(angle) / 2.0
        # Down, after a turn about the normal.
        quaternion = dict(qw=0.0, qx=math.cos(half), qy=math.sin(half), qz=0.0)
        ends = k == 0 or k == turns // 10 + 2
        at = dict(x_mm=50, y_mm=30, z_mm=20 if ends else 0, feed_mm_s=40.0, rapid=k == 0, line=k)
        rows.append({**quaternion, **at})
    return rows


def test_a_pass_that_no_posture_does_is_cut_and_told(laid):
    job = cell(laid=laid)
    job = {**job, "programs": [{"name": "turning", "poses": turning(900), "unresolved": 0}]}
    whole = writing.plan_job(job)
    assert not whole.problems
    cuts = [fact for fact in whole.notes if fact.code == "robot_program.cut"]
    assert cuts and len(cuts) == whole.figures["cuts"]
    assert "pass 1 is cut at line" in str(cuts[0])
    begins = [k for k, move in enumerate(whole.moves) if "another posture" in move.note]
    assert len(begins) == len(cuts)
    for k in begins:  # up, over by the joints, down to where it was
        up, down = whole.moves[k - 1], next(m for m in whole.moves[k:] if m.kind == "LIN")
        before = whole.moves[k - 2]
        assert up.kind == "LIN" and up.frame[2, 3] == pytest.approx(before.frame[2, 3] + 30.0)
        assert np.abs(down.frame - before.frame).max() < 1e-6 and down.feed == 20.0
        assert np.abs(down.joints_deg - before.joints_deg).max() > 90.0
    finer(job, whole)


def test_a_link_goes_by_a_safe_place_where_no_direct_way_is_found(laid, monkeypatch):
    safe = [20.0, -100.0, 100.0, 0.0, 60.0, 0.0]
    direct = linking.Linker._way
    home = np.radians(HOME)

    def way(self, begin, end):
        if (begin == home).all() and not np.allclose(end, np.radians(safe)):
            return None
        return direct(self, begin, end)

    monkeypatch.setattr(linking.Linker, "_way", way)
    whole = writing.plan_job(cell(laid=laid, safe_joints_deg=[safe]))
    assert not whole.problems
    assert whole.moves[1].joints_deg == pytest.approx(safe)
    whole = writing.plan_job(cell(laid=laid))
    assert [fact.code for fact in whole.problems] == ["robot_program.no_link"]


def test_links_lift_the_wheel_off_the_part_before_a_search(laid):
    """A wall between two passes: the way over it goes off the part, across and down, with the least lift that does."""
    wall = {"name": "wall", "frame": "part", "brep": brep([-20, 28, 1], [120, 32, 25])}
    job = typed(cell(laid=laid))
    planner = wholes.Planner(job, 0, read_design(job.design), core.RunContext())
    of = planner.scenes
    ends = [np.radians(m.joints_deg) for m in writing.plan_job(job).moves if m.note.startswith("pass")]  # fmt: skip
    ends = [ends[0], ends[-1]]
    near = typed(cell(laid=laid, bodies=[wall]))
    scene = wholes.Planner(near, 0, read_design(near.design), core.RunContext()).scenes.links
    off = lifts.off_the_part(scene, near.cell)
    a, b = (of.links.base_from_tcp(q) for q in ends)
    assert abs(a[1, 3] - b[1, 3]) > 35  # on both sides of it
    both, clearance = (off, off), near.robot.program.clearance_mm
    found = lifts.link(scene, (ends[0], ends[1]), both, 30.0, clearance, 0.5)
    way = found["joints"]
    assert len(way) == 4 and not found["straight"] and found["clearance"] == clearance
    for p, q in zip(way[:-1], way[1:]):
        for share in np.linspace(0, 1, 200):
            assert scene.within(p + share * (q - p), 0.9 * clearance) is None
    begin, lifted = (scene.base_from_tcp(q) for q in way[:2])
    rise = lifted[:3, 3] - begin[:3, 3]
    assert np.abs(rise - [0, 0, rise[2]]).max() < 1e-6  # along the plate's normal
    share = rise[2] / 30.0
    assert any(share == pytest.approx(one, abs=1e-6) for one in lifts.SHARES)
    for less in (one for one in lifts.SHARES if 0 < one < share - 1e-6):
        lower = [off(q, 30.0 * less) for q in (ends[0], ends[1])]
        assert scene.on_way(*lower, clearance, 0.5) is not None
    # An end that stays where it is.
    home = planner.home
    way = lifts.link(scene, (home, ends[0]), (None, off), 30.0, clearance, 0.5)["joints"]
    assert (way[0] == home).all() and len(way) <= 3
    assert planner.linker._off(home) is None and planner.linker._off(ends[0]) is not None


def test_a_corner_that_the_controller_rounds_is_looked_at(laid):
    """A pin inside of a corner: both straight ways are clear of it, the arc is not, until its zone is smaller."""
    down = np.eye(4)
    down[:3, :3] = np.diag([1.0, -1.0, -1.0])
    frames_of = []
    for x, z in ((0, 140), (0, 60), (80, 60)):
        frame = down.copy()
        frame[:3, 3] = x + 20, 30, z
        frames_of.append(frame)
    listed = [
        {**pose_row(frame), "feed_mm_s": 40.0, "rapid": k == 0} for k, frame in enumerate(frames_of)
    ]
    # A rod that the tool carries to the side; the pin lies 10 mm beside both of its ways.
    rod = {"name": "rod", "frame": "tool", "brep": brep([-1, -61, -1], [1, -59, 1])}
    pin = {"name": "pin", "frame": "base", "brep": brep([29, 85, 69], [31, 95, 71])}
    found = {}
    for zone in (0.0, 4.0, 40.0):
        job = {**cell(laid=laid, bodies=[rod, pin]), "programs": [{"name": "corner", "poses": [{**one, "zone_mm": zone} for one in listed], "unresolved": 0}]}  # fmt: skip
        found[zone] = [fact.code for fact in writing.plan_job(jobs.validate(job)).problems]
    assert found == {0.0: [], 4.0: [], 40.0: ["robot_program.corner_meets"]}


def test_arcs_lie_between_the_ways_beside_their_corner():
    a, b, c = np.eye(4), np.eye(4), np.eye(4)
    b[0, 3], c[:2, 3] = 10, (10, 8)
    moves = [wholes.Move(kind, one, np.zeros(6), zone=zone) for kind, one, zone in (("PTP", a, 0), ("LIN", b, 100), ("LIN", c, 2))]  # fmt: skip
    ((move, places),) = corners.rounded(moves, 1.0)
    assert move is moves[1]
    points = np.array([one.frame[:3, 3] for one in places])
    assert points[0] == pytest.approx([6, 0, 0]) and points[-1] == pytest.approx([10, 4, 0])
    assert points[len(points) // 2] == pytest.approx([9, 1, 0])  # a parabola's middle
    moves[1].zone = 0.0
    assert not list(corners.rounded(moves, 1.0))
    moves[1].zone = -1.0
    ((_, places),) = corners.rounded(moves, 1.0)
    assert places[0].frame[:3, 3] == pytest.approx([9, 0, 0])


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, robot, home, line",
    [
        ("w.src", KUKA, HOME, "$LOAD={M 12.5,CM {X 0,Y -4,Z 80.5,A 0,B 0,C 0},J {X 0.1,Y 0.2,Z 0.3}}"),
        ("w.mod", ABB, [60, 0, 0, 0, 60, 0], ",[12.5,[0,-4,80.5],[1,0,0,0],0.1,0.2,0.3]];"),
        ("w.script", KUKA, HOME, "set_target_payload(12.5, [0, -0.004, 0.0805], [0.1, 0.2, 0.3, 0, 0, 0])"),
        ("w.ls", FANUC, [60, 0, 0, 0, -60, 0], "load of the flange: 12.5 kg at 0, -4, 80.5 mm"),
    ],
)  # fmt: skip
def test_programs_set_the_load_of_the_flange(name, robot, home, line, laid, tmp_path):
    load = {"mass_kg": 12.5, "centre_mm": [0, -4, 80.5], "inertia_kg_m2": [0.1, 0.2, 0.3]}
    job, file = cell({**robot, "load": load}, laid=laid, home_joints_deg=home), tmp_path / name
    whole = writing.plan_job(job)
    given = {"tools": "3", "bases": "5"} if name == "w.ls" else {}
    writing.write(file, job, whole, **given)  # and reads it again
    text = file.read_text()
    assert line in re.sub(
        r"\s+", " ", re.sub(r";\n +\d+:!", " ", text)
    )  # Fanuc's comments are short
    assert "Enter its load" not in text
    none = tmp_path / f"none_{name}"
    writing.write(none, cell(robot, laid=laid, home_joints_deg=home), whole, **given)
    assert line not in none.read_text()


def test_no_joint_is_too_fast_between_two_poses():
    """A motion straight past axis 1 turns it most in its middle: on the mean from pose to pose it is slow."""
    made = [np.eye(4), np.eye(4)]
    for frame, y in zip(made, (-300.0, 300.0)):
        frame[:3, :3] = np.diag([1.0, -1.0, -1.0])
        frame[:3, 3] = (100, y, 0)
    listed = [{**pose_row(frame), "feed_mm_s": 1400.0, "rapid": k == 0} for k, frame in enumerate(made)]  # fmt: skip
    robot = {**KUKA, "base_from_robot": {"position_mm": [0, 0, -500]}, "flip_deg": 175}
    job = cell(robot)
    job = jobs.validate({**job, "cell": {**job["cell"], "check_collisions": False}, "programs": [{"name": "past", "poses": listed, "unresolved": 0}]})  # fmt: skip
    whole = writing.plan_job(job)
    assert not whole.problems, [str(one) for one in whole.problems]
    moves = [one for one in whole.moves if one.kind == "LIN"]
    arm = robots.arm_of(job["robot"])
    base, tool = (robots.robot_frame(job["robot"], key) for key in ("base_from_robot", "flange_from_tcp"))  # fmt: skip
    fastest = 0.0
    for before, move in zip(whole.moves[:-1], whole.moves[1:]):
        if move.kind != "LIN":
            continue
        q, count = np.radians(before.joints_deg), 2000
        seconds = np.linalg.norm(move.frame[:3, 3] - before.frame[:3, 3]) / move.feed
        for k in range(1, count + 1):
            place = before.frame + (move.frame - before.frame) * k / count  # it does not turn
            rows = arm.inverse(np.linalg.inv(base) @ place @ np.linalg.inv(tool), q)
            after = rows[np.argmin(np.abs(rows - q).max(axis=1))]
            fastest = max(fastest, (np.abs(after - q) * count / seconds / arm.max_speed).max())
            q = after
    assert 0.8 < fastest < 1.02
    assert min(one.feed for one in moves) < 900 and whole.figures["slower"] > 0
