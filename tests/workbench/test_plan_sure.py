"""Plans that shall keep the tolerance with a probability: laws drawn at random, simulated whole."""

import copy
import math

import numpy as np
import pytest

from beltgrinding import planning
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.planning import rounds, sure
from beltgrinding.simulation import run as runs
from support.thorough import cases
from test_plan import SETTINGS, job  # noqa: F401 (a fixture)

COVARIANCE = np.array([[0.0012, 0.001], [0.001, 0.004]])
SCATTER = 0.03
LAW = {
    "model": "local",
    "calibration": {
        "parameters": ["coefficient", "pressure_exponent"],
        "covariance": COVARIANCE.tolist(),
        "scatter": SCATTER,
    },
}
WANTED = {**SETTINGS, "rounds": 8, "probability": 0.95, "goal": "time"}
DRAWN = 150  # whole simulations
CASES = cases([("wavy", 0.1, 0.9)], [("wavy", 0.1, 0.9), ("even", 0.06, 0.8)])


def calibrated(given, tolerance, **changes):
    given = copy.deepcopy(given)
    given["law"] = {**given["law"], **LAW}
    given["inspection"]["tolerance_mm"] = [-tolerance, tolerance]
    given.update(changes)
    return jobs.validate(given)


def whole(plan, seed, count):
    """(count,) shares in tolerance of whole simulations with laws drawn by the calibration's covariance."""
    random, shares = np.random.default_rng(seed), []
    law = plan.job["law"]
    for _ in range(count):
        ln_k, exponent = random.multivariate_normal([0.0, 0.0], COVARIANCE)
        drawn = {
            **law,
            "coefficient_mm2_per_N": law["coefficient_mm2_per_N"]
            * math.exp(ln_k + SCATTER * random.normal()),
            "pressure_exponent": 1.0 + exponent,
            "calibration": {},
        }
        result = runs.run({**plan.job, "law": drawn})
        shares.append(result.summary["in_tolerance_area_share"])
    return np.array(shares)


@pytest.mark.slow
@pytest.mark.parametrize("part, tolerance, wanted", CASES)
def test_as_many_drawn_laws_pass_as_are_asked_for(job, part, tolerance, wanted):
    even = {"stock": {"allowance_mm": 0.2, "kind": "allowance"}} if part == "even" else {}
    plan = planning.plan(calibrated(job, tolerance, **even), {**WANTED, "wanted_share": wanted})
    told = rounds.summary(plan)["after"]
    assert plan.better and 0.95 <= told["passing"] <= 0.97, told
    # The same share without looking at the law's doubt is faster, and far fewer pass.
    blind = {**WANTED, "wanted_share": wanted, "probability": 0.0}
    plain = planning.plan(plan.commands.job, blind)
    assert plain.after.summary["process_time_s"] < plan.after.summary["process_time_s"]
    passed = (whole(plan, 5, DRAWN) >= wanted).mean()
    assert 0.93 <= passed <= 0.97, passed
    assert (whole(plain, 5, 40) >= wanted).mean() < 0.8


def test_nothing_drawn_is_the_simulation_itself(job):
    given = calibrated(job, 0.1)
    settings = rounds.validate({"probability": 0.9})
    result = runs.run(given, shifts=True)
    still = copy.copy(result)
    still.shifts = np.zeros_like(result.shifts)
    shares = sure.drawn(still, settings)
    assert np.allclose(shares, result.summary["in_tolerance_area_share"], atol=1e-9)
    assert np.std(sure.drawn(result, settings)) > 0.01
    moved = {**settings, "placement_sd_mm": 0.05}
    assert np.std(sure.drawn(still, moved)) > 0.01
    assert np.array_equal(sure.drawn(result, settings), sure.drawn(result, settings))


def test_a_probability_needs_something_that_is_unsure(job):
    with pytest.raises(InputError, match="probability.*placement_sd_mm"):
        planning.plan(job, {**SETTINGS, "probability": 0.95})
    plan = planning.plan(job, {**SETTINGS, "probability": 0.95, "placement_sd_mm": 0.02})
    assert 0.0 < plan.rounds[-1]["sure_share"] < plan.rounds[-1]["in_tolerance"]
