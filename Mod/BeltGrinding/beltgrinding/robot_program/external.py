"""External axes on their way between home and passes, one after the other, with the arm at home."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base import records
from ..base.kinds import Floats, Json, known
from ..engine import core
from ..geometry.body_names import FOOT
from ..job.settings import Cell, Job
from ..job.workpiece import frame_of
from ..presets import external_axes, robot as robots

TURN = 45.0  # degrees between two poses, so that the way round is clear


class Stage(NamedTuple):
    """One axis goes, the others stand: values of all before and after."""

    number: int  # of the axis, from 0
    begin: tuple[float, ...]
    end: tuple[float, ...]


def stages(axes: list[Any]) -> list[Stage]:
    """From home to the passes, of axes that are indexed; what stays where it is has none."""
    found, now = [], list(external_axes.at(axes, "home"))
    moving = external_axes.coordinated(axes)
    for number, value in enumerate(external_axes.at(axes, "position")):
        if now[number] == value or number in moving:
            continue
        begin = tuple(now)
        now[number] = value
        found.append(Stage(number, begin, tuple(now)))
    return found


class Sweep:
    """The cell of a validated job while its external axes move. ``bodies``: as ``core.find_collisions`` takes them,
    placed as they are in the passes; ``home`` (6,) rad: where the arm stands meanwhile."""

    def __init__(self, job: Job, bodies: Sequence[Json], home: Floats) -> None:
        self.axes = records.plain(job.robot.external_axes)
        self.bodies, self.cell = bodies, job.cell
        robot = records.plain(job.robot)
        arm = known(robots.arm_of(robot))
        self.base = robots.frame_at_zero(robot)
        self.links = arm.links(home)
        self.tool = arm.forward(home) @ robots.robot_frame(robot, "flange_from_tcp")
        self.there = self._moved(external_axes.at(self.axes, "position"), external_axes.PART)

    def meetings(self, stage: Stage) -> Iterator[tuple[str, str]]:
        """Names of two bodies that run into each other in a stage."""
        path, bodies = self._path(stage)
        found = core.check_collisions(path, bodies, 0.0)
        for event in found["events"]:
            yield event["bodies"][0], event["bodies"][1]

    def _path(self, stage: Stage) -> tuple[core.ToolPath, list[dict[str, Any]]]:
        """What the axis carries, as a tool whose frame has its origin on the axis; all else stands in the base."""
        carried = self.axes[stage.number]["carries"]
        start = self._moved(stage.begin, carried)
        on_axis = np.eye(4)
        before = external_axes.displacement(
            self.axes[: stage.number], stage.begin[: stage.number], carried
        )
        on_axis[:3, 3] = (before @ [*self.axes[stage.number]["origin_mm"], 1.0])[:3]
        values = np.linspace(stage.begin, stage.end, self._count(stage) + 1)
        poses = [
            self._moved(tuple(one), carried) @ np.linalg.inv(start) @ on_axis for one in values
        ]
        moving = np.linalg.inv(on_axis)
        listed: list[dict[str, Any]] = []
        for body in self.bodies:
            frame, goes = self._place(body, stage.begin)
            if goes == carried and body["name"] == FOOT:
                continue  # it stands on the axis
            place = moving @ frame if goes == carried else frame
            kind = "tool" if goes == carried else "base"
            points = body["mesh"].vertices @ place[:3, :3].T + place[:3, 3]
            mesh = core.TriangleMesh(points.astype(np.float32), body["mesh"].triangles)
            listed.append({**_plain(body), "frame": kind, "mesh": mesh})
        count = len(poses)
        return core.ToolPath(
            frames=np.stack(poses), feeds=np.full(count, 100.0), forces=np.full(count, -1.0),
            rapid=np.zeros(count, dtype=bool), lines=np.zeros(count, dtype=np.int32),
        ), listed  # fmt: skip

    def _count(self, stage: Stage) -> int:
        way = abs(stage.end[stage.number] - stage.begin[stage.number])
        linear = self.axes[stage.number]["kind"] == external_axes.LINEAR
        return 1 if linear else max(1, math.ceil(way / TURN))

    def _place(self, body: Json, values: tuple[float, ...]) -> tuple[Floats, str]:
        """(a body's frame in the room, what of the axes carries it: robot, part, or "")."""
        robot = self._moved(values, external_axes.ROBOT) @ self.base
        part = self._moved(values, external_axes.PART)
        frame = body["frame"]
        if frame == "link":
            return robot @ self.links[body["link"]], external_axes.ROBOT
        tcp = robot @ self.tool
        in_hand = self.cell.holding == "tool_in_hand"
        if frame == "tool":
            return tcp, external_axes.ROBOT
        if frame == "wheel":
            if in_hand:
                return tcp @ _frame(self.cell, "tcp_from_contact"), external_axes.ROBOT
            return _frame(self.cell, "base_from_contact"), ""
        if frame == "part":
            if in_hand:
                return part @ _frame(self.cell, "base_from_work"), external_axes.PART
            return tcp @ _frame(self.cell, "tcp_from_work"), external_axes.ROBOT
        return self.there, ""  # of the base: it was placed in the frame of the passes

    def _moved(self, values: tuple[float, ...], carried: str) -> Floats:
        return external_axes.displacement(self.axes, values, carried)


def _plain(body: Json) -> dict[str, Any]:
    return {key: value for key, value in body.items() if key in ("name", "margin")}


def _frame(cell: Cell, key: str) -> Floats:
    frame: Floats = frame_of(getattr(cell, key), f"cell.{key}")
    return frame
