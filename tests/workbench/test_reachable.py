"""Where the wheel gets to: all faces of the part may stand in its way."""

import json
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import Part
from PIL import Image

from beltgrinding import cli
from beltgrinding.engine import core
from beltgrinding.job import load, workpiece
from beltgrinding.raster import drawing, raster_path, reachable
from beltgrinding.raster.clearing import Clearing
from support.freecad import SHARED


@pytest.fixture
def parts(freecad, tmp_path):
    """BREP files: a plate of 80 x 60 mm with a wall of 30 mm on its edge; a bore of 30 mm in a block."""
    freecad.call(make_parts, tmp_path)
    return tmp_path


def job_of(path, radius=20.0, width=10.0, faces=()):
    return load.validate(
        {
            "schema": 1,
            "design": {"file": str(path), "faces": list(faces)},
            "belt_machine": {"wheel": {"radius_mm": radius, "width_mm": width}, "force_N": 20},
            "programs": [{"poses": []}],
        }
    )


def face_with(shape, area=None, kind=None):
    for k in range(shape.face_count):
        if (area is None or abs(shape.face_area(k) - area) < 1.0) and kind in (
            None,
            shape.surface_type(k),
        ):
            return k
    raise AssertionError("no such face")


def reach(job, shape, face):
    """(points, normals (n, 3), fits (n,) in any direction without a lean, share of the area) of a face from 0."""
    settings = raster_path.validate({"where_it_collides": "leave_out"})
    field, _ = core.sample_faces(shape, [face], 1.5)
    points, normals = field.points, field.normals.astype(float)
    fits = reachable.in_any_direction(Clearing(job, shape, settings, [], None), points, normals)
    return points, normals, fits, field.areas[fits].sum() / field.areas.sum()


def test_a_wall_beside_the_face_keeps_the_wheel_away(parts):
    job = job_of(parts / "wall.brep")
    shape = workpiece.read_design(job["design"])
    floor = face_with(shape, 80 * 60)
    points, _, fits, share = reach(job, shape, floor)
    away = 60.0 - points[:, 1]
    # With its axis across the wall half the width fits beside it, the other way round 0.5 mm deep of R 20.
    assert fits[away > 6.5].all() and not fits[away < 3.5].any()
    assert share == pytest.approx(1.0 - 5.0 / 60.0, abs=0.03)


def test_a_bore_takes_a_wheel_that_is_smaller_than_it(parts):
    for radius, share in ((25.0, 0.0), (12.0, 1.0)):
        job = job_of(parts / "bore.brep", radius=radius)
        shape = workpiece.read_design(job["design"])
        bore = face_with(shape, kind="cylinder")
        assert reach(job, shape, bore)[3] == pytest.approx(share, abs=0.02)


def test_what_stands_over_the_axis_is_in_the_way_too(freecad, tmp_path):
    freecad.call(make_lids, tmp_path)
    for height, share in ((30, 0.0), (45, 0.97)):
        job = job_of(tmp_path / f"lid{height}.brep")
        shape = workpiece.read_design(job["design"])
        floor = next(
            face
            for face in range(shape.face_count)
            if abs(shape.face_area(face) - 118 * 100) < 1.0
            and reach(job, shape, face)[1][0][2] > 0.9
        )
        assert reach(job, shape, floor)[3] == pytest.approx(share, abs=0.03)


def test_a_raster_tells_it(parts):
    shape = workpiece.read_design(job_of(parts / "wall.brep")["design"])
    floor = face_with(shape, 80 * 60) + 1
    job = job_of(parts / "wall.brep", faces=[floor])
    laid = raster_path.raster(job, {"along": "direction", "direction": [1, 0, 0]})
    (told,) = [fact for fact in laid["warnings"] if fact.code == "raster.not_reachable_leaned"]
    assert f"Face{floor}" in told and laid["reachable"]["share"] < 0.98
    assert raster_path.summary(laid)["reachable"]["faces"] == laid["reachable"]["faces"]
    top = [k + 1 for k in range(shape.face_count) if abs(shape.face_area(k) - 80 * 10) < 1.0]
    free = raster_path.raster(job_of(parts / "wall.brep", faces=top[:1]), {"along": "u"})
    assert free["reachable"] == {"share": 1.0, "faces": {}, "left_out": 0.0, "no_pass": 0.0}
    assert not [fact for fact in free["warnings"] if fact.code.startswith("raster.not_reach")]


