"""`beltgrind faces`: which face of a part is which, without FreeCAD."""

import io
import json
import math

import numpy as np
import pytest
import FreeCAD
import Part
from PIL import Image

from beltgrinding import cli
from beltgrinding.engine import core
from beltgrinding.inspection import faces
from support.freecad import SHARED


@pytest.fixture
def bush(freecad, tmp_path):
    """A BREP of a bush, 20 mm across and 30 mm long, with a bore of 8 mm, on a plate of 40 x 40 x 5 mm."""
    path = tmp_path / "bush.brep"
    freecad.call(make_bush, path)
    return path


def told(capsys, *arguments):
    status = cli.main([str(one) for one in arguments])
    out = capsys.readouterr()
    return status, out.out, out.err


def test_a_part_is_told_face_by_face(bush, capsys):
    status, out, err = told(capsys, "faces", bush, "--json")
    assert status == 0 and err == ""
    found = json.loads(out)
    assert [one["face"] for one in found] == list(range(1, len(found) + 1))
    assert all(one["bounds_solid"] for one in found)
    outer = [one for one in found if one["convex_radius_mm"] == pytest.approx(10.0, rel=0.01)]
    bore = [one for one in found if one["concave_radius_mm"] == pytest.approx(4.0, rel=0.01)]
    assert len(outer) == len(bore) == 1
    assert outer[0]["type"] == bore[0]["type"] == "cylinder"
    assert outer[0]["concave_radius_mm"] is bore[0]["convex_radius_mm"] is None
    assert outer[0]["area_mm2"] == pytest.approx(2 * math.pi * 10 * 30, rel=1e-4)
    x, y, z = outer[0]["centre_mm"]
    assert math.hypot(x, y) == pytest.approx(10.0, abs=1e-3) and 10 < z < 20
    assert np.dot(outer[0]["normal"], [x, y, 0]) == pytest.approx(10.0, abs=0.01)
    sides = [one for one in found if one["area_mm2"] == pytest.approx(200.0)]
    assert len(sides) == 4 and all(one["convex_radius_mm"] is None for one in sides)
    bottom = next(one for one in found if one["normal"] == [0.0, 0.0, -1.0])
    assert set(bottom["neighbours"]) == {one["face"] for one in sides} | {bore[0]["face"]}
    for one in found:
        assert one["face"] not in one["neighbours"]
        assert all(one["face"] in found[k - 1]["neighbours"] for k in one["neighbours"])


@pytest.mark.slow
def test_the_table_and_the_picture_name_the_faces(bush, tmp_path, capsys):
    path = tmp_path / "faces.png"
    status, out, err = told(capsys, "faces", bush, "--picture", path)
    assert status == 0 and err == ""
    lines = out.splitlines()
    assert lines[0].split()[:2] == ["face", "type"] and len(lines) >= 9
    image = Image.open(io.BytesIO(path.read_bytes()))
    assert image.width > 1500 and len(set(image.resize((300, 100)).getdata())) > 20
    status, out, err = told(capsys, "faces", bush, "--picture", bush)
    assert status == 2 and "would write over it" in err
    assert told(capsys, "faces", bush, "--unit", "0")[0] == 2
    assert told(capsys, "faces", tmp_path / "none.step")[0] == 2
    scaled = json.loads(told(capsys, "faces", bush, "--unit", "10", "--json")[1])
    assert max(one["area_mm2"] for one in scaled) > 1e5


def test_a_job_s_part_and_loose_faces(bush, tmp_path, capsys):
    shape = core.Shape.read(str(bush))
    job = {"schema": 1, "design": {"file": "bush.brep"}, "programs": []}
    (tmp_path / "job.json").write_text(json.dumps(job))
    status, out, _ = told(capsys, "faces", tmp_path / "job.json", "--json")
    assert status == 0 and len(json.loads(out)) == shape.face_count


@pytest.mark.slow
def test_every_face_of_real_parts_has_a_row():
    if not SHARED.is_dir():
        pytest.skip("shared data absent (set BELTGRINDING_SHARED)")
    for name in ("cad/pump_cover.brep", "cad/hammer_claw.brep", "cad_nasty/nut_tiny_faces.brep"):
        shape = core.Shape.read(str(SHARED / "data" / name))
        found = faces.faces_of(shape)
        assert (
            len(found)
            == shape.face_count
            == len(faces.text(found).splitlines()[1:]) - (0 if found[0].solid else 1)
        )
        assert all(one.neighbours for one in found)
        png, missing = faces.draw(shape)
        assert png.startswith(b"\x89PNG") and len(missing) < shape.face_count


@pytest.fixture(scope="module")
def shapes(freecad, tmp_path_factory):
    """BREP files of parts whose faces' middles are known by hand."""
    folder = tmp_path_factory.mktemp("middles")
    freecad.call(make_shapes, folder)
    return folder


def middles(path):
    return faces.faces_of(core.Shape.read(str(path)))


def one_of(found, kind, normal=None):
    (face,) = [
        one
        for one in found
        if one.kind == kind and (normal is None or np.allclose(one.normal, normal, atol=1e-6))
    ]
    return face


