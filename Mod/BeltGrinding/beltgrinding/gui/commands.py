"""The commands, in the order of work. What a button does, it does by beltgrinding.objects.api."""

import traceback
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui

from .. import InputError
from ..objects import (
    api,
    belt_machine,
    deviation,
    freecad_path,
    preferences,
    robot_path,
    simulation,
    stock,
)
from ..objects.job_object import BeltGrindingJob, child
from ..objects.proxy import type_of
from ..programs import file_pattern
from .compat import QtGui, translate
from .icons import icon
from .panel import edit
from .start import tell

EXPAND = 2  # toggleTreeItem's modes: 0 toggle, 1 collapse, 2 expand
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


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


def programs_filter():
    """What a file dialog for robot programs offers."""
    return translate("BeltGrinding", "Robot programs") + f" ({file_pattern()})"


def _jobs_filter():
    return translate("BeltGrinding", "Job") + " (*.json)"


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


class NewJob(Command):
    NAME = "BeltGrinding_Job"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Job", "New job")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Job", "Makes a grinding job of the selected faces or part"
    )
    NEEDS_JOB = False

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and not Gui.Control.activeDialog()

    def run(self):
        document = FreeCAD.ActiveDocument
        links = []
        for one in Gui.Selection.getSelectionEx(document.Name):
            if hasattr(one.Object, "Shape") and one.Object.Shape.Faces:
                links.append((one.Object, [s for s in one.SubElementNames if s.startswith("Face")]))
        if not links:
            raise InputError(
                translate("BeltGrinding", "Select the faces to be ground, or the part, first.")
            )
        with transaction(
            document, translate("BeltGrinding", "New grinding job"), panel=True
        ) as step:
            job = api.make_job(links, **preferences.job_defaults())
        if not step.failed:
            expand(job)
            edit(job)


class _Child(Command):
    """Makes or edits the child of a kind."""

    PROXY = None

    def make(self, job):
        raise NotImplementedError

    def run(self):
        job = active_job()
        found = child(job, self.PROXY)
        if found is None:
            with transaction(job.Document, self.TEXT, panel=True) as step:
                found = self.make(job)
            if step.failed:
                return
        edit(found)


class Stock(_Child):
    NAME = "BeltGrinding_Stock"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Stock", "Stock")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_Stock", "Says what stock lies on the design faces")
    PROXY = stock.Stock

    def make(self, job):
        return api.make_stock(job)


class BeltMachine(_Child):
    NAME = "BeltGrinding_BeltMachine"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_BeltMachine", "Belt machine")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_BeltMachine", "Describes contact wheel, belt, force control and cell"
    )
    PROXY = belt_machine.BeltMachine

    def make(self, job):
        return api.make_belt_machine(job)


class Cell(Command):
    NAME = "BeltGrinding_Cell"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Cell", "Cell")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Cell", "Says who holds what, and where; shows the wheel at every pose"
    )

    def run(self):
        from .cell_panel import CellPanel

        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Cell"), panel=True) as step:
            panel = CellPanel(api.make_belt_machine(job))
        if not step.failed:
            Gui.Control.showDialog(panel)


class Belt(Command):
    NAME = "BeltGrinding_Belt"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Belt", "Belt")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Belt", "Puts a belt on the machine that carries its wear from run to run"
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Belt"), panel=True) as step:
            belt = api.make_belt(job)
        if not step.failed:
            edit(belt)


class ImportProgram(Command):
    NAME = "BeltGrinding_ImportProgram"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ImportProgram", "Import robot program...")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_ImportProgram", "Reads a robot program into the job")

    def run(self):
        title = translate("BeltGrinding", "Import robot program")
        path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", programs_filter())[
            0
        ]
        if path:
            import_program(active_job(), path)


def import_program(job, path):
    """Imports a program's file into the job in a transaction and opens its panel."""
    with transaction(
        job.Document, translate("BeltGrinding", "Import robot program"), panel=True
    ) as step:
        program = api.import_program(job, path)
    if not step.failed:
        edit(program)


class FollowPath(Command):
    NAME = "BeltGrinding_FollowPath"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_FollowPath", "Follow selected path")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_FollowPath",
        "Grinds along the selected CAM path or robot trajectory of FreeCAD, and follows its changes",
    )

    def run(self):
        job = active_job()
        sources = [
            obj
            for obj in Gui.Selection.getSelection(job.Document.Name)
            if freecad_path.is_path(obj) and type_of(obj) != robot_path.RobotPath.TYPE
        ]
        if len(sources) != 1:
            raise InputError(
                translate(
                    "BeltGrinding", "Select one CAM path or robot trajectory in the tree first."
                )
            )
        with transaction(
            job.Document, translate("BeltGrinding", "Follow selected path"), panel=True
        ) as step:
            program = api.follow_path(job, sources[0])
        if not step.failed:
            edit(program)


class RasterPath(Command):
    NAME = "BeltGrinding_RasterPath"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_RasterPath", "Raster path...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_RasterPath",
        "Lays contact passes side by side on the selected faces, or on all faces of the job",
    )

    def run(self):
        job = active_job()
        faces = [
            (one.Object, [s for s in one.SubElementNames if s.startswith("Face")])
            for one in Gui.Selection.getSelectionEx(job.Document.Name)
            if hasattr(one.Object, "Shape")
            and any(s.startswith("Face") for s in one.SubElementNames)
        ]
        with transaction(
            job.Document, translate("BeltGrinding", "Raster path"), panel=True
        ) as step:
            path = api.make_raster(job, faces, compute=False)
        if not step.failed:
            edit(path)


