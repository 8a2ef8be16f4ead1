"""Temperatures of any material at any feed: finite, below what its power allows, the same from finer steps; a
material that does not exist is refused, and so is a surface that boils away.
"""

import copy
import json
import math
import os
from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
MATERIALS = {  # conductivity, heat capacity, density
    "copper": (386.0, 385.0, 8940.0),
    "aluminium": (191.0, 911.0, 2700.0),
    "carbon steel": (53.0, 440.0, 7850.0),
    "titanium": (6.9, 560.0, 4400.0),
}
START, POWER = 20.0, 104.0  # degrees C; W: 20 N at 20 m/s, middles of friction and partition
KEYS = ("conductivity_W_mK", "heat_capacity_J_kgK", "density_kg_m3")


@pytest.fixture(scope="module")
def aluminium():
    path = SHARED / "faults" / "heat_aluminium.json"
    if not path.exists():
        pytest.skip("shared faults absent (set BELTGRINDING_SHARED)")
    job = json.loads(path.read_text(encoding="utf-8"))
    job["design"]["file"] = str(path.parent / job["design"]["file"])
    return job


def hottest(job, feed, travel=1.0, material=None, spacing=1.0):
    """The greatest likely temperature, degrees C; everything that a result tells of it is finite."""
    job = copy.deepcopy(job)
    if material is not None:
        job["heat"].update(zip(KEYS, material))
    for pose in job["programs"][0]["poses"]:
        pose["feed_mm_s"] = feed
    job["belt_machine"]["contact_spacing_mm"] = spacing
    job["simulation"] = {"max_travel_mm": travel}
    result = beltgrinding.run(job)
    rise = np.asarray(result.field.heat["rise"])
    assert np.isfinite(rise).all() and rise.min() >= 0.0
    heat = result.verdict["heat"]
    json.dumps(heat, allow_nan=False)
    for share in (heat["burnt_share"], heat["perhaps_burnt_share"]):
        assert share is None or 0.0 <= share <= 1.0
    # At the end of the way the wheel tips over the part's edge, with a contact that depends on the step.
    inside = np.asarray(result.field.points)[:, 0] < 34.0
    return heat["worst"]["temperature_C"], heat["start_C"] + rise[inside].max()


@pytest.mark.slow
def test_aluminium_at_any_feed_is_as_warm_as_it_is(aluminium):
    found = [hottest(aluminium, feed)[0] for feed in (1, 2, 5, 10, 50)]
    assert sorted(found, reverse=True) == found
    assert found[-1] > 30.0
    # 104 W for 30 s are 158 K for all of the part.
    assert 150.0 < found[0] < 400.0


@pytest.mark.slow
@pytest.mark.parametrize("feed, finer, near", [(5, 101.0, 0.03), (10, 73.8, 0.05)])
def test_the_end_of_the_box_is_as_warm_as_by_finite_differences(aluminium, feed, finer, near):
    """``finer``: what cells of 1 and 0.5 mm lead to, degrees C; these here are of 1 mm."""
    job = finely(aluminium, feed)
    recording = core.Recording()
    result = beltgrinding.run(job, recording=recording)
    truth = box_by_differences(result.field, recording)
    assert truth == pytest.approx(finer, rel=0.015)
    rise = float(np.asarray(result.field.heat["rise"]).max())
    assert rise == pytest.approx(finer - START, rel=0.02)
    # The default step, with which the wheel tips over the edge, loses up to 4 %.
    assert hottest(aluminium, feed)[0] - START == pytest.approx(finer - START, rel=near)


def finely(job, feed):
    job = copy.deepcopy(job)
    for pose in job["programs"][0]["poses"]:
        pose["feed_mm_s"] = feed
    job["belt_machine"]["contact_spacing_mm"] = 0.5
    job["simulation"] = {"max_travel_mm": 0.25}
    return job


