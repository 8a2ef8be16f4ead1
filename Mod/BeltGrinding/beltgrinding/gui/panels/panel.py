"""Base of the task panels: one undo transaction each, accepted or taken back."""

import re

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ..common.compat import QtGui, buttons, translate
from ..common.icons import qicon
from ..common.messages import error_text
from ..common.theme import warning_style
from ..widgets.fold import slim
from ..widgets.form import Form

LONG = re.compile(r"\S{20,}")  # names and paths that may be wider than the dock
BREAK = "\u200b"  # where a line may end; it has no width


def breakable(text):
    """A message whose long names and paths may be broken, so that it is no wider than the dock."""
    return LONG.sub(lambda word: word.group().replace("_", "_" + BREAK), text)


class Panel:
    """A task panel that edits ``obj``. Subclasses fill ``self.body`` (a QVBoxLayout).

    The transaction is open before the panel is (by the command, or by ``edit``); OK commits it,
    Cancel aborts it.
    """

    def __init__(self, obj, title, icon_name):
        self.obj = obj
        self.document = obj.Document
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(qicon(icon_name))
        self.body = QtGui.QVBoxLayout(self.form)
        self.note = QtGui.QLabel()
        self.note.setObjectName("note")
        self.note.setWordWrap(True)
        self.note.hide()

    def finish(self):
        """Puts the line for messages above the fields, under the buttons; call it last in __init__."""
        self.body.insertWidget(0, self.note)
        self.body.addStretch()
        slim(self.form)

    def tell(self, text, error=False):
        """A message in the panel; '' hides it."""
        self.note.setText(breakable(text))
        self.note.setStyleSheet(warning_style(error))
        self.note.setVisible(bool(text))

    def check(self):
        """Raises InputError for what must be mended before OK."""

    def apply(self):
        """What OK does once all is checked, before the document is recomputed."""

    def close(self):
        """Called when the panel goes, whatever the button."""

    def getStandardButtons(self):
        return buttons("Ok", "Cancel")

    def accept(self):
        try:
            for form in self.form.findChildren(QtGui.QGroupBox):
                if isinstance(form, Form):
                    form.check()
            self.check()
        except InputError as error:
            self.tell(error_text(error), True)
            FreeCAD.Console.PrintWarning(f"{self.obj.Label}: {error_text(error)}\n")
            return False
        self.apply()
        self.close()
        self.document.recompute()
        self.document.commitTransaction()
        _leave(self.document)
        return True

    def reject(self):
        self.close()
        self.document.abortTransaction()  # before leaving: resetEdit commits what is open
        _leave(self.document)
        self.document.recompute()
        return True


def _leave(document):
    gui = Gui.getDocument(document.Name)
    if gui.getInEdit() is not None:
        gui.resetEdit()
    else:
        Gui.Control.closeDialog()


def edit(obj):
    """Opens the panel of an object, as a double click does, in an undo transaction."""
    if Gui.Control.activeDialog():
        FreeCAD.Console.PrintWarning(
            translate("BeltGrinding", "Close the open task panel first.") + "\n"
        )
        return
    if not obj.Document.HasPendingTransaction:
        obj.Document.openTransaction(translate("BeltGrinding", "Edit") + " " + obj.Label)
    Gui.getDocument(obj.Document.Name).setEdit(obj.Name, 0)
