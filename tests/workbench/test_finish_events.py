"""Events of zones whose finish is not what they call for: they say what the verdict says. The roughness is of a made-up
belt."""

import copy
import json
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.base.messages import event_message
from beltgrinding.cell import events as event_lists, motions
from beltgrinding.inspection import finish_events, finish_zones, verdict as verdicts
from beltgrinding.job.typed import typed
from beltgrinding.simulation.result import Result
from beltgrinding.reporting import language
from beltgrinding.studies import figures, names
from support import synthetic_finish as made_up
from support.results import unseal
from test_finish import ALONG, crossing_job, finish_job, zone

ROOT = Path(__file__).resolve().parents[2]

KINDS = {finish_events.ROUGH, finish_events.LAY, finish_events.UNKNOWN}


def lined(job):
    """With lines in its programs: 100 times the program's number from 1, and the pose's from 0."""
    for number, program in enumerate(job["programs"], 1):
        for k, pose in enumerate(program["poses"]):
            pose["line"] = 100 * number + k
    return job


def of_finish(result):
    return [event for event in result.events if event["kind"] in KINDS]


def judged_again(result, zones):
    """A copy of a result, judged by other zones."""
    job = finish_job(zones, **{"grit": 120})
    again = copy.copy(result)
    again.summary = dict(result.summary)
    inspection = beltgrinding.job.load.validate(job)["inspection"]
    again.verdict = verdicts.of_result(result, inspection=inspection)
    again.tell_finish(inspection)
    return again


@pytest.fixture(scope="module")
def ground():
    """One pass along the middle of a plate."""
    return beltgrinding.run(lined(finish_job()))


@pytest.fixture(scope="module")
def crossed():
    """A second program across the first."""
    return beltgrinding.run(lined(crossing_job()))


DEMANDS = [
    ({"Ra_max_um": 3.0}, "roughness_exceeded", ["roughness_exceeded", "finish_untouched"]),
    ({"Ra_max_um": 0.9, "acceptance": "T16%"}, "roughness_exceeded", ["roughness_exceeded"]),
    (
        {"Ra_max_um": 3.2},
        None,
        [],
    ),  # as what was not ground: kept in single precision, and not above
    ({"lay": "=", "lay_direction": [0, 1, 0]}, "wrong_lay", ["wrong_lay", "lay_turned"]),
    ({"lay": "=", "lay_direction": ALONG}, "finish_unknown", ["lay_unknown", "finish_no_pass"]),
    ({"lay": "=", "lay_direction": [0, 0, 1]}, "finish_unknown", ["lay_unknown", None]),
    ({"lay": "X"}, "wrong_lay", ["wrong_lay", "lay_one_way"]),
    ({"lay": "C", "lay_centre_mm": [-900, 20, 0]}, "wrong_lay", ["wrong_lay", "lay_turned"]),
]


@pytest.mark.parametrize("asked, kind, codes", DEMANDS)
def test_events_say_what_the_verdict_says(ground, asked, kind, codes):
    result = judged_again(ground, [zone(**asked)])
    found = of_finish(result)
    assert not schemas.problems(result.events, event_lists.schema(), "events")
    assert not list(schemas.problems(result.verdict, schemas.schema("verdict"), "verdict"))
    told = result.verdict["zones"][0]["finish"]
    part = told.get("Ra") or told["lay"]
    if kind is None:
        assert not found and part["verdict"] == "pass"
        return
    (event,) = found
    assert event["kind"] == kind and event["severity"] in ("error", "warning")
    assert (kind == "finish_unknown") == (part["verdict"] == "unknown")
    assert (kind != "finish_unknown") == (part["verdict"] == "fail")
    said = [fact["code"].removeprefix("event.") for fact in event["facts"]]
    assert [code for code in codes if code] == said[: len([code for code in codes if code])]
    assert "'face'" in event["message"] and "'face'" in event_message(event, "de")
    assert event_message(event, "de") != event["message"]
    assert event["value"] > event["limit"] and event["advice"]
    x, y, _ = event["point"]
    assert 0 <= x <= 60 and 0 <= y <= 40 and event["face"] == 1


