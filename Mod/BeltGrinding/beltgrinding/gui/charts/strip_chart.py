"""A strip chart: rows of quantities against the time of a simulation, events marked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...objects.kinds import Event
from ..common import event_texts
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Array, Image, Painter, QtEvent
from ..common.theme import readable, theme

ROWS = (  # column of the steps, unit, colour
    ("force", "N", "#1f5fa8"),
    ("contact_area", "mm²", "#2b7a4b"),
    ("peak_pressure", "MPa", "#a63d2f"),
    ("removal_rate", "mm³/s", "#7a4fa3"),
)
LEFT, RIGHT, EVENTS = 200, 12, 14  # pixels: texts, border, the marks' band on top
ROW = 34  # pixels, least height of a row
NEAR = 5  # pixels
GAP = 1e-6  # s between two steps: nothing is ground there
MARK, CURSOR = "#d98200", "#d32f2f"


def texts() -> dict[str, str]:
    """What the columns are called, in the language of the window."""
    return {
        "force": translate("BeltGrinding", "Force"),
        "contact_area": translate("BeltGrinding", "Contact area"),
        "peak_pressure": translate("BeltGrinding", "Peak pressure"),
        "removal_rate": translate("BeltGrinding", "Removal rate"),
    }


class StripChart(QtGui.QWidget):
    """``chosen(time)`` tells of a click or a drag, in s."""

    def __init__(
        self, steps: Mapping[str, Array], events: Sequence[Event], duration: float
    ) -> None:
        super().__init__()
        self.setObjectName("stripChart")
        self.duration = max(duration, 1e-9)
        self.events = events
        self.time = 0.0
        self.chosen = lambda time: None
        self.lines = {name: staircase(steps, name) for name, *_ in ROWS}
        self.menu = QtGui.QMenu(self)
        self.texts = texts()
        for name, *_ in ROWS:
            action = self.menu.addAction(self.texts[name])
            action.setObjectName(name)
            action.setCheckable(True)
            action.setChecked(True)
            action.toggled.connect(lambda _: self._arrange())
        self.picture: Image | None = None  # all but the cursor, once it is drawn
        self._arrange()

    def rows(self) -> list[tuple[str, ...]]:
        """The rows that are shown, as in ROWS."""
        return [row for row, action in zip(ROWS, self.menu.actions()) if action.isChecked()]

    def set_time(self, time: float) -> None:
        self.time = time
        self.update()

    def x(self, time: float) -> float:
        """Pixel of a time."""
        return LEFT + (self.width() - LEFT - RIGHT) * time / self.duration

    def event_near(self, x: float) -> Event | None:
        """The event whose mark is drawn there, or None."""
        near = [(abs(self.x(e["time"]) - x), i) for i, e in enumerate(self.events)]
        distance, index = min(near, default=(NEAR + 1, 0))
        return self.events[index] if distance <= NEAR else None

    def contextMenuEvent(self, event: QtEvent) -> None:
        self.menu.popup(event.globalPos())

    def mousePressEvent(self, event: QtEvent) -> None:
        self.mouseMoveEvent(event)

    def mouseMoveEvent(self, event: QtEvent) -> None:
        if event.buttons() & QtCore.Qt.LeftButton:
            share = (event.pos().x() - LEFT) / max(self.width() - LEFT - RIGHT, 1)
            self.chosen(min(max(share, 0.0), 1.0) * self.duration)

    def event(self, event: QtEvent) -> bool:
        if event.type() == QtCore.QEvent.ToolTip:
            found = self.event_near(event.pos().x())
            text = "" if found is None else describe(found)
            QtGui.QToolTip.showText(event.globalPos(), text, self)
            return True
        return super().event(event)

    def resizeEvent(self, event: QtEvent) -> None:
        self.picture = None
        super().resizeEvent(event)

    def paintEvent(self, event: QtEvent) -> None:
        if self.picture is None:
            ratio = self.devicePixelRatioF()
            picture = QtGui.QPixmap(self.size() * ratio)
            picture.setDevicePixelRatio(ratio)
            picture.fill(QtGui.QColor(theme().ground))
            painter = QtGui.QPainter(picture)
            self._draw(painter)
            painter.end()
            self.picture = picture
        painter = QtGui.QPainter(self)
        painter.drawPixmap(0, 0, self.picture)
        painter.setPen(QtGui.QPen(QtGui.QColor(CURSOR), 2))
        x = round(self.x(self.time))
        painter.drawLine(x, 0, x, self.height())
        index = self._index()
        height = self._height()
        for k, (name, unit, colour) in enumerate(self.rows()):
            painter.setPen(readable(colour))
            value = (
                f"{figure(self.lines[name][1][index], '.4g')} {unit}" if index is not None else ""
            )
            box = QtCore.QRect(6, int(EVENTS + k * height + 0.5 * height), LEFT - 16, 16)
            painter.drawText(box, int(QtCore.Qt.AlignLeft), value)
        painter.end()

    def _index(self) -> int | None:
        times = next(iter(self.lines.values()))[0]
        return min(int(np.searchsorted(times, self.time)), len(times) - 1) if len(times) else None

    def _height(self) -> float:
        return (self.height() - EVENTS) / max(len(self.rows()), 1)

    def _arrange(self) -> None:
        self.setMinimumHeight(EVENTS + ROW * max(len(self.rows()), 1))
        self.picture = None
        self.update()

    def _draw(self, painter: Painter) -> None:
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        width, height = self.width() - LEFT - RIGHT, self._height()
        for k, (name, unit, colour) in enumerate(self.rows()):
            times, values = self.lines[name]
            top, bottom = EVENTS + k * height + 4, EVENTS + (k + 1) * height - 4
            most = float(values.max()) if len(values) else 0.0
            painter.setPen(QtGui.QColor(theme().grid))
            painter.drawLine(LEFT, round(bottom), LEFT + width, round(bottom))
            painter.setPen(QtGui.QColor(theme().text))
            label = f"{self.texts[name]}, 0…{figure(most, '.3g')} {unit}"
            painter.drawText(6, round(EVENTS + k * height + 0.5 * height - 2), label)
            x, y = envelope(times, values, self.duration, width)
            y = bottom - (bottom - top) * y / (most or 1.0)
            painter.setPen(QtGui.QPen(readable(colour), 1.2))
            points = [QtCore.QPointF(LEFT + a, b) for a, b in zip(x.tolist(), y.tolist())]
            painter.drawPolyline(QtGui.QPolygonF(points))
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(QtGui.QColor(MARK))
        for at in sorted({round(self.x(event["time"])) for event in self.events}):
            corners = ((at - 4, 1), (at + 4, 1), (at, EVENTS - 3))
            painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(*c) for c in corners]))


def staircase(steps: Mapping[str, Array], name: str) -> tuple[Array, Array]:
    """(times, values) of a quantity that is constant in every step, 0 between motions that grind."""
    begin = steps["time"] - 0.5 * steps["duration"]
    end = steps["time"] + 0.5 * steps["duration"]
    values = np.asarray(steps[name], dtype=float)
    gap = np.append(begin[1:] - end[:-1] > GAP, True) if len(begin) else np.zeros(0, dtype=bool)
    before = np.append(True, gap[:-1]) if len(gap) else gap
    times = np.stack([begin, begin, end, end], axis=1)
    heights = np.stack([np.zeros_like(values), values, values, np.zeros_like(values)], axis=1)
    kept = np.stack([before, np.ones_like(gap), np.ones_like(gap), gap], axis=1)
    return times[kept], heights[kept]


def envelope(times: Array, values: Array, duration: float, width: int) -> tuple[Array, Array]:
    """Points (x in pixels, value) that look like the line: least and largest value of every pixel."""
    x = times / duration * width
    if len(x) <= 2 * width or width < 1:
        return x, values
    begins = np.flatnonzero(np.diff(np.floor(x), prepend=-1.0))
    low, high = np.minimum.reduceat(values, begins), np.maximum.reduceat(values, begins)
    return np.repeat(np.floor(x[begins]), 2), np.stack([low, high], axis=1).ravel()


def describe(event: Event) -> str:
    """An event in two lines."""
    where = translate("BeltGrinding", "{:.2f} s, pose {}").format(event["time"], event["pose"] + 1)
    if event["line"]:
        where += translate("BeltGrinding", ", line {}").format(event["line"])
    return f"{event_texts.title(event)} ({where})\n{event_texts.message(event)}"
