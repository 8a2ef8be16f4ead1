"""View provider of the deviation: vertex colours that survive reopening, legend, rest of the part."""

from pivy import coin

from ...objects.deviation import (
    DIFFERENCE,
    MEASURED,
    TEMPERATURE,
    UNCERTAINTY,
    bands_of,
    temperature_span,
)
from ..common.compat import QtCore
from ..scene import legend
from ..scene.crisp_colours import CrispColours
from ..scene.part_context import rest_of_part
from .coloured_mesh_view import ColouredMeshView

LEGEND = (
    "ToleranceLower",
    "ToleranceUpper",
    "ColourLimit",
    "UncertaintyLimit",
    "GreatestTemperature",
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

    def __init__(self, view):
        super().__init__(view)
        view.addProperty(
            "App::PropertyBool", "RestOfPart", "Deviation", "draw the part's other faces in grey"
        )
        view.RestOfPart = True

    def attach(self, view):
        self.crisp = CrispColours(view.RootNode)
        super().attach(view)
        self.rest = coin.SoSwitch()
        # Before the mesh's materials and light, which it would inherit.
        view.RootNode.insertChild(self.rest, 0)

    def panel(self, obj):
        from ..panels.deviation_panel import DeviationPanel

        return DeviationPanel(obj)

    def finishRestoring(self):
        if hasattr(self.view, "Lit"):  # 0.1.0 shaded the colours, which made others of them
            self.view.removeProperty("Lit")
        super().finishRestoring()
        self.update_rest()
        QtCore.QTimer.singleShot(0, self._redraw)  # the simulation may come after it

    def updateData(self, obj, name):
        if getattr(self, "view", None) is None:
            return
        if name == "VertexColors":
            self.update_rest()
        if name == "Shown":  # what the object says last
            self.update_crisp()
        if name in LEGEND:
            self.update_legend()

    def onChanged(self, view, name):
        if getattr(self, "rest", None) is None:
            return
        super().onChanged(view, name)
        if name in ("Visibility", "RestOfPart"):
            self.update_rest()
        if name in ("Visibility", "DisplayMode", "Transparency"):
            self.update_crisp()

    def legend_spec(self):
        obj = self.view.Object
        if not (hasattr(obj, "OutOfDate") and hasattr(obj, "Bands")) or obj.ColourLimit.Value <= 0:
            return None
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        if obj.ColourBy == UNCERTAINTY and obj.ExpectedInTolerance > 0.0:
            return legend.uncertainty(obj.UncertaintyLimit.Value, obj.OutOfDate)
        if obj.ColourBy in (MEASURED, DIFFERENCE) and getattr(obj.Simulation, "ScanFigures", ""):
            return legend.scan(*scale, obj.OutOfDate, obj.ColourBy == DIFFERENCE)
        if obj.ColourBy == TEMPERATURE and obj.GreatestTemperature > 0.0:
            return legend.temperature(obj.StartTemperature, temperature_span(obj), obj.OutOfDate)
        beyond = obj.Minimum.Value < -scale[2], obj.Maximum.Value > scale[2]
        return legend.deviation(*scale, obj.OutOfDate, bands_of(obj), beyond)

    def update_crisp(self):
        """Draws the colours with crisp borders, where that can be done."""
        if self.view.Visibility:
            self.crisp.update(self.view)
        self.colour()

    def colour(self):
        """Lets FreeCAD take the vertices' colours over, which takes long, where it draws them."""
        if not self.crisp.shown():
            super().colour()

    def _redraw(self):
        try:
            self.update_crisp()
        except (ReferenceError, RuntimeError):
            pass  # the document is closed again

    def update_rest(self):
        """Draws the faces that are not ground; what is cut below them would else be hidden."""
        self.rest.removeAllChildren()
        job = self.view.Object.getParentGroup()
        if job is not None and self.view.Visibility and self.view.RestOfPart:
            self.rest.addChild(rest_of_part(job))
            self.rest.whichChild = -3
