"""How a belt loads over a part, and what its free running, pauses and dressings give back: docs/removal-method.md."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..base.kinds import known
from ..engine import InputError

if TYPE_CHECKING:
    from ..job.settings import Job, Wear
    from ..simulation.result import Result

MOST = 40  # stretches of contact in a part: the shortest breaks between more are moved to the next
LEAST_USE = 1e-9  # of the loading's scale: less is rounding
SAME_TIME = 1e-3  # of a step's duration: a shorter break is rounding


class Stretch(NamedTuple):
    """The belt runs free, may be dressed, then grinds."""

    share: float  # of what the belt does in a part; 0: it only runs free
    free_s: float  # at any feed
    moving_s: float  # runs free in motions whose feed may change
    dressings: int


class Between(NamedTuple):
    """What happens to a belt between two parts."""

    pause_s: float = 0.0  # in which it runs free, at no cost
    dress_every: int = 0  # parts on it, until it is dressed; 0: never
    dress_s: float = 0.0  # of the cell, for that


def check(between: Between, wear: Wear) -> None:
    """Raises InputError for what cannot be, or what a belt that does not load gains nothing by."""
    for value in (between.pause_s, between.dress_every, between.dress_s):
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(
                "planning.between",
                "belt plan: pause and dressing must be numbers, none below 0",
            )
    if any(between) and not wear.loading_share > 0.0:
        raise InputError(
            "planning.no_loading",
            "belt plan: pause and dressing free a belt of what loads it, and {key} is 0; set it, or leave them out",
            key="law.wear.loading_share",
        )


def stretches(job: Job, result: Result) -> tuple[Stretch, ...]:
    """The stretches of contact of a simulated job, with what is before each, and behind the last."""
    steps = known(result.steps)
    duration = np.asarray(steps["duration"], dtype=float)
    begin = np.asarray(steps["time"], dtype=float) - 0.5 * duration
    done = np.asarray(steps["force"], dtype=float) * duration
    shares = (done / max(done.sum(), 1e-300)).tolist()
    found, share, free, moving, dressings = list[Stretch](), 0.0, 0.0, 0.0, 0
    clock, before = 0.0, -1
    for at, seconds, part, program in zip(
        begin.tolist(), duration.tolist(), shares, steps["program"].tolist()
    ):
        gap, new = max(at - clock, 0.0), 0
        for one in job.programs[before + 1 : program + 1]:
            gap += one.pause_s or 0.0
            new += bool(one.dress)
        clock, before = at + seconds, program
        apart = gap > SAME_TIME * seconds or new > 0 or part == 0.0
        if apart and share > 0.0:
            found.append(Stretch(share, free, moving, dressings))
            share, free, moving, dressings = 0.0, 0.0, 0.0, 0
        free, dressings = free + (gap if apart else 0.0), dressings + new
        moving += seconds if part == 0.0 else 0.0
        share += part
    if share > 0.0:
        found.append(Stretch(share, free, moving, dressings))
        free, moving, dressings = 0.0, 0.0, 0
    free += max(float(result.summary["process_time_s"]) - clock, 0.0)
    return (*_fewer(found), Stretch(0.0, free, moving, dressings))


def _fewer(found: list[Stretch]) -> list[Stretch]:
    """At most ``MOST``: a short break is added to the one before the next stretch."""
    while len(found) > MOST:
        breaks = [one.free_s + one.moving_s + 1e9 * one.dressings for one in found[1:]]
        k = 1 + int(np.argmin(breaks))
        one, last = found[k], found[k - 1]
        joined = last._replace(share=last.share + one.share, free_s=last.free_s + one.free_s)
        joined = joined._replace(
            moving_s=last.moving_s + one.moving_s, dressings=last.dressings + one.dressings
        )
        found = [*found[: k - 1], joined, *found[k + 1 :]]
    return found


def over(
    wear: Wear, part: tuple[Stretch, ...], loading: float, use: float, feed: float
) -> tuple[float, float]:
    """(mean loading while a part is ground, loading behind it). ``use``: what the belt does in it, J or mm3 as its wear
    has it; ``feed``: factor on the feeds."""
    mean = 0.0
    for one in part:
        loading *= wear.dressing_rest**one.dressings
        loading = free(wear, loading, one.free_s + one.moving_s / feed)
        x = one.share * use / wear.loading_scale
        if x > LEAST_USE:
            mean += one.share * (1.0 + (1.0 - loading) * math.expm1(-x) / x)
            loading -= (1.0 - loading) * math.expm1(-x)
        else:
            mean += one.share * loading
    return mean, loading


def free(wear: Wear, loading: float, seconds: float) -> float:
    """The loading after the belt has run free."""
    recovery = wear.loading_recovery_s
    return loading * math.exp(-seconds / recovery) if recovery > 0.0 else loading


def rested(wear: Wear, between: Between, loading: float, done: int) -> tuple[float, bool]:
    """(loading, whether the belt was dressed) before its next part; ``done``: parts since it was put on."""
    loading = free(wear, loading, between.pause_s)
    dressed = between.dress_every > 0 and done % between.dress_every == 0
    return (wear.dressing_rest * loading if dressed else loading), dressed
