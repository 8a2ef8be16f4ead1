"""The shortest grind that keeps a share of the area in tolerance.

From the plan that brings most into tolerance, time is given a cost, the greatest with which the first-order prediction
still keeps the share; what is simulated says how far the prediction may be trusted, and moves it.
"""

import time

from ..simulation import run as runs
from . import step, sure

ROOM = 0.002  # of the area, given up for time where no share is asked for
GAIN = 0.005  # of the time, that a round must save
SEARCHES = 12  # costs that are tried in a round
LEAST, MOST = 1e-10, 1e-2  # mm2 a second
PEAKS = 0.01  # of the limit of pressure, by which two runs may differ
CAUTION = 0.5  # of what the prediction promised too much


def wanted_share(settings, best):
    """The share of the area that must stay in tolerance."""
    return settings["wanted_share"] or max(sure.share(best) - ROOM, 0.0)


def saves(figures, first, settings):
    """Whether a plan is faster than the job was, and as good as is asked for or as the job was."""
    least = min(settings["wanted_share"] or 1.0, sure.share(first))
    return sure.share(figures) >= least and figures["process_time_s"] < first["process_time_s"]


def faster(commands, best, settings, rounds, told, context):
    """``best`` (as ``rounds`` keeps its tries), or a faster one that has the share. Simulates ``rounds`` times at most;
    ``rounds`` and ``told`` get each."""
    wanted = wanted_share(settings, best["figures"])
    if sure.share(best["figures"]) < wanted:
        return best  # there is nothing to give away
    feeds, factors, result = best["feeds"], best["factors"], best["result"]
    margin = 0.0
    for _ in range(settings["rounds"]):
        begun = time.perf_counter()
        found = _dearest(commands, result, feeds, factors, settings, context, wanted + margin)
        if found is None:
            break
        new, forces, what = found
        job = commands.with_feeds(new, forces)
        tried = runs.run(job, context.part(1.0, 1.0), influence=True, shifts=True)
        one = {**step.figures(tried, settings), **what, "seconds": time.perf_counter() - begun}
        one["goal"] = "time"
        rounds.append(one)
        if told is not None:
            told(one)
        before = best["figures"]["process_time_s"]
        over = one.get("over_limit", 0.0) - best["figures"].get("over_limit", 0.0)
        if over <= PEAKS and sure.share(one) >= wanted and one["process_time_s"] < before:
            best["result"].influence = None
            best = {"figures": one, "feeds": new, "factors": forces, "result": tried, "job": job}
            feeds, factors, result = new, forces, tried
            if one["process_time_s"] > (1.0 - GAIN) * before:
                break
        else:
            tried.influence = None
        # What was promised too much is asked for beyond the share from now on.
        margin = max(0.0, margin + CAUTION * (what["predicted_in_tolerance"] - sure.share(one)))
        if wanted + margin > 1.0:
            break
    return best


def _dearest(commands, result, feeds, factors, settings, context, wanted):
    """The step (as ``step.following`` gives it) for the greatest cost of time with which the prediction keeps the
    share; None if none does."""
    low, high, best = LEAST, MOST, None
    for _ in range(SEARCHES):
        cost = (low * high) ** 0.5
        found = step.following(commands, result, feeds, factors, settings, context, cost)
        if found[2]["predicted_in_tolerance"] >= wanted:
            low, best = cost, found
        else:
            high = cost
    return best
