"""Panels and docks by the keyboard alone."""

from __future__ import annotations

from typing import Any

from ...objects.living import GONE
from .compat import QtCore
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
    for itself. The form itself takes it, so that no field changes under the mouse's wheel."""
    form.setFocusPolicy(QtCore.Qt.ClickFocus)

    def focus() -> None:
        try:
            form.setFocus()
        except GONE:
            pass  # closed again

    QtCore.QTimer.singleShot(0, focus)  # once it is shown
