"""The deviation's colours with crisp borders, drawn in place of FreeCAD's mesh, which has a colour a vertex."""

from __future__ import annotations

import json

import numpy as np
from pivy import coin

from ...base.kinds import known
from ...objects import preferences
from ...objects.deviation import (
    DIFFERENCE,
    MEASURED,
    ROUGHNESS,
    TEMPERATURE,
    UNCERTAINTY,
    bands_of,
    roughness_of,
    roughness_span,
    scan_heights,
    temperature_span,
)
from ...objects.fields import field_of
from ...objects.kinds import DocumentObject, Field, ViewObject
from ..common.kinds import Node
from . import field_view
from .field_view import FieldView
from .shapes3d import unpickable

PLAIN = "Shaded"  # the display mode that is drawn here; FreeCAD draws the others


class CrispColours:
    """Nodes to be put before those of a Deviation's mesh. The mesh stays, is picked, and is saved with its
    colours; it is only not drawn where this can."""

    def __init__(self, root: Node) -> None:
        self.field: Field | None = None
        self.shape: FieldView | None = None
        self.switch, self.mesh_style = coin.SoSwitch(), coin.SoDrawStyle()
        self.mesh_style.style = coin.SoDrawStyle.FILLED
        root.insertChild(self.mesh_style, 0)
        root.insertChild(self.switch, 0)

    def update(self, view: ViewObject) -> None:
        """Draws the object of a view provider as it is now."""
        if not _drawable(view) or not self._load(view.Object):
            return self.hide()
        self._colour(view.Object)
        self.switch.whichChild = coin.SO_SWITCH_ALL
        self.mesh_style.style = coin.SoDrawStyle.INVISIBLE
        self.mesh_style.setOverride(True)

    def shown(self) -> bool:
        """Whether the colours are drawn here, and not by FreeCAD."""
        return self.shape is not None

    def hide(self) -> None:
        """Leaves the drawing to FreeCAD."""
        self.field = self.shape = None
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
        self.field, self.shape = field, FieldView(field)
        self.switch.removeAllChildren()
        drawn = coin.SoSeparator()
        drawn.addChild(unpickable())
        drawn.addChild(self.shape.node)
        self.switch.addChild(drawn)
        return True

    def _colour(self, obj: DocumentObject) -> None:
        field, shape = known(self.field), known(self.shape)
        scale = (obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value)
        if obj.ColourBy == UNCERTAINTY and len(field.height_sd):
            shape.colour_by(field_view.UNCERTAINTY, obj.UncertaintyLimit.Value)
        elif obj.ColourBy in (MEASURED, DIFFERENCE) and len(field.measured):
            heights = scan_heights(obj, field)
            shape.colour_by(field_view.DEVIATION, *scale, values=heights)
        elif obj.ColourBy == TEMPERATURE and field.heat is not None:
            rise = np.array(field.heat["rise"], dtype=float)
            shape.colour_by(field_view.TEMPERATURE, temperature_span(obj), values=rise)
        elif obj.ColourBy == ROUGHNESS and field.finish is not None:
            rough = roughness_of(field)
            shape.colour_by(field_view.ROUGHNESS, roughness_span(obj), values=rough)
        else:
            shape.colour_by(field_view.DEVIATION, *scale, bands_of(obj), preferences.colours())


def _drawable(view: ViewObject) -> bool:
    """Whether a view provider's object can be drawn here; where not, FreeCAD draws it."""
    obj = view.Object
    simulation = getattr(obj, "Simulation", None)
    if simulation is None or not field_view.has_own_node():
        return False
    if view.DisplayMode != PLAIN or view.Transparency or not obj.Placement.isIdentity():
        return False
    # Else the mesh is still that of another result.
    return json.loads(obj.Shown or "[null]")[0] == [simulation.Fingerprint, simulation.WallTime]
