"""Base of the view providers of meshes with a colour at every vertex, and a legend over the 3D view.

A colour says a value, so nothing may change it: no light falls on it, and what is looked at or selected
is framed, not painted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pivy import coin

from ...objects.job_object import BeltGrindingJob
from ...objects.kinds import DocumentObject, ViewObject
from ...objects.proxy import type_of
from ..common.compat import make_matt
from ..common.redraw import Once
from ..scene.legend import Legend
from ..scene.part_context import points_of_part
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
        light = coin.SoLightModel()
        light.model = coin.SoLightModel.BASE_COLOR
        view.RootNode.insertChild(light, 0)
        self.drawn, self.legend = Legend(), coin.SoSwitch()
        self.legend.addChild(self.drawn.node)
        view.RootNode.insertChild(self.legend, 0)  # before what says how the mesh is drawn
        self.mesh_colours, self.mode = Once(), coin.SO_SWITCH_NONE
        super().attach(view)

    def finishRestoring(self) -> None:
        frame_selected(self.view)  # in a document of 0.1.0 it is painted
        super().finishRestoring()

    def draw(self) -> None:
        super().draw()
        self._draw_mesh()
        spec = self.legend_spec() if self.shown() else None
        if spec is not None:
            self.drawn.show(spec)
            self.drawn.avoid(points_of_part(self.view.Object.getParentGroup()))
        self.legend.whichChild = coin.SO_SWITCH_NONE if spec is None else coin.SO_SWITCH_ALL

    def legends(self) -> list[Legend]:
        there = self.legend.whichChild.getValue() != coin.SO_SWITCH_NONE
        return [self.drawn] if there else []

    def _draw_mesh(self) -> None:
        """FreeCAD's own mesh: hidden with what covers it, in the colours that the object has now."""
        switch = self.view.SwitchNode
        now = switch.whichChild.getValue()
        if self.covered:
            self.mode = now if now != coin.SO_SWITCH_NONE else self.mode
            switch.whichChild = coin.SO_SWITCH_NONE
        elif self.view.Visibility and now == coin.SO_SWITCH_NONE:
            switch.whichChild = self.mode
        obj = self.view.Object
        if self.own_colours() and self.mesh_colours.needed(*self.colours_key()):
            make_matt(self.view)
            if len(obj.VertexColors) == obj.Mesh.CountPoints:
                # 0.20 forgets them on reopening and whenever the mesh is set.
                self.view.Coloring = False
                self.view.Coloring = True

    def own_colours(self) -> bool:
        """Whether FreeCAD draws the mesh's colours, for which it needs long."""
        return True

    def colours_key(self) -> tuple[Any, ...]:
        """What the mesh's colours are of."""
        return (self.view.Object.Shown,)

    def legend_spec(self) -> Spec | None:
        raise NotImplementedError


def name_of(obj: DocumentObject) -> str:
    """An object's name for a legend; with its job's where there are several."""
    job = obj.getParentGroup()
    jobs = [one for one in obj.Document.Objects if type_of(one) == BeltGrindingJob.TYPE]
    label: str = obj.Label
    return f"{job.Label}: {label}" if job is not None and len(jobs) > 1 else label


def frame_selected(view: ViewObject) -> None:
    """Marks a mesh under the mouse, or selected, by a frame: FreeCAD would paint it in one colour."""
    if view.SelectionStyle != "BoundBox":
        view.SelectionStyle = "BoundBox"