def test_the_place_the_line_and_the_time_are_of_the_pass_that_left_it_so(ground):
    passes = np.asarray(ground.field.finish["passes"]) > 0
    rough = np.where(passes, np.asarray(ground.field.finish["roughness"]), 0.0)
    result = judged_again(ground, [zone(lay="⊥", lay_direction=ALONG)])
    (event,) = of_finish(result)
    assert (event["program"], event["pose"], event["line"]) == (0, 1, 101)
    x, y, _ = event["point"]
    assert passes[np.linalg.norm(ground.field.points - event["point"], axis=1).argmin()]
    # From x = 10 to x = 50 mm at 30 mm/s.
    assert event["time"] == event["worst_time"] == pytest.approx(min(max(x - 10, 0), 40) / 30)
    share = float(np.asarray(ground.field.areas)[passes].sum() / ground.field.areas.sum())
    assert event["value"] == pytest.approx(100 * share, rel=1e-5) and event["limit"] == 0.0
    # Of what passes left it is the roughest, though what none touched is rougher.
    (event,) = of_finish(judged_again(ground, [zone(Ra_max_um=0.9)]))
    assert (
        event["line"] == 101 and event["value"] == pytest.approx(rough.max()) and rough.max() < 3.2
    )
    assert np.allclose(event["point"], ground.field.points[rough.argmax()])
    # Where passes left what is called for it is what they missed; no line did it, and the end is when it is known.
    (event,) = of_finish(judged_again(ground, [zone(Ra_max_um=3.0)]))
    assert event["line"] == 0 and event["time"] == pytest.approx(40 / 30)
    assert event["value"] == pytest.approx(3.2) and event["value"] > rough.max()
    area = np.asarray(ground.field.areas)
    share = 100 * area[~passes].sum() / area.sum()
    assert event["facts"][1]["arguments"]["percent"] == pytest.approx(share, rel=1e-5)


def test_each_zone_and_each_failure_is_one_event_by_its_own_program(crossed):
    """A first program across all, a second over it: zones are judged apart."""
    faces = [
        {**zone(Ra_max_um=0.1, lay="X"), "name": "both"},
        {"name": "none asked", "tolerance_mm": [0, 1]},
    ]
    result = judged_again(crossed, faces[:1])
    found = {event["kind"]: event for event in of_finish(result)}
    assert set(found) == {"roughness_exceeded", "wrong_lay"} and len(of_finish(result)) == 2
    assert [event["time"] for event in result.events] == sorted(e["time"] for e in result.events)
    # The later zone has the samples: the first one holds none, which is told and not passed.
    result = judged_again(crossed, faces)
    assert {event["kind"] for event in of_finish(result)} == {"finish_unknown"}
    for event in of_finish(result):
        assert event["point"] is None and event["facts"][1]["code"] == "event.finish_no_sample"
    assert result.verdict["zones"][0]["finish"]["verdict"] == "unknown"
    # By the last program, whose belt crosses what the first one left.
    result = judged_again(crossed, [zone(lay="=", lay_direction=[0, 1, 0])])
    (event,) = of_finish(result)
    assert (event["program"], event["line"]) == (0, 101)  # farthest off: along the first one's
    tolerant = zone(lay="=", lay_direction=[0, 1, 0], lay_tolerance_deg=90)
    (event,) = of_finish(judged_again(crossed, [tolerant]))
    assert event["facts"][1]["code"] == "event.lay_crossed" and event["program"] == 1
    assert event["line"] == 201
    begin = crossed.summary["process_time_s"] / 2
    assert begin < event["time"] < crossed.summary["process_time_s"]


def test_scratches_that_a_pass_wears_off_are_told_so():
    result = beltgrinding.run(lined(crossing_job(rest_per_pass=0.01)))
    given = typed(result.job).finish
    samples = np.nan_to_num(np.asarray(result.field.finish["crossing"])) > 1.0
    assert samples.any()
    judged = {"symbol": "X", "worst": {"angle_deg": None, "crossing_deg": 90.0}}
    assert finish_events._why_wrong(given, judged, {}).code == "event.lay_worn_off"
    judged["worst"]["crossing_deg"] = 5.0
    kept = replace(given, rest_per_pass=0.5)
    assert finish_events._why_wrong(kept, judged, {}).code == "event.lay_not_crossed"


