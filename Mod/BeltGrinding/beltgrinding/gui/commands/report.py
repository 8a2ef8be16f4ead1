"""Telling others of a result: the report, the figures, and whether the settings are fine enough."""

from __future__ import annotations

from pathlib import Path


from ...objects import api
from ...objects.kinds import DocumentObject, Sheet
from ..common.compat import translate
from ..common.save_dialog import file_to_write
from ..common.task_panel import show_panel
from .base import active_job, no_result, make


def no_report() -> str:
    """Why no report can be written now."""
    from ..common.report_writer import ReportWriter

    if ReportWriter.running is not None:
        return translate("BeltGrinding", "A report is being written: wait for it.")
    return no_result()


def write_report() -> None:
    from ..common.report_writer import ReportWriter

    job = active_job()
    path = file_to_write(
        translate("BeltGrinding", "Report"),
        f"{Path(job.Document.FileName or job.Document.Name).stem}.html",
        "HTML (*.html *.htm);;PDF (*.pdf)",
    )
    if path:
        ReportWriter(job, path)


def check_settings() -> None:
    from ..panels.settings_check_panel import SettingsCheckPanel

    show_panel(SettingsCheckPanel(active_job()), active_job())


def make_figures() -> None:
    job = active_job()
    title = translate("BeltGrinding", "Figures")
    make(job.Document, title, lambda: api.make_figures(job), _show_sheet, panel=False)


def make_figures_page() -> None:
    job = active_job()
    title = translate("BeltGrinding", "Figures in a drawing")
    make(job.Document, title, lambda: api.make_figures_page(job), _show_page, panel=False)


def _show_page(page: DocumentObject) -> None:
    page.ViewObject.doubleClicked()


def _show_sheet(sheet: Sheet) -> None:
    view = sheet.ViewObject
    # From 1.0 on a double click changes to the Spreadsheet workbench; 0.20 knows only that.
    getattr(view, "showSheetMdi", view.doubleClicked)()
