"""Numbers of KRL: INT, REAL, and those of which it is not known which; what operators make of them."""

from __future__ import annotations

import math
from typing import Any

from ...program import Unknown
from .values import LARGEST, Either, Lost

CLOSE = 1e-6  # of REALs, which have 24 bits in the controller: whether they are equal is not known


def literal(text: str) -> float:
    """A number as it is written: an INT without point and exponent."""
    if text.isdigit() and int(text[:12]) < LARGEST and len(text) < 12:
        return int(text)
    value = float(text)
    if not math.isfinite(value):
        raise Unknown("programs.number_too_large", "{text} is too large a number", text=text[:20])
    return value


def number(value: object) -> float:
    """``value`` if it is a number."""
    if isinstance(value, Lost):
        raise Unknown(value.told)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Unknown("programs.number_expected", "a number expected")
    if not math.isfinite(value):
        raise Unknown("programs.number_not_finite", "the number is not finite")
    return value


def whole(value: int) -> int:
    """An int within the bounds of INT."""
    if abs(value) >= LARGEST:
        raise Unknown("programs.krl.int_bounds", "a whole number is out of the bounds of INT")
    return value


def integer(value: object) -> int:
    """A number that is whole, as int. Raises Unknown."""
    found = number(value)
    if found != int(found):
        raise Unknown("programs.krl.no_integer", "{value} is no whole number", value=f"{found:g}")
    return whole(int(found))


def truth(value: object) -> bool:
    """``value`` if it is a truth value. Raises Unknown."""
    if isinstance(value, Lost):
        raise Unknown(value.told)
    if not isinstance(value, bool):
        raise Unknown("programs.no_truth_value", "the condition is no truth value")
    return value


def of_both(left: float, right: float, value: Any) -> float:
    """What an operator makes of two numbers, of the type that it has then."""
    kinds = (type(left), type(right))
    if kinds == (int, int):
        return whole(value)
    return Either(value) if float not in kinds else float(value)


def quotient(left: float, right: float) -> float:
    """INT by INT is cut to a whole number. Raises Unknown where it is not known whether both are."""
    if right == 0:
        raise Unknown("programs.division_by_zero", "division by zero")
    kinds = (type(left), type(right))
    if kinds == (int, int):
        return whole(int(math.copysign(abs(left) // abs(right), left * right)))
    if float in kinds:
        return left / right
    if math.fmod(left, right):
        raise Unknown(
            "programs.krl.int_or_real",
            "whether {left} / {right} is cut to a whole number depends on declarations in other files",
            left=f"{left:g}",
            right=f"{right:g}",
        )
    return Either(left / right)


def compared(operator: str, left: Any, right: Any) -> bool:
    """A comparison's truth value. Raises Unknown."""
    if isinstance(left, dict) or isinstance(right, dict):
        raise Unknown("programs.krl.not_compared", "aggregates are not compared")
    plain = (bool, str)
    if isinstance(left, plain) or isinstance(right, plain):
        if type(left) is not type(right) or operator not in ("==", "<>"):
            raise Unknown("programs.number_expected", "a number expected")
        return (left == right) == (operator == "==")
    left, right = number(left), number(right)
    difference = abs(left - right) if float in (type(left), type(right)) else 0.0
    if 0 < difference < CLOSE * max(abs(left), abs(right)):
        raise Unknown(
            "programs.krl.too_close",
            "{left} and {right} are too close to say what the controller makes of them",
            left=f"{left:.9g}",
            right=f"{right:.9g}",
        )
    return {
        "==": left == right,
        "<>": left != right,
        "<": left < right,
        ">": left > right,
        "<=": left <= right,
        ">=": left >= right,
    }[operator]
