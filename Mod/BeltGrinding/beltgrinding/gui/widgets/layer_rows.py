"""Layers between a platen's plate and the belt, from the plate outwards: thickness, Young's modulus, Poisson's ratio."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NoReturn

from ...engine import InputError
from ..common.compat import QtGui, translate
from ..common.kinds import Json, Widget
from .rows import Row, Rows, number, shown

NEW = {
    "thickness_mm": 5.0,
    "youngs_modulus_MPa": 2.0,
    "poissons_ratio": 0.4,
}  # a soft one of rubber
MOST_RATIO = 0.499


class LayerRows(Rows):
    """``values()`` gives a job's ``platen.layers``."""

    def __init__(self, layers: Iterable[Json]) -> None:
        super().__init__("layer", translate("BeltGrinding", "Add layer"))
        self.show_layers(layers)

    def show_layers(self, layers: Iterable[Json]) -> None:
        """Puts other layers in the place of those that are shown; nobody is told."""
        changed, self.changed = self.changed, lambda: None
        for row in list(self.rows):
            self.remove(row)
        for layer in layers:
            self.add(_Layer(layer))
        self.changed = changed

    def same(self, layers: Iterable[Json]) -> bool:
        """Whether these are shown; also while one that is being typed is none yet."""
        try:
            return [row.value() for row in self.rows] == list(layers)
        except InputError:
            return True

    def added(self) -> None:
        self.add(_Layer(NEW))
        self.changed()


class _Layer(Row):
    """Its three numbers side by side, below what they are."""

    def __init__(self, layer: Json) -> None:
        super().__init__(translate("BeltGrinding", "Takes the layer away"))
        columns = (
            ("thickness_mm", translate("BeltGrinding", "mm thick")),
            ("youngs_modulus_MPa", translate("BeltGrinding", "E, MPa")),
            ("poissons_ratio", translate("BeltGrinding", "Poisson")),
        )
        self.lines = {}
        for k, (key, text) in enumerate(columns):
            label = QtGui.QLabel(text)
            self.lines[key] = self.entry(shown(layer[key]))
            self.grid.addWidget(label, 0, k)
            self.grid.addWidget(self.lines[key], 1, k)
            self.grid.setColumnStretch(k, 1)
        self.grid.addWidget(self.away, 1, len(columns))

    def number(self, k: int) -> None:
        names = ("layerThickness", "layerModulus", "layerRatio")
        for widget, name in zip((*self.lines.values(), self.away), (*names, "removeLayer")):
            widget.setObjectName(f"{name}{k}")

    def value(self) -> dict[str, float]:
        found = {key: self._number(line) for key, line in self.lines.items()}
        for key in ("thickness_mm", "youngs_modulus_MPa"):
            if found[key] <= 0.0:
                self._refuse(key, translate("BeltGrinding", "must be greater than 0"))
        if not 0.0 <= found["poissons_ratio"] <= MOST_RATIO:
            text = translate("BeltGrinding", "must lie from 0 to {}").format(MOST_RATIO)
            self._refuse("poissons_ratio", text)
        return found

    def _number(self, line: Widget) -> float:
        try:
            value = number(line.text())
        except ValueError:
            value = None
        if value is None:
            self.wrong(line)
            raise InputError(
                "gui.layer_number",
                "'{text}' is no number: give the layer's thickness, modulus and ratio",
                text=line.text().strip(),
            )
        return value

    def _refuse(self, key: str, reason: str) -> NoReturn:
        line = self.lines[key]
        self.wrong(line)
        raise InputError(
            "gui.layer_value", "Layer: {text} {reason}", text=line.text().strip(), reason=reason
        )
