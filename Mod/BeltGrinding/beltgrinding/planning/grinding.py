"""From faces to a path and its feeds: passes are laid, their feeds planned, and where that is not enough other passes
are tried, by why what is out of tolerance stays so.

Passes that are tried are simulated with few rounds, coarsely where samples are many; those that bring most of the area into tolerance are planned
as the settings say. It is a search by hand's rules, no proof that nothing is better.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Context, Floats, Json, known
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import poses
from ..job.settings import Job
from ..job.typed import typed
from ..programs.force_device import of_job
from ..raster import raster_path
from ..simulation import convergence
from . import reasons, rounds
from .limits import GENTLER

QUICK = {"rounds": 3, "check": False, "levels": 0}
TRIES = 6  # passes, at most
MOST_SAMPLES = 60_000  # finer ones are simulated at twice the spacing, for passes that are tried
GAIN = 0.003  # of the area, for other passes to be better
MATTERS = 0.01  # of the area: a reason for less is let be
CLOSER = 0.7  # step-over against the one before
CLOSEST = 0.2  # of the contact's width
MOST_POSES = 20_000
SMOOTHER = 2.0  # times the length over which the wheel turns, where the robot is slow to turn it and cuts too deep
MOST_SMOOTHING = 4.0  # of the contact's length
MOST_REPEATS = 20
MOST_OF = 0.9  # of the area that is not done at the least feed: the repeats are for it
GENTLE = 0.2  # of the force: the least where none is given, so that borders and ends of passes can be spared
FINAL = 0.5  # of the time: the last plan


class Ground(NamedTuple):
    """Passes and their plan."""

    settings: Json  # of the raster
    laid: dict[str, Any]  # as ``raster_path.raster`` gives it
    plan: rounds.Plan
    tried: list[
        dict[str, Any]
    ]  #: change, step_over_mm, repeats, run_out_mm, smoothing_mm, poses, in_tolerance, better


def grind(
    job: Job | Json,
    raster_settings: Json | None = None,
    settings: Json | None = None,
    context: Context = None,
    told: Callable[[dict[str, Any]], object] | None = None,
    zones: Callable[[dict[str, Any]], Floats] | None = None,
) -> Ground:
    """Lays passes on the faces of a validated job, whose own programs do not matter, and plans their feeds, and forces
    if the machine has a force device: down to ``GENTLER`` of the job's where ``force_min_N`` is not given, never up unless
    ``force_max_N`` is. Without a device the force stays, unless one of the two is given. ``raster_settings``: where the search begins; ``settings``: of the plan; ``told(dict)``: as
    ``tried``, then as rounds of the plan; ``zones(path)``: (poses,) mm, -1: the job's default, as the program's file will
    have them; without it those of the raster.

    Returns a ``Ground``. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    planned = _with_forces(typed(job), rounds.validate(settings or {}))
    data, settings = rounds.in_time(job, planned)
    best: dict[str, Any] | None = None
    tried: list[dict[str, Any]] = []
    queue: list[tuple[str, Json]] = [("first", raster_path.validate(raster_settings or {}))]
    seen = set()
    while queue and len(tried) < TRIES:
        change, wanted = queue.pop(0)
        key = repr(sorted(wanted.items(), key=lambda item: item[0]))
        if key in seen:
            continue
        seen.add(key)
        begun = len(tried) / TRIES * (1.0 - FINAL)
        part = context.part(begun, begun + (1.0 - FINAL) / TRIES)
        try:
            one = _try(data, wanted, settings, part, zones)
        except InputError:
            if best is None:
                raise
            continue  # no such passes on these faces
        better = best is None or one["in_tolerance"] > best["in_tolerance"] + GAIN
        tried.append(
            {
                "change": change,
                "step_over_mm": one["laid"]["step_over_mm"],
                "repeats": one["wanted"]["repeats"],
                "run_out_mm": one["wanted"]["run_out_mm"],
                "smoothing_mm": one["wanted"]["smoothing_mm"],
                "poses": len(one["laid"]["frames"]),
                "in_tolerance": one["in_tolerance"],
                "better": better,
            }
        )
        if told is not None:
            told(tried[-1])
        if better:
            best = one
            queue = _others(one)
    best = known(best)
    context.report(1.0 - FINAL)
    found = rounds.plan(
        _with_path(data, best["laid"]),
        settings,
        context.part(1.0 - FINAL, 1.0),
        told,
        start=(best["plan"].new, best["plan"].factors),
    )
    return Ground(best["wanted"], best["laid"], found, tried)


def _with_forces(job: Job, settings: Json) -> dict[str, Any]:
    settings = dict(settings)
    machine = job.belt_machine
    if sets_force(job, settings) and settings["force_min_N"] == 0.0:
        least = GENTLER if settings["timing"] == "robot" else GENTLE
        settings = {**settings, "force_min_N": least * machine.force_N}
    return settings


