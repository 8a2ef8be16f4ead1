"""The finish in the window: what it is computed with, and what zones call for. The roughness is of a made-up belt."""

START = """
import json
from pathlib import Path
from support import synthetic_finish as made_up
from support.hands import *

def finish():
    return json.loads(job.Finish) if job.Finish else None

def choose_in(name, index):
    field(name, QtGui.QComboBox).setCurrentIndex(index)
    settle()

def edit():
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    field("foldFinish").click()
    settle()

def read(path):
    choose(path)
    field("readFinishModel").click()
    settle()

job = prepare()
doc = job.Document
steps = doc.UndoCount
Path("model.json").write_text(json.dumps(made_up.model()))
"""


def test_the_model_is_read_from_its_file_and_the_fields_are_the_jobs(freecad):
    freecad.run(
        START
        + """
edit()
assert field("finishChoice").currentIndex() == 0 and finish() is None
assert not field("grit").isEnabled() and not field("readFinishModel").isEnabled()
choose_in("finishChoice", 1)
assert finish() == {"crossing_angle_deg": 20.0}
assert "no roughness" in field("finishNote").text()
press("Cancel")
assert finish() is None and doc.UndoCount == steps

edit()
choose_in("finishChoice", 1)
read("model.json")
model = made_up.model()
low, high = model["ranges"]["grit"]
assert "model" not in finish() and field("grit").styleSheet(), "which of the grits nobody knows"
assert f"{low:g} to {high:g}" in field("finishNote").text(), field("finishNote").text()
choose_in("finishChoice", 0)
choose_in("finishChoice", 1)
assert finish() is None and field("grit").styleSheet(), "nothing half-done"
type_in("grit", "36")  # not measured
assert finish() is None and field("grit").styleSheet()
assert "36 was not measured" in field("finishNote").text(), field("finishNote").text()
type_in("grit", "120")
assert finish()["model"] == {**model, "calibration": {}} and finish()["grit"] == 120, finish()
assert f"{low:g} … {high:g} grit" in field("finishNote").text(), field("finishNote").text()
assert "-0.75 grit" in field("finishNote").text() and not field("grit").styleSheet()
before = finish()
choose_in("finishChoice", 0)
assert finish() is None
choose_in("finishChoice", 1)
assert finish() == before, "off and on again loses nothing"
type_in("initial_Ra_um", "3,2")
assert finish()["initial_Ra_um"] == 3.2 and finish()["grit"] == 120
type_in("grit", "")  # which the model needs
assert field("grit").styleSheet() and finish()["grit"] == 120
press("OK")
assert Gui.Control.activeDialog() and "grit" in field("note").text(), field("note").text()
type_in("grit", "120")
for name, wrong in (("rest_per_pass", "1"), ("crossing_angle_deg", "91"), ("initial_Ra_um", "rough"),
                    ("initial_Ra_um", "inf"), ("grit", "1e999")):
    before = finish()
    text = field(name).text()
    type_in(name, wrong)
    assert field(name).styleSheet() and finish() == before, name
    type_in(name, text)
    assert not field(name).styleSheet(), name
type_in("rest_per_pass", "0.3")
press("OK")
assert finish()["rest_per_pass"] == 0.3 and doc.UndoCount == steps + 1

# Of one measured grit there is nothing to ask.
one = made_up.model()
one["ranges"]["grit"] = [80, 80]
Path("one.json").write_text(json.dumps(one))
job.Finish = "{}"
edit()
read("one.json")
assert finish()["grit"] == 80 and field("grit").text() == "80"
press("Cancel")
job.Finish = json.dumps(dict(before, grit=120))

# What is no model is told with the file's name, and nothing changes.
before = job.Finish
edit()
swapped = made_up.model()
swapped["ranges"]["feed_mm_s"] = [9, 1]
for name, text in (("other.json", '{"coefficient_um": 1}'), ("no.json", '{"a'), ("list.json", "[]"),
                   ("swapped.json", json.dumps(swapped))):
    Path(name).write_text(text)
    read(name)
    assert name in field("finishNote").text(), field("finishNote").text()
    assert job.Finish == before
read("missing.json")
assert "missing.json" in field("finishNote").text() and job.Finish == before
field("dropFinishModel").click()
settle()
assert "model" not in finish() and finish()["grit"] == 120
press("OK")
doc.undo()
assert finish()["model"] and doc.UndoCount == steps + 1

# What was written by hand and is none is told, and stays until something is chosen.
for text in ('{"grit": ', '{"grain": 15}', '[1]'):
    job.Finish = text
    edit()
    assert field("finishChoice").currentIndex() == 0 and field("finishNote").text(), text
    press("OK")
    assert job.Finish == text
""",
        window=True,
    )


