"""What is looked for among a study's runs: a figure that is to be least or greatest, and a limit of another."""

from ...engine import InputError
from ..common.compat import QtGui, translate
from .steady import steady


class BestForm(QtGui.QWidget):
    """``wanted()`` gives ``best`` of a study's answers, None where nothing is looked for; ``changed()`` tells. Limits that the
    form has no room for are kept. ``figures``: {name: text}."""

    def __init__(self, best, figures):
        super().__init__()
        self.changed = lambda: None
        best = best or {}
        self.kept = dict(best)
        body = QtGui.QFormLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        body.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.figure = self._figures("bestFigure", figures, best.get("figure"))
        self.goal = steady(QtGui.QComboBox())
        self.goal.setObjectName("bestGoal")
        self.goal.addItem(translate("BeltGrinding", "least"), "minimise")
        self.goal.addItem(translate("BeltGrinding", "greatest"), "maximise")
        self.goal.setCurrentIndex(max(self.goal.findData(best.get("goal")), 0))
        limits = dict(best.get("limits", {}))
        first = next(iter(limits), None)
        low, high = limits.pop(first, (None, None))
        self.others = limits
        self.limit = self._figures("bestLimit", figures, first)
        self.low, self.high = (self._end(n, v) for n, v in (("bestLow", low), ("bestHigh", high)))
        ends = QtGui.QHBoxLayout()
        for widget in (self.low, QtGui.QLabel("…"), self.high):
            ends.addWidget(widget)
        self.passing = QtGui.QCheckBox(translate("BeltGrinding", "only runs that pass"))
        self.passing.setObjectName("bestPassing")
        self.passing.setChecked(best.get("passing", False))
        self.surface = QtGui.QCheckBox(translate("BeltGrinding", "also between the runs"))
        self.surface.setObjectName("bestSurface")
        self.surface.setChecked(best.get("surface", False))
        body.addRow(translate("BeltGrinding", "Figure"), self.figure)
        body.addRow(translate("BeltGrinding", "Wanted"), self.goal)
        body.addRow(translate("BeltGrinding", "Limit of"), self.limit)
        body.addRow(translate("BeltGrinding", "From … to"), ends)
        body.addRow(self.passing)
        body.addRow(self.surface)
        for box in (self.figure, self.goal, self.limit):
            box.currentIndexChanged.connect(lambda _: self.changed())
        for line in (self.low, self.high):
            line.textChanged.connect(lambda _: self.changed())
        for box in (self.passing, self.surface):
            box.toggled.connect(lambda _: self.changed())

    def _figures(self, name, figures, chosen):
        box = steady(QtGui.QComboBox())
        box.setObjectName(name)
        box.addItem(translate("BeltGrinding", "none"), None)
        for key, text in figures.items():
            box.addItem(text, key)
        if chosen is not None and chosen not in figures:
            box.addItem(chosen, chosen)
        box.setCurrentIndex(max(box.findData(chosen), 0))
        box.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        box.setMinimumContentsLength(8)
        return box

    def _end(self, name, value):
        line = QtGui.QLineEdit("" if value is None else f"{value:g}")
        line.setObjectName(name)
        line.setMinimumWidth(40)
        line.setPlaceholderText(translate("BeltGrinding", "none"))
        return line

    def wanted(self):
        """Raises InputError for a limit that is no number."""
        figure, limit = self.figure.currentData(), self.limit.currentData()
        if figure is None:
            return None
        limits = {}
        if limit is not None:
            limits[limit] = [self._number(self.low), self._number(self.high)]
        return {
            **self.kept,
            "figure": figure,
            "goal": self.goal.currentData(),
            "limits": {**limits, **self.others},
            "passing": self.passing.isChecked(),
            "surface": self.surface.isChecked(),
        }

    def _number(self, line):
        text = line.text().strip().replace(",", ".")
        if not text:
            return None
        try:
            return float(text)
        except ValueError:
            raise InputError(
                "gui.best_limit", "'{text}' is no number: give the limit, or nothing", text=text
            ) from None
