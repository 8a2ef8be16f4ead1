"""The reader of Heidenhain conversational programs: each statement with its right answer."""

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program

HEAD = "0 BEGIN PGM P MM\n1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 Z+0 R0 F600\n"


def whole(folder, text, **beside):
    for name, source in beside.items():
        (folder / f"{name}.H").write_text(source)
    (folder / "p.h").write_text(text)
    return read_program(folder / "p.h")


def read(folder, blocks, **beside):
    return whole(folder, HEAD + blocks + "\nEND PGM P MM\n", **beside)


def points(program):
    """[(x, y, z), ...] of the motions after the first, None for a gap, points on arcs left out."""
    return [
        None if m.pose is None else tuple((np.round(m.pose[:3, 3], 4) + 0.0).tolist())
        for m in program.motions[1:]
        if not m.aux
    ]


@pytest.mark.parametrize(
    "blocks, expected",
    [
        ("5 L X+10 Y-5,5 R0 F500 M3\nL Z-.5\nL IX-2 IZ+1", [(10, -5.5, 0), (10, -5.5, -0.5), (8, -5.5, 0.5)]),
        ("L X1 Y2 FMAX ; a comment\n* - a heading\nL X+3 R F M", [(1, 2, 0), (3, 2, 0)]),
        ("Q1 = 5\nQ2 = (Q1 + 3) * 2 - SQRT 16\nL X+Q1 Y-Q2", [(5, -12, 0)]),
        ("Q1 = 2 * SIN 30 + 3 ^ 2\nL X+Q1", [(10, 0, 0)]),
        ("FN 0: Q1 = +5\nFN 1: Q2 = +Q1 + +2\nFN 2: Q3 = +Q1 - +7\nFN 3: Q4 = +Q1 * +4\nFN 4: Q5 = +Q1 DIV +2\n"
         "L X+Q2 Y+Q3 Z+Q4\nL X+Q5", [(7, -2, 20), (2.5, -2, 20)]),
        ("FN 8: Q1 = +3 LEN +4\nFN 6: Q2 = SIN+30\nFN 5: Q3 = SQRT+16\nL X+Q1 Y+Q2 Z+Q3", [(5, 0.5, 4)]),
        ("Q1 = 0\nLBL 1\nQ1 = Q1 + 1\nL X+Q1\nFN 12: IF +Q1 LT +3 GOTO LBL 1\nL Y+1",
         [(1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0)]),
        ("FN 9: IF +1 EQU +1 GOTO LBL \"OUT\"\nL X+1\nLBL \"OUT\"\nL X+2", [(2, 0, 0)]),
        ("LBL 3\nL IX+1\nCALL LBL 3 REP 2\nL Y+1", [(1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0)]),
        ("CALL LBL 4\nL Y+1\nM30\nLBL 4\nL X+9\nLBL 0", [(9, 0, 0), (9, 1, 0)]),
        ("CYCL DEF 7.0 NULLPUNKT\nCYCL DEF 7.1 X+60\nCYCL DEF 7.2 Y+40\nL X+1 Y+1 Z+1\nCYCL DEF 7.0 DATUM SHIFT\n"
         "CYCL DEF 7.1 X+0\nL X+1\nCYCL DEF 7.1 IX+5\nL X+1", [(61, 41, 1), (1, 41, 1), (6, 41, 1)]),
        ("TRANS DATUM AXIS X+10 Y+20\nL X+1 Y+1\nTRANS DATUM RESET\nL X+1 Y+1", [(11, 21, 0), (1, 1, 0)]),
        ("CYCL DEF 7.1 X+10\nCYCL DEF 10.0 DREHUNG\nCYCL DEF 10.1 ROT+90\nL X+1 Y+0\nCYCL DEF 10.1 IROT+90\nL X+1 Y+0\n"
         "CYCL DEF 10.1 ROT+0\nL X+1", [(10, 1, 0), (9, 0, 0), (11, 0, 0)]),
        ("CYCL DEF 10.1 ROT+90\nCYCL DEF 7.1 X+10\nL X+1 Y+0", [None]),  # which first?
        ("CYCL DEF 7.1 #3\nL X+1\nCYCL DEF 7.1 X+0\nCYCL DEF 7.2 Y+0\nCYCL DEF 7.3 Z+0\nL X+2 Y+0 Z+0", [None, (2, 0, 0)]),
        ("CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X\nL X+1\nCYCL DEF 8.0 MIRROR\nCYCL DEF 8.1\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05\nCYCL DEF 32.2 HSC-MODE:1 TA0.5\nM126\nL X+1", [(1, 0, 0)]),
        ("CYCL DEF 247 DATUM SETTING ~\n Q339=+4 ;DATUM NUMBER\nL X+1 Y+0 Z+0", [(1, 0, 0)]),
        ("CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-5\nL X+1 M99\nL X+2 Y+0 Z+0", [(1, 0, 0), None, (2, 0, 0)]),
        ("CYCL CALL\nL X+2\nL X+2 Y+0 Z+0", [None, (2, 0, 0)]),
        ("L X+5 FMAX M91\nL X+1\nL X+1 Y+1 Z+1", [None, (1, 1, 1)]),
        ("M140 MB MAX\nL X+1\nL X+1 Y+1 Z+1", [None, (1, 1, 1)]),
        ("APPR LT X+5 Y+5 LEN15 RL F100\nL X+9", [None, (9, 5, 0)]),
        ("DEP LCT X+5 Y+5 R10\nL X+9\nL X+9 Y+0 Z+0", [None, (9, 0, 0)]),
        ("FL X+5 AN+30\nL X+9\nL X+9 Y+0 Z+0", [None, (9, 0, 0)]),
        ("L X+Q99\nL Y+1\nL X+1 Y+1 Z+0", [None, (1, 1, 0)]),
        ("FN 18: SYSREAD Q1 = ID270 NR1\nL X+Q1\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("FN 9: IF +Q99 EQU +1 GOTO LBL 5\nL X+1 Y+1 Z+1\nLBL 5\nL X+2\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("GARBAGE X+3\nL X+1\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("/ L X+3\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("CHF 2\nL X+1", [(1, 0, 0)]),
        ("L X+9\nCHF 12\nL Y+9", [None, (9, 9, 0)]),  # no room
        ("L X+9\nRND R2\nC X+9 Y+4 DR+\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
        ("CALL PGM NOBODY\nL X+1\nL X+1 Y+0 Z+0", [None, (1, 0, 0)]),
    ],
)  # fmt: skip
def test_positions(tmp_path, blocks, expected):
    program = read(tmp_path, blocks)
    if blocks.startswith("CHF"):  # the motion to that corner is the first of all
        assert program.motions[0].pose is None
    assert points(program) == expected
    lost = None in expected or program.motions[0].pose is None
    assert bool(program.problems) == bool(program.lost) == lost
    first = program.problems[0].line if program.problems else 4
    assert first >= 4


@pytest.mark.parametrize(
    "blocks, end, centre, middle",
    [
        ("CC X+10 Y+0\nC X+10 Y+10 DR-", (10, 10, 0), (10, 0), (2.9289, 7.0711)),
        ("CC X+10 Y+0\nC X+10 Y+10 DR+", (10, 10, 0), (10, 0), (17.0711, -7.0711)),
        ("CC IX+10 IY+0\nC X+20 Y+0 DR+", (20, 0, 0), (10, 0), (10, -10)),
        ("CR X+10 Y+10 R+10 DR-", (10, 10, 0), (10, 0), (2.9289, 7.0711)),
        ("CR X+10 Y+10 R-10 DR-", (10, 10, 0), (0, 10), (-7.0711, 17.0711)),
        ("CR X+10 Y+10 R+10 DR+", (10, 10, 0), (0, 10), (7.0711, 2.9289)),
        ("L X+5\nCT X+10 Y+5", (10, 5, 0), (5, 5), (8.5355, 1.4645)),
        ("CC X+10 Y+0\nCP PA+90 DR-", (10, 10, 0), (10, 0), (2.9289, 7.0711)),
        ("CC X+10 Y+0\nCP IPA-90 DR-", (10, 10, 0), (10, 0), (2.9289, 7.0711)),
        ("CC X+0 Y+0\nLP PR+10 PA+90\nCP PA+180 DR+", (-10, 0, 0), (0, 0), (-7.0711, 7.0711)),
    ],
)
def test_arcs(tmp_path, blocks, end, centre, middle):
    program = read(tmp_path, blocks)
    assert not program.problems and points(program)[-1] == end
    np.testing.assert_allclose(program.motions[-2].pose[:2, 3], middle, atol=1e-4)
    radius = np.hypot(*(np.array(end[:2]) - centre))
    path = program.path_arrays(9.0)["frames"][-5:, :2, 3]
    np.testing.assert_allclose(np.linalg.norm(path - centre, axis=1), radius, atol=1e-6)


def test_full_circle_helix_and_polar_lines(tmp_path):
    program = read(tmp_path, "CC X+10 Y+0\nC X+0 Y+0 DR+")
    path = program.path_arrays(9.0)["frames"][:, :2, 3]
    assert path[:, 0].max() == pytest.approx(20, abs=0.05) and not program.problems
    program = read(tmp_path, "CC X+10 Y+0\nCP IPA-720 IZ-4 DR- F300")
    path = program.path_arrays(9.0)["frames"][:, :3, 3]
    turns = np.unwrap(np.arctan2(path[:, 1], path[:, 0] - 10)) - np.pi
    assert turns[-1] == pytest.approx(-4 * np.pi) and not program.problems
    np.testing.assert_allclose(path[:, 2], turns / np.pi, atol=1e-9)
    program = read(tmp_path, "CC X+0 Y+0\nLP PR+10 PA+0\nLP IPA+90\nLP IPR+5 IPA+90 IZ+1")
    assert points(program) == [(10, 0, 0), (0, 10, 0), (-15, 0, 1)]
    for blocks in ("CP PA+90 DR+", "LP PR+5 PA+0", "CC X+5 Y+0\nCP IPA+90 DR-"):
        program = read(tmp_path, blocks)
        assert points(program) == [None] and program.problems


def test_arcs_in_other_planes(tmp_path):
    blocks = "L Y-132.7 Z-13.6\nCC Y-131.3 Z-13.6\nCP IPA+90 DR+\nL Y-129.9\nCC X+5 Z-15\nC X+10 Z-15 DR-"
    program = read(tmp_path, blocks)
    assert points(program) == [
        (0, -132.7, -13.6),
        (0, -131.3, -15),
        (0, -129.9, -15),
        (10, -129.9, -15),
    ]
    middle = [m.pose[:3, 3] for m in program.motions if m.aux]
    np.testing.assert_allclose(
        middle[0], [0, -131.3 - 1.4 * np.sqrt(0.5), -13.6 - 1.4 * np.sqrt(0.5)]
    )
    np.testing.assert_allclose(middle[1], [5, -129.9, -20], atol=1e-9)  # from x to z seen from y
    assert not program.problems
    assert points(read(tmp_path, "CC X+5\nC X+10 Y+0 DR+"))[-1] is None


def test_a_chamfer(tmp_path):
    program = read(tmp_path, "L X+20 F300\nCHF 5 F100\nL X+30 Y+10\nL X+0")
    leg = round(5 * 0.5**0.5, 4)
    assert points(program) == [(15, 0, 0), (20 + leg, leg, 0), (30, 10, 0), (0, 10, 0)]
    assert [m.speed_mm_s for m in program.motions[1:]] == [5.0, 100 / 60, 5.0, 5.0]
    assert [p.code for p in program.problems] == ["programs.klartext.chamfer"]
    assert not program.lost


def plane(name, *words):
    return f"PLANE {name} {' '.join(words)} MOVE DIST50 F1000"


@pytest.mark.parametrize(
    "blocks, x, y",
    [
        (plane("SPATIAL", "SPA+0", "SPB+90", "SPC+0"), (0, 0, -1), (0, 1, 0)),
        (plane("EULER", "EULPR+90", "EULNU+90", "EULROT+0"), (0, 1, 0), (0, 0, 1)),
        (plane("EULER", "EULPR+0", "EULNU+90", "EULROT+90"), (0, 0, 1), (-1, 0, 0)),
        (plane("VECTOR", "BX+2", "BY+0", "BZ+0", "NX+0", "NY-3", "NZ+0"), (1, 0, 0), (0, 0, 1)),
        (plane("POINTS", "P1X+1", "P1Y+1", "P1Z+1", "P2X+5", "P2Y+1", "P2Z+1", "P3X+3", "P3Y+1", "P3Z+9"),
         (1, 0, 0), (0, 0, 1)),
        (plane("SPATIAL", "SPA+90", "SPB+0", "SPC+0") + "\n" + plane("RELATIV", "SPB+90"), (0, 1, 0), (0, 0, 1)),
        (plane("RELATIV", "SPA+90"), (1, 0, 0), (0, 0, 1)),
    ],
)  # fmt: skip
def test_planes(tmp_path, blocks, x, y):
    program = read(
        tmp_path, f"{blocks}\nL X+2 Y+3 Z+5\nPLANE RESET STAY\nL X+0 Y+0 Z+0 A+0 B+0 C+0"
    )
    z = np.cross(x, y)
    pose = program.motions[1].pose
    at = 2 * np.array(x) + 3 * np.array(y) + 5 * z
    np.testing.assert_allclose(pose[:3, 3], at, atol=1e-9)
    np.testing.assert_allclose(pose[:3, 2], -z, atol=1e-9)  # it points into the work
    assert not program.problems


@pytest.mark.parametrize(
    "words",
    [
        "AXIAL B+45 MOVE DIST5 F9",
        "PROJECTED PROPR+24 PROMIN+24 ROT+30 MOVE DIST5 F9",
        "EULER EULPR+45 EULNU+20 MOVE DIST5 F9",
        "VECTOR BX+1 BY+0 BZ+0 NX+1 NY+0 NZ+1 MOVE DIST5 F9",  # not at a right angle
        "POINTS P1X0 P1Y0 P1Z0 P2X1 P2Y0 P2Z0 P3X2 P3Y0 P3Z0 STAY",  # on a line
        "RELATIV SPA+1 SPB+2 STAY",
        "SPATIAL SPA+Q99 SPB+0 SPC+0 STAY",
        "RELATIV SPB+45",
    ],
)
def test_planes_that_are_told(tmp_path, words):
    program = read(tmp_path, f"PLANE {words}\nL X+2 Y+3 Z+5")
    assert points(program) == [None] and program.lost == 1 and len(program.problems) == 1


def test_a_plane_relative_to_a_shift_in_one_is_told(tmp_path):
    blocks = plane("SPATIAL", "SPA+90", "SPB+0", "SPC+0")
    blocks += "\nTRANS DATUM AXIS X+5\n" + plane("RELATIV", "SPB+90") + "\nL X+2 Y+3 Z+5"
    program = read(tmp_path, blocks)
    assert points(program) == [None] and program.problems


def test_a_rounded_corner(tmp_path):
    program = read(tmp_path, "L X+20\nRND R5 F100\nL Y+30\nL X+0")
    assert points(program) == [(15, 0, 0), (20, 5, 0), (20, 30, 0), (0, 30, 0)]
    aux = next(m for m in program.motions if m.aux)
    np.testing.assert_allclose(aux.pose[:2, 3], [15 + 3.5355, 5 - 3.5355], atol=1e-4)
    assert not program.problems
    program = read(tmp_path, "L X+20\nRND R50\nL Y+30\nL X+0")  # no room
    assert points(program) == [None, (20, 30, 0), (0, 30, 0)] and program.problems


def test_feeds_tools_and_kinds(tmp_path):
    blocks = (
        "L X+1 F1200\nL X+2 FMAX\nL X+3\nTOOL CALL 2 Z S100 F240\nL X+4\nL X+5 F60\nL X+6 F AUTO"
    )
    program = read(tmp_path, blocks)
    assert [m.kind for m in program.motions[1:]] == ["LIN", "PTP", *["LIN"] * 4]
    assert [m.speed_mm_s for m in program.motions] == [10, 20, None, 20, 4, 1, 4]
    assert [m.tool for m in program.motions[-4:]] == ["T1", "T2", "T2", "T2"]
    program = read(tmp_path, "M136\nL X+1 F0.1\nM137\nL X+2 F60")
    assert [m.speed_mm_s for m in program.motions[1:]] == [None, 1] and program.problems
    program = read(tmp_path, "L X+1 RL\nL X+2 RR\nL X+3")
    assert [p.line for p in program.problems] == [4, 5] and len(points(program)) == 3
    program = read(tmp_path, "TOOL CALL 3 X S100\nL X+1\nTOOL CALL 3 Z S100\nL X+2 Y+0 Z+0")
    assert points(program) == [None, (2, 0, 0)] and "not Z" in str(program.problems[0])
    assert (
        read(tmp_path, "CYCL DEF 247 X ~\n Q339=+4\nL X+1 Y+1 Z+1").motions[-1].base == "preset 4"
    )


@pytest.mark.parametrize(
    "blocks, axis",
    [
        ("M128 F1000\nL X+1 A+90", [0, -1, 0]),
        ("M128\nL X+1 B+90 C+90", [0, 1, 0]),
        ("L X+1 B+30 M128", [0.5, 0, np.sqrt(0.75)]),
        ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL X+1 B+30", [0.5, 0, np.sqrt(0.75)]),
        ("FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS\nL X+1 A+90 B+0 C+90", [1, 0, 0]),
        ("M128\nLN X+1 Y+0 Z+0 NX+0 NY+0 NZ+1 TX+0 TY+3 TZ+4 F500", [0, 0.6, 0.8]),
        ("M128\nLN X+1 Y+0 Z+0 NX+0 NY+0.6 NZ+0.8", [0, 0.6, 0.8]),
        ("LN X+1 Y+0 Z+0 NX+0 NY+0.6 NZ+0.8 TX+1 TY+0 TZ+0", [0, 0, 1]),  # T counts under M128 only
        ("PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX\nL X+0 Y+0 Z+1", [1, 0, 0]),
        ("PLANE SPATIAL SPA+90 SPB+0 SPC+90 STAY\nL A+Q120 C+Q122 FMAX\nL X+0 Y+0 Z+1", [1, 0, 0]),
        ("PLANE SPATIAL SPA+0 SPB+30 SPC+0 MOVE\nPLANE RESET TURN FMAX\nL X+1 Y+0 Z+0", [0, 0, 1]),
        ("L X+1 B+30", None),
        ("M128\nL X+1 A+10 B+30", None),
        ("FUNCTION TCPM F TCP AXIS POS REFPNT CENTER-CENTER\nL X+1 B+30", None),
        ("PLANE SPATIAL SPA+0 SPB+90 SPC+0 STAY\nL X+0 Y+0 Z+1", None),
        ("PLANE AXIAL B+90 C+0 TURN\nL X+0 Y+0 Z+1", None),
        ("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+90 C+0\nL X+0 Y+0 Z+1", None),
        ("M128\nL X+1 B+30\nM129\nL X+2", None),
        ("M128\nLN X+1 Y+0 Z+0 TX+0 TY+0 TZ+0", None),
    ],
)
def test_tool_axes(tmp_path, blocks, axis):
    program = read(tmp_path, blocks)
    last = program.motions[-1]
    assert (last.pose is None) == bool(program.problems) == (axis is None) or axis is not None
    if axis is not None:
        np.testing.assert_allclose(-last.pose[:3, 2], axis, atol=1e-9)


def test_positions_in_a_tilted_plane(tmp_path):
    blocks = "CYCL DEF 7.1 X+100\nPLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX\nL X+1 Y+2 Z+3"
    program = read(tmp_path, blocks)
    assert points(program) == [(103, 2, -1)] and not program.problems
    program = read(tmp_path, blocks + "\nPLANE RESET TURN FMAX\nL X+1 Y+2 Z+3")
    assert points(program)[-1] == (101, 2, 3) and not program.problems


def test_programs_beside(tmp_path):
    sub = "0 BEGIN PGM SUB MM\n1 L X+Q1\n2 L Y+Q1\n3 END PGM SUB MM\n"
    program = read(tmp_path, "Q1 = 7\nCALL PGM TNC:\\X\\SUB.H\nL Z+1", Sub=sub)
    assert points(program) == [(7, 0, 0), (7, 7, 0), (7, 7, 1)] and not program.problems
    assert [m.line for m in program.motions] == [3, 5, 5, 6]  # those of the calls
    program = read(tmp_path, "CALL PGM SUB", Sub="BEGIN PGM SUB MM\nCALL PGM SUB\nEND PGM SUB MM\n")
    assert program.problems and program.lost


def test_inch(tmp_path):
    program = whole(tmp_path, "BEGIN PGM P INCH\nL X+1 Y+2 Z+0 F10\nEND PGM P INCH\n")
    np.testing.assert_allclose(program.motions[0].pose[:3, 3], [25.4, 50.8, 0])
    assert program.motions[0].speed_mm_s is None and program.problems
    assert whole(tmp_path, "BEGIN PGM P\nL X+1 Y+2 Z+0\nEND PGM P\n").problems


@pytest.mark.parametrize(
    "text", ["#ifndef A_H\n#define A_H\nint L;\n#endif\n", "", "%\nG1 X1\nM30\n"]
)
def test_what_is_no_klartext_is_refused(tmp_path, text):
    with pytest.raises(ProgramError, match="p.h: holds no BEGIN PGM.*headers of C"):
        whole(tmp_path, text)


def test_a_file_cut_off_is_said(tmp_path):
    program = whole(tmp_path, HEAD + "L X+12")
    assert "cut" in str(program.problems[-1]) and program.problems[-1].line == 4


@pytest.mark.parametrize(
    "blocks",
    [
        "LBL 1\nL IX+0\nFN 9: IF +1 EQU +1 GOTO LBL 1",
        "LBL 1\nQ1 = 1\nFN 9: IF +1 EQU +1 GOTO LBL 1",
    ],
)
def test_what_does_not_end_is_refused(tmp_path, blocks):
    with pytest.raises(ProgramError, match="p.h:[456]: .*does not end"):
        read(tmp_path, blocks)


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(1)
    source = (
        HEAD
        + "CC X+0 Y+5\nC X+0 Y+10 DR+\nCR X+5 Y+5 R+5 DR-\nL X+20\nRND R2\nL Y+30\nCT X+30 Y+40\nLP PR+5 PA+10\n"
        "CP IPA+400 IZ+2 DR+\nCYCL DEF 7.0 NP\nCYCL DEF 7.1 IX+5\nCYCL DEF 10.1 ROT+30\nPLANE SPATIAL SPA+1 SPB+2 SPC+3 TURN\n"
        "M128\nLN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0 TY+1 TZ+1\nL X+1 A+5 C+9 M91\nQ1 = SIN 3 * (2 + Q2)\nFN 8: Q2 = +3 LEN +4\n"
        "LBL 1\nL IX+1\nCALL LBL 1 REP 2\nFN 12: IF +Q2 LT +3 GOTO LBL 1\nCALL PGM X\nAPPR LT X+1\nTOOL CALL 2 Z F5 DR+1\n"
        "PLANE RESET STAY\nCYCL DEF 247 X ~\n Q339=+4\nEND PGM P MM\n"
    ).encode()
    for _ in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            bad[rng.integers(len(bad))] = rng.integers(1, 256)
        (tmp_path / "m.h").write_bytes(bytes(bad[: rng.integers(30, len(bad))]))
        try:
            program = read_program(tmp_path / "m.h")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.h" in str(error)
