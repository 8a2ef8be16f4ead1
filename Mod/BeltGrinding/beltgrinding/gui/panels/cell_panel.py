"""Task panel of the cell: who holds what, the frames, the bodies; shown live at any pose."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui
import numpy as np

from ...base.kinds import known
from ...objects.belt_machine import BODIES
from ...objects.job_data import children
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...objects.robot_path import RobotPath
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Widget
from ..widgets.form import Form
from ..widgets.pose_walk import PoseWalk
from .panel import Panel
from .robot_box import RobotBox
from ..widgets.steady import steady

WAIT = 200  # ms after the last change of a frame; long paths take a while to draw


class CellPanel(Panel):
    """Edits the cell of a BeltMachine."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(obj, translate("BeltGrinding", "Cell"), "BeltGrinding_Cell")
        job = obj.getParentGroup()
        paths = [p for p in (children(job, RobotPath) if job else []) if p.Poses]
        self.walk = PoseWalk(obj.Document, obj, paths) if paths else None
        self.drawn = QtCore.QTimer()
        self.drawn.setSingleShot(True)
        self.drawn.timeout.connect(self.draw_paths)
        if self.walk:
            box = QtGui.QGroupBox(translate("BeltGrinding", "At a pose of the program"))
            QtGui.QVBoxLayout(box).addWidget(self.walk)
            self.body.addWidget(box)
        cell = self.cell = Form(obj, translate("BeltGrinding", "Frames"))
        holding = {
            "tool_in_hand": translate("BeltGrinding", "Tool in hand"),
            "part_in_hand": translate("BeltGrinding", "Part in hand"),
        }
        cell.layout_.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        cell.add("Holding", translate("BeltGrinding", "Robot holds"), holding)
        cell.add("BaseFromWork", translate("BeltGrinding", "Part in base"))
        cell.add("TcpFromContact", translate("BeltGrinding", "Contact in tool"))
        cell.add("TcpFromWork", translate("BeltGrinding", "Part in tool"))
        cell.add("BaseFromContact", translate("BeltGrinding", "Contact in base"))
        cell.changed = self.arrange
        self.body.addWidget(cell)
        if self.walk:
            self.body.addWidget(self._robot(self.walk))
        self.body.addWidget(self._bodies())
        self.finish()
        self.arrange()

    def _robot(self, walk: PoseWalk) -> RobotBox:
        self.robot = RobotBox(self.obj, walk.path)
        self.robot.changed = self.redraw
        self.robot.go = walk.go
        self.robot.found = self.followed
        walk.moved = lambda _: self.show_joints()
        return self.robot

    def followed(self, result: Any) -> None:
        """The whole path was followed: the arm is drawn as it goes along it."""
        view = known(self.walk).view
        view.robot.followed = result["joints"]
        view.update()
        self.show_joints()

    def show_joints(self) -> None:
        joints = known(self.walk).view.robot.joints
        self.robot.show_joints(None if joints is None else np.degrees(joints).tolist())

    def _bodies(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "Bodies"))
        box.setToolTip(
            translate(
                "BeltGrinding",
                "Housing, gripper, fixtures: their coordinates are taken in the chosen frame",
            )
        )
        layout = QtGui.QVBoxLayout(box)
        layout.setContentsMargins(4, 4, 4, 4)
        self.frame = steady(QtGui.QComboBox())
        self.frame.setObjectName("bodyFrame")
        for text in (
            translate("BeltGrinding", "Stand still, in the base frame"),
            translate("BeltGrinding", "In the robot's hand, in the tool frame"),
            translate("BeltGrinding", "At the wheel, in the contact frame"),
            translate("BeltGrinding", "At the part, as they are drawn"),
        ):
            self.frame.addItem(text)
        self.frame.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.list = QtGui.QListWidget()
        self.list.setObjectName("bodies")
        self.list.setMaximumHeight(80)
        row = QtGui.QHBoxLayout()
        for name, text, action in (
            ("addBodies", translate("BeltGrinding", "Add selected"), self.add_selected),
            ("removeBody", translate("BeltGrinding", "Remove"), self.remove),
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.clicked.connect(action)
            row.addWidget(button)
        for widget in (self.frame, self.list):
            layout.addWidget(widget)
        layout.addLayout(row)
        form = Form(self.obj, translate("BeltGrinding", "Collisions"))
        form.add("CheckCollisions", translate("BeltGrinding", "Look for collisions"))
        form.add("Clearance", translate("BeltGrinding", "Clearance"))
        form.add("WheelInset", translate("BeltGrinding", "Wheel's body inset"))
        form.setFlat(True)
        form.layout_.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        form.layout_.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(form)
        self.fill()
        return box

    def fill(self) -> None:
        """Shows the bodies of all frames."""
        self.rows = [(name, obj) for name in BODIES for obj in getattr(self.obj, name)]
        self.list.clear()
        for name, obj in self.rows:
            where = self.frame.itemText(list(BODIES).index(name))
            self.list.addItem(f"{obj.Label}: {where}")

    def add_selected(self) -> None:
        """Adds the objects that are selected in the tree or the view, to the chosen frame."""
        found = [
            one
            for one in Gui.Selection.getSelection(self.document.Name)
            if (hasattr(one, "Shape") or hasattr(one, "Mesh")) and not type_of(one)
        ]
        if not found:
            text = translate("BeltGrinding", "Select Part or Mesh objects in the tree first.")
            self.tell(text, True)
            return
        chosen = list(BODIES)[self.frame.currentIndex()]
        for name in BODIES:
            kept = [obj for obj in getattr(self.obj, name) if obj not in found]
            setattr(self.obj, name, kept + found if name == chosen else kept)
        self.tell("")
        self.fill()
        self.redraw()

    def remove(self) -> None:
        row = self.list.currentRow()
        if row >= 0:
            name, gone = self.rows[row]
            setattr(self.obj, name, [obj for obj in getattr(self.obj, name) if obj is not gone])
            self.fill()
            self.redraw()

    def arrange(self) -> None:
        """Shows the frames that the holding uses; draws the cell as it is now."""
        frames = {
            "tool_in_hand": {"BaseFromWork", "TcpFromContact"},
            "part_in_hand": {"TcpFromWork", "BaseFromContact"},
        }
        self.cell.show_rows({"Holding"} | frames[self.obj.Holding])
        if self.walk:
            self.robot.forget()
            self.walk.view.robot.followed = None
            self.walk.arrange()
            self.show_joints()
            self.drawn.start(WAIT)
            self.tell("")
        else:
            self.tell(
                translate("BeltGrinding", "Import a robot program to see the cell at its poses.")
            )

    def draw_paths(self) -> None:
        """Draws the paths where the contact runs now."""
        for path in known(self.walk).paths:
            path.recompute()

    def redraw(self) -> None:
        if self.walk:
            self.walk.view.rebuild()
            self.show_joints()

    def close(self) -> None:
        self.drawn.stop()
        if self.walk:
            self.robot.close()
            self.walk.release()
