"""The shape of a robot's arm, made from its axes: a model has no shape, only where its joints are.

Each link is a tapered tube from its axis to the next with a hub about its own. How thick they are is
*estimated* from the arm's length, unless the job says it (``robot.link_radii_mm``).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..base.kinds import Array, Floats, Json

if TYPE_CHECKING:
    from ..engine import core

# Radii as shares of the arm's length (axis 2 to the wrist, stretched), from data sheets' drawings of
# arms between 0.8 and 2.6 m: foot, column, upper arm, elbow, forearm, wrist, flange.
SHARES = (0.12, 0.10, 0.075, 0.07, 0.055, 0.045, 0.03)
AROUND = 24  # corners of a tube
HUB_RADIUS, HUB_LENGTH = 1.2, 1.15  # of a hub, in radii of its link; the length to each side
TAPER = 0.85  # a tube's radius at its far end, of that at the near one
ALONG = 0.9  # cosine: an axis nearer to its link's direction needs no hub
UPRIGHT = 0.5  # of axis 1 along the base's z; else the foot begins at the joint
LEAST = 1e-6  # mm; shorter is nothing

Mesh: TypeAlias = "tuple[Floats, Array]"  # points (n, 3) mm, triangles (m, 3)
NOTHING = np.zeros((0, 3)), np.zeros((0, 3), int)
Link: TypeAlias = "tuple[Mesh, Mesh]"  # tubes, hubs
Frustum: TypeAlias = "tuple[Floats, Floats, float, float]"  # ends, and a radius at each


def radii(robot: Json, arm: core.RobotArm) -> Floats:
    """(7,) mm: foot, then links 1 to 6; 0: the link has no body. ``robot``: a job's, with its defaults."""
    return np.array(robot["link_radii_mm"] or np.multiply(SHARES, arm.length), dtype=float)


def links(arm: core.RobotArm, radius: Floats, floor: float) -> list[Link]:
    """[(tubes, hubs)] of the foot and links 1 to 6, each (points (n, 3) in mm, triangles (m, 3)), closed,
    where they lie in the robot's base at joint angles 0; arm.links(q) moves them.

    arm: core.RobotArm. radius (7,) mm. floor: height of the floor plate in the robot's base, mm.
    """
    axes, points = arm.placed(np.zeros(6))
    flange = arm.forward(np.zeros(6))[:3, 3]
    # Foot and column meet half way up to axis 2, on axis 1.
    shoulder = points[0] + axes[0] * float((points[1] - points[0]) @ axes[0])
    upright = abs(axes[0][2]) > UPRIGHT
    foot = shoulder + axes[0] * ((floor - shoulder[2]) / axes[0][2]) if upright else points[0]
    middle = 0.5 * (foot + shoulder)
    found: list[tuple[list[Frustum], list[Frustum]]] = [
        ([(foot, middle, radius[0], radius[1])], [])
    ]
    found.append(
        (
            [
                (middle, shoulder, radius[1], radius[1]),
                (shoulder, points[1], radius[1], TAPER * radius[1]),
            ],
            [],
        )
    )
    ends = [*points[2:], flange]
    for k, end in enumerate(ends, 2):
        begin, axis, r = points[k - 1], axes[k - 1], radius[k]
        way = end - begin
        length = float(np.linalg.norm(way))
        hub: list[Frustum] = []
        if length < LEAST and k == 6:
            # Behind the flange, towards the wrist.
            back = axis * np.sign(axis @ (points[4] - begin) or 1.0)
            hub = [(begin, begin + 0.5 * r * back, r, r)]
        elif length < LEAST or abs(axis @ way) < ALONG * length:
            half = HUB_LENGTH * r * axis
            hub = [(begin - half, begin + half, HUB_RADIUS * r, HUB_RADIUS * r)]
        found.append(([(begin, end, r, TAPER * r)], hub))
    return [(_joined(tubes), _joined(hubs)) for tubes, hubs in found]


def measured(tubes: Sequence[Json]) -> list[Link]:
    """The same, without hubs, of a preset's ``tubes``."""
    found: list[list[Frustum]] = [[] for _ in range(7)]
    for one in tubes:
        begin, end = (np.array(one[key], dtype=float) for key in ("from_mm", "to_mm"))
        found[one["link"]].append((begin, end, one["radius_mm"], one["radius_mm"]))
    return [(_joined(one), NOTHING) for one in found]


def body(tubes: Mesh, hubs: Mesh) -> Mesh:
    """(points, triangles) of a link as one."""
    return _merged([tubes, hubs])


def _joined(frusta: Iterable[Frustum]) -> Mesh:
    return _merged(
        [
            _frustum(*one)
            for one in frusta
            if np.linalg.norm(one[1] - one[0]) > LEAST and max(one[2:]) > 0
        ]
    )


def _merged(meshes: Sequence[Mesh]) -> Mesh:
    points = [np.zeros((0, 3)), *(mesh[0] for mesh in meshes)]
    begins = np.cumsum([0, *(len(one) for one in points[1:])])
    faces = [np.zeros((0, 3), int), *(mesh[1] + b for mesh, b in zip(meshes, begins))]
    return np.concatenate(points), np.concatenate(faces)


def _frustum(begin: Floats, end: Floats, radius: float, far: float) -> Mesh:
    """A closed truncated cone between two points with a radius at each end."""
    z = (end - begin) / np.linalg.norm(end - begin)
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    angles = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)[:, None]
    ring = np.cos(angles) * x + np.sin(angles) * np.cross(z, x)
    points = np.concatenate([begin + radius * ring, end + far * ring, [begin, end]])
    a = np.arange(AROUND)
    b = (a + 1) % AROUND
    low, high = np.full(AROUND, 2 * AROUND), np.full(AROUND, 2 * AROUND + 1)
    faces = [
        (a, b, b + AROUND),
        (a, b + AROUND, a + AROUND),
        (low, b, a),
        (high, a + AROUND, b + AROUND),
    ]
    return points, np.concatenate([np.stack(face, axis=1) for face in faces])
