"""What jsonschema finds wrong, as errors of ours that name the key."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence
from typing import Any

from ..engine import InputError, core
from .files import either

MOST = 120  # characters of a value that are shown


def explained(error: Any, what: str) -> InputError:
    """The InputError of a jsonschema error; ``what`` stands for the whole."""
    where = path_of(error.absolute_path, what)
    limit = error.validator_value
    if error.validator in MAKERS:
        return MAKERS[error.validator](error, where, limit)
    if error.validator in LIMITS:
        code, text = LIMITS[error.validator]
        return InputError(code, text, key=where, value=_shown(error.instance), limit=limit)
    return InputError("base.other", "{key}: {reason}", key=where, reason=error.message[:200])


def path_of(way: Iterable[object], what: str) -> str:
    """Write a path of keys and indices with dots; ``what`` stands for the empty path."""
    return ".".join(str(part) for part in way) or what


def not_finite(value: object, where: str) -> InputError:
    """Make the InputError of a number that is NaN, infinite or too large for a double."""
    return InputError(
        "base.not_finite",
        "{key}: {value} is no finite number",
        key=where,
        value=_shown(value),
    )


def _of(error: Any, where: str, name: str) -> str:
    """The path of a key inside of what the error is about."""
    return f"{where}.{name}" if error.absolute_path else name


def _shown(value: object) -> str:
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python writes
        text = "an integer of very many digits"
    return text if len(text) <= MOST else text[:MOST] + "..."


def hint(name: str, known: Sequence[str], quote: str = "'") -> core.Fact:
    """Which of the names that are ``known`` was perhaps meant, or all of them, as a fact."""
    near = difflib.get_close_matches(name, known, 1)
    if near:
        return core.Fact(
            "base.did_you_mean", "did you mean {name}?", name=f"{quote}{near[0]}{quote}"
        )
    return core.Fact("base.known_are", "known are {names}", names=", ".join(known))


def _unknown(error: Any, where: str, _: object) -> InputError:
    known = list(error.schema["properties"])
    name = next(key for key in error.instance if key not in known)
    return InputError(
        "base.unknown_key",
        "{where}: unknown key '{name}'; {hint}",
        key=_of(error, where, name),
        where=where,
        name=name,
        hint=hint(name, known),
    )


def _missing(error: Any, where: str, required: Iterable[str]) -> InputError:
    name = next(key for key in required if key not in error.instance)
    return InputError(
        "base.missing_key",
        "{where}: the key '{name}' is missing",
        key=_of(error, where, name),
        where=where,
        name=name,
    )


def _one_of(error: Any, where: str, rules: Iterable[Any]) -> InputError:
    choices = either(*(rule["required"][0] for rule in rules))
    return InputError(
        "base.exactly_one", "{key}: give exactly one of {choices}", key=where, choices=choices
    )


def _type(error: Any, where: str, kinds: Any) -> InputError:
    if isinstance(error.instance, float) and not math.isfinite(error.instance):
        return not_finite(error.instance, where)
    names = {
        "array": core.Fact("base.array", "'array'"),
        "boolean": core.Fact("base.boolean", "'boolean'"),
        "integer": core.Fact("base.integer", "'integer'"),
        "null": core.Fact("base.null", "'null'"),
        "number": core.Fact("base.number", "'number'"),
        "object": core.Fact("base.object", "'object'"),
        "string": core.Fact("base.string", "'string'"),
    }
    kinds = [kinds] if isinstance(kinds, str) else kinds
    told = names[kinds[0]]
    for kind in kinds[1:]:
        told = core.Fact("base.types", "{one}, {other}", one=told, other=names[kind])
    return InputError(
        "base.wrong_type",
        "{key}: {value} is not of type {type}",
        key=where,
        value=_shown(error.instance),
        type=told,
    )


def _choice(error: Any, where: str, allowed: Any) -> InputError:
    return InputError(
        "base.not_one_of",
        "{key}: {value} is not one of {allowed}",
        key=where,
        value=_shown(error.instance),
        allowed=repr(allowed),
    )


def _const(error: Any, where: str, expected: Any) -> InputError:
    return InputError(
        "base.expected", "{key}: {expected} was expected", key=where, expected=repr(expected)
    )


MAKERS = {
    "additionalProperties": _unknown,
    "required": _missing,
    "oneOf": _one_of,
    "type": _type,
    "enum": _choice,
    "const": _const,
}
LIMITS = {
    "minimum": ("base.below_minimum", "{key}: {value} is less than the minimum of {limit}"),
    "maximum": ("base.above_maximum", "{key}: {value} is greater than the maximum of {limit}"),
    "exclusiveMinimum": (
        "base.not_above_minimum",
        "{key}: {value} is less than or equal to the minimum of {limit}",
    ),
    "exclusiveMaximum": (
        "base.not_below_maximum",
        "{key}: {value} is greater than or equal to the maximum of {limit}",
    ),
    "least": (
        "base.below_least",
        "{key}: {value} is too small; {limit} is the least but 0",
    ),
    "minItems": (
        "base.too_few",
        "{key}: {value} is too short; it has at least {limit} items",
    ),
    "maxItems": ("base.too_many", "{key}: {value} is too long; it has at most {limit} items"),
    "minLength": (
        "base.text_too_short",
        "{key}: {value} is too short; it has at least {limit} characters",
    ),
    "maxLength": (
        "base.text_too_long",
        "{key}: {value} is too long; it has at most {limit} characters",
    ),
    "maxProperties": (
        "base.too_many_keys",
        "{key}: it has too many keys; {limit} at most",
    ),
    "pattern": ("base.pattern", "{key}: {value} does not match '{limit}'"),
    "uniqueItems": ("base.not_unique", "{key}: {value} has non-unique elements"),
}
