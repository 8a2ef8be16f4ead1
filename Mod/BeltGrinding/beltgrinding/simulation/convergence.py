"""Are a job's settings fine enough? The job run coarser, as given and finer, and what that says of the
error of every figure of the verdict.

Richardson extrapolation over three levels with a constant ratio (Roache, Perspective: a method for
uniform reporting of grid refinement studies, J. Fluids Engineering 116, 1994; Celik et al., Procedure
for estimation and reporting of uncertainty due to discretization in CFD applications, J. Fluids
Engineering 130, 2008). Where the three values do not converge monotonically, their range.
"""

from __future__ import annotations

import copy
import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json
from ..base.messages import fact_data
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import resolution, spacing
from ..job.workpiece import check_faces, read_design
from . import run as runs
from .convergence_record import BAND_SHARE, LEVELS, assessed, digest, limits_digest

if TYPE_CHECKING:
    from .result import Result

RATIO = 2.0  # between the levels
SETTINGS = {  # what is refined: name, keys of the job
    "spacing": (("sampling", "spacing_mm"),),
    "step": (("simulation", "max_travel_mm"), ("simulation", "max_angle_deg")),
    "contact_grid": (("belt_machine", "contact_spacing_mm"),),
}

FAILED = {  # a note on one that failed
    "coarse": ("simulation.no_coarse_level", "the coarse level could not be run: {reason}"),
    "fine": ("simulation.no_fine_level", "the fine level could not be run: {reason}"),
}
OF_AREA = {"p50_mm": 0.5, "p95_mm": 0.95, "p99_mm": 0.99, "max_mm": 1.0}  # errors below which it is
COST = {"coarse": 0.125, "given": 1.0, "fine": 8.0}  # of a run: samples and steps, by the ratio
ORDERS = (0.5, 2.0)  # observed orders outside are taken as these: beyond, they are chance
SAFETY = 1.25  # on three levels (Roache)
SAFETY_TWO = 3.0  # on two levels, the order taken as 1 (Roache)
ROUNDING = 1e-9  # relative: differences below it are none


