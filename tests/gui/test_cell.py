"""The cell and the poses of a program, by hand: slider, table, source, a click in the view, bodies."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
import Path as Cam
from PySide import QtGui

from beltgrinding.gui.widgets import pose_walk
from beltgrinding.programs import read_program
from support.hands import click_at, field, menu, prepare, press, screenshot, settle, visible, wait
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc, part, machine = job.Document, job.Document.Block, job.Document.BeltMachine
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    view.fitAll()
    settle()
    path = doc.RobotPath
    return SimpleNamespace(doc=doc, job=job, machine=machine, path=path, view=view)


def test_a_pose_is_the_same_in_view_table_source_and_slider():
    here = prepared()
    path, view = here.path, here.view
    path.ViewObject.Proxy.doubleClicked(path.ViewObject)
    settle()
    table, source = field("poses"), field("poseTabs").findChild(QtGui.QPlainTextEdit, "source")
    assert table.model().rowCount() == 9

    field("poseNumber").setValue(4)
    assert table.currentIndex().row() == 3
    assert source.textCursor().blockNumber() + 1 == path.Lines[3] == 5

    table.setCurrentIndex(table.model().index(6, 0))
    assert field("poseNumber").value() == 7
    assert source.textCursor().blockNumber() + 1 == path.Lines[6]

    cursor = source.textCursor()
    cursor.setPosition(source.document().findBlockByNumber(path.Lines[1] - 1).position())
    source.setTextCursor(cursor)
    assert field("poseNumber").value() == 2 and table.currentIndex().row() == 1

    # The poses lie at x = 10, 15, ... 50; y = 20; seen from above.
    place = view.getPointOnScreen(FreeCAD.Vector(30, 20, 20.2))
    click_at(*place)
    assert field("poseNumber").value() == 5, field("poseNumber").value()
    click_at(3, 3)  # nothing is there
    assert field("poseNumber").value() == 5
    nodes = view.getSceneGraph().getNumChildren()
    press("OK")
    assert view.getSceneGraph().getNumChildren() == nodes - 2  # the wheel is gone


def test_the_cell_is_set_up_with_the_wheel_in_view():
    here = prepared()
    doc, machine, path = here.doc, here.machine, here.path
    walks, init = [], pose_walk.PoseWalk.__init__

    def watched(self, *arguments):
        init(self, *arguments)
        walks.append(self)

    patch(pose_walk.PoseWalk, "__init__", watched)

    gripper = doc.addObject("Part::Box", "Gripper")
    gripper.Placement.Base = (0, 0, -50)
    doc.recompute()
    menu("Cell")
    walk = walks[-1].view
    field("poseNumber").setValue(5)
    wheel = walk.frames()["contact"]
    assert np.allclose(wheel[:3, 3], [30, 20, 20.2]) and np.allclose(wheel[:3, 2], [0, 0, -1])
    assert not field("cellMoves").isEnabled()  # tool in hand: the wheel moves anyway

    frame = field("BaseFromWork")
    line = [w for w in frame.findChildren(QtGui.QWidget, "X")][0]
    line.setFocus()
    line.selectAll()
    line.insert("10 mm")
    line.editingFinished.emit()
    settle()
    assert machine.BaseFromWork.Base.x == 10
    assert np.allclose(walk.frames()["contact"][:3, 3], [20, 20, 20.2])
    wait(lambda: abs(path.Path.Commands[0].Placement.Base.x) < 1e-6)  # the drawn path follows

    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Gripper")
    field("bodyFrame").setCurrentIndex(1)
    press("Add selected")
    assert machine.BodiesInTool == [gripper] and field("bodies").count() == 1
    field("bodyFrame").setCurrentIndex(0)
    press("Add selected")  # a body is in one frame
    assert machine.BodiesInTool == [] and machine.BodiesInBase == [gripper]

    field("Holding").setCurrentIndex(1)
    field("cellMoves").setChecked(True)
    field("poseNumber").setValue(1)
    assert np.allclose(walk.carried(walk.frames()), np.eye(4))
    start = walk.carried(walk.frames()) @ walk.frames()["contact"]
    field("poseNumber").setValue(6)
    moved = walk.carried(walk.frames())
    assert np.linalg.norm(moved[:3, 3]) > 20  # the part goes through the cell
    assert np.allclose(moved @ walk.frames()["contact"], start)  # the wheel stands still
    press("Cancel")
    assert machine.Holding == "tool_in_hand" and machine.BodiesInBase == []
    assert machine.BaseFromWork.Base.x == 0


def test_a_cam_path_is_followed():
    here = prepared()
    doc, job = here.doc, here.job
    milling = doc.addObject("Path::Feature", "Contour")
    milling.Path = Cam.Path(
        [
            Cam.Command("G0", {"X": 10, "Y": 10, "Z": 30}),
            Cam.Command("G1", {"Z": 20.2, "F": 20}),
            Cam.Command("G1", {"X": 50, "F": 40}),
        ]
    )
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Contour")
    menu("Follow selected path")
    press("OK")
    made = [o for o in job.Group if o.Label == "Contour ground"][0]
    assert made.PoseCount == 3 and list(made.Feeds)[1:] == [20, 40]
    doc.undo()
    assert not [o for o in doc.Objects if o.Label == "Contour ground"]


@pytest.mark.slow
def test_the_robot_is_chosen_drawn_and_followed():
    here = prepared()
    job, machine = here.job, here.machine
    walks, init = [], pose_walk.PoseWalk.__init__

    def watched(self, *arguments):
        init(self, *arguments)
        walks.append(self)

    patch(pose_walk.PoseWalk, "__init__", watched)

    machine.BaseFromRobot.Base = (-500, 20, -300)
    menu("Cell")
    robot = walks[-1].view.robot
    assert robot.root.whichChild.getValue() == -1  # none is drawn
    box = field("robot")
    assert box.isEnabled()
    box.setCurrentIndex(box.findText("ABB IRB 1200-5/0.9"))
    settle()
    assert machine.Robot == "abb_irb1200_5_90" and robot.root.whichChild.getValue() == -3
    field("poseNumber").setValue(5)
    assert "Joints:" in field("joints").text()
    # Forward kinematics at the angles that are shown put the tool at the pose.
    flange = robot.arm.forward(robot.joints)
    base = np.array(machine.BaseFromRobot.toMatrix().A).reshape(4, 4)
    assert np.allclose(base @ flange, walks[-1].view.poses[4], atol=1e-6)

    def told():
        press("Check the whole program")
        assert field("taskBar").isVisible() and field("taskCancel").isEnabled()
        wait(lambda: field("checkReach").isEnabled())
        rows = field("reachEvents")
        return [rows.item(i).text() for i in range(rows.count())]

    # The tool has no length: the flange is in the part.
    assert any("Collision: part and robot link 6" in line for line in told()), told()
    machine.FlangeFromTcp = FreeCAD.Placement(FreeCAD.Vector(0, 0, 250), FreeCAD.Rotation())
    machine.BaseFromRobot.Base = (-500, 20, -200)
    lines = told()
    assert "follows the whole program" in lines[0] and "Nearest to the arm" in lines[1], lines
    assert len(robot.followed) == 9
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    screenshot("robot.png")
    machine.BaseFromRobot.Base = (-20, 20, -100)  # the foot stands in the part
    lines = told()
    assert any("Collision: part and robot foot" in line for line in lines), lines
    machine.CheckCollisions = False
    lines = told()
    assert "was not looked at" in lines[-1] and not any(
        "robot foot" in line for line in lines
    ), lines
    machine.CheckCollisions = True
    machine.FlangeFromTcp = FreeCAD.Placement()

    line = [w for w in field("BaseFromRobot").findChildren(QtGui.QWidget, "X")][0]
    line.setFocus()
    line.selectAll()
    line.insert("-1500 mm")
    line.editingFinished.emit()
    settle()
    assert "Out of reach" in field("joints").text() and robot.root.whichChild.getValue() == -1
    press("Check the whole program")
    wait(lambda: field("checkReach").isEnabled())
    assert "Out of reach" in field("reachEvents").item(0).text()
    press("OK")
    assert machine.BaseFromRobot.Base.x == -1500
    simulation = __import__("beltgrinding").simulate(job)
    assert any(e["kind"] == "out_of_reach" for e in simulation.Proxy.events(simulation))


def test_a_path_is_exported_as_a_robot_program():
    here = prepared()
    doc, machine, path = here.doc, here.machine, here.path
    path.FeedOverride = "20 mm/s"
    doc.recompute()
    asked = []

    def answer(*arguments, **keywords):
        asked.append(arguments)
        return "out", "ABB RAPID (*.mod)"

    patch(QtGui.QFileDialog, "getSaveFileName", staticmethod(answer))
    menu("Export robot program...")
    assert asked and Path("out.mod").exists()
    program = read_program("out.mod")
    assert program.language == "ABB RAPID"
    # What the program takes for granted is said, and nothing is set to zero.
    (box,) = visible(QtGui.QMessageBox, "BeltGrinding_Note")
    assert (
        "tBelt" in box.text() and "wPart" in box.text() and "Program Base" in box.text()
    ), box.text()
    assert "PERS" not in Path("out.mod").read_text()
    told = [problem.arguments["reason"] for problem in program.problems]
    assert len(told) == 2 and "tBelt" in told[0] and "wPart" in told[1], program.problems
    poses = np.array([m.pose for m in program.motions])
    assert np.allclose(poses, path.Proxy.arrays(path)["frames"], atol=1e-6)
    assert [m.speed_mm_s for m in program.motions][1:] == [20] * 8

    def close_boxes():
        for box in visible(QtGui.QMessageBox):
            box.close()
            box.deleteLater()
        settle()

    close_boxes()
    yes = []

    def agree(*arguments):
        yes.append(arguments)
        return QtGui.QMessageBox.Yes

    patch(QtGui.QMessageBox, "question", staticmethod(agree))

    # Frames of the controller by name; the cell's numbers where it has a robot.
    path.ProgramBase, path.ProgramTool = "wBlade", " tWheel "
    menu("Export robot program...")
    assert "tWheel\\WObj:=wBlade;" in Path("out.mod").read_text()
    assert len(yes) == 1  # "out" was typed, out.mod is there
    close_boxes()
    machine.Robot = "kuka_kr16_2"
    machine.FlangeFromTcp = FreeCAD.Placement(FreeCAD.Vector(0, 0, 150.25), FreeCAD.Rotation())
    path.ProgramBase = path.ProgramTool = "as-known"
    menu("Export robot program...")
    assert not visible(QtGui.QMessageBox), [b.text() for b in visible(QtGui.QMessageBox)]
    text = Path("out.mod").read_text()
    assert text.count("PERS ") == 2 and "[0.000000,0.000000,150.250000]" in text
    path.ProgramTool = ""
    menu("Export robot program...")
    text = Path("out.mod").read_text()
    assert "tBelt" in text and "!   [[0.000000,0.000000,150.250000]" in text
