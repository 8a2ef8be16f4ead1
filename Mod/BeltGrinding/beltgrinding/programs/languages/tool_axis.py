"""Poses of programs that give a tool's position and axis only, as milling programs do.

The axis points from the part to the spindle; the simulator's tool z points into the work, so
z = -axis. The rotation about it is free (``Motion.free_roll``): ``roll.lay`` turns the poses when all are
read; until then x stays as near as possible to the one before.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...base.kinds import Floats, known
from ..program import CHORD_ERROR, MAX_CHORDS, Fact, Motion, Program, Unknown
from .set_frames import Frame

Vector = Sequence[float]

NO_UNITS = Fact(
    "programs.units_unknown",
    "the file says neither mm nor inch; its motions are left out until you give the unit: --units mm or "
    '--units inch, or "units" in the values file',
)
MACHINE_COORDINATES = Fact(
    "programs.gcode.kinematics",
    "rotary axes without G43.4 or TRAORI are machine coordinates: the machine's kinematics is "
    "needed; post-process with tool-centre-point control",
)
A_AND_B = Fact("programs.gcode.a_and_b", "A and B together depend on the machine's kinematics")
RADIUS_ERROR = 0.05  # mm, between an arc's radius at its start and at its end
LEAST_STEP = 1e-9  # relative; below, a motion has no direction across the axis


class Tracer:
    """Appends motions to a Program, each oriented by its axis; its roll is free."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.position: tuple[
            float, ...
        ] | None = None  # (x, y, z) in mm of the last pose, None: unknown
        self.x: tuple[float, ...] = (1.0, 0.0, 0.0)
        self.zone: float | None = None  # of the motions to come, mm; None: not known
        self.frame: Frame | None = (
            None  # the Frame that positions are in; None: the program's first
        )

    def gap(self, line: int, again: bool = True) -> None:
        """What is left out: the path beyond must not be joined over it. ``again``: as ``Program.gap``'s."""
        self.position = None
        self.program.gap(line, self.program.file, again)

    def move(
        self,
        kind: str,
        position: Vector,
        axis: Vector,
        line: int,
        speed: float | None = None,
        base: str = "",
        tool: str = "",
        aux: bool = False,
    ) -> None:
        """One motion to ``position`` in mm, in ``frame``, with the unit ``axis`` in the program's first
        coordinates; ``speed`` in mm/s."""
        z = (-axis[0], -axis[1], -axis[2])
        x = _across(self.x, z) or _across((0.0, 1.0, 0.0), z) or known(_across((0.0, 0.0, 1.0), z))
        at: Vector | Floats = position
        if self.frame is not None:
            at = self.frame.point(position)
        pose = np.empty((4, 4))
        pose[:] = (
            (x[0], z[1] * x[2] - z[2] * x[1], z[0], at[0]),
            (x[1], z[2] * x[0] - z[0] * x[2], z[1], at[1]),
            (x[2], z[0] * x[1] - z[1] * x[0], z[2], at[2]),
            (0.0, 0.0, 0.0, 1.0),
        )
        motion = Motion(kind, pose, line, self.program.file, speed, tool=tool, base=base, aux=aux)
        motion.zone_mm, motion.free_roll = self.zone, True
        self.program.motions.append(motion)
        self.position, self.x = tuple(position), x

    def arcs(
        self,
        points: Sequence[Vector],
        axis: Vector,
        line: int,
        speed: float | None = None,
        base: str = "",
        tool: str = "",
    ) -> None:
        """Arcs, each by a point on the way and its end; there is no stop between them."""
        for k in range(0, len(points), 2):
            self.move("CIRC", points[k], axis, line, speed, base, tool, aux=True)
            self.move("CIRC", points[k + 1], axis, line, speed, base, tool)
            if k + 2 < len(points):
                self.program.motions[-1].zone_mm = math.inf

    def helix(
        self,
        points: Sequence[Vector],
        axis: Vector,
        line: int,
        speed: float | None = None,
        base: str = "",
        tool: str = "",
    ) -> None:
        """The chords of a helix; at the points between them there is no stop."""
        for k, point in enumerate(points):
            self.move("LIN", point, axis, line, speed, base, tool)
            if k + 1 < len(points):
                self.program.motions[-1].zone_mm = math.inf


def unit(vector: Vector) -> tuple[float, ...] | None:
    """The vector at length 1, None where it has no direction."""
    length = math.sqrt(sum(v * v for v in vector))
    if not 1e-6 < length < 1e6:
        return None
    return tuple(v / length for v in vector)


