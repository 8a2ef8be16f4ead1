"""Where a robot stands best: the whole of a job's programs within reach, far from limits and singularities.

A grid over what is free, then the best of it moved by steps that are halved. What is free is where the robot's base
stands about the work, upright as the job has it; or, where the job has external axes, where these stand in the passes.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base import frames, records
from ..base.kinds import Context, Floats, Json, known
from ..engine import core
from ..job import robot_time
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import read_design
from ..presets import robot as robots
from . import collision, reach, tool_path
from .event_lines import RAPID

POSES = 120  # of each program, that the search looks at
CHECKED = 8  # of the best places, with every pose and all bodies
BEST, HALVINGS = 4, 5  # of the grid's places that are moved, and how often their steps are halved
GRID = 500  # places of a grid over external axes, about
NEAREST, FARTHEST, HEIGHT = 0.15, 1.1, 0.6  # of the arm's length, from the middle of the work
HARD = ("out_of_reach", "joint_limit", "wrist_flip", "arm_flip", "collision")  # what may not be


class Free(NamedTuple):
    """A number that may be chosen."""

    name: str
    low: float
    high: float
    samples: int
    round: bool = False  # its ends are the same


class Place(NamedTuple):
    """``values``: of what is free; ``margin_deg``: the least distance from limits and singularities."""

    values: tuple[float, ...]
    reached: float  # share of the poses, within the limits of the joints
    hard: int  # events that may not be
    margin_deg: float

    @property
    def worth(self) -> tuple[float, int, float]:
        return self.reached, -self.hard, self.margin_deg


class Search:
    """Of a validated job with a robot. Raises InputError."""

    def __init__(self, job: Job | Json, context: Context = None) -> None:
        self.job, self.context = typed(job), context or core.RunContext()
        self.robot = records.plain(self.job.robot)
        reach.refuse_coordinated(self.robot)
        self.arm = known(robots.arm_of(self.robot))
        self.turning = robot_time.limits(self.job).rotation_speed_deg_s
        count = len(self.job.programs)
        self.paths = [tool_path.tool_path(self.job, k, []) for k in range(count)]
        self.thin = [_thinned(path) for path in self.paths]
        given = [tool_path.motions(path)["frames"][:, :3, 3] for path in self.paths]
        points = np.concatenate(given)
        self.middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        self.free: list[Free] = []
        self.made: Callable[[Sequence[float]], dict[str, Any]] = self._by_base
        self._choose()
        self.looked_at: list[Place] = []

    def _choose(self) -> None:
        axes = self.robot["external_axes"]
        if axes:
            each = max(3, round(GRID ** (1.0 / len(axes))))
            self.free = [
                Free(f"E{k}", one["lower"], one["upper"], each) for k, one in enumerate(axes, 1)
            ]
            self.made = self._by_axes
            return
        length = self.arm.length
        self.free = [
            Free("distance_mm", NEAREST * length, FARTHEST * length, 6),
            Free("azimuth_deg", -180.0, 180.0, 16, True),
            Free("height_mm", -HEIGHT * length, HEIGHT * length, 5),
            Free("yaw_deg", -180.0, 180.0, 1, True),
        ]

    def _by_axes(self, values: Sequence[float]) -> dict[str, Any]:
        axes = self.robot["external_axes"]
        return {"external_axes": [{**one, "position": v} for one, v in zip(axes, values)]}

    def _by_base(self, values: Sequence[float]) -> dict[str, Any]:
        distance, azimuth, height, yaw = values
        upright = robots.robot_frame(self.robot, robots.BASE)[:3, :3]
        a = math.radians(azimuth)
        frame = np.eye(4)
        # The robot looks at the work at yaw 0: its x leads from where it stands to the middle.
        frame[:3, :3] = upright @ frames.from_abc([0, 0, 0], [azimuth + yaw, 0, 0])[:3, :3]
        to_middle = upright @ [math.cos(a), math.sin(a), 0.0]
        frame[:3, 3] = self.middle - distance * to_middle - height * upright[:, 2]
        return {"base_from_robot": _told(frame)}

    def look(self, values: Sequence[float]) -> Place:
        """What the thinned programs meet there."""
        self.context.throw_if_cancelled()
        robot = {**self.robot, **self.made(values)}
        rows, hard = [], 0
        for path in self.thin:
            found = reach.follow(self.arm, path, robot, math.inf, 90.0, self.turning)
            rows.append(found["joints"])
            hard += sum(event["kind"] in HARD for event in found["events"])
        place = self._judged(tuple(map(float, values)), np.concatenate(rows), hard)
        self.looked_at.append(place)
        return place

    def _judged(self, values: tuple[float, ...], joints: Floats, hard: int) -> Place:
        room = np.minimum(joints - self.arm.lower, self.arm.upper - joints).min(axis=1)
        there = room >= 0.0  # what is beyond a limit is not reached; NaN is out of reach
        margin = -math.inf
        if there.any():
            singular = min(self.arm.singular_distance(one) for one in joints[there])
            margin = math.degrees(min(float(room[there].min()), singular))
        return Place(values, float(there.mean()), hard, margin)

    def run(self) -> tuple[Place, list[Json]]:
        """The best place, and the events that are left there with every pose and all bodies."""
        grid = [one.tolist() for one in np.stack(np.meshgrid(*map(_samples, self.free), indexing="ij"), -1).reshape(-1, len(self.free))]  # fmt: skip
        for count, values in enumerate(grid):
            self.context.report(0.5 * count / len(grid))
            self.look(values)
        starts = sorted(self.looked_at, key=lambda one: one.worth, reverse=True)[:BEST]
        for count, start in enumerate(starts):
            self.context.report(0.5 + 0.3 * count / BEST)
            self._moved(start)
        return self._proved()

    def _moved(self, place: Place) -> None:
        steps = np.array([(one.high - one.low) / max(2 * one.samples, 12) for one in self.free])
        for _ in range(HALVINGS):
            better = True
            while better:
                tried = [
                    self.look(self._within(np.array(place.values) + sign * step * unit))
                    for unit, step in zip(np.eye(len(self.free)), steps)
                    for sign in (-1.0, 1.0)
                ]
                best = max(tried, key=lambda one: one.worth)
                better = best.worth > place.worth
                place = best if better else place
            steps *= 0.5

    def _within(self, values: Floats) -> list[float]:
        found = []
        for value, one in zip(values.tolist(), self.free):
            if one.round:
                value = (value - one.low) % (one.high - one.low) + one.low
            found.append(min(max(value, one.low), one.high))
        return found

    def _proved(self) -> tuple[Place, list[Json]]:
        """The first of the best without an event that may not be; else the one with the fewest."""
        shape = (
            read_design(self.job.design, self.context) if self.job.cell.check_collisions else None
        )
        best: tuple[Place, list[Json]] | None = None
        listed = sorted(set(self.looked_at), key=lambda one: one.worth, reverse=True)
        for place in _apart(listed, self.free)[:CHECKED]:
            found = self._events(place, shape)
            joints = np.radians(np.concatenate([one["joints"] for one in found]))
            events = [event for one in found for event in one["events"] if self._is_hard(event)]
            whole = self._judged(place.values, joints, len(events))
            if best is None or whole.worth > best[0].worth:
                best = whole, events
            if not events and whole.reached == 1.0:
                break
        return known(best)

    def _is_hard(self, event: Json) -> bool:
        """Whether it may not be. A program for the whole robot has links in place of the rapid ways."""
        links = bool(self.job.robot.program.home_joints_deg)
        rapid = any(fact["code"].endswith(RAPID) for fact in event["facts"])
        return event["kind"] in HARD and not (links and rapid)

    def _events(self, place: Place, shape: core.Shape | None) -> list[dict[str, Any]]:
        job = typed({**records.plain(self.job), "robot": {**self.robot, **self.made(place.values)}})
        found = reach.job_reach(job, self.paths, self.context.part(0.8, 0.9))
        if shape is not None:
            met = collision.check(job, shape, self.paths, [], self.context.part(0.9, 1.0), found)
            for one, of_path in zip(found, met):
                one["events"] = [*one["events"], *of_path["events"]]
        return found


def doubts(place: Place, events: Sequence[Json]) -> list[core.Fact]:
    """That no place was found where all is well, if so."""
    if place.reached == 1.0 and not events:
        return []
    return [
        core.Fact(
            "cell.no_place",
            "no place is found where the robot does all of the programs: at the best one it reaches {reached:.1f} % of the "
            "poses within its limits, and {count} events are left",
            reached=100.0 * place.reached,
            count=len(events),
        )
    ]


def told(search: Search, place: Place, events: Sequence[Json]) -> dict[str, Any]:
    """A place as the command line prints it: keys of a job's robot, and how good it is."""
    return {
        **search.made(place.values),
        "reached": place.reached,
        "least_margin_deg": place.margin_deg if math.isfinite(place.margin_deg) else None,
        "places": len(search.looked_at),
        "events": [event["message"] for event in events],
    }


