"""What finish grinding left on a part: figures of the roughness and the lay that a result holds by sample, and whether
they are what zones call for. Terms of ISO 21920-1 and ISO 1302: Ra, lay and its symbols.
"""

from __future__ import annotations
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..base.kinds import Array, Facts, Floats, Json
from ..engine import core
from ..job.settings import Finish, FinishModel, Job
from ..job.typed import typed

if TYPE_CHECKING:
    from ..cell.motions import Motions

__all__ = [
    "crossed",
    "crossed_of",
    "figures",
    "notes",
    "rest_per_pass",
    "roughness",
    "text",
    "widened",
]

SLACK = 0.03  # of a range of measurements: what counts as the same
SEEN = 0.05  # share of an earlier pass from which its scratches are seen
NORMAL_95 = 1.96  # standard deviations that hold 95 %
OUTSIDE = ("pressure", "belt speed", "feed", "belt wear")  # as core numbers them, from 1
CODES = {  # of the facts that name them
    "pressure": ("calibration.the_pressure", "the mean pressure"),
    "belt speed": ("calibration.the_speed", "the belt's speed"),
    "feed": ("calibration.the_feed", "the feed"),
    "belt wear": ("calibration.the_wear", "the belt's wear"),
}


def widened(span: Sequence[float]) -> tuple[float, float]:
    """A range of what was measured, by what counts as the same."""
    return span[0] * (1.0 - SLACK), span[1] * (1.0 + SLACK)


def rest_per_pass(given: Finish) -> float | None:
    """Share of the roughness before that a pass leaves, of a job's ``finish``; None: not known."""
    if given.rest_per_pass is not None or given.model is None:
        return given.rest_per_pass
    return given.model.rest_per_pass


def roughness(field: core.HeightField) -> Floats | None:
    """(n,) Ra of every sample, um; NaN where it is not known. None where no finish was computed."""
    return None if field.finish is None else np.asarray(field.finish["roughness"], dtype=float)


def crossed(
    field: core.HeightField, rest: float | None, angle_deg: float
) -> NDArray[np.bool_] | None:
    """(n,) whether scratches of the last two passes cross by ``angle_deg`` or more and both are seen; None where that
    is not known. ``rest``: as ``rest_per_pass`` gives it.
    """
    if field.finish is None or rest is None:
        return None
    crossing = np.nan_to_num(np.asarray(field.finish["crossing"], dtype=float))
    return (crossing >= math.radians(angle_deg)) & (rest >= SEEN)


def crossed_of(job: Job | Json, field: core.HeightField) -> NDArray[np.bool_] | None:
    """``crossed`` by a job's ``finish``; None without."""
    given = typed(job).finish
    if given is None:
        return None
    return crossed(field, rest_per_pass(given), given.crossing_angle_deg)


def figures(
    job: Job | Json, field: core.HeightField, motions: Motions | None = None
) -> dict[str, Any] | None:
    """The dict of a verdict's ``finish``; None where none was computed. ``motions``: as ``motions.of_paths`` gives
    them, or None.
    """
    job = typed(job)
    given = job.finish
    if given is None or field.finish is None:
        return None
    areas = np.asarray(field.areas, dtype=float)
    ground = np.asarray(field.finish["passes"]) > 0
    found, across = np.asarray(field.finish["roughness"], dtype=float), crossed_of(job, field)
    known = ground & np.isfinite(found)
    outside = np.asarray(field.finish["outside"])
    whole = float(areas[ground].sum())
    part = lambda chosen: float(areas[ground & chosen].sum())
    share = lambda chosen: min(part(chosen) / whole, 1.0) if whole > 0.0 else 0.0
    model = given.model
    return {
        "initial_Ra_um": given.initial_Ra_um,
        "grit": given.grit,
        "source": model.source if model else None,
        "rest_per_pass": rest_per_pass(given),
        "crossing_angle_deg": given.crossing_angle_deg,
        "ground_area_mm2": whole,
        "known_share": share(known),
        "outside_shares": {
            name.replace(" ", "_"): share(outside == k) for k, name in enumerate(OUTSIDE, 1)
        },
        "Ra_um": _spread(found[known], areas[known]) if known.any() else None,
        "ln_deviation": model.ln_deviation if model else None,
        "worst": _worst(field, found, known, model, motions) if known.any() else None,
        "crossed_share": None if across is None else share(across),
    }


