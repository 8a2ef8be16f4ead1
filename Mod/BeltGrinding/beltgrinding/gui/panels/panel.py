"""Base of the task panels: one undo transaction each, accepted or taken back."""

from __future__ import annotations

import re
from collections.abc import Callable

import FreeCAD
import FreeCADGui as Gui

from ...engine import InputError
from ...objects.kinds import Document, DocumentObject
from ...objects.living import GONE
from ..common import field_links
from ..common.compat import QtGui, buttons, translate
from ..common.help_pages import helped
from ..common.icons import qicon
from ..common.kinds import Buttons, Widget
from ..common.messages import error_text
from ..common.theme import warning_style
from ..common.transaction import abort, commit
from ..widgets.fold import Fold, slim
from ..widgets.form import Form

LONG = re.compile(r"\S{20,}")  # names and paths that may be wider than the dock
BREAK = "\u200b"  # where a line may end; it has no width


def breakable(text: str) -> str:
    """A message whose long names and paths may be broken, so that it is no wider than the dock."""
    return LONG.sub(lambda word: word.group().replace("_", "_" + BREAK), text)


class Panel:
    """A task panel that edits ``obj``. Subclasses fill ``self.body`` (a QVBoxLayout).

    The transaction is open before the panel is (by the command, or by ``edit``); OK commits it,
    Cancel aborts it.
    """

    def __init__(self, obj: DocumentObject, title: str, icon_name: str) -> None:
        self.obj = obj
        self.document = obj.Document
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(qicon(icon_name))
        helped(self.form, icon_name)
        self.body = QtGui.QVBoxLayout(self.form)
        self.note = QtGui.QLabel()
        self.note.setObjectName("note")
        self.note.setWordWrap(True)
        self.note.linkActivated.connect(lambda link: field_links.go_to(self.document.Name, link))
        self.note.hide()
        self.ended = False
        self.form.destroyed.connect(lambda *_: self._gone())

    def add_fold(
        self,
        name: str,
        icon_name: str,
        content: Widget,
        folded: bool = False,
        summary: Callable[[], str] = lambda: "",
        title: str = "",
    ) -> Fold:
        """Adds a box that folds; its title is that of its content, unless one is given."""
        if isinstance(content, QtGui.QGroupBox):
            title = title or content.title()
            content.setTitle("")
        fold = Fold(name, title, content, summary, folded, icon_name)
        self.body.addWidget(fold)
        return fold

    def finish(self) -> None:
        """Puts the line for messages above the fields, under the buttons; call it last in __init__."""
        self.body.insertWidget(0, self.note)
        self.body.addStretch()
        slim(self.form)

    def tell(self, text: str, error: bool = False) -> None:
        """A message in the panel; '' hides it."""
        field_links.show(self.note, breakable(text), [self.obj] if error else [])
        self.note.setStyleSheet(warning_style(error))
        self.note.setVisible(bool(text))

    def check(self) -> None:
        """Raises InputError for what must be mended before OK."""

    def apply(self) -> None:
        """What OK does once all is checked, before the document is recomputed."""

    def close(self) -> None:
        """Called once when the panel goes, whatever closes it; its widgets may have gone before."""

    def end(self) -> None:
        """Calls ``close``, unless that was done."""
        if not self.ended:
            self.ended = True
            self.close()

    def _gone(self) -> None:
        """The form is deleted. Where a macro or another command has closed the panel, no button has ended it: what
        was entered stays, as a step that can be undone."""
        if self.ended:
            return
        try:
            self.end()
            if not Gui.Control.activeDialog():  # or the step is another panel's by now
                commit(self.document)
        except GONE:
            pass  # the document was closed with it

    def getStandardButtons(self) -> Buttons:
        return buttons("Ok", "Cancel")

    def accept(self) -> bool:
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
        self.end()
        self.document.recompute()
        commit(self.document)
        _leave(self.document)
        return True

    def reject(self) -> bool:
        self.end()
        abort(self.document)  # before leaving: resetEdit commits what is open
        _leave(self.document)
        self.document.recompute()
        return True


def _leave(document: Document) -> None:
    gui = Gui.getDocument(document.Name)
    if gui.getInEdit() is not None:
        gui.resetEdit()
    else:
        Gui.Control.closeDialog()
