"""An entry for a number with its unit, in the units of this field: N, m/s, MPa, mm.

FreeCAD's own writes 20000 mm/s, 0 mN and -50 um, by the unit system of the whole program, and a unit of the
entry's own does not change that.
"""

from __future__ import annotations

import math
from typing import Any

from FreeCAD import Units

from ...base.messages import reason
from ...objects import preferences
from ...objects.kinds import DocumentObject
from ...objects.properties import unit_of
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import QtEvent
from .steady import steady

DIGITS = 7
SIZES = {  # in FreeCAD's own units: mm, mN, kPa, mm/s
    "mm": 1.0,
    "µm": 1e-3,
    "mil": 0.0254,
    "°": 1.0,
    "N": 1000.0,
    "MPa": 1000.0,
    "mm/s": 1.0,
    "m/s": 1000.0,
    "mm/s²": 1.0,
}
KINDS = {  # where the schema says nothing
    "App::PropertyLength": "mm",
    "App::PropertyDistance": "mm",
    "App::PropertyAngle": "°",
    "App::PropertySpeed": "mm/s",
    "App::PropertyForce": "N",
    "App::PropertyPressure": "MPa",
    "App::PropertyAcceleration": "mm/s²",
}
BY_PREFERENCE = {"ToleranceLower", "ToleranceUpper", "ColourLimit"}  # deviations: mm, µm or mil
LENGTHS, SPEEDS = {"mm", "µm", "mil"}, {"mm/s", "m/s"}


def metric() -> bool:
    """Whether FreeCAD's unit system counts lengths in millimetres; its own entries are used where not."""
    return Units.Quantity(5.0, Units.Length).UserString.endswith("mm")


def symbol_of(obj: DocumentObject, name: str) -> str:
    """The unit in which a property is shown."""
    if name in BY_PREFERENCE:
        return preferences.deviation_unit().symbol
    return unit_of(obj, name) or KINDS[obj.getTypeIdOfProperty(name)]


def written(value: float, symbol: str) -> str:
    """A value in FreeCAD's unit as text."""
    shown = value / SIZES[symbol]
    if shown == 0.0:
        shown = 0.0  # not -0
    locale = QtCore.QLocale()
    locale.setNumberOptions(QtCore.QLocale.OmitGroupSeparator)
    return f"{locale.toString(shown, 'g', DIGITS)} {symbol}"


class QuantityEntry(QtGui.QLineEdit):
    """``rawValue`` is in FreeCAD's unit, as of FreeCAD's own entry; ``valueChanged`` tells of another one as it
    is typed. A bare number takes the unit that is shown."""

    valueChanged = QtCore.Signal(float)

    def __init__(self, value: float, unit: Any, symbol: str) -> None:
        """value: in FreeCAD's unit; unit: FreeCAD's Unit; symbol: one of SIZES."""
        super().__init__()
        steady(self)
        self.unit, self.symbol = unit, symbol
        self.raw = float(value)
        self.bound: tuple[
            DocumentObject, str
        ] | None = None  # (object, property) that may have an expression
        self.refused = lambda value: False  # a value that is not taken
        self.complain = lambda text: None  # of an expression that is not taken
        self._write()
        self.textChanged.connect(self._typed)
        self.editingFinished.connect(self._finished)

    def bind(self, obj: DocumentObject, name: str) -> None:
        """Lets an expression be typed, after =, that drives a property of ``obj``."""
        self.bound = obj, name
        self._write()

    def expression(self) -> str:
        """The expression that drives the property; '' if there is none."""
        if self.bound is None:
            return ""
        obj, name = self.bound
        found = [text for path, text in obj.ExpressionEngine if path.lstrip(".") == name]
        return found[0] if found else ""

    def show_value(self, value: float) -> None:
        """Shows a value, in FreeCAD's unit, that was set from elsewhere."""
        self.raw = float(value)
        self._write()

    def parsed(self, text: str) -> float:
        """The value of a text in FreeCAD's unit. Raises ValueError with what is wrong."""
        text = text.strip().replace(",", ".").replace("um", "µm")
        if not text:
            raise ValueError(translate("BeltGrinding", "This is no number: {}").format("''"))
        try:
            value = float(text) * SIZES[self.symbol]
        except ValueError:
            value = self._with_unit(text)
        if not math.isfinite(value):
            raise ValueError(translate("BeltGrinding", "This is no number: {}").format(text))
        return value

    def _with_unit(self, text: str) -> float:
        alike = next((one for one in (LENGTHS, SPEEDS) if self.symbol in one), {self.symbol})
        for symbol in sorted(alike, key=len, reverse=True):
            value = _number(text[: -len(symbol)]) if text.endswith(symbol) else None
            if value is not None:
                return value * SIZES[symbol]
        try:
            quantity = Units.Quantity(text)
        except Exception:  # the kind differs between FreeCAD's generations
            raise ValueError(
                translate("BeltGrinding", "This is no number: {}").format(text)
            ) from None
        if quantity.Unit == self.unit:
            return quantity.Value
        if quantity.Unit != Units.Unit():
            raise ValueError(translate("BeltGrinding", "The unit does not fit: {}").format(text))
        return quantity.Value * SIZES[self.symbol]  # 2 * 3.5

    def _typed(self, text: str) -> None:
        if text.startswith("=") or self.signalsBlocked():
            return
        try:
            value = self.parsed(text)
        except ValueError:
            return
        if value != self.raw and not self.refused(value):
            if self.bound is not None and self.expression():
                obj, name = self.bound
                obj.setExpression(name, None)
            self.raw = value
            self.valueChanged.emit(value)

    def _finished(self) -> None:
        text = self.text().strip()
        if text.startswith("=") and self.bound is not None:
            obj, name = self.bound
            try:
                obj.setExpression(name, text[1:])
                obj.recompute()
            except Exception as error:  # FreeCAD's parser has errors of many kinds
                self.complain(reason(error))
                return
            self.raw = float(getattr(obj, name))
            self.valueChanged.emit(self.raw)
        else:
            try:
                value = self.parsed(text)
            except ValueError:
                return  # stays, and is marked
            if value != self.raw:
                return  # refused, and is marked
        self._write()

    def _write(self) -> None:
        blocked = self.blockSignals(True)
        self.setText(written(self.raw, self.symbol))
        self.setCursorPosition(0)  # else a narrow panel shows the last digits only
        self.blockSignals(blocked)
        font = self.font()
        font.setItalic(bool(self.expression()))
        self.setFont(font)

    def keyPressEvent(self, event: QtEvent) -> None:
        steps = {QtCore.Qt.Key_Up: 1, QtCore.Qt.Key_Down: -1}.get(event.key(), 0)
        if not steps:
            return super().keyPressEvent(event)
        self._step(steps)

    def wheelEvent(self, event: QtEvent) -> None:
        """Turns the value; only where one has clicked into it (``steady``)."""
        self._step(1 if event.angleDelta().y() > 0 else -1)
        event.accept()

    def _step(self, steps: float) -> None:
        shown = self.raw / SIZES[self.symbol]
        step = 1.0 if abs(shown) >= 1.0 else 0.01
        self.setText(written((shown + steps * step) * SIZES[self.symbol], self.symbol))

    def _get_raw(self) -> float:
        return self.raw

    def _set_raw(self, value: float) -> None:
        if value != self.raw:
            self.raw = float(value)
            self._write()
            self.valueChanged.emit(self.raw)

    rawValue = QtCore.Property(float, _get_raw, _set_raw)


def _number(text: str) -> float | None:
    try:
        return float(text.strip())
    except ValueError:
        return None
