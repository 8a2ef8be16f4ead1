"""The law of removal of a job, as the engine takes it; and how sure it is."""

from __future__ import annotations

import json
import math
from functools import lru_cache
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..base import records, schemas
from ..base.files import cannot_be_written, in_file, write_whole
from ..base.kinds import Json
from ..engine import InputError, core
from .settings import Job, Law, Wear
from .typed import typed

MOST_LN = 700.0  # of what a number can hold
EXPONENTS = ("pressure_exponent", "speed_exponent", "feed_exponent")


SEED = 1
ROUNDING = 1e-6  # of correlations
MOST_DEVIATION = 10.0  # of ln K, or of an exponent
COEFFICIENT = "coefficient"  # a calibration's name of it: it stands for its logarithm
CALIBRATED = tuple(
    dict.fromkeys([COEFFICIENT, *EXPONENTS, *core.GRIND_PARAMETERS])
)  # what one may know of
Shift = tuple[tuple[str, ...], bool, float, float]  # keys, whether by a logarithm, least, most
SHIFTS: dict[str, Shift] = {
    COEFFICIENT: (("coefficient_mm2_per_N",), True, 0.0, math.inf),
    **{name: ((name,), False, -math.inf, math.inf) for name in EXPONENTS},
    "pressure_threshold": (("pressure_threshold_MPa",), False, 0.0, math.inf),
    "ln_saturation": (("saturation_pressure_MPa",), True, 0.0, math.inf),
}
WEAR_REST: Shift = (("rest",), False, 0.0, 1.0)
LOADING: dict[str, Shift] = {"loading_share": (("loading_share",), False, 0.0, 1.0)}
WEAR_SHIFTS: dict[str, dict[str, Shift]] = {  # by the wear's model
    "none": LOADING,
    "curve": LOADING,
    "exponential": {
        "ln_wear_scale": (("scale",), True, 0.0, math.inf),
        "wear_rest": WEAR_REST,
        **LOADING,
    },
    "two_stage": {
        "ln_wear_scale": (("scale", "first_scale"), True, 0.0, math.inf),
        "wear_rest": WEAR_REST,
        "first_share": (("first_share",), False, 0.0, 1.0),
        "ln_first_ratio": (("first_scale",), True, 0.0, math.inf),
        **LOADING,
    },
    "power": {
        "ln_wear_scale": (("scale",), True, 0.0, math.inf),
        "wear_exponent": (("exponent",), False, 0.0, 10.0),
        **LOADING,
    },
}
MOVED = {name for shifts in (SHIFTS, *WEAR_SHIFTS.values()) for name in shifts}


def engine_wear(law: Json | Law) -> Wear:
    """The Wear of a job's law, as core.belt_remaining takes it; what a calibration left out as the schema has it."""
    given = law.wear if isinstance(law, Law) else law["wear"]
    return given if isinstance(given, Wear) else records.made(Wear, schemas.filled(given, _wear()))


@lru_cache(maxsize=None)
def _wear() -> dict[str, Any]:
    """The schema of a law's wear."""
    return schemas.schema("job")["properties"]["law"]["properties"]["wear"]


def engine_belt(belt: Json) -> dict[str, float]:
    """The belt's state as a result of ``core.simulate`` has it, from a job's."""
    return {
        "work": float(belt["work_J"]),
        "volume": float(belt["removed_mm3"]),
        "time": 3600.0 * belt["hours"],
        "loading": float(belt.get("loading", 0.0)),
    }


def job_belt(belt: Json) -> dict[str, float]:
    """The other way round."""
    return {
        "work_J": belt["work"],
        "removed_mm3": belt["volume"],
        "hours": belt["time"] / 3600.0,
        "loading": belt.get("loading", 0.0),
    }


def dressed(wear: Wear, belt: Json) -> dict[str, float]:
    """The engine's belt after a dressing, which leaves a share of its loading."""
    return {**belt, "loading": wear.dressing_rest * belt["loading"]}


