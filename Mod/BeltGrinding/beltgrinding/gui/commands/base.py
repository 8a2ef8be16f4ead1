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
from ..common.chosen import active_job
from ..common.icons import icon
from ..common.messages import report
from ..common.transaction import transaction

if TYPE_CHECKING:
    from ...objects.proxy import Proxy

PREFIX = "BeltGrinding_"  # of all names
EXPAND = 2  # toggleTreeItem's modes: 0 toggle, 1 collapse, 2 expand


def expand(job: DocumentObject) -> None:
    """Opens the job in the tree."""
    Gui.getDocument(job.Document.Name).toggleTreeItem(job, EXPAND)


def always() -> bool:
    return True


def has_document() -> bool:
    return FreeCAD.ActiveDocument is not None


def has_job() -> bool:
    return active_job() is not None


def has_result() -> bool:
    """Whether the active job was simulated."""
    job = active_job()
    return job is not None and child(job, simulation.Simulation) is not None


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
    """A command as FreeCAD takes it. ``run()``: does its work, and raises what is to be told; ``ready()``: whether it
    can, while no panel is open."""

    def __init__(
        self,
        name: str,
        text: str,
        tip: str,
        run: Callable[[], object],
        ready: Callable[[], bool] = has_job,
    ) -> None:
        self.name, self.text, self.tip = PREFIX + name, text, tip
        self.run, self.ready = run, ready

    def GetResources(self) -> dict[str, str]:
        return {"Pixmap": icon(self.name), "MenuText": self.text, "ToolTip": self.tip}

    def IsActive(self) -> bool:
        return not Gui.Control.activeDialog() and self.ready()

    def Activated(self, index: int = 0) -> None:
        try:
            self.run()
        except Exception as error:
            report(error)
