"""The reader of Stäubli VAL3: own small programs, and real files where shared data is there."""

import os
import re
import shutil
import time
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.languages.core import flow
from beltgrinding.programs.languages.val3 import data as val3_data, reader as val3

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")

PGX = """<?xml version="1.0" encoding="utf-8"?>
<Programs xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="urn:p">
  <Program name="{name}" access="public">{head}
    <Code><![CDATA[begin
{body}
end]]></Code>
  </Program>
</Programs>
"""
DATA = """<?xml version="1.0" encoding="utf-8" ?>
<Database xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="urn:d">
  <Datas>
    <Data name="fCell" xsi:type="array" type="frame" size="1">
      <Value key="0" x="1000" rz="90" fatherId="world[0]" /></Data>
    <Data name="fPart" xsi:type="array" type="frame" size="2">
      <Value key="0" x="100" z="50" fatherId="fCell[0]" />
      <Value key="1" y="7" fatherId="world[0]" /></Data>
    <Data name="tBelt" xsi:type="array" type="tool" size="1">
      <Value key="0" z="200" fatherId="flange[0]" ioLink="v1" /></Data>
    <Data name="m" xsi:type="array" type="mdesc" size="2">
      <Value key="0" vel="50" tmax="120" rmax="90" blend="joint" leave="2" reach="3" /></Data>
    <Data name="p" xsi:type="array" type="pointRx" size="4">
      <Value key="0" x="1" y="2" z="3" fatherId="fPart[0]" />
      <Value key="1" x="10" rz="90" shoulder="lefty" fatherId="fPart[0]" />
      <Value key="2" x="20" fatherId="world[0]" />
    </Data>
    <Data name="j" xsi:type="array" type="jointRx" size="1"><Value key="0" j3="90"/></Data>
    <Data name="n" xsi:type="array" type="num" size="3"><Value key="1" value="4.5"/></Data>
    <Data name="b" xsi:type="array" type="bool" size="1"><Value key="0" value="true"/></Data>
    <Data name="k" xsi:type="collection" type="num"><Value key="two" value="2"/></Data>
    <Data name="tr" xsi:type="array" type="trsf" size="1"><Value key="0" z="-5" ry="90"/></Data>
    <Data name="io" xsi:type="array" type="dio" size="1"><Value key="0" link="x\\y"/></Data>
  </Datas>
</Database>
"""


def program(folder, body, head="", name="p", data=DATA):
    (folder / f"{name}.pgx").write_text(PGX.format(name=name, head=head, body=body), "utf-8")
    if data is not None:
        (folder / "p.dtx").write_text(data, "utf-8")
    return folder / f"{name}.pgx"


def read(folder, body, head="", data=DATA):
    return val3.read(program(folder, body, head, data=data))


def positions(found):
    return [m.pose[:3, 3].round(9).tolist() for m in found.motions if m.pose is not None]


def about(axis, degrees):
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[j, i], r[i, j] = s, -s
    return r


def angle_deg(a, b):
    d = a[:3, :3].T @ b[:3, :3]
    axis = [d[2, 1] - d[1, 2], d[0, 2] - d[2, 0], d[1, 0] - d[0, 1]]
    return np.degrees(np.arctan2(np.linalg.norm(axis), np.trace(d) - 1.0))


@needs_shared
@pytest.mark.parametrize("suffix", [".pgx", ".dtx"])
def test_flagship_program_against_its_truth(suffix):
    found = read_program(PROGRAMS / "same_path_crs_part5" / f"crs_part5{suffix}")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    assert len(found.motions) == len(truth) == 423 and not found.problems
    for k, (motion, row) in enumerate(zip(found.motions, truth)):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        assert angle_deg(motion.pose, expected) <= 1e-3, row
        assert (motion.kind, motion.line) == (("PTP", 6) if k == 0 else ("LIN", 8))
        assert motion.base == "fPart X 1500 Y -250 Z 420 RX 0 RY 0 RZ 30"
        assert motion.tool == "tBelt X 12.5 Y 0 Z 287.35 RX 0 RY 90 RZ 0"
        assert motion.speed_mm_s == (None if k == 0 else 100.0)  # .pgx moves in joints first


