"""The verdict on a ground part: in tolerance or not, where not, and which motions did it.

Its form is Resources/schema/verdict.schema.json; docs/verification.md tells what the figures mean.
Faces are numbered from 1 as FreeCAD does; programs, poses and motions from 0 as in events.json.
"""

from __future__ import annotations
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Context, Facts, Floats, Json, known
from ..base.messages import fact_data
from ..cell import motions as ways
from ..engine import InputError, core
from ..job import resolution
from ..job.poses import program_name
from ..job.settings import Job, Zone
from ..job.typed import typed
from . import edge_profile
from . import finish as finishes
from . import finish_zones
from . import heat as heats
from . import section_figures
from .verdict_text import text

if TYPE_CHECKING:
    from ..cell.motions import Motions
    from .ground import Judged

__all__ = ["cluster_samples", "judge", "of_result", "text", "verdict"]

FORMAT = 1
MOST_CLUSTERS = 200
MOST_MOTIONS = 20  # of a cluster
DEFLECTION = 0.01  # mm, of the faces that are not ground, for the thickness
EXTRAPOLATED = ("law_out_of_range", "belt_out_of_range")


def verdict(
    job: Job | Json,
    field: core.HeightField,
    events: Sequence[Json] = (),
    motions: Motions | None = None,
    unresolved: int | None = None,
    shape: core.Shape | None = None,
    context: Context = None,
) -> dict[str, Any]:
    """The verdict, a dict, on a ground core.HeightField by the zones of a validated job.

    ``events``: as in events.json. ``motions``: as ``motions.of_paths`` gives them; read from the job's
    programs if None. ``unresolved``: how many places of the programs could not be resolved; None:
    counted in them. ``shape``: the design, if it has been read. Raises InputError and Cancelled.
    """
    job = typed(job)
    notes: Facts = []
    if motions is None or unresolved is None:
        told, counted = _read_motions(job, notes)
        motions = told if motions is None else motions
        unresolved = counted if unresolved is None else unresolved
    zones = job.inspection.zones
    rest = job.inspection.tolerance_mm
    with ThreadPoolExecutor(1) as beside:  # each uses one processor, and holds up no other Python
        waiting = beside.submit(waviness, field, motions, context)
        found = judge(job, field)
        waves = {face["face"]: face for face in waiting.result()}
    traced = field.trace is not None

    faces = []
    for region in found["faces"]:
        number = region["region"]
        faces.append(
            {
                "face": number + 1,
                **_region(region, zones, found["zone"], traced),
                "waviness": _wave(waves[number]),
            }
        )
    judged, thickness = [], _thicknesses(job, field, zones, found["zone"], shape, notes, context)
    finished = finish_zones.judge_zones(job, field, found["zone"], motions)
    for zone, region, thick, texture in zip(
        [*zones, None], found["zones"], [*thickness, None], [*finished, None]
    ):
        if zone is None and not region["samples"]:
            continue  # all faces lie in zones
        one = _region(region, zones, found["zone"], traced)
        if thick is not None:
            one["verdict"] = _worse(one["verdict"], thick["verdict"])
        if not region["samples"]:
            notes.append(_empty(known(zone), field.spacing))
        samples = np.flatnonzero(found["zone"] == region["region"])
        if texture is not None:
            one["verdict"] = _worse(one["verdict"], texture["verdict"])
        edge = None
        if zone is not None and zone.edge_radius_mm is not None:
            edge = edge_profile.of_zone(field, samples, zone.edge_radius_mm)
        judged.append(
            {
                "name": None if zone is None else zone.name,
                "tolerance_mm": list(rest if zone is None else zone.tolerance_mm or rest),
                "edge_radius_mm": None if zone is None else zone.edge_radius_mm,
                "faces": [int(face) + 1 for face in np.unique(field.faces[samples])],
                **one,
                "edge": edge,
                "thickness": thick,
                **({"finish": texture} if texture is not None else {}),
            }
        )
    notes += finishes.notes(job, field)
    whole = _region(found["whole"], zones, found["zone"], traced)
    del whole["verdict"]
    verdicts = {one["verdict"] for one in [*judged, *faces]}
    kinds = [event["kind"] for event in events]
    heat = heats.figures(job, field, motions)
    finish = finishes.figures(job, field, motions)
    sections = section_figures.of_sections(job, field, notes)
    return {
        "format": FORMAT,
        "resolution": resolution.mode(job),
        "overall": next(word for word in ("fail", "unknown", "pass") if word in verdicts),
        "tolerance_mm": list(rest),
        **whole,
        "unresolved_motions": unresolved,
        "extrapolated_law_events": sum(kind in EXTRAPOLATED for kind in kinds),
        "not_converged_events": kinds.count("not_converged"),
        "faces": faces,
        "zones": judged,
        "clusters": [
            _cluster(number, one, zones, found["zone"], motions, traced)
            for number, one in enumerate(found["clusters"], 1)
        ],
        "clusters_in_all": {
            side: {"count": count, "area_mm2": area}
            for side, count, area in zip(
                ("below", "above"), found["cluster_counts"], found["cluster_areas"]
            )
        },
        **({"sections": sections} if sections else {}),
        **({"heat": heat} if heat is not None else {}),
        **({"finish": finish} if finish is not None else {}),
        "programs": _programs(job, motions),
        "notes": notes,
        "note_facts": [fact_data(note) for note in notes],
    }


