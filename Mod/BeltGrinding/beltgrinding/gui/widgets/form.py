"""A form whose fields are bound to an object's properties, with FreeCAD's unit entry."""

from __future__ import annotations

import gc
import math
from collections.abc import Collection, Sequence
from typing import Any

import FreeCADGui as Gui
from FreeCAD import Placement, Rotation, Units, Vector

from ...engine import InputError
from ...objects.kinds import DocumentObject, Point
from ...objects.properties import limits
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Changed, Quantity, Texts, Widget
from . import quantity_entry
from .quantity_entry import QuantityEntry
from .steady import steady

QUANTITIES = {
    "App::PropertyLength",
    "App::PropertyDistance",
    "App::PropertyAngle",
    "App::PropertySpeed",
    "App::PropertyForce",
    "App::PropertyPressure",
    "App::PropertyAcceleration",
}
NUMBERS = {"App::PropertyFloat", "App::PropertyPrecision", "App::PropertyInteger"}
WRONG = "QAbstractSpinBox, QLineEdit { border: 2px solid #b3261e; }"
ATTEMPTS = 20
MINIMUM_WIDTH = 96  # pixels: a panel must fit the combo view as it comes
NOT_NEGATIVE = {
    "App::PropertyLength",
    "App::PropertySpeed",
    "App::PropertyForce",
    "App::PropertyPressure",
    "App::PropertyAcceleration",
}


def quantity_field(quantity: Quantity, symbol: str) -> Widget:
    """An entry for a number with its unit, shown in ``symbol``'s; its property rawValue is in FreeCAD's own unit.
    FreeCAD's entry where its unit system is not metric."""
    if quantity_entry.metric():
        widget = QuantityEntry(quantity.Value, quantity.Unit, symbol)
    else:
        widget = _spin_box()
        show_quantity(widget, quantity)
    widget.setMinimumWidth(MINIMUM_WIDTH)
    return widget


def _spin_box() -> Widget:
    for _ in range(ATTEMPTS):
        widget = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
        try:
            widget.objectName()
            return steady(widget)
        except RuntimeError:
            # A closed panel's widget was at this address, and PySide hands out its dead wrapper.
            gc.collect()
    raise RuntimeError("FreeCAD's entry for quantities cannot be made")


def watch_quantity(widget: Widget, changed: Changed) -> None:
    """Calls ``changed()`` when the value of a ``quantity_field`` is another one."""
    if isinstance(widget, QuantityEntry):
        widget.valueChanged.connect(lambda _: changed())
    else:
        widget.connect(widget, QtCore.SIGNAL("valueChanged(double)"), lambda _: changed())


def show_quantity(widget: Widget, quantity: Quantity) -> None:
    """Puts a quantity into a ``quantity_field``."""
    if isinstance(widget, QuantityEntry):
        return widget.show_value(Units.Quantity(quantity).Value)
    # FreeCAD's two decimals would round the value itself, not only its text.
    quantity = Units.Quantity(quantity)
    quantity.Format = {"Precision": 7, "NumberFormat": "g", "Denominator": 8}
    widget.setProperty("value", quantity)


