"""Learning from scans of ground parts: law and wear, part by part, against not learning."""

import copy
import json
import math

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.calibration import learning
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.simulation import run as runs
from test_job import plate_job

WEAR = {"model": "exponential", "variable": "work", "scale": 12000.0, "rest": 0.3}
BELIEVED = {
    "model": "local",
    "coefficient_mm2_per_N": 1.25e-4,
    "wear": WEAR,
    "calibration": {
        "parameters": ["coefficient", "pressure_exponent"],
        "covariance": [[0.06, 0.0], [0.0, 0.02]],
        "scatter": 0.08,
    },
}
PARTS = 20


def job_of(law, work=0.0):
    given = plate_job()
    given["stock"] = {"allowance_mm": 0.4}
    given["law"] = law
    given["belt_machine"]["belt"] = {"work_J": work}
    return jobs.validate(given)


def truth_of(part, wear=True):
    """What cuts in fact: less, on belts that wear faster than believed, and faster from part to part."""
    scale = WEAR["scale"] * (0.5 * 0.985**part if wear else 1.0)
    return {
        **BELIEVED,
        "coefficient_mm2_per_N": 0.65 * BELIEVED["coefficient_mm2_per_N"],
        "pressure_exponent": 1.08,
        "wear": {**WEAR, "scale": scale},
        "calibration": {},
    }


def ground(law, work, random=None, scatter=0.0):
    """(heights of the part as it is really ground, its Result): a factor of its own, and a scan's noise."""
    own = math.exp(scatter * random.normal()) if random else 1.0
    law = {**law, "coefficient_mm2_per_N": law["coefficient_mm2_per_N"] * own}
    result = runs.run(job_of(law, work))
    height = np.array(result.field.height)
    return height + (0.01 * random.normal(size=len(height)) if random else 0.0), result


@pytest.mark.slow
def test_a_batch_is_predicted_far_better_by_the_fourth_part():
    random, law, work, errors = np.random.default_rng(8), BELIEVED, 0.0, []
    for part in range(PARTS):
        expected, exact = ground(truth_of(part), work)
        told = [np.array(runs.run(job_of(one, work)).field.height) for one in (law, BELIEVED)]
        errors.append([np.sqrt(np.mean((one - expected) ** 2)) for one in told])
        scan, _ = ground(truth_of(part), work, random, 0.08)
        law = learning.learn(job_of(law, work), scan).law
        jobs.validate({**plate_job(), "law": law})
        work += exact.summary["belt"]["work_J"] - work
    learnt, plain = np.sqrt(np.mean(np.square(errors[3:]), axis=0))
    assert plain > 5.0 * learnt, (learnt, plain)
    assert errors[3][1] > 5.0 * errors[3][0], errors[:4]


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
def test_one_part_tells_the_coefficient_and_not_the_wear_of_a_fresh_belt(factor):
    law = copy.deepcopy(BELIEVED)
    law["calibration"]["scatter"] = 1e-3
    law["calibration"]["covariance"] = [[0.3, 0.0], [0.0, 1e-6]]
    true = {**law, "coefficient_mm2_per_N": factor * law["coefficient_mm2_per_N"]}
    found = learning.learn(job_of(law), ground(true, 0.0)[0])
    by = {one["parameter"]: one for one in found.report}
    assert found.law["coefficient_mm2_per_N"] == pytest.approx(
        true["coefficient_mm2_per_N"], rel=0.06
    )
    low, high = by["coefficient"]["interval"]
    assert low < true["coefficient_mm2_per_N"] < high
    wide = np.log(np.divide(by["ln_wear_scale"]["interval_before"], WEAR["scale"]))
    now = np.log(np.divide(*by["ln_wear_scale"]["interval"]))
    assert abs(now) > 0.8 * (wide[1] - wide[0]), "a fresh belt says little of its wear"
    assert found.rms_mm[1] <= found.rms_mm[0] + 1e-6
    assert found.factor == pytest.approx(factor, rel=0.1)


