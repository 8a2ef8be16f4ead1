"""Texts and legends in the 3D view as pictures that Qt draws: smooth letters in any font, and a ground."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ..common.compat import QtCore, QtGui
from ..common.kinds import Colour, Image, Node
from ..common.theme import theme

LETTER = 13  # pixels of the screen
PAD = 5
OPACITY = 225  # of 255: the ground


def put_image(node: Node, image: Image | None) -> None:
    """Gives a SoImage the pixels of a QImage; none of None."""
    size, data = pixels(image)
    node.image.setValue(coin.SbVec2s(*size), 4 if data else 0, data)


def pixels(image: Image | None) -> tuple[tuple[int, int], bytes]:
    """((width, height), bytes from the lower left, RGBA) of a QImage; ((1, 1), b"") of None."""
    if image is None:
        return (1, 1), b""
    turned = image.convertToFormat(QtGui.QImage.Format_RGBA8888).mirrored(False, True)
    data = np.frombuffer(turned.constBits(), dtype=np.uint8)
    rows = data.reshape(turned.height(), turned.bytesPerLine())[:, : 4 * turned.width()]
    return (turned.width(), turned.height()), rows.tobytes()


def label(text: str, colour: Colour) -> Node:
    """A SoImage that shows a text to the right of where it stands, with a bar of a colour (as Qt takes it)."""
    ratio = QtGui.QGuiApplication.primaryScreen().devicePixelRatio()
    font = QtGui.QFont(QtGui.QApplication.font())
    font.setPixelSize(round(LETTER * ratio))
    metrics, pad = QtGui.QFontMetricsF(font), PAD * ratio
    # The space on the left keeps the place itself free.
    free = 2.5 * pad
    width = free + metrics.boundingRect(text).width() + 3.5 * pad
    height = metrics.height() + pad
    image = QtGui.QImage(round(width), round(height), QtGui.QImage.Format_RGBA8888)
    image.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(image)
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    painter.setFont(font)
    ground = QtGui.QColor(theme().ground)
    ground.setAlpha(OPACITY)
    painter.setPen(QtCore.Qt.NoPen)
    painter.setBrush(ground)
    painter.drawRoundedRect(QtCore.QRectF(free, 0, width - free, height), 0.6 * pad, 0.6 * pad)
    painter.setBrush(QtGui.QColor(colour))
    painter.drawRoundedRect(QtCore.QRectF(free, 0, 0.8 * pad, height), 0.4 * pad, 0.4 * pad)
    painter.setPen(QtGui.QColor(theme().text))
    box = QtCore.QRectF(free + 1.8 * pad, 0, width, height)
    painter.drawText(box, int(QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter), text)
    painter.end()
    node = coin.SoImage()
    put_image(node, image)
    node.vertAlignment = coin.SoImage.HALF
    return node
