"""First settings of a free belt or a platen: which way it runs over the part, and with what force. The belt itself is
the machine's; where it does not fit, a narrower one is named that does.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json, known
from ..base.quantile import weighted_quantile
from ..engine import core
from ..job.settings import BeltMachine, Job
from .clearing import Clearing
from .raster_path import validate

FORCE_PER_WIDTH = 0.75  # N/mm
OF_TENSION = (
    0.35  # of it: so that a free belt turns by 10 degrees on either side, F = 2 H sin(alpha)
)
ROOM = 1.5  # of what the belt gives way: the force control's travel
CELLS, LEAST_CELL = 20, 1.0  # across the belt; mm: its contact takes many times a wheel's time
OFF = 0.25  # of its width: so far from it flat may lie what it gets to
LEAST_LOOKS = 0.5  # of the mean normal: of faces that look all round no way lies square to another
WORTHWHILE = (
    0.5  # of what does not fit: a narrower belt on which as much does not is worth its name
)
BENT = 0.98  # of the area: what is bent more is left out of the look


def mounted(machine: BeltMachine) -> tuple[BeltMachine, dict[str, float]]:
    """(a job's belt machine with the force, how far the force control moves it, and the contact's cells as its belt wants
    them; what was set of the last two, {key: mm})."""
    run, found = known(machine.free_run), {}
    per_width = FORCE_PER_WIDTH
    if machine.kind == "free_belt":
        per_width = min(per_width, OF_TENSION * run.tension_N_per_mm)
        # A membrane's middle gives way by F L / (4 H) under a line across it.
        gives = per_width * run.length_mm / (4.0 * run.tension_N_per_mm)
        found["force_travel_mm"] = max(float(math.ceil(ROOM * gives)), machine.force_travel_mm)
    force = max(float(f"{per_width * run.width_mm:.2g}"), 1.0)
    found["contact_spacing_mm"] = max(LEAST_CELL, float(f"{run.width_mm / CELLS:.2g}"))
    return replace(machine, force_N=force, **found), found


def direction(
    job: Job,
    shape: core.Shape,
    field: core.HeightField,
    along: Floats,
    look: Json,
    notes: Facts,
    context: Context,
) -> Floats:
    """Unit direction (3,) of the passes, along which the belt runs: ``along``, that in which the faces are longest, or
    that square to it in the faces. The belt is stiff across: of directions on which it fits nearly as well, that
    across which the faces are bent less.

    look: dict(standing(field, direction): (frames, areas), bends(direction): ((n,) 1/mm across it, areas), widths: mm
    that are tried, unfit, as_good: shares of the area). Notes where the belt does not fit are added to ``notes``.
    """
    ways = [along]
    weight = field.areas[:, None].astype(float)
    mean = (field.normals * weight).sum(axis=0) / weight.sum()
    square = np.cross(mean, along)
    if np.linalg.norm(mean) > LEAST_LOOKS and np.linalg.norm(square) > 0.1:
        ways.append(np.round(square / np.linalg.norm(square), 4) + 0.0)
    clearing = Clearing(job, shape, validate({"max_tilt_deg": 0.0}), [], context)
    standing = [look["standing"](field, way) for way in ways]
    unfit = [_unfit(clearing, job, *places) for places in standing]
    good = [k for k in range(len(ways)) if unfit[k] <= min(unfit) + look["as_good"]]
    best = min(good, key=lambda k: _bent(*look["bends"](ways[k])))
    if unfit[best] > look["unfit"]:
        notes.append(_does_not_fit(job, clearing, standing[best], unfit[best], look))
    return ways[best]


def _bent(curvature: Floats, areas: Floats) -> float:
    return weighted_quantile(np.abs(curvature), areas, BENT)


def _unfit(
    clearing: Clearing, job: Job, frames: Floats, areas: Floats, width: float | None = None
) -> float:
    """Share of the area that the belt, of its own or another width, does not get to: no part of it lies there, where it
    fits at one of the places."""
    if width is not None:
        run = replace(known(job.belt_machine.free_run), width_mm=width)
        job = replace(job, belt_machine=replace(job.belt_machine, free_run=run))
        clearing = clearing.with_wheel(job)
    fits = clearing.fits_upright(frames)
    if fits.all():
        return 0.0
    left, there = frames[~fits, :3, 3], frames[fits]
    way = left[:, None] - there[None, :, :3, 3]
    along, across, off = (abs(np.einsum("nkx,kx->nk", way, there[:, :3, k])) for k in range(3))
    apart, half = math.sqrt(np.median(areas)), 0.5 * clearing.tool.width
    # A place stands for all that is nearer to it than to the next.
    reached = (along <= 2.0 * apart) & (across <= half + 0.5 * apart) & (off <= 2.0 * OFF * half)
    return float(areas[~fits][~reached.any(axis=1)].sum() / max(areas.sum(), 1e-12))


def _does_not_fit(
    job: Job, clearing: Clearing, standing: tuple[Floats, Floats], share: float, look: Json
) -> core.Fact:
    """Fact: to what ``share`` of the area the belt does not get, and the widest that does, or of those the best."""
    width = known(job.belt_machine.free_run).width_mm
    tried = {}
    for one in sorted((w for w in look["widths"] if w < width), reverse=True):
        tried[one] = _unfit(clearing, job, *standing, one)
        if tried[one] <= look["unfit"]:
            break
    least = min(tried.values(), default=share)
    if least > WORTHWHILE * share:
        return core.Fact(
            "raster.proposed_belt_unfit",
            "the belt of {width:.3g} mm, flat between its rollers, does not get to {share:.0f} % of the area for want of "
            "room, nor does a narrower one to much more: take rollers that are nearer, or a wheel",
            width=width,
            share=100.0 * share,
        )
    return core.Fact(
        "raster.proposed_narrower",
        "the belt of {width:.3g} mm, flat between its rollers, does not get to {share:.0f} % of the area for want of room; one "
        "of {narrower:.3g} mm leaves {rest:.0f} %",
        width=width,
        share=100.0 * share,
        narrower=max(one for one, left in tried.items() if left <= least + look["as_good"]),
        rest=100.0 * least,
    )
