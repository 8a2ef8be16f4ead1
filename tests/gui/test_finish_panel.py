"""The finish in the window: none without the key, then figures, colours, legend and strokes. The roughness is of a made-up
belt."""

import json

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
from PIL import Image
from PySide import QtGui
from pivy import coin

from beltgrinding.gui.scene import lay_strokes
from beltgrinding.objects import api
from beltgrinding.objects.fields import field_of
from support import synthetic_finish
from support.hands import field, menu, prepare, press, settle, visible, wait

pytestmark = pytest.mark.freecad(window=True)


def test_roughness_and_scratches_are_shown_once_the_job_asks_for_them():
    job = prepare()
    doc = job.Document

    def rows():
        table = field("statistics")
        return {table.item(i, 0).text(): table.item(i, 1).text() for i in range(table.rowCount())}

    def shown():
        api.simulate(job)
        deviation = doc.getObject("Deviation") or api.make_deviation(job)
        settle()
        deviation.ViewObject.Proxy.doubleClicked(deviation.ViewObject)
        settle()
        return deviation

    def stroked(deviation):
        lay = deviation.ViewObject.Proxy.lay
        search = coin.SoSearchAction()
        search.setType(coin.SoLineSet.getClassTypeId())
        search.setInterest(coin.SoSearchAction.ALL)
        search.apply(lay)
        return lay.whichChild.getValue() == coin.SO_SWITCH_ALL and search.getPaths().getLength()

    deviation = shown()
    assert deviation.GreatestRoughness == 0.0 and deviation.CrossedArea == -1.0
    assert "Ra, mean" not in rows() and not stroked(deviation)
    press("OK")

    job.Finish = json.dumps({"grit": 120, "initial_Ra_um": 3.2, "model": synthetic_finish.model()})
    deviation = shown()
    assert 0.0 < deviation.MeanRoughness < deviation.GreatestRoughness
    assert rows()["Ra, greatest"] == f"{deviation.GreatestRoughness:.2f} µm"
    assert rows()["Ra known"] == f"{deviation.RoughnessKnown:.1f} %"
    assert "Crossed scratches" in rows()
    before = list(deviation.VertexColors)
    choice = field("ColourBy")
    choice.setCurrentIndex(choice.findText("Roughness"))
    settle()
    assert deviation.ColourBy == "roughness"
    assert list(deviation.VertexColors) != before
    assert stroked(deviation)

    def picture():
        settle()
        Gui.ActiveDocument.ActiveView.saveImage("strokes.png", 400, 300, "White")
        return np.asarray(Image.open("strokes.png").convert("RGB"), dtype=int)

    Gui.ActiveDocument.ActiveView.viewTop()
    Gui.ActiveDocument.ActiveView.fitAll()
    drawn = picture()
    deviation.ViewObject.Scratches = False
    settle()
    assert not stroked(deviation)
    darker = (drawn.sum(axis=2) < picture().sum(axis=2) - 30).mean()
    assert 0.01 < darker < 0.5, darker
    deviation.ViewObject.Scratches = True
    press("OK")
    ground = field_of(deviation.Simulation)
    ends, across = lay_strokes.strokes(ground, None, 20.0)
    assert 200 < len(ends) < 2.5 * lay_strokes.MOST and not across.any()
    # Along the surface, where passes were.
    middle, way = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    near = (
        np.linalg.norm(middle[:, None] - ground.points[None], axis=2).argmin(axis=1)
        if ground.size < 20000
        else None
    )
    if near is not None:
        assert (np.asarray(ground.finish["passes"])[near] > 0).mean() > 0.95
        square = np.abs(np.einsum("ij,ij->i", way, np.asarray(ground.normals)[near]))
        assert np.median(square / np.linalg.norm(way, axis=1)) < 0.02


def test_a_zone_that_is_too_rough_is_an_event_at_its_worst_place():
    job = prepare()
    doc = job.Document
    job.Finish = json.dumps({"grit": 120, "initial_Ra_um": 0.5, "model": synthetic_finish.model()})
    job.ToleranceLower, job.ToleranceUpper = -9, 9
    asked = {"Ra_max_um": 0.6, "lay": "⊥", "lay_direction": [0, 1, 0]}
    api.set_zones(job, [{"name": "spout", "finish": asked}])
    doc.recompute()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None and doc.Simulation.Fingerprint)
    table, box = field("events"), field("eventKind")
    text = " ".join(label.text() for label in visible(QtGui.QLabel))
    assert "In tolerance, but the finish is not as called for: 1 of 1 zones" in text, text
    kinds = [box.itemText(k) for k in range(box.count())]
    assert kinds[0] == "All events (2)", kinds
    assert {"Roughness exceeded (1)", "Finish unknown (1)"} == set(kinds[1:]), kinds
    box.setCurrentIndex(box.findData("roughness_exceeded"))
    settle()
    assert table.rowCount() == 1 and table.item(0, 2).text() == "Face6"
    table.selectRow(0)
    settle()
    text = field("eventDetails").text()
    assert "spout" in text and "0.6 µm" in text and "finer grit" in text and "line" in text, text
    (event,) = [
        e for e in doc.Simulation.Proxy.events(doc.Simulation) if e["kind"] == "roughness_exceeded"
    ]
    ground = field_of(doc.Simulation)
    ra = np.asarray(ground.finish["roughness"])
    assert abs(event["value"] - np.nanmax(ra)) < 1e-6 and event["line"] == int(
        table.item(0, 3).text()
    )
    worst = ground.points[int(np.nanargmax(ra))]
    assert np.allclose(event["point"], worst)
    # The wheel stands over the place, within a pose's way of the time that the event tells.
    panel = table.parent().chosen.__self__
    contact = panel.moment.cell.frames()["contact"][:3, 3]
    assert abs(contact[0] - worst[0]) < 1.0 or not 10 <= worst[0] <= 50, (contact, worst)

    # The verdict's dock has rows for it: the zone's heights are good, not its roughness.
    press("Close")
    menu("Verdict")
    regions = field("regions")
    rows = [[regions.item(i, k).text() for k in range(7)] for i in range(regions.rowCount())]
    assert [row[:2] for row in rows[:3]] == [
        ["spout", "pass"],
        ["spout: roughness", "fail"],
        ["spout: lay", "unknown"],
    ], rows
    assert (
        rows[1][5] == f"{event['value']:.2f} µm" and rows[1][6] == f"+{event['value'] - 0.6:.2f} µm"
    ), rows
    assert doc.Verdict.ZoneVerdicts[0].endswith("finish: fail")
    regions.cellClicked.emit(1, 0)
    settle()
    view = Gui.ActiveDocument.ActiveView
    at, (width, height) = view.getPointOnScreen(FreeCAD.Vector(*event["point"])), view.getSize()
    assert abs(at[0] - width / 2) < 0.2 * width and abs(at[1] - height / 2) < 0.2 * height, (
        at,
        width,
        height,
    )
    field("BeltGrinding_VerdictDock").close()

    # By other zones the list is another one, at once.
    api.set_zones(job, [{"name": "spout", "tolerance_mm": [-9, 9], "finish": {"Ra_max_um": 9.0}}])
    doc.recompute()
    doc.Simulation.ViewObject.Proxy.doubleClicked(doc.Simulation.ViewObject)
    settle()
    assert not visible(QtGui.QTableWidget, "events") and "No events." in " ".join(
        label.text() for label in visible(QtGui.QLabel)
    )
