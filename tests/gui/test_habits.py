"""Habits of FreeCAD: a short menu with shortcuts, help on commands, reasons why one is greyed, an active job."""

import re
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.gui.commands import MENU
from beltgrinding.gui.common import help_pages
from beltgrinding.gui.common.chosen import active_job
from beltgrinding.gui.common.icons import pale_icon
from beltgrinding.gui.common.messages import error_text
from beltgrinding.gui.preferences_page import PreferencesPage
from beltgrinding.objects.belt_machine import KEYS
from beltgrinding.objects.properties import check_limits
from support.hands import (
    choose,
    click_at,
    entries,
    field,
    menu,
    name_file,
    prepare,
    press,
    settle,
    start,
    type_in,
    wait,
    widgets,
    window,
)

pytestmark = pytest.mark.freecad(window=True)


def bar():
    """The entry of the workbench in the menu bar."""
    return next(
        a for a in window.menuBar().actions() if a.text().replace("&", "") == "Belt grinding"
    )


def looked_at():
    """Lets FreeCAD look whether commands are ready."""
    QtCore.QMetaObject.invokeMethod(window, "_updateActions")
    settle()


def action_of(text):
    entry = bar()  # held: with it, PySide takes its menu for deleted
    return next(a for a in entries(entry) if a.text().replace("&", "") == text)


def results():
    """The submenu of results."""
    return next(m for m in window.menuBar().findChildren(QtGui.QMenu) if m.title() == "Results")


def test_the_menu_is_short_and_every_command_has_a_shortcut_of_its_own():
    start()
    entry = bar()
    top = [a for a in entry.menu().actions() if not a.isSeparator()]
    assert 10 <= len(top) <= 15, [a.text() for a in top]
    keys = {}
    for name in (command.name for _, group in MENU for command in group):
        (action,) = Gui.Command.get(name).getAction()[:1]
        text = action.shortcut().toString()
        assert text.startswith("G, "), (name, text)
        assert keys.setdefault(text, name) == name
    assert len(keys) > 30
    # None is one that FreeCAD's own commands have, or the begin of it.
    for action in window.findChildren(QtGui.QAction):
        other = action.shortcut().toString()
        if other and not action.whatsThis().startswith("BeltGrinding"):
            assert other != "G" and other not in keys, (action.text(), other)


def test_each_command_has_a_page():
    names = {command.name for _, group in MENU for command in group}
    assert {name.removeprefix("BeltGrinding_") for name in names} <= set(help_pages.PAGES)


def shown_page():
    settle()
    views = [v for v in widgets(QtGui.QTextBrowser, "BeltGrinding_ManualView") if v.isVisible()]
    page = views[0].source().fileName() if views else ""
    for view in views:
        view.window().close()
    return page


def test_f1_on_an_entry_and_whats_this_on_a_button_open_the_page():
    beltgrinding.simulate(prepare())
    looked_at()
    submenu = results()
    submenu.popup(QtCore.QPoint(10, 10))
    submenu.setActiveAction(next(a for a in submenu.actions() if a.text() == "Cross-section"))
    event = QtGui.QKeyEvent(QtCore.QEvent.KeyPress, QtCore.Qt.Key_F1, QtCore.Qt.NoModifier)
    QtGui.QApplication.sendEvent(submenu, event)
    assert shown_page() == "section.md" and not submenu.isVisible()

    button = next(
        b
        for b in widgets(QtGui.QToolButton)
        if b.defaultAction() is not None and b.defaultAction().whatsThis() == "BeltGrinding_Verdict"
    )
    QtGui.QWhatsThis.enterWhatsThisMode()
    at = button.rect().center()
    asked = QtGui.QHelpEvent(QtCore.QEvent.WhatsThis, at, button.mapToGlobal(at))
    QtGui.QApplication.sendEvent(button, asked)
    assert shown_page() == "verification.md" and not QtGui.QWhatsThis.inWhatsThisMode()


def test_a_greyed_command_says_why():
    start()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    settle()
    looked_at()
    verdict = action_of("Verdict")
    plain = verdict.toolTip().split("<p><b>")[0]
    assert not verdict.isEnabled() and "No document is open" in verdict.toolTip()
    job = prepare()
    looked_at()
    assert not verdict.isEnabled() and "The job has no result yet" in verdict.toolTip()
    assert verdict.statusTip() == "The job has no result yet: press Simulate."
    stock = action_of("Stock")
    assert stock.isEnabled() and "<p><b>" not in stock.toolTip()
    menu("Stock")
    looked_at()
    assert not stock.isEnabled() and "A task panel is open" in stock.toolTip()
    press("Cancel")
    looked_at()
    assert stock.isEnabled() and "<p><b>" not in stock.toolTip()
    beltgrinding.simulate(job)
    looked_at()
    assert verdict.isEnabled() and verdict.toolTip() == plain
    # The entry shows its tooltip, too.
    entry = bar()
    assert results().toolTipsVisible() and entry.menu().toolTipsVisible()


