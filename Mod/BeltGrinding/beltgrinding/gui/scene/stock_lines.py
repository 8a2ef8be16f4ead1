"""The edges of a solid stock, while a panel is about it: dashed where something hides them. The document stays as it is."""

from __future__ import annotations

from typing import Any

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
        source = _solid_of(None if job is None else child(job, Stock))
        key: tuple[Any, ...] = ()
        if source is not None:
            key = source.Shape.hashCode(), source.getGlobalPlacement().toMatrix().A
        if not self.drawn.needed(*key):
            return
        self.root.removeAllChildren()
        if source is None:
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


def _solid_of(stock: DocumentObject | None) -> DocumentObject | None:
    """The solid that a stock is; None of another one."""
    source = stock.Source if stock is not None and stock.Kind == "solid" else None
    return source if getattr(getattr(source, "Shape", None), "Edges", ()) else None
