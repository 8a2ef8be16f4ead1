"""What a search tries next: of all that may mend something of passes that were tried, the most promising."""

from __future__ import annotations

import heapq
from collections.abc import Sequence

from ..base.kinds import Json
from .rough import Move, Moves, Tried

HOPE = 0.3  # of what a move may mend: so much better than before it is taken to end


class Queue:
    """Moves from passes that were tried; none twice, and none back to those. ``sources``: as ``by_rules.others``; ``seen``: what is
    not to be tried again, to which is added what is."""

    def __init__(self, sources: Sequence[Moves], seen: set[str]) -> None:
        self._sources, self._seen = sources, seen
        self._waiting: list[tuple[float, int, Move]] = []
        self._count = 0

    def add(self, one: Tried) -> None:
        """What may mend passes that were tried."""
        self._seen.add(_key(one.machine, one.wanted))
        for source in self._sources:
            for share, move in source(one):
                self._count += 1  # of equals the first
                promise = one.in_tolerance + HOPE * share
                heapq.heappush(self._waiting, (-promise, self._count, move))

    def take(self, most: int) -> list[Move]:
        """The most promising, at most so many."""
        found: list[Move] = []
        while self._waiting and len(found) < most:
            move = heapq.heappop(self._waiting)[2]
            key = _key(*move[1:])
            if key not in self._seen:
                self._seen.add(key)
                found.append(move)
        return found


def _key(machine: Json, wanted: Json) -> str:
    return repr((sorted(machine.items(), key=str), sorted(wanted.items(), key=str)))