def number(text: str) -> float | None:
    """The number in a text, with a point or, as many languages have it, a comma; or None."""
    try:
        value = float(text.strip().replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _no_number(text: str) -> str:
    if not text:
        return translate("BeltGrinding", "Enter a number.")
    return translate("BeltGrinding", "This is no number: {}").format(text)


SIGNED = "signed"


FILE_WIDTH = (
    170  # pixels: beside most labels it goes on a line of its own, where a name can be read
)


class Form(QtGui.QGroupBox):
    """Rows of fields; every change goes to the property at once."""

    def __init__(self, obj: DocumentObject, title: str) -> None:
        super().__init__(title)
        self.obj = obj
        self.rows: dict[str, tuple[Widget, Widget]] = {}  # property name: (label, widget)
        self.choices: dict[str, list[DocumentObject | None]] = {}  # of links, by property
        self.changed = lambda: None  # called after a property was set
        self.unsigned: set[str] = set()  # that must not be negative, whatever the schema says
        # property name: what is wrong with what stands in its field, as typed, as told, as shown
        self.typed: dict[str, str] = {}
        self.told: dict[str, str] = {}
        self.mistakes: dict[str, str] = {}
        self.layout_ = QtGui.QFormLayout(self)
        self.layout_.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.layout_.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)

    def add(self, name: str, text: str, choices: Any = None, unit: str = "") -> Widget:
        """A row for the property ``name``. choices: texts of an enumeration's values, or the objects
        that a link can take, or SIGNED for a number that may be negative; unit: shown behind a plain
        number."""
        kind = self.obj.getTypeIdOfProperty(name)
        if kind in QUANTITIES:
            widget = self._quantity(name, kind)
        elif kind == "App::PropertyEnumeration":
            widget = self._enumeration(name, choices or {})
        elif kind == "App::PropertyBool":
            widget = QtGui.QCheckBox()
            widget.setChecked(getattr(self.obj, name))
            widget.toggled.connect(lambda on: self._set(name, on))
        elif kind == "App::PropertyInteger":
            widget = steady(QtGui.QSpinBox())
            # Whoever adds it may set another range; the value must not be cut off before.
            widget.setMaximum(max(widget.maximum(), getattr(self.obj, name)))
            widget.setValue(getattr(self.obj, name))
            widget.valueChanged.connect(lambda value: self._set(name, value))
        elif kind == "App::PropertyLinkGlobal":
            widget = self._link(name, choices or [])
        elif kind == "App::PropertyFile":
            widget = self._file(name, choices or "")
        elif kind == "App::PropertyPlacement":
            widget = FrameField(getattr(self.obj, name), lambda value: self._set(name, value))
        elif kind == "App::PropertyVector":
            widget = DirectionField(getattr(self.obj, name), lambda value: self._set(name, value))
        elif kind == "App::PropertyString":
            widget = QtGui.QLineEdit(getattr(self.obj, name))
            widget.textChanged.connect(lambda text: self._set(name, text))
        else:
            widget = self._number(name, choices == SIGNED)
        widget.setToolTip(self.obj.getDocumentationOfProperty(name))
        widget.setObjectName(name)
        label = QtGui.QLabel(f"{text}, {unit}" if unit else text)
        label.setToolTip(widget.toolTip())
        self.layout_.addRow(label, widget)
        self.rows[name] = (label, widget)
        self._watch(name, widget)
        return widget

    def _watch(self, name: str, widget: Widget) -> None:
        """Checks a number as it is typed."""
        line = widget if isinstance(widget, QtGui.QLineEdit) else widget.findChild(QtGui.QLineEdit)
        kind = self.obj.getTypeIdOfProperty(name)
        if line is not None and (kind in QUANTITIES or kind in NUMBERS):
            line.textChanged.connect(lambda text: self._check_typed(name, text))

    def _mistake(self, name: str, text: str) -> str:
        """What is wrong with a number as it was typed; '' if nothing is."""
        unit = getattr(getattr(self.obj, name), "Unit", None)
        if unit is None:
            value = number(text)
            if value is None:
                return _no_number(text)
            return self._out_of_limits(name, value)
        if text.startswith("="):
            return ""  # an expression, which FreeCAD checks itself
        widget = self.rows[name][1]
        if isinstance(widget, QuantityEntry):
            try:
                return self._out_of_limits(name, widget.parsed(text))
            except ValueError as error:
                return str(error)
        try:
            quantity = Units.Quantity(text)
        except Exception:  # the kind differs between FreeCAD's generations
            return _no_number(text)
        if quantity.Unit == unit:
            return self._out_of_limits(name, quantity.Value)
        if quantity.Unit != Units.Unit():
            return translate("BeltGrinding", "The unit does not fit: {}").format(text)
        # A bare number takes the unit that the field shows; zero is the same in all.
        bare = limits(self.obj, name)[0] == 0.0 and quantity.Value <= 0.0
        return self._out_of_limits(name, quantity.Value) if bare else ""

    def _out_of_limits(self, name: str, value: float) -> str:
        low, high, open_low = limits(self.obj, name)
        if name in self.unsigned and (low is None or low < 0.0):
            low = 0.0
        if low is not None and (value < low or open_low and value == low):
            if open_low:
                return translate("BeltGrinding", "Must be greater than {}").format(
                    self._shown(name, low)
                )
            return translate("BeltGrinding", "Must be at least {}").format(self._shown(name, low))
        if high is not None and value > high:
            return translate("BeltGrinding", "Must be at most {}").format(self._shown(name, high))
        return ""

    def _shown(self, name: str, value: float) -> str:
        unit = getattr(getattr(self.obj, name), "Unit", None)
        if unit is not None and isinstance(self.rows[name][1], QuantityEntry):
            return quantity_entry.written(value, quantity_entry.symbol_of(self.obj, name))
        return f"{value:g}" if unit is None else Units.Quantity(value, unit).UserString

    def mark(self, name: str, mistake: str) -> None:
        """Frames a field in red and says in its tooltip what is wrong; '' takes that back. What is
        wrong with the number as it was typed is marked anyway.
        """
        self.told[name] = mistake
        self._show_mistake(name)

    def _show_mistake(self, name: str) -> None:
        mistake = self.typed.get(name) or self.told.get(name) or ""
        if self.mistakes.get(name, "") == mistake:
            return
        widget = self.rows[name][1]
        self.mistakes[name] = mistake
        widget.setStyleSheet(WRONG if mistake else "")
        # FreeCAD's entry resets its own tooltip while something wrong stands in it.
        for shown in (widget, *widget.findChildren(QtGui.QLineEdit)):
            shown.setToolTip(mistake or self.obj.getDocumentationOfProperty(name))

    def _refuse(self, name: str, mistake: str) -> None:
        """Marks what was typed as wrong, until something else is typed."""
        self.typed[name] = mistake
        self._show_mistake(name)

    def _check_typed(self, name: str, text: str) -> None:
        self._refuse(name, self._mistake(name, text))

    def check(self) -> None:
        """Raises InputError for the first visible field with a mistake."""
        for name, mistake in self.mistakes.items():
            label, widget = self.rows[name]
            if mistake and not widget.isHidden():
                raise InputError(
                    "gui.field", "{label}: {mistake}", label=label.text(), mistake=mistake, key=name
                )

    def show_rows(self, names: Collection[str]) -> None:
        """Shows the rows in ``names`` and hides the others."""
        for name, row in self.rows.items():
            for widget in row:
                widget.setVisible(name in names)

    def refresh(self, name: str) -> None:
        """Shows a value that was set from elsewhere."""
        widget, value = self.rows[name][1], getattr(self.obj, name)
        if isinstance(widget, QtGui.QComboBox):
            widget.blockSignals(True)
            widget.setCurrentIndex(self.obj.getEnumerationsOfProperty(name).index(value))
            widget.blockSignals(False)
        elif self.obj.getTypeIdOfProperty(name) in QUANTITIES:
            show_quantity(widget, value)
        elif isinstance(widget, FrameField):
            widget.show_placement(value)
        else:
            widget.setText(f"{value:g}")

    def _set(self, name: str, value: Any) -> None:
        if getattr(self.obj, name) != value:
            setattr(self.obj, name, value)
            self.changed()

    def _quantity(self, name: str, kind: str) -> Widget:
        value = getattr(self.obj, name)
        widget = quantity_field(value, quantity_entry.symbol_of(self.obj, name))
        if isinstance(widget, QuantityEntry):
            widget.bind(self.obj, name)
            widget.complain = lambda text: self._refuse(name, text)
            negative = kind in NOT_NEGATIVE
            widget.refused = lambda v: bool(negative and v < 0.0 or self._out_of_limits(name, v))
        else:
            if kind in NOT_NEGATIVE:
                widget.setProperty("minimum", 0.0)
            Gui.ExpressionBinding(widget).bind(self.obj, name)

        def changed() -> None:
            raw = float(widget.property("rawValue"))
            self._set(name, Units.Quantity(raw, value.Unit))

        watch_quantity(widget, changed)
        return widget

    def _number(self, name: str, signed: bool = False) -> Widget:
        widget = QtGui.QLineEdit(f"{getattr(self.obj, name):g}")
        if not signed:
            self.unsigned.add(name)
        widget.setCursorPosition(0)  # else a narrow panel shows the last digits only

        def changed(text: str) -> None:
            value = number(text)
            if value is not None and not self._out_of_limits(name, value):
                self._set(name, value)

        widget.textChanged.connect(changed)
        return widget

    def _enumeration(self, name: str, texts: Texts) -> Widget:
        widget = steady(QtGui.QComboBox())
        # A long choice must not make the panel wider than the view that holds it.
        widget.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        widget.setMinimumContentsLength(10)
        values = self.obj.getEnumerationsOfProperty(name)
        for value in values:
            widget.addItem(texts.get(value, value))
        widget.setCurrentIndex(values.index(getattr(self.obj, name)))
        widget.currentIndexChanged.connect(lambda i: self._set(name, values[i]))
        return widget

    def _link(self, name: str, objects: Sequence[DocumentObject]) -> Widget:
        widget = steady(QtGui.QComboBox())
        self._offer(widget, name, objects, [one.Label for one in objects])
        widget.currentIndexChanged.connect(lambda i: self._set(name, self.choices[name][i]))
        return widget

    def _offer(
        self, widget: Widget, name: str, objects: Sequence[DocumentObject], texts: Sequence[str]
    ) -> None:
        self.choices[name] = [None, *objects]
        widget.clear()
        widget.addItems([translate("BeltGrinding", "(none)"), *texts])
        current = getattr(self.obj, name)
        widget.setCurrentIndex(
            self.choices[name].index(current) if current in self.choices[name] else 0
        )

    def offer(self, name: str, objects: Sequence[DocumentObject], texts: Sequence[str]) -> None:
        """Other objects that a link can take, under these texts; one that is not among them stays until another is
        chosen."""
        widget = self.rows[name][1]
        widget.blockSignals(True)
        self._offer(widget, name, objects, texts)
        widget.blockSignals(False)

    def _file(self, name: str, pattern: str) -> Widget:
        widget = Gui.UiLoader().createWidget("Gui::FileChooser")
        widget.setProperty("filter", pattern)
        widget.setProperty("fileName", getattr(self.obj, name))
        widget.setMinimumWidth(FILE_WIDTH)
        widget.connect(
            widget,
            QtCore.SIGNAL("fileNameSelected(const QString &)"),
            lambda path: self._set(name, str(path)),
        )
        return widget


