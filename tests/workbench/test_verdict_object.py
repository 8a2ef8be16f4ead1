"""The verdict and the tolerance zones as document objects, without a window."""

import json
from pathlib import Path

import pytest
import FreeCAD

import beltgrinding
from beltgrinding import InputError
from support.block import REMOVED, block, make, near, write_pass


@pytest.mark.freecad
def test_the_verdict_follows_result_zones_and_tolerance():
    write_pass()
    doc = FreeCAD.newDocument("life")
    job = make(block(doc))
    try:
        beltgrinding.make_verdict(job)
        raise AssertionError("there is no result")
    except InputError as error:
        assert "simulate first" in str(error)
    simulation = beltgrinding.simulate(job)
    verdict = beltgrinding.make_verdict(job)
    assert beltgrinding.make_verdict(job) is verdict and verdict.getParentGroup() is job
    assert verdict.Overall == "fail" and verdict.FacesFailed == verdict.ZonesFailed == 1
    assert len(verdict.FaceVerdicts) == 1 and verdict.FaceVerdicts[0].startswith("Face6: fail")
    assert near(verdict.RemovedVolume.Value, REMOVED) and verdict.ClustersAbove == 1
    assert verdict.LargestCluster.Value > 1000 and verdict.UntouchedArea.Value > 1000
    assert near(verdict.WorstBeyond.Value, 0.15) and near(verdict.Worst.Value, 0.2)
    data = verdict.Proxy.data(verdict)
    assert data["clusters"][0]["motions"][0]["program"] == 0
    assert data["programs"] == [{"name": "pass", "first_motion": 0}]
    motions = simulation.Proxy.motions(simulation)
    assert list(motions["line"]) == list(range(2, 11)) and len(motions["point"]) == 9

    # Zones are judged again without simulating; a wrong one is refused and changes nothing.
    beltgrinding.set_zones(job, [{"name": "top", "faces": [6], "tolerance_mm": [-0.1, 0.25]}])
    assert verdict.Overall == "pass" and not verdict.OutOfDate and verdict.ClustersAbove == 0
    assert verdict.ZoneVerdicts[0].startswith("top: pass")
    before = job.Zones
    for wrong in (
        {"name": "x"},
        {"name": "x", "faces": [5], "tolerance_mm": [0, 1]},
        {"tolerance": 1},
    ):
        try:
            beltgrinding.set_zones(job, [wrong])
            raise AssertionError(wrong)
        except InputError:
            assert job.Zones == before
    beltgrinding.set_zones(job, [{"name": "plate", "thickness_mm": [-0.1, 0.19]}])
    thick = verdict.Proxy.data(verdict)["zones"][0]["thickness"]
    assert thick["verdict"] == "fail" and near(thick["design_mm"]["min"], 20.0)
    assert near(thick["deviation_mm"]["max"], 0.2)
    job.Zones = json.dumps([{"name": "a", "tolerance_mm": [1, 0]}])
    doc.recompute()
    assert "Invalid" in job.State
    beltgrinding.set_zones(job, [])
    assert "Invalid" not in job.State

    # The figures of sections, of the faces' outline as far as it goes; another result is not asked for.
    asked = {"name": "across", "point_mm": [0, 0, 0], "normal": [1, 0, 0]}
    for normal in ([1, 0], "x"):
        try:
            beltgrinding.set_sections(job, [{**asked, "normal": normal}])
            raise AssertionError(normal)
        except InputError:
            assert not job.Sections
    beltgrinding.set_sections(job, [{**asked, "point_mm": [20, 0, 0]}])
    (told,) = verdict.Proxy.data(verdict)["sections"]
    assert told["ground"]["leading"]["state"] == "open" and not verdict.OutOfDate
    beltgrinding.set_sections(job, [{**asked, "point_mm": [900, 0, 0]}])
    assert verdict.Proxy.data(verdict)["sections"][0]["ground"] is None
    assert "misses the faces" in verdict.Notes[-1]
    beltgrinding.set_sections(job, [])
    assert "sections" not in verdict.Proxy.data(verdict)

    # A simulation by zones keeps its verdict; the job's file has them, and what was not resolved.
    beltgrinding.set_zones(job, [{"name": "top", "faces": [6], "tolerance_mm": [-0.1, 0.25]}])
    doc.RobotPath.Problems = ["pass.csv:3: unknown", "pass.csv:4: unknown"]
    simulation = beltgrinding.simulate(job, write_to="out")
    assert verdict.Overall == "pass" and verdict.UnresolvedMotions == 2
    written = json.loads(Path("out/verdict.json").read_text())
    assert written.pop("run_id") and written == verdict.Proxy.data(verdict)
    beltgrinding.export_job(job, "job.json")
    exported = json.loads(Path("job.json").read_text())
    assert exported["inspection"]["zones"][0]["name"] == "top"
    assert exported["programs"][0]["unresolved"] == 2
    doc.BeltMachine.Force = "31 N"
    doc.recompute()
    assert verdict.OutOfDate
    doc.BeltMachine.Force = "30 N"
    doc.saveAs("life.FCStd")
    shown, text = verdict.Shown, verdict.Data
    FreeCAD.closeDocument("life")
    doc = FreeCAD.openDocument("life.FCStd")
    verdict = doc.Verdict
    doc.recompute()
    assert (verdict.Shown, verdict.Data) == (shown, text), (verdict.Shown, shown)
    assert verdict.Overall == "pass", (verdict.Overall, verdict.FaceVerdicts)
    doc.BeltGrindingJob.Zones = ""
    doc.recompute()
    assert verdict.Overall == "fail" and verdict.UnresolvedMotions == 2
    assert verdict.Proxy.data(verdict)["clusters"][0]["motions"][0]["line"] is not None

    # A result that was computed elsewhere brings its verdict; the job comes back with its zones.
    other = beltgrinding.open_job(FreeCAD.newDocument("other"), "job.json")
    assert json.loads(other.Zones)[0]["faces"] == [6]
    beltgrinding.import_result(other, "out")
    assert beltgrinding.make_verdict(other).Overall == "pass"
