"""Robot programs: KRL, CSV, the writer; against real files where shared data is there."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.writer import write_program

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def krl(tmp_path, source, data=None):
    (tmp_path / "p.src").write_bytes(source.encode("latin-1"))
    if data is not None:
        (tmp_path / "P.DAT").write_bytes(data.encode("latin-1"))
    return read_program(tmp_path / "p.src")


def angle_deg(a, b):
    return np.degrees(np.arccos(np.clip((np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2, -1, 1)))


@needs_shared
def test_flagship_program_against_its_truth():
    program = read_program(PROGRAMS / "same_path_crs_part5" / "crs_part5.src")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    motions = [m for m in program.motions if m.pose is not None]
    assert len(motions) == len(truth) == 423
    assert not program.problems
    for motion, row in zip(motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        if row[1] != "Ca":  # an arc's auxiliary point has no orientation of its own
            assert angle_deg(motion.pose, expected) <= 2e-3, row
        assert {"J": "PTP", "L": "LIN", "S": "SPL"}.get(row[1], "CIRC") == motion.kind


# What a person reads in these files: (motions, those with a pose, lines of the problems).
REAL = {
    # A loop over points that another list of the folder makes GLOBAL: the excerpt has the first 79.
    "kuka_frame_array_loop.src": (779, 79, [9] * 700),
    # Begins in the middle of an IF; calls two routines of other files, each a gap.
    "kuka_inline_forms_excerpt.src": (6, 4, [4, 26, 48]),
    # The second motion is by joints, which are no pose without the robot.
    "kuka_robodk_Prog1.src": (2, 1, []),
}


@needs_shared
@pytest.mark.parametrize("file", REAL)
def test_real_files_give_the_poses_and_problems_that_they_hold(file):
    program = read_program(PROGRAMS / "real" / file)
    posed = sum(motion.pose is not None for motion in program.motions)
    lines = [problem.line for problem in program.problems]
    assert (len(program.motions), posed, lines) == REAL[file]
    assert {problem.file for problem in program.problems} <= {file}


@needs_shared
def test_inline_forms_take_their_targets_from_the_data_file():
    program = read_program(PROGRAMS / "real" / "kuka_inline_forms_excerpt.src")
    linear = [m for m in program.motions if m.kind == "LIN"]
    np.testing.assert_allclose(linear[0].pose[:3, 3], [392.37943, 496.91703, 840.17238])
    assert linear[0].speed_mm_s == 2000.0


def test_components_stay_and_order_and_case_do_not_matter(tmp_path):
    program = krl(
        tmp_path,
        "def p()\r\n$vel.cp=0.1 ; m/s\r\nPTP {X 1,Y 2,Z 3,A 10,B 20,C 30}\r\n"
        "lin {z 5, x -7.5} c_dis\r\nEND\r\n",
    )
    last = program.motions[-1]
    expected = frames.from_abc([-7.5, 2, 5], [10, 20, 30])
    np.testing.assert_allclose(last.pose, expected, atol=1e-12)
    assert last.speed_mm_s == pytest.approx(100.0)
    assert last.line == 4
    assert not program.problems


def test_loops_arrays_and_the_geometric_operator(tmp_path):
    program = krl(
        tmp_path,
        "DEF p()\nFOR i = 1 TO 3\nLIN pts[i] : {FRAME: X 0,Y 0,Z -2*i,A 0,B 0,C 0} C_VEL\nENDFOR\n"
        "END\n",
        "DEFDAT p PUBLIC\nDECL FRAME pts[3]\n"
        + "".join(f"pts[{i}  ]={{X {i},Y 0,Z 0,A 0,B 180,C 0}}\n" for i in (1, 2, 3)),
    )
    np.testing.assert_allclose([m.pose[0, 3] for m in program.motions], [1, 2, 3])
    np.testing.assert_allclose([m.pose[2, 3] for m in program.motions], [2, 4, 6], atol=1e-12)


def test_what_is_not_known_is_said_with_its_line(tmp_path):
    program = krl(
        tmp_path,
        "DEF p()\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\nLIN xsensor\nIF $IN[3] THEN\nLIN {X 9}\nENDIF\n"
        "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\nEND\n",
    )
    assert [problem.line for problem in program.problems] == [3, 4]
    assert "XSENSOR" in str(program.problems[0])
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2
    assert arrays["rapid"][1]  # the gap is not ground over


def test_speeds_of_blocks_and_of_single_motions(tmp_path):
    pose = "{X 1,Y 0,Z 0,A 0,B 0,C 0}"
    program = krl(
        tmp_path,
        f"DEF p()\n$VEL={{CP 0.2, ORI1 100}}\nLIN {pose}\nSPLINE WITH $VEL.CP=0.1\nSPL {pose}\n"
        f"SPL {pose} WITH $VEL.CP=0.3, $ACC.CP=1\nSPL {pose}\nENDSPLINE\nLIN {pose}\n"
        f"IF $IN[1] THEN\nBAS(#CP_PARAMS,2)\nENDIF\nLIN {pose}\nEND\n",
    )
    assert [m.speed_mm_s for m in program.motions] == [200, 100, 300, 100, 200, None]
    (problem,) = program.problems
    assert problem.line == 11 and "speed is not known" in problem.message


def test_truncated_numbers_are_never_silent(tmp_path):
    for text in ("1.2.3", "12abc", "1e", "--3", "nan", "1e999"):
        program = krl(tmp_path, f"DEF p()\nLIN {{X {text},Y 0,Z 0,A 0,B 0,C 0}}\nEND\n")
        assert program.problems and all(m.pose is None for m in program.motions), text


def test_arcs_become_chords_on_the_circle(tmp_path):
    program = krl(
        tmp_path,
        "DEF p()\nPTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\nCIRC {X 0,Y 10},{X -10,Y 0,A 90}\nEND\n",
    )
    arrays = program.path_arrays(50.0)
    points = arrays["frames"][:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 10.0, atol=1e-9)
    assert points[:, 1].min() > -1e-9
    middles = 0.5 * (points[1:] + points[:-1])
    assert 10.0 - np.linalg.norm(middles, axis=1).min() < 0.0101
    assert angle_deg(arrays["frames"][0], arrays["frames"][-1]) == pytest.approx(90.0)


def test_joint_targets_are_kept_without_a_pose(tmp_path):
    program = krl(
        tmp_path,
        "DEF p()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n",
    )
    assert program.motions[0].pose is None
    assert program.path_arrays(50.0)["rapid"].tolist() == [True]


def test_krl_round_trip(tmp_path):
    rng = np.random.default_rng(4)
    poses = [frames.from_abc(rng.uniform(-500, 500, 3), rng.uniform(-89, 89, 3)) for _ in range(20)]
    write_program(tmp_path / "w.src", None, [{"poses": poses, "feed_mm_s": 42.0}])
    program = read_program(tmp_path / "w.src")
    assert not program.problems
    for motion, pose in zip(program.motions, poses):
        np.testing.assert_allclose(motion.pose[:3, 3], pose[:3, 3], atol=6e-5)
        assert angle_deg(motion.pose, pose) < 2e-4
    assert program.motions[5].speed_mm_s == pytest.approx(42.0)


def test_csv_poses(tmp_path):
    file = tmp_path / "p.csv"
    file.write_text(
        "# a comment\nx_mm;y_mm;z_mm;a_deg;b_deg;c_deg;feed_mm_s;force_N;motion\n"
        "1;2;3;90;0;0;50;;PTP\n4;5;6;0;90;0;;30.5;\n"
    )
    program = read_program(file)
    arrays = program.path_arrays(80.0)
    assert arrays["feeds"].tolist() == [50, 80]
    assert arrays["forces"].tolist() == [-1, 30.5]
    assert arrays["lines"].tolist() == [3, 4]
    np.testing.assert_allclose(arrays["frames"][1], frames.from_abc([4, 5, 6], [0, 90, 0]))


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("", "empty"),
        ("x_mm,y_mm\n1,2\n", "z_mm"),
        ("x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,nan,1,0,0,0\n", ":2: z_mm"),
        ("x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,2,0,0,0\n", ":2: the quaternion"),
        ("x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,1,0,0\n", ":2: 6 values"),
        ("x_mm,y_mm,z_mm,qw,qx,qy,qz,speed\n", "speed"),
        ("x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n1,2,3,1,0,0,0,-5\n", ":2: feed_mm_s"),
    ],
)
def test_bad_csv_names_the_culprit(tmp_path, text, culprit):
    file = tmp_path / "p.csv"
    file.write_text(text)
    with pytest.raises(ProgramError, match=culprit):
        read_program(file)


def test_unknown_language(tmp_path):
    with pytest.raises(ProgramError, match="robot language"):
        read_program(tmp_path / "x.xyz")
    with pytest.raises(ProgramError, match="absent.src"):
        read_program(tmp_path / "absent.src")


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(1)
    source = (
        "DEF p()\n$BASE={X 1,Y 2,Z 3,A 0,B 0,C 0}\nFOR i=1 TO 3\nLIN {X i,Y 2,Z 3,A 0,B 0,C 0} C_DIS\n"
        "ENDFOR\nCIRC {X 1,Y 5},{X 3,Y 3}\nIF TRUE THEN\nLIN_REL {Z -5} #TOOL\nENDIF\nEND\n"
    ).encode()
    for _ in range(400):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = rng.integers(256)
        (tmp_path / "m.src").write_bytes(bytes(bad[: rng.integers(10, len(bad))]))
        try:
            program = read_program(tmp_path / "m.src")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError:
            pass


def test_rotation_vectors():
    axis = np.array([1.0, -2.0, 2.0]) / 3.0
    angles = np.array([0.0, 1e-14, 0.5, 3.0])
    half = 0.5 * angles
    turns = np.hstack([np.cos(half)[:, None], np.sin(half)[:, None] * axis])
    rotations = frames.from_quaternions(np.zeros((4, 3)), turns)[:, :3, :3]
    assert np.allclose(frames.rotation_vectors(rotations), angles[:, None] * axis, atol=1e-12)