def test_of_several_jobs_one_is_active_and_marked():
    job = prepare()
    doc = job.Document
    view = Gui.ActiveDocument.mdiViewsOfType("Gui::View3DInventor")[0]
    other = beltgrinding.make_job(doc.Block, ["Face5"])
    Gui.Selection.clearSelection()
    looked_at()
    stock = action_of("Stock")
    assert active_job() is None and "several jobs" in stock.toolTip()
    Gui.Selection.addSelection(other)
    menu("Stock")
    press("Cancel")
    Gui.Selection.clearSelection()
    assert active_job() == other and view.getActiveObject("beltgrindingjob") == other
    job.ViewObject.Proxy.setupContextMenu(job.ViewObject, entered := QtGui.QMenu())
    next(a for a in entered.actions() if a.text() == "Make active").trigger()
    assert active_job() == job and view.getActiveObject("beltgrindingjob") == job
    looked_at()
    assert stock.isEnabled()
    doc.removeObject(job.Name)
    assert active_job() == other  # the only one


def test_preferences_say_at_the_field_what_is_wrong():
    page = PreferencesPage()
    page.loadSettings()
    page.form.show()
    settle()
    lower, upper = (page.defaults[f"DefaultTolerance{end}"] for end in ("Lower", "Upper"))
    assert not page.wrong.isVisible() and not lower.styleSheet()
    stored = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/BeltGrinding")
    before = stored.GetFloat("DefaultToleranceLower", -1.0)
    type_in("DefaultToleranceLower", "3 mm")
    assert page.wrong.isVisible() and "above the upper limit" in page.wrong.text()
    assert lower.styleSheet() and upper.styleSheet() and "above" in lower.toolTip()
    page.saveSettings()
    assert stored.GetFloat("DefaultToleranceLower", -1.0) == before
    type_in("DefaultToleranceLower", "-0.04 mm")
    assert not page.wrong.isVisible() and not upper.styleSheet() and not lower.toolTip()
    page.form.close()


def test_a_double_click_on_the_legend_opens_what_it_is_of():
    job = prepare()
    beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    job.Document.Block.ViewObject.Visibility = False
    settle()
    Gui.ActiveDocument.ActiveView.redraw()
    settle()
    left, bottom, right, top = deviation.ViewObject.Proxy.drawn.box
    click_at(left + 5, bottom + 5)
    wait(lambda: True)
    assert not Gui.Control.activeDialog()
    wait(lambda: True)
    QtCore.QThread.msleep(QtGui.QApplication.doubleClickInterval() + 50)
    click_at((left + right) / 2, (bottom + top) / 2)
    click_at((left + right) / 2, (bottom + top) / 2)
    settle()
    assert Gui.Control.activeDialog() and field("Bounds").isVisible()
    press("Cancel")
    # Beside it nothing happens.
    click_at(left - 40 if left > 60 else right + 40, bottom + 5)
    click_at(left - 40 if left > 60 else right + 40, bottom + 5)
    settle()
    assert not Gui.Control.activeDialog()


def test_what_is_dropped_onto_a_job():
    job = prepare()
    doc = job.Document
    beltgrinding.simulate(job)
    ground = beltgrinding.make_ground_mesh(job)
    scan = doc.addObject("Mesh::Feature", "Measured")
    scan.Mesh = ground.Mesh.copy()
    doc.removeObject(ground.Name)
    box = doc.addObject("Part::Box", "Fixture")
    doc.recompute()
    assert job.ViewObject.canDropObject(scan)
    job.ViewObject.dropObject(box)
    assert box in job.Group
    job.ViewObject.dropObject(scan)
    settle()
    assert scan not in job.Group and field("scanSource").currentText() == "Measured"
    assert not field("scan").isEnabled() and not field("unit").isEnabled()
    press("Compare")
    wait(lambda: field("compare").isEnabled())
    assert doc.Simulation.ScanFile == "Measured"
    assert abs(doc.Simulation.DifferenceMean.Value) < 0.01
    press("OK")
    assert doc.Simulation.ScanFile == "Measured"
    doc.undo()
    assert not getattr(doc.Simulation, "ScanFile", "")


