"""Base of the view providers: the icon in the tree, and the panel that a double click opens."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import FreeCADGui as Gui

from ...objects.kinds import DocumentObject, ViewObject
from ...objects.proxy import Stateless
from ..common import command_registry
from ..common.compat import translate
from ..common.icons import icon, qicon
from ..common.kinds import Menu
from ..panels.panel import edit


def add_commands(menu: Menu, names: Iterable[str]) -> None:
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
    COMMANDS: tuple[str, ...] = ()

    def __init__(self, view: ViewObject) -> None:
        view.Proxy = self

    def attach(self, view: ViewObject) -> None:
        self.view = view

    def getIcon(self) -> str:
        return icon(self.ICON)

    def panel(self, obj: DocumentObject) -> Any:
        raise NotImplementedError

    def doubleClicked(self, view: ViewObject) -> bool:
        edit(view.Object)
        return True

    def setupContextMenu(self, view: ViewObject, menu: Menu) -> None:
        """The object's own entries in the tree's context menu."""
        menu.addAction(qicon(self.ICON), self.verb(), lambda: self.doubleClicked(view))
        self.own_entries(view.Object, menu)
        if self.COMMANDS:
            menu.addSeparator()
            add_commands(menu, self.COMMANDS)

    def verb(self) -> str:
        """What a double click does."""
        return translate("BeltGrinding", "Edit...")

    def own_entries(self, obj: DocumentObject, menu: Menu) -> None:
        """Adds what only this kind of object can do."""

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        if mode != 0:
            return None
        Gui.Control.showDialog(self.panel(view.Object))
        return True

    def unsetEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        if mode != 0:
            return None
        Gui.Control.closeDialog()
        return True
