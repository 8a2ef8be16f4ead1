"""The finish of a part while a job grinds it, where the job asks for it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..base import records
from ..base.kinds import Facts, Json, known
from ..engine import InputError, core
from ..inspection import finish as figures
from ..job.engine_input import FinishInput
from ..job.settings import Finish, FinishModel, Job
from ..job.typed import typed


SMALLEST = 1e-4  # of what a range begins with, 0 included
GREATEST = 46.0  # ln of Ra in µm: 1e-20 to 1e20


def check_grit(given: Finish | Json) -> None:
    """Raises InputError where the grit of a job's ``finish`` is none that its model's measurements cover."""
    given = records.made(Finish, given)
    span, grit = known(given.model).ranges.grit, known(given.grit)
    low, high = figures.widened(span)
    if not low <= grit <= high:
        raise InputError(
            "job.grit_not_measured",
            "{key}: a grit of {grit:g} was not measured (from {low:g} to {high:g}): its roughness is not known",
            key="finish.grit",
            grit=grit,
            low=span[0],
            high=span[1],
        )


def check_spread(model: FinishModel | Json, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Raises InputError for exponents that lead to roughnesses which no surface has, in the ranges of the measurements
    themselves."""
    model = records.made(FinishModel, model)
    least = most = math.log(model.coefficient_um)
    for name, exponent, reference in (
        ("grit", "grit_exponent", model.reference_grit),
        ("pressure_MPa", "pressure_exponent", model.reference_pressure_MPa),
        ("belt_speed_m_s", "belt_speed_exponent", model.reference_belt_speed_m_s),
        ("feed_mm_s", "feed_exponent", model.reference_feed_mm_s),
        ("remaining_cut", "wear_exponent", 1.0),
    ):
        ends = [
            getattr(model, exponent) * math.log(max(end, SMALLEST) / reference)
            for end in ranges[name]
        ]
        least, most = least + min(ends), most + max(ends)
    if not -GREATEST <= least <= most <= GREATEST:
        raise InputError(
            "job.finish_spread",
            "{key}: in the ranges of the measurements it tells Ra from {least:.3g} to {most:.3g} µm, which is no surface; "
            "look at its exponents",
            key="finish.model",
            least=math.exp(max(least, -700.0)),
            most=math.exp(min(most, 700.0)),
        )


def options(job: Job | Json, warnings: Facts) -> FinishInput | None:
    """What core.simulate takes as ``finish``; None for a job without ``finish``, or one whose rigid tool has no
    pressure, which is told. Raises InputError for a grit that was not measured.
    """
    job = typed(job)
    given = job.finish
    if given is None:
        return None
    if job.law.model == "geometric":
        warnings.append(
            core.Fact(
                "simulation.no_finish_of_rigid",
                "a geometric (rigid) tool has no pressure: no finish is computed",
            )
        )
        return None
    found: dict[str, Any] = {}
    if given.initial_Ra_um is not None:
        found["before"] = float(given.initial_Ra_um)
    rest = figures.rest_per_pass(given)
    if rest is not None:
        found["rest"] = float(rest)
    model = given.model
    if model is None:
        warnings.append(
            core.Fact(
                "simulation.no_finish_model",
                "{key} is not given: the direction of the scratches is computed, but no roughness, which only "
                "measurements tell (beltgrind calibrate-finish)",
                key="finish.model",
            )
        )
        return FinishInput(**found, roughness=0.0)
    ranges = {key: figures.widened(span) for key, span in records.plain(model.ranges).items()}
    check_grit(given)
    if rest is None:
        warnings.append(
            core.Fact(
                "simulation.no_rest_per_pass",
                "{key} is not known: each pass is taken to leave its own roughness, and whether crossed scratches stay "
                "is not told",
                key="finish.rest_per_pass",
            )
        )
    factor = (known(given.grit) / model.reference_grit) ** model.grit_exponent
    check_spread(model, ranges)
    slow, fast = ranges["belt_speed_m_s"]
    return FinishInput(
        **found,
        roughness=model.coefficient_um * factor,
        pressure_exponent=model.pressure_exponent,
        speed_exponent=model.belt_speed_exponent,
        feed_exponent=model.feed_exponent,
        cut_exponent=model.wear_exponent,
        reference_pressure=model.reference_pressure_MPa,
        reference_speed=1000.0 * model.reference_belt_speed_m_s,
        reference_feed=model.reference_feed_mm_s,
        pressure=ranges["pressure_MPa"],
        speed=(1000.0 * slow, 1000.0 * fast),
        feed=ranges["feed_mm_s"],
        cut=ranges["remaining_cut"],
    )
