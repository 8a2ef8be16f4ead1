"""What commands and messages are about."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...objects.job_object import BeltGrindingJob
from ...objects.kinds import Document, DocumentObject
from ...objects.proxy import type_of


ACTIVE = "beltgrindingjob"  # by which a view knows its active job, which FreeCAD's tree marks


def active_job() -> DocumentObject:
    """The selected job, or the job of the selected object, or the active one, or the document's only one; or None."""
    document = FreeCAD.ActiveDocument
    if document is None:
        return None
    for obj in Gui.Selection.getSelection(document.Name):
        while obj is not None:
            if type_of(obj) == BeltGrindingJob.TYPE:
                return obj
            obj = obj.getParentGroup()
    jobs, marked = jobs_of(document), _marked(document)
    if len(jobs) == 1:
        return jobs[0]
    return marked if marked in jobs else None


def activate(job: DocumentObject) -> None:
    """Makes a job the active one of its document, marked in the tree; where it is the only one there is nothing to
    mark."""
    found = _view(job.Document)
    several = len(jobs_of(job.Document)) > 1
    if found is not None and _marked(job.Document) is not (job if several else None):
        found.setActiveObject(ACTIVE, job if several else None)


def _marked(document: Document) -> DocumentObject | None:
    view = _view(document)
    return None if view is None else view.getActiveObject(ACTIVE)


def _view(document: Document) -> Any:
    """The 3D view whose active objects count: the first."""
    views = Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")
    return views[0] if views else None


def jobs_of(document: Document) -> list[DocumentObject]:
    """A document's grinding jobs."""
    return [obj for obj in document.Objects if type_of(obj) == BeltGrindingJob.TYPE]
