"""The panel that calibrates the law: a table chosen, fitted, looked at, and used in the job."""

import random
from pathlib import Path

import pytest
from PySide import QtGui

from support.hands import field, menu, name_file, prepare, press, type_in, visible, wait

pytestmark = pytest.mark.freecad(window=True)


@pytest.mark.slow
def test_from_a_table_to_the_law_of_the_job():
    job = prepare()
    doc = job.Document
    random.seed(1)
    lines = ["force_N,belt_speed_m_s,time_s,area_mm2,removed_volume_mm3"]
    for _ in range(30):
        force, speed, time_s = random.uniform(5, 50), random.uniform(10, 30), random.uniform(5, 30)
        volume = 2e-5 * 1000 * speed * force * time_s * random.lognormvariate(0, 0.05)
        lines.append(f"{force},{speed},{time_s},100,{volume}")
    Path("grinds.csv").write_text("\n".join(lines) + "\n")

    menu("Calibrate removal law...")
    press("Fit")
    assert "Choose the table" in field("calibrationState").text()
    type_in("grinds", "absent.csv")
    press("Fit")
    wait(lambda: "cannot be read" in field("calibrationState").text())
    type_in("grinds", "grinds.csv")
    press("Fit")
    wait(lambda: "median error" in field("calibrationState").text())
    assert field("calibrationTable").parentWidget().minimumSizeHint().width() < 250
    table = field("calibrationTable")
    names = [table.item(row, 0).text() for row in range(table.rowCount())]
    assert names[:3] == ["coefficient\nmm²/N", "pressure\nexponent", "speed\nexponent"], names
    assert abs(float(table.item(1, 1).text().split()[0]) - 1) < 0.1

    # What was fitted goes when a box, an entry or the table changes.
    def gone():
        return not visible(QtGui.QTableWidget, "calibrationTable") and not usable()

    def usable():
        return [b for b in visible(QtGui.QPushButton) if b.text() == "Use in the job"]

    def fitted():
        press("Fit")
        wait(lambda: "median error" in field("calibrationState").text())
        assert usable()

    field("wearUnit").setText("2")
    assert gone() and "has changed: fit again" in field("calibrationState").text()
    field("wearUnit").setText("")
    fitted()
    type_in("grinds", "absent.csv")
    assert gone()
    type_in("grinds", "grinds.csv")
    fitted()
    Path("grinds.csv").write_text(Path("grinds.csv").read_text() + "\n")
    press("Use in the job")
    assert gone() and job.Law != "local"
    fitted()
    field("ownWheel").setChecked(True)
    assert gone()
    press("Fit")
    wait(lambda: "median error" in field("calibrationState").text())
    told = field("calibrationWarnings").text()
    assert "solved from wheel and part (wheel_rim)" in told and "not from the table" in told, told
    field("ownWheel").setChecked(False)
    press("Fit")
    wait(lambda: "median error" in field("calibrationState").text())
    # Of even pressures there is nothing to warn.
    assert not visible(QtGui.QLabel, "calibrationWarnings")
    picture = field("calibrationPlot").pixmap().toImage()
    assert picture.width() > 150 and picture.height() > 150
    steps = doc.UndoCount
    press("Use in the job")
    assert job.Law == "local"
    assert "uses the calibrated law" in field("calibrationState").text()
    assert abs(job.LawCoefficient / 2e-5 - 1) < 0.1
    assert doc.UndoCount == steps + 1
    press("Larger plot")
    field("calibrationWindow").close()
    press("Close")
    doc.undo()
    assert job.Law != "local"


def test_an_example_of_a_table_is_saved_and_fits():
    job = prepare()
    menu("Calibrate removal law...")
    assert "force_N" in field("columns").text() and "removed_volume_mm3" in field("columns").text()
    name_file(Path.cwd() / "grinds.csv")
    press("Save an example...")
    assert Path("grinds.csv").read_text().count("\n") > 30
    press("Fit")
    wait(lambda: "median error" in field("calibrationState").text())
    table = field("calibrationTable")
    assert abs(float(table.item(1, 1).text().split()[0]) - 1) < 0.15  # the pressure's exponent
    name_file(Path.cwd() / "no folder" / "grinds.csv")
    press("Save an example...")
    assert "cannot be written" in field("calibrationState").text()
    press("Close")
