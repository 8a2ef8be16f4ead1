"""First settings for a part: wheel or belt's force, passes, feed, samples, chosen from the faces that are ground.

Rules of thumb and one balance of volumes, for a first look that is near what the user wants; none of it
replaces his knowledge of the machine. What is assumed is said.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json
from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from ..job import machine as machines
from ..job.settings import BeltMachine, Job, Wheel
from ..job.typed import typed
from ..job.workpiece import apply_stock, make_field, read_design
from . import belt_proposal
from .clearing import Clearing
from .passes import contact_frames
from .raster_path import raster, validate
from .reachable import GROUND
from .sheets import curvature_along_and_across, planes_across, surfaces

# ISO 3, R10: radii of wheels and their widths, mm.
RADII = (10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0, 100.0)
WIDTHS = (6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0, 50.0)
SAMPLES = 4000  # to look at the part
HOLLOW = 0.98  # of the area: what is more hollow is a groove or a fillet, left to another tool
FIT = 0.8  # of the hollow's radius: the wheel's
UNFIT, PLACES = 0.02, 500  # of the area; places that are looked at
AS_GOOD = 0.02  # of the area: a wheel that fits on so much less is as good, if it is larger
SAGITTA = 0.3  # mm that a rim gives way to a surface hollow across its width
RIM_SHARE, RIM_MOST = 0.3, 15.0  # the rubber's thickness: of the radius; mm
FORCE_PER_WIDTH = 1.5  # N/mm
FORCES = (10.0, 60.0)  # N, chosen; a feed out of its range moves it, up to
FORCE_LEAST, FORCE_MOST = 1.0, 120.0  # N
APPROACH_FEED = 200.0  # mm/s: the force presses on the way down, too
FEEDS = (2.0, 150.0)  # mm/s that robots follow evenly
SHORTEST = 0.05  # mm: passes
STEP_SHARE = 0.5  # of the contact's width: every place lies under two passes
ACROSS_WIDTH, ACROSS_SAMPLES = 20, 400_000  # samples across the contact; on the part, at most
OF_PASSES = (  # what is proposed of a raster
    *("direction", "step_over_share", "min_length_mm", "feed_mm_s", "approach_feed_mm_s"),
)
AXIS = math.cos(math.radians(10.0))  # a direction so near to an axis of the part is that axis


def propose(job: Job | Json, context: Context = None) -> dict[str, Any]:
    """Settings for a validated job's design, stock, kind of belt machine and law.

    Returns dict(wheel_radius_mm, wheel_width_mm, rim_thickness_mm: of a wheel, contact_spacing_mm, and force_travel_mm: of
    a belt, force_N, direction (3,), step_over_share, min_length_mm, feed_mm_s, spacing_mm, samples (about), allowance_mm: mean of what
    is to come off, area_mm2, ground_share: of it, that the passes touch, length_mm of them, notes: list of Fact). A
    free belt or a platen is taken as it is. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    job = typed(job)
    machine = job.belt_machine
    notes: Facts = []
    shape = read_design(job.design, context)
    area, field = _look(job, shape, context)
    middle, along = _principal(field)
    if machines.wheel_presses(machine):
        settings = _settings(along)
        extent = float(np.ptp(field.points @ along))
        wheel = _wheel(job, shape, field, settings, area, extent, notes, context)
        machine = mounted(machine, *wheel)
        tool: dict[str, float] = {
            "wheel_radius_mm": machine.wheel.radius_mm,
            "wheel_width_mm": machine.wheel.width_mm,
            "rim_thickness_mm": machine.compliance.rim_thickness_mm,
        }
        job = replace(job, belt_machine=machine)
    else:
        machine, tool = belt_proposal.mounted(machine)
        job = replace(job, belt_machine=machine)
        look = {
            "standing": _standing,
            "bends": lambda way: _bends(job, shape, area, _settings(way), context)[1:],
            "widths": WIDTHS,
            "unfit": UNFIT,
            "as_good": AS_GOOD,
        }
        along = belt_proposal.direction(job, shape, field, along, look, notes, context)
        settings = _settings(along)
    allowance = _allowance(job, field, notes, context)
    laid, settings = _first_passes(job, settings, context)
    force = machine.force_N
    feed = _feed(job, settings, laid, allowance)
    if feed is not None and not FEEDS[0] <= feed <= FEEDS[1]:
        bound = min(max(feed, FEEDS[0]), FEEDS[1])
        force = min(max(force * bound / feed, FORCE_LEAST), FORCE_MOST)
        force = _round(force)
        job = replace(job, belt_machine=replace(machine, force_N=force))
        laid = raster(job, settings, context)
        feed = _feed(job, settings, laid, allowance)
        if (
            feed is not None
            and _ground_share(laid) > 0.0
            and not 0.5 * FEEDS[0] <= feed <= 2.0 * FEEDS[1]
        ):
            notes.append(
                core.Fact(
                    "raster.proposed_feed",
                    "with this K the allowance comes off at a feed of {feed:.3g} mm/s, which a robot "
                    "hardly follows: calibrate K, or take another belt or force",
                    feed=feed,
                )
            )
    spacing, samples = _spacing(area, laid["contact_width_mm"], notes)
    return {
        **tool,
        "force_N": force,
        "direction": along.tolist(),
        "step_over_share": STEP_SHARE,
        "min_length_mm": settings["min_length_mm"],
        "feed_mm_s": settings["feed_mm_s"]
        if feed is None or not math.isfinite(feed)
        else _round(feed),
        "approach_feed_mm_s": APPROACH_FEED,
        "spacing_mm": spacing,
        "samples": samples,
        "allowance_mm": allowance,
        "area_mm2": area,
        "ground_share": _ground_share(laid),
        "length_mm": sum(one["length_mm"] for one in laid["passes"]),
        "notes": notes,
    }


