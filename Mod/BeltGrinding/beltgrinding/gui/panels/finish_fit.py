"""A model of the finish fitted to a table of measured roughnesses: read and fitted in a thread, shown, saved, taken."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ...calibration import calibrate as calibration, finish, finish_table
from ...engine import Cancelled, InputError
from ...objects import job_inputs
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Json, Table, Widget
from ..common.messages import error_text
from ..common.runner import TOLD, Background
from ..common.save_dialog import file_to_write
from ..common.theme import warning_style
from .finish_words import parameter, spans

TABLES = "*.csv *.txt"
WIDTH = 520  # pixels of the window, which must fit a small screen


class FinishFit:
    """What the button *Fit...* of a ``FinishForm`` does; while it fits, the button ends that."""

    def __init__(self, form: Widget) -> None:
        self.form = form
        self.task: Background | None = None
        self.window: FitWindow | None = None
        self.clock = QtCore.QTimer(form)
        self.clock.setInterval(int(1000 * TOLD))
        self.clock.timeout.connect(lambda: self._tell_progress())

    @property
    def busy(self) -> bool:
        """Whether it fits."""
        return self.task is not None

    def press(self) -> None:
        """Begins with a table that the user chooses, or ends the fit that goes on."""
        if self.task is not None:
            self.task.cancel()
            return
        title = translate("BeltGrinding", "Measured roughness")
        kinds = translate("BeltGrinding", "Tables ({});;All files (*)").format(TABLES)
        path = QtGui.QFileDialog.getOpenFileName(self.form, title, "", kinds)[0]
        if path:
            self.begin(path)

    def begin(self, path: str) -> None:
        """Fits to the table in a thread of its own; what it tells comes in a window, what it refuses in the form."""
        try:
            wear = finish_table.wear_by(job_inputs.wear(self.form.job))
        except InputError:  # tables that need no law of wear do without
            wear = None
        work = lambda context: finish.fit_finish(path, wear, Path(path).name, context)
        self.task = Background(work, lambda *found: self._done(path, *found), self.form)
        self.form.fit.setText(translate("BeltGrinding", "Stop"))
        self.form.arrange()
        self._tell_progress()
        self.clock.start()

    def _tell_progress(self) -> None:
        if self.task is not None:
            share = 100.0 * self.task.context.progress
            text = translate("BeltGrinding", "Fitting, {:.0f} %").format(share)
            self.form.told.setStyleSheet("")
            self.form.told.setText(text)

    def _done(self, path: str, result: Any, error: BaseException | None) -> None:
        self.task = None
        self.clock.stop()
        self.form.fit.setText(translate("BeltGrinding", "Fit..."))
        self.form.arrange()
        self.form.typed()  # what is to be known of the job's values again
        if isinstance(error, Cancelled):
            return
        if error is not None:
            self.form.warn(error)
            if not isinstance(error, InputError):
                raise error
            return
        self.window = FitWindow(self.form, path, result)
        self.window.open()

    def check(self) -> None:
        """Raises InputError while it fits."""
        if self.busy:
            raise InputError(
                "gui.finish_fitting",
                "Finish: the measurements are still being fitted; wait for that, or stop it.",
            )


class FitWindow(QtGui.QDialog):
    """What a fit has found, with its intervals and what it warns of; saves the model where the user says, and has the
    form take it."""

    def __init__(self, form: Widget, path: str, result: Json) -> None:
        super().__init__(form)
        self.form, self.path, self.result = form, path, result
        report = result["report"]
        self.setObjectName("finishFit")
        self.setWindowTitle(translate("BeltGrinding", "Fitted roughness"))
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        body = QtGui.QVBoxLayout(self)
        body.addWidget(self._label("finishFitted", _quality(report)))
        body.addWidget(self._table(report))
        held = translate("BeltGrinding", "Measured: {}").format(spans(report["ranges"]))
        body.addWidget(self._label("finishRanges", held))
        self.warnings = self._label(
            "finishWarnings", "\n".join(f"⚠ {error_text(one)}" for one in report["warnings"])
        )
        self.warnings.setStyleSheet(warning_style())
        self.warnings.setVisible(bool(report["warnings"]))
        body.addWidget(self.warnings)
        fields = QtGui.QFormLayout()
        self.source = QtGui.QLineEdit(result["model"]["source"])
        self.source.setObjectName("finishSource")
        self.source.setToolTip(translate("BeltGrinding", "and by whom; the model keeps it"))
        fields.addRow(translate("BeltGrinding", "What was measured"), self.source)
        body.addLayout(fields)
        self.note = self._label("finishFitNote", "")
        self.note.setStyleSheet(warning_style())
        self.note.hide()
        body.addWidget(self.note)
        buttons = QtGui.QDialogButtonBox()
        save = buttons.addButton(
            translate("BeltGrinding", "Save and use..."), QtGui.QDialogButtonBox.ActionRole
        )
        save.clicked.connect(lambda *_: self.save())
        away = buttons.addButton(
            translate("BeltGrinding", "Discard"), QtGui.QDialogButtonBox.RejectRole
        )
        away.clicked.connect(lambda *_: self.reject())
        body.addWidget(buttons)
        self.resize(WIDTH, self.heightForWidth(WIDTH))

    def _label(self, name: str, text: str) -> Widget:
        label = QtGui.QLabel(text)
        label.setObjectName(name)
        label.setWordWrap(True)
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        return label

    def _table(self, report: Json) -> Table:
        rows = [*report["parameters"]]
        if report["rest_per_pass"] is not None:
            rows.append({**report["rest_per_pass"], "name": "rest_per_pass", "free": True})
        table = QtGui.QTableWidget(len(rows), 3)
        table.setObjectName("finishParameters")
        table.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Parameter"),
                translate("BeltGrinding", "Value"),
                translate("BeltGrinding", "95 % interval"),
            ]
        )
        table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        table.verticalHeader().hide()
        table.setVerticalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        for row, one in enumerate(rows):
            value, interval = "", translate("BeltGrinding", "not varied")
            if one["free"]:
                value, interval = (
                    figure(one["value"], ".3g"),
                    f"{figure(one['low'], '.3g')} … {figure(one['high'], '.3g')}",
                )
            for column, text in enumerate((parameter(one["name"]), value, interval)):
                table.setItem(row, column, QtGui.QTableWidgetItem(text))
        table.resizeColumnsToContents()
        table.resizeRowsToContents()
        table.horizontalHeader().setStretchLastSection(True)
        height = sum(table.rowHeight(row) for row in range(len(rows)))
        table.setFixedHeight(height + table.horizontalHeader().sizeHint().height() + 4)
        return table

    def save(self) -> None:
        """Writes the model into a file that the user names, and has the form read that."""
        own = Path(self.path)
        path = file_to_write(
            self.windowTitle(), str(own.with_name(f"{own.stem}-model.json")), "*.json"
        )
        if not path:
            return
        model = {**self.result["model"], "source": self.source.text().strip()}
        try:
            if os.path.realpath(path) == os.path.realpath(self.path):
                raise InputError(
                    "gui.finish_over_table",
                    "{file}: is the table of the measurements; give the model another file",
                    file=path,
                )
            calibration.write(model, path)
        except InputError as error:
            self.note.setText(error_text(error))
            self.note.show()
            return
        self.accept()
        self.form.read_model(path)


def _quality(report: Json) -> str:
    """How well measurements are told by the others, beside plainer ways."""
    percent = lambda errors: (100.0 * errors["median"], 100.0 * errors["p90"])
    lines = [
        translate(
            "BeltGrinding",
            "{} measurements. Left out one by one, they are predicted with a median error of {:.1f} %, nine of ten "
            "within {:.0f} %.",
        ).format(report["measurements"], *percent(report["left_out"])),
        translate(
            "BeltGrinding", "By one Ra for all it would be {:.1f} %, nine of ten within {:.0f} %."
        ).format(*percent(report["plain"]["constant"])),
    ]
    if "grit_only" in report["plain"]:
        text = translate(
            "BeltGrinding", "By the grit alone it would be {:.1f} %, nine of ten within {:.0f} %."
        )
        lines.append(text.format(*percent(report["plain"]["grit_only"])))
    return "\n".join(lines)
