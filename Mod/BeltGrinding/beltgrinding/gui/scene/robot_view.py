"""A robot's arm as solids, in the shape that collisions take it in, at the pose of a path."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pivy import coin

from ...engine import InputError
from ...presets import external_axes, robot as robots, urdf_shapes
from ...geometry.body_names import LINKS
from ..common.kinds import Array, Json, Node, Surface
from .shapes3d import material, separator, set_matrix, triangles

if TYPE_CHECKING:
    from ...engine import core

LINK, HUB = (0.96, 0.55, 0.14), (0.20, 0.24, 0.30)
CREASE = 0.6  # rad; round along a link, an edge at its ends


class RobotView:
    """Draws a job's robot; nothing where there is none, or where it does not reach. ``bodies``: {name as
    events have it: node} of the links."""

    def __init__(self) -> None:
        self.root = coin.SoSwitch()
        self.places: list[Node] = []
        self.bodies: dict[str, Node] = {}
        self.arm: core.RobotArm | None = None
        self.joints: Array | None = None
        self.standing: Array = np.eye(4)  # base_from_room: external axes may carry the part
        self.shapes: list[tuple[str, Array, Array]] = []  # of the links: name, points, triangles
        self.at: list[Array] = []  # frames of the links at the pose
        self.followed: Array | None = None  # (n, 6) degrees, of a path that was followed as a whole
        self.external: Array | None = None  # (n, axes) where external axes move along the path

    def choose(self, robot: Json) -> None:
        """A job's robot, with its defaults; its errors are the panel's."""
        self.joints = self.followed = self.external = None
        self.standing = np.eye(4)
        self.root.removeAllChildren()
        self.places, self.bodies, self.shapes = [], {}, []
        try:
            robot = robots.checked(robot)
            self.arm = robots.arm_of(robot)
            self.standing = robots.standing(robot)
        except InputError:
            self.arm = None
        if self.arm is not None:
            self._build(robots.links_of(robot, urdf_shapes.VISUAL))
            self.base_from_robot = robots.robot_frame(robot, "base_from_robot")
            self.axes, self.at_zero = robot["external_axes"], robots.frame_at_zero(robot)
            self.flange_from_tcp = robots.robot_frame(robot, "flange_from_tcp")
            self.near = np.clip(np.zeros(6), self.arm.lower, self.arm.upper)

    def follow(self, joints_deg: Array | None, external: Array | None) -> None:
        """Goes by the joints of a path, and the places of the external axes, as ``followed`` and ``external`` have them;
        without them by the nearest solution, and the axes stand."""
        self.followed, self.external = joints_deg, external
        if self.arm is not None and external is None:
            self._move_axes(external_axes.at(self.axes, "position"))

    def stand(self, index: int) -> None:
        """Moves the external axes to where they are at a pose, if the path moves them."""
        if self.arm is None or self.external is None or index >= len(self.external):
            return
        self._move_axes(self.external[index].tolist())

    def _move_axes(self, values: Sequence[float]) -> None:
        self.base_from_robot = external_axes.base_from_robot(self.axes, values, self.at_zero)
        part = external_axes.displacement(self.axes, values, external_axes.PART)
        self.standing = np.linalg.inv(part)

    def place(self, work_from_base: Array, base_from_tcp: Array, index: int) -> None:
        """Puts the arm where it holds the tool frame at the pose number ``index`` (from 0)."""
        arm = self.arm
        self.joints = None if arm is None else self._solve(arm, base_from_tcp, index)
        if arm is None or self.joints is None:
            self.root.whichChild = coin.SO_SWITCH_NONE
            return
        self.root.whichChild = coin.SO_SWITCH_ALL
        self.near = self.joints
        work = work_from_base @ self.base_from_robot
        self.at = [work @ link for link in arm.links(self.joints)]
        for place, frame in zip(self.places, self.at):
            set_matrix(place, frame)

    def solids(self) -> dict[str, Surface]:
        """{name: (points (n, 3) mm, triangles (m, 3))} of the links as drawn; empty where they are not."""
        if self.joints is None:
            return {}
        return {
            name: (points @ frame[:3, :3].T + frame[:3, 3], faces)
            for (name, points, faces), frame in zip(self.shapes, self.at)
            if len(faces)
        }

    def _build(self, links: Iterable[Any]) -> None:
        """Nodes of the links, to be placed."""
        for name, parts in zip(LINKS, links):
            place, solid = coin.SoMatrixTransform(), coin.SoSeparator()
            for colour, (points, faces) in zip((LINK, HUB), parts):
                if len(faces):
                    shape = triangles(points, faces, CREASE, True)
                    solid.addChild(separator(material(colour), shape))
            self.root.addChild(separator(place, solid))
            self.places.append(place)
            self.shapes.append((name, *_joined(parts)))
            if solid.getNumChildren():
                self.bodies[name] = solid

    def _solve(self, arm: core.RobotArm, base_from_tcp: Array, index: int) -> Array | None:
        """Joints in rad: those with which the path is followed, else the nearest to the last."""
        if self.followed is not None and index < len(self.followed):
            joints = np.radians(self.followed[index])
            return joints if np.isfinite(joints).all() else None
        wanted = np.linalg.inv(self.base_from_robot) @ base_from_tcp
        rows = arm.inverse(wanted @ np.linalg.inv(self.flange_from_tcp), self.near)
        inside = ((rows >= arm.lower) & (rows <= arm.upper)).all(axis=1)
        rows = rows[inside] if inside.any() else rows
        if not len(rows):
            return None
        return rows[np.argmin(np.abs(rows - self.near).max(axis=1))]


def _joined(parts: Iterable[Surface]) -> Surface:
    """(points, triangles) of several meshes as one."""
    parts = [
        (np.asarray(p, dtype=float).reshape(-1, 3), np.asarray(f, dtype=int)) for p, f in parts
    ]
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    faces = [f.reshape(-1, 3) + start for (_, f), start in zip(parts, starts)]
    return np.vstack([points for points, _ in parts]), np.vstack(faces)
