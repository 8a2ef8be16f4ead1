"""Errors, said in the report view and in a message that does not hold FreeCAD up.

What a user is to mend is a warning there: on an error FreeCAD pulls its report view over the window. A
fault of ours is one.
"""

from __future__ import annotations

import traceback
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...base.messages import notes, reason, sentence
from .compat import QtGui, translate
from .kinds import Icon, Json, Widget

ERROR = "BeltGrinding_Error"
SAID = "said"  # property of a message: its text, without links


def error_text(error: Any) -> str:
    """What an error, a warning or a note says, in the window's language."""
    if not hasattr(error, "code"):
        return reason(error)
    from .report_language import language  # not above: that the core is missing must be said, too

    return sentence(error, language())


def note_texts(found: Json) -> list[str]:
    """What the notes of a verdict or a check of the settings say, in the window's language."""
    from .report_language import language  # not above, as in error_text

    return notes(found, language())


def report(error: BaseException) -> None:
    """Says an error in the report view and, where there is a user to see it, in a message."""
    from ...engine import InputError  # not above, as in error_text

    if not isinstance(error, InputError):
        lines = traceback.format_exception(type(error), error, error.__traceback__)
        FreeCAD.Console.PrintError("".join(lines))
    tell(error_text(error))
    from . import field_links  # not above, as in error_text

    for box in Gui.getMainWindow().findChildren(QtGui.QMessageBox, ERROR):
        if box.isVisible():
            field_links.link(box, box.property(SAID))


def tell(text: str) -> None:
    """An error in the report view and in a message that does not hold FreeCAD up."""
    FreeCAD.Console.PrintWarning(f"{text}\n")
    _show(text, ERROR, QtGui.QMessageBox.Warning)


def inform(text: str) -> None:
    """Likewise what is no error, but must not be missed."""
    FreeCAD.Console.PrintWarning(f"{text}\n")
    _show(text, "BeltGrinding_Note", QtGui.QMessageBox.Information)


def _show(text: str, name: str, icon: Icon) -> None:
    window = Gui.getMainWindow()
    for one in window.findChildren(QtGui.QMessageBox, name):
        if one.isVisible():  # not one upon the other
            said = one.property(SAID)
            if text not in said.split("\n\n"):
                _say(one, f"{said}\n\n{text}")
            return
    box = QtGui.QMessageBox(window)
    box.setObjectName(name)
    box.setIcon(icon)
    box.setWindowTitle(translate("BeltGrinding", "Belt grinding"))
    _say(box, text)
    box.setModal(False)
    box.show()


def _say(box: Widget, text: str) -> None:
    box.setProperty(SAID, text)
    box.setText(text)
