"""Calibration of the removal law from a table of measured grinds (docs/calibration.md).

The parameters' robust least squares are in C++ (src/removal, calibration.h); here the data choose
which parameters are free, and the result becomes a job's law and a report.
"""

from __future__ import annotations
from collections.abc import Iterator, Sequence

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Array, Facts, Floats, Json
from ..engine import InputError, core
from . import contacts, loading, report as calibration_report
from .areas import of_unknown_areas
from .cautions import (
    LEAST_GRINDS,
    LEAST_SPREAD,
    MOST_CORRELATION,
    cautions,
    effect_of,
    is_told,
    name_inputs,
    name_pairs,
    name_unsure,
    spread_of,
)
from .law import law_of, predict
from .model import DEFAULTS, INDEX, PRIORS, Model
from .part_scan import calibrate_from_scan
from .table import Table, from_columns, read

__all__ = ["fit", "fit_law", "predict", "calibrate_from_scan", "read", "write"]

MOST_ERROR = 1.0  # standard error from which an exponent (or ln of a scale) is not determined
SINGULAR = 1e-7  # of the scaled information's eigenvalues: the parameters are one
# Of the evidence for a further parameter, very strong after Kass and Raftery, JASA 90, 1995.
STRONG = math.log(150.0)
# How the cut may fall: by a power; exponentially, to nothing or to a rest; with a break-in before.
BREAK_IN = ("first_share", "ln_first_ratio")
WEAR = (
    ("wear_exponent",),
    ("ln_wear_scale",),
    ("ln_wear_scale", "wear_rest"),
    ("ln_wear_scale", "wear_rest", *BREAK_IN),
)


def fit(
    data: Path | str | Table | dict[str, Any],
    wheel_diameter_mm: float | None = None,
    wear_unit_J: float = 1.0,
    machine: Json | None = None,
) -> dict[str, Any]:
    """Calibrates the law. ``data``: path of a CSV, Table, or dict of columns; ``wear_unit_J``: the
    work of one unit of a wear number; ``machine``: a job's validated belt_machine, whose wheel the
    grinds were done on where the table does not say it. Returns dict(law: a job's 'law', report: see
    calibration_report.report). Raises InputError.
    """
    _check_unit(wear_unit_J)
    contact = None if machine is None else contacts.of_machine(machine)
    model, found, free, warnings = _fitted(data, wheel_diameter_mm, contact)
    warnings += cautions(model, found, wear_unit_J)
    law = law_of(model, found, free, wear_unit_J, contact)
    return {
        "law": law,
        "report": calibration_report.report(model, found, free, warnings),
    }


def fit_law(
    data: Path | str | Table | dict[str, Any],
    wheel_diameter_mm: float | None = None,
    wear_unit_J: float = 1.0,
    machine: Json | None = None,
) -> dict[str, Any]:
    """The law of ``fit`` without its report, which takes longer."""
    _check_unit(wear_unit_J)
    contact = None if machine is None else contacts.of_machine(machine)
    model, found, free, _ = _fitted(data, wheel_diameter_mm, contact)
    return law_of(model, found, free, wear_unit_J, contact)


def _check_unit(wear_unit_J: float) -> None:
    if not (math.isfinite(wear_unit_J) and wear_unit_J > 0):
        raise InputError(
            "calibration.wear_unit",
            "the work of one unit of wear must be a positive number of joules",
        )


def _fitted(
    data: Table, wheel_diameter_mm: float | None, contact: Json | None = None
) -> tuple[Model, dict[str, Any], list[str], Facts]:
    """(model, fit, free parameters, warnings)."""
    table = data
    if isinstance(data, dict):
        table = from_columns(data, wheel_diameter_mm, contact=contact)
    elif not isinstance(data, Table):
        table = read(data, wheel_diameter_mm, contact=contact)
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
    if _worn(table):
        free = _with_wear(model, free)
    while len(free) >= len(table.measured) - 1:
        warnings.append(
            core.Fact(
                "calibration.too_few_for",
                "too few grinds to tell the effect of {effect}; it is fixed",
                effect=effect_of(free[-1]),
            )
        )
        free.pop()
    name_inputs(table, warnings)
    free, found = _determined(model, free, warnings)
    free, found = _extended(model, free, found)
    wear = (lambda names: _with_wear(model, names)) if _worn(table) else (lambda names: names)
    free, found = loading.fit(model, free, found, wear, warnings)
    found["between"] = _between(model, found, free) + of_unknown_areas(model, found)
    found["between"] += found.get("between_loading", 0.0)
    name_unsure(model, found, free, warnings)
    name_pairs(found, free, warnings)
    if not found["converged"]:
        warnings.append(
            core.Fact(
                "calibration.not_at_rest",
                "the fit has not come to rest: the figures are rough",
            )
        )
    return model, found, free, warnings


