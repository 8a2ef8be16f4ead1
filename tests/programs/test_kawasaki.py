"""Kawasaki AS: poses, motions, what decides them, and what only the controller knows."""

import random
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.core.poses import as_zyz, zyz
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.languages.side_files import side_files

DATA = ".TRANS\np1 100 200 300 0 180 0\nq[2] 1, 2, 3, 0, 0, 0\n.END\n.REALS\nn = 4\n.END\n"


def read(folder, body, name="t.as", values=None, more=""):
    (folder / name).write_text(f".PROGRAM t()\n{body}\n.END\n{more}{DATA}")
    return read_program(folder / name, values=values)


def positions(program):
    return [None if m.pose is None else [*m.pose[:3, 3].round(6)] for m in program.motions]


def told(program):
    return "\n".join(map(str, program.problems))


def test_o_a_t_are_turns_about_z_the_new_y_and_the_new_z():
    """By hand: Rz(90) takes x to y; Ry(90) then tilts the tool's z there; Rz(90) turns about it."""
    expected = [[-1, 0, 0], [0, 0, 1], [0, 1, 0]]
    assert np.allclose(zyz(0, 0, 0, 90, 90, 90)[:3, :3], expected)
    angles = (20.0, 70.0, -130.0)
    assert np.allclose(as_zyz(zyz(1, 2, 3, *angles)), [1, 2, 3, *angles])
    assert np.allclose(zyz(*as_zyz(zyz(1, 2, 3, 30, 180, 10))), zyz(1, 2, 3, 30, 180, 10))


def test_motions_speeds_and_zones(tmp_path):
    program = read(
        tmp_path,
        """SPEED 100 MM/S ALWAYS ; a comment
  ACCURACY 2 ALWAYS
  jmove #[0,10,-90,0,-45,0,500]
  JAPPRO p1, 50
  LMOVE p1
  SPEED 6000 MM/MIN
  ACCURACY 5 FINE
  LMOVE SHIFT(p1 BY ,10)
  DRAW ,,-5
  TDRAW 0,0,5
  LDEPART 20
  BREAK
  C1MOVE q[2]
  C2MOVE TRANS(20,0,0,0,0,0,77)""",
    )
    assert [m.kind for m in program.motions] == ["PTP"] * 2 + ["LIN"] * 5 + ["CIRC"] * 2
    assert program.motions[0].joints_deg == (0, 10, -90, 0, -45, 0)
    assert positions(program)[1:] == [
        [100, 200, 350],
        [100, 200, 300],
        [100, 210, 300],
        [100, 210, 295],
        [100, 210, 290],
        [100, 210, 310],
        [1, 2, 3],
        [20, 0, 0],
    ]
    assert [m.speed_mm_s for m in program.motions[2:7]] == [100.0] * 5
    assert [m.zone_mm for m in program.motions[1:7]] == [2.0, 2.0, 5.0, 2.0, 2.0, 0.0]
    assert program.motions[7].aux and not program.problems


def test_a_speed_in_percent_is_not_known(tmp_path):
    program = read(tmp_path, "SPEED 50 ALWAYS\nLMOVE p1\nSPEED 2 S\nLMOVE SHIFT(p1 BY 10)")
    assert [m.speed_mm_s for m in program.motions] == [None, 5.0]
    assert "share" in told(program)


def test_tool_and_base(tmp_path):
    program = read(
        tmp_path,
        "BASE NULL\nTOOL TRANS(0,0,100)\nLMOVE p1\nBASE TRANS(10,0,0,90,0,0)\nDRAW 1\nLMOVE TRANS(0,5)",
    )
    assert np.allclose(program.motions[1].pose[:3, 3], [201, -90, 300])
    bases = [program.base_frames[m.base] @ m.pose for m in program.motions]
    assert np.allclose(bases[1][:3, 3], [100, 201, 300])
    assert np.allclose(bases[2][:3, 3], [5, 0, 0])


def test_poses_chain(tmp_path):
    program = read(
        tmp_path,
        """POINT a = TRANS(10,0,0,90,0,0)
  LMOVE a + TRANS(1,2,3)
  LMOVE a - a + RZ(90) + TRANS(1)
  POINT f = FRAME(TRANS(), TRANS(0,1), TRANS(-1), TRANS(5,5,5))
  LMOVE f + TRANS(2)
  LMOVE -a
  DECOMPOSE d[1] = a
  LMOVE TRANS(d[1], d[4], DX(a))
  BREAK
  HERE h
  LMOVE h""",
    )
    assert positions(program) == [
        [8, 1, 3],
        [0, 1, 0],
        [5, 7, 5],
        [0, 10, 0],
        [10, 90, 10],
        [10, 90, 10],
    ]


