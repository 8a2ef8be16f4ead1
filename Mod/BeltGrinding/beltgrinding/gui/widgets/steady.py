"""Fields that the mouse wheel changes only once they are clicked into: who scrolls a panel with the wheel
over a field means the panel, and would not see what it did to the field."""

from __future__ import annotations

from ..common.compat import QtCore
from ..common.kinds import QtEvent, Widget


class _Steady(QtCore.QObject):
    def eventFilter(self, widget: Widget, event: QtEvent) -> bool:
        if event.type() == QtCore.QEvent.Wheel and not widget.hasFocus():
            event.ignore()  # the panel behind gets it, and scrolls
            return True
        return False


_filter = None


def steady(widget: Widget) -> Widget:
    """Makes a spin box, list of choices or slider one of those; returns it."""
    global _filter
    if _filter is None:
        _filter = _Steady()
    widget.setFocusPolicy(QtCore.Qt.StrongFocus)  # not by the wheel
    widget.installEventFilter(_filter)
    return widget
