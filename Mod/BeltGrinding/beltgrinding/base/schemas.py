"""JSON files checked by the schemas in Resources/schema, which hold every default and every range.

A keyword of ours, ``least``: the smallest number but 0 that makes sense, where 0 means something of its own or is
excluded.
"""

from __future__ import annotations

import copy
import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from ..engine import InputError
from .files import cannot_be_read, in_file
from .regular_files import read_regular
from .resources import resources
from .schema_errors import explained, not_finite, path_of


Rules = Mapping[str, Any]  # a JSON Schema, or a part of one
Way = tuple[str | int, ...]  # keys and indices
Check = Callable[..., bool]  # of a value, a keyword's limit, its rule and the whole schema
T = TypeVar("T")

LARGEST = 1 << 30  # bytes of a JSON file


def schema(name: str) -> dict[str, Any]:
    """The JSON Schema ``name`` (job, contact, convergence, presets), as a dict."""
    with open(resources() / "schema" / f"{name}.schema.json", encoding="utf-8") as file:
        rules: dict[str, Any] = json.load(file)
        return rules


def read_json(path: Path | str) -> Any:
    """The content of a JSON file (a pathlib.Path). Raises InputError."""
    try:
        text = read_regular(path, LARGEST).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise cannot_be_read(path, error) from None
    try:
        return json.loads(
            text,
            parse_constant=_refuse_constant,
            parse_float=_finite,
            parse_int=_not_too_large,
            object_pairs_hook=_without_twins,
        )
    except json.JSONDecodeError as error:
        raise InputError(
            "base.no_json",
            "{file}: line {line}: no JSON: {reason}",
            file=path,
            line=error.lineno,
            reason=error.msg,
        ) from None
    except InputError as error:
        raise in_file(error, path) from None
    except RecursionError as error:
        raise in_file(InputError("base.json_too_deep", "{reason}", reason=error), path) from None
    except ValueError as error:  # such as an integer of more digits than Python takes
        raise in_file(InputError("base.json_refused", "{reason}", reason=error), path) from None


def checked_file(path: Path | str, rules: Rules) -> Any:
    """What a JSON file holds, as ``checked``. Raises InputError that names the file and the key."""
    data = read_json(path)
    try:
        return checked(data, rules, str(path))
    except InputError as error:
        named = str(error).startswith(str(path))
        raise error if named else in_file(error, path) from None


def _refuse_constant(name: str) -> NoReturn:
    raise InputError("base.json_number", "{name} is no number that a job can use", name=name)


def _not_too_large(text: str) -> int:
    value = int(text)
    if abs(value) > sys.float_info.max:
        raise InputError("base.json_too_large", "{text} is too large a number", text=text[:40])
    return value


def _without_twins(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object's dict; the later of two equal keys would win without a word."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [key for key, _ in pairs]
        twin = next(key for key in names if names.count(key) > 1)
        raise InputError("base.json_twin", "the key '{key}' is there twice", key=twin)
    return found


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise InputError("base.json_too_large", "{text} is too large a number", text=text[:40])
    return value


def checked(data: Any, rules: Rules, what: str) -> Any:
    """A copy of ``data`` with the schema's defaults filled in, in Python's own types. Raises InputError naming the key
    that is unknown, missing or wrong; ``what`` stands for the whole.
    """
    data = _plain(data, what)
    for _, error in problems(data, rules, what):
        raise error
    _fill(data, rules)
    return _whole_numbers(data, rules)


def _plain(value: Any, what: str, way: Way = ()) -> Any:
    """A copy in Python's own types: numpy's numbers and arrays are taken too. Raises InputError for what no schema
    bounds and JSON cannot hold."""
    try:
        return _copied(value, what, way)
    except RecursionError as error:
        raise InputError("base.json_too_deep", "{reason}", reason=error) from None


def _copied(value: Any, what: str, way: Way) -> Any:
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise InputError(
                    "base.key_no_text",
                    "{key}: a key is a text, not {value}",
                    key=path_of(way, what),
                    value=repr(key)[:40],
                )
        return {key: _copied(one, what, (*way, key)) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_copied(one, what, (*way, at)) for at, one in enumerate(value)]
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, (int, float)):
        if not finite(value):
            raise not_finite(value, path_of(way, what))
        return value
    if hasattr(value, "tolist"):  # numpy's
        return _copied(value.tolist(), what, way)
    return value  # of a type that the schema refuses


def finite(value: float) -> bool:
    """Whether a number is one that a double can hold."""
    try:
        return math.isfinite(value)
    except OverflowError:  # an int
        return False


def _whole_numbers(value: Any, rule: Rules) -> Any:
    """JSON Schema takes 6.0 for an integer; the engine does not."""
    if isinstance(value, float) and rule.get("type") == "integer":
        return int(value)
    if isinstance(value, list):
        items = rule.get("items", {})
        return [_whole_numbers(item, items) for item in value] if isinstance(items, dict) else value
    if isinstance(value, dict):
        known = rule.get("properties", {})
        return {key: _whole_numbers(item, known.get(key, {})) for key, item in value.items()}
    return value


def filled(data: T, rules: Rules) -> T:
    """A copy of ``data`` with the schema's defaults filled in, unchecked: of data that a version of this
    program wrote.
    """
    data = copy.deepcopy(data)
    _fill(data, rules)
    return data


