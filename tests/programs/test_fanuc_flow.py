"""Fanuc TP: position registers that the program sets, offset conditions, programs that are called, arithmetic."""

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.fanuc import reader as fanuc
from beltgrinding.programs.languages.side_files import side_files
from beltgrinding.programs.registry import read_program


def position(n, x, y=0.0):
    return (
        f"P[{n}]{{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x}.0 mm, Y = {y} mm, "
        "Z = 7.0 mm,\n\tW = 180.0 deg, P = 0.0 deg, R = 0.0 deg\n};\n"
    )


def tp(folder, *statements, name="P", scale=10):
    rows = [f"{k:4}:{text} ;" for k, text in enumerate(statements, 1)]
    points = "".join(position(n, scale * n) for n in (1, 2, 3))
    path = folder / f"{name}.LS"
    path.write_text("\n".join([f"/PROG {name}", "/MN", *rows, "/POS", points + "/END", ""]))
    return path


def read(folder, *statements, **more):
    return read_program(tp(folder, *statements, **more))


def to(n, more=""):
    return f"L P[{n}] 9mm/sec FINE{more}"


def places(program):
    return [
        m.pose[:3, 3].round(6).tolist() if m.pose is not None else None for m in program.motions
    ]


ZERO = [f"PR[5,{k}]=0" for k in range(1, 7)]


@pytest.mark.parametrize(
    "statements, expected",
    [
        ((*ZERO, "PR[5,3]=12.5", to(1, " Offset,PR[5]")), [[10, 0, 19.5]]),
        ((*ZERO, "PR[5,3]=12.5", to(1, " Tool_Offset,PR[5]")), [[10, 0, -5.5]]),
        ((*ZERO, "PR[5,1]=1", to(1, " Tool_Offset,PR[5] Offset,PR[5]")), [[12, 0, 7]]),
        ((*ZERO, "PR[5,2:dy]=(R[1]-3)*2", "OFFSET CONDITION PR[5:off]", to(1, " Offset")), None),
        (("R[1]=5", *ZERO, "PR[5,2:dy]=(R[1]-3)*2", "OFFSET CONDITION PR[5:off]", to(1, " Offset"), to(2)),
         [[10, 4, 7], [20, 0, 7]]),
        ((*ZERO, "PR[5,1]=3", "TOOL_OFFSET CONDITION PR[5]", to(1, " Tool_Offset")), [[13, 0, 7]]),
        (("PR[1]=P[2]", "PR[1,3]=PR[1,3]+50", "L PR[1] 9mm/sec FINE"), [[20, 0, 57]]),
        ((to(3), "PR[1]=LPOS", "PR[1,1]=PR[1,1]-5", "L PR[1] 9mm/sec FINE"), [[30, 0, 7], [25, 0, 7]]),
        ((*ZERO, "PR[5,1]=4", "PR[1]=P[1]+PR[5]", "L PR[1] 9mm/sec FINE"), [[14, 0, 7]]),
        (("PR[R[1],3]=1", "PR[1]=P[1]", "R[2]=1", "L PR[R[2]] 9mm/sec FINE"), [[10, 0, 7]]),
        (("R[1]=2", "R[2]=7 DIV R[1]", "R[3]=7 MOD 4", "IF (R[2]=3 AND R[3]=3),JMP LBL[1]", to(1), "LBL[1]", to(2)),
         [[20, 0, 7]]),
        (("R[1]=1", "IF R[1]+1=2 OR DI[1]=ON THEN", to(1), "ELSE", to(2), "ENDIF"), [[10, 0, 7]]),
        (("PR[1]=P[1]", "R[1]=0", "LBL[1]", "L PR[1] 9mm/sec FINE", "PR[1,1]=PR[1,1]+1", "R[1]=R[1]+1",
          "IF R[1]<3,JMP LBL[1]"), [[10, 0, 7], [11, 0, 7], [12, 0, 7]]),
        (("PR[GP2:5,1]=9", *ZERO, to(1, " Offset,PR[5]")), [[10, 0, 7]]),
    ],
)  # fmt: skip
def test_position_registers_that_the_program_sets(tmp_path, statements, expected):
    program = read(tmp_path, *statements)
    if expected is None:
        assert places(program) == [None] and list(program.asked) == ["R[1]"]
        return
    assert places(program) == expected and not program.lost, program.problems
    assert not program.asked


