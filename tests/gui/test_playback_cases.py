"""Playback where it is disturbed: closed, undone, deleted, cancelled; and what it shows besides."""

import threading
import time

import numpy as np
import pytest
import FreeCAD
from PySide import QtGui

from beltgrinding import core
from beltgrinding.gui.charts import strip_chart
from beltgrinding.gui.preferences_page import PreferencesPage
from beltgrinding.objects import simulation as simulation_object
from support.hands import field, menu, prepare, press, settle, visible, wait, widgets
from support.playing import prepared, record
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def recorded():
    dock = record()
    scene = dock.scene
    return dock, scene


def test_events_are_marked_in_the_strip_chart():
    job, doc, _ = prepared()
    job.HeatLimit = 0.01
    doc.recompute()
    dock = record()
    events = doc.Simulation.Proxy.events(doc.Simulation)
    assert any(e["kind"] == "burn_risk" for e in events), events
    chart = field("stripChart")
    mark = QtGui.QColor(strip_chart.MARK)

    def marks():
        image = chart.grab().toImage()
        ratio = image.width() / chart.width()
        row = round(3 * ratio)
        return {
            round(x / ratio)
            for x in range(image.width())
            if QtGui.QColor(image.pixel(x, row)) == mark
        }

    seen = marks()
    assert seen
    for event in events:
        x = chart.x(event["time"])
        assert min(abs(x - s) for s in seen) <= 2, (x, seen)
        found = chart.event_near(x)
        assert found is not None and abs(found["time"] - event["time"]) < 0.02
    assert all(
        min(abs(chart.x(e["time"]) - s) for e in events) <= 4 for s in seen
    )  # and none elsewhere
    assert "Burn risk" in strip_chart.describe(events[0])
    field("nextEvent").click()
    assert any(abs(dock.scene.time - e["time"]) < 1e-9 for e in events)
    chart.events = []
    chart.picture = None
    assert not marks()
    dock.close()


