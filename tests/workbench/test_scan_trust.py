"""A placement of a scan that other starts contradict is not to be trusted, and is said not to be."""

import math

import numpy as np
import pytest

from beltgrinding.engine import core
from beltgrinding.scan import comparison as scan, file as scan_file, trust
from test_scan import NOISE, ROUGH, SCAN_FROM_WORK, cloud, mesh, pytestmark, result  # noqa: F401


def ribbed(pitch, height=0.5, size=60.0, ends=True):
    """(points, normals) of a plate with a wave of ribs along x; with ends, walls around it."""
    x, y = np.meshgrid(np.arange(0, size, 0.25), np.arange(0, size / 2, 0.5), indexing="ij")
    x, y = x.ravel(), y.ravel()
    k = 2 * math.pi / pitch
    points = np.column_stack([x, y, height * np.sin(k * x)])
    normals = np.column_stack([-height * k * np.cos(k * x), np.zeros_like(x), np.ones_like(x)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    if ends:
        s, z = (a.ravel() for a in np.meshgrid(np.arange(0, size / 2, 0.5), np.arange(-4, 0, 0.5)))
        for at, across in ((0.0, -1.0), (size, 1.0)):
            points = np.vstack([points, np.column_stack([np.full_like(s, at), s, z])])
            normals = np.vstack([normals, np.tile([across, 0.0, 0.0], (len(s), 1))])
    s, z = (a.ravel() for a in np.meshgrid(np.arange(0, size, 0.5), np.arange(-4, 0, 0.5)))
    for at, across in ((0.0, -1.0), (size / 2, 1.0)):
        points = np.vstack([points, np.column_stack([s, np.full_like(s, at), z])])
        normals = np.vstack([normals, np.tile([0.0, across, 0.0], (len(s), 1))])
    return points, normals


def aligned(points, normals, start):
    random = np.random.default_rng(5)
    noisy = points + random.normal(0, 0.01, points.shape)
    datum = {"points": points, "normals": normals, "spacing": 0.5}
    return scan.align(scan_file.Scan(noisy), datum, start, max_distance_mm=3.0)


def test_a_good_placement_is_trusted(result, cloud):  # noqa: F811
    found = scan.align(scan_file.Scan(cloud), scan.datum(result), ROUGH)
    assert found["trusted"] and found["placements"] == 1 and found["apart_mm"] == 0.0
    assert found["rms_mm"] < 1.3 * NOISE


def test_ribs_that_fit_one_further_are_told_of():
    points, normals = ribbed(2.0, ends=False)
    found = aligned(points, normals, np.eye(4))
    assert not found["trusted"] and found["placements"] > 1
    assert [fact.code for fact in found["warnings"]] == ["scan.other_placements"]
    assert found["apart_mm"] > 1.7
    assert found["sd"]["tx"] > 0.2  # that of the residuals alone is 1e-4
    fixed = {"points": points, "normals": normals, "spacing": 0.5}
    held = scan.align(scan_file.Scan(points), fixed, np.eye(4), ("tx",), max_distance_mm=3.0)
    assert held["trusted"], held["warnings"]


def test_a_wrong_valley_is_told_of():
    points, normals = ribbed(3.0)
    start = np.eye(4)
    start[0, 3] = 3.0
    found = aligned(points, normals, start)
    assert found["work_from_scan"][0, 3] == pytest.approx(3.0, abs=0.01)  # one rib beside
    assert not found["trusted"] and found["apart_mm"] >= 2.9
    assert found["warnings"][0].code in ("scan.better_elsewhere", "scan.other_placements")
    assert aligned(points, normals, np.eye(4))["rms_mm"] < 0.012


@pytest.mark.slow
def test_a_residual_of_many_tolerances_is_told(result, cloud, tmp_path):  # noqa: F811
    path = tmp_path / "scan.xyz"
    random = np.random.default_rng(2)
    np.savetxt(path, cloud + random.normal(0, 0.4, cloud.shape))
    figures = scan.compare(result, path, start=ROUGH)
    codes = [fact.code for fact in figures["warnings"]]
    assert codes[0] == "scan.poor_fit" and not figures["alignment"]["trusted"]
    np.savetxt(path, cloud)
    figures = scan.compare(result, path, start=ROUGH)
    assert figures["alignment"]["trusted"] and figures["warnings"] == []


def test_motions_add_up():
    random = np.random.default_rng(1)
    for _ in range(20):
        centre = random.normal(0, 50, 3)
        matrix = trust.moved_about(np.eye(4), np.zeros(3), random.normal(0, 1, 6))
        motion = random.normal(0, 0.5, 6)
        other = trust.moved_about(matrix, centre, motion)
        assert trust.motion_between(matrix, other, centre) == pytest.approx(motion, abs=1e-9)
    ways = np.array(trust.WAYS)
    assert set(map(abs, ways.ravel())) == {1} and not ways.sum(axis=0).any()


def test_faces_are_told_in_runs():
    assert scan.face_runs([3, 1, 4, 5, 9]) == [1, [3, 5], 9]
    assert scan.face_runs(range(1, 34597)) == [[1, 34596]]
    assert scan.face_runs([]) == []
