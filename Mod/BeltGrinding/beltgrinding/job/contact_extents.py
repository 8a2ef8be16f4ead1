"""How large a solved contact is: on a plane or a cylinder, or as a map of pressures has it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..base.kinds import Json
from ..engine import core
from .settings import Wheel

if TYPE_CHECKING:
    from .engine_input import Elasticity

TOUCHED = 0.01  # of the peak pressure: cells with more belong to the contact
CELLS, MOST_CELLS = 6, 80  # of the contact's grid, across and along the contact
ALL_CELLS = 400  # across the wheel
ROUNDS = 3  # of finer grids, until it has them


def extents(contact: Json, angle: float = 0.0) -> tuple[float, float]:
    """(mm along a direction that lies at ``angle`` (rad) to the belt's travel about the contact's z, mm across it)
    of a contact as ``core.single_contact`` or ``core.contact_at`` gives it: where it has more than 1 % of its peak
    pressure, whole cells; 0, 0 without a contact."""
    pressure = contact["pressure"]
    if not pressure.size or not pressure.max() > 0.0:
        return 0.0, 0.0
    x, y = np.meshgrid(contact["x"], contact["y"])
    touched = pressure > TOUCHED * pressure.max()
    c, s = math.cos(angle), math.sin(angle)
    cells = [np.ptp(contact[name]) / max(len(contact[name]) - 1, 1) for name in ("x", "y")]
    along = np.ptp((c * x + s * y)[touched]) + abs(c) * cells[0] + abs(s) * cells[1]
    across = np.ptp((c * y - s * x)[touched]) + abs(s) * cells[0] + abs(c) * cells[1]
    return float(along), float(across)


def single(
    wheel: Wheel,
    workpiece: Json,
    elasticity: Elasticity,
    force: float,
    spacing: float,
    angle: float = 0.0,
) -> tuple[float, float]:
    """``extents`` of a core.single_contact on a grid that is fine enough for it, from cells of ``spacing`` mm.
    Raises InputError."""
    finest = wheel.width_mm / ALL_CELLS
    cell = min(max(spacing, finest), wheel.width_mm / CELLS)
    for _ in range(ROUNDS):
        found = core.single_contact(wheel, workpiece, elasticity, force, None, cell, 1e-3)
        length, breadth = extents(found)
        finer = max(min(length, breadth) / CELLS / 1.5, max(length, breadth) / MOST_CELLS, finest)
        if not min(length, breadth) > 0.0:  # nothing is pressed, on no grid
            break
        if min(length, breadth) >= CELLS * cell or finer >= cell:
            break
        cell = finer
    return extents(found, angle)
