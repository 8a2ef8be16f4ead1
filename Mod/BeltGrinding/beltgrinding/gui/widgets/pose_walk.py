"""Widgets that walk along a robot program: a slider with the cell in the view; a table and the source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import FreeCADGui as Gui
import numpy as np

from ...base.frames import to_abc
from ...objects import robot_path
from ...objects.kinds import Document, DocumentObject
from ...objects.living import GONE
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Array, Json, ModelIndex, View3D
from ..scene.cell_view import CellView
from .steady import steady

REACH = 8  # pixels around the mouse in which a pose is picked
LARGEST_SOURCE = 20_000_000  # bytes; a larger file is not shown
CURRENT = "#ffd54f"  # behind the line of the source that leads to the pose


class PoseWalk(QtGui.QWidget):
    """Slider, number and a switch; draws the cell at the pose. ``moved(index)`` tells of a new one."""

    def __init__(
        self, document: Document, machine: DocumentObject | None, paths: Sequence[DocumentObject]
    ) -> None:
        super().__init__()
        self.paths, self.count = paths, 0
        self.moved = lambda index: None
        self.view = CellView(document, machine)
        self.picking: list[tuple[View3D, Any]] = []
        body = QtGui.QVBoxLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        self.program = steady(QtGui.QComboBox())
        self.program.setObjectName("walkedProgram")
        for path in paths:
            self.program.addItem(path.Label)
        self.program.setVisible(len(paths) > 1)
        self.slider = steady(QtGui.QSlider(QtCore.Qt.Horizontal))
        self.slider.setObjectName("poseSlider")
        self.number = steady(QtGui.QSpinBox())
        self.number.setObjectName("poseNumber")
        self.number.setPrefix(translate("BeltGrinding", "pose "))
        row = QtGui.QHBoxLayout()
        row.addWidget(self.slider, 1)
        row.addWidget(self.number)
        self.moving = QtGui.QCheckBox(translate("BeltGrinding", "Show the cell as it moves"))
        self.moving.setObjectName("cellMoves")
        self.moving.setToolTip(
            translate(
                "BeltGrinding",
                "Off: the part stays and the wheel moves over it. On: the part moves where the "
                "robot holds it",
            )
        )
        body.addWidget(self.program)
        body.addLayout(row)
        body.addWidget(self.moving)
        self.moving.toggled.connect(self.view.set_moving)
        self.slider.valueChanged.connect(self.number.setValue)
        self.number.valueChanged.connect(self.slider.setValue)
        self.number.valueChanged.connect(self._go)
        self.program.currentIndexChanged.connect(self.choose)
        self._listen(document)
        self.choose(0)

    def path(self) -> DocumentObject:
        """The RobotPath that is walked."""
        return self.paths[max(self.program.currentIndex(), 0)]

    def choose(self, index: int) -> None:
        """Walks another program, from its first pose."""
        arrays = robot_path.as_run(self.paths[index])
        self.view.robot.follow(arrays.get("joints_deg"), arrays.get("external"))
        # The way of a program for the whole robot has places, and no feeds.
        self.view.set_path(arrays["frames"], arrays if "feeds" in arrays else None)
        count = len(arrays["frames"])
        for widget in (self.slider, self.number):
            widget.setRange(1, max(count, 1))
        self.slider.setPageStep(max(count // 20, 1))
        self.setEnabled(count > 0)
        self.count = count
        self.number.setValue(1)
        self.arrange()

    def arrange(self) -> None:
        """Follows a change of the cell."""
        part = self.view.cell()["holding"] == "part_in_hand"
        self.moving.setEnabled(part)  # with the tool in hand, the wheel moves anyway
        self.moving.setChecked(self.moving.isChecked() and part)
        self.view.update()

    def go(self, index: int) -> None:
        """Goes to the pose ``index`` (from 0)."""
        self.number.setValue(index + 1)

    def _go(self, number: int) -> None:
        if number > self.count:  # there is none
            return
        self.view.set_pose(number - 1)
        self.moved(number - 1)

    def _listen(self, document: Document) -> None:
        """A click on the path in a 3D view goes to the pose that is drawn there."""
        for view in Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor"):
            call = view.addEventCallback(
                "SoMouseButtonEvent", lambda event, view=view: self._clicked(view, event)
            )
            self.picking.append((view, call))

    def _clicked(self, view: View3D, event: Json) -> None:
        plain = not (event["ShiftDown"] or event["CtrlDown"] or event["AltDown"])
        if event["State"] == "DOWN" and event["Button"] == "BUTTON1" and plain:
            index = self.view.nearest(view, event["Position"], REACH)
            if index is not None:
                self.go(index)

    def release(self) -> None:
        """Takes everything out of the 3D views; call it when the panel closes."""
        for view, call in self.picking:
            try:
                view.removeEventCallback("SoMouseButtonEvent", call)
            except GONE:
                pass  # the view is closed
        self.picking = []
        self.view.close()


class _Poses(QtCore.QAbstractTableModel):
    """The poses of a path; made a row at a time, for there may be 100,000."""

    def __init__(self, arrays: Mapping[str, Array]) -> None:
        super().__init__()
        self.arrays = arrays
        self.titles = (
            translate("BeltGrinding", "Pose"),
            translate("BeltGrinding", "Line"),
            translate("BeltGrinding", "Motion"),
            *"XYZABC",
            translate("BeltGrinding", "Feed"),
            translate("BeltGrinding", "Force"),
        )

    def rowCount(self, parent: ModelIndex = None) -> int:
        return len(self.arrays["lines"])

    def columnCount(self, parent: ModelIndex = None) -> int:
        return len(self.titles)

    def headerData(self, section: int, orientation: Any, role: Any) -> str | None:
        if role == QtCore.Qt.DisplayRole and orientation == QtCore.Qt.Horizontal:
            return self.titles[section]
        return None

    def data(self, index: ModelIndex, role: Any) -> Any:
        if role == QtCore.Qt.TextAlignmentRole:
            return int(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        if role != QtCore.Qt.DisplayRole:
            return None
        i, k = index.row(), index.column()
        if k == 0:
            return str(i + 1)
        if k == 1:
            return str(int(self.arrays["lines"][i]) or "")
        if k == 2:
            rapid = self.arrays["rapid"][i]
            return (
                translate("BeltGrinding", "rapid") if rapid else translate("BeltGrinding", "linear")
            )
        if k < 6:
            return f"{self.arrays['frames'][i, k - 3, 3]:.3f}"
        if k < 9:
            return f"{to_abc(self.arrays['frames'][i])[k - 6]:.3f}"
        if k == 9:
            return f"{self.arrays['feeds'][i]:.5g}"
        force = self.arrays["forces"][i]
        return f"{force:.5g}" if force >= 0 else ""


class PoseTable(QtGui.QTabWidget):
    """The poses as a table, and the program's text; ``chosen(index)`` tells of a pose chosen here."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("poseTabs")
        self.chosen = lambda index: None
        self.quiet = False
        self.table = QtGui.QTableView()
        self.table.setObjectName("poses")
        self.table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        self.table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(20)
        self.table.setWordWrap(False)
        self.source = QtGui.QPlainTextEdit()
        self.source.setObjectName("source")
        self.source.setReadOnly(True)
        self.source.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
        self.source.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.FixedFont))
        self.source.cursorPositionChanged.connect(self._text_clicked)
        self.addTab(self.table, translate("BeltGrinding", "Poses"))
        self.addTab(self.source, translate("BeltGrinding", "Source"))

    def show_path(self, obj: DocumentObject) -> None:
        """Shows a RobotPath's poses and its source."""
        self.arrays = obj.Proxy.arrays(obj)
        self.model = _Poses(self.arrays)
        self.table.setModel(self.model)
        self.table.selectionModel().currentRowChanged.connect(self._row_chosen)
        for k in range(self.model.columnCount()):
            self.table.setColumnWidth(k, 52 if k in (0, 1, 2) else 68)
        self.quiet = True
        self.source.setPlainText(_text(obj.Source))
        self.quiet = False
        self.setTabEnabled(1, bool(self.source.toPlainText()))

    def show_pose(self, index: int) -> None:
        """Selects a pose that was chosen elsewhere."""
        if self.quiet:
            return
        self.quiet = True
        self.table.setCurrentIndex(self.model.index(index, 0))
        self._mark(int(self.arrays["lines"][index]))
        self.quiet = False

    def _row_chosen(self, row: ModelIndex, _: ModelIndex) -> None:
        if not self.quiet and row.isValid():
            self.quiet = True
            self._mark(int(self.arrays["lines"][row.row()]))
            self.chosen(row.row())
            self.quiet = False

    def _text_clicked(self) -> None:
        if self.quiet:
            return
        line = self.source.textCursor().blockNumber() + 1
        found = np.flatnonzero(self.arrays["lines"] == line)
        if len(found):
            self.quiet = True
            self.table.setCurrentIndex(self.model.index(int(found[0]), 0))
            self._mark(line)
            self.chosen(int(found[0]))
            self.quiet = False

    def _mark(self, line: int) -> None:
        """Marks a line of the source, from 1, and scrolls to it."""
        block = self.source.document().findBlockByNumber(line - 1)
        if line < 1 or not block.isValid():
            return
        mark = QtGui.QTextEdit.ExtraSelection()
        mark.cursor = QtGui.QTextCursor(block)
        mark.format.setBackground(QtGui.QColor(CURRENT))
        mark.format.setForeground(QtGui.QColor("black"))
        mark.format.setProperty(QtGui.QTextFormat.FullWidthSelection, True)
        self.source.setExtraSelections([mark])
        self.source.setTextCursor(mark.cursor)
        self.source.ensureCursorVisible()


def _text(path: str) -> str:
    """The program's text, '' where there is none to show."""
    try:
        data = (
            Path(path).read_bytes() if path and Path(path).stat().st_size < LARGEST_SOURCE else b""
        )
    except OSError:
        return ""
    return "" if b"\0" in data else data.decode("utf-8", "replace")
