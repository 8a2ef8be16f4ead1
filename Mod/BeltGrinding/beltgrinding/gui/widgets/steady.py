"""Fields that the mouse wheel changes only once they are clicked into: who scrolls a panel with the wheel
over a field means the panel, and would not see what it did to the field. A field that has the keyboard because
its panel was opened, or by the tab key, is not clicked into.
"""

from __future__ import annotations

from ..common.compat import QtCore, QtGui
from ..common.kinds import QtEvent, Widget

CLICKED = "beltGrindingClicked"  # property of a widget
STAYING = (QtCore.Qt.PopupFocusReason, QtCore.Qt.ActiveWindowFocusReason)


class _Steady(QtCore.QObject):
    def eventFilter(self, widget: Widget, event: QtEvent) -> bool:
        kind = event.type()
        if kind == QtCore.QEvent.MouseButtonPress:
            widget.setProperty(CLICKED, True)
        elif kind == QtCore.QEvent.FocusOut and event.reason() not in STAYING:
            for part in _parts(widget):
                part.setProperty(CLICKED, False)
        elif kind == QtCore.QEvent.Wheel and not any(p.property(CLICKED) for p in _parts(widget)):
            event.ignore()  # the panel behind gets it, and scrolls
            return True
        return False


def _parts(widget: Widget) -> list[Widget]:
    """A field, and the line in it, which gets the clicks of a spin box."""
    line = widget.findChild(QtGui.QLineEdit)
    return [widget] if line is None else [widget, line]


_filter = None


def steady(widget: Widget) -> Widget:
    """Makes a spin box, list of choices or slider one of those; returns it."""
    global _filter
    if _filter is None:
        _filter = _Steady()
    widget.setFocusPolicy(QtCore.Qt.StrongFocus)  # not by the wheel
    for part in _parts(widget):
        part.installEventFilter(_filter)
    return widget
