"""A calibrated law: a job's 'law' from a fit, and what it predicts of further grinds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Floats, Json
from ..engine import InputError, core
from . import loading
from .model import DEFAULTS, INDEX, NAMES, Model
from .table import Table, from_columns, read, with_areas

# What a law's 'calibration' carries: ln K, the exponents, and what else a job's law has.
LAW_NAMES = {
    "ln_coefficient": "coefficient",
    "pressure_exponent": "pressure_exponent",
    "speed_exponent": "speed_exponent",
    "feed_exponent": "feed_exponent",
}
CARRIED = {
    **LAW_NAMES,
    **{
        name: name
        for name in (
            "ln_wear_scale",
            "wear_rest",
            "wear_exponent",
            "first_share",
            "ln_first_ratio",
            "loading_share",
            "pressure_threshold",
            "ln_saturation",
        )
    },
}

ASSUMED = ("pressure_exponent", "speed_exponent")  # 1 where they were not varied
CURVES = ("pressure_curve", "speed_curve", "feed_curve")
LOADING_SCALE = 1e4  # J or mm3, of a law that gives none: as the job's schema has it
LEAST_LEFT = 0.05  # of a grind's variance, once it has pulled the fit to itself


def worn(found: Json) -> bool:
    return math.isfinite(found["parameters"][INDEX["ln_wear_scale"]])


def student(freedom: float, share: float = 0.95) -> float:
    """Student's t within which ``share`` lies; freedom inf: of the normal distribution."""
    return float(core.student_quantile(0.5 + 0.5 * share, freedom))


def freedom(model: Model, free: Sequence[str]) -> int:
    """Degrees of freedom of a fit's scatter."""
    hidden = loading.HIDDEN if model.loading else 0
    return max(len(model.table.measured) - len(free) - hidden, 1)


def half_width(calibration: Json, share: float = 0.95) -> float:
    """Deviations of a law's calibration on each side within which ``share`` of new grinds lie."""
    quantile = student(calibration.get("freedom", math.inf), share)
    # A law of an earlier version has both in one factor, for 95 %.
    return quantile * calibration.get("widening", calibration.get("fit", {}).get("widening", 1.0))


def widening(model: Model, found: Json, free: Sequence[str]) -> float:
    """Factor, at least 1, by which the grinds, each predicted without itself, scatter beyond Student's t (the
    quantile of conformal prediction, Barber, Candes, Ramdas and Tibshirani, Annals of Statistics 49, 2021; the
    leverages stand for leaving out).
    """
    said, gradient, area_variance = model.predict(found["parameters"], found["shares"])
    slopes = np.nan_to_num(gradient[:, [INDEX[name] for name in free]])
    own = np.einsum("ni,ij,nj->n", slopes, model.posterior(found, free), slopes)
    variance = found["scatter"] ** 2
    left = np.maximum(variance - own, LEAST_LEFT * variance) + area_variance
    sizes = np.abs(np.log(model.table.measured) - said) / np.sqrt(left)
    sizes = np.sort(sizes[found["weight"] > 0])  # blunders are none of it
    count = len(sizes)
    if not count:
        return 1.0
    rank = min(round(0.95 * (count + 1)), count)
    beyond = sizes[rank - 1] / student(freedom(model, free), rank / (count + 1))
    return max(1.0, float(beyond))


