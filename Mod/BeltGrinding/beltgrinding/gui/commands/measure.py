"""The ground part for other measuring programs, and what a scanner measured."""

import FreeCAD
import FreeCADGui as Gui

from ...objects import api, deviation, simulation
from ...objects.job_data import child, children
from ..common.compat import translate
from ..common.transaction import transaction
from .base import Command, active_job

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Measured(Command):
    """Base: there must be a result."""

    def IsActive(self):
        return super().IsActive() and child(active_job(), simulation.Simulation) is not None


class GroundMesh(Measured):
    NAME = "BeltGrinding_GroundMesh"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_GroundMesh", "Ground part as mesh")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_GroundMesh",
        "Makes the whole part as ground, one closed mesh, to measure or export; once more after a "
        "new simulation",
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Ground part as mesh")):
            api.make_ground_mesh(job)
            # Their surfaces are the same, more or less: they would shimmer through each other.
            hidden = {obj for obj, _ in job.DesignFaces}
            hidden.update(children(job, deviation.Deviation))
            for one in hidden:
                one.ViewObject.Visibility = False


class Scan(Measured):
    NAME = "BeltGrinding_Scan"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Scan", "Compare a scan...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Scan",
        "Lays a scan of the ground part on the design and compares it with the prediction",
    )

    def run(self):
        from ..panels.scan_panel import ScanPanel

        job = active_job()
        job.Document.openTransaction(translate("BeltGrinding", "Compare a scan"))
        Gui.Control.showDialog(ScanPanel(job))
