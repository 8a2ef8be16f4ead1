"""What is ground, by what machine."""

from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ...objects import api, belt_machine, first_settings, preferences, stock
from ...objects.kinds import DocumentObject
from ..common.chosen import activate
from ..common.compat import translate
from ..common.transaction import transaction
from ..common.task_panel import show_panel
from ..common.editing import edit_in_step
from .base import active_job, expand, make, make_once


def edit_new_job() -> None:
    job = new_job()
    if job is not None:
        edit_in_step(job)


def new_job() -> DocumentObject | None:
    """A job of the selected faces, with first values; None where it failed, which is told then. Raises InputError."""
    document = FreeCAD.ActiveDocument
    links = []
    for one in Gui.Selection.getSelectionEx(document.Name):
        if hasattr(one.Object, "Shape") and one.Object.Shape.Faces:
            links.append((one.Object, [s for s in one.SubElementNames if s.startswith("Face")]))
        elif hasattr(one.Object, "Mesh"):
            links.append((one.Object, []))
    if not links:
        raise InputError(
            "gui.select_faces", "Select the faces to be ground, the part, or a mesh, first."
        )
    with transaction(document, translate("BeltGrinding", "New grinding job"), panel=True) as step:
        job = api.make_job(links, (), **preferences.job_defaults())
        text = translate("BeltGrinding", "Looking at the part for first values")
        found = api.set_up(job, text)
        if "feed_mm_s" in found:
            text = translate("BeltGrinding", "Grinding coarsely what the first values bring")
            found["in_tolerance"] = first_settings.expected(job, text)
        job.Proxy.proposed = found
    if step.failed:
        return None
    expand(job)
    activate(job)
    return job


def edit_stock() -> None:
    make_once(stock.Stock, "Stock", api.make_stock, edit_in_step)


def edit_machine() -> None:
    make_once(belt_machine.BeltMachine, "Belt machine", api.make_belt_machine, edit_in_step)


def show_cell() -> None:
    from ..panels.cell_panel import CellPanel

    job = active_job()
    title = translate("BeltGrinding", "Cell")
    make(
        job.Document,
        title,
        lambda: CellPanel(api.make_belt_machine(job)),
        lambda panel: show_panel(panel, job),
    )


def edit_belt() -> None:
    job = active_job()
    make(job.Document, translate("BeltGrinding", "Belt"), lambda: api.make_belt(job), edit_in_step)
