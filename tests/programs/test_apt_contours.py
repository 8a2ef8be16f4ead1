"""Contour motions of APT (TLON,GOFWD), and what CAM systems write beside GOTO and CIRCLE."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.apt import reader as apt

ROOT = Path(__file__).resolve().parents[2]
FAULTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "faults"
needs_shared = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")

R = np.sqrt(0.5)
TO_START = "UNITS/MM\nFEDRAT/600,MMPM\nGOTO/10,0,0,0,0,1\n"
QUARTER = "TLON,GOFWD/ (CIRCLE/ 0, 0, 0, 10),ON,(LINE/ 0,0,0, 0,10,0)\n"


def cl(tmp_path, source, end="FINI\n"):
    (tmp_path / "p.apt").write_text(source + end)
    return apt.read(tmp_path / "p.apt")


def moves(program):
    """[kind or aux, x, y, z] of each motion."""
    return [
        [
            "aux" if m.aux else m.kind,
            *(np.round(m.pose[:3, 3], 4).tolist() if m.pose is not None else []),
        ]
        for m in program.motions
    ]


def angle(program):
    """Degrees that the arc of a program goes about z, by its chords."""
    x, y = program.path_arrays(10.0)["frames"][:, :2, 3].T
    return np.degrees(np.unwrap(np.arctan2(y, x)))[-1] - np.degrees(np.arctan2(y[0], x[0]))


@needs_shared
def test_an_arc_of_catia():
    program = apt.read(FAULTS / "catia.aptsource.apt")
    assert not program.problems and not program.lost
    assert moves(program)[1:] == [
        ["LIN", 0, 0, 0],
        ["aux", 7.0711, 2.9289, 0],
        ["CIRC", 10, 10, 0],
        ["LIN", 10, 20, 0],
    ]
    assert program.motions[2].speed_mm_s == pytest.approx(1000 / 60)


@pytest.mark.parametrize(
    "before, drive, degrees",
    [
        ("INDIRV/0,1,0", QUARTER, 90),
        ("INDIRV/0,1,0", QUARTER.replace("ON,", "ON,2,INTOF,").replace("0,10,0)", "0,-10,0)"), 270),
        ("INDIRV/0,1,0", QUARTER.replace("0,10,0)", "-10,0,0)"), 180),
        ("INDIRV/0,-1,0", QUARTER.replace("0,10,0)", "-10,0,0)"), -180),
        ("INDIRV/0,1,0", QUARTER.replace("ON,", "ON,2,INTOF,").replace("0,10,0)", "10,0,0)"), 360),
        ("INDIRP/10,5,0", QUARTER, 90),  # a direction that is no tangent
        ("INDIRV/1,1,0", QUARTER.replace("10),", "10) , "), 90),
        ("INDIRV/0,1,0", "TLON,GOFWD/(CIRCLE/CANON,0,0,0,0,0,-1,10),ON,(PLANE/1,0,0,0)\n", 90),
        ("INDIRV/0,1,0", "TLON,GOFWD/(CYLNDR/0,0,0,0,0,1,10),ON,2,INTOF,(PLANE/1,0,0,0)\n", 270),
        ("INDIRV/0,1,0", "TLON,GOFWD/(CIRCLE/CANON,0,0,0,0,0,1,10),TANTO,(PLANE/-2,0,0,20)\n", 180),
        ("INDIRV/0,1,0", "TLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/-20,5,0,20,5,0)\n", 30),
        ("TLON\nINDIRV/0,1,0", QUARTER[5:], 90),
        ("PSIS/(PLANE/0,0,1,0)\nINDIRV/0,1,0", QUARTER, 90),
    ],
)
def test_where_an_arc_ends(tmp_path, before, drive, degrees):
    program = cl(tmp_path, f"{TO_START}{before}\n{drive}")
    assert not program.problems, program.problems
    assert angle(program) == pytest.approx(degrees, abs=1e-6)
    assert {m.speed_mm_s for m in program.motions} == {10.0}


def test_arcs_after_each_other_go_on_the_same_way(tmp_path):
    source = TO_START + "INDIRV/0,1,0\n" + QUARTER
    source += QUARTER.replace("0,10,0)", "-10,0,0)")
    source += "TLON,GOFWD/(CIRCLE/-20,0,0,10),ON,(LINE/-20,0,0,-20,-10,0)\n"
    program = cl(tmp_path, source)
    assert not program.problems
    ends = [m for m in moves(program) if m[0] == "CIRC"]
    assert ends == [["CIRC", 0, 10, 0], ["CIRC", -10, 0, 0], ["CIRC", -20, -10, 0]]


def test_a_line_gives_the_direction_too(tmp_path):
    program = cl(tmp_path, TO_START + "GOTO/10,-5,0\nGOTO/10,0,0\n" + QUARTER)
    assert not program.problems and moves(program)[-1] == ["CIRC", 0, 10, 0]


def test_planes_of_turning_and_tilted_ones(tmp_path):
    program = cl(
        tmp_path,
        "UNITS/MM\nFEDRAT/60,MMPM\nGOTO/20,3,-30,0,0,1\nAUTOPS\nINDIRV/0,0,1\n"
        "TLON,GOFWD/(CIRCLE/25,3,-30,5),ON,(LINE/25,3,-30,25,3,-25)\n"
        "AUTOPS\nINDIRV/1,0,0\nTLON,GOFWD/(CIRCLE/25,3,-20,5),ON,(LINE/25,3,-20,30,3,-20)\n",
    )
    assert not program.problems
    h = 5 * R
    np.testing.assert_allclose(
        [m.pose[:3, 3] for m in program.motions[1:]],
        [[25 - h, 3, -30 + h], [25, 3, -25], [25 + h, 3, -20 - h], [30, 3, -20]],
        atol=1e-9,
    )
    # About (0, -0.6, 0.8) from (10, 0, 0): a quarter turn later at (0, 8, 6).
    axis, plane = "0,-0.6,0.8", "(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,-0.6,0.8))"
    program = cl(
        tmp_path,
        f"{TO_START}PSIS/{plane}\nINDIRV/0,0.8,0.6\nTLON,GOFWD/(CYLNDR/ 0,0,0,$\n{axis},10.0), ON,$\n"
        f"(PLANE/PERPTO,$\n{plane},$\n(POINT/0,0,0),$\n(POINT/0,8,6))\n",
    )
    assert not program.problems
    assert moves(program)[-1] == ["CIRC", 0, 8, 6]
    np.testing.assert_allclose(program.motions[1].pose[:3, 3], [10 * R, 8 * R, 6 * R])


def test_inches_and_the_tool_s_axis(tmp_path):
    source = TO_START.replace("UNITS/MM", "UNITS/INCHES").replace("0,0,1", "0,0.6,0.8")
    program = cl(tmp_path, source + "INDIRV/0,1,0\n" + QUARTER)
    np.testing.assert_allclose(program.motions[-1].pose[:3, 3], [0, 254, 0], atol=1e-9)
    np.testing.assert_allclose(program.motions[-1].pose[:3, 2], [0, -0.6, -0.8])


@pytest.mark.parametrize(
    "source, culprit",
    [
        ("INDIRV/0,1,0\n" + QUARTER.replace("),ON", "),TO"), "cutter"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("),ON", "),PAST"), "cutter"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("TLON", "TLLFT"), "cutter"),
        ("INDIRV/1,0,0\n" + QUARTER, "which way"),
        (QUARTER, "which way"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("10),ON", "9),ON"), "not on its circle"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("0,10,0)", "0,-10,0)"), "check line"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("0,10,0)", "0,10,4)"), "plane of the arc"),
        ("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,11,0,1,11,0)", "does not reach"),
        ("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,(CIRCLE/0,11,0,1)", "not of a kind"),
        ("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10)", "not of a kind"),
        ("INDIRV/0,1,0\nTLON,GOFWD/C1,ON,L1", "not of a kind"),
        ("PSIS/(PLANE/0,0,1,5)\nINDIRV/0,1,0\n" + QUARTER, "part surface"),
        ("PSIS/(PLANE/0,0.6,0.8,0)\nINDIRV/0,1,0\n" + QUARTER, "part surface"),
        ("PSIS/SF1\nINDIRV/0,1,0\n" + QUARTER, "part surface"),
        ("INDIRV/0,1,0\n" + QUARTER.replace("10),ON", "0),ON"), "radius"),
        ("CYCLE/DRILL,10\nGOTO/1,2,3\nGOTO/3,2,3\nCYCLE/OFF", "cycle"),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/0,-10,0", "other way round"),
        ("INSERT G0 Z100", "INSERT"),
        ("INSERT/L Z+100 R0 FMAX M91", "INSERT"),
    ],
)
def test_what_does_not_say_one_motion_is_a_gap(tmp_path, source, culprit):
    program = cl(tmp_path, f"{TO_START}{source}\nFEDRAT/100\nGOTO/0,0,1\n")
    (problem,) = program.problems
    assert culprit in str(problem)
    assert program.lost >= 1
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2 and arrays["rapid"][1]  # the gap is not ground over
    assert arrays["frames"][1, 2, 3] == 1.0 and program.motions[-1].base == ""


def test_movarc_with_names_with_an_angle_and_senses_of_circles(tmp_path):
    program = cl(
        tmp_path,
        TO_START + "MOVARC/ CENTER,0,0,0,AXIS,0,0,1,RADIUS,10\nGOTO/0,10,0\n"
        "MOVARC/0,0,0,0,0,1,10, ANGLE, 90\nGOTO/-10,0,0,0,0,1\n"
        "CIRCLE/ 0,0,0,0,0,1,10,CLOCKWISE\nGOTO/0,10,0\n"
        "CIRCLE/ 0,0,0,0,0,1,10,COUNTERCLOCKWISE\nGOTO/-10,0,0\n"
        "MOVARC/0,0,0,0,0,1,10,ANGLE,90\nFEDRAT/1200\nGOTO/0,-20,0\n",
    )
    assert not program.problems
    h = 10 * R
    expected = [[h, h], [0, 10], [-h, h], [-10, 0], [-h, h], [0, 10], [-h, h], [-10, 0]]
    expected += [[-h, -h], [0, -10], [0, -20]]
    np.testing.assert_allclose([m.pose[:2, 3] for m in program.motions[1:]], expected, atol=1e-9)
    assert [m.speed_mm_s for m in program.motions[-2:]] == [10.0, 20.0]


def test_statements_beside_the_motions_are_no_gaps(tmp_path):
    program = cl(
        tmp_path,
        "PARTNO/1\nUNITS/MM\n$$-> CSYS / 1.0, 0.0, 0.0, 0.0, $\n 0.0, 1.0, 0.0, 0.0, $\n 0.0, 0.0, 1.0, 0.0\n"
        "$$-> CUTTER / 12.0, $\n 3, 4\nINSERT/Stock Size X50. Y914. Z50.\n"
        "INSERT/[HOLDER=C40-M20EM3] 20MM CRB 2FL 38 LOC\nSWITCH/3\nTLAXIS/0,0.6,0.8\nSETUP/START,1\n"
        "CYCLE/INIT\nFEDRAT/60,MMPM\nRAPID,GOTO/1,2,3\nGOTO/4,5,6\n",
    )
    assert not program.problems
    assert moves(program) == [["PTP", 1, 2, 3], ["LIN", 4, 5, 6]]
    np.testing.assert_allclose(program.motions[0].pose[:3, 2], [0, -0.6, -0.8])
    assert program.motions[1].line == 16
    other = "$$-> CSYS / 0,1,0,0, $\n 1,0,0,0, $\n 0,0,-1,5\nGOTO/1,1,1\n"
    program = cl(tmp_path, TO_START + "GOTO/1,2,3\n" + other)
    assert [m.base[:4] for m in program.motions] == ["", "", "CSYS"]
    assert program.counted() == (2, 3)  # nobody says how the two lie to each other


def test_mutated_contours_never_crash(tmp_path):
    rng = np.random.default_rng(4)
    plane = "(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,0,1))"
    source = (
        TO_START
        + "INDIRV/0,1,0\n"
        + QUARTER
        + "AUTOPS\n"
        + QUARTER.replace("0,10,0)", "-10,0,0)")
        + f"PSIS/{plane}\nINDIRP/-10,-5,0\nTLON,GOFWD/(CYLNDR/0,0,0,0,0,1,10),ON,2,INTOF,"
        f"(PLANE/PERPTO,{plane},(POINT/0,0,0),(POINT/10,0,0))\n"
        "TLON,GOFWD/(CIRCLE/CANON,0,0,0,0,0,1,10),TANTO,(PLANE/0,1,0,10)\n"
        "MOVARC/CENTER,0,0,0,AXIS,0,0,1,RADIUS,10,ANGLE,90\nGOTO/-10,0,0\nTLAXIS/0,0,1\n"
    ).encode()
    for _ in range(400):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 5)):
            bad[rng.integers(len(bad))] = rng.integers(256)
        (tmp_path / "m.apt").write_bytes(bytes(bad[: rng.integers(60, len(bad))]))
        try:
            assert np.isfinite(apt.read(tmp_path / "m.apt").path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.apt" in str(error)
    for text in ("(" * 4000, "(A/" * 4000, "(A/1" + ")" * 4000, ",,", "(/1)", "1/2", "(A,B)"):
        program = cl(tmp_path, f"{TO_START}INDIRV/0,1,0\nTLON,GOFWD/{text}\n")
        assert program.lost == 1 and len(program.problems) == 1
