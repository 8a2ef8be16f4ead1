"""KRL's variables: paths, types, scopes, what WITH sets, and what is unknown behind a statement."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.registry import read_program

FAULTS = Path(os.environ.get("BELTGRINDING_SHARED", Path(__file__).resolve().parents[3] / "shared"))
FAULTS = FAULTS / "faults"
needs_faults = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")
FULL = "{X 1,Y 2,Z 3,A 0,B 90,C 0}"
HEAD = "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n$VEL.CP=0.1\n"
FIRST = 5  # line of a body's first statement


def read(folder, body, tail="", data=None, **values):
    (folder / "p.src").write_text(f"DEF p()\n{HEAD}{body}\nEND\n{tail}")
    if data is not None:
        (folder / "p.dat").write_text(f"DEFDAT p\n{data}\nENDDAT\n")
    return read_program(folder / "p.src", **values)


def places(program):
    """Places of the motions, None for a gap."""
    return [
        None if m.pose is None else np.round(m.pose[:3, 3], 9).tolist() for m in program.motions
    ]


def xs(program):
    return [place and place[0] for place in places(program)]


@needs_faults
def test_flow_and_components(tmp_path):
    program = read_program(FAULTS / "krl_flow.src")
    turned = [[0, 0, 0, a, 0, 0] for a in (0, 5, 10)]
    held = [
        [100, 0, 0], [110, 4, 0], [120, 8, 0], [130, 12, 0],
        *([100, 0, z] for z in (5, 10, 5, 0)), [0, 0, 0], [1, 0, 0],
    ]  # fmt: skip
    expected = [[*place, 0, 90, 0] for place in held] + 3 * turned
    expected += 2 * [[0, 0, 77, 10, 0, 0]] + [[10, 10, 77, 10, 0, 0], [20, 0, 77, 10, 0, 0]]
    assert len(program.motions) == len(expected)
    for motion, six in zip(program.motions, expected):
        np.testing.assert_allclose(motion.pose, frames.from_abc(six[:3], six[3:]), atol=1e-9)
    assert [m.kind for m in program.motions][-2:] == ["CIRC", "CIRC"] and program.motions[-2].aux
    assert {m.speed_mm_s for m in program.motions[1:]} == {100.0}
    assert [p.code for p in program.problems] == ["programs.krl.zeroed"]


@needs_faults
def test_whole_structures_and_routines(tmp_path):
    program = read_program(FAULTS / "whole_assign.src")
    assert [p[2] for p in places(program)] == [50, 75, 50, 95, 70] and not program.problems
    program = read_program(FAULTS / "sub_params.src")
    assert places(program)[1:] == [[100, 0, 0], [100, 10, 0], [100, 20, 0], [120, 20, 0]]
    assert [m.speed_mm_s for m in program.motions] == [None, 100, 50, 50, 50]
    assert not program.problems


@needs_faults
def test_what_with_sets(tmp_path):
    program = read_program(FAULTS / "with_base.src")
    path = program.path_arrays(50.0)
    assert not program.problems and not path["gaps"].any()
    wanted = [[0, 0, 50], [0, 0, 0], [50, 200, 0], [20, 0, 0], [100, 0, 0]]
    np.testing.assert_allclose(path["frames"][:, :3, 3], wanted, atol=1e-9)
    program = read_program(FAULTS / "with_vel.src")
    assert [m.speed_mm_s for m in program.motions] == [None, 7, 7, 20, 30]
    assert not program.problems


FORM = (
    "$VEL=SVEL_CP(0.5, , L1), $TOOL=STOOL2(FP1), $BASE=SBASE(FP1), $IPO_MODE=SIPO_MODE(FP1), "
    "$LOAD=SLOAD(FP1.TOOL_NO), $ACC=SACC_CP(L1), $ORI_TYPE=SORI_TYP(L1), $APO=SAPO(L1), $JERK=SJERK(L1)"
)
FORM_DATA = (
    "DECL FDAT FP1={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE}\nDECL LDAT L1={VEL 1,APO_DIST 5.0,ORI_TYP #CONSTANT}\n"
    "BASE_DATA[2]={X 0,Y 50,Z 0,A 0,B 0,C 0}\nTOOL_DATA[1]={X 0,Y 0,Z 90,A 0,B 0,C 0}"
)


def test_inline_forms_of_splines(tmp_path):
    program = read(tmp_path, f"SLIN {FULL} WITH {FORM} C_SPL\nSLIN {FULL}", data=FORM_DATA)
    form, plain = program.motions
    assert (form.speed_mm_s, form.zone_mm, form.turn) == (500, 5.0, "hold")
    assert (plain.speed_mm_s, plain.zone_mm, plain.turn) == (100, 0.0, "")
    assert form.base == "X 0 Y 50 Z 0 A 0 B 0 C 0" and form.tool == "X 0 Y 0 Z 90 A 0 B 0 C 0"
    assert plain.base == "X 0 Y 0 Z 0 A 0 B 0 C 0" and not program.problems
    program = read(tmp_path, f"SLIN {FULL} WITH {FORM}\nSLIN {FULL}", data="")
    assert [m.kind for m in program.motions] == [
        "GAP",
        "LIN",
    ]  # without FP1 its IPO_MODE is not known


@pytest.mark.parametrize(
    "setting",
    ["$BASE=unknown", "$TOOL.Z=unknown", "$BASE=made(1)", "$TOOL={X 1}", "$BASE={ZX 1}", "$BASE 3"],
)
def test_a_frame_behind_with_that_is_not_known_is_another_frame(tmp_path, setting):
    program = read(tmp_path, f"LIN {FULL}\nSLIN {FULL} WITH {setting}\nLIN {FULL}\nLIN {{X 4}}")
    assert xs(program)[-2:] == [1, 4]
    path = program.path_arrays(50.0)
    assert path["lines"].tolist() == [5, 7, 8] and path["rapid"].tolist() == [True, True, False]
    assert {6} <= {p.line for p in program.problems}


@pytest.mark.parametrize("setting", ["$IPO_MODE=#T", "$ZZ=1", "zz.X=3", "[]"])
def test_what_with_sets_that_is_not_understood_leaves_the_motion_out(tmp_path, setting):
    program = read(tmp_path, f"LIN {FULL}\nSLIN {{X 9}} WITH {setting}\nLIN {FULL}")
    assert xs(program) == [1, None, 1]
    program = read(tmp_path, f"SPLINE WITH {setting}\nSPL {FULL}\nENDSPLINE\nLIN {FULL}")
    assert xs(program) == [None, 1]


def test_a_spline_s_end_that_is_not_understood(tmp_path):
    program = read(
        tmp_path, f"SPLINE WITH $VEL.CP=0.02\nSPL {FULL}\nENDSPL\nSLIN {FULL}\nLIN {FULL}"
    )
    assert [(m.speed_mm_s, m.zone_mm) for m in program.motions if m.pose is not None] == [
        (20, np.inf), (None, None), (100, 0),
    ]  # fmt: skip
    program = read(tmp_path, f"SPLINE WITH $VEL.CP=0.02\nSPL {FULL}\nLIN {FULL}")
    assert [m.speed_mm_s for m in program.motions] == [20, 100] and len(program.problems) == 1


@pytest.mark.parametrize(
    "statement",
    [
        "p1=unknown", "p1.X=unknown", "q[k]=p1\np1=q[2]", "p1.ZX=4", "p1[k]=3", "made(p1)", "x=made(p1)",
        "CREAD(h,state,p1)", "p1 ? 3", "READ p1", "IF $IN[1] THEN\np1.X=4\nENDIF", "TRIGGER WHEN PATH=0 DELAY=0 DO p1.X=4",
        "INTERRUPT DECL 3 WHEN $IN[1] DO made(p1)", "IF $IN[1] THEN\ninside()\nENDIF", "x=1/0+changes(p1)",
    ],
)  # fmt: skip
@pytest.mark.parametrize("data", [None, f"DECL FRAME p1={FULL}\nDECL FRAME q[2]\nq[2]={FULL}"])
def test_what_a_statement_may_change_is_unknown(tmp_path, statement, data):
    tail = "DEF inside()\np1.X=5\nEND\nDEFFCT INT changes(f:OUT)\nDECL FRAME f\nf.X=8\nRETURN 3\nENDFCT\n"
    before = f"p1={FULL}\nq[1]=p1\n" if data is None else ""
    program = read(tmp_path, f"{before}LIN p1\n{statement}\nLIN p1\nLIN {FULL}", tail, data)
    assert xs(program)[0] == 1 and xs(program)[-2:] == [None, 1]
    assert program.problems
    again = f"{before}LIN p1\n{statement}\np1={FULL}\nLIN p1"
    if "TRIGGER" not in statement and "INTERRUPT" not in statement:  # those come at any time
        assert xs(read(tmp_path, again, tail, data))[-1] == 1


def test_what_is_not_touched_stays(tmp_path):
    program = read(
        tmp_path,
        f"p1={FULL}\np2=p1\np2.X=2\nmade(p1)\nLIN p2\np1=p2\np2.X=unknown\nLIN p1\nq[1]=p1\nq[2].X=made(3)\nLIN q[1]",
    )
    assert [x for x in xs(program) if x is not None] == [2, 2, 2]


def test_a_value_that_was_given_or_listed_does_not_come_back(tmp_path):
    point = dict(zip(("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg"), (7, 0, 0, 0, 0, 0)))
    values = {"variables": {"G1": point}}
    program = read(tmp_path, "LIN g1\ng1.Y=3\nLIN g1\ng1=unknown\nLIN g1", values=values)
    assert places(program) == [[7, 0, 0], [7, 3, 0], None]
    program = read(tmp_path, f"LIN {FULL}\ng1.Y=3\nLIN g1")
    assert xs(program) == [1, None] and program.asked == {"G1": "frame"}


def test_types(tmp_path):
    program = read(
        tmp_path,
        "DECL INT i, j\nDECL REAL x\ni=5/2\nj=2.5\nx=5/2\n"
        f"LIN {FULL}\nLIN {{X i,Y j,Z x}}\nLIN {{X 7.0/2,Y -7/2,Z 4*2/3}}\nLIN {{X 'HFF' B_AND 'B1010'}}",
    )
    assert places(program)[1:] == [[2, 3, 2], [3.5, -3, 2], [10, -3, 2]] and not program.problems
    program = read(tmp_path, f"n=3\nm=4\nLIN {FULL}\nLIN {{X m/2}}\nLIN {{X n/2}}")
    assert xs(program) == [1, 2, None] and "3 / 2" in str(program.problems[0])
    program = read(tmp_path, f"b=FALSE\nIF NOT b AND TRUE EXOR FALSE THEN\nLIN {FULL}\nENDIF")
    assert xs(program) == [1] and not program.problems
    program = read(tmp_path, f"x=0.1+0.2\nIF x>0.3 THEN\nLIN {FULL}\nENDIF")
    assert xs(program) == [None] and "too close" in str(program.problems[0])


def test_partial_targets_are_in_the_frames_of_their_motion(tmp_path):
    body = f"LIN {FULL}\n$BASE={{X 10,Y 0,Z 0,A 90,B 0,C 0}}\nLIN_REL {{X 1}}\nLIN {{Z 77}}"
    assert places(read(tmp_path, body)) == [[1, 2, 3], [3, 9, 3], [3, 9, 77]]
    body = f"LIN {FULL}\n$BASE=unknown\nLIN_REL {{X 1}}\nLIN {{Z 77}}\nLIN {FULL}"
    assert xs(read(tmp_path, body)) == [1, None, None, 1]


def test_a_frame_turned_round(tmp_path):
    body = f"DECL FRAME f\nf={{X 5,Y 0,Z 0,A 90,B 0,C 0}}\nLIN INV_POS(f)\nLIN f:INV_POS(f)\nLIN INV_POS(g)"
    program = read(tmp_path, body)
    assert places(program) == [[0, 5, 0], [0, 0, 0], None] and "G has no value" in str(
        program.problems[0]
    )


def test_frames_that_are_not_known_are_not_one(tmp_path):
    body = f"FOR i=1 TO 2\n$BASE=BASE_DATA[i]\nLIN {FULL}\nENDFOR\n$BASE=BASE_DATA[1]\nLIN {FULL}\n"
    program = read(tmp_path, body + f"s=one(1)\n$BASE=s\nLIN {FULL}\ns=one(2)\n$BASE=s\nLIN {FULL}")
    bases = [m.base for m in program.motions if m.pose is not None]
    assert bases[:3] == ["BASE_DATA[1]", "BASE_DATA[2]", "BASE_DATA[1]"] and len(set(bases)) == 4


def test_routines_have_variables_of_their_own(tmp_path):
    tail = "DEF inc(v:OUT, w:IN)\nINT v,w,i\ni=9\nv=v+w\nw=0\nEND\nDEFFCT REAL half(v:IN)\nREAL v\nRETURN v/2\nENDFCT\n"
    program = read(tmp_path, f"i=1\nk=4\ninc(i, k)\nLIN {FULL}\nLIN {{X i,Y k,Z half(3)}}", tail)
    assert places(program)[-1] == [5, 4, 1.5] and not program.problems


def test_loops_decisions_and_jumps_as_far_as_they_are_known(tmp_path):
    program = read(tmp_path, f"i=0\na:\ni=i+1\nLIN {FULL}\nIF i<3 THEN\nGOTO a\nENDIF\nLIN {{X 4}}")
    assert xs(program) == [1, 1, 1, 4] and not program.problems
    program = read(tmp_path, f"a:\nLIN {FULL}\nGOTO a\nLIN {{X 9}}")
    assert [p.code for p in program.problems] == ["programs.endless", "programs.left_out"]
    assert xs(program) == [1, None, None]
    program = read(tmp_path, f"LIN {FULL}\nGOTO nowhere\nLIN {FULL}")
    assert xs(program) == [1, None] and "NOWHERE" in str(program.problems[0])
    program = read(
        tmp_path,
        f"LIN {FULL}\nIF $IN[1] THEN\nGOTO b\nENDIF\nx=3\nb:\nLIN {{X x,Y 0,Z 0,A 0,B 0,C 0}}",
    )
    assert xs(program) == [1, None, None]
    program = read(
        tmp_path, f"FOR i=1 TO 3\nIF $IN[1] THEN\nEXIT\nENDIF\nLIN {FULL}\nENDFOR\nLIN {{X i}}"
    )
    assert xs(program) == [1, None, None] and "left within" in str(program.problems[0])
    program = read(
        tmp_path, f"n=0\nLOOP\nn=n+1\nLIN {FULL}\nIF n==0 THEN\nEXIT\nENDIF\nENDLOOP\nLIN {FULL}"
    )
    assert xs(program) == [1, None] and [p.code for p in program.problems] == ["programs.endless"]
    program = read(tmp_path, f"$TIMER[1]=0\nWHILE $TIMER[1]<5\nLIN {FULL}\nENDWHILE")
    assert xs(program) == [None]
    program = read(tmp_path, f"REPEAT\nLIN {FULL}\nUNTIL $IN[1]\nLIN {{X 3}}")
    assert xs(program) == [1, None, None]
    program = read(
        tmp_path,
        f"SWITCH m\nCASE 1\nLIN {FULL}\nENDSWITCH\nm=#B\nSWITCH m\nCASE #A,#b\nLIN {FULL}\nENDSWITCH",
    )
    assert xs(program) == [None, 1]


def test_a_call_of_what_is_not_here_is_told_with_what_is_assumed(tmp_path):
    program = read(tmp_path, f"LIN {FULL}\nGRIPPER()\nLIN {FULL}\nGRIPPER()\nLIN {{X 2}}")
    assert xs(program) == [1, None, 1, None, None] and program.motions[2].speed_mm_s == 100
    assert "are taken to stay as they are" in str(program.problems[0])
    quiet = "PULSE($OUT[3],TRUE,0.5)\nCWRITE(h,s)\nWAIT SEC 0\n$OUT[2]=TRUE\nANOUT ON $ANOUT[1]=2"
    program = read(tmp_path, f"LIN {FULL}\n{quiet}\nLIN {{X 2}}")
    assert xs(program) == [1, 2] and not program.problems


def test_the_frames_of_a_home_that_the_controller_has(tmp_path):
    body = (
        "FDAT_ACT=FHOME\nBAS(#PTP_PARAMS,100)\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
        f"BAS(#BASE,0)\nLIN {FULL}\nFDAT_ACT=FOTHER\nBAS(#CP_PARAMS,0.1)\nLIN {FULL}"
    )
    program = read(tmp_path, body)
    assert places(program) == [None, [1, 2, 3], None]
    assert program.motions[1].tool == "TOOL OF FHOME"
    assert program.motions[2].kind == "GAP"
    assert [p.line for p in program.problems if p.code == "programs.krl.home_frames"] == [FIRST + 1]
