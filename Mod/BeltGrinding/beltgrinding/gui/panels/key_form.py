"""A part of the job's panel that edits a property which holds a key of the job's file as a text."""

from __future__ import annotations

import copy
import json
import math
from typing import Any

from ...base import schemas
from ...engine import InputError
from ...objects.job_data import KEYS
from ...objects.kinds import DocumentObject
from ...objects.properties import get_value, rule
from ..common.compat import QtGui, translate
from ..common.kinds import Widget
from ..common.messages import error_text
from ..common.theme import warning_style
from ..widgets.form import WRONG
from ..widgets.rows import number
from ..widgets.steady import steady
from .panel import breakable

LINE = 40  # pixels, the least width of a line: a panel must fit the dock as FreeCAD opens it


class KeyForm(QtGui.QGroupBox):
    """Edits a JSON property of a job, empty: it has none of it. A choice on top, lines for numbers, and below them a text
    that tells what is wrong or is to be known. A subclass makes its rows, then calls ``begin``; ``values``: what the job has,
    a dict as its file would, or None. ``changed()`` is called after each change of the property.
    """

    def __init__(self, job: DocumentObject, name: str, title: str, choice: str) -> None:
        """``name``: of the property; ``choice``: the object name of the list of choices."""
        super().__init__(title)
        self.job, self.changed = job, lambda: None
        self.key = next(key for key in KEYS if key.name == name)
        self.values: dict[str, Any] | None = None
        self.fields: dict[Any, Widget] = {}
        self.rows = QtGui.QFormLayout(self)
        self.rows.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.box = steady(QtGui.QComboBox())
        self.box.setObjectName(choice)

    def entry(self, key: Any, name: str) -> Widget:
        """A line for a number, called ``name``; ``read`` and ``show_values`` know it by ``key``."""
        line = QtGui.QLineEdit()
        line.setObjectName(name)
        line.setMinimumWidth(LINE)
        line.textEdited.connect(lambda _: self.typed())
        self.fields[key] = line
        return line

    def begin(self, note: str) -> None:
        """Adds the text below the rows, called ``note``, and shows what the job has. What was written by hand and is none is
        told, and stays until something is chosen here."""
        self.told = QtGui.QLabel()
        self.told.setObjectName(note)
        self.told.setWordWrap(True)
        self.rows.addRow(self.told)
        error = None
        try:
            given = get_value(self.job, self.key)
            if given is not None:
                given = schemas.checked(given, rule(self.key.key)[0], self.key.key)
            self.values = given
        except InputError as found:
            error = found
        self.show_values()
        if error is not None:
            self.warn(error)
        self.box.currentIndexChanged.connect(self.chosen)

    def chosen(self, index: int) -> None:
        """Another choice was made in the list."""
        raise NotImplementedError

    def index(self) -> int:
        """The choice that shows ``values``."""
        raise NotImplementedError

    def shown(self, key: Any) -> str:
        """The text of a line where there are values."""
        raise NotImplementedError

    def reason(self, key: Any, value: float | None) -> str:
        """What is wrong with the number of a line, None of an empty one; "": nothing."""
        raise NotImplementedError

    def put(self, values: dict[str, Any], key: Any, value: Any) -> None:
        """Puts the number of a line, None of an empty one, into values."""
        raise NotImplementedError

    def mistake(self, text: str, reason: str) -> InputError:
        """The InputError for a line."""
        raise NotImplementedError

    def lines(self) -> list[str]:
        """What is to be known of the values, a list of lines."""
        raise NotImplementedError

    def show_choice(self) -> None:
        """Brings the list of choices up to date."""
        self.box.blockSignals(True)
        self.box.setCurrentIndex(self.index())
        self.box.blockSignals(False)

    def show_values(self) -> None:
        """Shows what the job has."""
        self.show_choice()
        for key, line in self.fields.items():
            line.setEnabled(self.values is not None)
            line.setStyleSheet("")
            line.setText("" if self.values is None else self.shown(key))
        self.tell()

    def typed(self) -> None:
        """Takes over what stands in the lines; what cannot be is told below them, and again by OK."""
        try:
            self.values = self.read()
        except InputError:
            return
        self.show_choice()
        self.tell()
        self.write()

    def read(self) -> dict[str, Any] | None:
        """The property's value of what stands in the lines, None where there is none. Marks what cannot be, tells it, and
        raises InputError.
        """
        if self.values is None:
            return None
        found, error = copy.deepcopy(self.values), None
        for key, line in self.fields.items():
            line.setStyleSheet("")
            text = line.text().strip()
            try:
                value = number(text)
                wrong = value is not None and not math.isfinite(value)
            except ValueError:
                wrong = True
            if wrong:
                reason = translate("BeltGrinding", "This is no number: {}").format(text)
            else:
                reason = self.reason(key, value)
            if reason:
                line.setStyleSheet(WRONG)
                error = error or self.mistake(text, reason)
            else:
                self.put(found, key, value)
        if error is not None:
            self.warn(error)
            raise error
        return found

    def warn(self, error: BaseException) -> None:
        """Tells an error below the lines."""
        self.told.setStyleSheet(warning_style())
        self.told.setText(breakable(error_text(error)))

    def tell(self) -> None:
        """Tells what is to be known of the values."""
        self.told.setStyleSheet("")
        self.told.setText("\n".join([] if self.values is None else self.lines()))

    def write(self) -> None:
        """Writes the values into the property."""
        text = "" if self.values is None else json.dumps(self.values, allow_nan=False)
        if getattr(self.job, self.key.name) != text:
            setattr(self.job, self.key.name, text)
            self.changed()

    def check(self) -> None:
        """Raises InputError for the first line with a mistake."""
        self.read()
