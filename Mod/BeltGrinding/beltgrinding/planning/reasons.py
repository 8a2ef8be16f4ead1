"""Why a place stays out of tolerance under a plan."""

import numpy as np

from ..engine import core
from ..inspection import verdict as verdicts

GOOD, NOT_REACHED, BORDER, SLOWEST, FASTEST, KEPT, SHARED = range(7)
WORDS = {
    NOT_REACHED: "no_motion",  # none removes anything there
    BORDER: "border",  # within a contact's half width of the border of the faces
    SLOWEST: "slowest_feed",  # too much is left, and its motions go as slowly, and press as hard, as they may
    FASTEST: "fastest_feed",  # it is cut too deep, and its motions go as fast, and press as little, as they may
    KEPT: "kept",  # its motions must not be changed
    SHARED: "shared",  # its motions also grind what needs the contrary, or the rounds ended before
}
MOST_OF = 0.8  # of what was removed there, by motions at a limit
AT = 1e-3  # relative, of a limit
NEAR = 4.0  # samples from a border


def find(result, commands, feeds, factors, settings):
    """dict(state (samples,) of the above, reached (samples,) bool: some motion removes something, shares: {word: of the
    area, where it is out of tolerance})."""
    field, influence = result.field, result.influence
    lower, upper = verdicts.limits(result.job, field)
    height, areas = np.asarray(field.height, dtype=float), np.asarray(field.areas, dtype=float)
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    above, below = seen & (height > upper), seen & (height < lower)
    motions = np.repeat(np.arange(len(influence)), np.diff(influence.first).astype(int))
    samples, depth = influence.sample.astype(int), influence.depth.astype(float)
    total = np.bincount(samples, depth, len(height))

    def share(commands_):
        """(samples,) of what was removed, by motions of these commands."""
        mine = commands_[commands.group][motions]
        return np.bincount(samples, depth * mine, len(height)) / np.maximum(total, 1e-300)

    state = np.full(len(height), GOOD)
    state[above | below] = SHARED
    border = np.asarray(field.flags) & core.ON_BOUNDARY != 0
    state[(above | below) & _near(field, border)] = BORDER
    least, greatest = commands.force_range
    slow = (feeds <= settings["feed_min_mm_s"] * (1 + AT)) & (factors >= greatest * (1 - AT))
    fast = (feeds >= settings["feed_max_mm_s"] * (1 - AT)) & (factors <= least * (1 + AT))
    slow, fast = slow & ~commands.kept, fast & ~commands.kept
    state[above & (share(slow) > MOST_OF)] = SLOWEST
    state[below & (share(fast) > MOST_OF)] = FASTEST
    state[(above | below) & (share(commands.kept) > MOST_OF)] = KEPT
    state[above & (total <= 0.0)] = NOT_REACHED
    whole = max(areas[seen].sum(), 1e-300)
    shares = {word: float(areas[seen & (state == k)].sum() / whole) for k, word in WORDS.items()}
    return {"state": state, "reached": total > 0.0, "shares": shares}


def _near(field, border):
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
