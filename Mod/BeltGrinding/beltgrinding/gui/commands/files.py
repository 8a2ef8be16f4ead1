"""Job files, results of other machines, the examples, the calibration."""

from __future__ import annotations

from pathlib import Path

import FreeCAD
import FreeCADGui as Gui

from ...objects import api
from ..common.compat import QtGui, translate
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from ..common.task_panel import show_panel
from .base import PREFIX, active_job, expand


def _jobs_filter() -> str:
    return translate("BeltGrinding", "Job") + " (*.json)"


def open_job() -> None:
    title = translate("BeltGrinding", "Open job file")
    path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", _jobs_filter())[0]
    if not path:
        return
    document = FreeCAD.ActiveDocument
    if document is None or document.Objects:  # the part is no other one's
        document = FreeCAD.newDocument(Path(path).stem)
    with transaction(document, title):
        expand(api.open_job(document, path))
        Gui.SendMsgToActiveView("ViewFit")


def export_job() -> None:
    title = translate("BeltGrinding", "Export job file")
    path = file_to_write(title, "job.json", _jobs_filter())
    if path:
        api.export_job(active_job(), path)


def _templates_filter() -> str:
    return translate("BeltGrinding", "Template") + " (*.json)"


def export_template() -> None:
    title = translate("BeltGrinding", "Save as template")
    path = file_to_write(title, "template.json", _templates_filter())
    if path:
        api.export_template(active_job(), path)


def apply_template() -> None:
    title, job = translate("BeltGrinding", "Apply template"), active_job()
    path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", _templates_filter())[0]
    if path:
        with transaction(job.Document, title):
            api.apply_template(job, path)


def import_result() -> None:
    title = translate("BeltGrinding", "Folder of the result")
    folder = QtGui.QFileDialog.getExistingDirectory(Gui.getMainWindow(), title)
    if folder:
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Import result")):
            api.import_result(job, folder)


def open_example(example: str) -> None:
    """Makes a document of an example, a name of ``examples``."""
    folder = Path(FreeCAD.getUserAppDataDir(), "BeltGrinding", example)
    expand(api.open_example(folder, example))
    Gui.activeDocument().activeView().viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")


def run_example(example: str) -> None:
    """Makes a document of an example and simulates it."""
    open_example(example)
    Gui.runCommand(f"{PREFIX}Simulate")


def show_examples() -> None:
    from ..docks.examples_dock import show

    show(open_example, run_example)


def calibrate() -> None:
    from ..panels.calibration_panel import CalibrationPanel

    show_panel(CalibrationPanel(active_job()), active_job())
