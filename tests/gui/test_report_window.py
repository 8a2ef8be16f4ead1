"""Report, figures and the check of the settings in FreeCAD's window."""

from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtGui

import beltgrinding
from beltgrinding.gui.panels import simulation_panel
from beltgrinding.objects import job_inputs, reports
from support.hands import field, menu, name_file, prepare, press, settle, visible, wait
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Close")
    return doc, job


@pytest.mark.slow
def test_the_menus_report_is_that_of_the_document():
    doc, job = prepared()
    opened = []
    patch(
        QtGui.QDesktopServices,
        "openUrl",
        staticmethod(lambda url: opened.append(url.toLocalFile())),
    )
    part = job.DesignFaces[0][0]
    part.Label = 'Plate <7> & "co"'
    name_file(Path("told").resolve(), "HTML (*.html)")
    menu("Report...")
    wait(lambda: opened, 120)
    assert opened == [str(Path("told.html").resolve())]
    html = Path("told.html").read_text()
    assert '<h1>Plate &lt;7&gt; &amp; "co"</h1>' in html and "Face6" in html
    assert f"{doc.Simulation.RemovedVolume.Value:.1f} mm³" in html
    assert "An input has changed" not in html and html.count("<svg") > 3
    assert "Where it is out of tolerance" in html
    assert "Peak pressure" in html  # the time series came with the document

    before = doc.Simulation.RemovedVolume.Value
    doc.BeltMachine.Force = "20 N"
    doc.recompute()
    opened.clear()
    name_file(Path("new.html").resolve(), "HTML (*.html)")
    menu("Report...")
    wait(lambda: opened, 120)
    assert "An input has changed" in Path("new.html").read_text()

    opened.clear()
    Path("told.html").write_text("mine")
    files = sorted(path.name for path in Path().iterdir())
    name_file(Path("told.pdf").resolve(), "PDF (*.pdf)")
    doc.recompute()  # FreeCAD asks whether an entry can be chosen when something has happened
    menu("Report...")
    wait(lambda: opened or visible(QtGui.QMessageBox), 120)
    assert Path("told.html").read_text() == "mine"  # lies beside it, and is another file
    try:
        import weasyprint

        assert Path("told.pdf").read_bytes().startswith(b"%PDF") and opened
        files.append("told.pdf")
    except ImportError:
        assert not Path("told.pdf").exists()
    assert sorted(path.name for path in Path().iterdir()) == sorted(files)

    asked = []

    def answer(parent, title, text, *rest):
        asked.append(text)
        return QtGui.QMessageBox.No

    patch(QtGui.QMessageBox, "question", staticmethod(answer))
    opened.clear()
    for box in visible(QtGui.QMessageBox):
        box.close()
        box.deleteLater()
    settle()
    name_file(
        Path("told").resolve(), "HTML (*.html)"
    )  # the dialog asks for the name as it was typed
    doc.recompute()
    menu("Report...")
    settle()
    assert "told.html is there already" in asked[0] and Path("told.html").read_text() == "mine"


@pytest.mark.slow
def test_the_figures_follow_the_result():
    doc, job = prepared()
    deviation = beltgrinding.make_deviation(job)
    verdict = beltgrinding.make_verdict(job)
    menu("Figures in a spreadsheet")
    assert Gui.activeWorkbench().name() == "BeltGrindingWorkbench"
    sheet = doc.Figures
    rows = {sheet.get(f"A{r}"): r for r in range(1, 90) if sheet.getContents(f"B{r}")}

    def value(label):
        found = sheet.get(f"B{rows[label]}")
        return getattr(found, "Value", found)

    assert sheet.getContents(f"B{rows['Removed']}").endswith("Simulation.RemovedVolume")
    assert value("Removed") == doc.Simulation.RemovedVolume.Value > 0
    assert value("Area in tolerance") == deviation.InTolerance < 99
    assert sheet.get(f"C{rows['Area in tolerance']}") == "%"
    assert value("Verdict") == verdict.Overall == "fail"
    assert value("Left above the design") == verdict.ExcessVolume.Value > 0
    assert abs(value("Force") - 30000) < 1e-6  # FreeCAD's mm kg/s2
    job.ToleranceUpper = "9 mm"
    doc.recompute()
    assert value("Verdict") == "pass"
    assert (
        value("Area in tolerance") == deviation.InTolerance and value("Tolerance, upper limit") == 9
    )
    for obj in (job, doc.Simulation, deviation, doc.BeltMachine, sheet):
        obj.Label = f"Renamed {obj.Name}"
    before = value("Removed")
    doc.BeltMachine.Force = "20 N"
    doc.recompute()
    assert value("An input has changed since") and value("Removed") == before
    menu("Simulate")
    wait(lambda: not doc.Simulation.OutOfDate)
    press("Close")
    assert value("Removed") == doc.Simulation.RemovedVolume.Value < 0.8 * before
    assert not value("An input has changed since")

    sheet.set("D1", "mine")
    menu("Figures in a spreadsheet")
    assert len([o for o in doc.Objects if o.TypeId == "Spreadsheet::Sheet"]) == 1
    assert sheet.get("D1") == "mine" and value("Removed") == doc.Simulation.RemovedVolume.Value

    doc.saveAs(str(Path("work.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("work.FCStd")
    sheet, job = doc.Figures, doc.BeltGrindingJob
    assert value("Removed") == doc.Simulation.RemovedVolume.Value
    job.ToleranceUpper = "0.01 mm"
    doc.recompute()
    assert value("Area in tolerance") == doc.Deviation.InTolerance < 99


def test_settings_are_checked_and_the_answer_stays():
    doc, job = prepared()
    assert doc.Simulation.FineEnough == "not checked"
    job.Spacing, job.ToleranceLower, job.ToleranceUpper = 0.3, -9, 9  # slow enough to be cancelled
    doc.recompute()
    steps = doc.UndoCount
    menu("Check settings...")
    assert field("state").text() == "Not checked yet."
    press("Check")
    field("cancel").click()
    wait(lambda: "Cancelled" in field("state").text())
    assert doc.Simulation.OutOfDate and doc.UndoCount == steps
    press("Close")
    job.Spacing = 1.5
    doc.recompute()
    menu("Check settings...")
    press("Check")
    wait(lambda: doc.Simulation.FineEnough == "yes", 120)
    assert not doc.Simulation.OutOfDate and doc.Simulation.SettingsError.Value > 0
    assert field("state").text().startswith("Yes")
    table = field("figures")
    assert table.rowCount() > 8 and "Removed" in table.item(0, 0).text()
    press("Close")

    job.ToleranceLower, job.ToleranceUpper = -1e-6, 1e-6
    doc.recompute()
    assert doc.Simulation.FineEnough == "no"
    menu("Check settings...")
    assert field("state").text().startswith("No")
    press("Close")
    simulation_panel.show_result(doc.Simulation)
    assert field("state").text().startswith("The limits have changed")
    press("Close")
    with job_inputs.scratch_folder() as folder:
        (note,) = reports.result_to_report(job, folder)[2]
    assert note.startswith("The limits have changed")
    doc.BeltMachine.Force = "20 N"
    doc.recompute()
    assert doc.Simulation.FineEnough == "not checked"
