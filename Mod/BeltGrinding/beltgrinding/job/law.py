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


ROUNDING = 1e-6  # of correlations
MOST_DEVIATION = 10.0  # of ln K, or of an exponent
COEFFICIENT = "coefficient"  # a calibration's name of it: it stands for its logarithm
CALIBRATED = tuple(
    dict.fromkeys([COEFFICIENT, *EXPONENTS, *core.GRIND_PARAMETERS])
)  # what one may know of


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
    }


def job_belt(belt: Json) -> dict[str, float]:
    """The other way round."""
    return {
        "work_J": belt["work"],
        "removed_mm3": belt["volume"],
        "hours": belt["time"] / 3600.0,
    }


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
    state = {key: belt[key] for key in ("work_J", "removed_mm3", "hours")}
    try:
        write_whole(Path(path), (json.dumps(state, indent=2, allow_nan=False) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def shifted_laws(law: Json | Law) -> list[Law]:
    """Laws, each a standard deviation off along one of the directions in which a calibrated
    law is uncertain: the principal axes of its parameters' covariance, and the scatter of one grind.
    Their effects are independent. Empty for a law that was not calibrated. Raises InputError.
    """
    plain: Json = records.plain(law)
    if not plain["calibration"] or plain["model"] == "geometric":
        return []
    base, laws = records.made(Law, law), []
    for step in _steps(plain["calibration"]):
        changed: dict[str, float] = {}
        for name, by in step.items():
            if name == COEFFICIENT:
                changed["coefficient_mm2_per_N"] = base.coefficient_mm2_per_N * math.exp(
                    min(by, MOST_LN)
                )
            elif base.model == "local":  # the others know no exponents
                changed[name] = getattr(base, name) + by
        shifted = replace(base, **changed)
        if shifted != base:
            laws.append(shifted)
    return laws


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
    steps = [{COEFFICIENT: float(calibration.get("scatter", 0.0))}]
    # Of wear and other parameters the engine is told nothing: the rest's own covariance.
    known = [i for i, name in enumerate(names) if name in (COEFFICIENT, *EXPONENTS)]
    if known:
        covariance = np.array(calibration["covariance"], dtype=float)[np.ix_(known, known)]
        variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
        for variance, axis in zip(variances, axes.T):
            by = math.sqrt(max(variance, 0.0)) * axis
            steps.append({names[i]: float(value) for i, value in zip(known, by)})
    return steps


def remaining_cut(job: Job | Json, belt: Json) -> float:
    """k_t of a belt that has done ``belt`` (as the engine has it), on the job's machine."""
    job = typed(job)
    return job.belt_machine.belt_wear * core.belt_remaining(engine_wear(job.law), belt)