def _varied(table: Table, warnings: Facts) -> list[str]:
    """Parameters whose inputs the data vary."""
    names = []
    if max(spread_of(table.force), spread_of(table.force / table.area)) > LEAST_SPREAD:
        names.append("pressure_exponent")
    if spread_of(table.speed) > LEAST_SPREAD:
        names.append("speed_exponent")
    moving = table.feed > 0
    if moving.any() and spread_of(table.feed[moving]) > LEAST_SPREAD:
        names.append("feed_exponent")
    still = ~moving
    if still.sum() > 2 and spread_of(table.time[still]) > 2 * LEAST_SPREAD:
        names.append("time_exponent")
    if "pressure_exponent" in names and _area_apart(table):
        names.append("area_exponent")
    for name in ("pressure_exponent", "speed_exponent"):
        if name not in names:
            warnings.append(
                core.Fact(
                    "calibration.not_varied",
                    "the data do not vary {effect}: the {parameter} stays {value:g}, an assumption",
                    effect=effect_of(name),
                    parameter=name.replace("_", " "),
                    value=DEFAULTS[name],
                )
            )
    return names


def _area_apart(table: Table) -> bool:
    """Whether areas were varied apart from forces; solved contacts say all of theirs by the pressure."""
    known = np.isfinite(table.area)
    if np.isfinite(table.relative).any() or spread_of(table.area) <= 2 * LEAST_SPREAD:
        return False
    force, area = np.log(table.force[known]), np.log(table.area[known])
    return np.ptp(force) == 0 or abs(np.corrcoef(force, area)[0, 1]) < MOST_CORRELATION


def _worn(table: Table) -> bool:
    """Whether the belts were worn differently."""
    return bool(
        table.wear_kind and np.ptp(table.wear) > LEAST_SPREAD * max(table.wear.max(), 1e-300)
    )


def _with_wear(model: Model, free: list[str]) -> list[str]:
    """The parameters with those of the wear: a power's, which the belt's last grinds bend least, unless
    the data speak very strongly for another form."""
    forms = [[*free, *wear] for wear in WEAR]
    forms = [form for form in forms if len(form) < len(model.table.measured) - 1]
    if not forms:
        return free
    found = [model.evidence(model.fit(form), form) for form in forms]
    best = int(np.argmax(found))
    return forms[best if found[best] > found[0] + STRONG else 0]


def _between(model: Model, found: Json, free: Sequence[str]) -> Floats:
    """Covariance by which ln K and the exponents differ among the forms of the wear, each as likely as the
    data make it (Hoeting, Madigan, Raftery and Volinsky, Statistical Science 14, 1999); (k, k) of all
    parameters."""
    between = np.zeros((len(INDEX), len(INDEX)))
    common = [name for name in free if all(name not in form for form in WEAR)]
    if len(common) == len(free):
        return between
    away, evidence = [], []
    at = [INDEX[name] for name in common]
    for wear in WEAR:
        form = [*common, *wear]
        if len(form) >= len(model.table.measured) - 1:
            continue
        same = set(form) == set(free)
        other = found if same else model.fit(form)
        away.append(other["parameters"][at] - found["parameters"][at])
        evidence.append(model.evidence(other, form))
    if evidence:
        weights = np.exp(np.array(evidence) - max(evidence))
        for weight, one in zip(weights / weights.sum(), away):
            between[np.ix_(at, at)] += weight * np.outer(one, one)
    return between


