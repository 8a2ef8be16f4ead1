"""Whether a scan lies where it was laid: the alignment begun from other places around, and compared.

Iterative closest points end in the nearest valley. That it converged, and the standard deviations of its last
step, say nothing of other valleys beside it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..engine import InputError, core
from . import start as scan_start

if TYPE_CHECKING:
    from .kinds import Register

# Places around, as shares of the datum's radius and as turns: all freedoms at once near it, and each by itself
# farther away, since far from it in all of them nothing ends where it should.
NEAR, FAR = (0.06, math.radians(5.0)), (0.15, math.radians(12.0))
POINTS, ROUNDS = 4_000, 60  # of the scan, for one of them
WAYS = (  # signs of tx, ty, tz, rx, ry, rz: two of each sign in every pair of freedoms (Plackett, Burman)
    (1, 1, 1, -1, 1, -1),
    (-1, 1, 1, 1, -1, 1),
    (-1, -1, 1, 1, 1, -1),
    (1, -1, -1, 1, 1, 1),
    (-1, 1, -1, -1, 1, 1),
    (1, -1, 1, -1, -1, 1),
    (1, 1, -1, 1, -1, -1),
    (-1, -1, -1, -1, -1, -1),
)
APART = 2e-3  # of the datum's radius: placements that are no farther from each other are one
LEAST_APART = 0.05  # mm
ALIKE = 1.25  # times the residual per share of points used: fits nearly as well
BETTER = 0.8
LEAST_RMS = 1e-5  # mm: what is below is rounding
POOR = 3.0  # bands of the tolerance: a datum that the scan is farther from is not the scan's


def look_around(
    found: Json, register: Register, datum: Json, fixed: Iterable[bool]
) -> dict[str, Any]:
    """What other starts say of an alignment: dict(placements: of those that fit as well or better, itself
    among them; apart_mm, apart_deg: how far these lie from it; sd: {index of a freedom: mm or rad over
    them}, warnings).

    found: what ``register(matrix, points, rounds)`` gave for the whole scan; fixed: bool for each of
    ``FREEDOMS``. A placement that fits worse is a valley that the alignment is not in, and counts for
    nothing.
    """
    free = np.array([0.0 if one else 1.0 for one in fixed])
    centre = np.asarray(found["centre"])
    radius = float(np.sqrt(((datum["points"] - centre) ** 2).sum(axis=1).mean()))
    here = np.asarray(found["work_from_scan"])
    own = _tried(register, here)
    nothing = {"placements": 1, "apart_mm": 0.0, "apart_deg": 0.0, "sd": {}, "warnings": []}
    if own is None or not free.any():
        return nothing
    alike, better = [np.zeros(6)], []
    starts = _starts(radius, free)
    for step in starts:
        other = _tried(register, moved_about(here, centre, step))
        if other is None:
            continue
        motion = motion_between(own["work_from_scan"], other["work_from_scan"], centre)
        if _size(motion, radius) <= max(LEAST_APART, APART * radius):
            continue  # the same place
        if _score(other) < BETTER * _score(own):
            better.append(motion)
        elif _score(other) <= ALIKE * _score(own):
            alike.append(motion)
    others = better or alike[1:]
    if not others:
        return nothing
    far = max(others, key=lambda motion: _size(motion, radius))
    spread = np.std(np.array([*alike, *better]), axis=0)
    scale = np.array([1 / radius] * 3 + [1.0] * 3)
    told = {
        "count": len(others),
        "tried": len(starts),
        "mm": _size(far, radius),
        "deg": math.degrees(float(np.linalg.norm(far[3:]))),
        "motion": scan_start.motion_words((far * scale) / np.linalg.norm(far * scale)),
    }
    if better:
        warning = core.Fact(
            "scan.better_elsewhere",
            "this placement is not to be trusted: {count} of {tried} starts around it end where the scan fits "
            "better, up to {mm:.2g} mm and {deg:.2g}° away ({motion}); start from pairs of points",
            **told,
        )
    else:
        warning = core.Fact(
            "scan.other_placements",
            "this placement is not to be trusted: {count} of {tried} starts around it end elsewhere and fit as "
            "well, up to {mm:.2g} mm and {deg:.2g}° away ({motion}); add datum faces that hold the scan, or "
            "start from pairs of points",
            **told,
        )
    return {
        "placements": 1 + len(others),
        "apart_mm": told["mm"],
        "apart_deg": told["deg"],
        "sd": {k: float(value) for k, value in enumerate(spread) if free[k] > 0.0},
        "warnings": [warning],
    }


def _starts(radius: float, free: Floats) -> list[Floats]:
    """Motions (6,) in mm and rad that lead to the places around; ``free``: 0 for a freedom that is fixed."""
    near = np.array([NEAR[0] * radius] * 3 + [NEAR[1]] * 3) * free
    far = np.array([FAR[0] * radius] * 3 + [FAR[1]] * 3) * free
    single = np.concatenate([np.diag(far), -np.diag(far)])
    return [*(near * np.array(WAYS)), *single[np.abs(single).sum(axis=1) > 0.0]]


def poor_fit(rms_mm: float, tolerance: Sequence[float]) -> Facts:
    """[Fact] where the datum's residual is many times a tolerance (lower, upper) in mm, else []."""
    band = tolerance[1] - tolerance[0]
    if not (band > 0 and rms_mm > POOR * band):
        return []
    return [
        core.Fact(
            "scan.poor_fit",
            "this placement is not to be trusted: on the mean the scan lies {rms:.3g} mm off the datum, {times:.0f} "
            "times the tolerance's band; it is another part, or not well aligned",
            rms=rms_mm,
            times=rms_mm / band,
        )
    ]