@pytest.mark.parametrize(
    "statements, culprit",
    [
        ((to(1, " Offset"),), "no OFFSET CONDITION"),
        ((*ZERO, "OFFSET CONDITION PR[5]", "PR[5,1]=2", to(1, " Offset")), "changed after"),
        ((*ZERO, "OFFSET CONDITION PR[5],UFRAME[1]", to(1, " Offset")), "not understood"),
        (("PR[1]=JPOS", "L PR[1] 9mm/sec FINE"), "set by the program, in line 3"),
        (("PR[1]=LPOS", "L PR[1] 9mm/sec FINE"), "set by the program"),
        (("PR[1]=P[1]", "PR[1,2]=GI[1]", "L PR[1] 9mm/sec FINE"), "not known before it runs"),
        (("PR[1]=P[1]", "IF DI[1]=ON,PR[1]=P[2]", "L PR[1] 9mm/sec FINE"), "set by the program"),
        (("PR[1]=P[1]", "RUN OTHER", "L PR[1] 9mm/sec FINE"), "set by the program"),
        (("PR[1]=P[1]", "PR[R[9]]=P[2]", "L PR[1] 9mm/sec FINE"), "set by the program"),
        (
            ("PR[1]=P[1]", "FOR R[1]=1 TO R[9]", "PR[1,1]=3", "ENDFOR", "L PR[1] 9mm/sec FINE"),
            "set by the program",
        ),
        (
            (*ZERO, "IF DI[1]=ON THEN", "OFFSET CONDITION PR[5]", "ENDIF", to(1, " Offset")),
            "run time",
        ),
        ((*ZERO, "C P[1] P[2] 9mm/sec FINE Offset,PR[5]"), "arc"),
        ((to(1, " Skip,LBL[1]"), "LBL[1]"), "Skip"),
    ],
)
def test_what_is_not_known_of_them_is_a_gap(tmp_path, statements, culprit):
    program = read(tmp_path, *statements, to(3))
    assert any(culprit in str(p) for p in program.problems), program.problems
    assert places(program)[-2:] == [None, [30, 0, 7]]


def test_programs_that_are_called_lie_beside(tmp_path):
    tp(tmp_path, "IF AR[1]<1,JMP LBL[1]", to(1), "LBL[1]", "R[7]=AR[1]+AR[2]", "PR[1]=P[2]", "END", to(3), name="SUB",
       scale=100)  # fmt: skip
    path = tp(tmp_path, to(1), "R[2]=4", "CALL SUB(1,R[2]+1)", "IF R[7]<>6,JMP LBL[9]", to(2), "L PR[1] 9mm/sec FINE",
              "CALL sub(0,0)", "LBL[9]", "CALL MISSING", to(3))  # fmt: skip
    program = read_program(path)
    assert [p and p[0] for p in places(program)] == [10, 100, 20, 200, None, 30]
    assert [m.line for m in program.motions] == [3, 5, 7, 8, 11, 12]
    assert {m.file for m in program.motions} == {"P.LS"}
    assert [str(p) for p in program.problems] == [
        "P.LS:11: MISSING is not in this file; motions in it are left out"
    ]
    assert [p.name for p in side_files(path)] == ["SUB.LS"]
    # ABORT ends all; a program that calls itself, or cannot be read, is left out and told.
    tp(tmp_path, to(1), "ABORT", name="SUB")
    assert [p[0] for p in places(read(tmp_path, "CALL SUB", to(2)))] == [10]
    tp(tmp_path, to(1), "CALL SUB", name="SUB")
    assert places(read(tmp_path, "CALL SUB", to(2))) == [[10, 0, 7], None, [20, 0, 7]]
    (tmp_path / "SUB.LS").write_text("/PROG SUB\n/MN\n1:L P[1]\n/POS\n/END\n")
    program = read(tmp_path, "CALL SUB", to(2))
    assert places(program) == [None, [20, 0, 7]]
    assert "SUB.LS:3: the statement does not end" in str(program.problems[0])
    # A loop without end in a called program is told, and nothing is read beyond it.
    tp(tmp_path, "LBL[1]", to(1), "JMP LBL[1]", name="SUB")
    program = read(tmp_path, "CALL SUB", to(2))
    assert places(program) == [[10, 0, 7]] and "endless" in str(program.problems[0])


