"""Numbers as FreeCAD writes them: with the decimal sign of its language, thousands apart by a narrow blank where the
comma is that sign, so that no number can be read a thousand times too small.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from typing import Any

from PySide import QtCore

NARROW = "\u202f"  # a blank that keeps a number on one line


def localized(number: str) -> str:
    """A number that Python has written, as FreeCAD writes it."""
    point = str(QtCore.QLocale().decimalPoint())
    if point == ".":
        return number
    return number.replace(",", NARROW).replace(".", point)


def figure(value: Any, spec: str = "") -> str:
    """``format(value, spec)`` as FreeCAD writes numbers."""
    text = format(value, spec)
    return localized(text) if isinstance(value, (int, float)) else text


def way_of_passes(one: Mapping[str, Any]) -> tuple[str, str]:
    """(along what, the belt's angle in degrees) of passes, by their settings."""
    way = ", ".join(figure(part, ".3g") for part in one["direction"])
    way = f"({way})" if one["along"] == "direction" else one["along"]
    return way, figure(one["belt_angle_deg"], ".3g")


def length_text(value: float, more: int = 0, sign: str = "+") -> str:
    """A deviation in mm as a number with its unit; ``more``: decimals beyond the usual."""
    return f"{length_number(value, more, sign)} {_unit().symbol}"


def length_number(value: float, more: int = 0, sign: str = "+") -> str:
    """The same without its unit, which the head of its column has."""
    unit = _unit()
    return figure(value / unit.size, f"{sign}.{unit.decimals + more}f")


def _unit() -> Any:
    # The preferences need the core, and all texts need this module: FreeCAD starts without the core, too.
    from ...objects import preferences

    return preferences.deviation_unit()


class _Filler(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        return figure(value, format_spec)


class Text(str):
    """A text of the window, which is filled with numbers as FreeCAD writes them."""

    def format(self, *values: Any, **named: Any) -> str:
        return str(_Filler().vformat(str(self), values, named))
