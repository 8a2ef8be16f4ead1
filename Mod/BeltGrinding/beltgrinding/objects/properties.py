"""Properties that mirror keys of a job: name, unit type, default and text come from the schema."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

from ..base import schemas
from ..base.messages import reason
from ..base.kinds import Json
from ..base.schema_errors import hint
from ..engine import InputError
from ..job.load import schema
from . import damage
from .kinds import DocumentObject, Properties
from .proxy import type_of

# FreeCAD's unit of a property type, in the job's unit: a force is kept in mm kg/s2, 1/1000 N, a
# pressure in kPa.
AS_IS = ("Bool", "Enumeration", "String", "File", "Integer")  # kinds without a unit
FACTOR = {"Force": 1000.0, "Pressure": 1000.0}


# FreeCAD's property editor shows a Float with two decimals, and Enter makes the value what is shown: K of
# 0.000125 becomes 0. A Precision is the same number with all of its decimals.
STORED_AS = {"JSON": "String", "Float": "Precision"}
UNBOUND = 1e300  # FreeCAD lets no Precision be negative unless it is told a bound


class Key(NamedTuple):
    """A property for the key of a job. ``kind`` is the property's type without App::Property; what
    FreeCAD keeps it as: ``STORED_AS``."""

    name: str
    kind: str
    group: str
    key: str  # dotted; a number is an index of an array
    factor: float = 1.0  # FreeCAD's value of the job's 1

    @property
    def scale(self) -> float:
        return self.factor * FACTOR.get(self.kind, 1.0)


_keys = {}  # (type of the object, name of the property): Key


class Output(NamedTuple):
    """A read-only result."""

    name: str
    kind: str
    group: str
    text: str
    hidden: bool = False


@lru_cache(maxsize=None)
def _schema() -> dict[str, Any]:
    """The job's schema, and under 'raster', 'plan' and 'study' those of a raster path's settings, a plan's and a
    study."""
    found = schema()
    for name in ("raster", "plan", "study"):
        found["properties"][name] = schemas.schema(name)
    return found


def rule(key: str) -> tuple[dict[str, Any], Any]:
    """The schema's rule for a dotted key, and its default."""
    default: Any
    node, default = _schema(), None
    for part in key.split("."):
        if part.isdigit():
            default = default[int(part)] if default else None
        elif node.get("type") == "array":
            node = node["items"]["properties"][part]
            default = node.get("default")
        else:
            node = node["properties"][part]
            default = node.get("default")
    return node, default


def add_keys(obj: DocumentObject, keys: Iterable[Key]) -> None:
    """Adds what ``obj`` lacks, with the schema's defaults."""
    for key in keys:
        _keys[type_of(obj), key.name] = key
        if key.name in obj.PropertiesList:
            _keep_up(obj, key)
            continue
        found, default = rule(key.key)
        _add(obj, key)
        if key.kind == "Enumeration":
            setattr(obj, key.name, found["enum"])
        elif key.kind == "Float":
            _unbind(obj, key, 0.0)
        if default is not None:
            set_value(obj, key, default)


def _add(obj: DocumentObject, key: Key) -> None:
    kind, found = STORED_AS.get(key.kind, key.kind), rule(key.key)[0]
    obj.addProperty(f"App::Property{kind}", key.name, key.group, found["description"])


def _keep_up(obj: DocumentObject, key: Key) -> None:
    """Makes the property of an older file what it would be in a new one."""
    _widen(obj, key)
    if key.kind != "Float":
        return
    touched, value = "Touched" in obj.State, getattr(obj, key.name)
    if obj.getTypeIdOfProperty(key.name) == "App::PropertyFloat":  # of 0.1.0
        bound = [text for name, text in obj.ExpressionEngine if name == key.name]
        obj.removeProperty(key.name)
        _add(obj, key)
        for text in bound:
            obj.setExpression(key.name, text)
    _unbind(obj, key, value)
    if not touched:
        obj.purgeTouched()


def _unbind(obj: DocumentObject, key: Key, value: Any) -> None:
    """Sets a Precision, and lets it take any number, which FreeCAD forgets with its file: what is
    beyond the schema's limits is then told, not set to the limit without a word."""
    default = rule(key.key)[1] or 1.0
    step = 10.0 ** math.floor(math.log10(abs(default) * key.scale)) / 10.0
    setattr(obj, key.name, (value, -UNBOUND, UNBOUND, step))


def _widen(obj: DocumentObject, key: Key) -> None:
    """Gives an enumeration of an older file the choices that have come since."""
    if key.kind == "Enumeration":
        choices, value = rule(key.key)[0]["enum"], getattr(obj, key.name)
        if obj.getEnumerationsOfProperty(key.name) != choices:
            setattr(obj, key.name, choices)
            if value in choices:
                setattr(obj, key.name, value)
            else:  # damaged: no version had it
                setattr(obj, key.name, rule(key.key)[1] or choices[0])
                damage.keep(obj, [key.name])


def add_outputs(obj: DocumentObject, outputs: Iterable[Output]) -> None:
    """Adds results: read-only, and setting them does not touch the object."""
    for output in outputs:
        if output.name in obj.PropertiesList:
            continue
        kind = f"App::Property{output.kind}"
        obj.addProperty(kind, output.name, output.group, output.text, 8)
        obj.setEditorMode(output.name, 2 if output.hidden else 1)


