"""What a deviation's colours show, as one record. The mesh's colours, those in the 3D view and the legend are made of
it alone, so that they cannot say different things.
"""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Floats
from ..engine import core
from .kinds import DocumentObject, Field, Scale

DEVIATION, UNCERTAINTY = "deviation", "uncertainty"
# Of a scan: its height, and that less the predicted.
MEASURED, DIFFERENCE = "measured", "difference"
TEMPERATURE, ROUGHNESS = "temperature", "roughness"
CELL_ERROR = "error of the cells"
MODES = [DEVIATION, UNCERTAINTY, MEASURED, DIFFERENCE, TEMPERATURE, ROUGHNESS, CELL_ERROR]
HEIGHTS = (DEVIATION, MEASURED, DIFFERENCE)  # with a tolerance
BY_HAND, BY_TOLERANCE, BY_PERCENTILE = "by hand", "by tolerance", "by percentile"
MOST_BANDS = 20
LEAST_SPAN = {TEMPERATURE: 1.0, ROUGHNESS: 1e-3, UNCERTAINTY: 1e-6, CELL_ERROR: 1e-6}  # K, µm, mm


class Shown(NamedTuple):
    """``known``: whether the result has what the mode shows; where not, all is grey. ``start``, ``end``: of the colours
    of modes without a tolerance; mm, degrees C, µm. ``beyond``: whether values lie below and above the ends.
    """

    mode: str = DEVIATION
    known: bool = True
    lower: float = 0.0  # mm
    upper: float = 0.0
    limit: float = 0.0
    bands: int = 0
    colours: tuple[int, ...] | None = None  # in, above and below the tolerance; None: the standard
    start: float = 0.0
    end: float = 0.0
    beyond: tuple[bool, bool] = (True, True)

    @property
    def scale(self) -> Scale:
        return self.lower, self.upper, self.limit

    def values(self, field: Field) -> Floats:
        """(n,) what is shown of every sample: mm, K above the start, µm; NaN where it is not known."""
        if not self.known:
            return np.full(len(field.height), np.nan)
        if self.mode == UNCERTAINTY:
            return np.array(field.height_sd, dtype=float)
        if self.mode == CELL_ERROR:
            return np.array(field.height_error, dtype=float)
        if self.mode == TEMPERATURE:
            return np.array(field.heat["rise"], dtype=float)
        if self.mode == ROUGHNESS:
            return np.array(field.finish["roughness"], dtype=float)
        if self.mode == DEVIATION:
            return np.array(field.height, dtype=float)
        measured = np.array(field.measured, dtype=float)
        return measured if self.mode == MEASURED else measured - field.height

    def colours_of(self, field: Field) -> Array:
        """(n,) 0xRRGGBBAA of every sample."""
        values = self.values(field)
        unknown = np.isnan(values)
        grey = core.colour_scale(-1.0, 1.0, 2.0, [np.nan])[0]
        if unknown.all():
            return np.full(len(values), grey, dtype=np.uint32)
        if self.mode == DEVIATION:
            return core.deviation_colours(field, *self.scale, self.bands, self.colours)
        if self.mode in HEIGHTS:
            return core.height_colours(values, field.flags, *self.scale)
        found = core.magnitude_colours(
            np.nan_to_num(values), field.flags, max(self.end - self.start, LEAST_SPAN[self.mode])
        )
        found[unknown] = grey
        return found


def has(field: Field, mode: str) -> bool:
    """Whether a core.HeightField has what a mode shows, at one sample at least."""
    if mode == UNCERTAINTY:
        return len(field.height_sd) > 0
    if mode == CELL_ERROR:
        return len(field.height_error) > 0
    if mode in (MEASURED, DIFFERENCE):
        return len(field.measured) > 0 and bool(np.isfinite(field.measured).any())
    if mode == TEMPERATURE:
        return field.heat is not None
    if mode == ROUGHNESS:
        found = field.finish is not None and np.asarray(field.finish["roughness"])
        return bool(np.isfinite(found).any()) if field.finish is not None else False
    return True


