"""A program for the whole robot as it is run: places of the arm by time, what is near there, events."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ..base import frames, records
from ..base.kinds import Context, Floats, Json, known
from ..cell import events as kinds, tool_path as tool_paths
from ..engine import core
from ..job import robot_time
from ..job.settings import Job
from ..job.typed import typed
from ..presets import external_axes, robot as robots
from . import facts, scenes as scene_lists
from .moves import Incident, Move, Whole

STEP, TURN = 5.0, math.radians(3.0)  # mm, rad, between places
MOST = 4000  # places; a longer program has them farther apart
LEAST_FEED, LEAST_TIME = 1e-3, 1e-3  # mm/s, s
HALVINGS = 6  # of the clearance, for how near two bodies come
FREE, NEAR, MET = 0, 1, 2


@dataclass
class Walk:
    """n places. Joints are NaN where the arm does not get."""

    times: list[float]  # s
    joints_deg: list[list[float]]  # (n, 6)
    poses: list[list[float]]  # (n, 6) mm and rotation vector in rad: base_from_tcp
    external: list[list[float]]  # (n, axes) mm or degrees
    moves: list[int]  # on whose way each place is, from 0
    states: list[int]  # FREE; NEAR: bodies within cell.clearance_mm; MET: in each other
    bodies: list[list[str]]  # two names, none where it is free
    distances: list[float]  # mm, at most, where bodies are near

    def data(self) -> dict[str, Any]:
        """As JSON has it."""
        found = {one.name: getattr(self, one.name) for one in fields(self)}
        rows = [[None if math.isnan(x) else x for x in row] for row in self.joints_deg]
        return {**found, "joints_deg": rows}

    @classmethod
    def from_data(cls, data: Json) -> Walk:
        """Of what ``data`` gives."""
        rows = [[math.nan if x is None else x for x in row] for row in data["joints_deg"]]
        given: dict[str, Any] = {**data, "joints_deg": rows}
        return cls(**given)

    def frames(self) -> Floats:
        """(n, 4, 4) mm: base_from_tcp."""
        found = np.tile(np.eye(4), (len(self.poses), 1, 1))
        for frame, pose in zip(found, self.poses):
            frame[:3, 3], frame[:3, :3] = pose[:3], frames.rotation(np.array(pose[3:]))
        return found

    def at_move(self, move: int) -> int:
        """The last place on the way of a motion."""
        return max(int(np.searchsorted(self.moves, move, side="right")) - 1, 0)


def walk(
    job: Job | Json, whole: Whole, shape: core.Shape | None = None, context: Context = None
) -> Walk:
    """The ``Walk`` of a validated job's ``Whole``. ``shape``: the design, None: it is read. Joints go as fast as they may
    in joint motions; path motions take their feed. Raises InputError, Cancelled."""
    from ..job.workpiece import read_design

    job, context = typed(job), context or core.RunContext()
    if shape is None and job.cell.check_collisions:
        shape = read_design(job.design, context)
    return _Walker(job, whole, shape, context).run()


class _Walker:
    def __init__(
        self, job: Job, whole: Whole, shape: core.Shape | None, context: core.RunContext
    ) -> None:
        self.job, self.whole, self.context = job, whole, context
        path = tool_paths.tool_path(job, 0, [])
        self.scenes = scene_lists.of_job(job, shape, path, [], context)
        robot = records.plain(job.robot)
        self.arm = known(robots.arm_of(robot))
        self.axes = robot["external_axes"]
        self.standing = external_axes.at(self.axes, "position")
        self.moving = external_axes.coordinated(self.axes)
        self.at_zero = robots.frame_at_zero(robot)
        self.tool = robots.robot_frame(robot, "flange_from_tcp")
        self.turning = math.radians(robot_time.limits(job).rotation_speed_deg_s)
        self.clearance = job.cell.clearance_mm
        self.scale = max(1.0, self._places() / MOST)
        self.found = Walk([], [], [], [], [], [], [], [])
        self.time = 0.0

    def run(self) -> Walk:
        moves = self.whole.moves
        self._add(0, 0.0, self._at(moves[0]), moves[0])
        for number, (before, move) in enumerate(zip(moves[:-1], moves[1:]), 1):
            self.context.report(number / len(moves))  # raises Cancelled
            self._follow(number, before, move)
        return self.found

    def _places(self) -> float:
        """About how many there are at STEP and TURN."""
        return sum(
            1.0 + max(_way(before, move) / STEP, _turn(before, move) / TURN)
            for before, move in zip(self.whole.moves[:-1], self.whole.moves[1:])
        )

    def _follow(self, number: int, before: Move, move: Move) -> None:
        begin, end = self._at(before), self._at(move)
        seconds = self._seconds(before, move)
        if move.kind == "LIN" and np.isfinite(begin).all() and np.isfinite(end).all():
            way, whole = self.scenes.passes.straight_way(
                begin, move.frame, STEP * self.scale, TURN * self.scale, end
            )
            rows = np.asarray(way)[1:] if whole and len(way) > 1 else end[None]
        else:
            count = math.ceil(_turn(before, move) / (TURN * self.scale)) or 1
            rows = begin + np.linspace(0.0, 1.0, count + 1)[1:, None] * (end - begin)
            rows[-1] = end
        for k, row in enumerate(rows, 1):
            share = k / len(rows)
            self._add(number, self.time + share * seconds, row, move, before, share)
        self.time += seconds

    def _at(self, move: Move) -> Floats:
        """(6 + k,) at a motion's end, NaN where the arm does not get."""
        return external_axes.coordinates(self.axes, np.degrees(_radians(move)), move.external)

    def _seconds(self, before: Move, move: Move) -> float:
        """What a motion takes: of joints, of the tool, of external axes."""
        axes = [
            abs(b - a) / one["max_speed"]
            for a, b, one in zip(before.external, move.external, self.axes)
            if one["max_speed"] > 0.0
        ]
        slowest = max(axes, default=0.0)
        if move.kind == "LIN":
            length, turned = _way(before, move), _rotation(before.frame, move.frame)
            return max(length / max(move.feed, LEAST_FEED), turned / self.turning, slowest)
        limited = self.arm.max_speed > 0.0
        turns = np.abs(_radians(move) - _radians(before))[limited]
        share = self.job.robot.program.joint_speed_percent / 100.0
        joints = np.nan_to_num(turns / (share * self.arm.max_speed[limited]))
        return float(max(joints.max(initial=0.0), slowest, LEAST_TIME))

    def _add(
        self,
        number: int,
        time: float,
        q: Floats,
        move: Move,
        before: Move | None = None,
        share: float = 1.0,
    ) -> None:
        values = move.external
        if before is not None:
            values = tuple(a + share * (b - a) for a, b in zip(before.external, move.external))
        frame, there = move.frame, bool(np.isfinite(q).all())
        if there:
            base = external_axes.base_from_robot(self.axes, values, self.at_zero)
            frame = base @ self.arm.forward(q[:6]) @ self.tool
        vector = frames.rotation_vectors(frame[None, :3, :3])[0]
        found = self.found
        found.times.append(round(time, 6))
        found.joints_deg.append(np.degrees(q[:6]).tolist())
        found.poses.append([*frame[:3, 3].tolist(), *vector.tolist()])
        found.external.append([float(one) for one in values])
        found.moves.append(number)
        state, distance = FREE, 0.0
        bodies: list[str] = []
        indexed = [k for k in range(len(values)) if k not in self.moving]
        if there and all(values[k] == self.standing[k] for k in indexed):
            scene = self.scenes.passes if move.kind == "LIN" else self.scenes.links
            state, bodies, distance = self._look(scene, q)
        found.states.append(state)
        found.bodies.append(bodies)
        found.distances.append(distance)

    def _look(self, scene: core.ArmScene, q: Floats) -> tuple[int, list[str], float]:
        met = scene.within(q, 0.0)
        if met is not None:
            return MET, [*met[:2]], 0.0
        near = scene.within(q, self.clearance)
        if near is None:
            return FREE, [], 0.0
        low, high = 0.0, self.clearance
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            one = scene.within(q, middle)
            low, high, near = (middle, high, near) if one is None else (low, middle, one)
        return NEAR, [*near[:2]], high


