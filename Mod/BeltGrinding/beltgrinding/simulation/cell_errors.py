"""How far a run's heights are off by the size of the contact's cells: an estimate at every sample, in every run.

The engine extrapolates the rate of removal from cells of twice the length at every step (``unresolved``); the sum over
the run, spread to its neighbours and with a margin, bounds the error. tests/validation/test_cell_errors.py measures how
often it does.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Array, Facts, Floats, Json
from ..engine import core
from ..inspection import verdict as verdicts
from ..job.settings import Job
from ..job.tolerances import narrowest_band
from .convergence_record import BAND_SHARE

MARGIN = 1.25  # on an extrapolation, by Roache (convergence)
DEPTH_SHARE = 0.1  # of the depth ground: errors above it count as coarse
RINGS = 1  # of samples round one, the largest of which it takes: signs change from one to the next
UNDECIDED = 0.2  # of the ground area: more is warned of; the errors are on the safe side


def estimate(job: Job, field: core.HeightField, unresolved: Sequence[Floats]) -> None:
    """Gives a ground field its ``height_error`` by ``unresolved``, (n,) mm of each program; of a rigid tool none."""
    if not all(len(one) for one in unresolved):
        return
    off = np.sum(unresolved, axis=0)
    ground, areas = _ground(field), np.asarray(field.areas, float)
    depth = np.where(ground, np.asarray(field.stock_height, float) - np.asarray(field.height), 0.0)
    volume = float((areas * depth).sum())
    # A force grinds one volume whatever the cells: what they take too much at edges is missing elsewhere.
    balance = abs(float((areas * off).sum())) / volume if volume > 0.0 else 0.0
    field.set_height_error(MARGIN * (np.abs(off) + balance * depth), RINGS)


def figures(job: Job, field: core.HeightField) -> dict[str, Json]:
    """What summary.json says of the errors; nothing where there are none."""
    if not len(field.height_error):
        return {}
    most = p95(field)  # before what else is large
    ground = _ground(field)
    error, areas = np.asarray(field.height_error)[ground], np.asarray(field.areas, float)[ground]
    if not areas.sum() > 0.0:
        return {}
    coarse = error > least(job, field)[ground]
    lower, upper = (limit[ground] for limit in verdicts.limits(job, field))
    height = np.asarray(field.height)[ground]
    nearest = np.minimum(abs(height - lower), abs(height - upper))
    told = {
        "p95": most,
        "max": float(error.max()),
        "coarse_area_share": _share(areas, coarse),
        "undecided_area_share": _share(areas, nearest <= error),
    }
    return {"cell_error_mm": told}


def p95(field: core.HeightField) -> float:
    """mm that 95 % of the ground area keep to; 0 where nothing was ground, or no errors are known."""
    ground = _ground(field) & (len(field.height_error) > 0)
    if not ground.any():
        return 0.0
    error, areas = np.asarray(field.height_error)[ground], np.asarray(field.areas, float)[ground]
    order = np.argsort(error)
    above = np.searchsorted(np.cumsum(areas[order]), 0.95 * areas.sum())
    return float(error[order][min(above, len(error) - 1)])


def least(job: Job, field: core.HeightField) -> Floats:
    """(n,) mm: the errors above which a depth counts as coarse."""
    lower, upper = narrowest_band(job.inspection)
    depth = np.asarray(field.stock_height, float) - np.asarray(field.height)
    return np.maximum(DEPTH_SHARE * depth, BAND_SHARE * (upper - lower))


def warn(summary: dict[str, Any], warnings: Facts) -> None:
    """Adds the warning that a summary's errors ask for."""
    told = summary.get("cell_error_mm")
    if told is None or told["undecided_area_share"] <= UNDECIDED:
        return
    warnings.append(
        core.Fact(
            "simulation.coarse_cells",
            "the size of the contact's cells may leave open whether {share:.1f} % of the ground area is in tolerance, mostly at "
            "edges; lower belt_machine.contact_spacing_mm and sampling.spacing_mm, or check the settings",
            share=100.0 * told["undecided_area_share"],
        )
    )


def _share(areas: Floats, which: Array) -> float:
    return float(min(areas[which].sum() / areas.sum(), 1.0))


def _ground(field: core.HeightField) -> Array:
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    return seen & (np.asarray(field.stock_height, float) > np.asarray(field.height))
