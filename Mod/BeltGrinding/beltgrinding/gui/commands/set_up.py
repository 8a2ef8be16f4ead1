"""What is ground, by what machine."""

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ...objects import api, belt_machine, preferences, stock
from ...objects.job_data import child
from ..common.compat import translate
from ..common.transaction import transaction
from ..panels.panel import edit
from .base import Command, active_job, expand

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class NewJob(Command):
    NAME = "BeltGrinding_Job"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Job", "New job")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Job", "Makes a grinding job of the selected faces or part"
    )
    NEEDS_JOB = False

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and not Gui.Control.activeDialog()

    def run(self):
        job = new_job()
        if job is not None:
            edit(job)


def new_job():
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
        job = api.make_job(links, **preferences.job_defaults())
        text = translate("BeltGrinding", "Looking at the part for first values")
        job.Proxy.proposed = api.set_up(job, text)
    if step.failed:
        return None
    expand(job)
    return job


class _Child(Command):
    """Makes or edits the child of a kind."""

    PROXY = None

    def make(self, job):
        raise NotImplementedError

    def run(self):
        job = active_job()
        found = child(job, self.PROXY)
        if found is None:
            with transaction(job.Document, self.TEXT, panel=True) as step:
                found = self.make(job)
            if step.failed:
                return
        edit(found)


class Stock(_Child):
    NAME = "BeltGrinding_Stock"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Stock", "Stock")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_Stock", "Says what stock lies on the design faces")
    PROXY = stock.Stock

    def make(self, job):
        return api.make_stock(job)


class BeltMachine(_Child):
    NAME = "BeltGrinding_BeltMachine"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_BeltMachine", "Belt machine")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_BeltMachine", "Describes contact wheel, belt, force control and cell"
    )
    PROXY = belt_machine.BeltMachine

    def make(self, job):
        return api.make_belt_machine(job)


class Cell(Command):
    NAME = "BeltGrinding_Cell"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Cell", "Cell")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Cell", "Says who holds what, and where; shows the wheel at every pose"
    )

    def run(self):
        from ..panels.cell_panel import CellPanel

        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Cell"), panel=True) as step:
            panel = CellPanel(api.make_belt_machine(job))
        if not step.failed:
            Gui.Control.showDialog(panel)


class Belt(Command):
    NAME = "BeltGrinding_Belt"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Belt", "Belt")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Belt", "Puts a belt on the machine that carries its wear from run to run"
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Belt"), panel=True) as step:
            belt = api.make_belt(job)
        if not step.failed:
            edit(belt)
