"""Quantiles of values that count differently."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def weighted_quantile(
    values: NDArray[np.float64], weights: NDArray[np.float64], share: float
) -> float:
    """The least of ``values`` (n,) that ``share`` (0 to 1) of the ``weights`` (n,) do not exceed; 0.0 of none."""
    if not len(values):
        return 0.0
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order][min(np.searchsorted(summed, share * summed[-1]), len(values) - 1)])
