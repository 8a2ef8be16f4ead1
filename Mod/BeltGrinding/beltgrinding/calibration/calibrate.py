"""Calibration of the removal law from a table of measured grinds (docs/calibration.md).

The parameters' robust least squares are in C++ (src/removal, calibration.h); here the data choose
which parameters are free, and the result becomes a job's law and a report.
"""

import json
import math
from pathlib import Path

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..engine import InputError, core
from . import report as calibration_report
from .law import law_of, predict, worn
from .model import DEFAULTS, INDEX, Model, correlations
from .part_scan import calibrate_from_scan
from .table import Table, from_columns, read

__all__ = ["fit", "fit_law", "predict", "calibrate_from_scan", "read", "write"]

# What each parameter is the effect of, for messages.
EFFECT = {  # of the parameters: code and English form
    "ln_coefficient": ("calibration.the_coefficient", "the coefficient"),
    "pressure_exponent": ("calibration.force", "force"),
    "speed_exponent": ("calibration.belt_speed", "belt speed"),
    "feed_exponent": ("calibration.feed", "feed"),
    "time_exponent": ("calibration.grind_time", "grind time"),
    "area_exponent": ("calibration.contact_area", "contact area"),
    "ln_wear_scale": ("calibration.belt_wear", "belt wear"),
    "wear_rest": ("calibration.the_rest", "the rest of the cut of a worn belt"),
    "pressure_threshold": ("calibration.the_threshold", "the pressure threshold"),
    "ln_saturation": ("calibration.the_saturation", "the saturation pressure"),
}
PRESSURE = ("pressure_exponent", "area_exponent")  # force and area
LEAST_SPREAD = 0.03  # standard deviation of ln(x) from which x varies at all
LEAST_GRINDS = 4
MOST_ERROR = 1.0  # standard error from which an exponent (or ln of a scale) is not determined
MOST_CORRELATION = 0.95
SINGULAR = 1e-7  # of the scaled information's eigenvalues: the parameters are one
GRINDS_PER_PARAMETER = 6  # from which a further parameter is tried
LEAST_ERRORS = 1.64  # standard errors by which it must differ from its default
FOLDS, ROUNDS = 5, 2
LEAST_GAIN = 0.5  # standard errors of the gain by which a further parameter must predict better


def fit(data, wheel_diameter_mm=None, wear_unit_J=1.0):
    """Calibrates the law. ``data``: path of a CSV, Table, or dict of columns; ``wear_unit_J``: the
    work of one unit of a wear number. Returns dict(law: a job's 'law', report: see
    calibration_report.report). Raises InputError.
    """
    _check_unit(wear_unit_J)
    model, found, free, warnings = _fitted(data, wheel_diameter_mm)
    warnings += _cautions(model, found, wear_unit_J)
    law = law_of(model, found, free, wear_unit_J)
    return {"law": law, "report": calibration_report.report(model, found, free, warnings)}


def fit_law(data, wheel_diameter_mm=None, wear_unit_J=1.0):
    """The law of ``fit`` without its report, which takes longer."""
    _check_unit(wear_unit_J)
    model, found, free, _ = _fitted(data, wheel_diameter_mm)
    return law_of(model, found, free, wear_unit_J)


def _effect(name):
    return core.Fact(*EFFECT[name])


def _check_unit(wear_unit_J):
    if not (math.isfinite(wear_unit_J) and wear_unit_J > 0):
        raise InputError(
            "calibration.wear_unit",
            "the work of one unit of wear must be a positive number of joules",
        )


