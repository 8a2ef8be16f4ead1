"""The robot program's panel: robot, home, plan, the arm on its way, what is refused, what is written; one undo step."""

import json
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from support.planning import prepared
from support.hands import (
    field,
    menu,
    name_file,
    picture,
    press,
    settle,
    type_in,
    visible,
    wait,
    whole_screen,
    widgets,
)

pytestmark = pytest.mark.freecad(window=True)
HOME = "60, -90, 90, 0, 60, 0"


def with_robot():
    """The block, ground by a small robot that holds the wheel."""
    doc, job, path = prepared()
    machine = doc.BeltMachine
    machine.Robot = "kuka_kr6_r900"
    machine.BaseFromRobot.Base = FreeCAD.Vector(-450, 30, -350)
    machine.FlangeFromTcp.Base = FreeCAD.Vector(0, 0, 150)
    path.StepOver = "16 mm"
    doc.recompute()
    return doc, job, machine


def turn_wheel_over(widget):
    """Turns the mouse's wheel over a widget that nobody has clicked into."""
    at = QtCore.QPointF(widget.rect().center())
    event = QtGui.QWheelEvent(
        at, QtCore.QPointF(widget.mapToGlobal(at.toPoint())), QtCore.QPoint(0, 0),
        QtCore.QPoint(0, -120), QtCore.Qt.NoButton, QtCore.Qt.NoModifier, QtCore.Qt.NoScrollPhase, False,
    )  # fmt: skip
    QtGui.QApplication.sendEvent(widget, event)
    settle()


def test_mistakes_are_told_in_one_line_and_leave_nothing():
    doc, job, machine = with_robot()
    count = len(doc.Objects)
    menu("Robot program...")
    assert doc.RobotProgram.getParentGroup() is job and "Refused" in doc.RobotProgram.PropertiesList
    robot = field("robot", QtGui.QComboBox)
    turn_wheel_over(robot)
    assert machine.Robot == "kuka_kr6_r900"
    assert field("externalAxes").text() == "No external axes."
    type_in("homeJoints", "1, 2, 3")
    press("Plan")
    assert "six joint angles" in field("state").text() and "1, 2, 3" in field("state").text()
    assert not visible(QtGui.QPushButton, "writeRobot")
    press("Take from view")  # of the wheel at the first pose
    angles = [float(one) for one in field("homeJoints").text().split(",")]
    assert json.loads(machine.RobotProgram)["home_joints_deg"] == angles and len(angles) == 6
    press("Close")
    assert len(doc.Objects) == count + 1  # home was set, so it stays
    doc.undo()
    doc.undo()
    assert len(doc.Objects) == count and "deg" not in machine.RobotProgram


@pytest.mark.slow
def test_from_home_to_a_written_program(tmp_path):
    whole_screen()
    doc, job, machine = with_robot()
    machine.Controller = "krc4"
    doc.recompute()
    menu("Robot program...")
    type_in("homeJoints", HOME)
    steps = doc.UndoCount
    press("Plan")
    press("Cancel")
    wait(lambda: "Cancelled" in field("state").text(), 60)
    program = doc.RobotProgram
    assert not program.Fingerprint
    press("Plan")
    wait(lambda: program.Fingerprint, 120)
    settle()
    assert "from home to home" in field("state").text() and not program.Refused
    assert program.Passes == 3 and not program.OutOfDate

    # The arm walks through it; chart and slider go together.
    way = program.Proxy.walk(program)
    slider, chart = field("poseSlider", QtGui.QSlider), field("jointChart")
    assert slider.maximum() == len(way.times) and [row.name for row in chart.rows] == [
        f"J{k}" for k in range(1, 7)
    ]
    middle = len(way.times) // 2
    slider.setValue(middle + 1)
    assert chart.place == middle
    at = QtCore.QPointF(chart.x(way.times[-1]), chart.height() // 2)
    left = QtCore.Qt.LeftButton
    press_there = QtGui.QMouseEvent(
        QtCore.QEvent.MouseButtonPress, at, left, left, QtCore.Qt.NoModifier
    )
    QtGui.QApplication.sendEvent(chart, press_there)
    assert slider.value() == len(way.times)
    assert way.joints_deg[-1] == pytest.approx([60, -90, 90, 0, 60, 0])
    slider.setValue(middle + 1)
    Gui.SendMsgToActiveView("ViewFit")
    picture("workbench-robot-program")

    file = tmp_path / "whole.src"
    name_file(file, "KUKA KRL (*.src)")
    press("Write...")
    assert "Written" in field("state").text(), field("state").text()
    assert file.read_text().count("PTP {A1") >= 4 and "#BASE," not in file.read_text()
    field("foldRobot", QtGui.QToolButton).click()
    settle()
    type_in("programBase", "5")  # what is planned stays as it is
    assert json.loads(machine.RobotProgram)["base"] == "5" and not program.OutOfDate
    press("Write...")
    text = file.read_text()
    assert "#BASE,5" in text
    type_in("programBase", "a table")
    press("Write...")
    assert "'a table' is no base of a controller" in field("state").text()
    assert file.read_text() == text
    type_in("programBase", "")
    assert "base" not in json.loads(machine.RobotProgram)
    press("Close")
    doc.undo()  # of the base
    assert doc.RobotProgram.Fingerprint
    doc.undo()
    assert doc.getObject("RobotProgram") is not None and not doc.RobotProgram.Fingerprint
    doc.redo()
    assert doc.RobotProgram.Fingerprint and not [
        w for w in widgets(QtGui.QWidget, "jointChart") if w.isVisible()
    ]


@pytest.mark.slow
def test_what_must_not_run_is_refused_with_its_place(tmp_path):
    doc, job, machine = with_robot()
    machine.RobotProgram = json.dumps({"home_joints_deg": [60, -90, 90, 0, 60, 0]})
    machine.BaseFromRobot.Base = FreeCAD.Vector(-830, 30, -350)  # the far end is out of reach
    doc.recompute()
    menu("Robot program...")
    press("Plan")
    program = doc.RobotProgram
    wait(lambda: program.Fingerprint, 120)
    settle()
    assert program.Refused and "Not to be run" in field("state").text()
    table = field("events", QtGui.QTableWidget)
    assert table.rowCount() >= 1
    table.selectRow(0)
    settle()
    assert (
        field("poseSlider", QtGui.QSlider).value() == program.Proxy.events(program)[0]["pose"] + 1
    )
    file = tmp_path / "unsafe.src"
    name_file(file, "KUKA KRL (*.src)")
    press("Write...")
    assert "is not written" in field("state").text() and "out of" in field("state").text()
    assert not file.exists()
    field("unsafe", QtGui.QCheckBox).setChecked(True)
    press("Write...")
    assert "UNSAFE" in file.read_text()
    field("foldRobot", QtGui.QToolButton).click()
    settle()
    type_in("homeJoints", HOME.replace("60,", "50,", 1))
    assert program.OutOfDate and not field("writeRobot", QtGui.QPushButton).isEnabled()
    press("Close")
