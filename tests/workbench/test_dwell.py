"""The planner's solver against others: on a mirror's map, and on small random cases."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear, minimize

import dwell_bench
from beltgrinding.engine import core


@pytest.mark.slow
@pytest.mark.skipif(not dwell_bench.DATA.is_file(), reason="the shared data are not here")
def test_a_mirror_is_flattened_better_and_sooner_than_its_own_method_does():
    heights = dwell_bench.surface()
    assert heights.std() == pytest.approx(147.5, abs=0.01), "the aperture is another one"
    found = dwell_bench.solve(heights, 3)
    assert found["dwell"].min() >= 0.0 and found["kkt"] < 1e-6
    assert found["rms_nm"] <= 0.094 and found["dwell_s"] <= 62_800.0, found
    rms, _ = dwell_bench.plain(heights, 3)
    assert found["rms_nm"] < 0.1 * rms, "no better than least squares that are cut off"


def strip(motions, seed):
    """(A (samples, motions) mm, excess, half, weight (samples,), lower, upper (motions,)): passes side by side."""
    random = np.random.default_rng(seed)
    samples = 4 * motions
    away = np.arange(samples)[:, None] / 4.0 - np.arange(motions)[None]
    a = np.float32(random.uniform(0.02, 0.06, motions) * np.exp(-0.5 * (away / 0.8) ** 2))
    a[a < 1e-4] = 0.0
    return (
        a.astype(float),
        random.uniform(-0.1, 0.2, samples),
        random.uniform(0.02, 0.06, samples),
        random.uniform(0.2, 1.0, samples),
        random.uniform(0.3, 0.9, motions),
        random.uniform(1.1, 3.0, motions),
    )


def planned(a, excess, half, weight, lower, upper, **settings):
    rows, columns = np.nonzero(a.T)
    first = np.searchsorted(rows, np.arange(a.shape[1] + 1))
    influence = core.Influence(
        first.astype(np.uint64), columns.astype(np.uint32), a.T[rows, columns].astype(np.float32)
    )
    given = {"smoothing": 0.0, "reweightings": 0, "accuracy": 1e-10, **settings}
    pace = np.zeros(a.shape[1])
    return core.plan_dwell(influence, excess, half, weight, lower, upper, pace, given)


@pytest.mark.parametrize("seed", range(6))
def test_bounded_least_squares_are_those_of_another_solver(seed):
    a, excess, half, weight, lower, upper = strip(25, seed)
    found = planned(a, excess, half, weight, lower, upper, inner_share=1.0, inner_cost=1.0)
    root = np.sqrt(weight)
    other = lsq_linear(
        root[:, None] * a, root * (excess + a.sum(axis=1)), (lower, upper), "bvls", tol=1e-14
    ).x
    assert np.abs(found["factor"] - other).max() < 1e-5
    assert (np.abs(other - lower) < 1e-9).sum() + (
        np.abs(other - upper) < 1e-9
    ).sum() >= 3, "limits"


@pytest.mark.parametrize("seed", range(6))
def test_the_cost_of_bands_has_the_least_that_another_solver_finds(seed):
    a, excess, half, weight, lower, upper = strip(20, 100 + seed)
    settings = {"inner_share": 0.7, "inner_cost": 0.3}
    found = planned(a, excess, half, weight, lower, upper, **settings)
    share = weight / weight.sum()

    def cost(x):
        e = excess - a @ (x - 1.0)
        outer = np.maximum(np.abs(e) - 0.7 * half, 0.0)
        value = 0.5 * share @ (0.3 * e**2 + 0.7 * outer**2)
        return 1e4 * value, -1e4 * a.T @ (share * (0.3 * e + 0.7 * outer * np.sign(e)))

    other = minimize(
        cost,
        np.clip(np.ones(20), lower, upper),
        jac=True,
        method="L-BFGS-B",
        bounds=np.stack([lower, upper], axis=1),
        options={"ftol": 1e-15, "gtol": 1e-11, "maxiter": 20_000, "maxfun": 40_000},
    )
    assert found["objective"] == pytest.approx(1e-4 * other.fun, rel=1e-7)
    assert np.abs(found["factor"] - other.x).max() < 1e-4


def test_what_no_motion_can_mend_does_not_keep_the_rest_out_of_the_band():
    # One motion over two places: the one is left too high, the other is too deep already.
    a, half = np.full((2, 1), 0.1), np.full(2, 0.05)
    excess, weight = np.array([0.065, -0.11]), np.array([1.0, 1.0])
    lower, upper = np.array([0.9]), np.array([2.0])

    def heights(**settings):
        found = planned(a, excess, half, weight, lower, upper, **settings)
        assert found["residual"] <= 1e-9
        return excess - 0.1 * (found["factor"] - 1.0)

    assert heights()[0] > half[0]
    assert heights(reweightings=6)[0] <= half[0]
