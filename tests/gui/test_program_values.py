"""What only the controller knows is typed into a program's panel."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.gui.common.editing import edit
from beltgrinding.objects import set_up
from support.hands import choose, field, menu, press, settle, start, visible
from support.restoring import speak


def table():
    return field("programValues", QtGui.QTableWidget)


def cells(column):
    return [table().item(i, column).text() for i in range(table().rowCount())]


def tab():
    tabs = field("poseTabs", QtGui.QTabWidget)
    found = [
        k
        for k in range(tabs.count())
        if tabs.widget(k).findChild(QtGui.QTableWidget, "programValues")
    ]
    return tabs, found[0]


def type_cell(row, text):
    # Opens the cell's editor as a double click does, types and leaves it by Return.
    view = table()
    item = view.item(row, 1)
    view.setCurrentItem(item)
    view.editItem(item)
    (line,) = view.viewport().findChildren(QtGui.QLineEdit)
    line.selectAll()
    line.insert(text)
    key = QtGui.QKeyEvent(QtCore.QEvent.KeyPress, QtCore.Qt.Key_Return, QtCore.Qt.NoModifier)
    QtGui.QApplication.sendEvent(line, key)
    settle()
    assert item.text() == text, item.text()


def head(rows):
    start()
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.set_up(job)
    doc = job.Document
    doc.UndoMode = 1
    points = "".join(
        f"P[{n}]{{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {10 * n}.0 mm, "
        "Y = 5.0 mm, Z = 7.0 mm,\n\tW = 0.0 deg, P = 0.0 deg, R = 0.0 deg\n};\n"
        for n in (1, 2, 3)
    )
    text = "\n".join(f"{k:4}:{row} ;" for k, row in enumerate(rows, 1))
    Path("v.ls").write_text(f"/PROG V\n/MN\n{text}\n/POS\n{points}/END\n")
    side = Path("v.values.json")
    side.unlink(missing_ok=True)  # of the other language
    return SimpleNamespace(doc=doc, job=job, part=part, side=side, text=text)


ROWS = ["L P[1] 9mm/sec FINE", "L P[2] R[5:speed]mm/sec FINE", "L P[3] 9mm/sec FINE Offset,PR[15]"]
NO_PATH_ROWS = ["L P[1] 9mm/sec FINE", "L PR[2] 9mm/sec FINE", "L P[3] 9mm/sec FINE Offset,PR[15]"]


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "de"])
def test_values_are_typed_kept_and_saved_where_asked(freecad, language):
    run(freecad, values_are_typed, language)


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "de"])
def test_a_program_without_a_path_gets_it_by_its_values(freecad, language):
    run(freecad, a_path_by_values, language)


def test_a_unit_that_the_file_does_not_say_is_typed(freecad):
    run(freecad, a_unit_is_typed, "en")


def test_a_jobs_values_come_into_the_document(freecad):
    run(freecad, values_of_a_job, "en")


def values_are_typed(language):
    here = head(ROWS)
    doc, job, side, text = here.doc, here.job, here.side, here.text
    path = set_up.import_program(job, "v.ls")
    doc.recompute()
    doc.clearUndos()
    assert len(path.Poses) == 2, "the third is left out"

    edit(path)
    tabs, at = tab()
    tabs.setCurrentIndex(at)
    settle()
    assert "2" in tabs.tabText(at), tabs.tabText(at)
    assert cells(0) == ["R[5]", "PR[15]"] and cells(2) == ["4", "5"] and cells(1) == ["", ""], (
        cells(0),
        cells(2),
    )
    before = [path.Values, path.Feeds, path.Problems, len(path.Poses)]
    for row, text in (
        (1, "1 2 3"),
        (1, "1 2 x 0 0 0"),
        (1, "1 2 1e9 0 0 0"),
        (0, "fast"),
        (0, "1e300"),
    ):
        type_cell(1 - row, "")
        type_cell(row, text)
        field("applyValues").click()
        settle()
        name = cells(0)[row]
        assert name in field("note").text() and table().currentRow() == row, (
            text,
            field("note").text(),
        )
        assert before == [path.Values, path.Feeds, path.Problems, len(path.Poses)], text
    type_cell(0, "12,5")
    type_cell(1, "0 0 2 0 0 0")
    field("applyValues").click()
    settle()
    assert [round(p.Base.z, 9) for p in path.Poses] == [7, 7, 9] and path.Feeds[1] == 12.5
    assert not path.Problems, path.Problems
    tabs, at = tab()
    assert (
        "0" in tabs.tabText(at)
        and tabs.currentIndex() == at
        and cells(1) == ["12.5", "0 0 2 0 0 0"]
    )
    assert not side.exists(), "only when asked"
    areas = [a for a in visible(QtGui.QScrollArea) if a.findChildren(QtGui.QDialogButtonBox)]
    over = {
        w.objectName() or type(w).__name__: w.minimumSizeHint().width()
        for a in areas
        for w in a.findChildren(QtGui.QWidget)
        if w.isVisible() and w.minimumSizeHint().width() > 200
    }
    assert areas and not any(a.horizontalScrollBar().maximum() for a in areas), over
    press("OK")
    assert doc.UndoCount == 1
    doc.undo()
    assert len(path.Poses) == 2 and not path.Values
    doc.redo()
    assert len(path.Poses) == 3 and json.loads(path.Values)["variables"]["R[5]"] == 12.5
    doc.recompute()

    file = str(Path("v.FCStd").resolve())
    doc.saveAs(file)
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(file)
    path = [o for o in doc.Objects if str(getattr(o, "Source", "")).endswith("v.ls")][0]
    edit(path)
    tabs, at = tab()
    tabs.setCurrentIndex(at)
    assert cells(1) == ["12.5", "0 0 2 0 0 0"]
    type_cell(0, "")  # not known any more
    field("saveValues").click()
    settle()
    data = json.loads(side.read_text())
    assert data["variables"] == {
        "R[5]": None,
        "PR[15]": {"x_mm": 0, "y_mm": 0, "z_mm": 2, "a_deg": 0, "b_deg": 0, "c_deg": 0},
    }
    press("Cancel" if language == "en" else "Abbrechen")
    assert json.loads(path.Values)["variables"]["R[5]"] == 12.5 and side.exists()

    job = [o for o in doc.Objects if o.Name == "BeltGrindingJob"][0]
    again = set_up.import_program(job, "v.ls")  # the file beside it is read
    assert not again.Values and len(again.Poses) == 3
    edit(again)
    tabs, at = tab()
    tabs.setCurrentIndex(at)
    assert cells(1) == ["", "0 0 2 0 0 0"], cells(1)
    press("OK")


def a_path_by_values(language):
    here = head(NO_PATH_ROWS)
    doc, job = here.doc, here.job

    def command(text, name):
        # hands.menu knows the English menu.
        menu(text) if language == "en" else Gui.runCommand("BeltGrinding_" + name)
        settle()

    choose("v.ls")
    command("Import robot program...", "ImportProgram")
    path = [o for o in doc.Objects if str(getattr(o, "Source", "")).endswith("v.ls")][0]
    doc.recompute()
    assert len(path.Poses) == 1 and path.PoseCount == 1 and path.Path.Size == 0
    assert path.State == ["Up-to-date"], path.State
    assert (
        path.Problems[0].startswith("no path yet") and "PR[2], PR[15]" in path.Problems[0]
    ), path.Problems
    NOT_YET = {"en": "no path yet", "de": "noch keine Bahn"}[language]
    tabs, at = tab()
    assert tabs.currentIndex() == at, "its page is open"
    assert NOT_YET in field("note").text() and "PR[2], PR[15]" in field("note").text(), field(
        "note"
    ).text()
    assert cells(0) == ["PR[2]", "PR[15]"] and cells(1) == ["", ""], (cells(0), cells(1))
    areas = [a for a in visible(QtGui.QScrollArea) if a.findChildren(QtGui.QDialogButtonBox)]
    assert areas and not any(a.horizontalScrollBar().maximum() for a in areas)
    press("OK")
    assert doc.UndoCount == 1

    # Not simulated: who is in the way is named.
    command("Simulate", "Simulate")
    said = field("state").text()
    assert path.Label in said and NOT_YET in said and "PR[15]" in said, said
    Gui.Control.closeDialog()
    settle()
    try:
        beltgrinding.simulate(job)
        raise SystemExit("it was simulated")
    except beltgrinding.InputError as error:
        assert path.Label in str(error) and "PR[2]" in str(error), error

    # It is kept so, and what is typed gives it its path.
    file = str(Path("w.FCStd").resolve())
    doc.saveAs(file)
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(file)
    doc.UndoMode = 1
    path = [o for o in doc.Objects if str(getattr(o, "Source", "")).endswith("v.ls")][0]
    assert path.Problems[0].startswith("no path yet")
    view = path.ViewObject
    view.Proxy.doubleClicked(view)
    settle()
    tabs, at = tab()
    assert tabs.currentIndex() == at
    type_cell(1, "0 0 0 0 0 2000")
    field("applyValues").click()  # PR[15] alone: two poses, a path
    settle()
    assert len(path.Poses) == 2 and not any(
        "no path yet" in one for one in path.Problems
    ), path.Problems
    tabs, at = tab()
    type_cell(1, "")
    field("applyValues").click()
    settle()
    assert (
        len(path.Poses) == 1
        and path.Problems[0].startswith("no path yet")
        and NOT_YET in field("note").text()
    )
    type_cell(0, "40 0 12 0 0 0")
    type_cell(1, "0 0 2 0 0 0")
    field("applyValues").click()
    settle()
    assert [[round(v, 9) for v in p.Base] for p in path.Poses] == [
        [10, 5, 7],
        [40, 0, 12],
        [30, 5, 9],
    ], path.Poses
    assert not path.Problems and path.PoseCount == 3 and path.Path.Size == 3
    assert NOT_YET not in field("note").text() and "3" in field("note").text(), field("note").text()
    assert field("poseNumber").isEnabled()
    press("OK")
    assert doc.UndoCount == 1
    doc.undo()
    doc.recompute()
    assert len(path.Poses) == 1 and path.PoseCount == 1 and path.Path.Size == 0
    doc.redo()
    doc.recompute()
    assert len(path.Poses) == 3 and path.Path.Size == 3

    # One that has no pose at all opens its panel as well.
    Path("none.ls").write_text(Path("v.ls").read_text().replace("L P[1]", "L PR[1]"))
    job = [o for o in doc.Objects if o.Name == "BeltGrindingJob"][0]
    none = set_up.import_program(job, "none.ls")
    doc.recompute()
    assert len(none.Poses) == 0 and "PR[1], PR[2], PR[15]" in none.Problems[0]
    edit(none)
    settle()
    assert NOT_YET in field("note").text() and cells(0) == ["PR[1]", "PR[2]", "PR[15]"]
    assert not field("poseSlider").isEnabled()
    press("Cancel" if language == "en" else "Abbrechen")
    doc.removeObject(none.Name)
    doc.recompute()

    # A program that asks for nothing and has no path is refused as ever.
    Path("short.ls").write_text(
        Path("v.ls")
        .read_text()
        .replace("L PR[2]", "!")
        .replace("Offset,PR[15]", "")
        .replace("L P[3]", "!")
    )
    names = [o.Name for o in doc.Objects]
    try:
        set_up.import_program(job, "short.ls")
        raise SystemExit("it was imported")
    except beltgrinding.InputError as error:
        assert "short.ls: 1 Cartesian" in str(error), error
    assert names == [o.Name for o in doc.Objects]


def values_of_a_job(language):
    here = head(NO_PATH_ROWS)
    doc, part = here.doc, here.part
    six = dict(zip(("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg"), range(6)))
    data = {
        "schema": 1,
        "design": {"file": "block.brep", "faces": [6]},
        "stock": {"allowance_mm": 0.5},
        "programs": [
            {"file": "v.ls", "values": {"variables": {"PR[2]": six, "PR[15]": six}}},
            {"file": "v.ls", "values": "known.json"},
            {"file": "v.ls"},
        ],
    }
    part.Shape.exportBrep("block.brep")
    Path("known.json").write_text(json.dumps({"variables": {"PR[2]": six}}))
    Path("job.json").write_text(json.dumps(data))
    doc = FreeCAD.newDocument("opened")
    job = beltgrinding.open_job(doc, "job.json")
    paths = [o for o in doc.Objects if str(getattr(o, "Source", "")).endswith("v.ls")]
    assert [len(path.Poses) for path in paths] == [3, 2, 1], [len(path.Poses) for path in paths]
    assert json.loads(paths[1].Values) == {"variables": {"PR[2]": six}} and not paths[2].Values


def a_unit_is_typed(language):
    here = head(NO_PATH_ROWS)
    doc, job = here.doc, here.job
    Path("u.apt").write_text("FEDRAT/100\nGOTO/1,2,3\nGOTO/2,2,3\nGOTO/4,2,3\nFINI\n")
    Path("u.values.json").unlink(missing_ok=True)
    path = set_up.import_program(job, "u.apt")
    doc.recompute()
    assert len(path.Poses) == 0 and "neither mm nor inch" in path.Problems[1], path.Problems
    edit(path)
    settle()
    assert cells(0) == ["units"] and cells(1) == [""] and cells(3) == ["mm or inch"], (
        cells(0),
        cells(1),
        cells(3),
    )
    type_cell(0, "furlong")
    field("applyValues").click()
    settle()
    assert "'furlong' is no unit; give mm or inch" in field("note").text(), field("note").text()
    type_cell(0, "inch")
    field("applyValues").click()
    settle()
    assert [round(p.Base.x, 6) for p in path.Poses] == [25.4, 50.8, 101.6], path.Poses
    assert not [p for p in path.Problems if "inch" in p], path.Problems
    assert json.loads(path.Values)["units"] == "inch" and cells(1) == ["inch"]
    press("OK")


def run(freecad, function, language):
    if language == "de":
        freecad.call(speak, "German")
    freecad.call(function, language, window=True, fresh=language == "de")
