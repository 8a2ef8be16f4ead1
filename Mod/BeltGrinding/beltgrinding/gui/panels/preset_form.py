"""Presets and the rubber's hardness in the belt machine's panel; both only set properties."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from ...engine import InputError
from ...objects import belt_machine, job_data, job_object
from ...objects.kinds import DocumentObject
from ...objects.properties import set_value
from ...objects.proxy import type_of
from ...presets import library as presets, rubber
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Json, Widget
from ..common.messages import error_text
from ..common.theme import warning_style
from ..widgets.steady import steady

if TYPE_CHECKING:
    from ..widgets.form import Form

YOUNGS_MODULUS = next(key for key in belt_machine.KEYS if key.name == "YoungsModulus")

SPEED = "belt_machine.belt_speed_m_s"
FIELD_WIDTH = 150  # pixels: wider than what a narrow panel has beside a label, so it goes below


class HardnessField:
    """A row for the Shore A hardness below Young's modulus, which it sets by the default formula.

    It keeps nothing in the document: a modulus that is changed afterwards empties it.
    """

    def __init__(self, form: Form) -> None:
        self.form = form
        self.line = QtGui.QLineEdit()
        self.line.setObjectName("ShoreA")
        self.line.setPlaceholderText(translate("BeltGrinding", "from hardness…"))
        validator = QtGui.QDoubleValidator(0.0, 100.0, 2, self.line)
        validator.setLocale(QtCore.QLocale.c())
        self.line.setValidator(validator)
        self.line.setToolTip(_formulas_text())
        self.text = QtGui.QLabel()
        self.text.setObjectName("ShoreAText")
        self.text.setWordWrap(True)
        self.text.hide()
        field = QtGui.QWidget()
        field.setMinimumWidth(FIELD_WIDTH)
        column = QtGui.QVBoxLayout(field)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.line)
        column.addWidget(self.text)
        label = QtGui.QLabel(translate("BeltGrinding", "Shore A"))
        label.setToolTip(self.line.toolTip())
        form.layout_.addRow(label, field)
        form.rows["ShoreA"] = (label, field)
        self.line.textChanged.connect(self._changed)

    def show(self, shore_a: float) -> None:
        """Shows a hardness and sets the modulus by it."""
        self.line.setText(f"{shore_a:g}")

    def follow(self) -> None:
        """Empties the field when the modulus no longer follows from it."""
        if not self.line.hasAcceptableInput():
            return
        try:
            modulus = rubber.modulus(float(self.line.text()))
        except InputError:
            return  # nothing was set by it
        set_by_it = YOUNGS_MODULUS.scale * modulus
        if not math.isclose(self.form.obj.YoungsModulus.Value, set_by_it, rel_tol=1e-5):
            self.line.clear()

    def _changed(self, text: str) -> None:
        try:
            if self.line.hasAcceptableInput():
                shore_a = float(text)
                text = rubber.spread_text(shore_a)
                set_value(self.form.obj, YOUNGS_MODULUS, rubber.modulus(shore_a))
                self.form.refresh("YoungsModulus")
        except InputError as error:
            text = error_text(error)
        self.text.setText(text)
        self.text.setVisible(bool(text))


def _formulas_text() -> str:
    lines = [translate("BeltGrinding", "Young's modulus E in MPa from the Shore A hardness S:")]
    for one in rubber.formulas().values():
        lines.append(f"{one['name']}: {one['equation']} ({one['least']:g} to {one['greatest']:g})")
    return "\n".join(lines)


class PresetForm(QtGui.QGroupBox):
    """Combo boxes of machine, wheel, belt, material and force control. A preset sets what it knows when it is chosen; the
    recommended belt speed only by its button.
    """

    def __init__(self, obj: DocumentObject, forms: Sequence[Form], hardness: HardnessField) -> None:
        super().__init__(translate("BeltGrinding", "Presets"))
        self.obj, self.forms, self.hardness = obj, forms, hardness
        # Combo boxes, and what is beside and below them, by kind.
        self.boxes: dict[str, Widget] = {}
        self.labels: dict[str, Widget] = {}
        self.hints: dict[str, Widget] = {}
        self.recommended = 0.0  # m/s
        self.rows = QtGui.QFormLayout(self)
        self.rows.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.rows.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        found = presets.library()
        self._add("machine", translate("BeltGrinding", "Free belt or platen"), found.machines)
        self._add("wheel", translate("BeltGrinding", "Wheel"), found.wheels)
        self._add("belt", translate("BeltGrinding", "Belt"), found.belts)
        self.speed = QtGui.QPushButton()
        self.speed.setObjectName("UseBeltSpeed")
        self.speed.hide()
        self._add("material", translate("BeltGrinding", "Material"), found.materials)
        self.rows.addRow(self.speed)
        self._add("actuator", translate("BeltGrinding", "Force control"), found.actuators)
        self.speed.clicked.connect(lambda *_: self._put({SPEED: self.recommended}))
        if found.problems:
            wrong = _hint("PresetProblems")
            wrong.setText("\n".join(error_text(problem) for problem in found.problems))
            wrong.setStyleSheet(warning_style())
            wrong.show()
            self.rows.addRow(wrong)

    def show_kind(self, kind: str) -> None:
        """Shows the presets that a kind of belt machine has: a wheel's only of a contact wheel."""
        for widgets in (self.labels, self.boxes):
            widgets["wheel"].setVisible(kind in belt_machine.WHEELS)
        self.hints["wheel"].setVisible(
            kind in belt_machine.WHEELS and bool(self.hints["wheel"].text())
        )

    def _add(self, kind: str, text: str, found: Sequence[Json]) -> None:
        box, hint = steady(QtGui.QComboBox()), _hint(f"{kind}PresetHint")
        self.boxes[kind] = box
        box.setObjectName(f"{kind}Preset")
        box.addItem(translate("BeltGrinding", "choose a preset…"))
        for preset in found:
            box.addItem(preset["name"])
            box.setItemData(
                box.count() - 1, "\n".join(presets.describe(preset)), QtCore.Qt.ToolTipRole
            )
        # A panel must fit the combo view; the list that opens may be as wide as its names.
        box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        box.setMinimumContentsLength(10)
        box.view().setMinimumWidth(box.view().sizeHintForColumn(0) + 24)
        self.labels[kind], self.hints[kind] = QtGui.QLabel(text), hint
        self.rows.addRow(self.labels[kind], box)
        self.rows.addRow(hint)
        box.currentIndexChanged.connect(
            lambda i: self._chosen(kind, found[i - 1] if i > 0 else None, hint)
        )

    def _chosen(self, kind: str, preset: Json | None, hint: Widget) -> None:
        lines = presets.describe(preset) if preset else []
        hint.setText("\n".join(short(preset)) if preset else "")
        hint.setToolTip("\n".join(lines))
        hint.setVisible(bool(lines))
        self.boxes[kind].setToolTip(preset["name"] if preset else "")
        values = presets.settings(**{kind: preset})
        if kind == "material":
            self.recommended = values.pop(SPEED, 0.0)
            text = translate("BeltGrinding", "Set the belt speed to {} m/s")
            self.speed.setText(text.format(f"{self.recommended:g}"))
            self.speed.setVisible(self.recommended > 0)
        self._put(values)
        if kind == "wheel" and preset and "shore_a" in preset and "youngs_modulus" not in preset:
            self.hardness.show(presets.middle(preset["shore_a"]))

    def _put(self, values: Json) -> None:
        """Sets the properties of the machine and of its job that mirror the job's keys."""
        jobs = [o for o in self.obj.InList if type_of(o) == job_object.BeltGrindingJob.TYPE]
        targets = [(self.obj, belt_machine.ALL_KEYS), *((job, job_data.KEYS) for job in jobs)]
        for obj, keys in targets:
            for key in keys:
                if key.key in values and hasattr(obj, key.name):
                    set_value(obj, key, values[key.key])
                    for form in self.forms:
                        if obj is form.obj and key.name in form.rows:
                            form.refresh(key.name)
        for form in self.forms:
            form.changed()


def _hint(name: str) -> Widget:
    label = QtGui.QLabel()
    label.setObjectName(name)
    label.setWordWrap(True)
    label.hide()
    return label


def short(preset: Json) -> list[str]:
    """What the preset says, by source and without its page, which the tool tip has."""
    lines = [preset["text"]] if "text" in preset else []
    numbers = presets.numbers(preset).items()
    for source, group in groupby(numbers, key=lambda item: rubber.cite(item[1]["source"])):
        said = "; ".join(f"{presets.label(name)} {presets.number_text(n)}" for name, n in group)
        lines.append(f"{said[0].upper()}{said[1:]}: {source}")
    return lines
