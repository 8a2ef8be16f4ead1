"""Scans of the ground part: read, aligned, measured sample by sample, and used to calibrate."""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from support.freecad import ROOT

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.scan import (
    comparison as scan,
    file as scan_file,
    start as scan_start,
)
from beltgrinding.simulation.result import Result
from test_ground_mesh import block_job
from test_job import cli

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
NOISE = 0.01  # mm, standard deviation of a synthetic scan's points
pytestmark = pytest.mark.skipif(
    not list((ROOT / "build" / "release" / "python").glob("beltgrinding_scan*")),
    reason="beltgrinding_scan is not built (no nanoflann)",
)


def motion(axis, degrees, shift):
    """4 x 4 by a turn about an axis and a shift in mm."""
    axis = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.cross(np.eye(3), axis)
    angle = math.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) - math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    matrix[:3, 3] = shift
    return matrix


def apart(one, other, centre):
    """(mm at the centre, degrees) between two transforms."""
    both = one @ np.linalg.inv(other)
    turn = math.degrees(math.acos(np.clip((np.trace(both[:3, :3]) - 1) / 2, -1, 1)))
    return float(np.linalg.norm(both[:3, :3] @ centre + both[:3, 3] - centre)), turn


def spread(mesh, count, seed):
    """(count, 3) points evenly on a core.GroundMesh."""
    random = np.random.default_rng(seed)
    corners = mesh.vertices[mesh.triangles]
    twice = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    chosen = corners[random.choice(len(corners), count, p=twice / twice.sum())]
    u, v = random.random((2, count))
    fold = u + v > 1
    u[fold], v[fold] = 1 - u[fold], 1 - v[fold]
    return (
        chosen[:, 0]
        + u[:, None] * (chosen[:, 1] - chosen[:, 0])
        + v[:, None] * (chosen[:, 2] - chosen[:, 0])
    )


@pytest.fixture(scope="module")
def result():
    return beltgrinding.run(block_job())


@pytest.fixture(scope="module")
def mesh(result):
    return beltgrinding.ground_mesh(result)


SCAN_FROM_WORK = motion((1, 2, -1), 35.0, (400.0, -150.0, 80.0))
ROUGH = motion((0, 1, 1), 2.5, (1.5, -1.0, 1.2)) @ np.linalg.inv(SCAN_FROM_WORK)  # as if by eye


@pytest.fixture(scope="module")
def cloud(mesh):
    """A noisy cloud with outliers and a table, in a frame of its own."""
    random = np.random.default_rng(3)
    part = spread(mesh, 120_000, 1) + random.normal(0, NOISE, (120_000, 3))
    stray = random.uniform((-20, -20, -30), (80, 60, 20), (3_000, 3))
    table = random.uniform((-60, -60, -13.5), (120, 100, -13.4), (20_000, 3))
    return scan_start.moved(np.concatenate([part, stray, table]), SCAN_FROM_WORK)


def test_a_cloud_with_clutter_comes_back_to_its_place(result, cloud):
    surface = scan.datum(result)
    assert not surface["predicted"] and len(surface["faces"]) == 5
    found = scan.align(scan_file.Scan(cloud), surface, ROUGH)
    mm, degrees = apart(found["work_from_scan"] @ SCAN_FROM_WORK, np.eye(4), np.array([30, 20, -6]))
    assert found["converged"] and found["warnings"] == []
    assert mm < 0.003 and degrees < 0.005
    assert found["rms_mm"] < 1.3 * NOISE
    assert all(0 < value < 0.001 for value in found["sd"].values())


def test_the_removed_depth_comes_back(result, cloud):
    found = scan.align(scan_file.Scan(cloud), scan.datum(result), ROUGH)
    measured = scan.measure(result.field, scan_file.Scan(cloud), found["work_from_scan"])
    difference = (measured - result.field.height)[np.isfinite(measured)]
    assert len(difference) > 0.9 * result.field.size
    assert abs(difference.mean()) < 0.003
    assert np.percentile(np.abs(difference), 95) < 2 * NOISE
    figures = scan.statistics(result.field, measured, (-0.05, 0.05))
    assert figures["measured_area_share"] > 0.9
    assert figures["difference_mm"]["mean"] == pytest.approx(difference.mean(), abs=1e-3)