def test_sixteen_percent_leave_less_to_be_unknown_where_some_are_beyond(ground):
    ra = np.asarray(ground.field.finish["roughness"])
    area = np.asarray(ground.field.areas)
    share = float(area[ra < 3.2 - 1e-3].sum() / area.sum())  # what was ground
    assert share > 0.2
    result = judged_again(ground, [zone(lay="⊥", lay_direction=[0, 1, 0], acceptance="T16%")])
    (event,) = of_finish(result)
    assert event["kind"] == "finish_unknown" and event["limit"] == pytest.approx(16.0)
    assert event["value"] == pytest.approx(
        100 * result.verdict["zones"][0]["finish"]["lay"]["unknown_share"]
    )
    judged = {
        "limit_um": 1.0,
        "above_share": 0.1,
        "unknown_share": 0.08,
        "unknown": {"reason": "feed", "place": None},
    }
    _, value, limit, _, facts = finish_events._of_unknown("z", "T16%", "Ra", judged)
    assert (value, limit) == (pytest.approx(8.0), pytest.approx(6.0)) and "feed" in facts[1]


@pytest.mark.parametrize(
    "changes, reason",
    [
        ({"model": None, "grit": None}, "no_model"),
        ({"initial_Ra_um": None}, "unsettled"),
        ({"feed": True}, "feed_outside"),
        ({"pressure": True}, "pressure_outside"),
    ],
)
def test_what_is_not_known_has_its_reason_and_a_place(changes, reason):
    narrow = {"feed": ("feed_mm_s", [60.0, 120.0]), "pressure": ("pressure_MPa", [5.0, 6.0])}
    model = made_up.model()
    for name in set(changes) & set(narrow):
        key, span = narrow[name]
        model["ranges"][key] = span
    given = {name: value for name, value in changes.items() if name not in narrow}
    job = finish_job([{**zone(Ra_max_um=9.0), "name": "strip"}], **{"model": model, **given})
    result = beltgrinding.run(lined(job))
    (event,) = of_finish(result)
    assert event["kind"] == "finish_unknown"
    codes = [fact["code"] for fact in event["facts"]]
    if reason in ("no_model", "unsettled") and "initial_Ra_um" in changes:
        # Most of the plate is untouched, whose roughness is not known either.
        assert codes[1] in ("event.finish_no_pass", f"event.finish_{reason}")
    else:
        assert codes[1] == f"event.finish_{reason}" and event["line"] == 101
    assert result.summary["events"]["finish_unknown"] == 1


def test_what_a_pass_outside_of_the_measurements_leaves_is_told_as_that():
    """Ra before grinding is given: what is not known is left by the first program, whose feed was not measured."""
    job = crossing_job()
    for pose in job["programs"][0]["poses"]:
        pose["feed_mm_s"] = 10
    result = beltgrinding.run(lined(job))
    assert result.verdict["finish"]["outside_shares"]["feed"] > 0.1
    codes = [fact["code"] for fact in result.verdict["note_facts"]]
    assert "inspection.finish_pass_before" in codes and "inspection.finish_unsettled" not in codes
    both = np.flatnonzero(np.asarray(result.field.finish["passes"]) == 2)
    asked = {"Ra_max_um": 9.0, "acceptance": "Tmax"}
    judged = finish_zones.judge_zone(result.job, result.field, asked, both, result.motions)
    assert (
        judged["Ra"]["verdict"] == "unknown" and judged["Ra"]["unknown"]["reason"] == "pass_before"
    )
    assert judged["Ra"]["unknown"]["place"]["line"] == 201
    event = finish_events._of_unknown("z", "Tmax", "Ra", judged["Ra"])
    assert event[-1][1].code == "event.finish_pass_before"


def test_a_rigid_tools_zone_is_told_though_nothing_was_computed():
    job = finish_job([zone(Ra_max_um=1.0)])
    job["law"] = {"model": "geometric"}
    job["belt_machine"]["control"] = "position"
    (event,) = of_finish(beltgrinding.run(job))
    assert event["kind"] == "finish_unknown" and event["point"] is None
    assert event["facts"][1]["code"] == "event.finish_not_computed"


def test_no_zone_calls_for_it_no_event(ground):
    assert not of_finish(ground)
    assert not of_finish(judged_again(ground, [{"name": "a", "tolerance_mm": [-1, 1]}]))


