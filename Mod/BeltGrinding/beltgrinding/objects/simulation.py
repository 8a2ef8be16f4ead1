"""The result of a simulation in the document: the stored height field, the events, the figures."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Json, known
from ..cell import event_lines, events as event_lists
from ..engine import InputError, core
from ..job import resolution
from ..job.poses import program_name
from ..simulation import result_folder
from . import part_scan, report_data, result_files
from .job_data import child, judged_by
from .kinds import DocumentObject, Event, Field
from .properties import Output, add_outputs
from .proxy import Proxy

if TYPE_CHECKING:
    from ..simulation.result import Result

OUTPUTS = (
    Output("OutOfDate", "Bool", "Result", "an input has changed since; simulate again"),
    Output("RemovedVolume", "Volume", "Result", "removed by grinding"),
    Output("StockVolume", "Volume", "Result", "on the design before"),
    Output("DesignArea", "Area", "Result", "of the faces"),
    Output("ProcessTime", "Float", "Result", "what the robot takes, s"),
    Output("WallTime", "Float", "Result", "what the simulation took, s"),
    Output("Samples", "Integer", "Result", "of the height field"),
    Output("SampleSpacing", "Length", "Result", "distance between neighbouring samples"),
    Output("Resolution", "String", "Result", "full, or coarse: for searching, and no verdict"),
    Output("Steps", "Integer", "Result", "of the simulation"),
    Output("MissedRays", "Integer", "Result", "samples over which no stock was found"),
    Output(
        "DefectiveSamples", "Integer", "Result", "samples where the stock lies below the design"
    ),
    Output("Events", "StringList", "Result", "what happened on the way"),
    Output("Warnings", "StringList", "Result", "what the user should know of the input"),
    Output("ElasticModel", "String", "Result", "compliance of the wheel"),
    Output("LawModel", "String", "Result", "law of removal"),
    Output("RemainingCut", "Float", "Result", "of the belt in the end, percent of a fresh one"),
    Output("BeltUse", "String", "Result", "what the belt did, as JSON", True),
    Output("EventData", "String", "Result", "the events as JSON", True),
    Output("EventZones", "String", "Result", "zones by which events tell the finish, JSON", True),
    Output("VerdictData", "String", "Result", "the verdict of the run and its limits, JSON", True),
    Output("UnresolvedMotions", "Integer", "Result", "places of the programs not resolved"),
    Output("Programs", "StringList", "Result", "names of the programs", True),
    Output("MotionPrograms", "IntegerList", "Result", "program of every motion, from 0", True),
    Output("MotionPoses", "IntegerList", "Result", "pose that every motion leads to, from 0", True),
    Output(
        "MotionLines", "IntegerList", "Result", "source line of every motion; 0: not known", True
    ),
    Output(
        "MotionTimes", "FloatList", "Result", "when every motion ends, s; empty: not known", True
    ),
    Output(
        "MotionPoints", "VectorList", "Result", "contact point at the end of every motion", True
    ),
    Output("Fingerprint", "String", "Result", "hash of the inputs", True),
)


KEEP = "KeepRecording"


class Simulation(Proxy):
    """Proxy. ``HeightField`` and ``Recording`` (if it was recorded) are HDF5 files, kept inside the
    document's file; the recording, which is most of it, only where ``KeepRecording`` says so.
    """

    TYPE = "BeltGrinding::Simulation"
    VIEW = "SimulationView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "HeightField" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyFileIncluded", "HeightField", "Result", "the ground height field"
            )
            obj.setEditorMode("HeightField", 1)
        add_outputs(obj, OUTPUTS)
        add_outputs(obj, result_files.OUTPUTS)
        report_data.add(obj)
        if KEEP not in obj.PropertiesList:
            text = "save the recording with the document, for playback after it is opened again"
            obj.addProperty("App::PropertyBool", KEEP, "Result", text)
            setattr(obj, KEEP, bool(getattr(obj, "Recording", "")))  # an older document's stays

    def onChanged(self, obj: DocumentObject, name: str) -> None:
        super().onChanged(obj, name)
        if name == KEEP:
            _arrange_recording(obj)

    def field(self, obj: DocumentObject) -> Field | None:
        """core.HeightField of the result; None if there is none."""
        path = result_files.sound(obj, "HeightField")
        return core.HeightField.from_hdf5(path)[0] if path else None

    def recording(self, obj: DocumentObject) -> tuple[core.Recording, dict[str, Array]] | None:
        """(core.Recording, steps as in ``Result.steps``) of the result; None if there is none."""
        data = result_files.read(obj, "Recording")
        if not data:
            return None
        recording, attributes = core.Recording.from_hdf5_bytes(data, obj.Recording)
        steps = json.loads(attributes)["steps"]
        return recording, {name: _unpacked(values) for name, values in steps.items()}

    def motions(self, obj: DocumentObject) -> dict[str, Array] | None:
        """As ``beltgrinding.motions`` has them; None where an older version made the result."""
        if not obj.MotionPoses:
            return None
        return {
            "program": np.array(obj.MotionPrograms),
            "pose": np.array(obj.MotionPoses),
            "line": np.array(obj.MotionLines),
            "point": np.array([tuple(point) for point in obj.MotionPoints]).reshape(-1, 3),
            **({"time": np.array(obj.MotionTimes)} if obj.MotionTimes else {}),
        }

    def events(self, obj: DocumentObject) -> list[Event]:
        """List of dicts, as events.schema.json says."""
        return event_lists.complete(json.loads(obj.EventData or "[]"))


def _packed(values: Array) -> list[str]:
    """[kind, Base64] of an array (n,): as text, numbers take longer than all else of the file."""
    kind = {"b": "|b1", "f": "<f8"}.get(values.dtype.kind, "<i8")
    return [kind, base64.b64encode(values.astype(kind).tobytes()).decode()]


def _unpacked(values: Sequence[Any]) -> Array:
    """The array of ``_packed``, or of the list of numbers of an older version."""
    if len(values) == 2 and isinstance(values[0], str):
        return np.frombuffer(base64.b64decode(values[1]), np.dtype(values[0])).copy()
    return np.array(values)


def files_of(result: Result, folder: str | None = None) -> result_files.Written:
    """The HDF5 files of a run's ``Result`` as ``result_files.Written``; may be called in any thread. ``folder``: the
    document's ``TransientDir``. Raises InputError."""
    job = {**_without_bulk(result.job), "run_id": result_folder.run_id(result.summary)}
    files: dict[str, Any] = {
        "HeightField": lambda file: result.field.hdf5_into(file, json.dumps(job, allow_nan=False))
    }
    if result.recording is not None:
        steps = {name: _packed(values) for name, values in known(result.steps).items()}
        about = json.dumps({"steps": steps}, allow_nan=False)
        files["Recording"] = lambda file: result.recording.hdf5_into(file, about)
    return result_files.Written(files, folder)


