"""Tolerance zones, and the verdict by them."""

from __future__ import annotations

from ...objects import api
from ..common.compat import translate
from ..common.task_panel import show_panel
from .base import active_job, make


def edit_zones() -> None:
    from ..panels.zones_panel import ZonesPanel

    job = active_job()
    if not job.Document.HasPendingTransaction:
        job.Document.openTransaction(translate("BeltGrinding", "Tolerance zones"))
    show_panel(ZonesPanel(job), job)


def show_verdict() -> None:
    from ..docks.verdict_dock import VerdictDock

    job = active_job()
    title = translate("BeltGrinding", "Verdict")
    make(job.Document, title, lambda: api.make_verdict(job), VerdictDock.open, panel=False)