def of_result(
    result: Judged,
    shape: core.Shape | None = None,
    inspection: Json | None = None,
    context: Context = None,
) -> dict[str, Any]:
    """The verdict on a ``Result``; by another job's ``inspection`` if given. ``shape``: the design, if
    it has been read. Raises InputError and Cancelled.
    """
    job = result.job if inspection is None else {**result.job, "inspection": inspection}
    return verdict(
        job,
        result.field,
        result.events,
        result.motions,
        result.summary.get("unresolved_motions"),
        shape,
        context,
    )


def cluster_samples(job: Job | Json, field: core.HeightField, number: int) -> Array:
    """(k,) the samples of a verdict's cluster ``number``, from 1."""
    job = typed(job)
    return np.flatnonzero(judge(job, field, 0, 0)["cluster"] == number - 1)


def judge(
    job: Job | Json,
    field: core.HeightField,
    clusters: int = MOST_CLUSTERS,
    motions: int = MOST_MOTIONS,
) -> dict[str, Any]:
    """What core.judge says by the zones of a job."""
    job = typed(job)
    rest = job.inspection.tolerance_mm
    zones = _core_zones(job.inspection.zones, rest)
    return core.judge(field, rest, zones, clusters, motions)


def lower_limits(job: Job | Json, field: core.HeightField) -> Array:
    """(n,) the lower limit of every sample, mm; (1,) where it is the same for all."""
    job = typed(job)
    rest, zones = job.inspection.tolerance_mm, job.inspection.zones
    bands = [*(zone.tolerance_mm or rest for zone in zones), rest]
    limits = np.array([band[0] for band in bands], np.float32)
    return limits[core.zone_of_samples(field, _core_zones(zones, rest))] if zones else limits


def zone_of_samples(job: Job | Json, field: core.HeightField) -> Array:
    """(n,) number of the zone of a job that holds each sample; that of all zones: none of them."""
    job = typed(job)
    rest, zones = job.inspection.tolerance_mm, job.inspection.zones
    return core.zone_of_samples(field, _core_zones(zones, rest))


def limits(job: Job | Json, field: core.HeightField) -> tuple[Array, Array]:
    """(lower (n,), upper (n,)) of every sample by its zone, mm."""
    job = typed(job)
    rest, zones = job.inspection.tolerance_mm, job.inspection.zones
    bands = np.array([*(zone.tolerance_mm or rest for zone in zones), rest], dtype=float)
    lower, upper = bands[zone_of_samples(job, field)].T
    return lower, upper


def thickness_deviation(
    job: Job | Json,
    field: core.HeightField,
    shape: core.Shape | None = None,
    context: Context = None,
) -> Floats | None:
    """(n,) how far the ground part's thickness is from the design's, mm; NaN where it cannot be measured
    and outside of the zones that limit it. None where no zone does. ``shape``: the design, if it has been
    read. Raises Cancelled.
    """
    job = typed(job)
    zones = job.inspection.zones
    limited = [i for i, zone in enumerate(zones) if zone.thickness_mm is not None]
    if not limited:
        return None
    samples = np.flatnonzero(np.isin(zone_of_samples(job, field), limited))
    others = other_faces(job, field, shape, [], context)
    found = np.full(field.size, np.nan)
    found[samples] = core.measure_thickness(field, samples, others, context)[1]
    return found


def _core_zones(zones: Sequence[Zone], rest: Sequence[float]) -> list[dict[str, Any]]:
    found = []
    for zone in zones:
        faces = [face - 1 for face in zone.faces]
        one: dict[str, Any] = {"tolerance": zone.tolerance_mm or rest, "faces": faces}
        if zone.edge_radius_mm is not None:
            one["edge_radius"] = float(zone.edge_radius_mm)
        found.append(one)
    return found


