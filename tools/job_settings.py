#!/usr/bin/env python3
"""Writes the dataclasses of a job, Mod/BeltGrinding/beltgrinding/job/settings.py, from the job's schema.

The schema stays the only home of defaults, ranges and texts. A key's name gives its unit.
tests/house/test_job_settings.py holds both together.
"""

import json
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCHEMA = ROOT / "Resources" / "schema" / "job.schema.json"
SETTINGS = ROOT / "Mod" / "BeltGrinding" / "beltgrinding" / "job" / "settings.py"

HEAD = '''"""A job's settings as frozen dataclasses, one of each object of its schema. Made by tools/job_settings.py; not to be edited.

Units stand in the names. Defaults, ranges and what each means: Resources/schema/job.schema.json. A key that a job may
leave out, and for which the schema has no default, is None.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal
'''
# Where the key's own name would be taken twice, or is no singular.
NAMES = {
    "": "Job",
    "belt_machine.frame": "BeltFrame",
    "belt_machine.platen.layers": "Layer",
    "belt_machine.compliance.layers": "Layer",
    "robot.model": "RobotModel",
    "robot.model.joints": "Joint",
    "robot.external_axes": "ExternalAxis",
    "robot.load": "Load",
    "robot.program": "RobotProgram",
    "finish.model": "FinishModel",
    "finish.model.ranges": "FinishRanges",
    "inspection.sections": "InspectedSection",
    "inspection.zones": "Zone",
    "inspection.zones.finish": "ZoneFinish",
    "cell.bodies": "Body",
    "programs": "Program",
}
# Rows of data by the million, which stay what they are.
ROWS = {"programs.poses": "Sequence[Mapping[str, Any]]"}
SIMPLE = {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}


def text():
    """What settings.py must be, unformatted but for what black leaves as it is."""
    schema, classes = json.loads(SCHEMA.read_text(encoding="utf-8")), {}
    frame = schema["definitions"]["frame"]
    _class("Frame", "A frame in a job", frame, "", classes)
    _object("", schema, classes)
    return HEAD + "".join(f"\n\n{one}" for one in classes.values())


def _object(place, rule, classes):
    """The name of a closed object's dataclass, which is added to ``classes`` behind those that it needs."""
    last = place.rpartition(".")[2]
    name = NAMES.get(place) or "".join(word.capitalize() for word in last.split("_"))
    about = f"``{place}`` of a job" if place else "A whole job"
    _class(name, about, rule, place, classes)
    return name


def _class(name, about, rule, place, classes):
    lines = ["@dataclass(frozen=True, kw_only=True)", f"class {name}:", f'    """{about}."""', ""]
    for key, sub in rule["properties"].items():
        kind = _type(f"{place}.{key}".lstrip("."), sub, classes)
        known = "default" in sub or key in rule.get("required", ())
        lines.append(f"    {key}: {kind}" if known else f"    {key}: {kind} | None = None")
    lines = "\n".join(lines) + "\n"
    fields = lambda text: text.partition('."""\n')[2]
    assert fields(classes.get(name, lines)) == fields(lines), f"two objects are called {name}"
    classes.setdefault(name, lines)


def _type(place, rule, classes):
    if place in ROWS:
        return ROWS[place]
    if "$ref" in rule:
        return "Frame"
    if "enum" in rule:
        return "Literal[" + ", ".join(json.dumps(v, ensure_ascii=False) for v in rule["enum"]) + "]"
    kinds = rule["type"]
    if isinstance(kinds, list):
        return " | ".join(_type(place, {**rule, "type": kind}, classes) for kind in kinds)
    if kinds == "array":
        item = _type(place, rule["items"], classes)
        count = rule.get("minItems")
        if count == rule.get("maxItems") and count is not None:
            return "tuple[" + ", ".join([item] * count) + "]"
        return f"tuple[{item}, ...]"
    if kinds == "object":
        closed = rule.get("additionalProperties") is False
        return _object(place, rule, classes) if closed else "Mapping[str, Any]"
    return SIMPLE[kinds]


if __name__ == "__main__":
    SETTINGS.write_text(text(), encoding="utf-8")
