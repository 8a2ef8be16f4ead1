"""Plans with scans of raw parts as stock: laid on the design, one part or many."""

import csv
import json

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.base import frames
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, poses
from beltgrinding.raster import raster_path
from beltgrinding.scan import stock as scan_stock
from beltgrinding.simulation import run as runs
from test_ground_mesh import block_job
from test_scan import motion, pytestmark  # noqa: F401

QUICK = ["--set", "check=false", "--set", "rounds=2", "-q"]
MOVED = motion((0.3, 0.2, 1.0), 1.2, (0.8, -0.5, 0.4))  # scan from work


def raw(wave, matrix=np.eye(4)):
    """(points, triangles) of the block with stock of ``wave(x, y)`` mm on its top, moved."""
    x, y = np.meshgrid(np.linspace(0, 60, 121), np.linspace(0, 40, 81))
    top = np.stack([x, y, wave(x, y)], -1)
    bottom = np.stack([x, y, np.full_like(x, -12.0)], -1)
    sheets = [(top, False), (bottom, True)]
    for edge, turned in (((0, slice(None)), False), ((-1, slice(None)), True)):
        sheets.append((_wall(bottom[edge], top[edge]), turned))
    for edge, turned in (((slice(None), 0), True), ((slice(None), -1), False)):
        sheets.append((_wall(bottom[edge], top[edge]), turned))
    points, triangles = [], []
    for grid, turned in sheets:
        k = np.arange(grid.shape[0] * grid.shape[1]).reshape(grid.shape[:2]) + sum(map(len, points))
        a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]
        some = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
        triangles.append(some[:, ::-1] if turned else some)
        points.append(grid.reshape(-1, 3))
    points = np.concatenate(points) @ matrix[:3, :3].T + matrix[:3, 3]
    return points, np.concatenate(triangles)


def _wall(lower, upper):
    share = np.linspace(0.0, 1.0, 25)[:, None, None]
    return lower[None] + share * (upper - lower)[None]


def ply(path, points, triangles):
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.zeros(len(triangles), dtype=[("n", "u1"), ("k", "<i4", 3)])
    rows["n"], rows["k"] = 3, triangles
    path.write_bytes(head.encode() + points.astype("<f4").tobytes() + rows.tobytes())
    return path


def wave(amplitude, length=40.0):
    return lambda x, y: 0.25 + amplitude * np.sin(2 * np.pi * x / length) + 0.0 * y


@pytest.fixture(scope="module")
def given():
    """A job as a dict: the block's top with a raster along x."""
    job = block_job()
    job["sampling"] = {"spacing_mm": 1.0}
    job["belt_machine"]["wheel"] = {"radius_mm": 30, "width_mm": 15, "crown_radius_mm": 80}
    job["cell"] = {"check_collisions": False}
    along = {"along": "direction", "direction": [1.0, 0.0, 0.0], "max_distance_mm": 4.0}
    laid = raster_path.raster(jobs.validate({**job, "programs": [{"poses": []}]}), along)
    job["programs"] = [{"name": "pass", "poses": poses.list_poses(laid)}]
    return job


def test_a_scan_is_laid_on_what_is_not_ground(given, tmp_path):
    file = ply(tmp_path / "part.ply", *raw(wave(0.1), MOVED))
    job, found = scan_stock.as_stock(jobs.validate(given), file)
    assert job["stock"]["kind"] == "mesh" and found["converged"]
    matrix = frames.from_data(job["stock"]["placement"])
    assert np.allclose(matrix @ MOVED, np.eye(4), atol=0.02), matrix @ MOVED
    field = runs.run(job).field
    x, y = np.asarray(field.points)[:, :2].T
    expected, inside = wave(0.1)(x, y), (abs(x - 30.0) < 28.0) & (abs(y - 20.0) < 18.0)
    assert np.abs(np.asarray(field.stock_height)[inside] - expected[inside]).max() < 0.02


def test_what_is_ground_is_no_datum_and_a_cloud_no_stock(given, tmp_path):
    file = ply(tmp_path / "part.ply", *raw(wave(0.1)))
    job = jobs.validate(given)
    with pytest.raises(InputError, match="part.ply.*stock would be lost"):
        scan_stock.as_stock(job, file, datum_faces=job["design"]["faces"])
    placed, found = scan_stock.as_stock(job, file, aligned=True)
    assert found is None and np.allclose(frames.from_data(placed["stock"]["placement"]), np.eye(4))
    (tmp_path / "cloud.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    with pytest.raises(InputError, match="cloud.xyz.*mesh it first"):
        scan_stock.as_stock(job, tmp_path / "cloud.xyz")
    with pytest.raises(InputError, match="none.ply"):
        scan_stock.as_stock(job, tmp_path / "none.ply")


@pytest.mark.slow
def test_each_part_of_a_batch_gets_its_own_program(given, tmp_path, capsys):
    (tmp_path / "job.json").write_text(json.dumps(given))
    scans = [
        ply(tmp_path / "a.ply", *raw(wave(0.12), MOVED)),
        ply(tmp_path / "b.ply", *raw(wave(0.12, -40.0), MOVED)),  # the other way round
    ]
    begin = ["plan", str(tmp_path / "job.json"), "-o", str(tmp_path / "out"), *QUICK]
    stocks = [word for scan in scans for word in ("--stock", str(scan))]
    assert cli.main([*begin, *stocks]) == 0
    rows = list(csv.DictReader((tmp_path / "out" / "parts.csv").read_text().splitlines()))
    assert [row["folder"] for row in rows] == ["a", "b"]
    assert all(float(r["in_tolerance"]) > float(r["before_in_tolerance"]) + 0.1 for r in rows), rows
    assert all(row["trusted"] in ("True", "False") and not row["error"] for row in rows)
    feeds = [
        [
            p["feed_mm_s"]
            for p in json.loads((tmp_path / "out" / n / "job.json").read_text())["programs"][0][
                "poses"
            ]
        ]
        for n in "ab"
    ]
    assert feeds[0] != feeds[1]
    # The plan of one is not that of the other.
    capsys.readouterr()
    out = tmp_path / "one"
    assert cli.main([*begin[:3], str(out), *QUICK, "--stock", str(scans[0])]) == 0
    assert (
        json.loads((out / "plan.json").read_text()) is not None and not (out / "parts.csv").exists()
    )


def test_a_part_that_fails_stops_no_other(given, tmp_path, capsys):
    (tmp_path / "job.json").write_text(json.dumps(given))
    good = ply(tmp_path / "a.ply", *raw(wave(0.1)))
    (tmp_path / "bad.ply").write_bytes(b"ply\nno")
    begin = ["plan", str(tmp_path / "job.json"), "-o", str(tmp_path / "out"), *QUICK, "--aligned"]
    assert cli.main([*begin, "--stock", str(tmp_path / "bad.ply"), "--stock", str(good)]) == 2
    assert "1 of 2 parts could not be planned" in capsys.readouterr().err
    rows = list(csv.DictReader((tmp_path / "out" / "parts.csv").read_text().splitlines()))
    assert "bad.ply" in rows[0]["error"] and not rows[1]["error"]
    assert (tmp_path / "out" / "a" / "plan.json").exists()
