"""Limits of a run's figures, under which the best setting is looked for: a figure each, its least and its greatest value."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ...engine import InputError
from ..common.compat import QtGui, translate
from ..common.kinds import Texts, Widget
from .rows import Row, Rows, none_text, number, shown


class LimitRows(Rows):
    """``values()`` gives pairs (figure, [least, greatest]), None where there is no such end."""

    def __init__(self, limits: Mapping[str, Sequence[float | None]], figures: Texts) -> None:
        """``limits``: {figure: [least, greatest]}; ``figures``: {name: text}."""
        super().__init__("limit", translate("BeltGrinding", "Add limit"))
        self.figures, self.check = figures, self._each_once
        for figure, ends in limits.items():
            self.add(_Limit(figure, ends, figures))

    def added(self) -> None:
        taken = {row.figure.currentData() for row in self.rows}
        free = next((name for name in self.figures if name not in taken), None)
        self.add(_Limit(free, [None, None], self.figures))
        self.changed()

    def _each_once(self, found: Sequence[tuple[str, Any]]) -> None:
        taken = set()
        for row, (name, _) in zip(self.rows, found):
            if name in taken:
                row.wrong(row.figure)
                raise InputError(
                    "gui.limit_twice",
                    "{figure}: has a limit already; give both ends there",
                    figure=row.figure.currentText(),
                )
            taken.add(name)


class _Limit(Row):
    """A figure, and below it its ends."""

    def __init__(self, figure: str | None, ends: Sequence[float | None], figures: Texts) -> None:
        super().__init__(translate("BeltGrinding", "It has no limit"))
        self.figure = self.choices(figures, figure)
        self.low, self.high = (self.entry(shown(value), none_text()) for value in ends)
        self.low.setToolTip(translate("BeltGrinding", "Least value; empty: none"))
        self.high.setToolTip(translate("BeltGrinding", "Greatest value; empty: none"))
        self.grid.addWidget(self.figure, 0, 0, 1, 3)
        self.grid.addWidget(self.away, 0, 3)
        self.grid.addWidget(self.low, 1, 0)
        self.grid.addWidget(QtGui.QLabel("…"), 1, 1)
        self.grid.addWidget(self.high, 1, 2, 1, 2)
        self.grid.setColumnStretch(0, 1)
        self.grid.setColumnStretch(2, 1)

    def number(self, k: int) -> None:
        for widget, name in (
            (self.figure, "limitFigure"),
            (self.low, "limitLow"),
            (self.high, "limitHigh"),
            (self.away, "removeLimit"),
        ):
            widget.setObjectName(f"{name}{k}")

    def value(self) -> tuple[str, list[float | None]]:
        low, high = self._end(self.low), self._end(self.high)
        if low is not None and high is not None and low > high:
            self.wrong(self.high)
            raise InputError(
                "gui.limit_swapped",
                "{figure}: the least value, {low:g}, lies above the greatest, {high:g}",
                figure=self.figure.currentText(),
                low=low,
                high=high,
            )
        return self.figure.currentData(), [low, high]

    def _end(self, line: Widget) -> float | None:
        try:
            return number(line.text())
        except ValueError:
            self.wrong(line)
            raise InputError(
                "gui.best_limit",
                "'{text}' is no number: give the limit, or nothing",
                text=line.text().strip(),
            ) from None
