"""The raster path's command and panel."""

import json
from types import SimpleNamespace

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtGui

from support.hands import (
    field,
    menu,
    prepare,
    press,
    screenshot,
    settle,
    type_in,
    visible,
    wait,
    widgets,
)

pytestmark = pytest.mark.freecad(window=True)


def number():
    return field("note").text().split()[0]


def prepared():
    job = prepare()
    doc = job.Document
    names = [o.Name for o in doc.Objects]
    steps = doc.UndoCount
    return SimpleNamespace(doc=doc, job=job, names=names, steps=steps)


def test_passes_follow_the_panel_and_ok_is_one_step():
    here = prepared()
    doc, job, names, steps = here.doc, here.job, here.names, here.steps
    menu("Raster path...")
    path = doc.RasterPath
    assert path.PassCount > 0 and number() == str(path.PassCount), field("note").text()
    assert "Contact across the pass" in field("note").text()
    type_in("StepOver", "8 mm")
    wait(lambda: path.PassCount == 5)
    assert not [w for w in widgets(QtGui.QWidget, "StepOverShare") if w.isVisible()]
    field("Along").setCurrentIndex(2)
    type_in("Direction_x", "0")
    type_in("Direction_z", "1")
    wait(lambda: "very direction" in field("note").text())
    press("OK")  # refused: the panel stays
    assert field("note").isVisible()
    Gui.Selection.clearSelection()
    edge = next(
        i
        for i, e in enumerate(doc.Block.Shape.Edges, 1)
        if abs(abs((e.Vertexes[1].Point - e.Vertexes[0].Point).y) - 40) < 1e-9
    )
    Gui.Selection.addSelection(doc.Name, "Block", f"Edge{edge}")
    field("takeEdge").click()
    assert [abs(x) for x in path.Direction] == [0, 1, 0]
    wait(lambda: path.PassCount == 8)

    # Another face of the part.
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face4")
    field("takeFaces").click()
    assert path.Faces == [(doc.Block, ("Face4",))] and "Face4" in field("rasterFaces").text()
    wait(lambda: "very direction" in field("note").text())
    field("Along").setCurrentIndex(0)
    wait(lambda: "passes" in field("note").text())
    press("OK")
    assert doc.UndoCount == steps + 1 and path in job.Group and not Gui.Control.activeDialog()
    doc.undo()
    assert [o.Name for o in doc.Objects] == names
    doc.redo()
    assert doc.RasterPath.PassCount > 0


@pytest.mark.slow
def test_selected_faces_are_taken_and_cancel_takes_back():
    here = prepared()
    doc, job, names, steps = here.doc, here.job, here.names, here.steps
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face1")
    menu("Raster path...")
    assert doc.RasterPath.Faces == [(doc.Block, ("Face1",))]
    press("Cancel")
    assert [o.Name for o in doc.Objects] == names and doc.UndoCount == steps

    Gui.Selection.clearSelection()
    menu("Raster path...")
    assert doc.RasterPath.Faces == job.DesignFaces
    press("OK")
    path = doc.RasterPath
    poses = [tuple(p.Base) for p in path.Poses]
    assert path.ViewObject.Proxy.doubleClicked(path.ViewObject)
    settle()
    type_in("StepOver", "5 mm")
    wait(lambda: path.PassCount == 8)
    press("Cancel")
    assert path.StepOver.Value == 0 and [tuple(p.Base) for p in path.Poses] == poses

    # It is simulated like any other path.
    doc.removeObject("RobotPath")
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    assert doc.Simulation.RemovedVolume.Value > 10
    press("Close")


