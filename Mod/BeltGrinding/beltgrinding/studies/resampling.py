"""The bootstrap: how often each run is drawn in each of many samples with replacement (Efron and Tibshirani 1993)."""

from __future__ import annotations

import numpy as np

from ..base.kinds import Array, Floats

SAMPLES = 500
MOST_CELLS = 20_000_000  # of the matrix of counts; fewer samples for very many runs
LEAST_SAMPLES = 100
SEED = 1


def counts(runs: int, groups: Array | None = None, samples: int = SAMPLES) -> Floats:
    """(samples, runs) float: how often each of ``runs`` runs is drawn. ``groups``: (runs,) int; the runs of a group are
    drawn together, since they are not independent. The same for the same numbers."""
    groups = np.arange(runs) if groups is None else np.unique(groups, return_inverse=True)[1]
    number = int(groups.max()) + 1
    samples = int(np.clip(MOST_CELLS // max(runs, 1), LEAST_SAMPLES, samples))
    drawn = np.random.default_rng(SEED).multinomial(number, np.full(number, 1.0 / number), samples)
    return drawn[:, groups].astype(float)


def interval(values: Array, confidence: float) -> tuple[Floats, Floats]:
    """(low, high) (...,): the percentiles of ``values`` (samples, ...) that enclose the confidence; NaN is left out."""
    rest = 50.0 * (1.0 - confidence)
    some = np.isfinite(values).any(axis=0)
    known = np.where(some, values, 0.0)
    low, high = np.nanpercentile(known, [rest, 100.0 - rest], axis=0)
    return np.where(some, low, np.nan), np.where(some, high, np.nan)
