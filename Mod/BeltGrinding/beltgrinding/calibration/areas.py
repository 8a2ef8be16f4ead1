"""How unsure a law is whose grinds do not say on which contact areas they were done."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..engine import core
from .model import INDEX

if TYPE_CHECKING:
    from .model import Model

# Standard deviation of ln of a contact area that nobody knows: 95 % of what belts grind is ground with a mean pressure
# of a tenth to ten times the nominal one, 0.1 MPa.
DEVIATION = math.log(10.0) / 1.96
# The area grows by this power of the force on a wheel's rim (0.33 bonded thin, 0.5 Hertz's cylinder), and not at all on a
# test piece that lies on the belt with its whole face.
GROWTH = 0.4
LEAST_FACTOR = 1.02  # of a removal at another area, to be told


def of_unknown_areas(model: Model, found: Json) -> Floats:
    """Covariance (parameters, parameters) that a nominal area in place of the true ones leaves in ln K and the pressure
    exponent; zero where the table knows areas.

    V ~ K F^a A^(1 - a), a depth V / A: an area that is exp(u) times the nominal one moves ln K by (a - 1) u, or a u. Areas that grow by F^q leave
    the slope a + (1 - a) q over the forces, so that the exponent is off by (a - 1) q / (1 - q).
    """
    covariance = np.zeros((len(INDEX), len(INDEX)))
    if not model.table.nominal_area:
        return covariance
    k, exponent = INDEX["ln_coefficient"], INDEX["pressure_exponent"]
    off = float(found["parameters"][exponent]) - 1.0
    covariance[k, k] = (_by_area(model, found) * DEVIATION) ** 2
    covariance[exponent, exponent] = (off * GROWTH / (1.0 - GROWTH)) ** 2
    return covariance


def caution(model: Model, found: Json) -> Facts:
    """What a reader has to know of a law without areas, as a Fact; none where areas hardly matter."""
    if not model.table.nominal_area:
        return []
    factor = math.exp(1.96 * _by_area(model, found) * DEVIATION)
    if factor < LEAST_FACTOR:
        return []
    return [
        core.Fact(
            "calibration.no_areas",
            "no contact area of the grinds is known: with a pressure exponent of {exponent:.2f} a simulation may remove "
            "up to {factor:.3g} times too much or too little, which its intervals hold; give area_mm2, the columns of "
            "the wheel, or the job whose wheel it was",
            exponent=float(found["parameters"][INDEX["pressure_exponent"]]),
            factor=factor,
        )
    ]


def _by_area(model: Model, found: Json) -> float:
    """By how much ln K is off for an area that is off by a factor e, on average."""
    exponent = float(found["parameters"][INDEX["pressure_exponent"]])
    return float(np.abs(exponent - np.isfinite(model.table.spread)).mean())
