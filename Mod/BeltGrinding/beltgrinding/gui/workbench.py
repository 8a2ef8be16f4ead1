"""What InitGui.py does: FreeCAD runs that file without keeping its names, so the work stands here.

Nothing here needs the compiled core before the workbench is chosen: where that is missing, FreeCAD
starts all the same, and ``start`` says so.
"""

import FreeCAD
import FreeCADGui as Gui

from .. import resources
from . import languages
from .icons import icon

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
NAME = QT_TRANSLATE_NOOP("Workbench", "Belt grinding")
MENU = QT_TRANSLATE_NOOP("Workbench", "&Belt grinding")


def describe(workbench):
    """Gives the workbench's class what FreeCAD shows of it, in its language."""
    languages.register()
    workbench.Icon = icon("BeltGrinding_Workbench")
    workbench.MenuText = FreeCAD.Qt.translate("Workbench", "Belt grinding")
    workbench.ToolTip = FreeCAD.Qt.translate(
        "Workbench", "What a robot's belt grinding will leave, before any metal is ground"
    )


def fill(workbench):
    """Toolbar and menu of the workbench, when it is chosen first; the commands of its toolbar."""
    from . import start

    work, more = start.register()
    if work:
        from ..objects.importer import SHARED_TYPE

        workbench.appendToolbar(NAME, work)
        more = [*work, "Separator", *more]
        FreeCAD.addImportType(*SHARED_TYPE)
    workbench.appendMenu(MENU, more)
    return work


def at_start():
    """The preferences: they hold from FreeCAD's start."""
    try:
        from ..objects import preferences
        from .preferences_page import PreferencesPage
    except ImportError:
        return  # said when the workbench is chosen
    preferences.apply_threads()
    Gui.addIconPath(str(resources() / "icons"))
    Gui.addPreferencePage(PreferencesPage, QT_TRANSLATE_NOOP("QObject", "Belt grinding"))