@pytest.mark.slow
def test_passes_on_what_a_result_has_left():
    """From the verdict's cluster, and from the panel; the whole is one step, everywhere again."""
    here = prepared()
    doc, steps = here.doc, here.steps
    menu("Raster path...")
    path = doc.RasterPath
    note = field("note").text()
    wait(lambda: path.PassCount > 0)
    field("foldRegion").click()
    field("regionLeft").click()  # nothing has been simulated
    assert "simulate first" in field("note").text(), field("note").text()
    press("Cancel")
    assert doc.getObject("RasterPath") is None

    Gui.Selection.clearSelection()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    menu("Verdict")
    verdict = doc.Verdict
    found = verdict.Proxy.data(verdict)
    dock = field("BeltGrinding_VerdictDock")
    button, clusters = field("rasterHere"), field("clusters")
    assert not button.isEnabled()
    above = next(i for i, c in enumerate(found["clusters"]) if c["side"] == "above")
    clusters.setCurrentCell(above, 0)
    settle()
    assert button.isEnabled()
    steps = doc.UndoCount
    button.click()
    path = doc.RasterPath
    wait(lambda: path.PassCount > 0)
    low, high = found["clusters"][above]["box_mm"]
    points = list(path.RegionPoints)
    assert points and all(low[k] - 1e-6 <= p[k] <= high[k] + 1e-6 for p in points for k in range(3))
    assert "near" in field("rasterRegion").text()
    screenshot("region.png")
    few = path.GroundLength.Value
    field("regionAll").click()
    wait(lambda: path.GroundLength.Value >= few)
    assert not path.RegionPoints and "everywhere" in field("rasterRegion").text()
    field("regionLeft").click()
    wait(lambda: path.GroundLength.Value < 1e9 and len(path.RegionPoints) > 0)
    press("OK")
    assert doc.UndoCount == steps + 1
    doc.undo()
    assert doc.getObject("RasterPath") is None


@pytest.mark.slow
def test_what_is_left_out_is_coloured():
    here = prepared()
    doc = here.doc
    doc.BeltMachine.WheelRadius, doc.BeltMachine.RimThickness = "15 mm", "5 mm"
    wall = doc.addObject("Part::Feature", "Corner")
    wall.Shape = (
        Part.makeBox(60, 40, 20)
        .fuse(Part.makeBox(60, 8, 60, FreeCAD.Vector(0, 40, 0)))
        .removeSplitter()
    )
    doc.recompute()
    top = next(
        i
        for i, f in enumerate(wall.Shape.Faces, 1)
        if abs(f.Area - 60 * 40) < 1 and abs(f.CenterOfMass.z - 20) < 1e-6
    )
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Corner", f"Face{top}")
    menu("Raster path...")
    path = doc.RasterPath
    wait(lambda: path.PassCount > 0)
    field("foldPoses").click()
    field("WhereItCollides").setCurrentIndex(1)
    field("Along").setCurrentIndex(2)
    type_in("Direction_x", "0")
    type_in("Direction_y", "1")
    wait(lambda: path.LeftOut > 5 and "without room" in field("rasterLeft").text())
    assert path.LeftTriangles and path.ViewObject.Proxy.left.whichChild.getValue() == -3
    screenshot("left.png")
    field("WhereItCollides").setCurrentIndex(2)  # only warn
    wait(lambda: path.LeftOut == 0)
    field("WhereItCollides").setCurrentIndex(1)
    wait(lambda: path.LeftOut > 5)
    press("OK")
    first = doc.RasterPath
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Corner", f"Face{top}")
    menu("Raster path...")
    path = doc.RasterPath001
    wait(lambda: path.PassCount > 0)
    assert path.GroundLength.Value > 0 and not path.RegionPoints
    field("foldRegion").click()
    field("regionOthers").click()
    assert path.RegionPoints, field("note").text()
    assert {tuple(p) for p in path.RegionPoints} == {tuple(p) for p in first.LeftPoints}
    assert min(p.y for p in path.RegionPoints) > 15  # beside the wall at y = 40
    path.ViewObject.Visibility = False
    assert path.ViewObject.Proxy.left.whichChild.getValue() == -1
    press("Cancel")


def test_further_passes_are_listed_and_left_out():
    here = prepared()
    doc, steps = here.doc, here.steps
    menu("Raster path...")
    path = doc.RasterPath
    assert not visible(QtGui.QLabel, "furtherPasses")
    type_in("StepOver", "8 mm")
    wait(lambda: path.PassCount == 5)
    press("OK")
    group = {"along": "v", "belt_angle_deg": 90.0, "region_points": [[20.0, 20.0, 20.0]]}
    path.FurtherPasses = json.dumps([group])
    doc.recompute()
    more = path.PassCount
    assert more > 5
    path.ViewObject.Proxy.doubleClicked(path.ViewObject)
    settle()
    assert visible(QtGui.QLabel, "furtherPasses")
    assert field("furtherPasses").text() == "along v, belt at 90 degrees, near 1 points"
    press("Leave them out")
    wait(lambda: path.PassCount == 5)
    assert not visible(QtGui.QLabel, "furtherPasses")
    press("Cancel")
    assert path.PassCount == more and json.loads(path.FurtherPasses) == [group]
    assert steps < doc.UndoCount
