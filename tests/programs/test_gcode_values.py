"""G-code with values: SINUMERIK's R parameters and frames, # and [..], flow and subprograms."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]
FAULTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "faults"


def read(folder, name, text, **beside):
    for other, source in beside.items():
        (folder / other.replace("_dot_", ".")).write_text(source)
    (folder / name).write_text(text)
    return read_program(folder / name)


def points(program):
    """[(x, y, z), ...] of the motions, None for a gap, points on arcs left out."""
    return [
        None if m.pose is None else tuple(np.round(m.pose[:3, 3], 4).tolist())
        for m in program.motions
        if not m.aux
    ]


def siemens(folder, blocks, **beside):
    text = f"G71 G90 G17\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n"
    program = read(folder, "p.mpf", text, **beside)
    return program, points(program)[1:]


@pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")
def test_the_shared_arcs_by_radius():
    program = read_program(FAULTS / "cr.mpf")
    assert not program.problems and not program.lost
    assert points(program) == [
        (-26.3, 23.749, 5),
        (-26.3, 23.749, 0),
        (-22.313, 27.736, 0),
        (20, 27.736, 0),
        (25, 30, 0),
        (30, 35, 0),
    ]
    on_the_way = [m.pose[:2, 3] for m in program.motions if m.aux]
    np.testing.assert_allclose(
        on_the_way[0], np.array([-22.313, 23.749]) + 3.987 * np.array([-0.5, 0.5]) * np.sqrt(2)
    )
    np.testing.assert_allclose(on_the_way[1], [28.5355, 31.4645], atol=1e-4)
    assert {m.speed_mm_s for m in program.motions[1:]} == {250 / 60}


@pytest.mark.parametrize(
    "blocks, expected",
    [
        ("R1=10\nR2=R1*2+SIN(30)\nG1 X=R1+5 Y=-R2", [(15, -20.5, 0)]),
        ("X=AC(5) Y5\nG91\nX=AC(7) Y1\nX1\nG90\nX=IC(2) Y1", [(5, 5, 0), (7, 6, 0), (8, 6, 0), (10, 1, 0)]),
        ("DEF REAL WIDTH=4, DEEP\nDEEP=WIDTH/8\nX=WIDTH Z=-DEEP", [(4, 0, -0.5)]),
        ("DEF INT NO=2\nNO=NO+1\nX=NO", [(3, 0, 0)]),
        ("R1=1\nAGAIN:\nX=R1\nR1=R1+1\nIF R1<=3 GOTOB AGAIN\nX0", [(1, 0, 0), (2, 0, 0), (3, 0, 0), (0, 0, 0)]),
        ("R1=5\nIF (R1>4) AND (R1<9) GOTOF OUT\nX1\nOUT: X2", [(2, 0, 0)]),
        ("GOTOF N90\nX1\nN90 X2", [(2, 0, 0)]),
        ("DEF INT I\nFOR I=1 TO 3\nX=I*10\nENDFOR\nY1", [(10, 0, 0), (20, 0, 0), (30, 0, 0), (30, 1, 0)]),
        ("R1=0\nWHILE R1<2\nR1=R1+1\nX=R1\nENDWHILE", [(1, 0, 0), (2, 0, 0)]),
        ("R1=0\nREPEAT\nR1=R1+1\nX=R1\nUNTIL R1==2", [(1, 0, 0), (2, 0, 0)]),
        ("R1=3\nIF R1==3\nX1\nELSE\nX2\nENDIF\nIF R1<>3\nX3\nELSE\nX4\nENDIF", [(1, 0, 0), (4, 0, 0)]),
        ("R1=7\nIF R1 MOD 2==1\nX1\nENDIF\nX=R1 DIV 2", [(1, 0, 0), (3, 0, 0)]),
        ("R[3]=4\nX=R3\nR1=3\nX=R[R1]*2", [(4, 0, 0), (8, 0, 0)]),
        ("TRANS X10 Y5\nX1 Y1\nATRANS Z2\nX0 Y0 Z0\nTRANS\nX0", [(11, 6, 0), (10, 5, 2), (0, 5, 2)]),
        ("ROT Z90\nX2 Y0\nAROT RPL=90\nX2 Y0\nROT\nX2 Y0", [(0, 2, 0), (-2, 0, 0), (2, 0, 0)]),
        ("TRANS X10\nAROT Z90\nX1 Y0\nROT Z90\nX1 Y0", [(10, 1, 0), (0, 1, 0)]),
        ("TRANS X10\nG91 X1", [None]),  # whether the shift counts, a setting of the control says
        ("ROT X90 Y10\nX1 Y1 Z1\nROT\nX1 Y1 Z1", [None, (1, 1, 1)]),
        ("ROT X90\nX1 Y0 Z0", [None]),  # nobody knows how the tool stands
        ("MIRROR X0\nX1\nMIRROR\nX1 Y1 Z1", [None, (1, 1, 1)]),
        ("X=R9\nX1", [None, (1, 0, 0)]),
        ("X=$AA_IW[X]+1\nX1 Y0 Z0", [None, (1, 0, 0)]),
        ("R1=1 R2=R1\nX=R2\nX1", [None, (1, 0, 0)]),
        ("IF R9==1 GOTOF OUT\nX1\nOUT: X2\nG71 G90 G17 G1 X1 Y1 Z1", [None, (1, 1, 1)]),
        ("R1=1\nIF R9==1\nR1=2\nENDIF\nG71 G90 G1 X=R1 Y1 Z1\nX2 Y1 Z1", [None, (2, 1, 1)]),
        ("GOTOF NOWHERE\nX1", [None]),
        ("MSG(\"to; the (left)\") ; X9\nX1 (no comment)\nX2 Y0 Z0", [None, (2, 0, 0)]),
        ("G4 F2\nX1", [(1, 0, 0)]),
        ("G58 X5\nX1", [None]),
        ("RND=2 X1\nX2 Y0 Z0", [None, (2, 0, 0)]),
    ],
)  # fmt: skip
def test_siemens_values_flow_and_frames(tmp_path, blocks, expected):
    program, found = siemens(tmp_path, blocks)
    assert found == expected
    assert None not in expected or program.problems
    assert None in expected or not program.problems
    assert all(m.speed_mm_s in (10, None) for m in program.motions)


def test_siemens_arcs(tmp_path):
    program, found = siemens(tmp_path, "X10\nCIP X0 Y0 Z10 I1=5 J1=5 K1=5\nG1 X5")
    assert not program.problems and found == [(10, 0, 0), (0, 0, 10), (5, 0, 10)]
    aux = next(m for m in program.motions if m.aux)
    np.testing.assert_allclose(aux.pose[:3, 3], [5, 5, 5])
    program, found = siemens(tmp_path, "G3 X0 Y10 CR=-10")  # the longer way, about (-8.66, 5)
    path = program.path_arrays(9.0)["frames"][1:, :3, 3]
    assert not program.problems and path[:, 0].max() == pytest.approx(0) or path[:, 0].max() > 18
    program, found = siemens(tmp_path, "X10\nG3 X-10 Y0 Z-5 I-10 J0 TURN=2 F300")
    path = program.path_arrays(9.0)["frames"][2:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(path[:, :2], axis=1), 10.0, atol=1e-6)
    turns = np.unwrap(np.arctan2(path[:, 1], path[:, 0]))
    assert turns[-1] == pytest.approx(5 * np.pi) and not program.problems
    np.testing.assert_allclose(path[:, 2], -turns / np.pi, atol=1e-9)
    assert program.motions[-1].speed_mm_s == 5


@pytest.mark.parametrize(
    "blocks, axis",
    [
        ("TRAORI\nX1 A3=1 C3=1", [np.sqrt(0.5), 0, np.sqrt(0.5)]),
        ("TRAORI\nORIRPY\nX1 B2=90 C2=90", [0, 1, 0]),
        ("TRAORI\nORIEULER\nX1 A2=90 B2=90", [1, 0, 0]),
        ("TRAORI\nORIWKS\nROT Z90\nX1 Y0 Z0 A3=1 C3=0", [0, 1, 0]),
        ("TRAORI\nORIMKS\nROT Z90\nX1 Y0 Z0 A3=1 C3=0", [1, 0, 0]),
        ("TRAORI\nR1=30\nX1 B=R1", [0.5, 0, np.sqrt(0.75)]),
        ("TRAORI\nX1 A2=10", None),
        ("TRAORI\nROT Z90\nX1 Y0 Z0 A3=1 C3=0", None),
    ],
)
def test_siemens_tool_axes(tmp_path, blocks, axis):
    program, _ = siemens(tmp_path, blocks)
    last = program.motions[-1]
    assert bool(program.problems) == (axis is None) == (last.pose is None)
    if axis is not None:
        np.testing.assert_allclose(-last.pose[:3, 2], axis, atol=1e-12)


def test_siemens_subprograms(tmp_path):
    side = {"L100_dot_SPF": "R1=R1+1\nG1 X=R1\nM17\n"}
    program, found = siemens(tmp_path, "R1=4\nL100 P2\nY1", **side)
    assert not program.problems and found == [(5, 0, 0), (6, 0, 0), (6, 1, 0)]
    assert [m.line for m in program.motions] == [2, 4, 4, 5]  # those of the calls
    side = {"BOX_dot_spf": "PROC BOX(REAL W, REAL H)\nX=W\nY=H\nRET\n"}
    program, found = siemens(tmp_path, "BOX(3,4)\nX0", **side)
    assert not program.problems and found == [(3, 0, 0), (3, 4, 0), (0, 4, 0)]
    program, found = siemens(tmp_path, "NOBODY(3)\nX0\nX1 Y1 Z1")
    assert found == [None, (1, 1, 1)] and program.problems[0].line == 3
    text = "%_N_MAIN_MPF\nG71 G90 G1 X0 Y0 Z0 F600\nL7\nM30\n%_N_L7_SPF\nG1 X7\nM17\n"
    program = read(tmp_path, "a.mpf", text)
    assert not program.problems and points(program) == [(0, 0, 0), (7, 0, 0)]


@pytest.mark.parametrize(
    "name, blocks, expected",
    [
        ("p.nc", "#1=5\n#2=[#1+1]*2\nX#1 Y-[#2/4]", [(5, -3, 0)]),
        ("p.nc", "#1=1\nN5 X#1\n#1=#1+1\nIF [#1 LE 3] GOTO 5\nY1", [(1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0)]),
        ("p.nc", "#1=0\nWHILE [#1 LT 2] DO1\n#1=#1+1\nX#1\nEND1\nY1", [(1, 0, 0), (2, 0, 0), (2, 1, 0)]),
        ("p.nc", "#1=2\nIF [#1 EQ 2] THEN #1=9\nX#1", [(9, 0, 0)]),
        ("p.nc", "#100=7\nX#100\nX[SQRT[16]+ABS[-1]+FIX[2.7]]", [(7, 0, 0), (7, 0, 0)]),
        ("p.nc", "X#1", [None]),
        ("p.nc", "#1=-7\nX[#1 MOD 4]\nX1", [None, (1, 0, 0)]),  # controls differ
        ("p.ngc", "#<far>=8\nX#<far>\no1 if [#<far> GT 5]\nX1\no1 else\nX2\no1 endif", [(8, 0, 0), (1, 0, 0)]),
        ("p.ngc", "o9 sub\nX#1 Y#2\no9 endsub\no9 call [3] [4]\no9 call [5] [6]", [(3, 4, 0), (5, 6, 0)]),
        ("p.ngc", "#5=0\no1 while [#5 LT 2]\n#5=[#5+1]\nX#5\no1 endwhile", [(1, 0, 0), (2, 0, 0)]),
        ("p.ngc", "#5=0\no1 do\n#5=[#5+1]\nX#5\no1 while [#5 LT 2]", [(1, 0, 0), (2, 0, 0)]),
        ("p.ngc", "#5=0\no1 repeat [3]\n#5=[#5+1]\no2 if [#5 EQ 2]\no1 break\no2 endif\nX#5\no1 endrepeat\nY1",
         [(1, 0, 0), (1, 1, 0)]),
        ("p.ngc", "o<none> call\nX1\nX1 Y1 Z1", [None, (1, 1, 1)]),
        ("p.ngc", "#5=1\no1 if [#77 GT 5]\n#5=2\no1 endif\nG21 G90 G17 G1 X#5 Y0 Z0\nX3 Y0 Z0", [None, (3, 0, 0)]),
    ],
)  # fmt: skip
def test_numbered_variables(tmp_path, name, blocks, expected):
    program = read(tmp_path, name, f"G21 G90 G17\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    assert points(program)[1:] == expected
    assert bool(program.problems) == (None in expected)


def test_numbered_subprograms(tmp_path):
    text = "G21 G90 G17\nG1 X0 Y0 Z0 F600\n{}\nM30\nO100\nG91 X1\nG90\nM99\n"
    program = read(tmp_path, "p.nc", text.format("M98 P100 L2\nY5"))
    assert not program.problems
    assert points(program) == [(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 5, 0)]
    text = "G21 G90 G17\nG1 X0 Y0 Z0 F600\nG65 P7 X4 A2\nM30\nO7\nX#24 Y#1\nM99\n"
    program = read(tmp_path, "p.nc", text)
    assert not program.problems and points(program) == [(0, 0, 0), (4, 2, 0)]
    program = read(
        tmp_path,
        "p.ngc",
        "G21 G90 G1 X0 Y0 Z0 F600\no<step> call [6]\nM2\n",
        step_dot_ngc="o<step> sub\nG1 X#1\no<step> endsub\nM2\n",
    )
    assert not program.problems and points(program) == [(0, 0, 0), (6, 0, 0)]


def test_a_file_of_two_dialects_is_followed_in_neither(tmp_path):
    program = read(tmp_path, "p.nc", "G21 G90\nG1 X0 Y0 Z0\nR1=5\n#1=5\nX=R1\nX#1\nX1\nM30\n")
    assert points(program) == [(0, 0, 0), None, (1, 0, 0)]


@pytest.mark.parametrize(
    "name, blocks",
    [
        ("p.mpf", "AA:\nX1\nGOTOB AA"),
        ("p.mpf", "LOOP\nX1\nENDLOOP"),
        ("p.mpf", "R1=1\nWHILE R1>0\nENDWHILE"),
        ("p.nc", "#1=1\nN5 GOTO 5"),
        ("p.ngc", "o1 sub\no1 call\no1 call\no1 endsub\no1 call"),
    ],
)
def test_what_does_not_end_is_refused(tmp_path, name, blocks):
    try:
        program = read(tmp_path, name, f"G21 G90\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    except ProgramError as error:
        assert "does not end" in str(error)
    else:  # calls too deep are left out
        assert "sub" in blocks and program.lost


PARTS = "PART: X1\nY1\n"


@pytest.mark.parametrize(
    "blocks, expected",
    [
        ("R1=2\nCASE R1 OF 1 GOTOF AA 2 GOTOF BB DEFAULT GOTOF CC\nX1\nAA: X2\nBB: X3\nCC: Y4", [(3, 0), (3, 4)]),
        ("R1=7\nCASE (R1) OF 1 GOTOF AA 2 GOTOF BB DEFAULT GOTOF CC\nX1\nAA: X2\nBB: X3\nCC: Y4", [(0, 4)]),
        ("R1=7\nCASE R1 OF 1 GOTOF AA\nX1\nAA: X2", [(1, 0), (2, 0)]),
        (f"G91\n{PARTS}REPEAT PART P=2", [(1, 0), (1, 1), (2, 1), (2, 2), (3, 2), (3, 3)]),
        (f"G91\n{PARTS}REPEAT PART", [(1, 0), (1, 1), (2, 1), (2, 2)]),
        (f"G91\n{PARTS}ENDLABEL:\nX9\nREPEAT PART P1", [(1, 0), (1, 1), (10, 1), (11, 1), (11, 2)]),
        (f"G91\n{PARTS}REPEATB PART P=2", [(1, 0), (1, 1), (2, 1), (3, 1)]),
        (f"R5=1\nG91\n{PARTS}LAST: X3\nX9\nREPEAT PART LAST P=R5",
         [(1, 0), (1, 1), (4, 1), (13, 1), (14, 1), (14, 2), (17, 2)]),
        ("G91\nREPEAT PART LAST\nGOTOF OUT\nPART: X1\nLAST: Y1\nOUT: X5", [(1, 0), (1, 1), (6, 1)]),  # behind it
        ("GOTOC NOWHERE\nX1", [(1, 0)]),
        ("G91\nUP1 P2\nCALL \"UP1\"\nUP1 P=1\nPCALL /_N_WKS_DIR/UP1\nEXTCALL \"UP1.SPF\"\nCALL \"/_N_SPF_DIR/_N_UP1_SPF\"",
         [(k, 0) for k in range(1, 8)]),
        ("UP2(3)\nUP2(4,5)", [(3, 7), (4, 5)]),
        ("DEF REAL WIDE=1\nUP3(WIDE)\nUP3(WIDE)\nX=WIDE", [(3, 0)]),
        ("DEF REAL WIDE=1\nUP3(5)\nX1", [None]),  # nothing to give back to
        (f"G91\n{PARTS}REPEAT PART P=R9\nX1", [(1, 0), (1, 1), None]),
        (f"G91\n{PARTS}REPEAT NOWHERE\nX1", [(1, 0), (1, 1), None]),
        ("CASE R9 OF 1 GOTOF AA\nX1\nAA: X2", [None]),
    ],
)  # fmt: skip
def test_parts_that_come_again_and_calls(tmp_path, blocks, expected):
    (tmp_path / "up1.spf").write_text("X1\nM17\n")
    (tmp_path / "up2.spf").write_text("PROC UP2(REAL WIDE, REAL HIGH=7)\nX=WIDE Y=HIGH\nRET\n")
    (tmp_path / "up3.spf").write_text("PROC UP3(VAR REAL BOTH)\nBOTH=BOTH+1\nRET\n")
    (tmp_path / "p.mpf").write_text(f"G71 G90 G17 G54\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    program = read_program(tmp_path / "p.mpf")
    found = [
        None if m.pose is None else tuple((np.round(m.pose[:2, 3], 6) + 0.0).tolist())
        for m in program.motions[1:]
    ]
    assert found[: len(expected)] == expected
    assert bool(program.problems) == (None in expected)


def test_a_jump_out_of_a_part_that_comes_again_is_told(tmp_path):
    blocks = "R1=0\nG91\nPART: X1\nR1=R1+1\nIF R1==3 GOTOF OUT\nREPEAT PART P=5\nOUT: G90 X9"
    (tmp_path / "p.mpf").write_text(f"G71 G90 G17 G54\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    program = read_program(tmp_path / "p.mpf")
    assert [m.pose is None for m in program.motions] == [False] * 4 + [True]
    assert program.problems[0].line == 8


def test_a_program_that_begins_again_without_end_is_followed_once(tmp_path):
    (tmp_path / "p.mpf").write_text("G71 G90 G17 G54\nG1 X0 Y0 Z0 F600\nX5\nGOTOS\n")
    program = read_program(tmp_path / "p.mpf")
    assert len(program.motions) == 2 and [p.code for p in program.problems] == ["programs.endless"]
