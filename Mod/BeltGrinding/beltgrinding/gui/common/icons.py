"""Icons of the workbench: SVG files in Resources/icons."""

import FreeCADGui as Gui

from ...base.resources import resources


def icon(name):
    """Path of the icon ``name``, as FreeCAD takes it."""
    return str(resources() / "icons" / f"{name}.svg")


def qicon(name):
    """The icon as QIcon, drawn by FreeCAD: Qt draws no SVG itself where its plugin is missing."""
    return Gui.getIcon(icon(name))
