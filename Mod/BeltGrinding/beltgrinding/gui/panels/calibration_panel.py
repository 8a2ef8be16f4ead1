"""Task panel: the law of removal fitted to a table of measured grinds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import FreeCADGui as Gui

from ...base.files import cannot_be_written, write_whole
from ...base.kinds import known
from ...calibration import calibrate as calibration, example, plot as calibration_plot
from ...engine import Cancelled, InputError
from ...objects import job_data, job_inputs, properties
from ...objects.kinds import DocumentObject
from ..common.compat import QtCore, QtGui, buttons, translate
from ..common.figures import figure
from ..common.help_pages import helped
from ..common.icons import qicon
from ..common.kinds import Buttons, Context, Json, Layout, Table, Widget
from ..common.messages import error_text
from ..common.runner import Background
from ..common.save_dialog import file_to_write
from ..common.transaction import abort, commit
from ..widgets.form import MINIMUM_WIDTH

WIDTH = 210  # pixels of the plot in the panel, which must fit the combo view as it comes
LONG = 12  # characters of an interval's two ends that fit beside each other
COLUMNS = (  # of the table, as the panel names them
    "force_N",
    "belt_speed_m_s",
    "rpm",
    "time_s",
    "feed_mm_s",
    "length_mm",
    "area_mm2",
    "removed_volume_mm3",
    "depth_mm",
    "work_J",
)
TABLES = "Measured grinds (*.csv *.txt);;All files (*)"


class CalibrationPanel:
    """Fits, shows the result, and on demand writes it into the job in one undo step."""

    def __init__(self, job: DocumentObject) -> None:
        self.job = job
        self.task: Background | None = None
        self.result: Json | None = None  # of ``calibrate.fit``
        self.fitted: tuple[Any, ...] = ()  # what it was fitted to
        self.picture = QtGui.QPixmap()
        self.form = QtGui.QWidget()
        self.form.destroyed.connect(lambda *_: self._gone())  # whatever closes it
        self.form.setWindowTitle(translate("BeltGrinding", "Calibrate removal law"))
        self.form.setWindowIcon(qicon("BeltGrinding_Calibrate"))
        helped(self.form, "BeltGrinding_Calibrate")
        body = QtGui.QVBoxLayout(self.form)
        fields = QtGui.QFormLayout()
        fields.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        self.file = Gui.UiLoader().createWidget("Gui::FileChooser")
        self.file.setObjectName("grinds")
        self.file.setProperty("filter", TABLES)
        self.file.setToolTip(
            translate("BeltGrinding", "CSV with columns such as force_N, time_s, area_mm2")
        )
        fields.addRow(translate("BeltGrinding", "Measured grinds"), self.file)
        body.addLayout(fields)
        columns = QtGui.QLabel(
            translate(
                "BeltGrinding",
                "A CSV, a line a grind. Columns: {}; {} or {}; {} or {}, {}; {}; {} or {}; and, if the belt "
                "wears, {}.",
            ).format(*(f"<b>{name}</b>" for name in COLUMNS))
        )
        columns.setObjectName("columns")
        columns.setWordWrap(True)
        body.addWidget(columns)
        text = translate("BeltGrinding", "Save an example...")
        self._button(body, text, self.save_example).setObjectName("saveExample")
        fields = QtGui.QFormLayout()
        fields.setRowWrapPolicy(QtGui.QFormLayout.WrapAllRows)
        self.diameter = self._number(
            fields,
            "driveWheelDiameter",
            translate("BeltGrinding", "Drive wheel's diameter, mm"),
            translate("BeltGrinding", "needed only where the table gives rotations a minute"),
        )
        self.wear_unit = self._number(
            fields,
            "wearUnit",
            translate("BeltGrinding", "Work of one unit of wear, J"),
            translate("BeltGrinding", "needed only where the table gives a wear number"),
        )
        body.addLayout(fields)
        self.own_wheel = QtGui.QCheckBox(translate("BeltGrinding", "Ground on the job's wheel"))
        self.own_wheel.setObjectName("ownWheel")
        self.own_wheel.setToolTip(
            translate(
                "BeltGrinding",
                "The contacts are solved with the job's wheel, and the law is fitted to their pressures; "
                "columns of the wheel in the table come first",
            )
        )
        body.addWidget(self.own_wheel)
        row = QtGui.QHBoxLayout()
        self.start = self._button(row, translate("BeltGrinding", "Fit"), self.fit)
        self.use = self._button(row, translate("BeltGrinding", "Use in the job"), self.apply)
        body.addLayout(row)
        self.state = QtGui.QLabel()
        self.state.setObjectName("calibrationState")
        self.state.setWordWrap(True)
        body.addWidget(self.state)
        self.table = self._table()
        body.addWidget(self.table)
        self.plot = QtGui.QLabel()
        self.plot.setObjectName("calibrationPlot")
        self.plot.setAlignment(QtCore.Qt.AlignCenter)
        body.addWidget(self.plot)
        self.larger = self._button(body, translate("BeltGrinding", "Larger plot"), self.enlarge)
        self.warnings = QtGui.QLabel()
        self.warnings.setObjectName("calibrationWarnings")
        self.warnings.setWordWrap(True)
        body.addWidget(self.warnings)
        body.addStretch()
        self._show_parts(False)
        for signal in ("fileNameChanged(const QString &)", "fileNameSelected(const QString &)"):
            self.file.connect(self.file, QtCore.SIGNAL(signal), lambda _: self._look())
        for entry in (self.diameter, self.wear_unit):
            entry.textChanged.connect(lambda _: self._look())
        self.own_wheel.toggled.connect(lambda _: self._look())

    def _number(self, fields: Layout, name: str, text: str, tip: str) -> Widget:
        """An entry that may stay empty."""
        widget = QtGui.QLineEdit()
        widget.setObjectName(name)
        widget.setMinimumWidth(MINIMUM_WIDTH)
        widget.setToolTip(tip)
        widget.setPlaceholderText(translate("BeltGrinding", "(not known)"))
        validator = QtGui.QDoubleValidator(0.0, 1e12, 12, widget)
        validator.setLocale(QtCore.QLocale.c())
        widget.setValidator(validator)
        fields.addRow(text, widget)
        return widget

    def _button(self, body: Layout, text: str, action: Callable[[], object]) -> Widget:
        button = QtGui.QPushButton(text)
        button.clicked.connect(lambda *_: action())
        body.addWidget(button)
        return button

    def _table(self) -> Table:
        table = QtGui.QTableWidget(0, 2)
        table.setObjectName("calibrationTable")
        table.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Parameter"),
                translate("BeltGrinding", "Value (95 %)"),
            ]
        )
        table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        table.verticalHeader().hide()
        table.setMinimumWidth(WIDTH)
        table.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        table.setVerticalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        table.horizontalHeader().setStretchLastSection(True)
        return table

    def _show_parts(self, on: bool) -> None:
        for widget in (self.table, self.plot, self.larger, self.warnings, self.use):
            widget.setVisible(on)

    def save_example(self) -> None:
        """Writes a table of made-up grinds where the user says, and takes it."""
        title = translate("BeltGrinding", "Save an example")
        path = file_to_write(title, "grinds.csv", TABLES)
        if not path:
            return
        try:
            write_whole(Path(path), example.table().encode())
        except OSError as error:
            self.state.setText(error_text(cannot_be_written(path, error)))
            return
        self.file.setProperty("fileName", path)

    def _inputs(self) -> tuple[Any, ...]:
        """What a fit is of: the table as it is now, and the entries."""
        path = str(self.file.property("fileName") or "")
        try:
            found = Path(path).stat()
            version = found.st_mtime_ns, found.st_size
        except OSError:
            version = None
        entries = self.diameter.text(), self.wear_unit.text(), self.own_wheel.isChecked()
        return path, version, *entries

    def _look(self) -> bool:
        """Takes what was fitted away where it is of another table, or of other entries; whether it is there."""
        if self.fitted and self.fitted != self._inputs():
            if self.task is not None:
                self.task.abandon()
                self.task = None
                self.start.setEnabled(True)
            self.fitted, self.result = (), None
            self._show_parts(False)
            text = translate("BeltGrinding", "The table or an entry has changed: fit again.")
            self.state.setText(text)
        return bool(self.fitted)

    def fit(self) -> None:
        """Reads the table and fits, in a thread of its own."""
        path = str(self.file.property("fileName") or "")
        if not path:
            self.state.setText(translate("BeltGrinding", "Choose the table of measured grinds."))
            return
        diameter = self._entered(self.diameter)
        unit = self._entered(self.wear_unit) or 1.0
        machine = None
        if self.own_wheel.isChecked():
            try:
                machine = job_inputs.belt_machine(self.job)
            except InputError as error:
                self.state.setText(error_text(error))
                return
        self._show_parts(False)
        self.start.setEnabled(False)
        self.fitted = self._inputs()
        self.state.setText(translate("BeltGrinding", "Fitting ..."))

        def work(_: Context) -> tuple[Any, ...]:
            result = calibration.fit(path, diameter, unit, machine)
            report = result["report"]
            return result, calibration_plot.render(report), calibration_plot.render_small(report)

        self.task = Background(work, self.show, self.form)

    def _entered(self, field: Widget) -> float | None:
        return float(field.text()) if field.text() and field.hasAcceptableInput() else None

    def show(self, outcome: Any, error: BaseException | None) -> None:
        """Shows what the fit has found."""
        self.task = None
        self.start.setEnabled(True)
        if isinstance(error, Cancelled):
            return
        if error is not None:
            self.fitted = ()
            self.state.setText(error_text(error))
            if not isinstance(error, InputError):
                raise error
            return
        result, plot, small = outcome
        self.result, report = result, result["report"]
        self.state.setText(
            translate(
                "BeltGrinding",
                "{} grinds. Left out one by one, they are predicted with a median error of "
                "{:.1f} %, nine of ten within {:.0f} %.",
            ).format(
                report["grinds"],
                100.0 * report["leave_one_out"]["median"],
                100.0 * report["leave_one_out"]["p90"],
            )
        )
        self._fill(report["parameters"])
        self.picture.loadFromData(plot)
        preview = QtGui.QPixmap()
        preview.loadFromData(small)
        self.plot.setPixmap(preview.scaledToWidth(WIDTH, QtCore.Qt.SmoothTransformation))
        self.warnings.setText(
            "\n".join(f"\u2022 {error_text(text)}" for text in report["warnings"])
        )
        self._show_parts(True)
        self.warnings.setVisible(bool(report["warnings"]))

    def _fill(self, parameters: Sequence[Json]) -> None:
        self.table.setRowCount(len(parameters))
        for row, one in enumerate(parameters):
            name = one["name"].replace("_", "\n", 1).replace("_", " ")
            interval = translate("BeltGrinding", "fixed")
            if one["free"]:
                low, high = (figure(one[side], ".3g") for side in ("low", "high"))
                between = "\n... " if len(low + high) > LONG else " ... "
                interval = low + between + high
            texts = (
                f"{name}\n{one['unit'].replace('mm2', 'mm²')}".strip(),
                f"{figure(one['value'], '.4g')}\n({interval})",
            )
            for column, text in enumerate(texts):
                self.table.setItem(row, column, QtGui.QTableWidgetItem(text))
        self.table.resizeColumnsToContents()
        self.table.resizeRowsToContents()
        rows = sum(self.table.rowHeight(row) for row in range(len(parameters)))
        self.table.setFixedHeight(rows + self.table.horizontalHeader().sizeHint().height() + 4)

    def enlarge(self) -> None:
        """The plot in a window of its own."""
        window = QtGui.QDialog(self.form)
        window.setObjectName("calibrationWindow")
        window.setWindowTitle(self.form.windowTitle())
        body = QtGui.QVBoxLayout(window)
        area = QtGui.QScrollArea()
        label = QtGui.QLabel()
        label.setPixmap(self.picture)
        area.setWidget(label)
        body.addWidget(area)
        window.resize(self.picture.width() + 60, min(self.picture.height() + 60, 900))
        window.show()

    def apply(self) -> None:
        """Writes the law's parameters into the job's properties, in one undo step."""
        if not self._look():
            return  # the file has been written anew
        document = self.job.Document
        document.openTransaction(translate("BeltGrinding", "Calibrate removal law"))
        try:
            properties.from_job(self.job, job_data.KEYS, {"law": known(self.result)["law"]})
            document.recompute()
            commit(document)
        except Exception:
            abort(document)
            raise
        self.state.setText(
            translate("BeltGrinding", "{} uses the calibrated law.").format(self.job.Label)
        )

    def getStandardButtons(self) -> Buttons:
        return buttons("Close")

    def _gone(self) -> None:
        if self.task is not None:
            self.task.abandon()

    def reject(self) -> bool:
        Gui.Control.closeDialog()
        return True
