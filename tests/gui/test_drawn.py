"""What is drawn is a function of the properties: whatever was done, the 3D view and its legends show what the same
document shows that is opened anew."""

import json
import time
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
from PIL import Image

import beltgrinding
from beltgrinding.gui.preferences_page import PreferencesPage, take_effect
from beltgrinding.objects import preferences
from support import synthetic_finish
from support.hands import field, menu, prepare, press, settle, type_in

pytestmark = pytest.mark.freecad(window=True)

SIZE = 500, 360
SAME = 0.001  # share of the pixels: smooth lines are drawn a little otherwise in each view
HEAVY = ("VertexColors", "Mesh", "Path", "Shape")


def worked():
    """A job with finish, ground, and all that shows its result."""
    job = prepare()
    job.Finish = json.dumps({"grit": 120, "initial_Ra_um": 3.2, "model": synthetic_finish.model()})
    beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    beltgrinding.make_section(job)
    ground = beltgrinding.make_ground_mesh(job)
    ground.ViewObject.Visibility = False
    for part, _ in job.DesignFaces:
        part.ViewObject.Visibility = False
    doc = job.Document
    doc.recompute()
    settle()
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewIsometric()
    view.fitAll()
    settle()
    doc.commitTransaction()
    doc.clearUndos()
    return job, doc, deviation


def picture(camera=None, wait=True):
    view = Gui.ActiveDocument.ActiveView
    Gui.Selection.clearSelection()
    if camera is not None:
        view.setAnimationEnabled(False)
        view.setCamera(camera)
    if wait:
        settle()
    view.saveImage("drawn.png", *SIZE, "White")
    return np.asarray(Image.open("drawn.png").convert("RGB"), dtype=int)


def same(one, other):
    return (abs(one - other).max(axis=2) > 24).mean() <= SAME


def opened_anew(doc):
    """What the document shows that is saved now and opened."""
    camera = Gui.ActiveDocument.ActiveView.getCamera()
    path = Path("anew.FCStd").absolute()
    path.unlink(missing_ok=True)
    doc.saveCopy(str(path))
    other = FreeCAD.openDocument(str(path))
    settle()
    try:
        return picture(camera)
    finally:
        FreeCAD.closeDocument(other.Name)
        FreeCAD.setActiveDocument(doc.Name)
        Gui.ActiveDocument = Gui.getDocument(doc.Name)
        settle()


def properties(doc):
    """All that the document holds, as text."""
    found = {}
    for obj in doc.Objects:
        for holder in (obj, obj.ViewObject):
            for name in holder.PropertiesList:
                if name not in HEAVY and name != "Proxy":
                    found[obj.Name, holder is obj, name] = repr(getattr(holder, name))
    return found


def differing(one, other):
    return sorted(key for key in one if one[key] != other.get(key))


def holder(doc, name):
    """(what has the property, the property) of "Object.ViewObject.Property"."""
    first, *path, last = name.split(".")
    found = doc.getObject(first)
    return getattr(found, path[0]) if path else found, last


def set_of(doc, changes):
    """Sets properties; returns what they were."""
    before = [(name, getattr(*holder(doc, name))) for name, _ in changes]
    for name, value in changes:
        setattr(*holder(doc, name), value)
    return before


JOB, DEVIATION = "BeltGrindingJob", "Deviation"
HIDDEN = f"{DEVIATION}.ViewObject.Visibility", False
CHANGES = [
    [(f"{JOB}.ToleranceLower", -0.03), (f"{JOB}.ToleranceUpper", 0.03)],
    [(f"{JOB}.ColourLimit", 0.12)],
    [(f"{JOB}.Label", "Another")],
    [(f"{DEVIATION}.ColourBy", "roughness")],
    [(f"{DEVIATION}.ColourBy", "measured")],
    [(f"{DEVIATION}.ColourBy", "difference")],
    [(f"{DEVIATION}.ColourBy", "uncertainty")],
    [(f"{DEVIATION}.ColourBy", "error of the cells")],
    [(f"{DEVIATION}.ColourBy", "temperature")],
    [(f"{DEVIATION}.Bounds", "by tolerance"), (f"{DEVIATION}.TimesTolerance", 2.0)],
    [(f"{DEVIATION}.Bounds", "by percentile"), (f"{DEVIATION}.Percentile", 30.0)],
    [(f"{DEVIATION}.Bands", 3)],
    [(f"{DEVIATION}.Label", "The result")],
    [(f"{DEVIATION}.ViewObject.RestOfPart", False)],
    [(f"{DEVIATION}.ViewObject.Scratches", False)],
    [(f"{DEVIATION}.ViewObject.DisplayMode", "Flat Lines")],
    [(f"{DEVIATION}.ViewObject.Transparency", 50)],
    [HIDDEN],
    [HIDDEN, ("GroundPart.ViewObject.Visibility", True)],
    [HIDDEN, ("Stock.Allowance", 4.0)],
    [HIDDEN, ("Stock.ViewObject.Visibility", False)],
    [("Stock.Allowance", 0.3)],  # the result is out of date
    [("RobotPath.ViewObject.Visibility", False)],
    [("RobotPath.ViewObject.NormalColor", (1.0, 0.0, 0.0))],
    [("Section.ViewObject.Visibility", False)],
    [("Section.Point", (12, 20, 20))],
    [("BeltMachine.WheelRadius", 45.0)],  # the path's contact moves
]


