"""The roll of programs that give the tool's axis only: no twist in contact, changes out of it."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.roll_along import TURNING
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]

UP = (0.0, 0.0, 1.0)


def apt(tmp_path, passes, name="p.apt", clear=20.0, rapid=True, **rule):
    """A program of passes: lists of positions, or of (position, axis)."""
    lines = ["UNITS/MM", "FEDRAT/600,MMPM"]
    for one in passes:
        one = [point if len(point) == 2 else (point, UP) for point in one]
        for at, (place, axis) in enumerate([one[0], *one, one[-1]]):
            outside = at in (0, len(one) + 1)
            if outside:
                place = [p + clear * a for p, a in zip(place, axis)]
            if outside and rapid:
                lines.append("RAPID")
            lines.append("GOTO/" + ",".join(f"{v:.9f}" for v in (*place, *axis)))
    (tmp_path / name).write_text("\n".join([*lines, "FINI", ""]))
    return read_program(tmp_path / name, **rule)


def twist(a, b):
    """Degrees about the tool's axis from the pose a to b, beyond the axis' least rotation."""
    u, v = a[:3, 2], b[:3, 2]
    w, cosine = np.cross(u, v), u @ v
    x = cosine * a[:3, 0] + np.cross(w, a[:3, 0]) + (w @ a[:3, 0]) / (1.0 + cosine) * w
    return math.degrees(math.atan2(np.cross(x, b[:3, 0]) @ v, x @ b[:3, 0]))


def twists(program):
    """(degrees, mm) of each feed motion."""
    motions = program.motions
    return [
        (abs(twist(a.pose, b.pose)), float(np.linalg.norm(b.pose[:3, 3] - a.pose[:3, 3])))
        for a, b in zip(motions, motions[1:])
        if b.kind != "PTP"
    ]


def belt(program, k):
    return np.round(program.motions[k].pose[:3, 0], 6).tolist()


def zigzag(lines=6, length=100.0, pitch=5.0, y=0.0):
    points = []
    for k in range(lines):
        ends = [(0.0, y + k * pitch, 0.0), (length, y + k * pitch, 0.0)]
        points += ends if k % 2 == 0 else ends[::-1]
    return points


def circle(radius=30.0, count=24):
    turns = [2.0 * math.pi * k / count for k in range(count + 1)]
    return [(radius * math.cos(t), radius * math.sin(t), 0.0) for t in turns]


def spiral(turns=4, pitch=6.0, count=30):
    angles = [2.0 * math.pi * k / count for k in range(count, turns * count)]
    return [(pitch * t / 6 * math.cos(t), pitch * t / 6 * math.sin(t), 0.0) for t in angles]


def arch(radius=40.0, sign=1.0, y=0.0):
    """Over a cylinder about y, with its normals: at both ends the axis is along x."""
    turns = [math.pi * k / 18 for k in range(19)][:: 1 if sign > 0 else -1]
    axes = [(-math.cos(t), 0.0, math.sin(t)) for t in turns]
    return [((radius * a[0], y, radius * a[2]), a) for a in axes]


def wild(count=60, seed=3):
    random = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        axis = random.normal(size=3) + (0.0, 0.0, 1.5)
        found.append((tuple(random.uniform(-50, 50, 3)), tuple(axis / np.linalg.norm(axis))))
    return found


PATHS = {
    "zigzag": zigzag(),
    "circle": circle(),
    "spiral": spiral(),
    "arch": arch(),
    "reversal": [(0, 0, 0), (80, 0, 0), (0, 0, 0), (80, 0.0, 0)],
    "single point": [(5, 5, 0)],
    "stairs": [(0, 0, 0), (20, 0, 0), (20, 0, 5), (40, 0, 5)],
    "wild": wild(),
}


@pytest.mark.parametrize("name", PATHS)
def test_held_there_is_no_twist_in_contact(tmp_path, name):
    program = apt(tmp_path, [PATHS[name], [(0, 200, 0), (0, 300, 0)]])
    assert max(angle for angle, _ in twists(program)) < 1e-5
    for motion in program.motions:
        turn = motion.pose[:3, :3]
        np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=1e-9)
        assert np.linalg.det(turn) > 0


def test_a_pass_has_its_direction_as_a_whole_and_keeps_the_belt_s_travel(tmp_path):
    back = [(100.0, 60.0, 0.0), (0.0, 60.0, 0.0)]
    aslant = [(0.0, 80.0, 0.0), (100.0, 130.0, 0.0)]
    across = [(0.0, 200.0, 0.0), (0.0, 300.0, 0.0)]
    program = apt(tmp_path, [zigzag(), back, aslant, circle(), across])
    first = [m.line for m in program.motions]
    assert belt(program, 0) == [1, 0, 0] and belt(program, 10) == [1, 0, 0]
    at = len(zigzag()) + 2
    assert belt(program, at) == [1, 0, 0], "a reversal turns nothing"
    np.testing.assert_allclose(belt(program, at + 5), np.array([2, 1, 0]) / 5**0.5, atol=1e-5)
    np.testing.assert_allclose(belt(program, at + 9), np.array([2, 1, 0]) / 5**0.5, atol=1e-5)
    assert belt(program, -2) == [0, 1, 0]
    assert len(first) == len(set(first))


def test_the_roll_changes_on_the_longest_motion_out_of_contact(tmp_path):
    program = apt(tmp_path, [zigzag(2), [(0, 60, 0), (0, 90, 0)]])
    kinds = [(m.kind, belt(program, k)) for k, m in enumerate(program.motions)]
    assert kinds[4:8] == [
        ("LIN", [1, 0, 0]),
        ("PTP", [1, 0, 0]),  # lifted as it was
        ("PTP", [0, 1, 0]),
        ("LIN", [0, 1, 0]),
    ]


def test_feed_motions_that_cross_over_lifted_are_out_of_contact(tmp_path):
    program = apt(tmp_path, [[(0, 0, 0), (90, 0, 0)], [(0, 50, 0), (0, 90, 0)]], rapid=False)
    assert [m.kind for m in program.motions].count("PTP") == 0
    turned = [k for k, (angle, _) in enumerate(twists(program), 1) if angle > 1e-6]
    assert len(turned) == 1
    a, b = program.motions[turned[0] - 1], program.motions[turned[0]]
    assert a.pose[2, 3] == b.pose[2, 3] == 20.0


def test_a_step_too_small_to_be_a_lift_changes_nothing(tmp_path):
    low = apt(tmp_path, [[(0, 0, 0), (90, 0, 0)], [(0, 50, 0), (0, 90, 0)]], clear=1.0, rapid=False)
    assert max(angle for angle, _ in twists(low)) < 1e-6


def test_a_rapid_motion_amid_a_pass_turns_nothing_where_the_direction_is_the_same(tmp_path):
    program = apt(tmp_path, [zigzag(4)[:3], zigzag(4)[3:]])
    assert all(belt(program, k) == [1, 0, 0] for k in range(len(program.motions)))


def test_an_axis_along_the_first_direction_is_no_hindrance(tmp_path):
    program = apt(tmp_path, [arch(), arch(sign=-1.0, y=20.0)])
    assert max(angle for angle, _ in twists(program)) < 1e-6
    for motion in program.motions:  # the belt runs round the cylinder, never along its axis
        assert abs(motion.pose[1, 0]) < 1e-6


@pytest.mark.parametrize("roll", ["hold", "along"])
def test_arcs(tmp_path, roll):
    text = "G90 G21\nG0 X0 Y0 Z20\nG1 Z0 F600\nG1 X50\nG3 X50 Y40 J20\nG1 X0\nG0 Z20\nM30\n"
    (tmp_path / "p.nc").write_text(text)
    program = read_program(tmp_path / "p.nc", roll=roll)
    if roll == "hold":
        assert [m.kind for m in program.motions].count("CIRC") == 2
        assert all(belt(program, k) == [1, 0, 0] for k in range(len(program.motions)))
        return
    arrays = program.path_arrays(100.0)
    feed = ~arrays["rapid"]
    poses = arrays["frames"]
    for k in np.flatnonzero(feed[1:]) + 1:
        way = poses[k][:3, 3] - poses[k - 1][:3, 3]
        if abs(way[2]) < 1e-6 and np.linalg.norm(way) > 0.1:
            assert abs(poses[k][:3, 0] @ way) / np.linalg.norm(way) > math.cos(math.radians(31))
    assert belt(program, -1) == [-1, 0, 0], "round a half circle the belt goes on"
    worst = max(angle / length for angle, length in twists(program) if length > 1e-6)
    assert worst < 1.05 * math.degrees(1.0 / 20.0)  # the arc's own curvature


def test_along_the_belt_turns_round_corners_near_them_only(tmp_path):
    square = [(0, 0, 0), (100, 0, 0), (100, 100, 0), (0, 100, 0), (0, 0, 0)]
    program = apt(tmp_path, [square], roll="along")
    turning = [(angle, length) for angle, length in twists(program) if angle > 1e-6]
    assert sum(angle for angle, _ in turning) == pytest.approx(270.0)
    assert sum(length for _, length in turning) <= 3.01 * TURNING
    assert max(angle / length for angle, length in turning) < 90.0 / TURNING + 1e-6
    plain = apt(tmp_path, [square])
    lines = {m.line: m.pose[:3, 3].tolist() for m in program.motions}  # the last of each
    assert lines == {m.line: m.pose[:3, 3].tolist() for m in plain.motions}


@pytest.mark.parametrize("name", ["zigzag", "reversal", "single point"])
def test_along_reversals_and_step_overs_turn_nothing(tmp_path, name):
    program = apt(tmp_path, [PATHS[name]], roll="along")
    assert max(angle for angle, _ in twists(program)) < 1e-6


def test_along_a_circle_the_belt_follows_and_twists_as_it_bends(tmp_path):
    program = apt(tmp_path, [circle()], roll="along")
    inner = [(a, l) for a, l in twists(program)][6:-6]
    assert all(a / l == pytest.approx(math.degrees(1 / 30.0), rel=0.4) for a, l in inner if l > 1)


@pytest.mark.parametrize("name", PATHS)
def test_along_nothing_jumps(tmp_path, name):
    program = apt(tmp_path, [PATHS[name], [(0, 200, 0), (0, 300, 0)]], roll="along")
    for motion in program.motions:
        assert np.linalg.det(motion.pose[:3, :3]) == pytest.approx(1.0)
    if name != "wild":
        assert all(angle < 1 + 12.0 * length for angle, length in twists(program))


def test_a_fixed_direction(tmp_path):
    program = apt(tmp_path, [zigzag()], roll="fixed", roll_direction=(0, 2, 5))
    assert all(belt(program, k) == [0, 1, 0] for k in range(len(program.motions)))
    parallel = apt(tmp_path, [arch()], roll="fixed", roll_direction=(1, 0, 0))
    (problem,) = parallel.problems
    assert problem.code == "programs.roll.parallel" and problem.arguments["count"] == 4
    assert problem.line == parallel.motions[0].line


@pytest.mark.parametrize(
    "rule, code",
    [
        ({"roll": "upwards"}, "programs.roll.unknown"),
        ({"roll": "fixed"}, "programs.roll.no_direction"),
        ({"roll": "fixed", "roll_direction": (0, 0, 0)}, "programs.roll.no_direction"),
        ({"roll": "fixed", "roll_direction": (math.nan, 0, 0)}, "programs.roll.no_direction"),
        ({"roll": "hold", "roll_direction": (1, 0, 0)}, "programs.roll.direction_unused"),
    ],
)
def test_rules_without_meaning_are_refused(tmp_path, rule, code):
    with pytest.raises(ProgramError) as caught:
        apt(tmp_path, [zigzag()], **rule)
    assert caught.value.code == code


def test_a_program_of_whole_orientations_has_no_roll_to_choose(tmp_path):
    (tmp_path / "p.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n9,0,0,1,0,0,0\n")
    with pytest.raises(ProgramError) as caught:
        read_program(tmp_path / "p.csv", roll="along")
    assert caught.value.code == "programs.roll.not_free"


def test_half_turns_of_the_axis_and_gaps(tmp_path):
    down = [((0, 0, 0), (0, 0, 1)), ((50, 0, 0), (0, 0, -1)), ((90, 0, 0), (0, 0, 1))]
    program = apt(tmp_path, [down])
    assert np.isfinite([m.pose for m in program.motions]).all()
    (tmp_path / "g.apt").write_text(
        "UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/90,0,0\nGOHOME\nGOTO/0,50,0\nGOTO/0,90,0\nFINI\n"
    )
    for roll in (None, "along"):
        found = read_program(tmp_path / "g.apt", roll=roll)
        turned = [m.pose[:3, 0].round(6).tolist() for m in found.motions if m.pose is not None]
        assert turned == [[1, 0, 0]] * 2 + [[0, 1, 0]] * 2


def test_changes_go_back_into_programs_with_a_free_roll(tmp_path):
    apt(tmp_path, [zigzag(), circle()])
    report = patch(tmp_path / "p.apt", [{"index": 2, "dz_mm": 0.5}], tmp_path / "new.apt")
    assert report[0]["offset_mm"] == pytest.approx([0, 0, 0.5], abs=1e-4)
    old, new = ((tmp_path / n).read_text().splitlines() for n in ("p.apt", "new.apt"))
    assert sum(a != b for a, b in zip(old, new)) == 1 and len(old) == len(new)


def test_the_command_line_takes_a_roll(tmp_path, capsys):
    apt(tmp_path, [zigzag()])
    source, out = str(tmp_path / "p.apt"), tmp_path / "poses.csv"
    assert cli.main(["program", source, "-o", str(out), "--roll=0,1,0"]) == 0
    turned = out.read_text()
    assert cli.main(["program", source, "-o", str(out), "--force"]) == 0
    assert turned != out.read_text()
    assert cli.main(["program", source, "--roll=sideways"]) != 0
    assert "--roll" in capsys.readouterr().err


def test_a_job_s_roll(tmp_path):
    from beltgrinding.engine import InputError
    from beltgrinding.job.poses import program_arrays

    apt(tmp_path, [zigzag()])
    file = str(tmp_path / "p.apt")
    arrays = program_arrays({"file": file, "roll": "fixed", "roll_direction": [0, 1, 0]}, "p", [])
    np.testing.assert_allclose(
        arrays["frames"][:, :3, 0], [[0, 1, 0]] * len(arrays["frames"]), atol=1e-9
    )
    with pytest.raises(InputError) as caught:
        program_arrays({"poses": [], "roll": "hold"}, "p", [])
    assert caught.value.code == "job.roll_of_poses"
    schema = json.loads((ROOT / "Resources" / "schema" / "job.schema.json").read_text())
    rules = schema["properties"]["programs"]["items"]["properties"]["roll"]["enum"]
    assert rules == ["hold", "along", "fixed"]
