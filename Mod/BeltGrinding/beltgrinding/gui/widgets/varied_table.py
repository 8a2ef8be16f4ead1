"""What varies in a study, as a table: a row a key of the job, how its values come, and the values."""

import json

from ...engine import InputError
from ..common.compat import QtCore, QtGui, translate
from .steady import steady

NUMBERS = {  # kind: its numbers, in order
    "range": ("lower", "upper"),
    "normal": ("mean", "sd"),
    "uniform": ("lower", "upper"),
    "lognormal": ("mean", "sd"),
    "triangular": ("lower", "mode", "upper"),
    "weibull": ("scale", "shape"),
}
ROW, LEAST_ROWS = 26, 3  # pixels; rows
KEY, HOW, KIND, VALUES = range(4)


def kinds():
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


def hows():
    """{how: text}"""
    return {
        "set": translate("BeltGrinding", "="),
        "add": translate("BeltGrinding", "+"),
        "multiply": translate("BeltGrinding", "×"),
    }


class VariedTable(QtGui.QTableWidget):
    """``entries()`` gives the study's ``vary``; ``changed()`` tells."""

    def __init__(self, entries):
        super().__init__(0, 4)
        self.setObjectName("varied")
        self.changed = lambda: None
        self.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Key of the job"),
                "",
                translate("BeltGrinding", "How"),
                translate("BeltGrinding", "Values"),
            ]
        )
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(ROW)
        self.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        header = self.horizontalHeader()
        header.setSectionResizeMode(KEY, QtGui.QHeaderView.Stretch)
        header.setSectionResizeMode(VALUES, QtGui.QHeaderView.Stretch)
        header.setMinimumSectionSize(28)
        self.setColumnWidth(HOW, 34)
        self.setColumnWidth(KIND, 62)
        self.kept = []  # of each row, what of its entry the table does not show
        for entry in entries:
            self.add(entry)
        self.itemChanged.connect(lambda _: self.changed())

    def add(self, entry):
        """Adds a row for an entry of a study's ``vary``."""
        before = self.blockSignals(True)
        row = self.rowCount()
        self.insertRow(row)
        key = QtGui.QTableWidgetItem(entry.get("name") or entry["key"])
        key.setToolTip(entry["key"])
        key.setFlags(key.flags() & ~QtCore.Qt.ItemIsEditable)
        self.setItem(row, KEY, key)
        self._choices(row, HOW, hows(), entry.get("how", "set"))
        kind, text = _told(entry)
        self._choices(row, KIND, kinds(), kind)
        self.setItem(row, VALUES, QtGui.QTableWidgetItem(text))
        shown = ("how", "range", "values", "distribution", "key")
        self.kept.append({k: v for k, v in entry.items() if k not in shown})
        self.kept[-1]["key"] = entry["key"]
        if "parts" in entry:
            for column in (HOW, KIND):
                self.cellWidget(row, column).setEnabled(False)
            item = self.item(row, VALUES)
            item.setFlags(item.flags() & ~QtCore.Qt.ItemIsEditable)
        self._fit()
        self.blockSignals(before)

    def _choices(self, row, column, texts, chosen):
        box = steady(QtGui.QComboBox())
        box.setObjectName(f"varied{('Key', 'How', 'Kind')[column]}{row + 1}")
        for key, text in texts.items():
            box.addItem(text, key)
        box.setCurrentIndex(max(box.findData(chosen), 0))
        box.setToolTip(box.currentText())
        box.view().setMinimumWidth(170)
        box.currentIndexChanged.connect(lambda _: (box.setToolTip(box.currentText()), self.changed()))
        self.setCellWidget(row, column, box)

    def _fit(self):
        rows = max(self.rowCount(), LEAST_ROWS)
        self.setFixedHeight(self.horizontalHeader().sizeHint().height() + ROW * rows + 4)

    def remove_chosen(self):
        """Removes the rows that are chosen, else the last."""
        rows = {index.row() for index in self.selectionModel().selectedRows()}
        for row in sorted(rows or {self.rowCount() - 1} - {-1}, reverse=True):
            self.removeRow(row)
            del self.kept[row]
        self._fit()
        self.changed()

    def entries(self):
        """A study's ``vary``. Raises InputError for values that are none."""
        return [self._entry(row) for row in range(self.rowCount())]

    def _entry(self, row):
        entry = dict(self.kept[row])
        if "parts" in entry:
            return entry
        kind = self.cellWidget(row, KIND).currentData()
        how = self.cellWidget(row, HOW).currentData()
        if how != "set":
            entry["how"] = how
        values = _values(self.item(row, VALUES).text())
        if kind == "values":
            if not values:
                raise _unreadable(entry["key"], kinds()[kind])
            return {**entry, "values": values}
        names = NUMBERS[kind]
        numbers = [v for v in values if isinstance(v, (int, float)) and not isinstance(v, bool)]
        if len(numbers) != len(names) or len(values) != len(names):
            raise _unreadable(entry["key"], kinds()[kind])
        if kind == "range":
            return {**entry, "range": numbers}
        return {**entry, "distribution": {"kind": kind, **dict(zip(names, numbers))}}


def _unreadable(key, kind):
    return InputError(
        "gui.varied_values",
        "{key}: give the numbers of '{kind}', with blanks or semicolons between them",
        key=key,
        kind=kind,
    )


def _told(entry):
    """(kind, text of the values) of an entry."""
    if "parts" in entry:
        return "values", translate("BeltGrinding", "{} parts").format(len(entry["parts"]))
    if "range" in entry:
        return "range", "  ".join(_text(value) for value in entry["range"])
    if "values" in entry:
        return "values", "  ".join(_text(value) for value in entry["values"])
    given = entry["distribution"]
    return given["kind"], "  ".join(_text(given[n]) for n in NUMBERS[given["kind"]] if n in given)


def _text(value):
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if number:
        return f"{value:g}" if float(f"{value:g}") == value else repr(value)
    return value if isinstance(value, str) else json.dumps(value)


def _values(text):
    """Numbers and words of a text, between blanks or semicolons; a decimal comma is one."""
    found = []
    for word in text.replace(";", " ").replace("…", " ").replace("−", "-").split():
        try:
            found.append(float(word.replace(",", ".")))
        except ValueError:
            found.append({"true": True, "false": False}.get(word, word))
    return found
