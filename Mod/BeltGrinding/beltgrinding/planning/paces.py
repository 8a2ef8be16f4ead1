"""How long commands take by the job's time law, and the feeds with which they take as long as is wanted.

The robot is slower than its feed where it starts, stops and turns. Within the feeds that it reaches, a command takes
way / feed and a rest, which its neighbours and corners decide and which changes little with the feed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.kinds import Floats

if TYPE_CHECKING:
    from .commands import Commands

TRIES = 4  # of feeds, until neighbours take each other into account


class Pace:
    """The time of commands at feeds that a simulation was run with."""

    def __init__(self, commands: Commands, feeds: Floats) -> None:
        """``feeds`` (commands,) mm/s."""
        self._commands, self._feeds = commands, feeds
        self._way = commands.way()
        self.now = commands.times(feeds)  # (commands,) s
        self._rest = self._beyond(self.now, feeds)
        least, greatest = commands.feed_range
        self.longest = self._share(self._way / least + self._rest)  # (commands,) of now
        self.shortest = self._share(self._way / greatest + self._rest)

    def _beyond(self, seconds: Floats, feeds: Floats) -> Floats:
        """(commands,) s that they take more than their way asks for."""
        reached = np.minimum(feeds, self._commands.feed_range[1])
        return np.maximum(seconds - self._way / reached, 0.0)

    def _share(self, seconds: Floats) -> Floats:
        return seconds / np.maximum(self.now, 1e-12)

    def feeds(self, longer: Floats) -> Floats:
        """(commands,) mm/s, with which they take ``longer`` (commands,) times as long as now, as near as they can."""
        wanted, rest = longer * self.now, self._rest
        least, greatest = self._commands.feed_range
        found = self._feeds
        for _ in range(TRIES if self._commands.limits is not None else 1):
            left = np.maximum(wanted - rest, 1e-12)
            found = np.where(self._way > 0.0, np.clip(self._way / left, least, greatest), found)
            if self._commands.limits is not None:
                rest = self._beyond(self._commands.times(found), found)
        return found

    def longer(self, feeds: Floats) -> Floats:
        """(commands,) how many times as long as now they take at ``feeds`` (commands,) mm/s."""
        return np.where(self.now > 0.0, self._share(self._commands.times(feeds)), 1.0)
