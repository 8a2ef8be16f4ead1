"""The stock's panel offers what other jobs leave, by the jobs' names."""

import FreeCADGui as Gui
import pytest
from PySide import QtGui

import beltgrinding
from beltgrinding.gui.common.editing import edit
from support.hands import field, prepare, press, settle, visible

pytestmark = pytest.mark.freecad(window=True)


def offered(name):
    box = field(name, QtGui.QComboBox)
    return [box.itemText(k) for k in range(box.count())]


def choose(name, text):
    box = field(name, QtGui.QComboBox)
    box.setCurrentIndex(offered(name).index(text))
    settle()


def test_a_job_is_chosen_whose_result_is_the_stock():
    first = prepare()
    part = first.DesignFaces[0][0]
    second = beltgrinding.make_job(part, ["Face6"], Spacing="0.6 mm")
    stock = beltgrinding.make_stock(second)
    second.Document.recompute()
    first.Label = "Rough"
    edit(stock)
    settle()
    bodies = offered("Kind")
    assert bodies[-1] == "What another job leaves"
    choose("Kind", bodies[-1])
    assert offered("Source") == ["(none)"]  # not simulated yet
    assert field("Source").isVisible() and not visible(QtGui.QWidget, "Allowance")
    press("OK")
    assert "Choose the job" in field("note").text() and Gui.Control.activeDialog()
    press("Cancel")
    assert stock.Kind == "allowance"

    result = beltgrinding.simulate(first)
    edit(stock)
    settle()
    choose("Kind", "What another job leaves")
    assert offered("Source") == ["(none)", "Rough"]
    choose("Source", "Rough")
    press("OK")
    assert stock.Kind == "left" and stock.Source == result and stock.isValid()

    edit(stock)
    settle()
    assert field("Source", QtGui.QComboBox).currentText() == "Rough"
    choose("Kind", "Solid")
    assert offered("Source")[1] == "Block" and "Rough" not in offered("Source")
    choose("Source", "Block")
    assert stock.Source == part
    press("Cancel")
    assert stock.Kind == "left" and stock.Source == result
