"""Whether the finish of zones is what they call for: roughness and lay by the terms of ISO 21920-1 and ISO 21920-3, with the
worst place of what is not, and the most frequent reason of what is not known.
"""

from __future__ import annotations
import math
from collections.abc import Callable
from typing import TypeAlias, TYPE_CHECKING, Any

import numpy as np

from ..base import records
from ..base.kinds import Array, Floats, Json
from ..job.settings import Job, ZoneFinish
from ..job.typed import typed
from .finish import OUTSIDE, crossed_of, place, roughness

if TYPE_CHECKING:
    from ..cell.motions import Motions
    from ..engine import core

SIXTEEN_PERCENT = 0.16  # ISO 21920-3
CROSSED = ("X", "M")  # lays of several directions
ROUNDING = 1e-6  # of a roughness that is kept in single precision
LEAST_TRACE = 1e-6  # of a direction on the surface, that it tells one there
# Why something is not known; those of ``OUTSIDE`` have the numbers that core gives them.
Why: TypeAlias = "Callable[[Array, Array], Array]"  # as ``_unknown`` takes it
REASONS = (
    "not_computed",
    *(name.replace(" ", "_") for name in OUTSIDE),
    *("no_pass", "no_model", "unsettled", "pass_before", "no_direction", "no_rest"),
)


def allowed_share(acceptance: str) -> float:
    """Of the area, that may lie beyond by the acceptance rule of that name."""
    return SIXTEEN_PERCENT if acceptance == "T16%" else 0.0


def judge_zones(
    job: Job | Json, field: core.HeightField, zone_of: Array, motions: Motions | None = None
) -> list[dict[str, Any] | None]:
    """[what ``judge_zone`` tells, or None where nothing is called for] of every zone of a job; ``zone_of``: (n,) number of
    the zone of each sample. ``motions``: as ``motions.of_paths`` gives them, or None.
    """
    job = typed(job)
    return [
        (
            judge_zone(job, field, zone.finish, np.flatnonzero(zone_of == number), motions)
            if zone.finish is not None
            else None
        )
        for number, zone in enumerate(job.inspection.zones)
    ]


def judge_zone(
    job: Job | Json,
    field: core.HeightField,
    asked: ZoneFinish | Json,
    samples: Array,
    motions: Motions | None = None,
) -> dict[str, Any]:
    """What the finish of a zone is like, a dict; ``asked``: the zone's ``finish``, ``samples``: (k,) of the zone."""
    job, asked = typed(job), records.made(ZoneFinish, asked)
    areas = np.asarray(field.areas, dtype=float)[samples]
    whole = float(areas.sum())
    part = lambda chosen: float(areas[chosen].sum())
    share = lambda chosen: min(part(chosen) / whole, 1.0) if whole > 0.0 else 0.0
    allowed = allowed_share(asked.acceptance)
    verdicts: list[tuple[dict[str, Any], str]] = []
    judged: dict[str, Any] = {"acceptance": asked.acceptance}
    limit = asked.Ra_max_um
    if limit is not None:
        judged["Ra"] = _judge_roughness(job, field, limit, allowed, samples, share, motions)
        verdicts.append((judged["Ra"], "above_share"))
    if asked.lay is not None:
        judged["lay"] = _judge_lay(job, field, asked, samples, share, motions)
        verdicts.append((judged["lay"], "off_share"))
    for one, beyond in verdicts:
        one["verdict"] = _word(one[beyond], one["unknown_share"], allowed, whole)
        if not whole > 0.0:
            one["unknown"] = {"reason": "no_sample", "place": None}
    words = [one["verdict"] for one, _ in verdicts]
    judged["verdict"] = next((w for w in ("fail", "unknown", "pass") if w in words), "unknown")
    return judged


def heights(zone: Json) -> str:
    """What a zone of a verdict is by its heights alone: "pass", "fail" or "unknown"."""
    if zone["above_share"] + zone["below_share"] > 0.0:
        return "fail"
    return "unknown" if zone["worst"] is None or zone["missed_rays"] else "pass"


def without(zone: Json) -> str:
    """What it is by all but its finish."""
    words = (heights(zone), (zone["thickness"] or {}).get("verdict", "pass"))
    return next(word for word in ("fail", "unknown", "pass") if word in words)


def decides(verdict: Json) -> int:
    """How many zones a verdict hangs on by their finish alone: all else is good. 0: on none."""
    if any(one["verdict"] != "pass" for one in verdict["faces"]):
        return 0
    bad = [zone for zone in verdict["zones"] if zone["verdict"] != "pass"]
    if not all(zone.get("finish") and without(zone) == "pass" for zone in bad):
        return 0
    return sum(zone["verdict"] == verdict["overall"] for zone in bad)


def _word(off: float, unknown: float, allowed: float, whole: float) -> str:
    if off > allowed:
        return "fail"
    return "unknown" if off + unknown > allowed or not whole > 0.0 else "pass"


def _judge_roughness(
    job: Job,
    field: core.HeightField,
    limit: float,
    allowed: float,
    samples: Array,
    share: Callable[[Array], float],
    motions: Motions | None,
) -> dict[str, Any]:
    values = np.full(len(samples), np.nan)
    touched = np.zeros(len(samples), dtype=bool)
    if field.finish is not None:
        values = np.asarray(field.finish["roughness"], dtype=float)[samples]
        touched = np.asarray(field.finish["passes"])[samples] > 0
    known = np.isfinite(values)
    above = np.nan_to_num(values) > limit * (1.0 + ROUNDING)
    worst = None
    if above.any():
        # What no pass has touched is rough as it was: it counts where the rest would do.
        rough = above & touched if share(above & touched) > allowed else above
        k = int(np.flatnonzero(rough)[values[rough].argmax()])
        worst = {"Ra_um": float(values[k]), **place(field, samples[k], motions)}
    return {
        "limit_um": limit,
        "max_um": float(values[known].max()) if known.any() else None,
        "above_share": share(above),
        "untouched_share": share(above & ~touched),
        "unknown_share": share(~known),
        "worst": worst,
        "unknown": _unknown(field, samples[~known], _why_not_rough(job), motions),
    }


