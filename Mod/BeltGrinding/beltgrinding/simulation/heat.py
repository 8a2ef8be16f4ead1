"""The heat in a part while a job grinds it, where the job says what the material is."""

from __future__ import annotations


from dataclasses import replace
from ..base.kinds import Context, Facts, Json
from ..engine import core
from ..inspection import heat as figures
from ..inspection import verdict as verdicts
from ..job.engine_input import HeatInput
from ..job.settings import Job
from ..job.typed import typed


def options(
    job: Job | Json,
    field: core.HeightField,
    shape: core.Shape,
    warnings: Facts,
    context: Context = None,
) -> HeatInput | None:
    """What core.simulate takes as ``heat``, with a core.PartHeat that has seen none yet; None for a job
    without ``heat``, or one whose rigid tool has no pressure, which is told. Raises InputError and Cancelled.
    """
    job = typed(job)
    given = job.heat
    if given is None:
        return None
    if job.law.model == "geometric":
        warnings.append(
            core.Fact(
                "simulation.no_heat_of_rigid",
                "a geometric (rigid) tool has no pressure: no temperatures are computed",
            )
        )
        return None
    part = core.PartHeat(
        field,
        float(job.belt_machine.contact_spacing_mm),
        float(given.conductivity_W_mK),
        float(given.heat_capacity_J_kgK),
        float(given.density_kg_m3),
    )
    notes: Facts = []
    others = verdicts.other_faces(job, field, shape, notes, context)
    warnings += notes
    part.set_thickness(core.measure_thickness(field, part.samples, others, context)[0])
    if not given.burn_temperature_C:
        warnings.append(
            core.Fact(
                "simulation.no_burn_temperature",
                "{key} is not given: temperatures are computed, but not judged",
                key="heat.burn_temperature_C",
            )
        )
    low, likely, high = figures.shares(given)
    return HeatInput(
        part=part,
        friction=figures.middle(given.friction),
        partition=figures.middle(given.partition),
        low=low / likely,
        high=high / likely,
        start=given.start_temperature_C,
        burn=given.burn_temperature_C,
    )


def plain(heated: HeatInput | None) -> HeatInput | None:
    """What ``options`` returned, for a digest: of a core.PartHeat what it was made of, with the field."""
    if heated is None:
        return None
    part = heated.part
    made_of = (part.spacing, part.conductivity, part.heat_capacity, part.density, part.thickness)
    return replace(heated, part=made_of)
