"""Base of the view providers: the icon in the tree, and the panel that a double click opens."""

import FreeCADGui as Gui

from ...objects.proxy import Stateless
from ..common import command_registry
from ..common.compat import translate
from ..common.icons import icon, qicon
from ..panels.panel import edit


def add_commands(menu, names):
    """Adds commands of the workbench to a menu. They work on the job of what is selected, which is
    what the menu was called on.
    """
    for name in names:
        menu.addActions(command_registry.action(name))


class View(Stateless):
    """Base. ``ICON`` names the icon; ``panel`` makes the task panel; ``COMMANDS`` are those of the
    job that the tree's context menu offers.
    """

    ICON = ""
    COMMANDS = ()

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

    def setupContextMenu(self, view, menu):
        """The object's own entries in the tree's context menu."""
        menu.addAction(qicon(self.ICON), self.verb(), lambda: self.doubleClicked(view))
        self.own_entries(view.Object, menu)
        if self.COMMANDS:
            menu.addSeparator()
            add_commands(menu, self.COMMANDS)

    def verb(self):
        """What a double click does."""
        return translate("BeltGrinding", "Edit...")

    def own_entries(self, obj, menu):
        """Adds what only this kind of object can do."""

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
