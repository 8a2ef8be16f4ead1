"""How large a solved contact is: on a plane or a cylinder, or as a map of pressures has it."""

import math

import numpy as np

from ..engine import core

TOUCHED = 0.01  # of the peak pressure: cells with more belong to the contact
CELLS, MOST_CELLS = 6, 80  # of the contact's grid, across and along the contact
ALL_CELLS = 400  # across the wheel
ROUNDS = 3  # of finer grids, until it has them


def extents(contact, angle=0.0):
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


def single(wheel, workpiece, compliance, force, spacing, angle=0.0):
    """``extents`` of a core.single_contact on a grid that is fine enough for it, from cells of ``spacing`` mm.
    Raises InputError."""
    finest = wheel["width"] / ALL_CELLS
    cell = min(max(spacing, finest), wheel["width"] / CELLS)
    for _ in range(ROUNDS):
        found = core.single_contact(wheel, workpiece, compliance, force, None, cell, 1e-3)
        length, breadth = extents(found)
        finer = max(min(length, breadth) / CELLS / 1.5, max(length, breadth) / MOST_CELLS, finest)
        if min(length, breadth) >= CELLS * cell or finer >= cell:
            break
        cell = finer
    return extents(found, angle)
