"""One round of a plan: from what a simulation found to the feeds and forces that the next one tries."""

from __future__ import annotations

import time
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..base.kinds import Array, Floats, Json, known
from ..engine import core
from ..inspection import verdict as verdicts
from ..job.settings import Job
from ..job.typed import typed
from . import limits, sure, with_force
from .paces import Pace
from .thinning import Thinned

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .commands import Commands

SAME = 1e-9  # relative, of a feed or a force
HAND_FORCE = 1.5  # factor by which a round may change the one force that is set by hand
HAND_TRIES = 6  # of such forces
HAND_GAIN = 0.005  # of the area, that a lower one of them must bring
HURRIED = {"inner_share": 0.7, "inner_cost": 0.1}  # of the band; of what deviations cost beyond

# Feeds (commands,) and factors on forces (commands,) for the next round, and what is told of it, or by the solver.
Step: TypeAlias = "tuple[Floats, Floats, dict[str, Any]]"


def feed_exponent(job: Job | Json) -> float:
    """gamma of the job's law: the rate of removal goes with the feed to this power."""
    job = typed(job)
    law = job.law
    return float(law.feed_exponent) if law.model == "local" else 0.0


def force_exponent(job: Job | Json) -> float:
    """alpha of the job's law: the rate of removal goes with the pressure to this power."""
    job = typed(job)
    law = job.law
    return float(law.pressure_exponent) if law.model == "local" else 1.0


def figures(result: Result, settings: Json) -> dict[str, Any]:
    """What is told of a simulation: shares of the area, by the tolerance of each zone, and ``sure.figures``."""
    summary = result.summary
    found = {
        "resolution": summary["resolution"],
        "in_tolerance": summary["in_tolerance_area_share"],
        "above": summary["above_tolerance_area_share"],
        "below": summary["below_tolerance_area_share"],
        "rms_mm": summary["deviation_mm"]["rms"],
        "process_time_s": summary["process_time_s"],
    }
    if any(zone.tolerance_mm for zone in typed(result.job).inspection.zones):
        field = result.field
        lower, upper = verdicts.limits(result.job, field)
        height, weight = np.asarray(field.height, dtype=float), sure.seen_areas(field)
        above, below = (
            float(weight[off].sum() / weight.sum()) for off in (height > upper, height < lower)
        )
        found.update(in_tolerance=1.0 - above - below, above=above, below=below)
    return {**found, **sure.figures(result, settings), **limits.figures(result, settings)}


class Seen:
    """What a simulation of a job says for the next round."""

    def __init__(
        self,
        commands: Commands,
        result: Result,
        feeds: Floats,
        factors: Floats,
        settings: Json,
        context: core.RunContext,
    ) -> None:
        self.commands, self.result, self.settings = commands, result, settings
        self.feeds, self.factors = feeds, factors
        self.pace = Pace(commands, feeds)
        lower, upper = verdicts.limits(result.job, result.field)
        self.half = 0.5 * (upper - lower) * np.ones(result.field.size)  # mm
        # mm from the middle of the band
        self.deviation = np.asarray(result.field.height, dtype=float) - 0.5 * (lower + upper)
        self.weight = sure.seen_areas(result.field)
        self.context = context
        self.removed = known(result.influence).grouped(commands.group, len(commands))
        self.influence = self._in_the_end(known(result.influence))
        self.power = 1.0 - feed_exponent(result.job)  # removed depth goes with the time to this
        self.alpha = force_exponent(result.job)
        self.least, greatest = commands.force_range
        most = limits.greatest_factors(result, commands, factors, settings)
        self.greatest = np.maximum(np.minimum(greatest, most), self.least)
        self._thinned = Thinned(result.field, result.job, self.weight)
        self._removed = self.thinned(self.removed)
        self.moved = (np.diff(self._removed.first.astype(int)) > 0) & ~commands.kept

    @cached_property
    def _influence(self) -> core.Influence:
        return self.thinned(self.influence)

    def solver(self, in_the_end: bool = True) -> tuple[core.Influence, Floats, Floats, Floats]:
        """(influence, mm from the middle of the band, half the band that is aimed at mm, weights mm2) for the solver;
        ``in_the_end``: as later motions leave it, else what each removes itself."""
        thinned, band = self._thinned, sure.band(self.result, self.settings, self.half)
        kept, influence = thinned.kept, self._influence if in_the_end else self._removed
        return influence, self.deviation[kept], band[kept], thinned.weight

    def thinned(self, influence: core.Influence) -> core.Influence:
        return self._thinned.influence(influence, len(self.half))

    def by_force(self) -> core.Influence:
        """(commands,) core.Influence, mm per relative change of force: what each would remove more itself."""
        return known(self.result.force_influence).grouped(self.commands.group, len(self.commands))

    def by_force_in_the_end(self) -> core.Influence:
        """The same, as far as later motions leave it."""
        return self._in_the_end(known(self.result.force_influence))

    def _in_the_end(self, influence: core.Influence) -> core.Influence:
        removed, areas = known(self.result.influence), np.asarray(self.result.field.areas)
        group, count = self.commands.group, len(self.commands)
        return influence.in_the_end(removed, areas, group, count, self.context.part(0.0, 0.0))

    def within(self, low: Floats, high: Floats, most: float) -> tuple[Floats, Floats]:
        """Ranges (commands,) twice of a factor, by no more than the factor ``most`` from 1; 1 of what may not change."""
        low, high = (np.clip(one, 1.0 / most, most) for one in (low, high))
        low = np.minimum(low, high)
        low[~self.moved] = high[~self.moved] = 1.0
        return low, high


