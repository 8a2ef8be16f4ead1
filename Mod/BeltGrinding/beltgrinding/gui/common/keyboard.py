"""Panels and docks by the keyboard alone."""

from __future__ import annotations

from typing import Any

from ...objects.living import GONE
from .compat import QtCore, QtGui
from .kinds import QtEvent, Widget


class _Space(QtCore.QObject):
    """Keeps Space for the button or list that has the focus: FreeCAD's own shortcut hides what is selected by it."""

    def eventFilter(self, widget: Any, event: QtEvent) -> bool:
        if event.type() == QtCore.QEvent.ShortcutOverride and event.key() == QtCore.Qt.Key_Space:
            event.accept()
            return True
        return False


_space = _Space()


def space_presses(form: Widget) -> None:
    """Lets Space press the buttons of a panel's form, or of a dock."""
    form.installEventFilter(_space)


def take_keyboard(form: Widget) -> None:
    """Gives a panel the keyboard: the next Tab goes to its first field. FreeCAD leaves it in the 3D view, which keeps Tab
    for itself. A pixel at the form's top takes it: no field then changes under the mouse's wheel, and the view does not
    scroll to the form's end, past OK and Cancel."""
    first = QtGui.QWidget(form)
    first.setGeometry(0, 0, 1, 1)
    for widget in (form, first):
        widget.setFocusPolicy(QtCore.Qt.ClickFocus)
    first.show()

    def focus() -> None:
        try:
            QtGui.QWidget.setTabOrder(form, first)
            first.setFocus()
        except GONE:
            pass  # closed again

    QtCore.QTimer.singleShot(0, focus)  # once it is shown
