"""A picture in a panel."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Image, QtEvent

PICTURE_WIDTH = 160  # pixels, least; the panel must fit the combo view as it comes


class PictureLabel(QtGui.QLabel):
    """A picture as wide as the panel; a click calls ``clicked()``."""

    def __init__(self, name: str, clicked: Callable[[], object]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.clicked, self.pixmap_ = clicked, QtGui.QPixmap()
        self.setMinimumWidth(PICTURE_WIDTH)
        self.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        self.setCursor(QtCore.Qt.PointingHandCursor)
        self.setToolTip(translate("BeltGrinding", "Click for a larger picture"))

    def show_file(self, path: str) -> None:
        """A picture's file; none: hides it."""
        self._show(QtGui.QPixmap(path) if path and Path(path).exists() else QtGui.QPixmap())

    def show_bytes(self, content: bytes | None) -> None:
        """The bytes of a picture's file."""
        pixmap = QtGui.QPixmap()
        pixmap.loadFromData(content)
        self._show(pixmap)

    def _show(self, pixmap: Image) -> None:
        self.pixmap_ = pixmap
        self.setVisible(not self.pixmap_.isNull())
        self._fit()

    def resizeEvent(self, event: QtEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        if self.pixmap_.isNull():
            return
        width = max(self.width(), PICTURE_WIDTH)
        ratio = self.devicePixelRatioF()
        fitted = self.pixmap_.scaledToWidth(int(width * ratio), QtCore.Qt.SmoothTransformation)
        fitted.setDevicePixelRatio(ratio)
        self.setPixmap(fitted)
        self.setFixedHeight(int(fitted.height() / ratio))

    def mousePressEvent(self, event: QtEvent) -> None:
        self.clicked()
