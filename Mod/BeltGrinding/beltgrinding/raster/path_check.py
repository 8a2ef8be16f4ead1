"""What is wrong with a raster path, before it is written: found from its poses, nothing is simulated."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..base import records
from ..base.kinds import Array, Context, Facts, Floats, Json
from ..cell import reach
from ..cell.tool_path import tool_path
from ..engine import core
from ..job import poses
from ..job.settings import Job, Program
from ..job.typed import typed
from ..presets import external_axes
from ..presets.robot import given

PLUNGES = 0.02  # of the removal; more is told
STILL = 1e-6  # mm; less is no way
ROUNDING = 1e-6  # rad, and of a limit
REVERSAL = 0.0  # cosine between the ways to and from a pose


def check(job: Job | Json, settings: Json, result: Json, context: Context = None) -> dict[str, Any]:
    """Looks at what ``raster`` gave for a validated job with validated settings.

    Returns dict(
    poses, passes, duration_s (constant feed),
    turn_deg: the largest turn of the wheel between neighbouring poses of a pass,
    turn_deg_per_mm: the fastest one over the work (None: on the spot),
    fast_turns: pairs of poses above max_turn_deg or max_turn_deg_per_mm,
    reversals: poses of passes after which the way goes back,
    leaps: pairs of poses of a pass farther apart than max_distance_mm, bridges apart,
    plunge_share: of force x time, what lies on the way down to the passes and off them, within the travel of
    the force control; what is removed goes with it, for laws that are linear in the force. None under position
    control, where the force is not known before,
    reach: None without a robot, else dict(poses, reached, events: dict of counts by kind),
    problems: list of Fact). Raises InputError, Cancelled.
    """
    job, context = typed(job), context or core.RunContext()
    seen = motion(result)
    within = seen["within"]
    turn, way = seen["turn"][within], seen["way"][within]
    fastest, per_mm = math.radians(settings["max_turn_deg"]), _rates(turn, way)
    limit = math.radians(settings["max_turn_deg_per_mm"])
    fast = (turn > fastest + ROUNDING) | (per_mm > limit * (1.0 + ROUNDING) + ROUNDING)
    long = way > settings["max_distance_mm"] * (1.0 + ROUNDING)
    found: dict[str, Any] = {
        "poses": len(result["frames"]),
        "passes": len(result["passes"]),
        "duration_s": float(seen["time"].sum()),
        "turn_deg": math.degrees(turn.max(initial=0.0)),
        "turn_deg_per_mm": _finite(math.degrees(per_mm.max(initial=0.0))),
        "fast_turns": int(fast.sum()),
        "reversals": int(seen["reversals"].sum()),
        "leaps": int(long.sum()),
        "plunge_share": _plunge_share(job, result, seen),
        "reach": _reach(job, result, context),
    }
    found["problems"] = _problems(found, settings, np.flatnonzero(within)[fast])
    return found


def motion(result: Json) -> dict[str, Array]:
    """Between neighbouring poses, (n - 1,) each: ``way`` of the contact over the work, mm; ``turn`` of
    the wheel over the work, rad; ``time``, s at constant feed; ``within`` bool: both are of one pass;
    ``reversals`` (n - 2,) bool: the way goes back at the pose after.
    """
    contacts = result["contacts"]
    steps = np.diff(contacts[:, :3, 3], axis=0)
    way = np.linalg.norm(steps, axis=1)
    turn = _angles(contacts[:, :3, :3])
    within = np.zeros(len(contacts) - 1, dtype=bool)
    for one in result["passes"]:
        within[one["first"] : one["last"]] = True
    tcp = np.linalg.norm(np.diff(result["frames"][:, :3, 3], axis=0), axis=1)
    time = tcp / result["feeds"][1:]
    moves = np.flatnonzero(within & (way > STILL))
    reversals = np.zeros(max(len(contacts) - 2, 0), dtype=bool)
    for a, b in zip(moves[:-1], moves[1:]):
        # Turns on the spot between two ways belong to the same place.
        if within[a : b + 1].all() and steps[a] @ steps[b] < REVERSAL * way[a] * way[b] - 1e-12:
            reversals[a] = True
    return {"way": way, "turn": turn, "time": time, "within": within, "reversals": reversals}


def _finite(value: float) -> float | None:
    """For JSON, which has no infinity."""
    return value if math.isfinite(value) else None


def _angles(rotations: Floats) -> Floats:
    """rad from each rotation to the next: 2 asin(|A - B| / (2 sqrt 2)), Frobenius norm."""
    apart = np.linalg.norm(np.diff(rotations, axis=0), axis=(1, 2))
    return 2.0 * np.arcsin(np.minimum(apart / (2.0 * math.sqrt(2.0)), 1.0))


def _rates(turn: Floats, way: Floats) -> Floats:
    rates = np.where(turn > ROUNDING, np.inf, 0.0)
    moved = way > STILL
    rates[moved] = turn[moved] / way[moved]
    return rates


def _plunge_share(job: Job, result: Json, seen: Json) -> float | None:
    machine = job.belt_machine
    if machine.control != "force":
        return None
    forces = np.where(result["forces"] < 0, machine.force_N, result["forces"])[1:]
    plunging = ~seen["within"] & (result["contact"][1:] | result["contact"][:-1])
    plunging &= ~(result["contact"][1:] & result["contact"][:-1])
    plunging &= ~result["rapid"][1:]
    near = np.minimum(1.0, machine.force_travel_mm / np.maximum(seen["way"], STILL))
    work = forces * seen["time"]
    down, along = (work * near)[plunging].sum(), work[seen["within"]].sum()
    return float(down / (down + along)) if down + along > 0 else 0.0


def _reach(job: Job, result: Json, context: Context) -> dict[str, Any] | None:
    robot = records.plain(job.robot)
    if not given(robot) or external_axes.coordinated(robot["external_axes"]):
        return None
    steps = job.simulation
    program = records.made(Program, {"poses": poses.list_poses(dict(result))})
    path = tool_path(replace(job, programs=(program,)), 0, [])
    found = reach.reach(path, robot, steps.max_travel_mm, steps.max_angle_deg, context)
    events: dict[str, int] = {}
    for event in found["events"]:
        events[event["kind"]] = events.get(event["kind"], 0) + 1
    reached = int(np.isfinite(found["joints"]).all(axis=1).sum())
    return {"poses": len(found["joints"]), "reached": reached, "events": events}


def _problems(found: Json, settings: Json, fast: Array) -> Facts:
    """Facts: what of the figures should not be."""
    problems = []
    if found["fast_turns"]:
        problems.append(
            core.Fact(
                "raster.turns_too_fast",
                "between {count} pairs of poses in contact, first at pose {pose}, the tool turns faster than "
                "asked: by up to {turn:.1f} degrees from pose to pose",
                count=found["fast_turns"],
                pose=int(fast[0]) + 2,
                turn=found["turn_deg"],
            )
        )
    if found["reversals"]:
        problems.append(
            core.Fact(
                "raster.reverses",
                "the way goes back in contact at {count} poses",
                count=found["reversals"],
            )
        )
    if found["leaps"]:
        problems.append(
            core.Fact(
                "raster.leaps",
                "{count} pairs of poses of a pass are farther apart than {most:.4g} mm",
                count=found["leaps"],
                most=settings["max_distance_mm"],
            )
        )
    share = found["plunge_share"]
    if share is not None and share > PLUNGES:
        problems.append(
            core.Fact(
                "raster.plunges",
                "about {share:.0f} % of the removal happens on the way down to the passes and off them (by force "
                "and time); lower touch_force_share, or approach faster",
                share=100.0 * share,
            )
        )
    return problems + _of_reach(found["reach"])


def _of_reach(reached: Json | None) -> Facts:
    if reached is None:
        return []
    problems = []
    if reached["reached"] < reached["poses"]:
        problems.append(
            core.Fact(
                "raster.out_of_reach",
                "the job's robot does not get to {count} of {poses} poses",
                count=reached["poses"] - reached["reached"],
                poses=reached["poses"],
            )
        )
    for kind, count in sorted(reached["events"].items()):
        if kind in reach.EVENTS and kind != "out_of_reach":
            problems.append(
                core.Fact(
                    "raster.reach_event",
                    "the job's robot meets '{kind}' {count} times along the path",
                    kind=kind,
                    count=count,
                )
            )
    return problems
