"""Bodies of the cell, and whether they run into each other on the way.

A job's ``cell.bodies`` says which there are (job.schema.json); the part and the wheel are always among
them. The part is its whole shape with its stock; the wheel is what lies behind the rim. A free belt has
two rollers in place of the wheel, a platen its plate as well, both what holds them where a job says it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from ..base import frames, kept, records
from ..base.kinds import Array, Context, Facts, Floats, Json, known
from ..engine import InputError, core
from ..geometry import fork, free_run
from ..geometry.body_names import LINKS, PART, PLATE, ROLLERS, STOCK, WHEEL
from ..job import machine as machines, workpiece
from ..job.poses import program_name
from ..job.settings import BeltMachine, Body, Job, Stock, Wheel
from ..job.typed import typed
from ..presets import robot as robots, robot_shape
from . import tool_path

FINDING_BYTES = 4000  # in memory, about
DEFLECTION = 0.1  # mm, chord error of bodies, part and wheel, up to a size of a metre
LARGE = 1e-4  # of its size: the chord error of what is larger
LONGEST = 1e7  # s of a program, some months
LEAST_AROUND, MOST_AROUND = 12, 4000  # corners of a wheel's body


def check(
    job: Job | Json,
    shape: core.Shape,
    paths: Sequence[core.ToolPath],
    warnings: Facts,
    context: Context = None,
    reached: Sequence[Json] = (),
) -> list[dict[str, Any]]:
    """What ``core.check_collisions`` finds for each core.ToolPath of a validated job, kept for the next on the same way. ``shape``: the
    design's core.Shape; ``reached``: ``reach.job_reach`` of them, for the robot's own arm; [] if the job
    does not want it. Raises InputError, Cancelled.
    """
    job = typed(job)
    if not job.cell.check_collisions:
        return []
    if not shape.valid:  # OpenCASCADE's mesher may never end on its faults
        warnings.append(
            core.Fact(
                "cell.collisions_not_checked",
                "collisions are not checked: the part is not a valid shape; repair it",
            )
        )
        return []
    context = context or core.RunContext()
    found = bodies(job, shape, warnings, context)
    if reached:
        found += arm_bodies(records.plain(job.robot))
    for body in found:
        if not np.isfinite(body["mesh"].vertices).all():
            raise InputError(
                "cell.body_too_large",
                "cell: the body '{body}' is too large; check its sizes",
                body=body["name"],
            )
    clearance = float(job.cell.clearance_mm)
    results = []
    for i, path in enumerate(paths):
        part = context.part(i / len(paths), (i + 1) / len(paths))
        if not path.duration() < LONGEST:
            raise InputError(
                "cell.program_too_long",
                "{program}: the program takes {seconds:.3g} s, too long to be checked for collisions; check its poses and feeds",
                program=program_name(job, i),
                seconds=path.duration(),
            )
        arm = reached[i]["arm"] if reached else None
        results.append(_met(job, path, found, clearance, arm, part).told(path, arm))
    touching = sorted({name for one in results for name in one["touching"]})
    warnings += built_together(records.plain(job.robot), touching)
    return results


def _met(
    job: Job,
    path: core.ToolPath,
    found: list[dict[str, Any]],
    clearance: float,
    arm: core.ArmInCell | None,
    context: Context,
) -> core.CollisionFindings:
    """core.CollisionFindings."""

    def look() -> core.CollisionFindings:
        home = robots.home_of(records.plain(job.robot))
        return core.find_collisions(path, found, clearance, arm=arm, context=context, home=home)

    _, way = tool_path.digests(path)
    if way is None:
        return look()
    robot, steps = records.plain(job.robot), job.simulation
    followed = None
    if arm is not None:  # which decides what the joints do on the way, whatever time they take
        followed = robot, robots.model_of(robot), steps.max_travel_mm, steps.max_angle_deg
    met = [{**body, "mesh": [body["mesh"].vertices, body["mesh"].triangles]} for body in found]
    return kept.get(
        "collisions",
        lambda: (way, met, clearance, followed),
        look,
        lambda met: FINDING_BYTES * len(met),
    )


def bodies(
    job: Job | Json, shape: core.Shape, warnings: Facts, context: Context = None
) -> list[dict[str, Any]]:
    """The bodies of a validated job as ``core.check_collisions`` takes them."""
    job = typed(job)
    stock = job.stock
    uniform = stock.kind in ("allowance", "left")
    grown = max(0.0, stock.allowance_mm + stock.offset_mm) if uniform else 0.0
    mesh = _triangulate(shape, context)
    found = [{"name": PART, "frame": "part", "mesh": mesh, "margin": grown}]
    if not uniform:
        mesh = read_body(stock, "stock", warnings, context)
        grown = max(0.0, stock.offset_mm)
        found.append({"name": STOCK, "frame": "part", "mesh": mesh, "margin": grown})
    machine = job.belt_machine
    if machines.wheel_presses(machine):
        disc = wheel_body(machine.wheel, job.cell.wheel_inset_mm)
        if disc is not None:
            found.append({"name": WHEEL, "frame": "wheel", "mesh": disc})
    for name, mesh in machine_bodies(machine):
        found.append({"name": name, "frame": "wheel", "mesh": mesh})
    standing = robots.standing(records.plain(job.robot))
    for body in job.cell.bodies:
        mesh = read_body(body, body.name, warnings, context)
        if body.frame == "base" and not np.array_equal(standing, np.eye(4)):
            points = mesh.vertices @ standing[:3, :3].T + standing[:3, 3]
            mesh = core.TriangleMesh(points.astype(np.float32), mesh.triangles)
        found.append({"name": body.name, "frame": body.frame, "mesh": mesh})
    return found


def arm_bodies(robot: Json) -> list[dict[str, Any]]:
    """The links of a job's robot (with its defaults) as ``core.check_collisions`` takes them."""
    found = []
    for number, (name, parts) in enumerate(zip(LINKS, robots.links_of(robot))):
        points, triangles = robot_shape.body(*parts)
        if len(triangles):
            mesh = core.TriangleMesh(points.astype(np.float32), triangles.astype(np.uint32))
            found.append({"name": name, "frame": "link", "link": number, "mesh": mesh})
    return found