def read_belt(path: Path | str) -> dict[str, float]:
    """The belt's state, keys of a job's belt_machine.belt, from the file of ``write_belt``. Raises
    InputError.
    """
    rule = schemas.schema("job")["properties"]["belt_machine"]["properties"]["belt"]
    try:
        return schemas.checked(schemas.read_json(Path(path)), rule, "belt")
    except InputError as error:
        raise in_file(error, path) from None


def write_belt(path: Path | str, belt: Json) -> None:
    """Writes a summary's belt for the next job. Raises InputError."""
    state = {key: belt[key] for key in ("work_J", "removed_mm3", "hours", "loading")}
    try:
        write_whole(Path(path), (json.dumps(state, indent=2, allow_nan=False) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def freedom(law: Json | Law) -> float:
    """Degrees of freedom of Student's t whose scales the steps of ``shifted_laws`` are; inf: they are normal."""
    plain: Json = records.plain(law)
    return float(plain["calibration"].get("freedom", math.inf))


def shifted_laws(law: Json | Law) -> list[Law]:
    """Laws, each a standard deviation off along one of the directions in which a calibrated
    law is uncertain: the principal axes of its parameters' covariance, those of the wear among them, and the scatter of
    one grind. Their effects are uncorrelated: independent normals, or together Student's t (``freedom``). Empty for a
    law that was not calibrated. Raises InputError.
    """
    plain: Json = records.plain(law)
    if not plain["calibration"] or plain["model"] == "geometric":
        return []
    base, laws = records.made(Law, law), []
    for step in _steps(plain["calibration"]):
        shifted = _shifted(base, step)
        if shifted != base:
            laws.append(shifted)
    return laws


def drawn_wears(law: Json | Law, count: int) -> list[Wear]:
    """``count`` wears as a calibrated law says that they may be, drawn at random, the same at every call; empty where the
    law does not say. Raises InputError."""
    plain: Json = records.plain(law)
    calibration, base = plain["calibration"], engine_wear(law)
    check_calibration(calibration)
    shifts = WEAR_SHIFTS[base.model]
    names = [name for name in calibration.get("parameters", []) if name in shifts]
    if not names:
        return []
    at = [calibration["parameters"].index(name) for name in names]
    covariance = np.array(calibration["covariance"], dtype=float)[np.ix_(at, at)]
    variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
    random, degrees = np.random.default_rng(SEED), freedom(law)
    numbers = random.standard_normal((count, len(names)))
    if math.isfinite(degrees):
        numbers *= np.sqrt(degrees / random.chisquare(degrees, (count, 1)))
    steps = numbers * np.sqrt(np.maximum(variances, 0.0)) @ axes.T
    steps *= float(calibration.get("widening", 1.0))
    moved = (_changed(base, shifts, dict(zip(names, step)), 1.0)[0] for step in steps.tolist())
    return [replace(base, **one) for one in moved]


def _shifted(law: Law, step: dict[str, float]) -> Law:
    """A law moved by a step; by the opposite one, which says the same, where that leaves what a law can be."""
    own = SHIFTS if law.model == "local" else {COEFFICIENT: SHIFTS[COEFFICIENT]}
    sign, changed, worn = 1.0, dict[str, float](), dict[str, float]()
    for sign in (1.0, -1.0):
        changed, inside = _changed(law, own, step, sign)
        worn, kept = _changed(law.wear, WEAR_SHIFTS[law.wear.model], step, sign)
        if inside and kept:
            break
    return replace(law, **changed, wear=replace(law.wear, **worn))


def _changed(
    record: Law | Wear, shifts: dict[str, Shift], step: dict[str, float], sign: float
) -> tuple[dict[str, float], bool]:
    """(values by key of a record moved by a step, whether all stay within their bounds); kept within them."""
    changed, inside = dict[str, float](), True
    for name, (keys, logarithm, least, most) in shifts.items():
        for key in keys if step.get(name) else ():
            value, by = changed.get(key, getattr(record, key)), sign * step[name]
            moved = value * math.exp(min(by, MOST_LN)) if logarithm else value + by
            changed[key] = min(max(moved, least), most)
            inside = inside and least <= moved <= most
    if "first_share" in shifts and changed:  # both are shares of the same cut
        rest, first = (changed.get(key, getattr(record, key)) for key in ("rest", "first_share"))
        changed["first_share"] = min(first, 1.0 - rest)
        inside = inside and first + rest <= 1.0
    return changed, inside


def check_calibration(calibration: Json, key: str = "law.calibration") -> None:
    """Raises InputError for an invalid covariance: rows of other lengths, not symmetric, not positive semidefinite, or
    of parameters about which nothing is known, that are none of the law's, or that are there twice.
    """
    names = calibration.get("parameters", [])
    rows, named, key = calibration.get("covariance", []), f"{key}.parameters", f"{key}.covariance"
    if [len(row) for row in rows] != [len(names)] * len(names):
        raise InputError(
            "job.covariance_size",
            "{key}: the covariance has {count} numbers in {rows} rows; {parameters} parameters need {needed}, "
            "{parameters} in each row",
            key=key,
            count=sum(len(row) for row in rows),
            rows=len(rows),
            parameters=len(names),
            needed=len(names) ** 2,
        )
    if not names:
        return
    for k, name in enumerate(names):
        if name not in CALIBRATED:
            raise InputError(
                "job.calibration_parameter",
                "{key}: a calibration knows nothing of {name}; use {known}",
                key=f"{named}[{k}]",
                name=name,
                known=", ".join(CALIBRATED),
            )
        if name in names[:k]:
            raise InputError(
                "job.calibration_parameter_twice",
                "{key}: {name} is given twice; give each parameter once",
                key=f"{named}[{k}]",
                name=name,
            )
    covariance = np.array(rows, dtype=float)
    variances = np.diag(covariance)
    scales = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    correlation = covariance / scales[:, None] / scales  # its entries have no unit
    if np.abs(correlation - correlation.T).max() > ROUNDING:
        raise InputError(
            "job.covariance_not_symmetric", "{key}: the covariance is not symmetric", key=key
        )
    # Where a variance is 0, so are the covariances.
    loose = np.abs(correlation[variances <= 0.0]).max(initial=0.0) > 0.0
    if loose or np.linalg.eigvalsh(0.5 * (correlation + correlation.T)).min() < -ROUNDING:
        raise InputError(
            "job.covariance_not_definite", "{key}: the covariance is not positive definite", key=key
        )
    for name, variance in zip(names, variances):
        if name in (COEFFICIENT, *EXPONENTS) and variance > MOST_DEVIATION**2:
            raise InputError(
                "job.covariance_too_large",
                "{key}: the standard deviation of {name} is {deviation:.3g}; more than {most:g} tells nothing",
                key=key,
                name=name,
                deviation=math.sqrt(variance),
                most=MOST_DEVIATION,
            )


def _steps(calibration: Json) -> list[dict[str, float]]:
    check_calibration(calibration)
    names = calibration.get("parameters", [])
    wide = float(calibration.get("widening", 1.0))
    steps = [{COEFFICIENT: wide * float(calibration.get("scatter", 0.0))}]
    # The engine knows no times or areas: it gets the covariance of the other parameters.
    known = [i for i, name in enumerate(names) if name in MOVED]
    if known:
        covariance = np.array(calibration["covariance"], dtype=float)[np.ix_(known, known)]
        variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
        for variance, axis in zip(variances, axes.T):
            by = wide * math.sqrt(max(variance, 0.0)) * axis
            steps.append({names[i]: float(value) for i, value in zip(known, by)})
    return steps


def remaining_cut(job: Job | Json, belt: Json) -> float:
    """k_t of a belt that has done ``belt`` (as the engine has it), on the job's machine."""
    job = typed(job)
    return job.belt_machine.belt_wear * core.belt_remaining(engine_wear(job.law), belt)
