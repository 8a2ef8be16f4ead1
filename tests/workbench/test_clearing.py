"""Where the wheel would stand in the part it leans, or its pass is left out."""

import math

import numpy as np
import pytest
import FreeCAD
import Part

from beltgrinding.engine import InputError, core
from beltgrinding.job import load, workpiece
from beltgrinding.job.typed import typed
from beltgrinding.raster import filling, raster_path, reachable

RADIUS, WIDTH = 20.0, 10.0
X = {"along": "direction", "direction": [1, 0, 0], "step_over_mm": 3.0, "spacing": "lines"}


@pytest.fixture(scope="module")
def parts(freecad, tmp_path_factory):
    """BREP files: a floor of 80 x 60 mm with a wall of 30 mm beyond y = 60, and one with a post of 6 mm radius, 30 mm
    high, in its middle."""
    folder = tmp_path_factory.mktemp("parts")
    freecad.call(make_parts, folder)
    return folder


def job_of(path, faces=(), **parts):
    data = {
        "schema": 1,
        "design": {"file": str(path), "faces": list(faces)},
        "belt_machine": {"wheel": {"radius_mm": RADIUS, "width_mm": WIDTH}, "force_N": 20},
        "programs": [{"poses": []}],
    }
    return load.validate({**data, **parts})


def floor_of(path):
    """Number of the face that looks up at z = 0."""
    shape = workpiece.read_design(job_of(path)["design"])
    for k in range(shape.face_count):
        field, _ = core.sample_faces(shape, [k], 5.0)
        if field.normals[0][2] > 0.99 and abs(field.points[0][2]) < 1e-6:
            return k + 1
    raise AssertionError("no floor")


def edges(contacts):
    """(n, 2, 3): the rim's lowest points at both ends of its width."""
    y, origin = contacts[:, :3, 1], contacts[:, :3, 3]
    return np.stack([origin - 0.5 * WIDTH * y, origin + 0.5 * WIDTH * y], axis=1)


def on_passes(laid):
    return laid["contacts"][laid["contact"]]


@pytest.fixture(scope="module")
def wall(parts):
    path = parts / "wall.brep"
    return job_of(path, [floor_of(path)])


@pytest.mark.slow
def test_beside_a_wall_passes_are_left_out(wall):
    laid = raster_path.raster(wall, {**X, "where_it_collides": "leave_out"})
    contacts = on_passes(laid)
    assert contacts[:, 2, 2] == pytest.approx(-np.ones(len(contacts)))  # upright
    # Half the width keeps the passes 5 mm from the wall, but for half a millimetre.
    ends = edges(contacts)
    assert ends[:, :, 1].max() <= 60.5 + 1e-6
    warn = on_passes(raster_path.raster(wall, {**X, "where_it_collides": "warn"}))
    assert edges(warn)[:, :, 1].max() > 63.0
    assert laid["fit"].max() <= 0.5


@pytest.mark.slow
def test_beside_a_wall_the_wheel_cannot_lean_out_of_it(wall):
    """Leaning it away from the wall lifts the rim's other edge; the wheel's side is what meets the wall."""
    laid = raster_path.raster(wall, X)
    leaned = on_passes(laid)[:, 2, 2] > -0.9999
    ends = edges(on_passes(laid))
    assert laid["fit"].max() <= 0.5
    # Those that lean stand on their edge next to the wall, which so gets nearer to it.
    assert leaned.any() and ends[leaned][:, :, 1].max() <= 60.5 + 1e-6
    upright = raster_path.raster(wall, {**X, "where_it_collides": "leave_out"})
    assert len(laid["passes"]) > len(upright["passes"])
    tilt = np.degrees(np.arccos(np.clip(-on_passes(laid)[:, 2, 2], -1, 1)))
    assert tilt.max() <= 15.0 + 1e-6
    less = raster_path.raster(wall, {**X, "max_tilt_deg": 5.0})
    assert np.degrees(np.arccos(np.clip(-on_passes(less)[:, 2, 2], -1, 1))).max() <= 5.0 + 1e-6
    # A leaned wheel still stands on the floor: its lowest point has z = 0.
    low = edges(on_passes(laid)[leaned])[:, :, 2].min(axis=1)
    assert low == pytest.approx(np.zeros(len(low)), abs=0.05)


