"""A form whose fields are bound to an object's properties, with FreeCAD's unit entry."""

import gc

import FreeCADGui as Gui
from FreeCAD import Placement, Rotation, Units, Vector

from .compat import QtCore, QtGui, translate

QUANTITIES = {
    "App::PropertyLength",
    "App::PropertyDistance",
    "App::PropertyAngle",
    "App::PropertySpeed",
    "App::PropertyForce",
    "App::PropertyPressure",
    "App::PropertyAcceleration",
}
ATTEMPTS = 20
MINIMUM_WIDTH = 96  # pixels: a panel must fit the combo view as it comes
NOT_NEGATIVE = {
    "App::PropertyLength",
    "App::PropertySpeed",
    "App::PropertyForce",
    "App::PropertyPressure",
    "App::PropertyAcceleration",
}


def quantity_field(quantity):
    """FreeCAD's entry for a number with its unit; its property rawValue is in FreeCAD's own unit."""
    widget = _spin_box()
    show_quantity(widget, quantity)
    widget.setMinimumWidth(MINIMUM_WIDTH)
    return widget


def _spin_box():
    for _ in range(ATTEMPTS):
        widget = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
        try:
            widget.objectName()
            return widget
        except RuntimeError:
            # A closed panel's widget was at this address, and PySide hands out its dead wrapper.
            gc.collect()
    raise RuntimeError("FreeCAD's entry for quantities cannot be made")


def show_quantity(widget, quantity):
    """Puts a quantity into FreeCAD's entry."""
    # FreeCAD's two decimals would round the value itself, not only its text.
    quantity = Units.Quantity(quantity)
    quantity.Format = {"Precision": 7, "NumberFormat": "g", "Denominator": 8}
    widget.setProperty("value", quantity)


SIGNED = "signed"


class Form(QtGui.QGroupBox):
    """Rows of fields; every change goes to the property at once."""

    def __init__(self, obj, title):
        super().__init__(title)
        self.obj = obj
        self.rows = {}  # property name: (label, widget)
        self.changed = lambda: None  # called after a property was set
        self.layout_ = QtGui.QFormLayout(self)
        self.layout_.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.layout_.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)

    def add(self, name, text, choices=None, unit=""):
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
            widget = QtGui.QSpinBox()
            widget.setValue(getattr(self.obj, name))
            widget.valueChanged.connect(lambda value: self._set(name, value))
        elif kind == "App::PropertyLinkGlobal":
            widget = self._link(name, choices or [])
        elif kind == "App::PropertyFile":
            widget = self._file(name, choices or "")
        elif kind == "App::PropertyPlacement":
            widget = FrameField(getattr(self.obj, name), lambda value: self._set(name, value))
        else:
            widget = self._number(name, -1e12 if choices == SIGNED else 0.0)
        widget.setToolTip(self.obj.getDocumentationOfProperty(name))
        widget.setObjectName(name)
        label = QtGui.QLabel(f"{text}, {unit}" if unit else text)
        label.setToolTip(widget.toolTip())
        self.layout_.addRow(label, widget)
        self.rows[name] = (label, widget)
        return widget

    def show_rows(self, names):
        """Shows the rows in ``names`` and hides the others."""
        for name, row in self.rows.items():
            for widget in row:
                widget.setVisible(name in names)

    def refresh(self, name):
        """Shows a number that was set from elsewhere."""
        widget, value = self.rows[name][1], getattr(self.obj, name)
        if self.obj.getTypeIdOfProperty(name) in QUANTITIES:
            show_quantity(widget, value)
        else:
            widget.setText(f"{value:g}")

    def _set(self, name, value):
        if getattr(self.obj, name) != value:
            setattr(self.obj, name, value)
            self.changed()

    def _quantity(self, name, kind):
        value = getattr(self.obj, name)
        widget = quantity_field(value)
        if kind in NOT_NEGATIVE:
            widget.setProperty("minimum", 0.0)
        Gui.ExpressionBinding(widget).bind(self.obj, name)

        def changed(*_):
            raw = float(widget.property("rawValue"))
            self._set(name, Units.Quantity(raw, value.Unit))

        widget.connect(widget, QtCore.SIGNAL("valueChanged(double)"), changed)
        return widget

    def _number(self, name, lowest=0.0):
        widget = QtGui.QLineEdit(f"{getattr(self.obj, name):g}")
        validator = QtGui.QDoubleValidator(lowest, 1e12, 12, widget)
        validator.setLocale(QtCore.QLocale.c())
        widget.setValidator(validator)
        widget.setCursorPosition(0)  # else a narrow panel shows the last digits only

        def changed(text):
            if widget.hasAcceptableInput():
                self._set(name, float(text))

        widget.textChanged.connect(changed)
        return widget

    def _enumeration(self, name, texts):
        widget = QtGui.QComboBox()
        # A long choice must not make the panel wider than the view that holds it.
        widget.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        widget.setMinimumContentsLength(10)
        values = self.obj.getEnumerationsOfProperty(name)
        for value in values:
            widget.addItem(texts.get(value, value))
        widget.setCurrentIndex(values.index(getattr(self.obj, name)))
        widget.currentIndexChanged.connect(lambda i: self._set(name, values[i]))
        return widget

    def _link(self, name, objects):
        widget = QtGui.QComboBox()
        choices = [None, *objects]
        for one in choices:
            widget.addItem(one.Label if one else translate("BeltGrinding", "(none)"))
        current = getattr(self.obj, name)
        widget.setCurrentIndex(choices.index(current) if current in choices else 0)
        widget.currentIndexChanged.connect(lambda i: self._set(name, choices[i]))
        return widget

    def _file(self, name, pattern):
        widget = Gui.UiLoader().createWidget("Gui::FileChooser")
        widget.setProperty("filter", pattern)
        widget.setProperty("fileName", getattr(self.obj, name))
        widget.connect(
            widget,
            QtCore.SIGNAL("fileNameSelected(const QString &)"),
            lambda path: self._set(name, str(path)),
        )
        return widget


class FrameField(QtGui.QWidget):
    """X, Y, Z and A, B, C (KUKA's: about z, y, x) of a frame."""

    def __init__(self, placement, changed):
        super().__init__()
        grid = QtGui.QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(4)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)
        angles = placement.Rotation.toEuler()
        self.fields = []
        for i, (name, value) in enumerate(zip("XYZABC", (*placement.Base, *angles))):
            field = quantity_field(Units.Quantity(value, Units.Length if i < 3 else Units.Angle))
            field.setMinimumWidth(MINIMUM_WIDTH // 2)
            # Without its buttons a narrow panel shows the number whole, from its sign on.
            field.setProperty("buttonSymbols", 2)
            field.findChild(QtGui.QLineEdit).setCursorPosition(0)
            field.setObjectName(name)
            field.setToolTip(name)
            field.connect(field, QtCore.SIGNAL("valueChanged(double)"), self._changed)
            grid.addWidget(QtGui.QLabel(name), i % 3, 2 * (i // 3))
            grid.addWidget(field, i % 3, 2 * (i // 3) + 1)
            self.fields.append(field)
        self.notify = changed

    def _changed(self, *_):
        x, y, z, a, b, c = (float(field.property("rawValue")) for field in self.fields)
        self.notify(Placement(Vector(x, y, z), Rotation(a, b, c)))
