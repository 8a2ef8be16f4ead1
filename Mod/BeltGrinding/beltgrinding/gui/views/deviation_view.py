"""View provider of the deviation: vertex colours that survive reopening, legend, rest of the part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pivy import coin

from ...objects.deviation import (
    DIFFERENCE,
    MEASURED,
    ROUGHNESS,
    TEMPERATURE,
    UNCERTAINTY,
    bands_of,
    roughness_span,
    temperature_span,
)
from ...objects.kinds import DocumentObject, ViewObject
from ..common.compat import QtCore
from ..scene import legend
from ..scene.crisp_colours import CrispColours
from ..scene.lay_strokes import lay_strokes
from ..scene.part_context import rest_of_part
from .coloured_mesh_view import ColouredMeshView

if TYPE_CHECKING:
    from ..scene.legend_picture import Spec

LEGEND = (
    "ToleranceLower",
    "ToleranceUpper",
    "ColourLimit",
    "UncertaintyLimit",
    "GreatestTemperature",
    "GreatestRoughness",
    "Bands",
    "Minimum",
    "Maximum",
    "VertexColors",
    "OutOfDate",
)


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
        self.lay = coin.SoSwitch()
        super().attach(view)
        self.rest = coin.SoSwitch()
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
        self.update_rest()
        QtCore.QTimer.singleShot(0, self._redraw)  # the simulation may come after it

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if getattr(self, "view", None) is None:
            return
        if name == "VertexColors":
            self.update_rest()
        if name == "Shown":  # what the object says last
            self.update_crisp()
            self.update_lay()
        if name in LEGEND:
            self.update_legend()

    def onChanged(self, view: ViewObject, name: str) -> None:
        if getattr(self, "rest", None) is None:
            return
        super().onChanged(view, name)
        if name in ("Visibility", "RestOfPart"):
            self.update_rest()
        if name in ("Visibility", "DisplayMode", "Transparency"):
            self.update_crisp()
        if name in ("Visibility", "Scratches"):
            self.update_lay()

    def legend_spec(self) -> Spec | None:
        obj = self.view.Object
        if not (hasattr(obj, "OutOfDate") and hasattr(obj, "Bands")) or obj.ColourLimit.Value <= 0:
            return None
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        if obj.ColourBy == UNCERTAINTY and obj.ExpectedInTolerance > 0.0:
            return legend.uncertainty(obj.UncertaintyLimit.Value, obj.OutOfDate)
        scanned = bool(getattr(obj.Simulation, "ScanFigures", ""))
        if obj.ColourBy in (MEASURED, DIFFERENCE) and scanned:
            return legend.scan(*scale, obj.OutOfDate, obj.ColourBy == DIFFERENCE)
        if obj.ColourBy == TEMPERATURE and obj.GreatestTemperature > 0.0:
            return legend.temperature(obj.StartTemperature, temperature_span(obj), obj.OutOfDate)
        if obj.ColourBy == ROUGHNESS and obj.GreatestRoughness > 0.0:
            return legend.roughness(roughness_span(obj), obj.OutOfDate)
        beyond = obj.Minimum.Value < -scale[2], obj.Maximum.Value > scale[2]
        return legend.deviation(*scale, obj.OutOfDate, bands_of(obj), beyond)

    def update_crisp(self) -> None:
        """Draws the colours with crisp borders, where that can be done."""
        if self.view.Visibility:
            self.crisp.update(self.view)
        self.colour()

    def update_lay(self) -> None:
        """Draws the direction of the scratches, where it is known."""
        self.lay.removeAllChildren()
        self.lay.whichChild = coin.SO_SWITCH_NONE
        view = self.view
        if view.Visibility and getattr(view, "Scratches", False):
            drawn = lay_strokes(view.Object)
            if drawn is not None:
                self.lay.addChild(drawn)
                self.lay.whichChild = coin.SO_SWITCH_ALL

    def colour(self) -> None:
        """Lets FreeCAD take the vertices' colours over, which takes long, where it draws them."""
        if not self.crisp.shown():
            super().colour()

    def _redraw(self) -> None:
        try:
            self.update_crisp()
            self.update_lay()
        except (ReferenceError, RuntimeError):
            pass  # the document is closed again

    def update_rest(self) -> None:
        """Draws the faces that are not ground; what is cut below them would else be hidden."""
        self.rest.removeAllChildren()
        job = self.view.Object.getParentGroup()
        if job is not None and self.view.Visibility and self.view.RestOfPart:
            self.rest.addChild(rest_of_part(job))
            self.rest.whichChild = -3
