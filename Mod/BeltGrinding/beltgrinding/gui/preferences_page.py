"""The page in FreeCAD's preferences: defaults of new jobs, threads, colours, unit of deviations."""

from __future__ import annotations

from collections.abc import Sequence

import FreeCAD
import FreeCADGui as Gui
from FreeCAD import Units

from ..engine import InputError
from ..objects import preferences
from ..objects.deviation import Deviation
from ..objects.proxy import type_of
from .common.compat import QtGui, translate
from .common.kinds import Colour, Layout, Widget
from .common.messages import error_text
from .common.redraw import drawing
from .common.theme import warning_style
from .widgets.form import WRONG, quantity_field, show_quantity, watch_quantity
from .widgets.steady import steady

MOST_THREADS = 1024
LIMITS = "DefaultToleranceLower", "DefaultToleranceUpper"


class PreferencesPage:
    """FreeCAD makes one when its preferences open, and calls loadSettings and saveSettings."""

    def __init__(self, *_: object) -> None:
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(translate("BeltGrinding", "General"))
        body = QtGui.QVBoxLayout(self.form)
        body.addWidget(self._new_jobs())
        body.addWidget(self._simulation())
        body.addWidget(self._deviation())
        body.addStretch()

    def _new_jobs(self) -> Widget:
        texts = (
            translate("BeltGrinding", "Sample spacing"),
            translate("BeltGrinding", "Lower limit"),
            translate("BeltGrinding", "Upper limit"),
            translate("BeltGrinding", "Colours end at"),
        )
        box, rows = _group(translate("BeltGrinding", "New jobs"))
        self.defaults = {}
        for (name, prop, _), text in zip(preferences.JOB_DEFAULTS, texts):
            field = quantity_field(Units.Quantity(0.0, Units.Length), "mm")
            field.setObjectName(name)
            if "Tolerance" not in prop:
                field.setProperty("minimum", 1e-6)
            rows.addRow(text, field)
            self.defaults[name] = field
        self.wrong = QtGui.QLabel()
        self.wrong.setObjectName("wrongDefaults")
        self.wrong.setWordWrap(True)
        self.wrong.setStyleSheet(warning_style(True))
        self.wrong.hide()
        rows.addRow(self.wrong)
        for name in LIMITS:
            watch_quantity(self.defaults[name], self._check_limits)
        return box

    def _swapped(self) -> bool:
        """Whether the lower limit lies above the upper one."""
        lower, upper = (float(self.defaults[name].property("rawValue")) for name in LIMITS)
        return lower > upper

    def _check_limits(self) -> None:
        """Marks the limits where they are swapped, and says that they will not be stored."""
        text = more = ""
        if self._swapped():
            text = translate("BeltGrinding", "The lower limit lies above the upper limit.")
            more = text + " " + translate("BeltGrinding", "Both stay as they were.")
        self.wrong.setText(text)
        self.wrong.setVisible(bool(text))
        for name in LIMITS:
            self.defaults[name].setStyleSheet(WRONG if text else "")
            self.defaults[name].setToolTip(more)

    def _simulation(self) -> Widget:
        box, rows = _group(translate("BeltGrinding", "Simulation"))
        self.threads = steady(QtGui.QSpinBox())
        self.threads.setObjectName("Threads")
        self.threads.setRange(0, MOST_THREADS)
        self.threads.setSpecialValueText(translate("BeltGrinding", "all"))
        self.threads.setToolTip(
            translate(
                "BeltGrinding", "Fewer leave more of the machine to others; results are equal"
            )
        )
        rows.addRow(translate("BeltGrinding", "Threads"), self.threads)
        return box

    def _deviation(self) -> Widget:
        box, rows = _group(translate("BeltGrinding", "Deviation"))
        self.unit = steady(QtGui.QComboBox())
        self.unit.setObjectName("DeviationUnit")
        for unit in preferences.UNITS:
            self.unit.addItem(unit.symbol)
        self.unit.setToolTip(
            translate(
                "BeltGrinding",
                "For the legend and the figures of the deviation. All else is shown in the units of "
                "FreeCAD's own preferences",
            )
        )
        rows.addRow(translate("BeltGrinding", "Unit"), self.unit)
        texts = (
            translate("BeltGrinding", "In tolerance"),
            translate("BeltGrinding", "Too much left"),
            translate("BeltGrinding", "Cut too deep"),
        )
        self.colours = {}
        for name, text in zip(preferences.COLOURS, texts):
            button = ColourButton()
            button.setObjectName(name)
            rows.addRow(text, button)
            self.colours[name] = button
        standard = QtGui.QPushButton(translate("BeltGrinding", "Standard colours"))
        standard.setObjectName("StandardColours")
        standard.setToolTip(
            translate(
                "BeltGrinding", "The standard colours can be told apart with any colour vision"
            )
        )
        standard.clicked.connect(lambda: self._show_colours(preferences.standard_colours()))
        rows.addRow("", standard)
        return box

    def _show_colours(self, packed: Sequence[int]) -> None:
        for button, colour in zip(self.colours.values(), packed):
            button.show_colour(colour)

    def loadSettings(self) -> None:
        """Shows what is set."""
        for name, field in self.defaults.items():
            show_quantity(field, Units.Quantity(preferences.job_default(name), Units.Length))
        group = preferences.parameters()
        self.threads.setValue(group.GetInt("Threads", 0))
        symbols = [unit.symbol for unit in preferences.UNITS]
        self.unit.setCurrentIndex(symbols.index(preferences.deviation_unit().symbol))
        self._show_colours(preferences.colours() or preferences.standard_colours())

    def saveSettings(self) -> None:
        """Stores what is shown, and lets it take effect."""
        group = preferences.parameters()
        values = {name: float(f.property("rawValue")) for name, f in self.defaults.items()}
        if self._swapped():
            FreeCAD.Console.PrintWarning(self.wrong.text() + "\n")
            for name in LIMITS:
                del values[name]
        for name, value in values.items():
            # What nobody changed goes on following the schema's default.
            if abs(value - preferences.job_default(name)) > 1e-12:
                group.SetFloat(name, value)
        group.SetInt("Threads", self.threads.value())
        group.SetString("DeviationUnit", self.unit.currentText())
        colours = tuple(button.colour for button in self.colours.values())
        for name, colour, standard in zip(
            preferences.COLOURS, colours, preferences.standard_colours()
        ):
            # What is standard follows a later standard.
            if colour == standard:
                group.RemUnsigned(name)
            else:
                group.SetUnsigned(name, colour)
        take_effect()


