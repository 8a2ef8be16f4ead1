"""The last door: a result that cannot be is a fault of this program, told before any of it is written.

What the arrays of a height field hold is asked in the core, by the check that reads its file
(``core.HeightField.check``); here it is asked of the figures.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Json

if TYPE_CHECKING:
    from ..inspection.ground import Told

SHARE = "share"  # how the names of shares end
SENTENCE = "arguments"  # of a fact: shares are in percent there
ROUNDING = 1e-9  # relative, of sums
VOLUMES = ("stock_volume_mm3", "removed_volume_mm3", "gouge_volume_mm3")


class Impossible(RuntimeError):
    """A figure that cannot be: the program is wrong, and its result is worth nothing."""


def check(result: Told) -> None:
    """Raises Impossible, or RuntimeError from the core, naming what of a Result cannot be."""
    result.field.check()
    for name, values in (result.steps or {}).items():
        if not np.isfinite(values).all():
            raise Impossible(f"steps: {name} is not finite")
    check_figures(summary=result.summary, verdict=result.verdict, events=result.events)
    if result.verdict:
        _check_volumes("summary", {**result.verdict, **result.summary})


def check_figures(**told: Any) -> None:
    """The same of figures as JSON has them, by the name of what tells them."""
    for name, data in told.items():
        _check(data, name)


def _check(value: Any, where: str, shares: bool = False) -> None:
    if isinstance(value, dict):
        for key, one in value.items():
            _check(one, f"{where}.{key}", key.endswith(SHARE) and not where.endswith(SENTENCE))
        if all(volume in value for volume in VOLUMES):
            _check_volumes(where, value)
    elif isinstance(value, (list, tuple)):
        for number, one in enumerate(value):
            _check(one, f"{where}[{number}]", shares)
    elif isinstance(value, float):
        if not math.isfinite(value):
            raise Impossible(f"{where} is {value}")
        if shares and not 0.0 <= value <= 1.0:
            raise Impossible(f"{where} is {value}, which is no share")


def _check_volumes(where: str, figures: Json) -> None:
    """What is removed was stock, or was cut out of the design."""
    stock, removed, gouged = (figures[name] for name in VOLUMES)
    if not 0.0 <= removed <= (stock + gouged) * (1.0 + ROUNDING):
        raise Impossible(
            f"{where}: {removed} mm3 are removed of {stock} and {gouged} of the design"
        )
