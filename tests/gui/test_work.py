"""A person's work through menus and panels: fields typed in, buttons pressed, tree and view read."""

import json
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.gui.panels import program_panel
from beltgrinding.simulation import run as jobs
from support.hands import (
    bury,
    choose,
    example,
    field,
    menu,
    prepare,
    prepare_by_hand,
    press,
    settle,
    start,
    type_in,
    wait,
    widgets,
)
from support.picture import coloured
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc, part, machine = job.Document, job.Document.Block, job.Document.BeltMachine
    return SimpleNamespace(doc=doc, job=job, machine=machine, part=part)


def stored(doc):
    """What a document's objects say: {object: {property: value}}, and what is selected."""
    apart = ("Proxy", "Shape")  # another object each time
    says = {
        obj.Name: {
            name: repr(getattr(holder, name))
            for holder in (obj, obj.ViewObject)
            for name in holder.PropertiesList
            if name not in apart
        }
        for obj in doc.Objects
    }
    return says, [obj.Name for obj in Gui.Selection.getSelection()]


@pytest.mark.slow
def test_menus_and_panels_make_the_job_that_a_macro_makes():
    by_hand = stored(prepare_by_hand().Document)
    FreeCAD.closeDocument("work")
    assert stored(prepare().Document) == by_hand


def test_from_a_selected_face_to_the_coloured_deviation():
    here = prepared()
    doc, job, part = here.doc, here.job, here.part
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
    assert [o.Label for o in job.Group] == [
        "Stock",
        "Belt machine",
        "pass",
        "Simulation",
        "Deviation",
    ]
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    view.fitAll()
    settle()
    view.saveImage("work.png", 800, 600, "White")
    brown, _ = coloured(Path.cwd() / "work.png")
    assert brown > 10000


@pytest.mark.slow
def test_cancel_and_undo_take_back():
    job = prepare_by_hand()
    doc = job.Document
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


def test_a_run_can_be_cancelled_and_the_window_stays_usable():
    here = prepared()
    doc, job, machine = here.doc, here.job, here.machine
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


def test_mistakes_are_said_where_they_are_made():
    here = prepared()
    doc = here.doc

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

    Path("empty.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz\n")
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


def test_a_double_click_opens_the_panel():
    here = prepared()
    doc = here.doc
    for name in ("BeltGrindingJob", "Stock", "BeltMachine", "RobotPath"):
        view = doc.getObject(name).ViewObject
        assert view.Proxy.doubleClicked(view)
        settle()
        assert Gui.Control.activeDialog(), name
        press("OK")
        assert not Gui.Control.activeDialog(), name


def close_from_outside():
    """Closes a panel as a macro does: nobody asks it."""
    Gui.Control.closeDialog()
    settle()
    bury()


def test_a_panel_that_something_else_closes_leaves_nothing():
    job = prepare()
    scene = Gui.ActiveDocument.ActiveView.getSceneGraph()
    children = scene.getNumChildren()
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    Gui.Selection.addSelection(job)
    assert job not in Gui.Selection.getSelection()  # faces and parts alone, while it is open
    assert scene.getNumChildren() > children  # the faces are tinted
    close_from_outside()
    Gui.Selection.addSelection(job)
    assert job in Gui.Selection.getSelection()
    assert scene.getNumChildren() == children

    path = job.Document.RobotPath
    for index in (2, 3):
        program_panel.show_pose(path, index, True)
        settle()
        assert Gui.Control.activeDialog() and field("poseNumber").value() == index + 1
        assert scene.getNumChildren() > children
        close_from_outside()
        assert scene.getNumChildren() == children

    machine, steps = job.Document.BeltMachine, job.Document.UndoCount
    menu("Belt machine")
    type_in("Force", "36 N")
    close_from_outside()
    assert not job.Document.HasPendingTransaction and job.Document.UndoCount == steps + 1
    menu("Belt machine")
    type_in("Force", "40 N")
    press("Cancel")  # its own change alone
    assert machine.Force.getValueAs("N").Value == 36
    job.Document.undo()
    assert machine.Force.getValueAs("N").Value == 30


def test_a_job_or_document_removed_while_it_runs_ends_the_run():
    here = prepared()
    doc, job = here.doc, here.job
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


@pytest.mark.freecad(window=True, quiet=True)
def test_a_panel_closed_while_it_computes_leaves_nothing():
    here = prepared()
    doc, job = here.doc, here.job
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


def test_the_dock_of_examples_sets_one_up():
    start()
    example("Compressor blade")
    doc = FreeCAD.ActiveDocument
    assert [o.Label for o in doc.BeltGrindingJob.Group] == [
        "Stock",
        "Belt machine",
        "blade_pressure_side",
    ]
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    assert doc.Simulation.RemovedVolume.Value > 1000
    kinds = {event["kind"] for event in doc.Simulation.Proxy.events(doc.Simulation)}
    assert kinds == {"collision", "edge_contact", "gouge", "wheel_too_large"}, kinds


def test_the_pressure_at_any_pose():
    prepared()
    menu("Contact at a pose...")
    wait(lambda: "Highest pressure" in field("contactState").text())
    assert "Force: 30.0 N" in field("contactState").text()
    first = field("footprint").pixmap().toImage()
    assert first.width() > 50 and first.height() > 50
    colours = {first.pixel(x, first.height() // 2) for x in range(first.width())}
    assert len(colours) > 3  # a footprint, not one colour
    field("pose").setValue(6)
    wait(lambda: "Grinding up to pose 6" in field("taskText").text())
    assert not field("contactState").text()
    wait(lambda: "Highest pressure" in field("contactState").text())
    press("Close")


def test_the_law_the_belt_and_the_uncertainty():
    here = prepared()
    doc, job = here.doc, here.job

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


def test_cancel_leaves_other_documents_alone():
    """FreeCAD has one undo step for all documents: a panel's takes in what a macro does elsewhere meanwhile."""
    job = prepared().job
    job.Document.commitTransaction()
    assert job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    other = FreeCAD.newDocument("Other")
    other.addObject("Part::Feature", "Kept")
    FreeCAD.setActiveDocument(job.Document.Name)
    press("Cancel")
    assert other.getObject("Kept") is not None and FreeCAD.getActiveTransaction() is None
