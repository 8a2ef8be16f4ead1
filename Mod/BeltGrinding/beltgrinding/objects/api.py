"""What a macro and every button call; ``import beltgrinding`` offers these functions too.

Keyword arguments set properties by name; a plain number is in FreeCAD's unit (mm, mm/s, degree), a
text may carry its unit: ``Force="40 N"``. Every function raises InputError for what the user must
mend, and leaves the document as it was.
"""

import json
from pathlib import Path

import FreeCAD
import Part

from .. import InputError, job as jobs
from ..examples import blade
from ..poses import listed_poses
from ..programs import ProgramError
from ..result import Result, write_whole
from . import (
    belt as belts,
    belt_machine,
    bodies,
    deviation as deviations,
    job_object,
    raster_path,
    robot_path,
    section as sections,
    simulation as results,
    verdict as verdicts,
)
from . import stock as stocks
from . import ground_mesh, scanned
from .geometry import placement_from_job
from .job_object import child, children
from .preferences import apply_threads
from .properties import from_job, set_by_name
from .proxy import type_of
from .telling import check_settings, make_figures, write_report  # noqa: F401


apply_threads()  # before anything computes, whoever calls: a button or a macro


def make_job(design, faces=(), **properties):
    """Adds a job to the design's document. ``design``: a Part object; ``faces``: names such as
    "Face3" or numbers from 1, none for all; or ``design`` is a list of (object, names).
    """
    links = design if isinstance(design, (list, tuple)) else [(design, faces)]
    links = [
        (obj, tuple(f"Face{s}" if isinstance(s, int) else s for s in subs) or ("",))
        for obj, subs in links
    ]
    if not links:
        raise InputError("a job needs a part; give an object with a shape, or select faces")
    job = links[0][0].Document.addObject("App::DocumentObjectGroupPython", "BeltGrindingJob")
    with _removed_on_error(job):
        job.Label = "Belt grinding"
        job_object.BeltGrindingJob(job)
        job.DesignFaces = links
        job_object.design(job)
        set_by_name(job, properties)
    return job


def make_stock(job, source=None, **properties):
    """Adds the stock to a job, or changes the one it has. ``source``: a Part or Mesh object, or a
    mesh's file; its kind follows from it.
    """
    if source is not None:
        if isinstance(source, (str, Path)):
            properties = {"Kind": "mesh", "File": str(Path(source).absolute()), **properties}
        else:
            kind = "mesh" if hasattr(source, "Mesh") else "solid"
            properties = {"Kind": kind, "Source": source, **properties}
    return _child(job, stocks.Stock, "Stock", "Stock", properties)


def make_belt_machine(job, **properties):
    """Adds the belt machine to a job, or changes the one it has."""
    machine = _child(job, belt_machine.BeltMachine, "BeltMachine", "Belt machine", properties)
    for path in children(job, robot_path.RobotPath):
        path.Machine = machine
    return machine


def make_belt(job, **properties):
    """Puts a belt, which carries its wear from run to run, on the job's machine, or changes the one
    it has. Another job shares it by its machine's ``Belt``.
    """
    machine = job_object.required(job, belt_machine.BeltMachine, "belt machine")
    if machine.Belt is None:
        made = job.Document.addObject("App::FeaturePython", "Belt")
        with _removed_on_error(made):
            belts.Belt(made)
            set_by_name(made, properties)
            job.addObject(made)
        machine.Belt = made
    else:
        set_by_name(machine.Belt, properties)
    return machine.Belt


def wear_belt(job):
    """Counts what the belt did in the job's simulation, once the grind is done for real: the next
    run meets the belt as it is then. Returns the belt.
    """
    simulation = child(job, results.Simulation)
    if simulation is None:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    belt = make_belt(job)
    belt.Proxy.count(belt, simulation)
    return belt


def import_program(job, path, **properties):
    """Adds a robot program's file (.src, .csv) as RobotPath to a job, or to a document."""
    document = job if isinstance(job, FreeCAD.Document) else job.Document
    program = document.addObject("Path::FeaturePython", "RobotPath")
    with _removed_on_error(program):
        robot_path.RobotPath(program)
        robot_path.load_program(program, path, **properties)
        program.Label = Path(path).stem
        if job is not document:
            program.Machine = child(job, belt_machine.BeltMachine)
            job.addObject(program)
        program.recompute()
    return program


def follow_path(job, source, **properties):
    """Adds a RobotPath that follows a path object of FreeCAD: a ``Path::Feature`` (CAM), whose
    commands say where the contact runs, or a ``Robot::TrajectoryObject``. It changes when that does.
    """
    program = source.Document.addObject("Path::FeaturePython", "RobotPath")
    with _removed_on_error(program):
        robot_path.RobotPath(program)
        program.Machine = child(job, belt_machine.BeltMachine)
        program.SourceObject = source
        robot_path.follow(program)
        set_by_name(program, properties)
        program.Label = f"{source.Label} ground"
        job.addObject(program)
        program.recompute()
    return program


