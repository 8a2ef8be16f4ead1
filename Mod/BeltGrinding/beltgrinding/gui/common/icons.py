"""Icons of the workbench: SVG files in Resources/icons."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import FreeCADGui as Gui

from ...base.resources import resources
from .compat import QtCore, QtGui
from .kinds import Icon, Painter
from .theme import theme

SIZE = 64  # pixels of an icon that is put together
PALE = 0.4  # opacity of the icon of what is left out
CROSSED, STROKE = "#d03030", 6  # the line through it, its pixels
BADGE = 0.62  # of its side: the mark in its corner


def icon(name: str) -> str:
    """Path of the icon ``name``, as FreeCAD takes it."""
    return str(resources() / "icons" / f"{name}.svg")


def qicon(name: str) -> Icon:
    """The icon as QIcon, drawn by FreeCAD: Qt draws no SVG itself where its plugin is missing."""
    return Gui.getIcon(icon(name))


@cache
def stale_icon(name: str) -> Icon:
    """QIcon of ``name`` with the mark of what is out of date in its corner."""
    badge = round(BADGE * SIZE)
    mark = qicon("BeltGrinding_OutOfDate").pixmap(badge, badge)

    def draw(painter: Painter) -> None:
        painter.drawPixmap(0, 0, qicon(name).pixmap(SIZE, SIZE))
        painter.drawPixmap(SIZE - badge, SIZE - badge, mark)

    return _drawn(draw)


@cache
def pale_icon(name: str) -> Icon:
    """QIcon of ``name`` as that of what is left out: pale and crossed out."""

    def draw(painter: Painter) -> None:
        painter.setOpacity(PALE)
        painter.drawPixmap(0, 0, qicon(name).pixmap(SIZE, SIZE))
        painter.setOpacity(1.0)
        painter.setPen(QtGui.QPen(QtGui.QColor(CROSSED), STROKE))
        painter.drawLine(STROKE, SIZE - STROKE, SIZE - STROKE, STROKE)

    return _drawn(draw)


def _drawn(draw: Callable[[Painter], None]) -> Icon:
    """QIcon of what ``draw`` paints. It stays in memory: a file would have an owner, and stay behind."""
    picture = QtGui.QPixmap(SIZE, SIZE)
    picture.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(picture)
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    draw(painter)
    painter.end()
    return QtGui.QIcon(picture)


MEDIA: dict[str, Any] = {  # polygons in a square of 16, drawn in the colour of the window's text
    "play": [((4, 2), (13, 8), (4, 14))],
    "pause": [((4, 2), (7, 2), (7, 14), (4, 14)), ((9, 2), (12, 2), (12, 14), (9, 14))],
    "end": [((2, 2), (11, 8), (2, 14)), ((11, 2), (14, 2), (14, 14), (11, 14))],
    "begin": [((14, 2), (5, 8), (14, 14)), ((5, 2), (2, 2), (2, 14), (5, 14))],
    "next": [((2, 2), (8, 8), (2, 14)), ((9, 14), (12, 7), (15, 14))],
    "previous": [((14, 2), (8, 8), (14, 14)), ((1, 14), (4, 7), (7, 14))],
}


def media_icon(name: str) -> Icon:
    """QIcon of a button of the playback: Qt's own are dark in every theme."""

    def draw(painter: Painter) -> None:
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(QtGui.QColor(theme().text))
        for corners in MEDIA[name]:
            points = [QtCore.QPointF(x * SIZE / 16, y * SIZE / 16) for x, y in corners]
            painter.drawPolygon(QtGui.QPolygonF(points))

    return _drawn(draw)