@needs_shared
def test_a_real_program_says_why_it_gives_no_pose():
    found = val3.read(PROGRAMS / "real" / "staubli_pushMotion.pgx")
    assert not positions(found)
    assert [p.line for p in found.problems] == [1, 23, 32, 13]
    assert "no .dtx" in str(found.problems[0]) and "rosGenericMsg" in str(found.problems[1])
    assert "gives no pose" in str(found.problems[-1])


@needs_shared
def test_points_of_data_without_a_program(tmp_path):
    shutil.copy(PROGRAMS / "same_path_crs_part5" / "crs_part5.dtx", tmp_path / "alone.dtx")
    found = val3.read(tmp_path / "alone.dtx")
    assert len(positions(found)) == 423 and {m.kind for m in found.motions} == {"PTP"}
    assert found.motions[0].line == 14 and "no program" in str(found.problems[0])
    assert found.path_arrays(10.0)["rapid"].all()  # nothing is ground between mere points


def test_angles_are_about_x_then_the_new_y_then_the_new_z(tmp_path):
    rng = np.random.default_rng(3)
    rows = np.round(rng.uniform(-179, 179, (40, 6)), 3)
    rows[:3, 4] = 90.0, -90.0, 89.9999999
    points = "".join(
        f'<Value key="{k}" ' + " ".join(f'{n}="{v}"' for n, v in zip(val3_data.TRSF, row)) + "/>"
        for k, row in enumerate(rows)
    )
    data = DATA.replace(
        "</Datas>", f'<Data name="q" type="point" size="40">{points}</Data></Datas>'
    )
    body = "for i=0 to size(q)-1\nmovel(q[i],tBelt,m)\nmovel(appro(q[i],tr),tBelt,m)\nendFor"
    found = read(tmp_path, body, data=data)
    assert not found.problems and len(found.motions) == 80
    step = np.eye(4)
    step[:3, :3], step[2, 3] = about(1, 90), -5
    for row, motion, approach in zip(rows, found.motions[::2], found.motions[1::2]):
        expected = np.eye(4)
        expected[:3, :3] = about(0, row[3]) @ about(1, row[4]) @ about(2, row[5])
        expected[:3, 3] = row[:3]
        np.testing.assert_allclose(motion.pose, expected, atol=1e-9)
        np.testing.assert_allclose(approach.pose, expected @ step, atol=1e-7)
        six = (*row[:3], *row[3:])
        whole = val3_data.product(six, val3_data.inverse(six))
        np.testing.assert_allclose(val3_data.frames([whole])[0], np.eye(4), atol=1e-7)


def test_frames_tools_and_speeds_are_named(tmp_path):
    found = read(tmp_path, "movel(p[0],tBelt,m)\nmovej(p[1],flange,m)\nmovel(p[2],tBelt,m[1])")
    first, second, third = found.motions
    assert first.base == "fPart X 1000 Y 100 Z 50 RX 0 RY 0 RZ 90"  # through fCell
    assert third.base == "world" and first.tool == "tBelt X 0 Y 0 Z 200 RX 0 RY 0 RZ 0"
    assert second.tool == "flange X 0 Y 0 Z 0 RX 0 RY 0 RZ 0"
    assert [m.kind for m in found.motions] == ["LIN", "PTP", "LIN"]
    assert [m.speed_mm_s for m in found.motions] == [120.0, None, None]
    assert [(m.file, m.line) for m in found.motions] == [("p.pgx", 5), ("p.pgx", 6), ("p.pgx", 7)]
    texts = [str(problem) for problem in found.problems]
    assert len(texts) == 1 and "tvel" in texts[0]
    # Each where the robot makes it: in the first one's frame and with its tool.
    home, belt = frames.from_abc((1000, 100, 50), (90, 0, 0)), frames.from_abc(
        (0, 0, 200), (0, 0, 0)
    )
    path = found.path_arrays(100.0)["frames"]
    into = np.linalg.inv(home)
    assert second.base in (first.base, third.base)
    moved = second.pose if second.base == first.base else into @ second.pose
    np.testing.assert_allclose(path[0], first.pose, atol=1e-9)
    np.testing.assert_allclose(path[1], moved @ belt, atol=1e-6)
    np.testing.assert_allclose(path[2], into @ third.pose, atol=1e-6)