@pytest.mark.slow
def test_files_counts_and_a_studys_columns_have_them(tmp_path):
    job = lined(finish_job([zone(Ra_max_um=3.0, lay="X")]))
    path = tmp_path / "job.json"
    path.write_text(json.dumps(job))
    call = lambda *words: subprocess.run(
        [ROOT / "tools" / "beltgrind", *words], capture_output=True, text=True
    )
    done = call("run", path, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    result = Result.read(tmp_path / "out")
    assert [event["kind"] for event in of_finish(result)] == ["wrong_lay", "roughness_exceeded"]
    assert result.summary["events"]["wrong_lay"] == 1
    told = figures.of_result(result)
    assert told["events.roughness_exceeded"] == 1 and told["events.finish_unknown"] == 0
    assert told["events_in_all"] == len(result.events)
    columns = figures.usual(result.job)
    assert told["zones.face.finish.Ra.max_um"] == pytest.approx(3.2)
    assert 0.3 < told["zones.face.finish.lay.off_share"] < 0.4
    assert {"zones.face.finish.Ra.max_um", "zones.face.finish.lay.off_share"} <= set(columns)
    english = language.Language("en")
    assert names.figure("zones.face.finish.Ra.max_um", english) == "zone face: greatest Ra, µm"
    # Judged by other zones, verdict.json and events.json go on saying the same.
    job["inspection"]["zones"] = [zone(Ra_max_um=3.3)]
    path.write_text(json.dumps(job))
    done = call("verdict", tmp_path / "out", "--job", path, "-o", tmp_path / "other.json")
    assert done.returncode == 0 and Result.read(tmp_path / "out").events == result.events
    done = call("verdict", tmp_path / "out", "--job", path)
    assert done.returncode == 0, done.stderr
    again = Result.read(tmp_path / "out")
    assert not of_finish(again) and again.verdict["zones"][0]["finish"]["verdict"] == "pass"
    assert "wrong_lay" not in again.summary["events"]
    assert again.judged_by()["zones"][0]["finish"]["Ra_max_um"] == 3.3
    report = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "the limits of another job" in report
    done = call("verdict", tmp_path / "out")
    assert done.returncode == 0 and Result.read(tmp_path / "out").events == result.events
    assert "judged_by" not in Result.read(tmp_path / "out").summary
    report = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "the limits of another job" not in report


def test_an_earlier_versions_result_has_none_and_stays_so(ground, tmp_path):
    ground.write(tmp_path / "out")
    unseal(tmp_path / "out")
    table = tmp_path / "out" / motions.FILE
    rows = [line.rpartition(",")[0] for line in table.read_text().splitlines()]
    table.write_text("\n".join(rows) + "\n")
    old = Result.read(tmp_path / "out")
    assert "time" not in old.motions
    assert motions.csv_text(old.motions) == table.read_text()
    assert not of_finish(judged_again(old, [zone(Ra_max_um=0.1)]))
    html = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "Roughness exceeded" not in html


def test_the_report_tells_them_in_both_languages(ground, tmp_path):
    judged_again(ground, [zone(Ra_max_um=0.9)]).write(tmp_path / "out")
    html = beltgrinding.report(tmp_path / "out").read_text(encoding="utf-8")
    assert "Roughness exceeded" in html and "finer grit" in html
    html = beltgrinding.report(tmp_path / "out", language="de").read_text(encoding="utf-8")
    assert "Rauheit überschritten" in html and "feinerer Körnung" in html


def test_a_moment_lies_on_its_motion(crossed):
    ways = crossed.motions
    assert len(ways["time"]) == 4
    assert ways["time"][-1] == pytest.approx(crossed.summary["process_time_s"])
    begin, end = ways["point"][0], ways["point"][1]
    assert motions.time_at(ways, 1, 0.25 * end + 0.75 * begin) == pytest.approx(
        0.25 * ways["time"][1]
    )
    assert motions.time_at(ways, 1, end + 99) == pytest.approx(ways["time"][1])
    assert motions.time_at(ways, 2, begin) == ways["time"][2]  # of another program


def test_words_of_the_verdict_tell_what_it_hangs_on(ground):
    """Heights in tolerance and finish are told apart, by the command line, window and report."""
    lenient = {"tolerance_mm": [-9, 9]}
    for asked, overall, words in (
        ({"Ra_max_um": 3.0}, "fail", "not as called for"),
        ({"lay": "=", "lay_direction": ALONG}, "unknown", "not all known"),
    ):
        result = judged_again(ground, [{**zone(**asked), **lenient}])
        assert result.verdict["overall"] == overall and finish_zones.decides(result.verdict) == 1
        told = verdicts.text(result.verdict)
        assert (
            f"in tolerance, but its finish is {words}" in told
            and "beyond" not in told.split("finish")[0]
        )
        # Too much left elsewhere is more than a matter of the finish.
        result.verdict["zones"][0]["above_share"] = 0.1
        assert finish_zones.decides(result.verdict) == 0
