"""The study's dock: its table, a row a run, and its answers as charts."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...base.files import cannot_be_written, write_whole
from ...base.kinds import known
from ...base.messages import sentence
from ...engine import InputError
from ...objects import api, stored_facts
from ...objects.kinds import DocumentObject
from ...studies import names, report, table as tables
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Json, Widget
from ..common.messages import error_text, inform, tell
from ..common.report_language import language, words
from ..common.save_dialog import file_to_write
from ..common.transaction import transaction
from ..common.task_panel import show_panel
from ..panels.study_panel import StudyPanel
from ..widgets.picture_label import PictureLabel
from ..widgets.steady import steady
from .object_dock import ObjectDock
from .study_cells import NUMBER, cell

HEIGHT = 300  # pixels of the dock as it comes
SHARES = [620, 460]  # of table and charts, side by side
DPI = 100
LARGE = 0.9  # of the screen
HIDDEN = (tables.HASH,)
MOST_WARNINGS = 4  # lines above the table; all are in the tip


class StudyDock(ObjectDock):
    """Shows a Study object."""

    NAME = "BeltGrinding_StudyDock"

    def __init__(self) -> None:
        super().__init__()
        self.table: tables.Table | None = None
        self.answers: Json | None = None
        self.texts = words()
        parts = QtGui.QSplitter(QtCore.Qt.Horizontal)
        left, layout = QtGui.QWidget(), QtGui.QVBoxLayout()
        left.setLayout(layout)
        self.told = QtGui.QLabel()
        self.told.setObjectName("studyFigures")
        self.told.setWordWrap(True)
        self.warnings = QtGui.QLabel()
        self.warnings.setObjectName("studyWarnings")
        self.warnings.setWordWrap(True)
        self.rows = QtGui.QTableWidget(0, 0)
        self.rows.setObjectName("studyRows")
        self.rows.verticalHeader().hide()
        self.rows.verticalHeader().setDefaultSectionSize(20)
        self.rows.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.rows.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        self.rows.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
        self.rows.setToolTip(
            translate("BeltGrinding", "Double click: set the document to this run. Heads: sort")
        )
        self.rows.cellDoubleClicked.connect(lambda row, _: self.open_row())
        self.rows.itemSelectionChanged.connect(self._enable)
        self.opens = QtGui.QPushButton(translate("BeltGrinding", "Open as the document's state"))
        self.opens.setObjectName("openRun")
        self.opens.clicked.connect(self.open_row)
        self.save = QtGui.QPushButton(translate("BeltGrinding", "Save table..."))
        self.save.setObjectName("saveTable")
        self.save.clicked.connect(self.write_table)
        self.tells = QtGui.QPushButton(translate("BeltGrinding", "Report..."))
        self.tells.setObjectName("studyReport")
        self.tells.clicked.connect(self.write_report)
        buttons = QtGui.QHBoxLayout()
        for button in (self.opens, self.save, self.tells):
            buttons.addWidget(button)
        for widget in (self.told, self.warnings, self.rows):
            layout.addWidget(widget)
        layout.addLayout(buttons)
        parts.addWidget(left)
        parts.addWidget(self._charts())
        parts.setSizes(SHARES)
        self.setWidget(parts)
        self.place(QtCore.Qt.BottomDockWidgetArea, HEIGHT)
        FreeCAD.addDocumentObserver(self)

    @staticmethod
    def title() -> str:
        return translate("BeltGrinding", "Study")

    def _charts(self) -> Widget:
        side, layout = QtGui.QWidget(), QtGui.QVBoxLayout()
        side.setLayout(layout)
        self.kind, self.figure = steady(QtGui.QComboBox()), steady(QtGui.QComboBox())
        self.kind.setObjectName("studyChart")
        self.figure.setObjectName("studyFigure")
        for key, text in (
            ("tornado", translate("BeltGrinding", "What does most (tornado)")),
            ("effects", translate("BeltGrinding", "Mean over each variable")),
            ("scatter", translate("BeltGrinding", "All runs (scatter)")),
            ("sobol", translate("BeltGrinding", "Sobol indices")),
            ("yield", translate("BeltGrinding", "Tolerance yield")),
            ("matrix", translate("BeltGrinding", "Each against each other")),
        ):
            self.kind.addItem(text, key)
        row = QtGui.QHBoxLayout()
        for box in (self.kind, self.figure):
            box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(10)
            box.currentIndexChanged.connect(lambda _: self._draw())
            row.addWidget(box, 1)
        layout.addLayout(row)
        self.note = QtGui.QLabel()
        self.note.setObjectName("studyNote")
        self.note.setWordWrap(True)
        layout.addWidget(self.note)
        self.picture = PictureLabel("studyPicture", self.enlarge)
        area = QtGui.QScrollArea()
        # One that comes and goes changes the picture's width, thereby its height, thereby itself, without end.
        area.setVerticalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOn)
        area.setWidgetResizable(True)
        area.setFrameShape(QtGui.QFrame.NoFrame)
        held, inner = QtGui.QWidget(), QtGui.QVBoxLayout()
        inner.setContentsMargins(0, 0, 0, 0)
        held.setLayout(inner)
        inner.addWidget(self.picture)
        inner.addStretch()
        area.setWidget(held)
        layout.addWidget(area, 1)
        return side

    def refresh(self) -> None:
        """Shows the object as it is now."""
        obj = self.living()
        if obj is None:
            self._clear()
            return
        try:
            self.table, self.answers = obj.Proxy.table(obj), obj.Proxy.answers(obj)
        except InputError as error:
            self.table = self.answers = None
            self.told.setText(error_text(error))
        self._fill()
        self._tell(obj)
        self._warn(obj)
        before = self.figure.blockSignals(True)
        chosen = self.figure.currentData()
        self.figure.clear()
        for name in (self.answers or {}).get("figures", {}):
            self.figure.addItem(names.figure(name, self.texts), name)
        self.figure.setCurrentIndex(max(self.figure.findData(chosen), 0))
        self.figure.blockSignals(before)
        self._draw()
        self._enable()

    def _clear(self) -> None:
        self.table = self.answers = None
        self.rows.setRowCount(0)
        self.told.setText("")
        self.warnings.hide()
        self.picture.show_bytes(b"")
        self._enable()

    def _fill(self) -> None:
        made = self.table
        self.rows.setSortingEnabled(False)
        self.rows.clear()
        if made is None:
            self.rows.setRowCount(0)
            return
        first = [tables.RUN, tables.STATUS, *known(made.varied)]
        shown = first + [n for n in made.names if n not in (*first, *HIDDEN)]
        shown = [n for n in shown if n != tables.ERROR or (made[tables.STATUS] == "error").any()]
        self.rows.setColumnCount(len(shown))
        self.rows.setRowCount(len(made))
        for column, name in enumerate(shown):
            head = QtGui.QTableWidgetItem(self._head(name, made))
            head.setToolTip(name)
            self.rows.setHorizontalHeaderItem(column, head)
            for row, value in enumerate(made[name].tolist()):
                self.rows.setItem(row, column, cell(made, name, value, row))
        self.rows.resizeColumnsToContents()
        self.rows.setSortingEnabled(True)
        self.rows.sortByColumn(0, QtCore.Qt.AscendingOrder)

    def _head(self, name: str, made: tables.Table) -> str:
        heads = {
            tables.RUN: translate("BeltGrinding", "Run"),
            tables.STATUS: translate("BeltGrinding", "State"),
            tables.ERROR: translate("BeltGrinding", "Why"),
        }
        if name in heads or name in known(made.varied):
            return heads.get(name, name)
        return names.figure(name, self.texts)

    def _tell(self, obj: DocumentObject) -> None:
        if obj.OutOfDate:
            self.told.setText(
                translate("BeltGrinding", "Out of date: an input has changed since; run again.")
            )
            return
        lines = [
            translate("BeltGrinding", "{} of {} runs have figures").format(
                obj.RunsDone, obj.RunsInAll
            )
        ]
        if obj.RunsFailed:
            lines.append(translate("BeltGrinding", "{} failed").format(obj.RunsFailed))
        whole = [o for o in (self.answers or {}).get("yield", ()) if o["of"] == "overall"]
        if whole:
            text = translate("BeltGrinding", "{:.1f} % pass").format(100.0 * whole[0]["share"])
            if whole[0]["low"] is not None:
                low, high = 100.0 * whole[0]["low"], 100.0 * whole[0]["high"]
                text += translate("BeltGrinding", " (95 %: {:.1f} to {:.1f})").format(low, high)
            lines.append(text)
        lines += _best((self.answers or {}).get("best"))
        if obj.OpenedRun:
            text = translate("BeltGrinding", "the document is set to run {}")
            lines.append(text.format(obj.OpenedRun))
        self.told.setText(", ".join(lines))

    def _warn(self, obj: DocumentObject) -> None:
        """What the user should know of the runs and of their answers."""
        lines = stored_facts.sentences(obj, "Warnings", language(), alike=True)
        lines += [sentence(one, language()) for one in (self.answers or {}).get("note_facts", ())]
        self.warnings.setText("\n".join(lines[:MOST_WARNINGS]))
        self.warnings.setToolTip("\n".join(lines))
        self.warnings.setVisible(bool(lines) and not obj.OutOfDate)

    def _draw(self) -> None:
        """The chosen chart of the chosen figure."""
        kind, name = self.kind.currentData(), self.figure.currentData()
        self.figure.setEnabled(kind not in ("yield", "matrix"))
        self.note.hide()
        if self.answers is None or self.table is None:
            self.picture.show_bytes(b"")
            return
        try:
            self.picture.show_bytes(self._chart(kind, name, DPI) or b"")
        except InputError as error:  # no matplotlib
            self.picture.show_bytes(b"")
            self._note(error_text(error))

    def _note(self, text: str) -> None:
        self.note.setText(text)
        self.note.setVisible(bool(text))

    def _chart(self, kind: str, name: str | None, dpi: int) -> bytes | None:
        """Bytes of a picture; None where there is none, and the note says why."""
        answers = known(self.answers)
        if kind == "sobol" and name is not None:
            found = answers["figures"][name]["sobol"]
            told = [found[key] for key in ("reason", "doubt") if key in found]
            self._note("\n".join(sentence(one, language()) for one in told))
        return report.one(answers, known(self.table), kind, name, self.texts, dpi)

    def enlarge(self) -> None:
        """The chart in a window of its own."""
        if self.answers is None:
            return
        content = self._chart(self.kind.currentData(), self.figure.currentData(), 2 * DPI)
        pixmap = QtGui.QPixmap()
        pixmap.loadFromData(content or b"")
        if pixmap.isNull():
            return
        screen = QtGui.QApplication.primaryScreen().availableSize()
        whole = QtCore.QSize(int(LARGE * screen.width()), int(LARGE * screen.height()))
        dialog = QtGui.QDialog(self)
        dialog.setWindowTitle(self.windowTitle())
        label = QtGui.QLabel()
        label.setPixmap(
            pixmap.scaled(whole, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation)
        )
        QtGui.QVBoxLayout(dialog).addWidget(label)
        dialog.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        dialog.show()

    def _enable(self) -> None:
        there = self.table is not None
        self.opens.setEnabled(there and bool(self.rows.selectedItems()))
        self.save.setEnabled(there)
        self.tells.setEnabled(self.answers is not None)

    def open_row(self) -> None:
        """Sets the document to the chosen run, in one undo step."""
        row, obj = self.rows.currentRow(), self.living()
        if row < 0 or obj is None:
            return
        number = int(self.rows.item(row, 0).data(NUMBER))
        title = translate("BeltGrinding", "Set to run {}").format(number)
        with transaction(obj.Document, title) as step:
            left, laid_anew = api.open_study_run(obj, number)
        if step.failed:
            return
        self._tell(obj)
        told = []
        if left:
            text = translate(
                "BeltGrinding", "The document has no property for these, they stay as they are: {}"
            )
            told.append(text.format(", ".join(left)))
        if laid_anew:
            text = translate(
                "BeltGrinding",
                "These paths were laid anew for the settings, so the figures may differ from the table's: {}",
            )
            told.append(text.format(", ".join(laid_anew)))
        if told:
            inform("\n".join(told))

    def write_table(self) -> None:
        """The table as a CSV file."""
        self._write(
            translate("BeltGrinding", "Save table"),
            f"{self.shown().Label}.csv",
            "CSV (*.csv)",
            known(self.table).csv_bytes,
        )

    def write_report(self) -> None:
        """The answers as a report, in one HTML file."""

        def content() -> bytes:
            answers, obj = known(self.answers), self.shown()
            drawn = report.draw(answers, known(self.table), self.texts)
            job = obj.getParentGroup()
            held = {"vary": json.loads(obj.Design)["vary"]}
            held["job"] = {"design": {"file": job.Label}}
            return report.document(answers, held, drawn, self.texts).encode()

        title = translate("BeltGrinding", "Report of the study")
        self._write(title, f"{self.shown().Label}.html", "HTML (*.html)", content)

    def _write(self, title: str, name: str, kinds: str, content: Callable[[], bytes]) -> None:
        path = file_to_write(title, name, kinds)
        if not path:
            return
        try:
            write_whole(Path(path), content())
        except OSError as error:
            tell(error_text(cannot_be_written(path, error)))
        except InputError as error:
            tell(error_text(error))

    # Of the document

    def slotChangedObject(self, obj: DocumentObject, name: str) -> None:
        if obj is not self.obj or self.living() is None:
            return
        if name in ("OutOfDate", "OpenedRun"):
            self._tell(obj)
        elif name == "Fingerprint" and obj.Fingerprint:
            QtCore.QTimer.singleShot(0, self.refresh)

    def forget(self) -> None:
        self.obj = None
        self._clear()
        self.hide()


def _best(found: Json | None) -> list[str]:
    """What is said of the best setting, in a list."""
    if found is None:
        return []
    if found["run"] is not None:
        return [translate("BeltGrinding", "best: run {}").format(found["run"])]
    if found["nearest"] is not None:
        text = translate("BeltGrinding", "no run keeps all limits, nearest: run {}")
        return [text.format(found["nearest"]["run"])]
    return [translate("BeltGrinding", "no run to choose the best from")]


def show(obj: DocumentObject) -> None:
    """Opens the panel of a Study object; its table comes in the dock."""
    if obj.getParentGroup() is not None and not Gui.Control.activeDialog():
        show_panel(StudyPanel(obj, StudyDock.open), obj)
