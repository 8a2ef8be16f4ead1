"""The job in the document: a group that holds the settings and everything that belongs to it."""

import hashlib
import json
import tempfile

import numpy as np
import Part

from .. import InputError, core, job as jobs
from ..poses import list_poses
from . import bodies
from .belt_machine import BeltMachine
from .deviation import Deviation
from .ground_mesh import GroundMesh
from .geometry import faces_digest, placed_shape
from .properties import Key, add_keys, check_limits, to_job
from .proxy import Proxy, type_of
from .robot_path import RobotPath
from .section import Section
from .simulation import Simulation
from .stock import Stock
from . import told
from .verdict import Verdict

KEYS = (
    Key("FlipNormals", "Bool", "Design", "design.flip_normals"),
    Key("Spacing", "Length", "Sampling", "sampling.spacing_mm"),
    Key("Depth", "Length", "Sampling", "sampling.depth_mm"),
    Key("ToleranceLower", "Distance", "Tolerance", "inspection.tolerance_mm.0"),
    Key("ToleranceUpper", "Distance", "Tolerance", "inspection.tolerance_mm.1"),
    Key("ColourLimit", "Length", "Tolerance", "inspection.colour_limit_mm"),
    Key("Zones", "JSON", "Tolerance", "inspection.zones"),
    Key("Law", "Enumeration", "Law", "law.model"),
    Key("LawCoefficient", "Float", "Law", "law.coefficient_mm2_per_N"),
    Key("PressureThreshold", "Pressure", "Law", "law.pressure_threshold_MPa"),
    Key("PressureExponent", "Float", "Law", "law.pressure_exponent"),
    Key("ReferencePressure", "Pressure", "Law", "law.reference_pressure_MPa"),
    Key("SaturationPressure", "Pressure", "Law", "law.saturation_pressure_MPa"),
    Key("SpeedExponent", "Float", "Law", "law.speed_exponent"),
    Key("ReferenceSpeed", "Speed", "Law", "law.reference_speed_m_s", 1000.0),
    Key("FeedExponent", "Float", "Law", "law.feed_exponent"),
    Key("ReferenceFeed", "Speed", "Law", "law.reference_feed_mm_s"),
    Key("LandShare", "Float", "Law", "law.land_share"),
    Key("PressureCurve", "VectorList", "Law", "law.pressure_curve"),
    Key("SpeedCurve", "VectorList", "Law", "law.speed_curve"),
    Key("FeedCurve", "VectorList", "Law", "law.feed_curve"),
    Key("LandCurve", "VectorList", "Law", "law.land_curve"),
    Key("HeatLimit", "Float", "Law", "law.heat_limit_MPa_m_s"),
    Key("PressureLimit", "Pressure", "Law", "law.pressure_limit_MPa"),
    Key("Calibration", "JSON", "Law", "law.calibration"),
    Key("WearModel", "Enumeration", "Wear", "law.wear.model"),
    Key("WearVariable", "Enumeration", "Wear", "law.wear.variable"),
    Key("WearScale", "Float", "Wear", "law.wear.scale"),
    Key("WearRest", "Float", "Wear", "law.wear.rest"),
    Key("WearFirstShare", "Float", "Wear", "law.wear.first_share"),
    Key("WearFirstScale", "Float", "Wear", "law.wear.first_scale"),
    Key("WearCurve", "VectorList", "Wear", "law.wear.curve"),
    Key("MaxTravel", "Length", "Steps", "simulation.max_travel_mm"),
    Key("MaxAngle", "Angle", "Steps", "simulation.max_angle_deg"),
    Key("OrientationJump", "Angle", "Steps", "simulation.orientation_jump_deg"),
    Key("TiltLimit", "Angle", "Steps", "simulation.tilt_limit_deg"),
    Key("Timing", "Enumeration", "Timing", "simulation.timing"),
    Key("PathAcceleration", "Acceleration", "Timing", "simulation.path_acceleration_mm_s2"),
    Key("AngularAcceleration", "Float", "Timing", "simulation.angular_acceleration_deg_s2"),
    Key("RotationSpeed", "Float", "Timing", "simulation.rotation_speed_deg_s"),
    Key("DefaultZone", "Length", "Timing", "simulation.default_zone_mm"),
)


