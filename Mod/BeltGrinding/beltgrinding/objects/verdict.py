"""The verdict in the document: in tolerance or not, where not, and which motions did it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..base.kinds import Array, Json
from ..cell import events as event_lists
from ..engine import InputError
from ..inspection import finish_events, finish_zones, verdict as verdicts
from .geometry import core_shape
from .kinds import DocumentObject, Field
from .properties import Output, add_outputs
from .proxy import Proxy
from .fields import field_of
from .simulation import store_events

OUTPUTS = (
    Output("Overall", "String", "Verdict", "pass, fail or unknown"),
    Output("OutOfDate", "Bool", "Verdict", "an input of the simulation has changed since"),
    Output("FaceVerdicts", "StringList", "Verdict", "a line for every face"),
    Output("ZoneVerdicts", "StringList", "Verdict", "a line for every zone"),
    Output("FacesFailed", "Integer", "Verdict", "faces that fail"),
    Output("ZonesFailed", "Integer", "Verdict", "zones that fail"),
    Output("InTolerance", "Float", "Figures", "share of the inspected area, percent"),
    Output("AboveTolerance", "Float", "Figures", "share with too much left, percent"),
    Output("BelowTolerance", "Float", "Figures", "share cut too deep, percent"),
    Output("Worst", "Distance", "Figures", "deviation farthest beyond its limit, or next to it"),
    Output("WorstBeyond", "Distance", "Figures", "how far; negative: what is left to the limit"),
    Output("WorstPoint", "VectorDistance", "Figures", "where that is"),
    Output("ClustersAbove", "Integer", "Figures", "connected areas with too much left"),
    Output("ClustersBelow", "Integer", "Figures", "connected areas cut too deep"),
    Output(
        "LargestCluster", "Area", "Figures", "area of the largest connected place out of tolerance"
    ),
    Output("UntouchedArea", "Area", "Figures", "where the wheel never was"),
    Output("RemovedVolume", "Volume", "Figures", "removed by grinding"),
    Output("ExcessVolume", "Volume", "Figures", "left above the design"),
    Output("GougeVolume", "Volume", "Figures", "missing below the design"),
    Output(
        "WavinessAcross", "Distance", "Figures", "largest Wt of a face across the feed; 0: none"
    ),
    Output("WavinessAlong", "Distance", "Figures", "largest Wt of a face along the feed; 0: none"),
    Output("MissedRays", "Integer", "Doubts", "samples where no stock was found"),
    Output("DefectiveSamples", "Integer", "Doubts", "stock below the design from the start"),
    Output(
        "UnresolvedMotions",
        "Integer",
        "Doubts",
        "places of the programs that were not resolved; -1: not known",
    ),
    Output("ExtrapolatedLawEvents", "Integer", "Doubts", "events outside of what was measured"),
    Output("NotConverged", "Integer", "Doubts", "contacts that did not converge"),
    Output("Notes", "StringList", "Doubts", "what could not be judged, and why"),
    Output("Data", "String", "Verdict", "all of it as JSON", True),
    Output("Shown", "String", "Verdict", "what was judged, and how", True),
)


class Verdict(Proxy):
    """Proxy of the App::FeaturePython; judges what its ``Simulation`` holds by the job's zones."""

    TYPE = "BeltGrinding::Verdict"
    VIEW = "VerdictView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "Simulation" not in obj.PropertiesList:
            obj.addProperty("App::PropertyLink", "Simulation", "Verdict", "the result judged")
            obj.setEditorMode("Simulation", 1)
        add_outputs(obj, OUTPUTS)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def data(self, obj: DocumentObject) -> dict[str, Any] | None:
        """The verdict as ``beltgrinding.verdict`` gives it; None if there is none yet."""
        return json.loads(obj.Data) if obj.Data else None

    def update(self, obj: DocumentObject) -> None:
        """Judges again if the result or a tolerance is another one."""
        simulation, job = obj.Simulation, obj.getParentGroup()
        if simulation is None or job is None or not simulation.Fingerprint:
            return
        if obj.OutOfDate != simulation.OutOfDate:
            obj.OutOfDate = simulation.OutOfDate
        inspection = _judged_by(job)
        shown = json.dumps(
            [simulation.Fingerprint, simulation.WallTime, inspection], allow_nan=False
        )
        if shown == obj.Shown:
            return
        show(obj, verdict_of(job, simulation, inspection))
        obj.Shown = shown


def _judged_by(job: DocumentObject) -> dict[str, Any]:
    from .job_data import inspection, judged_by

    return judged_by(inspection(job))


def verdict_of(job: DocumentObject, simulation: DocumentObject, inspection: Json) -> dict[str, Any]:
    """The verdict that the simulation was stored with or, by other tolerances, another one."""
    stored = json.loads(simulation.VerdictData or "{}")
    if stored.get("inspection") == inspection:
        return stored["verdict"]
    found = judge(job, simulation, inspection)
    if "heat" in stored.get("verdict", {}):  # no tolerance changes it
        found["heat"] = stored["verdict"]["heat"]
    return found


def finish_of_run(simulation: DocumentObject) -> dict[str, Any]:
    """{"finish": what a Simulation's job had of it, as far as judging takes it}; {} where it computed none. From the run's
    verdict: the job may have another one meanwhile.
    """
    told = json.loads(simulation.VerdictData or "{}").get("verdict", {}).get("finish")
    if told is None:
        return {}
    keys = ("initial_Ra_um", "grit", "rest_per_pass", "crossing_angle_deg")
    found = {key: told[key] for key in keys if told.get(key) is not None}
    if told.get("source") is not None:
        found["model"] = {"source": told["source"], "ln_deviation": told["ln_deviation"]}
    return {"finish": found}