@pytest.mark.slow
@pytest.mark.parametrize("part", range(4))
def test_every_change_undo_redo_and_abort_draw_what_is_there(part):
    job, doc, deviation = worked()
    first, held = picture(), properties(doc)
    assert same(first, opened_anew(doc)), "as made"

    def consistent(what, *known):
        """Compares with the picture of the same properties, or with the document opened anew."""
        others = [image for image, before in known if not differing(before, properties(doc))]
        now = picture()
        for last in (False, True):
            if same(now, others[0] if others else opened_anew(doc)):
                return now
            assert not last, what
            time.sleep(1)  # on a busy machine FreeCAD may not be through
            now = picture()

    for changes in CHANGES[part::4]:
        what = str(changes)
        doc.openTransaction("change")
        set_of(doc, changes)
        doc.recompute()
        doc.commitTransaction()
        changed = consistent(what), properties(doc)
        doc.undo()
        consistent("undo of " + what, (first, held), changed)
        doc.redo()
        consistent("redo of " + what, (first, held), changed)
        doc.undo()
        doc.openTransaction("change")
        set_of(doc, changes)
        doc.recompute()
        settle()
        doc.abortTransaction()
        consistent("abort of " + what, (first, held), changed)
        doc.recompute()
        doc.UndoMode = 0  # as a macro may do it
        before = set_of(doc, changes)
        doc.recompute()
        set_of(doc, before)
        doc.recompute()
        doc.UndoMode = 1
        consistent("back from " + what, (first, held))


def test_cancel_of_the_deviations_panel_draws_the_old_limits():
    job, doc, deviation = worked()
    first = picture()
    menu("Deviation")
    type_in("ToleranceLower", "-0.03 mm")
    type_in("ToleranceUpper", "0.03 mm")
    assert not same(picture(), first)
    press("Cancel")
    assert same(picture(), first)
    assert deviation.ToleranceUpper.Value == 0.05


def test_a_macro_sees_what_it_has_set_without_waiting():
    job, doc, deviation = worked()
    shown = picture(wait=False)
    deviation.ViewObject.Visibility = False
    hidden = picture(wait=False)
    deviation.ViewObject.Visibility = True
    assert same(picture(wait=False), shown) and not same(hidden, shown)
    doc.openTransaction("limits")
    job.ToleranceLower, job.ToleranceUpper = -0.03, 0.03
    doc.recompute()
    narrow = picture(wait=False)
    doc.commitTransaction()
    assert not same(narrow, shown)
    doc.undo()
    assert same(picture(wait=False), shown)
    doc.redo()
    assert same(picture(wait=False), narrow)


def test_what_is_not_known_is_grey_and_says_so():
    job, doc, deviation = worked()
    deviation.ViewObject.Scratches = False

    def said(mode):
        deviation.ColourBy = mode
        doc.recompute()
        settle()
        assert len(set(deviation.VertexColors)) == 1, mode
        (legend,) = deviation.ViewObject.Proxy.legends()
        assert not legend.spec.colours
        return [legend.spec.name, legend.spec.title, *(mark.text for mark in legend.spec.marks)]

    for mode in ("measured", "difference"):
        assert said(mode)[-1] == "no scan: compare one"
    assert said("temperature")[-1] == "not computed: the job is without heat"
    assert said("uncertainty")[-1].startswith("not known")
    # A finish of which nothing was measured has scratches, and no Ra.
    job.Finish = json.dumps({"grit": 120})
    beltgrinding.simulate(job)
    assert said("roughness")[:2] == ["Deviation", "roughness Ra"]


