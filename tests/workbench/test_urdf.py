"""Robots of a URDF: the tests write the file and its meshes themselves."""

import json
import math
import struct

import numpy as np
import pytest
import PyKDL

from beltgrinding.base import frames
from beltgrinding.cell import collision
from beltgrinding.engine import InputError
from beltgrinding.job import inputs, load as jobs
from beltgrinding.presets import library, robot as robots, urdf_shapes

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TALL = CORNERS * [1, 2, 3]
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])  # of a tetrahedron, outside out


def stl(points):
    rows = [struct.pack("<12fH", *[0] * 3, *points[face].ravel(), 0) for face in FACES]
    return bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def obj(points):
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    return "\n".join([*lines, *(f"f {a+1} {b+1} {c+1}" for a, b, c in FACES)]).encode() + b"\n"


def dae(points, unit=1.0, up="Z_UP"):
    values = " ".join(str(v) for v in points.ravel())
    order = " ".join(str(v) for v in FACES.ravel())
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{unit}"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">{values}</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{order}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


def links_of(preset="kuka_kr6_r900"):
    return library.find("robots", preset)["model"]


def joint(name, parent, child, origin="0 0 0", rpy="0 0 0", kind="revolute", rest=""):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{origin}" rpy="{rpy}"/>{rest}</joint>'
    )


def body(shape, kind="collision", origin=""):
    return f"<{kind}>{origin}<geometry>{shape}</geometry></{kind}>"


def urdf(bodies=None, more="", kinds=None, rests=None, model=None):
    """The preset's arm as a URDF: link_0 (base_link) to link_6, and tool0 on its flange."""
    model, bodies = model or links_of(), bodies or {}
    names = ["base_link", *(f"link_{k}" for k in range(1, 7))]
    text = [f'<link name="{name}">{bodies.get(k, "")}</link>' for k, name in enumerate(names)]
    for k, one in enumerate(model["joints"]):
        x, y, z = (f"{v / 1000:.10g}" for v in one["origin_mm"])
        limits = " ".join(
            f'{key}="{math.radians(one[name]):.12g}"'
            for key, name in (("lower", "lower_deg"), ("upper", "upper_deg"), ("velocity", "max_speed_deg_s"))
        )  # fmt: skip
        axis = " ".join(str(v) for v in one["axis"])
        rest = f'<axis xyz="{axis}"/><limit effort="1" {limits}/>' + (rests or {}).get(k, "")
        turn = " ".join(str(round(math.radians(v), 4)) for v in one["rpy_deg"])
        kind = (kinds or {}).get(k, "revolute")
        text.append(joint(f"a{k + 1}", names[k], names[k + 1], f"{x} {y} {z}", turn, kind, rest))
    flange = frames.from_data(model.get("joint6_from_flange"))
    yaw, pitch, roll = np.radians(frames.to_abc(flange))
    x, y, z = flange[:3, 3] / 1000
    text.append('<link name="tool0"/>')
    text.append(joint("fl", "link_6", "tool0", f"{x} {y} {z}", f"{roll:.4f} {pitch:.4f} {yaw:.4f}", "fixed"))  # fmt: skip
    return f'<robot name="r">{"".join(text)}{more}</robot>'


def robot(folder, text, packages=(), **model):
    (folder / "arm.urdf").write_text(text)
    given = {"urdf": str(folder / "arm.urdf"), **model}
    return robots.checked({"model": given, "packages": list(map(str, packages))})


def kdl(model):
    """KDL's chain of a model's joints, by itself."""
    made = PyKDL.Chain()
    for one in model["joints"]:
        roll, pitch, yaw = np.radians(one["rpy_deg"])
        turn = PyKDL.Rotation.RPY(roll, pitch, yaw)
        at = PyKDL.Frame(turn, PyKDL.Vector(*one["origin_mm"]))
        axis = at.M * PyKDL.Vector(*one["axis"])
        made.addSegment(PyKDL.Segment(PyKDL.Joint("", at.p, axis, PyKDL.Joint.RotAxis), at))
    return made


@pytest.mark.parametrize("preset", ["kuka_kr6_r900", "abb_irb1200_5_90", "kuka_kr210_r2700_extra"])
def test_an_arm_by_its_urdf_is_the_arm_by_its_joints(preset, tmp_path):
    model = links_of(preset)
    found = robot(tmp_path, urdf(model=model))
    assert robots.given(found) and robots.name(found) == "arm"
    arm, own = robots.arm_of(found), robots.arm_of(robots.checked({"preset": preset}))
    # Angles of four digits, as files have them, are the quarter turns that they stand for.
    assert arm.structure == "spherical_wrist"
    assert arm.lower == pytest.approx(own.lower) and arm.max_speed == pytest.approx(own.max_speed)
    random = np.random.default_rng(3)
    for q in random.uniform(own.lower, own.upper, (50, 6)):
        assert arm.forward(q) == pytest.approx(own.forward(q), abs=1e-6)
        by_kdl, at = PyKDL.Frame(), PyKDL.JntArray(6)
        for k in range(6):
            at[k] = q[k]
        of = kdl(robots.model_of(found))
        PyKDL.ChainFkSolverPos_recursive(of).JntToCart(at, by_kdl)
        flange = frames.from_data(robots.model_of(found)["joint6_from_flange"])
        turn = np.array([[by_kdl.M[i, k] for k in range(3)] for i in range(3)])
        assert turn @ flange[:3, 3] + list(by_kdl.p) == pytest.approx(arm.forward(q)[:3, 3], abs=1e-6)  # fmt: skip
        assert len(arm.inverse(arm.forward(q), q)) >= 1


