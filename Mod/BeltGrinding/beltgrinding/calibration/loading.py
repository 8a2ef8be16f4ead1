"""Loading of the belt from grinds in sequence: what a grind loads, the belt gives back while it runs free.

The share that loading takes is a parameter of the fit (src/removal, calibration.h). Its scale and its recovery are those
of a grid, refined, with which the data are likeliest; what the grid's others say of the other parameters widens these.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..engine import InputError, core
from .model import INDEX

if TYPE_CHECKING:
    from .model import Model
    from .table import Table

SHARE = "loading_share"
HIDDEN = 2  # parameters besides the share: scale and recovery
LEVELS = 7  # of each in the grid
REACH = 3.0  # beyond the least and the greatest of what the grinds do, and of how long the belt was free
FINER = (0.5, 0.25)  # of the grid's step, about the best
# Of the evidence, very strong after Kass and Raftery, JASA 90, 1995.
STRONG = math.log(150.0)
LEAST_USE = 1e-9  # of the scale: less is rounding

Fit = tuple[list[str], dict[str, Any], float]  # free parameters, fit, evidence


class Loading(NamedTuple):
    """How a belt loads, but for the share that it takes."""

    scale: float  # J or mm3
    recovery: float  # s


def uses(table: Table) -> tuple[Floats, Floats]:
    """(what the belt does in each grind (n,), what it did since the one before that the table does not list (n,)): mm3 if
    its wear is counted so, else J."""
    volume = table.wear_kind == "volume"
    use = table.measured if volume else table.force * table.speed * table.time
    other = np.zeros(len(use))
    if table.wear_kind in ("volume", "work"):
        other[1:] = np.maximum(table.wear[1:] - table.wear[:-1] - use[:-1], 0.0)
    return use, other


def means(table: Table, loading: Loading) -> Floats:
    """(n,) mean loading over each grind, one after the other on one belt that begins without. A belt whose wear is less
    than before is another one."""
    use, other = uses(table)
    found, now = np.empty(len(use)), 0.0
    new = np.diff(table.wear, prepend=table.wear[:1]) < 0.0
    for i, seconds in enumerate(table.free.tolist()):
        if new[i]:
            now = 0.0
        else:
            now -= (1.0 - now) * math.expm1(-float(other[i]) / loading.scale)
            now *= math.exp(-seconds / loading.recovery)
        x = float(use[i]) / loading.scale
        found[i] = 1.0 + (1.0 - now) * math.expm1(-x) / x if x > LEAST_USE else now
        now -= (1.0 - now) * math.expm1(-x)
    return np.clip(found, 0.0, 1.0)


def refuse(table: Table) -> None:
    """Raises InputError for grinds whose work is not known."""
    if not (table.spread == 1.0).all():
        raise InputError(
            "calibration.loading_of_depths",
            "{file}: with the column free_s the table must give volumes (removed_volume_mm3): a depth does not say how "
            "much the belt did",
            file=table.path,
        )


def fit(
    model: Model,
    free: list[str],
    found: dict[str, Any],
    with_wear: Callable[[list[str]], list[str]],
    warnings: Facts,
) -> tuple[list[str], dict[str, Any]]:
    """(free parameters, fit) with the belt's loading where the grinds speak very strongly for it; else as given, with a
    word. ``with_wear(free)``: with the parameters of the wear that the model says then. Changes the model.
    """
    table = model.table
    if not len(table.free):
        return free, found
    refuse(table)
    if len(free) + 1 + HIDDEN >= len(table.measured) - 1 or not np.ptp(table.free) > 0.0:
        warnings.append(
            core.Fact(
                "calibration.loading_not_varied",
                "too few grinds, or the belt always ran free for as long: loading cannot be told from wear, and counts as "
                "such; vary free_s",
            )
        )
        return free, found
    plain = model.evidence(found, free)
    grid = _grid(table)
    tried = {at: _at(model, at, [*free, SHARE]) for at in grid}
    best = max(tried, key=lambda at: tried[at][2])
    model.load(means(table, best))
    longer = [*with_wear([name for name in free if not is_wear(name)]), SHARE]
    if longer != [*free, SHARE]:
        tried = {at: _at(model, at, longer) for at in grid}
        best = max(tried, key=lambda at: tried[at][2])
    evidence = np.array([one[2] for one in tried.values()])
    mean = evidence.max() + math.log(np.exp(evidence - evidence.max()).mean())
    if not mean > plain + STRONG:
        model.load(None)
        warnings.append(
            core.Fact(
                "calibration.no_loading",
                "the grinds do not tell loading of the belt from its wear: it is left out, and counts as wear",
            )
        )
        return free, found
    best, chosen = _refined(model, best, tried[best], grid)
    model.load(means(table, best), best)
    chosen["between_loading"] = _between(chosen, longer, list(tried.values()), evidence)
    edges = [grid[0], grid[-1]]
    if any(best.scale in (one.scale,) or best.recovery in (one.recovery,) for one in edges):
        warnings.append(
            core.Fact(
                "calibration.loading_at_edge",
                "the loading's scale of {scale:.3g} or its recovery in {recovery:.3g} s is at the end of what the grinds "
                "can tell; vary how long the belt grinds, and how long it runs free",
                scale=best.scale,
                recovery=best.recovery,
            )
        )
    return longer, chosen


def is_wear(name: str) -> bool:
    """Whether a parameter is one of the wear's forms."""
    return name in ("wear_exponent", "ln_wear_scale", "wear_rest", "first_share", "ln_first_ratio")


def _grid(table: Table) -> list[Loading]:
    use = uses(table)[0]
    times = table.free[table.free > 0.0]
    scales = np.geomspace(use.min() / REACH, REACH * use.sum(), LEVELS)
    recoveries = np.geomspace(times.min() / REACH, REACH * times.max(), LEVELS)
    return [Loading(float(scale), float(time)) for scale in scales for time in recoveries]


def _at(model: Model, at: Loading, free: list[str]) -> Fit:
    model.load(means(model.table, at))
    found = model.fit(free)
    return free, found, model.evidence(found, free)


def _refined(
    model: Model, best: Loading, chosen: Fit, grid: list[Loading]
) -> tuple[Loading, dict[str, Any]]:
    steps = [
        math.log(grid[-1][k] / grid[0][k]) / (LEVELS - 1) if grid[-1][k] > grid[0][k] else 0.0
        for k in (0, 1)
    ]
    for share in FINER:
        middle = best
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                at = Loading(
                    middle.scale * math.exp(i * share * steps[0]),
                    middle.recovery * math.exp(j * share * steps[1]),
                )
                one = _at(model, at, chosen[0]) if i or j else chosen
                if one[2] > chosen[2]:
                    best, chosen = at, one
    return best, chosen[1]


def _between(found: Json, free: list[str], tried: list[Fit], evidence: Floats) -> Floats:
    """(k, k) covariance of all parameters by which the fits of the grid differ, each as likely as the data make it."""
    between = np.zeros((len(INDEX), len(INDEX)))
    at = [INDEX[name] for name in free]
    weights = np.exp(evidence - evidence.max())
    for weight, one in zip(weights / weights.sum(), tried):
        away = one[1]["parameters"][at] - found["parameters"][at]
        between[np.ix_(at, at)] += weight * np.outer(away, away)
    return between