class BeltGrindingJob(Proxy):
    """Proxy of the App::DocumentObjectGroupPython."""

    TYPE = "BeltGrinding::Job"
    VIEW = "JobView"

    def add_properties(self, obj):
        if "DesignFaces" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyLinkSubListGlobal", "DesignFaces", "Design", "the faces to be ground"
            )
        add_keys(obj, KEYS)

    def execute(self, obj):
        """Marks the result out of date or up to date, and recolours it; never simulates. Raises
        InputError for settings that cannot be, so that the tree shows where the mistake is.
        """
        simulation = child(obj, Simulation)
        if simulation is not None and simulation.Fingerprint:
            try:
                stale = fingerprint(obj) != simulation.Fingerprint
            except InputError:
                stale = True
            simulation.OutOfDate = stale
            told.update(simulation, inspection(obj))
        for mesh in children(obj, GroundMesh):
            mesh.Proxy.update(mesh)
        for deviation in children(obj, Deviation):
            deviation.Proxy.update(deviation)
        for section in children(obj, Section):
            section.Proxy.update(section)
        for verdict in children(obj, Verdict):
            verdict.Proxy.update(verdict)
        check_limits(obj, KEYS)
        if obj.ToleranceLower > obj.ToleranceUpper:
            raise InputError(f"{obj.Label}: ToleranceLower lies above ToleranceUpper")
        jobs.check_zones(zones(obj), design(obj)[1])


def children(job, proxy):
    """The job's children of a proxy class, in the tree's order."""
    return [obj for obj in job.Group if type_of(obj) == proxy.TYPE]


def child(job, proxy):
    """The job's first child of a proxy class, or None."""
    return next(iter(children(job, proxy)), None)


def required(job, proxy, what):
    """The job's child of a proxy class. Raises InputError."""
    found = child(job, proxy)
    if found is None:
        raise InputError(f"{job.Label} has no {what}; add one")
    return found


def simulated(job):
    """The job's Simulation, which has a result. Raises InputError."""
    found = child(job, Simulation)
    if found is None or not found.Fingerprint:
        raise InputError(f"{job.Label} has no result yet; simulate first")
    return found


def inspection(job):
    """The part of a job under 'inspection'."""
    data = {}
    to_job(job, KEYS, data)
    return data["inspection"]


def zones(job):
    """The tolerance zones of a job, as its key inspection.zones has them."""
    return inspection(job)["zones"]


def set_zones(job, found):
    """Gives a job tolerance zones. Raises InputError, and leaves the old ones, for wrong ones."""
    from .. import schemas

    rule = schemas.schema("job")["properties"]["inspection"]["properties"]["zones"]
    found = schemas.checked(list(found), rule, "zones")
    jobs.check_zones(found, design(job)[1])
    job.Zones = json.dumps(found) if found else ""


def design(job):
    """(shape, numbers of its faces from 1) in the document's coordinates. Raises InputError.

    Several objects become one compound, whose faces are numbered through.
    """
    return shape_of(job.DesignFaces, job.Label)


def shape_of(links, label):
    """(shape, numbers of its faces from 1) of a list of (object, face names), as ``design`` gives
    them; ``label`` stands for its owner. Raises InputError.
    """
    if not links:
        raise InputError(f"{label}: no faces are chosen; select faces and add them to the job")
    shapes, numbers, offset = [], [], 0
    for obj, subs in _by_object(links):
        shape = placed_shape(obj)
        count = len(shape.Faces)
        if count == 0:
            raise InputError(f"{label}: {obj.Label} has no faces")
        for number in _face_numbers(label, obj, subs, count):
            if number + offset not in numbers:
                numbers.append(number + offset)
        shapes.append(shape)
        offset += count
    return (shapes[0] if len(shapes) == 1 else Part.Compound(shapes)), sorted(numbers)


def face_numbers(job, obj, subs):
    """Numbers from 1, as ``design`` has them, of faces of one of the job's objects; none of another
    object. Raises InputError.
    """
    offset = 0
    for one, _ in _by_object(job.DesignFaces):
        count = len(one.Shape.Faces)
        if one == obj:
            return [number + offset for number in _face_numbers(job.Label, obj, subs, count)]
        offset += count
    return []


def face_name(job, index):
    """Object.FaceN of the face that ``design`` numbers ``index`` + 1, '' if the job no longer has
    it."""
    for obj, _ in _by_object(job.DesignFaces):
        count = len(obj.Shape.Faces)
        if index < count:
            return f"{obj.Label}.Face{index + 1}"
        index -= count
    return ""


def _by_object(links):
    merged = {}
    for obj, subs in links:
        merged.setdefault(obj, []).extend([subs] if isinstance(subs, str) else subs)
    return merged.items()


