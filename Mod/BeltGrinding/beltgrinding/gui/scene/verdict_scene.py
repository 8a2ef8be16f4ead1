"""A cluster of the verdict, marked in the 3D views: its outline and its worst place."""

from __future__ import annotations

import FreeCADGui as Gui
import numpy as np
from pivy import coin

from ...objects.kinds import Document, Field
from ..common.kinds import Array
from .shapes3d import separator, unpickable

COLOUR = (0.85, 0.0, 0.55)  # in neither ramp of the deviation
WIDTH = 3  # pixels


def outline(triangles: Array, inside: Array) -> Array:
    """(k, 2) samples at the ends of the edges around the samples ``inside`` (n, bool): of the
    ``triangles`` (m, 3) that lie there with all corners, the edges that only one has.
    """
    whole = triangles[inside[triangles].all(axis=1)].astype(np.int64)
    edges = np.sort(np.concatenate([whole[:, [0, 1]], whole[:, [1, 2]], whole[:, [2, 0]]]), axis=1)
    found, counts = np.unique(edges, axis=0, return_counts=True)
    return found[counts == 1]


class VerdictScene:
    """Lines and a dot over everything, not picked, not counted by fitAll."""

    def __init__(self, document: Document) -> None:
        self.switch = coin.SoSwitch()
        outer = coin.SoType.fromName("SoSkipBoundingGroup").createInstance() or coin.SoSeparator()
        light, colour, style = coin.SoLightModel(), coin.SoBaseColor(), coin.SoDrawStyle()
        light.model = coin.SoLightModel.BASE_COLOR
        colour.rgb = COLOUR
        style.lineWidth = WIDTH
        self.points, self.lines = coin.SoCoordinate3(), coin.SoIndexedLineSet()
        top = coin.SoAnnotation()
        self.place, dot, marker = coin.SoTranslation(), coin.SoCoordinate3(), coin.SoMarkerSet()
        dot.point.setValues(0, 1, [(0.0, 0.0, 0.0)])
        marker.markerIndex = coin.SoMarkerSet.CIRCLE_LINE_9_9
        for node in (style, self.points, self.lines, self.place, dot, marker):
            top.addChild(node)
        outer.addChild(separator(unpickable(), light, colour, top))
        self.switch.addChild(outer)
        self.switch.whichChild = coin.SO_SWITCH_NONE
        # The scenes, not the views: a view that is closed cannot be asked any more.
        self.scenes = [
            view.getSceneGraph()
            for view in Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")
        ]
        for scene in self.scenes:
            scene.addChild(self.switch)

    def show(self, field: Field, inside: Array, worst: int) -> None:
        """Marks the samples ``inside`` (n, bool) of a core.HeightField, and the sample ``worst``."""
        edges = outline(field.triangles, inside)
        used, flat = np.unique(edges, return_inverse=True)
        tops = field.points[used] + field.height[used, None] * field.rays[used]
        self.points.point.deleteValues(0)
        self.lines.coordIndex.deleteValues(0)
        if len(used):
            self.points.point.setValues(0, len(used), tops.tolist())
            ends = np.full((len(edges), 1), -1)
            index = np.hstack([flat.reshape(-1, 2), ends]).ravel()
            self.lines.coordIndex.setValues(0, len(index), index.tolist())
        top = field.points[worst] + field.height[worst] * field.rays[worst]
        self.place.translation = tuple(float(x) for x in top)
        self.switch.whichChild = coin.SO_SWITCH_ALL

    def hide(self) -> None:
        self.switch.whichChild = coin.SO_SWITCH_NONE

    def close(self) -> None:
        """Takes everything out of the 3D views."""
        for scene in self.scenes:
            if scene.findChild(self.switch) >= 0:
                scene.removeChild(self.switch)
        self.scenes = []