def renew_events(simulation: DocumentObject, inspection: Json) -> None:
    """Tells zones' finish anew among a Simulation's events where a job's zones are others than those by which they tell it,
    so that they say what the verdict says.
    """
    given = finish_of_run(simulation)
    if not given or not simulation.MotionTimes:
        return  # nothing to tell, or the result of an earlier version, which has no such events
    if json.loads(simulation.EventZones or "[]") == inspection["zones"]:
        return
    field = field_of(simulation)
    if field is None:
        return
    job = {**given, "inspection": inspection}
    motions = simulation.Proxy.motions(simulation)
    judged = finish_zones.judge_zones(job, field, verdicts.zone_of_samples(job, field), motions)
    zones = [
        {"name": zone["name"], "finish": one}
        for zone, one in zip(inspection["zones"], judged)
        if one is not None
    ]
    events = finish_events.renewed(simulation.Proxy.events(simulation), job, zones, motions)
    names = [{"name": Path(name).name} for name in simulation.Programs]
    store_events(simulation, events, {"programs": names})
    summary = json.loads(simulation.SummaryData or "{}")
    if summary:
        simulation.SummaryData = json.dumps(
            {**summary, "events": event_lists.count(events)}, allow_nan=False
        )
    simulation.EventZones = json.dumps(inspection["zones"], allow_nan=False)


def limits_changed(job: DocumentObject, simulation: DocumentObject) -> bool:
    """Whether the limits are others than those of the run, by which it told gouges."""
    stored = json.loads(simulation.VerdictData or "{}")
    now = _judged_by(job)
    return bool(stored) and any(
        stored["inspection"][key] != now[key] for key in ("tolerance_mm", "zones")
    )


def judge(job: DocumentObject, simulation: DocumentObject, inspection: Json) -> dict[str, Any]:
    """The verdict on a Simulation by other tolerances. Raises InputError."""
    field = field_of(simulation)
    if field is None:
        raise InputError(
            "objects.no_field",
            "{object}: its height field is missing; simulate again",
            object=simulation.Label,
        )
    data = {
        "design": {},
        "programs": [{"name": name} for name in simulation.Programs],
        "inspection": inspection,
        **finish_of_run(simulation),
    }
    shape = None
    if any("thickness_mm" in zone for zone in inspection["zones"]):
        from .job_data import design

        shape = core_shape(design(job)[0])
    return verdicts.verdict(
        data,
        field,
        simulation.Proxy.events(simulation),
        simulation.Proxy.motions(simulation),
        simulation.UnresolvedMotions,
        shape,
    )


def show(obj: DocumentObject, found: Json) -> None:
    """Puts a verdict into the object."""
    obj.Overall = found["overall"]
    obj.FaceVerdicts = [f"Face{one['face']}: {describe(one)}" for one in found["faces"]]
    obj.ZoneVerdicts = [f"{one['name'] or 'elsewhere'}: {describe(one)}" for one in found["zones"]]
    obj.FacesFailed = sum(one["verdict"] == "fail" for one in found["faces"])
    obj.ZonesFailed = sum(one["verdict"] == "fail" for one in found["zones"])
    for name in ("in", "above", "below"):
        setattr(obj, f"{name.title()}Tolerance", 100.0 * found[f"{name}_share"])
    worst = found["worst"] or {"value_mm": 0.0, "beyond_mm": 0.0, "point_mm": (0.0, 0.0, 0.0)}
    obj.Worst, obj.WorstBeyond = worst["value_mm"], worst["beyond_mm"]
    obj.WorstPoint = tuple(worst["point_mm"])
    counted = found["clusters_in_all"]
    obj.ClustersAbove, obj.ClustersBelow = counted["above"]["count"], counted["below"]["count"]
    obj.LargestCluster = found["clusters"][0]["area_mm2"] if found["clusters"] else 0.0
    obj.UntouchedArea = found["untouched_area_mm2"] or 0.0
    for name in ("removed", "excess", "gouge"):
        setattr(obj, f"{name.title()}Volume", found[f"{name}_volume_mm3"])
    for direction in ("across", "along"):
        waves = [face["waviness"][direction] for face in found["faces"]]
        largest = max((wave["Wt_mm"] for wave in waves if wave), default=0.0)
        setattr(obj, f"Waviness{direction.title()}", largest)
    obj.MissedRays, obj.DefectiveSamples = found["missed_rays"], found["defective_samples"]
    unresolved = found["unresolved_motions"]
    obj.UnresolvedMotions = -1 if unresolved is None else unresolved
    obj.ExtrapolatedLawEvents = found["extrapolated_law_events"]
    obj.NotConverged = found["not_converged_events"]
    obj.Notes = found["notes"]
    obj.Data = json.dumps(found, allow_nan=False)


def describe(region: Json) -> str:
    """One line for a face or a zone."""
    worst, finish = region["worst"], ""
    if region.get("finish"):
        finish = f"; finish: {region['finish']['verdict']}"
    if worst is None:
        return f"{region['verdict']}, nothing was inspected{finish}"
    return (
        f"{region['verdict']}, {100 * region['in_share']:.2f} % in tolerance, worst "
        f"{worst['value_mm']:+.4f} mm ({worst['beyond_mm']:+.4f} mm beyond){finish}"
    )


def cluster_of_samples(job: DocumentObject, simulation: DocumentObject) -> tuple[Field, Array]:
    """(field, number of the cluster, from 0, of every sample; core.NO_CLUSTER: in tolerance)."""
    field: Any = field_of(simulation)
    inspection = _judged_by(job)
    return field, verdicts.judge({"inspection": inspection}, field)["cluster"]
