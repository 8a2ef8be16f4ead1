"""Writes a report while FreeCAD stays usable, and opens it."""

import time
from pathlib import Path

import FreeCAD

from .. import Cancelled, reporting
from ..objects import job_object, telling
from .commands.base import report as say
from .compat import QtCore, QtGui, translate
from .runner import Background
from .spoken import language
from .status_progress import StatusProgress


class ReportWriter(Background):
    """One report: the job's data are collected here and now (raises InputError), the rest goes on in a
    thread.
    """

    running = None  # the one that is at work

    def __init__(self, job, path):
        self.path = Path(path)
        self.folder = job_object.scratch_folder()
        result, title, notes = telling.report_data(job, self.folder.name)
        pdf = self.path if self.path.suffix.lower() == ".pdf" else None
        html = self.path.with_suffix(".html") if pdf else self.path
        words = language()
        self.status = StatusProgress(self.cancel)
        self.begin = time.monotonic()
        super().__init__(
            lambda context: reporting.report(result, html, pdf, words, title, context, notes),
            self._finish,
        )
        ReportWriter.running = self
        self._poll()

    def _poll(self):
        self.status.update_progress(0.0, translate("BeltGrinding", "Writing the report"))
        super()._poll()

    def _finish(self, path, error):
        ReportWriter.running = None
        self.status.remove()
        self.folder.cleanup()
        if error is None:
            FreeCAD.Console.PrintMessage(f"{self.path}\n")
            QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(self.path)))
        elif not isinstance(error, Cancelled):
            say(error)
