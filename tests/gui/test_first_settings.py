"""A new job has values from its part: six clicks from a part to colours, none of them silent or final."""

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui
from pivy import coin

import beltgrinding
from beltgrinding.engine import InputError
from beltgrinding.gui.scene import stock_shell
from beltgrinding.gui.scene.part_context import design_of
from beltgrinding.objects import first_settings, importer, sides
from support.hands import (
    click_at,
    field,
    menu,
    press,
    settle,
    start,
    type_in,
    visible,
    wait,
    window,
)
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def test_six_clicks_from_a_part_to_colours():
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    view.fitAll()
    settle()
    clicks = []

    def click(widget, at=None):
        at = QtCore.QPointF(at or widget.rect().center())
        place = QtCore.QPointF(widget.mapToGlobal(at.toPoint()))
        left, none = QtCore.Qt.LeftButton, QtCore.Qt.NoButton
        for kind, button, held in (
            (QtCore.QEvent.MouseMove, none, none),
            (QtCore.QEvent.MouseButtonPress, left, left),
            (QtCore.QEvent.MouseButtonRelease, left, none),
        ):
            event = QtGui.QMouseEvent(kind, at, place, button, held, QtCore.Qt.NoModifier)
            QtGui.QApplication.sendEvent(widget, event)
        clicks.append(widget)
        settle()

    def choose_entry(text):
        bar = window.menuBar()
        top = next(a for a in bar.actions() if a.text().replace("&", "") == "Belt grinding")
        click(bar, bar.actionGeometry(top).center())
        entries = top.menu()
        action = next(a for a in entries.actions() if a.text().replace("&", "") == text)
        wait(action.isEnabled, 20)
        click(entries, entries.actionGeometry(action).center())

    middle = view.getSize()
    click_at(middle[0] // 2, middle[1] // 2)
    clicks.append("face")
    wait(lambda: Gui.Selection.getSelectionEx(), 10)
    assert Gui.Selection.getSelectionEx()[0].SubElementNames == ("Face6",)
    choose_entry("New job")
    ok = [b for b in visible(QtGui.QPushButton) if b.text().replace("&", "") == "OK"]
    click(ok[0])
    choose_entry("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    assert len(clicks) == 6, clicks
    job = doc.BeltGrindingJob
    assert [o.Label for o in job.Group] == [
        "Stock",
        "Belt machine",
        "Raster",
        "Simulation",
        "Deviation",
    ]
    assert doc.Deviation.ViewObject.Visibility and not part.ViewObject.Visibility
    assert doc.Deviation.InTolerance > 70, doc.Deviation.InTolerance
    assert "in tolerance" in field("state").text(), field("state").text()
    assert (
        doc.Simulation.Proxy.recording(doc.Simulation) is not None
    )  # playback needs no second run
    press("Close")
    doc.undo()  # result and colours are one step
    assert doc.getObject("Simulation") is None and doc.getObject("Deviation") is None
    doc.undo()
    assert [o.Name for o in doc.Objects] == ["Block"]


@pytest.mark.slow
def test_values_come_from_the_part_and_follow_its_faces():
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Ring")
    ring = Part.makeCylinder(17.5, 15).cut(Part.makeCylinder(12, 15))
    part.Shape = ring
    doc.recompute()
    round_faces = {getattr(f.Surface, "Radius", 0): i for i, f in enumerate(ring.Faces, 1)}
    outer, hollow = round_faces[17.5], round_faces[12]
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Ring", f"Face{outer}")
    menu("New job")
    machine = doc.BeltMachine
    assert 10 <= machine.WheelRadius.Value <= 20, machine.WheelRadius  # not 100 mm on a ring of 35
    assert "Chosen from the part" in field("note").text()
    type_in("WheelWidth", "5 mm")
    assert "Changed since" in field("note").text() and "Chosen from" not in field("note").text()
    assert machine.WheelWidth.Value == 5
    # Other faces: what was chosen follows, what was typed stays.
    Gui.Selection.addSelection(doc.Name, "Ring", f"Face{hollow}")
    press("Add selected")
    assert machine.WheelRadius.Value == 10 and machine.WheelWidth.Value == 5
    head = field("foldMachine")
    head.click()
    settle()
    assert not visible(QtGui.QWidget, "WheelRadius") and "R 10" in head.text(), head.text()
    press("OK")
    assert doc.RasterPath.PoseCount > 2


@pytest.mark.slow
def test_first_values_say_what_they_bring_and_offer_a_plan():
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Knob")
    part.Shape = Part.makeSphere(18, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 20, 90)
    doc.recompute()
    dome = next(i for i, f in enumerate(part.Shape.Faces, 1) if hasattr(f.Surface, "Radius"))
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Knob", f"Face{dome}")
    menu("New job")
    share = doc.BeltGrindingJob.Proxy.proposed["in_tolerance"]
    assert 0.0 < share < 0.8, share
    text = f"By a coarse run they bring {100 * share:.0f} % of the area into tolerance."
    assert text in field("note").text() and "Planned feeds bring more" in field("note").text()
    offer = field("planThen")
    assert offer.isVisible() and not offer.isChecked()
    type_in("WheelWidth", "5 mm")  # not what was run
    assert "By a coarse run" not in field("note").text()
    offer.setChecked(True)
    press("OK")
    wait(lambda: doc.getObject("Plan") is not None, 20)
    settle()
    assert visible(QtGui.QPushButton, "plan") and not doc.Plan.Fingerprint  # a person begins it
    press("Close")


@pytest.mark.slow
def test_another_kind_of_machine_gets_values_of_its_own():
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Shell")
    part.Shape = Part.makeCylinder(30, 60, FreeCAD.Vector(), FreeCAD.Vector(0, 1, 0), 120)
    doc.recompute()
    side = next(i for i, f in enumerate(part.Shape.Faces, 1) if hasattr(f.Surface, "Radius"))
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Shell", f"Face{side}")
    menu("New job")
    machine, path = doc.BeltMachine, doc.RasterPath
    radius, travel, cell = (
        getattr(machine, name).Value for name in ("WheelRadius", "ForceTravel", "ContactSpacing")
    )
    along = FreeCAD.Vector(path.Direction)
    box = field("Kind", QtGui.QComboBox)

    def kind(text):
        box.setCurrentIndex(box.findText(text))
        settle()

    assert visible(QtGui.QWidget, "WheelRadius") and not visible(QtGui.QWidget, "RunWidth")
    laid = list(path.Poses)
    kind("Free belt")
    assert list(path.Poses) != laid  # the passes follow at once
    assert visible(QtGui.QWidget, "RunWidth") and not visible(QtGui.QWidget, "WheelRadius")
    # The belt gives way, and runs round the part.
    assert machine.ForceTravel.Value > travel and machine.ContactSpacing.Value > cell
    assert abs(path.Direction.dot(along)) < 0.1 and abs(path.Direction.y) < 0.01
    assert "The belt is taken as it is" in field("note").text(), field("note").text()
    force = machine.Force
    assert abs(force.getValueAs("N") - 38) < 1e-9, force  # 0.75 N for each of 50 mm
    kind("Contact wheel")
    assert (machine.WheelRadius.Value, machine.ForceTravel.Value, machine.ContactSpacing.Value) == (
        radius,
        travel,
        cell,
    )
    assert (
        abs(path.Direction.dot(along)) > 0.99
        and "Chosen from the part: wheel" in field("note").text()
    )
    kind("Platen")
    press("OK")
    assert doc.RasterPath.PoseCount > 2 and machine.Kind == "platen"
    doc.undo()
    assert [o.Name for o in doc.Objects] == ["Shell"]


@pytest.mark.slow
def test_a_large_part_takes_no_millions_of_samples_without_a_word():
    start()
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Panel")
    part.Shape = Part.makeBox(1700, 800, 20)
    doc.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Panel", "Face6")
    menu("New job")
    job = doc.BeltGrindingJob
    assert 1700 * 800 / job.Spacing.Value**2 < 500_000, job.Spacing
    type_in("Spacing", "0.3 mm")
    note = field("note").text()
    assert "15,111,111" in field("sampleCount").text() and "GB" in note, note
    press("Cancel")


def test_faces_on_which_no_pass_can_lie_give_a_job_all_the_same():
    start()

    def refuse(job, text):
        raise InputError(
            "raster.no_pass",
            "no pass is left on the faces; lower min_length_mm, or give another direction",
        )

    patch(first_settings, "propose", refuse)
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face6")
    menu("New job")
    assert "no pass is left" in field("note").text()
    press("OK")
    assert [o.Label for o in doc.BeltGrindingJob.Group] == ["Stock", "Belt machine"]


@pytest.mark.slow
def test_a_program_takes_the_place_of_proposed_passes_whatever_way_it_comes():
    start()
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.set_up(job)
    assert doc.RasterPath.PoseCount > 2
    importer.insert("pass.csv", doc.Name)  # as a dropped file comes; else both would be ground
    assert [o.Label for o in job.Group] == ["Stock", "Belt machine", "pass"]
    view = doc.RobotPath.ViewObject
    view.Proxy.doubleClicked(view)
    settle()
    assert "takes the place" in field("note").text()
    press("OK")
    beltgrinding.make_raster(job)  # asked for: it stays
    beltgrinding.import_program(job, "pass.csv")
    assert len(job.Group) == 5


@pytest.mark.slow
def test_loose_faces_are_flipped_in_the_panel():
    start()
    Gui.activateWorkbench("BeltGrindingWorkbench")
    doc = FreeCAD.newDocument("loose")
    doc.UndoMode = 1
    faces = [face.copy() for face in Part.makeBox(60, 40, 20).Faces]
    faces[5].reverse()  # the top, into the part
    part = doc.addObject("Part::Feature", "Skin")
    part.Shape = Part.Compound(faces)
    doc.recompute()
    Gui.Selection.addSelection(part, "Face6")
    menu("New job")
    job = doc.BeltGrindingJob

    def turned():
        return sides.shape_with_sides(job, design_of(job)[0]).reversed()

    def told():
        return [label.text() for label in visible(QtGui.QLabel) if "⚠" in label.text()]

    def stock_above():
        doc.recompute()
        settle()
        box = coin.SoGetBoundingBoxAction(coin.SbViewportRegion(100, 100))
        node = stock_shell.shell(job, 0.3)
        node.ref()
        box.apply(node)
        found = box.getBoundingBox()  # a temporary would be gone
        low, high = found.getMin().getValue()[2], found.getMax().getValue()[2]
        return high > 20.1 and low > 19.9

    assert any("are turned against the file" in text for text in told()), told()
    assert turned()[5] and stock_above()
    press("Flip side")  # nothing is chosen in the list; the face is selected in the view
    assert job.FlipFaces == [(part, ("Face6",))], job.FlipFaces
    assert field("faces").item(0).text() == "Skin: Face6 (flipped)"
    assert any("are flipped as wanted" in text for text in told()), told()
    assert not turned()[5] and not stock_above()
    assert doc.RasterPath.Path.Commands[-1].Placement.Base.z < 20  # the passes are below, too
    field("faces").item(0).setSelected(True)
    press("Flip side")
    assert job.FlipFaces == [] and field("faces").item(0).text() == "Skin: Face6"
    assert turned()[5] and stock_above()
    press("Cancel")
    assert doc.getObject("BeltGrindingJob") is None

    solid = doc.addObject("Part::Feature", "Solid")
    solid.Shape = Part.makeBox(10, 10, 10)
    doc.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(solid, "Face6")
    menu("New job")
    assert not visible(QtGui.QPushButton, "flipFaces")  # a solid's faces look out of it
    press("Cancel")