def test_blocks_jumps_and_calls(tmp_path):
    program = read(
        tmp_path,
        """FOR .k = 1 TO n STEP 3
    LMOVE TRANS(.k)
  END
  CALL sub(5, m, z[])
  IF m == 6 AND NOT (m > 7) THEN
    LMOVE TRANS(m, z[2])
  ELSE
    LMOVE p1
  END
  i = 0
10 i = i + 1
  IF i < 3 GOTO 10
  CASE i OF
   VALUE 1, 2:
    LMOVE p1
   VALUE 3:
    LMOVE TRANS(3)
   ANY :
    LMOVE p1
  END
  DO
    i = i - 1
  UNTIL i <= 0
  WHILE i < 2 DO
    i = i + 1
    GOTO out
  END
out:
  LMOVE TRANS(i)
  RETURN
  LMOVE p1""",
        more=".PROGRAM sub(.a, .b, .c[])\n.b = .a + 1\n.c[2] = 8\nLMOVE TRANS(.a)\n.END\n",
    )
    assert [p[0] for p in positions(program)] == [1, 4, 5, 6, 3, 1]
    assert positions(program)[3][1] == 8 and not [
        p for p in program.problems if "speed" not in str(p)
    ]


def test_a_program_beside_is_called_with_its_own_points(tmp_path):
    (tmp_path / "OTHER.pg").write_text(
        ".PROGRAM other(.x)\nLMOVE SHIFT(o BY .x)\n.END\n.TRANS\no 7 7 7 0 0 0\n.END\n"
    )
    program = read(tmp_path, "CALL other(1)\nLMOVE p1")
    assert positions(program) == [[8, 7, 7], [100, 200, 300]]
    assert program.motions[0].file == "OTHER.pg"
    assert [p.name for p in side_files(tmp_path / "t.as")] == ["OTHER.pg"]


@pytest.mark.parametrize(
    "body, line",
    [
        ("IF SIG(1001) THEN\nLMOVE p1\nEND", 2),
        ("LMOVE nowhere", 2),
        ("LMOVE #[1,2,3,4,5,6]", 2),
        ("JMOVE #taught", 2),
        ("DRAW 1", 2),
        ("CALL elsewhere", 2),
        ("ALIGN", 2),
        ("DRIVE 6, 90", 2),
        ("HOME", 2),
        ("XMOVE p1 TILL 1001", 2),
        ("WHILE TRUE DO\nLMOVE p1\nEND\nLMOVE p1", 2),
        ("C1MOVE p1\nLMOVE p1", 2),
        ("C2MOVE p1", 2),
        ("GOTO nowhere\nLMOVE p1", 2),
        ("IF SIG(1) GOTO 5\nLMOVE p1\n5 TWAIT 1", 2),
        ("LMOVE p1\nLMOVE HERE", 3),
        ("GLIDE p1", 2),
        ("LMOVE TRANS(1E300*10)", 2),
        ("FOR i = 1 TO SIG(1)\nLMOVE p1\nEND", 2),
        ("TDRAW 1,2,3,4", 2),
        ("LMOVE p1 +", 2),
        ("LMOVE", 2),
    ],
)
def test_what_is_not_known_is_told_at_its_line(tmp_path, body, line):
    program = read(tmp_path, body)
    assert any(problem.line == line for problem in program.problems), told(program)


def test_what_a_branch_may_have_changed_is_not_known(tmp_path):
    program = read(
        tmp_path,
        "i = 1\nIF SIG(1) THEN\ni = 2\nPOINT p1 = TRANS(1)\nTOOL p1\nEND\nLMOVE TRANS(i)\nLMOVE p1",
    )
    assert positions(program) == [None, None] and program.lost == 2
    program = read(tmp_path, "POINT x = TRANS(1)\nTCP_RECV ret, x\nLMOVE x")
    assert positions(program) == [None]
    program = read(tmp_path, "POINT x = TRANS(1)\nCALL elsewhere\nLMOVE x\nLMOVE p1")
    assert positions(program)[-2:] == [None, [100, 200, 300]]


def test_a_person_gives_a_location_and_a_number(tmp_path):
    body = "POINT b = fixture + TRANS(len)\nLMOVE b"
    assert set(read(tmp_path, body).asked) == set()
    assert set(read(tmp_path, "LMOVE fixture").asked) == {"FIXTURE"}
    frame = dict.fromkeys(("y_mm", "z_mm", "a_deg", "b_deg", "c_deg"), 0.0) | {"x_mm": 5.0}
    program = read(tmp_path, body, values={"variables": {"fixture": frame, "len": 2.0}})
    assert positions(program) == [[7, 0, 0]]


