"""How far a work in the background is: bar, time left and Cancel, in a panel, a dialog or anywhere."""

from __future__ import annotations

import time
from collections.abc import Callable

from .compat import QtCore, QtGui, translate
from .kinds import Widget
from .runner import Background
from .status_progress import painted_once
from .time_left import TimeLeft, duration

LOOK = 250  # ms between two looks
STEPS = 1000  # of a bar


def told(text: str, left: float | None) -> str:
    """What goes on, with the seconds that are left, None: not known."""
    if left is None:
        return text
    return text + translate("BeltGrinding", "; about {} left").format(duration(left))


class Follower(QtCore.QObject):
    """Shows a work's progress in a bar, and by ``say(text)``. A bar whose work goes through phases that each begin
    anew says only that it goes on."""

    def __init__(self, bar: Widget, say: Callable[[str], object]) -> None:
        super().__init__(bar)
        self.bar, self.say = bar, say
        self.task: Background | None = None
        self.timer = QtCore.QTimer(self)
        self.timer.timeout.connect(self.look)

    def follow(self, task: Background, text: str) -> None:
        """Shows a work that has just begun."""
        self.task, self.text, self.start = task, text, time.monotonic()
        self.left, self.share, self.known = TimeLeft(), 0.0, True
        self.bar.setRange(0, 0)
        self.say(text)
        self.timer.start(LOOK)

    def look(self) -> None:
        """Shows how far it is now."""
        if self.task is None or not self.task.thread.is_alive():
            self.end()
            return
        share, seconds = self.task.context.progress, time.monotonic() - self.start
        self.known &= share >= self.share
        self.share = share
        left = self.left.update(seconds, share) if self.known else None
        if self.known and share > 0.0:
            self.bar.setRange(0, STEPS)
            self.bar.setValue(int(STEPS * share))
        else:
            self.bar.setRange(0, 0)
        self.say(told(f"{self.text}, {duration(seconds)}", left))

    def end(self) -> None:
        """It has ended."""
        self.task = None
        self.timer.stop()


class TaskRow(QtGui.QWidget):
    """A panel's rows of the work that it does in the background; hidden while there is none."""

    def __init__(self) -> None:
        super().__init__()
        rows = QtGui.QGridLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        self.text = QtGui.QLabel()
        self.text.setObjectName("taskText")
        self.text.setWordWrap(True)
        bar = QtGui.QProgressBar()
        bar.setObjectName("taskBar")
        bar.setTextVisible(False)
        self.button = QtGui.QPushButton(translate("BeltGrinding", "Cancel"))
        self.button.setObjectName("taskCancel")
        self.button.clicked.connect(self.cancel)
        rows.addWidget(self.text, 0, 0, 1, 2)
        rows.addWidget(bar, 1, 0)
        rows.addWidget(self.button, 1, 1)
        rows.setColumnStretch(0, 1)
        self.follower = Follower(bar, self._say)
        self.hide()

    def follow(self, task: Background, text: str) -> None:
        """Shows a work until it has ended, or ``end``."""
        self.button.setEnabled(True)
        self.follower.follow(task, text)
        self.show()

    def cancel(self) -> None:
        """Asks the work to end; whoever began it hears of that."""
        if self.follower.task is not None:
            self.button.setEnabled(False)
            self.follower.task.cancel()

    def end(self) -> None:
        """Hides it: what it showed has ended, or nobody waits for it any more."""
        self.follower.end()
        self.hide()

    def _say(self, text: str) -> None:
        with painted_once(self):
            self.text.setText(text)