def _group(title: str) -> tuple[Widget, Layout]:
    box = QtGui.QGroupBox(title)
    return box, QtGui.QFormLayout(box)


class ColourButton(QtGui.QPushButton):
    """Shows a colour, 0xRRGGBBAA, and asks for another one when pressed."""

    def __init__(self) -> None:
        super().__init__()
        self.clicked.connect(self.ask)
        self.show_colour(255)

    def show_colour(self, colour: Colour) -> None:
        self.colour = int(colour)
        image = QtGui.QPixmap(32, 16)
        image.fill(QtGui.QColor(f"#{self.colour >> 8:06x}"))
        self.setIcon(QtGui.QIcon(image))
        self.setIconSize(image.size())

    def ask(self) -> None:
        chosen = QtGui.QColorDialog.getColor(QtGui.QColor(f"#{self.colour >> 8:06x}"), self)
        if chosen.isValid():
            self.show_colour(chosen.rgb() << 8 & 0xFFFFFF00 | 255)


def take_effect() -> None:
    """Lets the preferences hold: the threads, and what is shown of all deviations that are open."""
    preferences.apply_threads()
    drawing.ask_all()
    for dock in Gui.getMainWindow().findChildren(QtGui.QDockWidget):
        if hasattr(dock, "preferences_changed"):
            dock.preferences_changed()
    for document in FreeCAD.listDocuments().values():
        for obj in document.Objects:
            if type_of(obj) != Deviation.TYPE:
                continue
            try:
                obj.Proxy.update(obj)
            except InputError as error:  # its result is gone
                FreeCAD.Console.PrintWarning(f"{error_text(error)}\n")