def following(
    seen: Seen,
    time_cost: float | None = None,
    forces: bool = False,
    reach: float = 1.0,
) -> Step:
    """(feeds (commands,) and factors on forces (commands,) for the next round, what is told of it).

    ``time_cost``: mm2 that a second of the process costs; None: only deviations count. Where time counts, deviations
    within the band hardly do, and forces rather than slow feeds do what is to be done. ``forces``: forces are planned
    with the feeds, by the result's ``force_influence``; else they change where feeds are at their limits. ``reach``: of
    what a round may change, on a logarithmic scale.
    """
    begun = time.perf_counter()
    commands, settings, context = seen.commands, seen.settings, seen.context
    feeds, factors = seen.feeds, seen.factors
    by_hand = commands.by_hand and commands.presses()
    if by_hand:
        forces = False
        if time_cost is None:
            new, force, found = _feeds_and_one_force(seen, reach, context)
        else:  # the force stays
            seen.least = seen.greatest = factors
            new, force, found = _feeds_first(seen, time_cost, reach, context)
    elif forces:
        new, force, found = _feeds_and_forces(seen, reach, context)
    else:
        new, force, found = _feeds_first(seen, time_cost, reach, context)
    force[abs(force - 1.0) <= SAME] = 1.0
    new = np.where(seen.moved, new, feeds)
    matter = with_force.energy(seen.removed, seen.weight)
    new = limits.feeds(commands, new, matter, settings)
    if not by_hand:
        force = np.where(seen.moved, force, factors)
        force = limits.factors(commands, force, matter, new, settings)
    # What the feeds and forces in the end should do: limits may have changed them.
    longer = seen.pace.longer(new) ** seen.power
    if forces:
        excess = seen.deviation - _removed(seen.influence, longer - 1.0, len(seen.half))
        excess -= _removed(seen.by_force_in_the_end(), force / factors - 1.0, len(seen.half))
    else:
        done = longer * (force / factors) ** seen.alpha
        excess = seen.deviation - _removed(seen.influence, done - 1.0, len(seen.half))
    inside = abs(excess) <= seen.half
    height = np.asarray(seen.result.field.height, dtype=float) - seen.deviation + excess
    predicted = sure.figures(seen.result, settings, height)
    share = float(seen.weight[inside].sum() / seen.weight.sum())
    return (
        new,
        force,
        {
            "predicted_in_tolerance": sure.share({"in_tolerance": share, **predicted}),
            "predicted_rms_mm": float(np.sqrt(np.average(height**2, weights=seen.weight))),
            "residual": found["residual"],
            "iterations": found["iterations"],
            "planning_seconds": time.perf_counter() - begun,
        },
    )


