"""All that a job's result depends on: as plain data, as a fingerprint, as paths of the wheel."""

from __future__ import annotations

import hashlib
import json
import math
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ..base import schemas
from ..base.kinds import Json
from ..engine import InputError, core
from ..job import engine_input, load as jobs
from ..job.poses import list_poses
from ..job.workpiece import OwnBrep
from . import bodies, ground_by
from .belt_machine import BeltMachine
from .damage import check_job
from .geometry import faces_digest
from .job_data import KEYS, child, design, flips, required
from .kinds import DocumentObject, PartFace
from .program_values import no_path
from .properties import to_job
from .stock import Stock

TURN = ("qw", "qx", "qy", "qz")  # of a pose
SAME = 1e-9  # of a number, mm: what digits of a file and a placement round


def without_geometry(job: DocumentObject) -> dict[str, Any]:
    """The job's settings, without shapes, meshes and poses."""
    check_job(job)
    data: dict[str, Any] = {"schema": 1}
    to_job(job, KEYS, data)
    data["design"].update(flips(job))
    data.update(required(job, BeltMachine, "belt machine").Proxy.to_job(child(job, BeltMachine)))
    return data


def belt_machine(job: DocumentObject) -> dict[str, Any]:
    """The part of a job under 'belt_machine', with its defaults. Raises InputError."""
    machine = required(job, BeltMachine, "belt machine")
    given = machine.Proxy.to_job(child(job, BeltMachine))["belt_machine"]
    rule = schemas.schema("job")["properties"]["belt_machine"]
    return schemas.checked(given, rule, "belt_machine")


def wear(job: DocumentObject) -> dict[str, Any]:
    """A job's ``law`` and ``belt_machine``, validated: what it takes to tell how far a belt is worn. Raises InputError."""
    rules, data = schemas.schema("job")["properties"], without_geometry(job)
    return {
        "law": schemas.checked(data["law"], rules["law"], "law"),
        "belt_machine": belt_machine(job),
    }


def without_programs(job: DocumentObject, folder: Path | str) -> dict[str, Any]:
    """The job as validated plain data, as ``to_data`` gives it, before it has paths. Raises InputError."""
    data = without_geometry(job)
    shape, data["design"]["faces"] = design(job)
    data["design"]["brep"] = OwnBrep(shape.exportBrepToString())
    stock = required(job, Stock, "stock")
    data["stock"] = stock.Proxy.to_job(stock, folder)
    data["cell"]["bodies"] = bodies.to_job(child(job, BeltMachine), folder)
    data["programs"] = [{"poses": []}]
    return jobs.validate(data, folder)


def overrides(path: DocumentObject) -> dict[str, float]:
    """A program's keys that replace its own feeds and forces, and what happens to the belt before it."""
    keys: dict[str, float] = {}
    if path.ForceOverride.Value > 0:
        keys["force_N"] = path.ForceOverride.getValueAs("N").Value
    if path.FeedOverride.Value > 0:
        keys["feed_mm_s"] = path.FeedOverride.Value
    if path.PauseBefore > 0:
        keys["pause_s"] = path.PauseBefore
    if path.DressBefore:
        keys["dress"] = True
    return keys


def fingerprint(job: DocumentObject) -> str:
    """Hash of all that the simulation's result depends on; not of the tolerance, nor of what the
    belt has done since.
    """
    data = without_geometry(job)
    data["belt_machine"].pop("belt", None)
    data["robot"].pop("controller", None)  # plans keep to it, and give the job its numbers
    data["robot"].get("program", {}).pop("base", None)  # only the written program has it
    del data["inspection"]
    stock = required(job, Stock, "stock")
    data["stock"] = stock.Proxy.settings(stock)
    data["stock"]["digest"] = stock.Proxy.digest(stock)
    shape, data["design"]["faces"] = design(job)
    chosen = set(data["design"]["faces"])
    data["design"]["digest"] = faces_digest(f for i, f in enumerate(shape.Faces, 1) if i in chosen)
    data["cell"]["bodies"] = bodies.digest(child(job, BeltMachine))
    data["programs"] = [
        {**overrides(path), "digest": path.Proxy.digest(path)} for path in ground_by.required(job)
    ]
    return hashlib.sha256(json.dumps(data, sort_keys=True, allow_nan=False).encode()).hexdigest()


