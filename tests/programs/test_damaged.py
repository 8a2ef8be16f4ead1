"""What fuzzing the readers of programs (tests/fuzz/fuzz_programs.py) once found."""

import time
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program
from support.cost import cost

ROOT = Path(__file__).resolve().parents[2]

LIN = "LIN {X 1,Y 2,Z 3,A 4,B 5,C 6}\n"
POINT = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
MOVE = f"MoveL {POINT},v100,fine,tool0;\n"
LS = "/PROG A\n/MN\n{}/POS\n/END\n"


def read(tmp_path, name, text):
    path = tmp_path / name
    path.write_bytes(text.encode("latin-1"))
    return read_program(path)


@pytest.fixture(scope="module")
def ordinary(tmp_path_factory):
    """CPU time in s of a long program that asks for nothing."""
    folder, text = tmp_path_factory.mktemp("ordinary"), "DEF a()\n" + 20_000 * LIN + "END\n"
    return cost(lambda: read(folder, "a.src", text))


def soon(ordinary, work, times=5):
    """What ``work()`` gives: it takes no longer than ``times`` the reading of 20,000 motions, by the least of three."""
    least = float("inf")
    for _ in range(3):
        begin = time.process_time()
        found = work()
        least = min(least, time.process_time() - begin)
        if least < times * ordinary:
            return found
    pytest.fail(f"{least:.2f} s, of 20,000 motions {ordinary:.2f} s")


def refused_soon(ordinary, match, work):
    """``work()`` is refused, no later than ``soon``."""

    def refused():
        with pytest.raises(ProgramError, match=match):
            work()

    soon(ordinary, refused)


@pytest.mark.parametrize(
    "name, text, line",
    [
        ("cut.apt", "UNITS/MM\nGOTO/1,2,3.4", 2),
        ("cut.apt", "UNITS/MM\nGOTO/1,2,3\nEND-OF-PATH\nGOTO/1,2,3.4", 4),
        ("cut.nc", "G21 G90\nG1 X1 Y2 Z3.4", 2),
        ("cut.nc", "%\nG21 G90\nG1 X1 Y2 Z3.4\nM3", 4),
        ("cut.csv", "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg\n1,2,3,4,5,6\n1,2,3,4,5,6.7", 3),
        ("cut.src", "DEF a()\n" + LIN, 2),
    ],
)
def test_a_file_cut_off_is_said(tmp_path, name, text, line):
    problems = read(tmp_path, name, text).problems
    assert [(p.file, p.line) for p in problems] == [(name, line)]
    assert "cut" in str(problems[0])


@pytest.mark.parametrize(
    "name, text",
    [
        ("whole.apt", "UNITS/MM\nGOTO/1,2,3\nFINI"),
        ("whole.apt", "UNITS/MM\nGOTO/1,2,3\nEND-OF-PATH\n$$ NX"),
        ("whole.nc", "G21 G90\nG1 X1 Y2 Z3.4\nM30"),
        ("whole.nc", "%\nG21 G90\nG1 X1 Y2 Z3.4\n%"),
        ("whole.mpf", "G71 G90\nN20 G1 X1 Y2 Z3.4\nN30 RET\n"),
        ("whole.csv", "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg\n1,2,3,4,5,6.7\n"),
        ("whole.src", "DEF a()\n" + LIN + "END"),
    ],
)
def test_a_whole_file_is_no_problem(tmp_path, name, text):
    program = read(tmp_path, name, text)
    assert len(program.motions) == 1 and not program.problems


