"""Yaskawa INFORM jobs: instructions by small jobs, real files where shared data is there."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.inform import reader as inform
from beltgrinding.programs.registry import read_program
from support.cost import growth

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")

HEAD = "///USER 4\n///TOOL 2\n///POSTYPE USER\n///RECTAN\n///RCONF 0,0,0,0,0,0,0,0\n"
POINTS = HEAD + "".join(f"C{n:05}={10 * n}.000,{n * n},0.5,0,0.,0.0000\n" for n in range(1, 7))
POINTS += "P0001=1.0,2.0,3.0,0.0,0.0,0.0\nP0002=1.0,2.0,3.0,0.0,0.0,90.0\n"
FIRST = 20  # line of NOP, before the first instruction


def job(tmp_path, *instructions, points=POINTS, end="END\n"):
    body = "".join(f"{line}\n" for line in instructions)
    text = f"/JOB\n//NAME T\n//POS\n{points}//INST\n///DATE 2020/01/01 00:00\n///GROUP1 RB1\nNOP\n"
    file = tmp_path / "p.jbi"
    file.write_bytes((text + body + end).replace("\n", "\r\n").encode("latin-1"))
    return inform.read(file)


def xs(program):
    return [m.pose[0, 3] if m.pose is not None else None for m in program.motions]


@needs_shared
def test_the_same_path_against_its_truth():
    folder = PROGRAMS / "same_path_crs_part5"
    program = inform.read(folder / "CRSPART5.JBI")
    lines = (folder / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    assert len(program.motions) == len(truth) == 423
    assert not program.problems
    for motion, row in zip(program.motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        # The angle between two rotations close to each other, from the chord of their matrices.
        chord = np.linalg.norm(motion.pose[:3, :3] - expected[:3, :3])
        assert math.degrees(chord / math.sqrt(2.0)) <= 1e-3, row
        assert motion.kind == ("PTP" if row[1] == "J" else "LIN")
        assert (motion.base, motion.tool) == ("USER 4", "TOOL 2")


@needs_shared
def test_a_real_job_without_positions():
    program = inform.read(PROGRAMS / "real" / "yaskawa_ROS_S1.JBI")
    assert not program.motions and not program.problems


def test_motions_speeds_and_positions(tmp_path):
    program = job(
        tmp_path,
        "'a comment MOVL C00009 V=1.0",
        "MOVJ C00001 VJ=20.00 PL=2",
        "MOVL C00002 V=100.5 PL=0 CONT",
        "DOUT OT#(1) ON",
        "TIMER T=0.50",
        "MOVS C00003 BC00003 V=50.0 NWAIT",
        "SPEED V=25.0",
        "MOVL P001 PL=1",
        "IMOV P001 V=10.0 UF#(4)",
        "IMOV P001 V=10.0 TF",
    )
    assert not program.problems
    assert [m.kind for m in program.motions] == ["PTP", "LIN", "SPL", "LIN", "LIN", "LIN"]
    assert [m.speed_mm_s for m in program.motions] == [None, 100.5, 50.0, 25.0, 10.0, 10.0]
    assert xs(program) == [10, 20, 30, 1, 2, 3]
    np.testing.assert_allclose(program.motions[-1].pose[:3, 3], [3, 6, 9])
    assert program.motions[0].line == FIRST + 2
    assert len(program.path_arrays(50.0)["frames"]) == 6


def test_angles_and_frames(tmp_path):
    points = (
        "///NPOS 2,0,0,0,0,0\n///TOOL 3\n///POSTYPE BASE\n///RECTAN\n"
        "C00000=1.0,2.0,3.0,10.0,20.0,30.0,5.0\n///POSTYPE ROBOT\nC00001=1,2,3,0,0,0\n"
    )
    program = job(tmp_path, "MOVL C00000 V=5.0", "MOVL C00001 V=5.0", points=points)
    np.testing.assert_allclose(program.motions[0].pose, frames.from_abc((1, 2, 3), (30, 20, 10)))
    assert [m.base for m in program.motions] == ["BASE", "ROBOT"]
    assert [m.tool for m in program.motions] == ["TOOL 3", "TOOL 3"]
    assert len(program.path_arrays(9.0)["frames"]) == 1
    (problem,) = program.problems
    assert "ROBOT" in problem.message and "read in BASE" in problem.message
    program = job(tmp_path, points=points.replace("NPOS 2", "NPOS 3"))
    assert program.problems[0].line == 4 and "announces 3 C, 2" in program.problems[0].message


@pytest.mark.parametrize(
    "instruction, culprit",
    [
        ("MOVL C00099 V=10.0", "C00099 has no value"),
        ("MOVL LP001 V=10.0", "not in this file"),
        ("MOVL P009 V=10.0", "P009 has no value"),
        ("MOVL V=10.0", "not in this file"),
        ("MOVJ C00050 VJ=5.00", "PULSES_PER_DEGREE_S"),
        ("MOVL C00051 V=5.0", "frame TOOL"),
        ("MOVL C00002 V=5.0 UNTIL IN#(1)=ON", "UNTIL"),
        ("SMOVL C00002 V=5.0 +MOVJ EC00002", "station"),
        ("IMOV P002 V=5.0 UF#(4)", "turns"),
        ("IMOV P001 V=5.0 BF", "along BF"),
        ("IMOV P001 V=5.0", "not known"),
    ],
)
def test_what_is_not_known_is_said_and_leaves_a_gap(tmp_path, instruction, culprit):
    more = "///POSTYPE PULSE\n///PULSE\nC00050=1,-2000000,3,4,5,6\n"
    more += "///POSTYPE TOOL\n///RECTAN\nC00051=1,2,3,4,5,6\n"
    program = job(
        tmp_path,
        "MOVL C00001 V=10.0",
        instruction,
        "MOVL C00003 V=10.0",
        points=POINTS + more,
    )
    (problem,) = program.problems
    assert problem.line == FIRST + 2 + more.count("\n")
    assert culprit in problem.message, problem
    assert xs(program) == [10, None, 30]
    assert program.path_arrays(5.0)["rapid"].tolist() == [True, True]


@pytest.mark.parametrize("speed", ["V=I001", "V=100", "VR=20.0", "V=0.0", "V=1.2.3", "V=1O.0", ""])
def test_unknown_speeds_are_noted_and_the_motion_stays(tmp_path, speed):
    program = job(tmp_path, "MOVJ C00001 VJ=5.00", f"MOVL C00002 {speed} PL=1")
    assert [p.line for p in program.problems] == [FIRST + 2]
    assert "speed" in program.problems[0].message
    assert xs(program) == [10, 20] and program.motions[1].speed_mm_s is None


def test_variables_set_at_run_time_are_unknown(tmp_path):
    for instruction in ("GETS PX001 $PX000", "SET P001 P009", "ADD P001 P002", "CALL JOB:OTHER"):
        program = job(tmp_path, instruction, "MOVL P001 V=10.0")
        assert xs(program) == [None], instruction
        assert "P001 has no value" in program.problems[-1].message


def test_jumps_blocks_and_calls(tmp_path):
    one, two = "MOVL C00001 V=10.0", "MOVL C00002 V=10.0"
    program = job(tmp_path, "JUMP *A", one, "*A", two)
    assert xs(program) == [20] and not program.problems
    program = job(tmp_path, "JUMP *A IF IN#(1)=ON", one, "*A", two)
    assert xs(program) == [None, 20] and program.problems[0].line == FIRST + 1
    program = job(tmp_path, "*A", one, "JUMP *A")
    assert xs(program) == [10] and "endless" in program.problems[0].message
    program = job(tmp_path, "*A", one, "JUMP *A IF B000<3", two)
    assert xs(program) == [10, 20] and "followed once" in program.problems[0].message
    program = job(tmp_path, one, "JUMP *NONE", two)
    assert xs(program) == [10] and "nowhere" in program.problems[0].message
    for begin, end in [("IFTHEN IN#(1)=ON", "ENDIF"), ("WHILE B000<3", "ENDWHILE")]:
        program = job(tmp_path, begin, one, end, two)
        assert xs(program) == [None, 20] and program.problems[0].line == FIRST + 1
    program = job(tmp_path, "SFTON P001 UF#(1)", one, "SFTOF", two)
    assert xs(program) == [None, 20]
    program = job(tmp_path, "CALL JOB:X IF IN#(1)=ON", one, "CALL JOB:X", "RET", two)
    assert xs(program) == [None, 10, None]
    assert [p.line for p in program.problems] == [FIRST + 1, FIRST + 3]
    assert "IF" in str(program.problems[0]) and "X" in str(program.problems[1])
    program = job(tmp_path, one, "+MOVJ EC00001 VJ=5.0", "FROBNICATE 3")
    assert [p.line for p in program.problems] == [FIRST + 2, FIRST + 3] and xs(program) == [10]


def test_arcs_lie_on_their_circle(tmp_path):
    angles = [0, 80, 160, 200, 240]
    points = [(100 * math.cos(math.radians(a)), 100 * math.sin(math.radians(a))) for a in angles]
    rows = HEAD + "".join(f"C{k:05}={x:.6f},{y:.6f},0,0,0,0\n" for k, (x, y) in enumerate(points))
    moves = [f"MOVC C{k:05} V=50.0" for k in range(5)]
    for fpt in ("", " FPT"):
        program = job(tmp_path, *moves[:2], moves[2] + fpt, *moves[3:], points=rows)
        assert not program.problems
        assert [m.kind for m in program.motions] == ["LIN"] + ["CIRC"] * 8
        path = program.path_arrays(9.0)["frames"]
        np.testing.assert_allclose(np.linalg.norm(path[:, :2, 3], axis=1), 100.0, atol=1e-5)
        turned = np.unwrap(np.arctan2(path[:, 1, 3], path[:, 0, 3]))
        assert (np.diff(turned) > 0).all() and turned[-1] == pytest.approx(math.radians(240))


@pytest.mark.parametrize(
    "points, culprit",
    [
        (HEAD + "C00000=1,2,3,4,5\n", ":9: C00000 has 5 values"),
        (HEAD + "C00000=1,2,3,4,5,6x\n", ":9: C00000 is '6x'"),
        (HEAD + "C00000=1,2,3,4,5,\n", ":9: C00000 is ''"),
        (HEAD + "C00000=1,2,3,4,5,1e999\n", ":9: C00000"),
        (HEAD + "C00000=1,2,3,4,5,nan\n", ":9: C00000"),
        (HEAD + "C00000=1,2,3,4,5,6\n" * 2, ":10: C00000 occurs twice"),
        (HEAD + "C0000O=1,2,3,4,5,6\n", ":9: 'C0000O"),
        ("///USER x\n", ":4: ///USER"),
        ("///POSTYPE USED\n", ":4: ///POSTYPE"),
        ("///NPOS 1,2\n", ":4: ///NPOS"),
    ],
)
def test_damaged_positions_name_the_line(tmp_path, points, culprit):
    with pytest.raises(ProgramError, match=culprit):
        job(tmp_path, points=points)


def test_what_is_no_whole_job(tmp_path):
    with pytest.raises(ProgramError, match="its END is missing"):
        job(tmp_path, "MOVL C00001 V=10", end="")
    for text, culprit in [("", "/JOB"), ("no job", ":1: .*/JOB"), ("/JOB\0", "zero bytes")]:
        (tmp_path / "q.jbi").write_text(text)
        with pytest.raises(ProgramError, match=culprit):
            inform.read(tmp_path / "q.jbi")
    with pytest.raises(ProgramError, match="cannot be read"):
        inform.read(tmp_path / "absent.jbi")


def test_the_time_of_reading_goes_with_the_number_of_motions(tmp_path):
    def work(n):
        rows = HEAD + "".join(f"C{k:05}={k}.000,2.0,3.0,4.0,5.0,6.0\n" for k in range(n))
        program = job(tmp_path, *[f"MOVL C{k:05} V=100.0 PL=3" for k in range(n)], points=rows)
        assert len(program.motions) == n

    assert growth(work, 2000) < 3


def test_mutated_jobs_never_crash(tmp_path):
    rng = np.random.default_rng(7)
    job(
        tmp_path,
        "*A",
        "MOVJ C00001 VJ=20.00 PL=2",
        "MOVC C00001 V=10.0",
        "MOVC C00002 V=10.0 FPT",
        "MOVC C00003 V=10.0",
        "IMOV P001 V=10.0 UF#(4)",
        "IFTHEN IN#(1)=ON",
        "SET P001 P002",
        "ENDIF",
        "CALL JOB:X",
        "JUMP *A IF B000<3",
        "MOVS C00006 V=9.0",
        "JUMP *A",
    )
    source = (tmp_path / "p.jbi").read_bytes()
    letters = b"0123456789CPMOVJL=/.,-+* \r\n"
    file = tmp_path / "m.jbi"
    for k in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = (
                letters[rng.integers(len(letters))] if k % 3 else rng.integers(256)
            )
        file.write_bytes(bytes(bad[: rng.integers(10, len(bad))]) if k % 4 == 0 else bytes(bad))
        try:
            program = inform.read(file)
        except ProgramError:
            continue
        assert np.isfinite(program.path_arrays(10.0)["frames"]).all()


def test_a_program_without_motions_says_so(tmp_path):
    path = tmp_path / "WAIT.JBI"
    path.write_text("/JOB\n//NAME WAIT\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\nNOP\nEND\n")
    program = read_program(path)
    assert not program.motions
    assert "no instruction of the program moves the robot" in str(program.problems[0])
