"""The finish of a job: from the key to result file, verdict, zones, report; and nothing without it. The roughness is of
a made-up belt."""

import copy
import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.engine import InputError
from beltgrinding.inspection import (
    finish as finishes,
    finish_zones,
    verdict as verdicts,
)
from beltgrinding.simulation.result import Result
from support import synthetic_finish as made_up
from test_job import plate_job

ALONG = [1.0, 0.0, 0.0]


def finish_job(zones=(), **finish):
    job = plate_job()
    job["finish"] = {"grit": 120, "initial_Ra_um": 3.2, "model": made_up.model(), **finish}
    job["finish"] = {name: value for name, value in job["finish"].items() if value is not None}
    job["inspection"] = {"zones": list(zones)}
    return job


def zone(**finish):
    return {"name": "face", "finish": finish}


def crossing_job(**finish):
    """A second program whose belt travels square to the first one's."""
    job = finish_job(**finish)
    turned = copy.deepcopy(job["programs"][0])
    root = float(np.sqrt(0.5))
    for pose, y in zip(turned["poses"], (6, 34)):
        pose.update(x_mm=30, y_mm=y, qw=0.0, qx=root, qy=root, qz=0.0)
    job["programs"].append(turned)
    return job


@pytest.fixture(scope="module")
def ground():
    return beltgrinding.run(finish_job([zone(Ra_max_um=3.5, lay="=", lay_direction=ALONG)]))


@pytest.fixture(scope="module")
def crossed():
    return beltgrinding.run(crossing_job())


def test_without_the_key_nothing_is_computed_and_nothing_else_changes(ground):
    plain = beltgrinding.run(plate_job())
    assert plain.field.finish is None and "finish" not in plain.verdict
    assert "finish" not in plain.job
    assert np.array_equal(plain.field.height, ground.field.height)
    for name, values in plain.field.trace.items():
        assert np.array_equal(values, ground.field.trace[name]), name
    # But what the zone calls for, and is not all known.
    assert [event for event in ground.events if event["kind"] != "finish_unknown"] == plain.events


def test_ra_is_the_models_and_what_no_pass_touched_stays_as_before(ground):
    finish = ground.field.finish
    passes, ra = np.asarray(finish["passes"]), np.asarray(finish["roughness"])
    assert np.allclose(ra[passes == 0], 3.2)
    middle = np.abs(ground.field.points - [30, 20, 0]).max(axis=1) < 5
    assert (passes[middle] == 1).all()
    # By the mean pressure, which is the force over the area.
    pressure = 30.0 / float(np.median(ground.steps["contact_area"]))
    c = dict(grit=120, pressure_MPa=pressure, belt_speed_m_s=20, feed_mm_s=30, remaining_cut=1.0)
    rest = made_up.TRUTH["rest_per_pass"]
    own = float(made_up.steady(c))
    assert np.median(ra[middle]) == pytest.approx(own + rest * (3.2 - own), rel=0.03)
    assert np.allclose(np.abs(np.asarray(finish["lay"])[middle] @ ALONG), 1.0, atol=1e-4)


def test_the_verdict_tells_the_roughness_and_judges_zones(ground):
    assert not list(schemas.problems(ground.verdict, schemas.schema("verdict"), "verdict"))
    told = ground.verdict["finish"]
    assert told["known_share"] == pytest.approx(1.0) and told["crossed_share"] == 0.0
    assert told["worst"]["least_um"] < told["worst"]["Ra_um"] < told["worst"]["greatest_um"]
    assert told["worst"]["program"] == 0
    one = ground.verdict["zones"][0]["finish"]
    assert one["Ra"]["verdict"] == "pass"
    assert one["lay"]["verdict"] == "unknown" and one["lay"]["off_share"] == 0.0
    assert 0.2 < one["lay"]["unknown_share"] < 0.9  # where no pass was
    assert "roughness" in verdicts.text(ground.verdict)