def test_points_are_moved_composed_and_linked(tmp_path):
    body = (
        "movel(appro(p[1],{0,0,-30,0,0,0}),tBelt,m)\n"
        "movel(appro(p[1],{5,0,0,0,0,90}),tBelt,m)\n"
        "movel(compose(p[0],fCell,{0,0,8,0,0,0}),tBelt,m)\n"
        "movel(compose(p[0],fCell,{0,8,0,0,0,0}),tBelt,m)\n"
        "p[3]=p[0]\np[3].trsf=p[3].trsf*{1,0,0,0,0,0}*!{0,2,0,0,0,0}\nmovel(p[3],tBelt,m)\n"
        "p[3].trsf.z=n[1]*2-p[0].trsf.x\nmovel(p[3],tBelt,m)\n"
        "p[3]={{1,1,1,0,0,0},{sfree,efree,wfree}}\nlink(p[3],fPart[1])\n"
        "movej(p[3],tBelt,m)\nn=distance(p[0],p[1])\np[3].trsf.x=n\nmovel(p[3],tBelt,m)\n"
        "p[3].trsf=position(p[0],fCell)\nmovel(p[3],tBelt,m)"
    )
    found = read(tmp_path, body)
    assert not found.problems
    # fCell's axes are parallel to fPart's: compose adds there.
    assert positions(found) == [
        [10, 0, -30],
        [10, 5, 0],
        [1, 2, 11],
        [1, 10, 3],
        [2, 0, 3],
        [2, 0, 8],
        [1, 1, 1],
        [round(np.sqrt(81 + 4 + 9), 9), 1, 1],
        [101, 2, 53],
    ]
    np.testing.assert_allclose(found.motions[1].pose[:3, 0], [-1, 0, 0], atol=1e-12)
    assert found.motions[6].base == "fPart[1] X 0 Y 7 Z 0 RX 0 RY 0 RZ 0"


def test_compose_in_a_turned_frame(tmp_path):
    found = read(tmp_path, "movel(compose(p[2],fCell,{3,0,0,0,0,90}),tBelt,m)")
    cell, point, turn = np.eye(4), np.eye(4), np.eye(4)
    cell[:3, :3], cell[0, 3] = about(2, 90), 1000
    point[0, 3] = 20
    turn[:3, :3], turn[0, 3] = about(2, 90), 3
    expected = cell @ turn @ np.linalg.inv(cell) @ point
    np.testing.assert_allclose(found.motions[0].pose, expected, atol=1e-9)


def test_arcs(tmp_path):
    body = "movel(p[0],tBelt,m)\nl_n=movec(p[1],appro(p[0],{20,0,0,0,0,0}),tBelt,m)"
    found = read(tmp_path, body)
    assert not found.problems and [m.aux for m in found.motions] == [False, True, False]
    assert [m.kind for m in found.motions] == ["LIN", "CIRC", "CIRC"]
    foreign = read(tmp_path, "movec(p[2],p[0],tBelt,m)")  # p[2] stands in the world
    world_from_part = np.eye(4)
    world_from_part[:3, :3], world_from_part[:3, 3] = about(2, 90), [1000, 100, 50]
    expected = np.linalg.inv(world_from_part) @ [20, 0, 0, 1]
    np.testing.assert_allclose(foreign.motions[0].pose[:3, 3], expected[:3], atol=1e-9)


