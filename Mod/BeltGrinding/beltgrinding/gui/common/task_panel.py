"""Task panels that go with the object that they are of, and with its document."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...objects.kinds import Document, DocumentObject
from ...objects.living import GONE
from .compat import QtCore
from .kinds import Widget


class _Watch:
    """Closes a panel whose object, or document, goes."""

    def __init__(self, panel: Any, obj: DocumentObject) -> None:
        self.name, self.obj = obj.Document.Name, obj
        self.end_panel = getattr(panel, "end", lambda: None)  # while its objects are there
        FreeCAD.addDocumentObserver(self)
        panel.form.destroyed.connect(lambda *_: self.end())
        self.watching = True

    def slotDeletedDocument(self, document: Document) -> None:
        if document.Name == self.name:
            self._close()

    def slotDeletedObject(self, obj: DocumentObject) -> None:
        if obj == self.obj:
            self._close()

    def _close(self) -> None:
        if self.watching:
            self.end()
            self.end_panel()
            QtCore.QTimer.singleShot(0, Gui.Control.closeDialog)  # FreeCAD is at it

    def end(self) -> None:
        """Stops looking."""
        if self.watching:
            self.watching = False
            FreeCAD.removeDocumentObserver(self)


def take_keyboard(form: Widget) -> None:
    """Gives a panel the keyboard: the next Tab goes to its first field. FreeCAD leaves it in the 3D view, which keeps Tab
    for itself. The form itself takes it, so that no field changes under the mouse's wheel."""
    form.setFocusPolicy(QtCore.Qt.ClickFocus)

    def focus() -> None:
        try:
            form.setFocus()
        except GONE:
            pass  # closed again

    QtCore.QTimer.singleShot(0, focus)  # once it is shown


def show_panel(panel: Any, obj: DocumentObject) -> None:
    """Shows a panel of an object until one closes it, or the object goes."""
    Gui.Control.showDialog(panel)
    take_keyboard(panel.form)
    _Watch(panel, obj)
