"""The view providers, by the names under which objects ask for them."""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
from pivy import coin

from ...engine import InputError
from ...objects.deviation import Deviation
from ...objects.ground_mesh import GroundMesh
from ...objects.job_data import child, children
from ...objects.kinds import DocumentObject, ViewObject
from ...objects.robot_path import load_program
from ..common.compat import translate
from ..common.icons import icon, stale_icon, qicon
from ..common.kinds import Menu
from ..scene import left_out, path_arrows, stock_shell
from .coloured_mesh_view import frame_selected
from .deviation_view import DeviationView
from .ground_mesh_view import GroundMeshView
from .showing import show_stock
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
    "SectionView",
    "SimulationView",
    "StockView",
    "StudyView",
    "VerdictView",
]


LINE_WIDTH = 2  # pixels of a path


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

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name in ("DesignFaces", "FlipFaces", "FlipNormals", "Group"):
            show_stock(obj)

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.job_panel import JobPanel

        return JobPanel(obj)


class StockView(View):
    """A uniform allowance is drawn as a shell until there is a result; another stock is an object of its own."""

    ICON = "BeltGrinding_Stock"

    def attach(self, view: ViewObject) -> None:
        super().attach(view)
        self.shell = coin.SoSwitch()
        view.addDisplayMode(self.shell, "Shell")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Shell"]

    def getDefaultDisplayMode(self) -> str:
        return "Shell"

    def finishRestoring(self) -> None:
        self.update_shell()

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name in ("Kind", "Allowance") and getattr(self, "view", None) is not None:
            self.update_shell()

    def onChanged(self, view: ViewObject, name: str) -> None:
        if name == "Visibility" and getattr(self, "shell", None) is not None:
            self.update_shell()

    def update_shell(self) -> None:
        """Draws the stock as it is now; nothing beside a result that is shown."""
        obj, job = self.view.Object, self.view.Object.getParentGroup()
        self.shell.whichChild = coin.SO_SWITCH_NONE
        self.shell.removeAllChildren()
        if job is None or not self.view.Visibility or getattr(obj, "Kind", "") != "allowance":
            return
        results = [*children(job, Deviation), *children(job, GroundMesh)]
        if not any(result.ViewObject.Visibility for result in results):
            self.shell.addChild(stock_shell.shell(job, obj.Allowance.Value))
            self.shell.whichChild = coin.SO_SWITCH_ALL

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.stock_panel import StockPanel

        return StockPanel(obj)


class BeltMachineView(Undrawn):
    ICON = "BeltGrinding_BeltMachine"
    COMMANDS = ("BeltGrinding_Cell", "BeltGrinding_Belt", "BeltGrinding_Contact")

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
        super().attach(view)
        self.arrows = coin.SoSwitch()
        view.RootNode.addChild(self.arrows)
        frame_selected(view)
        if view.LineWidth == 1:  # FreeCAD's default
            view.LineWidth = LINE_WIDTH
        self.start(view.Object)

    def finishRestoring(self) -> None:
        frame_selected(self.view)
        self.draw_arrows()

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name == "Path" and getattr(self, "view", None) is not None:
            self.start(obj)
            self.draw_arrows()

    def onChanged(self, view: ViewObject, name: str) -> None:
        # While a document is opened, a path of an earlier version has not all its properties yet.
        drawn = getattr(self, "arrows", None) is not None and not FreeCAD.isRestoring()
        if drawn and name in ("Visibility", "NormalColor"):
            self.draw_arrows()

    def draw_arrows(self) -> None:
        """Draws the arrows of the path as it is."""
        view = self.view
        self.arrows.whichChild = coin.SO_SWITCH_NONE
        self.arrows.removeAllChildren()
        obj = view.Object
        if not view.Visibility or getattr(obj, "Proxy", None) is None or not obj.Path.Size:
            return
        try:
            points = obj.Proxy.contacts(obj)
        except InputError:
            return  # the object says what is wrong when it is computed
        node = path_arrows.arrows(points, obj.Proxy.arrays(obj)["rapid"], view.NormalColor)
        self.arrows.addChild(node)
        self.arrows.whichChild = coin.SO_SWITCH_ALL

    def start(self, obj: DocumentObject) -> None:
        """Tells the view where the path begins."""
        if obj.Path.Size and hasattr(self.view, "StartPosition"):
            self.view.StartPosition = obj.Path.Commands[0].Placement.Base

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.program_panel import ProgramPanel

        return ProgramPanel(obj)

    def own_entries(self, obj: DocumentObject, menu: Menu) -> None:
        if obj.Source:
            text = translate("BeltGrinding", "Read the file again")
            menu.addAction(qicon("BeltGrinding_ReadAgain"), text, lambda: read_again(obj))


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
        self.left = coin.SoSwitch()
        view.RootNode.addChild(self.left)
        super().attach(view)

    def draw_arrows(self) -> None:
        super().draw_arrows()
        self.left.whichChild = coin.SO_SWITCH_NONE
        self.left.removeAllChildren()
        obj = self.view.Object
        if not self.view.Visibility or not getattr(obj, "LeftTriangles", None):
            return
        corners = np.array(obj.LeftTriangles, dtype=int).reshape(-1, 3)
        points = np.array([tuple(point) for point in obj.LeftPoints])
        self.left.addChild(left_out.left_out(points, corners, np.array(obj.LeftStates)))
        self.left.whichChild = coin.SO_SWITCH_ALL

    def updateData(self, obj: DocumentObject, name: str) -> None:
        super().updateData(obj, name)
        if name == "LeftStates" and getattr(self, "view", None) is not None:
            self.draw_arrows()

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.raster_panel import RasterPanel

        return RasterPanel(obj)


class VerdictView(Undrawn):
    """The icon says when the result is out of date; a double click shows the dock."""

    ICON = "BeltGrinding_Verdict"
    COMMANDS = ("BeltGrinding_Zones", "BeltGrinding_Deviation")

    def getIcon(self) -> str:
        stale = getattr(self, "view", None) is not None and self.view.Object.OutOfDate
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name == "OutOfDate" and getattr(self, "view", None) is not None:
            self.view.signalChangeIcon()

    def doubleClicked(self, view: ViewObject) -> bool:
        from ..docks.verdict_dock import VerdictDock

        VerdictDock.open(view.Object)
        return True

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show verdict")


class SimulationView(Undrawn):
    """The icon says when the result is out of date; a double click shows the result."""

    ICON = "BeltGrinding_Simulate"
    COMMANDS = ("BeltGrinding_Simulate", "BeltGrinding_Deviation", "BeltGrinding_ImportResult")

    def getIcon(self) -> str:
        stale = getattr(self, "view", None) is not None and self.view.Object.OutOfDate
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name == "OutOfDate" and getattr(self, "view", None) is not None:
            self.view.signalChangeIcon()

    def doubleClicked(self, view: ViewObject) -> bool:
        from ..panels.simulation_panel import show_result

        show_result(view.Object)
        return True

    def verb(self) -> str:
        return translate("BeltGrinding", "Show result")


class StudyView(Undrawn):
    """The icon says when the study is out of date; a double click opens its panel."""

    ICON = "BeltGrinding_Study"
    COMMANDS = ("BeltGrinding_Study", "BeltGrinding_Simulate")

    def getIcon(self) -> str:
        stale = getattr(self, "view", None) is not None and getattr(
            self.view.Object, "OutOfDate", False
        )
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if name == "OutOfDate" and getattr(self, "view", None) is not None:
            self.view.signalChangeIcon()

    def doubleClicked(self, view: ViewObject) -> bool:
        from ..docks.study_dock import show

        show(view.Object)
        return True

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show study")
