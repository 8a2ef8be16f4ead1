"""The view providers, by the names under which objects ask for them."""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
from pivy import coin

from ...engine import InputError
from ...objects.deviation import Deviation
from ...objects.ground_mesh import GroundMesh
from ...objects.job_data import children
from ...objects.kinds import DocumentObject, ViewObject
from ...objects.robot_path import load_program
from ..common.chosen import activate, jobs_of
from ..common.compat import translate
from ..common.icons import pale_icon, qicon
from ..common.kinds import Icon, Menu
from ..common.redraw import Once
from ..scene import cell_view, left_out, path_arrows, stock_shell
from ..scene.legend import Legend
from ..scene.part_context import design_key, points_of_part
from .coloured_mesh_view import frame_selected, name_of
from .deviation_view import DeviationView
from .ground_mesh_view import GroundMeshView
from .plan_view import PlanView
from .section_view import SectionView
from .view import View

__all__ = [
    "BeltMachineView",
    "BeltView",
    "DeviationView",
    "GroundMeshView",
    "JobView",
    "PlanView",
    "RasterPathView",
    "RobotPathView",
    "RobotProgramView",
    "SectionView",
    "SimulationView",
    "StockView",
    "StudyView",
    "VerdictView",
]


LINE_WIDTH = 2  # pixels of a path
DRAWN_OF = ("Path", "Poses", "LeftStates", "LeftPoints", "LeftTriangles")  # of a path


def _sides_key(job: DocumentObject) -> tuple[Any, ...]:
    """What the side depends on that a job's stock lies on."""
    flipped = [(obj.Name, tuple(subs)) for obj, subs in job.FlipFaces]
    return (*design_key(job), flipped, job.FlipNormals)


class Undrawn(View):
    """An object that draws nothing. Without a display mode the tree would grey it out as hidden."""

    def attach(self, view: ViewObject) -> None:
        super().attach(view)
        view.addDisplayMode(coin.SoGroup(), "Default")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Default"]

    def getDefaultDisplayMode(self) -> str:
        return "Default"


class JobView(View):
    ICON = "BeltGrinding_Job"
    COMMANDS = (
        "BeltGrinding_Stock",
        "BeltGrinding_BeltMachine",
        "BeltGrinding_ImportProgram",
        "BeltGrinding_RasterPath",
        "BeltGrinding_ReadAgain",
        "BeltGrinding_Simulate",
        "BeltGrinding_Plan",
        "BeltGrinding_Study",
        "BeltGrinding_Deviation",
        "BeltGrinding_ExportJob",
        "BeltGrinding_ImportResult",
    )

    def own_entries(self, obj: DocumentObject, menu: Menu) -> None:
        if len(jobs_of(obj.Document)) > 1:
            text = translate("BeltGrinding", "Make active")
            menu.addAction(qicon(self.ICON), text, lambda: activate(obj))

    def canDropObject(self, dropped: DocumentObject) -> bool:
        return True

    def dropObject(self, view: ViewObject, dropped: DocumentObject) -> None:
        """A mesh or points are a scan to be compared, a path of FreeCAD is followed; all else joins the group."""
        from .dropped import drop

        drop(view.Object, dropped)

    def canDelete(self, obj: DocumentObject) -> bool:
        """Whether FreeCAD may delete one that the job is linked to unasked: not a part that is to be ground."""
        return all(obj is not part for part, _ in self.view.Object.DesignFaces)

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.job_panel import JobPanel

        return JobPanel(obj)


class StockView(View):
    """A uniform allowance is drawn as a shell until there is a result; another stock is an object of its own."""

    ICON = "BeltGrinding_Stock"

    def attach(self, view: ViewObject) -> None:
        self.shell, self.shell_of = coin.SoSwitch(), Once()
        super().attach(view)
        view.addDisplayMode(self.shell, "Shell")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Shell"]

    def getDefaultDisplayMode(self) -> str:
        return "Shell"

    def draw(self) -> None:
        """Nothing beside a result that is shown."""
        super().draw()
        obj, job = self.view.Object, self.view.Object.getParentGroup()
        there = job is not None and self.shown() and getattr(obj, "Kind", "") == "allowance"
        results = [*children(job, Deviation), *children(job, GroundMesh)] if there else []
        there = there and not any(result.ViewObject.Visibility for result in results)
        if self.shell_of.needed(*((obj.Allowance.Value, *_sides_key(job)) if there else ())):
            self.shell.removeAllChildren()
            if there:
                self.shell.addChild(stock_shell.shell(job, obj.Allowance.Value))
            self.shell.whichChild = coin.SO_SWITCH_ALL if there else coin.SO_SWITCH_NONE

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.stock_panel import StockPanel

        return StockPanel(obj)


