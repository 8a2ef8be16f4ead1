"""INFORM jobs: positions in pulses, numbers that decide what runs, jobs that are called."""

import json

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs import given
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.inform import reader as inform
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.languages.side_files import side_files

RECTAN = "///TOOL 2\n///POSTYPE ROBOT\n///RECTAN\n///RCONF 0,0,0,0,0,0,0,0\n"
POINTS = RECTAN + "".join(f"C{n:05}={10 * n}.0,0.0,5.0,180.0,0.0,0.0\n" for n in range(7))
POINTS += "P00001=1.0,2.0,0.0,0.0,0.0,0.0\nP00002=7.0,0.0,0.0,0.0,0.0,0.0\n"
PULSE = "///TOOL 0\n///POSTYPE PULSE\n///PULSE\n"
PULSES = PULSE + "C00000=1000,2000,-3000,500,0,62\nC00001=1100,2000,-3000,500,0,62\n"
RATIOS = {
    f"PULSES_PER_DEGREE_{axis}": value for axis, value in zip("SLURBT", (100, 100, 50, 10, 10, 6.2))
}


def job(folder, *instructions, points=POINTS, name="P", groups=1, values=None):
    body = "".join(f"{line}\n" for line in instructions)
    body = "".join(f"///GROUP{k + 1} RB{k + 1}\n" for k in range(groups)) + "NOP\n" + body
    text = f"/JOB\n//NAME {name}\n//POS\n{points}//INST\n///DATE 2020/01/01 00:00\n{body}END\n"
    path = folder / f"{name}.JBI"
    path.write_text(text)
    if values is not None:
        (folder / f"{name}.values.json").write_text(json.dumps({"variables": values}))
    return path


def read(folder, *instructions, **more):
    return read_program(job(folder, *instructions, **more))


def xs(program):
    return [m.pose[0, 3] if m.pose is not None else None for m in program.motions]


def at(n, speed="10.0"):
    return f"MOVL C{n:05} V={speed}"


def test_positions_in_pulses_are_joint_targets(tmp_path):
    moves = ("MOVJ C00000 VJ=5.0", "MOVL C00001 V=20.0 PL=0")
    program = read(tmp_path, *moves, points=PULSES)
    assert [m.kind for m in program.motions] == ["GAP"] * 1 and program.lost == 2
    assert given.missing(program) == list(RATIOS)
    assert "PULSES_PER_DEGREE_S" in str(program.problems[0])
    program = read(tmp_path, *moves, points=PULSES, values=RATIOS)
    assert not program.problems and not program.lost
    assert [m.kind for m in program.motions] == ["PTP", "LIN"]
    np.testing.assert_allclose(program.motions[0].joints_deg, [10, 20, -60, 50, 0, 10])
    assert program.motions[1].speed_mm_s == 20.0 and program.motions[1].zone_mm == 0.0

    def pose_of(joints, external):
        return frames.from_abc((joints[0], 0, 0), (0, 0, 180))

    arrays = program.path_arrays(50.0, pose_of)
    assert not program.problems
    assert arrays["rapid"].tolist() == [True, False]  # the second is ground
    np.testing.assert_allclose(arrays["frames"][:, 0, 3], [10, 11])
    assert len(program.path_arrays(50.0)["frames"]) == 0
    (problem,) = program.problems  # nobody says where the joints put the tool
    assert "1 motions" in str(problem) and "robot" in str(problem)
    program.path_arrays(50.0)
    assert len(program.problems) == 1


def test_angles_need_no_pulses_a_degree(tmp_path):
    points = PULSES.replace("PULSE", "ANGLE")
    program = read(tmp_path, "MOVL C00000 V=20.0", points=points)
    assert program.motions[0].joints_deg == (1000, 2000, -3000, 500, 0, 62)
    seven = PULSE + "C00000=1,2,3,4,5,6,7\n"
    program = read(tmp_path, "MOVL C00000 V=20.0", points=seven, values=RATIOS)
    assert "joint position" in str(program.problems[0]) and program.lost == 1
    for zero in (0, 1e-9):
        program = read(
            tmp_path,
            "MOVL C00000 V=2.0",
            points=PULSES,
            values={**RATIOS, "PULSES_PER_DEGREE_U": zero},
        )
        assert program.lost == 1 and "axis U" in str(program.problems[0])


