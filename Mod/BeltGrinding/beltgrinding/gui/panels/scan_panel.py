"""Task panel of a scan: which file, where it starts, on which faces it is laid, and what comes out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ...calibration import learning
from ...engine import Cancelled, InputError
from ...objects import deviation, ground_mesh, part_scan, scan_source, shown, simulation
from ...objects.job_data import child, children
from ...objects.job_inputs import scratch_folder
from ...objects.kinds import DocumentObject
from ...scan import comparison as scan, start as scan_start
from ..common.compat import QtGui, translate
from ..common.figures import figure, length_text
from ..common.kinds import Context, Json, Layout, Widget
from ..common.messages import error_text
from ..common.runner import Background
from ..common.task_progress import TaskRow
from .panel import Panel
from ..widgets.figure_table import FigureTable
from ..widgets.steady import steady

UNITS = (("mm", 1.0), ("m", 1000.0), ("cm", 10.0), ("in", 25.4), ("ft", 304.8), ("µm", 0.001))
AS_IT_LIES, PRINCIPAL, MATRIX, PAIRS, ALIGNED = range(5)
TABLE_HEIGHT = 230  # pixels: all rows


class ScanPanel(Panel):
    """Compares on a button, in a thread; OK keeps what was compared last, Cancel takes it back."""

    def __init__(self, job: DocumentObject) -> None:
        title = translate("BeltGrinding", "Compare a scan")
        super().__init__(child(job, simulation.Simulation), title, "BeltGrinding_Scan")
        self.job = job
        self.work: Background | None = None
        rows = QtGui.QFormLayout()
        rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.offered = scan_source.offered(job)
        labels = [obj.Label for obj in self.offered]
        file = translate("BeltGrinding", "a file")
        self.source = self._choice(rows, translate("BeltGrinding", "Scan"), [file, *labels])
        self.source.setObjectName("scanSource")
        self.source.setToolTip(
            translate("BeltGrinding", "a file, or a mesh, points or a shape of the document")
        )
        self.file = self._file(rows, translate("BeltGrinding", "File"), "scan")
        self.unit = self._choice(rows, translate("BeltGrinding", "Unit"), [u for u, _ in UNITS])
        self.unit.setObjectName("unit")
        starts = [
            translate("BeltGrinding", "as it lies"),
            translate("BeltGrinding", "principal axes"),
            translate("BeltGrinding", "matrix from a file"),
            translate("BeltGrinding", "pairs of points from a file"),
            translate("BeltGrinding", "aligned already"),
        ]
        self.start = self._choice(rows, translate("BeltGrinding", "Start"), starts)
        self.start.setObjectName("start")
        self.start_file = self._file(rows, translate("BeltGrinding", "Start file"), "start_file")
        self.start.currentIndexChanged.connect(self._enable)
        self.source.currentIndexChanged.connect(self._enable)
        self.datum = QtGui.QLineEdit()
        self.datum.setObjectName("datum")
        self.datum.setPlaceholderText(translate("BeltGrinding", "all not ground"))
        self.datum.setToolTip(
            translate("BeltGrinding", "numbers of the faces that the scan is laid on, as 1,2,5")
        )
        rows.addRow(translate("BeltGrinding", "Datum faces"), self.datum)
        self._add_alignment(rows)
        self.body.addLayout(rows)
        self.button = QtGui.QPushButton(translate("BeltGrinding", "Compare"))
        self.button.setObjectName("compare")
        self.button.clicked.connect(self.compare)
        self.body.addWidget(self.button)
        self.correct = QtGui.QPushButton(translate("BeltGrinding", "Correct the law"))
        self.correct.setObjectName("correctLaw")
        self.correct.setToolTip(
            translate(
                "BeltGrinding",
                "law and wear of the belt, as far as they are unsure, by what the scan shows: for the next part",
            )
        )
        self.correct.clicked.connect(self.learn)
        self.body.addWidget(self.correct)
        self.progress = TaskRow()
        self.body.addWidget(self.progress)
        self.table = FigureTable("figures", TABLE_HEIGHT)
        self.body.addWidget(self.table, 1)
        self.finish()
        self._enable()
        self._may_learn()

    def _add_alignment(self, rows: Layout) -> None:
        """What of the start is kept, and how much of the scan decides."""
        held = QtGui.QWidget()
        held.setObjectName("held")
        held.setToolTip(
            translate(
                "BeltGrinding",
                "what stays as it starts: translations along the part's axes, rotations about them",
            )
        )
        grid = QtGui.QGridLayout(held)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(2)
        self.held = {}
        for i, name in enumerate(scan.FREEDOMS):
            text = f"{'Δ' if name[0] == 't' else '∠'}{name[1].upper()}"
            self.held[name] = QtGui.QCheckBox(text)
            self.held[name].setObjectName(name)
            grid.addWidget(self.held[name], i // 3, i % 3)
        rows.addRow(translate("BeltGrinding", "Keep fixed"), held)
        self.share = steady(QtGui.QDoubleSpinBox())
        self.share.setObjectName("share")
        self.share.setRange(1.0, 100.0)
        self.share.setDecimals(0)
        self.share.setSuffix(" %")
        self.share.setValue(100.0 * scan.SHARE)
        self.share.setToolTip(
            translate(
                "BeltGrinding",
                "of the pairs of points, the nearest: the rest, as a table or a clamp, does not count",
            )
        )
        rows.addRow(translate("BeltGrinding", "Pairs used"), self.share)

    def _file(self, rows: Layout, text: str, name: str) -> Widget:
        box = QtGui.QWidget()
        line, button = QtGui.QLineEdit(), QtGui.QPushButton("...")
        line.setObjectName(name)
        line.setMinimumWidth(40)
        button.setMaximumWidth(32)
        layout = QtGui.QHBoxLayout(box)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(line)
        layout.addWidget(button)
        button.clicked.connect(lambda: self._browse(line, text))
        rows.addRow(text, box)
        return line

    def _browse(self, line: Widget, title: str) -> None:
        path = QtGui.QFileDialog.getOpenFileName(self.form, title, line.text())[0]
        if path:
            line.setText(path)

    def _choice(self, rows: Layout, text: str, choices: Sequence[str]) -> Widget:
        box = steady(QtGui.QComboBox())
        # A long choice must not make the panel wider than the view that holds it.
        box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        box.setMinimumContentsLength(8)
        box.addItems(choices)
        rows.addRow(text, box)
        return box

    def _enable(self, _: object = None) -> None:
        of_file = self._chosen() is None
        for widget in (self.file.parentWidget(), self.unit):
            widget.setEnabled(of_file)
        self.start_file.parentWidget().setEnabled(self.start.currentIndex() in (MATRIX, PAIRS))
        for widget in (self.datum, self.share, *self.held.values()):
            widget.setEnabled(self.start.currentIndex() != ALIGNED)

    def _chosen(self) -> DocumentObject | None:
        """The object of the document that is the scan; None for a file."""
        at = self.source.currentIndex() - 1
        return self.offered[at] if at >= 0 else None

    def choose(self, obj: DocumentObject) -> None:
        """Takes an object of the document for the scan, if it may be one."""
        if obj in self.offered:
            self.source.setCurrentIndex(1 + self.offered.index(obj))

    def options(self) -> dict[str, Any]:
        """What ``scan.compare`` takes, from the fields. Raises InputError."""
        start, file = self.start.currentIndex(), self.start_file.text().strip()
        if start in (MATRIX, PAIRS) and not file:
            raise InputError("gui.choose_start", "Choose the file of the start.")
        unit = UNITS[self.unit.currentIndex()][1] if self._chosen() is None else 1.0
        options = {"unit_mm": unit, "aligned": start == ALIGNED}
        if start == PRINCIPAL:
            options["start"] = "principal"
        if start == MATRIX:
            options["start"] = scan_start.read_matrix(file)
        if start == PAIRS:
            options["pairs"] = scan_start.read_pairs(file)
        if self.datum.text().strip():
            options["datum_faces"] = scan_start.face_numbers(self.datum.text())
        options["fixed"] = [name for name, box in self.held.items() if box.isChecked()]
        options["share"] = self.share.value() / 100.0
        return options

    def compare(self) -> None:
        """Begins; ``_done`` follows."""
        path, chosen, folder = self.file.text().strip(), self._chosen(), scratch_folder()
        try:
            if chosen is None and not Path(path).is_file():
                raise InputError("gui.choose_scan", "Choose the scan's file.")
            options = self.options()
            result = part_scan.prepare(self.obj, self.job)
            if chosen is not None:
                path = str(scan_source.write(chosen, folder.name))
        except InputError as error:
            self.tell(error_text(error), True)
            return
        name = path if chosen is None else chosen.Label
        work = SimpleNamespace(result=result, folder=folder)  # which goes with the work

        def run(context: Context) -> tuple[Any, Any]:
            figures = scan.compare(work.result, path, context=context, **options)
            return work.result, {**figures, "file": name}

        self._busy(Background(run, self._done), translate("BeltGrinding", "Aligning and measuring"))

    def _done(self, found: Any, error: BaseException | None) -> None:
        self._free()
        if isinstance(error, Cancelled):
            return
        if error is not None:
            self.tell(error_text(error), True)
            return
        result, figures = found
        part_scan.store(self.obj, result, figures)
        compared = child(self.job, deviation.Deviation)
        if compared is not None:
            compared.ColourBy = shown.DIFFERENCE
            for mesh in children(self.job, ground_mesh.GroundMesh):
                mesh.ViewObject.Visibility = False  # its surface is the same
            compared.ViewObject.Visibility = True
        self.obj.touch()
        self.document.recompute()
        self.show(figures)
        told = " ".join(error_text(warning) for warning in figures["warnings"])
        self.tell(told, bool(told))
        self._may_learn()

    def learn(self) -> None:
        """Begins; ``_learned`` follows."""
        try:
            data, measured = part_scan.to_learn(self.obj, self.job)
        except InputError as error:
            self.tell(error_text(error), True)
            return
        work = lambda context: learning.learn(data, measured, context=context)
        self._busy(
            Background(work, self._learned), translate("BeltGrinding", "Learning from the scan")
        )

    def _learned(self, found: Any, error: BaseException | None) -> None:
        self._free()
        if isinstance(error, Cancelled):
            return
        if error is not None:
            self.tell(error_text(error), True)
            return
        part_scan.take(self.job, found)
        self.document.recompute()
        self._may_learn()
        lines = [
            translate("BeltGrinding", "Measured removal is {:.3f} of the predicted.").format(
                found.factor
            )
        ]
        for one in found.report:
            name = {
                learning.COEFFICIENT: translate("BeltGrinding", "Coefficient"),
                learning.WEAR: translate("BeltGrinding", "Wear scale"),
            }.get(one["parameter"], one["parameter"].replace("_", " "))
            values = (one["before"], one["after"], *one["interval"])
            lines.append(
                f"{name}: {figure(values[0], '.3g')} → {figure(values[1], '.3g')} ({figure(values[2], '.3g')}…{figure(values[3], '.3g')})"
            )
        lines.append(
            translate("BeltGrinding", "The job has this law now; simulate or plan the next part.")
        )
        self.tell("\n".join(lines))

    def _may_learn(self) -> None:
        there = bool(getattr(self.obj, "ScanFigures", "")) and not self.obj.OutOfDate
        self.correct.setEnabled(there)

    def _busy(self, work: Background, text: str) -> None:
        self.work = work
        for button in (self.button, self.correct):
            button.setEnabled(False)
        self.tell("")
        self.progress.follow(work, text)

    def _free(self) -> None:
        self.work = None
        self.progress.end()
        self.button.setEnabled(True)
        self._may_learn()

    def show(self, figures: Json) -> None:
        """The figures of a comparison."""

        def mm(value: float, sign: str = "+") -> str:
            return length_text(value, 1, sign)

        alignment, difference = figures["alignment"], figures["difference_mm"]
        rows = [
            (
                translate("BeltGrinding", "Area measured"),
                f"{figure(100 * figures['measured_area_share'], '.1f')} %",
            ),
            (translate("BeltGrinding", "Measured, mean"), mm(figures["measured_mm"]["mean"])),
            (translate("BeltGrinding", "Difference, mean"), mm(difference["mean"])),
            (translate("BeltGrinding", "Difference, rms"), mm(difference["rms"], "")),
            (translate("BeltGrinding", "5 % lie below"), mm(difference["p05"])),
            (translate("BeltGrinding", "95 % lie below"), mm(difference["p95"])),
            (
                translate("BeltGrinding", "Same verdict"),
                f"{figure(100 * figures['same_verdict_area_share'], '.1f')} %",
            ),
        ]
        if alignment:
            rows += [
                (translate("BeltGrinding", "Alignment, rms"), mm(alignment["rms_mm"], "")),
                (
                    translate("BeltGrinding", "Points used"),
                    f"{figure(100 * alignment['used_share'], '.1f')} %",
                ),
            ]
        self.table.show_rows(rows)

    def check(self) -> None:
        if self.work is not None:
            raise InputError("gui.comparison_runs", "The comparison is still running.")

    def close(self) -> None:
        if self.work is not None:
            self.work.abandon()
            self.work = None
