"""The cross-section in FreeCAD's window: dock, slider, picked points, export, undo, reopening."""

import csv
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui

import beltgrinding
from support.hands import click_at, field, menu, name_file, prepare, press, settle, type_in, wait

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    return doc, job, view


def test_a_section_follows_the_slider_and_the_result():
    doc, job, _ = prepared()
    steps = doc.UndoCount
    menu("Cross-section")
    section = doc.Section
    assert section.getParentGroup() is job and doc.UndoCount == steps + 1
    assert not section.Problem and abs(section.Length.Value - 40) < 1e-6  # across the longest side
    dock = field("BeltGrinding_SectionDock")
    field("sectionKind").setCurrentIndex(1)  # across Y
    settle()
    assert tuple(section.Normal) == (0, 1, 0) and abs(section.Point.y - 20) < 0.3
    assert abs(section.Length.Value - 60) < 1e-6 and section.Minimum.Value < 0.1

    slider, steps = field("sectionSlider"), doc.UndoCount
    slider.setSliderDown(True)
    for value in (400, 300, 200, 50):
        slider.setValue(value)
    slider.setSliderDown(False)
    settle()
    assert abs(section.Point.y - 2) < 1e-6 and doc.UndoCount == steps + 1
    assert abs(section.Minimum.Value - 0.2) < 1e-7  # beside the pass
    assert abs(field("sectionOffset").value() - 2) < 1e-3
    assert "Touched" not in section.State
    doc.undo()
    settle()
    assert abs(section.Point.y - 20) < 0.3 and section.Minimum.Value < 0.1
    assert abs(field("sectionOffset").value() - 20) < 1e-3

    menu("Stock")  # its panel's Cancel takes back what was changed in the dock meanwhile, too
    type_in("Allowance", "0.5 mm")
    field("sectionOffset").setValue(11.0)
    settle()
    assert abs(section.Point.y - 11) < 1e-6
    press("Cancel")
    settle()
    assert doc.Stock.Allowance.Value == 0.2 and abs(section.Point.y - 20) < 0.3

    share = section.InTolerance
    job.ToleranceUpper = "0.3 mm"
    doc.recompute()
    assert share < 90 and section.InTolerance == 100
    job.ToleranceUpper = "0.05 mm"
    doc.BeltMachine.Force = "20 N"
    doc.recompute()
    assert section.OutOfDate
    before = section.RemovedMean.Value
    menu("Simulate")
    wait(lambda: not doc.Simulation.OutOfDate)
    assert abs(section.RemovedMean.Value / before - 2 / 3) < 0.05 and not section.OutOfDate
    press("Close")

    field("sectionOffset").setValue(20.0)
    doc.removeObject("Section")
    settle()
    assert not field("sectionSlider").isEnabled() and field("sectionPlot").plot is None


def test_two_picked_points_and_the_files():
    doc, _, view = prepared()
    menu("Cross-section")
    section, plot = doc.Section, field("sectionPlot")
    view.fitAll()
    settle()
    field("sectionPick").click()
    settle()
    for x, y in ((12, 10), (48, 30)):
        at = view.getPointOnScreen(FreeCAD.Vector(x, y, 20.1))
        click_at(*at)
    wait(lambda: section.Cut == "line")
    assert not section.Problem
    assert abs(section.Length.Value - (36**2 + 20**2) ** 0.5) < 0.5
    wait(lambda: not field("sectionPick").isChecked())

    files = {kind: Path(f"section.{kind}").resolve() for kind in ("csv", "svg")}
    for kind, path in files.items():
        name_file(path)
        press(f"Export {kind.upper()}")
        assert str(path) in field("sectionFigures").text()
    rows = list(csv.DictReader(files["csv"].open()))
    assert abs(float(rows[-1]["s_mm"]) - section.Length.Value) < 1e-6
    assert "polyline" in files["svg"].read_text()

    # Hover, wheel, double click.
    line = plot.plot["ground"][0]
    k = len(line) // 2
    x, y = plot.pixels(line)[k]
    assert plot.nearest(x, y + 30) == (0, k) and plot.nearest(-500, 0) is None
    assert f"{section.Proxy.cut(section)['pieces'][0]['height'][k]:+.4f}" in plot.value_text(0, k)
    width = plot.window[2] - plot.window[0]
    plot.zoom(0.5, x, y)
    assert abs((plot.window[2] - plot.window[0]) / width - 0.5) < 1e-9
    assert max(abs(a - b) for a, b in zip(plot.pixels(line)[k], (x, y))) < 1e-6
    plot.fit()
    assert plot.window[2] - plot.window[0] == width
    field("sectionMode").setCurrentIndex(1)
    field("sectionFactor").setValue(7.0)
    settle()
    assert plot.plot["equal"] and plot.plot["exaggeration"] == 7

    doc.saveAs(str(Path("work.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    settle()
    assert field("sectionPlot").plot is None
    doc = FreeCAD.openDocument("work.FCStd")
    section = doc.Section
    assert section.Cut == "line" and len(section.Line) == sum(section.LineCounts) > 10
    section.ViewObject.Proxy.doubleClicked(section.ViewObject)
    settle()
    assert field("sectionPlot").plot is not None
    try:
        beltgrinding.make_section(doc.BeltGrindingJob, (0, 90, 0), (0, 1, 0))
        raise AssertionError("the plane misses the part")
    except beltgrinding.InputError as error:
        assert "misses" in str(error)
    assert len([o for o in doc.Objects if o.Name.startswith("Section")]) == 1
