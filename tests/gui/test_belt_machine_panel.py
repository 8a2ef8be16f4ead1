"""The belt machine's panel for its kinds: what each needs, presets, layers, the drawing, the cell; Cancel and undo."""

import json

import pytest
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.gui.scene import belt_shapes
from support import pictures
from support.hands import (
    field,
    fit_view,
    menu,
    picture,
    prepare,
    press,
    settle,
    type_in,
    wait,
    walked,
    whole_screen,
    widgets,
)
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def shown(name):
    return bool([w for w in widgets(QtGui.QWidget, name) if w.isVisible()])


def choose_in(name, text):
    box = field(name, QtGui.QComboBox)
    assert box.findText(text) >= 0, [box.itemText(k) for k in range(box.count())]
    box.setCurrentIndex(box.findText(text))
    settle()


def drawn():
    drawing = field("machineDrawing")
    image = drawing.grab().toImage()
    return {
        image.pixelColor(x, y).name()
        for x in range(0, image.width(), 2)
        for y in range(0, image.height(), 2)
    }


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_each_kind_has_its_fields_and_its_drawing():
    job = prepare()
    doc, machine = job.Document, job.Document.BeltMachine
    steps = doc.UndoCount
    menu("Belt machine")
    assert (
        shown("WheelRadius")
        and shown("wheelPreset")
        and not shown("RunLength")
        and not shown("PlatenLength")
    )
    wheel = drawn()
    choose_in("Kind", "Free belt")
    assert (
        not shown("WheelRadius")
        and not shown("wheelPreset")
        and shown("RunLength")
        and not shown("PlatenLength")
    )
    assert drawn() - wheel or wheel - drawn()
    type_in("RunPosition", "-30 mm")
    type_in("RunTension", "0")
    assert field("RunTension").styleSheet() and machine.RunTension > 0
    press("OK")  # refused: the panel stays
    assert Gui.Control.activeDialog() and "Tension" in field("note").text(), field("note").text()
    type_in("RunTension", "3")
    type_in("RunPosition", "150 mm")
    press("OK")
    assert Gui.Control.activeDialog() and "between the rollers" in field("note").text(), field(
        "note"
    ).text()
    type_in("RunPosition", "0 mm")
    choose_in("Kind", "Platen")
    assert shown("RunLength") and shown("PlatenLength")
    bare = drawn()
    press("Add layer")
    type_in("layerThickness1", "x")
    press("OK")
    assert Gui.Control.activeDialog() and shown("layerNote"), "a layer of no thickness"
    type_in("layerThickness1", "8")
    assert json.loads(machine.PlatenLayers)[0]["thickness_mm"] == 8.0
    assert not shown("layerNote")
    press("Cancel")
    assert machine.Kind == "contact_wheel" and not machine.PlatenLayers and doc.UndoCount == steps
    menu("Belt machine")
    choose_in("Kind", "Platen")
    press("Add layer")
    press("OK")
    assert machine.Kind == "platen" and doc.UndoCount == steps + 1
    doc.undo()
    assert machine.Kind == "contact_wheel" and not machine.PlatenLayers
    doc.redo()
    assert (
        machine.Kind == "platen"
        and json.loads(machine.PlatenLayers)[0]["youngs_modulus_MPa"] == 2.0
    )
    menu("Belt machine")
    assert field("layerModulus1").text() == "2"
    press("Cancel")

    # Layers that were written by hand and are none: the panel opens, the cell is drawn, OK puts what it shows.
    for text in ("[{", '[{"thickness_mm": 5}]', "[1]"):
        machine.PlatenLayers = text
        menu("Cell")
        press("Cancel")
        menu("Belt machine")
        assert not shown("layerModulus1")
        press("OK")
        assert not machine.PlatenLayers, text
    # So is a fork that ends within its wheel.
    machine.Kind, machine.ForkLength = "small_wheel", 10
    menu("Cell")
    press("Cancel")
    menu("Belt machine")
    assert drawn()
    press("Cancel")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_a_preset_makes_it_a_free_belt_that_is_drawn_in_the_cell():
    made = []
    parts = belt_shapes.parts

    def watched(machine):
        made.append(parts(machine))
        return made[-1]

    patch(belt_shapes, "parts", watched)
    whole_screen()
    job = prepare()
    doc, machine = job.Document, job.Document.BeltMachine
    fit_view()
    menu("Belt machine")
    choose_in("machinePreset", "Free belt 40 mm, tube belt grinder")
    assert machine.Kind == "free_belt" and machine.RunWidth.Value == 40 and machine.RunTension == 2
    assert (
        "Width 40 mm; belt speed of the machine 8.4 to 28 m/s: Metabo"
        in field("machinePresetHint").text()
    ), field("machinePresetHint").text()
    assert field("Kind", QtGui.QComboBox).currentText() == "Free belt" and shown("RunLength")
    assert "250" in field("RunLength").text()
    picture("workbench-free-belt")
    press("OK")
    menu("Cell")
    assert set(made[-1]) == {"", "roller_before", "roller_behind"}
    press("Cancel")
    machine.Kind = "small_wheel"
    doc.recompute()
    menu("Belt machine")
    field("foldFork").click()
    assert shown("WheelRadius") and shown("ForkLength") and not shown("RunLength")
    small = drawn()
    type_in("ForkLength", "30 mm")  # the wheel's radius is 60
    press("OK")
    assert Gui.Control.activeDialog() and "pulleys" in field("note").text(), field("note").text()
    type_in("ForkLength", "150 mm")
    press("OK")
    assert not Gui.Control.activeDialog()
    menu("Cell")
    press("Cancel")
    machine.Kind = "platen"
    doc.recompute()
    menu("Cell")
    assert set(made[-1]) == {"", "roller_before", "roller_behind", "platen"}
    press("Cancel")

    # Simulated, played, and its events walked.
    machine.Kind, machine.ForceTravel, machine.ContactSpacing = "free_belt", 30, 2
    doc.recompute()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None, 200)
    assert doc.Simulation.RemovedVolume.Value > 0
    press("Deviation")
    press("OK")
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    wait(lambda: dock.scene is not None, 200)
    dock.scrub(1.0)
    settle()
    dock.close()
    pictures.check(*walked())


