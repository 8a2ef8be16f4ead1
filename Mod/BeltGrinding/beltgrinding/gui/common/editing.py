"""Opens the panel of an object."""

from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from ...objects.kinds import DocumentObject
from .compat import translate


def end_left_over() -> None:
    """Ends an undo step that is open while no panel is that could own it, as one that had changed nothing of a document
    that was closed: it would take in all that is done next, in any document, and a panel's Cancel would take that back.
    """
    if not Gui.Control.activeDialog():
        FreeCAD.closeActiveTransaction(False)


def edit(obj: DocumentObject) -> None:
    """Opens the panel of an object, as a double click does, in an undo transaction."""
    end_left_over()
    edit_in_step(obj)


def edit_in_step(obj: DocumentObject) -> None:
    """Opens the panel of an object in the undo transaction that is open, by which it was made, or in one of its own."""
    if Gui.Control.activeDialog():
        FreeCAD.Console.PrintWarning(
            translate("BeltGrinding", "Close the open task panel first.") + "\n"
        )
        return
    if not obj.Document.HasPendingTransaction:
        obj.Document.openTransaction(translate("BeltGrinding", "Edit") + " " + obj.Label)
    Gui.getDocument(obj.Document.Name).setEdit(obj.Name, 0)
