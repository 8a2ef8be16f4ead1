"""Files that earlier versions of the workbench wrote (tests/gui/documents): they open and work on."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui

import beltgrinding
from beltgrinding.objects.proxy import type_of
from support.hands import field, menu, press, settle, type_in, wait
from support.picture import coloured

FOLDER = Path(__file__).parent / "documents"
STATES = sorted(path.name for path in FOLDER.iterdir() if (path / "document.FCStd").exists())


def opened(old):
    Gui.activateWorkbench("BeltGrindingWorkbench")
    doc = FreeCAD.openDocument(str(old / "document.FCStd"))
    settle()
    job = doc.BeltGrindingJob
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    return SimpleNamespace(doc=doc, job=job, view=view)


@pytest.fixture(params=STATES)
def old(request, tmp_path):
    """A copy of a state's folder: opening may write beside it."""
    return Path(shutil.copytree(FOLDER / request.param, tmp_path / request.param))


def test_there_is_a_state_of_every_issue():
    assert len(STATES) == 5


@pytest.mark.slow
@pytest.mark.freecad(window=True)
def test_a_document_opens_with_its_result(old):
    here = opened(old)
    doc, job, view = here.doc, here.job, here.view
    assert not [o.Name for o in doc.Objects if "Invalid" in o.State]
    assert job.Spacing.Value == 2 and abs(job.ToleranceUpper.Value - 0.04) < 1e-12
    assert doc.Stock.Allowance.Value == 0.2 and doc.BeltMachine.Force.getValueAs("N") == 20
    assert doc.BeltMachine.WheelRadius.Value == 30 and len(doc.RobotPath.Poses) == 5
    simulation, deviation = doc.Simulation, doc.Deviation
    field_ = simulation.Proxy.field(simulation)
    assert field_.size == simulation.Samples > 20 and simulation.RemovedVolume.Value > 0.5
    assert len(deviation.VertexColors) == deviation.Mesh.CountPoints == field_.size
    recorded = simulation.Proxy.recording(simulation)
    assert (recorded is not None) == (old.name >= "5")
    assert recorded is None or recorded[0].samples == field_.size
    assert deviation.ViewObject.Coloring and 0 < deviation.InTolerance < 100

    # Whatever an object of today has, it has; of the same kind, with the same choices.
    fresh = beltgrinding.open_job(FreeCAD.newDocument("fresh"), old / "job.json")
    made = {type_of(o): o for o in [fresh, *fresh.Group]}
    made[type_of(made["BeltGrinding::BeltMachine"].Proxy) or "belt"] = beltgrinding.make_belt(fresh)
    beltgrinding.simulate(fresh)
    beltgrinding.make_deviation(fresh)
    beltgrinding.make_section(fresh)
    beltgrinding.make_raster(fresh, StepOver="4 mm")
    today = {o.Proxy.__class__.__name__: o for o in [fresh, *fresh.Group]}
    assert len(today) == 9, sorted(today)
    seen = 0
    for obj in doc.Objects:
        if not type_of(obj):
            continue
        new = today[obj.Proxy.__class__.__name__]
        lacking = set(new.PropertiesList) - set(obj.PropertiesList)
        assert not lacking, (obj.Name, lacking)
        for name in new.PropertiesList:
            kinds = obj.getTypeIdOfProperty(name), new.getTypeIdOfProperty(name)
            assert kinds[0] == kinds[1], (obj.Name, name, kinds)
            if "Enumeration" in kinds[0]:
                assert obj.getEnumerationsOfProperty(name) == new.getEnumerationsOfProperty(
                    name
                ), name
            assert obj.getEditorMode(name) == new.getEditorMode(name), (obj.Name, name)
        seen += 1
    assert seen >= 6, seen
    FreeCAD.closeDocument("fresh")
    FreeCAD.setActiveDocument(doc.Name)
    for obj in doc.Objects:
        obj.ViewObject.Visibility = obj == deviation
    view.viewTop()
    view.fitAll()
    settle()
    view.saveImage("old.png", 400, 300, "White")
    assert sum(coloured(Path.cwd() / "old.png")) > 5000  # not grey


@pytest.mark.slow
@pytest.mark.freecad(window=True)
def test_a_document_is_worked_on(old):
    here = opened(old)
    doc, job = here.doc, here.job
    before = doc.Simulation.RemovedVolume.Value
    for obj in doc.Objects:
        obj.touch()
    doc.recompute()
    assert not [o.Name for o in doc.Objects if "Invalid" in o.State]
    for obj in (job, doc.Stock, doc.BeltMachine, doc.RobotPath):
        assert obj.ViewObject.Proxy.doubleClicked(obj.ViewObject)
        settle()
        press("OK")
    menu("Simulate")
    wait(lambda: "in tolerance" in field("state").text())
    press("Close")
    assert not doc.Simulation.OutOfDate and not doc.Deviation.OutOfDate
    # The elasticity of the wheel is another one since the first state.
    assert abs(doc.Simulation.RemovedVolume.Value / before - 1) < 0.25, (
        before,
        doc.Simulation.RemovedVolume,
    )
    menu("Belt machine")
    type_in("Force", "25 N")
    press("OK")
    assert doc.Simulation.OutOfDate and doc.Deviation.OutOfDate
    menu("Cross-section")
    field("BeltGrinding_SectionDock").close()
    menu("Simulate")
    wait(lambda: not doc.Simulation.OutOfDate)
    press("Close")
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    wait(lambda: dock.scene is not None)
    dock.close()
    more = doc.Simulation.RemovedVolume.Value
    assert more > before
    doc.saveAs(str(old / "saved.FCStd"))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(old / "saved.FCStd"))
    settle()
    assert not doc.Simulation.OutOfDate and doc.Simulation.RemovedVolume.Value == more
    assert not [o.Name for o in doc.Objects if "Invalid" in o.State]


@pytest.mark.slow
@pytest.mark.freecad(window=True)
def test_a_result_comes_back_into_its_document(old):
    here = opened(old)
    doc, job = here.doc, here.job
    before = doc.Simulation.RemovedVolume.Value
    simulation = beltgrinding.import_result(job, old / "result")
    assert abs(simulation.RemovedVolume.Value / before - 1) < 1e-6
    assert len(doc.Deviation.VertexColors) == simulation.Samples


def test_a_job_file_runs_and_a_result_is_read(old):
    from beltgrinding.job import load as jobs
    from beltgrinding.simulation import run as runs
    from beltgrinding.inspection import section
    from beltgrinding.simulation.result import Result

    told = json.loads((old / "job.json").read_text())
    job = jobs.load(old / "job.json")
    assert job["belt_machine"]["force_N"] == told["belt_machine"]["force_N"] == 20
    kept = Result.read(old / "result")
    again = runs.run(job)
    assert len(kept.field.height) == len(again.field.height)
    volume = [r.summary["removed_volume_mm3"] for r in (kept, again)]
    assert abs(volume[1] / volume[0] - 1) < 0.25, volume
    assert np.allclose(kept.field.points, again.field.points, atol=1e-9)
    cut = section.section(Result.read(old / "result"), (0, 6, 0), (0, 1, 0))
    assert abs(section.summary(cut)["length_mm"] - 18) < 2.1
