"""The belt plan's panel: costs, what is found, its chart, files, what is refused; the job stays as it is."""

import json
from pathlib import Path

import pytest
from PySide import QtGui

from support.planning import prepared
from support.hands import field, menu, press, settle, visible, wait

pytestmark = pytest.mark.freecad(window=True)


def worn(doc, job):
    job.Law, job.WearModel, job.WearScale, job.WearRest = "local", "exponential", 60000.0, 0.25
    doc.recompute()
    settle()


@pytest.mark.slow
def test_from_costs_to_belts_and_files(tmp_path):
    doc, job, _ = prepared()
    worn(doc, job)
    steps, label = doc.UndoCount, dict((o.Name, o.Label) for o in doc.Objects)
    menu("Belt plan...")
    assert not field("saveBelts", QtGui.QPushButton).isEnabled()
    field("parts", QtGui.QSpinBox).setValue(60)
    for name, value in (("beltCost", 4.0), ("changeTime", 1.0), ("minuteCost", 1.5)):
        field(name, QtGui.QDoubleSpinBox).setValue(value)
    assert not [one for one in visible(QtGui.QDoubleSpinBox) if one.objectName() == "forceMax"]
    press("Plan")
    wait(lambda: field("saveBelts", QtGui.QPushButton).isEnabled(), 120)
    settle()
    text = field("state").text()
    assert "New belts: " in text and "New belts: 0" not in text, text
    assert field("beltChart").isVisible() and field("beltChart").height() > 100
    QtGui.QFileDialog.getExistingDirectory = lambda *_: str(tmp_path)
    press("Save...")
    assert "Written" in field("state").text()
    rows = Path(tmp_path, "parts.csv").read_text().splitlines()
    assert (
        len(rows) == 61 and json.loads(Path(tmp_path, "belt_plan.json").read_text())["parts"] == 60
    )
    press("Save...")
    assert "is there already" in field("state").text(), field("state").text()
    field("beltChart").clicked()
    settle()
    window = [
        w for w in QtGui.QApplication.topLevelWidgets() if w.objectName() == "beltPlanWindow"
    ][0]
    assert window.isVisible() and window.width() > 600
    window.close()

    follow = field("follow", QtGui.QComboBox)
    follow.setCurrentIndex(follow.findData("both"))
    field("forceMax", QtGui.QDoubleSpinBox).setValue(10.0)
    press("Plan")
    wait(lambda: "beyond the limits" in field("state").text(), 120)
    assert not [one for one in visible(QtGui.QLabel) if one.objectName() == "beltChart"]
    assert not field("saveBelts", QtGui.QPushButton).isEnabled()
    press("Close")
    assert doc.UndoCount == steps and dict((o.Name, o.Label) for o in doc.Objects) == label
    menu("Belt plan...")
    assert (
        field("parts", QtGui.QSpinBox).value() == 60
        and field("beltCost", QtGui.QDoubleSpinBox).value() == 4.0
    )
    press("Close")


def test_a_law_without_wear_says_so():
    prepared()
    menu("Belt plan...")
    press("Plan")
    wait(lambda: "Belt-grinding job: Model<" in field("state").text(), 60)
    press("Close")