def converge(job: Json, context: Context = None) -> Result:
    """Runs a validated job at twice, once and half its sampling spacing, steps and contact cells.

    Returns (the job's ``Result``, whose ``convergence`` is the dict that convergence.json holds: see
    Resources/schema/convergence.schema.json). A level that cannot be run is left out, and said. Where
    the settings are not fine enough, each of them is coarsened alone as well, to tell which matters.
    Takes about ten times as long as the job. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    if resolution.mode(job) != resolution.FULL:
        raise InputError(
            "simulation.coarse_check",
            "{key}: a coarse job's settings are not checked; set it to full",
            key="resolution.mode",
        )
    if job["sampling"]["spacing_mm"] == 0:
        shape = read_design(job["design"], context.part(0.0, 0.0))
        check_faces(job, shape)
        job, _ = spacing.settled(job, shape, [], context.part(0.0, 0.0))
    whole, so_far = sum(COST.values()) + 2.0, 0.0
    inspection = job["inspection"]
    levels: dict[str, dict[str, Any] | None] = {}
    heights: dict[str, Floats] = {}
    result: Result | None = None
    notes: Facts = []
    for level in ("given", "coarse", "fine"):
        end = so_far + COST[level]
        part = context.part(so_far / whole, end / whole)
        start = time.perf_counter()
        try:
            found: Result | None = runs.run(scaled(job, level), part, resume=level == "given")
        except (InputError, MemoryError) as error:
            if level == "given":
                raise
            reason: object = error
            if isinstance(error, MemoryError):
                reason = core.Fact("simulation.out_of_memory", "out of memory")
            code, text = FAILED[level]
            notes.append(core.Fact(code, text, reason=reason))
            levels[level] = None
        else:
            assert found is not None
            levels[level] = _level(found, time.perf_counter() - start)
            result = found if level == "given" else result
            assert result is not None
            try:
                heights[level] = _heights_at(result.field, found.field, part)
            except InputError:  # its samples lie elsewhere: no errors by this level
                pass
        so_far = end
        found = None  # a fine field is large
    assert result is not None
    answer = {
        "job_sha256": digest(job),
        "ratio": RATIO,
        "tolerance_mm": list(inspection["tolerance_mm"]),
        "band_share": BAND_SHARE,
        "levels": {name: _settings(job, name, levels[name]) for name in LEVELS},
        "quantities": _quantities(levels),
        "samples": _of_samples(result, heights, limits_digest(inspection)),
        "settings": None,
        "notes": notes,
    }
    answer = assessed(answer, inspection)
    if not answer["fine_enough"]:
        context.report(so_far / whole)
        rest = context.part(so_far / whole, 1.0)
        answer["settings"] = _blame(job, levels["given"], rest, notes)
    answer["note_facts"] = [fact_data(note) for note in notes]
    result.convergence = answer
    context.report(1.0)
    return result


def scaled(job: Json, level: str, only: str | None = None) -> dict[str, Any]:
    """A copy of a job at a level; ``only``: the one of ``SETTINGS`` that is changed."""
    factor = RATIO ** (1 - LEVELS.index(level))
    changed: dict[str, Any] = copy.deepcopy(dict(job))
    for name, keys in SETTINGS.items():
        if only is None or name == only:
            for part, key in keys:
                changed[part][key] *= factor
    if only in (None, "spacing"):  # chords bulge by the square of their length
        changed["sampling"]["edge_spacing_mm"] *= factor
        changed["sampling"]["precision_mm"] *= factor**2
    return changed


def _level(result: Result, seconds: float) -> dict[str, Any]:
    """The figures of a run that are compared: name, unit, value."""
    summary = result.summary
    figures: dict[tuple[str, str, int | None], float] = {}
    figures[("removed_volume", "mm3", None)] = summary["removed_volume_mm3"]
    for name, value in summary["deviation_mm"].items():
        figures[(name, "mm", None)] = value
    figures[("in_tolerance", "share", None)] = summary["in_tolerance_area_share"]
    field = result.field
    seen = (field.flags & core.MISSED) == 0
    faces, heights = field.faces[seen], field.height[seen]
    for face in np.unique(faces):
        own = heights[faces == face]
        figures[("face_min", "mm", int(face) + 1)] = float(own.min())
        figures[("face_max", "mm", int(face) + 1)] = float(own.max())
    return {
        "figures": figures,
        "samples": summary["samples"],
        "steps": summary["steps"],
        "seconds": seconds,
    }


def _settings(job: Json, level: str, run: Json | None) -> dict[str, Any] | None:
    """A level's settings and size; None where it could not be run."""
    if run is None:
        return None
    job = scaled(job, level)
    return {
        **{key: job[part][key] for keys in SETTINGS.values() for part, key in keys},
        "samples": run["samples"],
        "steps": run["steps"],
        "wall_time_s": run["seconds"],
    }


def _quantities(levels: Mapping[str, Any]) -> list[dict[str, Any]]:
    found = []
    for key in levels["given"]["figures"]:
        name, unit, face = key
        values = [levels[level]["figures"].get(key) if levels[level] else None for level in LEVELS]
        found.append({"name": name, "face": face, "unit": unit, "values": values})
        found[-1].update(estimate(*values))
    return found


def estimate(coarse: float | None, given: float, fine: float | None) -> dict[str, Any]:
    """dict(behaviour, order, error) of a quantity by its values at three levels, None where a level
    has none. ``error``: estimate of |given - exact| in the quantity's unit, on the safe side.
    """
    if coarse is None:  # f(h) - f(0) = 2 (f(h) - f(h/2)) at order 1
        if fine is None:
            return {"behaviour": "unknown", "order": None, "error": None}
        error = SAFETY_TWO * RATIO / (RATIO - 1.0) * abs(fine - given)
        return {"behaviour": "two levels", "order": None, "error": error}
    if fine is None:
        error = SAFETY_TWO / (RATIO - 1.0) * abs(given - coarse)
        return {"behaviour": "two levels", "order": None, "error": error}
    step, before = fine - given, given - coarse
    size = ROUNDING * max(abs(coarse), abs(given), abs(fine))
    if abs(step) <= size:
        return {"behaviour": "exact", "order": None, "error": max(abs(step), abs(before))}
    if abs(before) <= size or not 0.0 < step / before < 1.0:
        three = (coarse, given, fine)
        behaviour = "diverging" if abs(step) >= abs(before) else "oscillating"
        return {"behaviour": behaviour, "order": None, "error": max(three) - min(three)}
    order = -math.log(step / before) / math.log(RATIO)
    grown = RATIO ** min(max(order, ORDERS[0]), ORDERS[1])
    error = SAFETY * abs(step) * grown / (grown - 1.0)
    return {"behaviour": "monotonic", "order": order, "error": error}


