"""More passes for what the wheel would get to and the passes at their even distance do not touch: beside walls, between
obstacles, a place may lie where every pass had to be left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError
from . import passes, reachable
from .kinds import Extents, Levels, Piece

if TYPE_CHECKING:
    from .clearing import Clearing

DENSER = (
    5,
    25,
    100,
)  # passes in a step-over, that are tried, in turn: strips along borders are narrow
LEAST = 0.02  # of what the wheel gets to: less is left as it is, for a pass grinds what lies beside it once more
GAIN = 0.005  # of what is to be filled, that a pass must touch
MOST = 30  # passes that are added
TOO_MANY = "raster.too_many_passes"  # code of the error where they lie nearer to each other than may be asked for


def more(
    levels_of: Callable[[float, Floats, float], Levels],
    seen: Json,
    clearing: Clearing,
    settings: Json,
    step_over: float,
    extents: Extents,
) -> Levels:
    """Levels, each of one piece, to lay besides.

    ``levels_of(step_over, points, margin)``: passes at that distance, where they are within ``margin`` mm of points
    (n, 3), as ``clearing.cleared`` takes them; ``seen``: of ``reachable.look``; ``step_over``: mm, of the passes that
    lie; ``extents``: as there.
    """
    left = (seen["state"] == reachable.NO_PASS) & (seen["counted"] > 0)
    enough = LEAST * seen["counted"][seen["fits"]].sum()
    found: list[list[Piece]] = []
    for denser in DENSER:
        if seen["counted"][left].sum() <= enough or len(found) >= MOST:
            break
        points, areas = seen["points"][left], seen["counted"][left]
        try:
            near = levels_of(step_over / denser, points, 0.5 * step_over)
        except InputError as error:
            if error.code != TOO_MANY:
                raise
            break  # the gaps that are left stay without a pass
        pieces = [
            piece
            for level in clearing.cleared([level for level in near if level])
            for piece in level
            if passes.length(piece["points"]) >= max(settings["min_length_mm"], 1e-9)
        ]
        touched = [
            reachable.touched(points, [clearing.frames(piece)], clearing.tool, extents)
            for piece in pieces
        ]
        some, missed = _best(touched, areas, enough, MOST - len(found))
        found += [[pieces[k]] for k in some]
        left[np.flatnonzero(left)[~missed]] = False
    return found


def _best(
    touched: Sequence[Array], areas: Floats, enough: float, most: int
) -> tuple[list[int], Array]:
    """(numbers of pieces, at most ``most``, each the one that touches most of what is left, until no more than
    ``enough`` is, (n,) bool: left by them); ``touched``: of each piece (n,) bool; ``areas`` (n,).
    """
    left = np.ones(len(areas), dtype=bool)
    chosen: list[int] = []
    while touched and len(chosen) < most and areas[left].sum() > enough:
        gains = [areas[mine & left].sum() for mine in touched]
        best = int(np.argmax(gains))
        if gains[best] < GAIN * areas.sum():
            break
        chosen.append(best)
        left &= ~touched[best]
    return chosen, left
