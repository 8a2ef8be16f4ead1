"""The ground part for other measuring programs, and what a scanner measured."""

from __future__ import annotations

import FreeCADGui as Gui

from ...objects import api, deviation
from ...objects.job_data import children
from ..common.compat import translate
from ..common.transaction import transaction
from ..common.task_panel import show_panel
from .base import active_job


def make_ground_mesh() -> None:
    job = active_job()
    with transaction(job.Document, translate("BeltGrinding", "Ground part as mesh")):
        api.make_ground_mesh(job)
        # Their surfaces are the same, more or less: they would shimmer through each other.
        hidden = {obj for obj, _ in job.DesignFaces}
        hidden.update(children(job, deviation.Deviation))
        for one in hidden:
            one.ViewObject.Visibility = False


def compare_scan() -> None:
    from ..panels.scan_panel import ScanPanel

    job = active_job()
    selected = Gui.Selection.getSelection(job.Document.Name)
    job.Document.openTransaction(translate("BeltGrinding", "Compare a scan"))
    panel = ScanPanel(job)
    for obj in selected[:1]:
        panel.choose(obj)
    show_panel(panel, job)
