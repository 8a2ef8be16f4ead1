"""FreeCAD in German: menus, panels and messages of the workbench."""

import os
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.gui.common.messages import report
from support.hands import (
    entries,
    field,
    screenshot,
    settle,
    type_in,
    visible,
    wait,
    whole_screen,
    widgets,
    window,
)
from support.restoring import speak


@pytest.mark.slow
def test_german(freecad):
    freecad.call(speak, "German")
    freecad.call(german, window=True, fresh=True)


def german():
    Gui.activateWorkbench("BeltGrindingWorkbench")
    whole_screen()
    settle()
    names = [a.text().replace("&", "") for a in window.menuBar().actions()]
    assert "Bandschleifen" in names, names
    assert Gui.getWorkbench("BeltGrindingWorkbench").MenuText == "Bandschleifen"
    bar = next(
        a for a in window.menuBar().actions() if a.text().replace("&", "") == "Bandschleifen"
    )
    texts = [a.text().replace("&", "") for a in entries(bar) if a.text()]
    assert texts[:3] == ["Neuer Auftrag", "Rohteil", "Bandschleifmaschine"], texts
    assert not {"Simulate", "Deviation", "New job"} & set(texts), texts
    subs = [a.text().replace("&", "") for a in bar.menu().actions() if a.menu()]
    assert subs[-1] == "Austausch" and "Maschine" in subs and len(subs) == 5, subs
    bars = {b.windowTitle() for b in widgets(QtGui.QToolBar)}
    assert "Bandschleifen: Einrichten" in bars, bars
    Gui.runCommand("BeltGrinding_Examples")
    field("setUpExample").click()
    settle()
    doc = FreeCAD.ActiveDocument
    for name in ("BeltGrindingJob", "Stock", "BeltMachine", "RobotPath"):
        view = doc.getObject(name).ViewObject
        assert view.Proxy.doubleClicked(view)
        settle()
        if "PICTURES" in os.environ:
            screenshot(Path(os.environ["PICTURES"], f"{name}.png"))
        if name == "BeltGrindingJob":
            labels = {w.text() for w in widgets(QtGui.QLabel) if w.isVisible()}
            assert "Abtastabstand" in labels and "Sample spacing" not in labels, labels
            usual = doc.BeltGrindingJob.LawCoefficient
            type_in("LawCoefficient", "0,07")  # a comma, as Germans write it
            assert doc.BeltGrindingJob.LawCoefficient == 0.07
        buttons = [b for b in widgets(QtGui.QPushButton) if b.isVisible()]
        next(b for b in buttons if b.text().replace("&", "") in ("OK", "Ok")).click()
        settle()

    doc.BeltGrindingJob.LawCoefficient = usual  # with the other, what is below takes minutes

    # What the core refuses is told in German, too.
    try:
        core.read_mesh("/no/such.stl")
    except InputError as error:
        report(error)
    (box,) = visible(QtGui.QMessageBox, "BeltGrinding_Error")
    assert box.text() == "/no/such.stl: Diese Datei gibt es nicht", box.text()
    box.close()

    # What a program leaves open, too; in the document it stands in English.
    Path("pass.src").write_text(
        "DEF pass()\nLIN {X 0, Y 0, Z 30, A 0, B 0, C 180}\nLIN NOWHERE\nLIN {X 50, Y 0, Z 30, A 0, B 0, C 180}\nEND\n"
    )
    robot = beltgrinding.import_program(doc.BeltGrindingJob, "pass.src")
    assert robot.ViewObject.Proxy.doubleClicked(robot.ViewObject)
    settle()
    items = [w.item(i).text() for w in widgets(QtGui.QListWidget) for i in range(w.count())]
    (told,) = [text for text in items if "NOWHERE" in text]
    (kept,) = [text for text in robot.Problems if "NOWHERE" in text]
    assert told != kept and told.startswith(kept.split(" ")[0]), told
    Gui.Control.closeDialog()
    doc.removeObject(robot.Name)

    # What is said of a property: FreeCAD stores it in English, and looks for its translation when it shows it.
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.BeltMachine)
    tips = set()

    def seen():
        for view in widgets(QtGui.QTreeView):
            if view.metaObject().className() != "Gui::PropertyEditor::PropertyEditor":
                continue
            model = view.model()
            rows = [model.index(i, 0) for i in range(model.rowCount())]
            rows += [
                model.index(k, 0, group) for group in rows for k in range(model.rowCount(group))
            ]
            tips.update(str(model.data(row, QtCore.Qt.ToolTipRole)) for row in rows)
        return any("Außenradius in der Mitte der Breite" in tip for tip in tips)

    wait(seen, 20)
    assert any("Elastizitätsmodul des Gummibelags" in tip for tip in tips)
    for obj in [doc.BeltGrindingJob, *doc.BeltGrindingJob.Group]:
        plain = doc.addObject(obj.TypeId, "plain")
        for name in set(obj.PropertiesList) - set(plain.PropertiesList):
            said = obj.getDocumentationOfProperty(name)
            assert FreeCAD.Qt.translate("App::Property", said) != said, (obj.Name, name, said)
        doc.removeObject(plain.Name)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.BeltGrindingJob)
    wait(lambda: Gui.Command.get("BeltGrinding_Simulate").isActive(), 10)
    Gui.runCommand("BeltGrinding_Simulate")
    assert Gui.Control.activeDialog()
    wait(lambda: doc.getObject("Simulation") is not None, 120)
    assert "% in Toleranz" in field("state").text(), field("state").text()
    if "PICTURES" in os.environ:
        screenshot(Path(os.environ["PICTURES"], "simulation.png"))