def test_round_a_post_the_pass_is_interrupted(parts):
    path = parts / "post.brep"
    job = job_of(path, [floor_of(path)])
    laid = raster_path.raster(job, {**X, "max_tilt_deg": 0.0, "bridge_mm": 60.0})
    contacts = on_passes(laid)
    centre = contacts[:, :3, 3] - RADIUS * contacts[:, :3, 2]
    beside = np.abs(contacts[:, 1, 3] - 30.0) < 0.5 * WIDTH + 6.0 - 1.0
    # The wheel's axis is 20 mm high, the post 30: along x it keeps a radius off the post's side.
    side = np.sqrt(
        np.maximum(6.0**2 - np.maximum(np.abs(contacts[:, 1, 3] - 30.0) - 5.0, 0) ** 2, 0)
    )
    assert (np.abs(centre[beside, 0] - 40.0) > RADIUS + side[beside] - 0.75).all()
    # No way bridges the post in contact, however long a gap may be.
    for one in laid["passes"]:
        x = laid["contacts"][one["first"] : one["last"] + 1, 0, 3]
        y = laid["contacts"][one["first"], 1, 3]
        if abs(y - 30.0) < 8.0:
            assert (x < 40).all() or (x > 40).all()
    assert laid["reachable"]["left_out"] == pytest.approx(2 * 26 * 12 / (80 * 60), abs=0.08)
    (told,) = [fact for fact in laid["warnings"] if fact.code == "raster.not_reachable_leaned"]
    assert f"Face{job['design']['faces'][0]}" in told


@pytest.mark.slow
def test_off_the_passes_it_is_lifted_no_higher_than_there_is_room(freecad, tmp_path):
    freecad.call(make_lid, tmp_path)
    path = tmp_path / "lid.brep"
    laid = raster_path.raster(job_of(path, [floor_of(path)]), {**X, "step_over_mm": 10.0})
    heights = laid["contacts"][:, 2, 3]
    # The wheel of 40 mm has 12 mm above it; the settings ask for 30.
    assert 6.0 < heights.max() <= 12.5
    assert not [fact for fact in laid["warnings"] if fact.code == "raster.ways_blocked"]
    high = raster_path.raster(job_of(path, [floor_of(path)]), {**X, "where_it_collides": "warn"})
    assert high["contacts"][:, 2, 3].max() == pytest.approx(30.0)
    assert [fact for fact in high["warnings"] if fact.code == "raster.ways_blocked"]


@pytest.mark.slow
def test_a_body_that_is_fixed_to_the_part_is_in_the_way_too(parts):
    path = parts / "wall.brep"
    points = np.array([[30, 0, 0], [50, 0, 0], [50, 60, 0], [30, 60, 0]], np.float32)
    points = np.vstack([points, points + [0, 0, 8]]).astype(np.float32)
    quads = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32)
    clamp = core.shape_from_mesh(core.TriangleMesh(points, triangles)).write_brep()
    clamp = {"name": "clamp", "brep": clamp, "frame": "part"}
    floor = [floor_of(path)]
    laid = raster_path.raster(job_of(path, floor, cell={"bodies": [clamp]}), X)
    x = on_passes(laid)[:, 0, 3]
    # Over a clamp 8 mm high the rim of radius 20 begins sqrt(20^2 - 12^2) = 16 mm before it.
    assert ((x < 30 - 14.5) | (x > 50 + 14.5)).all()
    moved = {**clamp, "frame": "wheel"}  # goes with the wheel: the simulation looks at it
    free = on_passes(raster_path.raster(job_of(path, floor, cell={"bodies": [moved]}), X))
    assert ((free[:, 0, 3] > 31) & (free[:, 0, 3] < 49)).any()


def test_where_it_fits_nowhere_that_is_said_and_nothing_hidden(freecad, tmp_path):
    freecad.call(make_slot, tmp_path)
    path = tmp_path / "slot.brep"
    shape = workpiece.read_design(job_of(path)["design"])
    slot = [k + 1 for k in range(shape.face_count) if abs(shape.face_area(k) - 240.0) < 1.0]
    laid = raster_path.raster(job_of(path, slot), X)
    codes = [fact.code for fact in laid["warnings"]]
    assert "raster.no_room" in codes and "raster.wheel_does_not_fit" in codes
    assert laid["reachable"]["share"] == 0.0


