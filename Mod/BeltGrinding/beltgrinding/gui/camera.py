"""The 3D view's camera."""

import FreeCAD
import FreeCADGui as Gui


def look_at(normal):
    """Turns the view to look against ``normal`` (FreeCAD.Vector, document's frame), upright where it
    can, and fits everything into it.
    """
    view = Gui.ActiveDocument.ActiveView
    upright = FreeCAD.Vector(0, 0, 1)
    if normal.getAngle(upright) < 0.05 or normal.getAngle(-upright) < 0.05:
        upright = FreeCAD.Vector(0, 1, 0)
    side = upright.cross(normal).normalize()
    animated = view.isAnimationEnabled()
    view.setAnimationEnabled(False)
    view.setCameraOrientation(FreeCAD.Rotation(side, upright, normal, "ZXY").Q)
    view.fitAll()
    Gui.updateGui()
    view.setAnimationEnabled(animated)
