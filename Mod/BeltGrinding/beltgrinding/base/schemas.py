"""JSON files checked by the schemas in Resources/schema, which hold every default."""

import copy
import difflib
import json
import math

from ..engine import InputError
from .resources import resources


def schema(name):
    """The JSON Schema ``name`` (job, contact, convergence, presets), as a dict."""
    with open(resources() / "schema" / f"{name}.schema.json", encoding="utf-8") as file:
        return json.load(file)


def read_json(path):
    """The content of a JSON file (a pathlib.Path). Raises InputError."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"{path}: cannot be read: {reason}") from None
    try:
        return json.loads(text, parse_constant=_refuse_constant, parse_float=_finite)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: line {error.lineno}: no JSON: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: {error}") from None


def _refuse_constant(name):
    raise ValueError(f"{name} is no number that a job can use")


def _finite(text):
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is too large a number")
    return value


def checked(data, rules, what):
    """A copy of ``data`` with the schema's defaults filled in. Raises InputError naming the key that
    is unknown, missing or wrong; ``what`` stands for the whole.
    """
    for _, sentence in problems(data, rules, what):
        raise InputError(sentence)
    data = filled(data, rules)
    if not all(math.isfinite(value) for value in _numbers(data)):
        raise InputError(f"the {what} holds a number that is not finite")
    return data


def filled(data, rules):
    """A copy of ``data`` with the schema's defaults filled in, unchecked: of data that a version of this
    program wrote.
    """
    data = copy.deepcopy(data)
    _fill(data, rules)
    return data


def problems(data, rules, what):
    """(path of keys and indices, sentence naming the key) of everything that breaks the schema, what
    is nearest to the root first; ``what`` stands for the whole.
    """
    import jsonschema

    errors = jsonschema.Draft7Validator(rules).iter_errors(data)
    errors = sorted(errors, key=lambda e: (len(e.absolute_path), str(e.absolute_path)))
    return [(list(error.absolute_path), _explain(error, what)) for error in errors]


def _explain(error, what):
    """One sentence for a jsonschema error, naming the key."""
    where = ".".join(str(part) for part in error.absolute_path) or what
    if error.validator == "additionalProperties":
        known = list(error.schema["properties"])
        unknown = next(key for key in error.instance if key not in known)
        near = difflib.get_close_matches(unknown, known, 1)
        hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(known)}"
        return f"{where}: unknown key '{unknown}'; {hint}"
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        return f"{where}: the key '{missing}' is missing"
    if error.validator == "oneOf":
        keys = " or ".join(f"'{rule['required'][0]}'" for rule in error.validator_value)
        return f"{where}: give exactly one of {keys}"
    return f"{where}: {error.message[:200]}"


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
