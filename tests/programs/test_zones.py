"""Where a program says that the robot stops and where it rounds corners, language by language."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.engine import core
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.program import CHORD_ERROR, ON_CURVE

ROOT = Path(__file__).resolve().parents[2]

INF = float("inf")
PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def read(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    return read_program(tmp_path / name)


def zones(program):
    return [motion.zone_mm for motion in program.motions if motion.pose is not None]


def krl(tmp_path, body):
    return read(tmp_path, "p.src", f"DEF p()\n{body}\nEND\n")


START = "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"


@pytest.mark.parametrize(
    "body, expected",
    [
        ("$APO.CDIS=2.5\nLIN {X 1}\nLIN {X 2} C_DIS\nLIN {X 3} c_dis c_dis", [0, 0, 2.5, 2.5]),
        ("LIN {X 1} C_DIS", [0, None]),  # $APO.CDIS is not set here
        ("$APO.CDIS=2\nLIN {X 1} C_VEL\nLIN {X 2} C_ORI\nPTP {X 3} C_PTP", [0, None, None, None]),
        ("$APO.CDIS=2\nPTP {X 1} C_PTP C_DIS", [0, 2.0]),
        ("$APO={CVEL 50,CDIS 4.0}\nLIN {X 1} C_DIS", [0, 4.0]),
        ("$APO.CDIS=2\nSLIN {X 1} WITH $VEL.CP=0.1 C_SPL", [0, 2.0]),
        ("$APO.CDIS=2\nSLIN {X 1} WITH $APO.CDIS=7 C_SPL\nSLIN {X 2} C_SPL", [0, 7.0, 2.0]),
        ("$APO.CDIS=2\nSPLINE\nSPL {X 1}\nSPL {X 2}\nSLIN {X 3}\nENDSPLINE", [0, INF, INF, 0]),
        ("$APO.CDIS=2\nSPLINE\nSPL {X 1}\nSPL {X 2}\nENDSPLINE C_SPL\nLIN {X 3}", [0, INF, 2.0, 0]),
        ("$APO.CDIS=$IN[3]\nLIN {X 1} C_DIS", [0, None]),
        ("$APO.CDIS=3\nFOR I=1 TO 2\nLIN_REL {X 1} C_DIS\n$APO.CDIS=5\nENDFOR", [0, 3.0, 5.0]),
    ],
)
def test_krl_approximates_where_a_motion_says_so(tmp_path, body, expected):
    assert zones(krl(tmp_path, START + body)) == expected


def test_krl_inline_forms_take_the_distance_of_their_data(tmp_path):
    (tmp_path / "p.dat").write_text(
        "DEFDAT p\nDECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 7.5,APO_FAC 50.0,ORI_TYP #VAR}\n"
        "ENDDAT\n"
    )
    body = "LDAT_ACT=LCPDAT1\nBAS(#CP_PARAMS,0.2)\nLIN {X 1} C_DIS C_DIS\nLIN {X 2}"
    assert zones(krl(tmp_path, START + body)) == [0, 7.5, 0]


def rapid(tmp_path, body, declarations=""):
    text = f"MODULE m\n{declarations}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n"
    return read(tmp_path, "p.mod", text)


def target(x):
    return f"[[{x},0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


@pytest.mark.parametrize(
    "zone, expected",
    [
        ("fine", 0),
        ("z0", 0.3),
        ("z1", 1.0),
        ("z5", 5.0),
        ("z150", 150.0),
        ("own", 1.5),
        ("still", 0),
        ("[FALSE,12,18,18,1.8,18,1.8]", 12.0),
        ("z10\\Z:=4.5", 4.5),
        ("z10\\Inpos:=inpos50", 0),
        ("elsewhere", None),
        ("z7", None),
    ],
)
def test_rapid_has_zonedata(tmp_path, zone, expected):
    own = "PERS zonedata own:=[FALSE,1.5,2,2,0.2,2,0.2];\nCONST zonedata still:=[TRUE,9,9,9,9,9,9];"
    program = rapid(tmp_path, f"MoveL {target(1)},v100,{zone},tool0;", own)
    assert zones(program) == [expected]
    assert any("zone" in str(p) for p in program.problems) == (expected is None)


@pytest.mark.parametrize(
    "instruction, expected",
    [
        (f"MoveC {target(1)},{target(2)},v100,z5,tool0;", [5.0, 5.0]),
        (f"MoveLDO {target(1)},v100,z20,tool0,do1,1;", [20.0]),
        (f"TriggL {target(1)},v100,trigg1,z30,tool0;", [30.0]),
        (f"SearchL di1,found,{target(1)},v100,tool0;", [0]),  # has no zone: ends in a stop point
    ],
)
def test_rapid_zones_of_other_instructions(tmp_path, instruction, expected):
    assert zones(rapid(tmp_path, instruction, "VAR robtarget found;")) == expected


def test_urscript_has_blend_radii_in_metres(tmp_path):
    text = """def p():
  blend_m = 0.0015
  movel(p[0,0,0,0,0,0], a=1.2, v=0.1)
  movel(p[0.1,0,0,0,0,0], a=1.2, v=0.1, r=0.005)
  movel(p[0.2,0,0,0,0,0], 1.2, 0.1, 0, blend_m)
  movep(p[0.3,0,0,0,0,0], a=1.2, v=0.1, r=0.002)
  movec(p[0.4,0.1,0,0,0,0], p[0.5,0,0,0,0,0], 1.2, 0.1, 0.003)
  movel(p[0.6,0,0,0,0,0], r=unknown)
