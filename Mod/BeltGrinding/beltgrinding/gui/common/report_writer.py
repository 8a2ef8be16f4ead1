"""Writes a report while FreeCAD stays usable, and opens it."""

from __future__ import annotations

import time
from pathlib import Path

import FreeCAD

from ...engine import Cancelled
from ...objects import job_inputs, reports
from ...objects.kinds import DocumentObject
from ...reporting import report as reporting
from .compat import QtCore, QtGui, translate
from .messages import report as say
from .report_language import language
from .runner import Background
from .status_progress import StatusProgress


class ReportWriter(Background):
    """One report: the job's data are collected here and now (raises InputError), the rest goes on in a
    thread.
    """

    running = None  # the one that is at work

    def __init__(self, job: DocumentObject, path: Path | str) -> None:
        self.path = Path(path)
        self.folder = job_inputs.scratch_folder()
        result, title, notes = reports.result_to_report(job, self.folder.name)
        words = language()
        self.status = StatusProgress(self.cancel)
        self.begin = time.monotonic()
        super().__init__(
            lambda context: reporting.report(result, self.path, None, words, title, context, notes),
            self._finish,
        )
        ReportWriter.running = self
        self._poll()

    def _poll(self) -> None:
        self.status.update_progress(0.0, translate("BeltGrinding", "Writing the report"))
        super()._poll()

    def _finish(self, path: Path | None, error: BaseException | None) -> None:
        ReportWriter.running = None
        self.status.remove()
        self.folder.cleanup()
        if error is None:
            FreeCAD.Console.PrintMessage(f"{self.path}\n")
            QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(self.path)))
        elif not isinstance(error, Cancelled):
            say(error)