def test_places_tell_what_is_ground_and_why_not(wall):
    laid = raster_path.raster(wall, {**X, "where_it_collides": "leave_out"})
    seen = laid["places"]
    away = 60.0 - seen["points"][:, 1]
    assert (seen["state"][away > 11.0] == reachable.GROUND).all()
    assert set(seen["state"][away < 0.5]) <= {reachable.NO_ROOM, reachable.NO_PASS}
    assert not seen["fits"][away < 4.0].any() and seen["fits"][away > 5.5].all()
    wide = raster_path.raster(wall, {**X, "step_over_mm": 25.0})["places"]
    # Stripes between passes that are too far apart are no matter of room.
    between = (wide["state"] == reachable.NO_PASS) & (60.0 - wide["points"][:, 1] > 15)
    assert wide["areas"][between].sum() > 0.3 * wide["areas"].sum()


def test_the_touch_of_a_leaned_wheel_is_its_lowest_point():
    from beltgrinding.raster import tool
    from beltgrinding.raster.clearing import _about_x

    job = job_of("none")
    wheel = job["belt_machine"]["wheel"]
    assert tool.of(job).shift(math.radians(10)) == pytest.approx([0, 5, 0])
    assert tool.of(job).shift(-math.radians(10)) == pytest.approx([0, -5, 0])
    # A profile, as finely as it is to be seen: a crown of 60 mm.
    y = np.linspace(-5, 5, 2001)
    wheel["profile_mm"] = np.column_stack([y, 60.0 - np.sqrt(60.0**2 - y**2)]).tolist()
    lean = math.radians(3)
    assert tool.of(job).shift(lean)[1] == pytest.approx(60 * math.sin(lean), abs=0.01)
    assert _about_x(lean) @ [0, 1, 0] == pytest.approx([0, math.cos(lean), math.sin(lean)])


def make_parts(folder):
    V = FreeCAD.Vector
    floor = Part.makeBox(80, 60, 10, V(0, 0, -10))
    floor.fuse(Part.makeBox(80, 10, 40, V(0, 60, -10))).removeSplitter().exportBrep(
        str(folder / "wall.brep")
    )
    floor.fuse(Part.makeCylinder(6, 40, V(40, 30, -10))).removeSplitter().exportBrep(
        str(folder / "post.brep")
    )


def make_lid(tmp_path):
    V = FreeCAD.Vector
    lid = Part.makeBox(120, 60, 5, V(0, 0, 52))
    post = Part.makeBox(2, 60, 62, V(118, 0, -5))
    Part.makeBox(120, 60, 5, V(0, 0, -5)).fuse(lid).fuse(post).removeSplitter().exportBrep(
        str(tmp_path / "lid.brep")
    )


def make_slot(tmp_path):
    V = FreeCAD.Vector
    Part.makeBox(60, 60, 40, V(0, 0, -40)).cut(Part.makeBox(60, 4, 20, V(0, 28, -20))).exportBrep(
        str(tmp_path / "slot.brep")
    )


def test_passes_too_near_each_other_to_fill_with_are_left_away(wall):
    """On a face of more than 100 step-overs, the densest that fill its gaps are more than may be asked for."""
    shape = workpiece.read_design(wall["design"])
    clearing = raster_path.Clearing(typed(wall), shape, raster_path.validate({}), [], None)
    seen = {
        "points": np.array([[10.0, 10.0, 0.0]]),
        "counted": np.ones(1),
        "fits": np.array([True]),
        "state": np.array([reachable.NO_PASS]),
    }
    square = (
        np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]),
        np.tile([0.0, 0.0, 1.0], (4, 1)),
        np.array([[0, 1, 2], [0, 2, 3]]),
        np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 1.0]]),  # at the triangles' corners
    )
    asked = []

    def levels_of(step_over, points, margin):
        assert points.tolist() == [[10.0, 10.0, 0.0]] and margin == 0.5 * 2.0
        asked.append(step_over)
        if step_over < 0.1:
            core.raster_lines(*square, step_over=1e-7)
        return []

    assert (
        filling.more(levels_of, seen, clearing, raster_path.validate({}), 2.0, (5.0, 5.0, None))
        == []
    )
    assert asked == [2.0 / 5, 2.0 / 25]
