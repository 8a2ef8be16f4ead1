"""The plan's panel: limits, rounds, before and after, the chart, Apply as one undo step, Cancel, programs written."""

import json
from types import SimpleNamespace

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui

import beltgrinding
from support.planning import prepared
from support.hands import (
    field,
    menu,
    picture,
    press,
    settle,
    start,
    type_in,
    visible,
    wait,
    whole_screen,
)

pytestmark = pytest.mark.freecad(window=True)


def mouse(chart, share, kind):
    """Sends a chart an event of the mouse, at a share of its width."""
    at = QtCore.QPointF(int(chart.width() * share), chart.height() // 2)
    left = QtCore.Qt.LeftButton
    event = QtGui.QMouseEvent(kind, at, left, left, QtCore.Qt.NoModifier)
    QtGui.QApplication.sendEvent(chart, event)


@pytest.mark.slow
def test_from_the_limits_to_a_planned_program():
    doc, _, path = prepared()
    steps = doc.UndoCount
    menu("Plan feeds...")
    plan = doc.Plan
    assert doc.UndoCount == steps + 1
    type_in("FeedMax", "120")
    field("foldRounds", QtGui.QToolButton).click()
    settle()
    field("Rounds", QtGui.QSpinBox).setValue(3)
    field("Check", QtGui.QCheckBox).setChecked(False)
    feeds = list(path.Feeds)
    press("Plan")
    assert plan.FeedMax.Value == 120.0 and plan.Rounds == 3
    wait(lambda: plan.Fingerprint, 120)
    settle()
    assert "in tolerance as planned" in field("state").text()
    table = field("figures")
    assert [table.item(row, 0).text() for row in range(5)][0] == "In tolerance"
    assert float(table.item(0, 2).text()[:-2]) > float(table.item(0, 1).text()[:-2]) + 10.0
    assert field("rounds").rowCount() == len(plan.Rates) >= 3
    assert list(path.Feeds) == feeds and max(plan.NewFeeds) <= 120.0 + 1e-9

    write = field("writePrograms", QtGui.QPushButton)
    assert not write.isEnabled() and "no imported program" in write.toolTip()

    chart = field("feedChart")
    moving = next(i for i, fast in enumerate(plan.Rapid) if not fast)
    assert f"pose {moving + 1}" in chart.text(moving) and "→" in chart.text(moving)
    steps = doc.UndoCount
    press("Apply")
    assert list(path.Feeds) == list(plan.NewFeeds) and plan.Applied
    assert doc.UndoCount == steps + 1, (doc.UndoCount, steps)
    assert "programs have these feeds" in field("state").text()
    assert not field("apply", QtGui.QPushButton).isEnabled()
    assert not doc.Simulation.OutOfDate and abs(doc.Deviation.InTolerance - plan.InTolerance) < 1e-6
    press("Close")
    doc.undo()
    doc.recompute()
    assert list(path.Feeds) == feeds and not plan.Applied and not plan.OutOfDate


@pytest.mark.slow
def test_cancel_leaves_all_as_it_was_and_mistakes_are_told():
    doc, _, path = prepared()
    menu("Plan feeds...")
    plan = doc.Plan
    type_in("keep", "nonsense")
    press("Plan")
    assert "nonsense" in field("state").text() and not plan.Fingerprint
    type_in("keep", "1:9000")
    press("Plan")
    wait(lambda: "no motion in poses 9000" in field("state").text(), 30)
    type_in("keep", "1:1-40")
    assert json.loads(plan.Keep) == [{"program": 1, "first_pose": 1, "last_pose": 40}]
    feeds = list(path.Feeds)
    press("Plan")
    settle()
    press("Cancel")
    wait(lambda: "Cancelled" in field("state").text(), 60)
    assert not plan.Fingerprint and list(path.Feeds) == feeds and not hasattr(doc, "Simulation")
    press("Plan")
    wait(lambda: plan.Fingerprint, 180)
    settle()
    assert list(plan.NewFeeds)[:40] == feeds[:40] and list(plan.NewFeeds) != feeds
    assert any("must not be changed" in one for one in plan.Reasons), plan.Reasons

    # Motions chosen in the chart stay, too.
    chart = field("feedChart")
    mouse(chart, 0.5, QtCore.QEvent.MouseButtonPress)
    mouse(chart, 0.7, QtCore.QEvent.MouseMove)
    mouse(chart, 0.7, QtCore.QEvent.MouseButtonRelease)
    settle()
    press("Leave these as they are")
    first, last = chart.chosen
    assert field("keep").text() == f"1:1-40, {first + 1}-{last + 1}", field("keep").text()
    assert plan.OutOfDate and "plan again" in field("state").text()
    press("Close")
    assert not Gui.Control.activeDialog()


def test_a_plan_that_comes_during_a_drag_ends_it():
    from beltgrinding.gui.charts.feed_chart import FeedChart

    def plan_of(count):
        names = ("Along", "OldFeeds", "NewFeeds", "OldForces", "NewForces")
        figures = {name: [float(k) for k in range(count)] for name in names}
        return SimpleNamespace(
            **figures, Rapid=[False] * count, PathOf=[0] * count, Paths=[], Document=None
        )

    chart = FeedChart()
    for count in (3, 0):  # motions of the plan that comes; before, the press was on the 19th of 20
        chart.show_plan(plan_of(20))
        mouse(chart, 0.93, QtCore.QEvent.MouseButtonPress)
        assert chart.begun == 18
        chart.show_plan(plan_of(count))
        mouse(chart, 0.1, QtCore.QEvent.MouseMove)
        assert chart.chosen is None
    chart.deleteLater()


def with_block(height, angle):
    """A document with a block whose first face is round."""
    whole_screen()
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeCylinder(
        80, height, FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1), angle
    )
    doc.recompute()
    return doc