def test_a_frame_that_is_moved_moves_its_points_base(tmp_path):
    found = read(
        tmp_path, "fPart.trsf.x=0\nmovel(p[0],tBelt,m)\nfCell={{1,2,3,0,0,0}}\nmovel(p[0],tBelt,m)"
    )
    assert [m.base[6:27] for m in found.motions] == [
        "X 1000 Y 0 Z 50 RX 0 ",
        "X 1 Y 2 Z 53 RX 0 RY ",
    ]


def test_control_flow(tmp_path):
    (tmp_path / "p.pjx").write_text(
        '<Project xmlns="x"><Parameters millimeterUnit="true"/></Project>'
    )
    head = (
        '<Parameters/><Locals><Local name="l_n" type="num" xsi:type="array" size="2"/>'
        '<Local name="l_p" type="pointRx" xsi:type="array" size="1"/></Locals>'
    )
    program(
        tmp_path,
        "  x_p.trsf.y=x_n*10\n  if x_n>2\n    return\n  endIf\n  movel(x_p,tBelt,m)\n  x_n=x_n+1",
        '<Parameters><Parameter name="x_p" type="pointRx" use="value"/>'
        '<Parameter name="x_n" type="num" use="reference"/></Parameters>',
        name="step",
    )
    body = (
        "l_p=p[0] // call step(l_p, l_n)\nfor l_n[1]=3 to 0 step -1.5\n  l_p.trsf.x=l_n[1]\n"
        "  movel(l_p,tBelt,m)\nendFor\nwhile l_n<=1 and not (l_n==7)\n  call step(l_p,l_n)\n"
        'endWhile\ndo\n  l_n=l_n-1\nuntil l_n<=0\nswitch k["two"]\n  case 1, 3\n    movel(p[2],tBelt,m)\n'
        "  break\n  case 2\n    if(b==false)\n      movel(p[2],tBelt,m)\n    elseIf l_n!=0\n"
        '      movel(p[2],tBelt,m)\n    else\n      put("// endIf")\n      movel(p[1],tBelt,m)\n    endIf\n'
        "  break\n  default\n    movel(p[2],tBelt,m)\n  break\nendSwitch\n"
        "movel({{sel(b,abs(-4),9),roundDown(2.7),7%4,0,0,0},{sfree,efree,wfree}},tBelt,m)"
    )
    found = read(tmp_path, body, head)
    assert [p.line for p in found.problems] == [34]  # a literal is no point of its own frame
    assert positions(found) == [
        [3, 2, 3],
        [1.5, 2, 3],
        [0, 2, 3],
        [0, 0, 3],
        [0, 10, 3],
        [10, 0, 0],
    ]
    assert [m.file for m in found.motions[3:5]] == ["step.pgx"] * 2
    assert [m.line for m in found.motions[2:6]] == [8, 9, 9, 27]


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("p[0]=here(tBelt,world)\nmovel(p[0],tBelt,m)", "here()"),
        ("p[0].trsf.x=sioGet(io)\nmovel(p[0],tBelt,m)", "sioGet"),
        ("movel(p[n[1]],tBelt,m)", "no element 4.5"),
        ("movel(p[9],tBelt,m)", "no element 9"),
        ("movel(pNone,tBelt,m)", "pNone is not declared"),
        ("movel(j,tBelt,m)", "joint position"),
        ("movel(p[0],tBelt)", "2 arguments"),
        ("movel(p[0],tBelt,m", "cannot read|not understood"),
        ("movel(p[0].trsf,tBelt,m)", "no point"),
        ("moveSomewhere(p[0])", "moveSomewhere"),
        ("alterMovel(p[0],tBelt,m)", "alterMovel"),
        ("call other()", "no other.pgx"),
        ("call lib:other(n)", "library"),
        ('taskCreate "t",100,other()', "beside"),
        ("if io==true\nmovel(p[2],tBelt,m)\nendIf", "decided at run time"),
        ("while io==true\nmovel(p[2],tBelt,m)\nendWhile", "decided at run time"),
        ("switch io\ncase 1\nmovel(p[2],tBelt,m)\nbreak\nendSwitch", "decided at run time"),
        ("for i=0 to getKey()\nmovel(p[2],tBelt,m)\nendFor", "no static bounds"),
        ("movel(p[3],tBelt,m)", "not taught"),
        ("movec(p[0],appro(p[3],tr),tBelt,m)", "fNone is not declared"),
        ("readPoint(p[0])\nmovel(p[0],tBelt,m)", "readPoint"),
    ],
)
def test_what_is_not_known_is_said_with_its_line(tmp_path, text, culprit):
    data = DATA
    if "fNone" in culprit:
        data = DATA.replace(
            '    </Data>\n    <Data name="j"',
            '<Value key="3" x="1" fatherId="fNone[0]"/></Data>\n    <Data name="j"',
        )
        assert data != DATA
    found = read(tmp_path, f"movel(p[0],tBelt,m)\n{text}\nmovel(p[1],tBelt,m)", data=data)
    assert found.problems and all(p.line in (6, 7) for p in found.problems)
    assert re.search(culprit, " ".join(map(str, found.problems)))
    arrays = found.path_arrays(50.0)
    assert len(arrays["frames"]) == 2
    assert arrays["rapid"][1]  # the gap is not ground over


