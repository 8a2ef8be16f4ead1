"""Calibration of the finish from a table of measured roughnesses (docs/finish.md).

Ra = c (grit / grit_ref)^a (p / p_ref)^b (V_b / V_ref)^d (V_w / V_w,ref)^e k^f, by the robust least squares of the
removal law's calibration (C++, src/removal), without anything known before: an effect that the measurements do not
vary is none, and the model holds for that one value only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json
from ..engine import InputError, core
from .cautions import LEAST_SPREAD, MOST_CORRELATION, effect_of, spread_of, together
from .finish_table import FinishTable, from_columns, read
from .law import student
from .model import DEFAULTS, INDEX, NAMES

__all__ = ["FinishTable", "fit_finish", "predict", "read", "text"]

# Key of the job's model, parameter of the fit, attribute of the table.
EFFECTS = (
    ("grit_exponent", "grit_exponent", "grit"),
    ("pressure_exponent", "pressure_exponent", "pressure"),
    ("belt_speed_exponent", "speed_exponent", "speed"),
    ("feed_exponent", "feed_exponent", "feed"),
    ("wear_exponent", "cut_exponent", "cut"),
)
RANGES = {
    "grit": "grit",
    "pressure_MPa": "pressure",
    "belt_speed_m_s": "speed",
    "feed_mm_s": "feed",
    "remaining_cut": "cut",
}
LEAST_FREEDOM = 3  # measurements more than parameters
MOST_ERROR = 1.0  # standard error from which an exponent is not determined
SINGULAR = 1e-7  # of the scaled information's eigenvalues: two effects are one
STEEPEST = 6.0  # bound of the exponents
MOST_REST = 0.95
LEAST_REST_ROWS = 3  # measurements after different numbers of passes
# Of a measured Ra: what is told of many passes at least. Less is scatter of a place that few passes have hardly changed.
LEAST_TOLD = 0.05
OUTLIER = 3.5  # scatters


def fit_finish(
    data: Path | str | FinishTable | dict[str, Any],
    remaining_cut: Callable[[float, float], float] | None = None,
    source: str = "",
    context: Context = None,
) -> dict[str, Any]:
    """Calibrates the finish. ``data``: path of a CSV, FinishTable, or dict of columns; ``remaining_cut``: as of
    ``finish_table.from_columns``. Returns dict(model: of a job's ``finish``, report: measurements, parameters (name,
    value, low, high (95 %), free), rest_per_pass (value, low, high) or None, scatter, left_out and plain (median, p90 of
    the relative errors: by the model, by a constant Ra, by the grit alone), outliers (lines), ranges, warnings).
    ``context``: a core.RunContext. Raises InputError for what the measurements do not tell, and Cancelled.
    """
    table, context = data, context or core.RunContext()
    if isinstance(data, dict):
        table = from_columns(data, remaining_cut=remaining_cut)
    elif not isinstance(data, FinishTable):
        table = read(data, remaining_cut)
    warnings = list(table.notes)
    free = ["ln_coefficient", *_varied(table, warnings)]
    count = len(table.measured)
    if count < len(free) + LEAST_FREEDOM:
        raise InputError(
            "calibration.finish_too_few",
            "{file}: {count} measurements are too few for {parameters} effects; give at least {least}, or vary less",
            file=table.path,
            count=count,
            parameters=len(free),
            least=len(free) + LEAST_FREEDOM,
        )
    _name_pairs(table, free, warnings)
    references = _references(table)
    rest, error = _rest(table, free, references)
    if rest is None:
        warnings.append(
            core.Fact(
                "calibration.finish_no_rest",
                "no measurements after different numbers of passes from a known roughness: how many passes it takes is "
                "not known, each is taken as measured",
            )
        )
    found = _fit(table, free, references, rest)
    _check(table, found, free)
    own = found["parameters"]
    quantile = student(count - len(free))
    residual = np.log(table.measured) - _say(table, own, references, rest)
    outliers = np.abs(residual) > OUTLIER * found["scatter"]
    if outliers.any():
        warnings.append(
            core.Fact(
                "calibration.finish_outliers",
                "outliers, which hardly count: line {lines}; look at them",
                lines=", ".join(str(line) for line in table.lines[outliers]),
            )
        )
    deviation = (
        float(_deviation(table, found, free, references).max()) * quantile / student(math.inf)
    )
    ranges = {
        key: [float(getattr(table, name).min()), float(getattr(table, name).max())]
        for key, name in RANGES.items()
    }
    model = {
        "coefficient_um": _reference_roughness(own, references),
        **{key: float(own[INDEX[name]]) for key, name, _ in EFFECTS},
        "reference_grit": references["grit"],
        "reference_pressure_MPa": references["pressure"],
        "reference_belt_speed_m_s": references["speed"] / 1000.0,
        "reference_feed_mm_s": references["feed"],
        **({} if rest is None else {"rest_per_pass": rest}),
        "ln_deviation": deviation,
        "ranges": ranges,
        "source": source or str(table.path),
        "calibration": {
            "parameters": list(free),
            "covariance": found["covariance"][np.ix_(*2 * [_at(free)])].tolist(),
            "scatter": found["scatter"],
            "measurements": count,
        },
    }
    told = None
    if rest is not None:
        low, high = max(rest - quantile * error, 0.0), min(rest + quantile * error, 1.0)
        told = {"value": rest, "low": low, "high": high}
    report = {
        "measurements": count,
        "parameters": _parameters(model, found, free, quantile),
        "rest_per_pass": told,
        "scatter": found["scatter"],
        "ln_deviation": deviation,
        "left_out": _errors(
            table, _left_out(table, free, references, rest, context.part(0.1, 0.8))
        ),
        "plain": _plain(table, references, context.part(0.8, 1.0)),
        "outliers": [int(line) for line in table.lines[outliers]],
        "ranges": ranges,
        "warnings": warnings,
    }
    return {"model": model, "report": report}


def predict(model: Json, table: FinishTable) -> Floats:
    """(n,) Ra, um, that a job's finish model tells for the rows of a FinishTable; NaN outside of its ranges."""
    ratio = {
        "grit_exponent": table.grit / model["reference_grit"],
        "pressure_exponent": table.pressure / model["reference_pressure_MPa"],
        "belt_speed_exponent": table.speed / model["reference_belt_speed_m_s"],
        "feed_exponent": table.feed / model["reference_feed_mm_s"],
        "wear_exponent": table.cut,
    }
    told = np.full(len(table.feed), model["coefficient_um"])
    for key, values in ratio.items():
        told *= values ** model[key]
    left = np.nan_to_num(model.get("rest_per_pass", 0.0) ** np.nan_to_num(table.passes, nan=np.inf))
    told = np.where(left > 0.0, told + left * (np.nan_to_num(table.initial) - told), told)
    for key, name in RANGES.items():
        low, high = widened(model["ranges"][key])
        values = getattr(table, name)
        told[(values < low) | (values > high)] = np.nan
    return told


