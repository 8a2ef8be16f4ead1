"""Rows that are added and taken away, with what is wrong told below them: the place of a panel's short lists."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...engine import InputError
from ..common.compat import QtGui, translate
from ..common.kinds import Texts, Widget
from ..common.messages import error_text
from ..common.theme import warning_style
from .form import WRONG
from .steady import steady

CHARACTERS = (
    6  # that a list of choices shows at least: a panel must fit the dock as FreeCAD opens it
)


class Row(QtGui.QFrame):
    """A row of ``Rows``. A subclass lays its widgets out, names them in ``number(k)``, and gives its ``value()``."""

    def __init__(self, away: str) -> None:
        """``away``: what the button that takes it away says in its tooltip."""
        super().__init__()
        self.changed = self.gone = lambda: None
        self.grid = QtGui.QGridLayout(self)
        self.grid.setContentsMargins(0, 0, 0, 0)
        self.grid.setSpacing(2)
        self.away = QtGui.QToolButton()
        self.away.setText("×")
        self.away.setAutoRaise(True)
        self.away.setToolTip(away)
        self.away.clicked.connect(lambda: self.gone())

    def choices(self, texts: Texts, chosen: str | None) -> Widget:
        """A list of ``texts`` ({value: text}); ``chosen`` is offered too where it is none of them."""
        box = steady(QtGui.QComboBox())
        box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        box.setMinimumContentsLength(CHARACTERS)
        box.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        choose(box, texts, chosen)

        def other(_: int) -> None:
            box.setToolTip(box.currentText())
            self.changed()

        box.currentIndexChanged.connect(other)
        return box

    def entry(self, text: str, placeholder: str = "") -> Widget:
        """A line for a number."""
        line = QtGui.QLineEdit(text)
        line.setMinimumWidth(40)
        line.setPlaceholderText(placeholder)
        line.textChanged.connect(lambda _: self.changed())
        return line

    def number(self, k: int) -> None:
        """Gives its widgets the names by which they are found; ``k``: from 1."""
        raise NotImplementedError

    def value(self) -> Any:
        """What it holds. Raises InputError, whose widget it marks by ``wrong``."""
        raise NotImplementedError

    @staticmethod
    def wrong(widget: Widget) -> None:
        """Marks a widget whose value cannot be."""
        widget.setStyleSheet(WRONG)

    def right(self) -> None:
        """Takes the marks away."""
        for widget in self.findChildren(QtGui.QLineEdit) + self.findChildren(QtGui.QComboBox):
            if widget.styleSheet():
                widget.setStyleSheet("")


class Rows(QtGui.QWidget):
    """``values()`` gives what the rows hold; ``changed()`` tells of a change, and ``check(values)`` raises InputError for
    what they cannot be together."""

    def __init__(self, name: str, add: str) -> None:
        """``name``: its object name; ``add``: the text of the button that adds a row, called ``add`` and the name."""
        super().__init__()
        self.setObjectName(name)
        self.changed, self.check = lambda: None, lambda values: None
        self.rows: list[Row] = []
        body = QtGui.QVBoxLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        body.setSpacing(4)
        self.place = QtGui.QVBoxLayout()
        self.place.setSpacing(6)
        body.addLayout(self.place)
        self.note = QtGui.QLabel()
        self.note.setObjectName(f"{name}Note")
        self.note.setWordWrap(True)
        self.note.setStyleSheet(warning_style())
        self.note.hide()
        body.addWidget(self.note)
        self.button = QtGui.QPushButton(add)
        self.button.setObjectName(f"add{name[0].upper()}{name[1:]}")
        self.button.clicked.connect(lambda: self.added())
        body.addWidget(self.button)

    def added(self) -> None:
        """The button was pressed."""
        raise NotImplementedError

    def add(self, row: Row) -> None:
        """Takes a ``Row``."""
        row.changed = lambda: self.changed()
        row.gone = lambda: self.remove(row)
        self.rows.append(row)
        self.place.addWidget(row)
        self._number()

    def remove(self, row: Row) -> None:
        """Takes a row away."""
        self.rows.remove(row)
        self.place.removeWidget(row)
        row.hide()
        row.deleteLater()
        self._number()
        self.changed()

    def _number(self) -> None:
        for k, row in enumerate(self.rows, 1):
            row.number(k)

    def values(self) -> list[Any]:
        """[what each row holds]. What is wrong is marked and told below the rows; then it raises InputError."""
        found, error = [], None
        for row in self.rows:
            row.right()
            try:
                found.append(row.value())
            except InputError as one:
                error = error or one
        try:
            if error is not None:
                raise error
            self.check(found)
        except InputError as one:
            self.note.setText(error_text(one))
            self.note.show()
            raise
        self.note.hide()
        return found


def choose(box: Widget, texts: Mapping[Any, str], chosen: str | None) -> None:
    """Fills a list of choices anew with ``texts`` ({value: text}) and sets it; ``chosen`` is offered too where it is none of
    them."""
    box.blockSignals(True)
    box.clear()
    for value, text in texts.items():
        box.addItem(text, value)
    if chosen is not None and chosen not in texts:
        box.addItem(chosen, chosen)
    box.setCurrentIndex(max(box.findData(chosen), 0))
    box.setToolTip(box.currentText())
    box.blockSignals(False)


def number(text: str) -> float | None:
    """The number of a text, whose comma is a decimal one; None of an empty one. Raises ValueError."""
    text = text.strip().replace(",", ".").replace("−", "-")
    return float(text) if text else None


def shown(value: float | None) -> str:
    """A number as a line shows it, with no digit lost; "" for None."""
    if value is None:
        return ""
    return f"{value:g}" if float(f"{value:g}") == value else repr(value)


def none_text() -> str:
    """What an empty line stands for."""
    return translate("BeltGrinding", "none")
