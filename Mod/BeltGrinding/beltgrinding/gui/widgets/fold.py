"""A box of a panel that folds away under its icon and title; folded, the title tells what is in it."""

from __future__ import annotations

from collections.abc import Callable

from ..common.compat import QtCore, QtGui
from ..common.icons import qicon
from ..common.kinds import Layout, QtEvent, Widget


ARROW = 28  # pixels of a title's arrow and its frame
ICON = 18  # pixels
UNDER_TITLE = (0, 4, 0, 4)  # pixels
NARROW = (4, 9, 4, 4)  # pixels; FreeCAD's panels have margins of their own


def slim(form: Layout) -> None:
    """Takes the margins of a panel's boxes in: the dock, as FreeCAD opens it on a small screen, is narrow."""
    for box in (form, *form.findChildren(QtGui.QGroupBox)):
        folds = isinstance(box.parentWidget(), Fold)  # whose title stands above it
        box.layout().setContentsMargins(*(UNDER_TITLE if folds else NARROW))


class Fold(QtGui.QWidget):
    """``icon_name``: without "BeltGrinding_"; ``content``: the widget that is folded. ``summary()``: one line of what it holds, told beside the
    title while it is folded."""

    def __init__(
        self,
        name: str,
        title: str,
        content: Widget | Layout,
        summary: Callable[[], str] = lambda: "",
        folded: bool = False,
        icon_name: str = "",
    ) -> None:
        super().__init__()
        self.title, self.summary, self.content = title, summary, content
        layout = QtGui.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.head = QtGui.QToolButton()
        self.head.setObjectName(name)
        self.head.setAutoRaise(True)
        self.head.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.head.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        self.head.setStyleSheet("QToolButton { text-align: left; font-weight: bold; }")
        self.head.clicked.connect(lambda: self.fold(not self.content.isHidden()))
        if isinstance(content, QtGui.QGroupBox):
            content.setFlat(True)
        row = QtGui.QHBoxLayout()
        row.setSpacing(0)
        if icon_name:
            row.setContentsMargins(ICON // 4, 0, 0, 0)
            picture = QtGui.QLabel()
            picture.setPixmap(qicon(f"BeltGrinding_{icon_name}").pixmap(ICON, ICON))
            row.addWidget(picture)
        row.addWidget(self.head, 1)
        layout.addLayout(row)
        layout.addWidget(content)
        self.fold(folded)

    def fold(self, folded: bool) -> None:
        """Folds it away, or unfolds it."""
        self.content.setVisible(not folded)
        self.head.setArrowType(QtCore.Qt.RightArrow if folded else QtCore.Qt.DownArrow)
        told = self.summary() if folded else ""
        self.told = f"{self.title}: {told}" if told else self.title
        self.head.setToolTip(self.told)
        self._write()

    def resizeEvent(self, event: QtEvent) -> None:
        super().resizeEvent(event)
        self._write()

    def _write(self) -> None:
        """The title, and what it tells on a line of its own where one is too narrow for both."""
        text = self.told
        self.head.ensurePolished()  # or its letters are not bold yet
        if self.head.fontMetrics().horizontalAdvance(text) + ARROW > self.head.width():
            text = text.replace(": ", ":\n", 1)
        if text != self.head.text():
            self.head.setText(text)