def limits(obj: DocumentObject, name: str) -> tuple[float | None, float | None, bool]:
    """(lowest, highest, whether the lowest itself is out) of a property in FreeCAD's unit; None where
    the schema sets no limit, or the property is none of a job's numbers.
    """
    key = _keys.get((type_of(obj), name))
    if key is None or key.kind in (*AS_IS, "JSON", "Vector", "VectorList"):
        return None, None, False
    found = rule(key.key)[0]
    low, high = found.get("minimum"), found.get("maximum")
    open_low = "exclusiveMinimum" in found
    if open_low:
        low = found["exclusiveMinimum"]
    scaled = [None if value is None else value * key.scale for value in (low, high)]
    return scaled[0], scaled[1], open_low


def property_of(obj: DocumentObject, key: str) -> str:
    """The property that mirrors a job's key; '' where the object has none."""
    mine = (name for (kind, name), one in _keys.items() if kind == type_of(obj) and one.key == key)
    return next(mine, "")


def keys_of(name: str) -> set[str]:
    """The keys of a job that properties of this name mirror, whichever object has them."""
    return {one.key for (_, other), one in _keys.items() if other == name}


UNITS = {  # what a key ends with: the unit
    "_mm_s2": "mm/s²",
    "_mm_s": "mm/s",
    "_m_s": "m/s",
    "_mm": "mm",
    "_deg": "°",
    "_N": "N",
    "_MPa": "MPa",
}


def unit_of(obj: DocumentObject, name: str) -> str:
    """The unit of a job's key that a property mirrors; '' where it is none or has none."""
    key = _keys.get((type_of(obj), name))
    found = () if key is None else (unit for end, unit in UNITS.items() if key.key.endswith(end))
    return next(iter(found), "")


def check_limits(obj: DocumentObject, keys: Iterable[Key]) -> None:
    """Raises InputError for the first property that lies outside of the schema's limits."""
    for key in keys:
        low, high, open_low = limits(obj, key.name)
        value = getattr(obj, key.name)
        number = getattr(value, "Value", value)
        if low is not None and (number < low or open_low and number == low):
            given = {"object": obj.Label, "key": key.name, "value": value, "limit": low}
            if open_low:
                raise InputError(
                    "objects.not_above",
                    "{object}: {key} is {value}; it must be greater than {limit:g}",
                    **given,
                )
            raise InputError(
                "objects.below",
                "{object}: {key} is {value}; it must be at least {limit:g}",
                **given,
            )
        if high is not None and number > high:
            raise InputError(
                "objects.above",
                "{object}: {key} is {value}; it must be at most {limit:g}",
                object=obj.Label,
                key=key.name,
                value=value,
                limit=high,
            )


def get_value(obj: DocumentObject, key: Key) -> Any:
    """The property in the job's unit."""
    value = getattr(obj, key.name)
    if key.kind in AS_IS:
        return value
    if key.kind == "JSON":
        return _parsed(obj, key, value) if value else copy.deepcopy(rule(key.key)[1])
    if key.kind == "Vector":
        return [float(f"{x:.15g}") for x in value]
    if key.kind == "VectorList":  # pairs
        return [[float(f"{point.x:.15g}"), float(f"{point.y:.15g}")] for point in value]
    value = float(getattr(value, "Value", value)) / key.scale
    return float(f"{value:.15g}")  # 0.05 stays 0.05 on its way through FreeCAD's units


def _parsed(obj: DocumentObject, key: Key, text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError as error:
        raise InputError(
            "objects.not_json",
            "{object}: {key} is no JSON: {reason}",
            object=obj.Label,
            key=key.name,
            reason=str(error),
        ) from None


def set_value(obj: DocumentObject, key: Key, value: Any) -> None:
    """Sets the property from a value in the job's unit."""
    if key.kind == "JSON":
        value = json.dumps(value, allow_nan=False) if value else ""
    elif key.kind == "Vector":
        value = tuple(value)
    elif key.kind == "VectorList":
        value = [(x, y, 0.0) for x, y in value]
    elif key.kind not in AS_IS:
        value = value * key.scale
    setattr(obj, key.name, value)


def to_job(obj: DocumentObject, keys: Iterable[Key], job: dict[str, Any]) -> None:
    """Puts the properties into the nested dict ``job``."""
    for key in keys:
        *path, last = key.key.split(".")
        node: Any = job
        for i, part in enumerate(path):
            following = [*path, last][i + 1]
            node = node.setdefault(part, [None, None] if following.isdigit() else {})
        value = get_value(obj, key)
        if value is not None:  # else a key that the job may lack
            node[int(last) if last.isdigit() else last] = value


def from_job(obj: DocumentObject, keys: Iterable[Key], job: Json) -> None:
    """Sets the properties for which the nested dict ``job`` has a value."""
    for key in keys:
        node: Any = job
        for part in key.key.split("."):
            if part.isdigit():
                node = node[int(part)]
            elif part in node:
                node = node[part]
            else:
                break
        else:
            set_value(obj, key, node)


def set_by_name(obj: DocumentObject, values: Properties) -> None:
    """Sets properties from a macro's keyword arguments; a unit may be given: "0.5 mm".

    Raises InputError naming the property that does not exist or does not take the value.
    """
    own = [name for name in obj.PropertiesList if name not in ("Proxy", "ExpressionEngine")]
    for name, value in values.items():
        if name not in own:
            raise InputError(
                "objects.no_property",
                "{object} has no property {key}; {hint}",
                object=obj.Label,
                key=name,
                hint=hint(name, sorted(own), quote=""),
            )
        try:
            setattr(obj, name, value)
        except Exception as error:  # FreeCAD raises TypeError, ValueError and its own
            raise InputError(
                "objects.value_refused",
                "{object}.{key} does not take {value}: {reason}",
                object=obj.Label,
                key=name,
                value=repr(value),
                reason=reason(error),
            ) from None