def test_a_mesh_is_met_by_rays_and_feeds_the_calibration(result, mesh, tmp_path):
    ours = Result.read(_written(result, tmp_path))
    vertices = scan_start.moved(mesh.vertices, SCAN_FROM_WORK)
    _ply(tmp_path / "scan.ply", vertices / 1000.0, mesh.triangles)
    np.savetxt(
        tmp_path / "rough.txt", motion((1, 0, 0), 1, (0, 1, 0)) @ np.linalg.inv(SCAN_FROM_WORK)
    )
    done = cli(
        *("scan", "out", "scan.ply", "--unit-mm", "1000", "--matrix", "rough.txt"), cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    difference = told["difference_mm"]
    assert told["kind"] == "mesh" and abs(difference["mean"]) < 0.0002
    assert difference["min"] > -0.05  # no wall below the edge is taken for the face
    written = json.loads((tmp_path / "out" / "scan.json").read_text())
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert written.pop("run_id") == summary["run_id"] and told == written
    kept = Result.read(tmp_path / "out")
    # At the very edge a ray grazes the faces beside it.
    inside = (np.asarray(kept.field.flags) & core.ON_BOUNDARY) == 0
    known = np.isfinite(kept.field.measured) & inside
    assert known.sum() > 0.95 * inside.sum()
    off = np.abs(kept.field.measured[known] - ours.field.height[known])
    assert np.percentile(off, 95) < 0.002 and off.max() < 0.02  # between the mesh's vertices
    done = cli("calibrate-scan", "out", "-o", "law.json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["scale"] == pytest.approx(1.0, abs=0.02)


def _written(result, folder):
    result.write(folder / "out")
    return folder / "out"


def _ply(path, vertices, triangles):
    row = np.dtype([("n", "u1"), ("v", "<u4", 3)])
    faces = np.zeros(len(triangles), row)
    faces["n"], faces["v"] = 3, triangles
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    path.write_bytes(
        head.encode() + np.ascontiguousarray(vertices, "<f8").tobytes() + faces.tobytes()
    )


def test_a_plane_slides_and_is_said_to(result, cloud):
    bottom = [face for face in scan.datum(result)["faces"] if _faces_down(result, face)]
    surface = scan.datum(result, bottom)
    found = scan.align(scan_file.Scan(cloud), surface, np.linalg.inv(SCAN_FROM_WORK))
    assert len(found["undetermined"]) == 3
    assert "free to move" in found["warnings"][0]
    assert math.isinf(found["sd"]["tx"]) and math.isinf(found["sd"]["rz"])
    assert found["sd"]["tz"] < 0.001
    mm, degrees = apart(
        found["work_from_scan"] @ SCAN_FROM_WORK, np.eye(4), np.array([30, 20, -12])
    )
    assert mm < 0.005 and degrees < 0.01  # it stays where it started along the plane


def _faces_down(result, face):
    shape = core.Shape.from_brep(result.job["design"]["brep"])
    field, _ = core.sample_faces(shape, [face - 1], 5.0)
    return field.normals[0][2] < -0.9


def test_fixed_freedoms_keep_the_start(result, cloud):
    start = motion((0, 0, 1), 0.4, (0.3, -0.2, 0.5)) @ np.linalg.inv(SCAN_FROM_WORK)
    surface = scan.datum(result)
    found = scan.align(scan_file.Scan(cloud), surface, start, fixed=("tz", "rz"))
    moved = found["work_from_scan"] @ np.linalg.inv(start)
    centre = surface["points"].mean(axis=0)
    assert (moved[:3, :3] @ centre + moved[:3, 3] - centre)[2] == pytest.approx(0.0, abs=1e-9)
    vector = np.array(
        [moved[2, 1] - moved[1, 2], moved[0, 2] - moved[2, 0], moved[1, 0] - moved[0, 1]]
    )
    assert vector[2] == pytest.approx(0.0, abs=1e-12)
    assert found["sd"]["tz"] == 0.0 and found["sd"]["rz"] == 0.0
    with pytest.raises(InputError, match="no freedom 'z'"):
        scan.align(scan_file.Scan(cloud), surface, start, fixed=("z",))


def wedge(count, seed):
    """(points, normals) on a tetrahedron that no turn lays on itself."""
    corners = np.array([[0, 0, 0], [90, 0, 0], [15, 40, 0], [10, 8, 25]], dtype=float)
    random = np.random.default_rng(seed)
    points, normals = [], []
    for i, j, k, other in ((0, 1, 2, 3), (0, 1, 3, 2), (1, 2, 3, 0), (0, 2, 3, 1)):
        a, b, c = corners[[i, j, k]]
        normal = np.cross(b - a, c - a)
        share = np.linalg.norm(normal)
        normal /= share
        normal *= -np.sign(normal @ (corners[other] - a))
        some = int(count * share / 9000)
        u, v = random.random((2, some))
        fold = u + v > 1
        u[fold], v[fold] = 1 - u[fold], 1 - v[fold]
        points.append(a + u[:, None] * (b - a) + v[:, None] * (c - a))
        normals.append(np.tile(normal, (some, 1)))
    return np.concatenate(points), np.concatenate(normals)


@pytest.mark.slow
def test_principal_axes_find_any_attitude():
    points, normals = wedge(40_000, 1)
    surface = {"points": points, "normals": normals, "spacing": 0.7}
    for k in range(4):
        random = np.random.default_rng(k)
        there = motion(random.normal(size=3), random.uniform(0, 180), random.normal(0, 500, 3))
        scanned = scan_file.Scan(scan_start.moved(wedge(30_000, 2)[0], there))
        found = scan.align(scanned, surface, "principal")
        mm, degrees = apart(found["work_from_scan"] @ there, np.eye(4), points.mean(axis=0))
        assert mm < 0.02 and degrees < 0.05
        assert found["warnings"] == []


def test_a_symmetric_part_is_said_to_be(result, mesh):
    scanned = scan_file.Scan(scan_start.moved(spread(mesh, 40_000, 5), SCAN_FROM_WORK))
    found = scan.align(scanned, scan.datum(result), "principal")
    assert any("symmetric" in text for text in found["warnings"])


def test_three_pairs_place_the_scan():
    places = np.array([[0, 0, 0], [50, 0, 0], [0, 30, 5], [10, 10, 20]], dtype=float)
    there = scan_start.moved(places, SCAN_FROM_WORK) / 1000.0
    matrix, rms = scan_start.by_pairs(np.stack([there, places], axis=1), 1000.0)
    np.testing.assert_allclose(matrix @ SCAN_FROM_WORK, np.eye(4), atol=1e-9)
    assert rms < 1e-9
    with pytest.raises(InputError, match="one line"):
        scan_start.by_pairs(np.stack([places[[0, 1, 1]], places[[0, 1, 1]]], axis=1))
    with pytest.raises(InputError, match="three pairs"):
        scan_start.by_pairs(np.zeros((2, 2, 3)))


def test_a_hole_in_the_scan_is_not_filled(result, mesh):
    points = spread(mesh, 200_000, 9)
    hole = (np.abs(points[:, 0] - 30) < 6) & (np.abs(points[:, 1] - 20) < 6)
    measured = scan.measure(result.field, scan_file.Scan(points[~hole]), np.eye(4))
    at = result.field.points
    inside = (np.abs(at[:, 0] - 30) < 4) & (np.abs(at[:, 1] - 20) < 4)
    outside = (
        (np.abs(at[:, 0] - 30) > 8) & (np.abs(at[:, 0] - 30) < 25) & (np.abs(at[:, 1] - 20) < 15)
    )
    assert np.isnan(measured[inside]).all()
    assert np.isfinite(measured[outside]).all()


@pytest.mark.parametrize(
    "text, words",
    [
        (b"", "no point"),
        (b"x y z\nfoo\n", "line 2"),
        (b"1 2 3\n1,5 2\n", "line 2"),
        (b"1,5 2,5 3,5\n1,5 2,5 3,6\n", "line 1"),
        (b"1,5;2,5;3,5\n1,5;2,5;3,6\n", "line 2"),
        (b"1 2 nan\n", "line 1"),
        (b"\xff\xfe\x00garbage", "no point"),
        (b"# only\n// comments\n", "no point"),
    ],
)
def test_a_bad_cloud_is_refused_by_name(tmp_path, text, words):
    (tmp_path / "bad.xyz").write_bytes(text)
    with pytest.raises(InputError, match=words) as told:
        scan_file.read(tmp_path / "bad.xyz")
    assert "bad.xyz" in str(told.value)


@pytest.mark.parametrize("suffix", [".xyz", ".csv", ".obj", ".ply"])
def test_clouds_are_read_alike(tmp_path, suffix):
    points = np.random.default_rng(0).normal(0, 50, (100, 3))
    path = tmp_path / f"cloud{suffix}"
    if suffix == ".ply":
        _ply(path, points, np.empty((0, 3), np.uint32))
    elif suffix == ".obj":
        path.write_text("# a cloud\n" + "".join("v %.9g %.9g %.9g\n" % tuple(p) for p in points))
    else:
        sign = "," if suffix == ".csv" else " "
        rows = (sign.join("%.9g" % value for value in (*p, 7)) for p in points)
        path.write_text("x,y,z,intensity\n" * (suffix == ".csv") + "\n".join(rows))
    read = scan_file.read(path, 2.0)
    assert read.triangles is None
    np.testing.assert_allclose(read.points, 2 * points, rtol=1e-7)


def test_wrong_units_and_places_are_told(result, cloud):
    surface = scan.datum(result)
    for factor in (0.001, 1000.0):
        with pytest.raises(InputError, match="unit"):
            scan.align(scan_file.Scan(factor * cloud), surface, ROUGH)
    with pytest.raises(InputError, match="no datum face 99"):
        scan.datum(result, [99])
    with pytest.raises(InputError, match="no rotation"):
        scan.align(scan_file.Scan(cloud), surface, 2 * np.eye(4))


@pytest.mark.slow
def test_the_real_scan_finds_the_same_place_from_different_starts():
    folder = SHARED / "data" / "mesh"
    if not folder.is_dir():
        pytest.skip("shared data absent")
    design = scan_file.read(folder / "DAC_580813_cad.stl", 1000.0)
    scanned = scan_file.read(folder / "DAC_580813_scan.ply", 1000.0)
    points, normals = design.spread(40_000)
    surface = {"points": points, "normals": normals, "spacing": 6.0}
    rough = scan_start.read_matrix(folder / "DAC_580813_rough_alignment.txt")
    rough[:3, 3] *= 1000.0
    centre = design.points.mean(axis=0)
    about = np.eye(4)
    about[:3, 3] = centre
    found = []
    for degrees in (0.0, 1.5, -1.5):
        nudge = about @ motion((1, 1, 2), degrees, (2 * degrees, 0, 0)) @ np.linalg.inv(about)
        found.append(scan.align(scanned, surface, nudge @ rough, max_distance_mm=15.0))
    for one in found:
        assert one["rms_mm"] < 5.0  # the rough alignment's is 3.1 mm of the better 60 %
        assert 0.2 < one["used_share"] < 0.9  # the table is left out
        mm, degrees = apart(one["work_from_scan"], found[0]["work_from_scan"], centre)
        assert mm < 0.5 and degrees < 0.2
