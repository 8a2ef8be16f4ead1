"""Passes that a robot can follow: the wheel turns no faster than asked, and never goes back in contact."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np

from ..base import frames
from ..base.kinds import Floats, Json
from .kinds import Piece

STILL = 1e-6  # mm; less is no way
NO_TURN = 1e-7  # rad
KEPT = 0.999  # of the limit, that is used: rounding does not break it
GROWTH = 1.25  # of the stretch over which a turn is spread, from try to try
MOST_TRIES = 40
BACK = 0.0  # cosine between the way to a point and the way from it; below, it goes back

Way: TypeAlias = "tuple[Floats, Floats]"  # points and quaternions, or mm and rad


def limited(piece: Piece, settings: Json) -> list[Piece]:
    """The pieces (list of dict as given) that are left of one: a turn of the wheel that is faster than
    max_turn_deg_per_mm is spread along the pass, if it is no larger than edge_turn_deg on the way that it
    needs; else the pass ends there, as it does where its way goes back. Poses are put between those that
    are farther apart than max_turn_deg or max_distance_mm. ``piece``: dict(points, normals, tangents
    (n, 3), closed).
    """
    rate = math.radians(settings["max_turn_deg_per_mm"]) * KEPT
    largest = math.radians(settings["edge_turn_deg"])
    points, turns = _plain(piece["points"], _quaternions(piece["normals"], piece["tangents"]))
    if len(points) < 2:
        return []
    cuts, start = _backs(points), 0
    done: list[Way] = []
    for cut in [*cuts, len(points) - 1]:
        done += _spread(points[start : cut + 1], turns[start : cut + 1], rate, largest)
        start = cut
    result = []
    ring = piece["closed"] and not _seam_backs(points)
    whole = ring and len(done) == 1 and not _seam_jumps(*done[0], rate, settings)
    if ring and len(done) > 1 and not _apart(done[-1], done[0], rate):
        # The beginning of a ring is no end.
        last = done.pop()
        joined = [np.concatenate([a[:-1], b]) for a, b in zip(last, done[0])]
        done[0] = joined[0], joined[1]
    for points, turns in done:
        points, turns = _filled(points, turns, settings)
        x, y, z, w = turns[:, 1], turns[:, 2], turns[:, 3], turns[:, 0]
        tangents = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)], 1)
        normals = -np.stack([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)], 1)
        one = {"points": points, "normals": normals, "tangents": tangents, "closed": whole}
        result.append({**piece, **one})
    return result


def _quaternions(normals: Floats, tangents: Floats) -> Floats:
    """w, x, y, z (n, 4) of frames with x along the tangent, z against the normal; neighbours on one side."""
    z = -normals / np.linalg.norm(normals, axis=1)[:, None]
    x = tangents - (tangents * z).sum(axis=1)[:, None] * z
    x /= np.linalg.norm(x, axis=1)[:, None]
    found = frames.to_quaternions(np.stack([x, np.cross(z, x), z], axis=2))
    return _one_side(found)


def _one_side(turns: Floats) -> Floats:
    signs = np.where((turns[1:] * turns[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    return turns * np.concatenate([[1.0], np.cumprod(signs)])[:, None]


def _plain(points: Floats, turns: Floats) -> Way:
    """Without points that are the ones before again."""
    way, turn = _steps(points, turns)
    kept = np.concatenate([[True], (way > STILL) | (turn > NO_TURN)])
    return points[kept], turns[kept]


def _steps(points: Floats, turns: Floats) -> Way:
    """mm (n - 1,) and rad (n - 1,) from point to point."""
    apart = np.minimum(
        np.linalg.norm(np.diff(turns, axis=0), axis=1),
        np.linalg.norm(turns[1:] + turns[:-1], axis=1),
    )
    return np.linalg.norm(np.diff(points, axis=0), axis=1), 4.0 * np.arcsin(
        np.minimum(0.5 * apart, 1.0)
    )


def _backs(points: Floats) -> list[int]:
    """Indices of the points at which the way goes back."""
    steps = np.diff(points, axis=0)
    moves = np.flatnonzero(np.linalg.norm(steps, axis=1) > STILL)
    back = (steps[moves[1:]] * steps[moves[:-1]]).sum(axis=1) < BACK
    return moves[1:][back].tolist()


def _seam_backs(points: Floats) -> bool:
    """Whether the way of a ring goes back where it begins."""
    steps = np.diff(points, axis=0)
    moves = steps[np.linalg.norm(steps, axis=1) > STILL]
    return len(moves) < 2 or moves[-1] @ moves[0] < BACK


def _seam_jumps(points: Floats, turns: Floats, rate: float, settings: Json) -> bool:
    """Whether the wheel would turn too fast from a ring's end to its second point: a turn that is spread, or a lean
    that changes, at one side of the seam only."""
    way, turn = _steps(np.stack([points[-1], points[1]]), np.stack([turns[-1], turns[1]]))
    limit = min(rate * way[0], math.radians(settings["max_turn_deg"])) / KEPT
    return turn[0] > limit + NO_TURN


def slerp(a: Floats, b: Floats, shares: Floats) -> Floats:
    """Quaternions (n, 4) from ``a`` to ``b`` ((4,) or (n, 4)), the shorter way."""
    a, b = np.broadcast_to(a, (len(shares), 4)), np.broadcast_to(b, (len(shares), 4))
    cosine = (a * b).sum(axis=1)
    b = np.where(cosine[:, None] < 0, -b, b)
    angle = np.arccos(np.clip(abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    even = sine < 1e-9
    sine[even] = 1.0
    first = np.where(even, 1.0 - shares, np.sin((1.0 - shares) * angle) / sine)
    second = np.where(even, shares, np.sin(shares * angle) / sine)
    found = first[:, None] * a + second[:, None] * b
    return found / np.linalg.norm(found, axis=1)[:, None]


def _at(points: Floats, turns: Floats, s: Floats, places: Floats) -> Way:
    """(points, quaternions) at the places (k,), mm along the piece, strictly between its ends."""
    i = np.clip(np.searchsorted(s, places, side="right") - 1, 0, len(s) - 2)
    step = s[i + 1] - s[i]
    share = np.clip((places - s[i]) / np.where(step > 0, step, 1.0), 0.0, 1.0)
    between = points[i] + share[:, None] * (points[i + 1] - points[i])
    return between, slerp(turns[i], turns[i + 1], share)


def _spread(points: Floats, turns: Floats, rate: float, largest: float) -> list[Way]:
    """[(points, quaternions)] of the pieces that are left, in which no turn is faster than ``rate``
    (rad/mm)."""
    turns = _one_side(turns)
    pieces: list[Way] = []
    seen = 0  # before it all is well
    while len(points) > 1:
        way, turn = _steps(points, turns)
        bad = np.flatnonzero(turn[seen:] > rate * way[seen:] / KEPT + NO_TURN)
        if not len(bad):
            return [*pieces, (points, turns)]
        k = seen + int(bad[0])
        found = _blended(points, turns, k, rate, largest)
        if found is not None:
            points, turns, seen = found
            continue
        if k > 0:
            pieces.append((points[: k + 1], turns[: k + 1]))
        points, turns, seen = points[k + 1 :], turns[k + 1 :], 0
    return pieces


def _blended(
    points: Floats, turns: Floats, k: int, rate: float, largest: float
) -> tuple[Floats, Floats, int] | None:
    """The piece with its turn from point k to the next spread over a stretch round it, and the index of
    the stretch's first point; None if there is no such stretch."""
    way, turn = _steps(points, turns)
    s = np.concatenate([[0.0], np.cumsum(way)])
    middle, half = 0.5 * (s[k] + s[k + 1]), 0.5 * turn[k] / rate
    for _ in range(MOST_TRIES):
        low, high = max(middle - half, 0.0), min(middle + half, s[-1])
        ends, sides = _at(points, turns, s, np.array([low, high]))
        if low <= 0.0:
            sides[0] = turns[0]
        if high >= s[-1]:
            sides[1] = turns[-1]
        angle = _steps(ends, sides)[1][0]
        if angle > largest:
            return None
        if angle <= rate * (high - low):
            break
        if low <= 0.0 and high >= s[-1]:
            return None
        half *= GROWTH
    else:
        return None
    inside = np.flatnonzero((s > low) & (s < high))
    before, after = np.flatnonzero(s <= low), np.flatnonzero(s >= high)
    # Of points in one place at the stretch's end, those on its own side stay.
    before = before[before <= k]
    after = after[after > k]
    if low <= 0.0:
        before = before[:0]
    if high >= s[-1]:
        after = after[:0]
    share = (s[inside] - low) / (high - low)
    middle_turns = slerp(sides[0], sides[1], share)
    joined = np.vstack([points[before], ends[:1], points[inside], ends[1:], points[after]])
    turned = np.vstack([turns[before], sides[:1], middle_turns, sides[1:], turns[after]])
    points, turns = _plain(joined, _one_side(turned))
    return points, turns, max(len(before) - 1, 0)


def _apart(last: Way, first: Way, rate: float) -> bool:
    way, turn = _steps(np.stack([last[0][-1], first[0][0]]), np.stack([last[1][-1], first[1][0]]))
    return way[0] > 10 * STILL or turn[0] > max(rate * way[0], 10 * NO_TURN)


def _filled(points: Floats, turns: Floats, settings: Json) -> Way:
    """With poses between those that are too far apart."""
    way, turn = _steps(points, turns)
    count = np.maximum(
        np.ceil(turn / (math.radians(settings["max_turn_deg"]) * KEPT)),
        np.ceil(way / settings["max_distance_mm"] - 1e-6),
    )
    count = np.maximum(count, 1).astype(int)
    if (count == 1).all():
        return points, turns
    i = np.repeat(np.arange(len(way)), count)
    share = (np.arange(len(i)) - np.repeat(np.cumsum(count) - count, count)) / count[i]
    between = points[i] + share[:, None] * (points[i + 1] - points[i])
    return (
        np.vstack([between, points[-1:]]),
        np.vstack([slerp(turns[i], turns[i + 1], share), turns[-1:]]),
    )
