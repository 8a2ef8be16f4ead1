"""Task panels that go with the object that they are of, and with its document."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...objects.kinds import Document, DocumentObject
from .compat import QtCore
from .keyboard import take_keyboard


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


def show_panel(panel: Any, obj: DocumentObject) -> None:
    """Shows a panel of an object until one closes it, or the object goes."""
    Gui.Control.showDialog(panel)
    take_keyboard(panel.form)
    _Watch(panel, obj)
