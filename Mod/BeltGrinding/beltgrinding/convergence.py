"""Are a job's settings fine enough? The job run coarser, as given and finer, and what that says of the
error of every figure of the verdict.

Richardson extrapolation over three levels with a constant ratio (Roache, Perspective: a method for
uniform reporting of grid refinement studies, J. Fluids Engineering 116, 1994; Celik et al., Procedure
for estimation and reporting of uncertainty due to discretization in CFD applications, J. Fluids
Engineering 130, 2008). Where the three values do not converge monotonically, their range.
"""

import copy
import hashlib
import math
import time

import numpy as np

from . import InputError, core, inputs, job as jobs, schemas

RATIO = 2.0  # between the levels
LEVELS = ("coarse", "given", "fine")
SETTINGS = {  # what is refined: name, keys of the job
    "spacing": (("sampling", "spacing_mm"),),
    "step": (("simulation", "max_travel_mm"), ("simulation", "max_angle_deg")),
    "contact_grid": (("belt_machine", "contact_spacing_mm"),),
}
COST = {"coarse": 0.125, "given": 1.0, "fine": 8.0}  # of a run: samples and steps, by the ratio
ORDERS = (0.5, 2.0)  # observed orders outside are taken as these: beyond, they are chance
SAFETY = 1.25  # on three levels (Roache)
SAFETY_TWO = 3.0  # on two levels, the order taken as 1 (Roache)
BAND_SHARE = 0.1  # of the tolerance band: errors below it do not move a verdict
SHARE_LIMIT = 0.01  # of the area, and of the removed volume
ROUNDING = 1e-9  # relative: differences below it are none


def converge(job, context=None):
    """Runs a validated job at twice, once and half its sampling spacing, steps and contact cells.

    Returns (the job's ``Result``, whose ``convergence`` is the dict that convergence.json holds: see
    Resources/schema/convergence.schema.json). A level that cannot be run is left out, and said. Where
    the settings are not fine enough, each of them is coarsened alone as well, to tell which matters.
    Takes about ten times as long as the job. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    whole, so_far, runs, result, notes = sum(COST.values()) + 2.0, 0.0, {}, None, []
    for level in ("given", "coarse", "fine"):
        end = so_far + COST[level]
        part = context.part(so_far / whole, end / whole)
        start = time.perf_counter()
        try:
            found = jobs.run(scaled(job, level), part)
        except (InputError, MemoryError) as error:
            if level == "given":
                raise
            notes.append(f"the {level} level could not be run: {error or 'out of memory'}")
            runs[level] = None
        else:
            runs[level] = _level(found, time.perf_counter() - start)
            result = found if level == "given" else result
        so_far = end
        found = None  # a fine field is large
    answer = {
        "job_sha256": digest(job),
        "ratio": RATIO,
        "tolerance_mm": list(job["inspection"]["tolerance_mm"]),
        "band_share": BAND_SHARE,
        "levels": {name: _settings(job, name, runs[name]) for name in LEVELS},
        "quantities": _quantities(runs),
        "settings": None,
        "notes": notes,
    }
    answer = judged(answer, job["inspection"])
    if not answer["fine_enough"]:
        context.report(so_far / whole)
        rest = context.part(so_far / whole, 1.0)
        answer["settings"] = _blame(job, runs["given"], rest, notes)
    result.convergence = answer
    context.report(1.0)
    return result


def scaled(job, level, only=None):
    """A copy of a job at a level; ``only``: the one of ``SETTINGS`` that is changed."""
    factor = RATIO ** (1 - LEVELS.index(level))
    job = copy.deepcopy(job)
    for name, keys in SETTINGS.items():
        if only is None or name == only:
            for part, key in keys:
                job[part][key] *= factor
    return job


def _level(result, seconds):
    """The figures of a run that are compared: name, unit, value."""
    summary = result.summary
    figures = {("removed_volume", "mm3", None): summary["removed_volume_mm3"]}
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


def _settings(job, level, run):
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


def _quantities(runs):
    found = []
    for key in runs["given"]["figures"]:
        name, unit, face = key
        values = [runs[level]["figures"].get(key) if runs[level] else None for level in LEVELS]
        found.append({"name": name, "face": face, "unit": unit, "values": values})
        found[-1].update(estimate(*values))
    return found


def judged(convergence, inspection):
    """A copy of an answer, judged by the tolerances of a job's ``inspection``: the errors hold for any.
    The share in tolerance is left out where it was that of another tolerance.
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
    return {
        **convergence,
        "quantities": quantities,
        "fine_enough": all(one["ok"] for one in quantities),
    }


def narrowest_band(inspection):
    """(lower, upper) of the narrowest tolerance of a job's ``inspection``, mm."""
    bands = [inspection["tolerance_mm"]]
    bands += [
        zone["tolerance_mm"] for zone in inspection.get("zones", []) if zone.get("tolerance_mm")
    ]
    return min(bands, key=lambda band: band[1] - band[0])


def estimate(coarse, given, fine):
    """dict(behaviour, order, error) of a quantity by its values at three levels, None where a level
    has none. ``error``: estimate of |given - exact| in the quantity's unit, on the safe side.
    """
    if fine is None and coarse is None:
        return {"behaviour": "unknown", "order": None, "error": None}
    if coarse is None:  # f(h) - f(0) = 2 (f(h) - f(h/2)) at order 1
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


def _blame(job, given, context, notes):
    """How far each setting moves the deviations when it alone is coarsened: {name: mm}, the greatest
    change among the figures in mm.
    """
    found = {}
    for k, name in enumerate(SETTINGS):
        part = context.part(k / len(SETTINGS), (k + 1) / len(SETTINGS))
        try:
            run = _level(jobs.run(scaled(job, "coarse", name), part), 0.0)
        except InputError as error:
            notes.append(f"{name} alone could not be made coarser: {error}")
            found[name] = None
            continue
        changes = [
            abs(run["figures"][key] - value)
            for key, value in given["figures"].items()
            if key[1] == "mm" and key in run["figures"]
        ]
        found[name] = max(changes)
    return found


def worst(convergence):
    """The quantity whose error is the largest share of its limit."""
    return max(convergence["quantities"], key=_excess)


def _excess(one):
    if one["error"] is None:
        return math.inf
    return one["error"] / one["limit"] if one["limit"] > 0.0 else (math.inf, 0.0)[one["error"] == 0]


def digest(job):
    """SHA-256 of what the heights of a validated job depend on: all but its inspection."""
    job = {key: value for key, value in job.items() if key != "inspection"}
    return hashlib.sha256(inputs.canonical(job)).hexdigest()


def read(path, job):
    """The convergence of a job from a file; None where there is none, or one of another job. Raises
    InputError.
    """
    if not path.is_file():
        return None
    found = schemas.checked(schemas.read_json(path), schemas.schema("convergence"), str(path))
    return judged(found, job["inspection"]) if found["job_sha256"] == digest(job) else None
