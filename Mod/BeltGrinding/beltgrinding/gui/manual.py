"""The manual: the pages of docs/ in a window of FreeCAD, with their links and pictures.

Qt reads Markdown by itself, so that no browser and no network is needed.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ..base.resources import documentation
from .common.compat import QtCore, QtGui, translate
from .common.help_pages import page_of
from .common.icons import icon
from .common.kinds import QtEvent, Widget

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
CONTENTS = "index.md"
SIZE = 960, 800  # of the window at first, pixels
MARGIN = 40  # beside a picture, pixels: the page's own and the scroll bar


class ManualView(QtGui.QTextBrowser):
    """Shows pages; a picture is never wider than the window."""

    def __init__(self, parent: Widget = None) -> None:
        super().__init__(parent)
        self.setObjectName("BeltGrinding_ManualView")
        self.setOpenExternalLinks(True)

    def loadResource(self, kind: Any, url: Any) -> Any:
        content = super().loadResource(kind, url)
        if kind != QtGui.QTextDocument.ImageResource:
            return content
        picture = QtGui.QImage(self.source().resolved(url).toLocalFile())
        width = self.width() - MARGIN
        if picture.width() <= width:
            return picture
        return picture.scaledToWidth(width, QtCore.Qt.SmoothTransformation)


def show_manual(page: str = CONTENTS) -> Widget:
    """Opens a page of docs/ in a window, the same one each time; returns it."""
    window = Gui.getMainWindow()
    dialog = window.findChild(QtGui.QDialog, "BeltGrinding_Manual")
    if dialog is None:
        dialog = QtGui.QDialog(window)
        dialog.setObjectName("BeltGrinding_Manual")
        dialog.setWindowTitle(translate("BeltGrinding", "Belt grinding: manual"))
        dialog.resize(*SIZE)
        view = ManualView(dialog)
        bar = QtGui.QHBoxLayout()
        for text, action in (
            (translate("BeltGrinding", "Back"), view.backward),
            (translate("BeltGrinding", "Contents"), show_manual),  # home: the page that came first
        ):
            button = QtGui.QPushButton(text, dialog)
            button.setAutoDefault(False)
            button.clicked.connect(lambda *_, action=action: action())
            bar.addWidget(button)
        bar.addStretch()
        column = QtGui.QVBoxLayout(dialog)
        column.addLayout(bar)
        column.addWidget(view)
    dialog.show()
    dialog.raise_()
    view = dialog.findChild(QtGui.QTextBrowser)
    view.setSource(QtCore.QUrl.fromLocalFile(str(Path(documentation(), page))))
    return dialog


class HelpKey(QtCore.QObject):
    """F1 in a panel or a dock of ours opens its page of the manual; elsewhere F1 is FreeCAD's."""

    def eventFilter(self, window: Any, event: QtEvent) -> bool:
        # FreeCAD's shortcuts ask for a key first; the key itself does not come this far from a task panel.
        if event.type() != QtCore.QEvent.ShortcutOverride or event.key() != QtCore.Qt.Key_F1:
            return False
        page = page_of(QtGui.QApplication.focusWidget())
        if page:
            event.accept()
            QtCore.QTimer.singleShot(0, lambda: show_manual(page))
        return bool(page)


help_key = HelpKey()


class Manual:
    """The command."""

    NAME = "BeltGrinding_Manual"

    def GetResources(self) -> dict[str, str]:
        return {
            "Pixmap": icon(self.NAME),
            "MenuText": QT_TRANSLATE_NOOP("BeltGrinding_Manual", "Help"),
            "ToolTip": QT_TRANSLATE_NOOP(
                "BeltGrinding_Manual", "Opens the manual: tutorial, every panel, troubleshooting"
            ),
            "WhatsThis": self.NAME,
            "CmdType": "ForEdit",  # changes nothing: stays there while a panel is open
        }

    def IsActive(self) -> bool:
        return True

    def Activated(self, index: int = 0) -> None:
        show_manual()