def _fitted(data, wheel_diameter_mm):
    """(model, fit, free parameters, warnings)."""
    table = data
    if isinstance(data, dict):
        table = from_columns(data, wheel_diameter_mm)
    elif not isinstance(data, Table):
        table = read(data, wheel_diameter_mm)
    if len(table.measured) < LEAST_GRINDS:
        raise InputError(
            "calibration.too_few_rows",
            "{file}: {count} grinds are too few; give at least {least}",
            file=table.path,
            count=len(table.measured),
            least=LEAST_GRINDS,
        )
    model, warnings = Model(table), []
    free = ["ln_coefficient", *_varied(table, warnings)]
    while len(free) >= len(table.measured) - 1:
        warnings.append(
            core.Fact(
                "calibration.too_few_for",
                "too few grinds to tell the effect of {effect}; it is fixed",
                effect=_effect(free[-1]),
            )
        )
        free.pop()
    _name_inputs(table, warnings)
    free, found = _determined(model, free, warnings)
    free, found = _extended(model, free, found)
    _name_pairs(found, free, warnings)
    if not found["converged"]:
        warnings.append(
            core.Fact(
                "calibration.not_at_rest", "the fit has not come to rest: the figures are rough"
            )
        )
    return model, found, free, warnings


def _spread(values):
    values = values[np.isfinite(values)]
    return float(np.std(np.log(values))) if len(values) > 1 else 0.0


def _name_inputs(table, warnings):
    """Warns of inputs that move together in the data."""
    moving = table.feed > 0
    inputs = {
        "pressure_exponent": table.force,
        "speed_exponent": table.speed,
        "feed_exponent": np.where(moving, table.feed, math.nan),
        "time_exponent": np.where(moving, math.nan, table.time),
        "area_exponent": table.area,
        "ln_wear_scale": np.where(table.wear > 0, table.wear, math.nan),
    }
    names = [name for name, values in inputs.items() if _spread(values) > LEAST_SPREAD]
    for j, two in enumerate(names):
        for one in names[:j]:
            both = np.isfinite(inputs[one]) & np.isfinite(inputs[two])
            a, b = np.log(inputs[one][both]), np.log(inputs[two][both])
            if both.sum() < LEAST_GRINDS or np.ptp(a) == 0 or np.ptp(b) == 0:
                continue
            correlation = float(np.corrcoef(a, b)[0, 1])
            if abs(correlation) > MOST_CORRELATION and (one, two) == PRESSURE:
                warnings.append(  # as they do under any wheel
                    core.Fact(
                        "calibration.force_and_area",
                        "force and contact area move together in the data: that the mean pressure says "
                        "all of the area is an assumption",
                    )
                )
            elif abs(correlation) > MOST_CORRELATION:
                warnings.append(
                    core.Fact(
                        "calibration.together",
                        "{one} and {other} move together in the data (correlation {correlation:+.2f}), "
                        "which hardly separate their effects; vary them separately",
                        one=_effect(one),
                        other=_effect(two),
                        correlation=correlation,
                    )
                )


def _varied(table, warnings):
    """Parameters whose inputs the data vary."""
    names = []
    if max(_spread(table.force), _spread(table.force / table.area)) > LEAST_SPREAD:
        names.append("pressure_exponent")
    if _spread(table.speed) > LEAST_SPREAD:
        names.append("speed_exponent")
    moving = table.feed > 0
    if moving.any() and _spread(table.feed[moving]) > LEAST_SPREAD:
        names.append("feed_exponent")
    if table.wear_kind and np.ptp(table.wear) > LEAST_SPREAD * max(table.wear.max(), 1e-300):
        names.append("ln_wear_scale")
    for name in ("pressure_exponent", "speed_exponent"):
        if name not in names:
            warnings.append(
                core.Fact(
                    "calibration.not_varied",
                    "the data do not vary {effect}: the {parameter} stays {value:g}, an assumption",
                    effect=_effect(name),
                    parameter=name.replace("_", " "),
                    value=DEFAULTS[name],
                )
            )
    return names


def _determined(model, free, warnings):
    """Fixes what the data leave undetermined. Returns (free, fit)."""
    free = list(free)
    while True:
        found = model.fit(free)
        name = _undetermined(model, found, free, warnings)
        if name is None:
            return free, found
        free.remove(name)


