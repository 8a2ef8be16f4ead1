"""The law of removal of a job: exponents, curves, belt wear, heat, uncertainty."""

import json
import math

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding import cli
from beltgrinding.job import law as laws
from beltgrinding.simulation.result import Result
from test_job import plate_job


def run(**law):
    job = plate_job()
    job["law"] = law
    return beltgrinding.run(job)


def removed(result):
    return result.summary["removed_volume_mm3"]


def test_local_law_with_its_defaults_is_the_linear_one():
    assert removed(run(model="local")) == pytest.approx(removed(run()), rel=1e-9)
    faster = run(model="local", speed_exponent=1.5, reference_speed_m_s=10)
    assert removed(faster) == pytest.approx(math.sqrt(2) * removed(run()), rel=0.03)


def test_curves_come_in_the_jobs_units():
    flat = {"speed_curve": [[10, 0.5], [30, 1.5]], "feed_curve": [[1, 1.0], [200, 1.0]]}
    result = run(model="local", **flat)
    assert removed(result) == pytest.approx(removed(run()), rel=1e-6)
    assert "law_out_of_range" not in result.summary["events"]
    result = run(model="local", speed_curve=[[25, 1.0], [30, 1.2]])
    assert result.summary["events"]["law_out_of_range"] == 1
    assert "20 m/s lies outside the measured 25 to 30 m/s" in result.events[0]["message"]
    with pytest.raises(InputError, match="pressure_curve: a curve needs"):
        run(model="local", pressure_curve=[[1, 1]])


def test_geometric_law_cuts_all_that_the_envelope_meets():
    job = plate_job()
    job["law"] = {"model": "geometric"}
    job["belt_machine"]["control"] = "position"
    for pose in job["programs"][0]["poses"]:
        pose["z_mm"] = 0.05
    height = np.asarray(beltgrinding.run(job).field.height)
    assert height.min() == pytest.approx(0.05, abs=0.005)
    job["belt_machine"]["compliance"] = {"model": "geometric"}
    job["law"] = {}
    assert np.array_equal(np.asarray(beltgrinding.run(job).field.height), height)


def test_geometric_law_needs_position_control():
    with pytest.raises(InputError, match="set the control to position"):
        run(model="geometric")


def test_heat_is_an_event():
    result = run(heat_limit_MPa_m_s=0.5)
    event = next(e for e in result.events if e["kind"] == "burn_risk")
    assert event["value"] > 0.5 and "above the limit of 0.5" in event["message"]
    assert "burn_risk" not in run(heat_limit_MPa_m_s=100).summary["events"]


def test_the_belts_use_goes_from_program_to_program_and_job_to_job(tmp_path):
    once = run().summary["belt"]
    assert once["remaining_cut"] == 1.0 and once["work_J"] > 0
    job = plate_job()
    job["law"] = {"wear": {"model": "exponential", "scale": once["work_J"]}}
    job["programs"] = 2 * job["programs"]
    both = beltgrinding.run(job).summary["belt"]
    assert both["work_J"] == pytest.approx(2 * once["work_J"], rel=0.02)
    assert both["remaining_cut"] == pytest.approx(math.exp(-2), rel=0.03)

    job["programs"] = job["programs"][:1]
    (tmp_path / "job.json").write_text(json.dumps(job))
    arguments = ["run", str(tmp_path / "job.json"), "-q", "--belt", str(tmp_path / "belt.json")]
    volumes = []
    for name in ("a", "b"):
        assert cli.main([*arguments, "-o", str(tmp_path / name)]) == 0
        summary = json.loads((tmp_path / name / "summary.json").read_text())
        volumes.append(summary["removed_volume_mm3"])
    belt = json.loads((tmp_path / "belt.json").read_text())
    assert belt["work_J"] == pytest.approx(both["work_J"], rel=1e-6)
    assert volumes[1] == pytest.approx(volumes[0] / math.e, rel=0.03)
    (tmp_path / "belt.json").write_text('{"work_J": -1}')
    assert cli.main([*arguments, "-o", str(tmp_path / "c")]) == 2


CALIBRATION = {
    "parameters": ["coefficient", "pressure_exponent"],
    "covariance": [[0.01, 0.0], [0.0, 0.0]],
    "scatter": 0.0,
}


def test_a_calibrated_law_gives_every_deviation_its_standard_deviation(tmp_path):
    result = run(model="local", calibration=CALIBRATION)
    field = result.field
    depth = np.asarray(field.stock_height) - np.asarray(field.height)
    assert np.allclose(field.height_sd, 0.105 * depth, atol=0.02 * depth.max())
    assert result.summary["deviation_sd_mm"]["p95"] > result.summary["deviation_sd_mm"]["mean"] > 0
    share = result.summary["expected_in_tolerance_area_share"]
    assert 0 < share < 1
    result.write(tmp_path)
    again = Result.read(tmp_path)
    assert np.array_equal(again.field.height_sd, field.height_sd)
    colours = core.uncertainty_colours(again.field, 0.01)
    assert len(set(colours.tolist())) > 5
    with pytest.raises(InputError, match="not calibrated"):
        core.uncertainty_colours(run().field, 0.01)


