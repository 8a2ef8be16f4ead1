"""The reader of G-code: against the truth where shared data is there, and by small programs."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.gcode import reader as gcode

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def nc(tmp_path, source, end="\nM30\n"):
    (tmp_path / "p.nc").write_bytes((source + end).encode("latin-1"))
    return gcode.read(tmp_path / "p.nc", "mm")  # most say no G21


def positions(program):
    return [np.round(m.pose[:3, 3], 6).tolist() for m in program.motions if m.pose is not None]


@needs_shared
def test_flagship_program_against_its_truth():
    program = gcode.read(PROGRAMS / "same_path_crs_part5" / "crs_part5_AC.nc")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    assert not program.problems
    assert len(program.motions) == len(truth) == 423
    for motion, row in zip(program.motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        sine = np.linalg.norm(np.cross(motion.pose[:3, 2], expected[:3, 2]))
        assert np.degrees(np.arctan2(sine, motion.pose[:3, 2] @ expected[:3, 2])) <= 1e-3, row
    assert program.motions[0].kind == "PTP" and program.motions[1].kind == "LIN"
    assert program.motions[1].speed_mm_s == pytest.approx(100.0)
    assert program.motions[1].base == "G54"


@needs_shared
def test_machine_coordinates_are_left_out_with_one_problem():
    program = gcode.read(PROGRAMS / "real" / "gcode_5axis_AC_excerpt.gcode")
    assert not positions(program)
    assert [p.line for p in program.problems] == [8, 43]  # and no M30: it is an excerpt
    assert "kinematics" in str(program.problems[0])


@pytest.mark.parametrize(
    "words, axis",
    [
        ("G43.4 H1\nG1 X0 Y0 Z0 A90", [0, -1, 0]),
        ("G43.4 H1\nG1 X0 Y0 Z0 A90 C90", [1, 0, 0]),
        ("TRAORI\nG1 X0 Y0 Z0 B90 C90", [0, 1, 0]),
        ("TRAORI(1)\nG1 X=0 Y=0 Z=0 B=30", [0.5, 0, np.sqrt(0.75)]),
        ("G43.5\nG1 X0 Y0 Z0 I1 J0 K1", [np.sqrt(0.5), 0, np.sqrt(0.5)]),
        ("G1 X0 Y0 Z0 A0 C0", [0, 0, 1]),
    ],
)
def test_rotary_words_give_the_axis(tmp_path, words, axis):
    program = nc(tmp_path, words + " F100\n")
    assert not program.problems
    np.testing.assert_allclose(program.motions[0].pose[:3, 2], -np.array(axis), atol=1e-12)
    assert np.linalg.det(program.motions[0].pose[:3, :3]) == pytest.approx(1.0)


def test_words_are_modal(tmp_path):
    program = nc(
        tmp_path,
        "%\nO1 (TEST (NESTED))\nN10 G21G90G54T3M6\nN20 G0X1Y2Z3\nG1 X2 F600 ; to 2\nY-.5\n"
        "G91 Z1.\nG20 G90\nX1\nM30\nX9\n",
    )
    assert not program.problems
    expected = [[1, 2, 3], [2, 2, 3], [2, -0.5, 3], [2, -0.5, 4], [25.4, -0.5, 4]]
    np.testing.assert_allclose(positions(program), expected)
    assert [m.kind for m in program.motions] == ["PTP", "LIN", "LIN", "LIN", "LIN"]
    assert [m.speed_mm_s for m in program.motions] == [None, 10, 10, 10, 10]
    assert [m.line for m in program.motions] == [4, 5, 6, 7, 9]
    assert program.motions[1].tool == "T3"


@pytest.mark.parametrize(
    "text, middle",
    [
        ("G0 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0", [0, 10, 0]),
        ("G0 X10 Y0 Z0\nG2 X-10 Y0 I-10", [0, -10, 0]),
        ("G0 X10 Y0 Z0\nG3 X0 Y10 R10", [np.sqrt(50), np.sqrt(50), 0]),
        ("G0 X10 Y0 Z0\nG3 X0 Y-10 R-10", [0, 10, 0]),
        ("G0 X10 Y0 Z0\nG3 I-10", [0, 10, 0]),
        ("G18 G0 X0 Y0 Z10\nG3 X0 Z-10 K-10", [10, 0, 0]),
        ("G19 G0 X0 Y10 Z0\nG3 Y-10 J-10", [0, 0, 10]),
    ],
)
def test_arcs(tmp_path, text, middle):
    program = nc(tmp_path, text + "\n")
    assert not program.problems
    if "R-10" not in text:
        np.testing.assert_allclose(program.motions[1].pose[:3, 3], middle, atol=1e-9)
    assert program.motions[1].aux and program.motions[1].kind == "CIRC"
    points = program.path_arrays(10.0)["frames"][:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 10.0, atol=1e-6)
    assert np.linalg.norm(points - middle, axis=1).min() < 1.0


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("G1 X#100", "variables"),
        ("G28 Z0", "machine"),
        ("G53 G0 Z0", "machine"),
        ("G1 X5 A30", "kinematics"),
        ("G81 X1 Y1 Z-5 R2", "G81"),
        ("M98 P100", "subprogram"),
        ("G2 X9 I1", "centre"),
        ("G2 X9 R1", "R does not fit"),
        ("G3 X0 Z5 R-3", "R does not fit"),
        ("G1 X1 X2", "twice"),
        ("IF [#1 EQ 2] GOTO 10", "variables"),
        ("FOO", "cannot read"),
        ("/G1 X5", "switch"),
    ],
)
def test_what_is_not_known_is_said_with_its_line(tmp_path, text, culprit):
    program = nc(tmp_path, f"G1 X0 Y0 Z0 F100\n{text}\nG1 X0 Y0 Z1 A0 F100\n")
    assert [p.line for p in program.problems] == [2]
    assert culprit in str(program.problems[0])
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2 and arrays["rapid"][1]  # the gap is not ground over


def test_frames_in_the_control_are_said(tmp_path):
    program = nc(tmp_path, "G0 X0 Y0 Z0\nTRANS X=R1\nG1 X1\nX2\nTRANS\nG1 X3\n")
    assert [p.line for p in program.problems][0] == 2
    assert positions(program) == [[0, 0, 0], [3, 0, 0]]
    program = nc(tmp_path, "G0 X0 Y0 Z0\nG95\nG1 X1 F0.1\nG41 X2\n")
    assert [p.line for p in program.problems] == [3, 4]
    assert program.motions[1].speed_mm_s is None


def test_positions_after_an_unknown_one_are_not_guessed(tmp_path):
    program = nc(tmp_path, "G1 X0 Y0 Z0\nX#1\nY1\nX1\n")
    assert [p.line for p in program.problems] == [2, 3]
    assert positions(program) == [[0, 0, 0], [1, 1, 0]]


def test_truncated_numbers_are_never_silent(tmp_path):
    for text in ("1.2.3", "12abc", "1e5", "--3", "nan", "1 2", "", "9" * 20, "."):
        program = nc(tmp_path, f"G1 X{text} Y0 Z0\n")
        assert program.problems and all(m.pose is None for m in program.motions), text


def test_deep_comments_do_not_hang(tmp_path):
    assert nc(tmp_path, "(" * 50000 + ")" * 50000 + "\n").problems


def test_no_text_is_an_error(tmp_path):
    with pytest.raises(ProgramError, match="zero bytes"):
        nc(tmp_path, "a\0b")
    with pytest.raises(ProgramError, match="absent"):
        gcode.read(tmp_path / "absent.nc")


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(1)
    source = (
        "%\nO2 (X)\nN10 G21 G90 G54\nN20 T1 M6\nG43.4 H1\nG0 X0 Y1 Z2 A10 C-20.5\nG1 X5. F600\n"
        "G91 A5\nG90 G49\nA0 C0\nG3 X0 Y0 R8\nG2 X1 Y1 I1\nG43.5\nG1 X1 I1 J2 K3\nG28 Z0\n"
        "#1=3\nG1 X#1\nTRANS X1\nTRANS\nG1 X1 Y1 Z1\nM30\n%\n"
    ).encode()
    for _ in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = rng.integers(256)
        (tmp_path / "m.nc").write_bytes(bytes(bad[: rng.integers(10, len(bad))]))
        try:
            program = gcode.read(tmp_path / "m.nc")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.nc" in str(error)


def test_siemens_direction_vectors_are_the_axis(tmp_path):
    program = nc(
        tmp_path,
        "TRAORI\nG1 X0 Y0 Z0 A3=0 B3=2 C3=2 F600\nX10\nA3=1\nX20 A0 C0\nX30 A3=0 B3=0 C3=0\n"
        "X40\nTRAFOOF\nX50 A3=1\n",
    )
    half = [0.0, 0.7071, 0.7071]
    for motion, axis in zip(program.motions, [half, half, [1, 0, 0], [0, 0, 1]]):
        np.testing.assert_allclose(-motion.pose[:3, 2], axis, atol=1e-4)
    # What a direction that is none leaves behind is not known.
    assert all(motion.pose is None for motion in program.motions[4:])
    assert [p.line for p in program.problems] == [6, 7, 9]
