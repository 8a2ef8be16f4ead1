"""The examples by topic: a picture and a sentence each, to set up or to run."""

from __future__ import annotations

from collections.abc import Callable

import FreeCAD
import FreeCADGui as Gui

from ..common.compat import QtCore, QtGui, translate
from ..common.help_pages import helped
from ..common.icons import qicon
from ..common.kinds import Widget
from ..common.messages import report

NAME = "BeltGrinding_ExamplesDock"
PICTURE, ROW = 64, 24  # pixels of the picture, and of one in the list
WIDTH = 280  # pixels
EXAMPLE = QtCore.Qt.UserRole  # of an item: name of its example
Act = Callable[[str], object]  # with a name of ``examples``
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
TOPICS = (  # topic: name of ``examples``, icon, title, sentence
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Part in hand"),
        (
            (
                "tap",
                "ExampleTap",
                QT_TRANSLATE_NOOP("BeltGrinding", "Mixer tap"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "A robot holds a tap against a contact wheel that is too large for its hollow.",
                ),
            ),
            (
                "tap_belt",
                "ExampleTapBelt",
                QT_TRANSLATE_NOOP("BeltGrinding", "Tap spout on a free belt"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "A free belt wraps round the spout, and its edges cut into the hollow.",
                ),
            ),
            (
                "knife",
                "ExampleKnife",
                QT_TRANSLATE_NOOP("BeltGrinding", "Chef's knife"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "A robot that speeds up and slows down cuts the tip of a knife too deep.",
                ),
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Tool in hand"),
        (
            (
                "blade",
                "ExampleBlade",
                QT_TRANSLATE_NOOP("BeltGrinding", "Compressor blade"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "The tutorial's blade: ten passes along the span, and the wheel hits the root.",
                ),
            ),
            (
                "vane",
                "ExampleVane",
                QT_TRANSLATE_NOOP("BeltGrinding", "Blade with fillet and edges"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "A blade is ground on both sides, and its leading edge is cut too deep.",
                ),
            ),
            (
                "edges",
                "ExampleEdges",
                QT_TRANSLATE_NOOP("BeltGrinding", "Edges of a compressor blade"),
                QT_TRANSLATE_NOOP(
                    "BeltGrinding",
                    "Both edges are ground round; the verdict measures them before and after.",
                ),
            ),
        ),
    ),
)


def _in_words(text: str) -> str:
    """A text marked above, in FreeCAD's language."""
    in_language = FreeCAD.Qt.translate
    return str(in_language("BeltGrinding", text))


class ExamplesDock(QtGui.QDockWidget):
    """``set_up(name)`` makes a document of an example, ``run(name)`` grinds it, too. The dock closes then."""

    def __init__(self, set_up: Act, run: Act) -> None:
        super().__init__(translate("BeltGrinding", "Examples"), Gui.getMainWindow())
        self.setObjectName(NAME)
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        helped(self, "BeltGrinding_Examples")
        self.list = QtGui.QTreeWidget()
        self.list.setObjectName("examples")
        self.list.setHeaderHidden(True)
        self.list.setIconSize(QtCore.QSize(ROW, ROW))
        self.picture, self.sentence = QtGui.QLabel(), QtGui.QLabel()
        self.sentence.setObjectName("exampleSentence")
        self.sentence.setWordWrap(True)
        self.sentence.setTextInteractionFlags(QtCore.Qt.NoTextInteraction)
        about, row = QtGui.QHBoxLayout(), QtGui.QHBoxLayout()
        about.addWidget(self.picture)
        about.addWidget(self.sentence, 1)
        row.addWidget(self._button("setUpExample", translate("BeltGrinding", "Set up"), set_up))
        row.addWidget(self._button("runExample", translate("BeltGrinding", "Run"), run))
        panel = QtGui.QWidget()
        body = QtGui.QVBoxLayout(panel)
        body.addWidget(self.list, 1)
        body.addLayout(about)
        body.addLayout(row)
        self.setWidget(panel)
        for topic, examples in TOPICS:
            head = QtGui.QTreeWidgetItem(self.list, [_in_words(topic)])
            head.setFlags(QtCore.Qt.ItemIsEnabled)
            for example in examples:
                item = QtGui.QTreeWidgetItem(head, [_in_words(example[2])])
                item.setIcon(0, qicon(f"BeltGrinding_{example[1]}"))
                item.setData(0, EXAMPLE, example[0])
        self.list.expandAll()
        self.list.currentItemChanged.connect(lambda *_: self._describe())
        self.list.itemActivated.connect(lambda item, _: self._act(set_up))
        self.list.setCurrentItem(self.list.topLevelItem(0).child(0))
        Gui.getMainWindow().addDockWidget(QtCore.Qt.RightDockWidgetArea, self)
        Gui.getMainWindow().resizeDocks([self], [WIDTH], QtCore.Qt.Horizontal)

    def _button(self, name: str, text: str, act: Act) -> Widget:
        made = QtGui.QPushButton(text)
        made.setObjectName(name)
        made.clicked.connect(lambda *_: self._act(act))
        return made

    def _chosen(self) -> tuple[str, str, str, str] | None:
        """The row of TOPICS that is chosen; None of a topic."""
        name = self.list.currentItem().data(0, EXAMPLE)
        return next((one for _, rows in TOPICS for one in rows if one[0] == name), None)

    def _describe(self) -> None:
        chosen = self._chosen()
        if chosen is not None:
            self.picture.setPixmap(qicon(f"BeltGrinding_{chosen[1]}").pixmap(PICTURE, PICTURE))
            self.sentence.setText(_in_words(chosen[3]))

    def _act(self, act: Act) -> None:
        chosen = self._chosen()
        if chosen is None:
            return
        if Gui.Control.activeDialog():  # the panel's document is not this one's
            self.sentence.setText(
                translate("BeltGrinding", "A task panel is open: close it first.")
            )
            return
        try:
            act(chosen[0])
        except Exception as error:
            report(error)
            return
        self.close()


def show(set_up: Act, run: Act) -> None:
    """Opens the dock, the list ready for the keyboard."""
    window = Gui.getMainWindow()
    for dock in window.findChildren(QtGui.QDockWidget, NAME):
        dock.close()
    dock = ExamplesDock(set_up, run)
    dock.show()
    dock.raise_()
    dock.list.setFocus()
