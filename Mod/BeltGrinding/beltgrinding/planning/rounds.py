"""Plans a job's feeds: simulates it, sees what every motion removed where, slows down or speeds up, and simulates
again.

One simulation gives how much every motion removed at every sample. A motion that takes x times as long removes x
times as much, at first order; ``core.plan_dwell`` finds the x with which the heights come into the tolerance's band,
within the limits of feed. The contact changes with the surface, so that the figures hold near their own run only:
rounds, as Gauss and Newton's. What is told is not what was predicted, but what the last simulation found.
"""

import math
import time
from typing import NamedTuple

import numpy as np

from ..base import schemas
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import resolution, spacing
from ..job.workpiece import check_faces, read_design
from ..simulation import convergence, run as runs
from . import least_time, levels, limits, reasons, sure
from .commands import Commands
from .step import SAME, feed_exponent, figures, following

STEEPEST = 0.95  # exponent of the feed in the law, from which on the feed decides nothing
FEEDS_ONLY = 2  # rounds, in which forces change where feeds are at their limits: larger steps than both at once
STALLED = 2  # rounds without a gain
CHECKS = 16.0  # simulations' time: two runs at half the spacing and step
WORSE = 1e-9  # of the area
NEARER = 0.95  # of the rms
FARTHER = 2.0  # times what a round may change, after one that was better
NEARER_BY = 0.5  # after another
LOWERED = 6  # simulations, at most, in which forces are lowered to the limit of pressure
PEAKS = 0.01  # of the limit of pressure, by which two runs may differ


class Plan(NamedTuple):
    """What was planned."""

    job: dict  # the job with the planned feeds, its programs pose by pose
    before: object  # simulation Result of the job as it was
    after: object  # of the planned one; the same as ``before`` if nothing better was found
    rounds: list  # dicts: in_tolerance (share), rms_mm, process_time_s, predicted_in_tolerance, residual, seconds
    better: bool
    commands: Commands
    old: np.ndarray  # (commands,) mm/s
    new: np.ndarray  # (commands,) mm/s
    factors: np.ndarray  # (commands,) on the forces
    why: dict  # as ``reasons.find``
    checked: dict  # figures of the same job at half the spacing and step, before and after; {}: not asked for
    settings: dict  # with all defaults


def schema():
    """The JSON Schema of the settings, as a dict."""
    return schemas.schema("plan")


def validate(settings):
    """A copy of ``settings`` with all defaults filled in. Raises InputError naming the key."""
    settings = schemas.checked(settings, schema(), "plan")
    for low, high, bounded in (
        ("feed_min_mm_s", "feed_max_mm_s", True),
        ("force_min_N", "force_max_N", settings["force_max_N"] > 0.0),
    ):
        if bounded and settings[low] > settings[high]:
            raise InputError(
                "planning.limits",
                "{key}: {least:g} is above {other}, {most:g}",
                key=low,
                least=settings[low],
                other=high,
                most=settings[high],
            )
    return settings