def axis_by_angles(rotary: Mapping[str, Any]) -> tuple[float, ...]:
    """The tool's axis by the degrees of A, B, C: Rz(C) Rx(A) z, or Rz(C) Ry(B) z. Raises Unknown with A and B."""
    a, b, c = (math.radians(rotary.get(letter, 0.0)) for letter in "ABC")
    if a and b:
        raise Unknown(A_AND_B)
    x, y, z = math.sin(b), -math.sin(a), math.cos(a) * math.cos(b)
    return (math.cos(c) * x - math.sin(c) * y, math.sin(c) * x + math.cos(c) * y, z)


def _across(direction: Vector, z: Vector) -> tuple[float, ...] | None:
    """Unit vector of ``direction`` without its part along ``z``; None where nothing is left."""
    along = sum(a * b for a, b in zip(direction, z))
    x = [d - along * c for d, c in zip(direction, z)]
    length = math.sqrt(sum(v * v for v in x))
    if length <= LEAST_STEP * (1.0 + abs(along)) or length <= 1e-6 * abs(along):
        return None
    return tuple(v / length for v in x)


def arc_through(
    start: Vector, centre: Vector, end: Vector, normal: Vector, full: bool
) -> list[tuple[float, ...]]:
    """Points on a circle's arc from ``start`` counterclockwise about the unit ``normal``: the one
    half way, and for a full circle (``full``: start and end the same) those at 1/4, 1/2, 3/4 turn.

    Returns a list of points (3,) in mm, the end left out.
    """
    first, middle, last, up = (np.asarray(v, dtype=float) for v in (start, centre, end, normal))
    u, w = first - middle, last - middle
    height = float((w - u) @ up)  # of a helix
    u, w = u - (u @ up) * up, w - (w @ up) * up
    v = np.cross(up, u)
    angle = math.atan2(float(w @ v), float(w @ u)) % (2.0 * math.pi)
    if full or angle < 1e-9:
        angle = 2.0 * math.pi
    parts = 4 if angle > 1.5 * math.pi else 2
    foot = first - u
    points = []
    for k in range(1, parts):
        t = k / parts
        points.append(foot + math.cos(t * angle) * u + math.sin(t * angle) * v + t * height * up)
    return [tuple(map(float, point)) for point in points]


def centre_by_radius(
    start: Vector, end: Vector, radius: float, counterclockwise: bool
) -> tuple[float, float]:
    """The centre (2,) of the arc between two points (2,) of a plane; a negative radius: the longer arc. Raises
    Unknown where there is none."""
    chord = (end[0] - start[0], end[1] - start[1])
    length = math.hypot(*chord)
    if length < 1e-9 or length > 2.0 * abs(radius) + 2.0 * RADIUS_ERROR:
        raise Unknown("programs.gcode.radius", "R does not fit the arc's ends")
    height = math.sqrt(max(0.0, radius * radius - length * length / 4.0)) / length
    side = height if counterclockwise == (radius > 0) else -height
    return (
        start[0] + chord[0] / 2.0 - side * chord[1],
        start[1] + chord[1] / 2.0 + side * chord[0],
    )


def checked_arc(start: Vector, centre: Vector, end: Vector) -> float:
    """The radius of an arc in a plane. Raises Unknown where its ends are not at one distance from its centre."""
    radii = [math.hypot(p[0] - centre[0], p[1] - centre[1]) for p in (start, end)]
    if radii[0] < 1e-9 or abs(radii[0] - radii[1]) > max(RADIUS_ERROR, 1e-3 * radii[0]):
        raise Unknown(
            "programs.gcode.arc_ends", "the arc's ends are not at one distance from its centre"
        )
    return radii[0]


def helix_through(
    start: Vector, centre: Vector, end: Vector, plane: tuple[int, int, int], angle: float
) -> list[tuple[float, ...]]:
    """Points after ``start`` of a helix that turns by ``angle`` in rad (counterclockwise: positive) about
    ``centre`` to ``end``, all (3,) in mm; ``plane``: its axes and that of the helix."""
    u, v, w = plane
    first = math.atan2(start[v] - centre[v], start[u] - centre[u])
    radii = [math.hypot(p[u] - centre[u], p[v] - centre[v]) for p in (start, end)]
    step = 2.0 * math.acos(max(-1.0, 1.0 - CHORD_ERROR / max(radii[0], CHORD_ERROR)))
    count = math.ceil(abs(angle) / min(step, 0.5))
    if not 0 < count <= MAX_CHORDS:
        raise Unknown("programs.long_helix", "the helix has too many turns")
    points = []
    for k in range(1, count):
        share = k / count
        point, radius = [0.0] * 3, radii[0] + share * (radii[1] - radii[0])
        point[u] = centre[u] + radius * math.cos(first + share * angle)
        point[v] = centre[v] + radius * math.sin(first + share * angle)
        point[w] = start[w] + share * (end[w] - start[w])
        points.append(tuple(point))
    return [*points, tuple(end)]
