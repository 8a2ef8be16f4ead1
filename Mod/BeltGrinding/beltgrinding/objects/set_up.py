"""Adds what a job consists of: part, stock, machine, belt, paths. Offered by ``api``."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import FreeCAD

from ..engine import InputError
from . import (
    belt as belts,
    belt_machine,
    job_data,
    job_object,
    mesh_part,
    raster_path,
    robot_path,
    stock as stocks,
)
from .creation import called, make_child, removed_on_error
from .job_data import child, children, required
from .kinds import Document, DocumentObject, Faces, Links
from .properties import set_by_name
from .proxy import type_of
from .simulation import Simulation, simulated


def make_job(
    design: DocumentObject | Links, faces: Sequence[str | int] = (), **properties: Any
) -> DocumentObject:
    """Adds a job to the design's document. ``design``: a Part object, or a Mesh object, of whose triangles
    a Part object with faces is made; ``faces``: names such as "Face3" or numbers from 1, none for all; or
    ``design`` is a list of (object, names).
    """
    links = design if isinstance(design, (list, tuple)) else [(design, faces)]
    if not links:
        raise InputError(
            "objects.no_part", "a job needs a part; give an object with a shape, or select faces"
        )
    meshes = [obj for obj, _ in links if hasattr(obj, "Mesh")]
    job = links[0][0].Document.addObject("App::DocumentObjectGroupPython", "BeltGrindingJob")
    with removed_on_error(job), contextlib.ExitStack() as parts:

        def part_of(obj: DocumentObject) -> DocumentObject:
            if obj not in meshes:
                return obj
            made = mesh_part.faces_of(obj)
            parts.enter_context(removed_on_error(made))
            return made

        job.Label = FreeCAD.Qt.translate("BeltGrinding", "Belt grinding")
        job_object.BeltGrindingJob(job)
        job.DesignFaces = [
            (part_of(obj), tuple(f"Face{s}" if isinstance(s, int) else s for s in subs) or ("",))
            for obj, subs in links
        ]
        job_data.design(job)
        set_by_name(job, properties)
    for mesh in meshes:
        if getattr(mesh, "ViewObject", None) is not None:
            mesh.ViewObject.Visibility = False
    return job


def make_stock(
    job: DocumentObject, source: DocumentObject | Path | str | None = None, **properties: Any
) -> DocumentObject:
    """Adds the stock to a job, or changes the one it has. ``source``: a Part or Mesh object, a
    mesh's file, or the job (or its Simulation) that leaves it; its kind follows from it.
    """
    if source is not None:
        if isinstance(source, (str, Path)):
            properties = {"Kind": "mesh", "File": str(Path(source).absolute()), **properties}
        else:
            if type_of(source) == job_object.BeltGrindingJob.TYPE:
                source = required(source, Simulation, "result")
            kind = "mesh" if hasattr(source, "Mesh") else "solid"
            kind = "left" if hasattr(source, "HeightField") else kind
            properties = {"Kind": kind, "Source": source, **properties}
    label = FreeCAD.Qt.translate("BeltGrinding", "Stock")
    return make_child(job, stocks.Stock, "Stock", label, properties)


def make_belt_machine(job: DocumentObject, **properties: Any) -> DocumentObject:
    """Adds the belt machine to a job, or changes the one it has."""
    label = FreeCAD.Qt.translate("BeltGrinding", "Belt machine")
    machine = make_child(job, belt_machine.BeltMachine, "BeltMachine", label, properties)
    for path in children(job, robot_path.RobotPath):
        path.Machine = machine
    return machine


def make_belt(job: DocumentObject, **properties: Any) -> DocumentObject:
    """Puts a belt, which carries its wear from run to run, on the job's machine, or changes the one
    it has. Another job shares it by its machine's ``Belt``.
    """
    machine = job_data.required(job, belt_machine.BeltMachine, "belt machine")
    if machine.Belt is None:
        made = job.Document.addObject("App::FeaturePython", "Belt")
        with removed_on_error(made):
            belts.Belt(made)
            called(made, FreeCAD.Qt.translate("BeltGrinding", "Belt"))
            set_by_name(made, properties)
            job.addObject(made)
        machine.Belt = made
    else:
        set_by_name(machine.Belt, properties)
    return machine.Belt


def wear_belt(job: DocumentObject) -> DocumentObject:
    """Counts what the belt did in the job's simulation, once the grind is done for real: the next
    run meets the belt as it is then. Returns the belt.
    """
    simulation = simulated(job)
    belt = make_belt(job)
    belt.Proxy.count(belt, simulation)
    return belt


def import_program(
    job: DocumentObject | Document, path: Path | str, **properties: Any
) -> DocumentObject:
    """Adds a robot program's file (.src, .csv) as RobotPath to a job, or to a document. In the job it takes the
    place of passes that were only proposed (``set_up``), or both would be ground.
    """
    document = job if isinstance(job, FreeCAD.Document) else job.Document
    program = document.addObject("Path::FeaturePython", "RobotPath")
    with removed_on_error(program):
        robot_path.RobotPath(program)
        if job is not document:  # whose force device the file may use
            program.Machine = child(job, belt_machine.BeltMachine)
        robot_path.load_program(program, path, **properties)
        program.Label = Path(path).stem
        if job is not document:
            job.addObject(program)
        program.recompute()
    if job is not document:
        program.Proxy.replaced = raster_path.replace_proposed(job)
    return program


def follow_path(job: DocumentObject, source: DocumentObject, **properties: Any) -> DocumentObject:
    """Adds a RobotPath that follows a path object of FreeCAD: a ``Path::Feature`` (CAM), whose
    commands say where the contact runs, or a ``Robot::TrajectoryObject``. It changes when that does.
    """
    program = source.Document.addObject("Path::FeaturePython", "RobotPath")
    with removed_on_error(program):
        robot_path.RobotPath(program)
        program.Machine = child(job, belt_machine.BeltMachine)
        program.SourceObject = source
        robot_path.follow(program)
        set_by_name(program, properties)
        program.Label = f"{source.Label} ground"
        job.addObject(program)
        program.recompute()
    program.Proxy.replaced = raster_path.replace_proposed(job)
    return program


def make_raster(
    job: DocumentObject, faces: Faces = (), compute: bool = True, **properties: Any
) -> DocumentObject:
    """Adds a raster path to a job: contact passes side by side on ``faces``, given as for
    ``make_job`` (names of the first design object, or a list of (object, names)); none: the job's
    design faces. It is laid anew when an input changes. ``compute=False`` leaves it empty until
    the document is recomputed.
    """
    machine = job_data.required(job, belt_machine.BeltMachine, "belt machine")
    links = list(faces) or job.DesignFaces
    if isinstance(links[0], (str, int)):
        names = tuple(f"Face{s}" if isinstance(s, int) else s for s in links)
        links = [(job.DesignFaces[0][0], names)]
    path = job.Document.addObject("Path::FeaturePython", "RasterPath")
    with removed_on_error(path):
        raster_path.RasterPath(path)
        path.Label = FreeCAD.Qt.translate("BeltGrinding", "Raster")
        path.Faces = links
        path.Machine = machine
        set_by_name(path, properties)
        job.addObject(path)
        if compute:
            raster_path.generate(path)
            path.recompute()
    return path


def export_program(path: DocumentObject, file: Path | str, **options: Any) -> Any:
    """Writes a RobotPath as a new robot program (.src, .mod, .script, .ls, .jbi, .csv), overrides applied.

    Poses are written as they are, arcs as the chords they were cut into. Tool and base are set as the
    path's ``ProgramTool`` and ``ProgramBase`` say; where the belt machine has a robot, their numbers are
    told in the program. ``options``, and what is returned: of ``programs.write_program``.
    """
    return robot_path.write(path, file, **options)
