"""Asks for a file to be written."""

from __future__ import annotations

import re
from pathlib import Path

import FreeCADGui as Gui

from .compat import QtGui, translate

SUFFIX = re.compile(r"\*(\.\w+)")


def file_to_write(title: str, name: str, kinds: str) -> str:
    """The path of a file that may be written, or "". A name without a suffix gets that of the chosen kind; the
    dialog has asked whether the name as it was typed is to be replaced, so that the other is asked for here.

    name: that is offered; kinds: the filters.
    """
    path, kind = QtGui.QFileDialog.getSaveFileName(Gui.getMainWindow(), title, name, kinds)
    suffixes = SUFFIX.findall(kinds)
    if not path or Path(path).suffix.lower() in suffixes:
        return path
    chosen = SUFFIX.search(kind)
    path += chosen.group(1) if chosen else suffixes[0]
    return path if not Path(path).exists() or _may_replace(title, path) else ""


def _may_replace(title: str, path: str) -> bool:
    question = translate("BeltGrinding", "{} is there already. Replace it?").format(path)
    buttons = QtGui.QMessageBox.Yes | QtGui.QMessageBox.No
    answer = QtGui.QMessageBox.question(
        Gui.getMainWindow(), title, question, buttons, QtGui.QMessageBox.No
    )
    return answer == QtGui.QMessageBox.Yes
