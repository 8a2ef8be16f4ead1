"""Joints over time, between their limits, with marks where bodies are near or meet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..common.compat import QtCore, QtGui
from ..common.figures import figure
from ..common.kinds import Array, Image, Painter, QtEvent
from ..common.theme import readable, theme

LEFT, RIGHT, TOP, BOTTOM = 62, 6, 12, 18  # pixels
ROW = 38  # pixels, least height of a row
LETTERS = 11  # pixels
LINE, BAND, CURSOR = "#1f5fa8", "#c62828", "#d98200"
MARKS = {1: "#e08a00", 2: "#c62828"}  # by the state of a place: near, met
PAD = 0.04  # of a row's range, beyond the limits


class Row(NamedTuple):
    """An axis: what it is called, its unit, its limits (infinite: none), its values."""

    name: str
    unit: str
    lower: float
    upper: float
    values: Array


class JointChart(QtGui.QWidget):
    """``show_rows`` shows them. A click or drag tells ``chosen(place)``, from 0."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("jointChart")
        self.rows: list[Row] = []
        self.times = np.zeros(0)
        self.states: Sequence[int] = ()
        self.place = 0
        self.chosen = lambda place: None
        self.picture: Image | None = None  # all but the cursor

    def show_rows(self, times: Array, rows: Sequence[Row], states: Sequence[int]) -> None:
        """``times``: (n,) s; ``states``: of each place, 0 free."""
        self.times, self.rows, self.states = np.asarray(times, dtype=float), list(rows), states
        self.place, self.picture = 0, None
        self.setMinimumHeight(TOP + BOTTOM + ROW * len(self.rows))
        self.update()

    def set_place(self, place: int) -> None:
        """Puts the cursor there."""
        self.place = place
        self.update()

    def x(self, time: float) -> float:
        """Pixel of a time."""
        return LEFT + (self.width() - LEFT - RIGHT) * time / max(float(self.times[-1]), 1e-9)

    def at(self, x: float) -> int:
        """The place that is drawn nearest to a pixel."""
        share = (x - LEFT) / max(self.width() - LEFT - RIGHT, 1)
        return int(np.argmin(np.abs(self.times - share * self.times[-1])))

    def mousePressEvent(self, event: QtEvent) -> None:
        self.mouseMoveEvent(event)

    def mouseMoveEvent(self, event: QtEvent) -> None:
        if event.buttons() & QtCore.Qt.LeftButton and len(self.times):
            self.chosen(self.at(event.pos().x()))

    def resizeEvent(self, event: QtEvent) -> None:
        self.picture = None
        super().resizeEvent(event)

    def paintEvent(self, event: QtEvent) -> None:
        if not len(self.times):
            return
        if self.picture is None:
            ratio = self.devicePixelRatioF()
            self.picture = QtGui.QPixmap(self.size() * ratio)
            self.picture.setDevicePixelRatio(ratio)
            self.picture.fill(QtGui.QColor(theme().ground))
            painter = QtGui.QPainter(self.picture)
            self._draw(painter)
            painter.end()
        painter = QtGui.QPainter(self)
        painter.drawPixmap(0, 0, self.picture)
        painter.setPen(QtGui.QPen(QtGui.QColor(CURSOR), 2))
        x = round(self.x(self.times[self.place]))
        painter.drawLine(x, 0, x, self.height() - BOTTOM)
        painter.setPen(QtGui.QColor(theme().text))
        _small(painter)
        height = self._height()
        for k, row in enumerate(self.rows):
            value = row.values[self.place]
            text = (
                f"{figure(round(value, 1) + 0.0, '.1f')} {row.unit}"
                if math.isfinite(value)
                else "–"
            )
            painter.drawText(self._label(TOP + (k + 0.5) * height), text)
        painter.end()

    def _label(self, top: float) -> QtCore.QRect:
        return QtCore.QRect(4, round(top) - 1, LEFT - 8, 16)

    def _height(self) -> float:
        return (self.height() - TOP - BOTTOM) / max(len(self.rows), 1)

    def _draw(self, painter: Painter) -> None:
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        _small(painter)
        height = self._height()
        for k, row in enumerate(self.rows):
            self._draw_row(painter, TOP + k * height, height, row)
        for state, colour in MARKS.items():
            painter.setPen(QtGui.QPen(QtGui.QColor(colour), 3))
            for k in np.flatnonzero(np.asarray(self.states) == state).tolist():
                x = round(self.x(self.times[k]))
                painter.drawLine(x, 2, x, TOP - 3)
        painter.setPen(QtGui.QColor(theme().faint))
        text = f"0…{figure(float(self.times[-1]), '.4g')} s"
        box = QtCore.QRect(LEFT, self.height() - BOTTOM + 2, self.width() - LEFT - RIGHT, 14)
        painter.drawText(box, int(QtCore.Qt.AlignRight), text)

    def _draw_row(self, painter: Painter, top: float, height: float, row: Row) -> None:
        upper, lower = top + 3, top + height - 3
        low, high = limits(row)
        pad = PAD * (high - low)

        def y(value: float) -> float:
            return lower - (value - low + pad) / (high - low + 2 * pad) * (lower - upper)

        painter.setPen(QtGui.QColor(theme().text))
        painter.drawText(self._label(top + 5), row.name)
        right = self.width() - RIGHT
        painter.setPen(QtGui.QPen(QtGui.QColor(theme().grid), 1))
        if low < 0.0 < high:
            painter.drawLine(QtCore.QPointF(LEFT, y(0.0)), QtCore.QPointF(right, y(0.0)))
        painter.setPen(QtGui.QPen(readable(BAND), 1, QtCore.Qt.DashLine))
        for value in (row.lower, row.upper):
            if math.isfinite(value):
                painter.drawLine(QtCore.QPointF(LEFT, y(value)), QtCore.QPointF(right, y(value)))
        painter.setPen(QtGui.QPen(readable(LINE), 1.4))
        there = np.isfinite(row.values)
        for piece in np.split(np.arange(len(there)), np.flatnonzero(np.diff(there)) + 1):
            if len(piece) and there[piece[0]]:
                points = [QtCore.QPointF(self.x(self.times[k]), y(row.values[k])) for k in piece]
                painter.drawPolyline(QtGui.QPolygonF(points))


def _small(painter: Painter) -> None:
    font = painter.font()
    font.setPixelSize(LETTERS)
    painter.setFont(font)


def limits(row: Row) -> tuple[float, float]:
    """Lower and upper end of a row: its limits, or what its values need where it has none."""
    values = row.values[np.isfinite(row.values)]
    low = row.lower if math.isfinite(row.lower) else float(values.min(initial=0.0))
    high = row.upper if math.isfinite(row.upper) else float(values.max(initial=0.0))
    low = min(low, float(values.min(initial=low)))
    high = max(high, float(values.max(initial=high)))
    return (low, high) if high - low > 1e-6 else (low - 1.0, high + 1.0)