end
"""
    program = read(tmp_path, "p.script", text)
    assert zones(program) == pytest.approx([0, 5, 1.5, 2, 3, 3, None])
    assert len(program.problems) == 1 and "blend radius" in str(program.problems[0])


def test_fanuc_has_termination_types(tmp_path):
    ends = ["FINE", "CNT100", "CNT0", "CR25", "CD10", "CNT50 ACC80", "FINE PTH"]
    moves = "".join(f"{k}:L P[{k}] 10mm/sec {end} ;\n" for k, end in enumerate(ends, 1))
    points = "".join(
        f"P[{k}]{{\n GP1:\n UF : 1, UT : 1,\n X = {k} mm, Y = 0 mm, Z = 0 mm,\n"
        " W = 0 deg, P = 0 deg, R = 0 deg\n};\n"
        for k in range(1, len(ends) + 1)
    )
    program = read(tmp_path, "p.ls", f"/PROG P\n/MN\n{moves}/POS\n{points}/END\n")
    assert zones(program) == [0, None, None, 25.0, 10.0, None, 0]
    assert [m.corner_share for m in program.motions] == [None, 1.0, None, None, None, 0.5, None]
    assert program.path_arrays(10.0)["zones"].tolist() == [0, -2, -1, 25, 10, -1.5, 0]


def test_inform_has_position_levels(tmp_path):
    tags = ["V=10 PL=0", "V=10 PL=3", "V=10", "V=10 CR=12.5", "PL=0 V=10"]
    points = "".join(f"C{k:05d}={k},0,0,0,0,0\n" for k in range(len(tags)))
    moves = "".join(f"MOVL C{k:05d} {tag}\n" for k, tag in enumerate(tags))
    text = (
        f"/JOB\n//NAME A\n//POS\n///NPOS {len(tags)},0,0,0,0,0\n///USER 1\n///TOOL 0\n"
        "///POSTYPE USER\n///RECTAN\n///RCONF 0,0,0,0,0,0,0,0\n"
        f"{points}//INST\n///DATE 2024/01/01 00:00\n///ATTR SC,RW\nNOP\n{moves}END\n"
    )
    assert zones(read(tmp_path, "p.jbi", text)) == [0, None, None, 12.5, 0]


@pytest.mark.parametrize(
    "code, expected",
    [
        ("", [None, None]),
        ("G61", [0, 0]),
        ("G60", [0, 0]),
        ("G64", [None, None]),
        ("G64 P0.05", [0.1, 0.1]),
        ("G20 G64 P0.01", [0.508, 0.508]),
        ("G64 P0.05\nG9 X0.5\nG61", [0.0, 0, 0]),
    ],
)
def test_gcode_has_path_modes(tmp_path, code, expected):
    found = zones(read(tmp_path, "p.nc", f"G21 G90 G0 X0 Y0 Z0\nG1 F100\n{code}\nX1\nX2\nM30\n"))[
        1:
    ]
    assert found == pytest.approx(expected)


def test_a_full_circle_in_gcode_has_no_stop_half_way(tmp_path):
    program = read(tmp_path, "p.nc", "G21 G90 G17 G0 X0 Y0 Z0\nG61\nG2 X0 Y0 I10 J0 F100\nM30\n")
    found = program.path_arrays(100.0)["zones"][1:]
    assert found[-1] == 0 and (found[:-1] > 0).all() and len(found) > 20


def test_a_table_may_have_a_column_of_zones(tmp_path):
    head = "x_mm,y_mm,z_mm,qw,qx,qy,qz,zone_mm\n"
    program = read(tmp_path, "p.csv", head + "0,0,0,1,0,0,0,0\n1,0,0,1,0,0,0,\n2,0,0,1,0,0,0,2.5\n")
    assert zones(program) == [0, None, 2.5]
    with pytest.raises(ProgramError, match="zone_mm is -1"):
        read(tmp_path, "p.csv", head + "0,0,0,1,0,0,0,-1\n")


def rounded(arrays):
    """mm by which each inner pose is missed: zone |v - u| / 4, the zone at most half of the way."""
    steps = np.diff(arrays["frames"][:, :3, 3], axis=0)
    ways = np.linalg.norm(steps, axis=1)
    zone = np.minimum(arrays["zones"][1:-1], 0.5 * np.minimum(ways[1:], ways[:-1]))
    return 0.25 * zone * np.linalg.norm(np.diff(steps / ways[:, None], axis=0), axis=1)


def test_chords_of_an_arc_are_rounded_and_its_end_is_as_programmed(tmp_path):
    body = "CIRC {X 10,Y 10},{X 20,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 30}"
    arrays = krl(tmp_path, START + body).path_arrays(100.0)
    assert arrays["zones"][0] == arrays["zones"][-2] == arrays["zones"][-1] == 0
    inner = arrays["zones"][1:-2]
    assert len(inner) > 10 and (inner > 0).all()
    assert rounded(arrays).max() <= CHORD_ERROR * 1.01


def test_a_spline_passes_through_its_points(tmp_path):
    body = "SPLINE\nSPL {X 100}\nSPL {X 195,Y 30}\nSPL {X 195,Y 130}\nENDSPLINE\nLIN {X 300}"
    arrays = krl(tmp_path, START + body).path_arrays(100.0)
    assert (arrays["zones"][1:3] == ON_CURVE).all() and arrays["zones"][3] == 0
    law = {"timing": "trapezoidal", "acceleration": 1000.0}
    given = {
        name: arrays[name] for name in ("frames", "feeds", "forces", "rapid", "lines", "zones")
    }
    path = core.ToolPath(**given, time_law=law)
    places = [path.frame_at(time)[0][:3, 3] for time in path.times()]
    assert np.abs(np.array(places) - arrays["frames"][:, :3, 3]).max() < 1e-6
    # It does not stop there.
    after = [path.frame_at(time + 0.01)[0][:3, 3] for time in path.times()[1:3]]
    assert (np.linalg.norm(np.array(after) - places[1:3], axis=1) > 0.3).all()


def test_before_a_joint_target_no_corner_is_rounded(tmp_path):
    body = "$APO.CDIS=5\nLIN {X 10} C_DIS\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nLIN {X 1,Y 1,Z 1,A 0,B 0,C 0} C_DIS"
    arrays = krl(tmp_path, START + body).path_arrays(100.0)
    assert arrays["zones"].tolist() == [0, 0, 5]
    assert arrays["rapid"].tolist() == [True, False, True]


@needs_shared
def test_one_path_in_three_languages_has_the_same_zones():
    folder = PROGRAMS / "same_path_crs_part5"
    files = ("crs_part5.src", "CrsPart5.mod", "crs_part5.script")
    found = [
        [m.zone_mm for m in read_program(folder / f).motions if m.pose is not None] for f in files
    ]
    assert len({len(one) for one in found}) == 1
    # $APO.CDIS = 1.5, zProc, blend_m. In KRL two passes are splines, and where a pass begins and
    # ends each post-processor has its own habit.
    rows = list(zip(*found))
    assert sum(row == (1.5, 1.5, 1.5) for row in rows) == 320
    assert sum(row == (INF, 1.5, 1.5) for row in rows) > 30
