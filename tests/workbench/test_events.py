"""Events: their form, their codes, their manual."""

import json
import math
import re
from pathlib import Path

import pytest

import beltgrinding
from beltgrinding.cell import events
from beltgrinding.base import schemas
from beltgrinding.simulation.result import Result
from beltgrinding.engine import core
from test_job import plate_job
from support.results import unseal

ROOT = Path(__file__).resolve().parents[2]


def bad_job():
    """A job whose program does several things that it should not."""
    job = plate_job()
    job["law"] = {"pressure_limit_MPa": 0.01, "heat_limit_MPa_m_s": 0.1}
    job["simulation"] = {"orientation_jump_deg": 2.0}
    job["inspection"] = {"tolerance_mm": [0.19, 0.25]}
    first, second = job["programs"][0]["poses"]
    turned = math.radians(4.0) / 2
    first["line"], second["line"] = 11, 12
    second.update(qx=math.cos(turned), qz=math.sin(turned))  # about the pressing direction
    job["programs"].append({"poses": [dict(pose) for pose in job["programs"][0]["poses"]]})
    return job


def test_events_have_the_published_form(tmp_path):
    result = beltgrinding.run(bad_job())
    assert not schemas.problems(result.events, events.schema(), "events")
    kinds = {event["kind"] for event in result.events}
    assert {"over_pressure", "burn_risk", "gouge", "orientation_jump"} <= kinds
    first_time = result.summary["process_time_s"] / 2
    for event in result.events:
        assert event["line"] == 12 and event["pose"] == 1
        assert (event["time"] >= first_time) == (event["program"] == 1)
        assert 0 <= event["worst_time"] - event["time"] <= event["duration"]
        assert event["advice"] and event["facts"]
        facts = [
            core.Fact(fact["code"], fact["text"], **fact["arguments"]) for fact in event["facts"]
        ]
        assert event["message"] == "; ".join(facts)  # Python fills a form in as the core does
        if event["kind"] != "orientation_jump":
            assert event["face"] == 1
            x, y, _ = event["point"]
            assert 0 <= x <= 60 and 0 <= y <= 40
    gouge = next(event for event in result.events if event["kind"] == "gouge")
    assert gouge["severity"] == "error" and gouge["unit"] == "mm"
    assert gouge["limit"] == pytest.approx(0.19) and gouge["value"] < 0.19
    result.write(tmp_path)
    assert json.loads((tmp_path / "events.json").read_text()) == result.events
    assert Result.read(tmp_path).events == result.events


def test_a_gouge_is_below_the_limit_of_its_zone():
    job = bad_job()
    job["inspection"]["zones"] = [{"name": "deep", "faces": [1], "tolerance_mm": [-0.5, 0.25]}]
    kinds = {event["kind"] for event in beltgrinding.run(job).events}
    assert "over_pressure" in kinds and "gouge" not in kinds


def test_a_result_of_an_older_version_still_opens(tmp_path):
    beltgrinding.run(bad_job()).write(tmp_path)
    unseal(tmp_path)
    path = tmp_path / "events.json"
    old = ("program", "kind", "pose", "line", "time", "duration", "value", "message")
    stored = [{key: event[key] for key in old} for event in json.loads(path.read_text())]
    stored[0]["kind"] = "a_kind_of_long_ago"
    path.write_text(json.dumps(stored))
    read = Result.read(tmp_path).events
    assert read[0]["severity"] == "warning" and read[0]["advice"] == ""
    assert not schemas.problems(read[1:], events.schema(), "events")
    assert [{key: event[key] for key in old} for event in read] == stored
    burnt = next(event for event in read if event["kind"] == "burn_risk")
    assert burnt["severity"] == "error" and burnt["unit"] == "MPa m/s" and burnt["point"] is None


def test_the_schema_and_the_manual_have_every_kind():
    kinds = events.kinds()
    assert events.schema()["items"]["properties"]["kind"]["enum"] == list(kinds)
    rows = {}
    for line in (ROOT / "docs" / "events.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 5 and re.fullmatch(r"`\w+`", cells[0]):
            rows[cells[0].strip("`")] = cells[1:]
    assert list(rows) == list(kinds)
    for code, (severity, unit, meaning, advice) in rows.items():
        kind = kinds[code]
        assert (severity, unit, meaning, advice) == (
            kind["severity"],
            kind["unit"],
            kind["meaning"],
            kind["advice"],
        )


def test_motions_that_are_left_out_are_not_ground_and_an_event_tells(tmp_path):
    def program(*rows):
        path = tmp_path / "p.src"
        ends = "A 0,B 0,C 180"
        lines = [row if "(" in row else f"LIN {{X {row},Z 0.2,{ends}}}" for row in rows]
        path.write_text("\n".join(["DEF p()", "$VEL.CP=0.03", *lines, "END", ""]))
        job = plate_job()
        job["programs"] = [{"file": str(path)}]
        return beltgrinding.run(job)

    whole = program("10,Y 10", "30,Y 10", "30,Y 30", "50,Y 30")
    cut = program("10,Y 10", "30,Y 10", "elsewhere()", "30,Y 30", "50,Y 30")
    assert not [e for e in whole.events if e["kind"] == "program_gap"]
    (gap,) = [e for e in cut.events if e["kind"] == "program_gap"]
    assert (gap["pose"], gap["line"], gap["severity"]) == (2, 6, "warning")
    assert gap["point"] == pytest.approx([30, 30, 0.2]) and "line 5 to line 6" in gap["message"]
    volume = [one.summary["removed_volume_mm3"] for one in (whole, cut)]
    assert volume[1] == pytest.approx(volume[0] * 2 / 3, rel=0.02)  # two of three ways of 20 mm
    assert len([m for m in cut.events if m["kind"] == "program_gap"]) == 1
    cut.write(tmp_path / "out")
    rows = json.loads((tmp_path / "out" / "events.json").read_text())
    assert any(row["kind"] == "program_gap" and row["facts"] for row in rows)