def law_of(
    model: Model,
    found: Json,
    free: Sequence[str],
    wear_unit: float,
    contact: Json | None = None,
) -> dict[str, Any]:
    """The 'law' of a job; ``contact``: of the grinds, as far as the table does not say it."""
    x = {name: float(found["parameters"][k]) for name, k in INDEX.items()}
    wear, kind = {"model": "none"}, model.table.wear_kind
    unit = wear_unit if kind == "number" else 1.0
    if worn(found):
        wear = {
            "model": "exponential",
            "variable": "volume" if kind == "volume" else "work",
            "scale": math.exp(x["ln_wear_scale"]) * unit,
            "rest": x["wear_rest"],
        }
        if math.isfinite(x["wear_exponent"]):
            wear.update(model="power", rest=0.0, exponent=x["wear_exponent"])
        elif x["first_share"] > 0.0:
            wear.update(
                model="two_stage",
                first_share=(1.0 - x["wear_rest"]) * x["first_share"],
                first_scale=wear["scale"] * math.exp(x["ln_first_ratio"]),
            )
    if model.loading:
        wear.setdefault("variable", "volume" if kind == "volume" else "work")
        wear.update(
            loading_share=x["loading_share"],
            loading_scale=model.loading[0],
            loading_recovery_s=model.loading[1],
        )
    assumed = [name for name in ASSUMED if name not in free]
    own = [*(name for name in free if name in CARRIED), *assumed]
    everything = [INDEX[name] for name in free]
    saturation = x["ln_saturation"]
    return {
        "model": "local",
        "coefficient_mm2_per_N": math.exp(x["ln_coefficient"]),
        "pressure_threshold_MPa": x["pressure_threshold"],
        "pressure_exponent": x["pressure_exponent"],
        "reference_pressure_MPa": model.references["pressure"],
        "saturation_pressure_MPa": math.exp(saturation) if math.isfinite(saturation) else 0.0,
        "speed_exponent": x["speed_exponent"],
        "reference_speed_m_s": model.references["speed"] / 1000.0,
        "feed_exponent": x["feed_exponent"],
        "reference_feed_mm_s": model.references["feed"],
        **{key: [] for key in CURVES},  # a curve would replace what is found here
        "wear": wear,
        "calibration": {
            "parameters": [CARRIED[name] for name in own],
            "covariance": _covariance(model, found, own, assumed).tolist(),
            "scatter": found["scatter"],
            "freedom": freedom(model, free),
            "widening": widening(model, found, free),
            "fit": {
                "parameters": list(free),
                "covariance": found["covariance"][np.ix_(everything, everything)].tolist(),
                "grinds": len(model.table.measured),
                "contacts_known": int(np.isfinite(model.table.relative).all(axis=1).sum()),
                **({"contact": contact} if contact else {}),
                "time_exponent": x["time_exponent"],
                "reference_time_s": model.references["time"],
                "area_exponent": x["area_exponent"],
                "reference_area_mm2": model.references["area"],
                "areas_mm2": model.areas.tolist(),
                "pressure_profile": [float(one) for one in model.profile],
                "area_shares": [float(share) for share in found["shares"]],
                "wear_kind": model.table.wear_kind,
                "wear_unit_J": unit,
                "mean_wear": unit * float(model.table.wear.mean()),
                **(
                    {"mean_loading": float(model.arguments["loading"].mean())}
                    if model.loading
                    else {}
                ),
            },
        },
    }


def _covariance(model: Model, found: Json, names: Sequence[str], assumed: Sequence[str]) -> Floats:
    """(k, k) of the parameters that a law carries; of those ``assumed``, which the data do not vary, what is published."""
    at = [INDEX[name] for name in names]
    covariance: Floats = (found["covariance"] + found["between"])[np.ix_(at, at)]
    for name in assumed:
        k, (mean, deviation) = names.index(name), model.priors[name]
        covariance[k, k] += deviation**2 + (mean - DEFAULTS[name]) ** 2
    if "first_share" not in names:
        return covariance
    # A job's first share is of the whole cut, not of what wears.
    turn, k = np.eye(len(names)), names.index("first_share")
    turn[k, k] = 1.0 - found["parameters"][INDEX["wear_rest"]]
    if "wear_rest" in names:
        turn[k, names.index("wear_rest")] = -found["parameters"][INDEX["first_share"]]
    return turn @ covariance @ turn.T


