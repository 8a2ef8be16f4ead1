"""What every command has: its job, when it is ready, its undo step, how it says an error."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import FreeCAD
import FreeCADGui as Gui

from ...objects import simulation
from ...objects.job_data import child
from ...objects.job_object import BeltGrindingJob
from ...objects.kinds import Document, DocumentObject
from ...objects.proxy import type_of
from ..common.chosen import activate, active_job, jobs_of
from ..common.compat import translate
from ..common.editing import end_left_over
from ..common.icons import icon
from ..common.greyed import say_reason
from ..common.messages import report
from ..common.transaction import transaction

if TYPE_CHECKING:
    from ...objects.proxy import Proxy

PREFIX = "BeltGrinding_"  # of all names
EXPAND = 2  # toggleTreeItem's modes: 0 toggle, 1 collapse, 2 expand


def expand(job: DocumentObject) -> None:
    """Opens the job in the tree."""
    Gui.getDocument(job.Document.Name).toggleTreeItem(job, EXPAND)


# Whether a command can run: '' if so, else why not and what to do.


def always() -> str:
    return ""


def no_document() -> str:
    if FreeCAD.ActiveDocument is not None:
        return ""
    return translate("BeltGrinding", "No document is open: open or make one.")


def no_job() -> str:
    """Why there is no active job."""
    if active_job() is not None:
        return ""
    reason = no_document()
    if reason:
        return reason
    if jobs_of(FreeCAD.ActiveDocument):
        return translate("BeltGrinding", "The document has several jobs: select one in the tree.")
    return translate("BeltGrinding", "The document has no job: select faces and press New job.")


def no_result() -> str:
    """Why the active job has no result."""
    reason = no_job()
    if reason or child(active_job(), simulation.Simulation) is not None:
        return reason
    return translate("BeltGrinding", "The job has no result yet: press Simulate.")


def make(
    document: Document,
    title: str,
    make: Callable[[], Any],
    show: Callable[[Any], object],
    panel: bool = True,
) -> None:
    """Shows what ``make()`` makes, in one undo step; a failure is reported and shows nothing. ``panel``: the step
    stays open for the panel that ``show`` opens."""
    with transaction(document, title, panel=panel) as step:
        made = make()
    if not step.failed:
        show(made)


def make_once(
    proxy: type[Proxy],
    title: str,
    make_for: Callable[[DocumentObject], DocumentObject],
    show: Callable[[DocumentObject], object],
    panel: bool = True,
) -> None:
    """Shows the active job's child of a kind (a proxy's class), made by ``make_for(job)`` where it has none yet, as in
    ``make``."""
    job = active_job()
    found = child(job, proxy)
    if found is None:
        make(job.Document, title, lambda: make_for(job), show, panel)
    else:
        show(found)


class Command:
    """A command as FreeCAD takes it. ``run()``: does its work, and raises what is to be told; ``missing()``: '' if it
    can, else why not, which its tooltip says; ``keys``: its shortcut."""

    def __init__(
        self,
        name: str,
        text: str,
        tip: str,
        keys: str,
        run: Callable[[], object],
        missing: Callable[[], str] = no_job,
    ) -> None:
        self.name, self.text, self.tip, self.keys = PREFIX + name, text, tip, keys
        self.run, self.missing = run, missing

    def GetResources(self) -> dict[str, str]:
        return {
            "Pixmap": icon(self.name),
            "MenuText": self.text,
            "ToolTip": self.tip,
            "WhatsThis": self.name,
            "CmdType": "ForEdit",  # else FreeCAD greys it beside a panel without asking why
            **({"Accel": self.keys} if self.keys else {}),
        }

    def IsActive(self) -> bool:
        if Gui.Control.activeDialog():
            reason = translate("BeltGrinding", "A task panel is open: close it first.")
        else:
            reason = self.missing()
        say_reason(self.name, reason)
        return not reason

    def Activated(self, index: int = 0) -> None:
        try:
            end_left_over()
            job = active_job()
            if job is not None:
                activate(job)
            self.run()
        except Exception as error:
            report(error)
