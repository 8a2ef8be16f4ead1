"""What tables of grinds leave open: contact areas that nobody knows, exponents that nobody varied, a belt's break-in."""

import math

import numpy as np
import pytest
from support.freecad import SHARED
from test_job import plate_job

import beltgrinding
from beltgrinding.calibration import calibrate as calibration
from beltgrinding.engine import core
from beltgrinding.job import law as laws

NO_AREA = SHARED / "faults" / "grinds_noarea.csv"
WHEEL = {
    "wheel_radius_mm": 60.0,
    "wheel_width_mm": 15.0,
    "rim_thickness_mm": 15.0,
    "youngs_modulus_MPa": 5.0,
}


def told_deviation(law):
    """Of ln of what a simulation at the grinds' own pressures and speeds removes, without scatter."""
    return math.sqrt(law["calibration"]["covariance"][0][0])


@pytest.mark.slow
@pytest.mark.parametrize("exponent", (0.7, 1.0, 1.5, 2.65))
def test_the_interval_of_a_law_without_areas_holds_the_truth(exponent):
    random, count = np.random.default_rng(3), 12
    columns = {
        "force_N": random.uniform(15, 50, count),
        "belt_speed_m_s": random.uniform(14, 28, count),
        "feed_mm_s": random.uniform(15, 50, count),
        "length_mm": np.full(count, 40.0),
    }
    truth = {
        "model": "local",
        "coefficient_mm2_per_N": 2e-5,
        "pressure_exponent": exponent,
        "reference_pressure_MPa": 0.1,
        "reference_feed_mm_s": 50.0,
    }
    known = {**columns, **{key: np.full(count, value) for key, value in WHEEL.items()}}
    volume = calibration.predict(truth, known)["predicted"] * random.lognormal(0, 0.03, count)
    result = calibration.fit({**columns, "removed_volume_mm3": volume})
    law = result["law"]
    job = plate_job()
    job["belt_machine"]["compliance"] = {"rim_thickness_mm": 15.0, "youngs_modulus_MPa": 5.0}
    ground = [beltgrinding.run({**job, "law": one}) for one in (law, truth)]
    off = abs(
        math.log(ground[0].summary["removed_volume_mm3"] / ground[1].summary["removed_volume_mm3"])
    )
    assert off < 1.96 * told_deviation(law)
    said = [str(one) for one in result["report"]["warnings"]]
    assert any("no contact area of the grinds is known" in one for one in said) == (
        abs(law["pressure_exponent"] - 1.0) > 0.01
    )
    assert not any("more than these grinds did" in one for one in said)
    with_wheel = calibration.fit_law({**known, "removed_volume_mm3": volume})
    assert told_deviation(with_wheel) < 0.1
    if exponent > 2:  # what the grinds' scatter alone would say
        assert off > 3.0 * told_deviation(with_wheel)


@pytest.mark.skipif(not NO_AREA.is_file(), reason=f"no {NO_AREA}")
def test_grinds_without_areas_say_how_wrong_another_area_may_be():
    result = calibration.fit(NO_AREA)
    (said,) = [str(one) for one in result["report"]["warnings"] if "times too much" in str(one)]
    assert "area" in said
    law = result["law"]
    assert told_deviation(law) > math.log(1.93) / 1.96  # by as much a simulation was off
    k = law["calibration"]["parameters"].index("pressure_exponent")
    half = 1.96 * math.sqrt(law["calibration"]["covariance"][k][k])
    assert abs(law["pressure_exponent"] - 2.65) < half  # that of the law that made them


def test_an_exponent_that_was_not_varied_may_be_another():
    random = np.random.default_rng(5)
    columns = {
        "force_N": np.full(12, 30.0),
        "belt_speed_m_s": random.uniform(12, 30, 12),
        "time_s": random.uniform(5, 30, 12),
        "area_mm2": np.full(12, 200.0),
    }
    columns["removed_volume_mm3"] = (
        columns["belt_speed_m_s"] * columns["time_s"] * random.lognormal(0, 0.02, 12)
    )
    law = calibration.fit_law(columns)
    names = law["calibration"]["parameters"]
    assert law["pressure_exponent"] == 1.0 and "pressure_exponent" in names
    k = names.index("pressure_exponent")
    assert math.sqrt(law["calibration"]["covariance"][k][k]) == pytest.approx(1.05, abs=0.01)
    exponents = {one.pressure_exponent for one in laws.shifted_laws(full(law))}
    assert max(exponents) > 1.9 and min(exponents) < 1.01
    assert any(
        one.coefficient_mm2_per_N != law["coefficient_mm2_per_N"]
        for one in laws.shifted_laws(full(law))
    )


def full(law):
    return beltgrinding.job.load.validate({**plate_job(), "law": law})["law"]


def test_a_belts_break_in_is_found_where_the_grinds_tell_it():
    truth = {
        "wear": {
            "model": "two_stage",
            "scale": 2e5,
            "rest": 0.25,
            "first_share": 0.4,
            "first_scale": 4e3,
            "curve": [],
        }
    }
    random, count = np.random.default_rng(11), 80
    used = np.concatenate([[0.0] * 8, 10 ** random.uniform(2.5, 5.8, count - 8)])
    cut = [core.belt_remaining(laws.engine_wear(truth), {"work": one}) for one in used]
    columns = {
        "force_N": random.uniform(10, 60, count),
        "belt_speed_m_s": random.uniform(12, 30, count),
        "time_s": random.uniform(5, 30, count),
        "area_mm2": np.full(count, 200.0),
        "work_J": used,
    }
    columns["removed_volume_mm3"] = (
        1e-3 * columns["force_N"] * columns["belt_speed_m_s"] * columns["time_s"] * cut
    ) * random.lognormal(0, 0.03, count)
    law = calibration.fit_law(columns)
    wear = law["wear"]
    assert wear["model"] == "two_stage"
    assert wear["first_share"] == pytest.approx(0.4, abs=0.08)
    assert wear["first_scale"] == pytest.approx(4e3, rel=0.5)
    for one in (0.0, 2e3, 2e4, 4e5):
        found = core.belt_remaining(laws.engine_wear(law), {"work": one})
        assert found == pytest.approx(
            core.belt_remaining(laws.engine_wear(truth), {"work": one}), rel=0.1
        )
    assert {"first_share", "ln_first_ratio"} <= set(law["calibration"]["parameters"])
    said = calibration.predict(law, columns)
    off = abs(np.log(columns["removed_volume_mm3"] / said["predicted"]))
    assert np.mean(off < 1.96 * said["ln_deviation"]) > 0.9
    drawn = laws.drawn_wears(full(law), 50)
    assert all(one.rest + one.first_share <= 1.0 + 1e-12 for one in drawn)
    assert np.ptp([one.first_scale for one in drawn]) > 0
    # Belts that were all used before the first grind tell nothing of it.
    late = used > 3e4
    old = {key: value[late] for key, value in columns.items()}
    assert calibration.fit_law(old)["wear"]["model"] != "two_stage"