def map_csv(search: Search) -> str:
    """CSV of all places that were looked at, in order: what is free, share of the poses, margin in degrees."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    base = not search.robot["external_axes"]
    place = ["x_mm", "y_mm", "z_mm"] if base else []
    writer.writerow([*(one.name for one in search.free), *place, "reached", "events", "margin_deg"])
    for one in search.looked_at:
        where = search.made(one.values)["base_from_robot"]["position_mm"] if base else []
        margin = f"{one.margin_deg:.3f}" if math.isfinite(one.margin_deg) else ""
        row = [*(f"{v:.3f}" for v in (*one.values, *where)), f"{one.reached:.4f}", one.hard, margin]
        writer.writerow(row)
    return text.getvalue()


def _samples(one: Free) -> Floats:
    if one.samples == 1:
        return np.array([0.5 * (one.low + one.high)])
    return np.linspace(one.low, one.high, one.samples, endpoint=not one.round)


def _apart(places: Sequence[Place], free: Sequence[Free]) -> list[Place]:
    """The best of each neighbourhood, a tenth of what is free wide."""
    size = np.array([one.high - one.low for one in free])
    found: list[Place] = []
    for place in places:
        near = [np.abs((np.subtract(one.values, place.values)) / size).max() < 0.1 for one in found]
        if not any(near):
            found.append(place)
    return found


def _told(frame: Floats) -> dict[str, Any]:
    return {"position_mm": frame[:3, 3].tolist(), "abc_deg": list(frames.to_abc(frame))}


def _thinned(path: core.ToolPath) -> core.ToolPath:
    """At most about POSES of its poses, those at both ends of every linear run among them."""
    given = tool_path.motions(path)
    count = len(given["rapid"])
    keep = np.zeros(count, dtype=bool)
    keep[:: max(1, count // POSES)] = True
    rapid = np.asarray(given["rapid"], dtype=bool)
    if count <= 4 * POSES or rapid.sum() <= POSES:
        keep |= rapid
        keep[:-1] |= rapid[1:]
    keep[[0, -1]] = True
    arrays: dict[str, Any] = {
        name: values[keep] if _of_poses(name, values, count) else values
        for name, values in given.items()
    }
    return core.ToolPath(**arrays)


def _of_poses(name: str, values: object, count: int) -> bool:
    return isinstance(values, np.ndarray) and name not in tool_path.CELL_FRAMES and len(values) == count  # fmt: skip
