"""Base of the view providers of meshes with a colour at every vertex, and a legend over the 3D view.

A colour says a value, so nothing may change it: no light falls on it, and what is looked at or selected
is framed, not painted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pivy import coin

from ...objects.kinds import ViewObject
from ..common.compat import make_matt
from ..scene.legend import Legend
from ..scene.part_context import points_of_part
from .showing import show_stock
from .view import View

if TYPE_CHECKING:
    from ..scene.legend_picture import Spec


class ColouredMeshView(View):
    """Base. The object has ``VertexColors``; subclasses have ``legend_spec()``, a legend.Spec or
    None where nothing can be said yet.
    """

    def __init__(self, view: ViewObject) -> None:
        super().__init__(view)
        view.Coloring = True
        frame_selected(view)

    def attach(self, view: ViewObject) -> None:
        super().attach(view)
        light = coin.SoLightModel()
        light.model = coin.SoLightModel.BASE_COLOR
        view.RootNode.insertChild(light, 0)
        self.drawn, self.legend = Legend(), coin.SoSwitch()
        self.legend.addChild(self.drawn.node)
        view.RootNode.insertChild(self.legend, 0)  # before what says how the mesh is drawn
        self.update_legend()

    def finishRestoring(self) -> None:
        frame_selected(self.view)  # in a document of 0.1.0 it is painted
        self.colour()
        self.update_legend()

    def onChanged(self, view: ViewObject, name: str) -> None:
        if name == "Visibility" and getattr(self, "legend", None) is not None:
            self._show_legend()
            show_stock(view.Object.getParentGroup())

    def colour(self) -> None:
        """Draws the colours: 0.20 forgets them on reopening and whenever the mesh is set."""
        make_matt(self.view)
        obj = self.view.Object
        if len(obj.VertexColors) == obj.Mesh.CountPoints:
            self.view.Coloring = False
            self.view.Coloring = True

    def legend_spec(self) -> Spec | None:
        raise NotImplementedError

    def update_legend(self) -> None:
        spec = self.legend_spec()
        if spec is not None:
            self.drawn.show(spec)
            self._show_legend()

    def _show_legend(self) -> None:
        shown = self.view.Visibility
        if shown:
            self.drawn.avoid(points_of_part(self.view.Object.getParentGroup()))
        self.legend.whichChild = coin.SO_SWITCH_ALL if shown else coin.SO_SWITCH_NONE
        column = 0  # one legend beside the other
        for obj in self.view.Object.Document.Objects:
            proxy = getattr(obj.ViewObject, "Proxy", None)
            if isinstance(proxy, ColouredMeshView) and obj.ViewObject.Visibility:
                if getattr(proxy, "legend", None) is not None:
                    proxy.drawn.column = column
                    column += 1


def frame_selected(view: ViewObject) -> None:
    """Marks a mesh under the mouse, or selected, by a frame: FreeCAD would paint it in one colour."""
    if view.SelectionStyle != "BoundBox":
        view.SelectionStyle = "BoundBox"
