"""The finish of zones as document objects, without a window: its events and its verdict say the same, also by other zones.
The roughness is of a made-up belt."""

import json
from pathlib import Path

import pytest
import FreeCAD

import beltgrinding
from beltgrinding import cli
from support import synthetic_finish
from support.block import HEADER, block, make, write_pass


def zone(**finish):
    return {"name": "top", "finish": finish}


def told(simulation):
    return [
        e
        for e in simulation.Proxy.events(simulation)
        if e["kind"] in ("roughness_exceeded", "wrong_lay", "finish_unknown")
    ]


def kinds(simulation):
    return [e["kind"] for e in told(simulation)]


def agree(simulation, verdict):
    # One event for each thing that is judged and not good.
    found = [
        zone["finish"][k]["verdict"]
        for zone in verdict.Proxy.data(verdict)["zones"]
        for k in ("Ra", "lay")
        if k in zone.get("finish", {})
    ]
    assert sorted(
        "unknown" if k == "finish_unknown" else "fail" for k in kinds(simulation)
    ) == sorted(word for word in found if word != "pass"), (kinds(simulation), found)
    assert (
        simulation.EventCount == len(simulation.Proxy.events(simulation)) == len(simulation.Events)
    )
    counts = json.loads(simulation.SummaryData)["events"]
    assert sum(counts.values()) == simulation.EventCount


def with_job():
    FINISH = {"grit": 120, "initial_Ra_um": 3.2, "model": synthetic_finish.model()}
    return FINISH


@pytest.mark.freecad
def test_the_events_follow_the_zones_as_the_verdict_does():
    write_pass()
    FINISH = with_job()
    doc = FreeCAD.newDocument("life")
    doc.UndoMode = 1
    job = make(block(doc))
    job.Finish = json.dumps(FINISH)
    beltgrinding.set_zones(job, [zone(Ra_max_um=3.0)])
    simulation = beltgrinding.simulate(job)
    verdict = beltgrinding.make_verdict(job)
    assert kinds(simulation) == ["roughness_exceeded"]
    agree(simulation, verdict)
    assert any(
        line.startswith("roughness_exceeded: pass") for line in simulation.Events
    ), simulation.Events
    assert len(simulation.MotionTimes) == len(simulation.MotionPoses) == 9
    first = simulation.EventData

    doc.openTransaction("zones")
    beltgrinding.set_zones(job, [zone(Ra_max_um=3.3, lay="⊥", lay_direction=[1, 0, 0])])
    doc.commitTransaction()
    assert kinds(simulation) == ["wrong_lay"] and not simulation.OutOfDate
    (event,) = told(simulation)
    assert 2 < event["line"] <= 10 and event["point"]
    agree(simulation, verdict)
    doc.undo()
    doc.recompute()
    assert simulation.EventData == first and kinds(simulation) == ["roughness_exceeded"]
    agree(simulation, verdict)

    # Other limits of the heights leave the events as they are; without zones there are none.
    job.ToleranceUpper = "0.25 mm"
    doc.recompute()
    assert simulation.EventData == first
    beltgrinding.set_zones(job, [])
    assert not told(simulation)
    agree(simulation, verdict)

    # Where a zone cannot be, neither is judged by it.
    for wrong in (
        '[{"name": "top", "finish": {"lay": "="}}]',
        '[{"name": "top", "finish": {"lay": "P"}}]',
    ):
        job.Zones = wrong
        doc.recompute()
        assert "Invalid" in job.State and not told(simulation)
    beltgrinding.set_zones(job, [zone(Ra_max_um=3.0)])
    assert "Invalid" not in job.State and simulation.EventData == first

    doc.saveAs("life.FCStd")
    FreeCAD.closeDocument("life")
    doc = FreeCAD.openDocument("life.FCStd")
    simulation, verdict, job = doc.Simulation, doc.Verdict, doc.BeltGrindingJob
    doc.recompute()
    assert simulation.EventData == first
    beltgrinding.set_zones(job, [zone(lay="X")])
    assert kinds(simulation) == ["wrong_lay"]
    agree(simulation, verdict)

    # The result of a version that had no such events gets none.
    simulation.MotionTimes, simulation.EventZones = [], ""
    simulation.EventData, simulation.Events = "[]", []
    beltgrinding.set_zones(job, [zone(Ra_max_um=0.1)])
    assert not told(simulation) and verdict.Overall == "fail"


@pytest.mark.freecad
def test_a_result_that_was_judged_by_others_since_is_judged_by_the_document():
    write_pass()
    FINISH = with_job()
    doc = FreeCAD.newDocument("life")
    job = make(block(doc))
    job.Finish = json.dumps(FINISH)
    beltgrinding.set_zones(job, [zone(Ra_max_um=3.0)])
    simulation = beltgrinding.simulate(job, write_to="out")
    first = simulation.EventData
    beltgrinding.set_zones(job, [zone(Ra_max_um=9.0)])
    beltgrinding.export_job(job, "other.json")
    assert cli.main(["verdict", "out", "--job", "other.json"]) == 0
    assert "roughness_exceeded" not in Path("out/events.json").read_text()
    beltgrinding.set_zones(job, [zone(Ra_max_um=3.0)])
    simulation = beltgrinding.import_result(job, "out")
    verdict = beltgrinding.make_verdict(job)
    assert verdict.Proxy.data(verdict)["zones"][0]["finish"]["verdict"] == "fail"
    assert kinds(simulation) == ["roughness_exceeded"]
    agree(simulation, verdict)


@pytest.mark.freecad
def test_what_crosses_is_judged_again_as_the_run_judged_it():
    write_pass()
    FINISH = with_job()
    doc = FreeCAD.newDocument("life")
    job = make(block(doc))
    root = 0.5**0.5
    rows = [f"30,{y},20.2,0,{root},{root},0,30" for y in range(6, 36, 4)]
    Path("across.csv").write_text("\n".join([HEADER, *rows]) + "\n")
    beltgrinding.import_program(job, "across.csv")
    job.Finish = json.dumps(FINISH)
    crossed = [zone(lay="X", acceptance="T16%")]
    beltgrinding.set_zones(job, crossed)
    simulation = beltgrinding.simulate(job)
    verdict = beltgrinding.make_verdict(job)
    run, event = verdict.Proxy.data(verdict), told(simulation)
    assert run["zones"][0]["finish"]["lay"]["verdict"] == "fail"
    assert 0.0 < run["finish"]["crossed_share"] < 1.0
    beltgrinding.set_zones(job, [{**crossed[0], "tolerance_mm": [-9, 9]}])
    again = verdict.Proxy.data(verdict)
    assert (
        again["zones"][0]["finish"] == run["zones"][0]["finish"]
    ), "by the same crossing angle and rest"
    assert again["finish"] == run["finish"] and again["notes"] == run["notes"]
    assert told(simulation) == event
    # Another finish of the job is not the run's.
    job.Finish = json.dumps({**FINISH, "crossing_angle_deg": 90, "rest_per_pass": 0.01})
    beltgrinding.set_zones(job, [{**crossed[0], "tolerance_mm": [-8, 8]}])
    assert simulation.OutOfDate
    assert verdict.Proxy.data(verdict)["zones"][0]["finish"] == run["zones"][0]["finish"]
