"""Base of the view providers: the icon in the tree, and the panel that a double click opens."""

import FreeCADGui as Gui

from ..objects.proxy import Stateless
from .icons import icon
from .panel import edit


class View(Stateless):
    """Base. ``ICON`` names the icon; ``panel`` makes the task panel."""

    ICON = ""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        self.view = view

    def getIcon(self):
        return icon(self.ICON)

    def panel(self, obj):
        raise NotImplementedError

    def doubleClicked(self, view):
        edit(view.Object)
        return True

    def setEdit(self, view, mode=0):
        if mode != 0:
            return None
        Gui.Control.showDialog(self.panel(view.Object))
        return True

    def unsetEdit(self, view, mode=0):
        if mode != 0:
            return None
        Gui.Control.closeDialog()
        return True