def _first_passes(
    job: Job, settings: dict[str, Any], context: Context
) -> tuple[dict[str, Any], dict[str, Any]]:
    """(passes, settings of them), with ``min_length_mm`` halved until one is long enough. Raises InputError, where
    no pass can lie."""
    while True:
        try:
            return raster(job, settings, context), settings
        except InputError as error:
            if error.code != "raster.no_pass" or settings["min_length_mm"] < SHORTEST:
                raise
        settings = {**settings, "min_length_mm": 0.5 * settings["min_length_mm"]}


def _settings(direction: Floats) -> dict[str, Any]:
    """Validated settings of passes along a direction."""
    return validate(
        {
            "along": "direction",
            "direction": np.asarray(direction).tolist(),
            "step_over_share": STEP_SHARE,
            "approach_feed_mm_s": APPROACH_FEED,
        }
    )


def _bends(
    job: Job, shape: core.Shape, area: float, settings: Json, context: Context
) -> tuple[Floats, Floats, Floats]:
    """Normal curvatures (n,) along and across the passes, 1/mm, positive where the faces are convex, and the areas."""
    faces = [face - 1 for face in job.design.faces or range(1, shape.face_count + 1)]
    parts = surfaces(job, shape, faces, math.sqrt(area / SAMPLES), settings, [], context)
    seen = zip(*(curvature_along_and_across(part) for part in parts))
    along, across, areas = (np.concatenate(found) for found in seen)
    return along, across, areas


def mounted(machine: BeltMachine, radius: float, width: float, crown: float = 0.0) -> BeltMachine:
    """A job's belt machine with a wheel, and with rim and force to it; ``crown``: radius mm, 0: a cylinder."""
    rim = 0.5 * round(2.0 * min(RIM_SHARE * radius, RIM_MOST))
    force = min(max(FORCE_PER_WIDTH * width, FORCES[0]), FORCES[1])
    return replace(
        machine,
        wheel=Wheel(radius_mm=radius, width_mm=width, crown_radius_mm=crown, profile_mm=()),
        compliance=replace(machine.compliance, rim_thickness_mm=rim, layers=()),
        force_N=5.0 * round(force / 5.0),
    )


def _look(job: Job, shape: core.Shape, context: Context) -> tuple[float, core.HeightField]:
    """(mm2 of the faces, a coarse field of them)."""
    faces = job.design.faces or range(1, shape.face_count + 1)
    area = sum(shape.face_area(face - 1) for face in faces if face <= shape.face_count)
    coarse = replace(
        job,
        design=replace(job.design, faces=tuple(faces)),
        sampling=replace(job.sampling, spacing_mm=math.sqrt(area / SAMPLES)),
    )
    return area, make_field(coarse, shape, [], context)


