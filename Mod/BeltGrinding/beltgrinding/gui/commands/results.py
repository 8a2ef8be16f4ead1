"""The simulation, and what it shows."""

import FreeCAD
import FreeCADGui as Gui

from ...objects import api, deviation, plan, simulation, study
from ...objects.job_data import child
from ..common.compat import translate
from ..common.transaction import transaction
from ..panels.panel import edit
from .base import Command, active_job
from .set_up import new_job

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Simulate(Command):
    NAME = "BeltGrinding_Simulate"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Simulate", "Simulate")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_Simulate", "Grinds the job; FreeCAD stays usable")

    def run(self):
        from ..panels.simulation_panel import SimulationPanel

        Gui.Control.showDialog(SimulationPanel(active_job(), True))


class Plan(Command):
    NAME = "BeltGrinding_Plan"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Plan", "Plan feeds...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Plan",
        "Looks for the feeds and forces with which the programs bring the part into tolerance",
    )

    def run(self):
        from ..panels.plan_panel import show

        job = active_job()
        obj = child(job, plan.Plan)
        if obj is None:
            with transaction(job.Document, translate("BeltGrinding", "Plan")) as step:
                obj = api.make_plan(job, compute=False)
            if step.failed:
                return
        show(obj)


class BeltPlan(Command):
    NAME = "BeltGrinding_BeltPlan"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_BeltPlan", "Belt plan...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_BeltPlan",
        "When to change the belt over a batch of parts, and how feed or force follow its wear",
    )

    def run(self):
        from ..panels.belt_plan_panel import BeltPlanPanel

        Gui.Control.showDialog(BeltPlanPanel(active_job()))


class Study(Command):
    NAME = "BeltGrinding_Study"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Study", "Study...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Study",
        "Simulates the job many times with other values: yield, what matters most, the best setting",
    )

    def run(self):
        from ..docks.study_dock import show

        job = active_job()
        obj = child(job, study.Study)
        if obj is None:
            with transaction(job.Document, translate("BeltGrinding", "Study")) as step:
                obj = api.make_study(job, compute=False)
            if step.failed:
                return
        show(obj)


class GrindFaces(Command):
    NAME = "BeltGrinding_GrindFaces"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_GrindFaces", "Grind these faces...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_GrindFaces",
        "Lays passes on the selected faces, or the job's, and plans their feeds and forces, until they are in "
        "tolerance, or says why not",
    )
    NEEDS_JOB = False

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and super().IsActive()

    def run(self):
        from ..panels.plan_panel import show

        job = active_job()
        if job is None:
            job = new_job()
            if job is None:
                return
            job.Document.commitTransaction()
        with transaction(job.Document, translate("BeltGrinding", "Plan")) as step:
            plan.passes_of(job)
            obj = api.make_plan(job, compute=False, LayPasses=True)
        if not step.failed:
            Gui.Selection.clearSelection()  # its colour would hide those of the plan
            show(obj, True)


class Deviation(Command):
    NAME = "BeltGrinding_Deviation"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Deviation", "Deviation")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Deviation", "Lays the deviation from the design over the part in colour"
    )

    def IsActive(self):
        return super().IsActive() and child(active_job(), simulation.Simulation) is not None

    def run(self):
        job = active_job()
        found = child(job, deviation.Deviation)
        if found is None:
            with transaction(
                job.Document, translate("BeltGrinding", "Deviation"), panel=True
            ) as step:
                found = api.make_deviation(job)
                for part in {obj for obj, _ in job.DesignFaces}:
                    part.ViewObject.Visibility = False
            if step.failed:
                return
        edit(found)


class Section(Command):
    NAME = "BeltGrinding_Section"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Section", "Cross-section")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Section",
        "Cuts the result: design, stock and ground profile along a plane or between two points",
    )

    def IsActive(self):
        return super().IsActive() and child(active_job(), simulation.Simulation) is not None

    def run(self):
        from ..docks.section_dock import SectionDock

        job = active_job()
        with transaction(job.Document, "Cross-section") as step:
            section = api.make_section(job)
        if not step.failed:
            SectionDock.open(section)


class Playback(Command):
    NAME = "BeltGrinding_Playback"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Playback", "Playback")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Playback", "Shows the recorded simulation at any moment, under the 3D view"
    )

    def run(self):
        from ..docks.playback_dock import show

        show(active_job())


class Contact(Command):
    NAME = "BeltGrinding_Contact"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Contact", "Contact at a pose...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Contact", "Shows the pressure on the wheel's footprint at any pose"
    )

    def run(self):
        from ..panels.contact_panel import ContactPanel

        Gui.Control.showDialog(ContactPanel(active_job()))