def _radians(move: Move) -> Floats:
    if move.joints_deg is None:
        return np.full(6, np.nan)
    found: Floats = np.radians(move.joints_deg)
    return found


def _way(before: Move, move: Move) -> float:
    """mm, of the tool on a path motion."""
    length = float(np.linalg.norm(move.frame[:3, 3] - before.frame[:3, 3]))
    return length if move.kind == "LIN" else 0.0


def _turn(before: Move, move: Move) -> float:
    """rad: of the joint that turns most, of the tool on a path motion; external axes count as a turn of their own."""
    turns = np.nan_to_num(np.abs(_radians(move) - _radians(before)))
    if move.kind == "LIN":
        return _rotation(before.frame, move.frame)
    goes = before.external != move.external
    return max(float(turns.max()), 10.0 * TURN if goes else 0.0)


def _rotation(begin: Floats, end: Floats) -> float:
    return float(np.linalg.norm(frames.rotation_vectors((begin[:3, :3].T @ end[:3, :3])[None])))


def events(whole: Whole, found: Walk, clearance: float) -> list[dict[str, Any]]:
    """Events, as events.json has them, of a program's incidents and of where bodies are near, by time. ``pose``: the place
    of the walk, from 0."""
    known_kinds = kinds.kinds()
    lines = [move.line for move in whole.moves]
    listed = [_of_incident(one, found, lines, known_kinds) for one in whole.incidents]
    told = {frozenset(one.bodies) for one in whole.incidents if one.bodies}
    begin = 0
    for k in range(1, len(found.states) + 1):
        if k == len(found.states) or found.bodies[k] != found.bodies[begin]:
            if found.states[begin] != FREE and frozenset(found.bodies[begin]) not in told:
                event = _of_places(found, begin, k, clearance, known_kinds)
                listed.append({**event, "line": lines[found.moves[event["pose"]]]})
            begin = k
    return sorted(listed, key=lambda one: (one["time"], one["pose"]))