@pytest.mark.parametrize(
    "asked, part, verdict",
    [
        ({"Ra_max_um": 3.0}, "Ra", "fail"),  # what was not ground has 3.2
        ({"Ra_max_um": 3.3}, "Ra", "pass"),
        ({"lay": "=", "lay_direction": [0, 1, 0]}, "lay", "fail"),
        ({"lay": "⊥", "lay_direction": [0, 1, 0]}, "lay", "unknown"),
        ({"lay": "⊥", "lay_direction": ALONG}, "lay", "fail"),
        ({"lay": "=", "lay_direction": [1, 0.5, 0]}, "lay", "fail"),
        ({"lay": "=", "lay_direction": [1, 0.5, 0], "lay_tolerance_deg": 30}, "lay", "unknown"),
        ({"lay": "R", "lay_centre_mm": [-900, 20, 0]}, "lay", "unknown"),
        ({"lay": "C", "lay_centre_mm": [-900, 20, 0]}, "lay", "fail"),
        ({"lay": "C", "lay_centre_mm": [30, -900, 0]}, "lay", "unknown"),
        ({"lay": "X"}, "lay", "fail"),
        ({"lay": "M"}, "lay", "fail"),
    ],
)
def test_zones_call_for_what_drawings_do(ground, asked, part, verdict):
    job = finish_job([zone(**asked)])
    inspection = beltgrinding.job.load.validate(job)["inspection"]
    judged = verdicts.of_result(ground, inspection=inspection)["zones"][0]
    assert judged["finish"][part]["verdict"] == verdict == judged["finish"]["verdict"]
    if verdict == "fail":
        assert judged["verdict"] == "fail"


def test_sixteen_percent_may_lie_beyond(ground):
    samples = np.arange(ground.field.size)
    ra = np.asarray(ground.field.finish["roughness"])
    order = np.sort(ra)
    limit = float(0.5 * (order[int(0.9 * len(ra))] + order[int(0.9 * len(ra)) + 1]))
    if order[-1] <= limit:  # a tenth lies above only where the rest is smoother
        limit = float(order[-1]) - 1e-3
    share = float(np.asarray(ground.field.areas)[ra > limit].sum() / ground.field.areas.sum())
    for acceptance in ("Tmax", "T16%"):
        asked = {"Ra_max_um": limit, "acceptance": acceptance}
        judged = finish_zones.judge_zone(ground.job, ground.field, asked, samples)
        allowed = 0.16 if acceptance == "T16%" else 0.0
        assert judged["Ra"]["above_share"] == pytest.approx(share, abs=1e-6)
        assert judged["Ra"]["verdict"] == ("fail" if share > allowed else "pass")


def test_crossed_scratches_are_marked_where_both_stay(crossed):
    finish = crossed.field.finish
    passes = np.asarray(finish["passes"])
    across = finishes.crossed_of(crossed.job, crossed.field)
    assert across.any() and (across == (passes == 2)).all()
    assert np.allclose(np.asarray(finish["crossing"])[across], np.pi / 2, atol=1e-3)
    told = crossed.verdict["finish"]["crossed_share"]
    area = np.asarray(crossed.field.areas)
    assert told == pytest.approx(area[across].sum() / area[passes > 0].sum(), rel=1e-5)
    samples = np.flatnonzero(across)
    asked = {"acceptance": "Tmax", "lay": "X", "lay_tolerance_deg": 15}
    assert finish_zones.judge_zone(crossed.job, crossed.field, asked, samples)["verdict"] == "pass"
    asked.update(lay="=", lay_direction=[0, 1, 0])  # the last lay is right, an earlier one stays
    assert finish_zones.judge_zone(crossed.job, crossed.field, asked, samples)["verdict"] == "fail"
    # A pass that leaves nothing of what was leaves no crossed scratches.
    gone = beltgrinding.run(crossing_job(rest_per_pass=0.01))
    assert not finishes.crossed_of(gone.job, gone.field).any()


def test_without_measurements_there_is_a_lay_and_no_roughness():
    result = beltgrinding.run(finish_job([zone(Ra_max_um=9.0)], model=None, grit=None))
    codes = [fact["code"] for fact in result.summary["warning_facts"]]
    assert "simulation.no_finish_model" in codes
    ground = np.asarray(result.field.finish["passes"]) > 0
    assert np.isnan(np.asarray(result.field.finish["roughness"])[ground]).all()
    assert np.asarray(result.field.finish["lay"])[ground].any(axis=1).all()
    told = result.verdict["finish"]
    assert told["Ra_um"] is None and told["worst"] is None and told["source"] is None
    assert result.verdict["zones"][0]["finish"]["verdict"] == "unknown"


