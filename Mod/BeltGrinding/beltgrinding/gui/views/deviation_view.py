"""View provider of the deviation: vertex colours that survive reopening, legend, rest of the part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pivy import coin

from ...objects import shown
from ...objects.job_data import child
from ...objects.kinds import DocumentObject, ViewObject
from ...objects.plan import Plan
from ...planning.pictures import INSIDE
from ..common.redraw import Once
from ..scene import legend
from ..scene.crisp_colours import CrispColours
from ..scene.lay_strokes import lay_strokes, marks
from ..scene.part_context import design_key, rest_of_part
from .coloured_mesh_view import ColouredMeshView, name_of

if TYPE_CHECKING:
    from ..scene.legend_picture import Spec


class DeviationView(ColouredMeshView):
    """Proxy of the Mesh view provider."""

    ICON = "BeltGrinding_Deviation"
    COMMANDS = ("BeltGrinding_Simulate",)

    def __init__(self, view: ViewObject) -> None:
        super().__init__(view)
        view.addProperty(
            "App::PropertyBool", "RestOfPart", "Deviation", "draw the part's other faces in grey"
        )
        view.RestOfPart = True
        self._lay_property(view)

    @staticmethod
    def _lay_property(view: ViewObject) -> None:
        if "Scratches" in view.PropertiesList:
            return
        view.addProperty(
            "App::PropertyBool",
            "Scratches",
            "Deviation",
            "draw the direction of the scratches, of a job with Finish; red: crossed",
        )
        view.Scratches = True

    def attach(self, view: ViewObject) -> None:
        self.crisp = CrispColours(view.RootNode)
        self.lay, self.rest = coin.SoSwitch(), coin.SoSwitch()
        self.lay_of, self.rest_of = Once(), Once()
        super().attach(view)
        # Before the mesh's materials and light, which they would inherit, and its style, which hides it where the
        # height field is drawn in its place.
        view.RootNode.insertChild(self.lay, 0)
        view.RootNode.insertChild(self.rest, 0)

    def panel(self, obj: DocumentObject) -> Any:
        from ..panels.deviation_panel import DeviationPanel

        return DeviationPanel(obj)

    def finishRestoring(self) -> None:
        if hasattr(self.view, "Lit"):  # 0.1.0 shaded the colours, which made others of them
            self.view.removeProperty("Lit")
        self._lay_property(self.view)
        super().finishRestoring()

    def draw(self) -> None:
        self.crisp.draw(self.view, self.shown(), INSIDE if self._under_reasons() else 0)
        self._draw_lay()
        self._draw_rest()
        super().draw()

    def _under_reasons(self) -> bool:
        """Whether a plan shows in its colours why what stays out of tolerance does so: they would mean two things."""
        job = self.view.Object.getParentGroup()
        plan = None if job is None else child(job, Plan)
        proxy: Any = getattr(getattr(plan, "ViewObject", None), "Proxy", None)
        return hasattr(proxy, "draws") and bool(proxy.draws())

    def own_colours(self) -> bool:
        return self.shown() and not self.crisp.shown()

    def legend_spec(self) -> Spec | None:
        obj = self.view.Object
        picture = shown.of(obj)
        if picture is None or self.crisp.plain:
            return None
        spec = legend.of(picture, name_of(obj), obj.OutOfDate)
        return spec._replace(marks=(*spec.marks, *marks(self.lay)))

    def _draw_lay(self) -> None:
        """The direction of the scratches, where it is known."""
        obj, simulation = self.view.Object, self.view.Object.Simulation
        there = self.shown() and not self.crisp.plain and simulation is not None
        there = there and getattr(self.view, "Scratches", False)
        # The same result may be judged by other limits, or be stored in another file.
        of = (obj.Shown, simulation.VerdictData, simulation.HeightField) if there else ()
        if self.lay_of.needed(*of):
            self.lay.removeAllChildren()
            drawn = lay_strokes(obj) if there else None
            if drawn is not None:
                self.lay.addChild(drawn)
            self.lay.whichChild = coin.SO_SWITCH_NONE if drawn is None else coin.SO_SWITCH_ALL

    def _draw_rest(self) -> None:
        """The faces that are not ground; what is cut below them would else be hidden."""
        job = self.view.Object.getParentGroup()
        there = job is not None and self.shown() and getattr(self.view, "RestOfPart", False)
        if self.rest_of.needed(*(design_key(job) if there else ())):
            self.rest.removeAllChildren()
            if there:
                self.rest.addChild(rest_of_part(job))
            self.rest.whichChild = coin.SO_SWITCH_ALL if there else coin.SO_SWITCH_NONE
