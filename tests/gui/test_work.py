"""A person's work through menus and panels: fields typed in, buttons pressed, tree and view read."""

from support.picture import coloured

PREPARE = """
import time
from pathlib import Path
from support.hands import *
job = prepare()
doc, part, machine = job.Document, job.Document.Block, job.Document.BeltMachine
"""


def test_from_a_selected_face_to_the_coloured_deviation(freecad):
    freecad.run(
        PREPARE
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
        PREPARE
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

# Every panel's OK was one step; the imported program took the place of the proposed passes.
doc.undo()
assert {o.Name for o in job.Group} == {"Stock", "BeltMachine", "RasterPath"}
assert doc.BeltMachine.WheelRadius.Value == 60
doc.undo()
assert doc.BeltMachine.WheelRadius.Value != 60 and doc.Stock.Allowance.Value == 0.2
doc.undo()
assert doc.Stock.Allowance.Value == 0.3
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
        PREPARE
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
job.Spacing = 0.06  # long enough for what follows
doc.recompute()
menu("Simulate")
machine.Force = "31 N"
doc.recompute()
wait(lambda: doc.getObject("Simulation") is not None)
assert doc.Simulation.OutOfDate
assert "Out of date" in field("state").text(), field("state").text()
""",
        window=True,
    )


def test_mistakes_are_said_where_they_are_made(freecad):
    freecad.run(
        PREPARE
        + """
def message():
    boxes = [b for b in widgets(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible()]
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
        PREPARE
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


def test_a_job_or_document_removed_while_it_runs_ends_the_run(freecad):
    freecad.run(
        PREPARE
        + """
from beltgrinding.simulation import run as jobs
runs = []
whole = jobs.run
def watched(*arguments):
    runs.append("running")
    try:
        return whole(*arguments)
    finally:
        runs.append("ended")
patch(jobs, "run", watched)

job.Spacing = 0.05
doc.recompute()
menu("Simulate")
wait(lambda: runs)
doc.removeObject(job.Name)
wait(lambda: len(runs) == 2 and not Gui.Control.activeDialog())

job = prepare()
job.Spacing = 0.05
job.Document.recompute()
menu("Simulate")
wait(lambda: len(runs) == 3)
FreeCAD.closeDocument(job.Document.Name)
wait(lambda: len(runs) == 4 and not Gui.Control.activeDialog())
""",
        window=True,
    )


def test_a_panel_closed_while_it_computes_leaves_nothing(freecad):
    output = freecad.run(
        PREPARE
        + """
job.Spacing = 0.05
doc.recompute()
for name in ("Simulate", "Contact at a pose..."):
    menu(name)
    press("Close")
    end = time.monotonic() + 2
    while time.monotonic() < end:
        settle()
        time.sleep(0.01)
    assert doc.getObject("Simulation") is None, name
""",
        window=True,
    )
    assert "Traceback" not in output, output


def test_the_menu_offers_the_example(freecad):
    freecad.run(
        """
from support.hands import *
start()
menu("Example: compressor blade")
doc = FreeCAD.ActiveDocument
assert [o.Label for o in doc.BeltGrindingJob.Group] == [
    "Stock", "Belt machine", "blade_pressure_side"]
menu("Simulate")
wait(lambda: doc.getObject("Simulation") is not None)
assert doc.Simulation.RemovedVolume.Value > 1000
kinds = {event["kind"] for event in doc.Simulation.Proxy.events(doc.Simulation)}
assert kinds == {"collision", "edge_contact", "gouge", "wheel_too_large"}, kinds
""",
        window=True,
    )


def test_the_pressure_at_any_pose(freecad):
    freecad.run(
        PREPARE
        + """
menu("Contact at a pose...")
wait(lambda: "Highest pressure" in field("contactState").text())
assert "Force: 30.0 N" in field("contactState").text()
first = field("footprint").pixmap().toImage()
assert first.width() > 50 and first.height() > 50
colours = {first.pixel(x, first.height() // 2) for x in range(first.width())}
assert len(colours) > 3  # a footprint, not one colour
field("pose").setValue(6)
wait(lambda: "Grinding up to pose 6" in field("contactState").text())
wait(lambda: "Highest pressure" in field("contactState").text())
press("Close")
""",
        window=True,
    )


def test_the_law_the_belt_and_the_uncertainty(freecad):
    freecad.run(
        PREPARE
        + """
import json
def pick(name, text):
    box = field(name)
    assert box.findText(text) >= 0, [box.itemText(i) for i in range(box.count())]
    box.setCurrentIndex(box.findText(text))
    settle()
job.ViewObject.Proxy.doubleClicked(job.ViewObject)
settle()
pick("Law", "Local with exponents")
shown = {w.objectName() for w in widgets(QtGui.QWidget) if w.isVisible()}
assert "Timing" in shown and "PathAcceleration" not in shown
pick("Timing", "With acceleration and zones")
assert field("PathAcceleration").isVisible() and field("DefaultZone").isVisible()
type_in("PathAcceleration", "2000 mm/s^2")
type_in("AngularAcceleration", "150")
type_in("PressureExponent", "1.2")
type_in("FeedExponent", "-0.2")
pick("WearModel", "Exponential")
type_in("WearScale", "1000")
press("OK")
assert (job.Timing, job.PathAcceleration.Value) == ("trapezoidal", 2000)
assert job.AngularAcceleration == 150 and not job.Document.HasPendingTransaction
assert (job.Law, job.PressureExponent, job.FeedExponent) == ("local", 1.2, -0.2)
job.Calibration = json.dumps({"parameters": [], "covariance": [], "scatter": 0.1})
menu("Simulate")
wait(lambda: doc.getObject("Simulation") is not None)
left = doc.Simulation.RemainingCut
assert 5 < left < 95, left
press("Deviation")
before = list(doc.Deviation.VertexColors)
pick("ColourBy", "Uncertainty (1 sd)")
assert list(doc.Deviation.VertexColors) != before
press("OK")
menu("Belt")
press("Count the simulated grind")
assert abs(doc.Belt.RemainingCut - left) < 1e-6 and doc.Belt.WorkDone > 100
press("Count the simulated grind")
assert "counted already" in field("note").text()
press("New belt")
assert doc.Belt.WorkDone == 0 and doc.Belt.RemainingCut == 100
press("Cancel")
assert doc.getObject("Belt") is None
""",
        window=True,
    )