def predict(
    law: Json,
    rows: Table | Path | str | dict[str, Any] | list[dict[str, Any]],
    wheel_diameter_mm: float | None = None,
) -> dict[str, Any]:
    """What a law says of grinds. ``rows``: Table, path, dict of columns or list of dicts, with the
    columns of a calibration (the removal is not needed; without wear, the calibration's mean;
    without areas, those of the calibration). Returns dict(predicted (n,) mm3, or mm
    where the table gives depths; deviation (n,): of a new measurement in the same unit;
    ln_deviation (n,): of its logarithm, 1.96 of which hold 95 %). Raises InputError.
    """
    contact = law.get("calibration", {}).get("fit", {}).get("contact")
    if isinstance(rows, list):
        keys = {key: None for row in rows for key in row}
        rows = {key: [row.get(key, "") for row in rows] for key in keys}
    if isinstance(rows, dict):
        rows = from_columns(rows, wheel_diameter_mm, False, contact=contact)
    elif not isinstance(rows, Table):
        rows = read(rows, wheel_diameter_mm, False, contact)
    rows = rows._replace(measured=np.ones(len(rows.force)))
    fitted = law.get("calibration", {}).get("fit", {})
    parameters, references, unit = _of_law(law, fitted)
    rows = _with_wear(rows, law, fitted, unit)
    if not fitted:
        rows = with_areas(rows)
    profile = fitted.get("pressure_profile")
    if profile is not None and len(profile) == 1:  # fitted to mean pressures
        rows = rows._replace(relative=np.full((len(rows.force), 1), math.nan))
    model = Model(rows, references, fitted.get("areas_mm2"), profile)
    model.load(_loading(rows, law, fitted))
    shares = fitted.get("area_shares") or [1.0 / len(model.areas)] * len(model.areas)
    mean, gradient, variance = model.predict(parameters, shares)
    if fitted:
        at = [INDEX[name] for name in fitted["parameters"]]
        slopes = np.nan_to_num(gradient[:, at])
        variance = variance + np.einsum(
            "ni,ij,nj->n", slopes, np.asarray(fitted["covariance"]), slopes
        )
    deviation = np.sqrt(variance + law.get("calibration", {}).get("scatter", 0.0) ** 2)
    deviation = deviation * half_width(law.get("calibration", {})) / student(math.inf)
    value = np.exp(mean)
    return {
        "predicted": value,
        "deviation": value * deviation,
        "ln_deviation": deviation,
    }


def compare(law: Json, path: Path | str, wheel_diameter_mm: float | None = None) -> dict[str, Any]:
    """Predicts the grinds of a CSV, and lays them beside the removal where the file has it. Returns
    dict(lines, predicted, deviation, measured: (n,), nan where not known; figures: dict; notes).
    Raises InputError.
    """
    contact = law.get("calibration", {}).get("fit", {}).get("contact")
    table = read(path, wheel_diameter_mm, False, contact)
    told = predict(law, table)
    try:
        measured = read(path, wheel_diameter_mm).measured
    except InputError:  # a file of grinds to come
        measured = np.full(len(table.force), math.nan)
    figures = {
        "grinds": len(table.force),
        "deviation_median": float(np.median(told["ln_deviation"])),
    }
    if np.isfinite(measured).all():
        errors = np.abs(told["predicted"] / measured - 1.0)
        outside = np.abs(np.log(measured / told["predicted"])) > 1.96 * told["ln_deviation"]
        figures["error_median"] = float(np.median(errors))
        figures["error_p90"] = float(np.quantile(errors, 0.9))
        figures["inside_95_interval"] = float(1.0 - outside.mean())
    return {
        "lines": table.lines,
        "predicted": told["predicted"],
        "deviation": told["deviation"],
        "measured": measured,
        "figures": figures,
        "notes": table.notes,
    }


