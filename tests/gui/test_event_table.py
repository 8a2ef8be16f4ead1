"""Events by hand: the table, its filters, the chosen event in full, its moment in the view and in playback."""

import time
from pathlib import Path

import numpy as np
import pytest
import FreeCADGui as Gui
import Part
from PySide import QtGui

from beltgrinding.gui.panels import simulation_panel
from beltgrinding.gui.scene.cell_view import project
from support.hands import field, menu, press, settle, type_in, wait
from support.playing import prepared, record

pytestmark = pytest.mark.freecad(window=True)


def pause(seconds=0.6):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QtGui.QApplication.processEvents()
        time.sleep(0.01)


def titles(name):
    box = field(name)
    return [box.itemText(i) for i in range(box.count())]


def choose_kind(code):
    box = field("eventKind")
    box.setCurrentIndex(box.findData(code))
    settle()


def with_clamp(doc, job):
    job.ToleranceLower, job.ToleranceUpper = 0.195, 0.25
    clamp = doc.addObject("Part::Feature", "Clamp")
    clamp.Label, clamp.Shape = "clamp", Part.makeBox(25, 40, 40)
    clamp.Placement.Base = (95, 0, 60)
    doc.BeltMachine.BodiesAtPart = [clamp]
    doc.recompute()


def test_a_click_shows_the_moment_of_an_event():
    job, doc, view = prepared()
    with_clamp(doc, job)
    scene_graph = view.getSceneGraph()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    events = doc.Simulation.Proxy.events(doc.Simulation)
    assert sorted({e["kind"] for e in events}) == ["collision", "gouge"], events
    table, panel = field("events"), field("events").parent().chosen.__self__
    assert table.rowCount() == len(events) == 2
    assert titles("eventKind")[0] == "All events (2)" and "Collision (1)" in titles("eventKind")
    assert "Errors (2)" in titles("eventSeverity")
    assert not table.item(0, 0).icon().isNull()
    assert not table.isColumnHidden(3) and field("eventDetails").text() == ""
    children = scene_graph.getNumChildren()

    # The gouge: message and advice in full, marker and wheel where it was, the camera looks there.
    choose_kind("gouge")
    assert table.rowCount() == 1 and table.item(0, 2).text() == "Face6"
    assert table.item(0, 3).text() == str(events[0]["line"])
    camera = view.getCameraNode()
    before = camera.position.getValue().getValue()
    table.selectRow(0)
    gouge = next(e for e in events if e["kind"] == "gouge")
    text = field("eventDetails").text()
    assert "Gouge" in text and gouge["message"][1:] in text and gouge["advice"] in text
    assert "line" in text
    pause()
    x = panel.moment.cell.frames()["contact"][0, 3]
    assert abs(x - (10 + 30 * gouge["worst_time"])) < 0.05, x
    node, scenes = panel.moment.mark
    assert scene_graph.findChild(node) >= 0
    assert np.linalg.norm(np.subtract(camera.position.getValue().getValue(), before)) > 1
    (pixel,), _ = project(view, np.array([[*gouge["point"], 1.0]]))
    width, height = view.getSize()
    assert 0.2 < pixel[0] / width < 0.8 and 0.1 < pixel[1] / height < 0.9, pixel
    view.saveImage("gouge.png", 500, 400, "White")

    # The collision: both bodies are tinted, one after the other again.
    choose_kind("collision")
    table.selectRow(0)
    pause()
    assert panel.moment.cell.tinted == ("clamp", "wheel")
    assert "wheel run into each other" in field("eventDetails").text()
    view.saveImage("collision.png", 500, 400, "White")
    choose_kind("")
    row = next(i for i, e in enumerate(events) if e["kind"] == "gouge")
    table.selectRow(row)
    assert panel.moment.cell.tinted == ()

    # A column without content is not shown.
    widget = table.parent()
    widget.show_events([{**e, "line": 0, "face": None, "bodies": []} for e in events])
    assert table.isColumnHidden(2) and table.isColumnHidden(3)
    widget.show_events(events)

    # Closing leaves the view as it was, and the document unchanged.
    press("Close")
    assert scene_graph.getNumChildren() == children
    assert not doc.Simulation.OutOfDate

    # A macro closes it without asking it: likewise.
    simulation_panel.show_result(doc.Simulation)
    settle()
    field("events").selectRow(0)
    pause()
    assert scene_graph.getNumChildren() > children
    Gui.Control.closeDialog()
    wait(lambda: scene_graph.getNumChildren() == children, 10)
    red = [_red(Path.cwd() / f"{name}.png") for name in ("gouge", "collision")]
    assert red[1] > red[0] + 2000, red


def _red(path):
    from PIL import Image

    pixels = Image.open(path).convert("RGB").getdata()
    return sum(r > 130 and g < 100 and b < 100 for r, g, b in pixels)


def test_playback_goes_to_the_moment_of_a_chosen_event():
    job, doc, _ = prepared()
    with_clamp(doc, job)
    dock = record()
    simulation_panel.show_result(doc.Simulation)
    settle()
    panel = field("events").parent().chosen.__self__
    for kind in ("gouge", "collision"):
        choose_kind(kind)
        event = field("events").parent().rows[0]
        field("events").selectRow(0)
        pause()
        assert abs(dock.scene.time - event["worst_time"]) < 1e-6
        assert panel.moment.cell is None  # the dock's own wheel is the one that is drawn
        assert dock.scene.cell.tinted == tuple(event["bodies"])
    press("Close")
    assert dock.scene.cell.tinted == ()


def test_the_cells_panel_asks_for_clearance():
    _, doc, _ = prepared()
    menu("Cell")
    type_in("Clearance", "3.5 mm")
    field("CheckCollisions").setChecked(False)
    press("OK")
    machine = doc.BeltMachine
    assert machine.Clearance.Value == 3.5 and machine.CheckCollisions is False
