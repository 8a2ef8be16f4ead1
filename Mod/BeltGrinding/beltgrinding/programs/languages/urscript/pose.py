"""URScript's poses: six numbers in metres and radians, the rotation as an axis times an angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np

from ....base.kinds import Floats
from ....base.frames import to_quaternions
from ...program import Unknown
from ..core.expression import number


class Pose:
    """A pose: ``frame``, 4 x 4 in metres."""

    def __init__(self, frame: Floats) -> None:
        self.frame = frame

    def components(self) -> list[float]:
        """[x, y, z, rx, ry, rz] in metres and radians (axis times angle)."""
        w, *axis = map(float, to_quaternions(self.frame[None, :3, :3])[0])
        sine = math.sqrt(sum(v * v for v in axis))
        factor = 2.0 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
        return [*map(float, self.frame[:3, 3]), *(factor * v for v in axis)]

    def inverse(self) -> Pose:
        frame = np.eye(4)
        frame[:3, :3] = self.frame[:3, :3].T
        frame[:3, 3] = -frame[:3, :3] @ self.frame[:3, 3]
        return Pose(frame)

    def __str__(self) -> str:
        return "p[" + ", ".join(f"{v:g}" for v in self.components()) + "]"


class InReference(Pose):
    """A pose in ref_frame, of which only the controller knows where it is: only another pose in it goes
    with it.
    """

    def components(self) -> NoReturn:
        raise Unknown("programs.urscript.in_ref_frame", "where ref_frame is, is not known here")

    def inverse(self) -> NoReturn:
        self.components()


def pose_of(values: Sequence[object]) -> Pose:
    """Pose of six numbers in metres and radians."""
    if len(values) != 6:
        raise Unknown(
            "programs.urscript.components",
            "a pose has 6 components, not {count}",
            count=len(values),
        )
    x, y, z, rx, ry, rz = (float(number(v)) for v in values)
    angle = math.sqrt(rx * rx + ry * ry + rz * rz)
    if not math.isfinite(angle) or abs(x) + abs(y) + abs(z) > 1e6 or angle > 1e3:
        raise Unknown("programs.urscript.pose_out_of_bounds", "the pose is out of all bounds")
    frame = np.empty((4, 4))
    if angle > 1e-12:
        kx, ky, kz = rx / angle, ry / angle, rz / angle
    else:
        kx = ky = kz = 0.0
    c, s = math.cos(angle), math.sin(angle)
    d = 1.0 - c
    frame[:] = (
        (c + d * kx * kx, d * kx * ky - s * kz, d * kx * kz + s * ky, x),
        (d * kx * ky + s * kz, c + d * ky * ky, d * ky * kz - s * kx, y),
        (d * kx * kz - s * ky, d * ky * kz + s * kx, c + d * kz * kz, z),
        (0.0, 0.0, 0.0, 1.0),
    )
    return Pose(frame)


def a_pose(value: object) -> Pose:
    """``value`` if it is a pose."""
    if not isinstance(value, Pose):
        raise Unknown("programs.urscript.pose_expected", "a pose p[..] expected")
    return value


def chained(first: object, second: object) -> Pose:
    """pose_trans: the second pose, given in the first."""
    return _placed(first, second, a_pose(first).frame @ a_pose(second).frame)


def added(first: Any, second: Any) -> Pose:
    """pose_add: positions add up, rotations follow each other."""
    frame = a_pose(first).frame @ a_pose(second).frame
    frame[:3, 3] = first.frame[:3, 3] + second.frame[:3, 3]
    if isinstance(first, InReference):
        first.components()
    return _placed(first, second, frame)


def _placed(first: Any, second: Any, frame: Floats) -> Pose:
    if isinstance(second, InReference):
        (first if isinstance(first, InReference) else second).components()
    if not np.abs(frame[:3, 3]).max() < 1e6:
        raise Unknown("programs.urscript.pose_out_of_bounds", "the pose is out of all bounds")
    return InReference(frame) if isinstance(first, InReference) else Pose(frame)
