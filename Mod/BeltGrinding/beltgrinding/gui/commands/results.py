"""The simulation, and what it shows."""

from __future__ import annotations

import FreeCADGui as Gui

from ...objects import api, deviation, plan, study
from ...objects.job_data import child
from ...objects.kinds import DocumentObject
from ..common.compat import translate
from ..common.transaction import commit
from ..common.task_panel import show_panel
from ..common.editing import edit_in_step
from .base import active_job, make, make_once
from .set_up import new_job


def simulate() -> None:
    from ..panels.simulation_panel import SimulationPanel

    show_panel(SimulationPanel(active_job(), True), active_job())


def plan_feeds() -> None:
    from ..panels.plan_panel import show

    title = translate("BeltGrinding", "Plan")
    make_once(plan.Plan, title, lambda job: api.make_plan(job, compute=False), show)


def plan_belts() -> None:
    from ..panels.belt_plan_panel import BeltPlanPanel

    show_panel(BeltPlanPanel(active_job()), active_job())


def show_study() -> None:
    from ..docks.study_dock import show

    title = translate("BeltGrinding", "Study")
    make_once(study.Study, title, lambda job: api.make_study(job, compute=False), show)


def grind_faces() -> None:
    from ..panels.plan_panel import show

    job = active_job()
    if job is None:
        job = new_job()
        if job is None:
            return
        commit(job.Document)

    def passes() -> DocumentObject:
        plan.passes_of(job)
        return api.make_plan(job, compute=False, LayPasses=True, SearchSeconds=plan.SEARCH_S)

    def show_plan(obj: DocumentObject) -> None:
        Gui.Selection.clearSelection()  # its colour would hide those of the plan
        show(obj)

    make(job.Document, translate("BeltGrinding", "Plan"), passes, show_plan)


def show_deviation() -> None:
    make_once(deviation.Deviation, translate("BeltGrinding", "Deviation"), _deviation, edit_in_step)


def _deviation(job: DocumentObject) -> DocumentObject:
    found = api.make_deviation(job)
    for part in {obj for obj, _ in job.DesignFaces}:
        part.ViewObject.Visibility = False
    return found


def show_section() -> None:
    from ..docks.section_dock import SectionDock

    job = active_job()
    make(
        job.Document, "Cross-section", lambda: api.make_section(job), SectionDock.open, panel=False
    )


def play() -> None:
    from ..docks.playback_dock import show

    show(active_job())


def show_contact() -> None:
    from ..panels.contact_panel import ContactPanel

    show_panel(ContactPanel(active_job()), active_job())
