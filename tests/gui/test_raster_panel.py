"""The raster path's command and panel."""

PREPARE = """
from support.hands import *
job = prepare()
doc = job.Document
names = [o.Name for o in doc.Objects]
steps = doc.UndoCount

def number():
    return field("note").text().split()[0]
"""


def test_passes_follow_the_panel_and_ok_is_one_step(freecad):
    freecad.run(
        PREPARE
        + """
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
edge = next(i for i, e in enumerate(doc.Block.Shape.Edges, 1)
            if abs(abs((e.Vertexes[1].Point - e.Vertexes[0].Point).y) - 40) < 1e-9)
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
""",
        window=True,
    )


def test_selected_faces_are_taken_and_cancel_takes_back(freecad):
    freecad.run(
        PREPARE
        + """
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
""",
        window=True,
    )
