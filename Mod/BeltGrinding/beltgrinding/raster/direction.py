"""Which way the passes go best: each way is laid and ground by the simulator on a coarse field, and compared."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Context, Floats, Json
from ..engine import InputError, core
from ..job import engine_input, resolution, robot_time
from ..job.settings import Job
from ..job.workpiece import apply_stock
from . import around, tool

if TYPE_CHECKING:
    from ..job.engine_input import EngineInput

SAMPLES = 6_000  # on the faces, about
ACROSS = 4.0  # of them across the contact's width, if that is finer
MOST_SAMPLES = 40_000
STEP = 0.3  # of the contact's length: from step to step of the simulation
BELT_STEPS, BELT_TURN = 150, 0.3  # of a belt; rad a step
AS_EVEN = 0.1  # of the residual: so near the best, the quickest is taken
ANGLES = (0.0, 45.0, 90.0, 135.0)  # degrees, from the direction in which the faces are longest
BELT_ANGLES = (0.0, 90.0)  # of a belt, whose contacts take their time
ROUND = 0.75  # of a turn, that coarse samples of closed faces take at least
STILL = 1e-6  # mm; less is no way
SAME_WAY = 0.99  # cosine: such directions are one
UNBENT = 1e-4  # square of the normals' turn, radians: flat faces
FLAT = 0.3  # of its unit length, the mean of the normals of faces that look one way


def candidates(field: core.HeightField, angles: Sequence[float] = ANGLES) -> list[dict[str, Any]]:
    """Settings of the ways that are tried, for a core.HeightField of the faces: list of dict(along, direction)."""
    points, weight = field.points, field.areas[:, None].astype(float)
    middle = (points * weight).sum(axis=0) / weight.sum()
    spread = ((points - middle) * weight).T @ (points - middle)
    mean = (field.normals * weight).sum(axis=0) / weight.sum()
    _, axes = np.linalg.eigh(spread)
    ways = [{"along": "u"}, {"along": "v"}]
    if around.Axis(points, field.normals.astype(float), field.areas).turn >= ROUND:
        ways.append({"along": "rings"})
    if np.linalg.norm(mean) > FLAT:
        normal = mean / np.linalg.norm(mean)
        first = axes[:, -1] - (axes[:, -1] @ normal) * normal
        if np.linalg.norm(first) < 0.1:
            first = axes[:, -2] - (axes[:, -2] @ normal) * normal
        first /= np.linalg.norm(first)
        second = np.cross(normal, first)
        turns = [math.radians(angle) for angle in angles]
        directions = [math.cos(a) * first + math.sin(a) * second for a in turns]
    else:  # round about: along its axes
        directions = list(axes.T[::-1])
    return ways + [
        {"along": "direction", "direction": (np.round(d, 4) + 0.0).tolist()} for d in directions
    ]


def best(
    job: Job,
    given: EngineInput,
    shape: core.Shape,
    faces: Sequence[int],
    settings: Json,
    lay: Callable[[Json, Context], dict[str, Any]],
    context: Context = None,
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Lays passes every way of ``candidates`` and takes the one that leaves least; ``given``: the job's EngineInput.

    ``lay(settings, context)`` gives a path with contacts, feeds and so on as ``raster_path.raster`` does. Returns
    (settings of the best way, list of dict(along, direction, residual, untouched, duration_s, poses, chosen, no_room,
    error: why there is no path) of all ways). residual: standard deviation of the removal over the area, by its mean:
    what stays of an allowance that comes off on the mean; untouched: of the area; duration_s: by the robot, whose time
    lets sharp turns grind deep.
    A way whose path takes nothing off is as one without a path. Each is ground on a thread of its own while the next
    is laid. Raises InputError (no way gives a path), Cancelled.
    """
    context = context or core.RunContext()
    area = sum(shape.face_area(face) for face in faces)
    coarse, _ = core.sample_faces(shape, list(faces), math.sqrt(area / SAMPLES), context=context)
    angles = BELT_ANGLES if tool.of(job).belt else ANGLES
    tried: list[dict[str, Any]] = []
    ways = candidates(coarse, angles)
    if settings["order"] == "helix":
        ways = [{"along": "rings"}]
    with ThreadPoolExecutor(core.threads()) as beside:
        judged: list[Future[dict[str, Any]]] = []
        try:
            for way in ways:
                try:
                    path = lay({**settings, **way, "footprint": "cylinder"}, context)
                except InputError as error:
                    judged.append(Future())
                    judged[-1].set_exception(error)
                    continue
                parts = (job, given, shape, faces, area, settings, path, context)
                judged.append(beside.submit(_judged, *parts))
            for way, found in zip(ways, judged):
                one: dict[str, Any] = {**way, "chosen": False}
                tried.append(one)
                try:
                    one.update(found.result())
                except InputError as error:
                    one["error"] = error
        except BaseException:
            context.cancel()  # what is still being ground, for which the way out would wait
            raise
    laid = [k for k, one in enumerate(tried) if "residual" in one]
    if not laid:
        raise tried[0]["error"]
    # One that only lies as if the wheel fitted is worse than any other.
    laid = [k for k in laid if not tried[k]["no_room"]] or laid
    least = min(tried[k]["residual"] for k in laid)
    near = [k for k in laid if tried[k]["residual"] <= (1.0 + AS_EVEN) * least]
    chosen = min(near, key=lambda k: tried[k]["duration_s"])
    tried[chosen]["chosen"] = True
    return ways[chosen], tried


