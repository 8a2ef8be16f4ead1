"""Frozen dataclasses from plain data, as JSON has it, and back."""

import dataclasses
import types
import typing
from collections.abc import Callable, Hashable, Mapping
from functools import lru_cache
from typing import Any, TypeVar

Record = TypeVar("Record")
Convert = Callable[[Any], Any]


def made(kind: type[Record], data: Record | Mapping[str, Any]) -> Record:
    """A dataclass of checked plain data, the dataclasses within it too; what is one already stays as it is.

    Missing keys are None, numbers and texts stay as they are, lists become tuples. Raises TypeError for unknown keys.
    """
    if isinstance(data, kind):
        return data
    converters = _converters(typing.cast(Hashable, kind))
    # The room that reads a key reports it if it is missing.
    given: dict[str, Any] = dict.fromkeys(converters)
    for key, value in typing.cast(Mapping[str, Any], data).items():
        convert = converters.get(key)
        given[key] = value if convert is None or value is None else convert(value)
    return kind(**given)


def plain(value: Any) -> Any:
    """Returns what ``made`` took: dicts and lists, without the keys that are None."""
    if dataclasses.is_dataclass(value):
        named = ((field.name, getattr(value, field.name)) for field in dataclasses.fields(value))
        return {name: plain(one) for name, one in named if one is not None}
    if isinstance(value, tuple):
        return [plain(one) for one in value]
    return value


@lru_cache(maxsize=None)
def _converters(kind: Any) -> dict[str, Convert | None]:
    return {name: _converter(hint) for name, hint in typing.get_type_hints(kind).items()}


def _converter(hint: Any) -> Convert | None:
    """Of a value of that type; None where it is taken as it is."""
    if isinstance(hint, type) and dataclasses.is_dataclass(hint):
        return lambda data: made(hint, data)
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (typing.Union, types.UnionType):
        found = [_converter(one) for one in arguments if one is not type(None)]
        return found[0] if len(found) == 1 else None
    if origin is tuple:
        each = _converter(arguments[0])
        return tuple if each is None else _Each(each)
    return None


class _Each:
    """Converts a list, one by one."""

    def __init__(self, convert: Convert) -> None:
        self.convert = convert

    def __call__(self, data: Any) -> tuple[Any, ...]:
        return tuple(self.convert(one) for one in data)
