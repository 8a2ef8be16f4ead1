"""Many feeds as few: what a person types into a pendant."""

from __future__ import annotations

import numpy as np

from ..base.kinds import Floats

ROUNDS = 200


def quantised(feeds: Floats, weights: Floats, count: int) -> Floats:
    """(n,) each feed (n,) mm/s replaced by one of at most ``count``, so that the weighted squares of the logarithms'
    differences are as small as moving the borders makes them (Lloyd, IEEE Trans. Inf. Theory 28, 1982).
    """
    values, inverse = np.unique(feeds, return_inverse=True)
    if len(values) <= count:
        return feeds.copy()
    logs, summed = np.log(values), np.bincount(inverse, weights)
    sums = np.concatenate([[0.0], np.cumsum(summed)])
    centres = np.interp((np.arange(count) + 0.5) / count * sums[-1], sums[1:], logs)
    for _ in range(ROUNDS):
        own = np.searchsorted(0.5 * (centres[1:] + centres[:-1]), logs)
        total = np.bincount(own, summed, count)
        means = np.bincount(own, summed * logs, count) / np.maximum(total, 1e-300)
        next_ = np.where(total > 0, means, centres)
        if np.array_equal(next_, centres):
            break
        centres = np.sort(next_)
    own = np.searchsorted(0.5 * (centres[1:] + centres[:-1]), logs)
    return np.exp(centres)[own][inverse]


def lowered(feeds: Floats, most: Floats) -> Floats:
    """(n,) of few different feeds (n,) mm/s each no more than ``most`` (n,): the greatest of them that is, or the least."""
    values = np.unique(feeds)
    within = np.searchsorted(values, np.minimum(feeds, most), side="right") - 1
    return values[np.maximum(within, 0)]
