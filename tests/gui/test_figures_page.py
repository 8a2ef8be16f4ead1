"""Figures in a drawing: a page whose table follows the result; made once, undone in one step, kept in the file."""

from pathlib import Path

import pytest
import FreeCAD

import beltgrinding
from beltgrinding.objects import figures
from support.hands import menu, prepare, settle
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def test_the_table_follows_the_result():
    job = prepare()
    doc = job.Document
    with pytest.raises(beltgrinding.InputError):
        beltgrinding.make_figures_page(job)  # without a result
    beltgrinding.simulate(job)
    beltgrinding.make_deviation(job)
    doc.recompute()
    doc.clearUndos()
    menu("Figures in a drawing")
    page, table, sheet = doc.FiguresPage, doc.FiguresTable, doc.Figures
    assert doc.UndoCount == 1 and page.Views == [table] and table.Source == sheet
    (row,) = [k for k in range(1, 99) if sheet.getContents(f"B{k}") == "=Simulation.RemovedVolume"]
    assert int(table.CellEnd[1:]) >= row and table.CellEnd[0] == "C"

    def shown():
        return sheet.get(f"B{row}").Value

    before, drawn = shown(), table.Symbol
    assert before == pytest.approx(doc.Simulation.RemovedVolume.Value) and "<svg" in drawn
    assert "Removed" in drawn
    doc.BeltMachine.Force = "20 N"
    beltgrinding.simulate(job)
    doc.recompute()
    assert shown() < 0.8 * before and table.Symbol != drawn
    # Once more: the same page, filled anew; FreeCAD's file keeps the link.
    objects = len(doc.Objects)
    menu("Figures in a drawing")
    assert len(doc.Objects) == objects
    doc.saveAs(str(Path("page.FCStd").absolute()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(Path("page.FCStd").absolute()))
    settle()
    assert doc.FiguresTable.Source == doc.Figures and doc.FiguresPage.Views == [doc.FiguresTable]


def test_without_templates_it_says_what_is_missing():
    job = prepare()
    beltgrinding.simulate(job)
    patch(figures, "BLANK", "none.svg")
    with pytest.raises(beltgrinding.InputError, match="none.svg"):
        beltgrinding.make_figures_page(job)
    assert job.Document.getObject("FiguresPage") is None
