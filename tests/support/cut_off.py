"""What of a panel or a dock is cut off: texts that are wider than their widgets. Imported inside FreeCAD."""

import re

from PySide import QtCore, QtGui

BUTTONS = (QtGui.QPushButton, QtGui.QToolButton, QtGui.QCheckBox, QtGui.QRadioButton)
TAG = re.compile(r"<[^>]*>")
BESIDE = {True: 6, False: 20}  # pixels of a button's frame; of an arrow or a box beside the text
CELL = 4  # pixels beside a cell's text


def cut_off(root):
    """[(kind, object name, text, its width, the room that it has)] of what is visible below a widget."""
    found = []
    for widget in [root, *root.findChildren(QtGui.QWidget)]:
        if not widget.isVisible():
            continue
        for text, room in _texts(widget):
            wide = max(map(widget.fontMetrics().horizontalAdvance, text.split("\n")))
            if wide > room:
                found.append((type(widget).__name__, widget.objectName(), text, wide, room))
    return found


def _texts(widget):
    """(text, pixels of room) of a widget."""
    if isinstance(widget, QtGui.QLabel):
        if widget.text() and not widget.wordWrap():
            margins = widget.contentsMargins()
            room = widget.width() - margins.left() - margins.right()
            yield TAG.sub("", widget.text()), room
    elif isinstance(widget, BUTTONS):
        text = widget.text().replace("&", "")
        if text and _shows_text(widget):
            plain = isinstance(widget, QtGui.QPushButton) or len(text) < 3  # without arrow or box
            yield text, widget.width() - BESIDE[plain]
    elif isinstance(widget, QtGui.QGroupBox):
        yield widget.title(), widget.width() - 16
    elif isinstance(widget, QtGui.QTableWidget):
        yield from _cells(widget)


def _shows_text(button):
    if not isinstance(button, QtGui.QToolButton):
        return True
    return button.toolButtonStyle() != QtCore.Qt.ToolButtonIconOnly or button.icon().isNull()


def _cells(table):
    for column in range(table.columnCount()):
        if table.isColumnHidden(column):
            continue
        room = table.columnWidth(column) - CELL
        head = table.horizontalHeaderItem(column)
        if head is not None and table.horizontalHeader().isVisible():
            yield head.text(), room
        for row in range(table.rowCount()):
            item = table.item(row, column)
            if item is not None and not table.isRowHidden(row) and not _wraps(table, row):
                yield item.text(), room


def _wraps(table, row):
    """Whether a row is high enough for texts of several lines."""
    return table.rowHeight(row) > 1.8 * table.fontMetrics().height()
