"""The reader of PolyScope's .urp, by files of our own in the published structure."""

import gzip
import re
import time
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import Motion, ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.languages.core import flow
from beltgrinding.programs.languages.urp import position as urp_position
from beltgrinding.programs.languages import xml_tree

ROOT = Path(__file__).resolve().parents[2]

# Universal Robots' published Denavit-Hartenberg parameters of the UR5e, m and rad.
UR5E = {
    "deltaTheta": "0.0, 0.0, 0.0, 0.0, 0.0, 0.0",
    "a": "0.0, -0.425, -0.3922, 0.0, 0.0, 0.0",
    "d": "0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996",
    "alpha": "1.5707963267948966, 0.0, 0.0, 1.5707963267948966, -1.5707963267948966, 0.0",
}
ZERO = dict.fromkeys(UR5E, "0, 0, 0, 0, 0, 0")
NONE = "0.0, 0.0, 0.0, 0.0, 0.0, 0.0"
BASE = '<feature class="GeomFeatureReference" referencedName="Joint_0_name"/>'


def kinematics(arm=UR5E, tag="Kinematics"):
    values = "".join(f'<{name} value="{value}"/>' for name, value in arm.items())
    return f'<{tag} status="LINEARIZED" validChecksum="true">{values}</{tag}>'


def waypoint(joints=NONE, tcp=NONE, feature=NONE, name="W", arm=UR5E, more="<motionParameters/>"):
    """A waypoint as PolyScope 5 writes it."""
    return (
        f'<Waypoint type="Fixed" name="{name}" kinematicsFlags="4">{more}<position>'
        f'<JointAngles angles="{joints}"/><TCPOffset pose="{tcp}"/>{kinematics(arm)}</position>'
        f'<BaseToFeature pose="{feature}"/></Waypoint>\n'
    )


def old(pose, inner=None, name="W", more=""):
    """A waypoint as PolyScope 3 writes it."""
    inner = f'<poseInFeatureCoordinates pose="{inner or pose}"/>'
    position = f'<position joints="{NONE}" pose="{pose}"/>'
    return f'<Waypoint type="Fixed" name="{name}">{more}{position}{inner}</Waypoint>\n'


def move(children, kind="MoveL", feature=BASE, more='speed="0.25" acceleration="1.2"'):
    return (
        f'<Move motionType="{kind}" {more} useActiveTCP="true">{feature}'
        f"<children>{children}</children></Move>\n"
    )


def expression(text):
    chars = "".join(
        f'<ExpressionChar character="{c.replace("&", "&amp;").replace(chr(34), "&quot;").replace("<", "&lt;")}"/>'
        for c in text
    )
    return f"<expression>{chars}</expression>"


def document(main, tops="", arm=ZERO):
    return (
        '<URProgram name="t" createdIn="5.12.5" lastSavedIn="5.12.5">\n'
        f"{kinematics(arm, 'kinematics')}<children>{tops}"
        f'<MainProgram runOnlyOnce="false"><children>\n{main}</children></MainProgram>'
        "</children></URProgram>\n"
    )


def read(tmp_path, main, tops="", arm=ZERO):
    (tmp_path / "p.urp").write_bytes(gzip.compress(document(main, tops, arm).encode()))
    return read_program(tmp_path / "p.urp")


def positions(program):
    return [m.pose[:3, 3].round(6).tolist() for m in program.motions if m.pose is not None]