def make_raster(job, faces=(), compute=True, **properties):
    """Adds a raster path to a job: contact passes side by side on ``faces``, given as for
    ``make_job`` (names of the first design object, or a list of (object, names)); none: the job's
    design faces. It is laid anew when an input changes. ``compute=False`` leaves it empty until
    the document is recomputed.
    """
    machine = job_object.required(job, belt_machine.BeltMachine, "belt machine")
    links = list(faces) or job.DesignFaces
    if isinstance(links[0], (str, int)):
        names = tuple(f"Face{s}" if isinstance(s, int) else s for s in links)
        links = [(job.DesignFaces[0][0], names)]
    path = job.Document.addObject("Path::FeaturePython", "RasterPath")
    with _removed_on_error(path):
        raster_path.RasterPath(path)
        path.Label = "Raster"
        path.Faces = links
        path.Machine = machine
        set_by_name(path, properties)
        job.addObject(path)
        if compute:
            raster_path.generate(path)
            path.recompute()
    return path


def export_program(path, file, **options):
    """Writes a RobotPath as a new robot program (.src, .mod, .script, .csv), overrides applied.

    Poses are written as they are, arcs as the chords they were cut into; the robot's tool and base
    come from the belt machine where it has a robot. ``options``: of ``programs.write_program``.
    """
    try:
        return robot_path.write(path, file, **options)
    except ProgramError as error:
        raise InputError(str(error)) from None


def simulate(job, context=None, write_to=None):
    """Grinds the job here and now; returns its Simulation object. ``write_to``: a folder for the
    files that ``beltgrind run`` writes.
    """
    with job_object.scratch_folder() as folder:
        result = jobs.run(job_object.to_data(job, folder), context)
    if write_to is not None:
        result.write(write_to)
    return store_result(job, result, job_object.fingerprint(job))


def store_result(job, result, fingerprint):
    """Puts a ``job.Result`` into the job's Simulation and returns that. ``fingerprint``: of the
    inputs that the run had (``job_object.fingerprint``); the job marks others as out of date.
    """
    simulation = child(job, results.Simulation)
    if simulation is None:
        simulation = job.Document.addObject("App::FeaturePython", "Simulation")
        results.Simulation(simulation)
        job.addObject(simulation)
    results.store(simulation, result, fingerprint)
    simulation.touch()
    job.Document.recompute()
    return simulation


def make_deviation(job):
    """Adds the coloured deviation of the job's simulation, or returns the one that is there."""
    simulation = child(job, results.Simulation)
    if simulation is None:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    found = child(job, deviations.Deviation)
    if found is None:
        found = job.Document.addObject("Mesh::FeaturePython", "Deviation")
        with _removed_on_error(found):
            deviations.Deviation(found)
            found.Simulation = simulation
            job.addObject(found)
            found.Proxy.update(found)
    job.Document.recompute()
    return found


def make_verdict(job):
    """Adds the verdict on the job's simulation, or returns the one that is there. It follows the
    result and the job's tolerances.
    """
    simulation = child(job, results.Simulation)
    if simulation is None or not simulation.Fingerprint:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    found = child(job, verdicts.Verdict)
    if found is None:
        found = job.Document.addObject("App::FeaturePython", "Verdict")
        with _removed_on_error(found):
            verdicts.Verdict(found)
            found.Simulation = simulation
            job.addObject(found)
            found.Proxy.update(found)
    job.Document.recompute()
    return found


def set_zones(job, zones):
    """Gives a job tolerance zones: a list of dicts as the key inspection.zones of a job file, faces
    numbered from 1 (docs/verification.md).
    """
    job_object.set_zones(job, zones)
    job.Document.recompute()


def make_section(job, point=None, normal=None, start=None, end=None, **properties):
    """Adds a cross-section of the job's simulation: by the plane through ``point`` with ``normal``, or
    along the surface from ``start`` to ``end`` (mm, the document's frame). Without any of them: across
    the longest side of the surface, in its middle. Raises InputError where there is nothing to cut.
    """
    simulation = child(job, results.Simulation)
    if simulation is None or not simulation.Fingerprint:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    field = sections.field_of(simulation)
    if field is None:
        raise InputError(f"{simulation.Label}: its height field is missing; simulate again")
    if (point is None) != (normal is None) or (start is None) != (end is None):
        raise InputError("a section needs a point and a normal, or a start and an end")
    found = job.Document.addObject("App::FeaturePython", "Section")
    with _removed_on_error(found):
        sections.Section(found)
        found.Label = "Cross-section"
        found.Simulation = simulation
        found.Point, found.Normal = sections.first_plane(field)
        if point is not None:
            found.Point, found.Normal = tuple(point), tuple(normal)
        if start is not None:
            found.Start, found.End, found.Cut = tuple(start), tuple(end), sections.LINE
        set_by_name(found, properties)
        job.addObject(found)
        found.Proxy.update(found)
        if found.Problem:
            raise InputError(found.Problem)
    job.Document.recompute()
    return found


