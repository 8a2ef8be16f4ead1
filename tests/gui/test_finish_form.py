"""The finish in the window: what it is computed with, and what zones call for. The roughness is of a made-up belt."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.gui.common import runner
from beltgrinding.objects import api
from support import synthetic_finish as made_up
from support.hands import (
    choose,
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
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def choose_in(name, index):
    field(name, QtGui.QComboBox).setCurrentIndex(index)
    settle()


def read(path):
    choose(path)
    field("readFinishModel").click()
    settle()


def started():
    def finish():
        return json.loads(job.Finish) if job.Finish else None

    def edit():
        job.ViewObject.Proxy.doubleClicked(job.ViewObject)
        settle()
        field("foldFinish").click()
        settle()

    job = prepare()
    doc = job.Document
    steps = doc.UndoCount
    Path("model.json").write_text(json.dumps(made_up.model()))
    return SimpleNamespace(doc=doc, edit=edit, finish=finish, job=job, steps=steps)


@pytest.mark.slow
def test_the_model_is_read_from_its_file_and_the_fields_are_the_jobs():
    here = started()
    doc, edit, finish, job, steps = here.doc, here.edit, here.finish, here.job, here.steps
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
    for name, wrong in (
        ("rest_per_pass", "1"),
        ("crossing_angle_deg", "91"),
        ("initial_Ra_um", "rough"),
        ("initial_Ra_um", "inf"),
        ("grit", "1e999"),
    ):
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
    for name, text in (
        ("other.json", '{"coefficient_um": 1}'),
        ("no.json", '{"a'),
        ("list.json", "[]"),
        ("swapped.json", json.dumps(swapped)),
    ):
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
    for text in ('{"grit": ', '{"grain": 15}', "[1]"):
        job.Finish = text
        edit()
        assert field("finishChoice").currentIndex() == 0 and field("finishNote").text(), text
        press("OK")
        assert job.Finish == text


def test_what_a_zone_calls_for_is_typed_and_kept():
    here = started()
    doc, job, steps = here.doc, here.job, here.steps
    job.Finish = json.dumps({"grit": 120, "initial_Ra_um": 3.2, "model": made_up.model()})
    asked = {
        "Ra_max_um": 0.8,
        "acceptance": "T16%",
        "lay": "=",
        "lay_direction": [1.0, 0.0, 0.0],
        "lay_tolerance_deg": 10.0,
    }
    exact = {
        "acceptance": "T16%",
        "lay": "⊥",
        "lay_direction": [0.577350269, -0.577350269, 0.577350269],
        "lay_tolerance_deg": 15.0,
    }
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
    assert (
        zones()[0]["name"] == "spout" and zones()[0]["finish"] == asked
    ), "what no cell shows stays"
    assert zones()[1]["finish"] == exact, "no digit, and the acceptance of a lay alone"
    table.setCurrentCell(1, 0)
    press("Remove")
    press("Add")
    press("Up")
    assert zones()[1]["finish"] == asked and "finish" not in zones()[0]
    for text, lay in (
        ("T 0 1 0", {"lay": "⊥", "lay_direction": [0, 1, 0]}),
        ("X", {"lay": "X"}),
        ("C 1,5 0 2", {"lay": "C", "lay_centre_mm": [1.5, 0, 2]}),
    ):
        table.item(0, LAY).setText(text)
        assert zones()[0]["finish"] == {
            "acceptance": "Tmax",
            "lay_tolerance_deg": 15.0,
            **lay,
        }, zones()
    for column, text in (
        (LAY, "="),
        (LAY, "Q"),
        (LAY, "= 1 0 nan"),
        (LAY, "= 0 0 0"),
        (LAY, "P"),
        (RA, "0.4 T50%"),
        (RA, "-1"),
        (RA, "fine"),
        (RA, "T50%"),
        (RA, "0.4 0.5 T16%"),
    ):
        before, old = zones(), table.item(0, column).text()
        table.item(0, column).setText(text)
        assert (
            zones() == before and field("note").text() and "Zones:" not in field("note").text()
        ), text
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


def fit(path):
    choose(path)
    field("fitFinish").click()
    settle()


def fitted(path):
    fit(path)
    wait(lambda: visible(QtGui.QDialog, "finishFit") or field("fitFinish").text() == "Fit...")
    return bool(visible(QtGui.QDialog, "finishFit"))


def with_fit():
    made_up.write(Path("roughness.csv"), made_up.columns(40))


@pytest.mark.slow
def test_a_table_is_fitted_looked_at_saved_and_taken():
    whole_screen()
    here = started()
    doc, edit, finish, job, steps = here.doc, here.edit, here.finish, here.job, here.steps
    with_fit()
    fit_view()
    edit()
    assert not field("fitFinish").isEnabled()
    choose_in("finishChoice", 1)
    assert "Fit..." in field("finishNote").text()
    fit("")  # Cancel in the dialog of files
    assert not visible(QtGui.QDialog, "finishFit") and "model" not in finish()
    assert fitted("roughness.csv")
    window_ = field("finishFit")
    assert window_.width() < 700 and window_.height() < 650, window_.size()
    assert (
        "40 measurements" in field("finishFitted").text()
        and "grit alone" in field("finishFitted").text()
    )
    table = field("finishParameters")
    rows = {
        table.item(k, 0).text(): (table.item(k, 1).text(), table.item(k, 2).text())
        for k in range(table.rowCount())
    }
    assert len(rows) == 7 and "left by a pass, share" in rows, rows
    for name, key in (
        ("exponent of the grit", "grit_exponent"),
        ("exponent of the feed", "feed_exponent"),
    ):
        low, high = map(float, rows[name][1].split(" … "))
        assert low < float(rows[name][0]) < high and low < made_up.TRUTH[key] < high, rows
    for area in visible(QtGui.QScrollArea):
        if area.isAncestorOf(field("finishNote")):
            area.ensureWidgetVisible(field("finishNote"))
    picture("finish-fit")
    assert "mm/s" in field("finishRanges").text() and not visible(QtGui.QLabel, "finishWarnings")
    press("Discard")
    assert "model" not in finish() and not visible(QtGui.QDialog, "finishFit")

    there = sorted(Path.cwd().glob("*.json"))
    # Saved where it cannot be, over the table itself, not at all, and then well.
    assert fitted("roughness.csv")
    name_file(Path.cwd() / "no folder" / "model.json")
    press("Save and use...")
    assert "cannot be written" in field("finishFitNote").text() and "model" not in finish()
    name_file("")
    press("Save and use...")
    assert (
        field("finishFit")
        and "model" not in finish()
        and sorted(Path.cwd().glob("*.json")) == there
    )
    Path("kept.json").write_text("kept")
    asked = []
    patch(
        QtGui.QMessageBox,
        "question",
        staticmethod(lambda *a, **k: asked.append(a[2]) or QtGui.QMessageBox.No),
    )
    name_file(
        Path.cwd() / "kept", "*.json"
    )  # typed without a suffix: the file of that name is not the one that was asked for
    press("Save and use...")
    assert len(asked) == 1 and "kept.json" in asked[0] and Path("kept.json").read_text() == "kept"
    type_in("finishSource", "measured by nobody")
    name_file(Path.cwd() / "fitted.json")
    press("Save and use...")
    assert not visible(QtGui.QDialog, "finishFit")
    saved = json.loads(Path("fitted.json").read_text())
    assert saved["source"] == "measured by nobody" and saved["calibration"]["measurements"] == 40
    assert "model" not in finish() and field("grit").styleSheet(), "which of the grits nobody knows"
    type_in("grit", "120")
    assert finish()["model"] == saved and "measured by nobody" in field("finishNote").text()
    press("OK")
    assert doc.UndoCount == steps + 1
    before = job.Finish
    doc.undo()
    assert not job.Finish
    doc.redo()
    assert job.Finish == before
    assert not doc.UndoCount > steps + 1

    # It is the command's own file: read again it is the same.
    edit()
    field("dropFinishModel").click()
    read("fitted.json")
    assert finish() == json.loads(before)
    # The table's own name, as one that is no table's may have it.
    Path("table.json").write_text(Path("roughness.csv").read_text())
    assert fitted("table.json")
    name_file(Path.cwd() / "table.json")
    press("Save and use...")
    assert "is the table" in field("finishFitNote").text()
    assert Path("table.json").read_text() == Path("roughness.csv").read_text()
    press("Discard")
    press("Cancel")
    assert finish() == json.loads(before)


def test_what_a_table_does_not_tell_is_refused_or_warned_of():
    here = started()
    edit, job = here.edit, here.job
    with_fit()
    edit()
    choose_in("finishChoice", 1)
    before = job.Finish
    few = {name: values[:5] for name, values in made_up.columns(40).items()}
    still = dict(made_up.columns(40), feed_mm_s=[0.0] * 40)
    none = {name: values for name, values in made_up.columns(40).items() if name != "Ra_um"}
    together = made_up.columns(40)
    together["feed_mm_s"] = [500 * p for p in together["pressure_MPa"]]
    made_up.write(Path("few.csv"), few)
    made_up.write(Path("still.csv"), still)
    made_up.write(Path("none.csv"), none)
    made_up.write(Path("together.csv"), together)
    Path("empty.csv").write_text("")
    Path("text.csv").write_text("Ra_um,grit\nrough,coarse\n")
    for name, words in (
        ("few.csv", "too few"),
        ("still.csv", "line 2"),
        ("none.csv", "Ra_um"),
        ("together.csv", "undetermined"),
        ("empty.csv", "empty.csv"),
        ("text.csv", "text.csv"),
        ("missing.csv", "cannot be read"),
    ):
        assert not fitted(name), name
        told = field("finishNote").text()
        assert name in told and words in told, told
        assert job.Finish == before and field("fitFinish").text() == "Fit..."
        assert field("finishNote").styleSheet() and field("readFinishModel").isEnabled()

    # What belts have done is told by the job's law of wear, and what does not vary by a warning.
    worn = made_up.columns(40, fixed=("belt_speed_m_s",))
    del worn["remaining_cut"]
    worn["work_J"] = [1000.0 * k for k in range(40)]
    made_up.write(Path("worn.csv"), worn)
    assert fitted("worn.csv")
    told = field("finishWarnings").text()
    assert "job's law of wear" in told and "work_J" in told and "do not vary" in told, told
    press("Discard")
    press("Cancel")


@pytest.mark.slow
def test_a_long_fit_is_stopped_and_leaves_nothing_behind():
    here = started()
    edit, finish, job = here.edit, here.finish, here.job
    with_fit()
    made_up.write(Path("long.csv"), made_up.columns(3000))
    edit()
    choose_in("finishChoice", 1)
    before, told = job.Finish, field("finishNote").text()
    fit("long.csv")
    assert field("fitFinish").text() == "Stop" and not field("finishChoice").isEnabled()
    assert not field("readFinishModel").isEnabled()
    wait(lambda: "Fitting, 0 %" not in field("finishNote").text())
    assert "Fitting, " in field("finishNote").text()
    type_in("initial_Ra_um", "3.2")  # the rest goes on
    press("OK")  # it would be lost
    assert Gui.Control.activeDialog() and "still being fitted" in field("note").text()
    field("fitFinish").click()
    wait(lambda: field("fitFinish").text() == "Fit...")
    assert field("finishNote").text() == told and not field("finishNote").styleSheet()
    assert (
        finish() == {"crossing_angle_deg": 20.0, "initial_Ra_um": 3.2}
        and field("finishChoice").isEnabled()
    )
    fit("long.csv")
    assert field("fitFinish").text() == "Stop"
    press("Cancel")
    assert not job.Finish
    wait(lambda: not runner._going)
    assert not visible(QtGui.QDialog, "finishFit") and not Gui.Control.activeDialog()
