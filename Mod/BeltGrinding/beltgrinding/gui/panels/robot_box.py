"""The robot in the cell's panel: which one, where it stands, what it meets along the program."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

from ...cell import arm_check
from ...engine import Cancelled, InputError, core
from ...objects import job_inputs
from ...objects.kinds import DocumentObject, Event
from ...presets import library as presets, robot as robots
from ...geometry.body_names import LINKS
from ..common import event_texts
from ..common.compat import QtGui, translate
from ..common.figures import figure
from ..common.kinds import Context, Numbers
from ..common.messages import error_text
from ..common.runner import Background
from ..common.task_progress import TaskRow
from ..widgets.form import FrameField
from ..widgets.steady import steady

OWN = "RobotModel"
SHOWN_EVENTS = 200
LIST_HEIGHT = 90  # pixels


class RobotForm(QtGui.QGroupBox):
    """Edits the robot of a BeltMachine: which one, its controller, where it stands, its tool. ``changed()`` follows every
    edit."""

    def __init__(self, machine: DocumentObject) -> None:
        super().__init__(translate("BeltGrinding", "Robot"))
        self.machine = machine
        self.changed: Callable[[], object] = lambda: None
        layout = self.rows = QtGui.QFormLayout(self)
        layout.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        self.choice = steady(QtGui.QComboBox())
        self.choice.setObjectName("robot")
        self.choice.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.ids = ["", *(one["id"] for one in presets.robots())]
        self.choice.addItem(translate("BeltGrinding", "(none: reach is not checked)"))
        for one in presets.robots():
            self.choice.addItem(one["name"])
        own = json.loads(machine.RobotModel or "{}")
        if own.get("joints") or own.get("urdf"):
            self.ids.append(OWN)
            self.choice.addItem(translate("BeltGrinding", "own model (property RobotModel)"))
        current = machine.Robot or (OWN if OWN in self.ids else "")
        self.choice.setCurrentIndex(self.ids.index(current) if current in self.ids else 0)
        self.choice.setEnabled(OWN not in self.ids)
        layout.addRow(translate("BeltGrinding", "Robot"), self.choice)
        self.controllers = ["", *(one["id"] for one in presets.controllers())]
        self.controller = steady(QtGui.QComboBox())
        self.controller.setObjectName("controller")
        self.controller.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.controller.addItem(translate("BeltGrinding", "(not known: a cautious one)"))
        for one in presets.controllers():
            self.controller.addItem(one["name"])
        given = machine.Controller
        self.controller.setCurrentIndex(
            self.controllers.index(given) if given in self.controllers else 0
        )
        self.controller.setToolTip(machine.getDocumentationOfProperty("Controller"))
        layout.addRow(translate("BeltGrinding", "Controller"), self.controller)
        self.controller.currentIndexChanged.connect(
            lambda index: self._set("Controller", self.controllers[index])
        )
        self.fields = []
        for name, text in (
            ("BaseFromRobot", translate("BeltGrinding", "Robot in base")),
            ("FlangeFromTcp", translate("BeltGrinding", "Tool in flange")),
        ):
            field = FrameField(
                getattr(machine, name), lambda value, name=name: self._set(name, value)
            )
            field.setObjectName(name)
            field.setToolTip(machine.getDocumentationOfProperty(name))
            label = QtGui.QLabel(text)
            layout.addRow(label, field)
            self.fields += [label, field]
        self.choice.currentIndexChanged.connect(self._choose)
        self._arrange()

    def _choose(self, index: int) -> None:
        self._set("Robot", self.ids[index])
        self._arrange()

    def _set(self, name: str, value: Any) -> None:
        if getattr(self.machine, name) != value:
            setattr(self.machine, name, value)
            self.forget()
            self.changed()

    def _arrange(self) -> None:
        some = bool(self.ids[self.choice.currentIndex()])
        for widget in self.fields:
            widget.setVisible(some)

    def forget(self) -> None:
        """What was found no longer holds."""


class RobotBox(RobotForm):
    """The same, and what its arm meets on a path. ``found(result)`` follows a check of the path that ``path()`` gives;
    ``go(pose)`` asks for a pose, from 0."""

    def __init__(self, machine: DocumentObject, path: Callable[[], DocumentObject]) -> None:
        self.events: list[Event] = []  # of the path that was checked
        self.task: Background | None = None
        self.list = QtGui.QListWidget()
        super().__init__(machine)
        self.path = path
        self.found: Callable[[Any], object] = lambda result: None
        self.go: Callable[[int], object] = lambda pose: None
        self.unchecked = ""  # why what the arm may meet was not looked at
        self.joints = QtGui.QLabel()
        self.joints.setObjectName("joints")
        self.joints.setWordWrap(True)
        self.check = QtGui.QPushButton(translate("BeltGrinding", "Check the whole program"))
        self.check.setObjectName("checkReach")
        self.check.clicked.connect(self.start)
        self.list.setObjectName("reachEvents")
        self.list.setMaximumHeight(LIST_HEIGHT)
        self.list.currentRowChanged.connect(self._chosen)
        self.progress = TaskRow()
        checking = QtGui.QWidget()  # a hidden row of its own would leave a gap
        column = QtGui.QVBoxLayout(checking)
        column.setContentsMargins(0, 0, 0, 0)
        for widget in (self.check, self.progress):
            column.addWidget(widget)
        for widget in (self.joints, checking, self.list):
            self.rows.addRow(widget)
            self.fields.append(widget)
        self._arrange()

    def _arrange(self) -> None:
        super()._arrange()
        self.list.setVisible(self.choice.currentIndex() > 0 and bool(self.events))

    def forget(self) -> None:
        """What was found no longer holds."""
        if self.task is not None:
            self.task.cancel()
        self.events = []
        self.list.clear()
        self.list.hide()

    def show_joints(self, joints: Numbers | None) -> None:
        """Joint angles (6,) in degrees at the pose, None: out of reach."""
        if joints is None:
            self.joints.setText(translate("BeltGrinding", "Out of reach at this pose."))
            return
        angles = ", ".join(figure(angle, ".1f") for angle in joints)
        self.joints.setText(translate("BeltGrinding", "Joints: {}°").format(angles))

    def start(self) -> None:
        """Follows the whole program in the background, with what the arm may meet."""
        self.forget()
        obj = self.path()
        try:
            robot = robots.checked(self.machine.Proxy.robot(self.machine))
            path = core.ToolPath(**obj.Proxy.arrays(obj), **self.machine.Proxy.cell(self.machine))
        except InputError as error:
            self.joints.setText(error_text(error))
            return
        folder = job_inputs.scratch_folder()
        job, self.unchecked = None, ""
        try:
            if self.machine.CheckCollisions:
                job = job_inputs.to_data(self.machine.getParentGroup(), folder.name)
            else:
                self.unchecked = translate("BeltGrinding", "looking for collisions is turned off")
        except InputError as error:
            self.unchecked = error_text(error)
        self.check.setEnabled(False)

        def work(context: Context) -> Any:
            with folder:
                return arm_check.follow(path, robot, job, context)

        self.task = Background(work, self._done, self)
        self.progress.follow(self.task, translate("BeltGrinding", "Checking the program"))

    def _done(self, result: Any, error: BaseException | None) -> None:
        self.task = None
        self.progress.end()
        self.check.setEnabled(True)
        if isinstance(error, Cancelled):
            return
        if error is not None:
            if not isinstance(error, InputError):
                raise error
            self.joints.setText(error_text(error))
            return
        self.events = result["events"][:SHOWN_EVENTS]
        self.list.clear()
        for event in self.events:
            kind, message = event_texts.title(event), event_texts.message(event)
            self.list.addItem(f"{event['pose'] + 1}: {kind}: {message}")
        for text in self._notes(result):
            self.list.addItem(text)
        self.list.show()
        self.found(result)

    def _notes(self, result: Any) -> Iterator[str]:
        """What stands below the events."""
        if not self.events:
            yield translate(
                "BeltGrinding", "The robot follows the whole program; nothing to report."
            )
        if self.unchecked:
            text = translate("BeltGrinding", "What its arm runs into was not looked at: {}")
            yield text.format(self.unchecked)
        for warning in result["warnings"]:
            yield error_text(warning)
        pairs = [pair for pair in result.get("pairs", ()) if pair["bodies"][1] in LINKS]
        if pairs:
            nearest = min(pairs, key=lambda pair: pair["distance"])
            text = translate(
                "BeltGrinding",
                "Nearest to the arm, whose thickness is estimated unless LinkRadii says it: {}, {:.0f} mm from {}",
            )
            first, second = (event_texts.body(name) for name in nearest["bodies"])
            yield text.format(first, nearest["distance"], second)

    def _chosen(self, row: int) -> None:
        if 0 <= row < len(self.events):
            self.go(self.events[row]["pose"])

    def close(self) -> None:
        """The panel goes: a check under way is given up."""
        if self.task is not None:
            self.task.abandon()
            self.progress.end()
            self.task = None
