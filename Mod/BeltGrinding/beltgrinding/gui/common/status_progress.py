"""A run's progress in FreeCAD's status bar, seen whatever panel is in front."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

import FreeCADGui as Gui

from .compat import QtGui, translate
from .kinds import Widget

WIDTH = 120  # pixels


@contextlib.contextmanager
def painted_once(widget: Widget) -> Iterator[None]:
    """What changes in a widget meanwhile is painted together, afterwards: a progress bar paints at once, and with it
    FreeCAD's whole window."""
    widget.setUpdatesEnabled(False)
    try:
        yield
    finally:
        widget.setUpdatesEnabled(True)


class StatusProgress(QtGui.QWidget):
    """Text, bar and Cancel; it is there until ``remove``."""

    def __init__(self, cancel: Callable[..., object]) -> None:
        super().__init__()
        self.setObjectName("BeltGrinding_Progress")
        row = QtGui.QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.text = QtGui.QLabel()
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setFixedWidth(WIDTH)
        self.bar.setTextVisible(False)
        button = QtGui.QToolButton()
        button.setIcon(self.style().standardIcon(QtGui.QStyle.SP_DialogCancelButton))
        button.setToolTip(translate("BeltGrinding", "Cancel the simulation"))
        button.setAutoRaise(True)
        button.clicked.connect(cancel)
        for widget in (self.text, self.bar, button):
            row.addWidget(widget)
        Gui.getMainWindow().statusBar().addPermanentWidget(self)
        self.show()

    def update_progress(self, share: float, text: str) -> None:
        """``share`` done in [0, 1]."""
        with painted_once(self):
            self.bar.setValue(int(1000 * share))
            self.text.setText(text)

    def remove(self) -> None:
        """Takes it out of the status bar."""
        Gui.getMainWindow().statusBar().removeWidget(self)
        self.deleteLater()
