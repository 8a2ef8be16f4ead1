"""Whether a job's settings are fine enough; and that the same job gives the same bytes."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import jsonschema
import beltgrinding
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.simulation import convergence, convergence_record, run as runs
from beltgrinding.job import tolerances, load as jobs
from beltgrinding.inspection import picture
from beltgrinding.simulation import result as results
from beltgrinding.base import schemas
from test_job import plate_job
from support.results import unseal

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    monkeypatch.setattr(picture, "PIXELS", 60000)
    monkeypatch.setattr(picture, "CLOSE_WIDTH", 160)
    monkeypatch.setattr(picture, "CLOSE_HEIGHT", 120)


@pytest.mark.parametrize("order", [0.7, 1.0, 2.0])
def test_a_power_law_comes_back_with_its_order_and_its_error(order):
    def figure(h):
        return 0.3 - 0.05 * h**order

    found = convergence.estimate(figure(2.0), figure(1.0), figure(0.5))
    assert found["behaviour"] == "monotonic"
    assert found["order"] == pytest.approx(order)
    assert found["error"] == pytest.approx(convergence.SAFETY * 0.05)


def test_an_order_by_chance_is_not_believed():
    quick = convergence.estimate(0.0, 1.0, 1.001)
    assert quick["order"] > 9 and quick["error"] == pytest.approx(1.25 * 0.001 * 4 / 3)
    slow = convergence.estimate(0.0, 1.0, 1.99)
    assert slow["order"] < 0.1 and slow["error"] == pytest.approx(
        1.25 * 0.99 * 2**0.5 / (2**0.5 - 1)
    )


@pytest.mark.parametrize(
    "values, behaviour, error",
    [
        ((1.0, 2.0, 1.6), "oscillating", 1.0),
        ((1.0, 1.2, 2.0), "diverging", 1.0),
        ((1.0, 1.2, 0.5), "diverging", 0.7),
        ((1.0, 1.0, 1.3), "diverging", 0.3),
        ((1.0, 1.0, 1.0), "exact", 0.0),
        ((None, 1.0, 1.1), "two levels", 0.6),
        ((1.0, 1.1, None), "two levels", 0.3),
        ((None, 1.0, None), "unknown", None),
    ],
)
def test_what_does_not_settle_evenly_has_its_range(values, behaviour, error):
    found = convergence.estimate(*values)
    assert found["behaviour"] == behaviour and found["order"] is None
    assert found["error"] == pytest.approx(error)


def test_levels_change_all_settings_or_one():
    job = jobs.validate(plate_job())
    fine, step = convergence.scaled(job, "fine"), convergence.scaled(job, "coarse", "step")
    assert fine["sampling"]["spacing_mm"] == 0.3 and job["sampling"]["spacing_mm"] == 0.6
    assert fine["simulation"]["max_angle_deg"] == 0.5 * job["simulation"]["max_angle_deg"]
    assert fine["belt_machine"]["contact_spacing_mm"] == 0.5
    assert step["simulation"]["max_travel_mm"] == 2.0 and step["sampling"] == job["sampling"]
    assert convergence.scaled(job, "given") == job


@pytest.fixture(scope="module")
def converged():
    job = plate_job()
    job["belt_machine"]["wheel"]["crown_radius_mm"] = 40
    job["inspection"] = {"tolerance_mm": [-0.4, 0.4]}
    return convergence.converge(jobs.validate(job))


def test_the_answer_covers_the_truth(converged):
    answer = converged.convergence
    jsonschema.validate(answer, schemas.schema("convergence"))
    by_name = {(one["name"], one["face"]): one for one in answer["quantities"]}
    volume = by_name["removed_volume", None]
    exact = 1.25e-4 * 20000.0 * 30.0 * 40.0 / 30.0  # K V_b F t
    assert abs(volume["values"][1] - exact) <= volume["error"] + 1e-3 * exact
    assert volume["limit"] == pytest.approx(0.01 * volume["values"][1])
    assert by_name["mean", None]["limit"] == pytest.approx(0.08)  # a tenth of the band
    deepest = by_name["face_min", 1]
    assert deepest["values"] == by_name["min", None]["values"]
    finer = runs.run(convergence.scaled(convergence.scaled(converged.job, "fine"), "fine"))
    assert abs(deepest["values"][1] - finer.summary["deviation_mm"]["min"]) <= deepest["error"]
    assert answer["levels"]["given"]["samples"] == converged.summary["samples"]
    assert answer["levels"]["fine"]["steps"] > 1.9 * converged.summary["steps"]
    assert answer["fine_enough"] and answer["settings"] is None
    assert converged.field.spacing == pytest.approx(0.6)  # the result is that of the job as given


def test_errors_of_samples_are_those_of_figures():
    values = np.array(
        [
            (1.0, 1.1, 1.15),
            (1.0, 1.1, 1.16),
            (1.0, 1.1, 1.05),
            (1.0, 1.1, 1.3),
            (1.0, 1.0, 1.0),
            (1.2, 1.1, 1.1),
        ]
    )
    levels = (*values.T,)
    for given in (levels, (None, *levels[1:]), (*levels[:2], None)):
        wanted = [
            convergence.estimate(*(None if level is None else level[k] for level in given))["error"]
            for k in range(len(values))
        ]
        assert convergence.errors(*given) == pytest.approx(wanted)
    assert convergence.errors(None, levels[1], None) is None


def test_a_level_of_other_samples_gives_no_errors(monkeypatch):
    def elsewhere(*_):
        raise InputError("stock: 9 of 10 samples lie where the earlier run ground nothing")

    monkeypatch.setattr(core, "apply_left", elsewhere)
    answer = convergence.converge(jobs.validate(plate_job())).convergence
    assert answer["samples"] is None and answer["quantities"]
    jsonschema.validate(answer, schemas.schema("convergence"))


def test_errors_of_samples_cover_the_truth(converged):
    told = converged.convergence["samples"]
    assert 0.0 < told["p50_mm"] < told["p95_mm"] < told["p99_mm"] < told["max_mm"]
    finer = runs.run(convergence.scaled(convergence.scaled(converged.job, "fine"), "fine"))
    field = converged.field
    truth = field.copy()
    core.apply_left(truth, finer.field, False, core.RunContext())
    off = abs(np.asarray(truth.height) - np.asarray(field.height))
    for key, share in (("p50_mm", 0.5), ("p95_mm", 0.95), ("p99_mm", 0.99)):
        areas = np.asarray(field.areas)
        assert areas[off <= told[key]].sum() >= 0.97 * share * areas.sum(), key
    # The plate is ground well within its tolerance: the errors leave nothing open.
    assert told["undecided_share"] == 0.0
    lower = float(np.median(field.height))
    narrow = dict(
        converged.job, inspection={**converged.job["inspection"], "tolerance_mm": [lower, 0.4]}
    )
    answer = convergence.converge(jobs.validate(narrow)).convergence
    assert 0.0 < answer["samples"]["undecided_share"] < 1.0


def test_settings_that_are_too_coarse_are_told_with_the_one_to_refine():
    job = plate_job()
    job["belt_machine"]["wheel"]["crown_radius_mm"] = 40
    job["inspection"] = {"tolerance_mm": [-1e-4, 1e-4]}
    job["simulation"] = {"max_travel_mm": 8.0}
    answer = convergence.converge(jobs.validate(job)).convergence
    assert not answer["fine_enough"]
    assert set(answer["settings"]) == set(convergence.SETTINGS)
    assert answer["settings"]["step"] == max(answer["settings"].values()) > 0
    bad = convergence_record.worst(answer)
    assert not bad["ok"] and bad["error"] > bad["limit"]


def test_a_level_that_cannot_be_run_is_said(monkeypatch):
    run = runs.run

    def refuse(job, context=None, recording=None, **options):
        if job["sampling"]["spacing_mm"] < 0.5:
            raise InputError("sampling.spacing_mm: too many samples")
        return run(job, context, recording, **options)

    monkeypatch.setattr(runs, "run", refuse)
    answer = convergence.converge(jobs.validate(plate_job())).convergence
    assert answer["levels"]["fine"] is None
    assert any("too many samples" in note for note in answer["notes"])
    assert {one["behaviour"] for one in answer["quantities"]} <= {"two levels"}
    jsonschema.validate(answer, schemas.schema("convergence"))


def test_it_can_be_cancelled():
    context = core.RunContext()
    context.cancel()
    with pytest.raises(Cancelled):
        convergence.converge(jobs.validate(plate_job()), context)


def test_the_narrowest_band_counts():
    inspection = {"tolerance_mm": [-0.1, 0.1]}
    assert tolerances.narrowest_band(inspection) == (-0.1, 0.1)
    inspection["zones"] = [{"tolerance_mm": [0, 0.05]}, {"thickness_mm": [0, 0.01]}]
    assert tolerances.narrowest_band(inspection) == (0, 0.05)


def test_another_tolerance_is_judged_without_another_run(converged):
    narrow = convergence_record.assessed(converged.convergence, {"tolerance_mm": [-1e-6, 1e-6]})
    samples = converged.convergence["samples"]
    assert narrow["samples"] == {**samples, "undecided_share": None}
    zoned = {**converged.job["inspection"], "zones": [{"faces": [1], "tolerance_mm": [0, 1]}]}
    zoned = convergence_record.assessed(converged.convergence, zoned)
    assert zoned["samples"]["undecided_share"] is None
    assert converged.convergence["fine_enough"] and not narrow["fine_enough"]
    names = {one["name"] for one in narrow["quantities"]}
    assert "mean" in names and "in_tolerance" not in names
    assert narrow["quantities"][1]["limit"] == pytest.approx(2e-7)
    wide = convergence_record.assessed(narrow, converged.job["inspection"])
    assert all(one["ok"] for one in wide["quantities"])
    job = dict(converged.job, inspection={"tolerance_mm": [0, 1]})
    assert convergence_record.digest(job) == convergence_record.digest(converged.job)


def test_the_report_shows_it_where_it_belongs(converged, tmp_path):
    converged.write(tmp_path / "out")
    read = results.Result.read(tmp_path / "out")
    assert read.convergence == json.loads((tmp_path / "out" / "convergence.json").read_text())
    html = beltgrinding.report(tmp_path / "out").read_text()
    assert "Yes: because of them no depth is off" in html and "twice as fine" in html
    assert "Ja: Keine Tiefe" in beltgrinding.report(tmp_path / "out", language="de").read_text()
    unseal(tmp_path / "out")
    other = dict(read.convergence, job_sha256="0" * 64)
    (tmp_path / "out" / "convergence.json").write_text(json.dumps(other))
    assert results.Result.read(tmp_path / "out").convergence is None
    (tmp_path / "out" / "convergence.json").write_text("{}")
    with pytest.raises(InputError, match="convergence.json"):
        results.Result.read(tmp_path / "out")
    runs.run(converged.job).write(tmp_path / "out")  # a run leaves none of an older one
    assert not (tmp_path / "out" / "convergence.json").exists()


def cli(*arguments, cwd, **environment):
    folders = [str(ROOT / "Mod" / "BeltGrinding"), str(Path(core.__file__).parent)]
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(folders), **environment},
        capture_output=True,
        text=True,
    )


def test_command_line_says_whether_the_settings_are_fine(tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(plate_job()))
    done = cli("converge", "job.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    answer = json.loads((tmp_path / "out" / "convergence.json").read_text())
    assert done.stdout.startswith("Yes" if answer["fine_enough"] else "No")
    assert (tmp_path / "out" / "summary.json").is_file()


# The same bytes.

WALL_TIMES = ("wall_time_s", "sha256")
ONE_RUN = """
import sys, json
import beltgrinding
from beltgrinding import core
core.set_threads(int(sys.argv[3]))
beltgrinding.run(sys.argv[1]).write(sys.argv[2])
"""


def process_job():
    """A job in which all parts of the engine take part: a mesh stock with holes and steps, two programs,
    a crowned wheel, a calibrated law with its uncertainty, trapezoidal timing, heat events.
    """
    job = plate_job()
    job["law"] = {
        "model": "local",
        "pressure_exponent": 0.9,
        "heat_limit_MPa_m_s": 1.0,
        "calibration": {
            "parameters": ["coefficient", "pressure_exponent"],
            "covariance": [[0.01, 0.001], [0.001, 0.004]],
            "scatter": 0.05,
        },
        "wear": {"model": "exponential", "scale": 1e4},
    }
    job["belt_machine"]["wheel"]["crown_radius_mm"] = 50
    job["simulation"] = {"timing": "trapezoidal"}
    second = {
        "poses": [dict(pose, y_mm=28, x_mm=pose["x_mm"]) for pose in job["programs"][0]["poses"]]
    }
    job["programs"].append(second)
    return job


def contents(folder):
    """{name: bytes} of a result's files, wall times taken out."""
    found = {path.name: path.read_bytes() for path in folder.iterdir()}
    summary = json.loads(found["summary.json"])
    for name in WALL_TIMES:
        del summary[name]
    found["summary.json"] = json.dumps(summary, sort_keys=True).encode()
    return found