def make_ground_mesh(job, **properties):
    """Adds the ground part as one closed Mesh object, or makes the one that is there anew. Raises
    InputError where the result is missing or out of date.
    """
    simulation = child(job, results.Simulation)
    if simulation is None:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    found = child(job, ground_mesh.GroundMesh)
    if found is not None:
        set_by_name(found, properties)
        ground_mesh.make(found)
        return found
    found = job.Document.addObject("Mesh::FeaturePython", "GroundPart")
    with _removed_on_error(found):
        ground_mesh.GroundMesh(found)
        found.Label = "Ground part"
        found.Simulation = simulation
        job.addObject(found)
        set_by_name(found, properties)
        ground_mesh.make(found)
    job.Document.recompute()
    return found


def compare_scan(job, path, **options):
    """Aligns a scan of the ground part and keeps its heights with the Simulation; returns the figures.
    ``options``: of ``scan.compare`` (unit_mm, start, pairs, datum_faces, fixed, ...).
    """
    simulation = child(job, results.Simulation)
    figures = scanned.compare(simulation, job, path, **options)
    simulation.touch()
    job.Document.recompute()
    return figures


def export_job(job, path):
    """Writes the job as job.json, which ``beltgrind run`` grinds without FreeCAD; a mesh stock is
    written beside it.
    """
    path = Path(path)
    try:
        data = job_object.to_data(job, path.resolve().parent)
        for holder in (data["stock"], *data["cell"]["bodies"]):
            if "file" in holder:
                holder["file"] = _relative(holder["file"], path.resolve().parent)
        write_whole(path, (json.dumps(data) + "\n").encode())
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    return path


def _relative(path, folder):
    path = Path(path)
    return path.name if path.parent == folder else str(path)


def import_result(job, folder):
    """Brings back what ``beltgrind run`` wrote to ``folder`` for this job. A result of other inputs
    is marked out of date.
    """
    result = Result.read(folder)
    with job_object.scratch_folder() as scratch:
        same = job_object.inputs(job_object.to_data(job, scratch)) == job_object.inputs(result.job)
    return store_result(job, result, job_object.fingerprint(job) if same else "other inputs")


def open_job(doc, path):
    """Makes the objects of a job.json in a document; returns the job."""
    data = jobs.load(path)
    made = []
    try:
        return _open_job(doc, data, Path(path), made)
    except Exception:
        for obj in reversed(made):
            doc.removeObject(obj.Name)
        raise


def open_example(folder):
    """A new document with the example blade, whose files are written to ``folder``; its job."""
    return open_job(FreeCAD.newDocument("Blade"), blade.make(folder))


def _open_job(doc, data, path, made):
    shape = jobs.read_design(data["design"])
    part = doc.addObject("Part::Feature", "Design")
    made.append(part)
    part.Label = Path(data["design"].get("file", path)).stem
    brep = Part.Shape()
    brep.importBrepFromString(shape.write_brep())
    part.Shape = brep
    faces = data["design"]["faces"]
    job = make_job(part, faces)
    made.append(job)
    from_job(job, job_object.KEYS, data)
    stock = make_stock(job)
    made.append(stock)
    _open_stock(doc, stock, data["stock"], made)
    machine = make_belt_machine(job)
    made.append(machine)
    from_job(machine, belt_machine.KEYS, data)
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
            robot = import_program(job, program["file"])
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
    doc.recompute()
    return job


def _open_stock(doc, stock, data, made):
    from_job(stock, stocks.KEYS, {"stock": data})
    if data["kind"] == "mesh":
        stock.File = data["file"]
        stock.FilePlacement = placement_from_job(data.get("placement"))
    elif data["kind"] == "solid":
        solid = doc.addObject("Part::Feature", "StockSolid")
        made.append(solid)
        brep = Part.Shape()
        brep.importBrepFromString(jobs.read_design(data).write_brep())
        solid.Shape = brep
        stock.Source = solid


def is_job(obj):
    """True for a BeltGrindingJob."""
    return type_of(obj) == job_object.BeltGrindingJob.TYPE


def _child(job, proxy, name, label, properties):
    """The job's child of a kind, made where it is missing, with properties set."""
    found = child(job, proxy)
    if found is not None:
        set_by_name(found, properties)
        return found
    found = job.Document.addObject("App::FeaturePython", name)
    with _removed_on_error(found):
        proxy(found)
        found.Label = label
        set_by_name(found, properties)
        job.addObject(found)
    return found


class _removed_on_error:
    """Removes a new object from its document if the block fails."""

    def __init__(self, obj):
        self.document, self.name = obj.Document, obj.Name

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is not None and self.document.getObject(self.name) is not None:
            self.document.removeObject(self.name)
        return False
