"""Presets and the hardness in the belt machine's panel, as a person chooses them."""

import json
from pathlib import Path

import pytest
import FreeCAD
from PySide import QtGui

from support.hands import field, menu, prepare, press, settle, type_in, widgets

pytestmark = pytest.mark.freecad(window=True)


def choose_preset(name, text):
    box = field(name, QtGui.QComboBox)
    box.setCurrentIndex(box.findText(text))
    settle()


def megapascals(machine):
    return machine.YoungsModulus.getValueAs("MPa").Value


def test_presets_set_the_machine_and_cancel_takes_back():
    job = prepare()
    doc, machine = job.Document, job.Document.BeltMachine
    before = (machine.WheelRadius.Value, megapascals(machine), machine.BeltSpeed.Value)
    steps = doc.UndoCount

    def choose_all():
        menu("Belt machine")
        choose_preset("wheelPreset", "Smooth, diameter 357 mm, 50 Shore A")
        assert machine.WheelRadius.Value == 178.5 and machine.WheelWidth.Value == 15
        assert abs(megapascals(machine) - 2.456) < 0.001
        assert field("ShoreA").text() == "50"
        assert "2.5 MPa (2.2 to 3.4" in field("ShoreAText").text()
        assert "178.5" in field("WheelRadius").text()
        choose_preset("beltPreset", "P80")
        assert "201 µm" in field("beltPresetHint").text()
        choose_preset("materialPreset", "Titanium")
        assert "8 to 15 m/s: Saint-Gobain" in field("materialPresetHint").text()
        assert machine.BeltSpeed.Value == before[2]  # a recommendation until it is asked for
        press("Set the belt speed to 11.5 m/s")
        assert abs(machine.BeltSpeed.Value - 11500) < 1e-6

    choose_all()
    press("Cancel")
    assert (machine.WheelRadius.Value, megapascals(machine), machine.BeltSpeed.Value) == before
    assert doc.UndoCount == steps
    choose_all()
    press("OK")
    assert machine.WheelRadius.Value == 178.5 and doc.UndoCount == steps + 1
    doc.undo()
    assert (machine.WheelRadius.Value, megapascals(machine), machine.BeltSpeed.Value) == before
    doc.redo()

    menu("Belt machine")
    choose_preset("materialPreset", "Nickel alloy")
    assert "No source was found" in field("materialPresetHint").text()
    assert not [b for b in widgets(QtGui.QPushButton, "UseBeltSpeed") if b.isVisible()]
    press("Cancel")


def test_a_force_control_takes_time_and_shows_what_it_takes():
    def shown(name):
        return [w for w in widgets(QtGui.QLineEdit, name) if w.isVisible()]

    job = prepare()
    machine = job.Document.BeltMachine
    assert machine.ForceModel == "ideal"
    menu("Belt machine")
    assert not shown("MovingMass") and field("Force").isVisible()
    choose_preset("actuatorPreset", "Pneumatic force flange")
    assert "estimate" in field("actuatorPresetHint").text()
    assert machine.ForceModel == "actuator" and machine.MovingMass == 5.5
    for name in ("ForceLag", "MovingMass", "Damping", "SpeedLimit", "OvershootLimit", "BounceTime"):
        assert field(name).isVisible(), name
    choose_preset("actuatorPreset", "Robot with force control")
    assert machine.ForceLag == 0.0 and machine.SpeedLimit.Value == 60.0
    type_in("MovingMass", "7.5")
    press("OK")
    given = machine.Proxy.to_job(machine)["belt_machine"]["force_dynamics"]
    assert (given["model"], given["moving_mass_kg"]) == ("actuator", 7.5), given
    menu("Belt machine")
    field("ForceModel", QtGui.QComboBox).setCurrentIndex(0)
    settle()
    assert machine.ForceModel == "ideal" and not shown("MovingMass")
    press("Cancel")


def test_the_hardness_gives_the_modulus():
    job = prepare()
    machine = job.Document.BeltMachine
    menu("Belt machine")
    type_in("ShoreA", "60")
    assert abs(megapascals(machine) - 3.605) < 0.001
    assert field("ShoreAText").text() == "60 Shore A: 3.6 MPa (3.5 to 5.9 by the formula)"
    type_in("ShoreA", "95")
    assert "from 20 to 90 Shore A" in field("ShoreAText").text()
    assert abs(megapascals(machine) - 3.605) < 0.001
    type_in("ShoreA", "60")
    type_in("YoungsModulus", "7 MPa")  # entered directly: it counts, and the hardness goes
    assert abs(megapascals(machine) - 7) < 1e-6 and field("ShoreA").text() == ""
    field("Compliance").setCurrentIndex(
        machine.getEnumerationsOfProperty("Compliance").index("geometric")
    )
    settle()
    assert not [w for w in widgets(QtGui.QLineEdit, "ShoreA") if w.isVisible()]
    press("Cancel")


def test_own_presets_are_offered_and_wrong_ones_named():
    folder = Path(FreeCAD.getUserAppDataDir(), "BeltGrinding", "presets")
    folder.mkdir(parents=True)
    number = lambda value, unit: {"value": value, "unit": unit, "source": "book"}
    wheels = [
        {
            "id": "mine",
            "name": "Mine",
            "width": number(33, "mm"),
            "poissons_ratio": number(0.48, "1"),
        },
        {"id": "bad", "name": "Bad", "width": number(33, "in")},
    ]
    sources = {"book": {"author": "Somebody", "title": "A book"}}
    data = {"schema": 1, "sources": sources, "wheels": wheels}
    (folder / "mine.json").write_text(json.dumps(data))
    job = prepare()
    machine = job.Document.BeltMachine
    menu("Belt machine")
    choose_preset("wheelPreset", "Mine")
    assert machine.WheelWidth.Value == 33 and machine.PoissonsRatio == 0.48
    assert field("PoissonsRatio").text() == "0.48"
    assert "mine.json: wheels.1.width.unit" in field("PresetProblems").text()
    press("OK")
