"""The plot of a cross-section as a widget: wheel zooms, drag pans, double click shows everything."""

from __future__ import annotations

import math

import numpy as np

from ...inspection import section_plot
from ...objects.preferences import deviation_unit
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure, length_text
from ..common.kinds import (
    Array,
    Colour,
    Json,
    Painter,
    Pen,
    Polygon,
    QtEvent,
    QtPoint,
    Rectangle,
    known,
)
from ..common.theme import readable, theme

LEFT, RIGHT, TOP, BOTTOM = 64, 12, 28, 40  # pixels around the plot
NEAR = 40  # pixels around the mouse in which a point is shown
ZOOM = 1.2  # per step of the wheel
LABELS = {  # of section_plot.LOOKS
    "tolerance": translate("BeltGrinding", "tolerance"),
    "uncertainty": translate("BeltGrinding", "95 % uncertainty"),
    "design": translate("BeltGrinding", "design"),
    "stock": translate("BeltGrinding", "stock"),
    "ground": translate("BeltGrinding", "ground"),
}


class SectionChart(QtGui.QWidget):
    """Draws what ``section_plot.plot`` gives. Data in mm; ``window`` is the part of it that is seen."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("sectionPlot")
        self.setMinimumSize(320, 160)
        self.setMouseTracking(True)
        self.plot: Json | None = None
        self.section: Json | None = None
        self.window: list[float] | None = None  # x and y from, x and y to
        self.hovered: tuple[int, int] | None = None  # piece and its point
        self.dragged: QtPoint | None = None  # where the mouse was
        self.zoomed = False

    def show_plot(self, section: Json | None, plot: Json | None) -> None:
        """Shows a section, None: that there is none; the zoom stays when its kind stays."""
        same = self.plot is not None and plot is not None and self.plot["mode"] == plot["mode"]
        self.section, self.plot, self.hovered = section, plot, None
        if not same or not self.zoomed:
            self.fit()
        self.update()

    def fit(self) -> None:
        """Shows everything."""
        self.zoomed = False
        self.window = list(self.plot["bounds"]) if self.plot else None
        self.update()

    # Data and pixels

    def area(self) -> Rectangle:
        return QtCore.QRectF(
            LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), max(self.height() - TOP - BOTTOM, 1)
        )

    def scales(self) -> tuple[float, float, float, float]:
        """(x0, y0 of the lower left in mm, pixels per mm in x and y)."""
        x0, y0, x1, y1 = known(self.window)
        area = self.area()
        x, y = area.width() / max(x1 - x0, 1e-9), area.height() / max(y1 - y0, 1e-9)
        if known(self.plot)["equal"]:
            x = y = min(x, y)
            x0 = 0.5 * (x0 + x1) - 0.5 * area.width() / x
            y0 = 0.5 * (y0 + y1) - 0.5 * area.height() / y
        return x0, y0, x, y

    def pixels(self, points: Array) -> Array:
        """(n, 2) pixels of (n, 2) mm."""
        x0, y0, x, y = self.scales()
        area = self.area()
        left, bottom = area.left() - x0 * x, area.bottom() + y0 * y
        return np.column_stack([left + points[:, 0] * x, bottom - points[:, 1] * y])

    def _polygon(self, points: Array) -> Polygon:
        return QtGui.QPolygonF([QtCore.QPointF(x, y) for x, y in self.pixels(points).tolist()])

    # Painting

    def paintEvent(self, event: QtEvent) -> None:
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        painter.fillRect(self.rect(), QtGui.QColor(theme().ground))
        if self.plot is None:
            painter.setPen(QtGui.QColor(theme().faint))
            painter.drawText(
                self.rect(), QtCore.Qt.AlignCenter, translate("BeltGrinding", "No section")
            )
            painter.end()
            return
        self._grid(painter)
        painter.save()
        painter.setClipRect(self.area())
        for layer in self.plot["layers"]:
            if "polygons" in layer:
                painter.setPen(QtCore.Qt.NoPen)
                painter.setBrush(_band(layer))
                for polygon in layer["polygons"]:
                    painter.drawPolygon(self._polygon(polygon))
                continue
            painter.setPen(_pen(layer))
            for line in layer["lines"]:
                painter.drawPolyline(self._polygon(line))
        painter.restore()
        self._legend(painter)
        self._value(painter)
        painter.end()

    def _grid(self, painter: Painter) -> None:
        area, (x0, y0, x, y) = self.area(), self.scales()
        width, height = area.width() / x, area.height() / y
        grey, dark = QtGui.QColor(theme().grid), QtGui.QColor(theme().text)
        values, decimals = section_plot.ticks(x0, x0 + width, max(int(area.width() / 90), 2))
        for value in values:
            at = area.left() + (value - x0) * x
            painter.setPen(grey)
            painter.drawLine(QtCore.QPointF(at, area.top()), QtCore.QPointF(at, area.bottom()))
            painter.setPen(dark)
            box = QtCore.QRectF(at - 40, area.bottom() + 3, 80, 16)
            painter.drawText(box, QtCore.Qt.AlignCenter, figure(value + 0.0, f".{decimals}f"))
        size = self.height_unit()
        low, high = y0 / size, (y0 + height) / size
        values, decimals = section_plot.ticks(low, high, max(int(area.height() / 45), 2))
        for value in values:
            at = area.bottom() - (value * size - y0) * y
            painter.setPen(grey)
            painter.drawLine(QtCore.QPointF(area.left(), at), QtCore.QPointF(area.right(), at))
            painter.setPen(dark)
            box = QtCore.QRectF(0, at - 9, area.left() - 5, 18)
            right = QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter
            painter.drawText(box, int(right), figure(value + 0.0, f".{decimals}f"))
        painter.setPen(dark)
        box = QtCore.QRectF(area.left(), area.bottom() + 20, area.width(), 18)
        painter.drawText(box, QtCore.Qt.AlignCenter, self._x_label())
        painter.setPen(QtGui.QColor(theme().faint))
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawRect(area)

    def height_unit(self) -> float:
        """What the upright axis counts in, mm: the outline's true shape stays in mm."""
        return deviation_unit().size if self._unrolled() else 1.0

    def _unrolled(self) -> bool:
        return bool(known(self.plot)["mode"] == section_plot.UNROLLED)

    def _x_label(self) -> str:
        if self._unrolled():
            text = translate("BeltGrinding", "arc length, mm; upright: height above the design, {}")
            return text.format(deviation_unit().symbol)
        factor = figure(known(self.plot)["exaggeration"], "g")
        return translate("BeltGrinding", "in the plane, mm; heights ×{}").format(factor)

    def _legend(self, painter: Painter) -> None:
        x, metrics = LEFT, QtGui.QFontMetrics(painter.font())
        for layer in known(self.plot)["layers"]:
            text = LABELS[layer["key"]]
            if "polygons" in layer:
                painter.fillRect(QtCore.QRectF(x, 9, 22, 10), _band(layer))
            else:
                painter.setPen(_pen(layer))
                painter.drawLine(QtCore.QPointF(x, 14), QtCore.QPointF(x + 22, 14))
            painter.setPen(QtGui.QColor(theme().text))
            painter.drawText(QtCore.QPointF(x + 27, 18), text)
            x += 44 + metrics.boundingRect(text).width()

    def _value(self, painter: Painter) -> None:
        if self.hovered is None:
            return
        piece, k = self.hovered
        at = self.pixels(known(self.plot)["ground"][piece][k : k + 1])[0]
        painter.setPen(QtGui.QPen(QtGui.QColor("white"), 1.5))
        painter.setBrush(QtGui.QColor(section_plot.LOOKS["ground"][1]))
        painter.drawEllipse(QtCore.QPointF(*at), 4.5, 4.5)
        text = self.value_text(piece, k)
        metrics = QtGui.QFontMetrics(painter.font())
        lines = text.split("\n")
        width = max(metrics.boundingRect(line).width() for line in lines) + 14
        height = metrics.height() * len(lines) + 8
        x = min(at[0] + 12, self.width() - width - 2)
        y = min(max(at[1] - height - 10, 2), self.height() - height - 2)
        box = QtCore.QRectF(x, y, width, height)
        painter.setPen(QtGui.QColor(theme().faint))
        painter.setBrush(QtGui.QColor(theme().ground))
        painter.drawRoundedRect(box, 3, 3)
        painter.setPen(QtGui.QColor(theme().text))
        painter.drawText(box.adjusted(7, 4, -7, -4), int(QtCore.Qt.AlignLeft), text)

    def value_text(self, piece: int, k: int) -> str:
        """What the plot says of point ``k`` of a piece."""
        one = known(self.section)["pieces"][piece]
        x, y, z = one["point"][k]
        lines = [
            translate("BeltGrinding", "Face {}, {:.2f} mm along").format(
                one["face"] + 1, one["s"][k]
            ),
            f"({figure(x, '.2f')}, {figure(y, '.2f')}, {figure(z, '.2f')})",
            translate("BeltGrinding", "deviation {}").format(length_text(one["height"][k], 1)),
            translate("BeltGrinding", "stock {}, removed {}").format(
                length_text(one["stock_height"][k], 1, ""),
                length_text(one["stock_height"][k] - one["height"][k], 1, ""),
            ),
        ]
        if "height_sd" in one:
            text = translate("BeltGrinding", "uncertainty (1 sd) {}")
            lines.append(text.format(length_text(one["height_sd"][k], 1, "")))
        return "\n".join(lines)

    # Mouse

    def mouseMoveEvent(self, event: QtEvent) -> None:
        if self.plot is None:
            return
        at = _position(event)
        if self.dragged is not None and event.buttons() & QtCore.Qt.LeftButton:
            _, _, x, y = self.scales()
            dx, dy = (at.x() - self.dragged.x()) / x, (at.y() - self.dragged.y()) / y
            self.window = [v - d for v, d in zip(known(self.window), (dx, -dy, dx, -dy))]
            self.dragged, self.zoomed = at, True
        self.hovered = self.nearest(at.x(), at.y())
        self.update()

    def mousePressEvent(self, event: QtEvent) -> None:
        self.dragged = _position(event)

    def mouseReleaseEvent(self, event: QtEvent) -> None:
        self.dragged = None

    def mouseDoubleClickEvent(self, event: QtEvent) -> None:
        self.fit()

    def leaveEvent(self, event: QtEvent) -> None:
        self.hovered = None
        self.update()

    def wheelEvent(self, event: QtEvent) -> None:
        if self.plot is not None:
            at = event.position() if hasattr(event, "position") else event.pos()
            steps = event.angleDelta().y() / 120.0
            self.zoom(ZOOM**-steps, at.x(), at.y())
        event.accept()

    def zoom(self, factor: float, at_x: float, at_y: float) -> None:
        """Makes the seen part ``factor`` times as large, keeping what is at a pixel in its place."""
        area, (x0, y0, x, y) = self.area(), self.scales()
        fx, fy = x0 + (at_x - area.left()) / x, y0 + (area.bottom() - at_y) / y
        x1, y1 = x0 + area.width() / x, y0 + area.height() / y
        new = [fx + (v - fx) * factor for v in (x0, x1)], [fy + (v - fy) * factor for v in (y0, y1)]
        if min(new[0][1] - new[0][0], new[1][1] - new[1][0]) > 1e-6:
            self.window = [new[0][0], new[1][0], new[0][1], new[1][1]]
            self.zoomed = True
        self.update()

    def nearest(self, x: float, y: float) -> tuple[int, int] | None:
        """(piece, point) of the ground profile next to a pixel, or None. Unrolled, the way along the
        section counts alone.
        """
        best, found = math.inf, None
        for piece, line in enumerate(known(self.plot)["ground"]):
            if np.isnan(line).all():
                continue
            away = self.pixels(line) - (x, y)
            if self._unrolled():
                away[:, 1] = np.where(np.isnan(away[:, 1]), np.nan, 0.0)
            distance = np.hypot(*away.T)
            k = int(np.nanargmin(distance))
            if distance[k] < best:
                best, found = distance[k], (piece, k)
        return found if best < NEAR else None


def _position(event: QtEvent) -> QtPoint:
    return event.position() if hasattr(event, "position") else event.pos()


def _band(layer: Json) -> Colour:
    """The colour of an area: see-through, the more so on a dark ground."""
    colour = QtGui.QColor(layer["colour"])
    colour.setAlphaF(0.3 if theme().dark else 0.7)
    return colour


def _pen(layer: Json) -> Pen:
    pen = QtGui.QPen(readable(layer["colour"]), layer["width"])
    if layer["dash"]:
        pen.setDashPattern([value / layer["width"] for value in layer["dash"]])
    return pen
