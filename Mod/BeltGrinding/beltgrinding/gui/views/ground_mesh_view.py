"""View provider of the ground part's mesh: vertex colours that survive reopening, and the legend."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pivy import coin

from ...objects.kinds import DocumentObject, ViewObject
from ..common.compat import translate
from ..common.icons import icon, stale_icon
from ..scene import legend
from ..scene.part_context import edges_of_part
from .coloured_mesh_view import ColouredMeshView

if TYPE_CHECKING:
    from ..scene.legend_picture import Spec


class GroundMeshView(ColouredMeshView):
    """Proxy of the Mesh view provider; a double click makes the mesh anew."""

    ICON = "BeltGrinding_GroundMesh"
    COMMANDS = ("BeltGrinding_GroundMesh", "BeltGrinding_Simulate")

    def attach(self, view: ViewObject) -> None:
        super().attach(view)
        self.edges = coin.SoSwitch()
        view.RootNode.insertChild(self.edges, 0)  # before the mesh's colours

    def finishRestoring(self) -> None:
        super().finishRestoring()
        self.update_edges()

    def onChanged(self, view: ViewObject, name: str) -> None:
        if getattr(self, "edges", None) is None:
            return
        super().onChanged(view, name)
        if name == "Visibility":
            self.update_edges()

    def update_edges(self) -> None:
        """Draws the part's edges: what is not ground is of one grey."""
        self.edges.removeAllChildren()
        job = self.view.Object.getParentGroup()
        if job is not None and self.view.Visibility:
            self.edges.addChild(edges_of_part(job))
            self.edges.whichChild = coin.SO_SWITCH_ALL

    def getIcon(self) -> str:
        stale = getattr(self, "view", None) is not None and self.view.Object.OutOfDate
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if getattr(self, "view", None) is None:
            return
        if name == "VertexColors":
            self.colour()
            self.update_edges()
        if name == "OutOfDate":
            self.view.signalChangeIcon()
        if name in ("VertexColors", "OutOfDate"):
            self.update_legend()

    def legend_spec(self) -> Spec | None:
        obj = self.view.Object
        if getattr(obj, "ColourLimit", None) is None or obj.ColourLimit.Value <= 0:
            return None
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        return legend.deviation(*scale, obj.OutOfDate)

    def doubleClicked(self, view: ViewObject) -> bool:
        from ...objects import ground_mesh
        from ..common.transaction import transaction

        with transaction(view.Object.Document, translate("BeltGrinding", "Ground part as mesh")):
            ground_mesh.make(view.Object)
        return True

    def verb(self) -> str:
        return translate("BeltGrinding", "Make the mesh anew")
