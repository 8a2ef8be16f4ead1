"""Rigid transforms as 4 x 4 numpy arrays, named a_from_b; mm. Needs nothing but numpy."""

import math

import numpy as np

QUATERNION_TOLERANCE = 1e-3  # off unit length by more is a mistake, not rounding


def from_quaternion(position, quaternion):
    """4 x 4 from a position (3,) in mm and a quaternion w, x, y, z. Raises ValueError."""
    values = np.asarray([*position, *quaternion], dtype=float)
    if not np.isfinite(values).all():
        raise ValueError("the pose is not finite; give real numbers")
    length = float(np.linalg.norm(values[3:]))
    if abs(length - 1.0) > QUATERNION_TOLERANCE:
        raise ValueError(
            f"the quaternion has length {length:.4g} instead of 1; "
            "give a unit quaternion w, x, y, z"
        )
    w, x, y, z = values[3:] / length
    frame = np.eye(4)
    frame[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    frame[:3, 3] = values[:3]
    return frame


def from_abc(position, abc_deg):
    """4 x 4 from a position in mm and KUKA's A, B, C in degrees: Rz(A) Ry(B) Rx(C)."""
    a, b, c = (math.radians(angle) for angle in abc_deg)
    ca, sa, cb, sb, cc, sc = (f(v) for v in (a, b, c) for f in (math.cos, math.sin))
    frame = np.eye(4)
    frame[:3, :3] = [
        [ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc],
        [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc],
        [-sb, cb * sc, cb * cc],
    ]
    frame[:3, 3] = position
    return frame


def to_abc(frame):
    """KUKA's A, B, C in degrees of a 4 x 4; at B = +-90 degrees C is 0."""
    r = np.asarray(frame)[:3, :3]
    horizontal = math.hypot(r[0, 0], r[1, 0])
    b = math.atan2(-r[2, 0], horizontal)
    if horizontal > 1e-9:
        a, c = math.atan2(r[1, 0], r[0, 0]), math.atan2(r[2, 1], r[2, 2])
    else:
        a, c = math.atan2(-r[0, 1], r[1, 1]), 0.0
    return tuple(math.degrees(angle) for angle in (a, b, c))


def from_data(data):
    """4 x 4 from a job file's frame; missing (None) is the identity. Raises ValueError."""
    if not data:
        return np.eye(4)
    position = data.get("position_mm", [0, 0, 0])
    if "quaternion_wxyz" in data and "abc_deg" in data:
        raise ValueError("give quaternion_wxyz or abc_deg, not both")
    if "abc_deg" in data:
        return from_abc(position, data["abc_deg"])
    return from_quaternion(position, data.get("quaternion_wxyz", [1, 0, 0, 0]))