def _spread(values: Floats, areas: Floats) -> dict[str, float]:
    order = np.argsort(values)
    summed = np.cumsum(areas[order])
    high = values[order][min(int(np.searchsorted(summed, 0.95 * summed[-1])), len(order) - 1)]
    mean = float(np.average(values, weights=areas)) if summed[-1] > 0.0 else float(values.mean())
    return {
        "min": float(values.min()),
        "mean": mean,
        "p95": float(high),
        "max": float(values.max()),
    }


def _worst(
    field: core.HeightField,
    found: Floats,
    known: Array,
    model: FinishModel | None,
    motions: Motions | None,
) -> dict[str, Any]:
    index = int(np.flatnonzero(known)[found[known].argmax()])
    factor = math.exp(NORMAL_95 * ((model.ln_deviation if model else None) or 0.0))
    return {
        "Ra_um": float(found[index]),
        "least_um": float(found[index] / factor),
        "greatest_um": float(found[index] * factor),
        **place(field, index, motions),
    }


def place(field: core.HeightField, sample: int, motions: Motions | None) -> dict[str, Any]:
    """Where a sample of a field with a finish lies and which motion passed last over it, as a verdict has it; None
    where no pass of this run was, or where that is not known.
    """
    number = int(field.finish["motion"][sample])
    motion = None if number == core.NEVER else number
    told = motion is not None and motions is not None and motion < len(motions["program"])
    of = motions if told else None
    return {
        "sample": int(sample),
        "point_mm": [float(x) for x in field.points[sample]],
        "face": int(field.faces[sample]) + 1,
        "motion": motion,
        "program": int(of["program"][motion]) if of else None,
        "line": int(of["line"][motion]) or None if of else None,
    }


def notes(job: Job | Json, field: core.HeightField) -> Facts:
    """Facts of what is not known of the finish."""
    job = typed(job)
    found = figures(job, field)
    given = job.finish
    if found is None or given is None or given.model is None:
        return []
    told = [
        core.Fact(
            "inspection.finish_outside",
            "{percent:.1f} % of the ground area has no roughness: {what} of its last pass lies outside of what was "
            "measured",
            percent=100.0 * found["outside_shares"][name.replace(" ", "_")],
            what=core.Fact(*CODES[name]),
        )
        for name in OUTSIDE
        if found["outside_shares"][name.replace(" ", "_")] > 0.0
    ]
    unsettled = 1.0 - found["known_share"] - sum(found["outside_shares"].values())
    if not (found["ground_area_mm2"] > 0.0 and unsettled > 1e-6):
        return told
    if given.initial_Ra_um is not None:
        told.append(
            core.Fact(
                "inspection.finish_pass_before",
                "{percent:.1f} % of the ground area has no roughness: too much is left there of a pass before the last, "
                "which lay outside of what was measured",
                percent=100.0 * unsettled,
            )
        )
    else:
        told.append(
            core.Fact(
                "inspection.finish_unsettled",
                "{percent:.1f} % of the ground area has no roughness: too much is left there of what was before, which "
                "is not known ({key})",
                percent=100.0 * unsettled,
                key="finish.initial_Ra_um",
            )
        )
    return told


def text(finish: Json, programs: Sequence[Json]) -> str:
    """A line in words; ``programs``: of the verdict."""
    lines = []
    worst, spread = finish["worst"], finish["Ra_um"]
    if worst is None:
        lines.append("  roughness: not known")
    else:
        told = (
            f"  roughness: Ra {spread['min']:.2f} to {spread['max']:.2f} µm, mean {spread['mean']:.2f} µm, known on "
            f"{100 * finish['known_share']:.1f} % of the ground area; most on face {worst['face']}"
        )
        if finish["ln_deviation"]:
            told += f" (95 %: {worst['least_um']:.2f} to {worst['greatest_um']:.2f} µm)"
        if worst["line"] is not None and worst["program"] is not None:
            told += f", by {Path(programs[worst['program']]['name']).name}, line {worst['line']}"
        lines.append(told)
    if finish["crossed_share"] is not None:
        lines.append(
            f"  crossed scratches on {100 * finish['crossed_share']:.1f} % of the ground area"
        )
    return "\n".join(lines)
