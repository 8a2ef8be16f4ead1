"""What presses the belt, as it is undeformed: whether it fits the part, and what lies under it. A wheel, or the flat
belt of a free run or a platen with its rollers.

Frames are work_from_contact (n, 4, 4), lengths mm.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from ..base.kinds import Array, Context, Floats, Json, known
from ..cell import collision
from ..engine import core
from ..geometry import free_run
from ..job import machine as machines, settings
from ..job.settings import Job
from ..job.typed import typed

CHECKS = 8.0  # of a wheel's radius, or a belt's width: that way from place to place that is looked at, along a pass
CLEAR = 0.25  # of the wheel's height over the border: so far it must stand off other faces
OFF = 0.05  # mm, that a belt must, which lies flat
COARSE_CELLS = 10  # across a belt, to look at many contacts
COARSE_TOLERANCE = 1e-2  # of their pressure
LEAST_BEHIND = 5.0  # mm behind a belt on rollers of no size

Tool: TypeAlias = "Wheel | Belt"


def of(job: Job | Json, advance: float = 0.0) -> Tool:
    """The tool of a validated job; ``advance``: mm that a belt gives way, by which its rollers come nearer to the part."""
    job = typed(job)
    return Wheel(job) if machines.wheel_presses(job.belt_machine) else Belt(job, advance)


class Wheel:
    """A contact wheel."""

    belt = False

    def __init__(self, job: Job) -> None:
        self.shape = job.belt_machine.wheel
        self.radius, self.width = float(self.shape.radius_mm), float(self.shape.width_mm)
        self.check = self.radius / CHECKS
        profile = collision.wheel_profile(job.belt_machine.wheel)
        self._across = profile[:, 0]
        self._back = np.interp(0.0, profile[:, 0], profile[:, 1]) - profile[:, 1]
        self._drop = _drop(self.shape)

    @property
    def name(self) -> core.Fact:
        """Fact: what it is, as a subject."""
        return core.Fact("raster.the_wheel", "the wheel")

    @property
    def smaller(self) -> core.Fact:
        """Fact: what to take where it does not fit."""
        return core.Fact("raster.a_smaller_wheel", "a smaller or narrower wheel")

    def chord(self, depth: float) -> float:
        """mm on which it stands ``depth`` deep in a plane."""
        return 2.0 * math.sqrt(2.0 * self.radius * depth)

    def over_border(self, lead: Floats) -> Floats:
        """mm (n,) by which it must stand off other faces, ``lead`` (n,) beyond a border: a share of how high it stands
        over that."""
        return CLEAR * lead**2 / (2.0 * self.radius)

    def shift(self, lean: float) -> Floats:
        """From the leaned contact frame's origin to the point that lies deepest in the work, in that frame (3,)."""
        k = int(np.argmax(self._across * math.sin(lean) - self._back * math.cos(lean)))
        return np.array([0.0, self._across[k], -self._back[k]])

    def depth(self, frames: Floats, points: Floats, context: Context = None) -> Floats:
        """mm (n,) that points (k, 3) stand in it."""
        return np.asarray(core.wheel_fit(self.shape, frames, points, points, context, True))

    def depth_before(
        self, frames: Floats, points: Floats, normals: Floats, context: Context = None
    ) -> Floats:
        """mm (n,) that a surface of points with normals (k, 3) stands in the half of it that faces the work."""
        return np.asarray(core.wheel_fit(self.shape, frames, points, normals, context, False))

    def edge_gap(self, length: float, width: float) -> float:
        """mm from it to a plane at the edge of a contact of ``length`` and ``width`` on that."""
        across = float(np.interp(0.5 * min(width, self.width), *self._drop))
        return max(length**2 / (8.0 * self.radius), across)

    def under(self, points: Floats, frames: Floats, length: float, gap: float) -> Array:
        """(k,) bool of points (k, 3) that lie no farther than ``gap`` from it at one of its frames."""
        z, y = frames[:, :3, 2], frames[:, :3, 1]
        middle = frames[:, :3, 3].mean(axis=0)  # from near by no digits are lost
        points, axle = points - middle, frames[:, :3, 3] - self.radius * z - middle
        beside = points @ y.T - (axle * y).sum(axis=1)
        down = points @ z.T > (axle * z).sum(axis=1)
        squares = (
            (points**2).sum(axis=1)[:, None] - 2.0 * points @ axle.T + (axle**2).sum(axis=1)
        )
        off = np.sqrt(np.maximum(squares - beside**2, 0.0)) - self.radius
        if self._drop[1].any():
            off += np.interp(beside, *self._drop)
        return ((abs(beside) <= 0.5 * self.width) & (abs(off) <= gap) & down).any(axis=1)


def _drop(wheel: settings.Wheel) -> tuple[Floats, Floats]:
    """(y mm, how much smaller the wheel's radius is there, mm), finely."""
    crown, half = wheel.crown_radius_mm, 0.5 * wheel.width_mm
    y = np.linspace(-half, half, 65)
    turned = np.array(wheel.profile_mm, dtype=float).reshape(-1, 2)
    drop = np.interp(y, turned[:, 0], turned[:, 1]) if len(turned) else np.zeros(len(y))
    if crown > 0.0:
        drop = drop + crown - np.sqrt(np.maximum(crown**2 - y**2, 0.0))
    return y, drop


