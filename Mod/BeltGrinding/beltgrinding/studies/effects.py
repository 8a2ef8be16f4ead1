"""Main effects: a figure's mean over the range of each variable, and the coefficients of a linear regression."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Floats
from . import resampling
from .share import CONFIDENCE

if TYPE_CHECKING:
    from .kinds import Variables

MOST_LEVELS = 8  # different values, up to which each is a level of its own
LEVELS = 6  # else
RUNS_A_LEVEL = 5  # at least
SAME = 1e-12  # relative: a figure that differs less is the same in all runs


def levels(values: Array) -> tuple[Array, list[tuple[Any, Any]]]:
    """How a variable's values fall into levels: (number (n,) int, [(from, to)]). Few different values are a level each,
    others fall into levels of equal counts; text is never ordered: its levels are (text, text)."""
    if values.dtype.kind not in "fiu":
        names, number = np.unique(values.astype(str), return_inverse=True)
        return number, [(name, name) for name in names.tolist()]
    values = values.astype(float)
    distinct, number = np.unique(values, return_inverse=True)
    if len(distinct) <= MOST_LEVELS:
        return number, [(one, one) for one in distinct.tolist()]
    count = int(np.clip(len(values) // RUNS_A_LEVEL, 2, LEVELS))
    edges = np.quantile(values, np.linspace(0.0, 1.0, count + 1)[1:-1])
    number = np.searchsorted(edges, values, "right")
    kept, number = np.unique(number, return_inverse=True)  # ties may leave a level empty
    ends = [values[number == k] for k in range(len(kept))]
    return number, [(float(one.min()), float(one.max())) for one in ends]


def is_constant(figure: Array) -> bool:
    """Whether a figure (n,) is the same in all runs, as far as doubles tell."""
    return len(figure) == 0 or np.ptp(figure) <= SAME * max(np.abs(figure).max(), 1e-300)


def main_effects(
    variables: Variables,
    figure: Floats,
    drawn: Floats | None = None,
    confidence: float = CONFIDENCE,
) -> list[dict[str, Any]]:
    """What each variable does to a figure, on average over the others.

    ``variables``: {name: (n,) numbers or text}; ``figure``: (n,) finite; ``drawn``: as ``resampling.counts``, None where
    the runs are no sample: then nothing has an interval. Returns [dict(variable, swing, low, high, range, levels)]: a level
    is dict(from, to, count, mean, low, high); the swing, with its interval, is the mean in the last level less that in
    the first, for text the greatest mean less the least, as is the range for all.
    """
    found = []
    for name, values in variables.items():
        number, ends = levels(values)
        member = np.eye(len(ends))[number]
        counts = member.sum(axis=0)
        means = figure @ member / counts
        ordered = values.dtype.kind in "fiu"
        first, last = (0, -1) if ordered else (int(means.argmin()), int(means.argmax()))
        low = high = np.full(len(ends) + 1, np.nan)
        if drawn is not None:
            with np.errstate(invalid="ignore", divide="ignore"):
                again = drawn @ (member * figure[:, None]) / (drawn @ member)
            swings = again[:, last] - again[:, first]
            low, high = resampling.interval(np.column_stack([again, swings]), confidence)
        found.append(
            {
                "variable": name,
                "swing": float(means[last] - means[first]),
                "low": _number(low[-1]),
                "high": _number(high[-1]),
                "range": float(np.ptp(means)),
                "levels": [
                    {
                        "from": ends[k][0],
                        "to": ends[k][1],
                        "count": int(counts[k]),
                        "mean": float(means[k]),
                        "low": _number(low[k]),
                        "high": _number(high[k]),
                    }
                    for k in range(len(ends))
                ],
            }
        )
    return found


def regression(
    variables: Variables,
    figure: Floats,
    drawn: Floats | None = None,
    confidence: float = CONFIDENCE,
) -> dict[str, Any] | None:
    """Linear regression on all variables with numbers: dict(r2, rows [dict(variable, coefficient, low, high)]), of the
    standardised coefficients: by how many of its standard deviations the figure changes with one of the variable.
    None where the runs do not determine them: too few, or variables that are not independent of each other.
    """
    names = [name for name, values in variables.items() if values.dtype.kind in "fiu"]
    names = [name for name in names if not is_constant(variables[name].astype(float))]
    if not names or is_constant(figure) or len(figure) < len(names) + 2:
        return None
    given = np.column_stack([variables[name].astype(float) for name in names])
    given = (given - given.mean(axis=0)) / given.std(axis=0)
    wanted = (figure - figure.mean()) / figure.std()
    if np.linalg.matrix_rank(given, tol=1e-8 * np.sqrt(given.size)) < len(names):
        return None
    whole = np.column_stack([np.ones(len(wanted)), given])
    found, *_ = np.linalg.lstsq(whole, wanted, rcond=None)
    residual = wanted - whole @ found
    low = high = np.full(len(names), np.nan)
    if drawn is not None:
        low, high = resampling.interval(_drawn(given, wanted, drawn), confidence)
    return {
        "r2": float(1.0 - np.mean(residual**2)),
        "rows": [
            {
                "variable": name,
                "coefficient": float(found[k + 1]),
                "low": _number(low[k]),
                "high": _number(high[k]),
            }
            for k, name in enumerate(names)
        ],
    }


def _drawn(given: Floats, wanted: Floats, drawn: Floats) -> Floats:
    """(samples, variables) standardised coefficients of each bootstrap sample, by its moments."""
    columns = np.column_stack([given, wanted])
    size = columns.shape[1]
    total = drawn.sum(axis=1)
    means = drawn @ columns / total[:, None]
    products = (columns[:, :, None] * columns[:, None, :]).reshape(len(columns), -1)
    moments = (drawn @ products / total[:, None]).reshape(-1, size, size)
    covariance = moments - means[:, :, None] * means[:, None, :]
    deviation = np.sqrt(np.maximum(np.einsum("bii->bi", covariance), 1e-300))
    correlation = covariance / (deviation[:, :, None] * deviation[:, None, :])
    inner = correlation[:, :-1, :-1] + 1e-12 * np.eye(size - 1)
    return np.linalg.solve(inner, correlation[:, :-1, -1:])[:, :, 0]


def _number(value: float) -> float | None:
    """For JSON: None where it is not known."""
    return float(value) if np.isfinite(value) else None