def test_a_template_gives_another_job_its_machine_and_tolerance():
    job = prepare()
    job.ToleranceUpper = "0.07 mm"
    job.LawCoefficient = 0.0004
    job.Document.recompute()
    name_file(Path("own.json").absolute())
    menu("Save as template...")
    text = Path("own.json").read_text()
    assert '"template": 1' in text and "brep" not in text and "programs" not in text
    doc = FreeCAD.newDocument("other")
    doc.UndoMode = 1
    part = doc.addObject("Part::Box", "Box")
    doc.recompute()
    other = beltgrinding.make_job(part, ["Face6"])
    beltgrinding.make_stock(other, Allowance="0.1 mm")
    doc.clearUndos()
    Gui.Selection.clearSelection()
    choose(Path("own.json").absolute())
    menu("Apply template...")
    assert doc.UndoCount == 1
    assert other.ToleranceUpper.Value == 0.07 and other.LawCoefficient == 0.0004
    assert doc.BeltMachine.WheelRadius.Value == 60 and doc.BeltMachine.Force.getValueAs("N") == 30
    assert doc.Stock.Allowance.Value == pytest.approx(0.2)
    doc.undo()
    assert other.ToleranceUpper.Value != 0.07 and doc.getObject("BeltMachine") is None
    # What is none says so, and changes nothing.
    for wrong in (
        '{"template": 1, "programs": []}',
        '{"law": {}}',
        "[1]",
        '{"template": 1, "law": {"model": "?"}}',
    ):
        Path("wrong.json").write_text(wrong)
        with pytest.raises(beltgrinding.InputError, match="wrong.json"):
            beltgrinding.apply_template(other, "wrong.json")
    assert other.LawCoefficient != 0.0004


def test_a_program_is_left_out_of_a_run():
    job = prepare()
    doc = job.Document
    Path("second.csv").write_text(re.sub(r",20,20\.2", ",30,20.2", Path("pass.csv").read_text()))
    second = beltgrinding.import_program(job, "second.csv")
    doc.recompute()
    simulation = beltgrinding.simulate(job)
    both = simulation.RemovedVolume.Value
    assert list(simulation.Programs) == ["pass", "second"] and not simulation.OutOfDate
    doc.clearUndos()
    settle()
    Gui.Selection.clearSelection()
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    assert field(f"active{second.Name}").isChecked()
    field(f"active{second.Name}").click()
    press("OK")
    assert not second.Active and simulation.OutOfDate
    doc.undo()
    assert second.Active
    doc.recompute()
    assert not simulation.OutOfDate
    shown, whole = second.ViewObject.Proxy.ICON, second.ViewObject.Icon

    def pixels(of):
        image = of.pixmap(32, 32).toImage()
        return [image.pixel(x, y) for x in range(32) for y in range(32)]

    second.ViewObject.Proxy.setupContextMenu(second.ViewObject, entered := QtGui.QMenu())
    next(a for a in entered.actions() if a.text() == "Leave out of runs").trigger()
    settle()
    assert not second.Active and pixels(second.ViewObject.Icon) == pixels(pale_icon(shown))
    assert pixels(pale_icon(shown)) != pixels(whole)
    assert simulation.OutOfDate
    beltgrinding.simulate(job)
    assert list(simulation.Programs) == ["pass"] and simulation.RemovedVolume.Value < 0.7 * both
    second.ViewObject.Proxy.setupContextMenu(second.ViewObject, entered := QtGui.QMenu())
    next(a for a in entered.actions() if a.text() == "Take into runs").trigger()
    assert second.Active
    doc.undo()
    assert not second.Active
    data = beltgrinding.export_job(job, "one.json").read_text()
    assert '"pass"' in data and '"second"' not in data


def test_a_plan_that_lacks_something_leaves_nothing_behind():
    job = prepare()
    doc = job.Document
    doc.RobotPath.Active = False
    doc.recompute()
    doc.clearUndos()
    settle()
    menu("Plan feeds...")
    field("plan", QtGui.QPushButton).click()
    settle()
    assert "left out" in field("state").text()
    press("Close")
    assert [obj for obj in doc.Objects if obj.Name.startswith("Plan")] == []
    assert doc.UndoCount == 0


def test_a_message_of_limits_names_the_field():
    job = prepare()
    machine = job.Document.BeltMachine
    machine.WheelRadius = 0.0
    with pytest.raises(beltgrinding.InputError) as told:
        check_limits(machine, KEYS)
    assert "WheelRadius is 0" in str(told.value)  # as a macro has it
    text = error_text(told.value)
    assert "“Belt machine: Wheel radius”" in text, text
    assert "WheelRadius" not in text and "radius_mm" not in text, text


@pytest.mark.parametrize("opened", ["double click", "menu", "plan"])
def test_cancel_takes_back_no_more_than_its_panel_did(opened):
    """Also where a document was closed within an undo step, which FreeCAD keeps open for the next one."""
    FreeCAD.newDocument("Closed").openTransaction("left over")
    FreeCAD.closeDocument("Closed")
    assert FreeCAD.getActiveTransaction()
    start()
    job = beltgrinding.open_example(Path.cwd() / "example")
    machine = job.Document.BeltMachine
    plan = beltgrinding.make_plan(job, compute=False)
    names = [obj.Name for obj in job.Document.Objects]
    if opened == "plan":
        plan.ViewObject.Proxy.doubleClicked(plan.ViewObject)
        press("Close")
        assert [obj.Name for obj in job.Document.Objects] == names
        return
    if opened == "menu":
        menu("Belt machine")
    else:
        machine.ViewObject.Proxy.doubleClicked(machine.ViewObject)
    type_in("Force", "36 N")
    press("Cancel")
    assert [obj.Name for obj in job.Document.Objects] == names
    assert machine.Force.getValueAs("N") == 30
