"""The height field of the last result, kept so that nothing reads it twice."""

from __future__ import annotations

import os
from typing import Any

from .kinds import DocumentObject, Field

_kept: dict[Any, Field | None] = {}  # the last field, by the result it is of


def _key(simulation: DocumentObject) -> tuple[Any, ...] | None:
    path = simulation.HeightField
    if not path or not os.path.exists(path):
        return None
    return path, simulation.Fingerprint, simulation.WallTime, os.stat(path).st_mtime_ns


def field_of(simulation: DocumentObject) -> Field | None:
    """core.HeightField of a Simulation, kept for the next call; None if there is none. Not to be changed."""
    key = _key(simulation)
    if key is None:
        return None
    if key not in _kept:
        _kept.clear()
        _kept[key] = simulation.Proxy.field(simulation)
    return _kept[key]


def keep(simulation: DocumentObject, field: Field) -> None:
    """Keeps the field that was just stored in a Simulation, as ``field_of`` would read it."""
    _kept.clear()
    key = _key(simulation)
    if key is not None:
        _kept[key] = field


def forget_field() -> None:
    """Frees the field that is kept."""
    _kept.clear()
