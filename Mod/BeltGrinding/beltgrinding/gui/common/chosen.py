"""What commands and messages are about."""

from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from ...objects.job_object import BeltGrindingJob
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of


def active_job() -> DocumentObject:
    """The selected job, or the job of the selected object, or the document's only one; or None."""
    document = FreeCAD.ActiveDocument
    if document is None:
        return None
    for obj in Gui.Selection.getSelection(document.Name):
        while obj is not None:
            if type_of(obj) == BeltGrindingJob.TYPE:
                return obj
            obj = obj.getParentGroup()
    jobs = [obj for obj in document.Objects if type_of(obj) == BeltGrindingJob.TYPE]
    return jobs[0] if len(jobs) == 1 else None
