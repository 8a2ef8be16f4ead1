"""What varies, as numbers with a distribution: text and lists by the number of their choice."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Floats, Json, known
from . import design

if TYPE_CHECKING:
    from .kinds import OpenTurns


class Input:
    """One varied thing. ``choices``: its values where it is a list of them, None for a range or a distribution;
    ``numeric``: whether they are numbers."""

    def __init__(self, name: str, given: Json, where: str) -> None:
        self.name, self.given, self.where = name, given, where
        self.choices: list[Any] | None = None
        self.weights = given.get("weights")
        if "parts" in given:
            self.choices = given["parts"]  # names
        elif "values" in given:
            self.choices = list(given["values"])
        numbers = [
            isinstance(one, (int, float)) and not isinstance(one, bool)
            for one in self.choices or ()
        ]
        self.numeric = all(numbers)
        self.varies = self.choices is None or len({_key(one) for one in self.choices}) > 1

    def coded(self, column: Array) -> Floats:
        """(n,) the column of a table as numbers."""
        if self.numeric:
            return column.astype(float)
        at = {_key(one): k for k, one in enumerate(known(self.choices))}
        return np.array([float(at[_key(one)]) for one in column])

    def value(self, code: float) -> Any:
        """The value of a number, the nearest where it is a choice."""
        if self.choices is None:
            return float(code)
        if self.numeric:
            return min(self.choices, key=lambda one: abs(one - code))
        return self.choices[int(round(float(code)))]

    def law(self) -> OpenTurns:
        """The distribution of the numbers, of OpenTURNS. Raises InputError."""
        ot = design.openturns()
        if self.choices is not None:
            weights = self.weights or [1.0] * len(self.choices)
            codes = self.choices if self.numeric else range(len(self.choices))
            merged: dict[float, float] = {}
            for code, weight in zip(codes, weights):
                merged[float(code)] = merged.get(float(code), 0.0) + weight
            whole = sum(merged.values())
            points = sorted(merged)
            return ot.UserDefined([[x] for x in points], [merged[x] / whole for x in points])
        if "range" in self.given:
            return ot.Uniform(*(float(end) for end in self.given["range"]))
        return design.distribution(ot, self.given["distribution"], self.where)


def _key(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, sort_keys=True, allow_nan=False)


def inputs_of(study: Json, varied: Sequence[str]) -> list[Input]:
    """[Input] in the order of the names ``varied``."""
    named: dict[str, Input] = {}
    for k, given in enumerate(study["vary"]):
        if "parts" in given:
            given = {**given, "parts": [_part_name(one) for one in given["parts"]]}
        named[given.get("name", given["key"])] = Input(
            given.get("name", given["key"]), given, f"vary[{k}].distribution"
        )
    return [named[name] for name in varied]


def _part_name(part: Json) -> str:
    return part.get("name", Path(part.get("job") or part["scan"]).stem)
