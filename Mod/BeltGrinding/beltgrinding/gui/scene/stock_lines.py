"""The edges of a solid stock, while a panel is about it: dashed where something hides them. The document stays as it is."""

from __future__ import annotations

import FreeCADGui as Gui
from pivy import coin

from ...objects.job_data import child
from ...objects.geometry import placed_shape
from ...objects.kinds import Document, DocumentObject
from ...objects.stock import Stock
from ..common.redraw import Once
from .part_context import line_set
from .shapes3d import separator, unpickable

COLOUR = (0.80, 0.52, 0.10)  # the shell's, dark enough for lines
DASHES, WIDTH = 0x0F0F, 2  # a line's pattern where it is hidden; its pixels


class StockLines:
    """Draws in a document's views until it is closed."""

    def __init__(self, document: Document) -> None:
        self.root, self.drawn = separator(unpickable()), Once()
        self.scenes = [
            view.getSceneGraph()
            for view in Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")
        ]
        for scene in self.scenes:
            scene.addChild(self.root)

    def show(self, job: DocumentObject | None) -> None:
        """Draws the stock of a job as it is now; nothing where it is no solid."""
        stock = None if job is None else child(job, Stock)
        solid = stock is not None and stock.Kind == "solid" and stock.Source is not None
        solid = solid and bool(getattr(getattr(stock.Source, "Shape", None), "Edges", ()))
        source = stock.Source if solid else None
        key = (source.Shape.hashCode(), source.getGlobalPlacement().toMatrix().A) if solid else ()
        if not self.drawn.needed(*key):
            return
        self.root.removeAllChildren()
        if not solid:
            return
        lines = line_set(placed_shape(source), COLOUR)
        for function, pattern in (
            (coin.SoDepthBuffer.LEQUAL, 0xFFFF),
            (coin.SoDepthBuffer.GREATER, DASHES),
        ):
            depth, style = coin.SoDepthBuffer(), coin.SoDrawStyle()
            depth.function, depth.write = function, False
            style.linePattern, style.lineWidth = pattern, WIDTH
            self.root.addChild(separator(depth, style, lines))

    def close(self) -> None:
        """Takes the lines away."""
        for scene in self.scenes:
            if scene.findChild(self.root) >= 0:
                scene.removeChild(self.root)
        self.scenes = []
