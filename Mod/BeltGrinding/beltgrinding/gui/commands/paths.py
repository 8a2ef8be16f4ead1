"""Robot programs, in and out, and paths made here."""

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ...objects import api, freecad_path, robot_path
from ...objects.proxy import type_of
from ..common.compat import QtGui, translate
from ..common.file_filters import programs_filter
from ..common.messages import error_text, inform
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from ..panels.panel import edit
from .base import Command, active_job

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class ImportProgram(Command):
    NAME = "BeltGrinding_ImportProgram"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ImportProgram", "Import robot program...")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_ImportProgram", "Reads a robot program into the job")

    def run(self):
        title = translate("BeltGrinding", "Import robot program")
        path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", programs_filter())[
            0
        ]
        if path:
            import_program(active_job(), path)


def import_program(job, path):
    """Imports a program's file into the job in a transaction and opens its panel."""
    with transaction(
        job.Document, translate("BeltGrinding", "Import robot program"), panel=True
    ) as step:
        program = api.import_program(job, path)
    if not step.failed:
        edit(program)


class FollowPath(Command):
    NAME = "BeltGrinding_FollowPath"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_FollowPath", "Follow selected path")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_FollowPath",
        "Grinds along the selected CAM path or robot trajectory of FreeCAD, and follows its changes",
    )

    def run(self):
        job = active_job()
        sources = [
            obj
            for obj in Gui.Selection.getSelection(job.Document.Name)
            if freecad_path.is_path(obj) and type_of(obj) != robot_path.RobotPath.TYPE
        ]
        if len(sources) != 1:
            raise InputError(
                "gui.select_path", "Select one CAM path or robot trajectory in the tree first."
            )
        with transaction(
            job.Document, translate("BeltGrinding", "Follow selected path"), panel=True
        ) as step:
            program = api.follow_path(job, sources[0])
        if not step.failed:
            edit(program)


class RasterPath(Command):
    NAME = "BeltGrinding_RasterPath"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_RasterPath", "Raster path...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_RasterPath",
        "Lays contact passes side by side on the selected faces, or on all faces of the job",
    )

    def run(self):
        job = active_job()
        faces = [
            (one.Object, [s for s in one.SubElementNames if s.startswith("Face")])
            for one in Gui.Selection.getSelectionEx(job.Document.Name)
            if hasattr(one.Object, "Shape")
            and any(s.startswith("Face") for s in one.SubElementNames)
        ]
        with transaction(
            job.Document, translate("BeltGrinding", "Raster path"), panel=True
        ) as step:
            path = api.make_raster(job, faces, compute=False)
        if not step.failed:
            edit(path)


class ReadAgain(Command):
    NAME = "BeltGrinding_ReadAgain"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ReadAgain", "Read programs again")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ReadAgain", "Reads the job's robot programs from their files again"
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Read programs again")):
            for path in job.Group:
                if type_of(path) == robot_path.RobotPath.TYPE and path.Source:
                    robot_path.load_program(path, path.Source)
            job.Document.recompute()


class ExportProgram(Command):
    NAME = "BeltGrinding_ExportProgram"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExportProgram", "Export robot program...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExportProgram",
        "Writes the selected robot path as KRL, RAPID, URScript or CSV",
    )

    NEEDS_JOB = False

    def candidates(self):
        """What could be meant: the selected paths, or those of the job, or those of the document."""
        document, job = FreeCAD.ActiveDocument, active_job()
        if document is None:
            return []
        for group in (
            Gui.Selection.getSelection(document.Name),
            [] if job is None else job.Group,
            document.Objects,
        ):
            found = [obj for obj in group if type_of(obj) == robot_path.RobotPath.TYPE]
            if found:
                return found
        return []

    def IsActive(self):
        return super().IsActive() and bool(self.candidates())

    def run(self):
        selected = self.candidates()
        if len(selected) != 1:
            raise InputError(
                "gui.select_robot_path", "Select the robot path that is to be written."
            )
        title = translate("BeltGrinding", "Export robot program")
        kinds = "KUKA KRL (*.src);;ABB RAPID (*.mod);;URScript (*.script);;CSV (*.csv)"
        path = file_to_write(title, f"{selected[0].Label}.src", kinds)
        if path:
            notes = api.export_program(selected[0], path)
            written = translate("BeltGrinding", "Written: {}").format(path)
            if notes:
                inform("\n\n".join([written, *map(error_text, notes), _how_to_set()]))
            else:
                FreeCAD.Console.PrintMessage(f"{written}\n")


def _how_to_set():
    return translate(
        "BeltGrinding",
        "To have the program set them, enter their names or numbers on the controller in the path's "
        "properties ProgramBase and ProgramTool.",
    )
