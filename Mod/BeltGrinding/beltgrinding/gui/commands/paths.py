"""Robot programs, in and out, and paths made here."""

from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ...objects import api, freecad_path, robot_path, robot_program
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ..common.compat import QtGui, translate
from ..common.file_filters import programs_filter
from ..common.messages import error_text, inform
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from ..common.editing import edit_in_step
from .base import active_job, make, make_once, no_document


def choose_program() -> None:
    title = translate("BeltGrinding", "Import robot program")
    window = Gui.getMainWindow()
    path = QtGui.QFileDialog.getOpenFileName(window, title, "", programs_filter())[0]
    if path:
        import_program(active_job(), path)


def import_program(job: DocumentObject, path: str) -> None:
    """Imports a program's file into the job in a transaction and opens its panel."""
    title = translate("BeltGrinding", "Import robot program")
    make(job.Document, title, lambda: api.import_program(job, path), edit_in_step)


def follow_selected() -> None:
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
    title = translate("BeltGrinding", "Follow selected path")
    make(job.Document, title, lambda: api.follow_path(job, sources[0]), edit_in_step)


def make_raster() -> None:
    job = active_job()
    faces = [
        (one.Object, [s for s in one.SubElementNames if s.startswith("Face")])
        for one in Gui.Selection.getSelectionEx(job.Document.Name)
        if hasattr(one.Object, "Shape") and any(s.startswith("Face") for s in one.SubElementNames)
    ]
    title = translate("BeltGrinding", "Raster path")
    make(job.Document, title, lambda: api.make_raster(job, faces, compute=False), edit_in_step)


def read_again() -> None:
    job = active_job()
    with transaction(job.Document, translate("BeltGrinding", "Read programs again")):
        for path in job.Group:
            if type_of(path) == robot_path.RobotPath.TYPE and path.Source:
                robot_path.load_program(path, path.Source)
        job.Document.recompute()


def plan_robot() -> None:
    from ..panels.robot_program_panel import show

    make_once(
        robot_program.RobotProgram,
        translate("BeltGrinding", "Robot program"),
        lambda job: api.make_robot_program(job, compute=False),
        show,
    )


def _to_export() -> list[DocumentObject]:
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


def no_path() -> str:
    """Why there is no path to export."""
    if FreeCAD.ActiveDocument is None:
        return no_document()
    if _to_export():
        return ""
    return translate("BeltGrinding", "The document has no robot path: import or lay one.")


def export_program() -> None:
    selected = _to_export()
    if len(selected) != 1:
        raise InputError("gui.select_robot_path", "Select the robot path that is to be written.")
    title = translate("BeltGrinding", "Export robot program")
    kinds = "KUKA KRL (*.src);;ABB RAPID (*.mod);;URScript (*.script);;"
    kinds += "Fanuc TP (*.ls);;Yaskawa INFORM (*.jbi);;CSV (*.csv)"
    path = file_to_write(title, f"{selected[0].Label}.src", kinds)
    if path:
        notes = api.export_program(selected[0], path)
        written = translate("BeltGrinding", "Written: {}").format(path)
        if notes:
            inform("\n\n".join([written, *map(error_text, notes), _how_to_set()]))
        else:
            FreeCAD.Console.PrintMessage(f"{written}\n")


def _how_to_set() -> str:
    return translate(
        "BeltGrinding",
        "To have the program set them, enter their names or numbers on the controller in the path's "
        "properties “Program Base” and “Program Tool”.",
    )
