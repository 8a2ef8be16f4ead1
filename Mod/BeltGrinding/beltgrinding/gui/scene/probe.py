"""A click on the deviation tells what is there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import FreeCADGui as Gui
from pivy import coin

from ...engine import InputError
from ...objects import preferences, readout as readings
from ...objects.kinds import DocumentObject, Field
from ...objects.living import GONE
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure, length_text
from ..common.kinds import Json, Node, View3D
from ..common.messages import error_text
from . import field_view

SHOWN_FOR = 10000  # ms
OFFSET = QtCore.QPoint(14, 14)  # pixels from the cursor to its label


class Probe(QtGui.QGroupBox):
    """Shows the sample under a click on a Deviation's mesh: at the cursor, in the status bar and here.
    With Shift, or when its box is checked, a marker stays in the document."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(translate("BeltGrinding", "Click on the surface"))
        self.obj = obj
        self.reader = readings.Reader(obj)
        self.text = QtGui.QLabel(
            translate("BeltGrinding", "Shows the sample's deviation and face.")
        )
        self.text.setObjectName("reading")
        self.text.setWordWrap(True)
        self.keep = QtGui.QCheckBox(translate("BeltGrinding", "Keep a marker"))
        self.keep.setToolTip(translate("BeltGrinding", "as Shift+click does"))
        self.keep.setObjectName("keepMarker")
        body = QtGui.QVBoxLayout(self)
        body.addWidget(self.text)
        body.addWidget(self.keep)
        # Not a QToolTip: that goes when the button is released.
        self.label = QtGui.QLabel(Gui.getMainWindow(), QtCore.Qt.ToolTip)
        self.label.setObjectName("readingAtCursor")
        self.label.setPalette(QtGui.QToolTip.palette())
        self.label.setMargin(4)
        self.fade = QtCore.QTimer(self.label)
        self.fade.setSingleShot(True)
        self.fade.timeout.connect(self.label.hide)
        self.dot, self.place = _dot()
        self.field: Field | None = None
        self.picked: field_view.FieldView | None = None
        self.listening = []
        for view in Gui.getDocument(obj.Document.Name).mdiViewsOfType("Gui::View3DInventor"):
            call = view.addEventCallback(
                "SoMouseButtonEvent", lambda event, view=view: self._clicked(view, event)
            )
            view.getSceneGraph().addChild(self.dot)
            self.listening.append((view, call))

    def release(self) -> None:
        """Takes everything out of the 3D views; call it when the panel closes."""
        self.fade.stop()
        self.label.hide()
        self.label.deleteLater()
        for view, call in self.listening:
            try:
                view.removeEventCallback("SoMouseButtonEvent", call)
                view.getSceneGraph().removeChild(self.dot)
            except GONE:
                pass  # the view is closed
        self.listening = []
        self.field = self.picked = None

    def _clicked(self, view: View3D, event: Json) -> None:
        if event["State"] != "DOWN" or event["Button"] != "BUTTON1":
            return  # the release is FreeCAD's, which selects
        self.label.hide()
        if event["CtrlDown"] or event["AltDown"]:
            return
        try:
            reading = self._seen(view, tuple(event["Position"]))
        except InputError as error:
            self.text.setText(error_text(error))
            return
        if reading is not None:
            self.show_reading(reading, event["ShiftDown"] or self.keep.isChecked())

    def _seen(self, view: View3D, position: Sequence[float]) -> dict[str, Any] | None:
        """The reading at a pixel of a view, None beside the field. What is drawn on the surface, such
        as the path, is looked through."""
        if not self.obj.ViewObject.Visibility:
            return None
        self.reader.update()
        if self.field is not self.reader.field:
            self.field, self.picked = self.reader.field, None
            if field_view.has_own_node():
                self.picked = field_view.FieldView(self.reader.field)
        if self.picked is not None:  # finds one of a million samples at once
            index = self.picked.pick(view, position)
            if index is None:
                return None
            reading = self.reader.sample(index)
            away = view.getViewDirection().dot(FreeCAD.Vector(*reading["normal"])) > 0.0
            return None if away else reading  # seen from behind, through the part
        under = view.getObjectsInfo(position) or ()
        seen = next((one for one in under if one.get("Object") == self.obj.Name), None)
        return None if seen is None else self.reader.at((seen["x"], seen["y"], seen["z"]))

    def show_reading(self, reading: Json, keep: bool = False) -> None:
        """Shows a reading; ``keep``: and leaves a marker."""
        lines = describe(reading)
        self.text.setText("\n".join(lines))
        self.label.setText("\n".join(lines))
        self.label.adjustSize()
        self.label.move(QtGui.QCursor.pos() + OFFSET)
        self.label.show()
        self.fade.start(SHOWN_FOR)
        Gui.getMainWindow().statusBar().showMessage("; ".join(lines), SHOWN_FOR)
        self.place.translation = reading["top"]
        self.dot.whichChild = coin.SO_SWITCH_ALL
        if keep:
            readings.make_marker(self.obj, reading, lines)


