"""The user's preferences: FreeCAD's parameters below BaseApp/Preferences/Mod/BeltGrinding.

A preference that is not set has the job schema's default, or the program's own.
"""

from __future__ import annotations

from typing import NamedTuple

import FreeCAD

from ..engine import InputError, core
from .kinds import ParameterGroup
from .properties import rule

GROUP = "User parameter:BaseApp/Preferences/Mod/BeltGrinding"
LIMIT = 0.5  # mm, end of the ramps for the figures below
TOLERANCE = 0.05  # mm
# name of the parameter, property of a new job, key of the job
JOB_DEFAULTS = (
    ("DefaultSpacing", "Spacing", "sampling.spacing_mm"),
    ("DefaultToleranceLower", "ToleranceLower", "inspection.tolerance_mm.0"),
    ("DefaultToleranceUpper", "ToleranceUpper", "inspection.tolerance_mm.1"),
    ("DefaultColourLimit", "ColourLimit", "inspection.colour_limit_mm"),
)
COLOURS = ("ColourInTolerance", "ColourAbove", "ColourBelow")


class DeviationUnit(NamedTuple):
    """What deviations are told in: ``symbol``, its size in mm, and the decimals that make sense."""

    symbol: str
    size: float
    decimals: int


UNITS = (
    DeviationUnit("mm", 1.0, 3),
    DeviationUnit("µm", 1e-3, 0),
    DeviationUnit("mil", 0.0254, 2),
)


def parameters() -> ParameterGroup:
    """FreeCAD's parameter group."""
    return FreeCAD.ParamGet(GROUP)


def job_default(parameter: str) -> float:
    """Value in mm that a new job gets, by the parameter's name."""
    key = next(key for name, _, key in JOB_DEFAULTS if name == parameter)
    return parameters().GetFloat(parameter, float(rule(key)[1]))


def job_defaults() -> dict[str, float]:
    """Properties of a new job by name, mm."""
    return {name: job_default(parameter) for parameter, name, _ in JOB_DEFAULTS}


def standard_colours() -> tuple[int, ...]:
    """The core's colours in, above and below the tolerance, 0xRRGGBBAA: in the ramps' middles."""
    middle = 0.5 * (LIMIT + TOLERANCE)
    return tuple(
        int(c) for c in core.colour_scale(-TOLERANCE, TOLERANCE, LIMIT, [0, middle, -middle])
    )


def colours() -> tuple[int, ...] | None:
    """(in, above, below the tolerance) as 0xRRGGBBAA, or None for the standard ones."""
    standard = standard_colours()
    chosen = tuple(
        parameters().GetUnsigned(name, default) | 255 for name, default in zip(COLOURS, standard)
    )
    return None if chosen == standard else chosen


def deviation_unit() -> DeviationUnit:
    """The DeviationUnit that deviations are told in."""
    symbol = parameters().GetString("DeviationUnit", UNITS[0].symbol)
    return next((unit for unit in UNITS if unit.symbol == symbol), UNITS[0])


def apply_threads() -> int:
    """Tells the core how many threads it may use; 0: all. Returns the number in use."""
    try:
        core.set_threads(parameters().GetInt("Threads", 0))
    except InputError:  # a value that no field of ours writes
        core.set_threads(0)
    return core.threads()
