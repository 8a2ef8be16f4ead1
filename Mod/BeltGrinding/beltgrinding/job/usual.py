"""Quantities of a job that are outside of what exists: told, since the unit is mostly another one. The ranges stand in the
schema ("usual", both ends in the key's unit); what cannot be at all is refused by its minimum and maximum.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

import numpy as np

from ..base import schemas
from ..base.kinds import Facts, Json
from ..engine import Fact
from .poses import program_name

UNITS = {  # what a key ends with: its unit, the longest first
    "_MPa_per_mm": "MPa/mm",
    "_mm2_per_N": "mm²/N",
    "_N_per_mm": "N/mm",
    "_kg_m3": "kg/m³",
    "_deg_s": "°/s",
    "_mm_s2": "mm/s²",
    "_mm_s": "mm/s",
    "_m_s": "m/s",
    "_MPa": "MPa",
    "_um": "µm",
    "_kg": "kg",
    "_mm": "mm",
    "_N": "N",
    "_s": "s",
}

Place = tuple[Union[str, int], ...]  # keys and numbers that lead to a value of a job
Odd = tuple[tuple[float, float], Place, float]  # (usual from, to), where, value


def unit_of(key: str) -> str:
    """The unit of a job's key; "" where it has none."""
    return next((unit for end, unit in UNITS.items() if key.endswith(end)), "")


def warnings(job: Json, programs: Sequence[Json] = ()) -> Facts:
    """[Fact]: what is unusual, one for each quantity. A 0, which means none, is not. ``job``: validated; ``programs``: of each a
    dict of the arrays feeds (mm/s), forces (N, below 0: the job's) and rapid of its motions, from wherever they come.
    """
    rules = schemas.schema("job")
    found: dict[Place, list[Odd]] = {}
    _look({k: v for k, v in job.items() if k != "programs"}, rules, (), found)
    pose = rules["properties"]["programs"]["items"]["properties"]["poses"]["items"]["properties"]
    for i, arrays in enumerate(programs):
        for name, key in (("feeds", "feed_mm_s"), ("forces", "force_N")):
            low, high = pose[key]["usual"]
            values = np.asarray(arrays[name], dtype=float)[~np.asarray(arrays["rapid"], dtype=bool)]
            odd = values[(values > 0.0) & ((values < low) | (values > high))]
            if len(odd):
                where = (f"{program_name(job, i)}: {key}",)
                found[where] = [((low, high), where, float(value)) for value in odd]
    return [_told(key, values) for key, values in found.items()]


def _look(value: Any, rule: Json, path: Place, found: dict[Place, list[Odd]]) -> None:
    if isinstance(value, dict):
        for key, item in value.items():
            _look(item, rule.get("properties", {}).get(key, {}), (*path, key), found)
    elif isinstance(value, list):
        items = rule.get("items", {})
        for i, item in enumerate(value):
            _look(item, items, (*path, i), found)
    elif "usual" in rule and not isinstance(value, bool) and value != 0:
        low, high = rule["usual"]
        if not low <= value <= high:
            whole = tuple(part for part in path if isinstance(part, str))
            found.setdefault(whole, []).append(((low, high), path, value))


def _told(key: Place, values: Sequence[Odd]) -> Fact:
    (low, high), path, value = values[0]
    told = {
        "key": ".".join(map(str, path)),
        "value": value,
        "unit": unit_of(str(key[-1])),
        "low": low,
        "high": high,
    }
    if len(values) > 1:
        return Fact(
            "job.unusual_values",
            "{key}: {value:g} {unit} is not usual ({low:g} to {high:g} {unit}), and {more} more likewise; check the unit",
            more=len(values) - 1,
            **told,
        )
    return Fact(
        "job.unusual",
        "{key}: {value:g} {unit} is not usual ({low:g} to {high:g} {unit}); check the unit",
        **told,
    )
