"""Temperatures in the window: none without the material, then in table, colours and legend."""


def test_the_temperature_is_shown_with_its_range_once_the_material_is_known(freecad):
    freecad.run(
        """
import json
from beltgrinding.objects import api
from support.hands import *
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

job.Heat = json.dumps({
    "conductivity_W_mK": 15, "heat_capacity_J_kgK": 500, "density_kg_m3": 7900,
    "friction": [0.3, 0.5], "partition": [0.4, 0.8],
})
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
""",
        window=True,
    )
