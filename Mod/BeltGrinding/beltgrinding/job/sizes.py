"""Whether something that came without a unit is as large as what it should be, and in which unit it would be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats
from ..engine import Fact, InputError

if TYPE_CHECKING:
    from ..engine import core

# mm of the file's 1, as meshes come. A file read in one of them may have been meant in any other.
UNITS = (0.001, 1.0, 10.0, 25.4, 304.8, 1000.0)
ALIKE = 0.1  # of a size: of two scans of one part, the raw part's allowance included
FLAT_ALIKE = 0.03  # of what has two sizes only: a piece of a flat part is as flat
FLAT_FACTORS = (5.0, 20.0)  # a piece of a tenth is no scan in another unit
CELLS = 40  # along the largest size, of points that are counted once a cell
THIN = 0.02  # of the largest size: what is less says nothing


def name(unit_mm: float) -> Fact:
    """A unit's name as a Fact."""
    if unit_mm == 0.001:
        return Fact("job.micrometres", "micrometres")
    if unit_mm == 10.0:
        return Fact("job.centimetres", "centimetres")
    if unit_mm == 25.4:
        return Fact("job.inches", "inches")
    if unit_mm == 304.8:
        return Fact("job.feet", "feet")
    if unit_mm == 1000.0:
        return Fact("job.metres", "metres")
    return Fact("job.millimetres", "millimetres")


def others(unit_mm: float) -> list[float]:
    """The units in which a file could have been meant that was read with ``unit_mm``."""
    return [unit for unit in UNITS if abs(math.log(unit / unit_mm)) > math.log(2.0)]


def fitting(
    sizes: ArrayLike, references: Sequence[ArrayLike], unit_mm: float, slack: float = 0.0
) -> float | None:
    """The unit in which all ``sizes`` (mm, in one order with each of ``references``) would be as one of these, to ``ALIKE`` and
    ``slack`` mm; None where there is none, or they are near one of them as they are."""
    sizes = np.asarray(sizes, dtype=float)
    for reference in references:
        reference = np.asarray(reference, dtype=float)
        counts = reference > THIN * reference.max()
        ratios = sizes[counts] / reference[counts]
        if ratios.max() > 0.5 and ratios.min() < 2.0:
            return None
    for reference in references:
        reference = np.asarray(reference, dtype=float)
        counts = reference > THIN * reference.max()
        flat = not counts.all()
        for unit in others(unit_mm):
            factor = unit / unit_mm
            if flat and FLAT_FACTORS[0] < max(factor, 1.0 / factor) < FLAT_FACTORS[1]:
                continue
            off = np.abs(sizes * factor - reference)
            if (off[counts] <= (FLAT_ALIKE if flat else ALIKE) * reference[counts] + slack).all():
                return unit
    return None


def spread(points: ArrayLike) -> Floats:
    """(3,) mm: standard deviations of a surface's points along its principal axes, falling. How it is turned and how dense the
    points are is no matter."""
    points = np.asarray(points, dtype=float)
    low, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    if size > 0.0:
        cells = np.minimum(((points - low) * (CELLS / size)).astype(np.int64), CELLS - 1)
        numbers = (cells[:, 0] * CELLS + cells[:, 1]) * CELLS + cells[:, 2]
        _, place = np.unique(numbers, return_inverse=True)
        counts = np.bincount(place)
        points = np.stack([np.bincount(place, points[:, k]) / counts for k in range(3)], axis=1)
    off = points - points.mean(axis=0)
    return np.sqrt(np.maximum(np.linalg.eigvalsh(off.T @ off / len(off))[::-1], 0.0))


def check_box(vertices: Array, shape: core.Shape, unit_mm: float, slack: float) -> None:
    """Raises InputError, naming the unit, where a mesh that lies in the design's frame (vertices (n, 3) mm, read with
    ``unit_mm``) would have the design's size in another unit; ``slack``: mm that it may be larger on each side.
    """
    own = np.ptp(np.asarray(vertices, dtype=float), axis=0)
    design = np.subtract(*reversed(shape.extents()))
    unit = fitting(own, [design], unit_mm, 2.0 * min(slack, ALIKE * float(design.max())))
    if unit is not None:
        raise InputError(
            "job.other_unit",
            "the mesh is {across:.4g} mm across, the design {design:.4g} mm; it would fit in {name}: set its unit to {unit:g} mm",
            across=float(np.linalg.norm(own)),
            design=float(np.linalg.norm(design)),
            name=name(unit),
            unit=unit,
        )