class FrameField(QtGui.QWidget):
    """X, Y, Z and A, B, C (KUKA's: about z, y, x) of a frame, one below the other: side by side, a panel as
    FreeCAD opens it shows none of them whole."""

    def __init__(self, placement: Placement, changed: Changed) -> None:
        super().__init__()
        grid = QtGui.QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(4)
        grid.setVerticalSpacing(2)
        grid.setColumnStretch(1, 1)
        angles = placement.Rotation.toEuler()
        self.fields = []
        for i, (name, value) in enumerate(zip("XYZABC", (*placement.Base, *angles))):
            unit, symbol = (Units.Length, "mm") if i < 3 else (Units.Angle, "°")
            field = quantity_field(Units.Quantity(value, unit), symbol)
            field.setObjectName(name)
            field.setToolTip(name)
            watch_quantity(field, self._changed)
            grid.addWidget(QtGui.QLabel(name), i, 0)
            grid.addWidget(field, i, 1)
            self.fields.append(field)
        self.notify = changed

    def show_placement(self, placement: Placement) -> None:
        """Shows one that was set from elsewhere, and tells nobody."""
        notify, self.notify = self.notify, lambda _: None
        for i, (field, value) in enumerate(
            zip(self.fields, (*placement.Base, *placement.Rotation.toEuler()))
        ):
            show_quantity(field, Units.Quantity(value, Units.Length if i < 3 else Units.Angle))
        self.notify = notify

    def _changed(self) -> None:
        x, y, z, a, b, c = (float(field.property("rawValue")) for field in self.fields)
        self.notify(Placement(Vector(x, y, z), Rotation(a, b, c)))


class DirectionField(QtGui.QWidget):
    """x, y, z of a direction side by side, plain numbers; ``changed(vector)`` where all are numbers and it
    is not zero."""

    def __init__(self, vector: Point, changed: Changed) -> None:
        super().__init__()
        row = QtGui.QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        self.fields = []
        for name, value in zip("XYZ", vector):
            field = QtGui.QLineEdit(f"{value:g}")
            field.setObjectName(name)
            field.setToolTip(name)
            field.setMinimumWidth(MINIMUM_WIDTH // 3)
            field.editingFinished.connect(self._changed)
            row.addWidget(field)
            self.fields.append(field)
        self.notify = changed

    def _changed(self) -> None:
        values = [number(field.text()) for field in self.fields]
        for field, value in zip(self.fields, values):
            field.setStyleSheet(WRONG if value is None or not any(values) else "")
        if None not in values and any(values):
            self.notify(Vector(*values))