def made(obj: DocumentObject, field: Field, scale: Scale, colours: Any) -> Shown:
    """The ``Shown`` of a Deviation whose figures are set. ``colours``: the preferences'."""
    mode = obj.ColourBy
    start, end = _ends(obj, mode)
    own = colours if mode == DEVIATION else None
    found = Shown(mode, has(field, mode), *scale, bands_of(obj), own and tuple(own), start, end)
    if not found.known:
        return found._replace(beyond=(False, False))
    values = found.values(field)
    if mode not in HEIGHTS:
        return found._replace(beyond=(False, bool((values > end - start).any())))
    seen = values[(field.flags & core.MISSED) == 0]
    return found._replace(beyond=(bool((seen < -scale[2]).any()), bool((seen > scale[2]).any())))


def of(obj: DocumentObject) -> Shown | None:
    """What a Deviation's colours show; None where they show nothing yet."""
    told = json.loads(getattr(obj, "Shown", "") or "[]")
    if len(told) > 2:
        found = Shown(**told[2])
        colours, beyond = found.colours, found.beyond
        return found._replace(colours=colours and tuple(colours), beyond=(beyond[0], beyond[1]))
    if not told or not hasattr(obj, "Bands") or obj.ColourLimit.Value <= 0:
        return None
    # Of an earlier version.
    mode = getattr(obj, "ColourBy", DEVIATION)
    scanned = bool(getattr(obj.Simulation, "ScanFigures", ""))
    there = {
        UNCERTAINTY: obj.ExpectedInTolerance > 0.0,
        MEASURED: scanned,
        DIFFERENCE: scanned,
        TEMPERATURE: getattr(obj, "GreatestTemperature", 0.0) > 0.0,
        ROUGHNESS: getattr(obj, "GreatestRoughness", 0.0) > 0.0,
    }
    if not there.get(mode, True):  # it painted the deviation then
        mode = DEVIATION
    scale = obj.ToleranceLower.Value, obj.ToleranceUpper.Value, obj.ColourLimit.Value
    beyond = obj.Minimum.Value < -scale[2], obj.Maximum.Value > scale[2]
    chosen = told[1][-2] if mode == DEVIATION and len(told) > 1 else None
    colours = tuple(chosen) if isinstance(chosen, list) else None
    return Shown(mode, True, *scale, bands_of(obj), colours, *_ends(obj, mode), beyond)


def _ends(obj: DocumentObject, mode: str) -> tuple[float, float]:
    """Where the colours of a mode without a tolerance begin and end."""
    if mode == UNCERTAINTY:
        return 0.0, obj.UncertaintyLimit.Value
    if mode == CELL_ERROR:
        return 0.0, round_up(obj.CellError95.Value)
    if mode == TEMPERATURE:
        return obj.StartTemperature, max(obj.GreatestTemperature, obj.StartTemperature + 1.0)
    if mode == ROUGHNESS:
        return 0.0, max(obj.GreatestRoughness, LEAST_SPAN[ROUGHNESS])
    return 0.0, 0.0


def bands_of(obj: DocumentObject) -> int:
    """The steps of each ramp; 0: none."""
    return min(max(obj.Bands, 0), MOST_BANDS)


def bounded(obj: DocumentObject, field: Field, scale: Scale) -> Scale:
    """``scale`` with the end of the ramps as the object's ``Bounds`` say, outside of the tolerance."""
    lower, upper, limit = scale
    widest = max(abs(lower), abs(upper))
    if obj.Bounds == BY_TOLERANCE:
        limit = obj.TimesTolerance * widest
    elif obj.Bounds == BY_PERCENTILE:
        limit = percentile(field, obj.Percentile)
    return lower, upper, max(limit, 1.01 * widest, 1e-4)


def percentile(field: Field, share: float) -> float:
    """|deviation| in mm that ``share`` percent of the area lie within; missed samples are left out."""
    found = (field.flags & core.MISSED) == 0
    height, area = np.abs(field.height[found]), field.areas[found].astype(float)
    if not len(height):
        return 0.0
    order = np.argsort(height)
    so_far = np.cumsum(area[order])
    k = np.searchsorted(so_far, np.clip(share, 0.0, 100.0) / 100.0 * so_far[-1])
    return float(height[order[min(k, len(order) - 1)]])


def round_up(value: float) -> float:
    """The next of 1, 2, 5, 10... above a value."""
    if value <= 0.0:
        return 0.001
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= 0.999 * value)