def links_left_out(robot: Json, bodies: Sequence[Json]) -> Facts:
    """A fact that names the links of a job's robot (with its defaults) whose ``bodies``, among others, are too rough to be
    looked at against each other; [] if there are none."""
    links = [body for body in bodies if body["frame"] == "link"]
    pairs = core.touching_links(known(robots.arm_of(robot)), links) if links else []
    if not pairs:
        return []
    told = ", ".join(f"{first}/{second}" for first, second in pairs)
    return [
        core.Fact(
            "cell.links_left_out",
            "{robot}: links {pairs} are not looked at against each other: their bodies touch at joint angles 0 or in more than a quarter of all postures",
            robot=robots.name(robot),
            pairs=told,
        )
    ]


def built_together(robot: Json, names: Sequence[str]) -> Facts:
    """A fact that names bodies at the flange of a job's robot that touch its link 5 at home; [] for none."""
    if not names:
        return []
    return [
        core.Fact(
            "cell.built_together",
            "{robot}: not checked against robot link 5, which they touch at the home posture: {bodies}",
            robot=robots.name(robot),
            bodies=", ".join(names),
        )
    ]


def read_body(
    body: Stock | Body | Json, name: str, warnings: Facts, context: Context = None
) -> core.TriangleMesh:
    """core.TriangleMesh of a job's body or stock, in its frame. Raises InputError."""
    placed = body.get("placement") if isinstance(body, Mapping) else body.placement
    try:
        placement = frames.from_data(records.plain(placed))
    except InputError as error:
        raise error.within("cell.placement", "{body}: placement: ", body=name) from None

    def read() -> tuple[core.TriangleMesh, Facts]:
        if workpiece.is_mesh(body):
            report: dict[str, Any] = {}
            file, _, unit = workpiece.source(body)
            mesh = core.read_mesh(known(file), known(unit), placement, context, report)
            return mesh, [
                core.Fact("cell.of_body", "{body}: {warning}", body=name, warning=fact)
                for fact in report["warnings"]
            ]
        shape = workpiece.read_shape(body, name, context)
        told = [
            core.Fact("cell.of_body", "{body}: {warning}", body=name, warning=text)
            for text in shape.warnings()
        ]
        mesh = _triangulate(shape, context)
        points = mesh.vertices @ placement[:3, :3].T.astype(np.float32) + placement[:3, 3]
        return core.TriangleMesh(points.astype(np.float32), mesh.triangles), told

    def parts() -> tuple[Any, ...]:
        return workpiece.made_from(body), name, placement

    mesh, told = kept.get("body", parts, read, _told_bytes)
    warnings += told
    return mesh


