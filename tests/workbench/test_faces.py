"""`beltgrind faces`: which face of a part is which, without FreeCAD."""

import io
import json
import math

import numpy as np
import pytest
from PIL import Image

from beltgrinding import cli
from beltgrinding.engine import core
from beltgrinding.inspection import faces
from support.freecad import SHARED


@pytest.fixture
def bush(freecad, tmp_path):
    """A BREP of a bush, 20 mm across and 30 mm long, with a bore of 8 mm, on a plate of 40 x 40 x 5 mm."""
    path = tmp_path / "bush.brep"
    freecad.run(
        f"""
import FreeCAD, Part
plate = Part.makeBox(40, 40, 5, FreeCAD.Vector(-20, -20, -5))
body = plate.fuse(Part.makeCylinder(10, 30)).cut(Part.makeCylinder(4, 60, FreeCAD.Vector(0, 0, -10)))
body.exportBrep({str(path)!r})
"""
    )
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
