"""How sure a plan is: the part as laws and placements drawn at random would leave it.

A calibrated law knows how unsure it is of itself, and a simulation gives, sample by sample, how much more a law would
remove that is a standard deviation off along one of the independent directions in which it is unsure. Any law drawn
from them leaves, at first order, the height less the sum of those, each times a standard normal number, and all of them
times one factor where few grinds told how large they are (Student's t). A raw part that lies beside where it should has
its surface off by its normal times the error.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Floats, Json
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import law as laws
from ..job.settings import Job
from ..job.typed import typed

if TYPE_CHECKING:
    from ..simulation.result import Result

DRAWN = 1000
SEED = 1
CHUNK = 4096  # samples at once
LEAST_BAND = 0.1  # of the tolerance's, that is always aimed at


def refuse(job: Job | Json, settings: Json) -> None:
    """Raises InputError where a probability is asked for and nothing says how unsure anything is."""
    job = typed(job)
    if settings["probability"] and not settings["placement_sd_mm"]:
        if not laws.shifted_laws(job.law):
            raise InputError(
                "planning.not_calibrated",
                "plan: {key}: neither is the law calibrated, which would say how unsure it is (beltgrind calibrate), "
                "nor is {other} given",
                key="probability",
                other="placement_sd_mm",
            )


def seen_areas(field: core.HeightField) -> Floats:
    """(samples,) mm2; 0 where no stock was found."""
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    return np.where(seen, np.asarray(field.areas, dtype=float), 0.0)


def band(result: Result, settings: Json, half: Floats) -> Floats:
    """(samples,) mm: half of the tolerance's band, ``half``, less what is unsure."""
    if not settings["probability"]:
        return half
    freedoms = [laws.freedom(typed(result.job).law), math.inf]
    of_law, of_place = core.student_quantile(max(settings["probability"], 0.5), freedoms)
    variance = (np.asarray(result.shifts) ** 2).sum(axis=1)
    by = np.sqrt(of_law**2 * variance + (of_place * settings["placement_sd_mm"]) ** 2)
    return np.maximum(half - by, LEAST_BAND * half)


def drawn(result: Result, settings: Json, height: Floats | None = None) -> Floats:
    """(``DRAWN``,) share of the area that is in tolerance, for each law and placement drawn at random; the same at every
    call. ``height``: (samples,) mm, in place of the result's."""
    field = result.field
    lower, upper = verdicts.limits(result.job, field)
    lower, upper = (np.broadcast_to(limit, field.size) for limit in (lower, upper))
    height = np.asarray(field.height if height is None else height, dtype=float)
    weight = seen_areas(field)
    normals = np.asarray(field.normals, dtype=float)
    by_law = np.asarray(result.shifts)
    random, freedom = np.random.default_rng(SEED), laws.freedom(typed(result.job).law)
    numbers = random.standard_normal((by_law.shape[1] + 3, DRAWN))
    if math.isfinite(freedom):
        numbers[:-3] *= np.sqrt(freedom / random.chisquare(freedom, DRAWN))
    numbers[-3:] *= settings["placement_sd_mm"]
    share = np.zeros(DRAWN)
    for begin in range(0, field.size, CHUNK):
        part = slice(begin, begin + CHUNK)
        off = np.hstack([-by_law[part], normals[part]]) @ numbers
        off += height[part, None]
        share += weight[part] @ ((off >= lower[part, None]) & (off <= upper[part, None]))
    return share / weight.sum()


def figures(result: Result, settings: Json, height: Floats | None = None) -> dict[str, Any]:
    """What is told of ``drawn``: ``sure_share``, of the area, that is in tolerance with the wanted probability;
    ``expected_share``, the mean of all drawn; ``passing``, of the drawn ones, that have the wanted share; their 5th, 50th and 95th percentile. Empty where no
    probability is asked for."""
    if not settings["probability"]:
        return {}
    share = drawn(result, settings, height)
    return {
        "sure_share": float(np.quantile(share, 1.0 - settings["probability"], method="lower")),
        "expected_share": float(share.mean()),
        "passing": float((share >= settings["wanted_share"]).mean()),
        "drawn": [float(value) for value in np.quantile(share, (0.05, 0.5, 0.95))],
    }


def share(figures: Json) -> float:
    """What a plan keeps: the share of the area in tolerance, that which is sure where a probability is asked for."""
    return figures.get("sure_share", figures["in_tolerance"])


def gain(one: Json, other: Json, settings: Json) -> float:
    """By how much figures are better than others, in shares. Where a probability is asked for: by more of the drawn laws
    that pass, until as many do as are asked for; else by what is expected of them."""
    if not settings["probability"]:
        return one["in_tolerance"] - other["in_tolerance"]
    if settings["wanted_share"]:
        passing = [min(figures["passing"], settings["probability"]) for figures in (one, other)]
        if passing[0] != passing[1]:
            return passing[0] - passing[1]
    return one["expected_share"] - other["expected_share"]
