"""The shortest grind that keeps a share of the area in tolerance.

From the plan that brings most into tolerance, time is given a cost, the greatest with which the first-order prediction
still keeps the share; what is simulated says how far the prediction may be trusted, and moves it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..base.kinds import Json
from . import step, sure

if TYPE_CHECKING:
    from .trials import Trial, Trials

ROOM = 0.002  # of the area, given up for time where no share is asked for
GAIN = 0.005  # of the time, that a round must save
SEARCHES = 12  # costs that are tried in a round
LEAST, MOST = 1e-10, 1e-2  # mm2 a second
PEAKS = 0.01  # of the limit of pressure, by which two runs may differ
CAUTION = 0.5  # of what the prediction promised too much


def wanted_share(settings: Json, best: Json) -> float:
    """The share of the area that must stay in tolerance."""
    return settings["wanted_share"] or max(sure.share(best) - ROOM, 0.0)


def saves(figures: Json, first: Json, settings: Json) -> bool:
    """Whether a plan is faster than the job was, and as good as is asked for or as the job was."""
    least = min(settings["wanted_share"] or 1.0, sure.share(first))
    return sure.share(figures) >= least and figures["process_time_s"] < first["process_time_s"]


def faster(trials: Trials, best: Trial) -> Trial:
    """The ``Trial`` ``best``, or a faster one that has the share. Simulates ``rounds`` times at most."""
    settings = trials.settings
    wanted = wanted_share(settings, best.figures)
    if sure.share(best.figures) < wanted:
        return best  # there is nothing to give away
    margin = 0.0
    for _ in range(settings["rounds"]):
        found = _dearest(trials, best, wanted + margin)
        if found is None:
            break
        feeds, forces, what = found
        trial = trials.tell(trials.simulate(feeds, forces), **what, goal="time")
        one, before = trial.figures, best.figures["process_time_s"]
        over = one.get("over_limit", 0.0) - best.figures.get("over_limit", 0.0)
        if over <= PEAKS and sure.share(one) >= wanted and one["process_time_s"] < before:
            trials.forget(best)
            best = trial
            if one["process_time_s"] > (1.0 - GAIN) * before:
                break
        else:
            trials.forget(trial)
        # What was promised too much is asked for beyond the share from now on.
        margin = max(0.0, margin + CAUTION * (what["predicted_in_tolerance"] - sure.share(one)))
        if wanted + margin > 1.0:
            break
    return best


def _dearest(trials: Trials, best: Trial, wanted: float) -> step.Step | None:
    """The step (as ``step.following`` gives it) for the greatest cost of time with which the prediction keeps the
    share; None if none does."""
    low, high, dearest = LEAST, MOST, None
    seen = step.Seen(
        trials.commands, best.result, best.feeds, best.factors, trials.settings, trials.context
    )
    for _ in range(SEARCHES):
        cost = (low * high) ** 0.5
        found = step.following(seen, cost)
        if found[2]["predicted_in_tolerance"] >= wanted:
            low, dearest = cost, found
        else:
            high = cost
    return dearest