@pytest.mark.slow
def test_the_same_job_gives_the_same_bytes(tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(process_job()))
    folders = [str(ROOT / "Mod" / "BeltGrinding"), str(Path(core.__file__).parent)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folders)}
    runs = {}
    for name, threads in (("one", 1), ("two", 2), ("again", 2)):
        done = subprocess.run(
            [sys.executable, "-c", ONE_RUN, "job.json", name, str(threads)],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        runs[name] = contents(tmp_path / name)
    expected = {"summary.json", "events.json", "steps.csv", "deviation.ply", "heightfield.h5"}
    assert expected <= runs["one"].keys() == runs["two"].keys() == runs["again"].keys()
    assert json.loads(runs["one"]["events.json"])  # there is something to be compared
    for name, data in runs["one"].items():
        assert data == runs["two"][name], f"{name}: 2 threads differ from 1"
        assert data == runs["again"][name], f"{name}: two runs differ"


def test_the_report_has_the_same_bytes_too(converged, tmp_path):
    for name in ("a", "b"):
        beltgrinding.report(converged, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_the_pictures_do_not_depend_on_threads(converged):
    views = []
    for threads in (1, 2):
        core.set_threads(threads)
        colours = core.deviation_colours(converged.field, -0.1, 0.1, 0.5)
        views.append(picture.Studio(converged.field, colours).both()[0].pixels)
    core.set_threads(0)
    np.testing.assert_array_equal(*views)