def moved_about(matrix: Floats, centre: Floats, motion: Floats) -> Floats:
    """A transform (4, 4) after a small motion (6,): shift in mm, and a turn in rad about ``centre``."""
    turn = rotation(np.asarray(motion[3:], dtype=float))
    result = np.eye(4)
    result[:3, :3] = turn @ matrix[:3, :3]
    result[:3, 3] = turn @ (matrix[:3, 3] - centre) + centre + motion[:3]
    return result


def motion_between(one: Floats, other: Floats, centre: Floats) -> Floats:
    """(6,) the motion that ``moved_about`` needs from one transform to the other."""
    one, other = np.asarray(one), np.asarray(other)
    turn = other[:3, :3] @ one[:3, :3].T
    shift = other[:3, 3] - (turn @ (one[:3, 3] - centre) + centre)
    return np.concatenate([shift, rotation_vector(turn)])


def rotation(vector: Floats) -> Floats:
    """The rotation (3, 3) by a vector of its axis times its angle in rad."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-15:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def rotation_vector(turn: Floats) -> Floats:
    """What ``rotation`` made a rotation of."""
    from ..base.frames import to_quaternions

    quaternion = to_quaternions(turn[None])[0]
    quaternion = quaternion if quaternion[0] >= 0 else -quaternion
    sine = float(np.linalg.norm(quaternion[1:]))
    if sine < 1e-15:
        return np.zeros(3)
    return quaternion[1:] / sine * 2.0 * math.atan2(sine, quaternion[0])


def _tried(register: Register, matrix: Floats) -> Json | None:
    try:
        return register(matrix, POINTS, ROUNDS)
    except InputError:  # hardly a point of the scan is near the datum there
        return None


def _score(found: Json) -> float:
    return max(found["rms"], LEAST_RMS) / max(found["used_share"], 1e-9)


def _size(motion: Floats, radius: float) -> float:
    """mm that the datum's points move by, about."""
    return float(np.hypot(np.linalg.norm(motion[:3]), radius * np.linalg.norm(motion[3:])))
