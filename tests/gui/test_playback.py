"""Playback by hand: record, play, scrub, step to an event, close; wheel, colours and chart follow."""

import time
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from beltgrinding.gui.scene import cell_view
from support.hands import field, menu, press, settle, wait, widgets
from support.playing import brown, prepared, record
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def test_a_recording_is_played_and_leaves_the_document_as_it_was():
    _, doc, view = prepared()
    dock = record()
    scene = dock.scene
    simulation = doc.Simulation
    assert scene.recording.last == simulation.Steps and abs(scene.duration - 4 / 3) < 1e-6
    menu("Deviation")
    press("OK")
    dock.show_result()
    scene = dock.scene
    field("playbackKept").click()
    doc.saveAs(str(Path("played.FCStd").absolute()))
    Gui.SendMsgToActiveView("Save")
    assert not Gui.ActiveDocument.Modified

    def wheel():
        return scene.cell.frames()["contact"][:3, 3]

    def height():
        return np.asarray(scene.recording.heights_at(scene.frame))

    # Scrubbing: the poses lie at x = 10 to 50, y = 20, 30 mm/s.
    slider = field("timeSlider")
    assert np.allclose(wheel(), [10, 20, 20.2]) and scene.frame == 0
    scene.cell.things["contact"].removeAllChildren()  # the wheel covers what it grinds
    patch(
        cell_view.CellView, "draw_loads", lambda cell: cell.loads.removeAllChildren()
    )  # arrows, too
    slider.setValue(0)
    before = brown("before.png")
    assert before > 10000, before
    slider.setValue(slider.maximum() // 2)
    assert np.allclose(wheel()[0], 30, atol=0.01), wheel()
    assert "pose 5" in field("moment").text() and "line 6" in field("moment").text()
    half = brown("half.png")
    slider.setValue(slider.maximum())
    final = brown("final.png")
    assert before > half + 500 and half > final + 500, (before, half, final)
    assert np.allclose(scene.field.heights, height())
    assert np.allclose(height(), simulation.Proxy.field(simulation).height, atol=1e-6)
    slider.setValue(0)
    assert abs(brown("again.png") - before) < 50
    assert not doc.Deviation.ViewObject.SwitchNode.whichChild.getValue() >= 0

    # A click in the chart goes there; rows can be chosen.
    chart = field("stripChart")
    place = QtCore.QPointF(round(chart.x(1.0)), 30)
    press_event = QtGui.QMouseEvent(
        QtCore.QEvent.MouseButtonPress,
        place,
        QtCore.QPointF(chart.mapToGlobal(place.toPoint())),
        QtCore.Qt.LeftButton,
        QtCore.Qt.LeftButton,
        QtCore.Qt.NoModifier,
    )
    QtGui.QApplication.sendEvent(chart, press_event)
    assert abs(scene.time - 1.0) < 0.01 and abs(wheel()[0] - 40) < 0.3
    chart.menu.actions()[0].setChecked(False)
    assert [row[0] for row in chart.rows()] == ["contact_area", "peak_pressure", "removal_rate"]

    # Playing slowly moves on, and pauses.
    slider.setValue(0)
    speed = field("speed")
    speed.setCurrentIndex(speed.findText("0.2 ×"))
    field("play").click()
    wait(lambda: scene.time > 0.1)
    field("play").click()
    moment = scene.time
    time.sleep(0.2)
    settle()
    assert scene.time == moment and abs(wheel()[0] - 10 - 30 * moment) < 0.01
    speed.setCurrentIndex(speed.findText("100 ×"))
    field("play").click()
    wait(lambda: not dock.clock.isActive())
    assert scene.time == scene.duration

    # Events.
    dock.events = [{"time": 0.5}, {"time": 1.2}]
    field("previousEvent").click()
    assert scene.time == 1.2
    field("previousEvent").click()
    field("previousEvent").click()
    assert scene.time == 0.5
    field("nextEvent").click()
    assert scene.time == 1.2

    nodes = view.getSceneGraph().getNumChildren()
    dock.close()
    settle()
    assert view.getSceneGraph().getNumChildren() == nodes - 2  # wheel and field are gone
    assert doc.Deviation.ViewObject.SwitchNode.whichChild.getValue() >= 0
    assert not Gui.ActiveDocument.Modified

    # Reopened, it plays at once; a closed document takes the dock with it.
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("played.FCStd")
    settle()
    Gui.Selection.addSelection(doc.Name, "BeltGrindingJob")
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    assert dock.scene.recording.last == doc.Simulation.Steps
    field("play").click()
    FreeCAD.closeDocument(doc.Name)
    settle()
    docks = widgets(QtGui.QDockWidget, "BeltGrinding_PlaybackDock")
    assert not any(dock.isVisible() or dock.clock.isActive() or dock.scene for dock in docks)


@pytest.mark.slow
def test_a_run_without_recording_forgets_the_old_one():
    job, doc, _ = prepared()
    dock = record()
    kept = field("playbackKept")
    assert not kept.isChecked() and not doc.Simulation.KeepRecording
    kept.click()
    assert doc.Simulation.KeepRecording
    doc.undo()
    assert not doc.Simulation.KeepRecording and not kept.isChecked()
    dock.close()
    assert "Recording" in doc.Simulation.PropertiesList
    job.Document.BeltMachine.Force = "20 N"
    doc.recompute()
    __import__("beltgrinding").simulate(job)  # a macro's records nothing
    assert not doc.Simulation.OutOfDate and "Recording" not in doc.Simulation.PropertiesList
    menu("Playback")
    assert field("record").isVisible()
    field("BeltGrinding_PlaybackDock").close()