def _read_motions(job: Job, notes: Facts) -> tuple[Motions, int] | tuple[None, None]:
    """(motions, unresolved) from the job's programs; None, None where they cannot be read."""
    from ..cell import tool_path as tool_paths  # which imports this module

    problems: Facts = []
    try:
        paths = [tool_paths.tool_path(job, i, problems) for i in range(len(job.programs))]
    except InputError as error:
        notes.append(
            core.Fact("inspection.no_motions", "the motions are not known: {reason}", reason=error)
        )
        return None, None
    counted = len(problems) + sum(program.unresolved or 0 for program in job.programs)
    return ways.of_paths(paths), counted


def _region(region: Json, zones: Sequence[Zone], zone_of: Array, traced: bool) -> dict[str, Any]:
    """The figures that a face, a zone and the whole have in common."""
    inspected = region["area"] - region["missed_area"]
    share = (lambda area: min(area / inspected, 1.0)) if inspected > 0 else (lambda area: 0.0)
    out = region["above_area"] + region["below_area"]
    known = region["worst"] is not None
    return {
        "verdict": _word(region),
        "samples": region["samples"],
        "area_mm2": region["area"],
        "inspected_area_mm2": inspected,
        "in_share": 1.0 - share(out) if known else 0.0,
        "above_share": share(region["above_area"]),
        "below_share": share(region["below_area"]),
        "deviation_mm": (
            {key: region[key] for key in ("min", "max", "mean", "rms")} if known else None
        ),
        "worst": _worst(region["worst"], zones, zone_of),
        "missed_rays": region["missed"],
        "missed_area_mm2": region["missed_area"],
        "defective_samples": region["defective"],
        "untouched_area_mm2": region["untouched_area"] if traced else None,
        "stock_volume_mm3": region["stock_volume"],
        "removed_volume_mm3": region["removed_volume"],
        "excess_volume_mm3": region["excess_volume"],
        "gouge_volume_mm3": region["gouge_volume"],
    }


def _worse(one: str, other: str) -> str:
    """Of two words."""
    return next(word for word in ("fail", "unknown", "pass") if word in (one, other))


def _word(region: Json) -> str:
    """Where stock was missed nothing is known: what is good elsewhere has not passed."""
    if region["above_area"] + region["below_area"] > 0:
        return "fail"
    return "pass" if region["passed"] and not region["missed"] else "unknown"


def _worst(worst: Json | None, zones: Sequence[Zone], zone_of: Array) -> dict[str, Any] | None:
    if worst is None:
        return None
    number = int(zone_of[worst["sample"]])
    return {
        "value_mm": worst["value"],
        "limit_mm": worst["limit"],
        "beyond_mm": worst["beyond"],
        "sample": worst["sample"],
        "point_mm": list(worst["point"]),
        "face": worst["face"] + 1,
        "zone": zones[number].name if number < len(zones) else None,
    }


def _cluster(
    number: int,
    cluster: Json,
    zones: Sequence[Zone],
    zone_of: Array,
    motions: Motions | None,
    traced: bool,
) -> dict[str, Any]:
    area = cluster["area"]
    return {
        "number": number,
        "side": "above" if cluster["above"] else "below",
        "samples": cluster["samples"],
        "area_mm2": area,
        "volume_mm3": cluster["volume"],
        "worst": _worst(cluster["worst"], zones, zone_of),
        "centroid_mm": list(cluster["centroid"]),
        "box_mm": [list(corner) for corner in cluster["box"]],
        "extent_mm": cluster["extent"],
        "width_mm": cluster["width"],
        "faces": [face + 1 for face in cluster["faces"]],
        "zones": [zones[z].name if z < len(zones) else None for z in cluster["zones"]],
        "untouched_share": (cluster["untouched_area"] / area if area else 0.0) if traced else None,
        "motion_count": cluster["motion_count"],
        "motions": [
            {
                **_motion(one["motion"], motions),
                "share": one["share"],
                "depth_mm": one["depth"],
            }
            for one in cluster["motions"]
        ],
    }


def _motion(number: int, motions: Motions | None) -> dict[str, Any]:
    """Which program, pose and line a motion is of; None where that is not known."""
    if motions is None or number >= len(motions["pose"]):
        return {"motion": number, "program": None, "pose": None, "line": None}
    line = int(motions["line"][number])
    return {
        "motion": number,
        "program": int(motions["program"][number]),
        "pose": int(motions["pose"][number]),
        "line": line or None,
    }


def _programs(job: Job, motions: Motions | None) -> list[dict[str, Any]]:
    names = [program_name(job, i) for i in range(len(job.programs))]
    first = [None] * len(names)
    if motions is not None:
        first = np.searchsorted(motions["program"], np.arange(len(names))).tolist()
    return [{"name": name, "first_motion": one} for name, one in zip(names, first)]


