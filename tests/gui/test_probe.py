"""A click on the deviation: what it says, and the marker that it leaves."""

import os
from types import SimpleNamespace

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.objects.readout import Reader
from support.hands import (
    click_at,
    field,
    menu,
    prepare,
    press,
    settle,
    type_in,
    wait,
    widgets,
    window,
)

pytestmark = pytest.mark.freecad(window=True)


def ground(kind="own"):
    if kind == "stock":
        os.environ["BELTGRINDING_STOCK_NODES"] = "1"
    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    view.fitAll()
    settle()

    def click(x, y, z=20.0):
        click_at(*view.getPointOnScreen(FreeCAD.Vector(x, y, z)))
        return field("reading").text()

    return SimpleNamespace(click=click, doc=doc, job=job, view=view)


@pytest.mark.parametrize("kind", ("own", "stock"))
def test_a_click_tells_the_sample_under_it(kind):
    here = ground(kind)
    click, doc, view = here.click, here.doc, here.view
    reader = Reader(doc.Deviation)
    text = click(2, 2)  # beside the pass: all the stock is left
    assert "+0.2000 mm: too much left" in text and "removed 0.0000 mm of 0.2000 mm" in text, text
    assert "Block.Face6" in text and "segment -1.0000 mm ... +0.2000 mm" in text, text
    assert window.statusBar().currentMessage().startswith("+0.2000 mm")
    assert field("readingAtCursor").text() == text

    text = click(30, 20)  # in the middle of the pass
    reading = reader.sample(int(text.split("sample ")[1].split()[0]))
    assert f"{reading['deviation']:+.4f} mm" in text and reading["removed"] > 0.01, text
    assert max(abs(reading["point"][0] - 30), abs(reading["point"][1] - 20)) <= 0.6
    assert abs(reading["stock"] - reading["removed"] - reading["deviation"]) < 1e-9

    press("OK")
    assert not [w for w in widgets(QtGui.QLabel, "readingAtCursor") if w.isVisible()]
    click_at(*view.getPointOnScreen(FreeCAD.Vector(2, 2, 20)))  # nobody listens any more
    assert not widgets(QtGui.QLabel, "reading")
    menu("Deviation")

    # The verdict follows the tolerance in the panel.
    type_in("ToleranceUpper", "0.3 mm")
    assert "+0.2000 mm: in tolerance" in click(2, 2)
    assert click_at(3, 3) is None and "in tolerance" in field("reading").text()  # beside the part
    assert reader.at((200, 0, 0)) is None


def test_a_marker_stays_if_asked():
    here = ground()
    click, doc, job, view = here.click, here.doc, here.job, here.view
    markers = lambda: [o for o in doc.Objects if o.TypeId == "App::AnnotationLabel"]
    click(30, 20)
    assert not markers()
    field("keepMarker").setChecked(True)
    click(2, 2)
    (marker,) = markers()
    assert marker.Label.startswith("+0.2000 mm") and marker.LabelText[2].startswith("Block.Face6")
    assert (marker.BasePosition - FreeCAD.Vector(2, 2, 20.2)).Length < 0.7, marker.BasePosition
    press("Cancel")
    assert not markers()  # Cancel takes back everything
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, job.Name)
    menu("Deviation")
    view = Gui.ActiveDocument.ActiveView
    view.viewTop()
    view.fitAll()
    settle()
    field("keepMarker").setChecked(True)
    click(2, 2)
    press("OK")
    assert len(markers()) == 1
    path = FreeCAD.getUserAppDataDir() + "marked.FCStd"
    doc.saveAs(path)
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(path)
    assert markers()[0].LabelText[0].startswith("+0.2000 mm")
