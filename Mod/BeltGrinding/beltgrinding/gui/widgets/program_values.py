"""A table of what only the controller knows of a program, to be filled in."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ...engine import InputError
from ...objects import program_values
from ..common.compat import QtCore, QtGui, translate

if TYPE_CHECKING:
    from ...objects.program_values import Row

NAME, VALUE, LINE, KIND = range(4)  # the dock is narrow: the value beside its name
HEIGHT = 120  # pixels


class ProgramValues(QtGui.QWidget):
    """Asks for the values of a RobotPath's program. ``applied(data)`` and ``saved(data)`` are called with the
    content of a values file, ``wrong(error)`` with the InputError of a cell, which is chosen then.
    """

    def __init__(self) -> None:
        super().__init__()
        self.applied = self.saved = self.wrong = lambda _: None
        self.rows: Sequence[Row] = []
        column = QtGui.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        text = translate(
            "BeltGrinding",
            "What only the controller knows. Frames: x y z in mm, a b c in degrees, Rz(a) Ry(b) Rx(c), "
            "with blanks between them. What is left empty is not known.",
        )
        label = QtGui.QLabel(text)
        label.setWordWrap(True)
        column.addWidget(label)
        self.table = QtGui.QTableWidget(0, 4)
        self.table.setObjectName("programValues")
        self.table.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Name"),
                translate("BeltGrinding", "Value"),
                translate("BeltGrinding", "Line"),
                translate("BeltGrinding", "Kind"),
            ]
        )
        self.table.verticalHeader().hide()
        self.table.setMinimumSize(120, HEIGHT)
        self.table.horizontalHeader().setSectionResizeMode(QtGui.QHeaderView.ResizeToContents)
        self.table.horizontalHeader().setStretchLastSection(True)
        column.addWidget(self.table, 1)
        tip = translate("BeltGrinding", "Writes NAME.values.json beside the program, too")
        for name, title, tip, act in (
            ("applyValues", translate("BeltGrinding", "Apply"), "", lambda: self.applied),
            ("saveValues", translate("BeltGrinding", "Apply and save"), tip, lambda: self.saved),
        ):
            button = QtGui.QPushButton(title)
            button.setObjectName(name)
            button.setToolTip(tip)
            button.clicked.connect(lambda *_, act=act: self._take(act()))
            column.addWidget(button)

    def show_rows(self, rows: Sequence[Row]) -> None:
        """Fills the table with ``program_values.Row``."""
        self.rows = rows
        kinds = {
            "bases": translate("BeltGrinding", "base"),
            "tools": translate("BeltGrinding", "tool"),
            program_values.UNIT: translate("BeltGrinding", "mm or inch"),
        }
        self.table.setRowCount(len(rows))
        for i, row in enumerate(rows):
            kind = (
                translate("BeltGrinding", "frame")
                if row.frame
                else translate("BeltGrinding", "number")
            )
            texts = (
                row.name,
                program_values.text_of(row.value),
                str(row.line or ""),
                kinds.get(row.kind, kind),
            )
            for k, text in enumerate(texts):
                item = QtGui.QTableWidgetItem(text)
                if k != VALUE:
                    item.setFlags(item.flags() & ~QtCore.Qt.ItemIsEditable)
                self.table.setItem(i, k, item)

    def _take(self, act: Callable[[Any], object]) -> None:
        for i, row in enumerate(self.rows):
            try:
                row.value = program_values.value_of(row, self.table.item(i, VALUE).text())
            except InputError as error:
                self.table.setCurrentCell(i, VALUE)
                self.wrong(error)
                return
        act(program_values.data_of(self.rows))
