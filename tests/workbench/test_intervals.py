"""How often the truth lies in the intervals that a calibrated law gives: grinds, heights, plans, belts."""

import json
import math

import numpy as np
import pytest
from support import synthetic_grinds
from support.thorough import cases
from test_job import plate_job

import beltgrinding
from beltgrinding.calibration import calibrate as calibration
from beltgrinding.engine import InputError, core
from beltgrinding.inspection import section_plot, section
from beltgrinding.job import law as laws
from beltgrinding.planning import sure

NEW = 20  # grinds that are predicted from each table
GRINDS = (8, 15, 40)
JOBS = cases([40], [150])[0]


def calibrated(seed, count, worn, **others):
    """(random, truth, law calibrated from ``count`` grinds)."""
    random = np.random.default_rng(seed)
    truth = synthetic_grinds.drawn(random, worn)
    columns = synthetic_grinds.inputs(random, count, worn, **others)
    columns["removed_volume_mm3"] = synthetic_grinds.measured(random, truth, columns)
    return random, truth, calibration.fit_law(columns)


def test_as_many_new_grinds_as_told_lie_in_the_interval():
    shares = {}
    for count in GRINDS:
        inside = []
        for worn in (False, True):
            for seed in range(JOBS):
                random, truth, law = calibrated(seed, count, worn, areas=False)
                new = synthetic_grinds.inputs(random, NEW, worn, areas=False)
                off = np.log(synthetic_grinds.measured(random, truth, new))
                told = calibration.predict(law, new)
                off -= np.log(told["predicted"])
                inside.append(np.mean(abs(off) < 1.96 * told["ln_deviation"]))
        shares[count] = np.mean(inside)
        print(f"{count} grinds: {100 * shares[count]:.1f} % of new ones inside")
    assert 0.93 <= min(shares.values()) and max(shares.values()) <= 0.985, shares


def ground(law, job):
    return beltgrinding.run({**job, "law": law})


@pytest.mark.slow
@pytest.mark.parametrize("worn", (False, True))
def test_the_true_heights_lie_in_the_interval(worn):
    """Of jobs within what the grinds varied, on belts of any use: the deepest place of the true part."""
    for count in GRINDS:
        inside = []
        for seed in range(JOBS):
            random, truth, law = calibrated(1000 + seed, count, worn)
            job = plate_job()
            job["sampling"]["spacing_mm"] = 1.0
            machine = job["belt_machine"]
            machine["force_N"] = float(random.uniform(15, 50))
            machine["belt_speed_m_s"] = float(random.uniform(14, 28))
            if worn:
                machine["belt"] = {"work_J": float(random.uniform(0, 2e5))}
            told = ground(law, job).field
            scatter = random.lognormal(0.0, synthetic_grinds.SCATTER)
            true = np.asarray(ground(truth.law(scatter), job).field.height)
            deepest = int(np.argmin(true))
            half = core.student_quantile(0.975, told.sd_freedom) * told.height_sd[deepest]
            inside.append(abs(true[deepest] - told.height[deepest]) < half)
        print(
            f"{count} grinds, worn {worn}: {100 * np.mean(inside):.1f} % of {JOBS} heights inside"
        )
        # Both ends of the binomial distribution's 99.9 % about 0.95.
        by = 3.3 * math.sqrt(0.95 * 0.05 / JOBS)
        assert 0.95 - by <= np.mean(inside) <= min(1.0, 0.97 + by)


def area(polygon):
    x, y = np.asarray(polygon).T
    return 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))


def test_a_law_of_few_grinds_widens_what_all_is_told_of():
    """Section, share in tolerance and plan by Student's t: a law that has but 3 degrees of freedom."""
    law = {
        "model": "local",
        "calibration": {"parameters": ["coefficient"], "covariance": [[0.01]], "scatter": 0.05},
    }
    few = json.loads(json.dumps(law))
    few["calibration"]["freedom"] = 3
    many, little = (ground(one, plate_job()) for one in (law, few))
    assert np.array_equal(many.field.height_sd, little.field.height_sd)
    assert math.isinf(many.field.sd_freedom) and little.field.sd_freedom == 3
    shares = [one.summary["expected_in_tolerance_area_share"] for one in (many, little)]
    assert shares[0] != shares[1]
    found = [
        section_plot.plot(section.section(one, [30, 0, 0], [1, 0, 0])) for one in (many, little)
    ]
    bands = [next(one for one in plot["layers"] if one["key"] == "uncertainty") for plot in found]
    areas = [sum(area(one) for one in band["polygons"]) for band in bands]
    assert areas[1] / areas[0] == pytest.approx(3.1824 / 1.9600, rel=1e-3)  # tables of t
    settings = {"probability": 0.95, "placement_sd_mm": 0.0, "wanted_share": 0.5}
    for one in (many, little):
        one.shifts = beltgrinding.simulation.run.run(one.job, shifts=True).shifts
    drawn = [sure.drawn(one, settings) for one in (many, little)]
    assert np.mean(drawn[1] == 0.0) > np.mean(drawn[0] == 0.0)
    half = np.full(many.field.size, 1.0)
    bands = [1.0 - sure.band(one, settings, half).min() for one in (many, little)]
    assert bands[1] / bands[0] == pytest.approx(2.3534 / 1.6449, rel=1e-3)


def test_the_field_keeps_its_freedom_in_a_file(tmp_path):
    field = ground({"calibration": {"scatter": 0.1, "freedom": 4.5}}, plate_job()).field
    field.write_hdf5(str(tmp_path / "field.h5"))
    again, _ = core.HeightField.from_hdf5(str(tmp_path / "field.h5"))
    assert again.sd_freedom == 4.5


def test_wear_is_among_what_may_be_otherwise():
    wear = {"model": "exponential", "scale": 1e4, "rest": 0.99}
    calibrated_law = {
        "model": "local",
        "wear": wear,
        "calibration": {
            "parameters": ["coefficient", "ln_wear_scale", "wear_rest"],
            "covariance": [[0.01, 0, 0], [0, 0.04, 0], [0, 0, 0.0025]],
            "scatter": 0.0,
            "widening": 2.0,
        },
    }
    law = beltgrinding.job.load.validate({**plate_job(), "law": calibrated_law})["law"]
    shifted = laws.shifted_laws(law)
    scales = [one.wear.scale / 1e4 for one in shifted]
    assert max(scales) == pytest.approx(math.exp(0.4))  # twice a deviation of 0.2
    rests = [one.wear.rest for one in shifted]
    assert min(rests) == pytest.approx(0.89) and max(rests) <= 1.0  # not 1.09, which says the same
    worn = plate_job()
    worn["belt_machine"]["belt"] = {"work_J": 1e4}
    law["wear"]["rest"] = 0.2
    law["calibration"]["parameters"] = ["coefficient", "ln_wear_scale"]
    law["calibration"]["covariance"] = [[0.0, 0.0], [0.0, 0.04]]
    told = ground(law, worn)
    truth = {**law, "calibration": {}, "wear": {**law["wear"], "scale": 1e4 * math.exp(0.4)}}
    more = np.asarray(told.field.height) - ground(truth, worn).field.height
    areas = told.field.areas
    assert np.dot(told.field.height_sd, areas) == pytest.approx(np.dot(more, areas), rel=0.03)


def test_a_freedom_that_is_none_is_refused():
    with pytest.raises(InputError, match="law.calibration.freedom"):
        ground({"calibration": {"scatter": 0.1, "freedom": 0}}, plate_job())
    with pytest.raises(InputError, match="law.calibration.widening"):
        ground({"calibration": {"scatter": 0.1, "widening": 0.5}}, plate_job())