def test_what_is_assigned_in_a_branch_left_out_is_not_known_after_it(tmp_path):
    body = "if io==true\n  n[1]=3\n  p[1].trsf.x=5\nendIf\nmovel(p[1],tBelt,m)\np[2].trsf.x=n[1]\n"
    found = read(tmp_path, body + "movel(p[2],tBelt,m)")
    assert not positions(found) and len(found.problems) == 3


def test_loops_and_cases_that_are_left_early(tmp_path):
    body = (
        "for i=0 to 5\n  p[2].trsf.x=i\n  movel(p[2],tBelt,m)\n  if i==2\n    i=4\n  endIf\nendFor\n"
        "switch n[1]\n  case 4.5\n    if b\n      break\n    endIf\n    movel(p[1],tBelt,m)\n"
        "  break\nendSwitch\nmovel(p[1],tBelt,m)\nbreak\nmovel(p[0],tBelt,m)"
    )
    found = read(tmp_path, body, data=DATA.replace('x="20" f', 'x="20" z="1" f'))
    assert [x for x, _, _ in positions(found)] == [0, 1, 2, 5, 10]
    assert [p.line for p in found.problems][-1] == 21 and len(found.motions) == 6
    lost = read(
        tmp_path, "for i=0 to 1\nmovel(p[2],tBelt,m)\ni=getKey()\nendFor\nmovel(p[1],tBelt,m)"
    )
    assert "its further motions are left out" in str(lost.problems[-1])
    assert [m.pose is None for m in lost.motions] == [False, True, False]


def test_joint_targets_are_kept_without_a_pose(tmp_path):
    found = read(tmp_path, "movej(j,tBelt,m)\nmovej({0,1,2,3,4,5},tBelt,m)\nmovel(p[0],tBelt,m)")
    assert [m.pose is None for m in found.motions] == [True, True, False]
    assert not found.problems
    assert found.path_arrays(50.0)["rapid"].tolist() == [True]


def test_instructions_without_motion_are_no_problem(tmp_path):
    body = 'waitEndMove()\nopen(tBelt)\ndelay(0.5)\nput("movel(")\nio=true\nwait(io==true)\n'
    found = read(tmp_path, body + "movel(p[0],tBelt,m)\nenablePower()\nresetMotion()\n")
    assert not found.problems and len(found.motions) == 1


