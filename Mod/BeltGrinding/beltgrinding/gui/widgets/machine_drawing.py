"""A small drawing of a belt machine, from its side and to scale: what presses, the belt's way, the work on it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ...geometry import free_run
from ...objects import belt_machine as machines
from ...objects.kinds import DocumentObject
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Array, Colour, Json, Painter, Polygon, QtEvent, QtPoint
from ..common.theme import readable, theme
from ..scene import belt_shapes

HEIGHT = 132  # pixels
EDGE = 6.0  # pixels round the drawing
BELT, RUBBER, METAL = "#7a4026", "#3a3f47", "#9aa1ab"
THICKEST = 0.5  # of the height that layers may take, so that the rest is seen
ARROW = 5.0  # pixels
THICK = 3.0  # pixels that the belt is drawn thick
SMALL = 0.6  # of the size that a wheel has, so that its runs are seen


class MachineDrawing(QtGui.QWidget):
    """Draws a BeltMachine of the document as its properties are now; ``update()`` after they have changed."""

    def __init__(self, machine: DocumentObject) -> None:
        super().__init__()
        self.machine = machine
        self.setObjectName("machineDrawing")
        self.setMinimumWidth(160)
        self.setFixedHeight(HEIGHT)
        self.setToolTip(translate("BeltGrinding", "From the side, to scale; the work is above"))

    def paintEvent(self, _: QtEvent) -> None:
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        painter.fillRect(self.rect(), QtGui.QColor(theme().ground))
        try:
            (self._wheel if self.machine.Kind in machines.WHEELS else self._belt)(painter)
        finally:
            painter.end()

    def _wheel(self, painter: Painter) -> None:
        radius = max(self.machine.WheelRadius.Value, 1e-3)
        # The work's mound takes a quarter of the height above the wheel.
        scale = (self.height() - 2 * EDGE - 34) / (2.0 * radius)
        middle = QtCore.QPointF(0.27 * self.width(), self.height() - EDGE - radius * scale)
        rim = min(self.machine.RimThickness.Value, radius) if self._has_rim() else 0.0
        outer = radius * scale
        if self.machine.Kind == machines.SMALL_WHEEL:
            scale *= SMALL
            outer *= SMALL
            middle.setY(middle.y() - (1.0 / SMALL - 1.0) * outer)
            self._runs(painter, middle, outer, scale)
        self._disc(painter, middle, outer, BELT)
        self._disc(painter, middle, outer - 2.5, RUBBER if rim else METAL)
        self._disc(painter, middle, max(outer - max(rim * scale, 2.5), 0.0), METAL)
        top = QtCore.QPointF(middle.x(), middle.y() - outer)
        self._work(painter, top)
        self._travel(painter, QtCore.QPointF(middle.x() + 0.62 * outer + 14, top.y() + 6))
        lines = [f"R {figure(radius, 'g')} mm", f"{figure(self.machine.WheelWidth.Value, 'g')} mm"]
        lines[1] = translate("BeltGrinding", "width {}").format(lines[1])
        if rim:
            lines.append(translate("BeltGrinding", "rim {} mm").format(figure(rim, "g")))
        self._texts(painter, middle.x() + outer + 8, middle.y() - 14, lines)

    def _runs(self, painter: Painter, middle: QtPoint, radius: float, scale: float) -> None:
        """The belt's two runs, as far as the drawing goes."""
        machine = self.machine
        x, y = 0.5 * machine.ForkSpread.Value * scale, machine.ForkLength.Value * scale
        square = x * x + y * y
        if square <= radius * radius:
            return  # a fork that ends within its wheel, which the panel refuses
        root = math.sqrt(square - radius * radius)
        across, down = (
            radius * (radius * x + root * y) / square,
            radius * (radius * y - root * x) / square,
        )
        painter.save()
        painter.setClipRect(self.rect().adjusted(0, 0, 0, -3))
        painter.setPen(QtGui.QPen(readable(BELT), 2.5))
        for side in (-1.0, 1.0):
            painter.drawLine(
                QtCore.QPointF(middle.x() + side * across, middle.y() + down),
                QtCore.QPointF(middle.x() + side * x, middle.y() + y),
            )
        painter.restore()

    def _has_rim(self) -> bool:
        return self.machine.Compliance in (
            "wheel_rim",
            "bonded_layer",
            "elastic_foundation",
            "surrogate",
        )

    def _belt(self, painter: Painter) -> None:
        machine, thick = self.machine, THICK
        if machine.Kind == machines.PLATEN and machine.PlatenRadius.Value > 0.0:
            job = belt_shapes.as_job(machine)
            if free_run.arc(job)[0] > 0.0:
                return self._bent(painter, job)
        length = max(machine.RunLength.Value, 1e-3)
        radius = machine.RollerRadius.Value
        whole = length + 2.0 * max(radius, 0.05 * length)
        scale = (self.width() - 2 * EDGE - 4) / whole
        high = self.height() - 2 * EDGE - 80
        roll = max(min(radius * scale, 0.5 * high), 2.0)
        left = EDGE + 2 + max(radius, 0.05 * length) * scale
        top = EDGE + 46.0
        ends = left, left + length * scale
        at = QtCore.QPointF(left + (0.5 * length + machine.RunPosition.Value) * scale, top)
        if machine.Kind == machines.PLATEN:
            self._plate(painter, at, scale, top + thick, 2.0 * roll - 2 * thick)
        for x in ends:
            self._disc(painter, QtCore.QPointF(x, top + roll), roll - 0.5 * thick, METAL)
        loop = QtCore.QRectF(ends[0] - roll, top, ends[1] - ends[0] + 2 * roll, 2 * roll)
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.setPen(QtGui.QPen(readable(BELT), thick))
        painter.drawRoundedRect(loop, roll, roll)
        self._work(painter, at)
        self._travel(painter, QtCore.QPointF(ends[1] - 30, top - 9))
        self._say(painter, loop.bottom() + 3)

    def _bent(self, painter: Painter, job: Json) -> None:
        """A belt over a curved platen, of a job's belt_machine: the parts as they are in the cell, one scale for all."""
        loop = belt_shapes.outline(job)
        low, high = loop.min(axis=0), loop.max(axis=0)
        top, room = EDGE + 46.0, self.height() - 2 * EDGE - 80
        across = (self.width() - 2 * EDGE - 4) / max(high[0] - low[0], 1e-3)
        scale = min(across, room / max(high[1] - low[1], 1e-3))
        middle = 0.5 * self.width() - 0.5 * (low[0] + high[0]) * scale

        def polygon(points: Any) -> Polygon:
            places = [
                QtCore.QPointF(middle + x * scale, top + (high[1] - z) * scale) for x, z in points
            ]
            return QtGui.QPolygonF(places)

        painter.setPen(QtGui.QPen(QtGui.QColor(METAL), 1))
        solids = [(RUBBER, solid) for solid in free_run.layers(job)]
        for colour, (points, _) in [*solids, (METAL, free_run.plate(job))]:
            upper, _, lower, _ = np.split(points[:, [0, 2]], 4)
            painter.setBrush(QtGui.QColor(colour))
            painter.drawPolygon(polygon(np.concatenate([upper, lower[::-1]])))
        radius = job["free_run"]["roller_radius_mm"] * scale
        if radius > 0.0:
            for axis in free_run.roller_axes(job):
                self._disc(painter, polygon([axis])[0], radius, METAL)
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.setPen(QtGui.QPen(readable(BELT), THICK))
        painter.drawPolyline(polygon(loop))
        self._work(painter, polygon([[0.0, 0.0]])[0])
        self._travel(painter, QtCore.QPointF(self.width() - EDGE - 34, top - 9))
        self._say(painter, top + (high[1] - low[1]) * scale + 5)

    def _say(self, painter: Painter, low: float) -> None:
        """The belt's sizes, below."""
        machine = self.machine
        wide = translate("BeltGrinding", "width {}").format(
            f"{figure(machine.RunWidth.Value, 'g')} mm"
        )
        said = f"{figure(machine.RunLength.Value, 'g')} mm · {figure(machine.RunTension, 'g')} N/mm\n{wide}"
        painter.setPen(QtGui.QColor(theme().text))
        box = QtCore.QRectF(EDGE, low, self.width() - 2 * EDGE, self.height() - low)
        painter.drawText(box, QtCore.Qt.AlignHCenter | QtCore.Qt.AlignTop, said)

    def _plate(self, painter: Painter, at: QtPoint, scale: float, top: float, room: float) -> None:
        machine = self.machine
        half = 0.5 * machine.PlatenLength.Value * scale
        layers = [layer["thickness_mm"] * scale for layer in machines.layers_of(machine)]
        whole = sum(layers)
        # Thin layers must be seen, and thick ones leave room for the plate.
        layers = [max(one, 2.0) * min(1.0, THICKEST * room / max(whole, 1e-9)) for one in layers]
        painter.setPen(QtCore.Qt.NoPen)
        for thick in reversed(layers):
            painter.setBrush(QtGui.QColor(RUBBER))
            painter.drawRect(QtCore.QRectF(at.x() - half, top, 2 * half, thick))
            painter.setPen(QtGui.QPen(QtGui.QColor(METAL), 1))
            top += thick
        plate = max(min(machine.PlateThickness.Value * scale, room - sum(layers)), 2.0)
        painter.setBrush(QtGui.QColor(METAL))
        painter.setPen(QtCore.Qt.NoPen)
        painter.drawRect(QtCore.QRectF(at.x() - half, top, 2 * half, plate))

    def _disc(self, painter: Painter, middle: QtPoint, radius: float, colour: Colour) -> None:
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(readable(colour) if colour == BELT else QtGui.QColor(colour))
        painter.drawEllipse(middle, radius, radius)

    def _work(self, painter: Painter, at: QtPoint) -> None:
        """A round piece of work that touches the belt at a point."""
        wide, high = 34.0, 26.0
        path = QtGui.QPainterPath()
        path.moveTo(at.x() - 0.5 * wide, at.y() - high)
        path.cubicTo(
            *(at.x() - 0.5 * wide, at.y() - 2.0, at.x() + 0.5 * wide, at.y() - 2.0),
            *(at.x() + 0.5 * wide, at.y() - high),
        )
        painter.setBrush(QtGui.QColor("#5b86c2"))
        painter.setPen(QtCore.Qt.NoPen)
        painter.drawPath(path.translated(0.0, 6.0))
        painter.setPen(QtGui.QColor(theme().faint))
        box = QtCore.QRectF(at.x() - 60, at.y() - high - 10, 120, 14)
        painter.drawText(box, QtCore.Qt.AlignCenter, translate("BeltGrinding", "work"))

    def _travel(self, painter: Painter, at: QtPoint) -> None:
        """An arrow in the belt's travel."""
        painter.setPen(QtGui.QPen(QtGui.QColor(theme().text), 1.5))
        end = QtCore.QPointF(at.x() + 24, at.y())
        painter.drawLine(at, end)
        for side in (-1.0, 1.0):
            painter.drawLine(end, QtCore.QPointF(end.x() - ARROW, end.y() + side * 0.7 * ARROW))

    def _texts(self, painter: Painter, x: float, y: float, lines: Iterable[str]) -> None:
        painter.setPen(QtGui.QColor(theme().text))
        step = math.ceil(painter.fontMetrics().height())
        for k, line in enumerate(lines):
            painter.drawText(QtCore.QPointF(x, y + k * step), line)