def test_arcs_and_other_tools_of_joint_targets_are_left_out(tmp_path):
    program = read(tmp_path, *["MOVC C00000 V=9.0"] * 3, points=PULSES, values=RATIOS)
    assert program.lost == 3 and "arc through joint" in str(program.problems[0])
    points = PULSES + "///TOOL 3\n///POSTYPE PULSE\n///PULSE\nC00002=1,2,3,4,5,6\n"
    program = read(tmp_path, at(0), at(2), at(1), points=points, values=RATIOS)
    arrays = program.path_arrays(9.0, lambda joints, external: np.eye(4))
    assert len(arrays["frames"]) == 2 and arrays["rapid"].tolist() == [True, True]
    assert "TOOL 3" in str(program.problems[0])
    # Poses and joint targets of one job go together.
    points = POINTS.replace("TOOL 2", "TOOL 0") + PULSES.replace("C0000", "C0010")
    program = read(tmp_path, at(1), at(100), at(2), points=points, values=RATIOS)
    arrays = program.path_arrays(9.0, lambda joints, external: np.eye(4))
    assert arrays["rapid"].tolist() == [True, False, False] and not program.problems


@pytest.mark.parametrize(
    "instructions, expected",
    [
        (("SET B000 2", "JUMP *A IF B000=2", at(1), "*A", at(2)), [20]),
        (("SET B000 2", "JUMP *A IF B000<>2", at(1), "*A", at(2)), [10, 20]),
        (("SET I000 0", "*A", at(1), "INC I000", "JUMP *A IF I000<3", at(2)), [10, 10, 10, 20]),
        (("SET D000 5", "*A", at(1), "SUB D000 2", "JUMP *A IF D000>0"), [10, 10, 10]),
        (("SET R000 1.5", "MUL R000 4", "JUMP *A IFEXPRESS R000=6 ANDEXP R000>2", at(1), "*A"), []),
        (("SET I001 EXPRESS ( 3 + 5 ) * 2 - 1", "JUMP *A IF I001=15", at(1), "*A", at(2)), [20]),
        (
            ("SET I001 7", "DIV I001 7", "IFTHENEXP I001=1", at(1), "ELSE", at(2), "ENDIF", at(3)),
            [10, 30],
        ),
        (
            (
                "SET B001 3",
                "IFTHEN B001=1",
                at(1),
                "ELSEIF B001=3",
                at(2),
                "ELSE",
                at(3),
                "ENDIF",
                at(4),
            ),
            [20, 40],
        ),
        (("SET B001 9", "IFTHENEXP B001=1", at(1), "ENDIF", at(4)), [40]),
        (("SET I000 0", "WHILE I000<2", at(1), "ADD I000 1", "ENDWHILE", at(2)), [10, 10, 20]),
        (("FOR I002 = 1 TO 3", at(1), "NEXT I002", at(2)), [10, 10, 10, 20]),
        (("FOR I002 = 5 TO 1 BY -2", at(1), "NEXT I002"), [10, 10, 10]),
        (("SET I003 2", "MOVL P[I003] V=9.0"), [7]),
        (("SET P001 P002", "MOVL P001 V=9.0"), [7]),
        (("SMOVL C00001 V=9.0", "SMOVJ C00002 VJ=9.0"), [10, 20]),
        (("COMM CALL JOB:OTHER", "'JUMP *X", at(1)), [10]),
        (("SET B000 1", "PAUSE IF B000=1", "RET IF B000=1", at(1)), []),
        (
            (
                "SET B000 2",
                "SWITCH B000",
                "CASE 1",
                at(1),
                "CASE 2",
                at(2),
                "DEFAULT",
                at(3),
                "ENDSWITCH",
                at(4),
            ),
            [20, 40],
        ),
        (("SET B000 9", "SWITCH B000", "CASE 1", at(1), "DEFAULT", at(3), "ENDSWITCH"), [30]),
        (("FOR I000 = 1 TO 5", at(1), "BREAK IF I000=2", "NEXT I000", at(2)), [10, 10, 20]),
        (
            ("SET I000 0", "WHILE I000<3", "INC I000", "CONTINUE IF I000=2", at(1), "ENDWHILE"),
            [10, 10],
        ),
        (("JUMP *A IF IN#(1)=ON OR 1=1", at(1), "*A", at(2)), [20]),
    ],
)
def test_numbers_that_the_job_sets_decide(tmp_path, instructions, expected):
    program = read(tmp_path, *instructions)
    assert xs(program) == expected, program.problems
    assert {p.code for p in program.problems} <= {"programs.no_motion"}