def problems(data: Any, rules: Rules, what: str) -> list[tuple[list[str | int], InputError]]:
    """(path of keys and indices, InputError naming the key) of everything that breaks the schema, what
    is nearest to the root first; ``what`` stands for the whole.
    """
    if _fits(data, rules, rules):
        return []
    errors = _validator()(rules).iter_errors(data)
    errors = sorted(errors, key=lambda e: (len(e.absolute_path), str(e.absolute_path)))
    return [(list(error.absolute_path), explained(error, what)) for error in errors]


SILENT = {
    "title",
    "description",
    "default",
    "definitions",
    "$schema",
    "usual",
}  # keywords that refuse nothing
KINDS = {"string": str, "boolean": bool, "object": dict, "array": list, "null": type(None)}


def _fits(value: Any, rule: Any, whole: Rules) -> bool:
    """Whether a value keeps a rule for certain: ten times as fast as jsonschema, which tells what is wrong. False where
    it is not sure, as of a keyword that it does not know."""
    if not isinstance(rule, dict):
        return False
    for keyword, limit in rule.items():
        if keyword in SILENT:
            continue
        known = _CHECKS.get(keyword)
        if known is None or not known(value, limit, rule, whole):
            return False
    return True


def _is(value: Any, kinds: Any, *_: object) -> bool:
    for kind in (kinds,) if isinstance(kinds, str) else kinds:
        if kind in KINDS:
            if isinstance(value, KINDS[kind]):
                return True
        elif isinstance(value, (int, float)) and not isinstance(value, bool) and finite(value):
            if kind == "number" or isinstance(value, int):
                return True
    return False


def _number(compare: Callable[[float, float], bool]) -> Check:
    return lambda value, limit, *_: not isinstance(value, (int, float)) or compare(value, limit)


def _of(kind: type, fits: Check) -> Check:
    return lambda value, limit, rule, whole: not isinstance(value, kind) or fits(
        value, limit, rule, whole
    )


def _has(value: Any, known: Any, _: object, whole: Rules) -> bool:
    return all(_fits(value[key], known[key], whole) for key in value.keys() & known.keys())


def _more(value: Any, allowed: Any, rule: Rules, whole: Rules) -> bool:
    if allowed is False:
        return bool(value.keys() <= rule.get("properties", {}).keys())
    return isinstance(allowed, dict) and all(
        _fits(value[key], allowed, whole)
        for key in value.keys() - rule.get("properties", {}).keys()
    )


def _unique(values: Any) -> bool:
    return all(isinstance(one, (int, str)) for one in values) and len(set(values)) == len(values)


_CHECKS: dict[str, Check] = {
    "$ref": lambda value, name, _, whole: _fits(
        value, whole.get("definitions", {}).get(name.rpartition("/")[2]), whole
    ),
    "type": _is,
    "enum": lambda value, allowed, *_: isinstance(value, str) and value in allowed,
    "const": lambda value, only, *_: type(value) is type(only) and value == only,
    "minimum": _number(lambda value, limit: value >= limit),
    "maximum": _number(lambda value, limit: value <= limit),
    "exclusiveMinimum": _number(lambda value, limit: value > limit),
    "exclusiveMaximum": _number(lambda value, limit: value < limit),
    "least": _number(lambda value, limit: value == 0 or abs(value) >= limit),
    "required": _of(dict, lambda value, names, *_: all(name in value for name in names)),
    "properties": _of(dict, _has),
    "additionalProperties": _of(dict, _more),
    "items": _of(list, lambda value, of, _, whole: all(_fits(one, of, whole) for one in value)),
    "minItems": _of(list, lambda value, limit, *_: len(value) >= limit),
    "maxItems": _of(list, lambda value, limit, *_: len(value) <= limit),
    "uniqueItems": _of(list, lambda value, *_: _unique(value)),
    "minLength": _of(str, lambda value, limit, *_: len(value) >= limit),
    "maxLength": _of(str, lambda value, limit, *_: len(value) <= limit),
    "oneOf": lambda value, rules, _, whole: sum(_fits(value, one, whole) for one in rules) == 1
    and all(one.keys() == {"required"} for one in rules),
}


@lru_cache(maxsize=None)
def _validator() -> Any:
    """Draft 7 with ``least``, for which NaN and infinity are no numbers."""
    import jsonschema

    def least(_: object, limit: float, value: Any, __: object) -> Iterator[Any]:
        if (
            isinstance(value, (int, float))
            and not isinstance(value, bool)
            and 0 < abs(value) < limit
        ):
            yield jsonschema.ValidationError("too small")

    base = jsonschema.Draft7Validator
    types = base.TYPE_CHECKER
    for name in ("number", "integer"):
        types = types.redefine(name, _finite_type(name, base.TYPE_CHECKER))
    return jsonschema.validators.extend(base, {"least": least}, type_checker=types)


def _finite_type(name: str, known: Any) -> Callable[[Any, Any], bool]:
    def is_one(_: object, value: Any) -> bool:
        return isinstance(value, (int, float)) and known.is_type(value, name) and finite(value)

    return is_one


def _fill(value: Any, rule: Rules) -> None:
    """Puts the schema's defaults in where ``value`` has nothing (frames have no defaults here)."""
    if isinstance(value, dict):
        for key, sub in rule.get("properties", {}).items():
            if key not in value and "default" in sub:
                value[key] = copy.deepcopy(sub["default"])
            if key in value:
                _fill(value[key], sub)
    elif isinstance(value, list):
        for item in value:
            _fill(item, rule.get("items", {}))
