"""What varies in a study: for each key of the job how its values come, and the values."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from ...engine import InputError
from ..common import field_words
from ..common.compat import QtGui, translate
from ..common.kinds import Json, Texts, Widget
from .steady import steady

NUMBERS = {  # kind: its numbers, in order
    "range": ("lower", "upper"),
    "normal": ("mean", "sd"),
    "uniform": ("lower", "upper"),
    "lognormal": ("mean", "sd"),
    "triangular": ("lower", "mode", "upper"),
    "weibull": ("scale", "shape"),
}


HOWS = {"set": "=", "add": "+", "multiply": "×"}


def kinds() -> dict[str, str]:
    """{kind: text}"""
    return {
        "range": translate("BeltGrinding", "from … to"),
        "values": translate("BeltGrinding", "values"),
        "normal": translate("BeltGrinding", "normal: mean, std. dev."),
        "uniform": translate("BeltGrinding", "uniform: from, to"),
        "triangular": translate("BeltGrinding", "triangular: from, mode, to"),
        "lognormal": translate("BeltGrinding", "lognormal: mean, std. dev."),
        "weibull": translate("BeltGrinding", "Weibull: scale, shape"),
    }


class VariedRows(QtGui.QWidget):
    """``entries()`` gives the study's ``vary``; ``changed()`` tells. ``texts``: {key: what it is}."""

    def __init__(self, entries: Iterable[Json], texts: Texts) -> None:
        super().__init__()
        self.setObjectName("varied")
        self.changed, self.texts = lambda: None, texts
        self.rows: list[_Row] = []
        self.layout_ = QtGui.QVBoxLayout(self)
        self.layout_.setContentsMargins(0, 0, 0, 0)
        self.layout_.setSpacing(6)
        for entry in entries:
            self.add(entry)

    def add(self, entry: Json) -> None:
        """Adds a row for an entry of a study's ``vary``."""
        row = _Row(entry, self.texts.get(entry["key"], entry["key"]))
        row.changed = lambda: self.changed()
        row.gone = lambda: self.remove(row)
        self.rows.append(row)
        self.layout_.addWidget(row)
        self._number()

    def remove(self, row: _Row) -> None:
        """Takes a row away."""
        self.rows.remove(row)
        self.layout_.removeWidget(row)
        row.hide()
        row.deleteLater()
        self._number()
        self.changed()

    def _number(self) -> None:
        for number, row in enumerate(self.rows, 1):
            row.number(number)

    def entries(self) -> list[dict[str, Any]]:
        """A study's ``vary``. Raises InputError for values that are none."""
        return [row.entry() for row in self.rows]


