"""Passes on a part of the faces only, and wheels that grind in turn."""

import json
import subprocess
import sys

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base.files import write_whole
from beltgrinding.engine import InputError, core
from beltgrinding.job import load, poses
from beltgrinding.raster import in_turn, raster_path, reachable, region

LENGTH, WIDTH = 80.0, 60.0
X = {"along": "direction", "direction": [1, 0, 0], "step_over_mm": 4.0, "spacing": "lines"}


def plate(groove=None):
    """A plate of LENGTH x WIDTH, z up; groove: (from, to, depth) mm across y."""
    y, z = [0.0, WIDTH], [0.0, 0.0]
    if groove:
        low, high, depth = groove
        y, z = [0.0, low, low, high, high, WIDTH], [0.0, 0.0, -depth, -depth, 0.0, 0.0]
    points = np.array([[x, b, c] for x in (0.0, LENGTH) for b, c in zip(y, z)], np.float32)
    count, triangles = len(y), []
    for k in range(count - 1):
        triangles += [[k, k + count, k + count + 1], [k, k + count + 1, k + 1]]
    mesh = core.TriangleMesh(points, np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def job_of(brep, wheel=None, **parts):
    wheel = wheel or {"radius_mm": 20, "width_mm": 10}
    return load.validate(
        {
            "schema": 1,
            "design": {"brep": brep},
            "belt_machine": {"wheel": wheel, "force_N": 20},
            "programs": [{"poses": []}],
            **parts,
        }
    )


def test_passes_stay_near_the_region():
    spot = [[x, y, 0.0] for x in range(30, 51, 2) for y in range(20, 31, 2)]
    job = job_of(plate())
    laid = raster_path.raster(
        job, {**X, "region_points": spot, "region_mm": 3.0, "entry": "direct"}
    )
    places = laid["contacts"][laid["contact"]][:, :3, 3]
    off = np.maximum(np.maximum([30, 20] - places[:, :2], places[:, :2] - [50, 30]), 0)
    assert np.linalg.norm(off, axis=1).max() <= 3.0 + 1e-6
    assert places[:, 0].min() < 29 and places[:, 0].max() > 51  # all of it, and what is round it
    seen = laid["places"]
    inside = (
        (seen["points"][:, 0] > 29)
        & (seen["points"][:, 0] < 51)
        & (seen["points"][:, 1] > 19)
        & (seen["points"][:, 1] < 31)
    )
    assert (seen["state"][inside] == reachable.GROUND).all()
    far = np.linalg.norm(seen["points"][:, :2] - [40, 25], axis=1) > 35
    assert (seen["state"][far] == reachable.NOT_WANTED).all()
    assert laid["reachable"]["no_pass"] < 0.01
    with pytest.raises(InputError, match="off the faces"):
        raster_path.raster(job, {**X, "region_points": [[40.0, 25.0, 60.0]], "region_mm": 3.0})


def ground(tmp_path):
    """The folder of a result whose left half alone was ground, and its job."""
    brep = plate()
    job = job_of(brep, stock={"kind": "allowance", "allowance_mm": 0.1})
    half = [[x, y, 0.0] for x in range(0, 41, 2) for y in range(0, 61, 2)]
    laid = raster_path.raster(job, {**X, "region_points": half, "region_mm": 2.0, "feed_mm_s": 5.0})
    result = beltgrinding.run({**job, "programs": [{"poses": poses.list_poses(laid)}]})
    result.write(tmp_path / "result")
    return tmp_path / "result", job, result


@pytest.mark.slow
def test_only_what_a_result_has_left(tmp_path):
    folder, job, result = ground(tmp_path)
    points, _ = region.of_result(folder, 0.06)
    left = result.field.points[result.field.height > 0.06]
    assert points[:, 0].min() == pytest.approx(left[:, 0].min(), abs=2.0)
    laid = raster_path.raster(job, {**X, "region_points": points.tolist(), "entry": "direct"})
    places = laid["contacts"][laid["contact"]][:, :3, 3]
    assert places[:, 0].min() > left[:, 0].min() - 6.0 > 20.0
    assert places[:, 0].max() == pytest.approx(LENGTH, abs=0.1)
    with pytest.raises(InputError, match="nothing is left above 5 mm"):
        region.of_result(folder, 5.0)
    with pytest.raises(InputError, match="no cluster 99"):
        region.of_result(folder, clusters=[99])


def test_the_command_line_takes_a_result_and_a_second_wheel(tmp_path):
    def run(*words):
        return subprocess.run(
            [sys.executable, "-m", "beltgrinding", "raster", *map(str, words)],
            capture_output=True,
            text=True,
        )

    brep = plate((25.0, 35.0, 6.0))
    for name, wheel in (
        ("large", {"radius_mm": 40, "width_mm": 16}),
        ("small", {"radius_mm": 12.5, "width_mm": 6}),
    ):
        (tmp_path / f"{name}.brep").write_text(brep)
        data = {
            "schema": 1,
            "design": {"file": f"{name}.brep"},
            "belt_machine": {"wheel": wheel, "force_N": 20},
        }
        if name == "small":
            data["belt_machine"]["compliance"] = {"rim_thickness_mm": 4}
        write_whole(tmp_path / f"{name}.json", json.dumps(data).encode())
    settings = ["--set", "along=direction", "--set", "step_over_mm=3", "--set", "max_tilt_deg=0"]
    large, small = tmp_path / "large.csv", tmp_path / "small.csv"
    done = run(
        tmp_path / "large.json", "-o", large, *settings, "--then", tmp_path / "small.json", small
    )
    found = json.loads(done.stdout)
    assert done.returncode == 0 and large.exists() and small.exists()
    assert len(found["wheels"]) == 2 and found["left_by_all"] < 0.2
    assert found["wheels"][1]["length_mm"] < found["wheels"][0]["length_mm"]
    refused = run(tmp_path / "large.json", "-o", tmp_path / "x.csv", "--above", "1")
    assert refused.returncode and "--region" in refused.stderr


def test_a_second_wheel_takes_what_the_first_leaves():
    brep = plate((25.0, 35.0, 6.0))
    large = job_of(brep, {"radius_mm": 40, "width_mm": 16})
    small = job_of(brep, {"radius_mm": 12.5, "width_mm": 6})
    small["belt_machine"]["compliance"]["rim_thickness_mm"] = 4.0
    settings = {**X, "step_over_mm": 3.0, "max_tilt_deg": 0.0}
    (first, second), places = in_turn([(large, settings), (small, settings)])
    at = first["contacts"][first["contact"]][:, :3, 3]
    assert not ((at[:, 1] > 26) & (at[:, 1] < 34) & (at[:, 2] < -1)).any()  # not into the groove
    at = second["contacts"][second["contact"]][:, :3, 3]
    assert ((at[:, 1] > 26) & (at[:, 1] < 34) & (at[:, 2] < -5.9)).any()
    floor = places["points"][:, 2] < -5.9
    middle = floor & (places["points"][:, 1] > 28.5) & (places["points"][:, 1] < 31.5)
    assert middle.any() and not places["left"][middle].any()
    again, _ = in_turn([(small, settings), (small, settings)])
    assert again[1] is None or len(again[1]["passes"]) < len(again[0]["passes"])


@pytest.mark.parametrize(
    "settings",
    [
        {"sampling_mm": 1000.0},
        {"region_points": [[40, 20, 0]], "region_mm": 1e-12},
        {"region_points": [[1e308, 0, 0]]},
        {"region_points": [[9e5, 0, 0]]},
        {"clearance_mm": 1e300},
        {"lead_mm": 1e300},
        {"run_out_mm": -1e4},
        {"order": "helix"},
        {"force_N": 1e300},
    ],
    ids=lambda one: next(iter(one)),
)
def test_nonsense_is_an_error_that_says_so(settings):
    with pytest.raises(InputError):
        raster_path.raster(job_of(plate((25.0, 35.0, 6.0))), {**X, "step_over_mm": 0.0, **settings})


@pytest.mark.slow
@pytest.mark.parametrize(
    "key", ["clearance_mm", "lead_mm", "run_out_mm", "offset_mm", "approach_mm"]
)
def test_large_lengths_give_a_path(key):
    laid = raster_path.raster(job_of(plate()), {**X, key: 1e4})
    assert len(laid["passes"]) and np.isfinite(laid["frames"]).all()


@pytest.mark.parametrize("margin", [1e-9, 0.3, 5.0])
def test_what_may_lie_beside_points_is_all_that_does_and_little_else(margin):
    by = np.random.default_rng(3)
    places, points = by.uniform(-20.0, 20.0, (4000, 3)), by.uniform(-5.0, 5.0, (40, 3))
    places[0] = points[0]
    apart = np.linalg.norm(places[:, None] - points, axis=2).min(axis=1)
    taken = region.beside(places, points, margin)
    assert (
        taken[apart <= margin].all() and not taken[apart > 2.0 * 3.0**0.5 * margin + 1e-3].any()
    )


def test_lines_about_some_points_are_those_of_all_there():
    """Where levels lie does not depend on where lines are wanted; they end a triangle or so farther out."""
    x, y = np.meshgrid(np.arange(0.0, 41.0), np.arange(0.0, 31.0))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(30)[:, None] * 41 + np.arange(40)).ravel()
    triangles = np.vstack(
        [
            np.column_stack([corner, corner + 1, corner + 42]),
            np.column_stack([corner, corner + 42, corner + 41]),
        ]
    )
    surface = {
        "name": "",
        "points": points,
        "normals": np.tile([0.0, 0.0, 1.0], (len(points), 1)),
        "triangles": triangles,
        "scalars": points[triangles][:, :, 1],
        "period": 0.0,
    }
    wanted = np.array([[10.0, 15.0, 0.0]])
    settings = raster_path.validate(X)
    laid = [surface], settings, 1.0, 1.0, 0.0, [], None
    all_, some = raster_path._lines(*laid), raster_path._lines(*laid, (wanted, 3.0))
    assert 0 < sum(map(len, some)) < sum(map(len, all_))
    cut = [region.restricted(levels, wanted, 3.0) for levels in (all_, some)]
    ends = [
        [[one["points"][0], one["points"][-1]] for level in levels for one in level]
        for levels in cut
    ]
    assert ends[0] and np.shape(ends[0]) == np.shape(ends[1])
    assert np.abs(np.subtract(*ends)).max() < 3.0 * region.FINE  # as finely as is looked at
