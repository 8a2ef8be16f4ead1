"""How long a run will still take, from its progress."""

from __future__ import annotations

import math
from collections import deque

WINDOW = 0.4  # share of the time so far whose pace is taken: the phases of a run differ in theirs
LEAST_TIME = 1.0  # s; before, a pace means nothing
LEAST_SHARE = 0.01
SLOWLY = 0.08  # share of the whole time in which what is told comes by two thirds nearer to a new estimate


class TimeLeft:
    """Told of the progress, it says the seconds that are left."""

    def __init__(self) -> None:
        self.seen: deque[tuple[float, float]] = deque()
        self.told: tuple[float, float] | None = None  # (when, s left)

    def update(self, seconds: float, share: float) -> float | None:
        """``share`` done in [0, 1] after ``seconds``; the seconds left, or None: not to be said."""
        self.seen.append((seconds, share))
        while len(self.seen) > 2 and self.seen[1][0] <= (1.0 - WINDOW) * seconds:
            self.seen.popleft()
        begin, before = self.seen[0]
        if seconds < LEAST_TIME or share < LEAST_SHARE or share <= before or seconds <= begin:
            return None
        return self._smoothed(seconds, (1.0 - share) * (seconds - begin) / (share - before))

    def _smoothed(self, seconds: float, estimate: float) -> float:
        """The last estimate, which runs down as a clock, drawn to the new one: a number that jumps tells
        nobody anything."""
        if self.told is not None:
            when, left = self.told
            passed = seconds - when
            left = max(left - passed, 0.0)
            weight = 1.0 - math.exp(-passed / max(SLOWLY * (seconds + estimate), LEAST_TIME))
            estimate = left + weight * (estimate - left)
        self.told = seconds, estimate
        return estimate


def duration(seconds: float) -> str:
    """A time as people say it: 12 s, 3 min 20 s, 1 h 05 min."""
    seconds = int(seconds + 0.5)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60} min {seconds % 60:02d} s"
    return f"{seconds // 3600} h {seconds // 60 % 60:02d} min"