def test_the_force_device_has_its_fields():
    job = prepare()
    machine = job.Document.BeltMachine
    menu("Belt machine")
    assert not shown("ForceDevice")
    field("foldDevice").click()
    assert shown("ForceDevice") and not shown("DeviceName") and not shown("DeviceLeast")
    choose_in("ForceDevice", "Analog output")
    assert shown("DeviceName") and shown("DeviceOutput") and shown("DeviceRamp")
    assert not shown("DeviceTemplate")
    type_in("DeviceName", "aoForce")
    type_in("DeviceScale", "0.01")
    type_in("DeviceOffset", "-0.1")
    type_in("DeviceGreatest", "80 N")
    press("OK")
    given = machine.Proxy.to_job(machine)["belt_machine"]["force_device"]
    assert (given["kind"], given["name"], given["scale_per_N"]) == ("analog", "aoForce", 0.01)
    assert (given["offset"], given["greatest_N"], given["output"]) == (-0.1, 80.0, 1)
    menu("Belt machine")
    choose_in("ForceDevice", "Statement of your own")
    type_in("DeviceTemplate", "FORCE({newton:.1f})")
    assert not shown("DeviceOutput")
    press("OK")
    assert machine.Proxy.force_device(machine).template == "FORCE({newton:.1f})"
    menu("Belt machine")
    type_in("DeviceTemplate", "FORCE(30)")
    press("OK")  # refused, or told
    assert "newton" in field("note").text(), field("note").text()
    press("Cancel")