@pytest.mark.parametrize("up", ["Y_UP", "Z_UP"])
def test_meshes_of_all_kinds_are_bodies_where_they_lie(up, tmp_path):
    package = tmp_path / "ros" / "arm_support"
    (package / "meshes").mkdir(parents=True)
    (package / "meshes" / "one.STL").write_bytes(stl(100 * CORNERS))  # mm
    (package / "meshes" / "two.dae").write_bytes(dae(10 * TALL, unit=0.01, up=up))  # cm
    (tmp_path / "three.obj").write_bytes(obj(0.1 * CORNERS))  # m
    shift = '<origin xyz="0.5 0 0" rpy="0 0 1.5708"/>'
    mesh = '<mesh filename="{}"{}/>'.format
    of = {
        0: body(mesh("package://arm_support/meshes/one.STL", ' scale="0.001 0.001 0.001"')),
        2: body(mesh("package://arm_support/meshes/two.dae", ""), origin=shift),
        3: body(mesh("three.obj", ' scale="1 -1 1"')),
        4: body('<box size="0.1 0.2 0.3"/>') + body('<sphere radius="0.05"/>'),
        6: body('<cylinder radius="0.05" length="0.2"/>') + body('<box size="1 1 1"/>', "visual"),
    }
    gripper = '<link name="finger">' + body('<box size="0.01 0.01 0.01"/>') + "</link>"
    gripper += joint("grip", "tool0", "finger", "0 0 0.1", kind="prismatic", rest='<mimic joint="a1"/>')  # fmt: skip
    found = robot(tmp_path, urdf(of, gripper), [tmp_path / "ros"])
    links = [one for one, _ in robots.links_of(found)]
    placed = robots.arm_of(found).placed(np.zeros(6))[1]
    at = np.array([frame["origin_mm"] for frame in links_of()["joints"]]).cumsum(axis=0)
    assert at == pytest.approx(placed)  # of this arm all frames are parallel at zero
    sizes = [np.ptp(points, axis=0) if len(points) else None for points, _ in links]
    assert links[0][0].max(axis=0) == pytest.approx([100, 100, 100], abs=1e-3)
    # Turned by a quarter about z, 500 mm along x, on the second joint; not turned up.
    low, high = links[2][0].min(axis=0) - at[1], links[2][0].max(axis=0) - at[1]
    assert low == pytest.approx([300, 0, 0], abs=1e-2)
    assert high == pytest.approx([500, 100, 300], abs=1e-2)
    assert links[3][0].min(axis=0) - at[2] == pytest.approx([0, -100, 0], abs=1e-3)  # mirrored
    assert sizes[4] == pytest.approx([100, 200, 300]) and sizes[1] is None and sizes[5] is None
    assert len(links[6][0]) == 2 * 24 + 2 + 8  # the finger goes with the flange
    for points, faces in links:
        if len(faces):
            a, b, c = (points[faces[:, k]] for k in range(3))
            assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0  # outside is outside
    shown = robots.links_of(found, urdf_shapes.VISUAL)[6][0][0]
    assert np.ptp(shown, axis=0) == pytest.approx([1000, 1000, 1000])
    assert [one["link"] for one in collision.arm_bodies(found)] == [0, 2, 3, 4, 6]
    tubes = robots.links_of({**found, "link_radii_mm": [50.0] * 7})
    assert all(len(one[0][0]) for one in tubes[:1]) and len(tubes[1][0][0])
    # A result can be traced to them.
    names = {path.name for path in urdf_shapes.files(found["model"], found["packages"])}
    assert names == {"arm.urdf", "one.STL", "two.dae", "three.obj"}


def test_without_bodies_the_arm_is_estimated_as_any_other(tmp_path):
    found = robots.links_of(robot(tmp_path, urdf()))
    own = robots.links_of(robots.checked({"preset": "kuka_kr6_r900"}))
    assert [len(tube[0]) for tube, _ in found] == [len(tube[0]) for tube, _ in own]


