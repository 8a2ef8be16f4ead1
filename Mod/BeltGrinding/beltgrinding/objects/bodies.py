"""The bodies of a belt machine's cell, to a job and from one."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import Mesh
import Part

from ..base.kinds import Json
from ..cell import collision
from ..job import bodies as job_bodies
from ..job.workpiece import MESH_SUFFIXES, read_design
from .belt_machine import BODIES
from .geometry import export_solid, geometry_digest, placement_from_job
from .kinds import Document, DocumentObject

JOB_FRAMES = {"base": "base", "tool": "tool", "contact": "wheel", "part": "part"}


def listed(machine: DocumentObject) -> list[tuple[str, str, DocumentObject]]:
    """(name in a job, frame in a job, object) of every body; the name is the label, made unique."""
    found, names = [], list(job_bodies.RESERVED)
    names += job_bodies.OF_KIND.get(machine.Kind, ())
    for prop, (frame, _) in BODIES.items():
        for obj in getattr(machine, prop):
            name, number = obj.Label, 2
            while name in names:
                name, number = f"{obj.Label} {number}", number + 1
            names.append(name)
            found.append((name, JOB_FRAMES[frame], obj))
    return found


def to_job(machine: DocumentObject, folder: Path | str) -> list[dict[str, Any]]:
    """The part of a job under 'cell.bodies'; meshes are written to ``folder``. Raises InputError."""
    return [
        {"name": name, "frame": frame, **export_solid(obj, folder, f"body{i + 1}")}
        for i, (name, frame, obj) in enumerate(listed(machine))
    ]


def digest(machine: DocumentObject) -> list[list[str]]:
    """What tells the bodies and their geometry apart from others."""
    return [[name, frame, geometry_digest(obj)] for name, frame, obj in listed(machine)]


def from_job(
    doc: Document, machine: DocumentObject, bodies: Iterable[Json], made: list[DocumentObject]
) -> None:
    """Makes the objects of a job's bodies; appends them to ``made``. Raises InputError."""
    properties = {JOB_FRAMES[frame]: name for name, (frame, _) in BODIES.items()}
    for body in bodies:
        if Path(body.get("file", "")).suffix.lower() in MESH_SUFFIXES:
            mesh = collision.read_body({**body, "placement": None}, body["name"], [])
            obj = doc.addObject("Mesh::Feature", "Body")
            obj.Mesh = Mesh.Mesh(mesh.vertices[mesh.triangles].reshape(-1, 3).tolist())
        else:
            obj = doc.addObject("Part::Feature", "Body")
            shape = Part.Shape()
            shape.importBrepFromString(read_design(body).write_brep())
            obj.Shape = shape
        made.append(obj)
        obj.Label = body["name"]
        obj.Placement = placement_from_job(body.get("placement")).multiply(obj.Placement)
        name = properties[body["frame"]]
        setattr(machine, name, [*getattr(machine, name), obj])
