"""Base of the view providers: the icon in the tree, and the panel that a double click opens."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import FreeCADGui as Gui

from ...objects.kinds import DocumentObject, ViewObject
from ...objects.proxy import Stateless
from ..common import command_registry
from ..common.compat import translate
from ..common.icons import icon, qicon, stale_icon
from ..common.kinds import Icon, Menu
from ..common.redraw import Once, drawing
from ..common.keyboard import take_keyboard
from ..common.editing import edit_in_step, end_left_over

if TYPE_CHECKING:
    from ..scene.legend import Legend


# Of FreeCAD's views, set to draw what the document holds: it is not changed by that.
DRAWN_BY = {"Coloring", "SelectionStyle", "ShapeAppearance", "StartPosition"}


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
        self.picture, self.covered = Once(), False
        self.view = view
        for name in DRAWN_BY.intersection(view.PropertiesList):
            view.setPropertyStatus(name, "NoModify")
        drawing.ask(view.Object.Document)

    def finishRestoring(self) -> None:
        drawing.ask(self.view.Object.Document)

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if getattr(self, "view", None) is not None:
            drawing.ask(obj.Document)

    def onChanged(self, view: ViewObject, name: str) -> None:
        if getattr(self, "view", None) is None:
            return
        if name == "Visibility":  # FreeCAD hides what is its own at once
            drawing.now(view.Object.Document)
        else:
            drawing.ask(view.Object.Document)

    def draw(self) -> None:
        """Draws the object as properties say: its own, its view's, and those of others. Called whenever one of them may
        have changed, so what is drawn so already stays (``Once``)."""
        if self.picture.needed(self.getIcon()):
            self.view.signalChangeIcon()

    def legends(self) -> list[Legend]:
        """The legends that are shown now."""
        return []

    def shown(self) -> bool:
        """Whether the object is to be seen; ``covered``: playback is, in its place."""
        return bool(self.view.Visibility) and not self.covered

    def cover(self, covered: bool) -> None:
        """Draws nothing in the 3D views, or again; no property says so."""
        self.covered = covered
        drawing.now(self.view.Object.Document)

    def getIcon(self) -> str | Icon:
        """The object's; a marked one where its result is out of date."""
        view = getattr(self, "view", None)
        stale = view is not None and getattr(view.Object, "OutOfDate", False)
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def panel(self, obj: DocumentObject) -> Any:
        raise NotImplementedError

    def doubleClicked(self, view: ViewObject) -> bool:
        end_left_over()
        self.open(view)
        return True

    def open(self, view: ViewObject) -> None:
        """Shows what a double click shows."""
        edit_in_step(view.Object)

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
        panel = self.panel(view.Object)
        Gui.Control.showDialog(panel)
        take_keyboard(panel.form)
        return True

    def unsetEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        if mode != 0:
            return None
        Gui.Control.closeDialog()
        return True
