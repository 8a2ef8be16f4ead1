"""A picture in a panel."""

from pathlib import Path

from ..common.compat import QtCore, QtGui, translate

PICTURE_WIDTH = 160  # pixels, least; the panel must fit the combo view as it comes


class PictureLabel(QtGui.QLabel):
    """A picture as wide as the panel; a click calls ``clicked()``."""

    def __init__(self, name, clicked):
        super().__init__()
        self.setObjectName(name)
        self.clicked, self.pixmap_ = clicked, QtGui.QPixmap()
        self.setMinimumWidth(PICTURE_WIDTH)
        self.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        self.setCursor(QtCore.Qt.PointingHandCursor)
        self.setToolTip(translate("BeltGrinding", "Click for a larger picture"))

    def show_file(self, path):
        """A picture's file; none: hides it."""
        self._show(QtGui.QPixmap(path) if path and Path(path).exists() else QtGui.QPixmap())

    def show_bytes(self, content):
        """The bytes of a picture's file."""
        pixmap = QtGui.QPixmap()
        pixmap.loadFromData(content)
        self._show(pixmap)

    def _show(self, pixmap):
        self.pixmap_ = pixmap
        self.setVisible(not self.pixmap_.isNull())
        self._fit()

    def resizeEvent(self, event):
        super().resizeEvent(event)
        self._fit()

    def _fit(self):
        if self.pixmap_.isNull():
            return
        width = max(self.width(), PICTURE_WIDTH)
        ratio = self.devicePixelRatioF()
        fitted = self.pixmap_.scaledToWidth(int(width * ratio), QtCore.Qt.SmoothTransformation)
        fitted.setDevicePixelRatio(ratio)
        self.setPixmap(fitted)
        self.setFixedHeight(int(fitted.height() / ratio))

    def mousePressEvent(self, event):
        self.clicked()
