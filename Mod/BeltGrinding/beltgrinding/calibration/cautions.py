"""What the reader of a calibration has to know: what moves together, what the data leave open, what is assumed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..engine import core
from . import areas, contacts
from .law import worn
from .model import DEFAULTS, INDEX, PRIORS, correlations

if TYPE_CHECKING:
    from .model import Model
    from .table import Table

# What each parameter is the effect of, for messages.
EFFECT = {  # of the parameters: code and English form
    "ln_coefficient": ("calibration.the_coefficient", "the coefficient"),
    "pressure_exponent": ("calibration.force", "force"),
    "speed_exponent": ("calibration.belt_speed", "belt speed"),
    "feed_exponent": ("calibration.feed", "feed"),
    "time_exponent": ("calibration.grind_time", "grind time"),
    "area_exponent": ("calibration.contact_area", "contact area"),
    "ln_wear_scale": ("calibration.belt_wear", "belt wear"),
    "wear_exponent": ("calibration.belt_wear", "belt wear"),
    "wear_rest": ("calibration.the_rest", "the rest of the cut of a worn belt"),
    "pressure_threshold": ("calibration.the_threshold", "the pressure threshold"),
    "ln_saturation": ("calibration.the_saturation", "the saturation pressure"),
    "grit_exponent": ("calibration.grit", "grit"),
    "cut_exponent": ("calibration.remaining_cut", "remaining cut"),
    "first_share": ("calibration.break_in", "the belt's break-in"),
    "ln_first_ratio": ("calibration.break_in", "the belt's break-in"),
    "loading_share": ("calibration.the_loading", "the belt's loading"),
}
PRESSURE = ("pressure_exponent", "area_exponent")  # force and area
LEAST_GRINDS = 4
LEAST_SPREAD = 0.03  # standard deviation of ln(x) from which x varies at all
MOST_CORRELATION = 0.95
MOST_SHARE = math.sqrt(0.5)  # of a prior's deviation, from which it says more than the data
LEAST_ERRORS = 1.64  # standard errors by which a parameter must differ from its default to be told
LEAST_PERCENT = 1.0  # that a simulation removes more or less than the grinds did, to be told


def effect_of(name: str) -> core.Fact:
    """The fact that names what a parameter is the effect of."""
    return core.Fact(*EFFECT[name])


def together(one: str, other: str, correlation: float) -> core.Fact:
    """The warning that the inputs of two parameters move together."""
    return core.Fact(
        "calibration.together",
        "{one} and {other} move together in the data (correlation {correlation:+.2f}), "
        "which hardly separate their effects; vary them separately",
        one=effect_of(one),
        other=effect_of(other),
        correlation=correlation,
    )


def spread_of(values: Floats) -> float:
    """Standard deviation of ln of the finite ones of ``values`` (n,)."""
    values = values[np.isfinite(values)]
    return float(np.std(np.log(values))) if len(values) > 1 else 0.0


def is_told(found: Json, name: str) -> bool:
    """Whether a parameter differs from its default by more than the least number of errors."""
    k = INDEX[name]
    default = DEFAULTS[name]
    if not math.isfinite(default):
        return True
    away = abs(found["parameters"][k] - default)
    return away > LEAST_ERRORS * math.sqrt(found["covariance"][k, k])


def name_inputs(table: Table, warnings: Facts) -> None:
    """Warns of inputs that move together in the data."""
    moving = table.feed > 0
    inputs = {
        "pressure_exponent": table.force,
        "speed_exponent": table.speed,
        "feed_exponent": np.where(moving, table.feed, math.nan),
        "time_exponent": np.where(moving, math.nan, table.time),
        "area_exponent": table.area,
        "ln_wear_scale": np.where(table.wear > 0, table.wear, math.nan),
    }
    names = [name for name, values in inputs.items() if spread_of(values) > LEAST_SPREAD]
    for j, two in enumerate(names):
        for one in names[:j]:
            both = np.isfinite(inputs[one]) & np.isfinite(inputs[two])
            a, b = np.log(inputs[one][both]), np.log(inputs[two][both])
            if both.sum() < LEAST_GRINDS or np.ptp(a) == 0 or np.ptp(b) == 0:
                continue
            correlation = float(np.corrcoef(a, b)[0, 1])
            if abs(correlation) > MOST_CORRELATION and (one, two) == PRESSURE:
                warnings.append(  # as they do under any wheel
                    core.Fact(
                        "calibration.force_and_area",
                        "force and contact area move together in the data: that the mean pressure says "
                        "all of the area is an assumption",
                    )
                )
            elif abs(correlation) > MOST_CORRELATION:
                warnings.append(together(one, two, correlation))


def name_unsure(model: Model, found: Json, free: Sequence[str], warnings: Facts) -> None:
    """Warns of parameters of which the data say less than what was known before."""
    errors = np.sqrt(np.diag(model.posterior(found, free)))
    for name, error in zip(free, errors):
        mean, deviation = PRIORS.get(name, (0.0, math.inf))
        if error < MOST_SHARE * deviation:
            continue
        warnings.append(
            core.Fact(
                "calibration.published_decides",
                "the data leave the effect of {effect} undetermined: the {parameter} of {value:.2f} is "
                "what is published, {mean:g} with a deviation of {deviation:g}, more than what they say",
                effect=effect_of(name),
                parameter=name.replace("_", " "),
                value=found["parameters"][INDEX[name]],
                mean=mean,
                deviation=deviation,
            )
        )


def name_pairs(found: Json, free: Sequence[str], warnings: Facts) -> None:
    """Warns of parameters that the data hardly separate."""
    correlation = correlations(found, free)
    for j in range(1, len(free)):
        for i in range(1, j):
            if abs(correlation[i, j]) > MOST_CORRELATION:
                warnings.append(
                    core.Fact(
                        "calibration.hardly_separate",
                        "the data hardly separate the effects of {one} and {other} (correlation "
                        "{correlation:+.2f})",
                        one=effect_of(free[i]),
                        other=effect_of(free[j]),
                        correlation=correlation[i, j],
                    )
                )


def cautions(model: Model, found: Json, wear_unit: float) -> Facts:
    """What the reader of the result has to know."""
    table, notes = model.table, [*model.table.notes, *areas.caution(model, found)]
    known = np.isfinite(table.relative).all(axis=1)
    percent = 100.0 * (contacts.too_much(found["parameters"][INDEX["pressure_exponent"]]) - 1.0)
    if known.any() and not known.all():
        notes.append(
            core.Fact(
                "calibration.contacts_alike",
                "the contacts of {count} grinds are not known: their pressures are taken as uneven as "
                "those of the others",
                count=int((~known).sum()),
            )
        )
    elif not known.any() and not table.nominal_area and abs(percent) >= LEAST_PERCENT:
        notes.append(
            core.Fact(
                "calibration.mean_pressure",
                "the contacts of the grinds are not known, and the law is fitted to their mean pressures, "
                "F/A: where the pressure of a wheel is uneven, a simulation removes {least:+.0f} to {most:+.0f} % "
                "more than these grinds did; give the columns of the wheel, or the job whose wheel it was",
                least=percent,
                most=2.0 * percent,  # as measured on rims with free side faces
            )
        )
    exponent = found["parameters"][INDEX["time_exponent"]]
    if exponent != 1.0 and is_told(found, "time_exponent"):
        given = {"exponent": exponent, "seconds": model.references["time"]}
        if exponent > 1:
            note = core.Fact(
                "calibration.faster_with_time",
                "removal grows as time^{exponent:.2f}: the law, linear in time, holds for grinds of "
                "about {seconds:g} s; short ones remove less, long ones more",
                **given,
            )
        else:
            note = core.Fact(
                "calibration.slower_with_time",
                "removal grows as time^{exponent:.2f}: the law, linear in time, holds for grinds of "
                "about {seconds:g} s",
                **given,
            )
        notes.append(note)
    delta = found["parameters"][INDEX["area_exponent"]]
    if delta != 0.0 and is_told(found, "area_exponent"):
        notes.append(
            core.Fact(
                "calibration.area_exponent",
                "the mean pressure does not say all of the contact area: removal has a further "
                "factor area^{exponent:+.2f}, which the law cannot carry; it holds at about "
                "{area:g} mm²",
                exponent=delta,
                area=model.references["area"],
            )
        )
    fresh = math.exp(found["parameters"][INDEX["ln_wear_scale"]]) if worn(found) else math.inf
    if table.wear.min() > fresh:
        notes.append(
            core.Fact(
                "calibration.no_fresh_belt",
                "no grind was done on a belt that had worn less than {least:.3g}, where the law falls from "
                "{scale:.3g} on: what it says of a fresh belt is a guess",
                least=float(table.wear.min()),
                scale=fresh,
            )
        )
    if worn(found) and not len(table.free):
        notes.append(
            core.Fact(
                "calibration.loading_unseen",
                "the table does not say how long the belt ran free before each grind (free_s): what loads it, and a pause "
                "gives back, counts as wear",
            )
        )
    if table.wear_kind == "number" and wear_unit == 1.0 and worn(found):
        notes.append(
            core.Fact(
                "calibration.wear_number",
                "the wear number has no unit of its own: the law's wear scale is in that number, "
                "where a job counts work in J; give the joules of one unit (--wear-unit) before "
                "use in a job",
            )
        )
    return notes
