"""Tolerance zones in a narrow dock: all that a zone can call for is in sight; an open Simulation panel follows them."""

import json
import os
from types import SimpleNamespace

import pytest
from PySide import QtCore

from beltgrinding.objects import api, preferences
from support.hands import (
    field,
    menu,
    prepare,
    press,
    screenshot,
    settle,
    type_in,
    view_widget,
    wait,
    window,
)

pytestmark = pytest.mark.freecad(window=True)


def started():
    SHOTS = os.environ.get("BELTGRINDING_SHOTS")
    job = prepare()
    doc = job.Document
    NAME, FACES, LOWER, UPPER, EDGE, THIN, THICK, RA, LAY = range(9)
    return SimpleNamespace(EDGE=EDGE, NAME=NAME, SHOTS=SHOTS, THIN=THIN, doc=doc, job=job)


@pytest.mark.slow
def test_all_of_a_zone_is_in_sight_and_typed():
    here = started()
    EDGE, NAME, SHOTS, THIN, doc, job = (
        here.EDGE,
        here.NAME,
        here.SHOTS,
        here.THIN,
        here.doc,
        here.job,
    )
    steps = doc.UndoCount
    menu("Tolerance zones...")
    table, lay = field("zones"), field("zoneLay")
    assert not lay.isEnabled(), "no zone is chosen"
    press("Add")
    press("Add")
    table.item(0, NAME).setText("leading edge")
    assert lay.isEnabled() and table.currentRow() == 1
    for name, text in (("zoneEdge", "2"), ("zoneThin", "-0,1"), ("zoneThick", "0.2")):
        type_in(name, text)
    settle()
    if SHOTS:
        screenshot(f"{SHOTS}/zones.png")
    assert table.item(1, EDGE).text() == "2" and table.item(0, EDGE).text() == ""
    zones = json.loads(job.Zones)
    assert zones[1]["edge_radius_mm"] == 2 and zones[1]["thickness_mm"] == [-0.1, 0.2]
    type_in("zoneThick", "x")
    assert "no length" in field("note").text() and json.loads(job.Zones) == zones
    type_in("zoneThick", "0.3")
    type_in("zoneRa", "0.8 T16%")
    assert "finish" in field("note").text(), "the job computes none"
    type_in("zoneRa", "")
    # What is typed in the table stands in the field, that of the chosen zone.
    table.item(1, THIN).setText("-0.4")
    assert field("zoneThin").text() == "-0.4"
    table.setCurrentCell(0, NAME)
    assert field("zoneThin").text() == "" and field("zoneEdge").text() == ""
    type_in("zoneEdge", "1")
    press("Down")
    assert field("zoneEdge").text() == "1" and table.currentRow() == 1
    press("Remove")
    assert field("zoneEdge").text() == "2"
    press("Remove")
    assert not lay.isEnabled() and field("zoneEdge").text() == ""
    press("Add")
    table.item(0, NAME).setText("trailing edge of the blade")
    settle()
    # Nothing of it lies beyond the dock.
    for name in ("zones", "zoneEdge", "zoneThin", "zoneThick", "zoneRa", "zoneLay"):
        one = field(name)
        left = one.mapTo(window, QtCore.QPoint(0, 0)).x()
        assert (
            left >= 0 and left + one.width() <= view_widget().mapTo(window, QtCore.QPoint(0, 0)).x()
        ), name
    assert table.horizontalScrollBar().maximum() == 0, "its columns are all in sight"
    press("OK")
    assert doc.UndoCount == steps + 1


def test_limits_are_in_the_unit_of_deviations():
    here = started()
    api.set_zones(here.job, [{"name": "top", "faces": [6], "tolerance_mm": [-0.03, 0.125]}])
    here.doc.recompute()
    preferences.parameters().SetString("DeviationUnit", "µm")
    menu("Tolerance zones...")
    table = field("zones")
    assert [table.item(0, k).text() for k in (2, 3)] == ["-30", "125"]
    assert "-50 µm" in field("note").text(), field("note").text()
    table.item(0, 2).setText("-70")
    for name, text in (("zoneThin", "-7um"), ("zoneThick", "0.2 mm"), ("zoneEdge", "2")):
        type_in(name, text)
    (zone,) = json.loads(here.job.Zones)
    assert zone["tolerance_mm"] == [-0.07, 0.125] and zone["thickness_mm"] == [-0.007, 0.2]
    assert zone["edge_radius_mm"] == 2  # no deviation: in mm
    press("Add")
    assert [table.item(1, k).text() for k in (2, 3)] == ["-50", "50"]
    press("OK")


def test_an_open_simulation_panel_follows_the_limits():
    here = started()
    doc, job = here.doc, here.job
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None and "%" in field("state").text(), 200)
    judged = field("state").text()
    api.set_zones(job, [{"name": "top", "faces": [6], "tolerance_mm": [-5, 5]}])
    doc.recompute()
    wait(lambda: "limits have changed" in field("state").text())
    api.set_zones(job, [])
    doc.recompute()
    wait(lambda: field("state").text() == judged)
    job.ToleranceUpper = 1.5
    doc.recompute()
    wait(lambda: "limits have changed" in field("state").text())
    doc.BeltMachine.Force = "33 N"
    doc.recompute()
    wait(lambda: "Out of date" in field("state").text())
    press("Close")
    job.ToleranceUpper = 1.0
    doc.recompute()
    settle()
