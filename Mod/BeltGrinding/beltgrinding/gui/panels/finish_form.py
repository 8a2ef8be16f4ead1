"""What the finish (roughness, lay) is computed with; a part of the job's panel."""

from __future__ import annotations

from typing import Any

from ...base.kinds import known
from ...engine import InputError
from ...objects.job_data import finish_model
from ...objects.kinds import DocumentObject
from ...simulation.finish import check_grit
from ..common.compat import QtGui, translate
from ..common.kinds import Json, Widget
from ..widgets.form import WRONG
from ..widgets.rows import shown
from .finish_fit import FinishFit
from .finish_words import exponents, spans
from .key_form import KeyForm

ANGLE = 20.0  # degrees, the schema's


class FinishForm(KeyForm):
    """Edits the property Finish of a job, which is a job file's ``finish`` as a text; empty: none."""

    def __init__(self, job: DocumentObject) -> None:
        super().__init__(job, "Finish", translate("BeltGrinding", "Finish"), "finishChoice")
        # What computing it again takes up.
        self.before: dict[str, Any] | None = {"crossing_angle_deg": ANGLE}
        self.box.addItems(
            [translate("BeltGrinding", "not computed"), translate("BeltGrinding", "computed")]
        )
        self.rows.addRow(translate("BeltGrinding", "Roughness and lay"), self.box)
        unknown = translate("BeltGrinding", "empty: not known")
        for key, text, tip in (
            ("initial_Ra_um", translate("BeltGrinding", "Ra before grinding, µm"), unknown),
            ("grit", translate("BeltGrinding", "Grit"), translate("BeltGrinding", "as measured")),
            (
                "rest_per_pass",
                translate("BeltGrinding", "Left by a pass, share"),
                translate("BeltGrinding", "empty: what the measurements tell"),
            ),
            ("crossing_angle_deg", translate("BeltGrinding", "Crossed from, °"), ""),
        ):
            line = self.entry(key, key)
            line.setToolTip(tip)
            self.rows.addRow(text, line)
        self.fitting = FinishFit(self)
        self.rows.addRow(translate("BeltGrinding", "Measurements"), self._model_row())
        self.begin("finishNote")

    def _model_row(self) -> Widget:
        box = QtGui.QWidget()
        row = QtGui.QGridLayout(box)
        row.setContentsMargins(0, 0, 0, 0)
        tip = translate("BeltGrinding", "A CSV of measured roughnesses, to which a model is fitted")
        self.fit = self._button("fitFinish", translate("BeltGrinding", "Fit..."), tip)
        self.fit.clicked.connect(lambda *_: self.fitting.press())
        tip = translate(
            "BeltGrinding", "The file that Fit... or beltgrind calibrate-finish has written"
        )
        self.load = self._button("readFinishModel", translate("BeltGrinding", "Read..."), tip)
        self.load.clicked.connect(lambda *_: self._browse())
        self.drop = self._button("dropFinishModel", translate("BeltGrinding", "Remove"), "")
        self.drop.clicked.connect(lambda *_: self.take_model(None))
        row.addWidget(self.fit, 0, 0)
        row.addWidget(self.load, 0, 1)
        row.addWidget(self.drop, 1, 0, 1, 2)
        return box

    def _button(self, name: str, text: str, tip: str) -> Widget:
        button = QtGui.QPushButton(text)
        button.setObjectName(name)
        button.setToolTip(tip)
        return button

    def index(self) -> int:
        return 0 if self.values is None else 1

    def shown(self, key: Any) -> str:
        return shown(known(self.values).get(key))

    def show_values(self) -> None:
        super().show_values()
        self.arrange()

    def arrange(self) -> None:
        """Lets press what can be pressed."""
        computed, free = self.values is not None, not self.fitting.busy
        self.fit.setEnabled(computed)
        self.box.setEnabled(free)
        self.load.setEnabled(computed and free)
        self.drop.setEnabled(free and "model" in (self.values or {}))

    def chosen(self, index: int) -> None:
        if index:
            self.values = self.before
        else:
            self.before, self.values = self.values, None
        self.show_values()
        self.typed()

    def _browse(self) -> None:
        title = translate("BeltGrinding", "Measured roughness")
        path = QtGui.QFileDialog.getOpenFileName(self, title, "", "*.json")[0]
        if path:
            self.read_model(path)

    def read_model(self, path: str) -> None:
        """Takes over what ``beltgrind calibrate-finish`` wrote; says so where the file is none."""
        try:
            model = finish_model(path)
        except InputError as error:
            self.warn(error)
            return
        self.take_model(model)

    def take_model(self, model: Json | None) -> None:
        """Takes over a model, a job's ``finish.model``, in place of the one that was; None: takes it out."""
        values = {key: value for key, value in known(self.values).items() if key != "model"}
        if model is not None:
            values["model"] = model
            low, high = model["ranges"]["grit"]
            if low == high:  # of several nobody knows which one the belt has
                values.setdefault("grit", low)
        self.values = values
        self.show_values()
        self.typed()

    def read(self) -> dict[str, Any] | None:
        found = super().read()
        if found is not None and "model" in found:
            try:
                check_grit(found)
            except InputError as error:
                self.fields["grit"].setStyleSheet(WRONG)
                self.warn(error)
                raise
        return found

    def put(self, values: dict[str, Any], key: Any, value: Any) -> None:
        if value is None:
            values.pop(key, None)
        else:
            values[key] = value

    def reason(self, key: Any, value: float | None) -> str:
        if value is None:
            values = known(self.values)
            if key == "grit" and "model" in values:
                low, high = values["model"]["ranges"]["grit"]
                needed = translate("BeltGrinding", "give the belt's grit; {} to {} were measured")
                return needed.format(shown(low), shown(high))
            return ""
        if key == "rest_per_pass":
            if not 0.0 <= value < 1.0:
                return translate("BeltGrinding", "must be 0 or more, and less than 1")
        elif not value > 0.0:
            return translate("BeltGrinding", "must be greater than 0")
        if key == "crossing_angle_deg" and value > 90.0:
            return translate("BeltGrinding", "must lie from 0 to {}").format(90)
        return ""

    def mistake(self, text: str, reason: str) -> InputError:
        return InputError(
            "gui.finish_value", "Finish: '{text}': {reason}", text=text, reason=reason
        )

    def lines(self) -> list[str]:
        """What the measurements hold for, and what is not known."""
        values = known(self.values)
        model = values.get("model")
        if model is None:
            text = translate(
                "BeltGrinding",
                "Without measurements there is the direction of the scratches, and no roughness: Fit... takes a table "
                "of your own.",
            )
            return [text]
        lines = [
            translate("BeltGrinding", "Measured: {}").format(spans(model["ranges"])),
            translate("BeltGrinding", "Exponents of Ra: {}").format(exponents(model)),
        ]
        if model["source"]:
            lines.append(model["source"])
        if values.get("rest_per_pass", model.get("rest_per_pass")) is None:
            lines.append(
                translate(
                    "BeltGrinding",
                    "What a pass leaves of the roughness before is not known: each counts as measured.",
                )
            )
        return lines

    def summary(self) -> str:
        """One line of it."""
        if self.values is None:
            return self.box.currentText()
        if "model" in self.values:
            return translate("BeltGrinding", "roughness and lay")
        return translate("BeltGrinding", "lay alone")

    def check(self) -> None:
        self.fitting.check()
        super().check()
