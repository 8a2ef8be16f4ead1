"""Task panel of the simulation: progress and Cancel, then figures and events."""

import time
import traceback

import FreeCAD
import FreeCADGui as Gui

from .. import Cancelled, InputError
from ..objects import job_object
from ..objects.job_object import child
from ..objects.simulation import Simulation
from .compat import QtCore, QtGui, buttons, translate
from .event_moment import EventMoment
from .event_table import EventTable
from .icons import icon
from .runner import Runner
from .status_progress import StatusProgress
from .time_left import TimeLeft, duration


class SimulationPanel:
    """Runs a job if ``run``, and shows its result."""

    def __init__(self, job, run):
        self.job = job
        self.runner = self.status = None
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(translate("BeltGrinding", "Simulation"))
        self.form.setWindowIcon(QtGui.QIcon(icon("BeltGrinding_Simulate")))
        body = QtGui.QVBoxLayout(self.form)
        self.state = QtGui.QLabel()
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        body.addWidget(self.state)
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        body.addWidget(self.bar)
        row = QtGui.QHBoxLayout()
        self.cancel = self._button("cancel", translate("BeltGrinding", "Cancel"), self.stop)
        self.again = self._button("again", translate("BeltGrinding", "Again"), self.start)
        self.look = self._button(
            "deviation", translate("BeltGrinding", "Deviation"), self.deviation
        )
        for button in (self.cancel, self.again, self.look):
            row.addWidget(button)
        body.addLayout(row)
        self.figures = QtGui.QLabel()
        self.figures.setWordWrap(True)
        self.figures.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        body.addWidget(self.figures)
        self.moment = EventMoment(job)
        self.table = EventTable(lambda number: job_object.face_name(self.job, number - 1))
        self.table.chosen = self.show_moment
        self.table.hide()
        body.addWidget(self.table, 1)
        body.addStretch()
        if run:
            self.start()
        else:
            self.show(child(job, Simulation))

    def _button(self, name, text, action):
        button = QtGui.QPushButton(text)
        button.setObjectName(name)
        button.clicked.connect(action)
        return button

    def start(self):
        """Begins a run; what is missing is said in the panel."""
        self.moment.close()
        self.moment = EventMoment(self.job)
        try:
            self.runner = Runner(self.job, self.progress, self.done)
        except InputError as error:
            self._arrange(False)
            FreeCAD.Console.PrintError(f"{error}\n")
            self._say(str(error), True)
            return
        self.left = TimeLeft()
        self.status = StatusProgress(self.stop)
        self._arrange(True)
        self.progress(0.0)

    def stop(self):
        if self.runner:
            self.runner.cancel()

    def progress(self, share):
        self.bar.setValue(int(1000 * share))
        seconds = time.monotonic() - self.runner.start
        text = translate("BeltGrinding", "Grinding, {}").format(duration(seconds))
        left = self.left.update(seconds, share)
        if left is not None:
            text += translate("BeltGrinding", "; about {} left").format(duration(left))
        self._say(text)
        self.status.update_progress(share, text)

    def done(self, simulation, error):
        """The run has ended."""
        self._remove_status()
        if self.runner.job() is None:
            Gui.Control.closeDialog()
            return
        self.runner = None
        self._arrange(False)
        if error is None:
            self.show(simulation)
        elif isinstance(error, Cancelled):
            self._say(translate("BeltGrinding", "Cancelled; the document is as it was."))
        else:
            if not isinstance(error, InputError):
                lines = traceback.format_exception(type(error), error, error.__traceback__)
                FreeCAD.Console.PrintError("".join(lines))
            FreeCAD.Console.PrintError(f"{error}\n")
            self._say(str(error), True)

    def show(self, simulation):
        """Figures and events of a result."""
        self._arrange(False)
        if simulation is None:
            self._say(translate("BeltGrinding", "No result yet."))
            return
        if simulation.OutOfDate:
            text = translate("BeltGrinding", "Out of date: an input has changed since.")
        else:
            text = translate("BeltGrinding", "Done.")
        self._say(text, simulation.OutOfDate)
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
            + "".join(f"\n⚠ {warning}" for warning in simulation.Warnings[:10])
        )
        events = simulation.Proxy.events(simulation)
        self.table.setVisible(bool(events))
        self.table.show_events(events)

    def show_moment(self, event):
        """Shows a chosen event in the 3D view."""
        try:
            self.moment.show(event)
        except InputError as error:  # the job has changed since
            self._say(str(error), True)

    def deviation(self):
        self.moment.close()
        Gui.Control.closeDialog()
        Gui.runCommand("BeltGrinding_Deviation")

    def _remove_status(self):
        if self.status:
            self.status.remove()
            self.status = None

    def _arrange(self, running):
        self.bar.setVisible(running)
        self.cancel.setVisible(running)
        self.again.setVisible(not running)
        self.look.setVisible(not running and child(self.job, Simulation) is not None)

    def _say(self, text, error=False):
        self.state.setText(text)
        self.state.setStyleSheet("color: #b3261e; font-weight: bold;" if error else "")

    def getStandardButtons(self):
        return buttons("Close")

    def reject(self):
        """Close: a run that still goes on is cancelled."""
        self.moment.close()
        if self.runner:
            self._remove_status()
            self.runner.abandon()  # this panel's widgets are gone before the run has ended
        Gui.Control.closeDialog()
        return True


def show_result(simulation):
    """Opens the panel with the result of a Simulation object."""
    job = simulation.getParentGroup()
    if job is not None and not Gui.Control.activeDialog():
        Gui.Control.showDialog(SimulationPanel(job, False))
