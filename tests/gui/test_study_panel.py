"""The study's panel and dock: what varies, Run, Cancel, the table, its charts, a row as the document's state."""

import pytest

pytest.importorskip("openturns")

PREPARE = """
import json
from support.hands import *
job = prepare()
doc = job.Document
job.Spacing = "2 mm"
doc.recompute()
"""


def test_from_what_varies_to_a_row_as_the_documents_state(freecad):
    freecad.run(
        PREPARE
        + """
steps = doc.UndoCount
menu("Study...")
study = doc.Study
assert doc.UndoCount == steps + 1
press("Run")
assert "nothing varies" in field("state").text()

keys = field("studyKeys", QtGui.QComboBox)
def vary(key, text):
    keys.setEditText(key)
    press("Add")
    number = len(json.loads(study.Vary))
    type_in(f"variedValues{number}", text)
vary("belt_machine.force_N", "20 60")
vary("stock.allowance_mm", "0.15 0.25")
assert json.loads(study.Vary)[0] == {"key": "belt_machine.force_N", "range": [20.0, 60.0]}
vary("programs[0].feed_mm_s", "20 30 40")
combo = field("variedKind3", QtGui.QComboBox)
combo.setCurrentIndex(combo.findData("values"))
settle()
assert json.loads(study.Vary)[2] == {"key": "programs[0].feed_mm_s", "values": [20.0, 30.0, 40.0]}
keys.setEditText("belt_machine.fors_N")
press("Add")
assert "force_N" in field("state").text() and len(json.loads(study.Vary)) == 3
vary("law.pressure_exponent", "0.9 1.1 5")
assert json.loads(study.Vary)[3] == {"key": "law.pressure_exponent", "range": [0.9, 1.1], "steps": 5}
field("removeVaried4", QtGui.QToolButton).click()
settle()
assert len(json.loads(study.Vary)) == 3

field("foldBest", QtGui.QToolButton).click()
settle()
for name, chosen in (("bestFigure", "process_time_s"), ("bestLimit", "removed_volume_mm3")):
    box = field(name, QtGui.QComboBox)
    box.setCurrentIndex(box.findData(chosen))
type_in("bestLow", "many")
assert "no number" in field("state").text()
type_in("bestLow", "120")
assert json.loads(study.Asked)["best"]["limits"] == {"removed_volume_mm3": [120.0, None]}
field("foldBest", QtGui.QToolButton).click()
field("Runs", QtGui.QSpinBox).setValue(24)
field("Workers", QtGui.QSpinBox).setValue(1)
press("Run")
wait(lambda: study.Fingerprint, 200)
settle()
assert study.RunsDone == 24 and "24 of 24 runs have figures" in field("state").text()

rows = field("studyRows")
assert rows.rowCount() == 24 and rows.columnCount() > 20
heads = [rows.horizontalHeaderItem(k).text() for k in range(rows.columnCount())]
assert heads[:2] == ["Run", "State"] and "belt_machine.force_N" in heads, heads
rows.sortByColumn(2, QtCore.Qt.DescendingOrder)
settle()
forces = [float(rows.item(k, 2).text()) for k in range(24)]
assert forces == sorted(forces, reverse=True)

kind, figure = field("studyChart", QtGui.QComboBox), field("studyFigure", QtGui.QComboBox)
figure.setCurrentIndex(figure.findData("removed_volume_mm3"))
for chart in ("tornado", "effects", "scatter", "yield", "matrix"):
    kind.setCurrentIndex(kind.findData(chart))
    settle()
    assert not field("studyPicture").pixmap_.isNull(), chart
kind.setCurrentIndex(kind.findData("sobol"))
settle()
assert not field("studyPicture").pixmap_.isNull() or "Q2" in field("studyNote").text()
kind.setCurrentIndex(0)
settle()
# A picture as high as its place: a scroll bar that came and went would resize it without end.
area = field("studyPicture").parent().parent().parent()
assert isinstance(area, QtGui.QScrollArea)
for height in range(120, 400, 7):
    area.setFixedHeight(height)
    settle()
area.setMinimumHeight(0)
area.setMaximumHeight(16777215)
settle()
press("Close")
Gui.activeDocument().activeView().viewIsometric()
Gui.SendMsgToActiveView("ViewFit")
settle()
picture("workbench-study-table")

# A double click sets the document to the run, as one step.
rows.setCurrentCell(0, 0)
number = int(rows.item(0, 0).text())
steps = doc.UndoCount
rows.cellDoubleClicked.emit(0, 0)
settle()
assert doc.UndoCount == steps + 1
made = study.Proxy.table(study)
force = float(made["belt_machine.force_N"][number - 1])
assert abs(doc.BeltMachine.Force.getValueAs("N").Value - force) < 1e-9 and force == made["belt_machine.force_N"].max()
assert not study.OutOfDate and f"set to run {number}" in field("studyFigures").text()
doc.undo()
doc.recompute()
assert doc.BeltMachine.Force.getValueAs("N").Value == 30.0 and not study.OutOfDate

best = study.Proxy.answers(study)["best"]
assert f"best: run {best['run']}" in field("studyFigures").text()
good = made["removed_volume_mm3"] >= 120.0
assert best["value"] == made["process_time_s"][good].min() and good[best["run"] - 1]
name_file("table.csv")
press("Save table...")
assert Path("table.csv").read_bytes() == made.csv_bytes()
name_file("study.html")
press("Report...")
wait(lambda: Path("study.html").exists(), 60)
assert "Tolerance yield" in Path("study.html").read_text()
""",
        window=True,
    )


def test_the_panel_as_it_looks(freecad):
    freecad.run(
        PREPARE
        + """
import beltgrinding
varied = [
    {"key": "belt_machine.force_N", "range": [20, 60]},
    {"key": "stock.allowance_mm", "distribution": {"kind": "normal", "mean": 0.2, "sd": 0.02, "lower": 0.0}},
    {"key": "placement.z_mm", "distribution": {"kind": "normal", "mean": 0, "sd": 0.05}},
    {"key": "programs[0].feed_mm_s", "values": [20, 30, 40]},
]
study = beltgrinding.make_study(job, compute=False, Vary=varied, Runs=200)
menu("Study...")
assert [field(f"variedValues{k}").text() for k in range(1, 5)] == ["20  60", "0.2  0.02", "0  0.05", "20  30  40"]
press("Close")
assert json.loads(study.Vary) == varied, "what was not changed is as it was"
menu("Study...")
assert field("Runs", QtGui.QSpinBox).value() == 200
picture("workbench-study")
""",
        window=True,
    )


def test_cancel_keeps_what_is_finished(freecad):
    freecad.run(
        PREPARE
        + """
import beltgrinding
job.Spacing = "0.6 mm"
varied = [{"key": "belt_machine.force_N", "range": [20, 60]}]
study = beltgrinding.make_study(job, compute=False, Vary=varied, Runs=40, Workers=1)
menu("Study...")
press("Run")
wait(lambda: " of 40 runs" in field("state").text() and not field("state").text().startswith("0 of"), 120)
press("Cancel")
wait(lambda: study.Fingerprint, 60)
settle()
kept = study.RunsDone
assert 0 < kept < 40 and "are kept" in field("state").text(), (kept, field("state").text())
rows = field("studyRows")
assert rows.rowCount() == 40
assert sum(rows.item(k, 1).text() == "open" for k in range(40)) == 40 - kept
field("Seed", QtGui.QSpinBox).setValue(1)
study.Seed = 1
press("Run")
wait(lambda: study.RunsDone == 40, 300)
press("Close")
""",
        window=True,
    )
