"""What our view providers draw is a function of properties: their own, their object's, and those of others.

Whatever changes one of them, by hand, by a panel, a macro, undo or redo, asks for a drawing of all views of the document.
They are drawn once FreeCAD is through with the change, so that none is drawn of half of it. A view draws anew only what
is not drawn like that already (``Once``).
"""

from __future__ import annotations

import traceback
from functools import partial
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...objects.kinds import Document, DocumentObject
from .compat import QtCore
from .kinds import QtEvent

WHILE_RESTORING = 50  # ms


class Once:
    """Remembers of what something was drawn."""

    def __init__(self) -> None:
        self.key: Any = None

    def needed(self, *key: Any) -> bool:
        """Whether it was last drawn of something else than ``key``, of which it is drawn now."""
        if key == self.key:
            return False
        self.key = key
        return True


class Redraw(QtCore.QObject):
    """Draws documents' views, when asked, undone, redone or recomputed; all when the language changes."""

    def __init__(self) -> None:
        super().__init__()
        self.waiting: set[str] = set()  # names of documents
        self.drawing = False

    def ask(self, document: Document) -> None:
        """Draws a document's views as soon as FreeCAD is through."""
        if self.drawing or document is None:
            return
        if not self.waiting:
            QtCore.QTimer.singleShot(0, self._run)
        self.waiting.add(document.Name)

    def ask_all(self) -> None:
        """Draws all: a preference has changed."""
        for document in FreeCAD.listDocuments().values():
            self.ask(document)

    def now(self, document: Document) -> None:
        """Draws a document's views at once; later while it is opened."""
        if self.drawing or Gui.getDocument(document.Name) is None:
            return
        if FreeCAD.isRestoring():
            self.ask(document)
            return
        self.waiting.discard(document.Name)
        self._draw(document)

    slotUndoDocument = slotRedoDocument = slotAbortTransaction = slotRecomputedDocument = now

    def slotDeletedObject(self, obj: DocumentObject) -> None:
        """An object goes, of which others may say something."""
        self.ask(obj.Document)

    def eventFilter(self, window: Any, event: QtEvent) -> bool:
        if event.type() == QtCore.QEvent.LanguageChange:
            self.ask_all()
        return False

    def _run(self) -> None:
        if FreeCAD.isRestoring():
            QtCore.QTimer.singleShot(WHILE_RESTORING, self._run)
            return
        names, self.waiting = self.waiting, set()
        documents = FreeCAD.listDocuments()
        for name in names & documents.keys():
            self._draw(documents[name])

    def _draw(self, document: Document) -> None:
        self.drawing = True
        try:
            shown: list[Any] = []  # legends, side by side
            for obj in document.Objects:
                proxy: Any = getattr(getattr(obj, "ViewObject", None), "Proxy", None)
                if getattr(proxy, "view", None) is None or not hasattr(proxy, "draw"):
                    continue
                try:
                    proxy.draw()
                    for legend in proxy.legends():
                        legend.beside = list(shown)
                        legend.chosen = partial(proxy.doubleClicked, proxy.view)
                        shown.append(legend)
                except Exception:  # one that cannot be drawn keeps none of the others from it
                    FreeCAD.Console.PrintError(traceback.format_exc())
        finally:
            self.drawing = False


drawing = Redraw()
FreeCAD.addDocumentObserver(drawing)
Gui.getMainWindow().installEventFilter(drawing)
