"""Whether a scan has the design's unit and sense: what a file without a unit, and one with turned triangles, would get wrong
without a word."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.kinds import Floats, Json
from ..engine import Fact, InputError
from ..job import sizes

if TYPE_CHECKING:
    from .file import Scan
    from .kinds import Fitted

ODD = 8.0  # times larger or smaller than all that it could be of: told
CLEARLY = 0.3  # of the residual per size: fits better by so much
MUCH = 0.2  # of the points are used where a scan fits: what is ground is no datum
NEAR = 3.0  # times the size: as large as a piece or the whole
SENSE = 0.3  # of the residual: the other sense fits better by so much
LEAST_SIZE = 0.02  # of the design's: no piece is so small, and no table so large
LEAST_RMS = 1e-6  # of the scan's size


def across(points: Floats) -> float:
    """mm, of the box."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def check(scan: Scan, datum: Json, fitted: Fitted) -> list[Fact]:
    """[Fact]: where the scan is oddly large or small beside the design. Raises InputError, naming the unit, where it would
    fit in another one. ``datum``: as ``comparison.align`` takes it; ``fitted(scan)``: about how a Scan fits, or None.
    """
    surfaces = (datum.get("whole"), datum.get("ground"), datum["points"])
    known = [sizes.spread(points) for points in surfaces if points is not None]
    taken, _ = scan.spread()
    own = sizes.spread(taken)
    unit = sizes.fitting(own, known, scan.unit_mm)
    if unit is not None:
        raise _other(scan, datum, unit)
    least, most = (func(np.linalg.norm(one) for one in known) for func in (min, max))
    size = float(np.linalg.norm(own))
    if least / ODD < size < most * ODD:
        return []
    here = _residual(fitted(scan), size)
    for unit in sizes.others(scan.unit_mm):
        factor = unit / scan.unit_mm
        if not most / (2.0 * ODD) < factor * size < 1.5 * most:
            continue
        there = _residual(fitted(scan.scaled(factor)), factor * size)
        if there is not None and (here is None or there < CLEARLY * here):
            raise _other(scan, datum, unit)
    if not LEAST_SIZE * most < size < most / LEAST_SIZE:
        near = min(sizes.UNITS, key=lambda unit: abs(np.log(unit / scan.unit_mm * size / most)))
        if most / NEAR < near / scan.unit_mm * size < NEAR * most:
            raise _other(scan, datum, near)
        raise InputError(
            "scan.size",
            "scan: it is {across:.3g} mm across, the design {size:.3g} mm; look at its unit",
            across=across(scan.points),
            size=_size(datum),
        )
    return [
        Fact(
            "scan.odd_size",
            "the scan is {across:.3g} mm across, the design {size:.3g} mm: if that is not what was scanned, give its unit",
            across=across(scan.points),
            size=_size(datum),
        )
    ]


def is_turned(scan: Scan, fitted: Fitted) -> bool:
    """Whether a mesh fits clearly better with its triangles turned; ``fitted`` as for ``check``."""
    if scan.triangles is None:
        return False
    other = fitted(scan.turned())
    here = fitted(scan) if other is not None else None
    return other is not None and (here is None or _score(other) < SENSE * _score(here))


def by_pairs(scan_points: Floats, work_points: Floats, unit_mm: float) -> None:
    """Raises InputError where the distances between the places of pairs say that the scan has another unit."""
    own, design = (
        np.linalg.norm(p - p.mean(axis=0), axis=1).sum() for p in (scan_points, work_points)
    )
    if own > 0.0 and design > 0.0 and not 0.6 < design / own < 1.7:
        unit = min(sizes.UNITS, key=lambda u: abs(np.log(u / unit_mm * own / design)))
        raise InputError(
            "scan.pairs_scale",
            "scan: the pairs' places are {own:.3g} mm apart on the scan, {design:.3g} mm on the design; give the scan's unit: "
            "in {name} (--unit-mm {unit:g}) they would be {fitting:.3g} mm",
            own=own / len(scan_points),
            design=design / len(scan_points),
            name=sizes.name(unit),
            unit=unit,
            fitting=own / len(scan_points) * unit / unit_mm,
        )


def _score(found: Json) -> float:
    return max(found["rms"], 1e-5) / max(found["used_share"], 1e-9)


def _residual(found: Json | None, size: float) -> float | None:
    """Of an alignment, per size of the scan; None where most of it lies elsewhere."""
    if found is None or found["used_share"] < MUCH:
        return None
    return max(found["rms"] / size, LEAST_RMS) / found["used_share"]


def _size(datum: Json) -> float:
    whole = datum.get("whole")
    return across(datum["points"] if whole is None else whole)


def _other(scan: Scan, datum: Json, unit: float) -> InputError:
    return InputError(
        "scan.other_unit",
        "scan: it is {across:.3g} mm across, the design {size:.3g} mm; it would fit in {name}: give its unit "
        "(--unit-mm {unit:g}, Unit in the panel), or that of the design",
        across=across(scan.points),
        size=_size(datum),
        name=sizes.name(unit),
        unit=unit,
    )
