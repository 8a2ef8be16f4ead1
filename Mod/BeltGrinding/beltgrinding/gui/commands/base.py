"""What every command has: its job, its undo step, how it says an error."""

import traceback

import FreeCAD
import FreeCADGui as Gui

from ... import InputError
from ...objects.job_object import BeltGrindingJob
from ...objects.proxy import type_of
from ..icons import icon
from ..start import tell

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


def report(error):
    """Says an error in the report view and, where there is a user to see it, in a message."""
    if not isinstance(error, InputError):
        lines = traceback.format_exception(type(error), error, error.__traceback__)
        FreeCAD.Console.PrintError("".join(lines))
    tell(str(error))


def expand(job):
    """Opens the job in the tree."""
    Gui.getDocument(job.Document.Name).toggleTreeItem(job, EXPAND)


class transaction:
    """One undo step; aborted, and the error reported, if the block fails. ``panel``: the step stays
    open for the panel that follows, whose Cancel takes it back.
    """

    def __init__(self, document, name, panel=False):
        self.document, self.name, self.panel = document, name, panel
        self.failed = False

    def __enter__(self):
        self.document.openTransaction(self.name)
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            if not self.panel:
                self.document.commitTransaction()
            return False
        self.failed = True
        self.document.abortTransaction()
        if issubclass(kind, Exception):
            report(error)
            return True
        return False


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
