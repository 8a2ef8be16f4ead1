"""What the scan of one ground part says of the law and the belt's wear, for the next part's plan.

The law's parameters are known before with a covariance; the part's heights, as scanned, correct them by Bayes' rule,
linearised and iterated: an extended Kalman filter whose state are the logarithm of the coefficient, the exponents that
were calibrated, and the logarithm of the wear's scale (Bell and Cathey, IEEE Trans. Automatic Control 38, 1993). One
part cannot tell a law that cuts too little from a belt that is worn; parts along a belt's life can, for the wear
counts more the more the belt has done. What no law predicts, the scatter of a grind, is a factor on each part by
itself, and is not learned. The state drifts a little from part to part, so that learning never ends.
"""

from __future__ import annotations
from collections.abc import Sequence

import copy
import math
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Context, Floats, Json
from ..engine import InputError, core
from ..job import law as laws
from ..simulation import run as runs

COEFFICIENT, WEAR = laws.COEFFICIENT, "ln_wear_scale"
SCALES = ("scale", "first_scale")
UNKNOWN = {
    COEFFICIENT: 0.5,
    WEAR: 0.7,
}  # standard deviation of what nothing is known of
SCATTER = 0.05  # of a grind, where none was measured
DRIFT = 0.03  # of the logarithms, from part to part
STEP = 1e-2  # of a parameter, for its derivative
BLOCK = 10.0  # mm: samples nearer to each other err together
LEAST_DEPTH = 0.05  # of the greatest: what is ground less says nothing
LEAST_BLOCKS = 4
LEAST_ERROR = 1e-3  # mm, of a block's mean: no scan is better
CAUCHY = 2.385
ROUNDS, SETTLED = 6, 0.01  # standard deviations before


class Learned(NamedTuple):
    """What was learned."""

    law: dict[str, Any]  # the job's, corrected, with its new covariance
    report: list[
        dict[str, Any]
    ]  # dicts: parameter, before, after, interval (2,) of 95 %, interval_before (2,)
    factor: float  # measured removal over predicted, of this part
    rms_mm: tuple[float, float]  # of what was measured less what is predicted: before, after
    samples: int


def refuse_stages(job: Json) -> None:
    """Raises InputError for a job that begins with what an earlier run left: other laws have removed, too."""
    if "left_by" in job["stock"]:
        raise InputError(
            "calibration.learn_stages",
            "{key}: an earlier run has removed, too; a law is learnt from a part that one job has ground",
            key="stock.left_by",
        )


def learn(
    job: Json,
    measured: Floats,
    scatter: float | None = None,
    drift: float = DRIFT,
    context: Context = None,
) -> Learned:
    """``Learned`` from a validated job as one part was ground (its programs, its law as it was believed, its belt's use
    before the part) and the scan's heights ``measured`` (samples,), mm above the design at the samples of the job; NaN
    where there are none. ``scatter``: standard deviation of ln(measured / predicted) of a grind; None: the
    calibration's. Raises InputError, Cancelled."""
    context = context or core.RunContext()
    law = job["law"]
    if law["model"] in ("geometric", "hammann"):
        raise InputError(
            "calibration.learn_model",
            "learn: a {model} law has no coefficient to learn",
            model=law["model"],
        )
    refuse_stages(job)
    calibration = law["calibration"]
    if scatter is None:
        scatter = calibration.get("widening", 1.0) * calibration.get("scatter", 0.0) or SCATTER
    names, prior = _prior(law, drift)
    inverse, found, before, part = (
        np.linalg.inv(prior),
        np.zeros(len(names)),
        None,
        None,
    )
    for k in range(ROUNDS):
        share = context.part(k / ROUNDS, (k + 1) / ROUNDS)
        part = _Part(job, law, names, found, measured, share)
        before = before or part
        moved, covariance = part.corrected(found, inverse, scatter)
        change = np.abs(moved - found) / np.sqrt(np.diag(prior))
        found = moved
        if change.max() < SETTLED:
            break
    after = _Part(job, law, names, found, measured, context.part(1.0, 1.0))
    corrected = _applied(law, names, found)
    corrected["calibration"] = {
        "parameters": list(names),
        "covariance": (0.5 * (covariance + covariance.T)).tolist(),
        "scatter": scatter,
        **({"freedom": calibration["freedom"]} if "freedom" in calibration else {}),
    }
    return Learned(
        corrected,
        [
            {
                "parameter": name,
                "before": _value(law, name),
                "after": _value(corrected, name),
                "interval": _interval(corrected, name, covariance[i, i]),
                "interval_before": _interval(law, name, prior[i, i]),
            }
            for i, name in enumerate(names)
        ],
        before.factor(),
        (before.rms(), after.rms()),
        int(before.used.sum()),
    )


