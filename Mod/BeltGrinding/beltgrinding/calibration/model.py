"""The model of a measured grind: its parameters, their bounds, its fit to a table (in C++)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats, Json
from ..engine import core

if TYPE_CHECKING:
    from .table import Table

NAMES = list(core.GRIND_PARAMETERS)
INDEX = {name: k for k, name in enumerate(NAMES)}
DEFAULTS = {
    "ln_coefficient": 0.0,
    "pressure_exponent": 1.0,
    "speed_exponent": 1.0,
    "feed_exponent": 0.0,
    "time_exponent": 1.0,
    "area_exponent": 0.0,
    "ln_wear_scale": math.inf,
    "wear_rest": 0.0,
    "pressure_threshold": 0.0,
    "ln_saturation": math.inf,
    "wear_exponent": math.inf,
    "grit_exponent": 0.0,
    "cut_exponent": 0.0,
    "first_share": 0.0,
    "ln_first_ratio": 0.0,
    "loading_share": 0.0,
}
BOUNDS = {
    "ln_coefficient": (-80.0, 40.0),
    "pressure_exponent": (0.1, 5.0),
    "speed_exponent": (-2.0, 6.0),
    "feed_exponent": (-2.0, 2.0),
    "time_exponent": (0.2, 3.0),
    "area_exponent": (-3.0, 3.0),
    "wear_rest": (0.0, 0.98),
    "wear_exponent": (0.0, 3.0),
    "first_share": (0.02, 0.95),
    "ln_first_ratio": (math.log(0.003), math.log(0.5)),
    "loading_share": (0.0, 0.95),
}
# Mean and standard deviation of what is known before: weakly, so that the grinds decide and what they
# leave open does not run away. The published exponents of force, 0.5 to 2.4, and of speed, 1 to 1.7
# (docs/removal-method.md), lie within one deviation and, as they are few, half of one; the others lie about
# the linear law, and a belt of mean wear that still cuts the half is one deviation off. Break-in takes 23 to 62 % of the cut.
PRIORS = {
    "pressure_exponent": (1.45, 0.95),
    "speed_exponent": (1.35, 0.7),
    "feed_exponent": (0.0, 0.5),
    "time_exponent": (1.0, 0.5),
    "area_exponent": (0.0, 1.0),
    "wear_rest": (0.5, 0.5),
    "wear_exponent": (0.0, 0.3),
    "first_share": (0.4, 0.3),
    "ln_first_ratio": (math.log(0.1), 1.0),
    "loading_share": (0.3, 0.3),
}
FRESH = 0.1  # of the geometric mean of the wear: from there on the cut falls by a power


class Model:
    """A table with its references and the parameters that are free; fits and predicts."""

    def __init__(
        self,
        table: Table,
        references: dict[str, float] | None = None,
        areas: Any = None,
        profile: Any = None,
    ) -> None:
        self.table = table
        self.references = references or _references(table)
        known = table.area[~np.isnan(table.area)]
        self.areas = _levels(known) if areas is None else np.asarray(areas, dtype=float)
        self.profile = _profile(table.relative) if profile is None else np.asarray(profile)
        self.arguments = _arguments(table, self.areas, self.profile)
        self.loading: tuple[
            float, float
        ] | None = None  # scale J or mm3, recovery s, of a belt that loads
        self.bounds = dict(BOUNDS)
        if table.wear_kind and table.wear.max() > 0:
            top = table.wear.max()
            self.bounds["ln_wear_scale"] = (math.log(0.02 * top), math.log(300 * top))
        pressure = table.force / np.where(np.isnan(table.area), self.areas.max(), table.area)
        self.bounds["pressure_threshold"] = (0.0, 0.98 * float(pressure.min()))
        self.bounds["ln_saturation"] = (
            math.log(0.3 * float(pressure.min())),
            math.log(30.0 * float(pressure.max())),
        )
        self.priors = dict(PRIORS)
        low, high = (math.log(float(edge)) for edge in (pressure.min(), pressure.max()))
        self.priors["pressure_threshold"] = (0.0, 0.5 * math.exp(low))
        self.priors["ln_saturation"] = (high + 1.0, 1.5)
        if "ln_wear_scale" in self.bounds:
            first, last = self.bounds["ln_wear_scale"]
            self.priors["ln_wear_scale"] = (0.5 * (first + last), 0.25 * (last - first))
        used = table.wear[table.wear > 0]
        self.fresh = math.log(FRESH * float(np.exp(np.log(used).mean()))) if len(used) else math.inf

    def fit(
        self,
        free: Sequence[str],
        start: ArrayLike | None = None,
        rows: Array | None = None,
    ) -> dict[str, Any]:
        """What core.calibrate gives. ``free``: names; ``start``: (parameters,); ``rows``: of the
        table, an index."""
        lower, upper = np.zeros(len(NAMES)), np.zeros(len(NAMES))
        begin = np.array([DEFAULTS[name] for name in NAMES])
        mean, deviation = np.zeros(len(NAMES)), np.full(len(NAMES), math.inf)
        if "wear_exponent" in free:
            begin[INDEX["ln_wear_scale"]] = self.fresh
        for name in free:
            k = INDEX[name]
            if name in self.priors:
                mean[k], deviation[k] = self.priors[name]
            lower[k], upper[k] = self.bounds[name]
            if not lower[k] < begin[k] < upper[k]:
                begin[k] = lower[k] + 0.3 * (upper[k] - lower[k])
            if start is not None and math.isfinite(start[k]):
                begin[k] = start[k]
        if start is None:
            arguments = self.arguments if rows is None else self._rows(rows)
            known = {**arguments, "area": _filled(arguments["area"], self.areas)}
            said, _ = core.log_grinds(begin, known, self.references)
            begin[0] += np.median(np.log(arguments["measured"]) - said)
        return core.calibrate(
            self.arguments if rows is None else self._rows(rows),
            self.references,
            begin,
            lower,
            upper,
            [name in free for name in NAMES],
            mean,
            deviation,
        )

    def load(self, means: Floats | None, loading: tuple[float, float] | None = None) -> None:
        """Gives each grind the belt's mean loading over it (n,); None: none. ``loading``: by which scale and recovery."""
        self.arguments.pop("loading", None)
        if means is not None:
            self.arguments["loading"] = means
        self.loading = loading

    def posterior(self, found: Json, free: Sequence[str]) -> Floats:
        """Covariance of the free parameters (k, k), if the scatter is normal."""
        at = [INDEX[name] for name in free]
        known = found["information"][np.ix_(at, at)] / found["scatter"] ** 2
        return np.linalg.pinv(known + np.diag(self._knowledge(free)))

    def _knowledge(self, free: Sequence[str]) -> Floats:
        """One over the priors' variances, (k,)."""
        return np.array([self.priors.get(name, (0.0, math.inf))[1] ** -2.0 for name in free])

    def evidence(self, found: Json, free: Sequence[str]) -> float:
        """ln of the probability of the data after Laplace, parameters integrated over (MacKay, Neural
        Computation 4, 1992); comparable among fits of the same rows."""
        sign, volume = np.linalg.slogdet(self.posterior(found, free))
        if sign <= 0:
            return -math.inf
        total = found["log_likelihood"] + 0.5 * volume
        for name in free:
            if name in self.priors:
                mean, deviation = self.priors[name]
                away = (found["parameters"][INDEX[name]] - mean) / deviation
                total -= 0.5 * away**2 + math.log(deviation)
        return float(total)

    def _rows(self, rows: Any) -> dict[str, Any]:
        a = self.arguments
        return {key: a[key] if key == "areas" else a[key][rows] for key in a}

    def predict(
        self, parameters: Floats, shares: Floats, rows: Array | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """(ln of the figure (n,), gradient (n, parameters), variance by unknown areas (n,))."""
        arguments = self.arguments if rows is None else self._rows(rows)
        unknown = np.isnan(arguments["area"])
        shares = np.asarray(shares, dtype=float)
        # The middle one of what an unknown area can be: as a prediction the median of its mixture.
        middle = 1.0
        if unknown.any():
            middle = self.areas[int(np.searchsorted(np.cumsum(shares), 0.5 * shares.sum()))]
        mean, gradient = self._say(parameters, arguments, np.where(unknown, middle, 1.0))
        variance = np.zeros(len(mean))
        for area, share in zip(self.areas, shares) if unknown.any() else ():
            said, _ = self._say(parameters, arguments, area)
            variance += share * np.square(said - mean)
        return mean, gradient, variance

    def _say(self, parameters: Any, arguments: Json, area: Floats) -> Any:
        known = np.where(np.isnan(arguments["area"]), area, arguments["area"])
        return core.log_grinds(parameters, {**arguments, "area": known}, self.references)


def _references(table: Table) -> dict[str, float]:
    """Geometric means of the data, to three digits: there ln K and the exponents are told apart."""

    def middle(values: Floats) -> float:
        values = values[~np.isnan(values)]
        return float(f"{math.exp(float(np.log(values).mean())):.3g}") if len(values) else 1.0

    moving = table.feed > 0
    return {
        "pressure": middle(table.force / table.area),
        "speed": 1000.0 * middle(table.speed),
        "feed": middle(table.feed[moving]) if moving.any() else 50.0,
        "time": middle(table.time[~moving]) if (~moving).any() else 1.0,
        "area": middle(table.area),
    }


def _levels(known: Floats) -> Floats:
    """What an unknown area can be: the known ones, gathered where they lie close or are many."""
    ordered = np.sort(known)
    groups = np.split(ordered, np.flatnonzero(np.diff(np.log(ordered)) > 0.02) + 1)
    levels = np.array([np.exp(np.log(group).mean()) for group in groups])
    if len(levels) > 12:
        levels = np.quantile(known, (np.arange(12) + 0.5) / 12)
    return levels


def _filled(area: Floats, areas: Floats) -> Floats:
    return np.where(np.isnan(area), np.exp(np.log(areas).mean()), area)


def _profile(relative: Floats) -> Floats:
    """Relative pressures (m,) of the contacts that are not known: the mean of those that are, else even."""
    known = np.isfinite(relative).all(axis=1)
    return relative[known].mean(axis=0) if known.any() else np.ones(1)


def _arguments(table: Table, areas: Floats, profile: Floats) -> dict[str, Any]:
    relative = np.tile(profile, (len(table.force), 1))
    if len(profile) == table.relative.shape[1]:
        relative = np.where(np.isfinite(table.relative), table.relative, relative)
    return {
        "relative": relative,
        "force": table.force,
        "area": table.area,
        "speed": 1000.0 * table.speed,
        "feed": table.feed,
        "time": table.time,
        "wear": table.wear,
        "spread": table.spread,
        "measured": table.measured,
        "areas": areas,
    }


def correlations(found: Json, free: Sequence[str]) -> Floats:
    """Correlation matrix of the free parameters; 0 for those at a bound."""
    at = [INDEX[name] for name in free]
    covariance = found["covariance"][np.ix_(at, at)]
    errors = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(covariance / np.outer(errors, errors))