class _Row(QtGui.QFrame):
    """A key of the job, and below it how it varies."""

    def __init__(self, entry: Json, about: str) -> None:
        super().__init__()
        self.changed = self.gone = lambda: None
        shown = ("how", "range", "values", "distribution")
        self.kept = {k: v for k, v in entry.items() if k not in shown}
        self.given = entry.get("distribution", {})  # its ends, which are not shown, are kept
        body = QtGui.QGridLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        body.setSpacing(2)
        name = entry.get("name")
        told = field_words.label(entry["key"]) or entry["key"]
        key = QtGui.QLabel(told if name is None else f"{name} ({told})")
        key.setToolTip(f"{about} ({entry['key']})" if about != entry["key"] else about)
        key.setWordWrap(True)
        key.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Preferred)
        self.away = QtGui.QToolButton()
        self.away.setText("×")
        self.away.setAutoRaise(True)
        self.away.setToolTip(translate("BeltGrinding", "It does not vary"))
        self.away.clicked.connect(lambda: self.gone())
        self.how = self._choices(HOWS, entry.get("how", "set"), 44)
        kind, text = _told(entry)
        self.kind = self._choices(kinds(), kind, 88)
        self.values = QtGui.QLineEdit(text)
        self.values.setMinimumWidth(60)
        self.values.textChanged.connect(lambda _: self.changed())
        body.addWidget(key, 0, 0, 1, 3)
        body.addWidget(self.away, 0, 3)
        body.addWidget(self.how, 1, 0)
        body.addWidget(self.kind, 1, 1)
        body.addWidget(self.values, 1, 2, 1, 2)
        body.setColumnStretch(2, 1)
        if "parts" in entry:
            for widget in (self.how, self.kind, self.values):
                widget.setEnabled(False)

    def _choices(self, texts: Texts, chosen: str, width: int) -> Widget:
        box = steady(QtGui.QComboBox())
        for key, text in texts.items():
            box.addItem(text, key)
        box.setCurrentIndex(max(box.findData(chosen), 0))
        box.setFixedWidth(width)
        box.view().setMinimumWidth(190)
        box.setToolTip(box.currentText())

        def other(_: int) -> None:
            box.setToolTip(box.currentText())
            self.changed()

        box.currentIndexChanged.connect(other)
        return box

    def number(self, number: int) -> None:
        """Gives its widgets the names by which they are found."""
        for widget, name in (
            (self.how, "variedHow"),
            (self.kind, "variedKind"),
            (self.values, "variedValues"),
            (self.away, "removeVaried"),
        ):
            widget.setObjectName(f"{name}{number}")

    def entry(self) -> dict[str, Any]:
        """Its entry of a study's ``vary``. Raises InputError for values that are none."""
        entry = dict(self.kept)
        if "parts" in entry:
            return entry
        kind, how = self.kind.currentData(), self.how.currentData()
        if how != "set":
            entry["how"] = how
        values = _values(self.values.text())
        if kind == "values":
            if not values:
                raise _unreadable(entry["key"], kinds()[kind])
            return {**entry, "values": values}
        names = NUMBERS[kind]
        numbers = [v for v in values if isinstance(v, float)]
        entry.pop("steps", None)
        if len(numbers) == len(names) + 1 and numbers[-1] >= 1.0 and numbers[-1].is_integer():
            entry["steps"] = int(numbers.pop())
        if len(numbers) != len(names) or len(values) not in (len(names), len(names) + 1):
            raise _unreadable(entry["key"], kinds()[kind])
        if kind == "range":
            return {**entry, "range": numbers}
        ends = self.given if self.given.get("kind") == kind else {}
        return {**entry, "distribution": {**ends, "kind": kind, **dict(zip(names, numbers))}}


def _unreadable(key: str, kind: str) -> InputError:
    return InputError(
        "gui.varied_values",
        "{key}: give the numbers of '{kind}', with blanks or semicolons between them",
        key=key,
        kind=kind,
    )


def _told(entry: Json) -> tuple[str, str]:
    """(kind, text of the values) of an entry."""
    if "parts" in entry:
        return "values", translate("BeltGrinding", "{} parts").format(len(entry["parts"]))
    steps = [entry["steps"]] if "steps" in entry else []
    if "range" in entry:
        return "range", "  ".join(_text(value) for value in [*entry["range"], *steps])
    if "values" in entry:
        return "values", "  ".join(_text(value) for value in entry["values"])
    given = entry["distribution"]
    numbers = [given[name] for name in NUMBERS[given["kind"]] if name in given]
    return given["kind"], "  ".join(_text(value) for value in [*numbers, *steps])


def _text(value: Any) -> str:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if number:
        return f"{value:g}" if float(f"{value:g}") == value else repr(value)
    return value if isinstance(value, str) else json.dumps(value, allow_nan=False)


def _values(text: str) -> list[Any]:
    """Numbers and words of a text, between blanks or semicolons; a decimal comma is one."""
    found: list[float | bool | str] = []
    for word in text.replace(";", " ").replace("…", " ").replace("−", "-").split():
        try:
            found.append(float(word.replace(",", ".")))
        except ValueError:
            found.append({"true": True, "false": False}.get(word, word))
    return found
