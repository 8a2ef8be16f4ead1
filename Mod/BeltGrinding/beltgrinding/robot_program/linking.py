"""Ways of the joints from where the arm is to where a pass begins, or home."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.kinds import Floats
from ..engine import core
from ..job.settings import Cell, RobotProgram
from . import lifts

STEP = 0.5  # mm, of the search
RESOLUTION = 0.05  # mm, of what is in the way where nothing is found


class Linker:
    """Of a cell's bodies (``scene``) and the settings of a job's program."""

    def __init__(
        self, scene: core.ArmScene, cell: Cell, settings: RobotProgram, context: core.RunContext
    ) -> None:
        self.scene, self.settings, self.context = scene, settings, context
        self.off = lifts.off_the_part(scene, cell)
        places = [settings.home_joints_deg, *settings.safe_joints_deg]
        self.own = [np.radians(one) for one in places]  # of the user, which stay where they are

    def find(self, begin: Floats, end: Floats) -> list[dict[str, Any]] | None:
        """Links in a row, as ``ArmScene.link`` gives them, by the user's safe places where no direct way is found; None:
        there is no way."""
        for places in ([end], *([*_stops(safe, begin, end), end] for safe in self.own[1:])):
            found, at = [], begin
            for place in places:
                one = self._way(at, place)
                if one is None:
                    break
                found.append(one)
                at = place
            else:
                return found
        return None

    def in_the_way(self, begin: Floats, end: Floats) -> tuple[str, str]:
        """Names of two bodies for which no way was found."""
        clearance = self.settings.clearance_mm / 2.0**lifts.HALVINGS
        met = self.scene.within(begin, clearance) or self.scene.within(end, clearance)
        if met is None:
            met = self.scene.on_way(begin, end, clearance, RESOLUTION)
        return ("", "") if met is None else met[:2]  # None cannot be: that way is tried first

    def _way(self, begin: Floats, end: Floats) -> dict[str, Any] | None:
        own = self.settings
        ways_off = (self._off(begin), self._off(end))
        found = lifts.link(
            self.scene, (begin, end), ways_off, own.retract_mm, own.clearance_mm, STEP
        )
        if found is None:
            part = self.context.part(0.0, 0.0)
            found = self.scene.link(begin, end, own.clearance_mm, STEP, own.seed, context=part)
        return found

    def _off(self, q: Floats) -> lifts.Lifted | None:
        return None if any(np.array_equal(q[:6], one) for one in self.own) else self.off


def _stops(safe: Floats, begin: Floats, end: Floats) -> list[Floats]:
    """At a safe place of the joints (6,) coordinated external axes go from where they begin to where they end."""
    stops = [np.concatenate([safe, one[6:]]) for one in (begin, end)]
    return stops[:1] if np.array_equal(*stops) else stops
