"""What temperatures are computed with: a material of the presets, and its values; a part of the job's panel."""

import copy
import json

from ...base import schemas
from ...engine import InputError
from ...objects.job_data import KEYS
from ...objects.properties import get_value, rule
from ...presets import library as presets
from ..common.compat import QtCore, QtGui, translate
from ..common.messages import error_text
from ..common.theme import warning_style
from ..widgets.form import WRONG
from ..widgets.rows import number, shown
from ..widgets.steady import steady
from .preset_form import short

HEAT = next(key for key in KEYS if key.name == "Heat")
PREFIX = "heat."


class HeatForm(QtGui.QGroupBox):
    """Edits the property Heat of a job, which is a job file's ``heat`` as a text; empty: no temperatures."""

    def __init__(self, job):
        super().__init__(translate("BeltGrinding", "Temperatures"))
        self.job, self.changed = job, lambda: None
        self.rows = QtGui.QFormLayout(self)
        self.rows.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.found = presets.library().thermals
        self.box = steady(QtGui.QComboBox())
        self.box.setObjectName("thermalPreset")
        self.box.addItem(translate("BeltGrinding", "not computed"))
        for preset in self.found:
            self.box.addItem(preset["name"])
            told = "\n".join(presets.describe(preset))
            self.box.setItemData(self.box.count() - 1, told, QtCore.Qt.ToolTipRole)
        self.box.addItem(translate("BeltGrinding", "own values"))
        self.box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.box.setMinimumContentsLength(10)
        self.box.view().setMinimumWidth(self.box.view().sizeHintForColumn(0) + 24)
        self.rows.addRow(translate("BeltGrinding", "Material"), self.box)
        ends = translate("BeltGrinding", "least … greatest")
        self.fields = {}  # what is typed, by key and number of its end
        for key, text in (
            ("conductivity_W_mK", translate("BeltGrinding", "Conductivity, W/(m K)")),
            ("heat_capacity_J_kgK", translate("BeltGrinding", "Heat capacity, J/(kg K)")),
            ("density_kg_m3", translate("BeltGrinding", "Density, kg/m³")),
            ("start_temperature_C", translate("BeltGrinding", "Before grinding, °C")),
            ("burn_temperature_C", translate("BeltGrinding", "Burnt above, °C (0: unknown)")),
        ):
            self.rows.addRow(text, self._entry(key, 0))
        for key, text in (
            ("friction", translate("BeltGrinding", "Friction")),
            ("partition", translate("BeltGrinding", "Share into the work")),
        ):
            pair = QtGui.QWidget()
            row = QtGui.QHBoxLayout(pair)
            row.setContentsMargins(0, 0, 0, 0)
            for end in (0, 1):
                row.addWidget(self._entry(key, end))
            pair.setToolTip(ends)
            self.rows.addRow(text, pair)
        self.told = QtGui.QLabel()
        self.told.setObjectName("heatNote")
        self.told.setWordWrap(True)
        self.rows.addRow(self.told)
        self.parts = [_part(preset) for preset in self.found]
        try:
            self.values = get_value(job, HEAT)
            if self.values is not None:
                self.values = schemas.checked(self.values, rule(HEAT.key)[0], HEAT.key)
            self.show_values()
        except InputError as error:  # written by hand; it stays until something is chosen here
            self.values = None
            self.show_values()
            self.told.setText(error_text(error))
            self.told.setStyleSheet(warning_style())
        self.box.currentIndexChanged.connect(self._chosen)

    def _entry(self, key, end):
        line = QtGui.QLineEdit()
        line.setObjectName(f"{key}{end + 1}" if key in ("friction", "partition") else key)
        line.setMinimumWidth(40)
        line.textEdited.connect(lambda _: self._typed())
        self.fields[key, end] = line
        return line

    def show_values(self):
        """Shows what the job has."""
        given = self.values
        self.box.blockSignals(True)
        self.box.setCurrentIndex(0 if given is None else self._number_of(given))
        self.box.blockSignals(False)
        for (key, end), line in self.fields.items():
            line.setEnabled(given is not None)
            value = (given or {}).get(key, {"start_temperature_C": 20.0}.get(key, 0.0))
            line.setText(
                "" if given is None else shown(value[end] if isinstance(value, list) else value)
            )
        self._tell()

    def _number_of(self, given):
        """The row of the preset whose values these are, else that of own ones."""
        for k, of_it in enumerate(self.parts, 1):
            if all(given.get(key) == value for key, value in of_it.items() if key != "burn_source"):
                return k
        return self.box.count() - 1

    def _chosen(self, index):
        if index == 0:
            self.values = None
        elif index <= len(self.found):
            start = (self.values or {}).get("start_temperature_C", 20.0)
            self.values = {**self.parts[index - 1], "start_temperature_C": start}
        elif self.values is None:
            # Something to begin with, which is then nobody's.
            self.values = {**self.parts[0], "material": "", "burn_source": ""}
            self.values.pop("burn_temperature_C")
        else:
            self.values = {**self.values, "material": "", "burn_source": ""}
        self.show_values()
        self._set()

    def _typed(self):
        try:
            values = self.read()
        except InputError:
            return  # told below the fields, and again by OK
        if values["burn_temperature_C"] != self.values.get("burn_temperature_C", 0.0):
            values["burn_source"] = ""  # it was that of another limit
        same = {
            key: value for key, value in values.items() if key not in ("material", "burn_source")
        }
        if same != {key: self.values.get(key) for key in same}:
            values["material"] = ""
        self.values = values
        self.box.blockSignals(True)
        self.box.setCurrentIndex(self._number_of(values))
        self.box.blockSignals(False)
        self._tell()
        self._set()

    def read(self):
        """A job's ``heat`` of what stands in the fields, None where none is computed. Raises InputError."""
        if self.values is None:
            return None
        found, error = copy.deepcopy(self.values), None
        for (key, end), line in self.fields.items():
            line.setStyleSheet("")
            try:
                value = number(line.text())
            except ValueError:
                value = None
            reason = self._reason(key, end, value)
            if reason:
                line.setStyleSheet(WRONG)
                error = error or InputError(
                    "gui.heat_value",
                    "Temperatures: '{text}': {reason}",
                    text=line.text().strip(),
                    reason=reason,
                )
            elif key in ("friction", "partition"):
                found[key] = [*found[key][:end], value, *found[key][end + 1 :]]
            else:
                found[key] = value
        if error is not None:
            self.told.setStyleSheet(warning_style())
            self.told.setText(error_text(error))
            raise error
        return found

    def _reason(self, key, end, value):
        if value is None:
            return translate("BeltGrinding", "This is no number: {}").format(
                self.fields[key, end].text() or "''"
            )
        if key == "start_temperature_C":
            return ""
        if value < 0.0 or (value == 0.0 and key != "burn_temperature_C"):
            return translate("BeltGrinding", "must be greater than 0")
        if key == "partition" and value > 1.0:
            return translate("BeltGrinding", "must lie from 0 to {}").format(1)
        if end == 1:
            try:
                least = number(self.fields[key, 0].text())
            except ValueError:
                least = None
            if least is not None and value < least:
                return translate("BeltGrinding", "the greatest lies below the least")
        return ""

    def _tell(self):
        """What is to be known of the values."""
        self.told.setStyleSheet("")
        if self.values is None:
            self.told.setText("")
            return
        index = self.box.currentIndex()
        lines = []
        if 0 < index <= len(self.found):
            lines += short(self.found[index - 1])
        lines.append(
            translate(
                "BeltGrinding",
                "The rise is in proportion to friction times share: measure them before you believe a temperature.",
            )
        )
        self.told.setText("\n".join(lines))

    def _set(self):
        text = "" if self.values is None else json.dumps(self.values)
        if self.job.Heat != text:
            self.job.Heat = text
            self.changed()

    def summary(self):
        """One line of it."""
        return self.box.currentText()

    def check(self):
        """Raises InputError for the first field with a mistake."""
        self.read()


def _part(preset):
    """A job's ``heat`` of a preset."""
    found = presets.settings(thermal=preset)
    return {key[len(PREFIX) :]: value for key, value in found.items()}
