"""What temperatures are computed with: a material of the presets, and its values; a part of the job's panel."""

from __future__ import annotations

from typing import Any

from ...base.kinds import known
from ...engine import InputError
from ...objects.kinds import DocumentObject
from ...presets import library as presets
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Json
from ..widgets.rows import number, shown
from .key_form import KeyForm
from .preset_form import short

PREFIX = "heat."
PAIRS = ("friction", "partition")
START = 20.0  # °C, the schema's


class HeatForm(KeyForm):
    """Edits the property Heat of a job, which is a job file's ``heat`` as a text; empty: no temperatures."""

    def __init__(self, job: DocumentObject) -> None:
        title = translate("BeltGrinding", "Temperatures")
        super().__init__(job, "Heat", title, "thermalPreset")
        self.found = presets.library().thermals
        self.parts = [_part(preset) for preset in self.found]
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
        for key, text in (
            ("conductivity_W_mK", translate("BeltGrinding", "Conductivity, W/(m K)")),
            ("heat_capacity_J_kgK", translate("BeltGrinding", "Heat capacity, J/(kg K)")),
            ("density_kg_m3", translate("BeltGrinding", "Density, kg/m³")),
            ("start_temperature_C", translate("BeltGrinding", "Before grinding, °C")),
            ("burn_temperature_C", translate("BeltGrinding", "Burnt above, °C (0: unknown)")),
        ):
            self.rows.addRow(text, self.entry((key, 0), key))
        for key, text in (
            ("friction", translate("BeltGrinding", "Friction")),
            ("partition", translate("BeltGrinding", "Share into the work")),
        ):
            pair = QtGui.QWidget()
            row = QtGui.QHBoxLayout(pair)
            row.setContentsMargins(0, 0, 0, 0)
            for end in (0, 1):
                row.addWidget(self.entry((key, end), f"{key}{end + 1}"))
            pair.setToolTip(translate("BeltGrinding", "least … greatest"))
            self.rows.addRow(text, pair)
        self.begin("heatNote")

    def shown(self, key: Any) -> str:
        name, end = key
        value = known(self.values).get(name, START if name == "start_temperature_C" else 0.0)
        return shown(value[end] if name in PAIRS else value)

    def index(self) -> int:
        """The row of the preset whose values these are, else that of own ones."""
        if self.values is None:
            return 0
        for k, of_it in enumerate(self.parts, 1):
            if all(
                self.values.get(key) == value
                for key, value in of_it.items()
                if key != "burn_source"
            ):
                return k
        return self.box.count() - 1

    def chosen(self, index: int) -> None:
        if index == 0:
            self.values = None
        elif index <= len(self.found):
            start = (self.values or {}).get("start_temperature_C", START)
            self.values = {**self.parts[index - 1], "start_temperature_C": start}
        elif self.values is None:
            # Something to begin with, which is then nobody's.
            self.values = {**self.parts[0], "material": "", "burn_source": ""}
            self.values.pop("burn_temperature_C")
        else:
            self.values = {**self.values, "material": "", "burn_source": ""}
        self.show_values()
        self.write()

    def read(self) -> dict[str, Any] | None:
        values, before = super().read(), self.values
        if values is None or before is None:
            return None
        if values["burn_temperature_C"] != before.get("burn_temperature_C", 0.0):
            values["burn_source"] = ""  # it was that of another limit
        same = {
            key: value for key, value in values.items() if key not in ("material", "burn_source")
        }
        if same != {key: before.get(key) for key in same}:
            values["material"] = ""
        return values

    def put(self, values: dict[str, Any], key: Any, value: Any) -> None:
        name, end = key
        if name in PAIRS:
            values[name][end] = value
        else:
            values[name] = value

    def reason(self, key: Any, value: float | None) -> str:
        name, end = key
        if value is None:
            return translate("BeltGrinding", "This is no number: {}").format("''")
        if name == "start_temperature_C":
            return ""
        if value < 0.0 or (value == 0.0 and name != "burn_temperature_C"):
            return translate("BeltGrinding", "must be greater than 0")
        if name == "partition" and value > 1.0:
            return translate("BeltGrinding", "must lie from 0 to {}").format(1)
        if end == 1:
            try:
                least = number(self.fields[name, 0].text())
            except ValueError:
                least = None
            if least is not None and value < least:
                return translate("BeltGrinding", "the greatest lies below the least")
        return ""

    def mistake(self, text: str, reason: str) -> InputError:
        return InputError(
            "gui.heat_value", "Temperatures: '{text}': {reason}", text=text, reason=reason
        )

    def lines(self) -> list[str]:
        index = self.box.currentIndex()
        of_preset = short(self.found[index - 1]) if 0 < index <= len(self.found) else []
        return [
            *of_preset,
            translate(
                "BeltGrinding",
                "The rise is in proportion to friction times share: measure them before you believe a temperature.",
            ),
        ]

    def summary(self) -> str:
        """One line of it."""
        return self.box.currentText()


def _part(preset: Json) -> dict[str, Any]:
    """A job's ``heat`` of a preset."""
    found = presets.settings(thermal=preset)
    return {key[len(PREFIX) :]: value for key, value in found.items()}
