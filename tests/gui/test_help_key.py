"""F1 in a panel or a dock opens the page of the manual that tells of it."""

import re
from pathlib import Path

import pytest
from PySide import QtCore, QtGui

from beltgrinding.base.resources import documentation
from beltgrinding.gui.common import help_pages
from support.hands import field, menu, prepare, press, settle, widgets, window

pytestmark = pytest.mark.freecad(window=True)


def test_each_panel_has_a_page():
    named = set()
    for path in (Path(help_pages.__file__).parents[1] / "panels").glob("*.py"):
        named |= set(re.findall(r'"BeltGrinding_(\w+)"', path.read_text(encoding="utf-8")))
    assert len(named) > 15 and named - set(help_pages.PAGES) == set()


def test_f1_opens_the_page_of_the_panel():
    prepare()
    for page in help_pages.PAGES.values():
        assert (documentation() / page).is_file(), page

    def struck(widget):
        """Whether F1 there is taken from FreeCAD's shortcuts, and the page that it opens."""
        widget.setFocus()
        settle()
        asked = QtGui.QKeyEvent(
            QtCore.QEvent.ShortcutOverride, QtCore.Qt.Key_F1, QtCore.Qt.NoModifier
        )
        asked.ignore()
        QtGui.QApplication.sendEvent(widget, asked)
        settle()
        shown = [view for view in widgets(QtGui.QTextBrowser, "BeltGrinding_ManualView")]
        page = shown[0].source().fileName() if shown and shown[0].isVisible() else ""
        for view in shown:
            view.window().close()
        return asked.isAccepted(), page

    window.activateWindow()
    for command, name, page in (
        ("Stock", "Kind", "workbench-job.md"),
        ("Cell", "Holding", "workbench-cell.md"),
        ("Contact at a pose...", "pose", "contact.md"),
    ):
        menu(command)
        assert struck(field(name)) == (True, page), command
        press("Close" if command.startswith("Contact") else "Cancel")
    assert struck(window)[1] == "", "elsewhere F1 is FreeCAD's"
