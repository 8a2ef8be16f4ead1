"""What belongs to a document, a part or a panel that goes, goes with it."""

import contextlib
import json
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.gui.common import messages
from support.hands import choose, field, menu, prepare, press, settle, type_in, visible, wait

pytestmark = pytest.mark.freecad(window=True)


@pytest.mark.parametrize(
    "command",
    ["Simulate", "Plan feeds...", "Study...", "Contact at a pose...", "Cell", "Robot program..."],
)
def test_a_panel_goes_with_its_document(command):
    job = prepare()
    menu(command)
    assert Gui.Control.activeDialog()
    FreeCAD.closeDocument(job.Document.Name)
    wait(lambda: not Gui.Control.activeDialog(), 2)
    assert not [w for w in visible(QtGui.QProgressBar) if w.objectName() == "BeltGrinding_Progress"]


@pytest.mark.parametrize("command", ["Simulate", "Calibrate removal law...", "Tolerance zones..."])
def test_a_panel_goes_with_its_job(command):
    job = prepare()
    doc = job.Document
    menu(command)
    assert Gui.Control.activeDialog()
    doc.removeObject(job.Name)
    wait(lambda: not Gui.Control.activeDialog(), 2)


def test_a_job_whose_part_is_deleted_says_so_in_one_line():
    job = prepare()
    doc = job.Document
    beltgrinding.simulate(job)
    beltgrinding.make_deviation(job)
    beltgrinding.make_ground_mesh(job)
    settle()
    doc.openTransaction("Delete")
    doc.removeObject("Block")
    doc.commitTransaction()
    doc.recompute()
    settle()
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    assert field("note").text()
    press("Cancel")
    doc.undo()
    settle()
    assert job.DesignFaces and doc.getObject("Block")


@pytest.mark.parametrize(
    "command,name",
    [("Plan feeds...", "Plan"), ("Study...", "Study"), ("Robot program...", "RobotProgram")],
)
def test_a_panel_that_is_closed_at_once_leaves_nothing(command, name):
    job = prepare()
    doc = job.Document
    before = [obj.Name for obj in doc.Objects]
    menu(command)
    assert doc.getObject(name) is not None
    press("Close")
    assert [obj.Name for obj in doc.Objects] == before
    assert doc.UndoCount == 0
    # What was entered stays.
    menu(command)
    if name == "Plan":
        type_in("FeedMax", "77 mm/s")
    elif name == "RobotProgram":
        type_in("homeJoints", "0, -90, 90, 0, 60, 0")
    else:
        press("Add")
    press("Close")
    assert doc.getObject(name) is not None
    doc.undo()
    assert [obj.Name for obj in doc.Objects] == before


def test_a_job_file_gets_a_document_of_its_own():
    job = prepare()
    beltgrinding.export_job(job, "own.json")
    before = [obj.Name for obj in job.Document.Objects]
    choose(Path("own.json").absolute())
    menu("Open job file...")
    assert [obj.Name for obj in job.Document.Objects] == before
    assert FreeCAD.ActiveDocument.Name == "own" and FreeCAD.ActiveDocument.getObject("Stock")
    # An empty one is as good.
    empty = FreeCAD.newDocument("empty")
    FreeCAD.setActiveDocument("empty")
    menu("Open job file...")
    assert empty.getObject("Stock") is not None


def test_messages_do_not_lie_upon_each_other():
    prepare()
    for text in ("Written: a", "Written: b", "Written: b"):
        messages.inform(text)
    settle()
    (box,) = visible(QtGui.QMessageBox, "BeltGrinding_Note")
    assert box.text().splitlines() == ["Written: a", "", "Written: b"]


def test_a_job_is_copied_and_pasted():
    job = prepare()
    doc = job.Document
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(job)
    with what_depends_too():
        Gui.runCommand("Std_Copy")
        settle()
        Gui.runCommand("Std_Paste")
        settle()
    doc.recompute()
    settle()
    jobs = [obj for obj in doc.Objects if obj.Name.startswith("BeltGrindingJob")]
    assert len(jobs) == 2
    assert not visible(QtGui.QMessageBox)
    assert json.dumps(sorted(o.Name for o in jobs[0].Group)) != json.dumps(
        sorted(o.Name for o in jobs[1].Group)
    )


@contextlib.contextmanager
def what_depends_too():
    """FreeCAD asks which of the objects it depends on are to be copied: all."""

    def answer():
        for dialog in visible(QtGui.QDialog):
            if dialog is not Gui.getMainWindow() and dialog.isModal():
                dialog.accept()

    timer = QtCore.QTimer()
    timer.timeout.connect(answer)
    timer.start(200)
    try:
        yield
    finally:
        timer.stop()  # it would answer the next test's questions


def test_deleting_the_part_of_a_job_asks():
    job = prepare()
    doc = job.Document
    asked = []

    def delete(name, answer):
        def look():
            for box in visible(QtGui.QMessageBox):
                asked.append(box.text())
                next(b for b in box.buttons() if answer in b.text()).click()

        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(doc.Name, name)
        settle()
        timer = QtCore.QTimer()
        timer.timeout.connect(look)
        timer.start(50)
        Gui.runCommand("Std_Delete")
        settle()
        timer.stop()

    delete("Block", "No")
    assert doc.getObject("Block") is not None
    assert len(asked) == 1 and job.Label in asked[0], asked
    delete("Stock", "Yes")  # the job's own goes unasked
    assert doc.getObject("Stock") is None and len(asked) == 1, asked
    delete("Block", "Yes")
    assert doc.getObject("Block") is None and len(asked) == 2