def test_a_face_has_its_middle_to_a_micrometre(shapes):
    box = middles(shapes / "box.brep")
    for normal in np.concatenate([np.eye(3), -np.eye(3)]):
        right = np.array([115.5, -11.5, 6.5]) + normal * [15.5, 8.5, 3.5]
        face = one_of(box, "plane", normal)
        np.testing.assert_allclose(face.centre, right, atol=1e-6)
        np.testing.assert_allclose(face.centroid, right, atol=1e-6)
    face = one_of(middles(shapes / "triangle.brep"), "plane")
    np.testing.assert_allclose(face.centre, [3, 2, 2], atol=1e-6)


@pytest.mark.parametrize("name, half", [("half", math.pi / 2), ("quarter", math.pi / 4)])
def test_the_middle_of_a_part_of_a_cylinder_lies_on_it(shapes, name, half):
    face = one_of(middles(shapes / f"{name}.brep"), "cylinder")
    along = np.array([math.cos(half), math.sin(half), 0])
    np.testing.assert_allclose(face.centre, 10 * along + [0, 0, 15], atol=1e-6)
    np.testing.assert_allclose(face.normal, along, atol=1e-6)
    np.testing.assert_allclose(
        face.centroid, 10 * math.sin(half) / half * along + [0, 0, 15], atol=1e-6
    )
    top = one_of(middles(shapes / f"{name}.brep"), "plane", [0, 0, 1])
    off = 2 / 3 * 10 * math.sin(half) / half
    np.testing.assert_allclose(top.centre, off * along + [0, 0, 30], atol=1e-6)


def test_a_whole_cylinder_has_its_middle_at_half_its_height(shapes):
    face = one_of(middles(shapes / "cylinder.brep"), "cylinder")
    np.testing.assert_allclose(face.centroid, [5, 6, 22], atol=1e-6)
    off = np.subtract(face.centre, [5, 6, 22])
    assert np.linalg.norm(off) == pytest.approx(10.0, abs=1e-6) and off[2] == pytest.approx(
        0, abs=1e-6
    )
    np.testing.assert_allclose(face.normal, off / 10, atol=1e-6)


def test_cones_and_domes(shapes):
    face = one_of(middles(shapes / "cone.brep"), "cone")
    # Of a frustum's side: height h (R + 2 r) / (3 (R + r)); of half of it 2 / pi of the mean radius there, off the axis.
    height = 12 * (10 + 2 * 4) / (3 * (10 + 4))
    radius = 2 / math.pi * 2 / 3 * (10**2 + 10 * 4 + 4**2) / (10 + 4)
    np.testing.assert_allclose(face.centroid, [0, radius, height], atol=1e-6)
    lean = np.array([0, 12, 6]) / math.hypot(12, 6)
    np.testing.assert_allclose(face.normal, lean, atol=1e-6)
    foot = face.centroid + lean * np.dot(np.array([0, 10, 0]) - face.centroid, lean)
    np.testing.assert_allclose(face.centre, foot, atol=1e-6)
    face = one_of(middles(shapes / "dome.brep"), "sphere")
    np.testing.assert_allclose(face.centroid, [0, 0, 4], atol=1e-6)
    assert np.linalg.norm(face.centre) == pytest.approx(8.0, abs=1e-6)


def test_the_middle_of_a_ring_lies_on_it(shapes):
    face = one_of(middles(shapes / "ring.brep"), "plane", [0, 0, 1])
    np.testing.assert_allclose(face.centroid, [0, 0, 2], atol=1e-6)
    x, y, z = face.centre
    assert z == 2 and 6.1 < math.hypot(x, y) < 9.9


def make_bush(path):
    plate = Part.makeBox(40, 40, 5, FreeCAD.Vector(-20, -20, -5))
    body = plate.fuse(Part.makeCylinder(10, 30)).cut(
        Part.makeCylinder(4, 60, FreeCAD.Vector(0, 0, -10))
    )
    body.exportBrep(str(path))


def make_shapes(folder):
    V = FreeCAD.Vector
    folder = str(folder)
    Part.makeBox(31, 17, 7, V(100, -20, 3)).exportBrep(folder + "/box.brep")
    Part.makeCylinder(10, 30, V(5, 6, 7)).exportBrep(folder + "/cylinder.brep")
    Part.makeCylinder(10, 30, V(0, 0, 0), V(0, 0, 1), 180).exportBrep(folder + "/half.brep")
    Part.makeCylinder(10, 30, V(0, 0, 0), V(0, 0, 1), 90).exportBrep(folder + "/quarter.brep")
    Part.makeCone(10, 4, 12, V(0, 0, 0), V(0, 0, 1), 180).exportBrep(folder + "/cone.brep")
    Part.makeSphere(8, V(0, 0, 0), V(0, 0, 1), 0, 90, 360).exportBrep(folder + "/dome.brep")
    Part.makePolygon([V(0, 0, 0), V(9, 0, 0), V(0, 6, 0), V(0, 0, 0)])
    Part.Face(Part.makePolygon([V(0, 0, 2), V(9, 0, 2), V(0, 6, 2), V(0, 0, 2)])).exportBrep(
        folder + "/triangle.brep"
    )
    Part.makeCylinder(10, 2).cut(Part.makeCylinder(6, 2)).exportBrep(folder + "/ring.brep")