def write_predictions(found: Json, path: Path | str) -> None:
    """Writes what ``compare`` gave as a CSV. Raises InputError."""
    lines = ["line,predicted,standard_deviation,measured"]
    for row in zip(*(found[key] for key in ("lines", "predicted", "deviation", "measured"))):
        known = "" if math.isnan(row[3]) else f"{row[3]:.6g}"
        lines.append(f"{row[0]},{row[1]:.6g},{row[2]:.6g},{known}")
    try:
        write_whole(Path(path), ("\n".join(lines) + "\n").encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def _with_wear(rows: Table, law: Json, fitted: Json, unit: float) -> Table:
    """The rows with the belt's wear as the law counts it; the calibration's mean if not known."""
    if law.get("wear", {}).get("model", "none") == "none":
        return rows
    kind = fitted.get("wear_kind", "")
    if not rows.wear_kind:
        return rows._replace(wear=np.full(len(rows.force), fitted.get("mean_wear", 0.0)))
    counted = "volume" if law["wear"].get("variable") == "volume" else "work"
    if rows.wear_kind != (kind or counted):
        raise InputError(
            "calibration.other_wear",
            "{file}: the law counts the belt's wear as {law}, the table as {table}",
            file=rows.path,
            law=kind or counted,
            table=rows.wear_kind,
        )
    return rows._replace(wear=rows.wear * unit)


def _loading(rows: Table, law: Json, fitted: Json) -> Floats | None:
    """(n,) mean loading of the belt over each grind; the calibration's mean if not known. Raises InputError where nothing
    says it."""
    wear = law.get("wear", {})
    if not wear.get("loading_share", 0.0) > 0.0:
        return None
    if len(rows.free) and wear.get("variable") != "volume":
        recovery = wear.get("loading_recovery_s", 0.0) or math.inf
        scale = wear.get("loading_scale", LOADING_SCALE)
        return loading.means(rows, loading.Loading(scale, recovery))
    if "mean_loading" in fitted:
        return np.full(len(rows.force), fitted["mean_loading"])
    raise InputError(
        "calibration.loading_not_known",
        "{file}: the law's belt loads, and nothing says how loaded it was; add the column free_s (for a law whose wear goes "
        "with the work), or calibrate",
        file=rows.path,
    )


def _of_law(law: Json, fitted: Json) -> tuple[Floats, dict[str, float], float]:
    """(parameters, references, joules of the wear's unit) of a law."""
    local = law.get("model", "local") == "local"
    curves = [key for key in CURVES if law.get(key)]
    wear = law.get("wear", {})
    if (local and curves) or wear.get("model", "none") not in (
        "none",
        "exponential",
        "two_stage",
        "power",
    ):
        raise InputError(
            "calibration.not_predicted",
            "law: curves and measured wear are not predicted here",
        )
    x = dict(DEFAULTS)
    x["ln_coefficient"] = math.log(law["coefficient_mm2_per_N"])
    for name in ("pressure_exponent", "speed_exponent", "feed_exponent"):
        x[name] = law.get(name, x[name]) if local else x[name]
    if local:
        x["pressure_threshold"] = law.get("pressure_threshold_MPa", 0.0)
        if law.get("saturation_pressure_MPa", 0.0) > 0:
            x["ln_saturation"] = math.log(law["saturation_pressure_MPa"])
    if wear.get("model") in ("exponential", "two_stage"):
        x["ln_wear_scale"], x["wear_rest"] = math.log(wear["scale"]), wear.get("rest", 0.0)
    if wear.get("model") == "two_stage":
        x["first_share"] = wear["first_share"] / max(1.0 - x["wear_rest"], 1e-12)
        x["ln_first_ratio"] = math.log(wear["first_scale"] / wear["scale"])
    if wear.get("model") == "power":
        x["ln_wear_scale"], x["wear_exponent"] = (
            math.log(wear["scale"]),
            wear["exponent"],
        )
    x["loading_share"] = wear.get("loading_share", 0.0)
    x["time_exponent"] = fitted.get("time_exponent", 1.0)
    x["area_exponent"] = fitted.get("area_exponent", 0.0)
    references = {
        "pressure": law.get("reference_pressure_MPa", 0.1),
        "speed": 1000.0 * law.get("reference_speed_m_s", 20.0),
        "feed": law.get("reference_feed_mm_s", 50.0),
        "time": fitted.get("reference_time_s", 1.0),
        "area": fitted.get("reference_area_mm2", 1.0),
    }
    return (
        np.array([x[name] for name in NAMES]),
        references,
        fitted.get("wear_unit_J", 1.0),
    )