class Belt:
    """The belt between its rollers, as it touches nothing: flat, or bent over a curved platen. What of the part reaches through it beside the contact
    bears the belt there, as a wall beside a wheel would."""

    belt = True
    radius = math.inf

    def __init__(self, job: Job, advance: float) -> None:
        machine = job.belt_machine
        run = known(machine.free_run)
        self.width, self.length = float(run.width_mm), float(run.length_mm)
        self.check = self.width / CHECKS
        self._machine = machine
        radius, thickness = float(run.roller_radius_mm), float(run.thickness_mm)
        # Up to the belt that runs back.
        self._behind = max(2.0 * (radius + thickness), LEAST_BEHIND)
        self._roller = settings.Wheel(  # a cylinder
            radius_mm=radius, width_mm=self.width, crown_radius_mm=0.0, profile_mm=()
        )
        # Where a wheel would touch that stands as they do.
        axes = free_run.roller_axes(machine) if radius > 0.0 else np.zeros((0, 2))
        self._rollers = [np.array([x, 0.0, z + radius + advance]) for x, z in axes]
        self._radius = free_run.arc(machine)[0]
        self._face = free_run.line(machine, free_run.face(machine))  # [x, z]

    @property
    def name(self) -> core.Fact:
        """Fact: what it is, as a subject."""
        return core.Fact("raster.the_belt", "the belt")

    @property
    def smaller(self) -> core.Fact:
        """Fact: what to take where it does not fit."""
        return core.Fact("raster.a_smaller_belt", "a narrower belt, or rollers that are nearer")

    def coarse(self, machine: settings.BeltMachine) -> settings.BeltMachine:
        """A BeltMachine whose contacts are solved as finely as is enough to look at many contacts, each of which costs a hundred of a
        wheel's."""
        return replace(
            machine,
            contact_spacing_mm=max(machine.contact_spacing_mm, self.width / COARSE_CELLS),
            contact_tolerance=max(machine.contact_tolerance, COARSE_TOLERANCE),
        )

    def chord(self, depth: float) -> float:
        """mm on which it stands ``depth`` deep in a plane: all, where it is flat."""
        if self._radius > 0.0:
            return min(2.0 * math.sqrt(2.0 * self._radius * depth), self.length)
        return self.length

    def over_border(self, lead: Floats) -> Floats:
        """mm (n,) by which it must stand off other faces, ``lead`` (n,) beyond a border; of a curved platen a share of how
        high it stands over that, as of a wheel."""
        off = np.full(len(lead), OFF)
        if self._radius > 0.0:
            off = np.maximum(off, CLEAR * np.asarray(lead) ** 2 / (2.0 * self._radius))
        return off

    def shift(self, lean: float) -> Floats:
        """From the leaned contact frame's origin to the point that lies deepest in the work, in that frame (3,)."""
        return np.array([0.0, math.copysign(0.5 * self.width, lean) if lean else 0.0, 0.0])

    def depth(self, frames: Floats, points: Floats, context: Context = None) -> Floats:
        """mm (n,) that points (k, 3) stand in it, or in its rollers."""
        found = np.asarray(
            core.run_fit(self._machine, self._behind, frames, points, context=context)
        )
        if not self._rollers:
            return found
        both = []  # at once: the points are sorted into cells at each call
        for place in self._rollers:
            both.append(frames.copy())
            both[-1][:, :3, 3] += frames[:, :3, :3] @ place
        met = core.wheel_fit(self._roller, np.concatenate(both), points, points, context, True)
        return np.maximum(found, np.max(np.split(np.asarray(met), len(both)), axis=0))

    def depth_before(
        self, frames: Floats, points: Floats, normals: Floats, context: Context = None
    ) -> Floats:
        """mm (n,) that a surface of points (k, 3) stands in it, whatever its normals."""
        return self.depth(frames, points, context)

    def edge_gap(self, length: float, width: float) -> float:
        """mm from it to a plane at the ends of a contact of ``length``: none, where it is flat."""
        return max(OFF, length**2 / (8.0 * self._radius)) if self._radius > 0.0 else OFF

    def under(self, points: Floats, frames: Floats, length: float, gap: float) -> Array:
        """(k,) bool of points (k, 3) that lie no farther than ``gap`` from it at one of its frames, on ``length`` mm
        along it."""
        way = points[:, None] - frames[:, :3, 3][None]
        x, y, z = (np.einsum("nkx,kx->nk", way, frames[:, :3, k]) for k in range(3))
        along = abs(x) <= 0.5 * min(length, self.length)
        off = abs(z - np.interp(x, *self._face.T))
        return (along & (abs(y) <= 0.5 * self.width) & (off <= max(gap, OFF))).any(axis=1)