def box_by_differences(field, recording):
    """Degrees C, the greatest on the top of the box of 40 x 20 x 10 mm: cells of 1 mm, explicit; the heat flows in where
    the recording removes."""
    conductivity, capacity, density = MATERIALS["aluminium"]
    stored = capacity * density * 1e-9  # J/(mm3 K)
    diffusivity = conductivity * 1e-3 / stored  # mm2/s
    at = np.round(2 * np.asarray(field.points)[:, :2]).astype(int)  # samples every 0.5 mm
    times = np.asarray(recording.times())
    heights = [np.asarray(recording.heights_at(k), float) for k in range(recording.last + 1)]
    rise, greatest = np.zeros((40, 20, 10)), np.zeros((40, 20))
    for k, time in enumerate(np.diff(times)):
        removed = np.zeros((81, 41))
        removed[at[:, 0], at[:, 1]] = heights[k] - heights[k + 1]
        flux = removed[1::2, 1::2]  # the cells' middles
        if time <= 0.0 or flux.sum() <= 0.0:
            continue
        flux = flux * (POWER / flux.sum())  # W/mm2
        steps = math.ceil(time * diffusivity * 6.2)
        for _ in range(steps):
            flow = np.zeros_like(rise)
            for axis in range(3):
                along = np.diff(rise, axis=axis)
                pad = [(0, 0)] * 3
                pad[axis] = (0, 1)
                flow += np.pad(along, pad)
                pad[axis] = (1, 0)
                flow -= np.pad(along, pad)
            rise += flow * (diffusivity * time / steps)
            rise[:, :, -1] += flux * (time / steps / stored)
        top = (9 * rise[:, :, -1] - rise[:, :, -2]) / 8 + 3 * flux / (8e-3 * conductivity)
        greatest = np.maximum(greatest, top)
    return START + greatest.max()


@pytest.mark.slow
@pytest.mark.parametrize("material", MATERIALS)
def test_finer_steps_change_little(aluminium, material):
    for feed in (1, 5, 20):
        whole, half = (
            hottest(aluminium, feed, travel, MATERIALS[material])[1] for travel in (1.0, 0.5)
        )
        assert whole - 20.0 == pytest.approx(half - 20.0, rel=0.015), feed


def test_what_stores_next_to_nothing_and_what_stores_most(aluminium):
    for capacity in (1e5, 1e7):
        for feed in (5, 50):
            found = hottest(aluminium, feed, material=(191.0, 500.0, capacity / 500.0), spacing=0.5)
            assert 20.0 < found[0] < 5000.0
    # The part stores 8 mJ/K, and 104 W flow into it.
    with pytest.raises(InputError, match="W flow into") as error:
        hottest(aluminium, 1, material=(191.0, 500.0, 2.0), spacing=0.5)
    assert error.value.code == "heat.boils"


def test_a_material_that_none_is_is_refused_with_its_range():
    job = plate_job()
    job["heat"] = dict(zip(KEYS, MATERIALS["titanium"]), friction=[0.3, 0.6], partition=[0.5, 0.8])
    for key, wrong, told in (
        (KEYS[0], 1e6, "2500"),
        (KEYS[0], 0.0, "0.1"),
        (KEYS[1], 1e-6, "0.1"),
        (KEYS[2], 1e6, "25000"),
        (KEYS[2], -5.0, "1"),
    ):
        with pytest.raises(InputError, match=key) as error:
            beltgrinding.run({**job, "heat": {**job["heat"], key: wrong}})
        assert told in str(error.value)
    with pytest.raises(InputError, match="heat_capacity_J_kgK.*materials have") as error:
        beltgrinding.run({**job, "heat": {**job["heat"], KEYS[1]: 0.5, KEYS[2]: 20.0}})
    assert error.value.code == "job.heat_stored"


def test_a_surface_that_boils_away_is_an_error_that_tells_the_power():
    job = plate_job()
    job["heat"] = dict(zip(KEYS, (1.0, 500.0, 2000.0)), friction=[5.0, 9.0], partition=[0.9, 1.0])
    job["belt_machine"]["belt_speed_m_s"] = 50.0
    for program in job["programs"]:
        for pose in program["poses"]:
            pose["feed_mm_s"] = 0.5
    with pytest.raises(InputError, match="W flow into") as error:
        beltgrinding.run(job)
    assert error.value.code == "heat.boils"