def store(
    obj: DocumentObject, result: Result, fingerprint: str, files: result_files.Written | None = None
) -> None:
    """Puts a run's ``Result`` into a Simulation object; ``files``: ``files_of`` it, if they are there."""
    files = files or files_of(result, obj.Document.TransientDir)
    try:
        _store(obj, result, files)
    except BaseException:
        obj.Fingerprint = ""  # half of it is there: no result, rather than two in one
        raise
    obj.Fingerprint = fingerprint
    obj.OutOfDate = False


def _store(obj: DocumentObject, result: Result, files: result_files.Written) -> None:
    part_scan.forget(obj)  # it was compared with the older result
    _prepare_recording(obj, result)
    result_files.store(obj, files)
    s = result.summary
    obj.RemovedVolume, obj.StockVolume = s["removed_volume_mm3"], s["stock_volume_mm3"]
    obj.DesignArea = s["design_area_mm2"]
    # The wall time tells results apart: rounded, it comes back from a file as it was.
    obj.ProcessTime, obj.WallTime = s["process_time_s"], round(sum(s["wall_time_s"].values()), 6)
    obj.Samples, obj.Steps = s["samples"], s["steps"]
    obj.SampleSpacing = result.field.spacing
    obj.Resolution = s.get("resolution", resolution.FULL)
    obj.MissedRays, obj.DefectiveSamples = s["missed_rays"], s["defective_samples"]
    store_events(obj, result.events, result.job)
    obj.EventZones = json.dumps(result.judged_by().get("zones", []), allow_nan=False)
    obj.Warnings = s["warnings"]
    obj.ElasticModel, obj.LawModel = s["models"]["compliance"], s["models"]["law"]
    obj.RemainingCut = 100.0 * s["belt"]["remaining_cut"]
    before, machine = result.job["belt_machine"]["belt"], result.job["belt_machine"]
    during = {key: s["belt"][key] - before[key] for key in before if key != "loading"}
    kept = {"belt_machine": {"belt_wear": machine["belt_wear"]}, "law": result.job["law"]}
    use = {"during": during, "loading": s["belt"].get("loading", 0.0), "job": kept}
    obj.BeltUse = json.dumps(use, allow_nan=False)
    report_data.store(obj, result)
    _store_verdict(obj, result)