def _why_not_rough(job: Job) -> Why:
    """``why`` of ``_unknown`` for a roughness."""
    given, rest = job.finish, "unsettled"
    if given is None or given.model is None:
        rest = "no_model"
    elif given.initial_Ra_um is not None:  # what is not known is left by a pass
        rest = "pass_before"

    def why(passes: Array, outside: Array) -> Array:
        found = np.where(outside > 0, outside, REASONS.index(rest))
        return np.where(passes > 0, found, REASONS.index("no_pass"))

    return why


def _judge_lay(
    job: Job,
    field: core.HeightField,
    asked: ZoneFinish,
    samples: Array,
    share: Callable[[Array], float],
    motions: Motions | None,
) -> dict[str, Any]:
    angle, crossing, off, unknown, rest = _lay(job, field, asked, samples)
    no_pass, why = REASONS.index("no_pass"), REASONS.index(rest)
    worst = None
    if off.any():
        # Farthest from what is called for; of crossed scratches, least or most crossed.
        apart = -np.nan_to_num(crossing) if asked.lay in CROSSED else angle
        if asked.lay not in CROSSED and not (off & (angle > _tolerance(asked))).any():
            apart = np.nan_to_num(crossing)
        k = int(np.flatnonzero(off)[apart[off].argmax()])
        degrees = lambda value: float(math.degrees(value)) if math.isfinite(value) else None
        worst = {
            "angle_deg": degrees(angle[k]),
            "crossing_deg": degrees(crossing[k]),
            **place(field, samples[k], motions),
        }
    return {
        "symbol": asked.lay,
        "off_share": share(off),
        "unknown_share": share(unknown),
        "worst": worst,
        "unknown": _unknown(
            field, samples[unknown], lambda passes, _: np.where(passes > 0, why, no_pass), motions
        ),
    }


def _tolerance(asked: ZoneFinish) -> float:
    return math.radians(asked.lay_tolerance_deg) + 1e-9


def _lay(
    job: Job, field: core.HeightField, asked: ZoneFinish, samples: Array
) -> tuple[Floats, Floats, Array, Array, str]:
    """((k,) angle from the direction that is called for, rad, nan: there is none; (k,) angle by which the last two passes'
    scratches cross, rad, nan: fewer than two; (k,) whether the scratches are not what is called for; (k,) whether that is
    not known; why, where passes were).
    """
    count, symbol = len(samples), asked.lay
    nowhere, none = np.zeros(count, dtype=bool), np.full(count, np.nan)
    if field.finish is None:
        return none, none, nowhere, ~nowhere, "not_computed"
    lay = np.asarray(field.finish["lay"], dtype=float)[samples]
    crossing = np.asarray(field.finish["crossing"], dtype=float)[samples]
    unknown = ~lay.any(axis=1)
    across = crossed_of(job, field)
    across = None if across is None else across[samples]
    if symbol in CROSSED:
        if across is None:
            return none, crossing, nowhere, ~nowhere, "no_rest"
        return none, crossing, ~across & ~unknown, unknown, "no_direction"
    normals = np.asarray(field.normals, dtype=float)[samples]
    if symbol in ("=", "⊥"):
        along = np.tile(np.asarray(asked.lay_direction, dtype=float), (count, 1))
    else:
        along = np.asarray(field.points, dtype=float)[samples] - np.asarray(asked.lay_centre_mm)
    along = along - np.einsum("ij,ij->i", along, normals)[:, None] * normals
    size = np.linalg.norm(along, axis=1)
    blind = size < LEAST_TRACE  # the direction has no trace on the surface there
    cosine = np.abs(np.einsum("ij,ij->i", along, lay)) / np.where(blind, 1.0, size)
    angle = np.arccos(np.clip(cosine, 0.0, 1.0))
    if symbol not in ("=", "R"):
        angle = 0.5 * math.pi - angle
    off = angle > _tolerance(asked)
    if across is not None:
        off = off | across
    unknown = unknown | blind
    return angle, crossing, off & ~unknown, unknown, "no_direction"


def _unknown(
    field: core.HeightField, samples: Array, why: Why, motions: Motions | None
) -> dict[str, Any] | None:
    """The reason that most of the area of the ``samples`` has, of which something is not known, and a place in the middle of
    it; None where there are none. ``why(passes, outside)``: the numbers in ``REASONS``, of arrays as a finish has them.
    """
    if not len(samples):
        return None
    finish = field.finish
    if finish is None:
        return {"reason": "not_computed", "place": None}
    reasons = why(np.asarray(finish["passes"])[samples], np.asarray(finish["outside"])[samples])
    areas = np.asarray(field.areas, dtype=float)[samples]
    if not areas.sum() > 0.0:
        areas = np.ones(len(samples))
    most = int(np.bincount(reasons, weights=areas).argmax())
    of_it = reasons == most
    points, weights = np.asarray(field.points, dtype=float)[samples[of_it]], areas[of_it]
    middle = np.average(points, axis=0, weights=weights)
    nearest = int(((points - middle) ** 2).sum(axis=1).argmin())
    return {"reason": REASONS[most], "place": place(field, samples[of_it][nearest], motions)}