def test_part_in_hand_moves_and_the_wheel_stands():
    _, doc, view = prepared()
    machine, path = doc.BeltMachine, doc.RobotPath
    # The same contacts, the part in the hand: base_from_tcp is work_from_contact's inverse.
    path.Poses = [p.inverse() for p in path.Poses]
    machine.Holding = "part_in_hand"
    doc.recompute()
    dock = record()
    scene = dock.scene
    assert abs(doc.Simulation.RemovedVolume.Value - 100) < 2
    moves = field("playbackMoves")
    assert moves.isEnabled()
    carrier = scene.cell.carrier

    def place():
        return np.array(carrier.matrix.getValue().getValue()).reshape(4, 4).T

    def wheel():
        return place() @ scene.cell.frames()["contact"]

    slider = field("timeSlider")
    slider.setValue(slider.maximum() // 2)
    assert np.allclose(place(), np.eye(4))  # the part is drawn where the document has it
    moves.setChecked(True)
    first = None
    for share in (0.0, 0.3, 0.7, 1.0):
        slider.setValue(round(share * slider.maximum()))
        first = wheel() if first is None else first
        assert np.allclose(wheel(), first, atol=1e-3), (share, wheel())  # the machine stands
        assert abs(np.linalg.norm(place()[:3, 3]) - 40 * share) < 0.01, (
            share,
            place(),
        )  # 40 mm of pass
    moves.setChecked(False)
    assert np.allclose(place(), np.eye(4))
    field("play").click()
    wait(lambda: scene.time >= 0.2 or not dock.clock.isActive())
    dock.close()
    children = view.getSceneGraph().getChildren()
    assert not any(child == carrier for child in children)


def test_it_follows_the_bounds_and_steps_of_the_deviation():
    job, doc, _ = prepared()
    dock, scene = recorded()
    menu("Deviation")
    press("OK")
    dock.show_result()
    scene = dock.scene
    deviation = doc.Deviation
    before = scene.scale
    deviation.Bounds = "by tolerance"
    deviation.TimesTolerance = 3.0
    deviation.Bands = 4
    doc.recompute()
    settle()
    assert abs(scene.scale[2] - 0.15) < 1e-9 and scene.scale[3] == 4, (before, scene.scale)
    assert deviation.ViewObject.SwitchNode.whichChild.getValue() < 0  # still hidden
    assert deviation.ViewObject.Proxy.legend.whichChild.getValue() < 0
    scene.cell.things["contact"].removeAllChildren()
    slider = field("timeSlider")
    slider.setValue(slider.maximum())
    seen = []
    values = scene.field.drawn.set_values
    scene.field.drawn.set_values = lambda *given: (seen.append(given), values(*given))
    scene.recolour(job)
    heights, low, high, palette, missing = seen[0]
    assert (low, high) == (-scene.scale[2], scene.scale[2])
    middles = [low + (high - low) * (k + 0.5) / len(palette) for k in range(len(palette))]
    assert list(palette) == list(core.colour_scale(-0.05, 0.05, 0.15, middles, 4, None))

    # The preferences' colours, too.
    page = PreferencesPage()
    page.loadSettings()
    page.colours["ColourAbove"].show_colour(0x20A040FF)
    page.saveSettings()
    settle()
    assert scene.scale[4] is not None and 0x20A040FF in scene.scale[4]
    assert list(seen[-1][3]) == list(
        core.colour_scale(-0.05, 0.05, 0.15, middles, 4, scene.scale[4])
    )
    dock.close()
    settle()
    assert deviation.ViewObject.SwitchNode.whichChild.getValue() >= 0
    assert deviation.ViewObject.Proxy.legend.whichChild.getValue() != -1


def test_a_recording_is_cancelled():
    job, doc, _ = prepared()
    job.Spacing = 0.05
    doc.recompute()
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    press("Simulate with recording")
    wait(lambda: dock.bar.value() > 0)
    field("cancelRecording").click()
    wait(lambda: dock.runner is None)
    assert (
        doc.getObject("Simulation") is None and "Cancelled" in dock.state.text()
    ), dock.state.text()

    for close in (lambda: dock.close(), lambda: FreeCAD.closeDocument(doc.Name)):
        press("Simulate with recording")
        runner = dock.runner
        wait(lambda: dock.bar.value() > 0)
        close()
        wait(lambda: not runner.thread.is_alive())
        settle()
        docks = widgets(QtGui.QDockWidget, "BeltGrinding_PlaybackDock")
        assert not any(d.isVisible() for d in docks)
        if FreeCAD.listDocuments():
            assert doc.getObject("Simulation") is None
            menu("Playback")
            dock = field("BeltGrinding_PlaybackDock")
    assert not FreeCAD.listDocuments()


@pytest.mark.slow
@pytest.mark.freecad(window=True, quiet=True)
def test_it_stands_undo_and_a_deleted_result_while_it_plays():
    job, doc, view = prepared()
    dock, scene = recorded()
    nodes = scene.cell.root, scene.cell.carrier

    def play():
        speed = field("speed")
        speed.setCurrentIndex(speed.findText("0.1 ×"))
        field("play").click()
        begin = dock.scene.time
        wait(lambda: dock.scene.time > begin)

    # An input changes: said at once, and taken back by undo.
    play()
    assert not visible(QtGui.QLabel, "playbackOutOfDate")
    doc.openTransaction("force")
    doc.BeltMachine.Force = "20 N"
    doc.commitTransaction()
    doc.recompute()
    settle()
    assert field("playbackOutOfDate").isVisible() and dock.clock.isActive()
    doc.undo()
    doc.recompute()
    settle()
    assert not dock.stale.isVisible() and dock.scene is scene and dock.clock.isActive()

    # Undo of the run itself: nothing is left to play; redo brings it back.
    doc.undo()
    settle()
    assert doc.getObject("Simulation") is None and dock.isVisible()
    assert dock.scene is None and not dock.clock.isActive()
    assert "no result" in dock.state.text(), dock.state.text()
    assert all(view.getSceneGraph().findChild(node) < 0 for node in nodes)
    doc.redo()
    settle()
    dock.show_result()
    play()

    # The Simulation is deleted, or what is drawn needs an object that is.
    doc.removeObject("Simulation")
    settle()
    assert dock.scene is None and not dock.clock.isActive() and field("record").isVisible()
    press("Simulate with recording")
    wait(lambda: dock.scene is not None)
    play()
    doc.removeObject("BeltMachine")
    settle()
    assert dock.scene is None and "belt machine" in dock.state.text(), dock.state.text()
    press("Simulate with recording")
    assert dock.runner is None and "belt machine" in dock.state.text()
    doc.removeObject(job.Name)
    settle()
    dock.close()
    docks = widgets(QtGui.QDockWidget, "BeltGrinding_PlaybackDock")
    assert not any(d.isVisible() for d in docks)

    # The document is closed while it plays.
    job = prepare()
    doc = job.Document
    dock = record()
    play()
    FreeCAD.closeDocument(doc.Name)
    settle()
    docks = widgets(QtGui.QDockWidget, "BeltGrinding_PlaybackDock")
    assert not any(d.isVisible() or d.clock.isActive() or d.scene for d in docks)


def test_a_recording_is_read_beside_the_windows_thread():
    _, doc, _ = prepared()
    dock = record()
    dock.close()
    threads = []
    read = simulation_object.Simulation.recording

    def slow(proxy, obj):
        threads.append(threading.current_thread())
        time.sleep(0.5)
        return read(proxy, obj)

    patch(simulation_object.Simulation, "recording", slow)
    menu("Playback")
    assert threads and threads[0] is not threading.main_thread()
    assert field("BeltGrinding_PlaybackDock").scene is not None