def _empty(zone: Zone, spacing: float) -> core.Fact:
    if zone.edge_radius_mm is None:
        return core.Fact(
            "inspection.empty_zone",
            "zone '{name}' holds no sample, or later zones override all of it",
            name=zone.name,
        )
    return core.Fact(
        "inspection.empty_edge_zone",
        "zone '{name}' holds no sample: its faces have no convex edge with a radius below "
        "{radius:g} mm that samples {spacing:g} mm apart could tell, or later zones override all of it",
        name=zone.name,
        radius=zone.edge_radius_mm,
        spacing=spacing,
    )


def waviness(
    field: core.HeightField, motions: Motions | None, context: Context = None
) -> list[dict[str, Any]]:
    """What core.waviness says by ``motions``, as ``motions.of_paths`` gives them; None: not known."""
    ends, begins = np.zeros((0, 3)), np.zeros(0, dtype=bool)
    if motions is not None:
        ends, begins = motions["point"], motions["pose"] == 0
    return core.waviness(field, ends, begins, context)


def _wave(face: Json) -> dict[str, Any]:
    known = face["pass_distance"] > 0 and face["long_cutoff"] > 0
    return {
        "pass_distance_mm": face["pass_distance"] or None,
        "short_cutoff_mm": face["short_cutoff"] if known else None,
        "long_cutoff_mm": face["long_cutoff"] if known else None,
        **{
            direction: face[direction]
            and {
                "Wa_mm": face[direction]["mean"],
                "Wt_mm": face[direction]["total"],
                "profiles": face[direction]["profiles"],
            }
            for direction in ("along", "across")
        },
        "reason": face["reason"] or None,
    }


def _thicknesses(
    job: Job,
    field: core.HeightField,
    zones: Sequence[Zone],
    zone_of: Array,
    shape: core.Shape | None,
    notes: Facts,
    context: Context,
) -> list[dict[str, Any] | None]:
    """What each zone's thickness is like; None for those without a tolerance for it."""
    if not any(zone.thickness_mm for zone in zones):
        return [None] * len(zones)
    others = other_faces(job, field, shape, notes, context)
    return [
        (
            _thickness(field, zone.thickness_mm, np.flatnonzero(zone_of == i), others, context)
            if zone.thickness_mm
            else None
        )
        for i, zone in enumerate(zones)
    ]


def other_faces(
    job: Job | Json,
    field: core.HeightField,
    shape: core.Shape | None,
    notes: Facts,
    context: Context,
) -> core.TriangleMesh:
    """Triangles of the design's faces that are not ground."""
    from ..job import workpiece

    job = typed(job)
    sampled = set(np.unique(field.faces).tolist())
    try:  # what cannot be had here must not cost the result
        shape = shape or workpiece.read_design(job.design, context)
        others = [face for face in range(shape.face_count) if face not in sampled]
        if others:
            return core.triangulate(shape, DEFLECTION, context, faces=others)
    except InputError as error:
        notes.append(
            core.Fact(
                "inspection.thickness_of_ground",
                "thickness: only between ground faces, since the design fails: {reason}",
                reason=error,
            )
        )
    return core.TriangleMesh(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32))


def _thickness(
    field: core.HeightField,
    tolerance: Sequence[float],
    samples: Array,
    others: core.TriangleMesh,
    context: Context,
) -> dict[str, Any]:
    design, deviation = core.measure_thickness(field, samples, others, context)
    known = np.isfinite(deviation)
    where, value, area = samples[known], deviation[known], field.areas[samples[known]].astype(float)
    lower, upper = tolerance
    figures = {"tolerance_mm": list(tolerance), "samples": int(len(where))}
    figures["unmeasured"] = int(len(samples) - len(where))
    if not len(where) or not area.sum() > 0:
        return {
            **figures,
            "verdict": "unknown",
            "design_mm": None,
            "deviation_mm": None,
            "out_share": 0.0,
            "worst": None,
        }
    beyond = np.maximum(value - upper, lower - value)
    k = int(np.argmax(beyond))
    return {
        **figures,
        "verdict": "fail" if beyond[k] > 0 else "pass",
        "design_mm": {"min": float(design[known].min()), "max": float(design[known].max())},
        "deviation_mm": {
            "min": float(value.min()),
            "max": float(value.max()),
            "mean": float(np.average(value, weights=area)),
        },
        "out_share": min(float(area[beyond > 0].sum() / area.sum()), 1.0),
        "worst": {
            "value_mm": float(value[k]),
            "limit_mm": float(upper if value[k] - upper >= lower - value[k] else lower),
            "beyond_mm": float(beyond[k]),
            "thickness_mm": float(design[known][k]),
            "sample": int(where[k]),
            "point_mm": field.points[where[k]].tolist(),
            "face": int(field.faces[where[k]]) + 1,
        },
    }