CALLED = zip("bcdefghij", "cdefghijk")
LOOPS = {
    "empty.src": "DEF a()\nFOR I=1 TO 1000000000\nENDFOR\nEND\n",
    "long.src": "DEF a()\nFOR I=1 TO 9999999\nX=1" + "+1" * 5000 + "\nENDFOR\nEND\n",
    "nested.src": "DEF a()\n" + "IF 1==1 THEN\n" * 2000 + LIN + "ENDIF\n" * 2000 + "END\n",
    "self.src": "DEF a()\n" + LIN + "a()\na()\nEND\n",
    "empty.mod": "MODULE a\nPROC main()\nFOR i FROM 1 TO 1000000000 DO\nENDFOR\nENDPROC\nENDMODULE",
    "relative.mod": "MODULE a\nPROC main()\nFOR i FROM 1 TO 100000 DO\nMoveL "
    + "RelTool(" * 20
    + POINT
    + ",1,2,3)" * 20
    + ",v100,fine,tool0;\nENDFOR\nENDPROC\nENDMODULE",
    "calls.mod": "MODULE a\nPROC main()\nb;\nENDPROC\n"
    + "".join(f"PROC {name}()\n" + f"{next_};\n" * 30 + "ENDPROC\n" for name, next_ in CALLED)
    + "PROC k()\n"
    + MOVE
    + "ENDPROC\nENDMODULE",
    "registers.ls": LS.format(
        "".join(f" {k}: R[{k}]=0 ;\n" for k in range(1, 3000))
        + " 1: LBL[1] ;\n 2: R[1]=R[1]+1 ;\n 3: JMP LBL[1] ;\n"
    ),
}


@pytest.mark.parametrize("name", LOOPS)
def test_endless_work_is_refused_soon(tmp_path, ordinary, name):
    match = rf"{name}:\d+: .*(too long|too deeply|does not end)"
    refused_soon(ordinary, match, lambda: read(tmp_path, name, LOOPS[name]))


def test_a_loop_over_all_points_of_a_file_is_followed(tmp_path):
    count = 25_000
    points = "".join(f"P[{k}]={{X {k},Y 0,Z 0,A 0,B 0,C 0}}\n" for k in range(1, count + 1))
    (tmp_path / "a.dat").write_text("DEFDAT a\n" + points + "ENDDAT\n")
    text = f"DEF a()\nFOR I=1 TO {count}\n$VEL.CP=0.1\nLIN P[I] C_DIS\nENDFOR\nEND\n"
    program = read(tmp_path, "a.src", text)
    assert len(program.motions) == count and not program.problems


def test_a_loop_without_its_end_is_followed_once(tmp_path):
    program = read(tmp_path, "a.script", "while 1 < 2:\n  movel(p[0,0,0,0,0,0])\n")
    assert len(program.motions) == 1
    assert "while has no end" in str(program.problems[0])


def test_a_huge_array_is_not_made(tmp_path, ordinary):
    text = f"MODULE a\nVAR robtarget p{{1000,1000}};\nPROC main()\n{MOVE}ENDPROC\nENDMODULE"
    assert len(soon(ordinary, lambda: read(tmp_path, "a.mod", text), 1).motions) == 1


def test_a_head_that_swallows_a_statement_is_refused(tmp_path):
    with pytest.raises(ProgramError, match="a.mod:2: the head of this PROC"):
        read(tmp_path, "a.mod", f"MODULE a\nPROC main(\nb(1);\n{MOVE}ENDPROC\nENDMODULE")


@pytest.mark.parametrize(
    "name, text",
    [
        ("a.script", "movel(p[0,0,0,0,0,0])\nmovel(p[1,0,0,0,0,0], t=1e-320)\n"),
        ("a.script", "movel(p[0,0,0,0,0,0])\nmovel(p[1,0,0,0,0,0], v=1e308)\n"),
        ("a.src", f"DEF a()\n{LIN}$VEL.CP=1e308\n{LIN}END\n"),
    ],
)
def test_a_speed_beyond_all_bounds_is_not_known(tmp_path, name, text):
    program = read(tmp_path, name, text)
    assert program.motions[1].speed_mm_s is None and program.problems


@pytest.mark.parametrize("text", ["X 99999999999", "X 1e308", "X #1"])
def test_a_position_beyond_all_bounds_is_left_out(tmp_path, text):
    program = read(
        tmp_path, "a.src", f"DEF a()\n{LIN}LIN {{{text}}}\nLIN $NULLFRAME:{{{text}}}\nEND\n"
    )
    assert [motion.pose is None for motion in program.motions] == [False, True, True]
    assert len(program.problems) == 2
    assert np.isfinite(program.path_arrays(10.0)["frames"]).all()