def _principal(field: core.HeightField) -> tuple[Floats, Floats]:
    """(middle, unit direction in which the faces are longest), snapped to an axis that is near; along the
    faces, not through them.
    """
    points, weight = field.points, field.areas[:, None].astype(float)
    middle = (points * weight).sum(axis=0) / weight.sum()
    moved = points - middle
    values, vectors = np.linalg.eigh((moved * weight).T @ moved)
    mean = (field.normals * weight).sum(axis=0)
    looks = mean / weight.sum()
    found = vectors[:, -1]
    if np.linalg.norm(looks) > 0.5 and abs(found @ looks) > 0.9 * np.linalg.norm(looks):
        found = vectors[:, -2]  # a deep bowl: not along its depth
    axis = int(np.argmax(np.abs(found)))
    if abs(found[axis]) > AXIS:
        found = np.eye(3)[axis]
    found = np.round(found * (1.0 if found[axis] > 0 else -1.0), 4)
    return middle, found + 0.0


def _wheel(
    job: Job,
    shape: core.Shape,
    field: core.HeightField,
    settings: Json,
    area: float,
    extent: float,
    notes: Facts,
    context: Context,
) -> tuple[float, float]:
    """(radius, width), mm, of a cylindrical wheel."""
    along, across, weights = _bends(job, shape, area, settings, context)
    hollow_along, hollow_across = (
        weighted_quantile(np.maximum(-k, 0.0), weights, HOLLOW) for k in (along, across)
    )
    most = min(FIT / hollow_along if hollow_along > 0 else math.inf, max(0.5 * extent, RADII[0]))
    radius = max((r for r in RADII if r <= most), default=RADII[0])
    if most < RADII[0]:
        notes.append(
            core.Fact(
                "raster.proposed_radius",
                "the faces are hollow with a radius of {radius:.3g} mm along the passes: no wheel fits",
                radius=1.0 / hollow_along,
            )
        )
    wide = min(
        math.sqrt(8.0 * SAGITTA / hollow_across) if hollow_across > 0 else math.inf,
        0.5 * area / max(extent, 1e-9),
        radius,
    )
    width = max((w for w in WIDTHS if w <= wide), default=WIDTHS[0])
    found, tried = _that_fits(job, shape, field, settings, radius, width, context)
    largest = max(tried)
    if largest[0] > found[0]:
        notes.append(
            core.Fact(
                "raster.proposed_small",
                "the wheel has {radius:.3g} mm radius, since larger ones run into the part: it fits on "
                "{reached:.0f} % of the area, one of {larger:.3g} mm on {less:.0f} %",
                radius=found[0],
                reached=100.0 * (1.0 - tried[found]),
                larger=largest[0],
                less=100.0 * (1.0 - tried[largest]),
            )
        )
    elif tried[found] > UNFIT:
        notes.append(
            core.Fact(
                "raster.proposed_unfit",
                "a wheel of {radius:.3g} mm radius, the best of those that are tried, still does not fit the part "
                "on {share:.0f} % of the area",
                radius=found[0],
                share=100.0 * tried[found],
            )
        )
    return found


def _that_fits(
    job: Job,
    shape: core.Shape,
    field: core.HeightField,
    settings: Json,
    radius: float,
    width: float,
    context: Context,
) -> tuple[tuple[float, float], dict[tuple[float, float], float]]:
    """((radius, width) mm of the largest wheel, not above these, that fits the part nearly everywhere on the faces;
    share of the area where each that was tried does not): the radius comes down first. Where none fits, the best one.
    """
    frames, areas = _standing(field, settings["direction"])
    clearing = Clearing(job, shape, validate({"max_tilt_deg": 0.0}), [], context)

    def unfit(radius: float, width: float) -> float:
        machine = mounted(job.belt_machine, radius, width)
        trial = clearing.with_wheel(replace(job, belt_machine=machine))
        return float(areas[~trial.fits_upright(frames)].sum() / max(areas.sum(), 1e-12))

    tried = {}
    for r in sorted((r for r in RADII if r <= radius), reverse=True):
        size = r, min(width, max((w for w in WIDTHS if w <= r), default=WIDTHS[0]))
        tried[size] = unfit(*size)
        if tried[size] <= UNFIT:
            return size, tried
    best = _largest(tried)
    for w in sorted((w for w in WIDTHS if w < best[1]), reverse=True):
        size = best[0], w
        tried[size] = unfit(*size)
        if tried[size] <= UNFIT:
            return size, tried
    best = _largest(tried)
    return best, tried


