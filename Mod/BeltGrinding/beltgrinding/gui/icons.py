"""Icons of the workbench: SVG files in Resources/icons."""

from .. import resources


def icon(name):
    """Path of the icon ``name``, as FreeCAD takes it."""
    return str(resources() / "icons" / f"{name}.svg")
