"""Which keys of a job can vary in the document's studies, and how a run's values go back into its properties."""

from __future__ import annotations

import copy
import json
import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.kinds import Json, known
from ..studies import vary
from ..studies.keys import Key as JobKey
from . import belt, belt_machine, ground_by, job_data, stock
from .belt import Belt
from .belt_machine import FRAMES, BeltMachine
from .geometry import placement_from_job, placement_to_job
from .job_data import child
from .job_inputs import without_geometry
from .kinds import DocumentObject
from .properties import FACTOR, get_value, rule, set_value
from .proxy import type_of
from .stock import Stock

if TYPE_CHECKING:
    from .properties import Key

NUMBERS = (
    "Length",
    "Distance",
    "Force",
    "Pressure",
    "Float",
    "Speed",
    "Angle",
    "Acceleration",
    "Integer",
)
OF_PROGRAM = {"feed_mm_s": "FeedOverride", "force_N": "ForceOverride"}
PROGRAM = re.compile(r"programs\[(\d+|\*)\]\.(feed_mm_s|force_N)")
INDEX = re.compile(r"\[(\d+)\]")


class Choice(NamedTuple):
    """A key that may vary."""

    key: str  # as a study writes it
    text: str  # what it is, in English
    value: object  # now; None: none
    choices: list[str] | None  # of a word; None for a number


def choices(job: DocumentObject) -> list[Choice]:
    """[Choice] of a job in the document, those that can be set back first."""
    found = []
    for obj, keys in _holders(job):
        for key in keys:
            words = key.kind == "Enumeration"
            if not words and key.kind not in NUMBERS:
                continue
            about = rule(key.key)[0]
            found.append(
                Choice(
                    _written(key.key),
                    f"{obj.Label}: {about.get('description', key.name)}",
                    get_value(obj, key),
                    list(about["enum"]) if words else None,
                )
            )
    for k, path in enumerate(ground_by.active(job)):
        for name, value in zip(OF_PROGRAM, _of_path(path)):
            found.append(Choice(f"programs[{k}].{name}", f"{path.Label}: {name}", value, None))
    for name in OF_PROGRAM:
        found.append(Choice(f"programs[*].{name}", f"all programs: {name}", None, None))
    for place in (vary.PLACEMENT, vary.STOCK_PLACEMENT):
        what = "part" if place == vary.PLACEMENT else "stock"
        for axis in vary.AXES:
            found.append(Choice(f"{place}.{axis}", f"error of the {what}'s place", 0.0, None))
    return found


def _of_path(path: DocumentObject) -> tuple[float | None, float | None]:
    """(feed mm/s, force N) of a program: its overrides, else the middle of its poses'."""
    feed, force = path.FeedOverride.Value, path.ForceOverride.getValueAs("N").Value
    feeds = [f for f, rapid in zip(path.Feeds, path.Rapid) if not rapid]
    forces = [f for f in path.Forces if f >= 0.0]
    return (
        feed or (float(np.median(feeds)) if feeds else None),
        force or (float(np.median(forces)) if forces else None),
    )


def _holders(job: DocumentObject) -> list[tuple[DocumentObject, Sequence[Key]]]:
    """[(object, its Keys)] of a job."""
    found: list[tuple[DocumentObject, Sequence[Key]]] = [(job, job_data.KEYS)]
    machine, raw = child(job, BeltMachine), child(job, Stock)
    if machine is not None:
        found.append((machine, (*belt_machine.KIND_KEYS[machine.Kind], *belt_machine.KEYS)))
        if type_of(machine.Belt) == Belt.TYPE:
            found.append((machine.Belt, belt.KEYS))
    if raw is not None:
        found.append((raw, [key for key in stock.KEYS if key.name in stock.USED[raw.Kind]]))
    return found


def _written(dotted: str) -> str:
    """A property's key as a study writes it: inspection.tolerance_mm[0]."""
    return re.sub(r"\.(\d+)", r"[\1]", dotted)


def _dotted(written: str) -> str:
    return INDEX.sub(r".\1", written)


def base(job: DocumentObject) -> dict[str, Any]:
    """The job's settings that can be set back, as a job has them."""
    data = without_geometry(job)
    raw = child(job, Stock)
    if raw is not None:
        data["stock"] = raw.Proxy.settings(raw)
        data["stock"]["placement"] = placement_to_job(raw.FilePlacement)
    data["programs"] = [
        {
            "feed_mm_s": path.FeedOverride.Value or None,
            "force_N": path.ForceOverride.getValueAs("N").Value or None,
        }
        for path in ground_by.active(job)
    ]
    return json.loads(json.dumps(data, allow_nan=False))


def put_in(job: DocumentObject, held: Json, study: Json, values: Json) -> list[str]:
    """Sets the job's properties to a run: ``held``: of ``base``, when the study was run; ``study``: its settings with
    defaults; ``values``: of the run, by name. Returns the names of those that no property holds."""
    found: list[vary.Variable] = []
    left: list[vary.Variable] = []
    for one in vary.variables(study):
        (found if _settable(job, one) else left).append(one)
    given = copy.deepcopy(held)
    made = vary.job_of(given, found, [values[one.name] for one in found], study["placement"])
    for one in found:
        _put(job, one, made)
    return [one.name for one in left]


def _settable(job: DocumentObject, one: vary.Variable) -> bool:
    if one.key == vary.PART:
        return False
    if isinstance(one.key, JobKey):
        return PROGRAM.fullmatch(one.key.text) is not None or _holder(job, one.key.text) is not None
    raw = child(job, Stock)
    if one.key.startswith(vary.STOCK_PLACEMENT):
        return raw is not None and raw.Kind == "mesh" and bool(raw.File) and raw.Source is None
    return child(job, BeltMachine) is not None


def _holder(job: DocumentObject, text: str) -> tuple[DocumentObject, Key] | None:
    """(object, Key) of the property that holds a key, or the list that it is in; None without one."""
    dotted = _dotted(text)
    for obj, keys in _holders(job):
        for key in keys:
            if dotted == key.key or dotted.startswith(key.key + "."):
                return obj, key
    return None


def _put(job: DocumentObject, one: vary.Variable, made: Json) -> None:
    if isinstance(one.key, JobKey):
        programs = PROGRAM.fullmatch(one.key.text)
        if programs is None:
            obj, held = known(_holder(job, one.key.text))
            set_value(obj, held, _value(made, held.key))
            return
        for k, path in enumerate(ground_by.active(job)):
            if programs[1] in ("*", str(k)):
                value = made["programs"][k][programs[2]]
                scale = FACTOR["Force"] if programs[2] == "force_N" else 1.0
                setattr(path, OF_PROGRAM[programs[2]], scale * value)
        return
    if one.key.startswith(vary.STOCK_PLACEMENT):
        raw: DocumentObject = child(job, Stock)
        raw.FilePlacement = placement_from_job(made["stock"]["placement"])
        return
    machine: DocumentObject = child(job, BeltMachine)
    for name, (key, _) in FRAMES.items():
        if key == vary.OF_HOLDING[made["cell"]["holding"]]:
            setattr(machine, name, placement_from_job(made["cell"][key]))


def _value(made: Json, dotted: str) -> Any:
    node: Any = made
    for part in dotted.split("."):
        node = node[int(part)] if part.isdigit() else node[part]
    return node


def spread(choice: Choice) -> list[float]:
    """A first range around the value of a ``Choice``: [low, high]."""
    value = choice.value
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        return [0.0, 1.0]
    if value == 0.0:
        return [-0.1, 0.1]
    ends = sorted((0.8 * value, 1.2 * value))
    return [float(f"{end:.6g}") for end in ends]