def _told_bytes(found: tuple[core.TriangleMesh, Facts]) -> int:
    return _mesh_bytes(found[0])


def _mesh_bytes(mesh: core.TriangleMesh) -> int:
    return mesh.vertices.nbytes + mesh.triangles.nbytes


def _triangulate(shape: core.Shape, context: Context) -> core.TriangleMesh:
    def make() -> core.TriangleMesh:
        low, high = shape.extents()
        size = float(np.linalg.norm(np.subtract(high, low)))
        return core.triangulate(shape, max(DEFLECTION, LARGE * size), context)

    name = kept.name(shape)
    return make() if name is None else kept.get("triangles", lambda: name, make, _mesh_bytes)


def wheel_body(wheel: Wheel | Json, inset: float) -> core.TriangleMesh | None:
    """The wheel within its rim, ``inset`` mm below the belt's surface, as a core.TriangleMesh in the
    contact frame; None if nothing of it is left. ``wheel``: as in a job.
    """
    wheel = records.made(Wheel, wheel)
    line = wheel_profile(wheel)
    line[:, 1] -= inset
    if line[:, 1].min() <= 0.0:
        return None
    ends = [[line[0, 0], 0.0]], [[line[-1, 0], 0.0]]
    line = np.concatenate([ends[0], line, ends[1]])
    around = max(LEAST_AROUND, math.ceil(2.0 * math.pi / _chord_angle(line[:, 1].max())))
    angles = np.linspace(0.0, 2.0 * math.pi, around, endpoint=False)
    count = len(line)
    points = np.zeros((around, count, 3))
    points[..., 0] = np.sin(angles)[:, None] * line[:, 1]
    points[..., 1] = line[:, 0]
    points[..., 2] = np.cos(angles)[:, None] * line[:, 1] - wheel.radius_mm
    i, k = np.meshgrid(np.arange(around), np.arange(count - 1), indexing="ij")
    a, b = i * count + k, (i + 1) % around * count + k
    # The outermost quads end on the axis: of each, one triangle.
    quads = [a, b, b + 1], [a, b + 1, a + 1]
    triangles = np.concatenate(
        [
            np.stack(quads[0], axis=-1)[:, 1:].reshape(-1, 3),
            np.stack(quads[1], axis=-1)[:, :-1].reshape(-1, 3),
        ]
    )
    # All points on the axis at an end are one.
    triangles = np.where(triangles % count == 0, 0, triangles)
    triangles = np.where(triangles % count == count - 1, count - 1, triangles)
    return core.TriangleMesh(points.reshape(-1, 3).astype(np.float32), triangles.astype(np.uint32))


