"""Figures of the window in German: as FreeCAD writes its own."""

import re

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

import beltgrinding
from support import freecad as windows
from support.hands import field, prepare, settle, visible
from support.restoring import speak


@pytest.mark.slow
def test_german_figures_have_a_comma_and_no_english_thousands(tmp_path):
    freecad = windows.FreeCad(tmp_path)
    freecad.call(speak, "German")
    freecad.call(german_figures, window=True, fresh=True)


def german_figures():
    QtCore.QLocale.setDefault(QtCore.QLocale("de_DE"))  # as FreeCAD does by its preferences
    job = prepare()
    beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    deviation.ViewObject.Proxy.doubleClicked(deviation.ViewObject)
    settle()
    table = field("statistics")
    told = [table.item(row, 1).text() for row in range(table.rowCount())]
    assert "2\u202f400,0 mm²" in told and not [text for text in told if "." in text], told
    assert not [text for text in labels(deviation) if "." in text], labels(deviation)
    Gui.Control.closeDialog()
    settle()
    beltgrinding.make_raster(job)
    beltgrinding.make_verdict(job)
    wrong = {}
    for name in ("BeltGrindingJob", "BeltMachine", "RasterPath", "Simulation", "Verdict"):
        view = job.Document.getObject(name).ViewObject
        view.Proxy.doubleClicked(view)
        settle()
        wrong[name] = sorted({text for text in texts() if ENGLISH.search(text)})
        Gui.Control.closeDialog()
        settle()
    assert not any(wrong.values()), wrong
    assert FreeCAD.Units.Quantity("1.5 mm").UserString.startswith("1,5")  # as FreeCAD's own


ENGLISH = re.compile(r"\d\.\d|\d,\d{3},|\d,\d{3}\.")


def texts():
    """What labels and tables of the window say."""
    for label in visible(QtGui.QLabel):
        yield label.text()
    for table in visible(QtGui.QTableWidget):
        for row in range(table.rowCount()):
            for column in range(table.columnCount()):
                if table.item(row, column) is not None:
                    yield table.item(row, column).text()


def labels(deviation):
    return list(deviation.ViewObject.Proxy.drawn.spec.labels.values())
