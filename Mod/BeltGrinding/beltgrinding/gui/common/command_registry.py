"""How views reach the commands, which stand in a layer above: what registers them is put in here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

# Tells FreeCAD the commands, if it does not know them; the package itself puts it in.
register: Callable[[], None]


def action(name: str) -> list[Any]:
    """The QActions of a command of the workbench."""
    import FreeCADGui as Gui  # the package itself is imported without FreeCAD

    register()
    return Gui.Command.get(name).getAction()
