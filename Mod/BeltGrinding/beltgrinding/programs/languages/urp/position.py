"""Where the waypoints of a PolyScope program lie: joints and kinematics, or poses, made frames.

Metres and radians in the file. PolyScope 5 keeps a waypoint as joint angles q with the arm's
Denavit-Hartenberg parameters and the TCP on the flange; the flange is the product over the joints of
Rz(q + deltaTheta) Tz(d) Tx(a) Rx(alpha), as Universal Robots' "DH Parameters for calculations of
kinematics and dynamics" has it. PolyScope 3 keeps the pose of the TCP (rotation vector) as well.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np

from ....base.kinds import Array, Floats
from ....base.frames import to_quaternions
from ...program import Fact, Motion, Unknown
from ..xml_tree import Element
from ..urscript.pose import pose_of

NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
PARAMETERS = ("deltaTheta", "a", "d", "alpha")
LEAST_ARM = 0.1  # m; kinematics below are a placeholder
MOST = 1e4  # m or rad, of any number: calibrated d are hundreds of metres, which cancel
MOST_REACH = 100.0  # m
Six: TypeAlias = tuple[float, ...]  # m, and a rotation vector
NOWHERE: Six = (0.0,) * 6


def six(text: str | None, what: Fact) -> Six:
    """Six numbers 'a, b, ...' as floats. Raises Unknown."""
    parts = [part.strip() for part in (text or "").split(",")]
    if len(parts) != 6 or not all(map(NUMBER.fullmatch, parts)):
        raise Unknown(
            "programs.urp.not_six_numbers",
            "{what} '{text}' is not six numbers",
            what=what,
            text=(text or "")[:40],
        )
    values = tuple(map(float, parts))
    if max(values) >= MOST or min(values) <= -MOST:
        raise Unknown("programs.out_of_bounds", "{what} is out of all bounds", what=what)
    return values


def in_mm(values: Sequence[float]) -> Floats:
    """4 x 4 in mm of six numbers: m, and a rotation vector."""
    frame = pose_of(list(values)).frame.copy()
    frame[:3, 3] *= 1000.0
    return frame


def keep_kinematics() -> Callable[[Element], None]:
    """A function for <Kinematics> elements just read: their parameters become attributes, which are
    kept once, since every waypoint repeats them."""
    kept: dict[tuple[tuple[str, str], ...], dict[str, str]] = {}

    def reduce(element: Element) -> None:
        values = {c.tag: c.get("value", "") for c in element.children if c.tag in PARAMETERS}
        element.attributes = kept.setdefault(tuple(sorted(values.items())), values)
        element.children = ()

    return reduce


class Positions:
    """Waypoints to be made poses all at once."""

    def __init__(self) -> None:
        # (motion, q, parameters, tcp, feature)
        self.joints: list[tuple[Motion, Six, Six, Six, Six]] = []
        self.poses: list[tuple[Motion, Six, Six]] = []  # (motion, pose, feature)
        # (motion, pose in the base, pose in the feature, name of the feature)
        self.taught: list[tuple[Motion, Six, Six, str]] = []
        # Parameters by the id of the attributes, which are kept for it to stay their own
        self.arms: dict[int, tuple[Six | None, dict[str, str]]] = {}
        self.texts: dict[tuple[str, Six], str] = {}
        self.numbers: dict[str | None, Six] = {}
        self.frames: dict[str, Floats] = {}  # of features in words, 4 x 4 in mm

    def six(self, text: str | None, what: Fact) -> Six:
        """Six numbers, those that many waypoints have read once."""
        if text not in self.numbers:
            if len(self.numbers) > 1000:
                self.numbers.clear()
            self.numbers[text] = six(text, what)
        return self.numbers[text]

    def described(self, name: str, feature: Six) -> str:
        """A feature in words; '' for the robot's base."""
        key = (name, feature)
        if key not in self.texts:
            text = f"{name or 'feature'} p[" + ", ".join(f"{v:g}" for v in feature) + "]"
            self.texts[key] = "" if not name and feature == NOWHERE else text
            self.frames[self.texts[key]] = in_mm(feature)
        return self.texts[key]

    def arm(self, element: Element | None) -> Six | None:
        """24 parameters of a <Kinematics> element, None where it is a placeholder."""
        if element is None:
            return None
        key = id(element.attributes)
        if key not in self.arms:
            values = [
                six(
                    element.get(name),
                    Fact("programs.urp.kinematics", "the kinematics' {name}", name=name),
                )
                for name in PARAMETERS
            ]
            reach = sum(abs(v) for v in (*values[1], *values[2]))
            arm: Six | None = None if reach < LEAST_ARM else sum(values, ())
            self.arms[key] = (arm, element.attributes)
        return self.arms[key][0]

    def finish(self) -> list[Motion]:
        """Sets the motions' poses, in mm; returns those whose pose is no robot's."""
        wrong = []
        for motions, frames in (self._from_joints(), self._from_poses(), self._from_taught()):
            for motion, frame in zip(motions, frames):
                if np.abs(frame[:3, 3]).max() < 1000.0 * MOST_REACH:
                    motion.pose = frame
                else:
                    wrong.append(motion)
        return wrong

    def _from_joints(self) -> tuple[Sequence[Motion], Iterable[Floats]]:
        if not self.joints:
            return [], []
        motions, q, arms, tcps, features = zip(*self.joints)
        theta, a, d, alpha = np.split(np.array(arms), 4, axis=1)
        flange: Floats = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        for k in range(6):
            angle = np.array(q)[:, k] + theta[:, k]
            flange = flange @ _link(angle, a[:, k], d[:, k], alpha[:, k])
        return motions, _in_feature(flange @ frames_of(tcps), features)

    def _from_poses(self) -> tuple[Sequence[Motion], Iterable[Floats]]:
        if not self.poses:
            return [], []
        motions, poses, features = zip(*self.poses)
        return motions, _in_feature(frames_of(poses), features)

    def _from_taught(self) -> tuple[Sequence[Motion], Iterable[Floats]]:
        """PolyScope 3 keeps the pose in the base and in the feature: between them, the feature."""
        if not self.taught:
            return [], []
        motions, poses, insides, names = zip(*self.taught)
        inner = frames_of(insides)
        features = frames_of(poses) @ inverses(inner)
        quaternions = to_quaternions(features[:, :3, :3])
        sines = np.linalg.norm(quaternions[:, 1:], axis=1)
        angles = 2.0 * np.arctan2(sines, quaternions[:, 0])
        vectors = quaternions[:, 1:] * (angles / np.where(sines > 1e-12, sines, 1.0))[:, None]
        rows = np.round(np.hstack([features[:, :3, 3], vectors]), 6) + 0.0
        for motion, name, row in zip(motions, names, rows.tolist()):
            motion.base = self.described(name, tuple(row))
        inner[:, :3, 3] *= 1000.0
        return motions, inner