class Simulate(Command):
    NAME = "BeltGrinding_Simulate"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Simulate", "Simulate")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_Simulate", "Grinds the job; FreeCAD stays usable")

    def run(self):
        from .simulation_panel import SimulationPanel

        Gui.Control.showDialog(SimulationPanel(active_job(), True))


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
        from .section_dock import show_section

        job = active_job()
        with transaction(job.Document, "Cross-section") as step:
            section = api.make_section(job)
        if not step.failed:
            show_section(section)


class Playback(Command):
    NAME = "BeltGrinding_Playback"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Playback", "Playback")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Playback", "Shows the recorded simulation at any moment, under the 3D view"
    )

    def run(self):
        from .playback import show

        show(active_job())


class Contact(Command):
    NAME = "BeltGrinding_Contact"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Contact", "Contact at a pose...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Contact", "Shows the pressure on the wheel's footprint at any pose"
    )

    def run(self):
        from .contact_panel import ContactPanel

        Gui.Control.showDialog(ContactPanel(active_job()))


class Calibrate(Command):
    NAME = "BeltGrinding_Calibrate"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_Calibrate", "Calibrate removal law...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_Calibrate", "Fits the law of removal to a table of measured grinds"
    )

    def run(self):
        from .calibration_panel import CalibrationPanel

        Gui.Control.showDialog(CalibrationPanel(active_job()))


class ExampleBlade(Command):
    NAME = "BeltGrinding_ExampleBlade"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExampleBlade", "Example: compressor blade")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExampleBlade", "Makes a document with a blade, its stock and its program"
    )
    NEEDS_JOB = False

    def run(self):
        folder = Path(FreeCAD.getUserAppDataDir(), "BeltGrinding", "blade")
        expand(api.open_example(folder))
        Gui.activeDocument().activeView().viewIsometric()
        Gui.SendMsgToActiveView("ViewFit")


class OpenJob(Command):
    NAME = "BeltGrinding_OpenJob"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_OpenJob", "Open job file...")
    TIP = QT_TRANSLATE_NOOP("BeltGrinding_OpenJob", "Makes document objects of a job.json")
    NEEDS_JOB = False

    def run(self):
        title = translate("BeltGrinding", "Open job file")
        path = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", _jobs_filter())[0]
        if not path:
            return
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument(Path(path).stem)
        with transaction(document, translate("BeltGrinding", "Open job file")):
            expand(api.open_job(document, path))
            Gui.SendMsgToActiveView("ViewFit")


class ExportJob(Command):
    NAME = "BeltGrinding_ExportJob"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExportJob", "Export job file...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExportJob", "Writes the job as JSON, for beltgrind on another machine"
    )

    def run(self):
        title = translate("BeltGrinding", "Export job file")
        path = QtGui.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), title, "job.json", _jobs_filter()
        )[0]
        if path:
            api.export_job(active_job(), path)


class ExportProgram(Command):
    NAME = "BeltGrinding_ExportProgram"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ExportProgram", "Export robot program...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ExportProgram",
        "Writes the selected robot path as KRL, RAPID, URScript or CSV",
    )

    def run(self):
        job = active_job()
        paths = [o for o in job.Group if type_of(o) == robot_path.RobotPath.TYPE]
        selected = [o for o in Gui.Selection.getSelection(job.Document.Name) if o in paths] or paths
        if len(selected) != 1:
            raise InputError(
                translate("BeltGrinding", "Select the robot path that is to be written.")
            )
        title = translate("BeltGrinding", "Export robot program")
        kinds = "KUKA KRL (*.src);;ABB RAPID (*.mod);;URScript (*.script);;CSV (*.csv)"
        path, kind = QtGui.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), title, f"{selected[0].Label}.src", kinds
        )
        if path:
            suffix = kind.rpartition("*")[2].rstrip(")")
            path = path if Path(path).suffix else path + suffix
            api.export_program(selected[0], path)


class ImportResult(Command):
    NAME = "BeltGrinding_ImportResult"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ImportResult", "Import result...")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ImportResult", "Brings back what beltgrind computed on another machine"
    )

    def run(self):
        title = translate("BeltGrinding", "Folder of the result")
        folder = QtGui.QFileDialog.getExistingDirectory(Gui.getMainWindow(), title)
        if folder:
            job = active_job()
            with transaction(job.Document, translate("BeltGrinding", "Import result")):
                api.import_result(job, folder)


class ReadAgain(Command):
    NAME = "BeltGrinding_ReadAgain"
    TEXT = QT_TRANSLATE_NOOP("BeltGrinding_ReadAgain", "Read programs again")
    TIP = QT_TRANSLATE_NOOP(
        "BeltGrinding_ReadAgain", "Reads the job's robot programs from their files again"
    )

    def run(self):
        job = active_job()
        with transaction(job.Document, translate("BeltGrinding", "Read programs again")):
            for path in job.Group:
                if type_of(path) == robot_path.RobotPath.TYPE and path.Source:
                    robot_path.load_program(path, path.Source)
            job.Document.recompute()


WORK = (
    NewJob,
    Stock,
    BeltMachine,
    ImportProgram,
    RasterPath,
    Cell,
    Simulate,
    Deviation,
    Section,
    Playback,
)
MORE = (
    FollowPath,
    Belt,
    Calibrate,
    Contact,
    ReadAgain,
    OpenJob,
    ExportProgram,
    ExportJob,
    ImportResult,
    ExampleBlade,
)


def register():
    """Tells FreeCAD the commands, if it does not know them; returns (names in the order of work, other names)."""
    known = set(Gui.listCommands())
    for command in WORK + MORE:
        if command.NAME not in known:
            Gui.addCommand(command.NAME, command())
    return [c.NAME for c in WORK], [c.NAME for c in MORE]
