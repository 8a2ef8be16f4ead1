"""Light or dark: which way FreeCAD's window looks, and the colours that our own drawings take from it."""

from __future__ import annotations

from typing import Any, NamedTuple

import FreeCADGui as Gui

from .compat import QtCore, QtGui
from .kinds import Colour, Widget


class Theme(NamedTuple):
    """Colours as Qt takes them."""

    ground: str
    text: str
    faint: str  # of less important text
    grid: str
    warning: str
    doubt: str
    dark: bool


LIGHT = Theme("#ffffff", "#22262b", "#6b7078", "#e3e5e8", "#b3261e", "#8a6d00", False)
DARK = Theme("#26292e", "#e4e7ea", "#9aa1aa", "#3b4047", "#ff8a80", "#ffd54f", True)
HALF = 0.5  # of the lightness
DIM, BRIGHT = 0.35, 0.75  # of a colour's lightness on a dark ground, and what it becomes at least
_known: dict[Any, Theme] = {}  # what the window looked like -> Theme


def theme() -> Theme:
    """The window's ``Theme``. Not by its palette: a style sheet, which is how FreeCAD gets dark, leaves that
    as it is. The colour that a label's text gets tells, and what the window's ground is drawn in.
    """
    window = Gui.getMainWindow()
    key = QtGui.QApplication.instance().styleSheet(), window.palette().cacheKey()
    if key not in _known:
        _known.clear()
        _known[key] = DARK if _looks_dark(window) else LIGHT
    return _known[key]


def _looks_dark(window: Widget) -> bool:
    label = QtGui.QLabel("a", window)
    label.ensurePolished()
    text = label.palette().windowText().color()
    label.deleteLater()
    ground = window.grab(QtCore.QRect(1, 1, 4, 4)).toImage().pixelColor(1, 1)
    return text.lightnessF() > HALF or ground.lightnessF() < HALF


def readable(colour: Colour) -> Colour:
    """A line's colour (as Qt takes it) on the theme's ground: dark ones are lightened on a dark one."""
    found = QtGui.QColor(colour)
    if theme().dark and found.lightnessF() < 0.6:
        hue, saturation, lightness, alpha = found.getHslF()
        found.setHslF(max(hue, 0.0), saturation, min(DIM + 0.8 * lightness, BRIGHT), alpha)
    return found


def warning_style(warns: bool = True) -> str:
    """The style sheet of a label that warns; '' of one that does not."""
    return f"color: {theme().warning}; font-weight: bold;" if warns else ""