@pytest.mark.parametrize(
    "instructions, expected, asked",
    [
        (("JUMP *A IF B000=2", at(1), "*A", at(2)), [None, 20], ["B000"]),
        (("SET B000 B001", "IFTHEN B000=2", at(1), "ENDIF", at(2)), [None, 20], ["B001"]),
        (("FOR I000 = 1 TO I5", at(1), "NEXT I000", at(2)), [None, 20], ["I005"]),
        (
            ("SET B000 2", "DIN B000 IG#(1)", "JUMP *A IF B000=2", at(1), "*A", at(2)),
            [None, 20],
            ["B000"],
        ),
        (("SET B000 2", "DIALOG B000", "WHILE B000<3", at(1), "ENDWHILE"), [None], ["B000"]),
        (("SET I000 5", "DIV I000 2", "JUMP *A IF I000=2", at(1), "*A"), [None], ["I000"]),
        (("SET B000 300", "JUMP *A IF B000=44", at(1), "*A"), [None], ["B000"]),
        (("JUMP *A IF IN#(1)=ON", at(1), "*A"), [None], []),
        (("MOVL P[I007] V=9.0",), [None], ["I007"]),
        ((at(1), "IFTHEN IN#(1)=ON", "JUMP *E", "ENDIF", at(2), "*E", at(3)), [10, None, 30], []),
        (("SWITCH B000", "CASE 1", at(1), "ENDSWITCH", at(2)), [None, 20], ["B000"]),
        (
            ("FOR I000 = 1 TO 5", at(1), "BREAK IF IN#(1)=ON", "NEXT I000", at(2)),
            [10, None, 20],
            [],
        ),
    ],
)
def test_numbers_that_are_not_known_are_asked_for(tmp_path, instructions, expected, asked):
    program = read(tmp_path, *instructions)
    assert xs(program) == expected and list(program.asked) == asked
    assert program.problems


def test_a_value_of_a_person_decides(tmp_path):
    lines = ("JUMP *A IF B000=2", at(1), "*A", at(2))
    program = read(tmp_path, *lines, values={"B000": 2})
    assert xs(program) == [20] and not program.problems and list(program.asked) == ["B000"]
    # It holds until the job changes it where it is not followed.
    program = read(
        tmp_path,
        *lines,
        "DIN B000 IG#(1)",
        *[t.replace("*A", "*B") for t in lines],
        values={"B000": 2},
    )
    assert xs(program) == [20, None, 20]


def test_positions_that_are_set_elsewhere_are_asked_for(tmp_path):
    lines = ("GETS PX001 $PX000", at(1), "MOVL P001 V=9.0", "MOVL P077 V=9.0")
    program = read(tmp_path, *lines)
    assert xs(program) == [10, None] and program.lost == 2
    assert program.asked == {"P001": "frame", "P077": "frame"}
    place = dict(x_mm=50, y_mm=0, z_mm=5, a_deg=10, b_deg=20, c_deg=30)
    program = read(tmp_path, *lines, values={"P001": place, "P077": place})
    assert xs(program) == [10, 50, 50] and not program.problems
    np.testing.assert_allclose(program.motions[1].pose, frames.from_abc((50, 0, 5), (10, 20, 30)))
    assert {(m.base, m.tool) for m in program.motions} == {("ROBOT", "TOOL 2")}