def widened(span: Sequence[float]) -> tuple[float, float]:
    """A range of what was measured, by what counts as the same."""
    return span[0] * (1.0 - LEAST_SPREAD), span[1] * (1.0 + LEAST_SPREAD)


def _at(free: Sequence[str]) -> list[int]:
    return [INDEX[name] for name in free]


def _varied(table: FinishTable, warnings: Facts) -> list[str]:
    """Parameters whose inputs the measurements vary."""
    names = []
    for _, name, column in EFFECTS:
        if spread_of(getattr(table, column)) > LEAST_SPREAD:
            names.append(name)
        else:
            warnings.append(
                core.Fact(
                    "calibration.finish_not_varied",
                    "the measurements do not vary {effect}: the model holds for {value:.4g} only",
                    effect=effect_of(name),
                    value=float(np.median(getattr(table, column))),
                )
            )
    return names


def _name_pairs(table: FinishTable, free: Sequence[str], warnings: Facts) -> None:
    """Warns of inputs that move together."""
    inputs = [(name, np.log(getattr(table, column))) for _, name, column in EFFECTS if name in free]
    for j, (two, b) in enumerate(inputs):
        for one, a in inputs[:j]:
            correlation = float(np.corrcoef(a, b)[0, 1])
            if abs(correlation) > MOST_CORRELATION:
                warnings.append(together(one, two, correlation))


def _references(table: FinishTable) -> dict[str, float]:
    """Geometric means, to three digits."""
    middle = lambda values: float(f"{math.exp(float(np.log(values).mean())):.3g}")
    return {
        "grit": middle(table.grit),
        "pressure": middle(table.pressure),
        "speed": 1000.0 * middle(table.speed),
        "feed": middle(table.feed),
    }


