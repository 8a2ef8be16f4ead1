"""Which of what varies in a study goes along with what: pairs, each with a coefficient."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ...engine import InputError
from ..common import field_words
from ..common.compat import QtGui, translate
from ..common.kinds import Json
from .rows import Row, Rows, choose, number, shown


class CorrelationRows(Rows):
    """``values()`` gives the study's ``correlations``; ``set_names`` tells it what varies now."""

    def __init__(self, pairs: Iterable[Json], names: Sequence[str]) -> None:
        """``pairs``: a study's ``correlations``; ``names``: of what varies, in order."""
        super().__init__("correlated", translate("BeltGrinding", "Add pair"))
        self.names = list(names)
        for pair in pairs:
            self.add(_Pair(pair, self.names))
        self._enable()

    def added(self) -> None:
        """A pair that is not there yet, without a correlation."""
        taken = {frozenset(row.names()) for row in self.rows}
        free = (
            (a, b)
            for k, a in enumerate(self.names)
            for b in self.names[k + 1 :]
            if frozenset((a, b)) not in taken
        )
        first = next(free, self.names[:2])
        self.add(_Pair({"between": list(first), "coefficient": 0.0}, self.names))
        self.changed()

    def set_names(self, names: Sequence[str]) -> None:
        """What varies now. A pair of what does not vary any more stays, and is told as wrong."""
        if list(names) == self.names:
            return
        self.names = list(names)
        for row in self.rows:
            row.offer(self.names)
        self._enable()

    def _enable(self) -> None:
        self.button.setEnabled(len(self.names) > 1)

    def summary(self) -> str:
        """How many pairs there are."""
        return str(len(self.rows) or "")


class _Pair(Row):
    """Two names, one above the other, and their coefficient."""

    def __init__(self, pair: Json, names: Sequence[str]) -> None:
        super().__init__(translate("BeltGrinding", "They are independent"))
        self.offered: dict[str, str] = {}
        self.first, self.second = (self.choices({}, name) for name in pair["between"])
        self.offer(names)
        self.coefficient = self.entry(shown(pair["coefficient"]))
        self.coefficient.setMaximumWidth(64)
        self.coefficient.setToolTip(
            translate(
                "BeltGrinding",
                "Correlation of their normal scores, between -1 and 1; for normal variables the correlation itself, for "
                "Spearman's rank correlation r it is 2 sin(π r / 6)",
            )
        )
        self.grid.addWidget(self.first, 0, 0, 1, 2)
        self.grid.addWidget(self.away, 0, 2)
        self.grid.addWidget(self.second, 1, 0)
        self.grid.addWidget(self.coefficient, 1, 1, 1, 2)
        self.grid.setColumnStretch(0, 1)

    def offer(self, names: Sequence[str]) -> None:
        """The names that may be chosen."""
        self.offered = {name: field_words.label(name) or name for name in names}
        for box in (self.first, self.second):
            choose(box, self.offered, box.currentData())

    def names(self) -> list[str]:
        """The two that are chosen."""
        return [self.first.currentData(), self.second.currentData()]

    def number(self, k: int) -> None:
        for widget, name in (
            (self.first, "correlatedFirst"),
            (self.second, "correlatedSecond"),
            (self.coefficient, "correlatedCoefficient"),
            (self.away, "removeCorrelated"),
        ):
            widget.setObjectName(f"{name}{k}")

    def value(self) -> dict[str, Any]:
        """An entry of a study's ``correlations``."""
        first, second = self.names()
        for box, name in ((self.first, first), (self.second, second)):
            if name not in self.offered:
                self.wrong(box)
                raise InputError(
                    "gui.correlated_gone",
                    "'{name}' does not vary any more: choose another, or take the pair away",
                    name=name,
                )
        if first == second:
            self.wrong(self.second)
            raise InputError(
                "gui.correlated_itself", "{name}: choose two that are different", name=first
            )
        try:
            value = number(self.coefficient.text())
        except ValueError:
            value = None
        if value is None or not -1.0 < value < 1.0:
            self.wrong(self.coefficient)
            raise InputError(
                "gui.correlation_coefficient",
                "{first} with {second}: '{text}' is no coefficient; give a number between -1 and 1",
                first=first,
                second=second,
                text=self.coefficient.text().strip(),
            )
        return {"between": [first, second], "coefficient": value}
