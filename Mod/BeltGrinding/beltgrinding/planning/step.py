"""One round of a plan: from what a simulation found to the feeds and forces that the next one tries."""

import time

import numpy as np

from ..engine import core
from ..inspection import verdict as verdicts
from . import limits, sure

SAME = 1e-9  # relative, of a feed or a force
HURRIED = {"inner_share": 0.7, "inner_cost": 0.1}  # of the band; of what deviations cost beyond


def feed_exponent(job):
    """gamma of the job's law: the rate of removal goes with the feed to this power."""
    law = job["law"]
    return float(law["feed_exponent"]) if law["model"] == "local" else 0.0


def force_exponent(job):
    """alpha of the job's law: the rate of removal goes with the pressure to this power."""
    law = job["law"]
    return float(law["pressure_exponent"]) if law["model"] == "local" else 1.0


def figures(result, settings):
    """What is told of a simulation: shares of the area, by the tolerance of each zone, and ``sure.figures``."""
    summary = result.summary
    found = {
        "in_tolerance": summary["in_tolerance_area_share"],
        "above": summary["above_tolerance_area_share"],
        "below": summary["below_tolerance_area_share"],
        "rms_mm": summary["deviation_mm"]["rms"],
        "process_time_s": summary["process_time_s"],
    }
    if any("tolerance_mm" in zone for zone in result.job["inspection"].get("zones", [])):
        field = result.field
        lower, upper = verdicts.limits(result.job, field)
        height, weight = np.asarray(field.height, dtype=float), sure.seen_areas(field)
        above, below = (
            float(weight[off].sum() / weight.sum()) for off in (height > upper, height < lower)
        )
        found.update(in_tolerance=1.0 - above - below, above=above, below=below)
    return {**found, **sure.figures(result, settings), **limits.figures(result, settings)}


def following(commands, result, feeds, factors, settings, context, time_cost=None):
    """(feeds (commands,) and factors on forces (commands,) for the next round, what is told of it).

    ``time_cost``: mm2 that a second of the process costs; None: only deviations count. Where time counts, deviations
    within the band hardly do, and forces rather than slow feeds do what is to be done.
    """
    begun = time.perf_counter()
    field, job = result.field, result.job
    lower, upper = verdicts.limits(job, field)
    height = np.asarray(field.height, dtype=float)
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    weight = sure.seen_areas(field)
    influence = result.influence.grouped(commands.group, len(commands))
    power = 1.0 - feed_exponent(job)  # removed depth goes with the time to this power
    alpha = force_exponent(job)
    least, greatest = commands.force_range
    greatest = np.maximum(
        np.minimum(greatest, limits.greatest_factors(result, commands, factors, settings)), least
    )
    # How much a command removes, at first order, against the job's: by its time and its force.
    given = (commands.feed() / feeds) ** power * factors**alpha
    slowest = (commands.feed() / settings["feed_min_mm_s"]) ** power * greatest**alpha / given
    fastest = (commands.feed() / settings["feed_max_mm_s"]) ** power * least**alpha / given
    change = settings["most_change"]
    slowest, fastest = (np.clip(a, 1.0 / change, change) for a in (slowest, fastest))
    fastest = np.minimum(fastest, slowest)
    moved = np.asarray(np.diff(influence.first.astype(int)) > 0) & ~commands.kept
    fastest[~moved] = slowest[~moved] = 1.0
    solver, costs = {"smoothing": settings["smoothing"]}, np.zeros(0)
    if time_cost is not None:
        solver.update(HURRIED)
        costs = time_cost * commands.seconds(feeds)
    found = core.plan_dwell(
        influence,
        height - middle,
        sure.band(result, settings, half),
        weight,
        fastest,
        slowest,
        1.0 / feeds,
        solver,
        context.part(0.0, 0.0),
        costs,
    )
    # The feed does what it can, from the job's own force or, in a hurry, from the greatest; the force the rest.
    wanted = given * found["factor"]
    pressed = greatest if time_cost is not None else np.ones(len(wanted))
    new = commands.feed() * (pressed**alpha / wanted) ** (1.0 / power)
    new = np.clip(new, settings["feed_min_mm_s"], settings["feed_max_mm_s"])
    rest = wanted * (new / commands.feed()) ** power
    force = np.clip(rest ** (1.0 / alpha), least, greatest)
    force[abs(force - 1.0) <= SAME] = 1.0
    new, force = np.where(moved, new, feeds), np.where(moved, force, factors)
    matter = _matter(influence, weight)
    new = limits.feeds(commands, new, matter, settings)
    force = limits.factors(commands, force, matter, new, settings)
    # What the feeds and forces in the end should do: limits may have changed them.
    done = (feeds / new) ** power * (force / factors) ** alpha
    excess = height - middle - _removed(influence, done - 1.0, len(height))
    inside = abs(excess) <= half
    predicted = sure.figures(result, settings, middle + excess)
    return (
        new,
        force,
        {
            "predicted_in_tolerance": sure.share(
                {"in_tolerance": float(weight[inside].sum() / weight.sum()), **predicted}
            ),
            "residual": found["residual"],
            "iterations": found["iterations"],
            "planning_seconds": time.perf_counter() - begun,
        },
    )


def _matter(influence, weight):
    """(commands,) mm4: of each command, the square of what it removes, over the area."""
    depth = np.asarray(influence.depth, dtype=float)
    sums = np.append(0.0, np.cumsum(depth**2 * weight[np.asarray(influence.sample)]))
    return np.diff(sums[np.asarray(influence.first).astype(int)])


def _removed(influence, share, samples):
    """(samples,) mm that motions remove which take so much longer."""
    each = np.repeat(share, np.diff(influence.first).astype(int))
    return np.bincount(np.asarray(influence.sample), each * np.asarray(influence.depth), samples)
