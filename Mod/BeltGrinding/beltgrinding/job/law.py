"""The law of removal of a job, as the engine takes it; and how sure it is."""

import json
import math
from pathlib import Path

import numpy as np

from ..base import schemas
from ..base.files import cannot_be_written, in_file, write_whole
from ..engine import InputError, core

# Keys of a job's law, the engine's names, and the engine's unit of the job's 1.
PARAMETERS = {
    "coefficient_mm2_per_N": ("coefficient", 1.0),
    "pressure_threshold_MPa": ("pressure_threshold", 1.0),
    "pressure_exponent": ("pressure_exponent", 1.0),
    "reference_pressure_MPa": ("reference_pressure", 1.0),
    "saturation_pressure_MPa": ("saturation_pressure", 1.0),
    "speed_exponent": ("speed_exponent", 1.0),
    "reference_speed_m_s": ("reference_speed", 1000.0),
    "feed_exponent": ("feed_exponent", 1.0),
    "reference_feed_mm_s": ("reference_feed", 1.0),
    "land_share": ("land_share", 1.0),
}


CURVES = {"pressure_curve": 1.0, "speed_curve": 1000.0, "feed_curve": 1.0, "land_curve": 1.0}


EXPONENTS = ("pressure_exponent", "speed_exponent", "feed_exponent")


COEFFICIENT = "coefficient"  # a calibration's name of it: it stands for its logarithm


def engine_law(law):
    """The dict that ``core.simulate`` takes as its law."""
    coefficient = float(law["coefficient_mm2_per_N"])
    if law["model"] == "hammann":
        return {"model": "hammann", "coefficient": coefficient}
    if law["model"] in ("local_linear", "geometric"):
        return {"model": "local", "coefficient": coefficient}
    result = {name: unit * float(law[key]) for key, (name, unit) in PARAMETERS.items()}
    for key, unit in CURVES.items():
        result[key] = [[unit * x, y] for x, y in law[key]]
    return {"model": "local", **result}


def engine_wear(law):
    """The dict that ``core.simulate`` takes as the belt's wear."""
    return {**law["wear"], "curve": [list(point) for point in law["wear"]["curve"]]}


def engine_belt(belt):
    """The belt's state as ``core.simulate`` takes it, from a job's."""
    return {
        "work": float(belt["work_J"]),
        "volume": float(belt["removed_mm3"]),
        "time": 3600.0 * belt["hours"],
    }


def job_belt(belt):
    """The other way round."""
    return {
        "work_J": belt["work"],
        "removed_mm3": belt["volume"],
        "hours": belt["time"] / 3600.0,
    }


def read_belt(path):
    """The belt's state, keys of a job's belt_machine.belt, from the file of ``write_belt``. Raises
    InputError.
    """
    rule = schemas.schema("job")["properties"]["belt_machine"]["properties"]["belt"]
    try:
        return schemas.checked(schemas.read_json(Path(path)), rule, "belt")
    except InputError as error:
        raise in_file(error, path) from None


def write_belt(path, belt):
    """Writes a summary's belt for the next job. Raises InputError."""
    state = {key: belt[key] for key in ("work_J", "removed_mm3", "hours")}
    try:
        write_whole(Path(path), (json.dumps(state, indent=2) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def shifted_laws(law):
    """Engine laws, each a standard deviation off along one of the directions in which a calibrated
    law is uncertain: the principal axes of its parameters' covariance, and the scatter of one grind.
    Their effects are independent. Empty for a law that was not calibrated. Raises InputError.
    """
    calibration = law["calibration"]
    if not calibration or law["model"] == "geometric":
        return []
    base, laws = engine_law(law), []
    for step in _steps(calibration):
        shifted = dict(base)
        for name, by in step.items():
            if name == COEFFICIENT:
                shifted[name] *= math.exp(by)
            elif name in base:
                shifted[name] += by
        if shifted != base:
            laws.append(shifted)
    return laws


def _steps(calibration):
    names = calibration.get("parameters", [])
    covariance = np.array(calibration.get("covariance", []), dtype=float)
    if covariance.size != len(names) ** 2:
        raise InputError(
            "job.covariance_size",
            "{key}: the covariance has {count} numbers; {parameters} parameters need {needed}",
            key="law.calibration",
            count=covariance.size,
            parameters=len(names),
            needed=len(names) ** 2,
        )
    steps = [{COEFFICIENT: float(calibration.get("scatter", 0.0))}]
    # Of wear and other parameters the engine is told nothing: the rest's own covariance.
    known = [i for i, name in enumerate(names) if name in (COEFFICIENT, *EXPONENTS)]
    if known:
        covariance = covariance.reshape(len(names), len(names))[np.ix_(known, known)]
        variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
        if variances.min() < -1e-9 * max(1.0, variances.max()):
            raise InputError(
                "job.covariance_not_definite",
                "{key}: the covariance is not positive definite",
                key="law.calibration",
            )
        for variance, axis in zip(variances, axes.T):
            by = math.sqrt(max(variance, 0.0)) * axis
            steps.append({names[i]: float(value) for i, value in zip(known, by)})
    return steps


def remaining_cut(job, belt):
    """k_t of a belt that has done ``belt`` (as the engine has it), on the job's machine."""
    return job["belt_machine"]["belt_wear"] * core.belt_remaining(engine_wear(job["law"]), belt)
