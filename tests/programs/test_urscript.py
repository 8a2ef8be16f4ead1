"""The reader of URScript: against the truth where shared data is there, and by small programs."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.core import flow
from beltgrinding.programs.languages.urscript import reader as urscript
from beltgrinding.programs.languages.urscript.pose import pose_of

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def script(tmp_path, source):
    (tmp_path / "p.script").write_bytes(source.encode())
    return urscript.read(tmp_path / "p.script")


def angle_deg(a, b):
    r = a[:3, :3].T @ b[:3, :3]
    sine = np.linalg.norm([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    return np.degrees(np.arctan2(sine, np.trace(r) - 1))


def positions(program):
    return [[round(float(v), 6) for v in m.pose[:3, 3]] for m in program.motions]


@needs_shared
def test_flagship_program_against_its_truth():
    program = urscript.read(PROGRAMS / "same_path_crs_part5" / "crs_part5.script")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    motions = [m for m in program.motions if m.pose is not None]
    assert len(motions) == len(truth) == 423
    assert len(program.motions) == 424 and not program.problems
    for motion, row in zip(motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        assert angle_deg(motion.pose, expected) <= 1e-3, row
        assert motion.aux == (row[1] == "Ca")
        if row[1] in ("Ca", "Ce"):
            assert motion.kind == "CIRC"
    assert motions[0].kind == "PTP" and motions[1].speed_mm_s == 100.0


@needs_shared
def test_a_post_processors_program():
    program = urscript.read(PROGRAMS / "real" / "ur_robodk_welding_excerpt.script")
    assert not program.problems
    assert [m.kind for m in program.motions] == ["PTP"] * 2 + ["LIN"] * 4
    np.testing.assert_allclose(program.motions[-1].pose[:3, 3], [-3.377, 210.145, 82.441])
    assert program.motions[-1].speed_mm_s == 250.0


def test_poses_are_metres_and_rotation_vectors(tmp_path):
    program = script(
        tmp_path,
        "def p():\n  movel(p[0.1,-.2,3e-1,0,0,d2r(90)], v=0.05) # p[9]\n"
        "movel(pose=p[0,0,0,0,3.14159265358979,0], a=1)\nend\n",
    )
    np.testing.assert_allclose(
        program.motions[0].pose, frames.from_abc([100, -200, 300], [90, 0, 0]), atol=1e-12
    )
    np.testing.assert_allclose(program.motions[1].pose[:3, 2], [0, 0, -1], atol=1e-12)
    assert [m.speed_mm_s for m in program.motions] == pytest.approx([50.0, 250.0])
    assert [m.line for m in program.motions] == [2, 3]


def test_frames_are_multiplied_inverted_and_added(tmp_path):
    program = script(
        tmp_path,
        "a = p[1,0,0,0,0,1.5707963267948966]\nmovel(pose_trans(a, p[0.5,0,0,0,0,0]))\n"
        "movel(pose_trans(pose_inv(a), pose_trans(a, p[0.1,0.2,0.3,0,0,0])))\n"
        "movel(pose_add(a, p[0.5,0,0,0,0,0]))\nb = a\nb[2] = a[0] * 2\nmovel(b)\n",
    )
    assert not program.problems
    np.testing.assert_allclose(
        [m.pose[:3, 3] for m in program.motions],
        [[1000, 500, 0], [100, 200, 300], [1500, 0, 0], [1000, 0, 2000]],
        atol=1e-9,
    )


def test_poses_are_given_in_the_first_ref_frame(tmp_path):
    program = script(
        tmp_path,
        "ref_frame = p[1,0,0,0,0,0]\nmovel(pose_trans(ref_frame, p[0.1,0,0,0,0,0]))\n"
        "movel(p[1,0,0.5,0,0,0])\nref_frame = p[2,0,0,0,0,0]\n"
        "movel(pose_trans(ref_frame, p[0.1,0,0,0,0,0]))\n",
    )
    assert positions(program) == [[100, 0, 0], [0, 0, 500], [1100, 0, 0]]
    assert program.motions[0].base == "ref_frame p[1, 0, 0, 0, 0, 0]"


@pytest.mark.parametrize("reference_first", [True, False])
def test_poses_in_a_ref_frame_from_elsewhere_are_kept(tmp_path, reference_first):
    inside = "movel(pose_trans(pose_trans(ref_frame, p[0.1,0,0,0,0,0]), p[0,0.2,0,0,0,0]))"
    lines = [inside, "movel(p[1,0,0.5,0,0,0])"]  # how they lie to each other, the file does not say
    if not reference_first:
        lines.reverse()
    program = script(tmp_path, "\n".join(lines) + "\n")
    known, lost = program.motions
    assert known.pose[:3, 3].tolist() == ([100, 200, 0] if reference_first else [1000, 0, 500])
    assert known.base == ("ref_frame" if reference_first else "") and lost.pose is None
    assert sorted(p.code for p in program.problems) == [
        "programs.left_out",
        "programs.urscript.ref_frame_elsewhere",
    ]


@pytest.mark.parametrize(
    "target",
    [
        "pose_inv(ref_frame)",
        "pose_add(ref_frame, p[0,0,1,0,0,0])",
        "pose_trans(p[0,0,1,0,0,0], ref_frame)",
    ],
)
def test_what_depends_on_where_ref_frame_is_is_left_out(tmp_path, target):
    program = script(tmp_path, f"movel({target})\nx = ref_frame[0]\nmovel(p[x,0,0,0,0,0])\n")
    assert [m.pose for m in program.motions] == [None, None]


def test_a_ref_frame_that_is_assigned_anywhere_is_not_from_elsewhere(tmp_path):
    program = script(
        tmp_path,
        "if get_digital_in(1):\n  ref_frame = p[1,0,0,0,0,0]\nend\n"
        "movel(pose_trans(ref_frame, p[0.1,0,0,0,0,0]))\n",
    )
    assert [m.pose for m in program.motions] == [None]


def test_arcs_times_and_tools(tmp_path):
    program = script(
        tmp_path,
        "set_tcp(p[0,0,0.1,0,0,0])\nmovel(p[0.01,0,0,0,0,0])\n"
        "movec(p[0,0.01,0,0,0,0], pose_to=p[-0.01,0,0,0,0,0], v=0.2, mode=0)\n"
        "movel(p[0.09,0,0,0,0,0], t=2)\nmovep(p[0,0,0,0,0,0], 1.2, 0.3, 0.01)\n"
        "movec(p[0,0.01,0,0,0,0], p[-0.01,0,0,0,0,0], mode=1)\n",
    )
    assert [m.kind for m in program.motions] == ["LIN", "CIRC", "CIRC", "LIN", "LIN", "GAP"]
    assert [m.aux for m in program.motions[:4]] == [False, True, False, False]
    assert [m.speed_mm_s for m in program.motions[1:5]] == pytest.approx([200, 200, 50, 300])
    assert program.motions[0].tool == "p[0, 0, 0.1, 0, 0, 0]"
    assert [p.line for p in program.problems] == [6]
    points = program.path_arrays(10.0)["frames"][:20, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 10.0, atol=1e-9)


def test_loops_branches_lists_and_routines(tmp_path):
    program = script(
        tmp_path,
        "def main():\n  def step(x, z=0.5):\n    if x == 1:\n      movel(p[x,0,z,0,0,0])\n"
        "    elif x > 1 and not False:\n      movel(p[x,1,z,0,0,0])\n    else:\n"
        "      movel(p[x,2,z,0,0,0])\n    end\n    return x + 1\n  end\n"
        "  points = [0.1, 0.2, 0.3]\n  i = 0\n  while i < length(points):\n    step(i, points[i])\n"
        "    i = i + 1\n  end\n  while True:\n    i = step(i)\n    if i >= 5:\n      break\n    end\n"
        "    movel(p[0,0,0,0,0,0])\n  end\nend\nmain()\n",
    )
    assert positions(program)[:3] == [[0, 2000, 100], [1000, 0, 200], [2000, 1000, 300]]
    assert positions(program)[3:] == [[3000, 1000, 500], [0, 0, 0], [4000, 1000, 500]]
    assert not program.problems


def test_joint_targets_are_kept_without_a_pose(tmp_path):
    program = script(tmp_path, "movej([0,-1.5,1.5,0,0.7,0], a=1.4)\nmovel(p[1,2,3,0,0,0])\n")
    assert program.motions[0].pose is None and not program.problems
    assert program.path_arrays(50.0)["rapid"].tolist() == [True]


@pytest.mark.parametrize(
    "text, lines, culprit",
    [
        ("movel(get_actual_tcp_pose())", [2], "get_actual_tcp_pose"),
        ("q = get_inverse_kin(p[0,0,0,0,0,0])\nmovej(q)", [3], "q has no value"),
        ("if digital_in(1):\n  movel(p[9,0,0,0,0,0])\nend", [2], "digital_in"),
        ("while get_x() < 3:\n  movel(p[9,0,0,0,0,0])\nend", [2], "get_x"),
        ("thread a():\n  movel(p[9,0,0,0,0,0])\nend", [2], "beside"),
        ("my_routine(3)", [2], "my_routine"),
        ("servoj([0,0,0,0,0,0])", [2], "servoj"),
        ("movel([0,0,0,0,0,0])", [2], "joint"),
        ("movel(p[0,0,0,0,0])", [2], "6 components"),
        ("movel(p[0,0,0,0,0,0]", [2], "',' expected, not 'the end of the statement'"),
        ("movel(p[5/2,0,0,0,0,0])", [2], "remainder"),
        ("movel(p[0,0,0,0,0,0], w=1)", [2], "argument w"),
        ("ref_frame = get_feature()", [2], "ref_frame"),
    ],
)
def test_what_is_not_known_is_said_with_its_line(tmp_path, text, lines, culprit):
    source = f"movel(p[0,0,0,0,0,0])\n{text}\nmovel(p[0,0,1,0,0,0])\n"
    program = script(tmp_path, source)
    assert [problem.line for problem in program.problems] == lines
    assert culprit in str(program.problems[0])
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2
    assert arrays["rapid"][1] or culprit == "ref_frame"  # the gap is not ground over


def test_harmless_functions_are_no_problem(tmp_path):
    program = script(
        tmp_path, 'set_standard_digital_out(1, True)\nsleep(0.5)\ntextmsg("a # b", 1)\nsync()\n'
    )
    assert not program.problems and not program.motions


def test_a_speed_that_is_not_known_leaves_the_pose(tmp_path):
    program = script(tmp_path, "movel(p[0,0,0,0,0,0], v=slow)\nmovel(p[0,0,0,0,0,0], v=-1)\n")
    assert [m.speed_mm_s for m in program.motions] == [None, None]
    assert [p.line for p in program.problems] == [1, 2]


def test_truncated_numbers_are_never_silent(tmp_path):
    for text in ("1.2.3", "12abc", "1e", "--3", "nan", "1e999", "1_0", "0x1F", "1j", "9" * 400):
        program = script(tmp_path, f"movel(p[{text},0,0,0,0,0])\n")
        assert program.problems and all(m.pose is None for m in program.motions), text


def test_a_file_cut_off_is_said(tmp_path):
    program = script(tmp_path, "def p():\n  movel(p[0,0,0,0,0,0])\n")
    assert "cut off" in str(program.problems[0]) and len(program.motions) == 1


def test_nothing_hangs_or_overflows(tmp_path):
    for text, error in [
        ("if True:\n" * 70, "nested too deeply"),
        ("a\0b", "zero bytes"),
    ]:
        with pytest.raises(ProgramError, match=error):
            script(tmp_path, text)
    for text in ("while 1 < 2:\n  i = 1\nend\n", "while 1 < 2:\nend\n"):
        assert "an endless while is followed once" in str(script(tmp_path, text).problems[0])
    for text in ("def f():\n  f()\nend\nf()\n", "movel(" + "(" * 5000 + "\n", "a = " + "-" * 9999):
        script(tmp_path, text)
    script(tmp_path, "x = " + "1+" * 20000 + "1\nmovel(p[x,0,0,0,0,0])\n")
    with pytest.raises(ProgramError, match="absent"):
        urscript.read(tmp_path / "absent.script")


def test_mutated_programs_never_crash(tmp_path, monkeypatch):
    monkeypatch.setattr(flow, "MAX_UNROLLED", 2000)
    rng = np.random.default_rng(1)
    source = (
        "def p():\n  ref_frame = p[1,0,0,0,0,1]\n  i = 0\n  while i < 3:\n"
        "    movel(pose_trans(ref_frame, p[0.1*i,0,0,0,3,0]), 1.2, 0.1, 0, r=0.01)\n"
        "    i = i + 1\n  end\n  if i == 3:\n    movec(p[0,1,0,0,0,0], p[1,0,0,0,0,0], v=1)\n"
        "  end\n  l = [1, 2]\n  l[0] = d2r(l[1])\n  movej([0,0,0,0,0,l[0]])\n"
        "  movel(pose_add(p[0,0,0,0,0,0], pose_inv(ref_frame)), t=1)\nend\np()\n"
    ).encode()
    for _ in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = rng.integers(256)
        (tmp_path / "m.script").write_bytes(bytes(bad[: rng.integers(10, len(bad))]))
        try:
            program = urscript.read(tmp_path / "m.script")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.script" in str(error)


def test_the_manuals_own_numbers(tmp_path):
    # Universal Robots, Script Manual e-Series, 16.20 pose_add, 16.22 pose_inv, 16.24 pose_trans.
    poses = "p[.2,.5,.1,1.57,0,0], p[.2,.5,.6,1.57,0,0]"
    program = script(
        tmp_path,
        f"movel(pose_add({poses}))\nmovel(pose_trans({poses}))\n"
        "movel(pose_inv(p[.2,.5,.1,1.57,0,3.14]))\n",
    )
    for motion, expected in zip(
        program.motions,
        [
            [0.4, 1.0, 0.7, 3.14, 0, 0],
            [0.4, -0.0996, 0.60048, 3.14, 0, 0],
            [0.19324, 0.41794, -0.29662, 1.23993, 0, 2.47985],
        ],
    ):
        wanted = pose_of(expected).frame
        np.testing.assert_allclose(motion.pose[:3, :3], wanted[:3, :3], atol=2e-3)
        np.testing.assert_allclose(motion.pose[:3, 3], 1000.0 * wanted[:3, 3], atol=0.02)
    assert not program.problems


def test_optimove_has_poses_and_no_speed(tmp_path):
    pose = "p[0.1,0,0,0,0,0]"
    program = script(tmp_path, f"optimovej({pose}, v=0.5)\noptimovel({pose}, a=0.4, v=0.6)\n")
    assert [m.kind for m in program.motions] == ["PTP", "LIN"]
    assert all(m.speed_mm_s is None for m in program.motions)
    assert [p.line for p in program.problems] == [2]


def test_each_unknown_call_is_a_gap(tmp_path):
    program = script(tmp_path, "movel(p[0,0,0,0,0,0])\nfoo()\nmovel(p[1,0,0,0,0,0])\nfoo()\n")
    assert [m.pose is None for m in program.motions] == [False, True, False, True]
    assert len(program.problems) == 1
