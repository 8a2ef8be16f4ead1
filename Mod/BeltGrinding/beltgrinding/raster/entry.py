"""How the wheel comes onto a pass and leaves it: from outside the border where there is room, under a force
that grows from little to full along the pass.

A wheel that comes down under its full force grinds where it comes down. Here it comes down and lifts off with
touch_force_share of the force, outside the border, and the force grows over the length of the contact while
that rolls over the border: as much of the force as of the contact is on the face, so that the pressure stays.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
import math
from collections.abc import Sequence

import numpy as np

from ..base.kinds import Context, Floats, Json
from ..engine import InputError, core
from ..job import robot_time
from ..job.settings import Job

if TYPE_CHECKING:
    from .kinds import Room
    from .tool import Tool

SAMPLES = 40_000  # of the faces that are ground, and of all others, to look for room
OWN = 0.05  # mm that it may reach deeper into the faces that are ground
TRIES = 1.0, 0.5  # of the way beyond the border
INSIDE = 0.1  # of half the contact's length: a ramp that begins on the border
STILL = 1e-6  # mm; less is no way
SHORTEST = 0.2  # mm; a shorter one is none
FASTER = 2.0  # times the feed, that plans may come to within the robot's blocks


class Entry:
    """What the ends of passes need: ``lead``, mm; ``force``, N, full, None under position
    control; ``block``, mm: the least way from pose to pose, so that the robot keeps up."""

    def __init__(
        self,
        job: Job,
        shape: core.Shape,
        faces: Sequence[int],
        settings: Json,
        context: Context,
        length: float,
        tool: Tool,
    ) -> None:
        """``faces``: those that are ground, from 0; ``length``: mm of the contact along the passes; ``tool``: of
        ``tool.of``. Raises InputError, Cancelled."""
        self.settings, self.context = settings, context
        machine = job.belt_machine
        self.tool = tool
        under_force = machine.control == "force"
        self.force = (settings["force_N"] or machine.force_N) if under_force else None
        spares = under_force and settings["entry"] != "direct"
        self.border = float(settings["border_force_share"]) if spares else 0.0
        self._half = 0.5 * length if settings["entry"] != "direct" else 0.0
        self.lead = 0.0
        if settings["entry"] == "run_on":
            self.lead = settings["lead_mm"] or self._half
        self.limits = robot_time.limits(job)
        feed = FASTER * (settings["entry_feed_mm_s"] or settings["feed_mm_s"])
        self.block = max(feed * self.limits.least_block_s, self.limits.least_block_mm)
        # A run-out of the user's own is a part of it.
        self.lead = max(self.lead - max(settings["run_out_mm"], 0.0), 0.0)
        if (
            settings["run_out_mm"] < 0.0 or settings["keep_edge_mm"] > 0.0
        ):  # the border is to be spared
            self.lead = 0.0
        self._own = self._others = None
        if self.lead > 0.0:
            self._own, self._others = (
                self._samples(shape, some)
                for some in (faces, [k for k in range(shape.face_count) if k not in set(faces)])
            )

    def _samples(self, shape: core.Shape, faces: Sequence[int]) -> tuple[Floats, Floats] | None:
        """(points, normals) of faces; None: they cannot be sampled."""
        if not faces:
            return np.zeros((0, 3)), np.zeros((0, 3))
        try:
            spacing = math.sqrt(sum(shape.face_area(k) for k in faces) / SAMPLES)
            field, _ = core.sample_faces(shape, faces, spacing, context=self.context)
        except InputError:
            return None
        # Both ways: beyond a wall the wheel's centre is behind it, and would see its back only.
        normals = field.normals.astype(float)
        return np.vstack([field.points] * 2), np.vstack([normals, -normals])

    def leads(self, frames: Floats, outwards: Floats, most: Floats, clearing: Room) -> Floats:
        """mm that the wheel may stand beyond the ends of passes at ``frames`` (n, 4, 4) along ``outwards``
        (n, 3), ``most`` (n,) at most; 0: no room. There it must stand off the faces that are not ground, and
        reach no deeper into those that are than it does at the end, and than fit_mm; ``clearing``: clearing.Clearing,
        by which it must fit.
        """
        found = np.zeros(len(frames))
        if self._own is None or self._others is None:
            return found
        here = np.minimum(self._depth(frames, self._own), self.settings["fit_mm"])
        for share in TRIES:
            lead = share * most
            left = np.flatnonzero((found == 0.0) & (lead > SHORTEST))
            out = frames[left].copy()
            out[:, :3, 3] += lead[left, None] * outwards[left]
            fits = self._depth(out, self._own) <= here[left] + OWN
            fits &= clearing.fits_upright(out)
            down = self.tool.over_border(lead[left])
            out[:, :3, 3] += down[:, None] * out[:, :3, 2]
            fits &= self._depth(out, self._others, whole=True) <= 0.0
            found[left[fits]] = lead[left[fits]]
        return found

    def _depth(
        self, frames: Floats, samples: tuple[Floats, Floats] | None, whole: bool = False
    ) -> Floats:
        assert samples is not None  # what cannot be sampled is not asked for
        points, normals = samples
        if not len(points) or not len(frames):
            return np.zeros(len(frames))
        if whole:
            return self.tool.depth(frames, points, self.context)
        return self.tool.depth_before(frames, points, normals, self.context)

    def ramp(self, lead: float = 0.0) -> float:
        """mm over which the force grows from where the wheel comes down, ``lead`` mm outside the border: to
        where all of the contact is on the face. Without a lead it is on its border for half of its length at
        once, and what that half does not remove there is missing: a short ramp, of one block at least.
        """
        if self.settings["entry"] == "direct":
            return 0.0
        grown = lead + (1.0 if lead > 0.0 or self.border else INSIDE) * self._half
        return self.settings["ramp_mm"] or max(grown, self.block)

    def ramps(self, leads: Sequence[float], length: float) -> Floats:
        """mm at both ends of ``length`` mm: shorter, where they do not fit in."""
        ramps = np.array([self.ramp(lead) for lead in leads])
        return ramps * min(1.0, length / max(ramps.sum(), STILL))

    def shares(self, places: Floats, leads: Sequence[float], length: float) -> Floats:
        """Of the full force, at ``places`` (n,) mm from where the wheel comes down, ``length`` mm before it
        lifts off; ``leads``: of both ends, mm."""
        touch, ramps = self.settings["touch_force_share"], self.ramps(leads, length)
        if ramps[0] <= 0.0:
            return np.ones(len(places))
        ends = zip((places, length - places), ramps, leads)
        return np.minimum(*(self._grown(way, ramp, lead, touch) for way, ramp, lead in ends))

    def _grown(self, way: Floats, ramp: float, lead: float, touch: float) -> Floats:
        """Of the full force, ``way`` (n,) mm from one end of a pass."""
        if not self.border:
            return touch + (1.0 - touch) * np.clip(way / ramp, 0.0, 1.0)
        outside = min(lead, ramp)
        inside = np.clip((way - outside) / max(ramp - outside, STILL), 0.0, 1.0)
        # A contact's length goes with the root of its force: it reaches to the border and no farther.
        spared = np.maximum(self.border, inside**2)
        least = min(touch, self.border)
        before = least + (self.border - least) * np.clip(way / max(outside, STILL), 0.0, 1.0)
        return np.where(way < outside, before, spared)
