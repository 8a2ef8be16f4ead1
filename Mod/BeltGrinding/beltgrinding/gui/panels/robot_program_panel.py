"""Task panel of the program for the whole robot: its robot and home, the plan, the arm on its way, Write."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import FreeCADGui as Gui
import numpy as np

from ...base.kinds import known
from ...engine import InputError
from ...objects import api, robot_program, stored_facts
from ...objects.belt_machine import BeltMachine
from ...objects.job_data import children, required
from ...objects.kinds import DocumentObject, Event
from ...objects.robot_path import RobotPath
from ...presets import robot as robots
from ..charts.joint_chart import JointChart, Row
from ..common import event_texts
from ..common.compat import QtGui, translate
from ..common.figures import figure
from ..common.kinds import Layout, Widget
from ..common.messages import error_text
from ..common.report_language import language
from ..common.robot_program_runner import RobotProgramRunner
from ..common.save_dialog import file_to_write
from ..common.task_panel import show_panel
from ..common.transaction import commit
from ..scene.cell_view import ALARM, CLOSE
from ..widgets.event_table import EventTable
from ..widgets.fold import Fold, slim
from ..widgets.form import WRONG, Form, number
from ..widgets.pose_walk import PoseWalk
from .panel import breakable
from .robot_box import RobotForm
from .run_panel import RunPanel

if TYPE_CHECKING:
    from ..common.runner import Runner

LANGUAGES = "KUKA KRL (*.src);;ABB RAPID (*.mod);;URScript (*.script);;Fanuc TP (*.ls);;Yaskawa INFORM (*.jbi)"
JOINTS = 6
EVENT_ROWS = 6
SHOWN_NOTES = 2


class RobotProgramPanel(RunPanel):
    """Settings go into the belt machine as they are typed; what was planned is shown, walked through and written."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(
            obj.getParentGroup(),
            translate("BeltGrinding", "Robot program"),
            "BeltGrinding_RobotProgram",
        )
        self.obj, self.document, self.ended = obj, obj.Document, False
        self.machine = required(self.job, BeltMachine, "belt machine")
        self.walk: PoseWalk | None = None
        body = QtGui.QVBoxLayout(self.form)
        self.settings = self._settings()
        body.addWidget(self.settings)
        row = QtGui.QHBoxLayout()
        self.begin = self._button("planRobot", translate("BeltGrinding", "Plan"), self.start)
        row.addWidget(self.begin)
        row.addWidget(self.cancel)
        body.addLayout(row)
        body.addWidget(self.bar)
        body.addWidget(self.state)
        body.addLayout(self._writing())
        self.walked = QtGui.QVBoxLayout()
        body.addLayout(self.walked)
        self.place = QtGui.QLabel()
        self.place.setObjectName("place")
        self.place.setWordWrap(True)
        body.addWidget(self.place)
        self.chart = JointChart()
        self.chart.chosen = self._go
        body.addWidget(self.chart)
        self.events = EventTable(str)
        height = self.events.table.verticalHeader().defaultSectionSize()
        self.events.table.setMinimumHeight((EVENT_ROWS + 1) * height)
        self.events.chosen = self._choose
        body.addWidget(self.events)
        body.addStretch()
        slim(self.form)
        self.begin_made(obj)
        self._open()
        self.show(None)

    def _settings(self) -> Fold:
        inner = QtGui.QWidget()
        rows = QtGui.QVBoxLayout(inner)
        rows.setContentsMargins(0, 0, 0, 0)
        mounting = Form(self.machine, "")
        holding = {
            "tool_in_hand": translate("BeltGrinding", "Tool in hand"),
            "part_in_hand": translate("BeltGrinding", "Part in hand"),
        }
        mounting.add("Holding", translate("BeltGrinding", "Robot holds"), holding)
        mounting.changed = self._changed
        rows.addWidget(mounting)
        self.robot = RobotForm(self.machine)
        self.robot.changed = self._changed
        rows.addWidget(self.robot)
        rows.addWidget(self._home())
        folded = bool(self.obj.Fingerprint)
        title = translate("BeltGrinding", "Robot, mounting, home")
        self.fold = Fold("foldRobot", title, inner, folded=folded)
        return self.fold

    def _home(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "Home"))
        rows = QtGui.QVBoxLayout(box)
        given = self._program().get("home_joints_deg", [])
        self.home = QtGui.QLineEdit(", ".join(f"{one:g}" for one in given))
        self.home.setObjectName("homeJoints")
        self.home.setPlaceholderText("0, -90, 90, 0, 60, 0")
        self.home.setToolTip(
            translate(
                "BeltGrinding", "Six joint angles in degrees, where the program begins and ends"
            )
        )
        self.home.textChanged.connect(lambda _: self._set_home())
        rows.addWidget(self.home)
        text = translate("BeltGrinding", "Take from view")
        take = self._button("takeHome", text, self.take_home)
        take.setToolTip(
            translate(
                "BeltGrinding", "The joints of the arm as the 3D view shows it at the pose below"
            )
        )
        rows.addWidget(take)
        named = QtGui.QFormLayout()
        self.base = QtGui.QLineEdit(self._program().get("base", ""))
        self.base.setObjectName("programBase")
        self.base.setPlaceholderText(translate("BeltGrinding", "numbers of the job"))
        self.base.setToolTip(
            translate(
                "BeltGrinding",
                "The controller's own base that the program sets: its number (KRL) or name (RAPID). A part that moves in the "
                "passes needs one, coupled to its axis.",
            )
        )
        self.base.textChanged.connect(lambda _: self._set_base())
        named.addRow(translate("BeltGrinding", "Controller's base"), self.base)
        rows.addLayout(named)
        self.axes = QtGui.QLabel(self._axes_text())
        self.axes.setObjectName("externalAxes")
        self.axes.setWordWrap(True)
        rows.addWidget(self.axes)
        return box

    def _axes_text(self) -> str:
        """The external axes, a line each."""
        carried = {
            "robot": translate("BeltGrinding", "carries the robot"),
            "part": translate("BeltGrinding", "carries the part"),
        }
        lines = []
        for number_, one in enumerate(json.loads(self.machine.ExternalAxes or "[]"), 1):
            unit = "mm" if one.get("kind") == "linear" else "°"
            text = translate("BeltGrinding", "E{}, {}: from {:g} to {:g} {}, limits {:g} and {:g}")
            what = carried.get(one.get("carries", ""), "")
            ends: tuple[float, ...] = (one.get("home", 0.0), one.get("position", 0.0))
            limits = one.get("lower", 0.0), one.get("upper", 0.0)
            if one.get("motion") == "coordinated":
                text = translate("BeltGrinding", "E{}, {}: moves in the passes, home {:g} {}, limits {:g} and {:g}")  # fmt: skip
                ends = (one.get("home", 0.0),)
            lines.append(text.format(number_, what, *ends, unit, *limits))
        return "\n".join(lines) or translate("BeltGrinding", "No external axes.")

    def _writing(self) -> Layout:
        row = QtGui.QVBoxLayout()
        self.unsafe = QtGui.QCheckBox(translate("BeltGrinding", "In spite of its problems"))
        self.unsafe.setObjectName("unsafe")
        self.unsafe.setToolTip(
            translate("BeltGrinding", "The program names them in its head. Do not run it as it is.")
        )
        self.save = self._button("writeRobot", translate("BeltGrinding", "Write..."), self.write)
        row.addWidget(self.unsafe)
        row.addWidget(self.save)
        return row

    def _program(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.machine.RobotProgram or "{}")
        return found

    def _joints_typed(self) -> list[float]:
        """The six angles of the home. Raises InputError."""
        words = self.home.text().replace(";", ",").split(",")
        angles = [number(word) for word in words]
        if len(angles) != JOINTS or None in angles:
            raise InputError(
                "gui.robot_home",
                "Home: give six joint angles in degrees, with commas between them, not '{text}'",
                text=self.home.text(),
            )
        return [known(one) for one in angles]

    def _set_home(self) -> None:
        try:
            angles = self._joints_typed()
        except InputError:
            self.home.setStyleSheet(WRONG)
            return
        self.home.setStyleSheet("")
        self._set_program({**self._program(), "home_joints_deg": angles})

    def _set_base(self) -> None:
        base, rest = self.base.text().strip(), self._program()
        rest.pop("base", None)
        fit = robots.CONTROLLERS_OWN.fullmatch(base) is not None
        self.base.setStyleSheet("" if fit else WRONG)
        self._set_program({**rest, "base": base} if base else rest)  # writing refuses what is wrong

    def _set_program(self, program: dict[str, Any]) -> None:
        if program != self._program():
            self.machine.RobotProgram = json.dumps(program, allow_nan=False)
            self._changed()

    def take_home(self) -> None:
        """Home is where the arm is in the 3D view."""
        joints = None if self.walk is None else self.walk.view.robot.joints
        if joints is None:
            self._say(translate("BeltGrinding", "The 3D view shows no arm at this pose."), True)
            return
        self.home.setText(", ".join(f"{one:.3f}" for one in np.degrees(joints).tolist()))

    def doing(self) -> str:
        return translate("BeltGrinding", "Planning, {}")

    def start(self) -> None:
        self.document.recompute()
        super().start()
        if self.runner is not None:  # else something is missing, and the step goes on
            commit(self.document)

    def make_runner(self) -> Runner:
        self._joints_typed()
        self.fold.fold(True)
        return RobotProgramRunner(self.obj, self.progress, self.done)

    def done(self, found: Any, error: BaseException | None) -> None:
        super().done(found, error)
        self._open()

    def show(self, found: Any) -> None:
        """Shows what the document has; ``found`` is in it already."""
        self._walk_anew()
        self._show_plan()
        self._arrange(False)
        self._tell_state()

    def _walk_anew(self) -> None:
        planned = [self.obj] if self.obj.Fingerprint else []
        paths = [*planned, *(one for one in children(self.job, RobotPath) if one.Poses)]
        self._drop_walk()
        if paths:
            self.walk = PoseWalk(self.document, self.machine, paths)
            self.walk.moved = self._moved
            self.walk.program.currentIndexChanged.connect(lambda _: self._moved(0))
            self.walked.addWidget(self.walk)

    def _drop_walk(self) -> None:
        if self.walk is not None:
            self.walk.release()
            self.walk.setParent(None)
            self.walk.deleteLater()
            self.walk = None

    def _show_plan(self) -> None:
        if not self.obj.Fingerprint:
            return
        walk = self.obj.Proxy.walk(self.obj)
        self.chart.show_rows(np.array(walk.times), self._rows(), walk.states)
        self.events.show_events(self.obj.Proxy.events(self.obj))
        self._moved(0)

    def _rows(self) -> list[Row]:
        """Of the chart: the joints with the limits of the robot, and the external axes."""
        walk = self.obj.Proxy.walk(self.obj)
        joints, external = np.array(walk.joints_deg), np.array(walk.external)
        try:
            robot = robots.checked(self.machine.Proxy.robot(self.machine))
            arm, axes = robots.arm_of(robot), robot["external_axes"]
        except InputError:
            arm, axes = None, []
        ends = np.full((2, JOINTS), np.nan)
        if arm is not None:
            ends = np.degrees([arm.lower, arm.upper])
        rows = [Row(f"J{k + 1}", "°", ends[0][k], ends[1][k], joints[:, k]) for k in range(JOINTS)]
        for k, one in enumerate(axes[: external.shape[1] if external.size else 0]):
            unit = "mm" if one["kind"] == "linear" else "°"
            rows.append(Row(f"E{k + 1}", unit, one["lower"], one["upper"], external[:, k]))
        return rows

    def _on_program(self) -> bool:
        """Whether the walk is through what was planned."""
        return self.walk is not None and self.walk.path() is self.obj

    def _moved(self, index: int) -> None:
        walk = self.walk
        if walk is None:
            return
        if not self._on_program():
            walk.view.tint(())
            self.place.setText("")
            return
        way = self.obj.Proxy.walk(self.obj)
        self.chart.set_place(index)
        walk.view.tint(way.bodies[index], ALARM if way.states[index] == 2 else CLOSE)
        text = translate("BeltGrinding", "{} s, motion {} of {}").format(
            figure(way.times[index], ".2f"), way.moves[index] + 1, self.obj.Motions
        )
        if way.bodies[index]:
            names = tuple(event_texts.body(name) for name in way.bodies[index])
            if way.states[index] == 2:
                told = translate("BeltGrinding", "; {} and {} are in each other").format(*names)
            else:
                told = translate("BeltGrinding", "; {} and {}: {} mm apart").format(
                    *names, figure(way.distances[index], ".1f")
                )
            text += told
        self.place.setText(text)

    def _go(self, place: int) -> None:
        if self.walk is not None:
            self.walk.program.setCurrentIndex(0)
            self.walk.go(place)

    def _choose(self, event: Event) -> None:
        self._go(event["pose"])

    def _changed(self) -> None:
        """A setting is another one."""
        self.obj.Proxy.update(self.obj)
        if self.walk is not None:
            self.walk.view.rebuild()
            self.walk.arrange()
        self._tell_state()

    def _tell_state(self) -> None:
        obj = self.obj
        if not obj.Fingerprint:
            self._say(
                translate(
                    "BeltGrinding",
                    "Postures, links and retracts are planned for all passes, from home to home. The job stays as it is.",
                )
            )
        elif obj.OutOfDate:
            self._say(
                translate("BeltGrinding", "Out of date: an input has changed since; plan again."),
                True,
            )
        else:
            self._say(self._summary(), bool(obj.Refused))
        self._enable()

    def _summary(self) -> str:
        obj, code = self.obj, language()
        lines = [
            translate(
                "BeltGrinding", "{} passes, {} motions, {} s from home to home; {}° to the limits"
            ).format(
                obj.Passes, obj.Motions, figure(obj.Duration, ".1f"), figure(obj.LimitMargin, ".1f")
            )
        ]
        if obj.Refused:
            text = translate("BeltGrinding", "Not to be run, {} problems:")
            lines.append(text.format(len(obj.Refused)))
        told = "Refused" if obj.Refused else "Notes"
        lines += stored_facts.sentences(obj, told, code, SHOWN_NOTES)
        return "\n".join(lines)

    def write(self) -> None:
        """Writes the program; refused where it must not run, unless it is wanted in spite of that."""
        obj = self.obj
        try:
            robot_program.check(obj, self.unsafe.isChecked())
            title = translate("BeltGrinding", "Write robot program")
            file = file_to_write(title, f"{self.job.Label}.src", LANGUAGES)
            if not file:
                return
            notes = api.write_robot_program(obj, file, self.unsafe.isChecked())
        except InputError as error:
            self._say(error_text(error), True)
            return
        written = translate("BeltGrinding", "Written: {}").format(file)
        self._say("\n".join([written, *map(error_text, notes)]))

    def _say(self, text: str, error: bool = False) -> None:
        super()._say(breakable(text), error)

    def _open(self) -> None:
        if not self.ended and not self.document.HasPendingTransaction:
            self.document.openTransaction(
                translate("BeltGrinding", "Settings of the robot program")
            )

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        there = bool(self.obj.Fingerprint) and not running
        self.begin.setVisible(not running)
        self.settings.setEnabled(not running)
        for widget in (self.chart, self.place, self.save):
            widget.setVisible(there)
        self.events.setVisible(there and bool(self.events.events))
        self.unsafe.setVisible(there and bool(self.obj.Refused))
        self._enable()

    def _enable(self) -> None:
        stale = bool(self.obj.OutOfDate)
        self.save.setEnabled(not stale)
        self.save.setToolTip(
            translate("BeltGrinding", "Plan again: an input has changed since.") if stale else ""
        )

    def end(self) -> None:
        """Takes the arm out of the 3D views."""
        if not self.ended:
            self.ended = True
            if self.walk is not None:
                self.walk.release()

    def _gone(self, *arguments: object) -> None:
        super()._gone(*arguments)
        try:
            self.end()
        except (ReferenceError, RuntimeError):
            pass  # the document, or its view, was closed with it

    def reject(self) -> bool:
        self.end()
        if not self.end_made():
            commit(self.document)
            self.document.recompute()
        return super().reject()


def show(obj: DocumentObject) -> None:
    """Opens the panel of a RobotProgram object."""
    if obj.getParentGroup() is not None and not Gui.Control.activeDialog():
        show_panel(RobotProgramPanel(obj), obj)