def shown(name):
    return bool(visible(QtGui.QWidget, name))


@pytest.mark.slow
def test_faces_are_ground_from_nothing_by_one_button():
    doc = with_block(30, 40)
    Gui.activeDocument().activeView().viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    Gui.Selection.addSelection(doc.Name, "Block", "Face1")
    settle()
    menu("Grind these faces...")
    plan, path = doc.Plan, doc.RasterPath
    assert plan.LayPasses and path.Proposed
    before = [list(path.Feeds), list(path.Poses)]
    settle()
    assert field("plan").isEnabled() and not plan.Fingerprint, "nothing begins by itself"
    assert plan.SearchSeconds == 120 and not shown("enough")
    field("LayPasses").setChecked(False)
    assert not shown("SearchSeconds")
    field("LayPasses").setChecked(True)
    assert shown("SearchSeconds")
    # What a search tries depends on the machine, and the picture shows it.
    field("SearchSeconds").setValue(0)
    press("Plan")
    assert not shown("enough")
    wait(lambda: plan.Fingerprint, 400)
    settle()
    assert [list(path.Feeds), list(path.Poses)] == before, "nothing is changed before it is applied"
    assert "in tolerance" in field("state").text()
    assert plan.InTolerance > 80.0, (plan.InTolerance, list(plan.Reasons))
    table = field("rounds")
    names = [table.item(row, 0).text() for row in range(table.rowCount())]
    assert names[0].endswith(" mm") and "now" in names, names
    assert "belt at 0 degrees" in table.item(0, 0).toolTip()
    panel = [area for area in visible(QtGui.QScrollArea) if area.isAncestorOf(field("feedChart"))][
        0
    ]
    panel.ensureWidgetVisible(field("feedChart"))
    path.ViewObject.Visibility = False
    picture("workbench-plan")
    steps = doc.UndoCount
    press("Apply")
    assert doc.UndoCount == steps + 1 and plan.Applied and not path.Proposed
    assert list(path.Feeds) == list(plan.NewFeeds)
    assert not doc.Simulation.OutOfDate
    press("Close")
    doc.undo()
    doc.recompute()
    assert [list(path.Feeds), list(path.Poses)] == before and not plan.Applied


@pytest.mark.slow
def test_a_search_can_be_ended_and_tells_what_the_wheel_gets_to():
    doc = with_block(12, 15)
    Gui.Selection.addSelection(doc.Name, "Block", "Face1")
    settle()
    menu("Grind these faces...")
    plan = doc.Plan
    plan.Check = False
    press("Plan")
    press("Take the best so far")
    assert not field("enough").isEnabled()
    wait(lambda: plan.Fingerprint, 110)  # less than the search would take
    settle()
    assert not shown("enough") and "The wheel gets to" in field("reasons").text()
    assert plan.InTolerance > 50.0, (plan.InTolerance, list(plan.Reasons))  # the first passes alone
    press("Close")


@pytest.mark.slow
def test_passes_for_another_force_say_what_to_set_by_hand():
    _, job, path = prepared()
    plan = beltgrinding.make_plan(job, Rounds=1, Check=False)
    for force, told in ((1.3, "1.3 N"), (0.0, ""), (float(job_force(job)), "")):
        plan.Raster = json.dumps({"force_N": force})
        plan.ViewObject.Proxy.doubleClicked(plan.ViewObject)
        settle()
        said = [one.text() for one in visible(QtGui.QLabel) if "by hand" in one.text()]
        assert (told in said[0]) if told else not said, (force, said)
        press("Close")


def job_force(job):
    machine = next(one for one in job.Group if hasattr(one, "BeltSpeed"))
    return machine.Force.getValueAs("N").Value
