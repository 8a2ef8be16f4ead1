"""A scan of the raw part as stock, laid on the design by the stock's panel; and by a macro."""

import os
from types import SimpleNamespace

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
import MeshPart
import Part
from PySide import QtGui

import beltgrinding
from beltgrinding.gui.panels.stock_panel import StockPanel
from support.hands import field, press, settle, start, wait

pytestmark = pytest.mark.freecad(window=True)


def script():
    start()
    doc = FreeCAD.newDocument("casting")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.make_belt_machine(job, WheelRadius=30, WheelWidth="15 mm", Force="30 N")
    raw = Part.makeBox(60, 40, 20.25)  # 0.25 mm on the top; the other faces as designed
    moved = FreeCAD.Placement(FreeCAD.Vector(1.5, -0.8, 0.6), FreeCAD.Rotation(1.5, -1.0, 0.8))
    mesh = MeshPart.meshFromShape(
        Shape=raw, LinearDeflection=0.05, AngularDeflection=0.2, Relative=False
    )
    mesh.transform(moved.toMatrix())
    mesh.write(os.path.abspath("raw.stl"))
    stock = beltgrinding.make_stock(job, os.path.abspath("raw.stl"))
    doc.recompute()
    return SimpleNamespace(doc=doc, job=job, moved=moved, stock=stock)


def check(job, moved, stock):
    left = stock.FilePlacement.multiply(moved)
    assert left.Base.Length < 0.05 and left.Rotation.Angle < 2e-3, left
    beltgrinding.make_raster(job, Along="direction", Direction=FreeCAD.Vector(1, 0, 0))
    simulation = beltgrinding.simulate(job)
    height = np.array(simulation.Proxy.field(simulation).stock_height)
    assert abs(np.median(height) - 0.25) < 0.02, np.median(height)


def test_the_panel_lays_a_scan_on_the_design():
    here = script()
    doc, job, moved, stock = here.doc, here.job, here.moved, here.stock
    doc.openTransaction("Edit")
    Gui.Selection.addSelection(stock)
    settle()
    Gui.Control.showDialog(StockPanel(stock))
    settle()
    press("Lay the scan on the design")
    note = field("note", QtGui.QLabel)
    wait(lambda: field("layScan", QtGui.QPushButton).isEnabled(), 120)
    assert "Laid on the design" in note.text() and "trusted" not in note.text(), note.text()
    placed = stock.FilePlacement
    shown = float(field("X").property("rawValue"))
    assert abs(shown - placed.Base.x) < 0.01, (shown, placed)
    assert stock.FilePlacement == placed
    field("scanDatum", QtGui.QLineEdit).setText("6")
    press("Lay the scan on the design")
    wait(lambda: field("layScan", QtGui.QPushButton).isEnabled(), 120)
    assert "still to be ground" in note.text(), note.text()
    press("OK")
    check(job, moved, stock)


def test_a_macro_lays_it_too():
    here = script()
    job, moved, stock = here.job, here.moved, here.stock
    found = beltgrinding.lay_stock(job)
    assert found["rms_mm"] < 0.05
    again = beltgrinding.lay_stock(job)  # from where it lies now
    assert again["rms_mm"] < 0.05
    check(job, moved, stock)
    beltgrinding.make_stock(job, Kind="allowance", Allowance=0.2)
    try:
        beltgrinding.lay_stock(job)
        assert False
    except beltgrinding.InputError as error:
        assert "no mesh" in str(error)
