"""Rigid transforms as 4 x 4 numpy arrays, named a_from_b; mm."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..engine import InputError

QUATERNION_TOLERANCE = 1e-3  # off unit length by more is a mistake, not rounding


def from_quaternion(position: ArrayLike, quaternion: ArrayLike) -> NDArray[np.float64]:
    """4 x 4 from a position (3,) in mm and a quaternion w, x, y, z. Raises InputError."""
    position = np.asarray(position, dtype=float).reshape(1, 3)
    frames = from_quaternions(position, np.asarray(quaternion, dtype=float).reshape(1, 4))
    frame: NDArray[np.float64] = frames[0]
    return frame


def from_quaternions(
    positions: NDArray[np.float64], quaternions: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n, 4, 4) from positions (n, 3) in mm and quaternions (n, 4) w, x, y, z.

    Raises InputError naming the first pose (from 1) that is not finite or not of unit length.
    """
    lengths = np.linalg.norm(quaternions, axis=1)
    finite = np.isfinite(positions).all(axis=1) & np.isfinite(quaternions).all(axis=1)
    unit = np.abs(lengths - 1.0) <= QUATERNION_TOLERANCE
    wrong = np.flatnonzero(~(finite & unit))
    if len(wrong):
        i = int(wrong[0])
        if not finite[i]:
            error = InputError("frames.not_finite", "the pose is not finite; give real numbers")
        else:
            error = InputError(
                "frames.quaternion",
                "the quaternion has length {length:.4g} instead of 1; "
                "give a unit quaternion w, x, y, z",
                length=lengths[i],
            )
        if len(lengths) > 1:
            error = error.within("frames.at_pose", "pose {pose}: ", pose=i + 1)
        raise error
    w, x, y, z = (quaternions / lengths[:, None]).T
    frames = np.zeros((len(lengths), 4, 4))
    frames[:, 0, :3] = np.stack(
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=1
    )
    frames[:, 1, :3] = np.stack(
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=1
    )
    frames[:, 2, :3] = np.stack(
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1
    )
    frames[:, :3, 3] = positions
    frames[:, 3, 3] = 1.0
    return frames


def to_quaternions(rotations: ArrayLike) -> NDArray[np.float64]:
    """Unit quaternions (n, 4) w, x, y, z with w >= 0 of rotations (n, 3, 3), each by its largest
    component (Shepperd 1978)."""
    r = np.asarray(rotations, dtype=float)
    xx, yy, zz = r[:, 0, 0], r[:, 1, 1], r[:, 2, 2]
    a, b, c = r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]
    d, e, f = r[:, 0, 1] + r[:, 1, 0], r[:, 2, 0] + r[:, 0, 2], r[:, 2, 1] + r[:, 1, 2]
    squares = np.stack([1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz], 1)
    rows = np.stack(  # row k: four times component k times w, x, y, z
        [
            np.stack([squares[:, 0], a, b, c], 1),
            np.stack([a, squares[:, 1], d, e], 1),
            np.stack([b, d, squares[:, 2], f], 1),
            np.stack([c, e, f, squares[:, 3]], 1),
        ],
        1,
    )
    quaternions = rows[np.arange(len(r)), np.argmax(squares, axis=1)]
    quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
    return np.asarray(np.where(quaternions[:, :1] < 0, -quaternions, quaternions))


def rotation_vectors(rotations: ArrayLike) -> NDArray[np.float64]:
    """(n, 3) axis times angle in radian, 0 to pi, of rotations (n, 3, 3)."""
    quaternions = to_quaternions(rotations)
    sines = np.linalg.norm(quaternions[:, 1:], axis=1)
    angles = 2.0 * np.arctan2(sines, quaternions[:, 0])
    # 2 is the limit of angle / sine for a small turn.
    factors = np.divide(angles, sines, out=np.full(len(sines), 2.0), where=sines > 1e-12)
    return np.asarray(quaternions[:, 1:] * factors[:, None])


def rotation(vector: ArrayLike) -> NDArray[np.float64]:
    """3 x 3 of an axis times angle in radian (Rodrigues' formula)."""
    turn = np.asarray(vector, dtype=float)
    angle = float(np.linalg.norm(turn))
    if angle < 1e-15:
        return np.eye(3)
    cross = np.cross(np.eye(3), turn / angle)  # times a vector: axis x vector
    found: NDArray[np.float64] = (
        np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    )
    return found