def _steady(table: FinishTable, rest: float | None) -> Floats:
    """(n,) um: what each measurement tells of the roughness that many passes leave."""
    if rest is None:
        return table.measured
    known = np.isfinite(table.passes) & np.isfinite(table.initial)
    left = np.where(known, rest ** np.where(known, table.passes, 1.0), 0.0)
    told = (table.measured - left * np.where(known, table.initial, 0.0)) / (1.0 - left)
    return np.maximum(told, LEAST_TOLD * table.measured)


def _arguments(table: FinishTable, measured: Floats) -> dict[str, Any]:
    """As core.log_grinds takes them: a depth over an area of 1 in a time of 1."""
    one = np.ones(len(measured))
    return {
        "force": table.pressure,
        "area": one,
        "speed": 1000.0 * table.speed,
        "feed": table.feed,
        "time": one,
        "wear": 0.0 * one,
        "spread": one,
        "grit": table.grit,
        "cut": table.cut,
        "measured": measured,
    }


def _fit(
    table: FinishTable, free: Sequence[str], references: Json, rest: float | None, start: Any = None
) -> dict[str, Any]:
    arguments = _arguments(table, _steady(table, rest))
    if start is None:
        start = np.array([DEFAULTS[name] for name in NAMES])
        for _, name, _ in EFFECTS:
            start[INDEX[name]] = 0.0
        said, _ = core.log_grinds(start, arguments, references)
        start[0] += np.median(np.log(arguments["measured"]) - said)
    lower, upper = start.copy(), start.copy()
    for name in free:
        k = INDEX[name]
        lower[k], upper[k] = (-80.0, 40.0) if k == 0 else (-STEEPEST, STEEPEST)
    nothing, unsure = np.zeros(len(NAMES)), np.full(len(NAMES), math.inf)
    chosen = [name in free for name in NAMES]
    return core.calibrate(arguments, references, start, lower, upper, chosen, nothing, unsure)


def _say(table: FinishTable, parameters: Any, references: Json, rest: float | None) -> Floats:
    """(n,) ln of the Ra that is told for each row, after its passes."""
    said, _ = core.log_grinds(parameters, _arguments(table, table.measured), references)
    if rest is None:
        return said
    known = np.isfinite(table.passes) & np.isfinite(table.initial)
    left = np.where(known, rest ** np.where(known, table.passes, 1.0), 0.0)
    return np.log((1.0 - left) * np.exp(said) + left * np.where(known, table.initial, 0.0))


def _rest(
    table: FinishTable, free: Sequence[str], references: Json
) -> tuple[float, float] | tuple[None, None]:
    """(share that a pass leaves, its standard error), by the least sum of |ln| errors; (None, None) where the
    measurements do not tell."""
    known = np.isfinite(table.passes) & np.isfinite(table.initial)
    if known.sum() < LEAST_REST_ROWS or len(np.unique(table.passes[known])) < 2:
        return None, None

    def loss(rest: float) -> float:
        own = _fit(table, free, references, rest)["parameters"]
        return float(np.abs(np.log(table.measured) - _say(table, own, references, rest)).sum())

    coarse = np.linspace(0.0, MOST_REST, 20)
    best = int(np.argmin([loss(rest) for rest in coarse]))
    low, high = coarse[max(best - 1, 0)], coarse[min(best + 1, len(coarse) - 1)]
    golden = 0.5 * (math.sqrt(5.0) - 1.0)
    while high - low > 1e-3:
        one, two = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, two) if loss(one) <= loss(two) else (one, high)
    rest = 0.5 * (low + high)
    found = _fit(table, free, references, rest)
    step = 1e-4
    slope = (
        _say(table, found["parameters"], references, rest + step)
        - _say(table, found["parameters"], references, max(rest - step, 0.0))
    ) / (step + min(step, rest))
    _, gradient = core.log_grinds(
        found["parameters"], _arguments(table, table.measured), references
    )
    others = gradient[:, _at(free)]
    apart = slope - others @ np.linalg.lstsq(others, slope, rcond=None)[0]
    return rest, found["scatter"] / max(float(np.linalg.norm(apart)), 1e-12)


