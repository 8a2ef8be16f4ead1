"""External axes that move in the passes: a rim that no standing table lets the arm do; proved by KDL and FCL."""

import copy
import math

import numpy as np
import PyKDL
import pytest
import robot_program_bench as bench
from test_collision import brep
from test_raster import job_of
from test_robot_program import KUKA, chain, forward

from beltgrinding.base import frames
from beltgrinding.cell import reach, tool_path
from beltgrinding.cli import ground_files
from beltgrinding.engine import InputError, core
from beltgrinding.job import poses, workpiece
from beltgrinding.job.typed import typed
from beltgrinding.presets import robot as robots
from beltgrinding.programs.registry import read_program
from beltgrinding.robot_program import scenes, walk as walks, write as writing

RADIUS, HALF, AROUND = 60.0, 20.0, 72  # mm, mm, corners of the disc
TURN = {"kind": "rotary", "carries": "part", "motion": "coordinated", "lower": -400, "upper": 400, "max_speed": 60}  # fmt: skip
ROBOT = {**KUKA, "base_from_robot": {"position_mm": [-480, 0, -350]}}
HOME = [0, -90, 90, 0, 60, 0]
BASES = {"whole.src": "5", "whole.mod": "wTable"}


def disc():
    """A closed prism about z."""
    a = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
    ring = [np.column_stack([RADIUS * np.cos(a), RADIUS * np.sin(a), np.full(AROUND, z)]) for z in (-HALF, HALF)]  # fmt: skip
    points = np.concatenate([*ring, [[0, 0, -HALF], [0, 0, HALF]]])
    k = np.arange(AROUND)
    j = (k + 1) % AROUND
    faces = [(k, j, AROUND + j), (k, AROUND + j, AROUND + k), (0 * k + 2 * AROUND, j, k), (0 * k + 2 * AROUND + 1, AROUND + k, AROUND + j)]  # fmt: skip
    faces = np.concatenate([np.column_stack(one) for one in faces])
    mesh = core.TriangleMesh(points.astype(np.float32), faces.astype(np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def rim(axes, robot=ROBOT, home=HOME, count=73, bodies=(), **program):
    """A validated job: once round the disc's rim, with the belt along it."""
    wanted = {**robot, "external_axes": list(axes), "program": {"home_joints_deg": home, **program}}
    job = job_of(disc(), robot=wanted, cell={"bodies": list(bodies)})
    contact = frames.from_data(job["cell"].get("tcp_from_contact"))
    placed = []
    for a in np.linspace(0.0, 2.0 * np.pi, count):
        z = np.array([-math.cos(a), -math.sin(a), 0.0])
        x = np.array([-math.sin(a), math.cos(a), 0.0])
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = np.column_stack([x, np.cross(z, x), z]), -RADIUS * z
        placed.append(frame)
    above = []
    for one in (placed[0], placed[-1]):
        off = one.copy()
        off[:3, 3] -= 30.0 * off[:3, 2]
        above.append(off)
    all_frames = np.stack([above[0], *placed, above[1]]) @ np.linalg.inv(contact)
    rapid = np.zeros(len(all_frames), dtype=bool)
    rapid[[0, 1, -1]] = True
    arrays = {
        "frames": all_frames, "feeds": np.full(len(rapid), 40.0), "forces": np.full(len(rapid), -1.0),
        "rapid": rapid, "lines": np.arange(1, len(rapid) + 1), "zones": np.full(len(rapid), -1.0),
    }  # fmt: skip
    listed = poses.list_poses(arrays)
    return {**job, "programs": [{"name": "rim", "poses": listed, "unresolved": 0}]}


@pytest.fixture(scope="module")
def turned():
    job = rim([TURN])
    return job, writing.plan_job(job)


def room_from_part(values):
    """Of one table about z through the origin, by KDL."""
    frame = np.eye(4)
    turn = PyKDL.Rotation.RotZ(math.radians(values[0]))
    frame[:3, :3] = [[turn[i, k] for k in range(3)] for i in range(3)]
    return frame


def fine(job, whole, step=0.5, angle=math.radians(0.5)):
    """(coordinates (n, 7), numbers of the motions, seconds of each place's way): joints and table, by inverse kinematics
    of the test's own between the poses of path motions."""
    robot = robots.checked(job["robot"])
    arm = robots.arm_of(robot)
    at_zero, tool = robots.frame_at_zero(robot), robots.robot_frame(robot, "flange_from_tcp")
    rows, before, q = [], whole.moves[0], np.radians(whole.moves[0].joints_deg)
    for number, move in enumerate(whole.moves[1:], 1):
        end, turn = np.radians(move.joints_deg), np.radians(np.subtract(move.external, before.external))  # fmt: skip
        begin = np.radians(before.external)
        if move.kind == "PTP":
            count = max(1, math.ceil(max(np.abs(end - q).max(), np.abs(turn).max()) / angle))
            for s in np.linspace(0.0, 1.0, count + 1)[1:]:
                rows.append((np.append(q + s * (end - q), begin + s * turn), number, 0.0))
            q = end
        else:
            way = np.linalg.norm(move.frame[:3, 3] - before.frame[:3, 3])
            count = max(1, math.ceil(way / step), math.ceil(np.abs(turn).max() / angle))
            for s in np.linspace(0.0, 1.0, count + 1)[1:]:
                value = begin + s * turn
                pose = room_from_part(np.degrees(value)) @ frames.between(before.frame, move.frame, s)  # fmt: skip
                found = arm.inverse(np.linalg.inv(at_zero) @ pose @ np.linalg.inv(tool), q)
                q = found[np.argmin(np.abs(found - q).max(axis=1))]
                rows.append((np.append(q, value), number, way / move.feed / count))
            assert np.abs(q - end).max() < 1e-5, number
        before = move
    return tuple(np.array(one) for one in zip(*rows))


def test_a_table_turns_what_no_standing_table_lets_the_arm_do(turned):
    job, whole = turned
    assert not whole.problems and whole.figures["passes"] == 1 and whole.figures["cuts"] == 0
    values = np.array([move.external[0] for move in whole.moves])
    grinds = np.array([move.kind == "LIN" for move in whole.moves])
    assert np.ptp(values[grinds]) > 180.0 and np.abs(values).max() <= 400.0
    assert values[0] == values[-1] == 0.0  # home
    for standing in (-120.0, 0.0, 120.0):
        still = writing.plan_job(rim([{**TURN, "motion": "indexed", "position": standing}]))
        assert still.figures["cuts"] > 0 or still.problems, standing


def test_kdl_fcl_and_the_speeds_agree(turned):
    """Another chain: KDL for arm and table, FCL's crossings for bodies, at every 0.5 mm and 0.5 degrees."""
    job, whole = turned
    tool = frames.from_data(job["robot"]["flange_from_tcp"])
    of, at_zero = chain("kuka_kr6_r900", tool), robots.frame_at_zero(job["robot"])
    for move in whole.moves:
        there = (
            np.linalg.inv(room_from_part(move.external)) @ at_zero @ forward(of, move.joints_deg)
        )
        assert np.abs(there - move.frame).max() < 1e-4
    at, numbers, seconds = fine(job, whole)
    arm = robots.arm_of(robots.checked(job["robot"]))
    assert (at[:, :6] >= arm.lower - 1e-9).all() and (at[:, :6] <= arm.upper + 1e-9).all()
    known = (seconds > 0) & (np.diff(numbers, prepend=-1) == 0)
    speeds = np.abs(np.diff(at, axis=0, prepend=at[:1]))[known] / seconds[known, None]
    assert (speeds[:, :6] <= arm.max_speed * 1.01).all()
    assert np.degrees(speeds[:, 6]).max() <= 60.0 * 1.01
    plain = typed(job)
    path = tool_path.tool_path(plain, 0, [])
    lists = scenes.of_job(plain, workpiece.read_design(plain.design), path, [], None)
    links = bench.Chain(robots.checked(job["robot"]))
    linear = np.array([whole.moves[n].kind == "LIN" for n in numbers])
    for chosen, bodies in ((linear, lists.bodies_of_passes), (~linear, lists.bodies)):
        assert crossing(links, at_zero, tool, at[chosen][::3], bodies) == 0


def crossing(of, at_zero, tool, at, bodies):
    """Whether the part crosses the wheel or a link at any place; links by KDL's frames (``of``: bench.Chain)."""
    part = next(one for one in bodies if one["name"] == "part")
    of_part = core.CollisionMesh(part["mesh"])
    from_room = np.stack([np.linalg.inv(room_from_part([math.degrees(q[6])])) for q in at])
    met = looked_at = 0
    for one in bodies:
        if one["frame"] == "link":
            places = [at_zero @ of.link(q[:6], one["link"]) for q in at]
        elif one["frame"] == "wheel":
            places = [at_zero @ of.link(q[:6], 6) @ of.flange @ tool for q in at]
        else:
            continue
        looked_at += 1
        found = core.first_met([core.CollisionMesh(one["mesh"])], [(of_part, 0.0)], from_room @ np.stack(places))  # fmt: skip
        met += int((found >= 0).sum())
    assert looked_at >= 7
    return met


@pytest.mark.parametrize("name", BASES)
def test_it_reads_again_with_its_axes(name, turned, tmp_path):
    job, whole = turned
    file = tmp_path / name
    with pytest.raises(InputError, match="E1 carries the part and moves in the passes"):
        writing.write(file, job, whole)
    assert not file.exists()
    with pytest.raises(InputError, match="external axes are written as .src"):
        writing.write(tmp_path / "whole.script", job, whole)
    writing.write(file, job, whole, bases=BASES[name])
    text = file.read_text()
    assert "E1 moves in the passes" in text
    again = read_program(file)
    assert len(again.motions) == len(whole.moves)
    for motion, move in zip(again.motions, whole.moves):
        assert motion.external == pytest.approx(move.external, abs=1e-6)
    found = writing.joints_of_file(file, job)
    assert np.abs(found - np.stack([one.joints_deg for one in whole.moves])).max() < 1e-3
    # An unsafe one says both.
    unsafe = copy.deepcopy(whole)
    unsafe.problems.append(core.Fact("test.problem", "it hits a post"))
    writing.write(file, job, unsafe, bases=BASES[name], unsafe=True)
    head = file.read_text()
    assert "UNSAFE: it hits a post" in head and "E1 moves in the passes" in head
    writing.write(file, job, whole, bases=BASES[name])
    # What reads otherwise is noticed: the table a degree further at one pose.
    value = f"{whole.moves[20].external[0]:.6f}".rstrip("0").rstrip(".")
    other = value.replace(value.split(".")[0], str(int(value.split(".")[0]) + 1), 1)
    assert value in text
    file.write_text(text.replace(value, other))
    with pytest.raises(InputError, match="other joint angles than planned"):
        writing.check_joints(file, typed(job), whole)


def test_the_job_names_the_base_for_every_writer(turned, tmp_path):
    job, whole = turned
    for given in (np.eye(4), "as-known", {"table": "as-known"}):  # numbers do not go with the table
        with pytest.raises(InputError, match="only the controller's own base"):
            writing.write(tmp_path / "whole.src", job, whole, bases=given)
    with pytest.raises(InputError, match="only the controller's own base"):
        ground_files.check_name("whole.src", "", job)
    program = {"home_joints_deg": HOME, "base": "5"}
    named = {**job, "robot": {**job["robot"], "program": {**job["robot"]["program"], **program}}}
    ground_files.check_name("whole.src", "", named)
    with pytest.raises(InputError, match="external axes are written as .src"):
        ground_files.check_name("whole.ls", "", named)
    file = tmp_path / "whole.src"
    writing.write(file, named, whole)
    assert "BAS (#BASE,5 )" in file.read_text()
    writing.write(file, named, whole, bases="7")
    assert "BAS (#BASE,7 )" in file.read_text() and "#BASE,5" not in file.read_text()
    with pytest.raises(
        InputError, match="robot.program.base: 'a table' is no base of a controller"
    ):
        robots.checked({**ROBOT, "program": {"base": "a table"}})


def test_the_arm_walks_with_the_table(turned):
    job, whole = turned
    found = walks.walk(job, whole)
    assert {walks.FREE, walks.NEAR} >= set(found.states)
    assert np.ptp([one[0] for one in found.external]) > 180.0
    poses_, values = found.frames(), np.array(found.external)[:, 0]
    assert np.abs(np.diff(values)).max() < 30.0
    last = found.at_move(20)
    assert poses_[last] == pytest.approx(whole.moves[20].frame, abs=1e-6)


def test_a_track_follows_a_long_pass(tmp_path):
    """A rail of two metres, longer than the arm reaches: the track goes along. Its base is that of the room."""
    track = {"kind": "linear", "carries": "robot", "motion": "coordinated", "axis": [1, 0, 0], "lower": -900, "upper": 900, "max_speed": 500}  # fmt: skip
    job = job_of(brep([-1000, -20, -40], [1000, 20, 0]), robot={
        **ROBOT, "base_from_robot": {"position_mm": [0, -480, -350], "abc_deg": [90, 0, 0]},
        "external_axes": [track], "program": {"home_joints_deg": HOME},
    })  # fmt: skip
    xs = np.linspace(-950, 950, 39)
    placed = np.tile(np.diag([1.0, -1.0, -1.0, 1.0]), (41, 1, 1))
    placed[1:-1, 0, 3], placed[0, 0, 3], placed[-1, 0, 3] = xs, xs[0], xs[-1]
    placed[[0, -1], 2, 3] = 40.0
    rapid = np.zeros(41, dtype=bool)
    rapid[[0, 1, -1]] = True
    arrays = {"frames": placed, "feeds": np.full(41, 80.0), "forces": np.full(41, -1.0), "rapid": rapid, "lines": np.arange(1, 42), "zones": np.full(41, -1.0)}  # fmt: skip
    job = {**job, "programs": [{"name": "rail", "poses": poses.list_poses(arrays), "unresolved": 0}]}  # fmt: skip
    whole = writing.plan_job(job)
    assert not whole.problems and whole.figures["cuts"] == 0
    values = np.array([move.external[0] for move in whole.moves])
    assert np.ptp(values) > 200.0
    still = {**job, "robot": {**job["robot"], "external_axes": [{**job["robot"]["external_axes"][0], "motion": "indexed"}]}}  # fmt: skip
    assert any("out of the robot's reach" in str(one) for one in writing.plan_job(still).problems)
    arm, at_zero = robots.arm_of(robots.checked(job["robot"])), robots.frame_at_zero(job["robot"])
    tool = frames.from_data(job["robot"]["flange_from_tcp"])
    for move in whole.moves:
        there = at_zero @ arm.forward(np.radians(move.joints_deg)) @ tool
        there[0, 3] += move.external[0]
        assert there == pytest.approx(move.frame, abs=1e-6)
    file = tmp_path / "rail.src"
    writing.write(file, job, whole)
    again = read_program(file)
    (base,) = again.base_frames.values()
    assert base == pytest.approx(np.linalg.inv(at_zero), abs=1e-5)


def test_what_only_stands_is_not_looked_at_alone(turned):
    job, _ = turned
    plain = typed(job)
    path = tool_path.tool_path(plain, 0, [])
    assert reach.job_reach(plain, [path]) == []
    (told,) = reach.warnings(plain)
    assert str(told).startswith("E1 moves in the passes")
    with pytest.raises(
        InputError, match="E1 moves in the passes, which only a program for the whole"
    ):
        reach.reach(path, job["robot"])
    four = [{**TURN, "origin_mm": [k, 0, 0]} for k in range(4)]
    with pytest.raises(InputError, match="4 axes are coordinated; at most 3"):
        rim(four)
