"""A program for the whole robot: from home by links through all passes and back.

Postures and links are the core's (``ArmScene``); here they are put in a row, and looked at once more as they lie.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base import frames, records
from ..base.kinds import Context, Floats, Json, known
from ..cell import tool_path as tool_paths
from ..engine import InputError, core
from ..job import robot_time
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from ..presets import external_axes, robot as robots
from . import corners, external, facts, scenes as scene_lists
from .linking import Linker
from .moves import Move, Whole
from .passes import Pass, least_way, split
from .retract import retracted

RESOLUTION = 0.05  # mm, of the last look
STEP, TURN = 1.0, 0.02  # mm, rad, between places of the tool's straight ways there
ROLL_STEP, LEAN_STEP, SHIFT_STEP = math.radians(10.0), math.radians(2.5), 0.25  # the last: of most
RETRACTS = (1.0, 0.5, 2.0, 0.25, 4.0)  # times the job's, that are tried
BLEND = 1.0  # mm, of corners whose motion gives no zone, as writers have it
LEAST_FEED = 1e-3  # mm/s
MAY_BE_FAST, FINER = (
    0.3,
    20.0,
)  # of a joint's limit, from where a way is looked at in parts so much finer
SLOWER = 1e-3  # relative; less is no lower feed


def wanted(job: Job | Json) -> bool:
    """Whether a validated job has all that a program for the whole robot needs."""
    robot = typed(job).robot
    return robots.given(records.plain(robot)) and bool(robot.program.home_joints_deg)


def plan(
    job: Job | Json, index: int, shape: core.Shape | None = None, context: Context = None
) -> Whole:
    """The ``Whole`` of a validated job's program number ``index``. ``shape``: the design, None: it is read. Raises
    InputError, Cancelled."""
    from ..job.workpiece import read_design

    job, context = typed(job), context or core.RunContext()
    if not wanted(job):
        raise InputError(
            "robot_program.no_home",
            "{key}: a program for the whole robot needs a robot, and where it begins: give six angles",
            key="robot.program.home_joints_deg",
        )
    if shape is None and job.cell.check_collisions:
        shape = read_design(job.design, context)
    return Planner(job, index, shape, context).run()


class Planner:
    """Of a validated job's program number ``index``: its passes, and the scenes that they lie in."""

    def __init__(
        self, job: Job, index: int, shape: core.Shape | None, context: core.RunContext
    ) -> None:
        self.job, self.context, self.whole = job, context, Whole()
        self.name = program_name(job, index)
        self.settings = job.robot.program
        path = tool_paths.tool_path(job, index, self.whole.notes)
        self.scenes = scene_lists.of_job(job, shape, path, self.whole.notes, context)
        self.robot = records.plain(job.robot)
        self.arm = known(robots.arm_of(self.robot))
        self.axes = self.robot["external_axes"]
        self.turning = math.radians(robot_time.limits(job).rotation_speed_deg_s)
        if self.arm.structure == "general":
            name = robots.name(self.robot)
            self.whole.notes.append(facts.no_closed_form(robot=name))
        self.home = self._coordinates(self.settings.home_joints_deg)
        self.linker = Linker(self.scenes.links, job.cell, self.settings, context)
        self.given = tool_paths.motions(path)
        self.passes = self._passes()
        self.rows = np.concatenate([np.arange(one.first, one.last + 1) for one in self.passes])
        self.begins = np.cumsum([0, *(one.last - one.first + 1 for one in self.passes)])
        self.path = self._in_order()
        self.seconds = np.diff(self.path.times(), prepend=0.0)
        self.at = self.home
        self.numbers = {"passes": 0, "cuts": 0, "slower": 0, "links": 0, "links_round": 0}
        self.least_clearance, self.first_slower = math.inf, 0
        self.told: set[tuple[Any, ...] | None] = set()  # of what has been said to meet

    def run(self) -> Whole:
        self._check_place(self.home, "robot.program.home_joints_deg", 0)
        for number, safe in enumerate(self.settings.safe_joints_deg):
            self._check_place(
                self._coordinates(safe), f"robot.program.safe_joints_deg[{number}]", 0
            )
        found = self.postures(self.context.part(0.0, 0.6))
        self._set_out()
        poses = found["poses"]
        begins = [k for k, one in enumerate(poses) if k == 0 or one["link"]]
        for count, (begin, end) in enumerate(zip(begins, [*begins[1:], len(poses)])):
            self.context.report(0.6 + 0.35 * count / len(begins))
            self._run(poses[begin:end])
        self._link(self.home, "home")
        self._go_back()
        self._look_at_corners()
        self._tell(found)
        self.context.report(1.0)
        return self.whole

    def _coordinates(self, joints_deg: Sequence[float]) -> Floats:
        """A place of the user's, with coordinated axes at home."""
        home = external_axes.at(self.axes, "home")
        return external_axes.coordinates(self.axes, np.array(joints_deg), home)

    def _set_out(self) -> None:
        """From home, where the indexed axes go one by one to where they stand in the passes."""
        stages = external.stages(self.axes)
        values = external_axes.values_of(self.axes, self.home)
        self._at_home(stages[0].begin if stages else values, "home")
        sweep = external.Sweep(self.job, self.scenes.bodies, self.home[:6]) if stages else None
        for stage in stages:
            name = external_axes.NAME.format(stage.number + 1)
            self._at_home(stage.end, f"{name} to its place")
            for body, other in known(sweep).meetings(stage):
                begin, end = stage.begin[stage.number], stage.end[stage.number]
                fact = facts.external_meets(
                    program=self.name, body=body, other=other, axis=name, begin=begin, end=end
                )
                last = len(self.whole.moves) - 1
                self.whole.add_problem("collision", fact, (body, other), last)

    def _go_back(self) -> None:
        for stage in reversed(external.stages(self.axes)):
            name = external_axes.NAME.format(stage.number + 1)
            self._at_home(stage.begin, f"{name} back home")

    def _at_home(self, values: tuple[float, ...], note: str) -> None:
        base = external_axes.base_from_robot(self.axes, values, robots.frame_at_zero(self.robot))
        frame = (
            base
            @ self.arm.forward(self.home[:6])
            @ robots.robot_frame(self.robot, "flange_from_tcp")
        )
        joints = np.degrees(self.home[:6])
        self._move(Move("PTP", frame, joints, note=note, external=values), look=False)

    def postures(self, context: core.RunContext) -> dict[str, Any]:
        """As ``ArmScene.postures`` gives them, of the passes in their order."""
        return self.scenes.passes.postures(self.path, self._options(), context)

    def feeds(self, context: core.RunContext) -> Floats:
        """(poses,) mm/s at which the joints can follow each motion of the program's passes, no more than its own; inf of
        rapid motions, and where the arm does not get."""
        found = np.full(len(self.given["feeds"]), np.inf)
        for pose in self.postures(context)["poses"]:
            if pose["reached"] and not pose["link"]:
                found[self.rows[pose["pose"]]] = self._motion(pose).feed
        return found

    def _passes(self) -> list[Pass]:
        rapid = self.given["rapid"]
        found, lone = split(rapid)
        if not found:
            raise InputError(
                "robot_program.no_pass",
                "{program}: no path motion follows a rapid one; there is no pass",
                program=self.name,
            )
        if lone:
            self.whole.notes.append(facts.lone_poses(program=self.name, count=lone))
        if self.settings.order == "least_way":
            home = self._frame(self.home)
            found = [found[k] for k in least_way(self.given["frames"], found, home)]
        return found

    def _in_order(self) -> core.ToolPath:
        rows = self.rows
        arrays: dict[str, Any] = {
            name: values[rows]
            for name, values in self.given.items()
            if isinstance(values, np.ndarray) and len(values) == len(self.given["rapid"])
            and name not in tool_paths.CELL_FRAMES
        }  # fmt: skip
        arrays["rapid"] = np.zeros(len(rows), dtype=bool)
        arrays["rapid"][self.begins[:-1]] = True
        rest: dict[str, Any] = {k: v for k, v in self.given.items() if k not in arrays}
        return core.ToolPath(**rest, **arrays)

    def _options(self) -> dict[str, Any]:
        wheel, own = self.job.belt_machine.wheel, self.settings
        shift = own.shift_share * wheel.width_mm
        options: dict[str, Any] = {
            "most": [math.radians(own.roll_deg), math.radians(own.lean_deg), shift],
            "spacing": [ROLL_STEP, LEAN_STEP, max(SHIFT_STEP * shift, 1e-3)],
            "wheel_radius": wheel.radius_mm,
            "flip": math.radians(self.job.robot.flip_deg),
            "singularity": math.radians(self.job.robot.singularity_deg),
            "clearance": self.job.cell.clearance_mm,
            "home": self.home,
            "axes_spacing": external_axes.spacing(self.axes),
        }
        free = np.zeros(len(self.home) - 6)  # external axes: no limit but their speeds
        if own.joint_acceleration_deg_s2:
            options["acceleration"] = np.append(np.radians(own.joint_acceleration_deg_s2), free)
        if own.joint_jerk_deg_s3:
            options["jerk"] = np.append(np.radians(own.joint_jerk_deg_s3), free)
        return options

    def _frame(self, q: Floats) -> Floats:
        return self.scenes.passes.base_from_tcp(q)

    def _check_place(self, q: Floats, key: str, row: int) -> None:
        """Raises InputError for a place of the user's beyond a limit, or where bodies meet."""
        for joint, (angle, low, high) in enumerate(zip(q, self.arm.lower, self.arm.upper), 1):
            if not low <= angle <= high:
                raise InputError(
                    "robot_program.place_beyond",
                    "{key}: joint {joint} at {angle:.1f} deg is beyond its limits of {lower:.1f} to {upper:.1f} deg",
                    key=key,
                    joint=joint,
                    angle=math.degrees(angle),
                    lower=math.degrees(low),
                    upper=math.degrees(high),
                )
        met = self.scenes.links.within(q, 0.0) or self.scenes.links.inside(q)
        if met is not None:
            raise InputError(
                "robot_program.place_collides",
                "{key}: {body} and {other} are in each other there; give another place",
                key=key,
                body=met[0],
                other=met[1],
            )

    def _run(self, poses: list[dict[str, Any]]) -> None:
        """A pass, or a piece of one: link, approach, its motions, retract."""
        first, last = poses[0], poses[-1]
        self.numbers["cuts" if first["cut"] else "passes"] += 1
        note = f"pass {self.numbers['passes']}"
        if first["cut"]:
            note += ", goes on in another posture"
            self._tell_cut(first)
        self._tell_poses(poses)
        reached = next((one for one in poses if one["reached"]), None)
        if reached is None:
            for one in poses:
                self._move(self._motion(one), look=False)
            return
        above = self._above(reached)
        self._link(reached["q"] if above is None else above[0], note)
        feed = self.settings.retract_feed_mm_s
        rest = poses[poses.index(reached) + (above is None) :]
        for one in rest:
            move = self._motion(one)
            if one is reached:
                move.feed, move.force, move.zone = feed, -1.0, 0.0
            self._move(move)
        above = self._above(last) if last["reached"] else None
        if above is not None:
            q, frame = above
            line = self._line(last)
            self._move(Move("LIN", frame, feed=feed, line=line, **self._standing(q)))

    def _above(self, pose: Json) -> tuple[Floats, Floats] | None:
        """(joints, frame) off the part above a pose; None: it is clear of everything, or nothing above it is."""
        clearance = self.settings.clearance_mm
        whole = self.scenes.links
        inner = pose["pose"] not in self.begins and pose["pose"] + 1 not in self.begins
        if not inner and whole.within(pose["q"], clearance) is None:
            return None
        for share in RETRACTS:
            frame = retracted(self.job.cell, pose["frame"], share * self.settings.retract_mm)
            way, gets_there = self.scenes.passes.straight_way(pose["q"], frame, STEP, TURN)
            if not gets_there or whole.within(way[-1], clearance) is not None:
                continue
            if self._met(self.scenes.passes, way) is None:
                return way[-1], frame
        return None

    def _link(self, to: Floats, note: str) -> None:
        """Joint motions from where the arm is."""
        found = self.linker.find(self.at, to)
        if found is None:
            body, other = self.linker.in_the_way(self.at, to)
            fact = facts.no_link(program=self.name, place=note, body=body, other=other)
            self.whole.add_problem("collision", fact, (body, other))
            found = [{"joints": np.stack([self.at, to]), "straight": True, "clearance": 0.0}]
        self.numbers["links"] += 1
        self.numbers["links_round"] += any(not one["straight"] for one in found)
        for one in found:
            self.least_clearance = min(self.least_clearance, one["clearance"])
            for q in one["joints"][1:]:
                frame = self._frame(q)
                self._move(Move("PTP", frame, note=note, **self._standing(q)), look=False)
                note = ""
        self.at = to

    def _move(self, move: Move, look: bool = True) -> None:
        """Adds a motion; ``look``: it is looked at whether it is free."""
        if move.joints_deg is not None:
            q = external_axes.coordinates(self.axes, move.joints_deg, move.external)
            if look and move.kind == "LIN":
                self._look(move, q)
            self.at = q
        self.whole.moves.append(move)

    def _standing(self, q: Floats) -> dict[str, Any]:
        """``joints_deg`` and ``external`` of a Move at coordinates (6 + k,)."""
        values = external_axes.values_of(self.axes, q)
        return {"joints_deg": np.degrees(q[:6]), "external": values}

    def _look(self, move: Move, q: Floats) -> None:
        way, gets_there = self.scenes.passes.straight_way(self.at, move.frame, STEP, TURN, q)
        if not gets_there or np.abs(way[-1] - q).max() > 1e-6:
            self._tell_broken(move)
            return
        self._keep_pace(move, way, q)
        met = self._met(self.scenes.passes, way)
        known_of = None if met is None else (*met[:2], self.numbers["passes"])
        if met is not None and known_of not in self.told:  # once a pass
            self.told.add(known_of)
            place = self._place(move.line)
            fact = facts.meets(program=self.name, body=met[0], other=met[1], place=place)
            self.whole.add_problem("collision", fact, met[:2])

    def _keep_pace(self, move: Move, way: Floats, end: Floats) -> None:
        """Lowers a motion's feed so far that no joint and no external axis is too fast anywhere on its ``way`` to ``end``,
        whose parts are equally long: between two poses a joint may turn mostly in one place."""
        before = self.whole.moves[-1].frame
        length = float(np.linalg.norm(move.frame[:3, 3] - before[:3, 3]))
        turn = float(np.linalg.norm(frames.rotation_vectors((before[:3, :3].T @ move.frame[:3, :3])[None])))  # fmt: skip
        seconds = max(length / max(move.feed, LEAST_FEED), turn / self.turning)
        if length <= 0.0 or seconds <= 0.0 or len(way) < 2:
            return
        most = self._fastest(way, seconds)
        if most > MAY_BE_FAST:  # near a singularity a joint turns mostly within a part
            finer, _ = self.scenes.passes.straight_way(
                self.at, move.frame, STEP / FINER, TURN / FINER, end
            )
            most = self._fastest(finer, seconds)
        if most > 1.0 + SLOWER:
            move.feed = length / (seconds * most)
            self._count_slower()

    def _count_slower(self) -> None:
        if not self.numbers["slower"]:
            self.first_slower = len(self.whole.moves)
        self.numbers["slower"] += 1

    def _fastest(self, way: Floats, seconds: float) -> float:
        """The greatest speed of a joint or an axis on a way of equally long parts, times its limit."""
        fastest = np.abs(np.diff(way, axis=0)).max(axis=0) * (len(way) - 1) / seconds
        most = self.scenes.passes.max_speed
        limited = most > 0.0
        return float((fastest[limited] / most[limited]).max(initial=0.0))

    def _look_at_corners(self) -> None:
        default = max(robot_time.limits(self.job).default_zone_mm, BLEND)
        for move, places in corners.rounded(self.whole.moves, default):
            way = corners.way(self.scenes.passes, self.axes, move, places)
            met = None if way is None else self._met(self.scenes.passes, way)
            if met is not None:
                place = f"line {move.line}" if move.line else "a pose"
                fact = facts.corner_meets(program=self.name, body=met[0], other=met[1], place=place)
                number = next(k for k, one in enumerate(self.whole.moves) if one is move)
                self.whole.add_problem("collision", fact, met[:2], number)
                return

    @staticmethod
    def _met(scene: core.ArmScene, way: Floats) -> tuple[Any, ...] | None:
        for a, b in zip(way[:-1], way[1:]):
            met: tuple[Any, ...] | None = scene.on_way(a, b, 0.0, RESOLUTION)
            if met is not None:
                return met
        return None

    def _line(self, pose: Json) -> int:
        return int(self.given["lines"][self.rows[pose["pose"]]])

    def _place(self, line: int) -> str:
        number = max(self.numbers["passes"], 1)
        return f"line {line} (pass {number})" if line else f"a pose of pass {number}"

    def _motion(self, pose: Json) -> Move:
        row = self.rows[pose["pose"]]
        feed, before = float(self.given["feeds"][row]), float(self.seconds[pose["pose"]])
        if not pose["link"] and 0.0 < before * (1.0 + SLOWER) < pose["duration"]:
            feed *= before / pose["duration"]
            self._count_slower()
        standing = self._standing(pose["q"]) if pose["reached"] else self._lost()
        force, zone = float(self.given["forces"][row]), float(self.given["zones"][row])
        line = self._line(pose)
        return Move("LIN", pose["frame"], feed=feed, force=force, zone=zone, line=line, **standing)

    def _lost(self) -> dict[str, Any]:
        """As ``_standing``, of a pose that the arm does not get to."""
        return {"joints_deg": None, "external": external_axes.at(self.axes, "position")}

    def _tell_cut(self, pose: Json) -> None:
        number, place = self.numbers["passes"], self._place(self._line(pose))
        self.whole.add_note("arm_flip", facts.cut(program=self.name, number=number, place=place))
        if pose["torn"]:
            self._tell_broken(self._motion(pose))

    def _tell_broken(self, move: Move) -> None:
        place = self._place(move.line)
        self.whole.add_problem("arm_flip", facts.broken(program=self.name, place=place))

    def _tell_poses(self, poses: list[dict[str, Any]]) -> None:
        for fact, kind, within in (
            (facts.out_of_reach, "out_of_reach", True),
            (facts.beyond_limits, "joint_limit", False),
        ):
            lost = [one for one in poses if not one["reached"] and one["within_limits"] == within]
            if lost:
                place = self._place(self._line(lost[0]))
                self.whole.add_problem(kind, fact(program=self.name, count=len(lost), place=place))

    def _tell(self, found: Json) -> None:
        if self.numbers["slower"]:
            count = self.numbers["slower"]
            fact = facts.slower(program=self.name, count=count)
            self.whole.add_note("joint_speed", fact, self.first_slower)
        joints = np.stack([m.joints_deg for m in self.whole.moves if m.joints_deg is not None])
        lower, upper = np.degrees(self.arm.lower), np.degrees(self.arm.upper)
        self.whole.figures = {
            **self.numbers,
            "motions": len(self.whole.moves),
            "least_limit_margin_deg": float(np.minimum(joints - lower, upper - joints).min()),
            "link_clearance_mm": None if math.isinf(self.least_clearance) else self.least_clearance,
            "cost_s": found["cost"],
        }
