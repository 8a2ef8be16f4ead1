"""Measured grinds split in two: the calibrated law and an ordinary power law predict what they never saw."""

import numpy as np
from support.freecad import SHARED

from beltgrinding.calibration import calibrate as calibration
from beltgrinding.calibration.table import with_areas

TABLE = SHARED / "data" / "removal" / "belt_grinder_recovered.csv"


def tables():
    """{name: Table} that the measured grinds give: by area, time, force, wear, and how many records each
    grind was recovered from."""
    table = calibration.read(TABLE)
    area, known = np.round(table.area), np.isfinite(table.area)
    records = np.genfromtxt(TABLE, delimiter=",", comments="#")[:, 6]
    middle = {"time": 15.5, "force": 5.5, "wear": np.median(table.wear)}

    def bare(rows):
        return rows._replace(area=np.full(len(rows.force), np.nan), notes=[])

    parts = {
        "known areas": table.take(known),
        "50 mm2": table.take(area == 50),
        "50 mm2 exactly": table.take(table.area == 50.0),
        "98 and 200 mm2": table.take(area > 90),
        "98 mm2": table.take(area == 98),
        "unknown areas": bare(table.take(~known)),
        "all, areas taken out": bare(table),
    }
    for name, edge in middle.items():
        values = getattr(table, name)
        parts[f"{name} below {edge:.3g}"] = table.take(known & (values < edge))
        parts[f"{name} above {edge:.3g}"] = table.take(known & (values > edge))
    parts["1 or 2 records"] = table.take(known & (records < 3))
    parts["3 or more records"] = table.take(known & (records >= 3))
    return parts


def halves(count, repeats, seed=1):
    """(fitted, held out) rows: random halves both ways, then every second row both ways."""
    random = np.random.default_rng(seed)
    for _ in range(repeats):
        order = random.permutation(count)
        one, other = order[: count // 2], order[count // 2 :]
        yield one, other
        yield other, one
    rows = np.arange(count)
    yield rows[::2], rows[1::2]
    yield rows[1::2], rows[::2]


def power_law(table, held):
    """What an ordinary least-squares regression of ln(removed) on the logarithms of the inputs that vary
    says of the held grinds, (n,)."""

    def design(rows):
        return np.column_stack(
            [np.ones(len(rows.force))] + [np.log(getattr(rows, name)) for name in used]
        )

    names = ("force", "speed", "feed", "time", "area", "wear")
    used = [
        name
        for name in names
        if (getattr(table, name) > 0).all() and np.std(np.log(getattr(table, name))) > 0.03
    ]
    found = np.linalg.lstsq(design(table), np.log(table.measured), rcond=None)[0]
    with np.errstate(over="ignore"):
        return np.exp(design(held) @ found)


def law(table, held):
    """(predicted, whether the 95 % interval holds) by the calibrated law, (n,) each."""
    said = calibration.predict(calibration.fit_law(_own(table)), held)
    off = np.abs(np.log(held.measured / said["predicted"]))
    return said["predicted"], off < 1.96 * said["ln_deviation"]


def _own(table):
    """A table with a nominal area where it knows none."""
    return with_areas(table._replace(notes=[])) if np.isnan(table.area).all() else table


def compared(table, repeats):
    """dict(law, power: (median, 90 %) of the relative errors over all splits; inside: share of held-out
    grinds within the law's 95 % intervals)."""
    errors, inside = {"law": [], "power": []}, []
    for one, other in halves(len(table.force), repeats):
        fitted, held = table.take(one), table.take(other)
        predicted, within = law(fitted, held)
        errors["law"].append(np.abs(predicted / held.measured - 1.0))
        errors["power"].append(np.abs(power_law(fitted, held) / held.measured - 1.0))
        inside.append(within)
    figures = {
        name: tuple(float(np.quantile(np.concatenate(values), q)) for q in (0.5, 0.9))
        for name, values in errors.items()
    }
    return {**figures, "inside": float(np.mean(np.concatenate(inside)))}


def extrapolated(table, name, share=0.1):
    """(law, power law): median of the relative errors on the greatest ``share`` of what a column ``name``
    holds, by what the others tell."""
    values = getattr(table, name)
    above = values > np.quantile(np.round(values, 1), 1.0 - share) - 0.1
    fitted, held = table.take(~above), table.take(above)
    said = law(fitted, held)[0], power_law(fitted, held)
    return tuple(float(np.median(np.abs(one / held.measured - 1.0))) for one in said)
