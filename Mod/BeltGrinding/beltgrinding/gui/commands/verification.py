"""Tolerance zones, and the verdict by them."""

import FreeCAD
import FreeCADGui as Gui

from ...objects import api, simulation
from ...objects.job_data import child
from ..common.compat import translate
from ..common.transaction import transaction
from .base import Command, active_job

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Zones(Command):
    NAME = "BeltGrinding_Zones"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Zones", "Tolerance zones...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Zones",
        "Gives faces, edges and the thickness tolerances of their own",
    )

    def run(self):
        from ..panels.zones_panel import ZonesPanel

        job = active_job()
        if not job.Document.HasPendingTransaction:
            job.Document.openTransaction(translate("BeltGrinding", "Tolerance zones"))
        Gui.Control.showDialog(ZonesPanel(job))


class Verdict(Command):
    NAME = "BeltGrinding_Verdict"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Verdict", "Verdict")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Verdict",
        "In tolerance or not, where not, and which motion of the program did it",
    )

    def IsActive(self):
        return super().IsActive() and child(active_job(), simulation.Simulation) is not None

    def run(self):
        from ..docks.verdict_dock import VerdictDock

        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Verdict")) as step:
            verdict = api.make_verdict(job)
        if not step.failed:
            VerdictDock.open(verdict)
