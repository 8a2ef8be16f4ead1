"""Which wheels, ways and belt angles a search tries first: by how much of the faces the wheel gets to, by its shape alone."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from ..base.kinds import Json
from ..raster import reach_map
from .rough import MATTERS, Move, Tried

OF_A_WHEEL = 2  # of each wheel besides the job's own
FAR_BEHIND = 0.1  # of the area: ways on which the wheel gets to so much less are no candidates

Ranked = list[tuple[float, Move]]  # with how much of the area the wheel gets to


class Seen(NamedTuple):
    """A wheel, and what the geometry says of it."""

    machine: Json  # the job's belt machine with it
    map: reach_map.Map

    @property
    def most(self) -> float:
        """Of the area, that it gets to on the best way."""
        return max((reach.share for reach in self.map.found), default=0.0)

    @property
    def size(self) -> dict[str, float]:
        """Of the wheel, mm."""
        names = ("radius_mm", "width_mm", "crown_radius_mm")
        return {name: self.machine["wheel"][name] for name in names}


def candidates(
    own: Seen, others: Sequence[Seen], start: Move, fixed: Collection[str] = ()
) -> list[Move]:
    """In the order of their promise: the job's own wheel on the ways on which it gets to most, then with other belt angles on them, and
    between them the best of each other wheel. ``fixed``: settings of the raster that stay as those of ``start``.
    """
    mine = ranked(own, start, fixed)
    theirs = [
        pair for other in others for pair in one_a_way(ranked(other, start, fixed))[:OF_A_WHEEL]
    ]
    theirs.sort(key=lambda pair: -round(pair[0], 2))
    most = max([share for share, _ in [*mine, *theirs]], default=0.0)
    mine = [pair for pair in mine if pair[0] >= own.most - FAR_BEHIND]
    first = one_a_way(mine)
    mine = [*first, *(pair for pair in mine if pair not in first)]
    theirs = [pair for pair in theirs if pair[0] >= most - FAR_BEHIND]
    found = []
    for k in range(max(len(mine), len(theirs))):
        found += [move for _, move in [*mine[k : k + 1], *theirs[k : k + 1]]]
    return [move for move in found if move[1:] != start[1:]]


def ranked(one: Seen, start: Move, fixed: Collection[str] = ()) -> Ranked:
    """The most first, where it need not lean counts double; of equals as they come. A step-over in mm is for the wheel and the belt
    angle of ``start``: others get theirs by the contact's width, unless it is ``fixed``."""
    _, machine, wanted = start
    found = sorted(one.map.found, key=lambda reach: -round(reach.share + reach.upright, 2))
    moves: Ranked = []
    for reach in found:
        changed = {**wanted, **reach.way, "belt_angle_deg": reach.belt_angle_deg}
        same = one.machine["wheel"] == machine["wheel"]
        same &= reach.belt_angle_deg == wanted["belt_angle_deg"]
        if not same and "step_over_mm" not in fixed:
            changed["step_over_mm"] = 0.0
        moves.append((reach.share, ("way", one.machine, changed)))
    return moves


def one_a_way(moves: Ranked) -> Ranked:
    """The first of each way, whatever its belt angle."""
    found: Ranked = []
    for share, move in moves:
        if all(not _same_way(move[2], other[2]) for _, other in found):
            found.append((share, move))
    return found


def of_further(one: Seen, start: Move, fixed: Collection[str], best: Tried) -> list[Move]:
    """How a wheel is tried of which is to be told what it would bring: on the way and with the belt angle that were the job's wheel's
    best, where it gets to as much there, and on its own best."""
    moves = ranked(one, start, fixed)
    angle = best.wanted["belt_angle_deg"]
    alike = [
        (share, move)
        for share, move in moves
        if _same_way(move[2], best.wanted) and move[2]["belt_angle_deg"] == angle
    ]
    alike = [pair for pair in alike if pair[0] >= one.most - FAR_BEHIND]
    return [move for _, move in [*alike, *one_a_way(moves)]][:OF_A_WHEEL]


def further_groups(one: Tried, seen: reach_map.Map, fixed: Collection[str]) -> list[Move]:
    """Passes with a group more, where they leave too much; of ways and belt angles those first with which the wheel gets to most of it
    by ``seen``, which is of that region. The step-over is by the contact's width there, unless it is ``fixed``.
    """
    found = sorted(seen.found, key=lambda reach: -round(reach.share + reach.upright, 2))
    moves: list[Move] = []
    for reach in found:
        if reach.share * one.left_share < MATTERS:
            continue
        group = {**reach.way, "belt_angle_deg": reach.belt_angle_deg, **one.region()}
        if "step_over_mm" not in fixed:
            group["step_over_mm"] = 0.0
        groups = [*one.wanted["further_passes"], group]
        moves.append(("group", one.machine, {**one.wanted, "further_passes": groups}))
    return moves


def _same_way(one: Json, other: Json) -> bool:
    if one["along"] != other["along"]:
        return False
    return one["along"] != "direction" or list(one["direction"]) == list(other["direction"])