def test_a_job_names_its_urdf_relative_to_itself(tmp_path):
    (tmp_path / "arm.urdf").write_text(urdf({1: body('<mesh filename="m.stl"/>')}))
    (tmp_path / "m.stl").write_bytes(stl(CORNERS))
    (tmp_path / "p.csv").write_text("x_mm,y_mm,z_mm\n0,0,0\n")
    job = {
        "design": {"file": "part.step"},
        "robot": {"model": {"urdf": "arm.urdf"}, "packages": ["ros"]},
        "programs": [{"file": "p.csv"}],
    }
    (tmp_path / "job.json").write_text(json.dumps(job))
    read = jobs.load(tmp_path / "job.json")
    assert read["robot"]["model"]["urdf"] == str(tmp_path / "arm.urdf")
    assert read["robot"]["packages"] == [str(tmp_path / "ros")]
    listed = {path.name for path in inputs.files(read)}
    assert {"arm.urdf", "m.stl"} <= listed


def with_track(text):
    more = '<link name="world"/>' + joint("track", "world", "base_link", kind="prismatic")
    return text.replace("</robot>", more + "</robot>")


def test_a_base_and_a_flange_can_be_chosen(tmp_path):
    found = robot(tmp_path, with_track(urdf()))
    assert robots.arm_of(found).structure == "spherical_wrist"  # from base_link on
    to = robots.arm_of(robot(tmp_path, urdf(), tip_link="link_6"))
    assert (
        np.abs(to.forward(np.zeros(6)) - robots.arm_of(found).forward(np.zeros(6))).max() > 0.5
    )  # turned
    with pytest.raises(InputError, match="track of the arm is of the type 'prismatic'"):
        robot(tmp_path, with_track(urdf()), base_link="world")


TWICE = urdf(more=joint("again", "link_2", "link_5", kind="fixed"))
CIRCLE = urdf(more='<link name="x"/><link name="y"/>' + joint("j1", "x", "y", kind="fixed") + joint("j2", "y", "x", kind="fixed"))  # fmt: skip
SEVENTH = urdf(
    more='<link name="x"/>'
    + joint("a7", "tool0", "x", rest='<limit lower="-1" upper="1" velocity="1"/>')
)


@pytest.mark.parametrize(
    "text, keys, message",
    [
        (TWICE, {}, "link link_5 hangs on two joints, a5 and again: a loop"),
        (CIRCLE, {}, "link x carries itself: a loop"),
        (urdf(rests={3: '<mimic joint="a2"/>'}), {}, "joint a4 of the arm mimics another"),
        (urdf(kinds={2: "prismatic"}), {}, "joint a3 of the arm is of the type 'prismatic'"),
        (urdf(kinds={2: "fixed"}), {}, "5 joints turn between base_link and tool0; only arms of six"),
        (SEVENTH, {"tip_link": "x"}, "7 joints turn between base_link and x; only arms of six"),
        (urdf({1: body('<mesh filename="no.stl"/>')}), {}, "link link_1: there is no mesh 'no.stl'"),
        (urdf({1: body('<mesh filename="package://kr/a.stl"/>')}), {}, "the package 'kr' among robot.packages"),
        (urdf({1: body('<mesh filename="a.fbx"/>')}), {}, "'a.fbx' is no STL, DAE, OBJ or PLY"),
        (urdf(), {"tip_link": "flansch"}, "robot.model.tip_link: there is no link 'flansch'"),
        (urdf(), {"base_link": "link_6", "tip_link": "link_2"}, "link_6 does not carry link link_2"),
        (urdf().replace('lower="', 'lower="x'), {}, "a1: 'x.*' is not a number"),
        (urdf().replace('xyz="0 0 ', 'xyz="0 ', 1), {}, "a1: '0 0.4' is not three numbers"),
        (urdf().replace("link_6", "link_7", 1), {}, "joint a6: its child 'link_6' is no link"),
        (urdf(more='<link name="lost"/>'), {}, "hang on nothing"),
        ("<robot", {}, "cannot be read as XML"),
        ("<sdf/>", {}, "is no URDF: its outermost element is 'sdf'"),
        ('<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arm/></robot>', {}, "expand it: xacro"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot/>', {}, "entities"),
        ("<robot/>", {}, "has no link"),
    ],
    ids=lambda one: one if isinstance(one, str) and "<" not in one else "",
)  # fmt: skip
def test_what_is_no_arm_gets_one_line(text, keys, message, tmp_path):
    with pytest.raises(InputError, match=message) as caught:
        robot(tmp_path, text, **keys)
    assert "arm.urdf" in str(caught.value) and "\n" not in str(caught.value)


def test_a_damaged_mesh_is_named_with_its_link(tmp_path):
    (tmp_path / "m.stl").write_bytes(b"nothing")
    found = robot(tmp_path, urdf({1: body('<mesh filename="m.stl"/>')}))
    with pytest.raises(InputError, match="arm.urdf: link link_1: .*m.stl"):
        robots.links_of(found)


def test_a_urdf_beside_other_joints_is_refused(tmp_path):
    with pytest.raises(InputError, match="give a preset or a model"):
        (tmp_path / "arm.urdf").write_text(urdf())
        robots.checked({"preset": "ur10e", "model": {"urdf": str(tmp_path / "arm.urdf")}})
