"""Base of the docks that show one document object: one dock of a kind for the window."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ...base.kinds import known
from ...objects.kinds import Document, DocumentObject
from ...objects.living import goes_with, living
from ..common.compat import QtCore, QtGui
from ..common.help_pages import helped


class ObjectDock(QtGui.QDockWidget):
    """Base. What it shows, ``obj``, is the object that was opened last, None before. Subclasses have
    ``NAME``, ``title()``, and ``refresh()``, which shows it as it is now, and call ``place`` once they
    are filled.
    """

    NAME: str  # the dock's object name
    _made: dict[type[ObjectDock], ObjectDock] = {}  # kind -> the one dock

    def __init__(self) -> None:
        super().__init__(self.title(), Gui.getMainWindow())
        self.setObjectName(self.NAME)
        helped(self, self.NAME.removesuffix("Dock"))
        self.obj: DocumentObject | None = None

    @staticmethod
    def title() -> str:
        """What the dock is called before it shows an object."""
        raise NotImplementedError

    @classmethod
    def open(cls, obj: DocumentObject) -> ObjectDock:
        """Shows the object in the dock of this kind; returns that."""
        if cls not in cls._made:
            cls._made[cls] = cls()
        dock = cls._made[cls]
        dock.show_object(obj)
        dock.show()
        dock.raise_()
        return dock

    @classmethod
    def current(cls) -> ObjectDock | None:
        """The dock of this kind, None before the first was opened."""
        return cls._made.get(cls)

    def place(self, area: Any, pixels: int) -> None:
        """Puts the dock into an area of the window, so wide or high."""
        window = Gui.getMainWindow()
        window.addDockWidget(area, self)
        below = area in (QtCore.Qt.BottomDockWidgetArea, QtCore.Qt.TopDockWidgetArea)
        window.resizeDocks([self], [pixels], QtCore.Qt.Vertical if below else QtCore.Qt.Horizontal)

    def show_object(self, obj: DocumentObject) -> None:
        """Shows another object."""
        self.obj = obj
        self.setWindowTitle(obj.Label)
        self.refresh()

    def refresh(self) -> None:
        raise NotImplementedError

    def shown(self) -> DocumentObject:
        """The object shown, for what can be asked of one alone."""
        return known(self.obj)

    def living(self) -> DocumentObject | None:
        """The object shown, None once it is no longer in its document."""
        return living(self.obj)

    def forget(self) -> None:
        """The object goes, or has gone."""
        raise NotImplementedError

    def slotDeletedObject(self, obj: DocumentObject) -> None:
        """An object of a document goes."""
        if self.obj is not None and obj == self.obj:
            self.forget()

    def slotDeletedDocument(self, document: Document) -> None:
        """A document is closed."""
        if self.obj is not None and goes_with(self.obj, document):
            self.forget()
