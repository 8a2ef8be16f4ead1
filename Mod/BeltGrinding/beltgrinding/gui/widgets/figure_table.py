"""A table of names and figures, of which nothing is cut off: where both have no room the names wrap."""

from __future__ import annotations

from collections.abc import Sequence

from ..common.compat import QtGui
from ..common.kinds import QtEvent


class FigureTable(QtGui.QTableWidget):
    """Two columns without heads."""

    def __init__(self, name: str, height: int) -> None:
        super().__init__(0, 2)
        self.setObjectName(name)
        self.horizontalHeader().hide()
        self.verticalHeader().hide()
        self.setMinimumHeight(height)
        self.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)

    def show_rows(self, rows: Sequence[tuple[str, str]]) -> None:
        """Shows (name, figure) of each row."""
        self.setRowCount(len(rows))
        for row, texts in enumerate(rows):
            for column, text in enumerate(texts):
                self.setItem(row, column, QtGui.QTableWidgetItem(text))
        self.arrange()

    def resizeEvent(self, event: QtEvent) -> None:
        super().resizeEvent(event)
        self.arrange()

    def arrange(self) -> None:
        """Gives both columns what there is of room, the figures first."""
        head, kinds = self.horizontalHeader(), QtGui.QHeaderView
        tight = self.sizeHintForColumn(0) + self.sizeHintForColumn(1) > self.viewport().width()
        head.setSectionResizeMode(0, kinds.Stretch if tight else kinds.ResizeToContents)
        head.setSectionResizeMode(1, kinds.ResizeToContents if tight else kinds.Stretch)
        self.resizeRowsToContents()
