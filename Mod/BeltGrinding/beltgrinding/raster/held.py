"""What goes with the wheel or the belt, and must not touch the part: what holds a belt, and bodies of the cell."""

from __future__ import annotations


import numpy as np

from ..base.kinds import Array, Context, Facts, Floats, Json
from ..cell import collision
from ..engine import core
from ..geometry import fork, free_run
from ..job.settings import BeltMachine, Job
from ..job.typed import typed
from . import passes


def sides(job: Job | Json) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """(frames of ``cell.bodies`` that go with the wheel, frames that are fixed to the part): {frame: (4, 4), from the
    contact frame, or from the work frame, to it}."""
    cell = passes.cell_of(typed(job))
    if cell["holding"] == "tool_in_hand":
        with_wheel = {"tool": cell["tcp_from_contact"]}
        with_part = {"base": cell["base_from_work"]}
    else:
        with_wheel = {"base": cell["base_from_contact"]}
        with_part = {"tool": cell["tcp_from_work"]}
    return {"wheel": np.eye(4), **with_wheel}, {"part": np.eye(4), **with_part}


class Held:
    """Whether what goes with the wheel of a validated job meets the part, its stock, or bodies that are fixed to them."""

    def __init__(
        self, job: Job | Json, shape: core.Shape, warnings: Facts, context: Context
    ) -> None:
        """``mount`` must follow. Without anything that goes with the wheel, or where the job wants no collisions
        checked, it meets nothing. Raises InputError, Cancelled."""
        self._job = job = typed(job)
        self._shape, self._context = shape, context
        self._looks = job.cell.check_collisions and shape.valid
        self._own: list[tuple[str, core.CollisionMesh]] = []
        self._machine: list[tuple[str, core.CollisionMesh]] = []
        self._advance = 0.0
        self._fixed: list[tuple[core.CollisionMesh, float]] | None = None
        with_wheel, _ = sides(job)
        mine = [body for body in job.cell.bodies if body.frame in with_wheel]
        if not self._looks:
            if job.cell.check_collisions and (mine or _of_machine(job.belt_machine)):
                warnings.append(
                    core.Fact(
                        "raster.held_not_looked_at",
                        "whether what goes with the wheel has room is not known: the part is not a valid shape; repair it",
                    )
                )
            return
        for body in mine:
            mesh = collision.read_body(body, body.name, warnings, context)
            mesh = _moved(mesh, np.linalg.inv(with_wheel[body.frame]))
            self._own.append((body.name, core.CollisionMesh(mesh, context)))

    def mount(self, machine: BeltMachine, advance: float = 0.0) -> None:
        """Takes a job's belt_machine; ``advance``: mm that a belt gives way, by which all comes nearer to the part."""
        self._advance = advance
        found = _of_machine(machine) if self._looks else []
        self._machine = [(name, core.CollisionMesh(mesh, self._context)) for name, mesh in found]

    @property
    def names(self) -> list[str]:
        """Of the bodies that go with the wheel."""
        return [name for name, _ in self._machine + self._own]

    def first_met(self, frames: Floats, room: float = 0.0) -> Array:
        """(n,) int: at work_from_contact (n, 4, 4) the number in ``names`` of the first that meets something, or comes within
        ``room`` mm of it; -1: none."""
        meshes = [mesh for _, mesh in self._machine + self._own]
        if not meshes or not len(frames):
            return np.full(len(frames), -1)
        if self._fixed is None:
            self._fixed = self._bodies_of_work()
        nearer = np.array(frames, dtype=float)
        nearer[:, :3, 3] += self._advance * nearer[:, :3, 2]
        fixed = [(mesh, margin + room) for mesh, margin in self._fixed]
        return core.first_met(meshes, fixed, nearer, self._context)

    def _bodies_of_work(self) -> list[tuple[core.CollisionMesh, float]]:
        """[(core.CollisionMesh, margin mm)] in the work frame."""
        _, with_part = sides(self._job)
        found = []
        for body in collision.bodies(self._job, self._shape, [], self._context):
            if body["frame"] in with_part:
                moved = _moved(body["mesh"], np.linalg.inv(with_part[body["frame"]]))
                mesh = core.CollisionMesh(moved, self._context)
                found.append((mesh, body.get("margin", 0.0)))
        return found


def _of_machine(machine: BeltMachine) -> list[tuple[str, core.TriangleMesh]]:
    """[(name, core.TriangleMesh in the contact frame)] of what holds the belt: a fork, or runs and arms. Rollers and plate
    are looked at with the belt itself."""
    names = {*fork.NAMES, fork.ARMS, *free_run.NAMES, free_run.ARMS}
    return [one for one in collision.machine_bodies(machine) if one[0] in names]


def _moved(mesh: core.TriangleMesh, frame: Floats) -> core.TriangleMesh:
    points = np.asarray(mesh.vertices, dtype=float) @ frame[:3, :3].T + frame[:3, 3]
    return core.TriangleMesh(points.astype(np.float32), np.asarray(mesh.triangles))