def turned(axis, angle):
    """Rodrigues' formula, apart from the reader's."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def test_waypoints_of_joints_are_where_the_arm_is():
    """The stretched UR5e lies along -x; turning the base by 90 degrees turns all of it."""
    positions = urp_position.Positions()
    arm = sum((urp_position.six(UR5E[n], n) for n in urp_position.PARAMETERS), ())
    zero, lifted, turned_base = (Motion("LIN", None, 1, "p") for _ in range(3))
    nothing, up = (0.0,) * 6, (0.0, -np.pi / 2, 0.0, 0.0, 0.0, 0.0)
    positions.joints += [
        (zero, nothing, arm, nothing, nothing),
        (lifted, up, arm, nothing, nothing),
        (turned_base, (np.pi / 2, *up[1:]), arm, (0, 0, 0.1, 0, 0, 0), nothing),
    ]
    assert positions.finish() == []
    np.testing.assert_allclose(zero.pose[:3, 3], [-817.2, -232.9, 62.8], atol=1e-9)
    # Upright: the whole length stands on the shoulder, the wrist's d5 beside it.
    np.testing.assert_allclose(lifted.pose[:3, 3], [-99.7, -232.9, 162.5 + 425 + 392.2], atol=1e-9)
    np.testing.assert_allclose(
        turned_base.pose[:3, 3], [232.9 + 100, -99.7, 162.5 + 425 + 392.2], atol=1e-9
    )


def test_a_polyscope_5_program(tmp_path):
    joints = "0.3, -1.2, 1.9, -0.4, 1.1, 0.2"
    feature, tcp = "0.4, -0.1, 0.2, 0.0, 0.0, 1.5707963267948966", "0.01, 0.0, 0.12, 0.5, 0.0, 0.0"
    plane = '<feature class="GeomFeatureReference" referencedName="Plane_1"/>'
    same = '<feature class="GeomFeatureReference" reference="../../Move[2]/feature"/>'
    program = read(
        tmp_path,
        move(waypoint(joints), "MoveJ")
        + move(
            waypoint(joints, tcp, feature, more='<motionParameters cartesianSpeed="0.1"/>'),
            feature=plane,
        )
        + move(waypoint(joints, tcp, feature), "MoveP", same),
    )
    assert [m.kind for m in program.motions] == ["PTP", "LIN", "LIN"]
    assert [m.speed_mm_s for m in program.motions] == [None, 100.0, 250.0]
    first, second, third = program.motions
    assert (
        first.base == "" and second.base == third.base == "Plane_1 p[0.4, -0.1, 0.2, 0, 0, 1.5708]"
    )
    assert second.tool == "p[0.01, 0, 0.12, 0.5, 0, 0]"
    offset, plane_1 = np.eye(4), np.eye(4)
    offset[:3, :3], offset[:3, 3] = turned([1, 0, 0], 0.5), [10, 0, 120]
    plane_1[:3, :3], plane_1[:3, 3] = turned([0, 0, 1], np.pi / 2), [400, -100, 200]
    np.testing.assert_allclose(second.pose, np.linalg.inv(plane_1) @ first.pose @ offset, atol=1e-9)
    np.testing.assert_array_equal(second.pose, third.pose)
    assert not program.problems
    path = program.path_arrays(100.0)["frames"]  # in the plane, with its tool
    np.testing.assert_allclose(path[0], path[1], atol=1e-9)
    assert [m.line for m in program.motions] == [3, 5, 7]  # the XML's own


def test_a_polyscope_3_program(tmp_path):
    pose = "0.1, 0.2, 0.3, 0.0, 3.141592653589793, 0.0"
    in_plane = "0.1, 0.0, 0.0, 0.0, 3.141592653589793, 0.0"
    plane = '<feature class="GeomFeatureReference" referencedName="Plane_1"/>'
    program = read(
        tmp_path, move(old(pose)) + move(old(pose, in_plane) + old(pose, in_plane), feature=plane)
    )
    np.testing.assert_allclose(
        program.motions[0].pose, frames.from_abc([100, 200, 300], [0, 180, 0]), atol=1e-9
    )
    np.testing.assert_allclose(program.motions[1].pose[:3, 3], [100, 0, 0], atol=1e-9)
    assert program.motions[1].base == "Plane_1 p[0, 0.2, 0.3, 0, 0, 0]"
    assert not program.problems
    path = program.path_arrays(100.0)["frames"]
    np.testing.assert_allclose(path[0], path[1], atol=1e-9)


def test_joint_angles_without_kinematics_have_no_pose(tmp_path):
    bare = (
        waypoint(arm=ZERO)
        + f'<Waypoint type="Fixed" name="B"><position joints="{NONE}"/></Waypoint>'
    )
    program = read(tmp_path, move(old(NONE) + bare + old("0, 0, 0.1, 0, 0, 0")))
    assert [m.pose is None for m in program.motions] == [False, True, True, False]
    assert len(program.problems) == 2 and "no kinematics" in str(program.problems[0])
    assert program.path_arrays(10.0)["rapid"].tolist() == [True, True]
    # With the program's own kinematics the same waypoint has a pose.
    inner = waypoint().replace(kinematics(), "")
    assert positions(read(tmp_path, move(inner), arm=UR5E)) == [[-817.2, -232.9, 62.8]]


def test_arcs(tmp_path):
    points = [f"{x}, {y}, 0, 0, 0, 0" for x, y in ((0.01, 0), (0, 0.01), (-0.01, 0))]
    arc = f"<CircleMove><children>{old(points[1])}{old(points[2])}</children></CircleMove>"
    program = read(tmp_path, move(old(points[0]) + arc, "MoveP"))
    assert [(m.kind, m.aux) for m in program.motions] == [
        ("LIN", False),
        ("CIRC", True),
        ("CIRC", False),
    ]
    path = program.path_arrays(10.0)["frames"][:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(path, axis=1), 10.0, atol=1e-9)
    lost = arc.replace(points[2], "0, 0, 0")
    for bad in (lost, arc.replace("<CircleMove", '<CircleMove orientationMode="Fixed"')):
        program = read(tmp_path, move(old(points[0]) + bad + old(NONE), "MoveP"))
        assert [m.pose is None for m in program.motions] == [False, True, False]
        assert len(program.problems) == 1


def test_loops_decisions_and_subprograms(tmp_path):
    line = [old(f"{k}, 0, 0, 0, 0, 0", name=f"W{k}") for k in range(9)]
    variable = '<variable name="i"><initializeExpression/></variable>'
    program = read(
        tmp_path,
        f'<Assignment valueSource="Expression">{variable}{expression("1 + 1")}</Assignment>'
        f'<Loop type="Counting" count="2"><children>{move(line[1])}</children></Loop>'
        f'<Folder name="f"><children>{move(line[2])}</children></Folder>'
        f'<If type="If">{expression("i == 3")}<children>{move(line[8])}</children></If>'
        f'<If type="ElseIf">{expression("i ≟ 2")}<children>{move(line[3])}</children></If>'
        f'<If type="Else"><expression/><children>{move(line[8])}</children></If>'
        f'<Loop type="While"><expression><ExpressionVariable>'
        f'<ProgramVariable reference="../../../../Assignment/variable"/></ExpressionVariable>'
        f'<ExpressionChar character="&gt;"/><ExpressionToken token=" 0"/></expression><children>'
        f'<Assignment>{variable}{expression("i - 1")}</Assignment>{move(line[4])}</children></Loop>'
        '<CallSubProgram><subprogram reference="../../../../SubProgram"/></CallSubProgram>'
        f"<Halt/>{move(line[8])}",
        tops=f'<SubProgram name="s"><children>{move(line[5])}<Comment comment="c"/></children></SubProgram>'
        f'<SpecialSequence type="BeforeStart"><children>{move(line[0])}</children></SpecialSequence>',
    )
    assert not program.problems
    assert [p[0] / 1000 for p in positions(program)] == [0, 1, 1, 2, 3, 4, 4, 5]


def test_scripts_are_followed(tmp_path):
    text = "def step(x):\n  movel(p[x,0,0,0,0,0], v=0.05)\nend\nstep(0.3)\nmovel(pose_trans(W_p, p[0,0,1,0,0,0]))"
    program = read(
        tmp_path,
        move(old("0.1, 0.2, 0, 0, 0, 0"))
        + f'<Script type="File"><cachedContents>{text}</cachedContents><file>/x.script</file></Script>\n'
        + f'<Script type="Line">{expression("step(0.4)")}</Script>\n'
        + f'<Script type="Line">{expression("movel(get_actual_tcp_pose())")}</Script>\n',
    )
    assert positions(program) == [[100, 200, 0], [300, 0, 0], [100, 200, 1000], [400, 0, 0]]
    assert (
        program.motions[1].speed_mm_s == 50
        and program.motions[3].line == program.motions[1].line + 5
    )
    assert len(program.problems) == 1 and "get_actual_tcp_pose" in str(program.problems[0])


def variable_waypoint(name="V"):
    return f'<Waypoint type="Variable" name="{name}"><motionParameters/><variable name="v"/></Waypoint>\n'


def assigned(text):
    return f'<Assignment><variable name="v"/>{expression(text)}</Assignment>\n'


def test_variable_waypoints_that_the_program_assigns(tmp_path):
    program = read(
        tmp_path,
        move(old("0.1, 0, 0, 0, 0, 0"))
        + assigned("p[0.3, 0.2, 0.1, 0, 0, 0]")
        + move(variable_waypoint())
        + assigned("pose_trans(v, p[0, 0, 0.05, 0, 0, 0])")
        + move(variable_waypoint()),
    )
    assert positions(program) == [[100, 0, 0], [300, 200, 100], [300, 200, 150]]
    assert not program.problems and len(program.path_arrays(50.0)["frames"]) == 3


@pytest.mark.parametrize(
    "text", ["get_actual_tcp_pose()", "[0, 1, 2, 3, 4, 5]", "5", "p[9e99, 0, 0, 0, 0, 0]"]
)
def test_variable_waypoints_without_a_pose_of_the_program_are_left_out(tmp_path, text):
    program = read(tmp_path, assigned(text) + move(variable_waypoint()) + move(old(NONE)))
    assert positions(program) == [[0, 0, 0]] and program.problems


def test_variable_waypoints_of_a_branch_at_run_time_or_of_another_feature_are_left_out(tmp_path):
    branch = f"<If type='If'>{expression('x')}<children>{assigned('p[9, 0, 0, 0, 0, 0]')}</children></If>"
    feature = '<feature class="GeomFeatureReference" referencedName="Plane_1"/>'
    first = assigned("p[0.3, 0, 0, 0, 0, 0]")
    program = read(tmp_path, first + branch + move(variable_waypoint()))
    assert positions(program) == []
    program = read(tmp_path, first + move(variable_waypoint(), feature=feature))
    assert positions(program) == [] and "Plane_1" in str(program.problems[0])


@pytest.mark.parametrize(
    "node, culprit",
    [
        (move('<Waypoint type="Variable" name="V"><variable name="x"/></Waypoint>'), "variable"),
        (move('<Waypoint type="Relative" name="R"/>'), "relative"),
        (move('<Waypoint type="Fixed" name="U"/>'), "not taught"),
        (move(old("1, 2, 3, 0, 0")), "not six numbers"),
        (move(old(NONE), "MoveX"), "MoveX"),
        (move(old(NONE), feature=BASE.replace("_0_", "_6_")), "feature is the tool"),
        (move(old(NONE), feature='<feature reference="../../Nowhere"/>'), "leads nowhere"),
        ('<Contributed strategyProgramNodeType="RG Grip"/>', "RG Grip"),
        ('<CallSubProgram><subprogram name="s"><children/></subprogram></CallSubProgram>', "own"),
        (f'<Loop type="Counting"><children>{move(old(NONE))}</children></Loop>', "how often"),
        (f"<If type='If'>{expression('x')}<children>{move(old(NONE))}</children></If>", "x has no"),
        (f"<Switch><Case><children>{move(old(NONE))}</children></Case></Switch>", "Switch"),
        ('<Script type="File"><cachedContents>while True\n</cachedContents></Script>', "no end"),
    ],
)
def test_what_is_not_known_is_said(tmp_path, node, culprit):
    before, after = move(old("0, 0, 1, 0, 0, 0")), move(old("0, 0, 2, 0, 0, 0"))
    program = read(tmp_path, before + node + after)
    assert culprit in " ".join(map(str, program.problems))
    arrays = program.path_arrays(50.0)
    assert len(arrays["frames"]) == 2
    assert arrays["rapid"][1] or "Script" in node  # the gap is not ground over


def test_an_endless_loop_is_followed_once(tmp_path):
    program = read(tmp_path, f'<Loop type="Forever"><children>{move(old(NONE))}</children></Loop>')
    assert len(positions(program)) == 1 and "followed once" in str(program.problems[0])


def test_damaged_numbers_are_never_silent(tmp_path):
    for bad in ("1.2.3", "12abc", "1e", "--3", "nan", "inf", "1e999", "1_0", "0x1F", "", "9" * 400):
        for point in (
            old(f"{bad}, 0, 0, 0, 0, 0"),
            waypoint(f"{bad}, 0, 0, 0, 0, 0"),
            waypoint(tcp=f"{bad}, 0, 0, 0, 0, 0"),
            waypoint(feature=f"{bad}, 0, 0, 0, 0, 0"),
            waypoint(arm={**UR5E, "a": f"{bad}, -0.425, -0.3922, 0.0, 0.0, 0.0"}),
        ):
            program = read(tmp_path, move(point))
            assert not positions(program) and program.problems, (bad, point)
    far = read(tmp_path, move(old("5000, 0, 0, 0, 0, 0")))
    assert not positions(far) and "no robot's" in str(far.problems[0])
    slow = read(tmp_path, move(old(NONE), more='speed="0.2.5"'))
    assert slow.motions[0].speed_mm_s is None and len(slow.problems) == 1


def test_files_cut_off_or_hostile_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "p.urp"
    whole = gzip.compress(document(move(old(NONE))).encode())
    for end in range(0, len(whole)):
        path.write_bytes(whole[:end])
        with pytest.raises(ProgramError, match="p.urp"):
            read_program(path)
    for bad in (whole + b"more", whole[:20] + b"\0\0" + whole[22:], b"PK\3\4 no gzip"):
        path.write_bytes(bad)
        with pytest.raises(ProgramError, match="p.urp"):
            read_program(path)
    path.write_bytes(whole + bytes(100))
    assert len(read_program(path).motions) == 1
    path.write_text(document(move(old(NONE))))  # as some tools write it
    assert len(read_program(path).motions) == 1
    for text, error in [
        ('<!DOCTYPE x [<!ENTITY a "b">]><URProgram/>', "DOCTYPE"),
        ("<Other/>", "no PolyScope program"),
        ("<URProgram/>", "no MainProgram"),
        ("<a>" * 300, "nested too deeply"),
    ]:
        path.write_bytes(gzip.compress(text.encode()))
        with pytest.raises(ProgramError, match=error):
            read_program(path)
    monkeypatch.setattr(xml_tree, "MAX_BYTES", 2**20)
    path.write_bytes(gzip.compress(b"<URProgram>" + b" " * 2**28))  # a bomb: 256 MB in 260 kB
    start = time.process_time()
    with pytest.raises(ProgramError, match="larger than 1 MB"):
        read_program(path)
    assert time.process_time() - start < 10.0


def test_nothing_hangs(tmp_path, monkeypatch):
    monkeypatch.setattr(flow, "MAX_UNROLLED", 20_000)
    loop = '<Loop type="Counting" count="999999"><children>{}</children></Loop>'
    with pytest.raises(ProgramError, match="too long"):
        read(tmp_path, loop.format(loop.format("<Comment/>")))
    call = '<CallSubProgram><subprogram reference="../../../../SubProgram"/></CallSubProgram>'
    inner = '<CallSubProgram><subprogram reference="../../.."/></CallSubProgram>'
    program = read(
        tmp_path, call, tops=f'<SubProgram name="s"><children>{inner}</children></SubProgram>'
    )
    assert "too deeply" in str(program.problems[0])
    self_reference = '<feature reference="../feature"/>'
    program = read(tmp_path, move(old(NONE), feature=self_reference))
    assert "leads nowhere" in str(program.problems[0])


def test_a_hundred_thousand_waypoints_take_seconds(tmp_path):
    one = waypoint("0.3, -1.2, 1.9, -0.4, 1.1, 0.2", "0, 0, 0.1, 0, 0, 0")
    main = move("".join(one.replace("0.3,", f"{k * 1e-5:.5f},") for k in range(100_000)))
    (tmp_path / "p.urp").write_bytes(gzip.compress(document(main).encode(), 1))
    start = time.process_time()
    program = read_program(tmp_path / "p.urp")
    seconds = time.process_time() - start
    assert len(positions(program)) == 100_000 and not program.problems
    assert seconds < 30.0, seconds


def test_mutated_programs_never_crash(tmp_path, monkeypatch):
    monkeypatch.setattr(flow, "MAX_UNROLLED", 2000)
    rng = np.random.default_rng(1)
    variable = '<variable name="i"/>'
    text = document(
        f'<Assignment>{variable}{expression("1")}</Assignment>'
        + move(waypoint("0.3, -1.2, 1.9, -0.4, 1.1, 0.2", feature="1, 0, 0, 0, 0, 1"), "MoveJ")
        + f'<Loop type="Counting" count="3"><children>{move(old("1, 2, 3, 0, 1, 0"))}</children></Loop>'
        + f'<If type="If">{expression("i==1")}<children>{move(waypoint())}</children></If>'
        + f'<Script type="Line">{expression("movel(W_p)")}</Script>'
        + move(f"<CircleMove><children>{old(NONE)}{old(NONE)}</children></CircleMove>", "MoveP")
        + '<CallSubProgram><subprogram reference="../../../../SubProgram"/></CallSubProgram>',
        tops=f'<SubProgram name="s"><children>{move(old(NONE))}</children></SubProgram>',
    ).encode()
    values = [m.start() for m in re.finditer(rb'(?<==")[^"]', text)]
    read_whole = 0
    for k in range(300):
        bad = bytearray(text)
        for _ in range(rng.integers(1, 6)):
            at = rng.integers(len(bad)) if k % 3 == 0 else values[rng.integers(len(values))]
            bad[at] = rng.integers(256) if k % 3 == 0 else rng.integers(35, 60)
        bad = bytes(bad if k % 5 else bad[: rng.integers(10, len(bad))])
        packed = bytearray(gzip.compress(bad) if k % 2 else bad)
        if k % 10 == 1:
            packed[rng.integers(len(packed))] = rng.integers(256)
        (tmp_path / "m.urp").write_bytes(packed)
        try:
            program = read_program(tmp_path / "m.urp")
            read_whole += 1
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.urp" in str(error)
    assert read_whole > 50  # the mutations reach beyond the XML
