"""What every command has: its job, its undo step, how it says an error."""

import FreeCAD
import FreeCADGui as Gui

from ...objects.job_object import BeltGrindingJob
from ...objects.proxy import type_of
from ..common.icons import icon
from ..common.messages import report

EXPAND = 2  # toggleTreeItem's modes: 0 toggle, 1 collapse, 2 expand


def active_job():
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


def expand(job):
    """Opens the job in the tree."""
    Gui.getDocument(job.Document.Name).toggleTreeItem(job, EXPAND)


class Command:
    """Base. Subclasses give NAME, TEXT, TIP, and do their work in ``run``."""

    NAME = TEXT = TIP = ""
    NEEDS_JOB = True

    def GetResources(self):
        return {"Pixmap": icon(self.NAME), "MenuText": self.TEXT, "ToolTip": self.TIP}

    def IsActive(self):
        if Gui.Control.activeDialog():
            return False
        return not self.NEEDS_JOB or active_job() is not None

    def Activated(self, index=0):
        try:
            self.run()
        except Exception as error:
            report(error)

    def run(self):
        raise NotImplementedError
