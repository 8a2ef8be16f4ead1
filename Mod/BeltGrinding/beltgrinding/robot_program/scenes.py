"""What the robot may run into: the cell's bodies with the arm, for its passes and for the links between them."""

from __future__ import annotations

from typing import NamedTuple

from ..base import records
from ..base.kinds import Context, Facts, known
from ..cell import collision
from ..engine import core
from ..geometry.body_names import WHEEL
from ..job import machine as machines
from ..job.settings import Job
from ..presets import external_axes, robot as robots


class Scenes(NamedTuple):
    """``passes``: of the wheel only what lies behind the rim counts, which touches the part; ``links``: all of it."""

    passes: core.ArmScene
    links: core.ArmScene
    bodies: list[dict[str, object]]  # of ``links``
    bodies_of_passes: list[dict[str, object]]


def of_job(
    job: Job, shape: core.Shape | None, path: core.ToolPath, warnings: Facts, context: Context
) -> Scenes:
    """The scenes of a validated job with a robot, for the cell's frames of a core.ToolPath. Without collisions
    (``cell.check_collisions`` false, or a shape that is not valid) there is no body, which is told. Raises InputError,
    Cancelled."""
    robot = records.plain(job.robot)
    near: list[dict[str, object]] = []
    if job.cell.check_collisions and shape is not None and shape.valid:
        near = collision.bodies(job, shape, warnings, context) + collision.arm_bodies(robot)
        warnings += collision.links_left_out(robot, near)
    else:
        warnings.append(
            core.Fact(
                "robot_program.no_bodies",
                "collisions are not checked: links are straight, and nothing says whether they are free",
            )
        )
    whole = [body for body in near if body["name"] != WHEEL]
    if near and machines.wheel_presses(job.belt_machine):
        disc = collision.wheel_body(job.belt_machine.wheel, 0.0)
        whole.append({"name": WHEEL, "frame": "wheel", "mesh": disc})
    arm = known(robots.arm_of(robot))
    frames = (robots.frame_at_zero(robot), robots.robot_frame(robot, "flange_from_tcp"))
    axes = external_axes.for_core(robot["external_axes"])
    home = robots.home_of(robot)
    passes, links = (
        core.ArmScene(arm, path, one, *frames, axes, home, context) for one in (near, whole)
    )
    warnings += collision.built_together(robot, links.touching)
    return Scenes(passes, links, whole, near)
