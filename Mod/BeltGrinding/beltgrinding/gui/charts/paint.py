"""Charts of ``charts.model`` painted in a widget.

A widget paints the model itself instead of showing its SVG: to pan or to zoom an SVG would have to be
made anew for every picture, which takes 0.2 s. Here the points stay in Qt's own polygons in the data's
units, and a movement of the mouse is another matrix of the painter.
"""

from ...charts.model import Band
from ..common.compat import QtCore, QtGui

KEY = 22  # pixels of a line's sample in the legend
# Points of a solid line that are painted at once: Qt's time grows faster than their number.
RUN = 64


def pen(line):
    """The pen of a ``Line``: as wide on the screen whatever the matrix."""
    found = QtGui.QPen(QtGui.QColor(line.colour), line.width)
    found.setCosmetic(True)
    found.setCapStyle(QtCore.Qt.FlatCap if line.dash else QtCore.Qt.RoundCap)
    if line.dash:
        found.setDashPattern([part / line.width for part in line.dash])
    return found


def brush(band):
    """The brush of a ``Band``."""
    colour = QtGui.QColor(band.colour)
    colour.setAlphaF(band.opacity)
    return QtGui.QBrush(colour)


def polygon(points):
    """Qt's polygon of (n, 2) points."""
    return QtGui.QPolygonF([QtCore.QPointF(x, y) for x, y in points.tolist()])


def runs(line):
    """A line in parts of ``RUN`` points, each beginning where the one before ends."""
    return [line[k : k + RUN + 1] for k in range(0, max(len(line) - 1, 1), RUN)]


class Drawing:
    """The bands and lines of a chart, ready to be painted."""

    def __init__(self, chart):
        self.parts = []
        for series in chart.series:
            band = isinstance(series, Band)
            points = series.polygons if band else series.lines
            if not band and not series.dash:
                points = [part for line in points for part in runs(line)]
            self.parts.append((series, band, [polygon(part) for part in points]))

    def paint(self, painter, matrix, area):
        """Paints what lies in ``area``; ``matrix``: from the data to pixels."""
        painter.save()
        painter.setClipRect(area)
        painter.setTransform(matrix, True)
        for series, band, shapes in self.parts:
            painter.setPen(QtGui.QPen(QtCore.Qt.NoPen) if band else pen(series))
            painter.setBrush(brush(series) if band else QtGui.QBrush())
            for shape in shapes:
                painter.drawPolygon(shape) if band else painter.drawPolyline(shape)
        painter.restore()


def legend(painter, chart, left, middle, labels, ink):
    """A row of samples and ``labels`` (by the series' key) from ``left`` on, its middle's height."""
    metrics = QtGui.QFontMetrics(painter.font())
    for series in chart.series:
        if isinstance(series, Band):
            box = QtCore.QRectF(left, middle - 5, KEY, 10)
            painter.fillRect(box, QtGui.QColor(series.colour))
        else:
            painter.setPen(pen(series))
            painter.drawLine(QtCore.QPointF(left, middle), QtCore.QPointF(left + KEY, middle))
        painter.setPen(ink)
        painter.drawText(QtCore.QPointF(left + KEY + 5, middle + 4), labels[series.key])
        left += 2 * KEY + metrics.boundingRect(labels[series.key]).width()