def _face_numbers(label, obj, subs, count):
    names = [sub.rpartition(".")[2] for sub in subs]
    if not any(names):
        return range(1, count + 1)
    numbers = []
    for name in names:
        if not (name.startswith("Face") and name[4:].isdigit()):
            raise InputError(f"{label}: {obj.Label}.{name or '(all)'} is no face; choose faces")
        if not 1 <= int(name[4:]) <= count:
            raise InputError(
                f"{label}: {obj.Label} has no {name}; it has {count} faces. Choose them again"
            )
        numbers.append(int(name[4:]))
    return numbers


def _without_geometry(job):
    """The job's settings, without shapes, meshes and poses."""
    data = {"schema": 1}
    to_job(job, KEYS, data)
    data.update(required(job, BeltMachine, "belt machine").Proxy.to_job(child(job, BeltMachine)))
    return data


def _paths(job):
    paths = children(job, RobotPath)
    if not paths:
        raise InputError(f"{job.Label} has no robot program; import one")
    return paths


def _overrides(path):
    """A program's keys that replace its own feeds and forces."""
    keys = {}
    if path.ForceOverride.Value > 0:
        keys["force_N"] = path.ForceOverride.getValueAs("N").Value
    if path.FeedOverride.Value > 0:
        keys["feed_mm_s"] = path.FeedOverride.Value
    return keys


def fingerprint(job):
    """Hash of all that the simulation's result depends on; not of the tolerance, nor of what the
    belt has done since.
    """
    data = _without_geometry(job)
    data["belt_machine"].pop("belt", None)
    del data["inspection"]
    stock = required(job, Stock, "stock")
    data["stock"] = stock.Proxy.settings(stock)
    data["stock"]["digest"] = stock.Proxy.digest(stock)
    shape, data["design"]["faces"] = design(job)
    chosen = set(data["design"]["faces"])
    data["design"]["digest"] = faces_digest(f for i, f in enumerate(shape.Faces, 1) if i in chosen)
    data["cell"]["bodies"] = bodies.digest(child(job, BeltMachine))
    data["programs"] = [
        {**_overrides(path), "digest": path.Proxy.digest(path)} for path in _paths(job)
    ]
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def to_data(job, folder):
    """The whole job as validated plain data; a mesh stock is written to ``folder``.

    Raises InputError naming the object and what is wrong with it.
    """
    data = _without_geometry(job)
    shape, data["design"]["faces"] = design(job)
    data["design"]["brep"] = shape.exportBrepToString()
    stock = required(job, Stock, "stock")
    data["stock"] = stock.Proxy.to_job(stock, folder)
    data["cell"]["bodies"] = bodies.to_job(child(job, BeltMachine), folder)
    paths = _paths(job)
    data["programs"] = [{"poses": []} for _ in paths]
    # The poses come from properties that hold nothing but numbers, and they may be many.
    data = jobs.validate(data, folder)
    for program, path in zip(data["programs"], paths):
        program.update(_overrides(path))
        program["name"] = path.Label
        program["poses"] = list_poses(path.Proxy.arrays(path))
        program["unresolved"] = len(path.Problems)
        if len(program["poses"]) < 2:
            raise InputError(f"{path.Label}: {len(program['poses'])} poses; two make a path")
    return data


def inputs(data):
    """What of a job's plain data the result depends on: no tolerance, no names and places of files."""
    data = {key: value for key, value in data.items() if key != "inspection"}
    data["stock"] = _without_file(data["stock"])
    placed = [_without_file(body) for body in data["cell"].get("bodies", [])]
    data["cell"] = {**data["cell"], "bodies": placed}
    return data


def _without_file(data):
    return {key: value for key, value in data.items() if key != "file"}


def tool_paths(job):
    """core.ToolPath of every program, one after the other as they are run. Raises InputError."""
    data = _without_geometry(job)
    machine = child(job, BeltMachine)
    cell = machine.Proxy.cell(machine)
    paths = []
    for path in _paths(job):
        arrays = dict(path.Proxy.arrays(path))
        keys = _overrides(path)
        for name, key in (("feeds", "feed_mm_s"), ("forces", "force_N")):
            if key in keys:
                arrays[name] = np.full(len(arrays["lines"]), keys[key])
        paths.append(core.ToolPath(**arrays, **cell, time_law=jobs.time_law(data["simulation"])))
    return paths


def scratch_folder():
    """A folder for a mesh stock, removed when the object dies."""
    return tempfile.TemporaryDirectory(prefix="beltgrinding-")
