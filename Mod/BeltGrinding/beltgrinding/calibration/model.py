"""The model of a measured grind: its parameters, their bounds, its fit to a table (in C++)."""

import math

import numpy as np

from ..engine import core

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
}
BOUNDS = {
    "ln_coefficient": (-80.0, 40.0),
    "pressure_exponent": (0.1, 5.0),
    "speed_exponent": (-2.0, 6.0),
    "feed_exponent": (-2.0, 2.0),
    "time_exponent": (0.2, 3.0),
    "area_exponent": (-3.0, 3.0),
    "wear_rest": (0.0, 0.98),
}


class Model:
    """A table with its references and the parameters that are free; fits and predicts."""

    def __init__(self, table, references=None, areas=None):
        self.table = table
        self.references = references or _references(table)
        known = table.area[~np.isnan(table.area)]
        self.areas = _levels(known) if areas is None else np.asarray(areas, dtype=float)
        self.arguments = _arguments(table, self.areas)
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

    def fit(self, free, start=None, rows=None):
        """What core.calibrate gives. ``free``: names; ``start``: (parameters,); ``rows``: of the
        table, an index."""
        lower, upper = np.zeros(len(NAMES)), np.zeros(len(NAMES))
        begin = np.array([DEFAULTS[name] for name in NAMES])
        for name in free:
            k = INDEX[name]
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
        )

    def _rows(self, rows):
        a = self.arguments
        return {key: a[key] if key == "areas" else a[key][rows] for key in a}

    def predict(self, parameters, shares, rows=None):
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

    def _say(self, parameters, arguments, area):
        known = np.where(np.isnan(arguments["area"]), area, arguments["area"])
        return core.log_grinds(parameters, {**arguments, "area": known}, self.references)


def _references(table):
    """Geometric means of the data, to three digits: there ln K and the exponents are told apart."""

    def middle(values):
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


def _levels(known):
    """What an unknown area can be: the known ones, gathered where they lie close or are many."""
    ordered = np.sort(known)
    groups = np.split(ordered, np.flatnonzero(np.diff(np.log(ordered)) > 0.02) + 1)
    levels = np.array([np.exp(np.log(group).mean()) for group in groups])
    if len(levels) > 12:
        levels = np.quantile(known, (np.arange(12) + 0.5) / 12)
    return levels


def _filled(area, areas):
    return np.where(np.isnan(area), np.exp(np.log(areas).mean()), area)


def _arguments(table, areas):
    return {
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


def correlations(found, free):
    """Correlation matrix of the free parameters; 0 for those at a bound."""
    at = [INDEX[name] for name in free]
    covariance = found["covariance"][np.ix_(at, at)]
    errors = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(covariance / np.outer(errors, errors))
