"""What the finish (roughness, lay) is computed with; a part of the job's panel."""

import json
import math

from ...base import schemas
from ...engine import InputError
from ...objects.job_data import KEYS, finish_model
from ...objects.properties import get_value, rule
from ...simulation.finish import check_grit
from ..common.compat import QtGui, translate
from ..common.messages import error_text
from ..common.theme import warning_style
from ..widgets.form import WRONG
from ..widgets.rows import number, shown
from ..widgets.steady import steady

FINISH = next(key for key in KEYS if key.name == "Finish")
RANGES = ("grit", "pressure_MPa", "belt_speed_m_s", "feed_mm_s", "remaining_cut")
ANGLE = 20.0  # degrees, the schema's


class FinishForm(QtGui.QGroupBox):
    """Edits the property Finish of a job, which is a job file's ``finish`` as a text; empty: none."""

    def __init__(self, job):
        super().__init__(translate("BeltGrinding", "Finish"))
        self.job, self.changed = job, lambda: None
        self.before = {"crossing_angle_deg": ANGLE}  # what computing it again takes up
        self.rows = QtGui.QFormLayout(self)
        self.rows.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.box = steady(QtGui.QComboBox())
        self.box.setObjectName("finishChoice")
        self.box.addItems(
            [translate("BeltGrinding", "not computed"), translate("BeltGrinding", "computed")]
        )
        self.rows.addRow(translate("BeltGrinding", "Roughness and lay"), self.box)
        unknown = translate("BeltGrinding", "empty: not known")
        self.fields = {}
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
            line = QtGui.QLineEdit()
            line.setObjectName(key)
            line.setMinimumWidth(40)
            line.setToolTip(tip)
            line.textEdited.connect(lambda _: self._typed())
            self.fields[key] = line
            self.rows.addRow(text, line)
        self.rows.addRow(translate("BeltGrinding", "Measurements"), self._model_row())
        self.told = QtGui.QLabel()
        self.told.setObjectName("finishNote")
        self.told.setWordWrap(True)
        self.rows.addRow(self.told)
        error = None
        try:
            self.values = get_value(job, FINISH)
            if self.values is not None:
                self.values = schemas.checked(self.values, rule(FINISH.key)[0], FINISH.key)
        except InputError as found:  # written by hand; it stays until something is chosen here
            self.values, error = None, found
        self.show_values()
        if error is not None:
            self._warn(error)
        self.box.currentIndexChanged.connect(self._chosen)

    def _model_row(self):
        box = QtGui.QWidget()
        row = QtGui.QHBoxLayout(box)
        row.setContentsMargins(0, 0, 0, 0)
        self.load = QtGui.QPushButton(translate("BeltGrinding", "Read..."))
        self.load.setObjectName("readFinishModel")
        self.load.setToolTip(
            translate("BeltGrinding", "The file that beltgrind calibrate-finish wrote")
        )
        self.load.clicked.connect(lambda *_: self._browse())
        self.drop = QtGui.QPushButton(translate("BeltGrinding", "Remove"))
        self.drop.setObjectName("dropFinishModel")
        self.drop.clicked.connect(lambda *_: self._take_model(None))
        row.addWidget(self.load)
        row.addWidget(self.drop)
        return box

    def show_values(self):
        """Shows what the job has."""
        given = self.values
        self.box.blockSignals(True)
        self.box.setCurrentIndex(0 if given is None else 1)
        self.box.blockSignals(False)
        for key, line in self.fields.items():
            line.setEnabled(given is not None)
            line.setStyleSheet("")
            value = (given or {}).get(key)
            line.setText("" if value is None else shown(value))
        self.load.setEnabled(given is not None)
        self.drop.setEnabled("model" in (given or {}))
        self._tell()

    def _chosen(self, index):
        if index:
            self.values = self.before
        else:
            self.before, self.values = self.values, None
        self.show_values()
        self._typed()

    def _browse(self):
        title = translate("BeltGrinding", "Measured roughness")
        path = QtGui.QFileDialog.getOpenFileName(self, title, "", "*.json")[0]
        if path:
            self.read_model(path)

    def read_model(self, path):
        """Takes over what ``beltgrind calibrate-finish`` wrote; says so where the file is none."""
        try:
            model = finish_model(path)
        except InputError as error:
            self._warn(error)
            return
        self._take_model(model)

    def _take_model(self, model):
        values = {key: value for key, value in self.values.items() if key != "model"}
        if model is not None:
            values["model"] = model
            low, high = model["ranges"]["grit"]
            if low == high:  # of several nobody knows which one the belt has
                values.setdefault("grit", low)
        self.values = values
        self.show_values()
        self._typed()

    def _typed(self):
        try:
            self.values = self.read()
        except InputError:
            return  # told below the fields, and again by OK
        self._tell()
        self._set()

    def read(self):
        """A job's ``finish`` of what stands in the fields, None where none is computed. Raises InputError."""
        if self.values is None:
            return None
        found, error = dict(self.values), None
        for key, line in self.fields.items():
            line.setStyleSheet("")
            text = line.text().strip()
            reason = self._reason(key, text)
            if reason:
                line.setStyleSheet(WRONG)
                error = error or InputError(
                    "gui.finish_value", "Finish: '{text}': {reason}", text=text, reason=reason
                )
            elif text:
                found[key] = number(text)
            else:
                found.pop(key, None)
        try:
            if error is not None:
                raise error
            if "model" in found:
                check_grit(found)
        except InputError as one:
            if error is None:
                self.fields["grit"].setStyleSheet(WRONG)
            self._warn(one)
            raise
        return found

    def _reason(self, key, text):
        if not text:
            if key == "grit" and "model" in self.values:
                low, high = self.values["model"]["ranges"]["grit"]
                needed = translate("BeltGrinding", "give the belt's grit; {} to {} were measured")
                return needed.format(shown(low), shown(high))
            return ""
        try:
            value = number(text)
        except ValueError:
            return translate("BeltGrinding", "This is no number: {}").format(text)
        if not math.isfinite(value):
            return translate("BeltGrinding", "This is no number: {}").format(text)
        if key == "rest_per_pass":
            if not 0.0 <= value < 1.0:
                return translate("BeltGrinding", "must be 0 or more, and less than 1")
        elif not value > 0.0:
            return translate("BeltGrinding", "must be greater than 0")
        if key == "crossing_angle_deg" and value > 90.0:
            return translate("BeltGrinding", "must lie from 0 to {}").format(90)
        return ""

    def _warn(self, error):
        self.told.setStyleSheet(warning_style())
        self.told.setText(error_text(error))

    def _tell(self):
        """What the measurements hold for, and what is not known."""
        self.told.setStyleSheet("")
        given = self.values
        if given is None:
            self.told.setText("")
            return
        model = given.get("model")
        if model is None:
            text = translate(
                "BeltGrinding",
                "Without measurements there is the direction of the scratches, and no roughness: fit them by "
                "beltgrind calibrate-finish.",
            )
            self.told.setText(text)
            return
        names = {
            "grit": translate("BeltGrinding", "grit"),
            "pressure_MPa": "MPa",
            "belt_speed_m_s": "m/s",
            "feed_mm_s": "mm/s",
            "remaining_cut": translate("BeltGrinding", "of a fresh belt's cut"),
        }
        spans = (f"{_span(*model['ranges'][key])} {names[key]}" for key in RANGES)
        lines = [translate("BeltGrinding", "Measured: {}").format("; ".join(spans))]
        exponents = (
            f"{model[key]:+.2g} {text}"
            for key, text in (
                ("grit_exponent", translate("BeltGrinding", "grit")),
                ("pressure_exponent", translate("BeltGrinding", "pressure")),
                ("belt_speed_exponent", translate("BeltGrinding", "belt speed")),
                ("feed_exponent", translate("BeltGrinding", "feed")),
                ("wear_exponent", translate("BeltGrinding", "remaining cut")),
            )
        )
        lines.append(translate("BeltGrinding", "Exponents of Ra: {}").format("; ".join(exponents)))
        if model["source"]:
            lines.append(model["source"])
        if given.get("rest_per_pass", model.get("rest_per_pass")) is None:
            lines.append(
                translate(
                    "BeltGrinding",
                    "What a pass leaves of the roughness before is not known: each counts as measured.",
                )
            )
        self.told.setText("\n".join(lines))

    def _set(self):
        text = "" if self.values is None else json.dumps(self.values)
        if self.job.Finish != text:
            self.job.Finish = text
            self.changed()

    def summary(self):
        """One line of it."""
        if self.values is None:
            return self.box.currentText()
        if "model" in self.values:
            return translate("BeltGrinding", "roughness and lay")
        return translate("BeltGrinding", "lay alone")

    def check(self):
        """Raises InputError for the first field with a mistake."""
        self.read()


def _span(low, high):
    """What was measured, from least to greatest."""
    return f"{low:g} … {high:g}" if low < high else f"{low:g}"
