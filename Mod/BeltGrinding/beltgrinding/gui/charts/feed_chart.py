"""Feeds and forces along the programs, as they were and as planned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ...objects.kinds import DocumentObject
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Array, Painter, QtEvent, known
from ..common.theme import readable, theme
from .strip_chart import envelope

LEFT, RIGHT, TOP, BOTTOM = 6, 6, 18, 34  # pixels
ROW = 88  # pixels, least height of a row
OLD, NEW = "#8a9099", "#1f5fa8"
CHOSEN = "#d98200"


class FeedChart(QtGui.QWidget):
    """``show_plan(obj)``: a Plan object. Dragging chooses motions: ``chosen`` is (first, last) from 0, or None, and
    ``changed()`` tells."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("feedChart")
        self.setMouseTracking(True)
        self.along = np.zeros(0)
        self.rows: list[tuple[str, str, Array, Array]] = []  # name, unit, before, as planned
        self.chosen: tuple[int, int] | None = None
        self.begun: int | None = None  # the motion at which the mouse was pressed
        self.changed = lambda: None
        self.of = np.zeros(0, dtype=int)  # the path of each motion
        self.names: list[str] = []  # of the paths
        self.lines: list[Sequence[int]] = []  # of each path's source; [] without one

    def show_plan(self, obj: DocumentObject) -> None:
        """Shows what a Plan object holds."""
        self.along, self.rapid = np.array(obj.Along), np.array(obj.Rapid, dtype=bool)
        self.of = np.array(obj.PathOf, dtype=int)
        self.chosen = self.begun = None  # a drag that goes on was of the plan before
        document = obj.Document
        paths = [document.getObject(name) for name in obj.Paths]
        self.names = [name if path is None else path.Label for name, path in zip(obj.Paths, paths)]
        self.lines = [[] if path is None or not path.Source else path.Lines for path in paths]
        self.rows = [
            (
                translate("BeltGrinding", "Feed"),
                "mm/s",
                np.array(obj.OldFeeds),
                np.array(obj.NewFeeds),
            )
        ]
        old, new = np.array(obj.OldForces), np.array(obj.NewForces)
        if (old != new).any():
            self.rows.append((translate("BeltGrinding", "Force"), "N", old, new))
        self.setMinimumHeight(BOTTOM + len(self.rows) * ROW)
        self.update()

    def x(self, along: Any) -> Any:
        """Pixels of places on the way, mm."""
        whole = max(self.along[-1], 1e-9) if len(self.along) else 1.0
        return LEFT + np.asarray(along) / whole * (self.width() - LEFT - RIGHT)

    def at(self, x: float) -> int | None:
        """The motion that is drawn there, from 0; None without one."""
        if not len(self.along):
            return None
        share = (x - LEFT) / max(self.width() - LEFT - RIGHT, 1)
        found = np.searchsorted(self.along, np.clip(share, 0.0, 1.0) * self.along[-1])
        return int(min(found, len(self.along) - 1))

    def text(self, k: int) -> str:
        """What is told of a motion."""
        own = k - int(np.argmax(self.of == self.of[k]))
        told = translate("BeltGrinding", "{}, pose {}").format(self.names[self.of[k]], own + 1)
        lines = self.lines[self.of[k]]
        if own < len(lines) and lines[own]:
            told += translate("BeltGrinding", ", line {}").format(lines[own])
        if self.rapid[k]:
            return told + "\n" + translate("BeltGrinding", "positioning: nothing is ground")
        for name, unit, old, new in self.rows:
            told += f"\n{name}: {figure(old[k], '.4g')} → {figure(new[k], '.4g')} {unit}"
        return told

    def event(self, event: QtEvent) -> bool:
        if event.type() == QtCore.QEvent.ToolTip:
            k = self.at(event.pos().x())
            QtGui.QToolTip.showText(event.globalPos(), "" if k is None else self.text(k), self)
            return True
        return super().event(event)

    def mousePressEvent(self, event: QtEvent) -> None:
        self.begun = self.at(event.pos().x())
        self.chosen = None
        self.changed()
        self.update()

    def mouseMoveEvent(self, event: QtEvent) -> None:
        if event.buttons() & QtCore.Qt.LeftButton and self.begun is not None:
            end = self.at(event.pos().x())
            if end is not None and end != self.begun:
                self.chosen = min(self.begun, end), max(self.begun, end)
                self.changed()
                self.update()

    def paintEvent(self, event: QtEvent) -> None:
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        painter.fillRect(self.rect(), QtGui.QColor(theme().ground))
        if not self.rows or len(self.along) < 2:
            return
        height = (self.height() - BOTTOM) / len(self.rows)
        if self.chosen is not None:
            a, b = (float(self.x(self.along[max(k, 0)])) for k in self._ends())
            shade = QtGui.QColor(CHOSEN)
            shade.setAlpha(70)
            painter.fillRect(QtCore.QRectF(a, 0.0, max(b - a, 1.0), self.height() - BOTTOM), shade)
        for k, row in enumerate(self.rows):
            self._draw_row(painter, k * height, height, *row)
        x, y = LEFT, self.height() - BOTTOM + 13
        for text, colour in (
            (translate("BeltGrinding", "before"), OLD),
            (translate("BeltGrinding", "planned"), NEW),
        ):
            painter.setPen(QtGui.QPen(readable(colour), 2))
            painter.drawLine(QtCore.QPointF(x, y - 4), QtCore.QPointF(x + 14, y - 4))
            painter.drawText(QtCore.QPointF(x + 18, y), text)
            x += 30 + painter.fontMetrics().horizontalAdvance(text)
        painter.setPen(QtGui.QColor(theme().faint))
        text = translate("BeltGrinding", "way of the wheel, 0…{:.4g} mm").format(self.along[-1])
        painter.drawText(QtCore.QPointF(LEFT, self.height() - 5), text)

    def _ends(self) -> tuple[int, int]:
        first, last = known(self.chosen)
        return first - 1, last

    def _draw_row(
        self,
        painter: Painter,
        top: float,
        height: float,
        name: str,
        unit: str,
        old: Array,
        new: Array,
    ) -> None:
        moving = ~self.rapid
        most = max(float(np.max(np.where(moving, np.maximum(old, new), 0.0))), 1e-9)
        upper, lower = top + TOP, top + height - 4
        painter.setPen(QtGui.QColor(theme().grid))
        for share in (0.0, 0.5, 1.0):
            y = lower - share * (lower - upper)
            painter.drawLine(QtCore.QPointF(LEFT, y), QtCore.QPointF(self.width() - RIGHT, y))
        painter.setPen(QtGui.QColor(theme().text))
        title = f"{name}, 0…{figure(most, '.4g')} {unit}"
        painter.drawText(QtCore.QPointF(LEFT, top + TOP - 5), title)
        for values, colour, width in ((old, OLD, 1.0), (new, NEW, 1.4)):
            painter.setPen(QtGui.QPen(readable(colour), width))
            for way, steps in self._pieces(values):
                px, py = envelope(way, steps, self.along[-1] or 1.0, self.width() - LEFT - RIGHT)
                py = lower - py / most * (lower - upper)
                points = [QtCore.QPointF(LEFT + a, b) for a, b in zip(px.tolist(), py.tolist())]
                painter.drawPolyline(QtGui.QPolygonF(points))

    def _pieces(self, values: Array) -> Iterator[tuple[Array, Array]]:
        """(way mm, values) as stairs, one for each row of motions that grind."""
        begin = np.append(0.0, self.along[:-1])
        grinding = np.flatnonzero(~self.rapid & (self.along > begin))
        if not len(grinding):
            return
        for piece in np.split(grinding, np.flatnonzero(np.diff(grinding) > 1) + 1):
            way = np.stack([begin[piece], self.along[piece]], axis=1).ravel()
            yield way, np.repeat(values[piece], 2)
