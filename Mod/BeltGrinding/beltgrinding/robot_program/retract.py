"""The tool off the part: along the surface's normal at the contact."""

from __future__ import annotations

import numpy as np

from ..base.kinds import Floats
from ..job.settings import Cell
from ..job.workpiece import frame_of


def retracted(cell: Cell, frame: Floats, distance: float) -> Floats:
    """base_from_tcp (4, 4), mm, with the wheel ``distance`` mm further off the part: along the contact frame's z, which
    points into it."""
    off = np.eye(4)
    off[2, 3] = -distance
    if cell.holding == "tool_in_hand":
        contact = _known(cell, "tcp_from_contact")
        return frame @ contact @ off @ np.linalg.inv(contact)
    contact = _known(cell, "base_from_contact")
    return contact @ np.linalg.inv(off) @ np.linalg.inv(contact) @ frame


def _known(cell: Cell, key: str) -> Floats:
    frame: Floats = frame_of(getattr(cell, key), f"cell.{key}")
    return frame
