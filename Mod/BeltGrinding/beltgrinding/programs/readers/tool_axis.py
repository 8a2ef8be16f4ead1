"""Poses of programs that give a tool's position and axis only, as milling programs do.

The axis points from the part to the spindle; the simulator's tool z points into the work, so
z = -axis. The rotation about it is free (``Motion.free_roll``): ``roll.lay`` turns the poses when all are
read; until then x stays as near as possible to the one before.
"""

import math

import numpy as np

from ..program import Motion

LEAST_STEP = 1e-9  # relative; below, a motion has no direction across the axis


class Tracer:
    """Appends motions to a Program, each oriented by its axis; its roll is free."""

    def __init__(self, program):
        self.program = program
        self.position = None  # (x, y, z) in mm of the last pose, None: unknown
        self.x = (1.0, 0.0, 0.0)
        self.zone = None  # of the motions to come, mm; None: not known

    def gap(self, line):
        """What is left out: the path beyond must not be joined over it."""
        self.position = None
        self.program.gap(line, self.program.file)

    def move(self, kind, position, axis, line, speed=None, base="", tool="", aux=False):
        """One motion to ``position`` in mm with the unit ``axis``; ``speed`` in mm/s."""
        z = (-axis[0], -axis[1], -axis[2])
        x = _across(self.x, z) or _across((0.0, 1.0, 0.0), z) or _across((0.0, 0.0, 1.0), z)
        pose = np.empty((4, 4))
        pose[:] = (
            (x[0], z[1] * x[2] - z[2] * x[1], z[0], position[0]),
            (x[1], z[2] * x[0] - z[0] * x[2], z[1], position[1]),
            (x[2], z[0] * x[1] - z[1] * x[0], z[2], position[2]),
            (0.0, 0.0, 0.0, 1.0),
        )
        motion = Motion(kind, pose, line, self.program.file, speed, tool=tool, base=base, aux=aux)
        motion.zone_mm, motion.free_roll = self.zone, True
        self.program.motions.append(motion)
        self.position, self.x = tuple(position), x

    def arcs(self, points, axis, line, speed=None, base="", tool=""):
        """Arcs, each by a point on the way and its end; there is no stop between them."""
        for k in range(0, len(points), 2):
            self.move("CIRC", points[k], axis, line, speed, base, tool, aux=True)
            self.move("CIRC", points[k + 1], axis, line, speed, base, tool)
            if k + 2 < len(points):
                self.program.motions[-1].zone_mm = math.inf


def unit(vector):
    """The vector at length 1, None where it has no direction."""
    length = math.sqrt(sum(v * v for v in vector))
    if not 1e-6 < length < 1e6:
        return None
    return tuple(v / length for v in vector)


def _across(direction, z):
    """Unit vector of ``direction`` without its part along ``z``; None where nothing is left."""
    along = sum(a * b for a, b in zip(direction, z))
    x = [d - along * c for d, c in zip(direction, z)]
    length = math.sqrt(sum(v * v for v in x))
    if length <= LEAST_STEP * (1.0 + abs(along)) or length <= 1e-6 * abs(along):
        return None
    return tuple(v / length for v in x)


def arc_through(start, centre, end, normal, full):
    """Points on a circle's arc from ``start`` counterclockwise about the unit ``normal``: the one
    half way, and for a full circle (``full``: start and end the same) those at 1/4, 1/2, 3/4 turn.

    Returns a list of points (3,) in mm, the end left out.
    """
    start, centre, end, normal = (np.asarray(v, dtype=float) for v in (start, centre, end, normal))
    u, w = start - centre, end - centre
    height = float((w - u) @ normal)  # of a helix
    u, w = u - (u @ normal) * normal, w - (w @ normal) * normal
    v = np.cross(normal, u)
    angle = math.atan2(float(w @ v), float(w @ u)) % (2.0 * math.pi)
    if full or angle < 1e-9:
        angle = 2.0 * math.pi
    parts = 4 if angle > 1.5 * math.pi else 2
    foot = start - u
    points = []
    for k in range(1, parts):
        t = k / parts
        points.append(
            foot + math.cos(t * angle) * u + math.sin(t * angle) * v + t * height * normal
        )
    return [tuple(map(float, point)) for point in points]