def _heights_at(
    field: core.HeightField, other: core.HeightField, context: core.RunContext
) -> Floats:
    """(samples,) mm that another field of the same design has at the samples of ``field``, NaN where it has none. Raises
    InputError where it hardly has any, Cancelled."""
    at = field
    if other is not field:
        at = field.copy()
        core.apply_left(at, other, False, context)
    missed = (np.asarray(at.flags) & core.MISSED) != 0
    return np.where(missed, np.nan, np.asarray(at.height, dtype=float))


def errors(coarse: Floats | None, given: Floats, fine: Floats | None) -> Floats | None:
    """(n,) as ``estimate`` has it, of heights (n,) at three levels."""
    if coarse is None or fine is None:
        if coarse is fine is None:
            return None
        factor = RATIO if coarse is None else 1.0
        other = fine if coarse is None else coarse
        assert other is not None
        return SAFETY_TWO * factor / (RATIO - 1.0) * np.asarray(abs(given - other))
    step, before = fine - given, given - coarse
    with np.errstate(divide="ignore", invalid="ignore"):
        shrinks = before / step
        grown = np.clip(shrinks, *(RATIO**order for order in ORDERS))
        settled = SAFETY * abs(step) * grown / (grown - 1.0)
    spread = np.ptp([coarse, given, fine], axis=0)
    return np.where(shrinks > 1.0, settled, spread)


def _of_samples(
    result: Result, heights: Mapping[str, Floats], limits: str
) -> dict[str, Any] | None:
    """The errors of the heights over the area, and of how much of it they leave open whether it is in tolerance."""
    found = errors(heights.get("coarse"), heights["given"], heights.get("fine"))
    if found is None:
        return None
    field = result.field
    seen = np.isfinite(found)
    if not seen.any():
        return None
    height, areas = heights["given"][seen], np.asarray(field.areas, dtype=float)[seen]
    error: Floats = found[seen]
    lower, upper = (limit[seen] for limit in verdicts.limits(result.job, field))
    nearest = np.minimum(abs(height - lower), abs(height - upper))
    order = np.argsort(error)
    summed = np.cumsum(areas[order]) / areas.sum()
    last = np.minimum(np.searchsorted(summed, list(OF_AREA.values())), len(error) - 1)
    below = dict(zip(OF_AREA, error[order][last].tolist()))
    return {
        **below,
        "undecided_share": float(areas[nearest <= error].sum() / areas.sum()),
        "limits_sha256": limits,
    }


def _blame(
    job: Json, given: Any, context: core.RunContext, notes: Facts
) -> dict[str, float | None]:
    """How far each setting moves the deviations when it alone is coarsened: {name: mm}, the greatest
    change among the figures in mm.
    """
    found: dict[str, float | None] = {}
    for k, name in enumerate(SETTINGS):
        part = context.part(k / len(SETTINGS), (k + 1) / len(SETTINGS))
        try:
            run = _level(runs.run(scaled(job, "coarse", name), part, resume=False), 0.0)
        except InputError as error:
            notes.append(
                core.Fact(
                    "simulation.not_coarser",
                    "{setting} alone could not be made coarser: {reason}",
                    setting=name,
                    reason=error,
                )
            )
            found[name] = None
            continue
        changes = [
            abs(run["figures"][key] - value)
            for key, value in given["figures"].items()
            if key[1] == "mm" and key in run["figures"]
        ]
        found[name] = max(changes)
    return found
