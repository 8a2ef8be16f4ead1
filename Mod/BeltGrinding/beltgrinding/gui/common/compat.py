"""What differs between FreeCAD's generations, for the window."""

from __future__ import annotations

import FreeCAD
from PySide import QtCore, QtGui  # FreeCAD's shim: PySide2 or 6; 0.20 has the widgets in QtGui

from ...objects.kinds import ViewObject
from .figures import Text
from .kinds import Buttons

__all__ = ["QtCore", "QtGui", "VERSION", "buttons", "make_matt", "translate"]

VERSION = tuple(int("".join(c for c in part if c.isdigit()) or 0) for part in FreeCAD.Version()[:2])
_translated = FreeCAD.Qt.translate


def translate(context: str, text: str) -> str:
    """A text in the window's language; its ``format`` writes numbers as FreeCAD does."""
    return Text(_translated(context, text))


def buttons(*names: str) -> Buttons:
    """What getStandardButtons returns: an int in 0.20, the enum later. Names such as "Ok"."""
    box = QtGui.QDialogButtonBox
    both = getattr(box, names[0])
    for name in names[1:]:
        both = both | getattr(box, name)
    return int(both) if VERSION < (1, 0) else both


def make_matt(view: ViewObject) -> None:
    """Takes the shine from a view provider: 1.0 gives all that is new a highlight, in whose middle
    every colour is white.
    """
    if hasattr(view, "ShapeAppearance"):
        appearance = view.ShapeAppearance[0]
        if any(appearance.SpecularColor[:3]):
            appearance.SpecularColor = (0.0, 0.0, 0.0, 1.0)
            view.ShapeAppearance = (appearance,)