def test_files_of_an_application(tmp_path):
    program(tmp_path, "call main()", name="start")
    path = program(tmp_path, "movel(p[0],tBelt,m)", name="main")
    path.rename(tmp_path / "Main.PGX")
    (tmp_path / "p.dtx").rename(tmp_path / "Cell.dtx")
    (tmp_path / "Cell.pjx").write_text(
        '<Project><Parameters millimeterUnit="false"/><Database><Data file="Cell.dtx"/></Database>'
        "</Project>"
    )
    found = val3.read(tmp_path / "start.pgx")
    assert not found.problems and found.motions[0].file == "Main.PGX"
    np.testing.assert_allclose(found.motions[0].pose[:3, 3], [25.4, 50.8, 76.2])
    assert found.motions[0].speed_mm_s == pytest.approx(120 * 25.4)
    (tmp_path / "Cell.pjx").unlink()
    (tmp_path / "Other.dtx").write_text(DATA)
    several = val3.read(tmp_path / "start.pgx")
    assert "Cell.dtx, Other.dtx" in str(several.problems[0]) and not positions(several)


def test_lines_stay_true_beside_comments(tmp_path):
    text = PGX.format(name="p", head="", body="movel(p[0],tBelt,m)").replace(
        "<Code><![CDATA[begin", "<Code>\n\n<!-- a\nb -->\n<![CDATA[\r\nbegin"
    )
    (tmp_path / "p.pgx").write_bytes(("\ufeff" + text).encode())
    (tmp_path / "p.dtx").write_text(DATA)
    lines = text.splitlines()
    assert val3.read(tmp_path / "p.pgx").motions[0].line == lines.index("movel(p[0],tBelt,m)") + 1


def test_damaged_numbers_are_never_silent(tmp_path):
    for bad in ("1.2.3", "12abc", "1e", "--3", "nan", "1e999", "1_0", "0x1F", "", "1,5", "9" * 400):
        found = read(tmp_path, "movel(p[0],tBelt,m)", data=DATA.replace('x="1" y', f'x="{bad}" y'))
        assert not positions(found) and found.problems, bad
    for other in ('w="1" y', 'X="1" y', 'fatherId="fNone[0]" x="1" y'):
        data = DATA.replace('x="1" y', other).replace('z="3" fatherId="fPart[0]"', 'z="3"')
        found = read(tmp_path, "movel(p[0],tBelt,m)", data=data)
        assert not positions(found) and found.problems, other
    for bad in (
        "{1.2.3,0,0,0,0,0}",
        "{1,2,3,0,0}",
        "{1,2,3,0,0,0,0}",
        "{1e999,0,0,0,0,0}",
        "{1,,0}",
    ):
        found = read(tmp_path, f"p[0].trsf={bad}\nmovel(p[0],tBelt,m)")
        assert not positions(found) and found.problems, bad
    found = read(
        tmp_path, "movel(p[1],tBelt,m)", data=DATA.replace('key="1" x="10"', 'key="0" x="10"')
    )
    assert "given twice" in str(found.problems) and not positions(found)


def test_files_cut_off_or_hostile_are_refused(tmp_path):
    path = program(tmp_path, "movel(p[0],tBelt,m)")
    whole = {suffix: path.with_suffix(suffix).read_bytes() for suffix in (".pgx", ".dtx")}
    for suffix, raw in whole.items():
        for end in range(0, len(raw) - 20, 97):
            path.with_suffix(suffix).write_bytes(raw[:end])
            with pytest.raises(ProgramError, match=f"p{suffix}:"):
                val3.read(path)
        path.with_suffix(suffix).write_bytes(raw)
    bomb = '<!DOCTYPE d [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>'
    outside = '<!DOCTYPE d [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
    for doctype in (bomb, outside):
        text = whole[".dtx"].decode().replace("<Database", doctype + "<Database")
        path.with_suffix(".dtx").write_text(text)
        with pytest.raises(ProgramError, match="DOCTYPE"):
            val3.read(path)
    path.write_text("<a>" * 300)
    with pytest.raises(ProgramError, match="nested too deeply"):
        val3.read(path)
    path.write_text('<programList xmlns="ProgramNameSpace"/>')
    with pytest.raises(ProgramError, match="s7 or later"):
        val3.read(path)
    with pytest.raises(ProgramError, match="absent"):
        val3.read(tmp_path / "absent.pgx")


