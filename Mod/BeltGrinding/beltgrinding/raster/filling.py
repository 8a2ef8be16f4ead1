"""More passes for what the wheel would get to and the passes at their even distance do not touch: beside walls, between
obstacles, a place may lie where every pass had to be left out."""

import numpy as np

from . import passes, reachable, region

DENSER = 5  # passes in a step-over, that are tried
LEAST = 0.005  # of the area: less is left as it is
GAIN = 0.05  # of what is to be filled, that a pass must touch
MOST = 30  # passes that are added


def more(levels_of, seen, clearing, settings, step_over, extents):
    """Levels, each of one piece, to lay besides.

    ``levels_of(step_over)``: passes at that distance, as ``clearing.cleared`` takes them; ``seen``: of
    ``reachable.look``; ``step_over``: mm, of the passes that lie; ``extents``: as there.
    """
    missed = (seen["state"] == reachable.NO_PASS) & (seen["counted"] > 0)
    areas = seen["counted"][missed]
    if areas.sum() <= LEAST * seen["counted"].sum():
        return []
    points = seen["points"][missed]
    near = region.restricted(levels_of(step_over / DENSER), points, 0.5 * step_over)
    shortest = max(settings["min_length_mm"], 1e-9)
    pieces = [
        piece
        for level in clearing.cleared([level for level in near if level])
        for piece in level
        if passes.length(piece["points"]) >= shortest
    ]
    touched = [
        reachable.touched(points, [clearing.frames(piece)], clearing.wheel, extents)
        for piece in pieces
    ]
    left, found = np.ones(len(points), dtype=bool), []
    while touched and len(found) < MOST:
        gains = [areas[mine & left].sum() for mine in touched]
        best = int(np.argmax(gains))
        if gains[best] < GAIN * areas.sum():
            break
        found.append([pieces[best]])
        left &= ~touched[best]
    return found