def test_a_law_from_the_calibration_predicts_and_grinds_a_job(tmp_path, capsys):
    random = np.random.default_rng(7)
    rows = ["force_N,belt_speed_m_s,time_s,area_mm2,work_J,removed_volume_mm3"]
    for _ in range(40):
        force, speed, area = (
            random.uniform(10, 60),
            random.uniform(12, 30),
            random.uniform(100, 400),
        )
        time, work = random.uniform(5, 30), random.uniform(0, 2e5)
        pressure = (force / area / 0.1) ** 1.3
        rate = 1.25e-4 * (0.5 + 0.5 * math.exp(-work / 5e4)) * speed * 1000 * 0.1 * pressure
        volume = rate * area * time * random.lognormal(0, 0.05)
        rows.append(f"{force},{speed},{time},{area},{work},{volume}")
    (tmp_path / "grinds.csv").write_text("\n".join(rows) + "\n")
    arguments = ["calibrate", str(tmp_path / "grinds.csv"), "-o", str(tmp_path / "law.json")]
    assert cli.main(arguments) == 0
    law = json.loads((tmp_path / "law.json").read_text())
    wear = laws.engine_wear({"wear": {"curve": [], **law["wear"]}})
    for work in (1e4, 4e4, 1e5, 2e5):  # of whichever form, the belt wears as it was made to
        told = [core.belt_remaining(wear, {"work": used}) for used in (work, 6e4)]
        truth = [0.5 + 0.5 * math.exp(-used / 5e4) for used in (work, 6e4)]
        assert told[0] / told[1] == pytest.approx(truth[0] / truth[1], rel=0.08)
    capsys.readouterr()
    again = ["predict", str(tmp_path / "law.json"), str(tmp_path / "grinds.csv")]
    assert cli.main([*again, "-o", str(tmp_path / "predicted.csv")]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["grinds"] == 40 and figures["error_median"] < 0.07
    assert figures["inside_95_interval"] > 0.85
    assert len((tmp_path / "predicted.csv").read_text().splitlines()) == 41
    to_come = [row.rpartition(",")[0] for row in rows]
    (tmp_path / "to_come.csv").write_text("\n".join(to_come) + "\n")
    assert cli.main([*again[:2], str(tmp_path / "to_come.csv")]) == 0
    assert "error_median" not in json.loads(capsys.readouterr().out)
    assert cli.main(["predict", str(tmp_path / "grinds.csv"), str(tmp_path / "grinds.csv")]) == 2
    result = run(**law)
    truth = run(model="local", pressure_exponent=1.3)
    assert removed(result) == pytest.approx(removed(truth), rel=0.1)
    sd = result.summary["deviation_sd_mm"]["p95"]
    depth = np.max(np.asarray(result.field.stock_height) - np.asarray(result.field.height))
    assert 0.03 * depth < sd < 0.3 * depth


def test_a_scan_of_the_ground_part_gives_the_coefficient(tmp_path, capsys):
    truth = run(coefficient_mm2_per_N=1.5e-4)
    truth.write(tmp_path / "truth")  # its deviation.ply is the scan of the ground surface
    run(coefficient_mm2_per_N=1.2e-4).write(tmp_path / "simulated")
    scan = str(tmp_path / "truth" / "deviation.ply")
    arguments = ["calibrate-scan", str(tmp_path / "simulated"), scan]
    assert cli.main([*arguments, "-o", str(tmp_path / "law.json")]) == 0
    low, high = json.loads(capsys.readouterr().out)["interval"]
    law = json.loads((tmp_path / "law.json").read_text())
    assert law["coefficient_mm2_per_N"] == pytest.approx(1.5e-4, rel=0.03)
    assert low < law["coefficient_mm2_per_N"] < high
    assert run(**law).summary["deviation_sd_mm"]["mean"] > 0
    assert cli.main(["calibrate-scan", str(tmp_path), scan, "-o", "x.json"]) == 2


@pytest.mark.slow
def test_the_uncertainty_is_that_of_many_laws_drawn_at_random():
    covariance = np.array([[0.01, 0.012], [0.012, 0.04]])
    calibration = {**CALIBRATION, "covariance": covariance.tolist(), "scatter": 0.05}
    first_order = run(model="local", calibration=calibration).field.height_sd
    random, heights = np.random.default_rng(4), []
    for _ in range(60):
        ln_k, alpha = random.multivariate_normal([0, 0], covariance)
        coefficient = 1.25e-4 * math.exp(ln_k + 0.05 * random.normal())
        one = run(model="local", coefficient_mm2_per_N=coefficient, pressure_exponent=1 + alpha)
        heights.append(np.array(one.field.height))
    drawn = np.std(heights, axis=0, ddof=1)
    ground = drawn > 0.3 * drawn.max()
    ratio = np.asarray(first_order)[ground] / drawn[ground]
    assert 0.7 < np.median(ratio) < 1.4


def test_calibrations_that_are_none_are_refused():
    wrong = {**CALIBRATION, "covariance": [[0.01]]}
    with pytest.raises(InputError, match="2 parameters need 4"):
        run(model="local", calibration=wrong)
    wrong = {**CALIBRATION, "covariance": [[0.01, 1.0], [1.0, 0.01]]}
    with pytest.raises(InputError, match="not positive definite"):
        run(model="local", calibration=wrong)
    assert laws.shifted_laws({"model": "local_linear", "calibration": {}}) == []
