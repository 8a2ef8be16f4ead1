"""The answer whether a job's settings are fine enough: as kept, and judged by its tolerances."""

from __future__ import annotations

import hashlib
import math
from pathlib import Path
from typing import Any

from ..base import schemas
from ..base.kinds import Json
from ..job import inputs
from ..job.tolerances import narrowest_band

LEVELS = ("coarse", "given", "fine")
BAND_SHARE = 0.1  # of the tolerance band: errors below it do not move a verdict
SHARE_LIMIT = 0.01  # of the area, and of the removed volume


def assessed(convergence: Json, inspection: Json) -> dict[str, Any]:
    """A copy of an answer, assessed by the tolerances of a job's ``inspection``: the errors hold for any.
    The share in tolerance, and that which is open, are left out where they were those of another tolerance.
    """
    lower, upper = narrowest_band(inspection)
    limits = {"mm": BAND_SHARE * (upper - lower), "share": SHARE_LIMIT}
    same = convergence["tolerance_mm"] == list(inspection["tolerance_mm"])
    quantities = []
    for one in convergence["quantities"]:
        if one["name"] == "in_tolerance" and not same:
            continue
        limit = limits.get(one["unit"], SHARE_LIMIT * abs(one["values"][1]))
        ok = one["error"] is not None and one["error"] <= limit
        quantities.append({**one, "limit": limit, "ok": ok})
    samples = convergence.get("samples")
    if samples and samples["limits_sha256"] != limits_digest(inspection):
        samples = {**samples, "undecided_share": None}
    return {
        **convergence,
        "quantities": quantities,
        "samples": samples,
        "fine_enough": all(one["ok"] for one in quantities),
    }


def worst(convergence: Json) -> Json:
    """The quantity whose error is the largest share of its limit."""
    return max(convergence["quantities"], key=_excess)


def _excess(one: Json) -> float:
    if one["error"] is None:
        return math.inf
    return one["error"] / one["limit"] if one["limit"] > 0.0 else (math.inf, 0.0)[one["error"] == 0]


def digest(job: Json) -> str:
    """SHA-256 of what the heights of a validated job depend on: all but its inspection."""
    job = {key: value for key, value in job.items() if key != "inspection"}
    return hashlib.sha256(inputs.canonical(job)).hexdigest()


def limits_digest(inspection: Json) -> str:
    """SHA-256 of what decides which samples are in tolerance."""
    limits = {"tolerance_mm": inspection["tolerance_mm"], "zones": inspection.get("zones", [])}
    return hashlib.sha256(inputs.canonical(limits)).hexdigest()


def read(path: Path, job: Json) -> dict[str, Any] | None:
    """The convergence of a job from a file; None where there is none, or one of another job. Raises
    InputError.
    """
    if not path.is_file():
        return None
    found = schemas.checked_file(path, schemas.schema("convergence"))
    return assessed(found, job["inspection"]) if found["job_sha256"] == digest(job) else None
