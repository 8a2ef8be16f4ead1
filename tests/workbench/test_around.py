"""Passes round closed faces: rings and the helix."""

import math

import numpy as np
import pytest
import FreeCAD
import Part

from beltgrinding.engine import InputError, core
from beltgrinding.job import load, workpiece
from beltgrinding.raster import around, raster_path

RADIUS, HEIGHT = 30.0, 60.0
RINGS = {"along": "rings", "step_over_mm": 10.0, "entry": "direct"}


@pytest.fixture(scope="module")
def parts(freecad, tmp_path_factory):
    """BREP files: a cylinder whose side is two half faces, askew in space; a cone; a cup; a quarter of a torus (a
    bent tube); a half cylinder; a cap of a sphere about (1, 2, 2)."""
    folder = tmp_path_factory.mktemp("round")
    freecad.call(make_parts, folder)
    return folder


def job_of(path, faces):
    return load.validate(
        {
            "schema": 1,
            "design": {"file": str(path), "faces": faces},
            "belt_machine": {"wheel": {"radius_mm": 20, "width_mm": 10}, "force_N": 20},
            "programs": [{"poses": []}],
        }
    )


def faces_of(path, kind):
    shape = workpiece.read_design(job_of(path, [])["design"])
    return [k + 1 for k in range(shape.face_count) if shape.surface_type(k) == kind]


def on_pass(laid, k):
    one = laid["passes"][k]
    return laid["contacts"][one["first"] : one["last"] + 1]


def test_rings_close_over_two_half_cylinders(parts):
    path = parts / "halves.brep"
    faces = faces_of(path, "cylinder")
    assert len(faces) == 2
    laid = raster_path.raster(job_of(path, faces), RINGS)
    assert len(laid["passes"]) == 6
    for k, one in enumerate(laid["passes"]):
        assert one["length_mm"] == pytest.approx(2 * math.pi * RADIUS, rel=2e-3)
        places = on_pass(laid, k)[:, :3, 3]
        assert np.linalg.norm(places[0] - places[-1]) < 0.1
        # A plane circle: all of it as far from its middle.
        middle = (places[:-1].max(axis=0) + places[:-1].min(axis=0)) / 2
        assert np.linalg.norm(places - middle, axis=1) == pytest.approx(
            np.full(len(places), RADIUS), abs=0.1
        )
    assert not [fact for fact in laid["warnings"] if fact.code == "raster.rings_open"]


def test_a_helix_is_one_pass_with_its_pitch(parts):
    path = parts / "halves.brep"
    job = job_of(path, faces_of(path, "cylinder"))
    laid = raster_path.raster(job, {**RINGS, "order": "helix", "step_over_mm": 7.0})
    assert len(laid["passes"]) == 1
    turns = math.ceil(HEIGHT / 7.0)
    whole = turns * math.hypot(2 * math.pi * RADIUS, HEIGHT / turns)
    assert laid["passes"][0]["length_mm"] == pytest.approx(whole, rel=5e-3)
    shape = workpiece.read_design(job["design"])
    field, _ = core.sample_faces(shape, [face - 1 for face in job["design"]["faces"]], 1.0)
    axis = around.Axis(field.points, field.normals.astype(float), field.areas)
    places = on_pass(laid, 0)[:, :3, 3]
    rise = np.diff(axis.heights(places)) / np.diff(np.unwrap(axis.angles(places)))
    assert abs(rise) == pytest.approx(np.full(len(rise), HEIGHT / turns / (2 * math.pi)), rel=0.1)