def _judged(
    job: Job,
    given: EngineInput,
    shape: core.Shape,
    faces: Sequence[int],
    area: float,
    settings: Json,
    path: Json,
    context: Context,
) -> dict[str, Any]:
    """What a path leaves, by the simulator: dict(residual, untouched, duration_s, no_room, poses). Raises InputError for
    one that takes nothing off, Cancelled.
    """
    width = path["contact_width_mm"] or path["step_over_mm"]
    spacing = max(min(math.sqrt(area / SAMPLES), width / ACROSS), math.sqrt(area / MOST_SAMPLES))
    field, _ = core.sample_faces(shape, list(faces), spacing, context=context)
    machine, steps = given.machine, given.simulation
    if machine.control != "force":  # the stock decides what comes off
        apply_stock(field, job.stock, [], context)
    before = field.height.astype(float)
    step, pressing = STEP * max(path["contact_length_mm"], spacing), tool.of(job)
    turn = 2.0 * step / pressing.radius
    if isinstance(pressing, tool.Belt):  # a step costs a hundred of a wheel's
        step, turn = max(step, sum(p["length_mm"] for p in path["passes"]) / BELT_STEPS), BELT_TURN
        machine = pressing.coarse(machine)
    given = replace(
        given,
        machine=replace(
            machine,
            force_N=settings["force_N"] or machine.force_N,
            contact_tolerance=max(machine.contact_tolerance, resolution.TOLERANCE),
        ),
        simulation=replace(steps, max_travel_mm=max(step, steps.max_travel_mm)),
        max_angle=max(turn, math.radians(steps.max_angle_deg)),
        must_touch=False,
        shifted_laws=(),
    )
    some = _sparse(path, step) if pressing.belt else np.arange(len(path["contacts"]))
    columns = {name: path[name][some] for name in ("forces", "rapid", "lines", "zones")}
    times = _times(job, path)
    feeds = _feeds(path["contacts"][some], times[some], path["feeds"][some])
    tool_path = core.ToolPath(frames=path["contacts"][some], feeds=feeds, **columns)
    core.simulate(field, tool_path, given, context)
    removed, weight = before - field.height, field.areas.astype(float)
    removed[~np.isfinite(removed)] = 0.0
    mean = (removed * weight).sum() / weight.sum()
    if not mean > 0.0:
        raise InputError(
            "raster.takes_nothing_off",
            "its path takes nothing off the faces; raise force or coefficient, or give a direction",
        )
    spread = math.sqrt(((removed - mean) ** 2 * weight).sum() / weight.sum())
    untouched = weight[field.trace["peak_pressure"] <= 0].sum() / weight.sum()
    return {
        "residual": spread / mean,
        "untouched": float(untouched),
        "duration_s": float(times[-1]),
        "no_room": path["no_room"],
        "poses": len(path["frames"]),
    }


def _times(job: Job, path: Json) -> Array:
    """(n,) s, at which the robot comes to a path's poses."""
    law = engine_input.time_law(robot_time.timed(job)["simulation"])
    given = {name: path[name] for name in ("frames", "feeds", "forces", "rapid", "lines", "zones")}
    return core.ToolPath(**given, time_law=law).times()


def _feeds(contacts: Floats, times: Floats, feeds: Floats) -> Array:
    """mm/s (n,) of the contact with which it comes to ``contacts`` (n, 4, 4) at ``times`` (n,) s; where it does not move as
    ``feeds`` (n,)."""
    way = np.linalg.norm(np.diff(contacts[:, :3, 3], axis=0), axis=1)
    found, lasts = feeds.copy(), np.diff(times)
    moves = np.flatnonzero((way > STILL) & (lasts > 0.0))
    found[moves + 1] = way[moves] / lasts[moves]
    return found


def _sparse(path: Json, step: float) -> Array:
    """Numbers of a path's poses, of each pass those that are ``step`` mm apart, about, and its ends."""
    wanted = np.ones(len(path["contacts"]), dtype=bool)
    for one in path["passes"]:
        inner = np.arange(one["first"] + 1, one["last"])
        way = np.diff(path["contacts"][one["first"] : one["last"] + 1, :3, 3], axis=0)
        steps = np.floor(np.cumsum(np.linalg.norm(way, axis=1)) / step).astype(int)
        wanted[inner] = steps[:-1] > np.concatenate([[0], steps[:-2]]) if len(inner) else []
    return np.flatnonzero(wanted)
