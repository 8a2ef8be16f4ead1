"""View provider of the ground part's mesh: vertex colours that survive reopening, and the legend."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pivy import coin

from ...objects.kinds import ViewObject
from ..common.compat import translate
from ..common.redraw import Once
from ..scene import legend
from ..scene.part_context import design_key, edges_of_part
from .coloured_mesh_view import ColouredMeshView, name_of

if TYPE_CHECKING:
    from ..scene.legend_picture import Spec


class GroundMeshView(ColouredMeshView):
    """Proxy of the Mesh view provider; a double click makes the mesh anew."""

    ICON = "BeltGrinding_GroundMesh"
    COMMANDS = ("BeltGrinding_GroundMesh", "BeltGrinding_Simulate")

    def attach(self, view: ViewObject) -> None:
        self.edges, self.edges_of = coin.SoSwitch(), Once()
        super().attach(view)
        view.RootNode.insertChild(self.edges, 0)  # before the mesh's colours

    def draw(self) -> None:
        super().draw()
        self._draw_edges()

    def _draw_edges(self) -> None:
        """The part's edges: what is not ground is of one grey."""
        job = self.view.Object.getParentGroup()
        there = job is not None and self.shown()
        if self.edges_of.needed(*(design_key(job) if there else ())):
            self.edges.removeAllChildren()
            if there:
                self.edges.addChild(edges_of_part(job))
            self.edges.whichChild = coin.SO_SWITCH_ALL if there else coin.SO_SWITCH_NONE

    def legend_spec(self) -> Spec | None:
        obj = self.view.Object
        if getattr(obj, "ColourLimit", None) is None or obj.ColourLimit.Value <= 0:
            return None
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        spec = legend.deviation(*scale, obj.OutOfDate, standard=True)
        return spec._replace(name=name_of(obj))

    def open(self, view: ViewObject) -> None:
        from ...objects import ground_mesh
        from ..common.transaction import transaction

        with transaction(view.Object.Document, translate("BeltGrinding", "Ground part as mesh")):
            ground_mesh.make(view.Object)

    def verb(self) -> str:
        return translate("BeltGrinding", "Make the mesh anew")