def test_rings_on_a_cone_and_round_a_bend(parts):
    laid = raster_path.raster(
        job_of(parts / "cone.brep", faces_of(parts / "cone.brep", "cone")), RINGS
    )
    lengths = [one["length_mm"] for one in laid["passes"]]
    heights = [on_pass(laid, k)[:, 2, 3] for k in range(len(lengths))]
    assert all(np.ptp(z) < 0.2 for z in heights)
    for length, z in zip(lengths, heights):
        assert length == pytest.approx(2 * math.pi * (30 - 15 * z.mean() / 40), rel=5e-3)
    bend = parts / "bend.brep"
    laid = raster_path.raster(job_of(bend, faces_of(bend, "torus")), {**RINGS, "step_over_mm": 8})
    assert len(laid["passes"]) >= 8
    middle = laid["passes"][len(laid["passes"]) // 2]
    assert middle["length_mm"] == pytest.approx(2 * math.pi * 15, rel=0.02)
    closed = 0
    for k in range(len(laid["passes"])):  # at the ends of the outer side, arcs are what is left
        places = on_pass(laid, k)[:, :3, 3]
        closed += np.linalg.norm(places[0] - places[-1]) < 0.2
    assert closed >= 6 and laid["reachable"]["no_pass"] < 0.01


def test_what_is_not_round_is_said(parts):
    half = parts / "half.brep"
    laid = raster_path.raster(job_of(half, faces_of(half, "cylinder")), RINGS)
    assert [fact for fact in laid["warnings"] if fact.code == "raster.rings_open"]
    bend = parts / "bend.brep"
    with pytest.raises(InputError, match="helix needs a surface of revolution"):
        raster_path.raster(job_of(bend, faces_of(bend, "torus")), {**RINGS, "order": "helix"})
    with pytest.raises(InputError, match="do not go round"):
        quarter = parts / "quarter.brep"
        raster_path.raster(job_of(quarter, faces_of(quarter, "cylinder")), RINGS)


def test_the_axis_of_a_surface_of_revolution_is_found(parts):
    path = parts / "halves.brep"
    shape = workpiece.read_design(job_of(path, [])["design"])
    field, _ = core.sample_faces(shape, [k - 1 for k in faces_of(path, "cylinder")], 2.0)
    axis = around.Axis(field.points, field.normals.astype(float), field.areas)
    assert axis.revolution and axis.turn == 1.0
    angle, n = math.radians(50), np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
    z = np.array([0.0, 0.0, 1.0])
    turned = (
        z * math.cos(angle) + np.cross(n, z) * math.sin(angle) + n * (n @ z) * (1 - math.cos(angle))
    )
    assert abs(axis.way @ turned) == pytest.approx(1.0, abs=1e-6)
    assert axis.radii(field.points) == pytest.approx(np.full(field.size, RADIUS), abs=1e-3)


def test_rings_on_a_cap_of_a_sphere_go_round_its_pole(parts):
    path = (
        parts / "cap.brep"
    )  # all lines through a sphere's middle are axes of it, one is its border's
    laid = raster_path.raster(job_of(path, faces_of(path, "sphere")), RINGS)
    way = np.array([1.0, 2.0, 2.0]) / 3.0
    rings = 0
    for k, one in enumerate(laid["passes"]):
        places = on_pass(laid, k)[:, :3, 3]
        height = places @ way
        assert np.ptp(height) < 0.3
        if np.linalg.norm(places[0] - places[-1]) < 0.3:
            rings += 1
            radius = math.sqrt(50.0**2 - height.mean() ** 2)
            assert one["length_mm"] == pytest.approx(2 * math.pi * radius, rel=1e-2)
    # 50 mm by 40 degrees of arc from the border to the pole.
    assert rings >= 3


def test_an_oblong_dome_does_not_go_round():
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 60), np.linspace(-1, 1, 60)))
    points = 20.0 * np.stack([x, 0.6 * y, -0.5 * x**2 - y**2], axis=1)
    normals = np.stack([x, 2.0 * y / 0.6, np.ones(len(x))], axis=1)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    axis = around.Axis(points, normals, np.ones(len(x)))
    assert axis.turn < 0.5


def make_parts(folder):
    V = FreeCAD.Vector
    half = lambda: Part.makeCylinder(RADIUS, HEIGHT, V(0, 0, 0), V(0, 0, 1), 180)
    other = half()
    other.rotate(V(0, 0, 0), V(0, 0, 1), 180)
    both = half().fuse(other)
    place = FreeCAD.Placement(V(40, -10, 25), FreeCAD.Rotation(V(1, 2, 3), 50))
    both.Placement = place
    both.exportBrep(str(folder / "halves.brep"))
    half().exportBrep(str(folder / "half.brep"))
    Part.makeCylinder(RADIUS, HEIGHT, V(0, 0, 0), V(0, 0, 1), 90).exportBrep(
        str(folder / "quarter.brep")
    )
    Part.makeCone(30, 15, 40).exportBrep(str(folder / "cone.brep"))
    Part.makeTorus(60, 15, V(0, 0, 0), V(0, 0, 1), -180, 180, 90).exportBrep(
        str(folder / "bend.brep")
    )
    Part.makeSphere(50, V(0, 0, 0), V(1, 2, 2), 50, 90, 360).exportBrep(str(folder / "cap.brep"))