def test_the_error_of_the_cells_has_colours_a_legend_and_a_figure():
    job, doc, deviation = worked()
    error = deviation.CellError95.Value
    assert 0.0 < error < 0.1
    deviation.ColourBy = "error of the cells"
    doc.recompute()
    settle()
    assert len(set(deviation.VertexColors)) > 20
    (legend,) = deviation.ViewObject.Proxy.legends()
    assert legend.spec.title == "error of the cells, mm" and legend.spec.colours
    assert error <= float(legend.spec.labels[1.0]) < 6.0 * error
    deviation.ViewObject.Proxy.doubleClicked(deviation.ViewObject)
    settle()
    table = field("statistics")
    assert "Cell error, 95 %" in [table.item(i, 0).text() for i in range(table.rowCount())]
    press("OK")


def test_legends_name_object_quantity_and_unit_and_follow_the_preferences():
    job, doc, deviation = worked()
    ground = doc.GroundPart
    ground.ViewObject.Visibility = True
    settle()

    def specs():
        settle()
        proxies = [getattr(obj.ViewObject, "Proxy", None) for obj in doc.Objects]
        return [legend.spec for one in proxies if one for legend in one.legends()]

    first, second = specs()
    assert (first.name, first.title) == ("Deviation", "deviation, mm")
    assert (second.name, second.title) == ("Ground part", "deviation, mm")
    assert [mark.text for mark in first.marks] == ["scratches"]
    preferences.parameters().SetString("DeviationUnit", "µm")
    take_effect()
    assert [spec.title for spec in specs()] == ["deviation, µm"] * 2
    assert "+50" in specs()[1].labels.values()
    page = PreferencesPage()
    page.loadSettings()
    page.colours["ColourAbove"].show_colour(0x20A040FF)
    page.saveSettings()
    above = [spec.colours[-30] for spec in specs()]
    assert above[0] != first.colours[-30]
    assert above[1] == second.colours[-30]  # as its mesh is
    assert same(picture(), opened_anew(doc))

    # A second job: names say whose.
    copied = doc.copyObject(job, False)
    settle()
    assert {spec.name for spec in specs()} >= {"Belt grinding: Deviation"}
    doc.removeObject(copied.Name)
    assert specs()[0].name == "Deviation"


def test_opening_changes_nothing():
    _, doc, _ = worked()
    doc.saveAs(str(Path("opened.FCStd").absolute()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(Path("opened.FCStd").absolute()))
    settle()
    assert not Gui.getDocument(doc.Name).Modified


def test_the_verdicts_tables_follow_the_unit_of_deviations():
    job, _, _ = worked()
    verdict = beltgrinding.make_verdict(job)
    verdict.ViewObject.Proxy.doubleClicked(verdict.ViewObject)
    settle()
    table = field("regions")

    def worst():
        titles = [table.horizontalHeaderItem(k).text() for k in range(table.columnCount())]
        column = [k for k, title in enumerate(titles) if title.startswith("Worst")][0]
        return titles[column], float(table.item(0, column).text())

    unit, value = worst()
    assert unit == "Worst, mm"
    preferences.parameters().SetString("DeviationUnit", "µm")
    take_effect()
    settle()
    assert worst() == ("Worst, µm", round(1000 * value))


@pytest.mark.slow
def test_a_plans_reasons_have_their_legend_and_go_with_its_panel():
    job, doc, deviation = worked()
    first = picture()
    plan = beltgrinding.make_plan(job, Rounds=1, Check=False)
    settle()
    assert plan.LeftStates
    # One legend, of the reasons: their colours lie over one tone.
    (legend,) = plan.ViewObject.Proxy.legends()
    assert legend.spec.name == "Plan" and len(legend.spec.marks) > 1
    assert not deviation.ViewObject.Proxy.legends() and not same(picture(), first)
    menu("Plan feeds...")
    press("Close")
    assert not plan.ViewObject.Proxy.legends() and same(picture(), first)
    plan.ViewObject.Visibility = True
    assert plan.ViewObject.Proxy.legends()
