"""The keyboard alone: from New job to a report; Tab reaches every control of every panel, in the order of reading."""

import time
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtGui

import beltgrinding
from support.hands import field, name_file, settle, start, visible, wait, whole_screen, widgets
from support.keys import out_of_order, press_keys, unreachable
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)
OBJECTS = (
    "BeltGrindingJob",
    "Stock",
    "BeltMachine",
    "RobotPath",
    "RasterPath",
    "Deviation",
    "Belt",
)
COMMANDS = (
    *("Plan", "Study", "Cell", "Simulate", "Contact", "Calibrate", "Zones", "CheckSettings"),
    *("Scan", "BeltPlan", "RobotProgram"),
)
DOCKS = ("Verdict", "Section", "Playback", "Examples")


def part():
    start()
    doc = FreeCAD.newDocument("work")
    block = doc.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(30, 20, 10)
    doc.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face6")
    return doc


def tab_to(name):
    """Strikes Tab until the focus is in the control of this name."""
    passed = []
    while len(passed) < 80:
        press_keys("Tab")
        widget, names = QtGui.QApplication.focusWidget(), []
        while widget is not None:
            names.append(widget.objectName())
            widget = widget.parentWidget()
        if name in names[:3]:
            return
        passed.append(names[:3])
    raise AssertionError(passed)


@pytest.mark.freecad(window=True, fresh=True)
def test_from_a_job_to_its_report_by_the_keyboard():
    doc = part()
    Gui.getMainWindow().activateWindow()
    field_of_view = visible(QtGui.QMdiArea)[0]
    field_of_view.setFocus()
    press_keys("g", "j")
    assert Gui.Control.activeDialog() and doc.BeltGrindingJob.DesignFaces
    tab_to("Spacing")
    press_keys("1", "space", "m", "m", "Tab")
    assert doc.BeltGrindingJob.Spacing.Value == 1
    # Space folds and unfolds a box.
    tab_to("foldHeat")
    assert not visible(QtGui.QComboBox, "thermalPreset")
    press_keys("space")
    assert visible(QtGui.QComboBox, "thermalPreset")
    press_keys("space")
    assert not visible(QtGui.QComboBox, "thermalPreset")
    press_keys("Return")
    wait(lambda: not Gui.Control.activeDialog())
    assert doc.RasterPath.PoseCount > 2
    press_keys("g", "s")
    wait(lambda: doc.getObject("Simulation") is not None, 200)
    press_keys("Escape")
    wait(lambda: not Gui.Control.activeDialog())
    until(lambda: doc.getObject("Deviation") is not None and Gui.Control.activeDialog(), "g", "d")
    settle()
    buttons = [one for one in visible(QtGui.QPushButton) if one.text().replace("&", "") == "OK"]
    assert any(not one.visibleRegion().isEmpty() for one in buttons)  # not scrolled past
    press_keys("Return")
    wait(lambda: not Gui.Control.activeDialog())
    assert doc.getObject("Deviation") is not None
    name_file("report.html", "HTML (*.html *.htm)")
    press_keys("g", "Shift+r")
    wait(lambda: Path("report.html").exists() and Path("report.html").stat().st_size > 10000, 200)


def until(done, *names):
    """Strikes keys until that is done: without a window manager the focus comes back late after a panel."""
    for _ in range(3):
        press_keys(*names)
        end = time.monotonic() + 20.0
        while not done() and time.monotonic() < end:
            settle()
        if done():
            return
    raise AssertionError(names)


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_tab_reaches_every_control_in_the_order_of_reading():
    doc = part()
    whole_screen()
    job = beltgrinding.make_job(doc.Block, ["Face6"], Spacing="1 mm")
    beltgrinding.set_up(job)
    beltgrinding.make_belt(job)
    beltgrinding.import_program(job, "pass.csv")
    beltgrinding.make_raster(job)
    beltgrinding.simulate(job)
    beltgrinding.make_deviation(job)
    beltgrinding.make_plan(job, compute=False)
    unreached, disordered = {}, {}

    def look(name, form):
        settle()
        if found := unreachable(form):
            unreached[name] = found
        if found := out_of_order(form):
            disordered[name] = found

    def panel(name):
        settle()
        assert Gui.Control.activeDialog(), name
        areas = [
            area
            for area in visible(QtGui.QScrollArea)
            if any(box.isVisible() for box in area.findChildren(QtGui.QDialogButtonBox))
        ]
        for area in areas:
            for fold in area.findChildren(QtGui.QToolButton):
                if fold.objectName().startswith("fold") and fold.isVisible():
                    if not fold.parentWidget().content.isVisible():
                        fold.click()
            settle()
            look(name, area.widget())
        view = Gui.getDocument(doc.Name)
        view.resetEdit() if view.getInEdit() else Gui.Control.closeDialog()
        settle()

    for name in OBJECTS:
        view = doc.getObject(name).ViewObject
        view.Proxy.doubleClicked(view)
        panel(name)
    for kind in ("free_belt", "platen", "small_wheel"):
        doc.BeltMachine.Kind = kind
        view = doc.BeltMachine.ViewObject
        view.Proxy.doubleClicked(view)
        panel(kind)
    doc.BeltMachine.Kind = "contact_wheel"
    for command in COMMANDS:
        Gui.runCommand("BeltGrinding_" + command)
        panel(command)
    for command in DOCKS:
        Gui.runCommand("BeltGrinding_" + command)
        settle()
        for dock in visible(QtGui.QDockWidget):
            if dock.objectName().startswith("BeltGrinding_"):
                look(dock.objectName(), dock.widget())
                dock.close()
        settle()
    assert not unreached and not disordered, (unreached, disordered)
