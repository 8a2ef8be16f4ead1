"""Where the wheel gets to at all: the rigid wheel, standing on a place of the faces, reaches nowhere deep into
the part, whichever of its faces. Bodies of the cell are not looked at."""

import math

import numpy as np

from ..engine import InputError, core
from ..job import engine_input
from . import passes

PLACES = 1_500  # on the faces, that are looked at
SPARE = 4.0  # samples for each of them, from which they are taken
PART_SAMPLES = 40_000  # of the whole part
ANGLES = 4  # of the belt's travel, that are tried, over half a turn
WHOLE = 0.995  # of the area: what is less is told


def reachable(job, shape, faces, fit_mm=0.5, context=None):
    """Where the rigid wheel of a validated job gets to on faces (from 0) of a core.Shape, its belt in any of
    ``ANGLES`` directions about the surface's normal.

    Returns dict(points, normals (n, 3), areas (n,), faces (n,) from 0, fits (n,) bool: no deeper than
    ``fit_mm`` in the part anywhere; share: of the area; by_face: {face from 1: share of its area}). Raises
    InputError, Cancelled.
    """
    area = sum(shape.face_area(face) for face in faces)
    field, _ = core.sample_faces(
        shape, list(faces), math.sqrt(area / (SPARE * PLACES)), context=context
    )
    places = np.unique(np.linspace(0, field.size - 1, PLACES).astype(int))
    points, normals = field.points[places], field.normals[places].astype(float)
    fits = fits_at(job, shape, points, normals, fit_mm, context)
    areas, owner = field.areas[places].astype(float), np.asarray(field.faces)[places]
    return {
        "points": points,
        "normals": normals,
        "areas": areas,
        "faces": owner,
        "fits": fits,
        "share": _share(fits, areas),
        "by_face": {
            int(face) + 1: _share(fits[owner == face], areas[owner == face])
            for face in np.unique(owner)
        },
    }


def fits_at(job, shape, points, normals, fit_mm, context=None):
    """(n,) bool of places with outward normals (n, 3), mm, as ``reachable`` gives it."""
    wheel = engine_input.engine_arguments(job)[0]
    whole = sum(shape.face_area(face) for face in range(shape.face_count))
    part, _ = core.sample_faces(shape, [], math.sqrt(whole / PART_SAMPLES), context=context)
    # Both ways: beyond a wall the wheel's centre is behind it, and would see its back only.
    inside = np.vstack([part.points] * 2)
    looks = np.vstack([part.normals, -part.normals]).astype(float)
    other = np.eye(3)[np.argmin(abs(normals), axis=1)]
    tangents = np.cross(normals, other)
    fits = np.zeros(len(points), dtype=bool)
    for k in range(ANGLES):
        frames = passes.contact_frames(points, normals, tangents, math.pi * k / ANGLES)
        depth = core.wheel_fit(wheel, frames, inside, looks, context, True)
        fits |= np.asarray(depth) <= fit_mm
    return fits


def told(job, shape, faces, settings, warnings, context):
    """The share of the area that the wheel gets to, and {face from 1: share} of the faces of which it does not
    get to all; None where the part cannot be sampled. What it does not get to is warned of."""
    try:
        found = reachable(job, shape, faces, settings["fit_mm"], context)
    except InputError:
        return None
    lacking = {face: share for face, share in found["by_face"].items() if share < WHOLE}
    if found["share"] < WHOLE:
        warnings.append(
            core.Fact(
                "raster.not_reachable",
                "the rigid wheel gets to {share:.0f} % of the area only: elsewhere it would stand more than "
                "{fit:.3g} mm deep in the part, in whichever direction the belt runs ({faces}); take a smaller or "
                "narrower wheel there, or leave it to another tool",
                share=100.0 * found["share"],
                fit=settings["fit_mm"],
                faces=", ".join(f"Face{k} {100.0 * v:.0f} %" for k, v in list(lacking.items())[:8]),
            )
        )
    return {"share": found["share"], "faces": lacking}


def _share(fits, areas):
    return float(areas[fits].sum() / max(areas.sum(), 1e-300))
