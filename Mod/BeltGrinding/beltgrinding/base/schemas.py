"""JSON files checked by the schemas in Resources/schema, which hold every default."""

import copy
import json
import math
import sys

from ..engine import InputError
from .files import cannot_be_read, in_file
from .regular_files import read_regular
from .resources import resources
from .schema_errors import explained


LARGEST = 1 << 30  # bytes of a JSON file


def schema(name):
    """The JSON Schema ``name`` (job, contact, convergence, presets), as a dict."""
    with open(resources() / "schema" / f"{name}.schema.json", encoding="utf-8") as file:
        return json.load(file)


def read_json(path):
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


def _refuse_constant(name):
    raise InputError("base.json_number", "{name} is no number that a job can use", name=name)


def _not_too_large(text):
    value = int(text)
    if abs(value) > sys.float_info.max:
        raise InputError("base.json_too_large", "{text} is too large a number", text=text[:40])
    return value


def _without_twins(pairs):
    """A JSON object's dict; the later of two equal keys would win without a word."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [key for key, _ in pairs]
        twin = next(key for key in names if names.count(key) > 1)
        raise InputError("base.json_twin", "the key '{key}' is there twice", key=twin)
    return found


def _finite(text):
    value = float(text)
    if not math.isfinite(value):
        raise InputError("base.json_too_large", "{text} is too large a number", text=text[:40])
    return value


def checked(data, rules, what):
    """A copy of ``data`` with the schema's defaults filled in. Raises InputError naming the key that
    is unknown, missing or wrong; ``what`` stands for the whole.
    """
    for _, error in problems(data, rules, what):
        raise error
    data = _whole_numbers(filled(data, rules), rules)
    if not all(math.isfinite(value) for value in _numbers(data)):
        raise InputError(
            "base.not_finite", "the {what} holds a number that is not finite", what=what
        )
    return data


def _whole_numbers(value, rule):
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


def filled(data, rules):
    """A copy of ``data`` with the schema's defaults filled in, unchecked: of data that a version of this
    program wrote.
    """
    data = copy.deepcopy(data)
    _fill(data, rules)
    return data


def problems(data, rules, what):
    """(path of keys and indices, InputError naming the key) of everything that breaks the schema, what
    is nearest to the root first; ``what`` stands for the whole.
    """
    import jsonschema

    errors = jsonschema.Draft7Validator(rules).iter_errors(data)
    errors = sorted(errors, key=lambda e: (len(e.absolute_path), str(e.absolute_path)))
    return [(list(error.absolute_path), explained(error, what)) for error in errors]


def _fill(value, rule):
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


def _numbers(value):
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, (int, float)):
        yield value