def _feeds_first(
    seen: Seen, time_cost: float | None, reach: float, context: core.RunContext
) -> Step:
    """(feeds mm/s, factors on forces (commands,), what the solver tells): the feed does what it can, from the job's own
    force or, in a hurry, from the greatest; the force the rest, as much more as the law has it.
    """
    settings, pace, factors = seen.settings, seen.pace, seen.factors
    power, alpha = seen.power, seen.alpha
    # How much a command removes, at first order, against now: by its time and its force.
    slowest = pace.longest**power * (seen.greatest / factors) ** alpha
    fastest = pace.shortest**power * (seen.least / factors) ** alpha
    fastest, slowest = seen.within(fastest, slowest, settings["most_change"] ** reach)
    solver = {"smoothing": settings["smoothing"], "accuracy": with_force.ACCURACY}
    costs = np.zeros(0)
    if time_cost is not None:
        solver.update(HURRIED)
        costs = time_cost * pace.now
    found = core.plan_dwell(
        *seen.solver(),
        fastest,
        slowest,
        1.0 / seen.feeds,
        solver,
        context.part(0.0, 0.0),
        costs,
    )
    wanted = found["factor"]
    pressed = seen.greatest if time_cost is not None else np.ones(len(wanted))
    longer = (wanted * (factors / pressed) ** alpha) ** (1.0 / power)
    new = pace.feeds(np.clip(longer, pace.shortest, pace.longest))
    rest = wanted / pace.longer(new) ** power
    return new, np.clip(factors * rest ** (1.0 / alpha), seen.least, seen.greatest), found


def _feeds_and_one_force(seen: Seen, reach: float, context: core.RunContext) -> Step:
    """As ``_feeds_first``, with the one force for all that is set by hand: of several, the one with which most of the area
    is predicted to be in tolerance."""
    settings, pace = seen.settings, seen.pace
    now = float(seen.factors[0])
    most = min(settings["most_change"], HAND_FORCE) ** reach
    least, greatest = float(seen.least.max()), float(max(seen.greatest.min(), seen.least.max()))
    low, high = max(least, now / most), min(greatest, now * most)
    tried = {now, *np.geomspace(min(low, high), high, HAND_TRIES).tolist()}
    solver = {"smoothing": settings["smoothing"], "accuracy": with_force.ACCURACY}
    influence, deviation, half, weight = seen.solver()
    tries: list[tuple[float, float, Floats, dict[str, Any]]] = []
    for factor in sorted(one for one in tried if least - SAME <= one <= greatest + SAME):
        stronger = (factor / now) ** seen.alpha
        fastest, slowest = seen.within(
            pace.shortest**seen.power * stronger,
            pace.longest**seen.power * stronger,
            settings["most_change"] ** reach,
        )
        # What keeps its feed removes as much more as the force does.
        fastest = np.where(seen.moved, fastest, stronger)
        slowest = np.where(seen.moved, slowest, stronger)
        found = core.plan_dwell(
            influence, deviation, half, weight, fastest, slowest, 1.0 / seen.feeds, solver,
            context.part(0.0, 0.0), np.zeros(0),
        )  # fmt: skip
        left = deviation - _removed(influence, found["factor"] - 1.0, len(deviation))
        share = float(weight[abs(left) <= half].sum() / weight.sum())
        longer = (found["factor"] / stronger) ** (1.0 / seen.power)
        tries.append((share, factor, longer, found))
    most = max(one[0] for one in tries) - HAND_GAIN  # what is a little better is not worth the time
    _, factor, longer, found = max((one for one in tries if one[0] >= most), key=lambda one: one[1])
    new = pace.feeds(np.clip(longer, pace.shortest, pace.longest))
    return new, np.full(len(new), factor), found


def _feeds_and_forces(seen: Seen, reach: float, context: core.RunContext) -> Step:
    """As ``_feeds_first``, both at once."""
    settings, feeds, factors = seen.settings, seen.feeds, seen.factors
    slowest, fastest = seen.pace.longest**seen.power, seen.pace.shortest**seen.power
    most = min(settings["most_change"], with_force.MOST_TIME) ** reach
    strongest = min(settings["most_change"], with_force.MOST_FORCE) ** reach
    # Of these, what each removes itself: for both at once the wider columns take several times as long, and lead no further.
    influence, deviation, half, weight = seen.solver(in_the_end=False)
    longer, stronger, found = with_force.solve(
        influence,
        seen.thinned(seen.by_force()),
        deviation,
        half,
        weight,
        with_force.Ranges(
            *seen.within(fastest, slowest, most),
            *seen.within(seen.least / factors, seen.greatest / factors, strongest),
        ),
        (1.0 / feeds, factors),
        settings["smoothing"],
        context.part(0.0, 0.0),
    )
    return seen.pace.feeds(longer ** (1.0 / seen.power)), factors * stronger, found


def _removed(influence: core.Influence, share: Floats, samples: int) -> Array:
    """(samples,) mm that motions remove which take so much longer."""
    each = np.repeat(share, np.diff(influence.first).astype(int))
    return np.bincount(influence.sample, each * influence.depth, samples)
