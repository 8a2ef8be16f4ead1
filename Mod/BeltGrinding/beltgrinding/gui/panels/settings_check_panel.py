"""Task panel that tells whether a job's settings are fine enough: progress and Cancel, then the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...objects import report_data
from ...objects.job_data import child, inspection
from ...objects.kinds import DocumentObject
from ...objects.simulation import Simulation
from ...reporting import convergence_section
from ...simulation import convergence
from ..common.compat import QtGui, translate
from ..common.kinds import Context, Table
from ..common.messages import note_texts
from ..common.report_language import words
from ..common.runner import Runner
from ..common.theme import theme
from .run_panel import RunPanel

if TYPE_CHECKING:
    from ...simulation.result import Result

TABLE_HEIGHT = 320  # pixels


class _Check(Runner):
    """A run at three levels in place of one."""

    def grind(self, context: Context) -> Result:
        return convergence.converge(self.data, context)


class SettingsCheckPanel(RunPanel):
    """Shows what is known, and checks when asked to."""

    def __init__(self, job: DocumentObject) -> None:
        title = translate("BeltGrinding", "Check settings")
        super().__init__(job, title, "BeltGrinding_CheckSettings")
        self.words = words()
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
        for button in (self.check, self.cancel):
            row.addWidget(button)
        row.addStretch()
        body.addLayout(row)
        body.addWidget(self.bar)
        body.addWidget(self.state)
        self.more = QtGui.QLabel()
        self.more.setWordWrap(True)
        body.addWidget(self.more)
        self.table = self._table()
        body.addWidget(self.table, 1)
        body.addStretch()
        self.show(child(job, Simulation))

    def _table(self) -> Table:
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

    def doing(self) -> str:
        return translate("BeltGrinding", "Checking the settings, {}")

    def make_runner(self) -> Runner:
        return _Check(self.job, self.progress, self.done)

    def show(self, simulation: DocumentObject) -> None:
        """The answer that the document has, if there is one."""
        found = report_data.convergence(simulation, inspection(self.job)) if simulation else None
        self.table.setRowCount(len(found["quantities"]) if found else 0)
        self._arrange(False)
        if found is None:
            self._say(translate("BeltGrinding", "Not checked yet."))
            return
        first, *others = convergence_section.sentences(found, self.words)
        self._say(first, not found["fine_enough"])
        self.more.setText("\n\n".join([*others, *note_texts(found)]))
        for row, one in enumerate(found["quantities"]):
            name = convergence_section.name_of(one, self.words)
            value, error, limit = (
                convergence_section.value_of(one, number, self.words, True)
                for number in (one["values"][1], one["error"], one["limit"])
            )
            about = translate("BeltGrinding", "{}: {}, off by up to {}, allowed {}")
            for column, cell in enumerate((name, error)):
                item = QtGui.QTableWidgetItem(cell)
                item.setToolTip(about.format(name, value, error, limit))
                if not one["ok"]:
                    item.setForeground(QtGui.QColor(theme().warning))
                self.table.setItem(row, column, item)
        self.table.resizeColumnToContents(1)
        self.table.resizeRowsToContents()

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        self.check.setVisible(not running)
        self.table.setVisible(not running and self.table.rowCount() > 0)

    def _say(self, text: str, error: bool = False) -> None:
        super()._say(text, error)
        self.more.setText("")
