"""Whether the finish of zones is what they call for: roughness and lay by the terms of ISO 21920-1 and ISO 21920-3, with the
worst place of what is not, and the most frequent reason of what is not known.
"""

import math

import numpy as np

from .finish import OUTSIDE, crossed_of, place, roughness

SIXTEEN_PERCENT = 0.16  # ISO 21920-3
CROSSED = ("X", "M")  # lays of several directions
ROUNDING = 1e-6  # of a roughness that is kept in single precision
LEAST_TRACE = 1e-6  # of a direction on the surface, that it tells one there
# Why something is not known, beside the quantities of ``OUTSIDE``.
NOT_COMPUTED, NO_PASS, NO_MODEL = "not_computed", "no_pass", "no_model"
UNSETTLED, PASS_BEFORE = "unsettled", "pass_before"
NO_DIRECTION, NO_REST = "no_direction", "no_rest"
NO_SAMPLE = "no_sample"


def allowed_share(acceptance):
    """Of the area, that may lie beyond by the acceptance rule of that name."""
    return SIXTEEN_PERCENT if acceptance == "T16%" else 0.0


def judge_zones(job, field, zone_of, motions=None):
    """[what ``judge_zone`` tells, or None where nothing is called for] of every zone of a job; ``zone_of``: (n,) number of
    the zone of each sample. ``motions``: as ``motions.of_paths`` gives them, or None.
    """
    return [
        (
            judge_zone(job, field, zone["finish"], np.flatnonzero(zone_of == number), motions)
            if "finish" in zone
            else None
        )
        for number, zone in enumerate(job["inspection"].get("zones", []))
    ]


def judge_zone(job, field, asked, samples, motions=None):
    """What the finish of a zone is like, a dict; ``asked``: the zone's ``finish``, ``samples``: (k,) of the zone."""
    areas = np.asarray(field.areas, dtype=float)[samples]
    whole = float(areas.sum())
    share = lambda chosen: float(areas[chosen].sum()) / whole if whole > 0.0 else 0.0
    allowed = allowed_share(asked["acceptance"])
    verdicts, judged = [], {"acceptance": asked["acceptance"]}
    limit = asked.get("Ra_max_um")
    if limit is not None:
        judged["Ra"] = _judge_roughness(job, field, limit, samples, share, motions)
        verdicts.append((judged["Ra"], "above_share"))
    if asked.get("lay") is not None:
        judged["lay"] = _judge_lay(job, field, asked, samples, share, motions)
        verdicts.append((judged["lay"], "off_share"))
    for one, beyond in verdicts:
        one["verdict"] = _word(one[beyond], one["unknown_share"], allowed, whole)
        if not whole > 0.0:
            one["unknown"] = {"reason": NO_SAMPLE, "place": None}
    words = [one["verdict"] for one, _ in verdicts]
    judged["verdict"] = next((w for w in ("fail", "unknown", "pass") if w in words), "unknown")
    return judged


def without(zone):
    """ "pass", "fail" or "unknown": the verdict on a zone of a verdict but for its finish."""
    thick = (zone["thickness"] or {}).get("verdict", "pass")
    if zone["above_share"] + zone["below_share"] > 0.0 or thick == "fail":
        return "fail"
    unknown = zone["worst"] is None or zone["missed_rays"] or thick == "unknown"
    return "unknown" if unknown else "pass"


def decides(verdict):
    """How many zones a verdict hangs on by their finish alone: all else is good. 0: on none."""
    if any(one["verdict"] != "pass" for one in verdict["faces"]):
        return 0
    bad = [zone for zone in verdict["zones"] if zone["verdict"] != "pass"]
    if not all(zone.get("finish") and without(zone) == "pass" for zone in bad):
        return 0
    return sum(zone["verdict"] == verdict["overall"] for zone in bad)


def _word(off, unknown, allowed, whole):
    if off > allowed:
        return "fail"
    return "unknown" if off + unknown > allowed or not whole > 0.0 else "pass"


def _judge_roughness(job, field, limit, samples, share, motions):
    values = np.full(len(samples), np.nan)
    if field.finish is not None:
        values = roughness(field)[samples]
    known = np.isfinite(values)
    above = np.nan_to_num(values) > limit * (1.0 + ROUNDING)
    worst = None
    if above.any():
        worst = place(field, samples[int(np.nan_to_num(values).argmax())], motions)
    return {
        "limit_um": limit,
        "max_um": float(values[known].max()) if known.any() else None,
        "above_share": share(above),
        "unknown_share": share(~known),
        "worst": worst,
        "unknown": _unknown(
            field, samples, ~known, _roughness_reasons(job, field, samples), motions
        ),
    }


