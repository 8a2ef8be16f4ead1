"""Links as a person teaches them: off the part, across, and down. A search is dear where parts are near and bodies fine."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ..base.kinds import Floats
from ..engine import core
from ..job.settings import Cell
from .retract import retracted

SHARES = (0.0, 1.0, 2.5, 5.0, 10.0)  # of the job's retract, that ends are lifted by
HALVINGS = 3  # of the clearance, where an end is nearer; as the search has it
STEP, TURN = 5.0, 0.1  # mm, rad, between places of a lift


class Lifted(Protocol):
    """Where an end of a link is lifted to."""

    def __call__(self, q: Floats, distance: float) -> Floats | None:
        ...


def off_the_part(scene: core.ArmScene, cell: Cell) -> Lifted:
    """Joints (6 + k,) with the wheel ``distance`` mm farther off the part along the contact's normal; None: out of reach."""

    def lifted(q: Floats, distance: float) -> Floats | None:
        frame = retracted(cell, scene.base_from_tcp(q), distance)
        way, gets_there = scene.straight_way(q, frame, STEP, TURN)
        return np.asarray(way[-1]) if gets_there else None

    return lifted


def link(
    scene: core.ArmScene,
    ends: tuple[Floats, Floats],
    ways_off: tuple[Lifted | None, Lifted | None],
    retract: float,
    clearance: float,
    resolution: float,
) -> dict[str, Any] | None:
    """As ``ArmScene.link``: a free way by joints over both ends lifted, the least lift that does. ``ways_off``: of each
    end, None: it stays. The straight way is the first that is tried."""
    for _ in range(HALVINGS + 1):
        if all(scene.within(end, clearance) is None for end in ends):
            for share in SHARES:
                way = _way(ends, ways_off, share * retract)
                if way is not None and _free(scene, way, clearance, resolution):
                    return {
                        "joints": np.stack(way),
                        "clearance": clearance,
                        "straight": len(way) == 2,
                    }
        clearance *= 0.5
        resolution = min(resolution, 0.5 * clearance)
    return None


def _way(
    ends: tuple[Floats, Floats], ways_off: tuple[Lifted | None, Lifted | None], distance: float
) -> list[Floats] | None:
    begin, end = ends
    if distance == 0.0:
        return [begin, end]
    lifts = [off(q, distance) if off else None for off, q in zip(ways_off, ends)]
    if any(off is not None and one is None for off, one in zip(ways_off, lifts)):
        return None
    return [begin, *(one for one in lifts if one is not None), end]


def _free(scene: core.ArmScene, way: list[Floats], clearance: float, resolution: float) -> bool:
    legs = sorted(zip(way[:-1], way[1:]), key=lambda leg: -float(np.abs(leg[1] - leg[0]).max()))
    return all(scene.on_way(a, b, clearance, resolution) is None for a, b in legs)
