"""Events of a run: what goes wrong on the way, with stable codes. docs/events.md is their manual.

The kinds stand in the core (src/events/event_kinds.cpp); events.schema.json is the form.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ..base import schemas
from ..base.kinds import Json
from ..base.messages import fact_data
from ..engine import InputError, core

SEVERITIES = ("error", "warning", "info")  # the worst first
# What an event of an older result, or one that a caller makes, need not have.
NOTHING: dict[str, Any] = {
    "program": 0,
    "pose": 0,
    "line": 0,
    "time": 0.0,
    "duration": 0.0,
    "value": 0.0,
    "limit": None,
    "unit": "",
    "point": None,
    "face": None,
    "bodies": [],
    "message": "",
    "facts": [],
}


def kinds() -> dict[str, dict[str, Any]]:
    """{code: dict(severity, unit, meaning, advice)} in the order of the manual."""
    return {kind.pop("code"): kind for kind in core.event_kinds()}


def momentary(
    kind: Json,
    code: str,
    facts: Sequence[core.Fact],
    *,
    time: float,
    pose: int,
    line: int,
    value: float = 0.0,
    limit: float | None = None,
    point: Sequence[float] | None = None,
    face: int | None = None,
) -> dict[str, Any]:
    """An event without a duration that is found after a run, as the core gives those that it finds, but for its program.
    ``kind``: of ``kinds``; ``facts``: core.Fact, one after the other."""
    return {
        "kind": code,
        "severity": kind["severity"],
        "pose": pose,
        "line": line,
        "time": time,
        "duration": 0.0,
        "worst_time": time,
        "value": value,
        "limit": limit,
        "unit": kind["unit"],
        "point": point,
        "face": face,
        "bodies": [],
        "message": "; ".join(str(fact) for fact in facts),
        "facts": [fact_data(fact) for fact in facts],
        "advice": kind["advice"],
    }


def schema() -> dict[str, Any]:
    """The JSON Schema of events.json, as a dict."""
    return schemas.schema("events")


def read(path: Path) -> list[dict[str, Any]]:
    """The events of a file (a pathlib.Path), complete. Raises InputError."""
    found = schemas.read_json(path)
    if not isinstance(found, list) or not all(
        isinstance(one, dict) and isinstance(one.get("kind"), str) for one in found
    ):
        raise InputError("cell.no_events", "{file}: is no list of events", file=path)
    rules = schema()
    del rules["items"]["properties"]["kind"]["enum"]  # another version's may be new
    return schemas.checked(complete(found), rules, str(path))


def complete(events: Sequence[Json]) -> list[dict[str, Any]]:
    """Copies of events with every key that the schema asks for: older results have fewer. A kind
    that is not known is a warning without advice."""
    known = kinds()
    return [_complete(event, known.get(event["kind"], {})) for event in events]


def _complete(event: Json, kind: Json) -> dict[str, Any]:
    defaults = {
        **NOTHING,
        "bodies": [],
        "facts": [],
        "severity": kind.get("severity", "warning"),
        "unit": kind.get("unit", ""),
        "advice": kind.get("advice", ""),
        "worst_time": event.get("time", 0.0),
    }
    return {**defaults, **event}


def count(events: Sequence[Json]) -> dict[str, int]:
    """{code: how many}."""
    counts: dict[str, int] = {}
    for event in events:
        counts[event["kind"]] = counts.get(event["kind"], 0) + 1
    return counts


def merge(programs: Iterable[tuple[int, float, Sequence[Json]]]) -> list[dict[str, Any]]:
    """One list of the events of programs that run one after the other, by time.

    ``programs``: (number from 0, its begin in s, its events, as the core gives them) each.
    """
    merged = []
    for number, begin, found in programs:
        for event in sorted(found, key=lambda event: event["time"]):
            times = {key: event[key] + begin for key in ("time", "worst_time")}
            merged.append({"program": number, **event, **times})
    return merged
