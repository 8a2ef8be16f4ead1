"""A whole program followed by the robot: its joints, and what its arm runs into. No grinding."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..base import records
from ..base.kinds import Context, Json
from ..engine import core
from ..job.settings import Job, Robot
from ..job.typed import typed
from . import collision, events, reach


def follow(
    path: core.ToolPath, robot: Json, job: Job | Json | None = None, context: Context = None
) -> dict[str, Any]:
    """``reach.reach`` of a core.ToolPath, its events with those of the arm's collisions.

    ``robot``: as in a job, with its defaults. ``job``: a validated job for what the arm may meet (part,
    stock, wheel, bodies); None: only the joints are looked at. ``warnings``: of what was read. Raises
    InputError, Cancelled.
    """
    from ..job.workpiece import read_design

    context = context or core.RunContext()
    found = reach.reach(path, robot, context=context.part(0.0, 0.5))
    found["warnings"] = []
    if job is None:
        return found
    checked = replace(typed(job), robot=records.made(Robot, robot))
    shape = read_design(checked.design, context)
    met = collision.check(
        checked, shape, [path], found["warnings"], context.part(0.5, 1.0), [found]
    )
    if met:
        found["warnings"] += collision.links_left_out(robot, collision.arm_bodies(robot))
    for one in met:
        found["events"] = events.merge([(0, 0.0, found["events"] + one["events"])])
        found["pairs"] = one["pairs"]
    return found