def test_a_program_that_is_not_run_is_told(tmp_path):
    program = read(tmp_path, "LMOVE p1", more=".PROGRAM b()\nLMOVE p1\nLMOVE p1\n.END\n")
    assert program.counted() == (1, 3) and "b is not run by t" in told(program)
    program = read(tmp_path, "LMOVE q[2]", "b.as", more=".PROGRAM b()\nLMOVE p1\n.END\n")
    assert positions(program)[0] == [100, 200, 300]


@pytest.mark.parametrize("text", ["", "hello", "; .PROGRAM\n", ".TRANS\np 1 2 3 4 5 6\n.END\n"])
def test_what_is_no_program_is_refused(tmp_path, text):
    (tmp_path / "a.pg").write_text(text)
    with pytest.raises(ProgramError, match="holds no .PROGRAM"):
        read_program(tmp_path / "a.pg")


@pytest.mark.parametrize(
    "body",
    [
        "GOTO 1\n1 LMOVE p1\nGOTO 1",
        "10 i = 1\nLMOVE p1\nGOTO 10",
        "i = 0\n10 i = i + 1\nLMOVE p1\nGOTO 10",
        "CALL t",
        "FOR i = 1 TO 1E9\nLMOVE p1\nEND",
        "FOR i = 1 TO 1E9\nFOR j = 1 TO 1E9\nEND\nEND",
        "DO\nUNTIL FALSE",
        "IF TRUE THEN\n" * 70 + "END\n" * 70,
        "x = " + "(" * 3000,
        "x = " + "1+" * 3000 + "1",
        '$a = "x"\nFOR i = 1 TO 60\n$a = $a + $a\nEND',
        "END\nUNTIL x\nELSE\nVALUE 1:",
        "WHILE",
        "CASE OF",
        "IF",
        "x[1] = 1\nx[x[1]] = 2\nx[ = 3",
    ],
)
def test_endless_and_nested_programs_end(tmp_path, body):
    try:
        assert read(tmp_path, body).problems
    except ProgramError as error:
        assert "t.as:" in str(error)


BODY = """BASE NULL
  TOOL TRANS(0,0,100)
  SPEED 100 MM/S ALWAYS
  LAPPRO p1, 50
  FOR i = 1 TO 3
    LMOVE SHIFT(p1 BY 10*i, 0, 0)
  END
  C1MOVE TRANS(1,1,0)
  C2MOVE TRANS(2,0,0)
  CALL sub(i, k)
  IF k == 6 THEN
    DRAW 1,2,3
  END
10 i = i - 1
  IF i > 0 GOTO 10
  CASE i OF
   VALUE 0:
    LMOVE p1 + TRANS(1,2,3,4,5,6)
  END"""
SUB = ".PROGRAM sub(.a, .b)\n.b = .a + 2\n.END\n"


def test_damaged_programs_are_read_or_refused(tmp_path):
    rng = random.Random(5)
    text = f".PROGRAM t()\n{BODY}\n.END\n{SUB}{DATA}"
    for _ in range(300):
        damaged = list(text)
        for _ in range(rng.randint(1, 5)):
            at, kind = rng.randrange(len(damaged)), rng.random()
            if kind < 0.3:
                del damaged[at : at + rng.randint(1, 20)]
            elif kind < 0.7:
                damaged[at] = rng.choice('()[],.#;"+-*/<>=019abAB \n&$^\x7f\xe9')
            else:
                damaged[at:at] = damaged[at : at + rng.randint(1, 60)]
        (tmp_path / "t.as").write_text("".join(damaged))
        try:
            program = read_program(tmp_path / "t.as")
            program.path_arrays(100.0)
        except ProgramError as error:
            assert str(error)


DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_the_skeleton_of_a_language_runs(capsys):
    code = (DOCS / "adding-a-language.md").read_text().split("```python\n")[1].split("```")[0]
    found = {}
    exec(code, found)
    assert found["program"].counted() == (3, 4)
    assert [m.pose[0, 3] for m in found["program"].motions if m.pose is not None] == [10, 20, 30]
    assert "a.example:8: IF is decided at run time" in capsys.readouterr().out


def test_a_jump_in_a_block_that_may_run_is_one_that_may_be_made(tmp_path):
    path = tmp_path / "a.as"
    path.write_text(
        ".PROGRAM a()\n LMOVE p1\n IF SIG(1) THEN\n GOTO 10\n END\n LMOVE p2\n10 LMOVE p3\n.END\n"
        ".TRANS\np1 10 0 0 0 0 0\np2 20 0 0 0 0 0\np3 30 0 0 0 0 0\n.END\n"
    )
    program = read_program(path)
    assert [(m.kind, m.line) for m in program.motions] == [("LIN", 2), ("GAP", 3), ("LIN", 7)]
    assert program.lost