def _undetermined(model, found, free, warnings):
    """The name of a free parameter to fix, having warned; or None."""
    at = [INDEX[name] for name in free]
    information = found["information"][np.ix_(at, at)]
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    if values[0] < SINGULAR * values[-1]:
        one, two = _two(free, np.abs(vectors[:, 0]))
        return _inseparable(one, two, warnings)
    errors = np.sqrt(np.diag(found["covariance"])[at])
    scatter = max(found["scatter"], 1e-3)
    classic = np.linalg.inv(information) * scatter**2
    errors = np.maximum(errors, np.sqrt(np.diag(classic)))
    correlation = classic / np.sqrt(np.outer(np.diag(classic), np.diag(classic)))
    for name in reversed(free[1:]):
        j = free.index(name)
        at_bound = found["at_bound"][INDEX[name]]
        if not at_bound and errors[j] < MOST_ERROR:
            continue
        others = np.abs(correlation[j]).copy()
        others[[0, j]] = 0.0
        other = int(others.argmax())
        if others[other] > MOST_CORRELATION and not at_bound:
            return _inseparable(free[min(j, other)], free[max(j, other)], warnings)
        if name == "ln_wear_scale":
            warnings.append(
                core.Fact(
                    "calibration.no_wear",
                    "the data show no wear of the belt that could be told; it is left out",
                )
            )
        else:
            default = DEFAULTS[name]
            reason = core.Fact("calibration.at_bound", "is at its bound")
            if not at_bound:
                reason = core.Fact(
                    "calibration.uncertain", "is uncertain by {by:.1f}", by=1.96 * errors[j]
                )
            warnings.append(
                core.Fact(
                    "calibration.undetermined",
                    "the data leave the effect of {effect} undetermined (it {reason}): the "
                    "{parameter} is fixed at {value:g}",
                    effect=_effect(name),
                    reason=reason,
                    parameter=name.replace("_", " "),
                    value=default,
                )
            )
        return name
    return None


def _two(free, sizes):
    """The two parameters, other than ln K if possible, that a direction joins most."""
    order = [k for k in np.argsort(-sizes) if k != 0] + [0]
    return tuple(free[k] for k in sorted(order[:2]))


def _inseparable(one, two, warnings):
    fixed = two if two != "ln_coefficient" else one
    warnings.append(
        core.Fact(
            "calibration.inseparable",
            "{one} and {other} move together in the data, which cannot separate their "
            "effects: {fixed} keeps its default and the other carries both; vary them "
            "separately",
            one=_effect(one),
            other=_effect(two),
            fixed=_effect(fixed),
        )
    )
    return fixed


def _name_pairs(found, free, warnings):
    """Warns of parameters that the data hardly separate."""
    correlation = correlations(found, free)
    for j in range(1, len(free)):
        for i in range(1, j):
            if abs(correlation[i, j]) > MOST_CORRELATION:
                warnings.append(
                    core.Fact(
                        "calibration.hardly_separate",
                        "the data hardly separate the effects of {one} and {other} (correlation "
                        "{correlation:+.2f})",
                        one=_effect(free[i]),
                        other=_effect(free[j]),
                        correlation=correlation[i, j],
                    )
                )


def _candidates(table, free):
    """Further parameters that the data could tell, the simplest first."""
    still = table.feed <= 0
    if still.sum() > 2 and _spread(table.time[still]) > 2 * LEAST_SPREAD:
        yield "time_exponent"
    if _spread(table.area) > 2 * LEAST_SPREAD and "pressure_exponent" in free:
        yield "area_exponent"
    if "ln_wear_scale" in free:
        yield "wear_rest"
    if "pressure_exponent" in free:
        yield from ("ln_saturation", "pressure_threshold")


