"""What InitGui.py does: FreeCAD runs that file without keeping its names, so the work stands here.

Nothing here needs the compiled core before the workbench is chosen: where that is missing, FreeCAD
starts all the same, and ``start`` says so.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ..base.resources import resources
from ..objects import waiting
from . import languages
from .common.compat import QtCore, QtGui
from .common.icons import icon
from .common.kinds import Context

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
NAME = QT_TRANSLATE_NOOP("Workbench", "Belt grinding")
MENU = QT_TRANSLATE_NOOP("Workbench", "&Belt grinding")


SMALL_SCREEN = 1300  # pixels
_titles: list[str] = []  # of the toolbars


def describe(workbench: Any) -> None:
    """Gives the workbench's class what FreeCAD shows of it, in its language."""
    languages.register()
    workbench.Icon = icon("BeltGrinding_Workbench")
    workbench.MenuText = FreeCAD.Qt.translate("Workbench", "Belt grinding")
    workbench.ToolTip = FreeCAD.Qt.translate(
        "Workbench", "What a robot's belt grinding will leave, before any metal is ground"
    )


def fill(workbench: Any) -> list[str]:
    """Toolbars and menu of the workbench, when it is chosen first; the commands of its toolbars, which are
    its context menu, too.
    """
    from . import start

    toolbars, menu = start.register()
    _titles[:] = toolbars
    for title, names in toolbars.items():
        workbench.appendToolbar(title, names)
    if toolbars:
        from ..objects.importer import SHARED_TYPE

        FreeCAD.addImportType(*SHARED_TYPE)
    for title, names in menu:
        workbench.appendMenu([MENU, title] if title else MENU, names)
    return [name for names in toolbars.values() for name in names]


def activated() -> None:
    """What is to be done whenever the workbench is chosen, once FreeCAD has made its menus and toolbars."""
    from .command_help import commands_help

    commands_help.watch()
    QtCore.QTimer.singleShot(0, fit_toolbars)


def fit_toolbars() -> None:
    """Puts toolbars of ours whose buttons do not all show to the end of the first row, where that has room: wide themes
    need more than a row of a small screen. In a window that is no screen wide they stay, as it may grow.
    """
    window = Gui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtGui.QToolBar) if bar.isVisible()]
    if window.width() < SMALL_SCREEN or not bars:
        return
    top = min(bar.y() for bar in bars)
    for bar in bars:
        first_row = sorted((one for one in bars if one.y() == top), key=lambda one: one.x())
        last = first_row[-1]
        room = window.width() - last.x() - last.sizeHint().width()
        lacks = bar.sizeHint().width() > bar.width() and bar not in first_row
        if bar.objectName() in _titles and lacks and bar.sizeHint().width() <= room:
            window.insertToolBar(last, bar)
            window.insertToolBar(bar, last)
            window.layout().activate()


def at_start() -> None:
    """Offers the preferences, without what they need: everyone's FreeCAD starts through here."""
    waiting.wait_in_window = _wait
    Gui.addIconPath(str(resources() / "icons"))
    Gui.addPreferencePage(Preferences, QT_TRANSLATE_NOOP("QObject", "Belt grinding"))


def _wait(work: Callable[[Context], Any], text: str) -> Any:
    if threading.current_thread() is not threading.main_thread():
        return work(None)  # a macro's own thread holds nothing up, and may show no dialog
    from .common.waiting import wait  # not above: it needs the core

    return wait(work, text)


class Preferences:
    """The page in FreeCAD's preferences; made of what needs the core only when they are opened."""

    def __init__(self, *arguments: object) -> None:
        try:
            from .preferences_page import PreferencesPage
        except ImportError as error:
            self.form = QtGui.QLabel(str(error))
            self.form.setWindowTitle(FreeCAD.Qt.translate("BeltGrinding", "General"))
            self.form.setWordWrap(True)
            self.loadSettings = self.saveSettings = lambda: None
            return
        page = PreferencesPage(*arguments)
        self.form = page.form
        self.loadSettings, self.saveSettings = page.loadSettings, page.saveSettings
