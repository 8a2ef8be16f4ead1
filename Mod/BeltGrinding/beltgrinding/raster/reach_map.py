"""How much of the faces a wheel gets to, by its shape alone, for ways of the passes and angles of the belt: what a search
looks at before it simulates anything."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Context, Floats, Json
from ..engine import InputError, core
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import read_design
from . import direction, reachable, tool
from .clearing import Clearing
from .passes import contact_frames
from .sheets import facets, surfaces

SAMPLES = 2_000  # on the faces, about, to see how passes go
PLACES = 200  # that are looked at
NEARLY_ALL = 0.99  # of the places on which two ways are the same, for them to be one


class Reach(NamedTuple):
    """Of one way and one belt angle."""

    way: Json  # dict(along, direction), of a raster's settings
    belt_angle_deg: float
    share: float  # of the area, that the wheel gets to, leaned if it must be
    upright: float  # the same without a lean


class Map(NamedTuple):
    """Of one wheel."""

    found: list[Reach]
    fits: Array  # (places,) bool: with its belt in one direction at least, at places of equal area, the same for all wheels


def faces_of(job: Job, shape: core.Shape, settings: Json) -> list[int]:
    """Numbers from 0 of the faces that are ground."""
    wanted = settings["faces"] or job.design.faces or range(1, shape.face_count + 1)
    return sorted({face - 1 for face in wanted if face <= shape.face_count})


def area_of(job: Job | Json, settings: Json) -> float:
    """mm2 of the faces of a validated job that are ground."""
    job = typed(job)
    shape = read_design(job.design)
    return float(sum(shape.face_area(face) for face in faces_of(job, shape, settings)))


def ways(job: Job | Json, settings: Json, context: Context = None) -> list[dict[str, Any]]:
    """The ways that passes may go on the faces of a validated job: as ``direction.candidates``, and along and across the
    direction in which the faces are bent most."""
    job = typed(job)
    shape = read_design(job.design, context)
    field = _field(shape, faces_of(job, shape, settings), direction.SAMPLES, context)
    angles = direction.BELT_ANGLES if tool.of(job).belt else direction.ANGLES
    found = direction.candidates(field, angles)
    bent = [(np.round(way, 4) + 0.0).tolist() for way in _bent(field)]
    return distinct([*found, *({"along": "direction", "direction": way} for way in bent)])


def distinct(ways: Sequence[Json]) -> list[dict[str, Any]]:
    """Without directions that are nearly one before them."""
    found: list[dict[str, Any]] = []
    for way in ways:
        same = [one for one in found if one["along"] == way["along"]]
        if way["along"] == "direction":
            mine = _unit(way["direction"])
            same = [one for one in same if abs(mine @ _unit(one["direction"])) > direction.SAME_WAY]
        if not same:
            found.append(dict(way))
    return found


def _unit(way: Sequence[float]) -> Floats:
    found = np.asarray(way, dtype=float)
    return found / max(float(np.linalg.norm(found)), 1e-12)


def look(
    job: Job | Json,
    settings: Json,
    ways: Sequence[Json],
    angles: Sequence[float],
    context: Context = None,
) -> Map:
    """The ``Map`` of a validated job's wheel or belt, for each of ``ways`` with the belt at each of ``angles`` degrees to it, on all of
    the faces or in the region of the ``settings``. A way on which no pass can be laid has no entry. Raises InputError,
    Cancelled."""
    job = typed(job)
    context = context or core.RunContext()
    shape = read_design(job.design, context)
    faces = faces_of(job, shape, settings)
    clearing = Clearing(job, shape, settings, [], context)
    spacing = math.sqrt(sum(shape.face_area(face) for face in faces) / SAMPLES)
    found: list[Reach] = []
    laid: list[tuple[Floats, Floats]] = []  # (middles, along) of ways
    for way in ways:
        try:
            parts = surfaces(job, shape, faces, spacing, {**settings, **way}, [], context)
        except InputError:
            continue
        seen = [facets(part) for part in parts]
        points, normals, along, areas = (
            np.concatenate([getattr(one, name) for one in seen])
            for name in ("middles", "normals", "along", "areas")
        )
        if any(_same(points, along, *one) for one in laid):
            continue
        laid.append((points, along))
        some = _spread(np.where(_near(points, settings, spacing), areas, 0.0))
        for angle in angles:
            frames = contact_frames(points[some], normals[some], along[some], math.radians(angle))
            shares = clearing.fits(frames).mean(), clearing.fits_upright(frames).mean()
            found.append(Reach(way, angle, *map(float, shares)))
    field = _field(shape, faces, SAMPLES, context)
    near = _near(np.asarray(field.points), settings, spacing)
    areas = np.asarray(field.areas, dtype=float)
    some = _spread(np.where(near, areas, 0.0))
    normals = np.asarray(field.normals, dtype=float)[some]
    fits = reachable.in_any_direction(clearing, np.asarray(field.points)[some], normals)
    return Map(found, fits)


def _field(
    shape: core.Shape, faces: Sequence[int], samples: int, context: Context
) -> core.HeightField:
    area = sum(shape.face_area(face) for face in faces)
    return core.sample_faces(shape, list(faces), math.sqrt(area / samples), context=context)[0]


def _same(points: Floats, along: Floats, others: Floats, along_others: Floats) -> bool:
    """Whether passes at the same points go the same way nearly everywhere."""
    if points.shape != others.shape or not np.allclose(points, others):
        return False
    alike = abs((along * along_others).sum(axis=1)) > direction.SAME_WAY
    return bool(alike.mean() > NEARLY_ALL)


def _near(points: Floats, settings: Json, spacing: float) -> Array:
    """(n,) bool: points (n, 3) in the region of the settings, or nearer to it than places are to each other; all, where it has none."""
    wanted = settings["region_points"]
    if not wanted:
        return np.ones(len(points), dtype=bool)
    apart = reachable.nearest_distance(points, np.asarray(wanted, dtype=float))
    return apart <= max(settings["region_mm"], spacing, float(apart.min()))


def _spread(areas: Floats) -> Array:
    """Numbers of ``PLACES`` of so many areas, about, each for as much of the whole."""
    summed = np.cumsum(areas)
    wanted = (np.arange(PLACES) + 0.5) / PLACES * summed[-1]
    return np.searchsorted(summed, wanted)


def _bent(field: core.HeightField) -> list[Floats]:
    """Unit vectors (3,) in which the normals change most, and across it: the mean principal directions. [] of flat faces."""
    normals, areas = np.asarray(field.normals, dtype=float), np.asarray(field.areas, dtype=float)
    corners = np.asarray(field.triangles)
    mean = (normals * areas[:, None]).sum(axis=0)
    if np.linalg.norm(mean) < direction.FLAT * areas.sum() or not len(corners):
        return []
    mean /= np.linalg.norm(mean)
    spread = ((normals - mean) * areas[:, None]).T @ (normals - mean) / areas.sum()
    project = np.eye(3) - np.outer(mean, mean)
    values, vectors = np.linalg.eigh(project @ spread @ project)
    if values[-1] < direction.UNBENT:
        return []
    most = vectors[:, -1]
    return [most, np.cross(mean, most)]