def test_a_csv_beyond_all_bounds_is_refused(tmp_path):
    with pytest.raises(ProgramError, match="a.csv:2: x_mm is 9e.09"):
        read(tmp_path, "a.csv", "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg\n9E9,2,3,4,5,6\n")


def test_krl_words_that_are_not_understood_are_said(tmp_path):
    program = read(tmp_path, "a.src", f"DEF a()\n{LIN}LIM {{X 1}}\nBAS(#\nGOTO M1\n{LIN}END\n")
    assert [p.line for p in program.problems] == [3, 4, 5]
    assert program.motions[1].speed_mm_s is None
    assert [m.kind for m in program.motions].count("LIN") == 1  # where the jump goes nobody knows


def test_krl_leaves_loops_and_routines(tmp_path):
    text = (
        "DEF a()\nFOR I=1 TO 5\nIF I==3 THEN\nEXIT\nENDIF\nLIN {X I,Y 0,Z 0,A 0,B 0,C 0}\n"
        "ENDFOR\nb()\nLIN {X 8}\nEND\nDEF b()\nLIN {X 7}\nRETURN\nLIN {X 9}\nEND\n"
    )
    program = read(tmp_path, "a.src", text)
    assert [motion.pose[0, 3] for motion in program.motions] == [1, 2, 7, 8]
    assert not program.problems


VAL3 = (
    '<Programs xmlns="http://www.staubli.com/robotics/VAL3/Program/2">\n'
    '<Program name="a"><Code><![CDATA[begin\n{}end]]></Code></Program></Programs>\n'
)
VAL3_DATA = (
    '<Database xmlns="http://www.staubli.com/robotics/VAL3/Data/2"><Datas>\n'
    '<Data name="t" type="tool" size="1"><Value key="0" fatherId="flange[0]"/></Data>\n'
    '<Data name="m" type="mdesc" size="1"><Value key="0" tmax="100"/></Data>\n'
    '<Data name="p" type="pointRx" size="2"><Value key="0" x="1" fatherId="{0}"/>\n'
    '<Value key="1" x="2" fatherId="{1}"/></Data></Datas></Database>\n'
)


def val3(tmp_path, code, fathers=("world[0]", "world[0]")):
    (tmp_path / "a.dtx").write_text(VAL3_DATA.format(*fathers))
    return read(tmp_path, "a.pgx", VAL3.format(code))


def test_an_endless_val3_loop_is_refused_soon(tmp_path, ordinary):
    (tmp_path / "b.pgx").write_text(VAL3.format("return\n" + "x=1\n" * 1000).replace('"a"', '"b"'))
    for body in ("movel(p[0],t[0],m[0])", "call b()"):
        code = f"for l_n=1 to 9E9\n{body}\nendFor\n"
        refused_soon(ordinary, r"[ab].pgx:\d+: .*(too long|not end)", lambda: val3(tmp_path, code))


@pytest.mark.parametrize("fathers", [("nowhere", "f[#1]"), ("p", "t"), ("f[http]", "world[0]")])
def test_a_val3_point_in_no_frame_is_left_out(tmp_path, fathers):
    code = "movej(p[0],t[0],m[0])\nmovel(p[1],t[0],m[0])\nmovec(p[1],p[0],t[0],m[0])\n"
    program = val3(tmp_path, code, fathers)
    assert program.motions[0].pose is None and program.problems


def test_a_val3_call_cut_off_in_a_skipped_block_is_a_gap(tmp_path):
    code = "if(diIn[0])\ncall b(p[0],\nendIf\nmovel(p[0],t[0],m[0])\n"
    program = val3(tmp_path, code)
    assert program.motions[0].pose is None
    assert "if is decided at run time" in str(program.problems[0])


def test_an_endless_polyscope_loop_is_refused_soon(tmp_path, ordinary):
    inner = '<Loop type="Counting" count="999999"><children>{}</children></Loop>'
    text = (
        "<URProgram><children><MainProgram><children>"
        + inner.format(inner.format("<Comment/>"))
        + "</children></MainProgram></children></URProgram>"
    )
    refused_soon(
        ordinary,
        "a.urp:1: the program is too long",
        lambda: read(tmp_path, "a.urp", text),
    )
