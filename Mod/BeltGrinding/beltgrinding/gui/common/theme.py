"""Light or dark: which way FreeCAD's window looks, and the colours that our own drawings take from it."""

from typing import NamedTuple

import FreeCADGui as Gui

from .compat import QtGui


class Theme(NamedTuple):
    """Colours as Qt takes them."""

    ground: str
    text: str
    faint: str  # of less important text
    grid: str
    warning: str
    dark: bool


LIGHT = Theme("#ffffff", "#22262b", "#6b7078", "#e3e5e8", "#b3261e", False)
DARK = Theme("#26292e", "#e4e7ea", "#9aa1aa", "#3b4047", "#ff8a80", True)
DIM, BRIGHT = 0.35, 0.75  # of a colour's lightness on a dark ground, and what it becomes at least
_known = {}  # what the window looked like -> Theme


def theme():
    """The window's ``Theme``. Not by its palette: a style sheet, which is how FreeCAD 0.20 gets dark, leaves
    that as it is. The colour in which a label's text is drawn tells."""
    window = Gui.getMainWindow()
    key = QtGui.QApplication.instance().styleSheet(), window.palette().cacheKey()
    if key not in _known:
        _known.clear()
        _known[key] = DARK if _light_text(window) else LIGHT
    return _known[key]


def _light_text(window):
    box = QtGui.QGroupBox(window)  # in one, as most of our labels are
    label = QtGui.QLabel("\u2588\u2588", box)
    label.resize(40, 20)
    label.ensurePolished()
    image = label.grab().toImage()
    middle = image.height() // 2
    drawn = [image.pixelColor(x, middle) for x in range(image.width())]
    ground = drawn[-1].lightnessF()
    box.deleteLater()
    text = max((c.lightnessF() for c in drawn), key=lambda one: abs(one - ground))
    # Where a style sheet leaves the ground see-through, the text alone tells.
    return text > 0.5


def readable(colour):
    """A line's colour (as Qt takes it) on the theme's ground: dark ones are lightened on a dark one."""
    found = QtGui.QColor(colour)
    if theme().dark and found.lightnessF() < 0.6:
        hue, saturation, lightness, alpha = found.getHslF()
        found.setHslF(max(hue, 0.0), saturation, min(DIM + 0.8 * lightness, BRIGHT), alpha)
    return found
