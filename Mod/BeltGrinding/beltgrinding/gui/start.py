"""The start of the workbench, also where its compiled core or a Python package is missing."""

from __future__ import annotations

import importlib

import FreeCADGui as Gui

from ..base import messages
from ..engine import library as core_library
from .common.compat import translate
from .common.messages import tell
from .manual import Manual, help_key

PACKAGES = "numpy", "jsonschema"  # else missed only when a job is made; package.xml names them


def register() -> tuple[dict[str, list[str]], list[tuple[str, list[str]]]]:
    """Tells FreeCAD the commands; returns ({toolbar: names}, [(submenu, or "" for the menu itself, names)]).

    Where something that they need cannot be loaded, says so in the report view and in one message,
    and returns the manual alone. FreeCAD calls this when the workbench is first chosen.
    """
    Gui.addCommand(Manual.NAME, Manual())
    Gui.getMainWindow().installEventFilter(help_key)
    try:
        for name in PACKAGES:
            importlib.import_module(name)
        from . import commands
    except ImportError as error:
        tell(reason(error))
        return {}, [("", [Manual.NAME])]
    from .common.field_words import in_words  # not above: commands have said what is missing

    messages.show_keys_as(in_words)
    toolbars, menu = commands.register()
    return toolbars, [*menu, ("", ["Separator", Manual.NAME])]


def reason(error: ImportError) -> str:
    """An ImportError in the user's words."""
    if error.name == core_library.NAME:
        return str(error)
    return translate(
        "BeltGrinding",
        "The belt-grinding workbench needs the Python package {name}, and this FreeCAD does not have "
        "it ({error}). On Debian: apt install python3-{name}. Elsewhere FreeCAD's Addon Manager can "
        "install it: Tools, Addon manager, Python packages.",
    ).format(name=(error.name or "?").split(".")[0], error=error)