def machine_bodies(machine: BeltMachine | Json) -> list[tuple[str, core.TriangleMesh]]:
    """[(name, core.TriangleMesh in the contact frame)] of a job's free belt or platen: its rollers, with the belt round
    their outer sides, the plate behind the layers, the belt's runs beyond the rollers and the arms; of a small wheel the
    belt's runs and the fork. Of a contact wheel none. The belt between the rollers gives way.
    """
    machine = records.made(BeltMachine, machine)
    if machines.kind(machine) == machines.SMALL_WHEEL:
        return _runs_and_arms(fork, machine)
    if machines.kind(machine) == machines.WHEEL:
        return []
    run, found = known(machine.free_run), []
    radius = run.roller_radius_mm
    if radius > 0.0:
        roller = {"radius_mm": radius, "width_mm": run.width_mm}
        mesh = wheel_body({**roller, "crown_radius_mm": 0.0, "profile_mm": []}, 0.0)
        for name, (x, z) in zip(ROLLERS, free_run.roller_axes(machine)):
            assert mesh is not None  # its inset is 0
            # A wheel's body has its axis at -radius.
            points = mesh.vertices + np.array([x, 0.0, z + radius], dtype=np.float32)
            found.append((name, core.TriangleMesh(points, mesh.triangles)))
    if machines.kind(machine) == machines.PLATEN:
        found.append((PLATE, _mesh(*free_run.plate(machine))))
    if free_run.has_runs(machine):
        found += _runs_and_arms(free_run, machine)
    return found


def _runs_and_arms(holder: ModuleType, machine: BeltMachine) -> list[tuple[str, core.TriangleMesh]]:
    """``holder``: the module that knows them."""
    found = [(name, holder.run(machine, side)) for name, side in zip(holder.NAMES, (-1.0, 1.0))]
    held = holder.arms(machine)
    if held:
        starts = np.cumsum([0, *(len(points) for points, _ in held)])
        faces = np.concatenate([faces + start for (_, faces), start in zip(held, starts)])
        found.append((holder.ARMS, (np.concatenate([points for points, _ in held]), faces)))
    return [(name, _mesh(*solid)) for name, solid in found]


def _mesh(points: Array, faces: Array) -> core.TriangleMesh:
    return core.TriangleMesh(points.astype(np.float32), faces.astype(np.uint32))


def _chord_angle(radius: float) -> float:
    """The angle of a chord that leaves a circle of ``radius`` by DEFLECTION, or by no more than
    MOST_AROUND corners of the whole circle let it.
    """
    angle = 2.0 * math.acos(max(0.0, 1.0 - DEFLECTION / radius))
    return max(angle, 2.0 * math.pi / MOST_AROUND)


def wheel_profile(wheel: Wheel | Json) -> Floats:
    """Points [y, radius] (n, 2) in mm across a job's wheel."""
    wheel = records.made(Wheel, wheel)
    radius, width, crown = wheel.radius_mm, wheel.width_mm, wheel.crown_radius_mm
    parts = (
        math.ceil(2.0 * math.asin(0.5 * width / crown) / _chord_angle(crown)) if crown > 0 else 1
    )
    across = np.linspace(-0.5 * width, 0.5 * width, parts + 1)
    turned = np.array(wheel.profile_mm, dtype=float).reshape(-1, 2)
    if len(turned):
        across = np.union1d(across, turned[:, 0])
    drop = np.interp(across, turned[:, 0], turned[:, 1]) if len(turned) else np.zeros(len(across))
    if crown > 0:
        drop = drop + crown - np.sqrt(np.maximum(crown**2 - across**2, 0.0))
    return np.stack([across, radius - drop], axis=1)


def summary(found: Sequence[Json], paths: Sequence[core.ToolPath]) -> list[dict[str, Any]]:
    """The least clearance of every pair of bodies, as summary.json has it, the nearest first.

    ``found``: what ``check`` gives for ``paths``.
    """
    least: dict[tuple[str, ...], dict[str, Any]] = {}
    begin = 0.0
    for program, (result, path) in enumerate(zip(found, paths)):
        lines = path.lines()
        for pair in result["pairs"]:
            key = tuple(pair["bodies"])
            if key in least and least[key]["distance_mm"] <= pair["distance"]:
                continue
            least[key] = {
                "bodies": list(key),
                "distance_mm": pair["distance"],
                "program": program,
                "pose": pair["pose"],
                "line": int(lines[pair["pose"]]),
                "time_s": pair["time"] + begin,
                "points": [np.asarray(point).tolist() for point in pair["points"]],
            }
        begin += path.duration()
    return sorted(least.values(), key=lambda pair: pair["distance_mm"])