def _link(angle: Floats, a: Floats, d: Floats, alpha: Floats) -> Floats:
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha), np.sin(alpha)
    link = np.zeros((len(angle), 4, 4))
    link[:, 0] = np.stack([c, -s * ca, s * sa, a * c], 1)
    link[:, 1] = np.stack([s, c * ca, -c * sa, a * s], 1)
    link[:, 2, 1:] = np.stack([sa, ca, d], 1)
    link[:, 3, 3] = 1.0
    return link


def frames_of(poses: Sequence[Six]) -> Floats:
    """(n, 4, 4) in m of poses (n, 6): position in m and rotation vector."""
    rows = np.asarray(poses, dtype=float).reshape(-1, 6)
    vectors = rows[:, 3:]
    angles = np.linalg.norm(vectors, axis=1)
    x, y, z = (vectors / np.where(angles > 1e-12, angles, 1.0)[:, None]).T
    c, s = np.cos(angles), np.sin(angles)
    t = 1.0 - c
    frames = np.zeros((len(rows), 4, 4))
    frames[:, 0, :3] = np.stack([c + t * x * x, t * x * y - s * z, t * x * z + s * y], 1)
    frames[:, 1, :3] = np.stack([t * x * y + s * z, c + t * y * y, t * y * z - s * x], 1)
    frames[:, 2, :3] = np.stack([t * x * z - s * y, t * y * z + s * x, c + t * z * z], 1)
    frames[:, :3, 3] = rows[:, :3]
    frames[:, 3, 3] = 1.0
    return frames


def inverses(frames: Floats) -> Floats:
    result = np.zeros_like(frames)
    result[:, :3, :3] = frames[:, :3, :3].transpose(0, 2, 1)
    result[:, :3, 3] = -(result[:, :3, :3] @ frames[:, :3, 3:])[:, :, 0]
    result[:, 3, 3] = 1.0
    return result


def _in_feature(frames: Floats, features: Sequence[Six]) -> Floats:
    """Frames in the base, given in features, in mm."""
    frames = inverses(frames_of(features)) @ frames
    frames[:, :3, 3] *= 1000.0
    return frames