class _Part:
    """One part as a law that is moved by ``found`` (parameters,) would leave it, against the scan."""

    def __init__(
        self,
        job: Json,
        law: Json,
        names: Sequence[str],
        found: Any,
        measured: Floats,
        context: Context,
    ) -> None:
        law = _applied(law, names, found)
        exponents = [name for name in names if name in laws.EXPONENTS]
        trial_covariance = STEP**2 * np.eye(len(exponents))
        calibration = {
            "parameters": exponents,
            "covariance": trial_covariance.tolist(),
            "scatter": 0.0,
        }
        trial = {**job, "law": {**law, "calibration": calibration if exponents else {}}}
        result = runs.run(trial, context, shifts=True)
        field = result.field
        if measured.shape != (field.size,):
            raise InputError(
                "calibration.learn_samples",
                "learn: {given} measured heights for {count} samples",
                given=measured.size,
                count=field.size,
            )
        height = np.asarray(field.height, dtype=float)
        removed = np.asarray(field.stock_height, dtype=float) - height
        good = np.isfinite(measured) & ((np.asarray(field.flags) & core.MISSED) == 0)
        self.used = good & (removed > LEAST_DEPTH * np.max(removed, where=good, initial=0.0))
        cells = np.floor(np.asarray(field.points, dtype=float)[self.used] / BLOCK)
        block = np.unique(cells, axis=0, return_inverse=True)[1].ravel()
        self.count = np.bincount(block)
        if len(self.count) < LEAST_BLOCKS:
            raise InputError(
                "calibration.learn_too_little",
                "learn: the scan shows {count} places of {size:g} mm that were ground; at least {least} are needed. "
                "Do scan, design and job lie in the same place?",
                count=len(self.count),
                size=BLOCK,
                least=LEAST_BLOCKS,
            )

        def means(values: Floats) -> Floats:
            return np.bincount(block, values[self.used]) / self.count

        belt = laws.engine_belt(job["belt_machine"]["belt"])
        after = laws.engine_belt(result.summary["belt"])
        belt = {key: 0.5 * (belt[key] + after[key]) for key in belt}
        columns = {COEFFICIENT: removed, WEAR: removed * _wear_slope(law, belt)}
        if exponents:  # shifted along the axes of that covariance
            shifts = np.asarray(result.shifts) @ np.linalg.eigh(trial_covariance)[1].T / STEP
            columns.update(zip(exponents, shifts.T))
        self.removed = means(removed)
        self.slopes = np.column_stack([means(columns[name]) for name in names])
        self.missing = means(height - np.where(self.used, measured, 0.0))

    def corrected(self, found: Floats, inverse: Floats, scatter: float) -> tuple[Floats, Floats]:
        """(parameters (n,), covariance (n, n)): what was known before, with the inverse of its covariance, and this
        part. The part's own factor is one more unknown, which is dropped."""
        slopes = np.column_stack([self.slopes, self.removed])
        known = np.zeros([len(found) + 1] * 2)
        known[:-1, :-1], known[-1, -1] = inverse, 1.0 / max(scatter, 1e-6) ** 2
        target = self.missing + self.slopes @ found
        weight, error = np.ones(len(target)), None
        for _ in range(20):
            # Blocks count by their spread about what is found; those far off hardly.
            moved = np.linalg.lstsq(
                slopes * np.sqrt(weight)[:, None], target * np.sqrt(weight), rcond=None
            )[0]
            off = target - slopes @ moved
            error = max(1.4826 * float(np.median(abs(off))), LEAST_ERROR)
            weight = 1.0 / (1.0 + (off / (CAUCHY * error)) ** 2)
        information = known + slopes.T @ (slopes * (weight / error**2)[:, None])
        covariance = np.linalg.inv(information)
        return (covariance @ slopes.T @ (weight / error**2 * target))[:-1], covariance[:-1, :-1]

    def factor(self) -> float:
        """Measured removal over predicted, over the blocks."""
        removed = self.removed * self.count
        return float(1.0 + (self.missing * self.count).sum() / removed.sum())

    def rms(self) -> float:
        return float(np.sqrt(np.average(self.missing**2, weights=self.count)))


