"""The coarse resolution: what it changes, that its figures are named so, and plans that search with it."""

import copy
import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.engine import InputError
from beltgrinding.inspection import verdict as verdicts
from beltgrinding.job import load as jobs, resolution
from beltgrinding.planning import rounds
from beltgrinding.reporting import report
from beltgrinding.simulation import convergence
from beltgrinding.simulation.result import Result
from test_job import plate_job


def job_of(mode="coarse", spacing=0.3):
    job = plate_job()
    job["sampling"]["spacing_mm"] = spacing
    job["resolution"] = {"mode": mode}
    return job


@pytest.fixture(scope="module")
def coarse():
    return beltgrinding.run(job_of())


def test_samples_lie_apart_as_the_same_cells_of_the_contact_allow(coarse):
    full = beltgrinding.run(job_of("full"))
    assert coarse.summary["spacing_mm"] == pytest.approx(0.6)
    assert coarse.job["belt_machine"]["contact_tolerance"] == resolution.TOLERANCE
    assert full.summary["spacing_mm"] == 0.3
    assert coarse.summary["samples"] < 0.3 * full.summary["samples"]
    assert coarse.summary["steps"] == pytest.approx(0.5 * full.summary["steps"], rel=0.05)
    removed = [one.summary["removed_volume_mm3"] for one in (coarse, full)]
    assert removed[0] == pytest.approx(removed[1], rel=0.02) and removed[0] > 1.0


def test_deep_cuts_are_followed_as_exactly_as_contacts_are_solved():
    left = {}
    for tolerance in (1e-4, 1e-3, 1e-2):
        job = plate_job()
        job["sampling"]["spacing_mm"] = 0.6
        job["belt_machine"]["contact_tolerance"] = tolerance
        job["law"] = {"coefficient_mm2_per_N": 1e-3}  # as deep in a step as the wheel is pressed in
        left[tolerance] = beltgrinding.run(job).field.height.astype(float)
    removed = np.nansum(left[1e-4].max() - left[1e-4])
    off = {one: np.nansum(abs(left[one] - left[1e-4])) / removed for one in (1e-3, 1e-2)}
    assert off[1e-3] < 1e-3 < off[1e-2] < 1e-2, off


def test_what_is_coarser_already_stays_so():
    job = jobs.validate(job_of(spacing=0.9))
    job["belt_machine"]["contact_tolerance"] = 0.05
    told = []
    applied = resolution.applied(job, told)
    assert applied["sampling"] == job["sampling"] and len(told) == 1
    assert applied["belt_machine"] == job["belt_machine"]
    assert applied["simulation"]["max_travel_mm"] == resolution.TRAVEL
    assert resolution.applied({**job, "heat": {}}, [])["simulation"] == job["simulation"]
    job["simulation"].update(max_travel_mm=3.0, max_angle_deg=4.0)
    assert resolution.applied(job, [])["simulation"] == job["simulation"]
    job["sampling"].update(spacing_mm=0.3, precision_mm=0.01, edge_spacing_mm=0.05)
    sampling = resolution.applied(job, told)["sampling"]
    assert sampling["precision_mm"] == pytest.approx(0.04)
    assert sampling["edge_spacing_mm"] == pytest.approx(0.1)
    full = resolution.with_mode(job, "full")
    assert resolution.applied(full, told) is full and len(told) == 2


def test_its_figures_are_named_wherever_they_show(coarse, tmp_path, capsys):
    assert coarse.summary["resolution"] == coarse.verdict["resolution"] == "coarse"
    assert any("coarse resolution" in warning for warning in coarse.summary["warnings"])
    assert "(coarse resolution" in verdicts.text(coarse.verdict).splitlines()[0]
    coarse.write(tmp_path / "out")
    again = Result.read(tmp_path / "out")
    assert again.verdict["resolution"] == again.summary["resolution"] == "coarse"
    assert verdicts.of_result(again)["resolution"] == "coarse"
    page = tmp_path / "report.html"
    report.report(again, page)
    assert "(coarse resolution, for searching)" in page.read_text()
    (tmp_path / "job.json").write_text(json.dumps(job_of()))
    assert cli.main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "cli")]) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith("coarse: ") and "coarse resolution" in printed.out
    assert "coarse resolution" in printed.err


def test_a_full_run_says_nothing_of_it():
    result = beltgrinding.run(job_of("full"))
    assert result.summary["resolution"] == result.verdict["resolution"] == "full"
    assert "coarse" not in verdicts.text(result.verdict)
    assert not any("coarse resolution" in warning for warning in result.summary["warnings"])


def test_a_result_of_an_older_version_is_full(coarse, tmp_path):
    job = copy.deepcopy(coarse.job)
    del job["resolution"]
    assert resolution.mode(job) == "full"


def test_the_settings_of_a_coarse_job_are_not_checked():
    with pytest.raises(InputError, match="resolution.mode: a coarse job") as refused:
        convergence.converge(jobs.validate(job_of()))
    assert refused.value.code == "simulation.coarse_check"


@pytest.fixture(scope="module")
def planned():
    told = []
    settings = {"rounds": 2, "check": False, "search_resolution": "coarse"}
    return rounds.plan(jobs.validate(job_of("full")), settings, told=told.append), told


def test_a_plan_that_searches_coarsely_tells_figures_of_the_full_resolution(planned):
    plan, told = planned
    modes = [one["resolution"] for one in told]
    assert modes[-2:] == ["full", "full"] and set(modes[:-2]) == {"coarse"} and told == plan.rounds
    for result in (plan.before, plan.after):
        assert result.summary["resolution"] == "full" and result.summary["spacing_mm"] == 0.3
    assert plan.job["resolution"]["mode"] == "full"
    alone = beltgrinding.run(plan.job)
    assert np.array_equal(alone.field.height, plan.after.field.height)
    summary = rounds.summary(plan)
    assert summary["before"]["in_tolerance"] == told[-2]["in_tolerance"]
    assert summary["after"]["rms_mm"] <= summary["before"]["rms_mm"]


def test_the_rounds_say_that_they_are_coarse(planned, capsys):
    from beltgrinding.cli.rounds_table import Table

    table = Table()
    for one in planned[1]:
        table.told(one)
    _, first, *_, last = capsys.readouterr().out.splitlines()
    assert first.endswith("  coarse") and "coarse" not in last


def test_a_coarse_job_is_planned_in_full():
    plan = rounds.plan(jobs.validate(job_of("coarse", 0.8)), {"rounds": 1, "check": False})
    assert {one["resolution"] for one in plan.rounds} == {"full"}
