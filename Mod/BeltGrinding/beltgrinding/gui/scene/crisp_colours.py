"""The deviation's colours with crisp borders, drawn in place of FreeCAD's mesh, which has a colour a vertex."""

from __future__ import annotations

import json

import numpy as np
from pivy import coin

from ...base.kinds import known
from ...objects import shown
from ...objects.fields import field_of
from ...objects.kinds import DocumentObject, Field, ViewObject
from ...objects.shown import Shown
from ..common.kinds import Node
from ..common.redraw import Once
from . import field_view
from .field_view import FieldView
from .shapes3d import unpickable

PLAIN = "Shaded"  # the display mode that is drawn here; FreeCAD draws the others
MODES = {
    shown.UNCERTAINTY: field_view.UNCERTAINTY,
    shown.TEMPERATURE: field_view.TEMPERATURE,
    shown.ROUGHNESS: field_view.ROUGHNESS,
    shown.CELL_ERROR: field_view.CELL_ERROR,
}


class CrispColours:
    """Nodes to be put before those of a Deviation's mesh. The mesh stays, is picked, and is saved with its
    colours; it is only not drawn where this can."""

    def __init__(self, root: Node) -> None:
        self.field: Field | None = None
        self.shape: FieldView | None = None
        self.once, self.plain = Once(), False
        self.switch, self.mesh_style = coin.SoSwitch(), coin.SoDrawStyle()
        self.mesh_style.style = coin.SoDrawStyle.FILLED
        root.insertChild(self.mesh_style, 0)
        root.insertChild(self.switch, 0)

    def draw(self, view: ViewObject, visible: bool, plain: int = 0) -> None:
        """Draws the object of a view provider as it is now, where that can be done here; ``plain``: 0xRRGGBBAA, all in
        this tone, for what lies over it."""
        self.plain = False
        if not visible:
            self.switch.whichChild = coin.SO_SWITCH_NONE
            return
        picture = shown.of(view.Object)
        if picture is None or not _drawable(view) or not self._load(view.Object):
            self._leave()
            return
        self.plain = bool(plain)
        if self.once.needed(picture, plain):
            if plain:
                size = known(self.field).size
                known(self.shape).set_colours(np.full(size, plain, dtype=np.uint32))
            else:
                self._colour(picture)
        self.switch.whichChild = coin.SO_SWITCH_ALL
        self.mesh_style.style = coin.SoDrawStyle.INVISIBLE
        self.mesh_style.setOverride(True)

    def shown(self) -> bool:
        """Whether the colours are drawn here, and not by FreeCAD."""
        return self.shape is not None

    def _leave(self) -> None:
        """Leaves the drawing to FreeCAD."""
        self.field = self.shape = self.once.key = None
        self.switch.whichChild = coin.SO_SWITCH_NONE
        self.switch.removeAllChildren()
        self.mesh_style.setOverride(False)
        self.mesh_style.style = coin.SoDrawStyle.FILLED

    def _load(self, obj: DocumentObject) -> bool:
        """Takes the object's field, if another one is drawn: a result gets a new one when a scan is compared
        with it. False where there is none."""
        field = field_of(obj.Simulation)
        if field is None or field.size != obj.Mesh.CountPoints:
            return False
        if field is self.field:
            return True
        self.field, self.shape, self.once.key = field, FieldView(field), None
        self.switch.removeAllChildren()
        drawn = coin.SoSeparator()
        drawn.addChild(unpickable())
        drawn.addChild(self.shape.node)
        self.switch.addChild(drawn)
        return True

    def _colour(self, picture: Shown) -> None:
        field, shape = known(self.field), known(self.shape)
        if not picture.known:
            shape.set_colours(picture.colours_of(field))
        elif picture.mode in MODES:
            span = max(picture.end - picture.start, shown.LEAST_SPAN[picture.mode])
            shape.colour_by(MODES[picture.mode], span, values=picture.values(field))
        else:
            steps = picture.bands, picture.colours
            if picture.mode != shown.DEVIATION:
                steps = 0, None
            shape.colour_by(
                field_view.DEVIATION, *picture.scale, *steps, values=picture.values(field)
            )


def _drawable(view: ViewObject) -> bool:
    """Whether a view provider's object can be drawn here; where not, FreeCAD draws it."""
    obj = view.Object
    simulation = getattr(obj, "Simulation", None)
    if simulation is None or not field_view.has_own_node():
        return False
    if view.DisplayMode != PLAIN or view.Transparency or not obj.Placement.isIdentity():
        return False
    # Else the mesh is still that of another result, or of the same before it was compared with a scan.
    told = json.loads(obj.Shown or "[null]")
    same = told[0] == [simulation.Fingerprint, simulation.WallTime]
    earlier = len(told) < 3  # of an earlier version, which did not keep the scan
    return same and (earlier or told[1][-1] == getattr(simulation, "ScanFigures", ""))