def _prior(law: Json, drift: float) -> tuple[list[str], Floats]:
    """(names, covariance) before the part: the calibration's, with the drift of a part."""
    calibration = law["calibration"]
    given = list(calibration.get("parameters", []))
    laws.shifted_laws(law)  # refuses what is no covariance
    covariance = np.array(calibration.get("covariance", []), dtype=float)
    covariance = covariance.reshape(len(given), len(given))
    learnt = (COEFFICIENT, WEAR, *(laws.EXPONENTS if law["model"] == "local" else ()))
    kept = [k for k, name in enumerate(given) if name in learnt]
    names = [given[k] for k in kept]
    sizes = {}
    if WEAR not in names and law["wear"]["model"] in (
        "exponential",
        "two_stage",
        "power",
    ):
        fit = calibration.get("fit", {})
        if WEAR in fit.get("parameters", ()):
            k = fit["parameters"].index(WEAR)
            sizes[WEAR] = math.sqrt(fit["covariance"][k][k])
        else:
            sizes[WEAR] = UNKNOWN[WEAR]
    if COEFFICIENT not in names:
        sizes[COEFFICIENT] = UNKNOWN[COEFFICIENT]
    whole = np.zeros([len(names) + len(sizes)] * 2)
    whole[: len(kept), : len(kept)] = (
        covariance[np.ix_(kept, kept)] * calibration.get("widening", 1.0) ** 2 if kept else 0.0
    )
    for k, (name, size) in enumerate(sizes.items(), len(kept)):
        names.append(name)
        whole[k, k] = size**2
    for k, name in enumerate(names):
        whole[k, k] += drift**2 if name in (COEFFICIENT, WEAR) else 1e-12
    return names, whole


def _applied(law: Json, names: Sequence[str], found: Floats) -> dict[str, Any]:
    """A copy of a law, its parameters moved."""
    law = copy.deepcopy(law)
    for name, by in zip(names, found):
        if name == COEFFICIENT:
            law["coefficient_mm2_per_N"] *= math.exp(by)
        elif name == WEAR:
            for key in SCALES:
                law["wear"][key] *= math.exp(by)
        else:
            law[name] += float(by)
    return law


def _wear_slope(law: Json, belt: Any) -> float:
    """By how much ln k_t changes with the logarithm of the wear's scale."""
    low, high = (
        core.belt_remaining(laws.engine_wear(_applied(law, [WEAR], [by])), belt)
        for by in (-STEP, STEP)
    )
    return (math.log(max(high, 1e-12)) - math.log(max(low, 1e-12))) / (2.0 * STEP)


def _value(law: Json, name: str) -> float:
    if name == COEFFICIENT:
        return law["coefficient_mm2_per_N"]
    return law["wear"]["scale"] if name == WEAR else law[name]


def _interval(law: Json, name: str, variance: float) -> list[float]:
    quantile = float(core.student_quantile(0.975, laws.freedom(law)))
    value, half = _value(law, name), quantile * math.sqrt(max(variance, 0.0))
    if name in (COEFFICIENT, WEAR):
        return [value * math.exp(-half), value * math.exp(half)]
    return [value - half, value + half]
