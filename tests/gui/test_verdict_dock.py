"""Tolerance zones and the verdict in FreeCAD's window: panel, dock, a click to cluster and motion."""

import json
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui

from beltgrinding.gui.docks import verdict_dock
from beltgrinding.objects import api
from support.hands import field, menu, prepare, press, screenshot, settle, wait

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc = job.Document
    return doc, job


def test_the_verdict_leads_to_the_cluster_and_to_the_line():
    doc, job = prepared()
    # A pass whose fifth motion creeps: a gouge by line 7 of pass.csv.
    rows = Path("pass.csv").read_text().splitlines()
    rows[6] = rows[6].rsplit(",", 1)[0] + ",2"
    Path("pass.csv").write_text("\n".join(rows) + "\n")
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "RobotPath")
    menu("Read programs again")
    Gui.Selection.clearSelection()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    assert field("trouble").isVisible() and "Gouge" in field("trouble").text()
    assert "line 7: ground to" in field("trouble").text(), field("trouble").text()
    screenshot("trouble.png")
    press("Deviation")
    press("OK")
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)

    steps = doc.UndoCount
    menu("Verdict")
    verdict = doc.Verdict
    assert verdict.getParentGroup() is job and doc.UndoCount == steps + 1
    assert verdict.Overall == "fail"
    dock = field("BeltGrinding_VerdictDock")
    assert "1 of 1 faces" in field("overall").text()
    assert field("verdictTrouble").isVisible()
    assert field("verdictTrouble").text().startswith("Gouge: pass, line 7"), field(
        "verdictTrouble"
    ).text()
    assert (
        "Never touched" in field("verdictFigures").text()
        and "0 missed rays" in field("verdictFigures").text()
    )
    regions, clusters, motions = (field(name) for name in ("regions", "clusters", "motions"))
    assert regions.rowCount() == 1 and regions.item(0, 0).text() == "Block.Face6"
    assert regions.item(0, 1).text() == "fail"
    screenshot("verdict1.png")

    found = verdict.Proxy.data(verdict)
    deep = next(i for i, c in enumerate(found["clusters"]) if c["side"] == "below")
    assert clusters.rowCount() == len(found["clusters"])
    assert clusters.item(deep, 1).text() == "cut too deep" and clusters.item(deep, 5).text() == "7"
    clusters.setCurrentCell(deep, 0)
    settle()
    camera = view.getCameraNode()
    low, high = found["clusters"][deep]["box_mm"]
    at = view.getPointOnScreen(0.5 * (FreeCAD.Vector(*low) + FreeCAD.Vector(*high)))
    width, height = view.getSize()
    assert abs(at[0] - width / 2) < 3 and abs(at[1] - height / 2) < 3, (at, width, height)
    assert view.getViewDirection().z < -0.999
    if hasattr(camera, "height"):
        assert abs(camera.height.getValue() - 1.5 * found["clusters"][deep]["extent_mm"]) < 1e-3
    scene = verdict_dock.VerdictDock.current().scene
    assert scene.switch.whichChild.getValue() == -3 and scene.points.point.getNum() > 20
    screenshot("verdict2.png")

    assert motions.item(0, 1).text() == "7" and motions.item(0, 2).text() == "6"
    motions.setCurrentCell(0, 0)
    settle()
    source = field("source")  # pass.csv, its seventh line marked
    assert source.textCursor().blockNumber() + 1 == 7
    assert verdict_dock.VerdictDock.current().wheel.pose == 5
    screenshot("verdict3.png")
    motions.cellDoubleClicked.emit(0, 0)
    settle()
    assert Gui.Control.activeDialog() and field("poseNumber").value() == 6
    press("Cancel")

    # Zones: typed in, taken from a selection, undone.
    steps = doc.UndoCount
    menu("Tolerance zones...")
    press("Add")
    table = field("zones")
    assert table.rowCount() == 1
    table.item(0, 0).setText("top")
    table.item(0, 2).setText("-2")
    table.item(0, 3).setText("x")
    assert "no length" in field("note").text()
    table.item(0, 3).setText("0,25 mm")
    assert "no length" not in field("note").text()
    Gui.Selection.addSelection(doc.Name, "Block", "Face5")
    press("Take selected faces")
    assert "is not ground" in field("note").text()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face6")
    press("Take selected faces")
    assert table.item(0, 1).text() == "6" and "is not ground" not in field("note").text()
    screenshot("verdict4.png")
    press("OK")
    zone = {"name": "top", "faces": [6], "tolerance_mm": [-2.0, 0.25]}
    assert json.loads(job.Zones) == [zone] and doc.UndoCount == steps + 1
    wait(lambda: "In tolerance" == field("overall").text())
    assert verdict.Overall == "pass" and regions.rowCount() == 2 and clusters.rowCount() == 0
    doc.undo()
    doc.recompute()
    settle()
    assert not job.Zones and verdict.Overall == "fail"
    wait(lambda: clusters.rowCount() == len(found["clusters"]))
    middle = {"name": "middle", "point_mm": list(verdict.WorstPoint), "normal": [1, 0, 0]}
    api.set_sections(job, [middle])
    sections = field("sections")
    wait(lambda: sections.rowCount() == 4)
    assert sections.item(0, 0).text() == "middle: chord"
    assert sections.item(0, 3).text() == "not all around"
    api.set_sections(job, [])
    wait(lambda: not sections.isVisible())
    menu("Tolerance zones...")
    press("Add")
    press("Cancel")
    assert not job.Zones

    doc.BeltMachine.Force = "20 N"
    doc.recompute()
    settle()
    assert "Out of date" in field("verdictFigures").text()
    clusters.setCurrentCell(0, 0)
    settle()
    doc.saveAs(str(Path("work.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    settle()
    assert clusters.rowCount() == 0 and field("overall").text() == ""
    doc = FreeCAD.openDocument("work.FCStd")
    doc.Verdict.ViewObject.Proxy.doubleClicked(doc.Verdict.ViewObject)
    settle()
    assert clusters.rowCount() == len(found["clusters"])
    doc.removeObject("Verdict")
    settle()
    assert clusters.rowCount() == 0