@pytest.mark.parametrize("body", ["for i=0 to 3\nmovel(p[0],tBelt,m)", "endIf", "if b\nendFor"])
def test_blocks_that_do_not_match(tmp_path, body):
    with pytest.raises(ProgramError, match=r"p\.pgx:\d+: .*clos"):
        read(tmp_path, body)


def test_nothing_hangs_or_overflows(tmp_path):
    with pytest.raises(ProgramError, match="too long or does not end"):
        read(tmp_path, "for i=1 to 999999\nn=i\nendFor")
    for body in ("while 1<2\nn=n+1\nendWhile", "while b\nendWhile"):
        assert "an endless while is followed once" in str(read(tmp_path, body).problems[0])
    for body in (
        "call p()",
        "n=" + "(" * 5000,
        "n=" + "1+" * 20000 + "1",
        "n=" + "-" * 9999,
        "n=power(10,power(10,10))",
        "for i=0 to 1 step 0\nendFor",
    ):
        read(tmp_path, body)
    circle = DATA.replace('rz="90" fatherId="world[0]"', 'fatherId="fPart[0]"')
    found = read(
        tmp_path, "movel(p[0],tBelt,m)\nmovel(compose(p[0],world,tr),tBelt,m)", data=circle
    )
    assert "circle" in " ".join(map(str, found.problems))
    huge = read(tmp_path, "movel(p[0],tBelt,m)", data=DATA.replace('size="4"', 'size="99999999"'))
    assert not positions(huge) and "sensible" in str(huge.problems[0])


def test_a_hundred_thousand_motions_take_seconds(tmp_path):
    count = 100_000
    values = "".join(
        f'<Value key="{k}" x="{k * 0.01:.2f}" ry="{k % 80}" rz="3" fatherId="fPart[0]" />\n'
        for k in range(count)
    )
    extra = f'<Data name="q" xsi:type="array" type="pointRx" size="{count}">{values}</Data></Datas>'
    body = "\n".join(f"movel(q[{k}],tBelt,m)" for k in range(count))
    path = program(tmp_path, body, data=DATA.replace("</Datas>", extra))
    start = time.process_time()
    found = val3.read(path)
    seconds = time.process_time() - start
    assert len(found.motions) == count and not found.problems
    assert found.motions[-1].pose[0, 3] == pytest.approx(999.99)
    assert seconds < 15.0, seconds  # 3 s on two slow cores


def test_mutated_programs_never_crash(tmp_path, monkeypatch):
    monkeypatch.setattr(flow, "MAX_UNROLLED", 2000)
    rng = np.random.default_rng(1)
    body = (
        "for i=0 to 2\n  p[i].trsf.x=n[1]*i+3\n  movel(appro(p[i],{0,0,-5,0,0,i}),tBelt,m)\nendFor\n"
        "if n<3 and b\n  movec(p[0],p[1],tBelt,m[0])\nelse\n  n=sin(n)\nendIf\n"
        "link(p[3],fCell)\nmovel(compose(p[0],fCell,tr),tBelt,m)\ncall p()\nmovej(j,tBelt,m)"
    )
    path = program(tmp_path, body)
    whole = {suffix: path.with_suffix(suffix).read_bytes() for suffix in (".pgx", ".dtx")}
    read_whole = 0
    for k in range(300):
        suffix = (".pgx", ".dtx")[k % 2]
        bad = bytearray(whole[suffix])
        for _ in range(rng.integers(1, 4)):
            bad[rng.integers(len(bad))] = rng.integers(32, 127) if k % 3 else rng.integers(256)
        if k % 5 == 0:
            bad = bad[: rng.integers(10, len(bad))]
        for name, raw in whole.items():
            path.with_suffix(name).write_bytes(bytes(bad) if name == suffix else raw)
        try:
            found = val3.read(path)
            read_whole += 1
            assert np.isfinite(found.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "p." in str(error)
    assert read_whole > 50  # the mutations reach beyond the XML