@pytest.mark.parametrize("model", ["local", "local_linear"])
def test_a_law_that_was_never_calibrated_learns_its_coefficient(model):
    law = {"model": model, "coefficient_mm2_per_N": 1.25e-4}
    true = {**law, "coefficient_mm2_per_N": 2e-4}
    found = learning.learn(job_of(law), ground(true, 0.0)[0], scatter=0.01)
    assert [one["parameter"] for one in found.report] == ["coefficient"]
    assert found.law["coefficient_mm2_per_N"] == pytest.approx(2e-4, rel=0.03)
    again = learning.learn(job_of(found.law), ground(true, 0.0)[0])
    assert again.factor == pytest.approx(1.0, abs=0.03)


@pytest.mark.slow
def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """Laws drawn from what is believed, each tried on two parts."""
    random, held = np.random.default_rng(3), []
    spread = np.array(BELIEVED["calibration"]["covariance"])
    for _ in range(14):
        ln_k, exponent = random.multivariate_normal([0.0, 0.0], spread)
        true = {
            **BELIEVED,
            "coefficient_mm2_per_N": BELIEVED["coefficient_mm2_per_N"] * math.exp(ln_k),
            "pressure_exponent": 1.0 + exponent,
            "calibration": {},
        }
        law = BELIEVED
        for work in (0.0, 4000.0):
            law = learning.learn(
                job_of(law, work), ground(true, work, random, 0.08)[0], drift=0.0
            ).law
        calibration = law["calibration"]
        k = calibration["parameters"].index("coefficient")
        off = math.log(law["coefficient_mm2_per_N"] / true["coefficient_mm2_per_N"])
        held.append(abs(off) < 1.96 * math.sqrt(calibration["covariance"][k][k]))
    assert 12 <= sum(held), held


def test_a_few_blunders_of_the_scan_hardly_count():
    scan, _ = ground(truth_of(0, wear=False), 0.0)
    clean = learning.learn(job_of(BELIEVED), scan).law["coefficient_mm2_per_N"]
    spoilt = scan.copy()
    spoilt[: len(scan) // 20] += 5.0
    spoilt[-20:] = np.nan
    found = learning.learn(job_of(BELIEVED), spoilt).law["coefficient_mm2_per_N"]
    assert found == pytest.approx(clean, rel=0.02)


@pytest.mark.parametrize(
    "law, heights, words",
    [
        ({"model": "hammann"}, None, "no coefficient"),
        ({}, np.nan, "places of 10 mm"),
        ({}, "short", "measured heights for"),
    ],
)
def test_what_teaches_nothing_is_refused(law, heights, words):
    job = job_of({**BELIEVED, **law})
    count = 3 if isinstance(heights, str) else runs.run(job).field.size
    with pytest.raises(InputError, match=words):
        learning.learn(job, np.full(count, np.nan))


def test_the_command_writes_the_next_parts_law(tmp_path, capsys):
    runs.run(job_of(BELIEVED, 2000.0)).write(tmp_path / "out")
    truth = runs.run(job_of(truth_of(0), 2000.0))
    truth.write(tmp_path / "truth")
    scan = tmp_path / "truth" / "deviation.ply"
    begin = ["learn", str(tmp_path / "out"), str(scan), "-o", str(tmp_path / "law.json")]
    assert cli.main([*begin, "--report", str(tmp_path / "report.json")]) == 0
    law = json.loads((tmp_path / "law.json").read_text())
    report = json.loads((tmp_path / "report.json").read_text())
    told = capsys.readouterr().out
    assert law["coefficient_mm2_per_N"] < 0.9 * BELIEVED["coefficient_mm2_per_N"]
    assert {one["parameter"] for one in report["learned"]} == {
        "coefficient",
        "pressure_exponent",
        "ln_wear_scale",
    }
    assert f"{report['factor']:.3f}" in told and "wear" in told
    before = runs.run(job_of(BELIEVED, 2000.0)).field.height
    after = runs.run(job_of(law, 2000.0)).field.height
    rms = [np.sqrt(np.mean((np.array(h) - truth.field.height) ** 2)) for h in (before, after)]
    assert rms[1] < 0.3 * rms[0]
    assert cli.main([*begin[:2], str(tmp_path / "none.stl"), *begin[3:]]) == 2