def _of_incident(
    one: Incident, found: Walk, lines: Sequence[int], known_kinds: Json
) -> dict[str, Any]:
    place = found.at_move(one.move)
    for k in range(place, -1, -1):  # where the bodies are in each other, if a place shows it
        if found.moves[k] != found.moves[place]:
            break
        if found.states[k] == MET:
            place = k
            break
    event = kinds.momentary(
        known_kinds[one.kind],
        one.kind,
        [one.fact],
        time=found.times[place],
        pose=place,
        line=lines[min(one.move, len(lines) - 1)],
    )
    return {**event, "program": 0, "severity": one.severity, "bodies": [*one.bodies]}


def _of_places(
    found: Walk, begin: int, end: int, clearance: float, known_kinds: Json
) -> dict[str, Any]:
    """Of the places from ``begin`` on, up to ``end``, where the same two bodies are near."""
    worst = min(range(begin, end), key=lambda k: (-found.states[k], found.distances[k]))
    kind = "collision" if found.states[worst] == MET else "near_miss"
    body, other = found.bodies[worst]
    distance = found.distances[worst]
    if kind == "collision":
        fact = facts.meet_there(body=body, other=other)
    else:
        fact = facts.near_there(body=body, other=other, distance=distance)
    event = kinds.momentary(
        known_kinds[kind], kind, [fact], time=found.times[begin], pose=worst, line=0,
        value=distance, limit=clearance if kind == "near_miss" else None,
    )  # fmt: skip
    seconds = found.times[end - 1] - found.times[begin]
    return {**event, "program": 0, "bodies": [body, other], "duration": seconds,
            "worst_time": found.times[worst]}  # fmt: skip
