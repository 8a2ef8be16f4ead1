"""A robot path that is computed: passes side by side on faces, laid anew when an input changes."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np

from ..base.kinds import Array, Json
from ..engine import InputError, core
from ..job import load as jobs, machine as machines
from ..job.workpiece import OwnBrep
from ..raster import joined, raster_path as raster, region
from ..raster.reachable import NO_PASS, NO_ROOM
from . import bodies, job_data, job_inputs, job_object, stored_facts, waiting
from .belt_machine import BeltMachine
from .fields import field_of
from .geometry import faces_digest
from .kinds import DocumentObject
from .properties import Key, Output, add_keys, add_outputs, from_job, to_job
from .proxy import type_of
from .robot_path import RobotPath, set_arrays
from .stock import Stock

KEYS = (
    Key("Along", "Enumeration", "Passes", "raster.along"),
    Key("Direction", "Vector", "Passes", "raster.direction"),
    Key("RegionSize", "Length", "Passes", "raster.region_mm"),
    Key("FurtherPasses", "JSON", "Passes", "raster.further_passes"),
    Key("PassSpacing", "Enumeration", "Passes", "raster.spacing"),
    Key("StepOver", "Length", "Passes", "raster.step_over_mm"),
    Key("StepOverShare", "Float", "Passes", "raster.step_over_share"),
    Key("Footprint", "Enumeration", "Passes", "raster.footprint"),
    Key("Order", "Enumeration", "Passes", "raster.order"),
    Key("Repeats", "Integer", "Passes", "raster.repeats"),
    Key("RunOut", "Distance", "Passes", "raster.run_out_mm"),
    Key("KeepEdge", "Length", "Passes", "raster.keep_edge_mm"),
    Key("Bridge", "Length", "Passes", "raster.bridge_mm"),
    Key("MinLength", "Length", "Passes", "raster.min_length_mm"),
    Key("BeltAngle", "Angle", "Posing", "raster.belt_angle_deg"),
    Key("Offset", "Distance", "Posing", "raster.offset_mm"),
    Key("Smoothing", "Length", "Posing", "raster.smoothing_mm"),
    Key("EdgeTurn", "Angle", "Posing", "raster.edge_turn_deg"),
    Key("ChordError", "Length", "Posing", "raster.chord_error_mm"),
    Key("MaxDistance", "Length", "Posing", "raster.max_distance_mm"),
    Key("MaxTurn", "Angle", "Posing", "raster.max_turn_deg"),
    Key("TurnRate", "Float", "Posing", "raster.max_turn_deg_per_mm"),
    Key("Sampling", "Length", "Posing", "raster.sampling_mm"),
    Key("FitLimit", "Length", "Posing", "raster.fit_mm"),
    Key("WhereItCollides", "Enumeration", "Posing", "raster.where_it_collides"),
    Key("MaxTilt", "Angle", "Posing", "raster.max_tilt_deg"),
    Key("Feed", "Speed", "Process", "raster.feed_mm_s"),
    Key("MaxTcpFeed", "Speed", "Process", "raster.max_tcp_feed_mm_s"),
    Key("Force", "Force", "Process", "raster.force_N"),
    Key("Entry", "Enumeration", "Process", "raster.entry"),
    Key("Lead", "Length", "Process", "raster.lead_mm"),
    Key("Ramp", "Length", "Process", "raster.ramp_mm"),
    Key("BorderForceShare", "Float", "Process", "raster.border_force_share"),
    Key("TouchForceShare", "Float", "Process", "raster.touch_force_share"),
    Key("EntryFeed", "Speed", "Process", "raster.entry_feed_mm_s"),
    Key("Approach", "Enumeration", "Process", "raster.approach"),
    Key("ApproachLength", "Length", "Process", "raster.approach_mm"),
    Key("ApproachFeed", "Speed", "Process", "raster.approach_feed_mm_s"),
    Key("Clearance", "Length", "Process", "raster.clearance_mm"),
)
OUTPUTS = (
    Output("PassCount", "Integer", "Result", "number of passes"),
    Output("GroundLength", "Length", "Result", "length of all passes"),
    Output("StepOverUsed", "Length", "Result", "distance of neighbouring passes, at most"),
    Output("ContactWidth", "Length", "Result", "contact's width across the pass; 0: not asked for"),
    Output("LargestTurn", "Angle", "Result", "of the tool between neighbouring poses of a pass"),
    Output("FastestTurn", "Float", "Result", "of the tool along a pass, degrees per mm"),
    Output(
        "PlungeShare",
        "Float",
        "Result",
        "removed on the way down to the passes and off them, percent, by force and time; -1: not known",
    ),
    Output(
        "LeftOut",
        "Float",
        "Result",
        "of the area, where there is no room and no pass lies, percent",
    ),
    Output("NoPass", "Float", "Result", "of the area, where it fits and no pass lies, percent"),
    Output("LeftPoints", "VectorList", "Result", "corners of what is left out", True),
    Output("LeftTriangles", "IntegerList", "Result", "three of them each", True),
    Output("LeftStates", "IntegerList", "Result", "of the corners: 1 no room, 2 no pass", True),
    Output("Warnings", "StringList", "Result", "what the user should know of the passes"),
    stored_facts.output("Warnings", "Result"),
    Output("Inputs", "String", "Result", "hash of what the passes were laid from", True),
)


class RasterPath(RobotPath):
    """Proxy. A RobotPath like any other: the poses are its own, and only how they come differs."""

    VIEW = "RasterPathView"

    def add_properties(self, obj: DocumentObject) -> None:
        super().add_properties(obj)
        if "Faces" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyLinkSubListGlobal", "Faces", "Passes", "the faces with the passes"
            )
        if "RegionPoints" not in obj.PropertiesList:
            text = "passes only near these points of the faces; none: everywhere"
            obj.addProperty("App::PropertyVectorList", "RegionPoints", "Passes", text)
        if "Stock" not in obj.PropertiesList:
            text = "the job's stock, where the passes depend on it"
            obj.addProperty("App::PropertyLink", "Stock", "Passes", text)
        obj.setEditorMode("Stock", 2)
        if "Proposed" not in obj.PropertiesList:
            text = "laid as a first proposal, and nobody has looked at it since"
            obj.addProperty("App::PropertyBool", "Proposed", "Passes", text, 4)
        older = "Approach" in obj.PropertiesList
        added = {"Entry", "WhereItCollides", "Footprint"} - set(obj.PropertiesList) if older else ()
        add_keys(obj, KEYS)
        obj.setEditorMode("FurtherPasses", 2)  # with the points of their regions
        # The passes of an older document go on as they were, so that what it grinds stays.
        if "Entry" in added:
            obj.Entry = "direct"
        if "WhereItCollides" in added:
            obj.WhereItCollides = "warn"
        if "Footprint" in added:
            obj.Footprint = "cylinder"
        add_outputs(obj, OUTPUTS)
        for name in ("Source", "SourceObject"):
            obj.setEditorMode(name, 2)

    def execute(self, obj: DocumentObject) -> None:
        """Lays the passes anew if an input has changed; the last ones stay where that fails."""
        try:
            generate(obj)
        finally:
            super().execute(obj)


def generate(obj: DocumentObject) -> None:
    """Lays the passes of a raster path if what they come from has changed; for the way ``auto``, the best one is put
    in its place. Raises InputError, Cancelled."""
    job, settings, digest = _inputs(obj)
    stock = _stock(obj)
    if obj.Stock is not stock:  # so that it is touched with it
        obj.Stock = stock
    if digest == obj.Inputs:
        return
    with job_inputs.scratch_folder() as folder:
        _lay(obj, _with_geometry(obj, job, folder), settings, digest)


def _with_geometry(obj: DocumentObject, job: dict[str, Any], folder: Path | str) -> dict[str, Any]:
    """The job validated, with what ``_inputs`` leaves out; meshes are written to ``folder``."""
    job["design"]["brep"] = OwnBrep(job["design"]["brep"].exportBrepToString())
    job["cell"]["bodies"] = bodies.to_job(obj.Machine, folder)
    stock = _stock(obj)
    if stock is not None:
        job["stock"] = stock.Proxy.to_job(stock, folder)
    return jobs.validate(job)


def _lay(obj: DocumentObject, job: Json, settings: Json, digest: str) -> None:
    if settings.get("along") == "auto":
        text = FreeCAD.Qt.translate("BeltGrinding", "Comparing ways of the passes")
        found = waiting.wait(lambda context: raster.raster(job, settings, context), text)
        # From now on the way that was found is the user's: it changes no more by itself.
        obj.Along, obj.Direction = found["along"], FreeCAD.Vector(*found["direction"])
        digest = _inputs(obj)[2]
    else:
        text = FreeCAD.Qt.translate("BeltGrinding", "Laying the passes")
        found = waiting.wait(lambda context: raster.raster(job, settings, context), text)
    if obj.Planned:
        found["warnings"] = [
            *found["warnings"],
            core.Fact(
                "raster.plan_lost",
                "the passes were laid anew: the feeds that were planned for the former ones are gone; plan again",
            ),
        ]
    _take(obj, found, digest)


def settings_of(obj: DocumentObject) -> dict[str, Any]:
    """The settings of a raster path as ``raster.raster`` takes them, with its faces as the job numbers them. Raises
    InputError."""
    settings: dict[str, Any] = {}
    job = obj.getParentGroup()
    to_job(obj, KEYS, settings)
    settings = settings["raster"]
    settings["region_points"] = [list(point) for point in obj.RegionPoints]
    numbers = [job_data.face_numbers(job, part, names) for part, names in obj.Faces]
    settings["faces"] = sorted({number for some in numbers for number in some})
    return settings


def further_passes(obj: DocumentObject) -> list[dict[str, Any]]:
    """The settings of each further group of passes, with what it has of the first ones; [] where they cannot be read."""
    try:
        return joined.groups(raster.validate(settings_of(obj)))[1:]
    except InputError:
        return []


def take(obj: DocumentObject, settings: Json, found: Json) -> None:
    """Gives a raster path other settings, and the passes that ``raster.raster`` has laid by them."""
    from_job(obj, KEYS, {"raster": settings})
    _take(obj, found, _inputs(obj)[2])


def _take(obj: DocumentObject, found: Json, digest: str) -> None:
    set_arrays(obj, found)
    obj.Language = "raster"
    obj.PassCount = len(found["passes"])
    obj.GroundLength = sum(one["length_mm"] for one in found["passes"])
    obj.StepOverUsed = found["step_over_mm"]
    obj.ContactWidth = found["contact_width_mm"] or 0.0
    seen = found["check"]
    obj.LargestTurn = seen["turn_deg"]
    per_mm = seen["turn_deg_per_mm"]
    obj.FastestTurn = 1e9 if per_mm is None else per_mm  # on the spot
    obj.PlungeShare = -1.0 if seen["plunge_share"] is None else 100.0 * seen["plunge_share"]
    obj.LeftOut = 100.0 * found["reachable"]["left_out"]
    obj.NoPass = 100.0 * found["reachable"]["no_pass"]
    points, triangles, states = _left(found["places"])
    obj.LeftPoints = [tuple(point) for point in points.tolist()]
    obj.LeftTriangles = triangles.ravel().tolist()
    obj.LeftStates = states.tolist()
    stored_facts.store(obj, "Warnings", found["warnings"])
    obj.Inputs = digest


def _left(places: Json) -> tuple[Array, Array, Array]:
    """(points (n, 3), triangles (m, 3), states (n,)) of ``reachable.look``'s places that no pass touches: triangles
    with two such corners at least."""
    states = places["state"]
    triangles = places["triangles"]
    left = triangles[np.isin(states[triangles], (NO_ROOM, NO_PASS)).sum(axis=1) > 1]
    used, numbers = np.unique(left, return_inverse=True)
    return places["points"][used], numbers.reshape(-1, 3), states[used]


def _inputs(obj: DocumentObject) -> tuple[dict[str, Any], dict[str, Any], str]:
    """(job with the shape for its B-rep, settings, hash of both)."""
    if type_of(obj.Machine) != BeltMachine.TYPE:
        raise InputError(
            "objects.no_machine",
            "{object} has no belt machine; add one to the job",
            object=obj.Label,
        )
    data: dict[str, Any] = {"schema": 1}
    group = obj.getParentGroup()
    if type_of(group) == job_object.BeltGrindingJob.TYPE:
        to_job(group, job_data.KEYS, data)
        data = {key: data[key] for key in ("schema", "design", "law")}
    data.setdefault("design", {})
    data.update(obj.Machine.Proxy.to_job(obj.Machine))
    data["belt_machine"].pop("belt", None)  # its wear moves no pass
    shape, numbers = job_data.shape_of(obj.Faces, obj.Label)
    data["design"]["faces"] = numbers
    if type_of(group) == job_object.BeltGrindingJob.TYPE:
        data["design"].update(job_data.flips(group, obj.Faces))
    data["programs"] = [{"poses": []}]
    settings: dict[str, Any] = {}
    to_job(obj, KEYS, settings)
    settings = settings["raster"]
    settings["region_points"] = [list(point) for point in getattr(obj, "RegionPoints", [])]
    digest = faces_digest(shape.Faces[number - 1] for number in numbers)
    # Not what an older document has not: its passes need not be laid anew.
    newer = {"repeats": 1, "further_passes": []}
    told = {key: value for key, value in settings.items() if newer.get(key) != value}
    # Nor what one without bodies has not, and whose wheel goes alone.
    placed, stock = bodies.digest(obj.Machine), _stock(obj)
    more = [placed] if placed else []
    if stock is not None:
        more.append([stock.Proxy.settings(stock), stock.Proxy.digest(stock)])
    text = json.dumps([data, told, digest, *more], sort_keys=True, allow_nan=False)
    data["design"]["brep"] = shape
    return data, settings, hashlib.sha256(text.encode()).hexdigest()


def _stock(obj: DocumentObject) -> DocumentObject | None:
    """The job's stock, where passes depend on it: under position control, and where something goes with the wheel that
    must keep off it. Else None."""
    machine = obj.Machine
    held = machine.Kind == machines.SMALL_WHEEL
    if machine.Kind in (machines.FREE_BELT, machines.PLATEN):
        held = machine.FrameLength.Value > 0.0
    if machine.Control != "position" and not held and not bodies.listed(machine):
        return None
    group = obj.getParentGroup()
    if type_of(group) != job_object.BeltGrindingJob.TYPE:
        return None
    return job_data.child(group, Stock)


def to_what_is_left(obj: DocumentObject) -> None:
    """Restricts a raster path to where the last result of its job is above the tolerance. Raises InputError."""
    from .simulation import Simulation

    job = obj.getParentGroup()
    simulation: DocumentObject = job_data.child(job, Simulation)
    field = None if simulation is None else field_of(simulation)
    if field is None:
        raise InputError("raster.no_result", "there is no result yet: simulate first")
    data = {"inspection": job_data.inspection(job)}
    set_region(obj, region.of_field(field, data, where=simulation.Label)[0])


def to_what_others_leave(obj: DocumentObject) -> None:
    """Restricts a raster path to where the wheels of all other raster paths on its faces, whichever job they are of, do
    not get to or have no pass. Raises InputError."""
    chosen = {(part.Name, name) for part, names in obj.Faces for name in names}
    others = [
        other
        for other in obj.Document.Objects
        if other is not obj
        and getattr(other, "Active", False)
        and isinstance(getattr(other, "Proxy", None), RasterPath)
        and chosen <= {(part.Name, name) for part, names in other.Faces for name in names}
    ]
    if not others:
        raise InputError("raster.no_others", "no other raster path lies on these faces")
    left: set[Any] | None = None
    for other in others:
        mine = {tuple(point) for point in other.LeftPoints}
        left = mine if left is None else left & mine
    if not left:
        raise InputError("raster.others_leave_nothing", "the other raster paths leave nothing")
    set_region(obj, sorted(left))


def set_region(obj: DocumentObject, points: Any) -> None:
    """Restricts a raster path to the surroundings of points (n, 3) mm; to none: everywhere."""
    obj.RegionPoints = [tuple(point) for point in np.asarray(points, dtype=float).tolist()]


def proposed(path: DocumentObject) -> bool:
    """Whether a raster path is a first proposal that nobody has looked at; older documents have none."""
    return getattr(path, "Proposed", False)


def replace_proposed(job: DocumentObject) -> list[str]:
    """Removes the passes that were only proposed, for a program of the user's own; their labels."""
    gone = [path for path in job_data.children(job, RasterPath) if proposed(path)]
    labels = [path.Label for path in gone]
    for path in gone:
        job.Document.removeObject(path.Name)
    return labels
