"""The study's panel and dock: what varies, Run, Cancel, the table, its charts, a row as the document's state."""

import json
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
from PySide import QtCore, QtGui

import beltgrinding
from support.hands import (
    field,
    fit_view,
    menu,
    name_file,
    picture,
    prepare,
    press,
    settle,
    type_in,
    visible,
    wait,
    whole_screen,
)

pytestmark = pytest.mark.freecad(window=True)

pytest.importorskip("openturns")


def choose(name, value):
    box = field(name, QtGui.QComboBox)
    assert box.findData(value) >= 0, (name, value)
    box.setCurrentIndex(box.findData(value))
    settle()


def prepared():
    job = prepare()
    doc = job.Document
    job.Spacing = "2 mm"
    doc.recompute()
    return doc, job


@pytest.mark.slow
def test_from_what_varies_to_a_row_as_the_documents_state():
    whole_screen()
    doc, _ = prepared()
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
    assert json.loads(study.Vary)[2] == {
        "key": "programs[0].feed_mm_s",
        "values": [20.0, 30.0, 40.0],
    }
    keys.setEditText("belt_machine.fors_N")
    press("Add")
    assert "force_N" in field("state").text() and len(json.loads(study.Vary)) == 3
    vary("law.pressure_exponent", "0.9 1.1 5")
    assert json.loads(study.Vary)[3] == {
        "key": "law.pressure_exponent",
        "range": [0.9, 1.1],
        "steps": 5,
    }
    field("removeVaried4", QtGui.QToolButton).click()
    settle()
    assert len(json.loads(study.Vary)) == 3

    field("foldBest", QtGui.QToolButton).click()
    settle()
    press("Add limit")
    choose("bestFigure", "process_time_s")
    choose("limitFigure1", "removed_volume_mm3")
    type_in("limitLow1", "many")
    assert "no number" in field("limitNote").text() and field("limitLow1").styleSheet()
    type_in("limitLow1", "120")
    assert json.loads(study.Asked)["best"]["limits"] == {"removed_volume_mm3": [120.0, None]}
    assert not visible(QtGui.QLabel, "limitNote") and not field("limitLow1").styleSheet()
    press("Add limit")
    assert field("limitFigure2", QtGui.QComboBox).currentData() == "in_share"
    choose("limitFigure2", "removed_volume_mm3")
    assert (
        "has a limit already" in field("limitNote").text()
        and "limit already" in field("state").text()
    )
    choose("limitFigure2", "peak_pressure_MPa")
    type_in("limitLow2", "0,1")
    type_in("limitHigh2", "0.05")
    assert "0.1, lies above the greatest, 0.05" in field("limitNote").text()
    type_in("limitHigh2", "50")
    assert json.loads(study.Asked)["best"]["limits"]["peak_pressure_MPa"] == [0.1, 50.0]
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
    fit_view()
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
    assert (
        abs(doc.BeltMachine.Force.getValueAs("N").Value - force) < 1e-9
        and force == made["belt_machine.force_N"].max()
    )
    assert not study.OutOfDate and f"set to run {number}" in field("studyFigures").text()
    doc.undo()
    doc.recompute()
    assert doc.BeltMachine.Force.getValueAs("N").Value == 30.0 and not study.OutOfDate

    best = study.Proxy.answers(study)["best"]
    assert f"best: run {best['run']}" in field("studyFigures").text()
    good = (
        (made["removed_volume_mm3"] >= 120.0)
        & (made["peak_pressure_MPa"] >= 0.1)
        & (made["peak_pressure_MPa"] <= 50.0)
    )
    assert best["value"] == made["process_time_s"][good].min() and good[best["run"] - 1]
    name_file("table.csv")
    press("Save table...")
    assert Path("table.csv").read_bytes() == made.csv_bytes()
    name_file("study.html")
    press("Report...")
    wait(lambda: Path("study.html").exists(), 60)
    assert "Tolerance yield" in Path("study.html").read_text()


