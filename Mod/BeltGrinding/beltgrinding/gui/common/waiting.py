"""Work that the window waits for without standing still: in a thread, with a dialog that can cancel."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCADGui as Gui

from ...engine import Cancelled
from .compat import QtCore, QtGui, translate
from .kinds import Context, Widget
from .runner import Background
from .task_progress import Follower

PATIENCE = 0.2  # s; what is done by then needs no dialog
WIDTH = 400  # pixels


def wait(work: Callable[[Context], Any], text: str) -> Any:
    """What ``work(context)`` gives, or raises; meanwhile a dialog says ``text``. Cancelled as soon as
    its Cancel is pressed, even if the work does not notice: it ends in its thread, unheard.
    """
    loop, outcome = QtCore.QEventLoop(), []

    def done(result: Any, error: BaseException | None) -> None:
        outcome.append((result, error))
        loop.quit()

    background = Background(work, done)
    background.thread.join(PATIENCE)
    if not background.thread.is_alive():
        background.forget()
        return _given(*background.outcome)
    dialog, bar = _dialog(text)
    follower = Follower(bar, dialog.setLabelText)
    follower.follow(background, text)
    dialog.canceled.connect(loop.quit)
    try:
        dialog.show()
        (loop.exec_ if hasattr(loop, "exec_") else loop.exec)()
    finally:
        follower.end()
        dialog.canceled.disconnect(loop.quit)
        dialog.close()
        dialog.deleteLater()
    if not outcome:
        background.abandon()
        raise Cancelled(translate("BeltGrinding", "cancelled"))
    return _given(*outcome[0])


def _given(result: Any, error: BaseException | None) -> Any:
    if error is not None:
        raise error
    return result


def _dialog(text: str) -> tuple[Widget, Widget]:
    """A QProgressDialog and its bar: these FreeCAD lets have clicks and keys where it shows its wait cursor, as its
    own import commands do.
    """
    dialog = QtGui.QProgressDialog(Gui.getMainWindow())
    dialog.setObjectName("BeltGrinding_Waiting")
    dialog.setWindowTitle(translate("BeltGrinding", "Belt grinding"))
    dialog.setLabelText(text)
    dialog.setCancelButtonText(translate("BeltGrinding", "Cancel"))
    bar = QtGui.QProgressBar()
    bar.setTextVisible(False)
    dialog.setBar(bar)
    dialog.setMinimumWidth(WIDTH)
    dialog.setMinimumDuration(2**31 - 1)  # shown when it is needed, not by a guess
    dialog.setWindowModality(QtCore.Qt.ApplicationModal)
    dialog.setAutoClose(False)
    return dialog, bar
