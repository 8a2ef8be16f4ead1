"""Temperatures in the window: none without the material, then in table, colours and legend."""

import json

import pytest
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.objects import api
from support.hands import field, prepare, press, settle, type_in

pytestmark = pytest.mark.freecad(window=True)


def test_the_temperature_is_shown_with_its_range_once_the_material_is_known():
    job = prepare()
    doc = job.Document

    def rows():
        table = field("statistics")
        return {table.item(i, 0).text(): table.item(i, 1).text() for i in range(table.rowCount())}

    def shown():
        api.simulate(job)
        deviation = doc.getObject("Deviation") or api.make_deviation(job)
        settle()
        deviation.ViewObject.Proxy.doubleClicked(deviation.ViewObject)
        settle()
        return deviation

    deviation = shown()
    assert deviation.GreatestTemperature == 0.0
    assert "Hottest" not in rows()
    press("OK")

    job.Heat = json.dumps(
        {
            "conductivity_W_mK": 15,
            "heat_capacity_J_kgK": 500,
            "density_kg_m3": 7900,
            "friction": [0.3, 0.5],
            "partition": [0.4, 0.8],
        }
    )
    deviation = shown()
    assert 20.0 < deviation.GreatestTemperature < deviation.GreatestTemperatureAtMost
    assert rows()["Hottest"] == f"{deviation.GreatestTemperature:.0f} °C"
    assert rows()["Hottest, at most"] == f"{deviation.GreatestTemperatureAtMost:.0f} °C"
    before = list(deviation.VertexColors)
    choice = field("ColourBy")
    choice.setCurrentIndex(choice.findText("Greatest temperature"))
    settle()
    assert deviation.ColourBy == "temperature"
    assert list(deviation.VertexColors) != before
    press("OK")


@pytest.mark.slow
def test_the_material_is_chosen_and_its_values_are_the_jobs():
    def choose_in(name, text):
        box = field(name, QtGui.QComboBox)
        assert box.findText(text) >= 0, [box.itemText(k) for k in range(box.count())]
        box.setCurrentIndex(box.findText(text))
        settle()

    def heat():
        return json.loads(job.Heat) if job.Heat else None

    def edit():
        job.ViewObject.Proxy.doubleClicked(job.ViewObject)
        settle()
        field("foldHeat").click()
        settle()

    job = prepare()
    doc = job.Document
    steps = doc.UndoCount
    edit()
    assert field("thermalPreset").currentText() == "not computed" and heat() is None
    assert not field("conductivity_W_mK").isEnabled()
    choose_in("thermalPreset", "Stainless steel, austenitic (1.4301)")
    assert heat()["conductivity_W_mK"] == 15 and heat()["burn_temperature_C"] == 290
    assert "Stainless Steel Association" in heat()["burn_source"]
    assert "EN 10088-1" in field("heatNote").text() and "estimate" in field("heatNote").text()
    press("Cancel")
    assert heat() is None and doc.UndoCount == steps

    edit()
    choose_in("thermalPreset", "Stainless steel, austenitic (1.4301)")
    type_in("friction2", "0.2")  # below the least
    assert field("friction2").styleSheet() and heat()["friction"] == [0.3, 0.5]
    press("OK")
    assert Gui.Control.activeDialog() and "0.2" in field("note").text(), field("note").text()
    for text in ("1e999", "", "much"):  # JSON knows no infinity
        type_in("density_kg_m3", text)
        assert field("density_kg_m3").styleSheet() and heat()["density_kg_m3"] > 1000, text
        assert "no number" in field("heatNote").text(), field("heatNote").text()
    type_in("density_kg_m3", f"{heat()['density_kg_m3']:g}")
    type_in("friction2", "0,6")
    assert not field("friction2").styleSheet() and heat()["friction"] == [0.3, 0.6]
    assert field("thermalPreset").currentText() == "own values" and heat()["material"] == ""
    type_in("burn_temperature_C", "400")
    assert heat()["burn_temperature_C"] == 400 and heat()["burn_source"] == ""
    type_in("start_temperature_C", "-5")
    press("OK")
    assert heat()["start_temperature_C"] == -5 and doc.UndoCount == steps + 1
    edit()
    assert (
        field("thermalPreset").currentText() == "own values" and field("friction2").text() == "0.6"
    )
    choose_in("thermalPreset", "not computed")
    press("OK")
    assert heat() is None
    doc.undo()
    assert heat()["friction"] == [0.3, 0.6]

    # What was written by hand and is none is told, and stays until something is chosen.
    for text in ('{"friction": [0.3', '{"conductivity_W_mK": 15}', "[1]"):
        job.Heat = text
        edit()
        assert (
            field("thermalPreset").currentText() == "not computed" and field("heatNote").text()
        ), text
        press("OK")
        assert job.Heat == text
    edit()
    choose_in("thermalPreset", "Carbon steel")
    press("OK")
    assert heat()["conductivity_W_mK"] == 53
