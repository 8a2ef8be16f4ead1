"""Feeds and forces of a round at once: by what every motion removed, and what it would by more force.

More force does not only remove more: the contact grows, and its pressure changes place within it. So the two are no
copies of each other, and at borders and beside hollows they do together what neither does alone.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Floats
from ..engine import core

MOST_FORCE, MOST_TIME = (
    1.25,
    1.5,
)  # factors of a round: both are first order, and their product is not
ACCURACY = 1e-7  # of the conditions of optimality
PULL = 1e-3  # what changed forces cost, against the deviations
PRESSING = 0.02  # of what a motion removes, beyond ``INNER`` of the band, from which on its force is a variable
INNER = 0.7  # of the band, as the solver's


class Ranges(NamedTuple):
    """Of each command, (commands,): factors on its time and on its force."""

    fastest: Floats
    slowest: Floats
    weakest: Floats
    strongest: Floats


def solve(
    influence: core.Influence,
    by_force: core.Influence,
    deviation: Floats,
    half: Floats,
    weight: Floats,
    ranges: Ranges,
    paces: tuple[Floats, Floats],
    smoothing: float,
    context: core.RunContext,
) -> tuple[Floats, Floats, dict[str, Any]]:
    """(factors on the time, factors on the force (commands,), what ``core.plan_dwell`` tells).

    ``influence``, ``by_force``: core.Influence of the commands, mm, and mm per relative change of force;
    ``deviation``, ``half``, ``weight`` (samples,): mm from the middle of the band, half the band mm, area mm2;
    ``paces``: (of time, of force) (commands,), whose differences between neighbours are kept small, by ``smoothing``.
    """
    count, samples = len(influence), len(deviation)
    mean = energy(influence, weight).mean()
    free = (ranges.strongest > ranges.weakest) & _pressing(influence, deviation, half, weight)
    weakest = np.where(free, ranges.weakest, 1.0)
    strongest = np.where(free, ranges.strongest, 1.0)
    # A command's force is drawn to what it is by a sample of its own, on which nothing else has an effect.
    # An empty column keeps the last command's time and the first one's force from being neighbours.
    first, entries = by_force.first.astype(int), len(influence.sample)
    both = core.Influence(
        np.concatenate([influence.first.astype(int), entries + first + np.arange(count + 1)]),
        np.concatenate(
            [
                influence.sample,
                np.insert(by_force.sample.astype(int), first[1:], samples + np.arange(count)),
            ]
        ),
        np.concatenate([influence.depth, np.insert(by_force.depth, first[1:], 1.0)]),
    )
    ones = np.ones(count)
    found = core.plan_dwell(
        both,
        np.concatenate([deviation, np.zeros(count)]),
        np.concatenate([half, ones]),
        np.concatenate([weight, PULL * mean * ones]),
        np.concatenate([ranges.fastest, [1.0], weakest]),
        np.concatenate([ranges.slowest, [1.0], strongest]),
        np.concatenate([paces[0], [0.0], paces[1]]),
        {"smoothing": smoothing, "accuracy": ACCURACY},
        context,
    )
    return found["factor"][:count], found["factor"][count + 1 :], found


def _columns(influence: core.Influence) -> Array:
    return np.repeat(np.arange(len(influence)), np.diff(influence.first.astype(int)))


def energy(influence: core.Influence, weight: Floats) -> Array:
    """(commands,) mm4: of each, the square of what it removes, over the area."""
    each = influence.depth.astype(float) ** 2 * weight[influence.sample]
    return np.bincount(_columns(influence), each, len(influence))


def _pressing(influence: core.Influence, deviation: Floats, half: Floats, weight: Floats) -> Array:
    """(commands,) bool: enough of what it removes lies where deviations cost."""
    columns, sample = _columns(influence), influence.sample
    each = influence.depth * weight[sample]
    out = each * (abs(deviation) > INNER * half)[sample]
    whole = np.bincount(columns, each, len(influence))
    return np.bincount(columns, out, len(influence)) > PRESSING * whole