def _determined(model: Model, free: list[str], warnings: Facts) -> tuple[list[str], dict[str, Any]]:
    """Fixes what the data leave undetermined. Returns (free, fit)."""
    free = list(free)
    while True:
        found = model.fit(free)
        name = _undetermined(model, found, free, warnings)
        if name is None:
            return free, found
        gone = {name}
        if name == "ln_wear_scale":
            gone |= {"wear_rest", *BREAK_IN}
        if name in BREAK_IN:
            gone |= {*BREAK_IN}
        free = [one for one in free if one not in gone]


def _undetermined(model: Model, found: Json, free: Sequence[str], warnings: Facts) -> str | None:
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
        if not at_bound and (errors[j] < MOST_ERROR or name in PRIORS):
            continue
        others = np.abs(correlation[j]).copy()
        others[[0, j]] = 0.0
        other = int(others.argmax())
        if others[other] > MOST_CORRELATION and not at_bound:
            return _inseparable(free[min(j, other)], free[max(j, other)], warnings)
        if name in ("ln_wear_scale", "wear_exponent"):
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
                    "calibration.uncertain",
                    "is uncertain by {by:.1f}",
                    by=1.96 * errors[j],
                )
            warnings.append(
                core.Fact(
                    "calibration.undetermined",
                    "the data leave the effect of {effect} undetermined (it {reason}): the "
                    "{parameter} is fixed at {value:g}",
                    effect=effect_of(name),
                    reason=reason,
                    parameter=name.replace("_", " "),
                    value=default,
                )
            )
        return name
    return None


def _two(free: Sequence[str], sizes: Array) -> tuple[str, ...]:
    """The two parameters, other than ln K if possible, that a direction joins most."""
    order = [k for k in np.argsort(-sizes) if k != 0] + [0]
    return tuple(free[k] for k in sorted(order[:2]))


def _inseparable(one: str, two: str, warnings: Facts) -> str:
    fixed = two if two != "ln_coefficient" else one
    warnings.append(
        core.Fact(
            "calibration.inseparable",
            "{one} and {other} move together in the data, which cannot separate their "
            "effects: {fixed} keeps its default and the other carries both; vary them "
            "separately",
            one=effect_of(one),
            other=effect_of(two),
            fixed=effect_of(fixed),
        )
    )
    return fixed


def _candidates(free: Sequence[str]) -> Iterator[str]:
    """Further parameters that the data could tell."""
    if "pressure_exponent" in free:
        yield from ("ln_saturation", "pressure_threshold")


def _extended(
    model: Model, free: list[str], found: dict[str, Any]
) -> tuple[list[str], dict[str, Any]]:
    """Adds a parameter while the data speak for it very strongly, and it differs from its default."""
    untried = list(_candidates(free))
    evidence = model.evidence(found, free)
    while untried:
        best = None
        for name in untried:
            longer = [*free, name]
            if len(longer) >= len(model.table.measured) - 1:
                continue
            tried = model.fit(longer, _beginning(model, found, name))
            if not is_told(tried, name) or _undetermined(model, tried, longer, []) is not None:
                continue
            theirs = model.evidence(tried, longer)
            if theirs > evidence + STRONG and (best is None or theirs > best[0]):
                best = (theirs, name, tried)
        if best is None:
            break
        evidence, name, found = best
        free = [*free, name]
        untried.remove(name)
    return free, found


def _beginning(model: Model, found: Json, name: str) -> Array:
    """Parameters to start from when ``name`` becomes free as well."""
    start = np.array(found["parameters"])
    low, high = model.bounds[name]
    default = DEFAULTS[name]
    start[INDEX[name]] = default if low < default < high else low + 0.4 * (high - low)
    return start


def write(data: Json, path: Path | str) -> None:
    """Writes a law, or a report, as JSON. Raises InputError."""
    try:
        write_whole(
            Path(path),
            (json.dumps(_plain(data), indent=2, allow_nan=False) + "\n").encode(),
        )
    except OSError as error:
        raise cannot_be_written(path, error) from None


def _plain(value: Any) -> Any:
    """A copy that is JSON: what is not known (nan) becomes null."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