def _check(table: FinishTable, found: Json, free: Sequence[str]) -> None:
    """Raises InputError for an effect that the measurements leave open."""
    errors = np.sqrt(np.diag(found["covariance"]))
    information = found["information"][np.ix_(*2 * [_at(free)])]
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    one_effect = np.zeros(len(free), dtype=bool)  # that several inputs have together
    if values[0] < SINGULAR * values[-1]:
        one_effect = np.abs(vectors[:, 0]) > 0.1
    for j, name in enumerate(free[1:], 1):
        k = INDEX[name]
        if found["at_bound"][k] or not errors[k] < MOST_ERROR or one_effect[j]:
            raise InputError(
                "calibration.finish_undetermined",
                "{file}: the measurements leave the effect of {effect} on the roughness undetermined; vary it apart "
                "from the others, or measure more",
                file=table.path,
                effect=effect_of(name),
            )


def _deviation(table: FinishTable, found: Json, free: Sequence[str], references: Json) -> Floats:
    """(n,) standard deviation of ln Ra of a new measurement at each row."""
    _, gradient = core.log_grinds(
        found["parameters"], _arguments(table, table.measured), references
    )
    slopes = gradient[:, _at(free)]
    covariance = found["covariance"][np.ix_(*2 * [_at(free)])]
    return np.sqrt(np.einsum("ni,ij,nj->n", slopes, covariance, slopes) + found["scatter"] ** 2)


def _reference_roughness(parameters: Any, references: Json) -> float:
    return math.exp(parameters[0]) * references["speed"] * references["pressure"]


def _parameters(
    model: Json, found: Json, free: Sequence[str], quantile: float
) -> list[dict[str, Any]]:
    rows = []
    for key, name in [
        ("coefficient_um", "ln_coefficient"),
        *[effect[:2] for effect in EFFECTS],
    ]:
        k = INDEX[name]
        half = quantile * math.sqrt(found["covariance"][k, k])
        row = {"name": key, "value": model[key], "free": name in free}
        if name == "ln_coefficient":
            row.update(low=row["value"] * math.exp(-half), high=row["value"] * math.exp(half))
        elif name in free:
            row.update(low=row["value"] - half, high=row["value"] + half)
        rows.append(row)
    return rows


def _left_out(
    table: FinishTable,
    free: Sequence[str],
    references: Json,
    rest: float | None,
    context: core.RunContext,
) -> Floats:
    """(n,) um: what is told of each measurement by the others."""
    count = len(table.measured)
    told = np.empty(count)
    for i in range(count):
        context.throw_if_cancelled()
        context.report(i / count)
        others = table.take(np.arange(count) != i)
        own = _fit(others, free, references, rest)["parameters"]
        told[i] = math.exp(_say(table.take([i]), own, references, rest)[0])
    return told


def _errors(table: FinishTable, told: Floats) -> dict[str, float]:
    relative = np.abs(told / table.measured - 1.0)
    return {
        "median": float(np.median(relative)),
        "p90": float(np.quantile(relative, 0.9)),
    }


def _plain(table: FinishTable, references: Json, context: core.RunContext) -> dict[str, Any]:
    """Errors of left-out measurements by plainer ways: one Ra for all; one by the grit alone."""
    one = _left_out(table, ["ln_coefficient"], references, None, context.part(0.0, 0.5))
    plain = {"constant": _errors(table, one)}
    if spread_of(table.grit) > LEAST_SPREAD:
        free = ["ln_coefficient", "grit_exponent"]
        grit = _left_out(table, free, references, None, context.part(0.5, 1.0))
        plain["grit_only"] = _errors(table, grit)
    return plain


def text(report: Json) -> str:
    """The report as lines for people."""
    lines = [
        f"{report['measurements']} measurements",
        "parameter            value      95 % interval",
    ]
    for one in report["parameters"]:
        interval = f"{one['low']:.4g} to {one['high']:.4g}" if one["free"] else "not varied"
        lines.append(f"{one['name']:20s} {one['value']:<10.4g} {interval}")
    rest = report["rest_per_pass"]
    if rest is not None:
        lines.append(
            f"{'rest_per_pass':20s} {rest['value']:<10.4g} {rest['low']:.4g} to {rest['high']:.4g}"
        )
    names = {"constant": "one Ra for all", "grit_only": "by the grit alone"}
    others = [("the model", report["left_out"])]
    others += [(names[key], errors) for key, errors in report["plain"].items()]
    for name, errors in others:
        lines.append(
            f"left-out measurements, {name}: median error {100 * errors['median']:.1f} %, 90 % below "
            f"{100 * errors['p90']:.0f} %"
        )
    lines.append(
        "holds within: "
        + "; ".join(
            f"{key} {low:.4g} to {high:.4g}" for key, (low, high) in report["ranges"].items()
        )
    )
    return "\n".join(lines)