def sets_force(job: Job, settings: Json) -> bool:
    """Whether a program changes the pressing force: it is set by hand, once, where the job has no device for it and no
    other forces are asked for."""
    asked = settings["force_min_N"] > 0.0 or settings["force_max_N"] > 0.0
    return job.belt_machine.control == "force" and (asked or of_job(job) is not None)


def _with_path(data: Json, laid: Json) -> dict[str, Any]:
    """The job with the passes as its only program."""
    return {
        **data,
        "programs": [{"name": "raster", "poses": poses.list_poses(laid), "unresolved": 0}],
    }


def _try(
    data: Json,
    wanted: Json,
    settings: Json,
    context: core.RunContext,
    zones: Callable[[dict[str, Any]], Floats] | None,
) -> dict[str, Any]:
    laid = raster_path.raster(data, wanted, context.part(0.0, 0.2))
    if not sets_force(typed(data), settings):
        laid["forces"] = np.full(
            len(laid["forces"]), -1.0
        )  # the job's, from touching down to lifting off
    if zones is not None:
        laid["zones"] = zones(laid)
    # The way is found once: other passes go the same.
    wanted = {**wanted, "along": laid["along"], "direction": list(laid["direction"])}
    tried = rounds.settled(_with_path(data, laid), context)
    if laid["area_mm2"] > MOST_SAMPLES * tried["sampling"]["spacing_mm"] ** 2:
        tried = convergence.scaled(tried, "coarse")
    plan = rounds.plan(tried, {**settings, **QUICK}, context.part(0.2, 1.0))
    share = max(one.get("expected_share", one["in_tolerance"]) for one in plan.rounds)
    return {"wanted": wanted, "laid": laid, "plan": plan, "in_tolerance": share}


def _others(one: Json) -> list[tuple[str, Json]]:
    """[(what changes, settings)] that may mend what is out of tolerance, the likeliest first."""
    wanted, laid, shares = one["wanted"], one["laid"], one["plan"].why["shares"]
    found = []
    share, repeats = _repeats(one)
    if share > MATTERS and repeats > wanted["repeats"]:
        if len(laid["frames"]) * repeats <= MOST_POSES * max(wanted["repeats"], 1):
            found.append((share, "repeats", {**wanted, "repeats": repeats}))
    width, length = laid["contact_width_mm"], laid["contact_length_mm"]
    between = shares["shared"] + shares["fringe"] + shares["border"]
    closer = CLOSER * laid["step_over_mm"]
    if between > MATTERS and len(laid["frames"]) / CLOSER <= MOST_POSES:
        if width is None or closer >= CLOSEST * width:
            share = shares["shared"] + shares["fringe"]
            found.append((share, "step_over", {**wanted, "step_over_mm": closer}))
    if shares["border"] > MATTERS:
        for run_out in (0.25 * length, -0.25 * length):
            other = {**wanted, "run_out_mm": round(wanted["run_out_mm"] + run_out, 3)}
            found.append((0.9 * shares["border"], "run_out", other))
    below = one["plan"].rounds[-1]["below"]
    if below > MATTERS and wanted["smoothing_mm"] < MOST_SMOOTHING * length:
        smoother = max(SMOOTHER * wanted["smoothing_mm"], length)
        found.append((below, "smoothing", {**wanted, "smoothing_mm": round(smoother, 3)}))
    return [(name, settings) for _, name, settings in sorted(found, key=lambda one: -one[0])]


def _repeats(one: Json) -> tuple[float, int]:
    """(share of the area that is not done even at the least feed and the greatest force, how often the passes must be run
    through so that most of it is)."""
    plan, now = one["plan"], one["wanted"]["repeats"]
    field, influence = plan.after.field, known(plan.after.influence)
    slowest, _ = plan.commands.feed_range
    _, strongest = plan.commands.force_range
    more = (plan.new / slowest) * (strongest / plan.factors)  # of each command, than it removes now
    motions = np.repeat(np.arange(len(influence)), np.diff(influence.first).astype(int))
    depth = influence.depth * more[plan.commands.group][motions]
    most = np.bincount(influence.sample.astype(int), depth, len(field.height))
    lower, upper = verdicts.limits(plan.after.job, field)
    needed = np.asarray(field.stock_height, dtype=float) - upper
    areas = np.asarray(field.areas, dtype=float)
    left = (most > 0.0) & (most < needed) & (np.asarray(field.flags) & core.MISSED == 0)
    share = float(areas[left].sum() / areas.sum())
    if not left.any():
        return 0.0, now
    wanted = (needed + 0.5 * (upper - lower))[left]
    ratios = np.sort(wanted / np.maximum(most[left], 1e-6))
    return share, min(
        max(now + 1, math.ceil(now * float(ratios[int(MOST_OF * (len(ratios) - 1))]))), MOST_REPEATS
    )
