"""The reader of APT: against the truth where shared data is there, and by small programs."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.apt import reader as apt
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def cl(tmp_path, source, units="UNITS/MM\n", end="\nFINI\n"):
    (tmp_path / "p.apt").write_bytes((units + source + end).encode("latin-1"))
    return apt.read(tmp_path / "p.apt")


def positions(program):
    return [np.round(m.pose[:3, 3], 6).tolist() for m in program.motions if m.pose is not None]


def test_files_of_cutter_locations_are_known_by_their_suffix(tmp_path):
    (tmp_path / "p.CL").write_text("UNITS/MM\nGOTO/1,2,3,0,0,1\n")
    assert positions(read_program(tmp_path / "p.CL")) == [[1, 2, 3]]


@needs_shared
def test_flagship_program_against_its_truth():
    program = apt.read(PROGRAMS / "same_path_crs_part5" / "crs_part5.apt")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    assert len(program.motions) == len(truth) == 423
    assert not program.problems
    for motion, row in zip(program.motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        sine = np.linalg.norm(np.cross(motion.pose[:3, 2], expected[:3, 2]))
        assert np.degrees(np.arctan2(sine, motion.pose[:3, 2] @ expected[:3, 2])) <= 1e-3, row
        np.testing.assert_allclose(
            motion.pose[:3, :3].T @ motion.pose[:3, :3], np.eye(3), atol=1e-9
        )
        assert np.linalg.det(motion.pose[:3, :3]) > 0
    assert program.motions[0].kind == "PTP" and program.motions[1].kind == "LIN"
    assert program.motions[1].speed_mm_s == pytest.approx(100.0)


@needs_shared
def test_a_real_file():
    program = apt.read(PROGRAMS / "real" / "apt_rybakov25_test.apt")
    assert positions(program) == [[0, 0, 100], [50, 50, 10], [100, 100, 0], [150, 150, 0]]
    assert [p.line for p in program.problems] == [13, 16, 17, 19, 21]


def test_axis_and_direction_give_the_orientation(tmp_path):
    cl(tmp_path, "GOTO/0,0,0,0,0,1\nGOTO/0,10,5,0,0,1\nGOTO/0,10,9\n")
    program = read_program(tmp_path / "p.apt")
    pose = program.motions[1].pose
    np.testing.assert_allclose(pose[:3, 2], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(pose[:3, 0], [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(program.motions[2].pose[:3, 0], [0, 1, 0], atol=1e-12)  # it stays


def test_units_feeds_rapids_and_blanks(tmp_path):
    program = cl(
        tmp_path,
        "PARTNO a / b, c\nMULTAX / ON\nLOADTL / 3\nFROM / 0, 0, 1\nFEDRAT / 60 , IPM\n"
        "GOTO / 1, 0, $\n 0 , 0,0 , 1\nRAPID\nGOTO / 2, 0, 0 $$ away\nFEDRAT/MMPM,120\n"
        "GODLTA/0,1,0\nGODLTA/1\nFEDRAT/0.2,MMPR\nGOTO/0,0,0\nPPRINT GOTO/1\nFINI\nGOTO/9,9,9\n",
        units="UNITS / INCHES\n",
    )
    assert [m.kind for m in program.motions] == ["PTP", "LIN", "PTP", "LIN", "LIN", "LIN"]
    assert [m.speed_mm_s for m in program.motions] == [None, pytest.approx(25.4), None, 2, 2, None]
    np.testing.assert_allclose(program.motions[4].pose[:3, 3], [50.8, 25.4, 25.4])
    assert [m.line for m in program.motions][:3] == [5, 7, 10]
    assert [p.line for p in program.problems] == [14] and "revolution" in str(program.problems[0])
    assert program.motions[0].tool == "3"


def test_arcs(tmp_path):
    program = cl(
        tmp_path,
        "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.01\nGOTO/-10,0,0\n"
        "MOVARC/0,0,0,0,0,-1,10,ANGLE,90\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n",
    )
    assert not program.problems
    half = np.sqrt(50.0)
    expected = [[0, 10], [-10, 0], [-half, half], [0, 10], [-10, 0], [0, -10], [10, 0], [0, 10]]
    np.testing.assert_allclose([m.pose[:2, 3] for m in program.motions[1:]], expected, atol=1e-9)
    assert [m.aux for m in program.motions[1:]] == [True, False] * 4
    points = program.path_arrays(10.0)["frames"][:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 10.0, atol=1e-6)


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("GOHOME", "GOHOME"),
        ("GOTO/1,2", "2 values"),
        ("GOTO/1,2,x", "no number"),
        ("GOTO/1,2,3,0,0,0", "length 1"),
        ("GOTO/1,2,3,0,0,2", "length 1"),
        ("CIRCLE/0,0,0,0,0,1,3\nGOTO/1,1,1", "not on its circle"),
        ("CIRCLE/0,0,0,0,0,1,3\nRAPID", "no GOTO"),
        ("L1=LINE/P1,P2", "not known"),
    ],
)
def test_what_is_not_known_is_said_with_its_line(tmp_path, text, culprit):
    program = cl(tmp_path, f"GOTO/0,0,0\n{text}\nFEDRAT/100,MMPM\nGOTO/0,0,1\n")
    assert [p.line for p in program.problems] == [2 + len(text.split("\n"))]
    assert culprit in str(program.problems[0])
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2 and arrays["rapid"][1]  # the gap is not ground over


def test_units_and_compensation_are_not_silent(tmp_path):
    program = cl(tmp_path, "GOTO/1,2,3\nTLCOMP/ON,LEFT\nGOTO/1,2,4\n", units="")
    assert ["neither mm nor inch" in str(p) for p in program.problems] == [True, False]
    assert "TLCOMP" in str(program.problems[1])
    assert not positions(program) and program.asks_units and program.counted() == (0, 2)
    with pytest.raises(ProgramError, match="p.apt:1: UNITS"):
        cl(tmp_path, "", units="UNITS/FURLONGS\n")


def test_truncated_numbers_are_never_silent(tmp_path):
    for text in ("1.2.3", "12abc", "1e", "--3", "nan", "1e999", "1_0", "1 2", "", "9" * 20):
        program = cl(tmp_path, f"GOTO/{text},0,0\n")
        assert program.problems and all(m.pose is None for m in program.motions), text
    program = cl(tmp_path, "GOTO/1,2,3,$", end="")
    assert "file ends" in str(program.problems[0])


def test_no_text_is_an_error(tmp_path):
    with pytest.raises(ProgramError, match="zero bytes"):
        cl(tmp_path, "a\0b")
    with pytest.raises(ProgramError, match="absent"):
        apt.read(tmp_path / "absent.apt")


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(1)
    source = (
        "UNITS/MM\nMULTAX/ON\nLOADTL/1\nRAPID\nFROM/0,0,100,0,0,1\nFEDRAT/6000.0,MMPM\n"
        "GOTO/10,0,0,$\n 0,0.6,0.8\nGODLTA/1,2,3\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.1\n"
        "GOTO/-10,0,0\nMOVARC/0,0,0,0,0,1,10,ANGLE,90\nCYCLE/DRILL,3\nPPRINT x\nFINI\n"
    ).encode()
    for _ in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = rng.integers(256)
        (tmp_path / "m.apt").write_bytes(bytes(bad[: rng.integers(10, len(bad))]))
        try:
            program = apt.read(tmp_path / "m.apt")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.apt" in str(error)


def test_feet_per_minute(tmp_path):
    program = cl(tmp_path, "FEDRAT/2,FPM\nGOTO/1,2,3\nFEDRAT/2,FPR\nGOTO/2,2,3\n")
    assert program.motions[0].speed_mm_s == pytest.approx(2 * 304.8 / 60)
    assert program.motions[1].speed_mm_s is None
    assert [p.line for p in program.problems] == [4]


def test_coordinates_of_the_world_stay_whatever_a_system_says(tmp_path):
    """CAMWorks' programs: TRNTYP/WORLD before each CSYS; a GOTO without an axis has the system's."""
    down = "CSYS/-1.,0,0,5,0,1.,0,6,0,0,-1.,7"
    flat = "CSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0"
    text = f"""UNIT/MM
FEDRAT/600,MMPM
TRNTYP/WORLD,0,0,0
{down}
GOTO/1,2,3,0,0,-1
GOTO/2,2,3
TRNTYP/WORLD,0,0,0
{flat}
GOTO/3,2,1
FINI
"""
    path = tmp_path / "p.apt"
    path.write_text(text)
    program = read_program(path)
    assert not program.problems and {m.base for m in program.motions} == {""}
    assert [m.pose[2, 2] for m in program.motions] == [1.0, 1.0, -1.0]
    assert [m.pose[:3, 3].tolist() for m in program.motions] == [[1, 2, 3], [2, 2, 3], [3, 2, 1]]
    path.write_text(text.replace("TRNTYP/WORLD,0,0,0\n", ""))  # then they are of the system
    program = read_program(path)
    assert {m.base for m in program.motions} == {"", down.replace("/", " ")}
