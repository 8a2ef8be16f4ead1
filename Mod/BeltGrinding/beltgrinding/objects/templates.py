"""Templates: a job's settings without its part and programs, as a file that gives them to other jobs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..base import schemas
from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Json
from . import belt_machine, job_data, job_inputs, stock as stocks
from .geometry import placement_from_job
from .job_data import child
from .kinds import DocumentObject
from .properties import from_job
from .set_up import make_belt_machine, make_stock

# Rooms of a job that a template holds.
ROOMS = "stock inspection law heat finish resolution simulation belt_machine cell robot".split()
OF_PART = (  # keys that go with one part, or with one belt
    ("inspection", "zones"),
    ("inspection", "sections"),
    ("belt_machine", "belt"),
    ("cell", "bodies"),
)


def export_template(job: DocumentObject, path: Path | str) -> Path:
    """Writes the job's tolerance, law, belt machine, cell, robot and time law, and a uniform allowance, as JSON; not its
    part, faces, zones and programs, nor the bodies of its cell. Raises InputError."""
    data = job_inputs.without_geometry(job)
    stock = child(job, stocks.Stock)
    if stock is not None and stock.Kind == "allowance":
        data["stock"] = {"kind": "allowance", "allowance_mm": stock.Allowance.Value}
    for room, key in OF_PART:
        data.get(room, {}).pop(key, None)
    held = {"template": 1, **{room: data[room] for room in ROOMS if data.get(room)}}
    path = Path(path)
    try:
        write_whole(path, (json.dumps(held, indent=2, allow_nan=False) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
    return path


def _read(path: Path | str) -> dict[str, Any]:
    """A template's rooms, each as the job's schema has it. Raises InputError that names the file."""
    schema = schemas.schema("job")
    rooms = {room: schema["properties"][room] for room in ROOMS}
    rules = {
        **{key: rule for key, rule in schema.items() if key == "definitions"},
        "type": "object",
        "required": ["template"],
        "additionalProperties": False,
        "properties": {"template": {"enum": [1]}, **rooms},
    }
    schemas.checked_file(path, rules)
    found: dict[str, Any] = schemas.read_json(Path(path))  # without defaults: what it lacks stays
    del found["template"]
    return found


def apply_template(job: DocumentObject, path: Path | str) -> None:
    """Gives a job what a template's file holds; all else stays. Raises InputError; then nothing is changed."""
    data = _read(path)
    for room, key in OF_PART:
        data.get(room, {}).pop(key, None)
    from_job(job, job_data.KEYS, data)
    if "stock" in data:
        make_stock(job)
        from_job(child(job, stocks.Stock), stocks.KEYS, data)
    if {"belt_machine", "cell", "robot"} & set(data):
        _apply_machine(make_belt_machine(job), data)
    job.Document.recompute()


def _apply_machine(machine: DocumentObject, data: Json) -> None:
    from_job(machine, belt_machine.ALL_KEYS, data)
    for room, frames in (("cell", belt_machine.FRAMES), ("robot", belt_machine.ROBOT_FRAMES)):
        for name, (key, _) in frames.items():
            if key in data.get(room, {}):
                setattr(machine, name, placement_from_job(data[room][key]))
