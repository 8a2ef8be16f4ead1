"""Base of the task panels that run something in the background: progress, time left, Cancel, errors."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import FreeCAD
import FreeCADGui as Gui

from ...base.kinds import known
from ...engine import Cancelled, InputError
from ...objects.kinds import DocumentObject
from ..common import field_links
from ..common.compat import QtCore, QtGui, buttons, translate
from ..common.help_pages import helped
from ..common.icons import qicon
from ..common.kinds import Buttons, Widget
from ..common.messages import error_text
from ..common.status_progress import StatusProgress, painted_once
from ..common.task_progress import told
from ..common.theme import warning_style
from ..common.time_left import TimeLeft, duration
from ..common.transaction import abort

if TYPE_CHECKING:
    from ..common.runner import Runner


class RunPanel:
    """Base. Makes ``form`` and the widgets ``state``, ``bar`` and ``cancel``; subclasses lay them out, and
    show and hide their own in ``_arrange``.
    """

    def __init__(self, job: DocumentObject, title: str, icon_name: str) -> None:
        self.job = job
        self.runner: Runner | None = None
        self.status: StatusProgress | None = None
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(qicon(icon_name))
        helped(self.form, icon_name)
        self.form.destroyed.connect(self._gone)  # a macro or another command may close it, too
        self.state = QtGui.QLabel()
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        self.state.linkActivated.connect(self._leave_for)
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        self.cancel = self._button("cancel", translate("BeltGrinding", "Cancel"), self.stop)

    def begin_made(self, obj: DocumentObject) -> None:
        """Remembers whether the open undo step has just made the panel's object, and as what."""
        self.made = obj if obj.Document.HasPendingTransaction and not obj.Fingerprint else None
        self.made_with = obj.Proxy.settings(obj)

    def end_made(self) -> bool:
        """Takes the object back that was made for the panel, if the panel is closed at once; whether it did."""
        obj, document = self.made, self.job.Document
        if obj is None or self.runner or not document.HasPendingTransaction:
            return False
        if obj.Fingerprint or obj.Proxy.settings(obj) != self.made_with:
            return False
        abort(document)
        return True

    def doing(self) -> str:
        """What goes on, with {} for the time."""
        raise NotImplementedError

    def make_runner(self) -> Runner:
        """A Runner that calls ``progress`` and ``done``. Raises InputError for what is missing."""
        raise NotImplementedError

    def show(self, simulation: Any) -> None:
        """Shows the Simulation object, or None."""
        raise NotImplementedError

    def _button(self, name: str, text: str, action: Callable[..., object]) -> Widget:
        button = QtGui.QPushButton(text)
        button.setObjectName(name)
        button.clicked.connect(action)
        return button

    def start(self) -> None:
        """Begins; what is missing is said in the panel."""
        try:
            self.runner = self.make_runner()
        except InputError as error:
            self._arrange(False)
            self._tell(error)
            return
        self.left = TimeLeft()
        self.status = StatusProgress(self.stop)
        self._arrange(True)
        self.progress(0.0)

    def stop(self) -> None:
        if self.runner:
            self.runner.cancel()

    def progress(self, share: float) -> None:
        seconds = time.monotonic() - known(self.runner).start
        text = told(self.doing().format(duration(seconds)), self.left.update(seconds, share))
        with painted_once(self.form):
            self.bar.setValue(int(1000 * share))
            self._say(text)
        known(self.status).update_progress(share, text)

    def done(self, simulation: DocumentObject, error: BaseException | None) -> None:
        """It has ended."""
        self._remove_status()
        if known(self.runner).job() is None:
            Gui.Control.closeDialog()
            return
        self.runner = None
        self._arrange(False)
        if error is None:
            self.show(simulation)
        elif isinstance(error, Cancelled):
            self._say(translate("BeltGrinding", "Cancelled; the document is as it was."))
        else:
            self._tell(error)

    def _tell(self, error: BaseException) -> None:
        """An error in the panel, and in full in the report view."""
        if not isinstance(error, InputError):
            lines = traceback.format_exception(type(error), error, error.__traceback__)
            FreeCAD.Console.PrintError("".join(lines))
        FreeCAD.Console.PrintWarning(f"{error_text(error)}\n")
        self._say(error_text(error), True)

    def _say(self, text: str, error: bool = False) -> None:
        if error:
            field_links.show(self.state, text, field_links.objects_of(self.job))
        else:
            self.state.setText(text)
        style = warning_style(error)
        if style != self.state.styleSheet():
            self.state.setStyleSheet(style)

    def _leave_for(self, link: str) -> None:
        """Closes this panel for that of a field."""
        document = self.job.Document.Name
        Gui.Control.closeDialog()
        QtCore.QTimer.singleShot(0, lambda: field_links.go_to(document, link))

    def _arrange(self, running: bool) -> None:
        self.bar.setVisible(running)
        self.cancel.setVisible(running)

    def _remove_status(self) -> None:
        if self.status:
            self.status.remove()
            self.status = None

    def _gone(self, *_: object) -> None:
        """The panel was taken away: what still goes on is cancelled, unheard."""
        self._remove_status()
        if self.runner:
            self.runner.abandon()
            self.runner = None

    def getStandardButtons(self) -> Buttons:
        return buttons("Close")

    def reject(self) -> bool:
        """Close: what still goes on is cancelled."""
        if self.runner:
            self._remove_status()
            self.runner.abandon()  # this panel's widgets are gone before the run has ended
        Gui.Control.closeDialog()
        return True
