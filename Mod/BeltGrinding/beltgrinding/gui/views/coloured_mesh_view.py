"""Base of the view providers of meshes with a colour at every vertex, and a legend over the 3D view."""

from pivy import coin

from ..common.compat import make_matt
from .view import View


class ColouredMeshView(View):
    """Base. The object has ``VertexColors``; subclasses have ``legend_node()``, None where nothing can
    be said yet.
    """

    def __init__(self, view):
        super().__init__(view)
        view.Coloring = True

    def attach(self, view):
        super().attach(view)
        self.legend = coin.SoSwitch()
        view.RootNode.addChild(self.legend)
        self.update_legend()

    def finishRestoring(self):
        self.colour()
        self.update_legend()

    def onChanged(self, view, name):
        if name == "Visibility" and getattr(self, "legend", None) is not None:
            self._show_legend()

    def colour(self):
        """Draws the colours: 0.20 forgets them on reopening and whenever the mesh is set."""
        make_matt(self.view)
        obj = self.view.Object
        if len(obj.VertexColors) == obj.Mesh.CountPoints:
            self.view.Coloring = False
            self.view.Coloring = True

    def legend_node(self):
        raise NotImplementedError

    def update_legend(self):
        node = self.legend_node()
        if node is not None:
            self.legend.removeAllChildren()
            self.legend.addChild(node)
            self._show_legend()

    def _show_legend(self):
        shown = self.view.Visibility
        self.legend.whichChild = coin.SO_SWITCH_ALL if shown else coin.SO_SWITCH_NONE