def to_data(
    job: DocumentObject, folder: Path | str, meshes: Path | str | None = None
) -> dict[str, Any]:
    """The whole job as validated plain data for a file in ``folder``; meshes of the document are written
    to the folder ``meshes``, by default there.

    Raises InputError naming the object and what is wrong with it.
    """
    data = without_geometry(job)
    shape, data["design"]["faces"] = design(job)
    data["design"]["brep"] = OwnBrep(shape.exportBrepToString())
    stock = required(job, Stock, "stock")
    data["stock"] = stock.Proxy.to_job(stock, meshes or folder)
    data["cell"]["bodies"] = bodies.to_job(child(job, BeltMachine), meshes or folder)
    paths = ground_by.required(job)
    data["programs"] = [{"poses": []} for _ in paths]
    # The poses come from properties that hold nothing but numbers, and they may be many.
    data = jobs.validate(data, folder)
    for program, path in zip(data["programs"], paths):
        program.update(overrides(path))
        program["name"] = path.Label
        program["poses"] = list_poses({**path.Proxy.arrays(path), "gaps": path.Proxy.gaps(path)})
        program["unresolved"] = len(path.Problems)
        if len(program["poses"]) < 2:
            for why in no_path(path):
                raise InputError(
                    "objects.no_path_of", "{object}: {why}", object=path.Label, why=why
                )
            raise InputError(
                "objects.too_few_poses",
                "{object}: {count} poses; two make a path",
                object=path.Label,
                count=len(program["poses"]),
            )
    return data


def inputs(data: Json) -> dict[str, Any]:
    """What of a job's plain data the result depends on: no tolerance, no names and places of files."""
    data = {key: value for key, value in data.items() if key != "inspection"}
    data["stock"] = _without_file(data["stock"])
    placed = [_without_file(body) for body in data["cell"].get("bodies", [])]
    data["cell"] = {**data["cell"], "bodies": placed}
    return data


def same_inputs(one: Json, other: Json) -> bool:
    """Whether results of two jobs' plain data are the same: numbers but for the last digits, which a file and a
    placement round, shapes by what they look like."""
    return _alike(inputs(one), inputs(other))


def _alike(one: Any, other: Any, key: str = "") -> bool:
    if isinstance(one, dict) and isinstance(other, dict):
        if one.keys() != other.keys():
            return False
        turns = [key for key in TURN if key in one]
        turned = all(_alike(-one[key], other[key]) for key in turns)  # the same rotation
        return all(turned and k in turns or _alike(one[k], other[k], k) for k in one)
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        if len(one) != len(other):
            return False
        if key.startswith("quaternion") and not all(map(_alike, one, other)):
            return all(_alike(-a, b) for a, b in zip(one, other))  # the same rotation
        return all(map(_alike, one, other))
    if isinstance(one, float) or isinstance(other, float):
        numbers = all(isinstance(value, (int, float)) for value in (one, other))
        return numbers and math.isclose(one, other, rel_tol=SAME, abs_tol=SAME)
    if key == "brep" and isinstance(one, str) and isinstance(other, str) and one != other:
        return faces_digest(_faces(one)) == faces_digest(_faces(other))
    return bool(one == other)


def _faces(brep: str) -> list[PartFace]:
    shape = Part.Shape()
    shape.importBrepFromString(brep)
    faces: list[PartFace] = shape.Faces
    return faces


def _without_file(data: Json) -> dict[str, Any]:
    return {key: value for key, value in data.items() if key not in ("file", "left_by")}


def tool_paths(
    job: DocumentObject, programs: Sequence[DocumentObject] | None = None
) -> list[core.ToolPath]:
    """core.ToolPath of every program, one after the other as they are run; ``programs``: of these. Raises
    InputError."""
    data = without_geometry(job)
    machine: DocumentObject = child(job, BeltMachine)
    cell = machine.Proxy.cell(machine)
    paths = []
    for path in ground_by.required(job) if programs is None else programs:
        arrays = dict(path.Proxy.arrays(path))
        keys = overrides(path)
        for name, key in (("feeds", "feed_mm_s"), ("forces", "force_N")):
            if key in keys:
                arrays[name] = np.full(len(arrays["lines"]), keys[key])
        paths.append(
            core.ToolPath(**arrays, **cell, time_law=engine_input.time_law(data["simulation"]))
        )
    return paths


def scratch_folder() -> tempfile.TemporaryDirectory[str]:
    """A folder for a mesh stock, removed when the object dies."""
    return tempfile.TemporaryDirectory(prefix="beltgrinding-")
