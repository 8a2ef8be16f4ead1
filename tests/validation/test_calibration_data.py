"""The calibration on a table of real grinds: half of them predicted from the other half."""

import numpy as np
import pytest
from support.freecad import SHARED

from beltgrinding import calibration

TABLE = SHARED / "data" / "removal" / "belt_grinder_recovered.csv"
REPEATS = 100


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
    assert np.mean(within) > 0.85


@pytest.mark.skipif(not TABLE.is_file(), reason=f"no measured grinds at {TABLE}")
def test_the_whole_table():
    report = calibration.fit(TABLE)["report"]
    assert report["r2"] > 0.95 and report["leave_one_out"]["median"] < 0.12
    assert any("only the rotation speed is known" in warning for warning in report["warnings"])
    assert any("contact areas are unknown" in warning for warning in report["warnings"])
