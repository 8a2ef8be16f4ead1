"""Job files, results of other machines, the example, the calibration."""

from pathlib import Path

import FreeCAD
import FreeCADGui as Gui

from ...objects import api
from ..common.compat import QtGui, translate
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from .base import Command, active_job, expand

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


def _jobs_filter():
    return translate("BeltGrinding", "Job") + " (*.json)"


class OpenJob(Command):
    NAME = "BeltGrinding_OpenJob"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_OpenJob", "Open job file...")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_OpenJob", "Makes document objects of a job.json")
    NEEDS_JOB = False

    def run(self):
        title = translate("BeltGrinding", "Open job file")
        path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", _jobs_filter())[0]
        if not path:
            return
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument(Path(path).stem)
        with transaction(document, translate("BeltGrinding", "Open job file")):
            expand(api.open_job(document, path))
            Gui.SendMsgToActiveView("ViewFit")


class ExportJob(Command):
    NAME = "BeltGrinding_ExportJob"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExportJob", "Export job file...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExportJob", "Writes the job as JSON, for beltgrind on another machine"
    )

    def run(self):
        title = translate("BeltGrinding", "Export job file")
        path = file_to_write(title, "job.json", _jobs_filter())
        if path:
            api.export_job(active_job(), path)


class ImportResult(Command):
    NAME = "BeltGrinding_ImportResult"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ImportResult", "Import result...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ImportResult", "Brings back what beltgrind computed on another machine"
    )

    def run(self):
        title = translate("BeltGrinding", "Folder of the result")
        folder = QtGui.QFileDialog.getExistingDirectory(Gui.getMainWindow(), title)
        if folder:
            job = active_job()
            with transaction(job.Document, translate("BeltGrinding", "Import result")):
                api.import_result(job, folder)


class ExampleBlade(Command):
    NAME = "BeltGrinding_ExampleBlade"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleBlade", "Example: compressor blade")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleBlade", "Makes a document with a blade, its stock and its program"
    )
    NEEDS_JOB = False
    EXAMPLE = "blade"

    def run(self):
        folder = Path(FreeCAD.getUserAppDataDir(), "BeltGrinding", self.EXAMPLE)
        expand(api.open_example(folder, self.EXAMPLE))
        Gui.activeDocument().activeView().viewIsometric()
        Gui.SendMsgToActiveView("ViewFit")


class ExampleTap(ExampleBlade):
    NAME = "BeltGrinding_ExampleTap"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleTap", "Example: mixer tap")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleTap", "Makes a document with a tap that a robot holds against the belt"
    )
    EXAMPLE = "tap"


class ExampleTapBelt(ExampleBlade):
    NAME = "BeltGrinding_ExampleTapBelt"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleTapBelt", "Example: tap spout on a free belt")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleTapBelt",
        "Makes a document with a tap whose spout a free belt wraps round",
    )
    EXAMPLE = "tap_belt"


class ExampleVane(ExampleBlade):
    NAME = "BeltGrinding_ExampleVane"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleVane", "Example: blade with fillet and edges")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleVane", "Makes a document with a blade that is ground on both sides"
    )
    EXAMPLE = "vane"


class ExampleKnife(ExampleBlade):
    NAME = "BeltGrinding_ExampleKnife"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleKnife", "Example: chef's knife")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleKnife",
        "Makes a document with a knife, ground by a robot that speeds up and slows down",
    )
    EXAMPLE = "knife"


class Calibrate(Command):
    NAME = "BeltGrinding_Calibrate"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Calibrate", "Calibrate removal law...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Calibrate", "Fits the law of removal to a table of measured grinds"
    )

    def run(self):
        from ..panels.calibration_panel import CalibrationPanel

        Gui.Control.showDialog(CalibrationPanel(active_job()))