@pytest.mark.slow
def test_the_picture_shows_passes_and_what_is_left_out(parts, tmp_path, capsys):
    shape = workpiece.read_design(job_of(parts / "wall.brep")["design"])
    floor = face_with(shape, 80 * 60) + 1
    job = {
        "design": {"file": str(parts / "wall.brep"), "faces": [floor]},
        "belt_machine": {"wheel": {"radius_mm": 20, "width_mm": 10}, "force_N": 20},
    }
    (tmp_path / "job.json").write_text(json.dumps(job))
    file, program = tmp_path / "seen.png", tmp_path / "path.src"
    command = ["raster", str(tmp_path / "job.json"), "-o", str(program), "--picture", str(file)]
    along = ["--set", "along=direction"]
    assert cli.main([*command, *along]) == 0, capsys.readouterr().err
    told = json.loads(capsys.readouterr().out)["reachable"]
    pixels = np.asarray(Image.open(file).convert("RGB")).astype(int)
    red, green, blue = np.moveaxis(pixels, 2, 0)
    magenta = (red > 1.6 * green + 30) & (blue > 1.4 * green + 20)
    floor_like = (abs(red - green) < 30) & (blue > red + 4) & (red > 120)
    # Both lie in one plane: their areas in the picture are as on the part, but for the passes' lines.
    share = magenta.sum() / (magenta.sum() + floor_like.sum())
    assert 0.5 * told["left_out"] < share < 2.0 * told["left_out"] and told["left_out"] > 0.01
    assert (pixels == np.array(drawing.PASS)).all(axis=2).sum() > 500
    then = ["--then", str(tmp_path / "job.json"), str(tmp_path / "b.src")]
    assert cli.main([*command, *then, *along]) == 2 and not (tmp_path / "b.src").exists()
    before = program.read_bytes()
    assert cli.main([*command, *along]) == 0 and program.read_bytes() == before  # its own files
    for own, foreign in ((program, b"DEF path( )\nEND\n"), (file, b"\x89PNG of another")):
        kept = own.read_bytes()
        own.write_bytes(foreign)
        assert cli.main([*command, *along]) == 2 and own.read_bytes() == foreign
        assert "this program has not written it" in capsys.readouterr().err
        own.write_bytes(kept)


@pytest.mark.slow
def test_a_strip_along_a_border_gets_its_passes():
    """A concave fillet of the crank: the wheel gets to strips along its borders only, narrower than a pass."""
    file = SHARED / "data" / "cad" / "crank_arm.brep"
    if not file.is_file():
        pytest.skip(f"no data at {file}")
    job = load.validate(
        {
            "design": {"file": str(file), "faces": [13]},
            "belt_machine": {
                "wheel": {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60},
                "force_N": 30,
            },
            "programs": [{"poses": []}],
        }
    )
    laid = raster_path.raster(job, {})
    seen = laid["places"]
    reached = seen["areas"][seen["fits"]].sum()
    ground = seen["areas"][seen["fits"] & (seen["state"] == reachable.GROUND)].sum()
    assert ground > 0.8 * reached, (ground, reached)


def make_parts(tmp_path):
    folder = Path(str(tmp_path))
    V = FreeCAD.Vector
    Part.makeBox(80, 60, 10).fuse(
        Part.makeBox(80, 10, 40, V(0, 60, 0))
    ).removeSplitter().exportBrep(str(folder / "wall.brep"))
    Part.makeBox(60, 60, 80, V(-30, -30, 0)).cut(Part.makeCylinder(15, 80)).exportBrep(
        str(folder / "bore.brep")
    )


def make_lids(tmp_path):
    V = FreeCAD.Vector
    for height in (30, 45):
        floor, lid = Part.makeBox(120, 100, 5, V(0, 0, -5)), Part.makeBox(
            120, 100, 5, V(0, 0, height)
        )
        post = Part.makeBox(2, 100, height, V(118, 0, 0))
        floor.fuse(lid).fuse(post).removeSplitter().exportBrep(
            str(Path(str(tmp_path)) / f"lid{height}.brep")
        )
