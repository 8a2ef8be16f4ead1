"""The 3D view's camera."""

from __future__ import annotations

import math
from typing import Any

import FreeCAD
import FreeCADGui as Gui
from pivy import coin

from ...objects.kinds import Point, Vector
from ...objects.living import GONE
from ..common.compat import QtCore
from ..common.kinds import View3D

FLIGHT = 400  # ms
STEP = 25  # ms
_flights: list[Any] = []  # the one timer, once it is made


def look_at(normal: Vector) -> None:
    """Turns the view to look against ``normal`` (FreeCAD.Vector, document's frame), upright where it
    can, and fits everything into it.
    """
    view = Gui.ActiveDocument.ActiveView
    animated = view.isAnimationEnabled()
    view.setAnimationEnabled(False)
    view.setCameraOrientation(_upright(normal).Q)
    view.fitAll()
    Gui.updateGui()
    view.setAnimationEnabled(animated)


def _upright(normal: Vector, upright: Vector = FreeCAD.Vector(0, 0, 1)) -> Any:
    """Orientation (FreeCAD.Rotation) of a camera that looks against ``normal``, upright where it can."""
    if normal.getAngle(upright) < 0.05 or normal.getAngle(-upright) < 0.05:
        upright = FreeCAD.Vector(upright.y, upright.z, upright.x)
    side = upright.cross(normal).normalize()
    return FreeCAD.Rotation(side, upright, normal, "ZXY")


def fly_to(view: View3D, point: Point, normal: Point, size: float, up: Point = (0, 0, 1)) -> None:
    """Moves a 3D view's camera to look against ``normal`` at ``point`` (both three numbers, document's
    frame), with ``size`` mm in its height and ``up`` upwards; at once where the view's animation is off.
    """
    target, towards = FreeCAD.Vector(*point), FreeCAD.Vector(*normal).normalize()
    camera = view.getCameraNode()
    perspective = camera.isOfType(coin.SoPerspectiveCamera.getClassTypeId())
    distance = 5.0 * size
    if perspective:
        distance = 0.5 * size / math.tan(0.5 * camera.heightAngle.getValue())
    end = {
        "position": target + towards * distance,
        "turn": _upright(towards, FreeCAD.Vector(*up)),
        "distance": distance,
        "height": size,
    }
    start = {
        "position": FreeCAD.Vector(*camera.position.getValue().getValue()),
        "turn": FreeCAD.Rotation(*camera.orientation.getValue().getValue()),
        "distance": camera.focalDistance.getValue(),
        "height": end["height"] if perspective else camera.height.getValue(),
    }

    def put(share: float) -> None:
        camera.position = tuple(start["position"] * (1.0 - share) + end["position"] * share)
        camera.orientation = tuple(start["turn"].slerp(end["turn"], share).Q)
        for name in ("distance", "height"):
            start_value, end_value = start[name], end[name]
            value = start_value ** (1.0 - share) * end_value**share
            if name == "distance":
                camera.focalDistance = value
            elif not perspective:
                camera.height = value

    if _flights:
        _flights.pop().stop()
    if not view.isAnimationEnabled():
        return put(1.0)
    timer, clock = QtCore.QTimer(Gui.getMainWindow()), QtCore.QElapsedTimer()
    clock.start()

    def step() -> None:
        share = min(clock.elapsed() / FLIGHT, 1.0)
        try:
            put(share * share * (3.0 - 2.0 * share))
        except GONE:
            share = 1.0  # the view is closed
        if share >= 1.0:
            timer.stop()

    timer.timeout.connect(step)
    timer.start(STEP)
    _flights.append(timer)
