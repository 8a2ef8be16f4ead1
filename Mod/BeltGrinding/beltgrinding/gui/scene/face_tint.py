"""A tint on the faces that a panel is about, in the 3D views; the document is left as it is."""

from __future__ import annotations

from collections.abc import Iterable

import FreeCADGui as Gui
import Part
from pivy import coin

from ...objects.kinds import Document, DocumentObject
from .shapes3d import material, separator, triangles, unpickable

TINT = (0.1, 0.6, 0.55)
TRANSPARENCY = 0.45
DEFLECTION = 0.002  # chord error, as a share of the faces' diagonal


class FaceTint:
    """Draws over faces in a document's views until it is closed."""

    def __init__(self, document: Document) -> None:
        self.faces = coin.SoGroup()
        # Nearer to the eye than the part's own triangles, which lie in the same place.
        offset = coin.SoPolygonOffset()
        offset.factor, offset.units = -2.0, -2.0
        # At once, after the opaque part, as it comes last, and in nobody's way: sorted with the stock's shell, it would lie
        # before that on one side of the part and behind it on the other.
        order, depth = coin.SoTransparencyType(), coin.SoDepthBuffer()
        order.value, depth.write = coin.SoTransparencyType.BLEND, False
        look = material(TINT, TRANSPARENCY)
        self.root = separator(unpickable(), order, depth, look, offset, self.faces)
        self.scenes = [
            view.getSceneGraph()
            for view in Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")
        ]
        for scene in self.scenes:
            scene.addChild(self.root)

    def show(self, faces: Iterable[tuple[DocumentObject, str]]) -> None:
        """Tints these Part faces (in the document's coordinates), and no others."""
        self.faces.removeAllChildren()
        if not faces:
            return
        shape = Part.Compound(faces)
        points, found = shape.tessellate(DEFLECTION * max(shape.BoundBox.DiagonalLength, 1e-6))
        if found:
            self.faces.addChild(triangles([tuple(point) for point in points], found))

    def close(self) -> None:
        """Takes the tint away."""
        for scene in self.scenes:
            if scene.findChild(self.root) >= 0:
                scene.removeChild(self.root)
        self.scenes = []
