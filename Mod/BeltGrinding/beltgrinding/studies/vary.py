"""What varies in a study, and the job of a run.

A variable is a key of the job, or an error of place: ``placement.`` of the part with its stock in what holds it,
``stock_placement.`` of the stock against the design. Such an error E is a rigid transform: a shift in mm and a rotation vector
(axis times angle) in degrees about a point c, p -> c + R (p - c) + t.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base import frames, schemas
from ..base.kinds import Floats, Json
from ..engine import InputError
from ..job import machine
from . import table
from .keys import Key, job_schema

PART = "part"
AXES = ("x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg")
PLACEMENT, STOCK_PLACEMENT = "placement", "stock_placement"
OF_HOLDING = {"tool_in_hand": "base_from_work", "part_in_hand": "tcp_from_work"}


class Variable(NamedTuple):
    """One thing that varies."""

    name: str
    key: Key | str  # "placement.x_mm" and the like; PART
    how: str
    given: Json  # its entry in the study


def variables(study: Json) -> list[Variable]:
    """[Variable] of a study that its schema has passed. Raises InputError."""
    found: list[Variable] = []
    names: set[str] = set()
    for k, given in enumerate(study["vary"]):
        where = f"vary[{k}].key"
        name = given.get("name", given["key"])
        _check_name(name, names, f"vary[{k}].name")
        names.add(name)
        kind, _, axis = given["key"].partition(".")
        if given["key"] == PART or "parts" in given:
            _check_part(given, f"vary[{k}]")
            key: Key | str = PART
        elif kind in (PLACEMENT, STOCK_PLACEMENT):
            key = _place(given, axis, where)
        else:
            key = Key(given["key"], where)
        if isinstance(key, Key) or key != PART:
            _check_numbers(given, f"vary[{k}]")
        found.append(Variable(name, key, given["how"], given))
    _check_twice(found)
    return found


def _check_name(name: str, names: set[str], where: str) -> None:
    if any(ord(c) < 32 for c in name) or name != name.strip():
        raise InputError(
            "studies.bad_name",
            "{key}: {name} cannot head a column: no blanks at its ends, no line breaks",
            key=where,
            name=repr(name),
        )
    if name in names or name in (table.RUN, *table.TEXTS):
        raise InputError(
            "studies.name_taken",
            "{key}: a column '{name}' is there already; give another name",
            key=where,
            name=name,
        )


def _check_part(given: Json, where: str) -> None:
    if given["key"] != PART or "parts" not in given:
        raise InputError(
            "studies.parts_and_key",
            "{key}: parts go with the key 'part', and no other",
            key=where,
        )
    if given["how"] != "set":
        raise _only_set(where)


def _place(given: Json, axis: str, where: str) -> str:
    if axis not in AXES:
        from ..base.schema_errors import hint

        raise InputError(
            "studies.no_such_error",
            "{where}: there is no error '{key}'; {hint}",
            where=where,
            key=given["key"],
            hint=hint(axis, list(AXES)),
        )
    if given["how"] != "set":
        raise _only_set(where)
    return given["key"]


def _only_set(where: str) -> InputError:
    return InputError(
        "studies.only_set", "{key}: how must be 'set' here: it is an error by itself", key=where
    )


def _check_numbers(given: Json, where: str) -> None:
    """Ranges and distributions, and what is added or multiplied, are numbers."""
    values = given.get("values", ())
    number = "values" not in given or given["how"] != "set" or given["key"].startswith(PLACES)
    if not number:
        return
    for value in values:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError(
                "studies.no_number", "{key}: {value} is no number", key=where, value=repr(value)
            )


PLACES = (PLACEMENT + ".", STOCK_PLACEMENT + ".")


def _check_twice(found: Sequence[Variable]) -> None:
    """Two variables that set the same key would overrule each other."""
    seen: dict[str, str] = {}
    for one in found:
        key = one.key.text if isinstance(one.key, Key) else one.key
        if one.how == "set" and key in seen:
            raise InputError(
                "studies.set_twice",
                "vary: '{one}' and '{other}' both set {key}; only one of them would count",
                one=seen[key],
                other=one.name,
                key=key,
            )
        if one.how == "set":
            seen[key] = one.name


def job_of(job: Json, found: Sequence[Variable], values: Sequence[Any], placement: Json) -> Json:
    """The job of a run: a copy of a validated ``job``, which shares with it what does not vary. ``found``: [Variable];
    ``values``: theirs, in order; ``placement``: as in the study. Keys are set, with the defaults of what they call for, before
    they are added to and multiplied.
    Raises InputError naming the key."""
    places: dict[str, dict[str, float]] = {PLACEMENT: {}, STOCK_PLACEMENT: {}}
    for turn in ("set", "add", "multiply"):
        for one, value in zip(found, values):
            if one.how != turn or one.key == PART:
                continue
            if isinstance(one.key, Key):
                job = one.key.changed(job, value, one.how)
            else:
                kind, _, axis = one.key.partition(".")
                places[kind][axis] = float(value)
        if turn == "set":
            job = _filled(job, {str(one.key.steps[0]) for one in found if isinstance(one.key, Key)})
    if any(places[PLACEMENT].values()):
        job = _misplaced(job, places[PLACEMENT], placement)
    if any(places[STOCK_PLACEMENT].values()):
        job = _stock_misplaced(job, places[STOCK_PLACEMENT], placement)
    return job


def _filled(job: Json, sections: set[str]) -> Json:
    """Defaults of what the job had no need of before: parts of another kind of belt machine, a part of which a value was
    set alone. ``sections``: those that were changed."""
    rules = job_schema()["properties"]
    for name in sections & {key for key, rule in rules.items() if rule.get("type") == "object"}:
        job = {**job, name: schemas.filled(job[name], rules[name])}
    if "belt_machine" in sections:
        machine.filled(job["belt_machine"], rules["belt_machine"])
    return job


def transform(errors: Mapping[str, float], about: ArrayLike) -> Floats:
    """(4, 4) of an error of place: dict of ``AXES`` (missing: 0), turned about a point (3,), mm."""
    turn = np.radians([errors.get(axis, 0.0) for axis in AXES[3:]])
    angle = float(np.linalg.norm(turn))
    axis = turn / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
    half = 0.5 * angle
    rotation = frames.from_quaternion([0.0] * 3, [math.cos(half), *(math.sin(half) * axis)])
    centre = np.asarray(about, dtype=float)
    moved = centre - rotation[:3, :3] @ centre
    rotation[:3, 3] = moved + [errors.get(axis, 0.0) for axis in AXES[:3]]
    return rotation


def _misplaced(job: Json, errors: Mapping[str, float], placement: Json) -> dict[str, Any]:
    """The part, and what is fixed to it, lies elsewhere in what holds it than the program takes for granted."""
    name = OF_HOLDING[job["cell"]["holding"]]
    error = transform(errors, placement["about_mm"])
    nominal = frames.from_data(job["cell"].get(name))
    frame = nominal @ error if placement["frame"] == "part" else error @ nominal
    return {**job, "cell": {**job["cell"], name: frame_data(frame)}}


def _stock_misplaced(job: Json, errors: Mapping[str, float], placement: Json) -> dict[str, Any]:
    """The stock lies elsewhere against the design; in the design's frame."""
    nominal = frames.from_data(job["stock"].get("placement"))
    frame = transform(errors, placement["about_mm"]) @ nominal
    return {**job, "stock": {**job["stock"], "placement": frame_data(frame)}}


def frame_data(frame: Floats) -> dict[str, Any]:
    """A (4, 4) as a job has it."""
    return {
        "position_mm": frame[:3, 3].tolist(),
        "quaternion_wxyz": frames.to_quaternions(frame[None, :3, :3])[0].tolist(),
    }
