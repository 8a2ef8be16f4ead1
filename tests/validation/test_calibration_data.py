"""The calibration on a table of real grinds: half of them predicted from the other half."""

import math

import numpy as np
import pytest
from support import held_out
from support.held_out import TABLE

from beltgrinding.calibration import calibrate as calibration

REPEATS = 100
CONFIDENCE = 0.95  # of the intervals, and of the bounds within which their share of hits must lie


def hits_expected(count, share):
    """(least, most) of ``count`` independent trials that succeed with probability ``share``: the
    quantiles of the binomial distribution that leave 2.5 % outside on each side.
    """
    each = [math.comb(count, k) * share**k * (1 - share) ** (count - k) for k in range(count + 1)]
    sums = np.cumsum(each)
    tail = 0.5 * (1.0 - CONFIDENCE)
    return int(np.searchsorted(sums, tail)), int(np.searchsorted(sums, 1.0 - tail))


@pytest.mark.skipif(not TABLE.is_file(), reason=f"no measured grinds at {TABLE}")
def test_half_of_the_grinds_predict_the_other_half():
    table = calibration.read(TABLE)
    count = len(table.measured)
    random = np.random.default_rng(1)
    errors, within = [], []
    for _ in range(REPEATS):
        order = random.permutation(count)
        law = calibration.fit_law(table.take(order[: count // 2]))
        held = table.take(order[count // 2 :])
        said = calibration.predict(law, held)
        errors.append(np.abs(said["predicted"] / held.measured - 1))
        z = np.log(held.measured / said["predicted"]) / said["ln_deviation"]
        within.append(np.abs(z) < 1.96)
    median = np.median(np.concatenate(errors))
    p90 = np.quantile(np.concatenate(errors), 0.9)
    print(f"held-out: median {100 * median:.1f} %, 90 % below {100 * p90:.0f} %")
    assert median < 0.15 and p90 < 0.45
    assert np.max([np.median(one) for one in errors]) < 0.25
    # Every grind is held out of about half of the splits, but it scatters once: as many independent
    # trials as there are grinds.
    least, most = hits_expected(count, CONFIDENCE)
    print(
        f"95 % intervals hold {100 * np.mean(within):.1f} %; {least} to {most} of {count} expected"
    )
    assert least <= np.mean(within) * count <= most


@pytest.mark.skipif(not TABLE.is_file(), reason=f"no measured grinds at {TABLE}")
def test_the_law_is_nowhere_worse_than_a_power_law():
    """On held-out halves of every table that the grinds give by splitting; a hundredth or two is what the
    choice of the halves is worth."""
    better, inside = [], []
    for name, table in held_out.tables().items():
        found = held_out.compared(table, 25)
        ratios = [a / b for a, b in zip(found["law"], found["power"])]
        inside.append(found["inside"])
        print(f"{name}: median, 90 % over the power law's: {ratios}, inside {inside[-1]:.3f}")
        assert max(ratios) < 1.04, name
        assert inside[-1] > 0.92, name
        better.append(ratios)
    assert np.mean(better, axis=0).max() < 0.98
    assert 0.93 < np.mean(inside) < 0.97


@pytest.mark.skipif(not TABLE.is_file(), reason=f"no measured grinds at {TABLE}")
def test_the_highest_forces_are_predicted_from_the_lower():
    for name in ("known areas", "50 mm2", "98 and 200 mm2"):
        law, _ = held_out.extrapolated(held_out.tables()[name], "force")
        assert law < 0.2, name


@pytest.mark.skipif(not TABLE.is_file(), reason=f"no measured grinds at {TABLE}")
def test_the_whole_table():
    report = calibration.fit(TABLE)["report"]
    assert report["r2"] > 0.95 and report["leave_one_out"]["median"] < 0.12
    assert any("only the rotation speed is known" in warning for warning in report["warnings"])
    assert any("contact areas are unknown" in warning for warning in report["warnings"])


def test_the_bounds_of_hits():
    assert hits_expected(102, 0.95) == (92, 101)
    assert hits_expected(10, 0.5) == (2, 8)
