"""The cells of a study's table, in the window's words."""

from __future__ import annotations

from typing import Any

from ...studies import table as tables
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import TableItem
from ..common.theme import theme

NUMBER = QtCore.Qt.UserRole


class _Cell(QtGui.QTableWidgetItem):
    """Sorted by number where it is one; empty ones come last."""

    def __lt__(self, other: TableItem) -> bool:
        mine, its = self.data(NUMBER), other.data(NUMBER)
        if mine is None or its is None:
            return (mine is None, self.text()) < (its is None, other.text())
        return mine < its


def cell(made: tables.Table, name: str, value: Any, row: int) -> TableItem:
    """The cell of a study's table for a value of the column ``name``; ``row``: of the table, from 0."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if value is None or value != value:
        item = _Cell("")
    elif number:
        item = _Cell(f"{value:.5g}" if isinstance(value, float) else str(value))
        item.setData(NUMBER, float(value))
        item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        item.setToolTip(repr(value))
    else:
        item = _Cell(_word(name, str(value)))
        item.setToolTip(str(value))
    if made[tables.STATUS][row] == tables.FAILED:
        item.setForeground(QtGui.QColor(theme().warning))
        item.setToolTip(str(made[tables.ERROR][row]))
    elif name == "overall" and value == "fail":
        item.setForeground(QtGui.QColor(theme().warning))
    return item


def _word(name: str, text: str) -> str:
    if name == tables.STATUS:
        return {
            tables.DONE: translate("BeltGrinding", "done"),
            tables.FAILED: translate("BeltGrinding", "failed"),
            tables.OPEN: translate("BeltGrinding", "open"),
        }.get(text, text)
    if name == "overall" or name.endswith(".verdict"):
        return {
            "pass": translate("BeltGrinding", "pass"),
            "fail": translate("BeltGrinding", "fail"),
            "unknown": translate("BeltGrinding", "unknown"),
        }.get(text, text)
    return text
