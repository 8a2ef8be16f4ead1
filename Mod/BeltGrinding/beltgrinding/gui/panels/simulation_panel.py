"""Task panel of the simulation: progress and Cancel, then figures and events."""

from __future__ import annotations

import json
from collections.abc import Callable

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError, core
from ...objects import api, job_data, report_data
from ...objects.deviation import Deviation
from ...objects.job_data import child
from ...objects.kinds import DocumentObject, Event
from ...objects.living import GONE
from ...objects.robot_path import RobotPath
from ...objects.simulation import Simulation, is_coarse
from ...objects.verdict import limits_changed
from ..common.compat import QtCore, QtGui, translate
from ..common.event_texts import errors
from ..common.messages import error_text
from ..common.report_language import language
from ..common.runner import Runner
from ..common.theme import warning_style
from ..common.verdict_words import headline, shares
from ..common.task_panel import show_panel
from ..widgets.event_moment import EventMoment
from ..widgets.event_table import EventTable
from .run_panel import RunPanel


LIMITS = ("ToleranceLower", "ToleranceUpper", "Zones")  # of the job: what the panel says is by them


class _Follower:
    """Calls ``changed`` once FreeCAD is at rest after the limits of ``job`` or its Simulation have changed; an observer of the
    documents until ``end``."""

    def __init__(self, job: DocumentObject, changed: Callable[[], object]) -> None:
        self.job, self.changed, self.due = job, changed, False
        FreeCAD.addDocumentObserver(self)

    def slotChangedObject(self, obj: DocumentObject, name: str) -> None:
        if self.due or self.job is None:
            return
        try:
            ours = name in LIMITS if obj is self.job else obj is child(self.job, Simulation)
        except GONE:  # the job is
            ours = False
        if ours:
            self.due = True
            QtCore.QTimer.singleShot(0, self._tell)

    def _tell(self) -> None:
        self.due = False
        if self.job is not None:
            self.changed()

    def end(self) -> None:
        if self.job is not None:
            self.job = None
            FreeCAD.removeDocumentObserver(self)


class SimulationPanel(RunPanel):
    """Runs a job if ``run``, and shows its result."""

    def __init__(self, job: DocumentObject, run: bool) -> None:
        title = translate("BeltGrinding", "Simulation")
        super().__init__(job, title, "BeltGrinding_Simulate")
        body = QtGui.QVBoxLayout(self.form)
        body.addWidget(self.state)
        body.addWidget(self.bar)
        row = QtGui.QHBoxLayout()
        self.again = self._button("again", translate("BeltGrinding", "Again"), self.start)
        self.look = self._button(
            "deviation", translate("BeltGrinding", "Deviation"), self.deviation
        )
        for button in (self.cancel, self.again, self.look):
            row.addWidget(button)
        body.addLayout(row)
        self.trouble = QtGui.QLabel()
        self.trouble.setObjectName("trouble")
        self.trouble.setWordWrap(True)
        self.trouble.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.trouble.setStyleSheet(warning_style(True))
        body.insertWidget(1, self.trouble)
        self.trouble.hide()
        self.figures = QtGui.QLabel()
        self.figures.setWordWrap(True)
        self.figures.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        body.addWidget(self.figures)
        self.moment = moment = EventMoment(job)
        self.form.destroyed.connect(lambda *_: moment.close())  # by a macro: nobody asks the panel
        self.table = EventTable(lambda number: job_data.face_name(self.job, number - 1))
        self.table.chosen = self.show_moment
        self.table.hide()
        body.addWidget(self.table, 1)
        body.addStretch()
        self.shown = None  # the events in the table
        self.follower = follower = _Follower(job, self.follow)
        self.form.destroyed.connect(lambda *_: follower.end())
        if run:
            self.start()
        else:
            self.show(child(job, Simulation))

    def doing(self) -> str:
        return translate("BeltGrinding", "Grinding, {}")

    def make_runner(self) -> Runner:
        self.moment.forget()
        return Runner(self.job, self.progress, self.done, core.Recording(), lay_deviation)

    def show(self, simulation: DocumentObject) -> None:
        """Figures and events of a result."""
        self._arrange(False)
        if simulation is None:
            self._say(translate("BeltGrinding", "No result yet."))
            return
        if simulation.OutOfDate:
            text = translate("BeltGrinding", "Out of date: an input has changed since.")
        elif limits_changed(self.job, simulation):
            text = translate(
                "BeltGrinding", "The limits have changed since: gouges are by the old ones."
            )
        else:
            text = translate("BeltGrinding", "Done.")
        judged = json.loads(simulation.VerdictData or "{}").get("verdict")
        if judged and not simulation.OutOfDate and not limits_changed(self.job, simulation):
            text = f"{headline(judged)}\n{shares(judged)}"
        elif is_coarse(simulation):
            text += "\n" + translate(
                "BeltGrinding", "Coarse resolution: for searching, no verdict."
            )
        self._say(text, simulation.OutOfDate)
        trouble = errors(simulation)
        self.trouble.setText(trouble)
        self.trouble.setVisible(bool(trouble))
        self.figures.setText(
            translate(
                "BeltGrinding",
                "Removed: {:,.1f} of {:,.1f} mm³\nProcess time: {:.1f} s\n"
                "Samples: {:,}, steps: {:,}, computed in {:.1f} s\n"
                "Missed rays: {:,}, defective stock: {:,} samples",
            ).format(
                simulation.RemovedVolume.Value,
                simulation.StockVolume.Value,
                simulation.ProcessTime,
                simulation.Samples,
                simulation.Steps,
                simulation.WallTime,
                simulation.MissedRays,
                simulation.DefectiveSamples,
            )
            + ("" if simulation.Events else "\n" + translate("BeltGrinding", "No events."))
            + "".join(
                f"\n⚠ {warning}" for warning in report_data.warnings(simulation, language())[:10]
            )
        )
        events = simulation.Proxy.events(simulation)
        self.table.setVisible(bool(events))
        if events != self.shown:  # else what is chosen there stays
            self.table.show_events(events)
            self.shown = events

    def follow(self) -> None:
        """The limits or the result have changed while the panel is open."""
        if self.runner is not None:
            return
        try:
            self.show(child(self.job, Simulation))
        except GONE:
            self.follower.end()  # the job is

    def show_moment(self, event: Event) -> None:
        """Shows a chosen event in the 3D view."""
        try:
            self.moment.show(event)
        except InputError as error:  # the job has changed since
            self._say(error_text(error), True)

    def deviation(self) -> None:
        self.follower.end()
        self.moment.close()
        Gui.Control.closeDialog()
        Gui.runCommand("BeltGrinding_Deviation")

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        self.again.setVisible(not running)
        self.trouble.setVisible(False)
        self.look.setVisible(not running and child(self.job, Simulation) is not None)

    def reject(self) -> bool:
        self.follower.end()
        self.moment.close()
        return super().reject()


def lay_deviation(job: DocumentObject) -> None:
    """Shows a job's result in colour over its part; in the undo step that stores it."""
    made = job_data.child(job, Deviation) is None
    deviation = api.make_deviation(job)
    deviation.ViewObject.Visibility = True
    if made:  # what would hide the colours
        for part in {obj for obj, _ in job.DesignFaces}:
            part.ViewObject.Visibility = False
        for path in job_data.children(job, RobotPath):
            path.ViewObject.Visibility = False


def show_result(simulation: DocumentObject) -> None:
    """Opens the panel with the result of a Simulation object."""
    job = simulation.getParentGroup()
    if job is not None and not Gui.Control.activeDialog():
        show_panel(SimulationPanel(job, False), job)
