"""View provider of the ground part's mesh: vertex colours that survive reopening, and the legend."""

from pivy import coin

from . import legend
from .compat import make_matt, translate
from .icons import icon
from .view import View


class GroundMeshView(View):
    """Proxy of the Mesh view provider; a double click makes the mesh anew."""

    ICON = "BeltGrinding_GroundMesh"
    COMMANDS = ("BeltGrinding_GroundMesh", "BeltGrinding_Simulate")

    def __init__(self, view):
        super().__init__(view)
        view.Coloring = True

    def attach(self, view):
        super().attach(view)
        self.legend = coin.SoSwitch()
        view.RootNode.addChild(self.legend)
        self.update_legend()

    def getIcon(self):
        stale = getattr(self, "view", None) is not None and self.view.Object.OutOfDate
        return icon("BeltGrinding_OutOfDate" if stale else self.ICON)

    def finishRestoring(self):
        self.colour()
        self.update_legend()

    def onChanged(self, view, name):
        if name == "Visibility" and getattr(self, "legend", None) is not None:
            self.legend.whichChild = coin.SO_SWITCH_ALL if view.Visibility else coin.SO_SWITCH_NONE

    def updateData(self, obj, name):
        if getattr(self, "view", None) is None:
            return
        if name == "VertexColors":
            self.colour()
        if name == "OutOfDate":
            self.view.signalChangeIcon()
        if name in ("VertexColors", "OutOfDate"):
            self.update_legend()

    def colour(self):
        """Draws the colours: 0.20 forgets them on reopening and whenever the mesh is set."""
        make_matt(self.view)
        obj = self.view.Object
        if len(obj.VertexColors) == obj.Mesh.CountPoints:
            self.view.Coloring = False
            self.view.Coloring = True

    def update_legend(self):
        obj = self.view.Object
        if getattr(obj, "ColourLimit", None) is None or obj.ColourLimit.Value <= 0:
            return
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        self.legend.removeAllChildren()
        self.legend.addChild(legend.node(*scale, obj.OutOfDate))
        self.onChanged(self.view, "Visibility")

    def doubleClicked(self, view):
        from ..objects import ground_mesh
        from .commands.base import transaction

        with transaction(view.Object.Document, translate("BeltGrinding", "Ground part as mesh")):
            ground_mesh.make(view.Object)
        return True

    def verb(self):
        return translate("BeltGrinding", "Make the mesh anew")
