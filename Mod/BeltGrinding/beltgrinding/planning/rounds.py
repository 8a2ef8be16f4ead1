"""Plans a job's feeds: simulates it, sees what every motion removed where, slows down or speeds up, and simulates
again.

One simulation gives how much every motion removed at every sample. A motion that takes x times as long removes x
times as much, at first order; ``core.plan_dwell`` finds the x with which the heights come into the tolerance's band,
within the limits of feed. The contact changes with the surface, so that the figures hold near their own run only:
rounds, as Gauss and Newton's. What is told is not what was predicted, but what the last simulation found.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import records, schemas
from ..base.kinds import Array, Context, Floats, Json, known
from ..engine import InputError, core
from ..job import resolution, robot_time, spacing
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import check_faces, read_design
from ..simulation import convergence, run as runs
from . import least_time, levels, limits, reasons, sure
from .commands import Commands
from .step import SAME, Seen, feed_exponent, figures, following
from .trials import Trials

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .trials import Trial

STEEPEST = 0.95  # exponent of the feed in the law, from which on the feed decides nothing
FEEDS_ONLY = 2  # rounds, in which forces change where feeds are at their limits: larger steps than both at once
STALLED = 2  # rounds without a gain
CHECKS = 16.0  # simulations' time: two runs at half the spacing and step
WORSE = 1e-9  # of the area
NEARER = 0.95  # of the rms
FARTHER = 2.0  # times what a round may change, after one that was better
NEARER_BY = 0.5  # after another
LESS_FORCE = (
    0.01  # of the area, cut too deep at the greatest feed, to say that less force would help
)
LOWERED = 6  # simulations, at most, in which forces are lowered to the limit of pressure
PEAKS = 0.01  # of the limit of pressure, by which two runs may differ


class Plan(NamedTuple):
    """What was planned."""

    job: dict[str, Any]  # the job with the planned feeds, its programs pose by pose
    before: Result  # of the job as it was
    after: Result  # of the planned one; the same as ``before`` if nothing better was found
    rounds: list[
        dict[str, Any]
    ]  # dicts: in_tolerance (share), rms_mm, process_time_s, predicted_in_tolerance, residual, seconds
    better: bool
    commands: Commands
    old: Floats  # (commands,) mm/s
    new: Floats  # (commands,) mm/s
    factors: Floats  # (commands,) on the forces
    why: dict[str, Any]  # as ``reasons.find``
    # Figures of the same job at half the spacing and step, before and after; {}: not asked for.
    checked: dict[str, Any]
    settings: dict[str, Any]  # with all defaults


def schema() -> dict[str, Any]:
    """The JSON Schema of the settings, as a dict."""
    return schemas.schema("plan")


def validate(settings: Json) -> dict[str, Any]:
    """A copy of ``settings`` with all defaults filled in. Raises InputError naming the key."""
    given: dict[str, Any] = schemas.checked(settings, schema(), "plan")
    for low, high, bounded in (
        ("feed_min_mm_s", "feed_max_mm_s", True),
        ("force_min_N", "force_max_N", given["force_max_N"] > 0.0),
    ):
        if bounded and given[low] > given[high]:
            raise InputError(
                "planning.limits",
                "{key}: {least:g} is above {other}, {most:g}",
                key=low,
                least=given[low],
                other=high,
                most=given[high],
            )
    return given


def plan(
    job: Job | Json,
    settings: Json | None = None,
    context: Context = None,
    told: Callable[[dict[str, Any]], object] | None = None,
    sources: Sequence[str | None] | None = None,
    start: tuple[Floats, Floats] | None = None,
    over: Callable[[], bool] | None = None,
) -> Plan:
    """Plans the feeds of a validated job's programs. ``settings``: Resources/schema/plan.schema.json;
    ``told(round)``: is called after each round with its dict; ``sources``: as ``Commands`` takes them; ``start``: (feeds, factors on forces), a value a command, that the first round
    tries in place of planning, from an earlier ``Plan`` of the same programs; ``over()``: whether the best so far is enough.

    Returns a ``Plan``. It is never worse than the job: where no round brings more of the area into tolerance, the old
    feeds are given back, and ``better`` is false. Raises InputError (no tolerance, no stock, a tool that no feed
    matters to, limits that contradict each other), Cancelled.
    """
    settings = validate(settings or {})
    context = context or core.RunContext()
    limits.refuse(settings)
    data, settings = in_time(job, settings)
    job = typed(data)
    _refuse(job, settings)
    sure.refuse(job, settings)
    settings = limits.within_device(job, settings)
    whole_job = resolution.with_mode(settled(data, context), resolution.FULL)
    searched = resolution.with_mode(whole_job, settings["search_resolution"])
    commands = Commands(searched, settings, sources)
    old = commands.feed()
    tries = settings["rounds"] + 1
    whole = tries + (CHECKS if settings["check"] else 0.0)
    trials = Trials(commands, settings, told, context)
    best = _by_rounds(trials, old, start, tries, whole, over)
    if settings["goal"] == "time":
        best = least_time.faster(trials, best)
    if settings["levels"]:
        best = _in_levels(trials, best)
    if settings["search_resolution"] != resolution.FULL:
        trials.begin(Commands(whole_job, settings, sources))
        trials.tell(trials.simulate(old, np.ones(len(old))))
        best = trials.tell(trials.simulate(best.feeds, best.factors))
    best = _below_pressure(trials, best)
    first = known(trials.first)
    better = _better(best.figures, first.figures, settings) or (
        settings["goal"] == "time" and least_time.saves(best.figures, first.figures, settings)
    )
    if not better:
        best = first
    why = reasons.find(
        best.result, trials.commands, best.feeds, best.factors, settings, context.part(1.0, 1.0)
    )
    checked = {}
    if settings["check"]:
        done = len(trials.rounds) / whole
        for k, (name, one) in enumerate({"before": first, "after": best}.items()):
            part = context.part(done + (1 - done) * k / 2, done + (1 - done) * (k + 1) / 2)
            fine = runs.run(convergence.scaled(one.job, "fine"), part, shifts=True)
            checked[name] = figures(fine, settings)
    context.report(1.0)
    return Plan(
        best.job,
        first.result,
        best.result,
        trials.rounds,
        better,
        trials.commands,
        old,
        best.feeds,
        best.factors,
        why,
        checked,
        settings,
    )


def against(found: Plan, data: Json, context: Context = None) -> Plan:
    """A ``Plan`` of other passes with a job as it was, its own programs among it, as what was before. ``better`` is by
    that. A job whose programs are no path yet changes nothing. Raises Cancelled."""
    context = context or core.RunContext()
    part = context.part(1.0, 1.0)
    settings = found.settings
    try:
        job = in_time(data, settings)[0]
        job = resolution.with_mode(settled(job, part), resolution.FULL)
        before = runs.run(job, part, shifts=True)
    except InputError:
        return found
    first, after = (figures(one, settings) for one in (before, found.after))
    better = _better(after, first, settings) or (
        settings["goal"] == "time" and least_time.saves(after, first, settings)
    )
    checked = dict(found.checked)
    if checked:
        fine = runs.run(convergence.scaled(job, "fine"), part, shifts=True)
        checked["before"] = figures(fine, settings)
    return found._replace(before=before, better=better, checked=checked)


def in_time(job: Job | Json, settings: dict[str, Any]) -> tuple[Json, dict[str, Any]]:
    """(a validated job under the time that ``settings``, validated, plan in, those with the acceleration that the
    robot has where they give none). Few levels of feed jump: no acceleration is asked of them."""
    data = records.plain(job)
    if settings["timing"] != "robot":
        return data, settings
    given = settings["acceleration_mm_s2"]
    if not given and not settings["levels"]:
        given = robot_time.limits(data).path_acceleration_mm_s2
    return robot_time.timed(data), {**settings, "acceleration_mm_s2": given}


def _by_rounds(
    trials: Trials,
    old: Floats,
    start: tuple[Floats, Floats] | None,
    tries: int,
    whole: float,
    over: Callable[[], bool] | None,
) -> Trial:
    """The best ``Trial`` of at most ``tries``: simulates, plans from the best so far, and simulates again, as long as
    that leads on. ``start``, ``over``: as in ``plan``; ``whole``: how many simulations' time all of the planning takes.
    """
    commands, settings, context = trials.commands, trials.settings, trials.context
    feeds, factors = old, np.ones(len(commands))
    best: Trial | None = None
    stalled, reach = 0, 1.0
    with_forces = commands.presses() and not commands.by_hand
    for number in range(tries):
        part = context.part(number / whole, (number + 1) / whole)
        trial = trials.simulate(feeds, factors, part, with_forces)
        one = trial.figures
        if number == 0:
            _refuse_without_stock(trial.result)
        stalled = 0 if best is None or _gains(one, best.figures, settings) else stalled + 1
        if best is None or _better(one, best.figures, settings):
            if best is not None:
                trials.forget(best)
            best = trial
            reach = min(1.0, FARTHER * reach)
        else:
            trials.forget(trial)
            reach *= NEARER_BY
        ends = number + 1 == tries or stalled >= STALLED
        ends |= number > 0 and over is not None and over()
        found: dict[str, Any] = {}
        if number == 0 and start is not None and not ends:
            feeds, factors = start
        elif not ends:
            both = with_forces and number >= FEEDS_ONLY
            seen = Seen(commands, best.result, best.feeds, best.factors, settings, context)
            feeds, factors, found = following(seen, forces=both, reach=reach)
            # With forces, which the law is less linear in, a round that brought nothing must say so as well.
            asked = not with_forces or (both and stalled > 0)
            ends = asked and not _promises(found, best.figures, settings)
            found = {} if ends else found
        trials.tell(trial, **found)
        if ends:
            break
    return known(best)


def _refuse(job: Job, settings: Json) -> None:
    inspection = job.inspection
    zones = [zone.tolerance_mm for zone in inspection.zones if zone.tolerance_mm is not None]
    for lower, upper in (inspection.tolerance_mm, *zones):
        if not lower < upper:
            raise InputError(
                "planning.no_tolerance",
                "plan: the tolerance of {lower:g} to {upper:g} mm leaves no room; give one that does",
                lower=lower,
                upper=upper,
            )
    if settings["force_min_N"] or settings["force_max_N"]:
        if job.belt_machine.control != "force":
            raise InputError(
                "planning.no_force",
                "plan: {key}: forces are planned for machines under force control only",
                key="force_max_N" if settings["force_max_N"] else "force_min_N",
            )
    if job.law.model == "geometric":
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
    if job.law.model == "local" and job.law.feed_curve:
        raise InputError(
            "planning.feed_curve",
            "plan: laws with a curve over the feed are not planned yet; give law.feed_exponent in its place",
        )


def settled(data: Json, context: core.RunContext) -> Json:
    """The job with its spacing chosen, so that all rounds have the same samples."""
    job = typed(data)
    if job.sampling.spacing_mm != 0:
        return data
    shape = read_design(job.design, context.part(0.0, 0.0))
    check_faces(job, shape)
    return spacing.settled(data, shape, [], context.part(0.0, 0.0))[0]


def _better(one: Json, other: Json, settings: Json) -> bool:
    """Whether figures are better: nearer to the limit of pressure, or more in tolerance (surely, where that is asked
    for), or as much and nearer to it."""
    over = one.get("over_limit", 0.0) - other.get("over_limit", 0.0)
    if abs(over) > PEAKS:
        return over < 0.0
    gain = sure.gain(one, other, settings)
    return gain > WORSE or (gain > -WORSE and one["rms_mm"] < NEARER * other["rms_mm"])


def _gains(one: Json, best: Json, settings: Json) -> bool:
    """Whether a round leads on: enough comes into tolerance, or all comes nearer to it."""
    gain = sure.gain(one, best, settings)
    return gain >= settings["least_gain"] or one["rms_mm"] < NEARER * best["rms_mm"]


def _promises(found: Json, best: Json, settings: Json) -> bool:
    """Whether the round that was planned is predicted to lead on, as ``_gains``. Not asked where a probability or a limit of
    pressure counts, too."""
    if settings["probability"] or best.get("over_limit", 0.0) > PEAKS:
        return True
    gain = found["predicted_in_tolerance"] - sure.share(best)
    nearer: bool = found["predicted_rms_mm"] < NEARER * best["rms_mm"]
    return gain >= settings["least_gain"] or nearer


def _refuse_without_stock(result: Result) -> None:
    if not result.summary["stock_volume_mm3"] > 0.0:
        raise InputError(
            "planning.no_stock",
            "plan: there is no stock on the design, so that every motion cuts into it; give the job's stock",
        )


def _in_levels(trials: Trials, best: Trial) -> Trial:
    """The best feeds in few steps, simulated."""
    commands, count = trials.commands, trials.settings["levels"]
    lasts = np.bincount(commands.group, minlength=len(commands)).astype(float)
    free = ~commands.kept & (best.feeds > 0)
    feeds = best.feeds.copy()
    feeds[free] = levels.quantised(feeds[free], lasts[free], count)
    if commands.limits is not None:
        feeds[free] = levels.lowered(
            robot_time.rounded_feeds(feeds[free]), commands.feed_range[1][free]
        )
    return trials.tell(trials.simulate(feeds, best.factors), levels=count)


def _below_pressure(trials: Trials, best: Trial) -> Trial:
    """``best`` with forces lowered where they still press above the limit of pressure: the rounds come to it from both
    sides. Where commands that stay are above it, those alone are left so."""
    for _ in range(LOWERED):
        if best.figures.get("over_limit", 0.0) <= 0.0:
            break
        force = limits.below_pressure(
            best.result, trials.commands, best.feeds, best.factors, trials.settings
        )
        if trials.commands.by_hand:
            force = np.full(len(force), force.min())
        if (force >= best.factors * (1.0 - SAME)).all():
            break  # all that may be lowered is
        trials.forget(best)
        best = trials.tell(trials.simulate(best.feeds, force))
    return best


def changed(found: Plan, files: bool = False) -> Array:
    """(commands,) bool: a ``Plan`` changes its feed or its force. ``files``: in the programs' files, where a force that is
    set by hand does not stand."""
    feeds = abs(found.new - found.old) > SAME * found.old
    if files and found.commands.by_hand:
        return feeds
    return feeds | (abs(found.factors - 1.0) > SAME)


def summary(found: Plan) -> dict[str, Any]:
    """The figures of a ``Plan``, as JSON has them."""
    forces = found.commands.force(found.factors)
    return {
        "timing": found.settings["timing"],
        "time_law": typed(found.job).simulation.timing,
        "controller": robot_time.limits(found.job).controller,
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
        **_forces_and_blocks(found),
    }


def _forces_and_blocks(found: Plan) -> dict[str, Any]:
    """Of ``summary``: the one force that is set by hand, before and after; whether forces may change and less would help;
    how many commands keep feeds of their own that are too fast for their blocks."""
    commands = found.commands
    machine = typed(commands.job).belt_machine
    by_hand = None
    if commands.by_hand and commands.presses():
        by_hand = {
            "before_N": float(machine.force_N),
            "after_N": commands.hand_force(found.factors),
        }
    fixed = machine.control == "force" and not commands.presses()
    short = commands.too_short() & (found.new >= found.old * (1.0 - SAME))
    return {
        "force_by_hand": by_hand,
        "less_force_would_help": fixed and found.why["shares"]["fastest_feed"] > LESS_FORCE,
        "short_blocks": int(short.sum()),
    }