class BeltMachineView(Undrawn):
    ICON = "BeltGrinding_BeltMachine"
    COMMANDS = ("BeltGrinding_Cell", "BeltGrinding_Belt", "BeltGrinding_Contact")

    def attach(self, view: ViewObject) -> None:
        if cell_view.SHOWN not in view.PropertiesList:
            text = "show force, feed and the belt's travel as arrows where the cell is drawn"
            view.addProperty("App::PropertyBool", cell_view.SHOWN, "Belt grinding", text)
            setattr(view, cell_view.SHOWN, True)
        super().attach(view)

    def draw(self) -> None:
        super().draw()
        cell_view.redraw_loads(self.view.Object)

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.belt_machine_panel import BeltMachinePanel

        return BeltMachinePanel(obj)


class BeltView(Undrawn):
    ICON = "BeltGrinding_Belt"
    COMMANDS = ("BeltGrinding_Simulate",)

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.belt_panel import BeltPanel

        return BeltPanel(obj)


class RobotPathView(View):
    """The line begins at the first pose, FreeCAD's own at the document's origin. It has arrows, and keeps its
    colours when it is selected."""

    ICON = "BeltGrinding_ImportProgram"
    COMMANDS = (
        "BeltGrinding_ExportProgram",
        "BeltGrinding_Simulate",
        "BeltGrinding_Contact",
        "BeltGrinding_Cell",
    )

    def attach(self, view: ViewObject) -> None:
        self.arrows, self.arrows_of, self.start_of = coin.SoSwitch(), Once(), Once()
        self.changes = 0
        view.RootNode.addChild(self.arrows)
        super().attach(view)
        frame_selected(view)
        if view.LineWidth == 1:  # FreeCAD's default
            view.LineWidth = LINE_WIDTH

    def finishRestoring(self) -> None:
        frame_selected(self.view)
        super().finishRestoring()

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name in DRAWN_OF:  # lists too long to be compared
            self.changes = getattr(self, "changes", 0) + 1
        super().updateData(obj, name)

    def draw(self) -> None:
        super().draw()
        self.start(self.view.Object)
        self._draw_arrows()

    def _draw_arrows(self) -> None:
        view, obj = self.view, self.view.Object
        ready = getattr(obj, "Proxy", None) is not None and bool(obj.Path.Size)
        there = self.shown() and ready
        if not self.arrows_of.needed(*((view.NormalColor, *self._path_key()) if there else ())):
            return
        self.arrows.whichChild = coin.SO_SWITCH_NONE
        self.arrows.removeAllChildren()
        if not there:
            return
        try:
            points = obj.Proxy.contacts(obj)
        except InputError:
            return  # the object says what is wrong when it is computed
        node = path_arrows.arrows(points, obj.Proxy.arrays(obj)["rapid"], view.NormalColor)
        self.arrows.addChild(node)
        self.arrows.whichChild = coin.SO_SWITCH_ALL

    def _path_key(self) -> tuple[Any, ...]:
        """What the drawing of a path depends on."""
        obj = self.view.Object
        machine = obj.Machine
        cell = machine.Proxy.cell(machine) if machine is not None else {}
        return self.changes, repr(cell)

    def start(self, obj: DocumentObject) -> None:
        """Tells the view where the path begins."""
        if (
            obj.Path.Size
            and hasattr(self.view, "StartPosition")
            and self.start_of.needed(self.changes)
        ):
            self.view.StartPosition = obj.Path.Commands[0].Placement.Base

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.program_panel import ProgramPanel

        return ProgramPanel(obj)

    def own_entries(self, obj: DocumentObject, menu: Menu) -> None:
        if obj.Source:
            text = translate("BeltGrinding", "Read the file again")
            menu.addAction(qicon("BeltGrinding_ReadAgain"), text, lambda: read_again(obj))
        if obj.Active:
            picture, text = pale_icon(self.ICON), translate("BeltGrinding", "Leave out of runs")
        else:
            picture, text = qicon(self.ICON), translate("BeltGrinding", "Take into runs")
        menu.addAction(picture, text, lambda: set_active(obj, not obj.Active))

    def getIcon(self) -> str | Icon:
        view = getattr(self, "view", None)
        left_out = view is not None and not getattr(view.Object, "Active", True)
        return pale_icon(self.ICON) if left_out else super().getIcon()


