"""Why a place stays out of tolerance under a plan."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Context, Floats, Json, known
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job.typed import typed
from ..job.workpiece import read_design
from ..raster import raster_path, reachable
from ..raster.clearing import Clearing
from . import limits

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .commands import Commands

GOOD, NOT_REACHED, BORDER, SLOWEST, FASTEST, KEPT, SHARED, NO_ROOM, PRESSURE, CHANGE = range(10)
FRINGE = 10
WORDS = {
    NOT_REACHED: "no_motion",  # none removes anything there, though the wheel fits
    NO_ROOM: "no_room",  # none does, and the wheel would stand in the part there, however its belt travels
    FRINGE: "fringe",  # too much is left beside where none does: the contact fades out
    BORDER: "border",  # within a contact's half width of the border of the faces
    SLOWEST: "slowest_feed",  # too much is left, and its motions go as slowly, and press as hard, as they may
    FASTEST: "fastest_feed",  # it is cut too deep, and its motions go as fast, and press as little, as they may
    PRESSURE: "pressure",  # too much is left at the least feed, and the limit of pressure or heat lets them press no harder
    CHANGE: "change",  # the feed or the force of its motions could not differ more from their neighbours'
    KEPT: "kept",  # its motions must not be changed
    SHARED: "shared",  # its motions also grind what needs the contrary, or the rounds ended before
}
MOST_OF = 0.8  # of what was removed there, by motions at a limit
AT = 1e-3  # relative, of a limit
NEARLY = 0.05  # the same of pressure, which moves from round to round
NEAR = 4.0  # samples from a border
PLACES = 400  # that are looked at: does the wheel fit?
LEAST = 5e-4  # of the area


def find(
    result: Result,
    commands: Commands,
    feeds: Floats,
    factors: Floats,
    settings: Json,
    context: Context = None,
) -> dict[str, Any]:
    """dict(state (samples,) of the above, reached (samples,) bool: some motion removes something, shares: {word: of the
    area, where it is out of tolerance})."""
    field, influence = result.field, known(result.influence)
    lower, upper = verdicts.limits(result.job, field)
    height, areas = np.asarray(field.height, dtype=float), np.asarray(field.areas, dtype=float)
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    above, below = seen & (height > upper), seen & (height < lower)
    motions = np.repeat(np.arange(len(influence)), np.diff(influence.first).astype(int))
    samples, depth = influence.sample.astype(int), influence.depth.astype(float)
    total = np.bincount(samples, depth, len(height))

    def share(commands_: Array) -> Floats:
        """(samples,) of what was removed, by motions of these commands."""
        mine = commands_[commands.group][motions]
        return np.bincount(samples, depth * mine, len(height)) / np.maximum(total, 1e-300)

    state = np.full(len(height), GOOD)
    state[above | below] = SHARED
    border = np.asarray(field.flags) & core.ON_BOUNDARY != 0
    state[(above | below) & _near(field, border)] = BORDER
    least, greatest = commands.force_range
    slowest, fastest = commands.feed_range
    slow = (feeds <= slowest * (1 + AT)) & (factors >= greatest * (1 - AT))
    fast = (feeds >= fastest * (1 - AT)) & (factors <= least * (1 + AT))
    slow, fast = slow & ~commands.kept, fast & ~commands.kept
    most = limits.greatest_factors(result, commands, factors, settings)
    pressed = (feeds <= slowest * (1 + AT)) & (factors >= most * (1 - NEARLY))
    pressed &= ~slow & ~commands.kept
    held = limits.bound(commands, feeds, factors, settings)
    state[(state == SHARED) & (share(held) > MOST_OF)] = CHANGE
    state[above & (share(pressed) > MOST_OF)] = PRESSURE
    state[above & (share(slow) > MOST_OF)] = SLOWEST
    state[below & (share(fast) > MOST_OF)] = FASTEST
    state[(above | below) & (share(commands.kept) > MOST_OF)] = KEPT
    state[above & (total <= 0.0)] = NOT_REACHED
    whole = max(areas[seen].sum(), 1e-300)
    missed = seen & (state == NOT_REACHED)
    if areas[missed].sum() > LEAST * whole:
        state[_without_room(result.job, field, np.flatnonzero(missed), context)] = NO_ROOM
        left = np.flatnonzero(above & (state == SHARED))
        if len(left):  # so that some motion removes something
            reach = _half_width(influence, areas)
            state[left[_beside(field, left, np.flatnonzero(missed), reach)]] = FRINGE
    shares = {word: float(areas[seen & (state == k)].sum() / whole) for k, word in WORDS.items()}
    return {"state": state, "reached": total > 0.0, "shares": shares}


def _half_width(influence: core.Influence, areas: Floats) -> float:
    """mm, of a motion's contact: the radius of a disc as large as where it removes half of its most; the median."""
    motions = np.repeat(np.arange(len(influence)), np.diff(influence.first.astype(int)))
    most = np.zeros(len(influence))
    np.maximum.at(most, motions, influence.depth)
    half = influence.depth >= 0.5 * most[motions]
    pressed = np.bincount(motions[half], areas[influence.sample[half]], len(influence))
    return float(np.sqrt(np.median(pressed[pressed > 0.0]) / np.pi))


def _beside(field: core.HeightField, places: Array, others: Array, reach: float) -> Array:
    """(places,) bool: within ``reach`` mm of one of the samples ``others``."""
    points = np.asarray(field.points, dtype=float)
    low, high = points[places].min(axis=0) - reach, points[places].max(axis=0) + reach
    within = ((points[others] >= low) & (points[others] <= high)).all(axis=1)
    if not within.any():
        return np.zeros(len(places), dtype=bool)
    return reachable.nearest_distance(points[places], points[others[within]]) <= reach


def _without_room(job: Json, field: core.HeightField, places: Array, context: Context) -> Array:
    """Those of samples ``places`` where the undeformed wheel, leaned by up to the raster paths' default, fits no way; as the
    nearest of ``PLACES`` that are looked at. None where that cannot be known."""
    read = typed(job)
    try:
        shape = read_design(read.design, context)
        clearing = Clearing(read, shape, raster_path.validate({}), [], context)
    except InputError:
        return places[:0]
    if clearing.blind:
        return places[:0]
    points = np.asarray(field.points, dtype=float)[places]
    some = np.unique(np.linspace(0, len(places) - 1, PLACES).astype(int))
    normals = np.asarray(field.normals, dtype=float)[places[some]]
    fits = reachable.in_any_direction(clearing, points[some], normals)
    return places[~fits[reachable.nearest(points, points[some])]]


def _near(field: core.HeightField, border: Array) -> Array:
    """(n,) bool: within some samples of one on a border."""
    points = np.asarray(field.points)
    if not border.any():
        return np.zeros(len(points), dtype=bool)
    size = NEAR * field.spacing
    cells = np.floor(points / size).astype(np.int64)
    keys = {tuple(cell) for cell in cells[border].tolist()}
    around = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
    wide = {(a + i, b + j, c + k) for a, b, c in keys for i, j, k in around}
    return np.array([tuple(cell) in wide for cell in cells.tolist()])
