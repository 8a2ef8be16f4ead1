"""A run whose stock is what an earlier run left."""

import copy

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.simulation import convergence
from beltgrinding.simulation.result import Result
from test_finish import crossing_job
from test_job import plate, plate_job


def halves(job):
    """The job's two programs as jobs of their own."""
    return [{**copy.deepcopy(job), "programs": [program]} for program in job["programs"]]


@pytest.fixture(scope="module")
def in_turn(tmp_path_factory):
    """(both programs in one run, the first run's folder, the second run, which begins with it)."""
    folder = tmp_path_factory.mktemp("first")
    job = crossing_job()
    first, second = halves(job)
    beltgrinding.run(first).write(folder)
    second["stock"]["left_by"] = str(folder / "heightfield.h5")
    return beltgrinding.run(job), folder, beltgrinding.run(second)


def test_two_jobs_in_turn_grind_as_one_with_two_programs(in_turn):
    both, _, second = in_turn
    assert np.allclose(second.field.height, both.field.height, atol=1e-9)
    ground = np.asarray(both.field.trace["last"]) > 1  # by the second program
    ground &= np.asarray(both.field.trace["last"]) < 1000
    assert ground.any()
    assert np.array_equal(second.field.trace["last"][ground] + 2, both.field.trace["last"][ground])
    for name in ("settled", "unknown", "lay", "passes", "crossing"):
        assert np.allclose(
            second.field.finish[name], both.field.finish[name], atol=1e-6, equal_nan=True
        ), name
    assert second.verdict["in_share"] == pytest.approx(both.verdict["in_share"], abs=1e-6)


def test_it_keeps_the_stock_before_all_grinding_and_says_by_which_file(in_turn):
    both, folder, second = in_turn
    assert np.array_equal(second.field.stock_height, both.field.stock_height)
    assert any(one["what"] == "stock.left_by" for one in second.summary["inputs"])
    found = (one.summary["removed_volume_mm3"] for one in (second, both))
    assert next(found) == pytest.approx(next(found), rel=1e-9)
    assert Result.read(folder).summary["removed_volume_mm3"] < both.summary["removed_volume_mm3"]


def test_samplings_may_differ(in_turn):
    _, folder, second = in_turn
    job = copy.deepcopy(second.job)
    finer = beltgrinding.run(convergence.scaled(job, "fine"))
    assert finer.field.size > 2 * second.field.size
    for name in ("mean", "p05", "p50", "p95"):
        found, before = (one.summary["deviation_mm"][name] for one in (finer, second))
        assert found == pytest.approx(before, abs=0.004), name


def test_another_part_or_no_file_is_refused(in_turn, tmp_path):
    _, folder, _ = in_turn
    job = plate_job()
    job["design"] = {"brep": plate(90.0, 60.0).write_brep()}
    job["stock"]["left_by"] = str(folder / "heightfield.h5")
    with pytest.raises(InputError, match="another design"):
        beltgrinding.run(job)
    job["stock"]["left_by"] = str(tmp_path / "none.h5")
    with pytest.raises(InputError, match="none.h5"):
        beltgrinding.run(job)


@pytest.mark.parametrize(
    "given, key",
    [
        ({"offset_mm": 0.2}, "stock.offset_mm"),
        ({"placement": {"position_mm": [1.0, 0.0, 0.0]}}, "stock.placement"),
    ],
)
def test_what_was_left_is_not_moved(in_turn, given, key):
    _, _, second = in_turn
    job = copy.deepcopy(second.job)
    job["stock"].update(given)
    with pytest.raises(InputError, match=key):
        beltgrinding.run(job)
    at_rest = {"position_mm": [0.0, 0.0, 0.0]}
    job["stock"].update(offset_mm=0.0, placement=at_rest)
    beltgrinding.run(job)


def test_its_path_is_relative_to_the_job(tmp_path):
    job = {**plate_job(), "stock": {"left_by": "stage_1/result/heightfield.h5"}}
    found = jobs.validate(job, tmp_path)["stock"]["left_by"]
    assert found == str(tmp_path / "stage_1/result/heightfield.h5")