def test_unknown_before_is_unknown_after_few_passes_and_told():
    result = beltgrinding.run(finish_job(initial_Ra_um=None))
    assert result.verdict["finish"]["known_share"] == 0.0  # a pass leaves a third of it
    assert "inspection.finish_unsettled" in [f["code"] for f in result.verdict["note_facts"]]
    model = {k: v for k, v in made_up.model().items() if k != "rest_per_pass"}
    result = beltgrinding.run(finish_job(initial_Ra_um=None, model=model))
    assert result.verdict["finish"]["known_share"] == pytest.approx(1.0)
    assert result.verdict["finish"]["crossed_share"] is None
    codes = [fact["code"] for fact in result.summary["warning_facts"]]
    assert "simulation.no_rest_per_pass" in codes


def test_outside_of_the_measurements_nothing_is_told_and_the_reason_is():
    model = made_up.model()
    model["ranges"]["feed_mm_s"] = [60.0, 120.0]
    result = beltgrinding.run(finish_job(model=model))
    told = result.verdict["finish"]
    assert told["outside_shares"]["feed"] == pytest.approx(1.0) and told["Ra_um"] is None
    assert "inspection.finish_outside" in [f["code"] for f in result.verdict["note_facts"]]
    with pytest.raises(InputError) as refused:
        beltgrinding.run(finish_job(grit=36))
    assert refused.value.code == "job.grit_not_measured"


def test_a_worn_belt_scratches_otherwise():
    job = finish_job()
    # So little that it does not press otherwise on what it leaves.
    job["law"] = {"coefficient_mm2_per_N": 1e-7}
    fresh = beltgrinding.run(job)
    job["belt_machine"]["belt_wear"] = 0.6
    worn = beltgrinding.run(job)
    passes = np.asarray(worn.field.finish["passes"]) > 0
    one, other = (np.asarray(r.field.finish["roughness"])[passes] for r in (fresh, worn))
    rest = made_up.TRUTH["rest_per_pass"]
    own = lambda ra: (np.median(ra) - rest * 3.2) / (1 - rest)
    assert own(other) / own(one) == pytest.approx(0.6 ** made_up.TRUTH["wear_exponent"], rel=0.02)


def test_result_files_and_report_have_it(ground, tmp_path):
    ground.write(tmp_path / "out")
    back = Result.read(tmp_path / "out")
    for name, values in ground.field.finish.items():
        assert np.array_equal(values, back.field.finish[name], equal_nan=True), name
    assert back.verdict["finish"] == json.loads(json.dumps(ground.verdict["finish"]))
    html = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "Roughness Ra" in html and "SYNTHETIC" in html and "lay =" in html


@pytest.mark.parametrize(
    "zones, finish, code",
    [
        ([zone(lay="P")], {}, "job.lay_particulate"),
        ([zone(lay="=")], {}, "job.lay_incomplete"),
        ([zone(lay="C", lay_direction=ALONG)], {}, "job.lay_incomplete"),
        ([zone(lay="=", lay_direction=[0, 0, 0])], {}, "job.lay_direction"),
        ([zone()], {}, "job.zone_finish_empty"),
        ([], {"grit": None}, "job.finish_without_grit"),
    ],
)
def test_wrong_values_are_named(zones, finish, code):
    with pytest.raises(InputError) as refused:
        beltgrinding.job.load.validate(finish_job(zones, **finish))
    assert refused.value.code == code


def test_a_zone_cannot_call_for_what_is_not_computed():
    job = plate_job()
    job["inspection"] = {"zones": [zone(Ra_max_um=1.0)]}
    with pytest.raises(InputError) as refused:
        beltgrinding.job.load.validate(job)
    assert refused.value.code == "job.zone_without_finish"
    model = made_up.model()
    model["ranges"]["grit"] = [400.0, 60.0]
    with pytest.raises(InputError) as refused:
        beltgrinding.job.load.validate(finish_job(model=model))
    assert refused.value.code == "job.finish_range"


def test_a_rigid_tool_has_no_finish():
    job = finish_job()
    job["law"] = {"model": "geometric"}
    job["belt_machine"]["control"] = "position"
    result = beltgrinding.run(job)
    assert result.field.finish is None and "finish" not in result.verdict
    codes = [fact["code"] for fact in result.summary["warning_facts"]]
    assert "simulation.no_finish_of_rigid" in codes