@pytest.mark.slow
def test_correlations_are_filled_in_told_where_they_cannot_be_and_run():
    _, job = prepared()
    job.Spacing = "3 mm"
    varied = [
        {
            "name": name,
            "key": key,
            "how": "add",
            "distribution": {"kind": "normal", "mean": 0, "sd": sd},
        }
        for name, key, sd in (
            ("thick", "stock.allowance_mm", 0.02),
            ("off", "placement.z_mm", 0.05),
            ("force", "belt_machine.force_N", 2.0),
        )
    ]
    for one in varied:
        if one["key"].startswith("placement"):
            del one["how"]
    study = beltgrinding.make_study(job, compute=False, Vary=varied, Runs=60, Workers=1)
    menu("Study...")
    assert not visible(QtGui.QPushButton, "addCorrelated")
    field("foldCorrelated", QtGui.QToolButton).click()
    settle()
    press("Add pair")
    assert json.loads(study.Correlations) == [{"between": ["thick", "off"], "coefficient": 0.0}]
    # What is no coefficient is told beside it, and the last that was one stays.
    for text in ("much", "1", "-1.2", ""):
        type_in("correlatedCoefficient1", text)
        assert "thick with off" in field("correlatedNote").text(), text
        assert field("correlatedCoefficient1").styleSheet()
    assert json.loads(study.Correlations)[0]["coefficient"] == 0.0
    type_in("correlatedCoefficient1", "0,9")
    assert (
        not visible(QtGui.QLabel, "correlatedNote")
        and not field("correlatedCoefficient1").styleSheet()
    )
    choose("correlatedSecond1", "thick")
    assert (
        "two that are different" in field("correlatedNote").text()
        and field("correlatedSecond1").styleSheet()
    )
    choose("correlatedSecond1", "off")
    # Each is possible alone, together they are not.
    press("Add pair")
    assert [
        field(f"correlated{n}2", QtGui.QComboBox).currentData() for n in ("First", "Second")
    ] == ["thick", "force"]
    type_in("correlatedCoefficient2", "0.4")
    press("Add pair")
    type_in("correlatedCoefficient3", "-0.9")
    assert "not positive definite" in field("correlatedNote").text()
    press("Run")
    assert not study.Fingerprint and "not positive definite" in field("state").text()
    type_in("correlatedCoefficient3", "0.3")
    choose("correlatedSecond3", "thick")
    assert "each pair once" in field("correlatedNote").text()
    field("removeCorrelated3", QtGui.QToolButton).click()
    settle()
    wanted = [
        {"between": ["thick", "off"], "coefficient": 0.9},
        {"between": ["thick", "force"], "coefficient": 0.4},
    ]
    assert json.loads(study.Correlations) == wanted

    # A design that takes none says so at once.
    def set_method(value):
        field("Method", QtGui.QComboBox).setCurrentIndex(
            study.getEnumerationsOfProperty("Method").index(value)
        )
        settle()
        assert study.Method == value

    for method in ("grid", "sobol_indices"):
        set_method(method)
        assert "leave the correlations out" in field("correlatedNote").text(), method
    set_method("monte_carlo")
    assert not visible(QtGui.QLabel, "correlatedNote")
    # What does not vary any more is told, not dropped.
    field("removeVaried3", QtGui.QToolButton).click()
    settle()
    assert (
        "'force' does not vary any more" in field("correlatedNote").text()
        and field("correlatedSecond2").styleSheet()
    )
    assert len(json.loads(study.Vary)) == 2
    field("removeCorrelated2", QtGui.QToolButton).click()
    settle()
    assert json.loads(study.Correlations) == wanted[:1]
    press("Run")
    wait(lambda: study.Fingerprint, 200)
    settle()
    made = study.Proxy.table(study)
    assert study.RunsDone == 60 and np.corrcoef(made["thick"], made["off"])[0, 1] > 0.8
    press("Close")
    menu("Study...")
    assert field("correlatedCoefficient1").text() == "0.9"
    press("Close")
    assert json.loads(study.Correlations) == wanted[:1] and not study.OutOfDate


def test_the_panel_as_it_looks():
    whole_screen()
    _, job = prepared()
    varied = [
        {"key": "belt_machine.force_N", "range": [20, 60]},
        {
            "key": "stock.allowance_mm",
            "distribution": {"kind": "normal", "mean": 0.2, "sd": 0.02, "lower": 0.0},
        },
        {"key": "placement.z_mm", "distribution": {"kind": "normal", "mean": 0, "sd": 0.05}},
        {"key": "programs[0].feed_mm_s", "values": [20, 30, 40]},
    ]
    together = [{"between": ["stock.allowance_mm", "placement.z_mm"], "coefficient": 0.6}]
    asked = {
        "best": {
            "figure": "process_time_s",
            "limits": {"in_share": [0.98, None], "peak_pressure_MPa": [None, 0.4]},
        }
    }
    study = beltgrinding.make_study(
        job, compute=False, Vary=varied, Runs=200, Correlations=together, Asked=asked
    )
    kept = study.Correlations, study.Asked
    menu("Study...")
    assert [field(f"variedValues{k}").text() for k in range(1, 5)] == [
        "20  60",
        "0.2  0.02",
        "0  0.05",
        "20  30  40",
    ]
    press("Close")
    assert json.loads(study.Vary) == varied, "what was not changed is as it was"
    assert (study.Correlations, study.Asked) == kept
    fit_view()
    menu("Study...")
    assert field("Runs", QtGui.QSpinBox).value() == 200
    picture("workbench-study")
    panel = next(a for a in visible(QtGui.QScrollArea) if a.isAncestorOf(field("bestFigure")))
    panel.ensureWidgetVisible(field("bestSurface"))
    panel.ensureWidgetVisible(next(b for b in visible(QtGui.QPushButton) if b.text() == "Run"))
    settle()
    picture("workbench-study-limits")


@pytest.mark.slow
def test_cancel_keeps_what_is_finished():
    _, job = prepared()
    job.Spacing = "0.6 mm"
    varied = [{"key": "belt_machine.force_N", "range": [20, 60]}]
    study = beltgrinding.make_study(job, compute=False, Vary=varied, Runs=40, Workers=1)
    menu("Study...")
    press("Run")
    wait(
        lambda: " of 40 runs" in field("state").text()
        and not field("state").text().startswith("0 of"),
        120,
    )
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
    # An undo step in which nothing has changed would go on, and take in what is done to other documents.
    assert FreeCAD.getActiveTransaction() is None
