"""Values of expressions: what they must be, and the operators between them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

from ...program import Unknown

Environment: TypeAlias = Any  # the interpreter of a language
Evaluated: TypeAlias = Callable[[Environment], Any]

MAX_WHOLE = 2**53  # beyond, a whole number is no longer exact
NOT_COMPUTABLE = (
    TypeError,
    ValueError,
    OverflowError,
    ZeroDivisionError,
    IndexError,
    AttributeError,
)


def finite(value: float, text: str) -> float:
    """``value`` unless the number that is written so is too large."""
    if not math.isfinite(value):
        raise Unknown("programs.number_too_large", "{text} is too large a number", text=text[:20])
    return value


def truth(value: object) -> bool:
    """``value`` if it is a truth value."""
    if not isinstance(value, bool):
        raise Unknown("programs.truth_value_expected", "a truth value expected")
    return value


def number(value: object) -> float:
    """``value`` if it is a finite number."""
    if type(value) is float and math.isfinite(value):  # nearly all are
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Unknown("programs.number_expected", "a number expected")
    if type(value) is int and abs(value) > MAX_WHOLE:
        return finite(math.inf, str(value))
    if not math.isfinite(value):
        raise Unknown("programs.number_not_finite", "the number is not finite")
    return value


def true(value: object) -> bool:
    """Whether a condition holds where a number that is not 0 does."""
    return value if isinstance(value, bool) else number(value) != 0.0


def alike(left: object, right: object) -> bool:
    """Whether two truth values, numbers or strings are the same."""
    if isinstance(left, bool) != isinstance(right, bool) or not all(
        isinstance(one, (bool, float, str)) for one in (left, right)
    ):
        raise Unknown("programs.not_compared", "these values are not compared")
    return left == right


def power(base: object, exponent: object) -> float:
    """A power of two numbers."""
    try:
        found = number(base) ** number(exponent)
    except NOT_COMPUTABLE:
        found = math.nan
    return number(found if isinstance(found, float) else math.nan)


def both(left: Evaluated, right: Evaluated, env: Environment) -> bool:
    """AND, whose right side counts only where the left one is true."""
    return truth(left(env)) and truth(right(env))


def either(left: Evaluated, right: Evaluated, env: Environment) -> bool:
    """OR, likewise."""
    return truth(left(env)) or truth(right(env))


def divided(left: object, right: object) -> float:
    """A quotient of two numbers."""
    if number(right) == 0:
        raise Unknown("programs.division_by_zero", "division by zero")
    return number(left) / number(right)


COMPARED: dict[str, Callable[[object, object], bool]] = {
    "<": lambda a, b: number(a) < number(b),
    ">": lambda a, b: number(a) > number(b),
    "<=": lambda a, b: number(a) <= number(b),
    ">=": lambda a, b: number(a) >= number(b),
}


def applied(
    functions: Mapping[str, Callable[..., Any]],
    name: str,
    values: Sequence[object],
    named: Mapping[str, object],
    written: str,
) -> Any:
    """What a function of a table makes of values."""
    try:
        return functions[name](*values, **named)
    except NOT_COMPUTABLE:
        raise Unknown(
            "programs.not_computable",
            "{text} cannot be evaluated for these arguments",
            text=written,
        ) from None
