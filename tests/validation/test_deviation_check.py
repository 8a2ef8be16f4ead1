"""The deviation of the closed ground mesh, told by other programs from the CAD."""

import shutil

import deviation_bench
import numpy as np
import pytest
from test_ground_mesh import block_job

import beltgrinding
from beltgrinding.inspection import closed_mesh


AGREEMENT = 0.002  # mm, root mean square, on smooth areas

needs_cloudcompare = pytest.mark.skipif(
    deviation_bench.CLOUDCOMPARE is None or shutil.which("xvfb-run") is None,
    reason="cloudcompare or xvfb is not installed",
)


@pytest.fixture(scope="module")
def result():
    return beltgrinding.run(block_job())


@needs_cloudcompare
def test_cloudcompare_finds_the_same_deviation(result, tmp_path):
    mesh = beltgrinding.ground_mesh(result)
    ground = np.flatnonzero(mesh.standing == closed_mesh.STANDING.index("ground"))
    chosen = deviation_bench.smooth(result, mesh, mesh.vertices, ground)
    assert len(chosen) > 0.5 * len(ground)
    deviation_bench.cad_mesh(result, 0.5, tmp_path / "cad.stl")
    points = mesh.vertices[chosen]
    _, told = deviation_bench.cloudcompare(points, tmp_path / "cad.stl", tmp_path)
    truth = mesh.deviation[chosen].astype(float)
    assert truth.max() - truth.min() > 0.03  # a ground track, not a constant
    assert deviation_bench.difference(told, truth)["rms_mm"] < AGREEMENT


def test_inspection_finds_the_same_deviation(result, tmp_path, freecad):
    result.write(tmp_path / "out")
    figures = freecad.call(inspected, tmp_path / "out")
    assert figures["inspection"]["points"] == 100 and figures["inspection"]["lost"] == 0
    assert figures["inspection"]["rms_mm"] < AGREEMENT
    assert figures["ours"]["rms_mm"] < AGREEMENT


def inspected(folder):
    deviation_bench.CLOUDCOMPARE = None
    deviation_bench.INSPECTED = 100
    return deviation_bench.compare(str(folder))