@pytest.mark.parametrize(
    "statements, expected, lost",
    [
        # A jump in a block that is decided at run time is one that may be made.
        ((to(1), "IF DI[1]=ON THEN", "JMP LBL[9]", "ENDIF", to(2), "LBL[9]", to(3)), [10, None, 30], 1),
        (("FOR R[1]=1 TO 2", "IF DI[1]=ON,JMP LBL[9]", to(1), "ENDFOR", to(2), "LBL[9]", to(3)), [None, 30], 2),
        # Of what jumps over it before its pass ends a loop has its counters from here on.
        (("R[2]=1", "FOR R[1]=1 TO 2", "R[2]=R[2]+1", "IF DI[1]=ON,JMP LBL[9]", to(1), "ENDFOR", "LBL[9]",
          "L P[R[2]] 9mm/sec FINE", to(3)), [None, 30], 2),
        (("IF DI[1]=ON,CALL SUB", to(3)), [None, 30], 1),
        (("IF DI[1]=ON,CALL QUIET", to(3)), [30], 0),
        (("SELECT R[1]=1,JMP LBL[1]", "=2,CALL SUB", "ELSE,JMP LBL[3]", "LBL[1]", to(1), "LBL[3]", to(3)),
         [None, 30], 1),
        (("R[1]=2", "SELECT R[1]=1,JMP LBL[1]", "=2,CALL SUB", "ELSE,JMP LBL[3]", "LBL[1]", to(1), "LBL[3]", to(3)),
         [200, 10, 30], 0),
        (("R[1]=7", "SELECT R[1]=1,JMP LBL[1]", "ELSE,JMP LBL[3]", "LBL[1]", to(1), "LBL[3]", to(3)), [30], 0),
        (("FOR R[1]=1 TO R[5]", to(1), to(2), "ENDFOR", to(3)), [None, 30], 2),
        # A count of parts in the main loop does not keep it from being one.
        (("R[1]=0", "LBL[1]", to(1), "R[1]=R[1]+1", "JMP LBL[1]"), [10], 0),
        (("R[1]=1", "IF R[1]=1 AND (R[1]=2 OR R[1]<3),JMP LBL[1]", to(1), "LBL[1]", to(2)), [20], 0),
        ((to(1), "ENDIF", to(2)), [10, None, 20], 1),
        ((to(1), "IF R[1]>4 ZTHEN", to(2), "ELSE", to(3), "ENDIF", to(3)), [10, None, 20, None], 2),
    ],
)  # fmt: skip
def test_the_way_through_blocks_and_jumps(tmp_path, statements, expected, lost):
    tp(tmp_path, to(2), name="SUB", scale=100)
    tp(tmp_path, "DO[1]=ON", name="QUIET")
    program = read(tmp_path, *statements)
    assert [p and p[0] for p in places(program)] == expected, program.problems
    endless = [problem for problem in program.problems if "endless" in str(problem)]
    assert program.lost == lost and bool(program.problems) == (lost > 0 or bool(endless))


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(8)
    tp(tmp_path, "IF AR[1]<1,JMP LBL[1]", to(1), "LBL[1]", name="SUB")
    source = tp(
        tmp_path, *ZERO, "R[1]=(2+3)*4-1", "PR[5,2]=R[1] DIV 3", "OFFSET CONDITION PR[5]", to(1, " Offset"),
        to(2, " Tool_Offset,PR[5] Offset,PR[5]"), "PR[1]=LPOS", "PR[2]=PR[1]+P[1]-PR[5]", "L PR[2] 9mm/sec FINE",
        "CALL SUB(R[1],2)", "FOR R[3]=1 TO 3", "PR[2,R[3]]=R[3]*2", "L PR[2] 9mm/sec FINE", "ENDFOR",
        "IF (R[1]>3 AND R[3]<9) THEN", to(3), "ENDIF",
    ).read_bytes()  # fmt: skip
    letters = b"0123456789PRLJ[]=,.-+*()<> ;:\r\n"
    file = tmp_path / "m.ls"
    for k in range(400):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = (
                letters[rng.integers(len(letters))] if k % 3 else rng.integers(256)
            )
        file.write_bytes(bytes(bad))
        try:
            program = fanuc.read(file, {"PR[5]": (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)})
        except ProgramError:
            continue
        assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
