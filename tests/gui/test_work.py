"""A person's work through menus and panels: fields typed in, buttons pressed, tree and view read."""

from support.picture import coloured

# Helpers that run inside FreeCAD.
HANDS = """
import os, time
from pathlib import Path
import FreeCAD, Part
import FreeCADGui as Gui
from PySide import QtCore, QtGui

window = Gui.getMainWindow()

def settle():
    for _ in range(5):
        Gui.updateGui()
        QtGui.QApplication.processEvents()

def wait(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        QtGui.QApplication.processEvents()
        time.sleep(0.01)
    settle()

def menu(text):
    settle()
    bar = next(a for a in window.menuBar().actions() if a.text().replace("&", "") == "Belt grinding")
    action = next(a for a in bar.menu().actions() if a.text().replace("&", "") == text)
    wait(action.isEnabled, 5)  # FreeCAD looks a few times a second
    assert not action.icon().isNull() and action.toolTip()
    action.trigger()
    settle()

def field(name, kind=QtGui.QWidget):
    found = [w for w in window.findChildren(kind, name) if w.isVisible()]
    assert len(found) == 1, (name, found)
    return found[0]

def type_in(name, text):
    line = field(name)
    if not isinstance(line, QtGui.QLineEdit):
        line = line.findChild(QtGui.QLineEdit)
    line.setFocus()
    line.selectAll()
    line.insert(text)
    line.editingFinished.emit()
    settle()

def press(text):
    for button in window.findChildren(QtGui.QPushButton):
        if button.isVisible() and button.text().replace("&", "") == text:
            button.click()
            return settle()
    raise AssertionError(text)

def choose(path):
    QtGui.QFileDialog.getOpenFileName = staticmethod(lambda *a, **k: (str(path), ""))

ROWS = [f"{x},20,20.2,0,1,0,0,30" for x in range(10, 51, 5)]
Path("pass.csv").write_text("\\n".join(["x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s", *ROWS]) + "\\n")
Gui.activateWorkbench("BeltGrindingWorkbench")
window.showMaximized()
settle()
"""

PREPARE = """
doc = FreeCAD.newDocument("work")
doc.UndoMode = 1
part = doc.addObject("Part::Feature", "Block")
part.Shape = Part.makeBox(60, 40, 20)
doc.recompute()
Gui.Selection.clearSelection()
Gui.Selection.addSelection(doc.Name, "Block", "Face6")
menu("New job")
type_in("Spacing", "0.6 mm")
press("OK")
job = doc.BeltGrindingJob
assert job.Spacing.Value == 0.6 and job.DesignFaces == [(part, ("Face6",))]
menu("Stock")
type_in("Allowance", "0.2 mm")
press("OK")
menu("Belt machine")
type_in("WheelRadius", "60 mm")
type_in("WheelWidth", "15 mm")
type_in("Force", "30 N")
press("OK")
machine = doc.BeltMachine
assert machine.WheelRadius.Value == 60 and machine.Force.getValueAs("N") == 30
choose("pass.csv")
menu("Import robot program...")
press("OK")
assert doc.RobotPath.PoseCount == 9
"""


def test_from_a_selected_face_to_the_coloured_deviation(freecad):
    freecad.run(
        HANDS
        + PREPARE
        + """
menu("Simulate")
wait(lambda: doc.getObject("Simulation") is not None)
assert abs(doc.Simulation.RemovedVolume.Value - 100) < 1
press("Deviation")  # the panel's button leads on
deviation = doc.Deviation
assert deviation.ViewObject.Coloring and not part.ViewObject.Visibility
type_in("ToleranceUpper", "0.1234567 mm")
press("OK")
assert job.ToleranceUpper.Value == 0.1234567
assert abs(deviation.ToleranceUpper.Value - 0.1234567) < 1e-12
assert [o.Label for o in job.Group] == ["Stock", "Belt machine", "pass", "Simulation", "Deviation"]
view = Gui.ActiveDocument.ActiveView
view.setAnimationEnabled(False)
view.viewTop()
view.fitAll()
settle()
view.saveImage("work.png", 800, 600, "White")
""",
        window=True,
    )
    brown, _ = coloured(freecad.folder / "work.png")
    assert brown > 10000


def test_cancel_and_undo_take_back(freecad):
    freecad.run(
        HANDS
        + PREPARE
        + """
names = [o.Name for o in doc.Objects]
steps = doc.UndoCount

menu("Stock")
type_in("Allowance", "0.5 mm")
assert doc.Stock.Allowance.Value == 0.5
press("Cancel")
assert doc.Stock.Allowance.Value == 0.2

Gui.Selection.clearSelection()
Gui.Selection.addSelection(doc.Name, "Block", "Face1")
menu("New job")
press("Cancel")
assert [o.Name for o in doc.Objects] == names
assert doc.UndoCount == steps

# Every panel's OK was one step.
for left in (["Stock", "BeltMachine"], ["Stock"], []):
    doc.undo()
    assert [o.Name for o in job.Group] == left
doc.undo()
assert [o.Name for o in doc.Objects] == ["Block"]
for _ in range(4):
    doc.redo()
assert [o.Name for o in doc.Objects] == names
""",
        window=True,
    )


def test_a_run_can_be_cancelled_and_the_window_stays_usable(freecad):
    freecad.run(
        HANDS
        + PREPARE
        + """
job.Spacing = 0.05
doc.recompute()
menu("Simulate")
start = time.monotonic()
field("cancel").click()
wait(lambda: "Cancelled" in field("state").text())
assert doc.getObject("Simulation") is None
press("Close")

# The document may be edited while it runs; the result then says so.
job.Spacing = 0.1
doc.recompute()
menu("Simulate")
machine.Force = "31 N"
doc.recompute()
wait(lambda: doc.getObject("Simulation") is not None)
assert doc.Simulation.OutOfDate
assert "Out of date" in field("state").text()
""",
        window=True,
    )


def test_mistakes_are_said_where_they_are_made(freecad):
    freecad.run(
        HANDS
        + PREPARE
        + """
def message():
    boxes = [b for b in window.findChildren(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible()]
    text = boxes[-1].text()
    for box in boxes:
        box.close()
        box.deleteLater()
    settle()
    return text

names = [o.Name for o in doc.Objects]
Gui.Selection.clearSelection()
menu("New job")
assert "Select the faces" in message()

Path("empty.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz\\n")
choose("empty.csv")
menu("Import robot program...")
assert "empty.csv" in message()
assert [o.Name for o in doc.Objects] == names

menu("Stock")
box = field("Kind")
box.setCurrentIndex(1)
press("OK")  # refused: no solid is chosen; the panel stays
assert "Choose the solid" in field("note").text() and field("Source").isVisible()
press("Cancel")
assert doc.Stock.Kind == "allowance"

doc.removeObject("RobotPath")
doc.recompute()
menu("Simulate")
assert "no robot program" in field("state").text()
""",
        window=True,
    )


def test_a_double_click_opens_the_panel(freecad):
    freecad.run(
        HANDS
        + PREPARE
        + """
for name in ("BeltGrindingJob", "Stock", "BeltMachine", "RobotPath"):
    view = doc.getObject(name).ViewObject
    assert view.Proxy.doubleClicked(view)
    settle()
    assert Gui.Control.activeDialog(), name
    press("OK")
    assert not Gui.Control.activeDialog(), name
""",
        window=True,
    )