def test_what_a_zone_calls_for_is_typed_and_kept(freecad):
    freecad.run(
        START
        + """
from beltgrinding.objects import api
job.Finish = json.dumps({"grit": 120, "initial_Ra_um": 3.2, "model": made_up.model()})
asked = {"Ra_max_um": 0.8, "acceptance": "T16%", "lay": "=", "lay_direction": [1.0, 0.0, 0.0],
         "lay_tolerance_deg": 10.0}
exact = {"acceptance": "T16%", "lay": "⊥", "lay_direction": [0.577350269, -0.577350269, 0.577350269],
         "lay_tolerance_deg": 15.0}
api.set_zones(job, [{"name": "face", "finish": asked}, {"name": "lay", "finish": exact}])
doc.recompute()
assert job.isValid(), "the job knows that it computes the finish"

def zones():
    return json.loads(job.Zones)

steps = doc.UndoCount
menu("Tolerance zones...")
table = field("zones")
NAME, RA, LAY = 0, 7, 8
assert table.item(0, RA).text() == "0.8 T16%" and table.item(0, LAY).text() == "= 1 0 0"
table.item(0, NAME).setText("spout")
assert zones()[0]["name"] == "spout" and zones()[0]["finish"] == asked, "what no cell shows stays"
assert zones()[1]["finish"] == exact, "no digit, and the acceptance of a lay alone"
table.setCurrentCell(1, 0)
press("Remove")
press("Add")
press("Up")
assert zones()[1]["finish"] == asked and "finish" not in zones()[0]
for text, lay in (("T 0 1 0", {"lay": "⊥", "lay_direction": [0, 1, 0]}), ("X", {"lay": "X"}),
                  ("C 1,5 0 2", {"lay": "C", "lay_centre_mm": [1.5, 0, 2]})):
    table.item(0, LAY).setText(text)
    assert zones()[0]["finish"] == {"acceptance": "Tmax", "lay_tolerance_deg": 15.0, **lay}, zones()
for column, text in ((LAY, "="), (LAY, "Q"), (LAY, "= 1 0 nan"), (LAY, "= 0 0 0"), (LAY, "P"),
                     (RA, "0.4 T50%"), (RA, "-1"), (RA, "fine"),
                     (RA, "T50%"), (RA, "0.4 0.5 T16%")):
    before, old = zones(), table.item(0, column).text()
    table.item(0, column).setText(text)
    assert zones() == before and field("note").text() and "Zones:" not in field("note").text(), text
    table.item(0, column).setText(old)
    assert "Zones:" in field("note").text(), field("note").text()
table.item(0, LAY).setText("")
table.item(0, RA).setText("0,4")
assert zones()[0]["finish"]["Ra_max_um"] == 0.4
press("OK")
assert doc.UndoCount == steps + 1

# Without a finish nothing tells what becomes of it.
job.Finish = ""
doc.recompute()
assert not job.isValid()
menu("Tolerance zones...")
table = field("zones")
table.item(0, NAME).setText("other")
assert "finish" in field("note").text()
press("Cancel")
assert zones()[0]["name"] != "other"
""",
        window=True,
    )