def plan(job, settings=None, context=None, told=None, sources=None, start=None):
    """Plans the feeds of a validated job's programs. ``settings``: Resources/schema/plan.schema.json;
    ``told(round)``: is called after each round with its dict; ``sources``: as ``Commands`` takes them; ``start``: (feeds, factors on forces), a value a command, that the first round
    tries in place of planning, from an earlier ``Plan`` of the same programs.

    Returns a ``Plan``. It is never worse than the job: where no round brings more of the area into tolerance, the old
    feeds are given back, and ``better`` is false. Raises InputError (no tolerance, no stock, a tool that no feed
    matters to, limits that contradict each other), Cancelled.
    """
    settings = validate(settings or {})
    context = context or core.RunContext()
    _refuse(job, settings)
    sure.refuse(job, settings)
    limits.refuse(settings)
    whole_job = resolution.with_mode(settled(job, context), resolution.FULL)
    searched = resolution.with_mode(whole_job, settings["search_resolution"])
    commands = Commands(searched, settings, sources)
    old = commands.feed()
    tries = settings["rounds"] + 1
    whole = tries + (CHECKS if settings["check"] else 0.0)
    feeds, factors, rounds, best = old, np.ones(len(commands)), [], None
    before, stalled, reach = None, 0, 1.0
    with_forces = commands.presses()
    for number in range(tries):
        begun = time.perf_counter()
        part = context.part(number / whole, (number + 1) / whole)
        tried = commands.with_feeds(feeds, factors)
        result = runs.run(tried, part, influence=True, shifts=True, forces=with_forces)
        one = figures(result, settings)
        rounds.append(one)
        if before is None:
            _refuse_without_stock(result)
        before = before or result
        stalled = 0 if best is None or _gains(one, best["figures"], settings) else stalled + 1
        if best is None or _better(one, best["figures"], settings):
            if best is not None and best["result"] is not before:
                best["result"].influence = best["result"].force_influence = None
            best = _tried(one, feeds, factors, result, tried)
            reach = min(1.0, FARTHER * reach)
        else:
            result.influence = result.force_influence = None
            reach *= NEARER_BY
        ends = number + 1 == tries or stalled >= STALLED
        if number == 0 and start is not None and not ends:
            feeds, factors = start
        elif not ends:
            feeds, factors, found = following(
                commands,
                best["result"],
                best["feeds"],
                best["factors"],
                settings,
                context,
                forces=with_forces and number >= FEEDS_ONLY,
                reach=reach,
            )
            one.update(found)
        one["seconds"] = time.perf_counter() - begun
        if told is not None:
            told(one)
        if ends:
            break
    if settings["goal"] == "time":
        best = least_time.faster(commands, best, settings, rounds, told, context)
    if settings["levels"]:
        best = _in_levels(commands, best, settings, rounds, told, context)
    first = rounds[0]
    if settings["search_resolution"] != resolution.FULL:
        commands = Commands(whole_job, settings, sources)
        before, first, best = _in_full(commands, best, old, settings, rounds, told, context)
    best = _below_pressure(commands, best, settings, rounds, told, context)
    better = _better(best["figures"], first, settings) or (
        settings["goal"] == "time" and least_time.saves(best["figures"], first, settings)
    )
    if not better:
        best = _tried(first, old, np.ones(len(commands)), before, commands.with_feeds(old))
    why = reasons.find(
        best["result"], commands, best["feeds"], best["factors"], settings, context.part(1.0, 1.0)
    )
    checked = {}
    if settings["check"]:
        done = len(rounds) / whole
        jobs = {"before": commands.with_feeds(old), "after": best["job"]}
        for k, (name, one) in enumerate(jobs.items()):
            part = context.part(done + (1 - done) * k / 2, done + (1 - done) * (k + 1) / 2)
            fine = runs.run(convergence.scaled(one, "fine"), part, shifts=True)
            checked[name] = figures(fine, settings)
    context.report(1.0)
    return Plan(
        best["job"],
        before,
        best["result"],
        rounds,
        better,
        commands,
        old,
        best["feeds"],
        best["factors"],
        why,
        checked,
        settings,
    )


def _tried(figures, feeds, factors, result, job):
    return {"figures": figures, "feeds": feeds, "factors": factors, "result": result, "job": job}


def _refuse(job, settings):
    inspection = job["inspection"]
    zones = [zone["tolerance_mm"] for zone in inspection.get("zones", []) if "tolerance_mm" in zone]
    for lower, upper in (inspection["tolerance_mm"], *zones):
        if not lower < upper:
            raise InputError(
                "planning.no_tolerance",
                "plan: the tolerance of {lower:g} to {upper:g} mm leaves no room; give one that does",
                lower=lower,
                upper=upper,
            )
    if settings["force_min_N"] or settings["force_max_N"]:
        if job["belt_machine"]["control"] != "force":
            raise InputError(
                "planning.no_force",
                "plan: {key}: forces are planned for machines under force control only",
                key="force_max_N" if settings["force_max_N"] else "force_min_N",
            )
    if job["law"]["model"] == "geometric":
        raise InputError(
            "planning.rigid",
            "plan: a geometric (rigid) tool takes all that it reaches, at any feed; nothing can be planned",
        )
    if feed_exponent(job) > STEEPEST:
        raise InputError(
            "planning.feed_decides_nothing",
            "plan: by the law, {key} {value:g}, a faster feed removes no less; nothing can be planned by feeds",
            key="law.feed_exponent",
            value=feed_exponent(job),
        )
    if job["law"]["model"] == "local" and job["law"]["feed_curve"]:
        raise InputError(
            "planning.feed_curve",
            "plan: laws with a curve over the feed are not planned yet; give law.feed_exponent in its place",
        )


def settled(job, context):
    """The job with its spacing chosen, so that all rounds have the same samples."""
    if job["sampling"]["spacing_mm"] != 0:
        return job
    shape = read_design(job["design"], context.part(0.0, 0.0))
    check_faces(job, shape)
    return spacing.settled(job, shape, [], context.part(0.0, 0.0))[0]


