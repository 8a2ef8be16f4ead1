"""The dock of the examples: each has a picture and a sentence, is set up and run, by mouse and keyboard."""

import os

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.gui.docks.examples_dock import NAME, TOPICS
from beltgrinding.objects import api
from support.cut_off import cut_off
from support.hands import (
    bury,
    field,
    key,
    menu,
    press,
    screenshot,
    settle,
    start,
    visible,
    wait,
    window,
)
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)
SHOTS = os.environ.get("BELTGRINDING_SHOTS")


def opened():
    start()
    window.resize(1366, 700)
    menu("Examples...")
    return field("examples", QtGui.QTreeWidget)


def test_each_example_has_a_picture_and_a_sentence():
    shown = opened()
    names = [name for _, rows in TOPICS for name, *_ in rows]
    assert sorted(names) == sorted(["blade", "edges", "knife", "tap", "tap_belt", "vane"])
    told = set()
    for topic in range(shown.topLevelItemCount()):
        head = shown.topLevelItem(topic)
        for k in range(head.childCount()):
            shown.setCurrentItem(head.child(k))
            settle()
            assert not head.child(k).icon(0).isNull()
            told.add(field("exampleSentence").text())
    assert len(told) == 6 and all(20 < len(text) < 100 for text in told), told
    (dock,) = visible(QtGui.QDockWidget, NAME)
    assert not cut_off(dock), cut_off(dock)
    if SHOTS:
        screenshot(f"{SHOTS}/examples.png")


def test_the_keyboard_sets_one_up_and_a_button_runs_one():
    made = []
    patch(api, "open_example", lambda folder, name: made.append((folder.name, name)) or job())

    def job():
        doc = FreeCAD.newDocument("example")
        return doc.addObject("App::DocumentObjectGroup", "Group")

    shown = opened()
    for code in (QtCore.Qt.Key_Down, QtCore.Qt.Key_Return):
        key(code)
    settle()
    assert made == [("tap_belt", "tap_belt")] and not visible(QtGui.QDockWidget, NAME)
    bury()

    # Run simulates what it has set up.
    ran = []
    patch(Gui, "runCommand", lambda name: ran.append(name))
    shown = opened()
    (item,) = shown.findItems("Chef's knife", QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive)
    shown.setCurrentItem(item)
    press("Run")
    assert made[1:] == [("knife", "knife")] and ran == ["BeltGrinding_Simulate"]
    bury()

    # The dock shows a mistake and stays open; so it does beside a panel.
    def fails(*_):
        raise beltgrinding.InputError("test.none", "no such example")

    patch(api, "open_example", fails)
    opened()
    press("Set up")
    (box,) = visible(QtGui.QMessageBox, "BeltGrinding_Error")
    assert "no such example" in box.text() and visible(QtGui.QDockWidget, NAME)
    box.close()
    Gui.Control.showDialog(Panel())
    press("Set up")
    assert "task panel" in field("exampleSentence").text() and len(made) == 2


class Panel:
    def __init__(self):
        self.form = QtGui.QWidget()


@pytest.mark.slow
def test_run_grinds_the_blade():
    shown = opened()
    (item,) = shown.findItems("Compressor blade", QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive)
    shown.setCurrentItem(item)
    press("Run")
    doc = FreeCAD.ActiveDocument
    wait(lambda: doc.getObject("Simulation") is not None, 200)
    assert doc.Simulation.RemovedVolume.Value > 0