def _extended(model, free, found):
    """Adds a parameter while cross-validation predicts better with it, by more than half the
    standard error of the gain (after Hastie, Tibshirani and Friedman, The Elements of Statistical
    Learning, 7.10), and differs from its default.
    """
    untried = list(_candidates(model.table, free))
    errors = None
    while untried and len(model.table.measured) >= GRINDS_PER_PARAMETER * (len(free) + 1):
        if errors is None:
            errors = _held_out(model, free, found)
        best = None
        for name in untried:
            longer = [*free, name]
            tried = model.fit(longer, _beginning(model, found, name))
            if not _told(tried, name) or _undetermined(model, tried, longer, []) is not None:
                continue
            theirs = _held_out(model, longer, tried)
            gain = errors - theirs
            mean = float(gain.mean())
            if mean > LEAST_GAIN * gain.std() / math.sqrt(len(gain)) and (
                best is None or mean > best[0]
            ):
                best = (mean, name, tried, theirs)
        if best is None:
            break
        _, name, found, errors = best
        free = [*free, name]
        untried.remove(name)
    return free, found


def _told(found, name):
    """Whether a parameter differs from its default by more than two standard errors."""
    k = INDEX[name]
    away = abs(found["parameters"][k] - DEFAULTS[name])
    return away > LEAST_ERRORS * math.sqrt(found["covariance"][k, k])


def _beginning(model, found, name):
    """Parameters to start from when ``name`` becomes free as well."""
    start = np.array(found["parameters"])
    low, high = model.bounds[name]
    default = DEFAULTS[name]
    start[INDEX[name]] = default if low < default < high else low + 0.4 * (high - low)
    return start


def _held_out(model, free, found):
    """|ln(measured/predicted)| of every grind, (n,), by repeated cross-validation."""
    random = np.random.default_rng(1)
    count = len(model.table.measured)
    truth = np.log(model.table.measured)
    total = np.zeros(count)
    for _ in range(ROUNDS):
        order = random.permutation(count)
        for fold in np.array_split(order, FOLDS):
            kept = np.setdiff1d(order, fold)
            part = model.fit(free, found["parameters"], kept)
            said, _, _ = model.predict(part["parameters"], part["shares"], fold)
            total[fold] += np.abs(truth[fold] - said)
    return total / ROUNDS


def _cautions(model, found, wear_unit):
    """What the reader of the result has to know."""
    table, notes = model.table, list(model.table.notes)
    exponent = found["parameters"][INDEX["time_exponent"]]
    if exponent != 1.0:
        given = {"exponent": exponent, "seconds": model.references["time"]}
        if exponent > 1:
            note = core.Fact(
                "calibration.faster_with_time",
                "removal grows as time^{exponent:.2f}: the law, linear in time, holds for grinds of "
                "about {seconds:g} s; short ones remove less, long ones more",
                **given,
            )
        else:
            note = core.Fact(
                "calibration.slower_with_time",
                "removal grows as time^{exponent:.2f}: the law, linear in time, holds for grinds of "
                "about {seconds:g} s",
                **given,
            )
        notes.append(note)
    delta = found["parameters"][INDEX["area_exponent"]]
    if delta != 0.0:
        notes.append(
            core.Fact(
                "calibration.area_exponent",
                "the mean pressure does not say all of the contact area: removal has a further "
                "factor area^{exponent:+.2f}, which the law cannot carry; it holds at about "
                "{area:g} mm²",
                exponent=delta,
                area=model.references["area"],
            )
        )
    if table.wear_kind == "number" and wear_unit == 1.0 and worn(found):
        notes.append(
            core.Fact(
                "calibration.wear_number",
                "the wear number has no unit of its own: the law's wear scale is in that number, "
                "where a job counts work in J; give the joules of one unit (--wear-unit) before "
                "use in a job",
            )
        )
    return notes


def write(data, path):
    """Writes a law, or a report, as JSON. Raises InputError."""
    try:
        write_whole(Path(path), (json.dumps(_plain(data), indent=2) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def _plain(value):
    """A copy that is JSON: what is not known (nan) becomes null."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
