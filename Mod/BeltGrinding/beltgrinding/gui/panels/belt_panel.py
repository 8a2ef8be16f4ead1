"""Task panel of a belt: what it has done, a new one, and the count of a run."""

from __future__ import annotations

from collections.abc import Iterator

from ...engine import InputError
from ...objects import belt_machine, job_data
from ...objects.job_object import BeltGrindingJob
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...objects.simulation import Simulation
from ..common.compat import QtGui, translate
from ..common.kinds import Widget
from ..common.messages import error_text
from ..widgets.form import Form
from .panel import Panel


class BeltPanel(Panel):
    """Edits a Belt."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(obj, translate("BeltGrinding", "Belt"), "BeltGrinding_Belt")
        self.fields: Form | None = None
        self.place = QtGui.QVBoxLayout()
        self.body.addLayout(self.place)
        self.left = QtGui.QLabel()
        self.left.setObjectName("remainingCut")
        self.left.setWordWrap(True)
        self.body.addWidget(self.left)
        self.buttons: list[Widget] = []
        self.fill()  # before the buttons, so that Tab comes to them after the fields
        for name, text, action in (
            ("countRun", translate("BeltGrinding", "Count the simulated grind"), self.count),
            ("newBelt", translate("BeltGrinding", "New belt"), self.renew),
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.clicked.connect(action)
            self.body.addWidget(button)
            self.buttons.append(button)
        self.finish()

    def fill(self) -> None:
        """The fields anew: the buttons change the properties."""
        if self.fields is not None:
            self.fields.setParent(None)
        self.fields = Form(self.obj, translate("BeltGrinding", "What it has done"))
        self.fields.add("Hours", translate("BeltGrinding", "In contact"), unit="h")
        self.fields.add("WorkDone", translate("BeltGrinding", "Work"), unit="J")
        self.fields.add("RemovedVolume", translate("BeltGrinding", "Removed"), unit="mm³")
        self.fields.add("Loading", translate("BeltGrinding", "Loading (0 to 1)"))
        self.place.addWidget(self.fields)
        last = self.fields
        for button in self.buttons:  # behind fields that are newer than they
            QtGui.QWidget.setTabOrder(last, button)
            last = button
        text = translate("BeltGrinding", "Remaining cut: {:.1f} % of a fresh belt's")
        self.left.setText(text.format(self.obj.RemainingCut))

    def renew(self) -> None:
        self.obj.Proxy.reset(self.obj)
        self.fill()
        self.tell(translate("BeltGrinding", "A new belt is on."))

    def count(self) -> None:
        """Adds the use of the results of the jobs that run on this belt."""
        counted, refused = 0, []
        for simulation in self._simulations():
            try:
                self.obj.Proxy.count(self.obj, simulation)
                counted += 1
            except InputError as error:
                refused.append(error_text(error))
        self.fill()
        if counted:
            self.tell(translate("BeltGrinding", "Runs counted: {}.").format(counted))
        else:
            nothing = translate("BeltGrinding", "Simulate a job that runs on this belt first.")
            self.tell(refused[0] if refused else nothing, True)

    def _simulations(self) -> Iterator[DocumentObject]:
        for job in self.document.Objects:
            if type_of(job) != BeltGrindingJob.TYPE:
                continue
            machine = job_data.child(job, belt_machine.BeltMachine)
            simulation = job_data.child(job, Simulation)
            if machine is not None and machine.Belt == self.obj and simulation is not None:
                yield simulation