def _better(one, other, settings):
    """Whether figures are better: nearer to the limit of pressure, or more in tolerance (surely, where that is asked
    for), or as much and nearer to it."""
    over = one.get("over_limit", 0.0) - other.get("over_limit", 0.0)
    if abs(over) > PEAKS:
        return over < 0.0
    gain = sure.gain(one, other, settings)
    return gain > WORSE or (gain > -WORSE and one["rms_mm"] < NEARER * other["rms_mm"])


def _gains(one, best, settings):
    """Whether a round leads on: enough comes into tolerance, or all comes nearer to it."""
    gain = sure.gain(one, best, settings)
    return gain >= settings["least_gain"] or one["rms_mm"] < NEARER * best["rms_mm"]


def _refuse_without_stock(result):
    if not result.summary["stock_volume_mm3"] > 0.0:
        raise InputError(
            "planning.no_stock",
            "plan: there is no stock on the design, so that every motion cuts into it; give the job's stock",
        )


def _in_levels(commands, best, settings, rounds, told, context):
    """The best feeds in few steps, simulated."""
    lasts = np.bincount(commands.group, minlength=len(commands)).astype(float)
    free = ~commands.kept & (best["feeds"] > 0)
    feeds = best["feeds"].copy()
    feeds[free] = levels.quantised(feeds[free], lasts[free], settings["levels"])
    tried = commands.with_feeds(feeds, best["factors"])
    begun = time.perf_counter()
    result = runs.run(tried, context.part(1.0, 1.0), influence=True, shifts=True)
    one = {
        **figures(result, settings),
        "levels": settings["levels"],
        "seconds": time.perf_counter() - begun,
    }
    rounds.append(one)
    if told is not None:
        told(one)
    return _tried(one, feeds, best["factors"], result, tried)


def _in_full(commands, best, old, settings, rounds, told, context):
    """(result of the old feeds, its figures, the best feeds) by simulations at full resolution, after a coarse search."""
    found = []
    for feeds, factors in ((old, np.ones(len(commands))), (best["feeds"], best["factors"])):
        begun = time.perf_counter()
        tried = commands.with_feeds(feeds, factors)
        result = runs.run(tried, context.part(1.0, 1.0), influence=True, shifts=True)
        one = {**figures(result, settings), "seconds": time.perf_counter() - begun}
        rounds.append(one)
        if told is not None:
            told(one)
        found.append(_tried(one, feeds, factors, result, tried))
    return found[0]["result"], found[0]["figures"], found[1]


def _below_pressure(commands, best, settings, rounds, told, context):
    """``best`` with forces lowered where they still press above the limit of pressure: the rounds come to it from both
    sides. Where commands that stay are above it, those alone are left so."""
    for _ in range(LOWERED):
        if best["figures"].get("over_limit", 0.0) <= 0.0:
            break
        begun = time.perf_counter()
        force = limits.below_pressure(
            best["result"], commands, best["feeds"], best["factors"], settings
        )
        if (force >= best["factors"] * (1.0 - SAME)).all():
            break  # all that may be lowered is
        tried = commands.with_feeds(best["feeds"], force)
        result = runs.run(tried, context.part(1.0, 1.0), influence=True, shifts=True)
        one = {**figures(result, settings), "seconds": time.perf_counter() - begun}
        rounds.append(one)
        if told is not None:
            told(one)
        best["result"].influence = None
        best = _tried(one, best["feeds"], force, result, tried)
    return best


def changed(found):
    """(commands,) bool: a ``Plan`` changes its feed or its force."""
    return (abs(found.new - found.old) > SAME * found.old) | (abs(found.factors - 1.0) > SAME)


def summary(found):
    """The figures of a ``Plan``, as JSON has them."""
    forces = found.commands.force(found.factors)
    return {
        "better": found.better,
        "before": figures(found.before, found.settings),
        "after": figures(found.after, found.settings),
        "checked": found.checked,
        "rounds": [
            {
                k: (None if isinstance(v, float) and not math.isfinite(v) else v)
                for k, v in one.items()
            }
            for one in found.rounds
        ],
        "out_of_tolerance": found.why["shares"],
        "beyond_limits": {
            name: limits.beyond(found.commands, feeds, factors, found.settings)
            for name, feeds, factors in (
                ("before", found.old, np.ones(len(found.commands))),
                ("after", found.new, found.factors),
            )
        },
        "commands": len(found.commands),
        "changed": int(changed(found).sum()),
        "feed_mm_s": {
            "least": float(found.new.min()),
            "greatest": float(found.new.max()),
        },
        "force_N": {"least": float(forces.min()), "greatest": float(forces.max())},
    }
