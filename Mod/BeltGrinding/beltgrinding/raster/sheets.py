"""What passes are laid on: the faces of a job's design as sampled sheets, each with the scalar whose level lines
are the passes. No FreeCAD in here."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json
from ..engine import InputError, core
from ..job.settings import Job
from . import around

PARALLEL = 0.05  # sine of an angle below which two directions count as one


def surfaces(
    job: Job,
    shape: core.Shape,
    faces: Sequence[int],
    spacing: float,
    settings: Json,
    warnings: Facts,
    context: Context,
) -> list[dict[str, Any]]:
    """What passes are laid on: each face by itself for u and v, all together for a direction. List
    of dict(points, normals (n, 3), triangles (m, 3), scalars (m, 3), period, name).
    """
    along = settings["along"]
    field, report = core.sample_faces(shape, faces, spacing, 1.0, 0, context, along in ("u", "v"))
    warnings += report["warnings"]
    points, normals, triangles = field.points, field.normals.astype(float), field.triangles
    if len(triangles) == 0:
        raise InputError(
            "raster.faces_too_small", "the faces are too small for the sampling; lower sampling_mm"
        )
    if along == "rings":
        found = around.sheet(points, normals, triangles, field.areas)
        whole = {"points": points, "normals": normals, "triangles": triangles}
        return [{**whole, **found, "period": 0.0, "name": ""}]
    if along == "direction":
        scalars = points @ planes_across(settings["direction"], points, normals, field.areas)
        whole = {"points": points, "normals": normals, "triangles": triangles}
        return [{**whole, "scalars": scalars[triangles], "period": 0.0, "name": ""}]
    axis = 1 if along == "u" else 0  # what does not change along a pass
    scalars = report["parameters"][:, axis].copy()
    scalars[(field.flags & core.DEGENERATE) > 0] = np.nan  # a pole
    owner, result = field.faces[triangles[:, 0]], []
    for k, face in enumerate(faces):
        mine = triangles[owner == face]
        if len(mine) == 0:
            warnings.append(
                core.Fact(
                    "raster.face_too_small",
                    "Face{face} is too small for samples of {spacing:.3g} mm: no pass",
                    face=face + 1,
                    spacing=spacing,
                )
            )
            continue
        used, local = np.unique(mine, return_inverse=True)
        local = local.reshape(-1, 3)
        surface = {"points": points[used], "normals": normals[used], "triangles": local}
        period = report["period"][k][axis]
        values = scalars[used][local]
        result.append({**surface, "scalars": values, "period": period, "name": f"Face{face + 1}"})
    return result


def planes_across(direction: Floats, points: Floats, normals: Floats, areas: Floats) -> Floats:
    """Unit vector across the passes: the normal of the planes that cut them."""
    along = np.asarray(direction, dtype=float)
    length = np.linalg.norm(along)
    if length == 0:
        raise InputError(
            "raster.no_direction",
            "{key}: give a direction that is not 0, 0, 0",
            key="raster.direction",
        )
    along = along / length
    weights = areas[:, None].astype(float)
    mean = (normals * weights).sum(axis=0) / weights.sum()
    across = np.cross(mean, along)
    if np.linalg.norm(mean) > PARALLEL:
        if np.linalg.norm(across) < PARALLEL * np.linalg.norm(mean):
            raise InputError(
                "raster.direction_along_normal",
                "{key}: the faces look in this very direction; give one along them",
                key="raster.direction",
            )
    else:  # a closed surface looks everywhere: planes across its longer side
        middle = points - (points * weights).sum(axis=0) / weights.sum()
        spread = (middle * weights).T @ middle
        project = np.eye(3) - np.outer(along, along)
        across = np.linalg.eigh(project @ spread @ project)[1][:, -1]
    return across / np.linalg.norm(across)


class Facets(NamedTuple):
    """Triangles of a surface, those that passes have a way on."""

    middles: Floats  # (n, 3) mm
    normals: Floats  # (n, 3) unit, outward
    along: Floats  # (n, 3) unit, of the passes
    areas: Floats  # (n,) mm2
    edges: tuple[Floats, Floats]  # (n, 3) mm, from the first corner
    turns: tuple[Floats, Floats]  # (n, 3), of the surface's normal along them


def facets(surface: Json) -> Facets:
    """The triangles of one of ``surfaces``, and how the passes go on them."""
    corners = surface["triangles"]
    p, n, c = surface["points"][corners], surface["normals"][corners], surface["scalars"]
    c = (
        c - surface["period"] * np.round((c - c[:, :1]) / surface["period"])
        if (surface["period"] > 0)
        else c
    )
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    cross = np.cross(u, v)
    size = np.linalg.norm(cross, axis=1)
    along = (c[:, 2] - c[:, 0])[:, None] * u - (c[:, 1] - c[:, 0])[:, None] * v
    length = np.linalg.norm(along, axis=1)
    sound = np.isfinite(length) & (length > 0) & (size > 1e-12)
    p, u, v, n, cross, size, along = (a[sound] for a in (p, u, v, n, cross, size, along))
    turns = n[:, 1] - n[:, 0], n[:, 2] - n[:, 0]
    outward = np.sign((cross * n.sum(axis=1)).sum(axis=1))
    unit = outward[:, None] * cross / size[:, None]
    return Facets(p.mean(axis=1), unit, along / length[sound, None], 0.5 * size, (u, v), turns)


def curvature_along_and_across(surface: Json) -> tuple[Floats, Floats, Floats]:
    """Normal curvatures of the triangles along and across the passes, 1/mm, positive where the
    surface is convex, and the triangles' areas: from how the normals change along the edges.
    """
    seen = facets(surface)
    across = np.cross(seen.normals, seen.along)
    edges, turned = (
        np.stack([np.stack([(e * d).sum(1) for e in some], 1) for d in (seen.along, across)], 1)
        for some in (seen.edges, seen.turns)
    )
    shape = turned @ np.linalg.inv(edges)  # the shape operator in these two directions
    return shape[:, 0, 0], shape[:, 1, 1], seen.areas