def describe(reading: Json) -> list[str]:
    """The lines of text that tell a reading."""
    verdicts = {
        readings.IN_TOLERANCE: translate("BeltGrinding", "in tolerance"),
        readings.ABOVE: translate("BeltGrinding", "too much left"),
        readings.BELOW: translate("BeltGrinding", "cut too deep"),
        readings.MISSED: translate("BeltGrinding", "no stock was met here"),
    }
    verdict = verdicts[reading["verdict"]]
    if reading["coarse"]:
        verdict = translate("BeltGrinding", "{} (coarse)").format(verdict)
    x, y, z = reading["point"]
    place = f"({figure(x, '.3f')}, {figure(y, '.3f')}, {figure(z, '.3f')}) mm"
    sample = translate("BeltGrinding", "sample") + f" {reading['sample']}"
    where = ", ".join(part for part in (reading["face"], sample) if part)
    if reading["deviation"] is None:
        return [verdict, where, place]
    deviation = told(reading["deviation"])
    if reading["uncertainty"] is not None:
        deviation += f" ± {told(reading['uncertainty'], sign='')}"
    cells = []
    if reading["cell_error"] is not None:
        text = translate("BeltGrinding", "cells leave open {}")
        cells = [text.format("± " + told(reading["cell_error"], sign=""))]
    low, high = reading["segment"]
    return [
        f"{deviation}: {verdict}",
        translate("BeltGrinding", "removed")
        + f" {told(reading['removed'], sign='')} "
        + translate("BeltGrinding", "of")
        + f" {told(reading['stock'], sign='')}",
        where,
        translate("BeltGrinding", "segment") + f" {told(low)} ... {told(high)}",
        place,
        *cells,
    ]


def told(value: float, sign: str = "+") -> str:
    """A height in mm, in the unit of the preferences."""
    return length_text(value, 1, sign)


def _dot() -> tuple[Node, Node]:
    """(switch, translation): a dot over everything, not picked, not counted by fitAll; hidden."""
    switch = coin.SoSwitch()
    outer = coin.SoType.fromName("SoSkipBoundingGroup").createInstance() or coin.SoSeparator()
    top = coin.SoAnnotation()
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    colour = coin.SoBaseColor()
    colour.rgb = (0.0, 0.0, 0.0)
    place = coin.SoTranslation()
    points = coin.SoCoordinate3()
    points.point.setValues(0, 1, [(0.0, 0.0, 0.0)])
    marker = coin.SoMarkerSet()
    marker.markerIndex = coin.SoMarkerSet.CIRCLE_FILLED_9_9
    for node in (style, light, colour, place, points, marker):
        top.addChild(node)
    outer.addChild(top)
    switch.addChild(outer)
    switch.whichChild = coin.SO_SWITCH_NONE
    return switch, place
