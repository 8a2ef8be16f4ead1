"""Temperatures of a job: from the key to result file, verdict, events, report; and nothing without it."""

import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.engine import InputError
from beltgrinding.inspection import heat as heats, verdict as verdicts
from beltgrinding.simulation.result import Result
from test_job import plate_job

STEEL = {
    "material": "1.4301",
    "conductivity_W_mK": 15,
    "heat_capacity_J_kgK": 500,
    "density_kg_m3": 7900,
    "friction": [0.3, 0.6],
    "partition": [0.5, 0.8],
}


def run(**heat):
    job = plate_job()
    job["heat"] = {**STEEL, **heat}
    return beltgrinding.run(job)


@pytest.fixture(scope="module")
def ground():
    return run(burn_temperature_C=30.0, burn_source="a test")


def test_without_the_key_nothing_is_computed_and_nothing_else_changes(ground):
    plain = beltgrinding.run(plate_job())
    assert plain.field.heat is None and "heat" not in plain.verdict and "heat" not in plain.job
    assert np.array_equal(plain.field.height, ground.field.height)
    for name, values in plain.field.trace.items():
        assert np.array_equal(values, ground.field.trace[name]), name
    kinds = [event for event in ground.events if event["kind"] != "burn_risk"]
    assert kinds == plain.events


def test_the_rise_is_in_proportion_to_the_heat_that_flows_in(ground):
    once, twice = ground.field.heat["rise"], run(partition=[0.25, 0.4]).field.heat["rise"]
    assert once.max() > 5.0
    assert np.allclose(once, 2.0 * np.asarray(twice), rtol=1e-3, atol=0.1)


def test_only_what_is_near_the_belt_is_hot_and_the_motion_is_known(ground):
    heat, trace = ground.field.heat, ground.field.trace
    pressure = np.asarray(trace["peak_pressure"])
    touched, pressed = pressure > 0, pressure > 0.5 * pressure.max()
    assert heat["rise"][pressed].min() > 0.1 * heat["rise"].max()
    assert heat["rise"][~touched].max() < 0.9 * heat["rise"].max()
    assert pressed[heat["rise"].argmax()]
    assert set(np.unique(heat["motion"][touched])) <= set(range(len(ground.motions["program"])))


def test_the_verdict_tells_the_hottest_place_with_its_range(ground):
    heat = ground.verdict["heat"]
    worst = heat["worst"]
    assert not [
        error for _, error in schemas.problems(ground.verdict, schemas.schema("verdict"), "verdict")
    ]
    rise = ground.field.heat["rise"].max()
    assert worst["temperature_C"] == pytest.approx(20.0 + rise)
    likely = 0.45 * 0.65
    assert worst["least_C"] == pytest.approx(20.0 + rise * 0.3 * 0.5 / likely)
    assert worst["greatest_C"] == pytest.approx(20.0 + rise * 0.6 * 0.8 / likely)
    over = heats.temperatures(ground.job, ground.field) > 30.0
    area = np.asarray(ground.field.areas)
    assert heat["burnt_share"] == pytest.approx(area[over].sum() / area.sum(), rel=1e-5)
    assert heat["burnt_share"] <= heat["perhaps_burnt_share"]
    assert "hottest" in verdicts.text(ground.verdict)


def test_burning_is_an_event_and_what_is_only_possible_a_warning(ground):
    worst = ground.verdict["heat"]["worst"]
    event = next(e for e in ground.events if e["kind"] == "burn_risk")
    assert (event["severity"], event["unit"], event["limit"]) == ("error", "°C", 30.0)
    assert event["value"] == pytest.approx(worst["temperature_C"], rel=0.1)
    assert event["point"] is not None
    between = 0.5 * (worst["temperature_C"] + worst["greatest_C"])
    event = next(e for e in run(burn_temperature_C=between).events if e["kind"] == "burn_risk")
    assert event["severity"] == "warning"
    assert "burn_risk" not in run(burn_temperature_C=worst["greatest_C"] + 5).summary["events"]


def test_without_a_limit_it_is_said_that_nothing_is_judged():
    result = run()
    assert "burn_risk" not in result.summary["events"]
    assert any("heat.burn_temperature_C" in str(warning) for warning in result.summary["warnings"])
    assert result.verdict["heat"]["burnt_share"] is None


def test_result_files_and_report_have_it(ground, tmp_path):
    ground.write(tmp_path / "out")
    back = Result.read(tmp_path / "out")
    assert np.array_equal(back.field.heat["rise"], ground.field.heat["rise"])
    assert np.array_equal(back.field.heat["motion"], ground.field.heat["motion"])
    assert back.verdict["heat"] == json.loads(json.dumps(ground.verdict["heat"]))
    html = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "Greatest temperature" in html and "a test" in html


def test_heat_of_earlier_programs_is_there():
    job = plate_job()
    job["heat"] = dict(STEEL)
    alone = beltgrinding.run(job).field.heat["rise"].max()
    job["programs"] = [job["programs"][0], job["programs"][0]]
    assert beltgrinding.run(job).field.heat["rise"].max() > 1.01 * alone


def test_wrong_values_are_named():
    for wrong, told in (
        ({"friction": [0.6, 0.3]}, "heat.friction"),
        ({"partition": [0.5, 1.2]}, "partition"),
        ({"conductivity_W_mK": 0}, "conductivity_W_mK"),
        ({"colour": "red"}, "colour"),
    ):
        with pytest.raises(InputError, match=told):
            run(**wrong)
    job = plate_job()
    job["heat"] = {"friction": [0.3, 0.6], "partition": [0.5, 0.8]}
    with pytest.raises(InputError, match="conductivity_W_mK"):
        beltgrinding.run(job)


def test_a_rigid_tool_has_no_heat():
    job = plate_job()
    job["law"] = {"model": "geometric"}
    job["belt_machine"]["control"] = "position"
    job["heat"] = dict(STEEL)
    result = beltgrinding.run(job)
    assert result.field.heat is None and "heat" not in result.verdict
    assert any("no temperatures" in str(warning) for warning in result.summary["warnings"])


def test_a_study_of_its_properties_tells_the_temperatures(tmp_path):
    job = plate_job()
    job["heat"] = {**STEEL, "burn_temperature_C": 30.0}
    vary = [{"key": "heat.conductivity_W_mK", "values": [7, 15, 60]}]
    grid = {"method": "grid"}
    found = beltgrinding.study({"job": job, "vary": vary, "design": grid}, tmp_path, workers=0)
    hottest = [float(value) for value in found.table["heat.worst.temperature_C"]]
    assert hottest[0] > hottest[1] > hottest[2] > 20.0
    assert all(a < float(b) for a, b in zip(hottest, found.table["heat.worst.greatest_C"]))
    assert all(float(value) > 0.0 for value in found.table["heat.burnt_share"])
    plain = beltgrinding.study(
        {
            "job": plate_job(),
            "vary": [{"key": "belt_machine.force_N", "values": [20, 30]}],
            "design": grid,
        },
        tmp_path / "plain",
        workers=0,
    )
    assert not [name for name in plain.table.columns if name.startswith("heat")]
