"""Telling others of a result: the report, the figures, and whether the settings are fine enough."""

from pathlib import Path

import FreeCAD
import FreeCADGui as Gui

from ...objects import api, simulation
from ...objects.job_data import child
from ..common.compat import translate
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from .base import Command, active_job

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class _OfResult(Command):
    """Needs a result."""

    def IsActive(self):
        return super().IsActive() and child(active_job(), simulation.Simulation) is not None


class Report(_OfResult):
    NAME = "BeltGrinding_Report"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Report", "Report...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Report",
        "Writes verdict, pictures, events and the job itself into one HTML or PDF file",
    )

    def IsActive(self):
        from ..common.report_writer import ReportWriter

        return super().IsActive() and ReportWriter.running is None

    def run(self):
        from ..common.report_writer import ReportWriter

        job = active_job()
        path = file_to_write(
            translate("BeltGrinding", "Report"),
            f"{Path(job.Document.FileName or job.Document.Name).stem}.html",
            "HTML (*.html *.htm);;PDF (*.pdf)",
        )
        if path:
            ReportWriter(job, path)


class CheckSettings(Command):
    NAME = "BeltGrinding_CheckSettings"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_CheckSettings", "Check settings...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_CheckSettings",
        "Are spacing and steps fine enough? Simulates coarser, as given and finer",
    )

    def run(self):
        from ..panels.settings_check_panel import SettingsCheckPanel

        Gui.Control.showDialog(SettingsCheckPanel(active_job()))


class Figures(_OfResult):
    NAME = "BeltGrinding_Figures"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Figures", "Figures in a spreadsheet")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Figures", "Makes a spreadsheet of the figures that follows the result"
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Figures")) as step:
            sheet = api.make_figures(job)
        if not step.failed:
            view = sheet.ViewObject
            # From 1.0 on a double click changes to the Spreadsheet workbench; 0.20 knows only that.
            getattr(view, "showSheetMdi", view.doubleClicked)()
