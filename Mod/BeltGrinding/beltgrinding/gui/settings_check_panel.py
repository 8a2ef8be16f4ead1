"""Task panel that tells whether a job's settings are fine enough: progress and Cancel, then the answer."""

import time

import FreeCADGui as Gui

from .. import Cancelled, InputError, convergence
from ..objects import told
from ..objects.job_object import child, inspection
from ..objects.simulation import Simulation
from ..reporting import converged
from ..reporting.language import Language
from .compat import QtGui, buttons, translate
from .icons import icon
from .report_writer import language
from .runner import Runner
from .status_progress import StatusProgress
from .time_left import TimeLeft, duration

TABLE_HEIGHT = 320  # pixels
BAD = "#b3261e"


class _Check(Runner):
    """A run at three levels in place of one."""

    def work(self, context):
        return convergence.converge(self.data, context)


class SettingsCheckPanel:
    """Shows what is known, and checks when asked to."""

    def __init__(self, job):
        self.job = job
        self.runner = self.status = None
        self.words = Language(language())
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(translate("BeltGrinding", "Check settings"))
        self.form.setWindowIcon(QtGui.QIcon(icon("BeltGrinding_CheckSettings")))
        body = QtGui.QVBoxLayout(self.form)
        about = QtGui.QLabel(
            translate(
                "BeltGrinding",
                "Are the spacing of the samples, the steps and the contact's cells fine enough? The job "
                "is simulated at twice, once and half of them. That takes about ten times as long as "
                "one simulation.",
            )
        )
        about.setWordWrap(True)
        body.addWidget(about)
        row = QtGui.QHBoxLayout()
        self.check = self._button("check", translate("BeltGrinding", "Check"), self.start)
        self.cancel = self._button("cancel", translate("BeltGrinding", "Cancel"), self.stop)
        for button in (self.check, self.cancel):
            row.addWidget(button)
        row.addStretch()
        body.addLayout(row)
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        body.addWidget(self.bar)
        self.state = QtGui.QLabel()
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        body.addWidget(self.state)
        self.more = QtGui.QLabel()
        self.more.setWordWrap(True)
        body.addWidget(self.more)
        self.table = self._table()
        body.addWidget(self.table, 1)
        body.addStretch()
        self.show()

    def _button(self, name, text, action):
        button = QtGui.QPushButton(text)
        button.setObjectName(name)
        button.clicked.connect(action)
        return button

    def _table(self):
        table = QtGui.QTableWidget(0, 2)
        table.setObjectName("figures")
        table.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Figure"),
                translate("BeltGrinding", "Error"),
            ]
        )
        table.verticalHeader().hide()
        table.horizontalHeader().setSectionResizeMode(0, QtGui.QHeaderView.Stretch)
        table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        table.setMinimumHeight(TABLE_HEIGHT)
        return table

    def start(self):
        """Begins; what is missing is said in the panel."""
        try:
            self.runner = _Check(self.job, self.progress, self.done)
        except InputError as error:
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
        text = translate("BeltGrinding", "Checking the settings, {}").format(duration(seconds))
        left = self.left.update(seconds, share)
        if left is not None:
            text += translate("BeltGrinding", "; about {} left").format(duration(left))
        self._say(text)
        self.status.update_progress(share, text)

    def done(self, simulation, error):
        """The check has ended."""
        self._remove_status()
        if self.runner.job() is None:
            Gui.Control.closeDialog()
            return
        self.runner = None
        self.show()
        if isinstance(error, Cancelled):
            self._say(translate("BeltGrinding", "Cancelled; the document is as it was."))
        elif error is not None:
            self._say(str(error), True)

    def show(self):
        """The answer that the document has, if there is one."""
        self._arrange(False)
        simulation = child(self.job, Simulation)
        found = told.convergence(simulation, inspection(self.job)) if simulation else None
        self.table.setVisible(found is not None)
        if found is None:
            self._say(translate("BeltGrinding", "Not checked yet."))
            return
        first, *others = converged.sentences(found, self.words)
        self._say(first, not found["fine_enough"])
        self.more.setText("\n\n".join([*others, *found["notes"]]))
        self.table.setRowCount(len(found["quantities"]))
        for row, one in enumerate(found["quantities"]):
            name = converged.name_of(one, self.words)
            value, error, limit = (
                converged.value_of(one, number, self.words, True)
                for number in (one["values"][1], one["error"], one["limit"])
            )
            about = translate("BeltGrinding", "{}: {}, off by up to {}, allowed {}")
            for column, cell in enumerate((name, error)):
                item = QtGui.QTableWidgetItem(cell)
                item.setToolTip(about.format(name, value, error, limit))
                if not one["ok"]:
                    item.setForeground(QtGui.QColor(BAD))
                self.table.setItem(row, column, item)
        self.table.resizeColumnToContents(1)
        self.table.resizeRowsToContents()

    def _remove_status(self):
        if self.status:
            self.status.remove()
            self.status = None

    def _arrange(self, running):
        self.bar.setVisible(running)
        self.cancel.setVisible(running)
        self.check.setVisible(not running)
        self.table.setVisible(False)

    def _say(self, text, error=False):
        self.state.setText(text)
        self.state.setStyleSheet(f"color: {BAD}; font-weight: bold;" if error else "")
        self.more.setText("")

    def getStandardButtons(self):
        return buttons("Close")

    def reject(self):
        """Close: a check that still goes on is cancelled."""
        if self.runner:
            self._remove_status()
            self.runner.abandon()
        Gui.Control.closeDialog()
        return True