def between(
    begin: NDArray[np.float64], end: NDArray[np.float64], share: float
) -> NDArray[np.float64]:
    """The frame (4, 4) at a share of the straight way from one to another, which turns evenly about one axis."""
    frame = begin.copy()
    frame[:3, 3] += share * (end[:3, 3] - begin[:3, 3])
    vector = rotation_vectors((begin[:3, :3].T @ end[:3, :3])[None])[0]
    frame[:3, :3] = begin[:3, :3] @ rotation(share * vector)
    return frame


def from_abc(position: Iterable[float], abc_deg: Iterable[float]) -> NDArray[np.float64]:
    """4 x 4 from a position in mm and KUKA's A, B, C in degrees: Rz(A) Ry(B) Rx(C)."""
    a, b, c = (math.radians(angle) for angle in abc_deg)
    ca, sa, cb, sb, cc, sc = (f(v) for v in (a, b, c) for f in (math.cos, math.sin))
    x, y, z = position
    return np.array(
        [
            [ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc, x],
            [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc, y],
            [-sb, cb * sc, cb * cc, z],
            [0.0, 0.0, 0.0, 1.0],
        ],
        dtype=float,
    )


def to_abc(frame: ArrayLike) -> tuple[float, ...]:
    """KUKA's A, B, C in degrees of a 4 x 4; at B = +-90 degrees C is 0."""
    r = np.asarray(frame)[:3, :3]
    horizontal = math.hypot(r[0, 0], r[1, 0])
    b = math.atan2(-r[2, 0], horizontal)
    if horizontal > 1e-9:
        a, c = math.atan2(r[1, 0], r[0, 0]), math.atan2(r[2, 1], r[2, 2])
    else:
        a, c = math.atan2(-r[0, 1], r[1, 1]), 0.0
    return tuple(math.degrees(angle) for angle in (a, b, c))


def in_words(frame: NDArray[np.float64]) -> str:
    """A 4 x 4 as programs tell it: X, Y, Z in mm, A, B, C in degrees."""
    values = [*np.round(frame[:3, 3], 6), *np.round(to_abc(frame), 7)]
    return " ".join(f"{k} {v + 0.0:.10g}" for k, v in zip("XYZABC", values))


def from_data(data: Mapping[str, Any] | None) -> NDArray[np.float64]:
    """4 x 4 from a job file's frame; missing (None) is the identity. Raises InputError."""
    if not data:
        return np.eye(4)
    position = data.get("position_mm", [0, 0, 0])
    if "quaternion_wxyz" in data and "abc_deg" in data:
        raise InputError("frames.quaternion_and_abc", "give quaternion_wxyz or abc_deg, not both")
    if "abc_deg" in data:
        return from_abc(position, data["abc_deg"])
    return from_quaternion(position, data.get("quaternion_wxyz", [1, 0, 0, 0]))


def base_from_tcp(
    work_from_contact: NDArray[np.float64],
    holding: str,
    base_from_work: NDArray[np.float64],
    tcp_from_contact: NDArray[np.float64],
    tcp_from_work: NDArray[np.float64],
    base_from_contact: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(n, 4, 4) tool frames at which the contact frame lies at (n, 4, 4) ``work_from_contact``: the
    cell's equations solved for the robot's pose."""
    if holding == "tool_in_hand":
        found = base_from_work @ work_from_contact @ np.linalg.inv(tcp_from_contact)
    else:
        found = base_from_contact @ np.linalg.inv(work_from_contact) @ np.linalg.inv(tcp_from_work)
    return np.asarray(found)


def work_from_frames(
    base_from_tcp: NDArray[np.float64],
    holding: str,
    base_from_work: NDArray[np.float64],
    tcp_from_contact: NDArray[np.float64],
    tcp_from_work: NDArray[np.float64],
    base_from_contact: NDArray[np.float64],
) -> dict[str, NDArray[np.float64]]:
    """{frame: (..., 4, 4) work_from_frame} of base, tool (TCP), contact and part (the work itself)
    with the robot at (..., 4, 4) ``base_from_tcp``: the same equations forwards."""
    if holding == "tool_in_hand":
        base = np.linalg.inv(base_from_work)
        contact = base @ base_from_tcp @ tcp_from_contact
    else:
        base = np.linalg.inv(base_from_tcp @ tcp_from_work)
        contact = base @ base_from_contact
    return {"base": base, "tool": base @ base_from_tcp, "contact": contact, "part": np.eye(4)}