def _roughness_reasons(job, field, samples):
    """(k,) why the roughness of samples is not known, where it is not."""
    if field.finish is None:
        return np.full(len(samples), NOT_COMPUTED, dtype=object)
    given, reason = job.get("finish", {}), UNSETTLED
    if "model" not in given:
        reason = NO_MODEL
    elif "initial_Ra_um" in given:  # what is not known is left by a pass
        reason = PASS_BEFORE
    found = np.full(len(samples), reason, dtype=object)
    outside = np.asarray(field.finish["outside"])[samples]
    for number, name in enumerate(OUTSIDE, 1):
        found[outside == number] = name.replace(" ", "_")
    found[np.asarray(field.finish["passes"])[samples] == 0] = NO_PASS
    return found


def _judge_lay(job, field, asked, samples, share, motions):
    angle, crossing, off, unknown, reasons = _lay(job, field, asked, samples)
    worst = None
    if off.any():
        # Farthest from what is called for; of crossed scratches, least or most crossed.
        apart = -np.nan_to_num(crossing) if asked["lay"] in CROSSED else angle
        if asked["lay"] not in CROSSED and not (off & (angle > _tolerance(asked))).any():
            apart = np.nan_to_num(crossing)
        k = int(np.flatnonzero(off)[apart[off].argmax()])
        degrees = lambda value: float(math.degrees(value)) if math.isfinite(value) else None
        worst = {
            "angle_deg": degrees(angle[k]),
            "crossing_deg": degrees(crossing[k]),
            **place(field, samples[k], motions),
        }
    return {
        "symbol": asked["lay"],
        "off_share": share(off),
        "unknown_share": share(unknown),
        "worst": worst,
        "unknown": _unknown(field, samples, unknown, reasons, motions),
    }


def _tolerance(asked):
    return math.radians(asked["lay_tolerance_deg"]) + 1e-9


def _lay(job, field, asked, samples):
    """((k,) angle from the direction that is called for, rad, nan: there is none; (k,) angle by which the last two passes'
    scratches cross, rad, nan: fewer than two; (k,) whether the scratches are not what is called for; (k,) whether that is
    not known; (k,) why).
    """
    count, symbol = len(samples), asked["lay"]
    nowhere, none = np.zeros(count, dtype=bool), np.full(count, np.nan)
    if field.finish is None:
        return none, none, nowhere, ~nowhere, np.full(count, NOT_COMPUTED, dtype=object)
    lay = np.asarray(field.finish["lay"], dtype=float)[samples]
    crossing = np.asarray(field.finish["crossing"], dtype=float)[samples]
    reasons = np.full(count, NO_DIRECTION, dtype=object)
    reasons[np.asarray(field.finish["passes"])[samples] == 0] = NO_PASS
    unknown = ~lay.any(axis=1)
    across = crossed_of(job, field)
    across = None if across is None else across[samples]
    if symbol in CROSSED:
        if across is None:
            reasons[~unknown] = NO_REST
            return none, crossing, nowhere, ~nowhere, reasons
        return none, crossing, ~across & ~unknown, unknown, reasons
    normals = np.asarray(field.normals, dtype=float)[samples]
    if symbol in ("=", "⊥"):
        along = np.tile(np.asarray(asked["lay_direction"], dtype=float), (count, 1))
    else:
        along = np.asarray(field.points, dtype=float)[samples] - np.asarray(asked["lay_centre_mm"])
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
    return angle, crossing, off & ~unknown, unknown, reasons


def _unknown(field, samples, unknown, reasons, motions):
    """The reason that most of the area has of what is not known, and a place in the middle of it; None where all is."""
    if not unknown.any():
        return None
    areas = np.asarray(field.areas, dtype=float)[samples]
    names = sorted(set(reasons[unknown].tolist()))
    sums = [float(areas[unknown & (reasons == name)].sum()) for name in names]
    reason = names[int(np.argmax(sums))]
    if reason == NOT_COMPUTED:
        return {"reason": reason, "place": None}
    of_it = np.flatnonzero(unknown & (reasons == reason))
    points = np.asarray(field.points, dtype=float)[samples[of_it]]
    weights = areas[of_it] if areas[of_it].sum() > 0.0 else None
    middle = np.average(points, axis=0, weights=weights)
    nearest = int(((points - middle) ** 2).sum(axis=1).argmin())
    return {"reason": reason, "place": place(field, samples[of_it[nearest]], motions)}
