"""Why a command is greyed: its tooltip and the status bar say so."""

from __future__ import annotations

from html import escape
from typing import Any

import FreeCADGui as Gui

TIP, STATUS = "beltGrindingTip", "beltGrindingStatus"  # FreeCAD's own of an action
MADE = "beltGrindingMade"  # the tooltip that was made of it


def say_reason(name: str, reason: str) -> None:
    """Adds to the tooltip of a command why it cannot run; '' takes that away."""
    command = Gui.Command.get(name)
    for action in command.getAction() if command is not None else ():
        _say(action, reason)


def _say(action: Any, reason: str) -> None:
    if action.toolTip() != action.property(MADE):  # FreeCAD's own: at first, or in another language
        action.setProperty(TIP, action.toolTip())
        action.setProperty(STATUS, action.statusTip())
    own = action.property(TIP)
    wanted = f"{own}<p><b>{escape(reason)}</b></p>" if reason else own
    if action.toolTip() == wanted:
        return
    action.setProperty(MADE, wanted if reason else None)
    action.setToolTip(wanted)
    action.setStatusTip(reason or action.property(STATUS))
