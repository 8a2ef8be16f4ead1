"""View provider of a cross-section: its line over the ground surface."""

from __future__ import annotations

from pivy import coin

from ...objects.kinds import DocumentObject, ViewObject
from ..common.compat import translate
from ..common.icons import qicon
from ..common.kinds import Menu
from ..common.redraw import Once
from ..scene.shapes3d import separator, unpickable
from .view import View

COLOUR = (0.85, 0.0, 0.55)  # in neither ramp of the deviation
WIDTH = 3  # pixels


class SectionView(View):
    """A line; a double click opens the plot."""

    ICON = "BeltGrinding_Section"
    COMMANDS = ("BeltGrinding_Section", "BeltGrinding_Simulate")

    def attach(self, view: ViewObject) -> None:
        self.line_of = Once()
        super().attach(view)
        style, light, colour = coin.SoDrawStyle(), coin.SoLightModel(), coin.SoBaseColor()
        style.lineWidth = WIDTH
        light.model = coin.SoLightModel.BASE_COLOR
        colour.rgb = COLOUR
        depth = coin.SoDepthBuffer()
        depth.range = (0.0, 0.999)
        self.points, self.lines = coin.SoCoordinate3(), coin.SoLineSet()
        root = separator(unpickable(), light, colour, style, depth, self.points, self.lines)
        view.addDisplayMode(root, "Line")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Line"]

    def getDefaultDisplayMode(self) -> str:
        return "Line"

    def draw(self) -> None:
        super().draw()
        obj = self.view.Object
        if not hasattr(obj, "LineCounts"):
            return
        points, counts = [tuple(point) for point in obj.Line], obj.LineCounts
        if not self.line_of.needed(points, counts):
            return
        self.lines.numVertices.deleteValues(0)
        self.points.point.deleteValues(0)
        if points:
            self.points.point.setValues(0, len(points), points)
            self.lines.numVertices.setValues(0, len(counts), counts)

    def open(self, view: ViewObject) -> None:
        from ..docks.section_dock import SectionDock

        SectionDock.open(view.Object)

    def verb(self) -> str:
        return translate("BeltGrinding", "Show the plot")

    def own_entries(self, obj: DocumentObject, menu: Menu) -> None:
        for kind in ("CSV", "SVG"):
            text = translate("BeltGrinding", "Export {}").format(f"{kind}...")
            menu.addAction(
                qicon("BeltGrinding_ExportJob"),
                text,
                lambda kind=kind.lower(): self.export(obj, kind),
            )

    def export(self, obj: DocumentObject, kind: str) -> None:
        """Asks for a file and writes the section as "csv" or "svg"; its dock says what came of it."""
        from ..docks.section_dock import SectionDock

        SectionDock.open(obj).export(kind)

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None