def set_active(obj: DocumentObject, active: bool) -> None:
    """Takes a path into runs, or leaves it out, as one undo step."""
    from ..common.transaction import transaction

    with transaction(obj.Document, translate("BeltGrinding", "Active in runs")):
        obj.Active = active
        obj.Document.recompute()


def read_again(obj: DocumentObject) -> None:
    """Reads a path's file again, as one undo step."""
    from ..common.transaction import transaction

    with transaction(obj.Document, translate("BeltGrinding", "Read the file again")):
        load_program(obj, obj.Source)
        obj.Document.recompute()


class RasterPathView(RobotPathView):
    """Faces that its passes leave out are coloured."""

    ICON = "BeltGrinding_RasterPath"

    def attach(self, view: ViewObject) -> None:
        self.left, self.left_of, self.drawn = coin.SoSwitch(), Once(), Legend()
        view.RootNode.addChild(self.left)
        super().attach(view)

    def draw(self) -> None:
        super().draw()
        obj, there = self.view.Object, self._leaves_out()
        if self.left_of.needed(*((self.changes,) if there else ())):
            self.left.removeAllChildren()
            if there:
                corners = np.array(obj.LeftTriangles, dtype=int).reshape(-1, 3)
                points = np.array([tuple(point) for point in obj.LeftPoints])
                self.left.addChild(left_out.left_out(points, corners, np.array(obj.LeftStates)))
                self.left.addChild(self.drawn.node)
            self.left.whichChild = coin.SO_SWITCH_ALL if there else coin.SO_SWITCH_NONE
        if there:
            self.drawn.show(left_out.spec(name_of(obj), np.array(obj.LeftStates)))
            self.drawn.avoid(points_of_part(obj.getParentGroup()))

    def _leaves_out(self) -> bool:
        return self.shown() and bool(getattr(self.view.Object, "LeftTriangles", None))

    def legends(self) -> list[Legend]:
        return [self.drawn] if self._leaves_out() else []

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.raster_panel import RasterPanel

        return RasterPanel(obj)


class VerdictView(Undrawn):
    """The icon says when the result is out of date; a double click shows the dock."""

    ICON = "BeltGrinding_Verdict"
    COMMANDS = ("BeltGrinding_Zones", "BeltGrinding_Deviation")

    def open(self, view: ViewObject) -> None:
        from ..docks.verdict_dock import VerdictDock

        VerdictDock.open(view.Object)

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show verdict")


class SimulationView(Undrawn):
    """The icon says when the result is out of date; a double click shows the result."""

    ICON = "BeltGrinding_Simulate"
    COMMANDS = ("BeltGrinding_Simulate", "BeltGrinding_Deviation", "BeltGrinding_ImportResult")

    def open(self, view: ViewObject) -> None:
        from ..panels.simulation_panel import show_result

        show_result(view.Object)

    def verb(self) -> str:
        return translate("BeltGrinding", "Show result")


class StudyView(Undrawn):
    """The icon says when the study is out of date; a double click opens its panel."""

    ICON = "BeltGrinding_Study"
    COMMANDS = ("BeltGrinding_Study", "BeltGrinding_Simulate")

    def open(self, view: ViewObject) -> None:
        from ..docks.study_dock import show

        show(view.Object)

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show study")


class RobotProgramView(Undrawn):
    """The icon says when the program is out of date; a double click opens its panel."""

    ICON = "BeltGrinding_RobotProgram"
    COMMANDS = ("BeltGrinding_Cell",)

    def open(self, view: ViewObject) -> None:
        from ..panels.robot_program_panel import show

        show(view.Object)

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show robot program")
