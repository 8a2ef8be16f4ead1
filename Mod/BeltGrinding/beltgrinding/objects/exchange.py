"""Jobs as files: writes one, and makes the objects of one. Offered by ``api``."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import FreeCAD
import Part

from ..base import schemas
from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Json
from ..engine import InputError
from ..examples import blade, edges, knife, tap, tap_belt, vane
from ..job import load as jobs, workpiece
from ..job.poses import listed_poses
from ..programs import given
from . import belt as belts, belt_machine, bodies, job_data, job_inputs, robot_path, stock as stocks
from .geometry import placement_from_job
from .kinds import Document, DocumentObject
from .properties import from_job
from .set_up import import_program, make_belt, make_belt_machine, make_job, make_stock


def export_job(job: DocumentObject, path: Path | str) -> Path:
    """Writes the job as job.json, which ``beltgrind run`` grinds without FreeCAD. Meshes of the document
    (stock, bodies), and what another job leaves, are written beside it, under names that begin as its own; none takes the place of a
    file that is there.
    """
    path = Path(path)
    folder = path.resolve().parent
    try:
        with job_inputs.scratch_folder() as scratch:
            data = job_inputs.to_data(job, folder, scratch)
            holders = [(one, "file") for one in (data["stock"], *data["cell"]["bodies"])]
            for holder, key in [*holders, (data["stock"], "left_by")]:
                if key not in holder:
                    continue
                file = Path(holder[key])
                if os.path.realpath(file.parent) == os.path.realpath(scratch):
                    file = _kept(file.read_bytes(), folder / f"{path.stem}_{file.name}")
                holder[key] = _relative(file, folder)
        write_whole(path, (json.dumps(data, allow_nan=False) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
    return path


def _kept(data: bytes, path: Path) -> Path:
    """The path of a file with these bytes: ``path``, or the next number of it that is free."""
    number = 2
    while True:
        if not os.path.lexists(path):
            write_whole(path, data)
            return path
        if path.is_file() and path.read_bytes() == data:
            return path
        stem = path.stem if number == 2 else path.stem.rpartition("_")[0]
        path = path.with_name(f"{stem}_{number}{path.suffix}")
        number += 1


def _relative(path: Path | str, folder: Path) -> str:
    path = Path(path)
    return path.name if path.parent == folder else str(path)


def open_job(doc: Document, path: Path | str) -> DocumentObject:
    """Makes the objects of a job.json in a document; returns the job."""
    data = jobs.load(path)
    made: list[DocumentObject] = []
    try:
        return _open_job(doc, data, Path(path), made)
    except Exception:
        for obj in reversed(made):
            doc.removeObject(obj.Name)
        raise


EXAMPLES = {
    "blade": blade,
    "tap": tap,
    "tap_belt": tap_belt,
    "vane": vane,
    "edges": edges,
    "knife": knife,
}


def open_example(folder: Path | str, name: str = "blade") -> DocumentObject:
    """A new document with an example, whose files are written to ``folder``; its job. ``name``: of
    ``EXAMPLES``.
    """
    if name not in EXAMPLES:
        raise InputError(
            "objects.no_example",
            "there is no example '{name}'; known: {known}",
            name=name,
            known=", ".join(EXAMPLES),
        )
    return open_job(FreeCAD.newDocument(name.title().replace("_", "")), EXAMPLES[name].make(folder))


def _values(program: Json) -> Any:
    """What a job gives of its program, as ``load_program`` takes it."""
    values = program.get("values")
    if isinstance(values, str) and values:
        given.load(Path(values))
        return schemas.read_json(Path(values))
    return values or None


def _open_job(doc: Document, data: Json, path: Path, made: list[DocumentObject]) -> DocumentObject:
    shape = workpiece.read_design(data["design"])
    part = doc.addObject("Part::Feature", "Design")
    made.append(part)
    part.Label = Path(data["design"].get("file", path)).stem
    brep = Part.Shape()
    brep.importBrepFromString(shape.write_brep())
    part.Shape = brep
    faces = data["design"]["faces"]
    job = make_job(part, faces)
    made.append(job)
    from_job(job, job_data.KEYS, data)
    stock = make_stock(job)
    made.append(stock)
    _open_stock(doc, stock, data["stock"], made)
    machine = make_belt_machine(job)
    made.append(machine)
    from_job(machine, belt_machine.ALL_KEYS, data)
    for name, (key, _) in belt_machine.FRAMES.items():
        setattr(machine, name, placement_from_job(data["cell"].get(key)))
    for name, (key, _) in belt_machine.ROBOT_FRAMES.items():
        setattr(machine, name, placement_from_job(data["robot"].get(key)))
    bodies.from_job(doc, machine, data["cell"]["bodies"], made)
    if any(data["belt_machine"]["belt"].values()):
        made.append(make_belt(job))
        from_job(machine.Belt, belts.KEYS, data)
    for i, program in enumerate(data["programs"]):
        if "file" in program:
            robot = import_program(job, program["file"], given=_values(program))
        else:
            arrays = listed_poses(program["poses"], f"programs[{i}]")
            robot = robot_path.make_robot_path(doc, arrays, program.get("name", "Program"))
            robot.Machine = machine
            job.addObject(robot)
        made.append(robot)
        if "force_N" in program:
            robot.ForceOverride = f"{program['force_N']} N"
        if "feed_mm_s" in program:
            robot.FeedOverride = program["feed_mm_s"]
        if "pause_s" in program:
            robot.PauseBefore = program["pause_s"]
        if program.get("dress"):
            robot.DressBefore = True
    doc.recompute()
    return job


def _open_stock(
    doc: Document, stock: DocumentObject, data: Json, made: list[DocumentObject]
) -> None:
    if "left_by" in data:
        raise InputError(
            "objects.left_by",
            "{key}: what an earlier run left cannot be opened in a document; run this job on the command line and import "
            "its result, or set the stock there to what another of its jobs leaves",
            key="stock.left_by",
        )
    from_job(stock, stocks.KEYS, {"stock": data})
    if data["kind"] == "mesh":
        stock.File = data["file"]
        stock.FilePlacement = placement_from_job(data.get("placement"))
    elif data["kind"] == "solid":
        solid = doc.addObject("Part::Feature", "StockSolid")
        made.append(solid)
        brep = Part.Shape()
        brep.importBrepFromString(workpiece.read_design(data).write_brep())
        solid.Shape = brep
        stock.Source = solid
