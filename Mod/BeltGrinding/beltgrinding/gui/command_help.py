"""Help on the workbench's commands: F1 on an entry of its menu, and What's This on its buttons, open the manual."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from .common.compat import QtCore, QtGui
from .common.help_pages import PAGES
from .common.kinds import QtEvent, Widget
from .manual import show_manual

PREFIX = "BeltGrinding_"  # of the commands' names


class CommandHelp(QtCore.QObject):
    """Filters the events of the workbench's menus and of the buttons of its toolbars."""

    def watch(self) -> None:
        """Looks at all menus and toolbars that show a command of the workbench; FreeCAD makes them when the workbench
        is chosen. Entries that are greyed show their tooltips, which say why."""
        window = Gui.getMainWindow()
        for menu in window.menuBar().findChildren(QtGui.QMenu):
            if any(_page(action) for action in menu.actions()):
                menu.setToolTipsVisible(True)
                menu.installEventFilter(self)
        for button in window.findChildren(QtGui.QToolButton):
            if _page(button.defaultAction()):
                button.installEventFilter(self)

    def eventFilter(self, widget: Widget, event: QtEvent) -> bool:
        page = ""
        if isinstance(widget, QtGui.QMenu):
            struck = event.type() == QtCore.QEvent.KeyPress and event.key() == QtCore.Qt.Key_F1
            chosen = event.type() == QtCore.QEvent.MouseButtonRelease
            if struck or chosen and QtGui.QWhatsThis.inWhatsThisMode():
                # Greyed ones are never active.
                under = widget.actionAt(widget.mapFromGlobal(QtGui.QCursor.pos()))
                page = _page(widget.activeAction() or under)
        elif event.type() == QtCore.QEvent.WhatsThis:
            page = _page(widget.defaultAction())
        if not page:
            return False
        QtGui.QWhatsThis.leaveWhatsThisMode()
        if isinstance(widget, QtGui.QMenu):
            while QtGui.QApplication.activePopupWidget() is not None:
                QtGui.QApplication.activePopupWidget().close()
        QtCore.QTimer.singleShot(0, lambda: show_manual(page))
        return True


def _page(action: Any) -> str:
    """The manual's page of a command's QAction; '' of another's."""
    name = "" if action is None else action.whatsThis()
    return PAGES.get(name.removeprefix(PREFIX), "") if name.startswith(PREFIX) else ""


commands_help = CommandHelp()
