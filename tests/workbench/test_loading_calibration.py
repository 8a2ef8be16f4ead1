"""Loading of the belt from grinds one after the other, with known pauses."""

import math

import numpy as np
import pytest

from beltgrinding import calibration
from beltgrinding.calibration import loading
from beltgrinding.calibration.table import from_columns
from beltgrinding.engine import InputError
from beltgrinding.job import law as laws, load as jobs
from test_job import plate_job

SHARE, SCALE, RECOVERY = 0.4, 8e3, 90.0  # the truth: J, s
SCATTER = 0.04


def grinds(count, share=SHARE, seed=5, pauses=True, volume=False):
    """Columns of grinds on one belt that wears little, by steps of their own."""
    random = np.random.default_rng(seed)
    columns = {
        "force_N": random.uniform(15, 50, count),
        "belt_speed_m_s": random.uniform(15, 30, count),
        "time_s": random.uniform(3, 20, count),
        "area_mm2": np.full(count, 200.0),
        "free_s": 10 ** random.uniform(0.5, 2.8, count) if pauses else np.full(count, 30.0),
    }
    work, removed, l, used = [], [], 0.0, 0.0
    for k in range(count):
        power = columns["force_N"][k] * columns["belt_speed_m_s"][k]
        l *= math.exp(-columns["free_s"][k] / RECOVERY)
        work.append(used)
        taken, parts = 0.0, 400
        for _ in range(parts):  # an Euler step of its own
            one = power * columns["time_s"][k] / parts
            taken += 1e-3 * one * (1.0 - share * l) * (1.0 + used / 2e5) ** -0.15
            l += (1.0 - l) * one / SCALE
            used += one
        removed.append(taken * random.lognormal(0.0, SCATTER))
    columns["work_J"] = np.array(work)
    columns["removed_volume_mm3"] = np.array(removed)
    return columns


def codes(found):
    return [getattr(one, "code", "") for one in found["report"]["warnings"]]


def test_the_means_are_those_of_the_closed_form():
    columns = grinds(6)
    table = from_columns(columns)
    found = loading.means(table, loading.Loading(SCALE, RECOVERY))
    l = 0.0
    for k in range(6):
        use = columns["force_N"][k] * columns["belt_speed_m_s"][k] * columns["time_s"][k]
        l *= math.exp(-columns["free_s"][k] / RECOVERY) if k else 1.0
        steps = l + (1.0 - l) * -np.expm1(-use / SCALE * (np.arange(2000) + 0.5) / 2000)
        assert found[k] == pytest.approx(steps.mean(), abs=1e-6)
        l = 1.0 - (1.0 - l) * math.exp(-use / SCALE)
    # Another belt begins free; what the table does not list loads as well.
    columns["work_J"][3:] -= columns["work_J"][3]
    fresh = loading.means(from_columns(columns), loading.Loading(SCALE, RECOVERY))
    assert np.allclose(fresh[:3], found[:3]) and fresh[3] < found[3]
    columns["work_J"][4:] += 5e4
    assert loading.means(from_columns(columns), loading.Loading(SCALE, RECOVERY))[4] > fresh[4]


def test_loading_is_found_where_the_grinds_tell_it():
    columns = grinds(60)
    found = calibration.fit(columns)
    wear = found["law"]["wear"]
    assert wear["loading_share"] == pytest.approx(SHARE, abs=0.08)
    assert wear["loading_scale"] == pytest.approx(SCALE, rel=0.6)
    assert wear["loading_recovery_s"] == pytest.approx(RECOVERY, rel=0.6)
    assert "calibration.no_loading" not in codes(found)
    told = found["law"]["calibration"]
    assert "loading_share" in told["parameters"] and told["scatter"] < 1.4 * SCATTER
    assert told["freedom"] == 60 - len(told["fit"]["parameters"]) - loading.HIDDEN
    full = jobs.validate({**plate_job(), "law": found["law"]})["law"]
    assert len({one.wear.loading_share for one in laws.shifted_laws(full)}) > 1
    # Predicted in their order, or as they were on average.
    later = grinds(40, seed=8)
    said = calibration.predict(found["law"], later)
    errors = np.abs(np.log(said["predicted"] / later["removed_volume_mm3"]))
    assert np.median(errors) < 0.05
    assert np.mean(errors < 1.96 * said["ln_deviation"]) > 0.85
    del later["free_s"]
    blind = calibration.predict(found["law"], later)
    away = np.abs(np.log(blind["predicted"] / later["removed_volume_mm3"]))
    assert np.median(away) > np.median(errors)


def test_what_the_grinds_do_not_tell_is_said_in_one_line():
    plain = calibration.fit(grinds(40, share=0.0))
    assert "calibration.no_loading" in codes(plain)
    assert "loading_share" not in plain["law"]["wear"]
    even = calibration.fit(grinds(40, pauses=False))
    assert "calibration.loading_not_varied" in codes(even)
    columns = grinds(40)
    del columns["free_s"]
    unseen = calibration.fit(columns)
    assert ("calibration.loading_unseen" in codes(unseen)) == (
        unseen["law"]["wear"]["model"] != "none"
    )
    assert unseen["law"]["calibration"]["scatter"] > 1.3 * SCATTER


def test_depths_and_laws_by_hand_say_what_is_missing():
    columns = grinds(40)
    columns["depth_mm"] = columns.pop("removed_volume_mm3") / 200.0
    with pytest.raises(InputError, match="removed_volume_mm3"):
        calibration.fit(columns)
    law = {
        "model": "local_linear",
        "coefficient_mm2_per_N": 1e-5,
        "wear": {"model": "none", "variable": "work", "loading_share": 0.3},
    }
    columns = grinds(5)
    with_pauses = calibration.predict(law, columns)["predicted"]
    del columns["free_s"]
    with pytest.raises(InputError, match="free_s"):
        calibration.predict(law, columns)
    law["wear"]["loading_share"] = 0.0
    assert (calibration.predict(law, columns)["predicted"] > with_pauses).all()
