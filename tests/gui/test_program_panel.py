"""The panel of a robot program, in a window."""

from pathlib import Path

import pytest
from PySide import QtGui

from beltgrinding.gui.common.editing import edit
from beltgrinding.objects import set_up
from support.hands import bring_up, field, prepare, press, visible

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc = job.Document
    return doc, job


def test_the_belt_s_travel_is_chosen_where_a_program_leaves_it():
    doc, job = prepared()
    Path("p.apt").write_text("UNITS/MM\nGOTO/10,10,20,0,0,1\nGOTO/50,10,20\nGOTO/50,30,20\nFINI\n")
    path = set_up.import_program(job, "p.apt")
    doc.recompute()
    edit(path)
    assert field("Roll").isVisible() and not visible(QtGui.QWidget, "RollDirection")
    field("Roll").setCurrentIndex(2)
    assert path.Roll == "fixed" and field("RollDirection").isVisible()
    assert path.RollOfPoses == "fixed [1.0, 0.0, 0.0]", path.RollOfPoses
    x, y, z = field("RollDirection").fields
    x.setText("0")
    x.editingFinished.emit()
    assert path.RollDirection.x == 1 and x.styleSheet(), "no direction"
    y.setText("-2")
    y.editingFinished.emit()
    assert path.RollDirection.y == -2 and not x.styleSheet()
    assert path.RollOfPoses == "fixed [0.0, -2.0, 0.0]", path.RollOfPoses
    field("Roll").setCurrentIndex(1)
    assert len(path.Poses) > 3 and not visible(QtGui.QWidget, "RollDirection")
    press("OK")

    edit(doc.RobotPath)  # its poses are whole
    assert not visible(QtGui.QWidget, "Roll")
    press("OK")


def test_problems_of_a_kind_are_one_line_until_each_is_asked_for():
    _, job = prepared()
    rows = "".join(f"CYCLE/DRILL,{k}\nCYCLE/OFF\nGOTO/{k},0,0\n" for k in range(12))
    Path("p.apt").write_text(f"UNITS/MM\nFEDRAT/60,MMPM\n{rows}FINI\n")
    path = set_up.import_program(job, "p.apt")
    edit(path)
    problems = field("poseTabs").findChild(QtGui.QListWidget, "problems")
    bring_up(problems)
    each = field("eachProblem", QtGui.QCheckBox)
    assert len(path.Problems) == 12 and problems.count() == 1, problems.count()
    assert "11 more like it" in problems.item(0).text()
    each.setChecked(True)
    assert problems.count() == 12
    press("OK")
