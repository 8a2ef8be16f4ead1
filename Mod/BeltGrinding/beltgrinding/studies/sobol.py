"""Sobol indices: which share of a figure's variance each variable causes alone (first order), and with all others
(total). They are defined for independent variables only."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Floats
from . import design
from .effects import is_constant
from .share import CONFIDENCE

if TYPE_CHECKING:
    from .kinds import OpenTurns

BOOTSTRAP = 300
LEAST = 16  # rows of a block
ESTIMATORS = {  # of OpenTURNS
    "saltelli": "SaltelliSensitivityAlgorithm",
    "jansen": "JansenSensitivityAlgorithm",
    "martinez": "MartinezSensitivityAlgorithm",
    "mauntz-kucherenko": "MauntzKucherenkoSensitivityAlgorithm",
}


def whole_rows(good: Array, size: int) -> Array:
    """(size,) bool: the rows of a design of blocks of ``size`` runs that are there in every block. ``good``: (n,) bool,
    the runs that did not fail; a row that lacks a run in one block is of no use in the others."""
    return np.asarray(good, dtype=bool).reshape(-1, size).all(axis=0)


def of_blocks(
    inputs: Floats,
    figure: Floats,
    size: int,
    estimator: str = "martinez",
    confidence: float = CONFIDENCE,
    second_order: bool = False,
) -> dict[str, Any] | None:
    """Indices from a design of blocks (A, B, and B or A with one column of the other for each variable), as
    OpenTURNS' SobolIndicesExperiment makes it.

    ``inputs``: (n, d), text as numbers of its choices; ``figure``: (n,), all finite; ``size``: runs of a block; n is
    (d + 2) ``size`` or, with ``second_order`` and more than two variables, (2 d + 2) ``size``. Returns dict(first, total), a
    list of [value, low, high] each; and second, a matrix of values, with ``second_order``. None where the figure is the
    same in all runs or there are fewer than 16 rows. The intervals are of the bootstrap. Martinez' estimator (2011) by
    default.
    """
    if is_constant(figure) or size < LEAST:
        return None
    ot = design.openturns()
    kind = getattr(ot, ESTIMATORS[estimator])
    centred = (figure - figure.mean()) / figure.std()
    found = kind(ot.Sample(inputs.tolist()), ot.Sample(centred[:, None].tolist()), size)
    found.setUseAsymptoticDistribution(False)
    found.setBootstrapSize(BOOTSTRAP)
    found.setConfidenceLevel(confidence)
    ot.RandomGenerator.SetSeed(1)
    told = {
        "first": _rows(found.getFirstOrderIndices(), found.getFirstOrderIndicesInterval()),
        "total": _rows(found.getTotalOrderIndices(), found.getTotalOrderIndicesInterval()),
    }
    if second_order:
        told["second"] = np.array(found.getSecondOrderIndices()).tolist()
    return told


def _rows(values: Iterable[float], interval: OpenTurns) -> list[list[float]]:
    bounds = interval.getLowerBound(), interval.getUpperBound()
    return [[float(x) for x in row] for row in zip(values, *bounds)]
