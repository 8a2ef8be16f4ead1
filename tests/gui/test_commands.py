"""Every command of the menu: that a test starts it there, and those that go through files."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
import Path as Cam
from PySide import QtGui

import beltgrinding
from beltgrinding import cli
from beltgrinding.programs import read_program
from support.freecad import ROOT
from support.hands import (
    choose,
    entries,
    menu,
    name_file,
    prepare,
    settle,
    start,
    wait,
    widgets,
    window,
)
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)
MENUS = ["Machine", "Programs", "Plan and study", "Results", "Exchange"]


def prepared():
    job = prepare()
    doc = job.Document
    return doc, job


def test_every_command_is_started_from_the_menu_by_a_test():
    start()
    bar = next(
        a for a in window.menuBar().actions() if a.text().replace("&", "") == "Belt grinding"
    )
    texts = [a.text().replace("&", "") for a in entries(bar) if a.text()]
    Path("menu.json").write_text(json.dumps(texts))
    top = bar.menu().actions()
    # Grouped by step, with submenus for what is rare; a toolbar a step.
    assert sum(a.isSeparator() for a in top) >= 4 and top[0].text().replace("&", "") == "New job"
    assert [a.text() for a in top if a.menu() is not None] == MENUS
    bars = [
        b.windowTitle()
        for b in widgets(QtGui.QToolBar)
        if b.windowTitle().startswith("Belt grinding")
    ]
    assert sorted(bars) == [
        "Belt grinding: " + step for step in ("judge", "paths", "run", "set up")
    ], bars
    commands = json.loads((Path.cwd() / "menu.json").read_text())
    sources = [*(ROOT / "tests" / "gui").glob("*.py"), *(ROOT / "tests" / "support").glob("*.py")]
    started = set()
    for path in sources:
        started.update(re.findall(r'\bmenu\("([^"]+)"\)', path.read_text()))
    assert len(commands) > 20
    assert sorted(set(commands) - started) == []


@pytest.mark.slow
def test_programs_are_read_again():
    doc, job = prepared()
    raster = __import__("beltgrinding").make_raster(job, StepOver="8 mm")
    poses, steps = len(raster.Poses), doc.UndoCount
    Path("pass.csv").write_text("\n".join(Path("pass.csv").read_text().splitlines()[:-2]) + "\n")
    menu("Read programs again")
    assert doc.RobotPath.PoseCount == 7 and len(raster.Poses) == poses
    assert doc.UndoCount == steps + 1
    doc.undo()
    assert len(doc.RobotPath.Poses) == 9

    Path("pass.csv").unlink()
    menu("Read programs again")
    boxes = [b for b in widgets(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible()]
    assert len(boxes) == 1 and "pass.csv" in boxes[0].text()
    assert len(doc.RobotPath.Poses) == 9


def test_a_job_goes_to_another_machine_and_its_result_comes_back():
    doc, job = prepared()
    name_file("job.json", "Job (*.json)")
    menu("Export job file...")
    data = json.loads(Path("job.json").read_text())
    assert data["sampling"]["spacing_mm"] == 0.6 and len(data["programs"][0]["poses"]) == 9
    assert cli.main(["run", "job.json", "-o", "result"]) == 0

    patch(QtGui.QFileDialog, "getExistingDirectory", staticmethod(lambda *a, **k: "result"))
    steps = doc.UndoCount
    menu("Import result...")
    simulation = doc.Simulation
    assert not simulation.OutOfDate and abs(simulation.RemovedVolume.Value - 100) < 1
    assert doc.UndoCount == steps + 1
    doc.undo()
    assert doc.getObject("Simulation") is None
    doc.redo()
    doc.BeltMachine.Force = "25 N"
    doc.recompute()
    menu("Import result...")
    assert doc.Simulation.OutOfDate  # other inputs

    patch(QtGui.QFileDialog, "getExistingDirectory", staticmethod(lambda *a, **k: "nowhere"))
    menu("Import result...")
    boxes = [b for b in widgets(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible()]
    assert len(boxes) == 1 and "nowhere" in boxes[0].text()
    boxes[0].close()

    FreeCAD.closeDocument(doc.Name)
    choose("job.json")
    menu("Open job file...")
    doc = FreeCAD.ActiveDocument
    job = doc.BeltGrindingJob
    assert [o.Label for o in job.Group] == ["Stock", "Belt machine", "pass"]
    assert job.Spacing.Value == 0.6 and doc.BeltMachine.Force.getValueAs("N") == 30
    assert doc.RobotPath.PoseCount == 9 and not Gui.Control.activeDialog()
    again = {**json.loads(Path("job.json").read_text()), "design": None}
    name_file("again.json", "Job (*.json)")
    menu("Export job file...")
    assert {**json.loads(Path("again.json").read_text()), "design": None} == again


@pytest.mark.slow
def test_raster_and_followed_paths_are_exported_from_their_context_menu():
    doc, job = prepared()
    milling = doc.addObject("Path::Feature", "Contour")
    milling.Path = Cam.Path(
        [
            Cam.Command("G0", {"X": 10, "Y": 10, "Z": 30}),
            Cam.Command("G1", {"Z": 20.2, "F": 20}),
            Cam.Command("G1", {"X": 50, "F": 40}),
        ]
    )
    followed = beltgrinding.follow_path(job, milling)
    raster = beltgrinding.make_raster(job, StepOver="8 mm")
    loose = beltgrinding.import_program(doc, "pass.csv")  # in no job
    doc.recompute()
    for path in (raster, followed, loose):
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(path)
        entries = QtGui.QMenu()
        path.ViewObject.Proxy.setupContextMenu(path.ViewObject, entries)
        entry = next(
            a for a in entries.actions() if a.text().replace("&", "").startswith("Export robot")
        )
        for suffix in (".src", ".mod", ".script", ".csv"):
            file = Path(path.Name + suffix)
            name_file(file, f"x (*{suffix})")
            settle()
            wait(entry.isEnabled, 10)
            entry.trigger()
            settle()
            assert file.exists(), file
            program = read_program(str(file))
            poses = np.array([m.pose for m in program.motions])
            frames = path.Proxy.arrays(path)["frames"]
            assert poses.shape == frames.shape and np.abs(poses - frames).max() < 6e-4, file