def _largest(tried: Mapping[tuple[float, float], float]) -> tuple[float, float]:
    """Of {(radius, width): share that does not fit}, the largest that is nearly as good as the best."""
    least = min(tried.values())
    return max(size for size, share in tried.items() if share <= least + AS_GOOD)


def _standing(field: core.HeightField, direction: Floats) -> tuple[Floats, Floats]:
    """(work_from_contact (n, 4, 4) of a wheel that stands on places of the faces and travels along a direction,
    areas (n,) that each stands for)."""
    points, normals = field.points, field.normals.astype(float)
    across = planes_across(direction, points, normals, field.areas)
    chosen = slice(None, None, max(1, len(points) // PLACES))
    n, areas = normals[chosen], field.areas[chosen].astype(float)
    travel = np.cross(across, n)
    length = np.linalg.norm(travel, axis=1)
    sound = length > 0.1  # else the pass is no line there
    frames = contact_frames(points[chosen][sound], n[sound], travel[sound] / length[sound, None])
    return frames, areas[sound]


def _allowance(job: Job, field: core.HeightField, notes: Facts, context: Context) -> float:
    """mm that is to come off on the mean, to the middle of the tolerance."""
    lower, upper = job.inspection.tolerance_mm
    apply_stock(field, job.stock, [], context)
    weight = field.areas.astype(float)
    sound = np.isfinite(field.height) & (weight > 0)
    mean = float((field.height[sound] * weight[sound]).sum() / max(weight[sound].sum(), 1e-12))
    wanted = mean - 0.5 * (lower + upper)
    if wanted <= 0:
        notes.append(
            core.Fact(
                "raster.proposed_nothing",
                "on the mean there is no stock to come off: the feed is not chosen",
            )
        )
    return wanted


def _feed(job: Job, settings: Json, laid: Json, allowance: float) -> float | None:
    """mm/s at which K V_b F over the time in contact takes the allowance off the area; None if nothing
    is to come off. K V_b times the integral of F dt is the volume removed (Hammann's law, summed). In
    contact is also the last of each approach and the first of each retract, where the force control
    follows.
    """
    if allowance <= 0:
        return None
    machine, law = job.belt_machine, job.law
    rate = law.coefficient_mm2_per_N * machine.belt_wear * 1000.0 * machine.belt_speed_m_s
    length = _loaded(laid, settings["force_N"] or machine.force_N)
    plunge = min(machine.force_travel_mm, settings["approach_mm"])
    ends = 2.0 * len(laid["passes"]) * plunge / settings["approach_feed_mm_s"]
    if settings["entry"] != "direct":
        ends *= settings["touch_force_share"]
    time = allowance * _ground_share(laid) * laid["area_mm2"] / (rate * machine.force_N) - ends
    return length / time if time > 0 else math.inf


def _ground_share(laid: Json) -> float:
    """Of the area, what the passes touch."""
    places = laid["places"]
    ground = places["state"] == GROUND
    return float(places["areas"][ground].sum() / places["areas"].sum())


def _loaded(laid: Json, force: float) -> float:
    """mm of the passes under their full force; where that grows and falls, by its share of it."""
    way = np.linalg.norm(np.diff(laid["contacts"][:, :3, 3], axis=0), axis=1)
    share = np.where(laid["forces"] < 0.0, 1.0, laid["forces"] / force)[1:]
    on = laid["contact"][1:] & laid["contact"][:-1]
    return float((way * share)[on].sum())


def _spacing(area: float, contact_width: float, notes: Facts) -> tuple[float, int]:
    """(mm, samples): so many across the contact, if the part is not too large for that."""
    wanted = contact_width / ACROSS_WIDTH
    most = math.sqrt(area / ACROSS_SAMPLES)
    if wanted < most:
        notes.append(
            core.Fact(
                "raster.proposed_spacing",
                "samples {spacing:.3g} mm apart keep this large part at {samples} of them; {wanted:.3g} mm "
                "would show the contact's edge better, with {more} samples",
                spacing=_round(most),
                samples=ACROSS_SAMPLES,
                wanted=wanted,
                more=int(area / wanted**2),
            )
        )
    spacing = _round(max(wanted, most))
    return spacing, int(area / spacing**2)


def _round(value: float) -> float:
    """To two digits, so that the user reads what is a choice."""
    return float(f"{value:.2g}")
