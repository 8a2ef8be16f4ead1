"""A robot arm as a figure of sticks: its links and the hubs of its joints, at the pose of a path."""

import numpy as np
from pivy import coin

from ...base import frames
from ...engine import InputError
from ...presets import robot as robots, robot_model
from .shapes3d import material, separator, set_matrix

LINK, HUB = (0.96, 0.55, 0.14), (0.20, 0.24, 0.30)
THICKNESS = 0.035  # a link's radius as a share of the arm's length
LEAST = 1e-6  # mm; a shorter link is none


def _along(direction):
    """A rotation whose y axis is ``direction``."""
    y = direction / np.linalg.norm(direction)
    other = np.eye(3)[np.argmin(np.abs(y))]
    x = np.cross(y, other)
    x /= np.linalg.norm(x)
    return np.stack([x, y, np.cross(x, y)], axis=1)


class _Stick:
    """A cylinder between two points, or about one."""

    def __init__(self, colour):
        self.place = coin.SoMatrixTransform()
        self.cylinder = coin.SoCylinder()
        self.root = separator(self.place, material(colour), self.cylinder)

    def put(self, middle, direction, length, radius):
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = _along(direction), middle
        set_matrix(self.place, frame)
        self.cylinder.radius, self.cylinder.height = float(radius), float(length)


class RobotView:
    """Draws a job's robot; nothing where there is none, or where it does not reach."""

    def __init__(self):
        self.root = coin.SoSwitch()
        self.links = [_Stick(LINK) for _ in range(robot_model.JOINTS + 1)]
        self.hubs = [_Stick(HUB) for _ in range(robot_model.JOINTS)]
        for stick in (*self.links, *self.hubs):
            self.root.addChild(stick.root)
        self.arm = self.joints = None
        self.followed = None  # (n, 6) degrees, where the whole path has been followed

    def choose(self, robot):
        """A job's robot, with its defaults; its errors are the panel's."""
        self.joints = self.followed = None
        try:
            self.arm = robots.arm_of(robots.checked(robot))
        except InputError:
            self.arm = None
        if self.arm is not None:
            self.base_from_robot = frames.from_data(robot.get("base_from_robot"))
            self.flange_from_tcp = frames.from_data(robot.get("flange_from_tcp"))
            self.near = np.clip(np.zeros(6), self.arm.lower, self.arm.upper)

    def place(self, work_from_base, base_from_tcp, index):
        """Puts the arm where it holds the tool frame at the pose number ``index`` (from 0)."""
        self.joints = None
        if self.arm is not None:
            self.joints = self._solve(base_from_tcp, index)
        if self.joints is None:
            self.root.whichChild = coin.SO_SWITCH_NONE
            return
        self.root.whichChild = coin.SO_SWITCH_ALL
        self.near = self.joints
        work = work_from_base @ self.base_from_robot
        axes, points = self.arm.placed(self.joints)
        flange = self.arm.forward(self.joints)[:3, 3]
        axes = axes @ work[:3, :3].T
        points = np.vstack([np.zeros(3), points, flange]) @ work[:3, :3].T + work[:3, 3]
        radius = THICKNESS * self.arm.length
        for k, link in enumerate(self.links):
            way = points[k + 1] - points[k]
            length = float(np.linalg.norm(way))
            direction = way if length > LEAST else axes[0]
            middle = 0.5 * (points[k] + points[k + 1])
            link.put(middle, direction, length, radius if length > LEAST else 0.0)
        for hub, axis, point in zip(self.hubs, axes, points[1:]):
            hub.put(point, axis, 2.8 * radius, 1.5 * radius)

    def _solve(self, base_from_tcp, index):
        """Joints in rad: those with which the path is followed, else the nearest to the last."""
        if self.followed is not None and index < len(self.followed):
            joints = np.radians(self.followed[index])
            return joints if np.isfinite(joints).all() else None
        wanted = np.linalg.inv(self.base_from_robot) @ base_from_tcp
        rows = self.arm.inverse(wanted @ np.linalg.inv(self.flange_from_tcp), self.near)
        inside = ((rows >= self.arm.lower) & (rows <= self.arm.upper)).all(axis=1)
        rows = rows[inside] if inside.any() else rows
        if not len(rows):
            return None
        return rows[np.argmin(np.abs(rows - self.near).max(axis=1))]
