"""What the heat of grinding did to a part: figures of the temperatures that a result holds by sample."""

from __future__ import annotations
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Floats, Json, known
from ..engine import core
from ..job.settings import Heat, Job
from ..job.typed import typed

if TYPE_CHECKING:
    from ..cell.motions import Motions

__all__ = ["figures", "middle", "shares", "temperatures", "text"]


def middle(span: Sequence[float]) -> float:
    """What is taken of a range of numbers."""
    return 0.5 * (span[0] + span[1])


def shares(heat: Heat) -> tuple[float, float, float]:
    """(least, likely, greatest) share of the belt's power p V_b that flows into the work, by the ranges of a job's
    ``heat``: friction times partition. Temperatures are in proportion to it.
    """
    least, most = (heat.friction[k] * heat.partition[k] for k in (0, 1))
    return least, middle(heat.friction) * middle(heat.partition), most


def temperatures(job: Job | Json, field: core.HeightField) -> Floats | None:
    """(n,) likely greatest temperature of every sample, degrees C; None where none were computed."""
    job = typed(job)
    heat = job.heat
    if heat is None or field.heat is None:
        return None
    return heat.start_temperature_C + np.asarray(field.heat["rise"], dtype=float)


def figures(
    job: Job | Json, field: core.HeightField, motions: Motions | None = None
) -> dict[str, Any] | None:
    """The dict of a verdict's ``heat``; None where no temperatures were computed. ``motions``: as
    ``motions.of_paths`` gives them, or None.
    """
    job = typed(job)
    found = temperatures(job, field)
    if found is None:
        return None
    heat = known(job.heat)
    start, burn = heat.start_temperature_C, heat.burn_temperature_C
    least, likely, most = shares(heat)
    index = int(found.argmax())
    rise = found - start
    areas = np.asarray(field.areas, dtype=float)

    def burnt(share: float) -> float:
        """Of the area."""
        over = start + share / likely * rise > burn
        return min(float(areas[over].sum() / areas.sum()), 1.0)

    motion = int(field.heat["motion"][index])
    of = motions if motion != core.NEVER else None
    worst = {
        "temperature_C": float(found[index]),
        "least_C": float(start + least / likely * rise[index]),
        "greatest_C": float(start + most / likely * rise[index]),
        "sample": index,
        "point_mm": [float(x) for x in field.points[index]],
        "face": int(field.faces[index]) + 1,
        "motion": None if motion == core.NEVER else motion,
        "program": int(of["program"][motion]) if of else None,
        "line": int(of["line"][motion]) or None if of else None,
    }
    judged = burn > 0.0
    return {
        "material": heat.material,
        "start_C": float(start),
        "burn_C": float(burn) if judged else None,
        "burn_source": heat.burn_source,
        "worst": worst,
        "burnt_share": burnt(likely) if judged else None,
        "perhaps_burnt_share": burnt(most) if judged else None,
    }


def text(heat: Json, programs: Sequence[Json]) -> str:
    """A line in words; ``programs``: of the verdict."""
    worst = heat["worst"]
    told = (
        f"  hottest: {worst['temperature_C']:.0f} °C ({worst['least_C']:.0f} to {worst['greatest_C']:.0f} °C: "
        f"friction and partition are uncertain) on face {worst['face']}"
    )
    if worst["line"] is not None and worst["program"] is not None:
        told += f", by {Path(programs[worst['program']]['name']).name}, line {worst['line']}"
    if heat["burn_C"] is None:
        return told + "; no limit is known"
    return told + (
        f"; limit {heat['burn_C']:.0f} °C: {100 * heat['burnt_share']:.2f} % of the area above, "
        f"{100 * heat['perhaps_burnt_share']:.2f} % if the heat is the most that it may be"
    )