def test_jobs_that_are_called_lie_beside(tmp_path):
    other = POINTS.replace("C00001=10.0", "C00001=500.0")
    job(
        tmp_path,
        "GETARG LB000 IARG#(1)",
        "JUMP *E IF LB000=0",
        at(1),
        "*E",
        "SET B010 LB000",
        name="OTHER",
        points=other,
    )
    path = job(
        tmp_path,
        "SET LB000 7",
        "CALL JOB:OTHER ARGF3",
        "JUMP *A IF B010<>3",
        at(1),
        "*A",
        "CALL JOB:other ARGF0",
        "JUMP *B IF LB000<>7",
        at(2),
        "*B",
        "CALL JOB:MISSING",
        at(3),
    )
    program = read_program(path)
    assert xs(program) == [500, 10, 20, None, 30]
    assert [m.line for m in program.motions] == [22, 24, 28, 30, 31]
    assert {m.file for m in program.motions} == {"P.JBI"}
    assert ["MISSING" in str(p) for p in program.problems] == [True]
    assert [p.name for p in side_files(path)] == ["OTHER.JBI"]
    # It calls itself: not followed; a job that cannot be read is told.
    job(tmp_path, at(1), "CALL JOB:OTHER", name="OTHER")
    program = read(tmp_path, "CALL JOB:OTHER", at(2))
    assert xs(program) == [10, None, 20] and len(program.problems) == 1
    (tmp_path / "OTHER.JBI").write_text("/JOB\n")
    program = read(tmp_path, "CALL JOB:OTHER", at(2))
    assert xs(program) == [None, 20] and "OTHER.JBI" in str(program.problems[0])
    # P1 differs between the two files: nobody knows which holds.
    job(tmp_path, at(1), name="OTHER", points=POINTS.replace("P00001=1.0", "P00001=9.0"))
    program = read(
        tmp_path, "MOVL P001 V=9.0", "CALL JOB:OTHER", "MOVL P001 V=9.0", "MOVL P002 V=9.0"
    )
    assert xs(program) == [1, 10, None, 7]


def test_what_may_move_unseen_leaves_a_gap(tmp_path):
    for line in (
        "MACRO1 MJ#(10) ARGF1",
        "CALL JOB:X IF IN#(1)=ON",
        "JUMP *A IF IN#(1)=ON\nCALL JOB:X\n*A",
    ):
        program = read(tmp_path, at(1), line, at(2))
        assert xs(program) == [10, None, 20] and program.problems, line
    program = read(tmp_path, at(1), "SFTON P001", at(2), "SFTOF", at(3))
    assert xs(program) == [10, None, 30]
    program = read(tmp_path, at(1), "SMOVL C00002 V=9.0", at(3), groups=2)
    assert xs(program) == [10, None, 30] and "station" in str(program.problems[0])
    program = read(tmp_path, at(1), "RET IF IN#(1)=ON", at(2))
    assert xs(program) == [10, 20] and "went on" in str(program.problems[0])


def test_loops_without_an_end_are_told(tmp_path):
    program = read(tmp_path, "SET B000 0", "*A", at(1), "JUMP *A IF B000=0", at(2))
    assert xs(program) == [10] and "endless" in str(program.problems[0])
    program = read(tmp_path, "SET I000 1", "WHILE I000=1", at(1), "ENDWHILE", at(2))
    assert xs(program) == [10] and "endless" in str(program.problems[0])
    program = read(tmp_path, at(3), "SET D000 0", "*A", at(1), "INC D000", "JUMP *A IF D000>0")
    assert xs(program) == [30, 10] and "endless" in str(program.problems[0])
    program = read(tmp_path, "FOR I000 = 1 TO 3", at(1), "DIN I000 IG#(1)", "NEXT I000", at(2))
    assert xs(program) == [10, None, 20] and "how often FOR" in str(program.problems[0])


def test_mutated_flow_never_crashes(tmp_path):
    rng = np.random.default_rng(3)
    job(tmp_path, "GETARG LB000 IARG#(1)", at(1), "RET IF LB000=1", at(2), name="OTHER")
    source = job(
        tmp_path, "SET I000 EXPRESS ( 3 + 5 ) * 2", "FOR I001 = 1 TO 3 BY 1", at(1), "CALL JOB:OTHER ARGF1",
        "NEXT I001", "IFTHENEXP I000=16 ANDEXP I001>1", at(2), "ELSEIFEXP I000<2", at(3), "ELSE", at(4), "ENDIF",
        "WHILE I000<18", "INC I000", "SET P001 P[I000]", "ENDWHILE", "*A", "DEC I000", "JUMP *A IFEXPRESS I000>3",
        "MOVL P001 V=9.0", "MOVL C00100 V=9.0", points=POINTS + PULSES.replace("C0000", "C0010"), values=RATIOS,
    ).read_bytes()  # fmt: skip
    letters = b"0123456789CPMOVJLBIR=/.,-+*()<> \r\n"
    file = tmp_path / "m.jbi"
    for k in range(400):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = (
                letters[rng.integers(len(letters))] if k % 3 else rng.integers(256)
            )
        file.write_bytes(bytes(bad))
        try:
            program = inform.read(file, {name: float(v) for name, v in RATIOS.items()})
        except ProgramError:
            continue
        assert np.isfinite(
            program.path_arrays(10.0, lambda joints, external: np.eye(4))["frames"]
        ).all()
