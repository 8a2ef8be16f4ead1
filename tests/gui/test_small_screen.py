"""A screen of 1366 x 768 in a dark theme: every button of the toolbars shows, and a program's file can be read."""

from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtGui

from support import freecad as windows
from support.hands import field, prepare, settle, start, visible, whole_screen

DARK = Path("/usr/share/freecad/Gui/Stylesheets/Dark-blue.qss")


@pytest.mark.slow
def test_a_dark_theme_keeps_the_buttons(tmp_path, monkeypatch):
    if not DARK.exists():
        pytest.skip("this FreeCAD has no such theme")
    monkeypatch.setattr(windows, "SCREEN", "-screen 0 1366x768x24")
    freecad = windows.FreeCad(tmp_path)
    freecad.call(look, window=True, fresh=True)


def look():
    app = QtGui.QApplication.instance()
    app.setStyleSheet(DARK.read_text())
    whole_screen()
    start()
    settle()
    bars = [b for b in visible(QtGui.QToolBar) if b.windowTitle().startswith("Belt grinding")]
    assert len(bars) == 4
    for bar in bars:
        for action in bar.actions():
            button = bar.widgetForAction(action)
            assert button.isVisible(), (bar.windowTitle(), action.text())
    # On rows as they were or on the first: none has come to lie upon another.
    for one in bars:
        assert not any(
            one.geometry().intersects(other.geometry()) for other in bars if other != one
        )
    before = [bar.geometry().getRect() for bar in bars]
    Gui.activateWorkbench("PartWorkbench")
    settle()
    start()
    settle()
    bars = [b for b in visible(QtGui.QToolBar) if b.windowTitle().startswith("Belt grinding")]
    assert [bar.geometry().getRect() for bar in bars] == before  # moved once

    job = prepare()
    path = job.Document.RobotPath
    path.ViewObject.Proxy.doubleClicked(path.ViewObject)
    settle()
    line = field("Source").findChild(QtGui.QLineEdit)
    wide = line.fontMetrics().horizontalAdvance("pressure_side_01.src")
    assert line.width() > wide, (line.width(), wide)
    FreeCAD.Gui.Control.closeDialog()
