"""The report of a calibration: what is found, how sure it is, how well it predicts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Facts, Floats, Json
from . import model as c
from .law import LAW_NAMES, freedom, student, widening

if TYPE_CHECKING:
    from .model import Model
    from .table import Table

OUTLIER = 3.5  # scatters
MOST_LEFT_OUT = 150  # larger tables leave out several grinds at once


def report(model: Model, found: Json, free: Sequence[str], warnings: Facts) -> dict[str, Any]:
    """dict: parameters (list of name, value, low, high (95 %), unit, free), correlation (with
    'names'), condition (of the parameters' scaled information), r2 and rms_log (in-sample),
    scatter, references (where the coefficient holds, by unit), leave_one_out (median, p90: relative
    errors), outliers (lines of the file), ranges (by column), warnings, grinds, and the figures of
    the plot under 'rows'.
    """
    table = model.table
    said, gradient, area_variance = model.predict(found["parameters"], found["shares"])
    truth = np.log(table.measured)
    # A row whose area is unknown is judged by the area that it most probably has.
    fitted = truth - found["residual"]
    residual = found["residual"]
    at = [c.INDEX[name] for name in free]
    slopes = np.nan_to_num(gradient[:, at])
    covariance = found["covariance"][np.ix_(at, at)]
    deviation = np.sqrt(
        np.einsum("ni,ij,nj->n", slopes, covariance, slopes) + area_variance + found["scatter"] ** 2
    )
    deviation *= widening(model, found, free) * student(freedom(model, free)) / student(math.inf)
    left = left_out(model, free, found)
    relative = np.abs(np.expm1(left - truth))
    total = float(np.square(truth - truth.mean()).sum())
    information = found["information"][np.ix_(at, at)]
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    singular = np.linalg.svd(information / np.outer(size, size), compute_uv=False)
    outliers = np.abs(residual) > OUTLIER * found["scatter"]
    if outliers.any():
        lines = ", ".join(str(line) for line in table.lines[outliers])
        warnings = [
            *warnings,
            f"outliers, which hardly count: line {lines}; look at them",
        ]
    return {
        "grinds": len(truth),
        "parameters": _parameters(model, found, free),
        "correlation": {
            "names": list(free),
            "matrix": c.correlations(found, free).tolist(),
        },
        "condition": float(math.sqrt(singular[0] / max(singular[-1], 1e-300))),
        "r2": 1.0 - float(np.square(residual).sum()) / total if total > 0 else 0.0,
        "rms_log": float(np.sqrt(np.square(residual).mean())),
        "scatter": found["scatter"],
        "references": _references(model),
        "leave_one_out": {
            "median": float(np.median(relative)),
            "p90": float(np.quantile(relative, 0.9)),
        },
        "outliers": [int(line) for line in table.lines[outliers]],
        "ranges": ranges(table),
        "warnings": list(warnings),
        "rows": {
            "line": table.lines.tolist(),
            "measured": table.measured.tolist(),
            "predicted": np.exp(fitted).tolist(),
            "left_out": np.exp(left).tolist(),
            "ln_deviation": deviation.tolist(),
            "outlier": outliers.tolist(),
            "unit": "mm" if (table.spread != 1).all() else "mm3",
            **{name: values.tolist() for name, values in _inputs(table).items()},
        },
    }


def _references(model: Model) -> dict[str, float]:
    """Where the coefficient holds: {unit: value}."""
    at = model.references
    result = {"MPa": at["pressure"], "m/s": at["speed"] / 1000.0}
    if (model.table.feed > 0).any():
        result["mm/s"] = at["feed"]
    return result


def _inputs(table: Table) -> dict[str, Floats]:
    columns = {"force_N": table.force, "belt_speed_m_s": table.speed}
    if (table.feed <= 0).any():
        columns["time_s"] = np.where(table.feed > 0, np.nan, table.time)
    if (table.feed > 0).any():
        columns["feed_mm_s"] = np.where(table.feed > 0, table.feed, np.nan)
    columns["area_mm2"] = table.area
    columns["pressure_MPa"] = table.force / table.area
    if table.wear_kind:
        name = {"work": "work_J", "volume": "removed_so_far_mm3"}.get(table.wear_kind, "wear")
        columns[name] = table.wear
    return columns


def ranges(table: Table) -> dict[str, list[float]]:
    """{column: [least, greatest]} of the data, where the law is more than a guess."""
    return {
        name: [float(np.nanmin(values)), float(np.nanmax(values))]
        for name, values in _inputs(table).items()
    }


def left_out(model: Model, free: Sequence[str], found: Json) -> Floats:
    """ln of what each grind is predicted without it, (n,)."""
    count = len(model.table.measured)
    order = np.random.default_rng(2).permutation(count)
    said = np.empty(count)
    for fold in np.array_split(order, min(count, MOST_LEFT_OUT)):
        kept = np.setdiff1d(order, fold)
        part = model.fit(free, found["parameters"], kept)
        said[fold], _, _ = model.predict(part["parameters"], part["shares"], fold)
    return said


SHOWN = {  # name in the report, unit
    "ln_coefficient": ("coefficient", "mm2/N"),
    "pressure_exponent": ("pressure_exponent", ""),
    "speed_exponent": ("speed_exponent", ""),
    "feed_exponent": ("feed_exponent", ""),
    "time_exponent": ("time_exponent", ""),
    "area_exponent": ("area_exponent", ""),
    "ln_wear_scale": ("wear_scale", "wear"),
    "wear_rest": ("wear_rest", ""),
    "wear_exponent": ("wear_exponent", ""),
    "pressure_threshold": ("pressure_threshold", "MPa"),
    "ln_saturation": ("saturation_pressure", "MPa"),
    "grit_exponent": ("grit_exponent", ""),
    "cut_exponent": ("cut_exponent", ""),
    "first_share": ("break_in_share", ""),
    "ln_first_ratio": ("break_in_scale_ratio", ""),
    "loading_share": ("loading_share", ""),
}


def _parameters(model: Model, found: Json, free: Sequence[str]) -> list[dict[str, Any]]:
    quantile = student(freedom(model, free))
    rows = []
    for name, k in c.INDEX.items():
        value = float(found["parameters"][k])
        shown, unit = SHOWN[name]
        if unit == "wear":
            unit = {"work": "J", "volume": "mm3"}.get(model.table.wear_kind, "wear")
        half = quantile * math.sqrt(found["covariance"][k, k] + found["between"][k, k])
        low, high = value - half, value + half
        if name.startswith("ln_"):
            value, low, high = (_exp(x) for x in (value, low, high))
        row = {"name": shown, "value": value, "unit": unit, "free": name in free}
        if name in free:
            row.update(low=low, high=high)
        elif name not in LAW_NAMES:
            continue  # a part of the law that is not there
        rows.append(row)
    return rows


def _exp(value: float) -> float:
    return math.exp(min(value, 700.0))


def text(report: Json) -> str:
    """The report as lines for people."""
    lines = [
        f"{report['grinds']} grinds",
        "parameter            value      95 % interval",
    ]
    for one in report["parameters"]:
        interval = f"{one['low']:.4g} to {one['high']:.4g}" if one["free"] else "fixed"
        unit = f" {one['unit']}" if one["unit"] else ""
        lines.append(f"{one['name']:20s} {one['value']:<10.4g} {interval}{unit}")
    left, at = report["leave_one_out"], report["references"]
    holds = ", ".join(f"{value:.4g} {unit}" for unit, value in at.items())
    lines.append(f"the coefficient holds at {holds}; the exponents tell of elsewhere")
    lines.append(
        f"left-out grinds: median error {100 * left['median']:.1f} %, 90 % below "
        f"{100 * left['p90']:.0f} %; R2 of the logarithms {report['r2']:.3f}, "
        f"rms {report['rms_log']:.3f}"
    )
    covered = "; ".join(f"{key} {a:.4g} to {b:.4g}" for key, (a, b) in report["ranges"].items())
    return "\n".join([*lines, f"covered: {covered}"])
