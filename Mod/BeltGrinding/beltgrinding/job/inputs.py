"""What a job's result depends on, by SHA-256, so that a result can be traced to its inputs."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ..base.kinds import Json
from ..base.regular_files import open_regular
from ..engine import InputError
from ..presets import urdf_shapes

BESIDE = (".dat", ".dtx", ".pgx", ".pjx")  # files of a robot program's name that are read with it
CHUNK = 1 << 20  # bytes
LARGEST = 1 << 40  # bytes


def digests(job: Json) -> list[dict[str, Any]]:
    """List of dicts, one an input of a validated job: ``what`` (the job's key), ``file`` (its path, or
    None for what the job itself holds), ``bytes`` and ``sha256`` (None where there is no such file).
    The job itself comes first, as its JSON with sorted keys and without blanks.
    """
    found = [_held("job", job)]
    for what, path, data in _inputs(job):
        if path is not None:
            found.append(file_digest(what, path))
        else:
            found.append(_text(what, data) if isinstance(data, str) else _held(what, data))
    return found


def files(job: Json) -> list[Path]:
    """Paths of all files that a validated job reads."""
    return [path for _, path, _ in _inputs(job) if path is not None]


def _inputs(job: Json) -> Iterator[tuple[str, Path | None, Any]]:
    """(the job's key, path or None, what the job itself holds) of each input."""
    for key in ("design", "stock"):
        if "file" in job[key]:
            yield key, Path(job[key]["file"]), None
        elif "brep" in job[key]:
            yield f"{key}.brep", None, job[key]["brep"]
        if "left_by" in job[key]:
            yield f"{key}.left_by", Path(job[key]["left_by"]), None
    for i, body in enumerate(job["cell"].get("bodies", [])):
        if "file" in body:
            yield f"cell.bodies[{i}]", Path(body["file"]), None
        else:
            yield f"cell.bodies[{i}].brep", None, body["brep"]
    for i, program in enumerate(job["programs"]):
        if "file" in program:
            for path in _program_files(program["file"], program.get("values")):
                yield f"programs[{i}]", path, None
        else:
            yield f"programs[{i}].poses", None, program["poses"]
    robot = job["robot"]
    if robot["model"]["urdf"]:
        for path in urdf_shapes.files(robot["model"], robot["packages"]):
            yield "robot.model.urdf", path, None
    surrogate = job["belt_machine"]["compliance"]["surrogate_file"]
    if surrogate:
        yield "belt_machine.compliance.surrogate_file", Path(surrogate), None


def _program_files(path: Path | str, values: str | Json | None = None) -> list[Path]:
    from ..programs.registry import side_files, values_beside

    path = Path(path)
    given = []
    if not isinstance(values, Mapping):  # else part of the job, and so of its own digest
        said = Path(values) if values else values_beside(path)
        given = [said] if os.path.isfile(said) else []
    try:
        near = sorted(path.parent.iterdir())
    except OSError:
        near = []
    stem = path.stem.lower()
    beside = [
        p
        for p in near
        if p != path and p.stem.lower() == stem and p.suffix.lower() in BESIDE and p.is_file()
    ]
    return [path, *given, *beside, *(p for p in side_files(path) if p not in beside)]


def canonical(data: Any) -> bytes:
    """The bytes of plain data that its hash is taken of."""
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()


def _held(what: str, data: Any) -> dict[str, Any]:
    return _digest(what, None, canonical(data))


def _text(what: str, text: str) -> dict[str, Any]:
    return _digest(what, None, text.encode("utf-8", "surrogatepass"))


def _digest(what: str, file: str | None, data: bytes) -> dict[str, Any]:
    return {
        "what": what,
        "file": file,
        "bytes": len(data),
        "sha256": hashlib.sha256(data).hexdigest(),
    }


def file_digest(what: str, path: Path | str) -> dict[str, Any]:
    """The dict of one file; of what is none (a device would never end) bytes and sha256 are None."""
    found = hashlib.sha256()
    size = 0
    try:
        with open_regular(path, LARGEST) as file:
            while data := file.read(CHUNK):
                found.update(data)
                size += len(data)
    except (OSError, InputError):
        return {"what": what, "file": str(path), "bytes": None, "sha256": None}
    return {"what": what, "file": str(path), "bytes": size, "sha256": found.hexdigest()}