def store_events(obj: DocumentObject, events: Sequence[Event], job: Json) -> None:
    """Puts events into a Simulation; ``job``: of which the programs' names are asked."""
    obj.Events = [describe(event, job) for event in events]
    obj.EventData = json.dumps(events, allow_nan=False)
    obj.EventCount = len(events)


def _store_verdict(obj: DocumentObject, result: Result) -> None:
    """The verdict of the run, and what it takes to judge again."""
    obj.UnresolvedMotions = result.summary.get("unresolved_motions", 0)
    obj.Programs = [program_name(result.job, i) for i in range(len(result.job["programs"]))]
    none: Mapping[str, Any] = {"program": [], "pose": [], "line": [], "point": []}
    motions = result.motions if result.motions else none
    for name in ("program", "pose", "line"):
        values = [int(value) for value in motions[name]]
        setattr(obj, f"Motion{name.title()}s", values)
    obj.MotionPoints = [tuple(map(float, point)) for point in motions["point"]]
    obj.MotionTimes = [float(time) for time in motions.get("time", ())]
    inspection = result.judged_by()
    judged = (
        {"inspection": judged_by(inspection), "verdict": result.verdict} if result.verdict else {}
    )
    obj.VerdictData = json.dumps(judged, allow_nan=False)


def _prepare_recording(obj: DocumentObject, result: Result) -> None:
    """The property exists only where there is a recording: FreeCAD empties none of its kind."""
    there = "Recording" in obj.PropertiesList
    if there and result.recording is None:
        obj.removeProperty("Recording")
    if there or result.recording is None:
        return
    text = "what changed in every step, for playback"
    obj.addProperty("App::PropertyFileIncluded", "Recording", "Result", text)
    obj.setEditorMode("Recording", 1)
    _arrange_recording(obj)


def _arrange_recording(obj: DocumentObject) -> None:
    """Has FreeCAD save the recording or leave it out."""
    if "Recording" in obj.PropertiesList:
        obj.setPropertyStatus("Recording", "-Transient" if getattr(obj, KEEP) else "Transient")


def lost_recording(obj: DocumentObject) -> bool:
    """Whether the run was recorded, and the recording not saved with the document."""
    return result_files.stored(obj, "Recording") and not obj.Recording


def _without_bulk(job: Json) -> dict[str, Any]:
    """The job without what the document holds anyway: shapes and poses."""
    bulk = ("brep", "poses")
    job = {k: v for k, v in job.items()}
    for part in ("design", "stock"):
        job[part] = {k: v for k, v in job[part].items() if k not in bulk}
    job["programs"] = [{k: v for k, v in p.items() if k not in bulk} for p in job["programs"]]
    bodies = [{k: v for k, v in b.items() if k not in bulk} for b in job["cell"].get("bodies", [])]
    job["cell"] = {**job["cell"], "bodies": bodies}
    return job


def errors(simulation: DocumentObject) -> list[core.Fact]:
    """[Fact]: what went wrong on the way so that the part is spoilt or the machine stops, one for each kind of event."""
    programs = [{"name": name} for name in simulation.Programs]
    found = simulation.Proxy.events(simulation)
    found = [e for e in found if e["severity"] == "error" and e["program"] < len(programs)]
    return [fact for _, fact in event_lines.lines(found, {"programs": programs})]


def is_coarse(simulation: DocumentObject) -> bool:
    """Whether a Simulation's figures are those of a coarse run; not of one of an older version."""
    return getattr(simulation, "Resolution", "") == resolution.COARSE


def describe(event: Event, job: Json) -> str:
    """One line for an event."""
    program = job["programs"][event["program"]]
    where = program.get("name") or Path(program.get("file", "program")).name
    line = f", line {event['line']}" if event["line"] else ""
    return (
        f"{event['kind']}: {where}, pose {event['pose'] + 1}{line}, "
        f"{event['time']:.2f} s: {event['message']}"
    )


def simulated(job: DocumentObject) -> DocumentObject:
    """The job's Simulation, which has a result. Raises InputError."""
    found = child(job, Simulation)
    if found is None or not found.Fingerprint:
        raise InputError(
            "objects.no_result", "{object} has no result yet; simulate first", object=job.Label
        )
    return found
