"""What is looked for among a study's runs: a figure that is to be least or greatest, and limits of others."""

from __future__ import annotations

from typing import Any

from ..common.compat import QtGui, translate
from ..common.kinds import Json, Texts
from .limit_rows import LimitRows
from .rows import choose
from .steady import steady


class BestForm(QtGui.QWidget):
    """``wanted()`` gives ``best`` of a study's answers, None where nothing is looked for; ``changed()`` tells. ``figures``:
    {name: text}."""

    def __init__(self, best: Json | None, figures: Texts) -> None:
        super().__init__()
        self.changed = lambda: None
        best = best or {}
        self.kept = dict(best)
        body = QtGui.QFormLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        body.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.figure = steady(QtGui.QComboBox())
        self.figure.setObjectName("bestFigure")
        none = translate("BeltGrinding", "none")
        choose(self.figure, {None: none, **figures}, best.get("figure"))
        self.figure.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.figure.setMinimumContentsLength(8)
        self.goal = steady(QtGui.QComboBox())
        self.goal.setObjectName("bestGoal")
        self.goal.addItem(translate("BeltGrinding", "least"), "minimise")
        self.goal.addItem(translate("BeltGrinding", "greatest"), "maximise")
        self.goal.setCurrentIndex(max(self.goal.findData(best.get("goal")), 0))
        self.limits = LimitRows(best.get("limits", {}), figures)
        self.limits.changed = lambda: self.changed()
        self.passing = QtGui.QCheckBox(translate("BeltGrinding", "only runs that pass"))
        self.passing.setObjectName("bestPassing")
        self.passing.setChecked(best.get("passing", False))
        self.surface = QtGui.QCheckBox(translate("BeltGrinding", "also between the runs"))
        self.surface.setObjectName("bestSurface")
        self.surface.setChecked(best.get("surface", False))
        body.addRow(translate("BeltGrinding", "Figure"), self.figure)
        body.addRow(translate("BeltGrinding", "Wanted"), self.goal)
        title = QtGui.QLabel(translate("BeltGrinding", "Limits: least … greatest"))
        title.setWordWrap(True)
        body.addRow(title)
        body.addRow(self.limits)
        body.addRow(self.passing)
        body.addRow(self.surface)
        for box in (self.figure, self.goal):
            box.currentIndexChanged.connect(lambda _: self.changed())
        for box in (self.passing, self.surface):
            box.toggled.connect(lambda _: self.changed())

    def wanted(self) -> dict[str, Any] | None:
        """Raises InputError for a limit that cannot be."""
        limits, figure = self.limits.values(), self.figure.currentData()
        if figure is None:
            return None
        return {
            **self.kept,
            "figure": figure,
            "goal": self.goal.currentData(),
            "limits": dict(limits),
            "passing": self.passing.isChecked(),
            "surface": self.surface.isChecked(),
        }

    def summary(self) -> str:
        """What is looked for, in a line."""
        if self.figure.currentData() is None:
            return ""
        return f"{self.goal.currentText()} {self.figure.currentText()}"
