"""What of the faces a raster path grinds, and why the rest stays: place by place."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Context, Facts, Floats, Json
from ..engine import core
from . import passes
from .kinds import Extents, Levels

if TYPE_CHECKING:
    from .clearing import Clearing
    from .tool import Tool

PLACES = 4_000  # on the faces, about
OTHER_WAYS = 400  # of those that the wheel does not get to, that are looked at with the belt in other directions
ANGLES = 4  # of the belt's travel, over half a turn
WHOLE = 0.995  # of the area: what is less is told
BETTER = 0.02  # of the area, that another direction must gain to be told
BETWEEN = 0.25  # of the contact's length: from pose to pose, to see what lies under the wheel
BLOCK = 64  # poses that are looked at together
LEAST_CONTACT = 0.5  # mm

GROUND, NO_ROOM, NO_PASS, NOT_WANTED = 0, 1, 2, 3  # states of a place


def in_any_direction(clearing: Clearing, points: Floats, normals: Floats) -> Array:
    """(n,) bool: at places with outward normals (n, 3), mm, the wheel of a clearing.Clearing fits, leaned if it must
    be, with its belt in one of ``ANGLES`` directions about the normal at least."""
    other = np.eye(3)[np.argmin(abs(normals), axis=1)]
    tangents = np.cross(normals, other)
    fits = np.zeros(len(points), dtype=bool)
    for k in range(ANGLES):
        left = np.flatnonzero(~fits)
        frames = passes.contact_frames(
            points[left], normals[left], tangents[left], math.pi * k / ANGLES
        )
        fits[left] = clearing.fits(frames)
    return fits


def look(
    shape: core.Shape,
    faces: Sequence[int],
    levels: Levels,
    contacts: Sequence[Floats],
    clearing: Clearing,
    settings: Json,
    extents: Extents,
    wanted: tuple[Floats, float] | None = None,
    context: Context = None,
) -> dict[str, Any]:
    """What a path grinds of faces (from 0) of a core.Shape.

    ``levels``: the passes as they would lie if the wheel fitted everywhere, lists of dict(points, tangents (n, 3));
    ``contacts``: the poses of each pass that is left, list of (n, 4, 4) work_from_contact; ``clearing``: a
    clearing.Clearing; ``extents``: (length, width) mm of the contact along and across the belt's travel, and the gap
    mm at its edge (None: that of such a contact on a plane); ``wanted``: (points of a region, mm round them), None:
    everywhere.

    Returns dict(points, normals (n, 3), areas (n,), triangles (m, 3), faces (n,) from 0, fits (n,) bool, state (n,): GROUND,
    NO_ROOM (the wheel would stand in the part, or what goes with it would meet it, with its belt as the passes want it, however it is leaned), NO_PASS
    (it fits, and no pass touches it), NOT_WANTED (nor is it in the region); counted (n,): the areas in the region, to
    which all that follows belongs; share: of the area that the wheel gets to; by_face: {face from 1: the same};
    alone (n,) bool: the wheel fits, whatever goes with it; in_the_way: names of what is, where it alone fits; another_way:
    the same share as ``share`` with the belt in whichever direction, about). Raises InputError, Cancelled.
    """
    area = sum(shape.face_area(face) for face in faces)
    spacing = math.sqrt(area / PLACES)
    field, _ = core.sample_faces(shape, list(faces), spacing, context=context)
    points, normals = field.points, field.normals.astype(float)
    areas, owner = field.areas.astype(float), np.asarray(field.faces)
    line = np.vstack([piece["points"] for pieces in levels for piece in pieces])
    ways = np.vstack([piece["tangents"] for pieces in levels for piece in pieces])
    tangents = _along(ways[nearest(points, line)], normals)
    angle = math.radians(settings["belt_angle_deg"])
    frames = passes.contact_frames(points, normals, tangents, angle)
    fits = clearing.fits(frames)
    alone = fits.copy()
    if clearing.held.names:
        alone[~fits] = clearing.fits(frames[~fits], alone=True)
    state = np.where(fits, NO_PASS, NO_ROOM)
    state[touched(points, contacts, clearing.tool, extents)] = GROUND
    counted = areas
    if wanted is not None:
        outside = nearest_distance(points, np.array(wanted[0], dtype=float)) > wanted[1]
        state[outside & (state != GROUND)] = NOT_WANTED
        counted = np.where(outside, 0.0, areas)
    found = {
        "points": points,
        "normals": normals,
        "areas": areas,
        "counted": counted,
        "triangles": np.asarray(field.triangles),
        "faces": owner,
        "fits": fits,
        "state": state,
        "alone": alone,
        "in_the_way": clearing.in_the_way(frames[alone & ~fits & (counted > 0)]),
    }
    return with_shares(found, _another_way(clearing, points, normals, counted, fits))


def with_shares(seen: Json, another_way: float) -> dict[str, Any]:
    """Places with the shares of the area that follow from ``fits`` and ``counted``; ``another_way``: with the belt in whichever
    direction."""
    fits, counted = seen["fits"], seen["counted"]
    return {
        **seen,
        "share": _share(fits, counted),
        "by_face": _by_face(fits, seen["faces"], counted),
        "another_way": max(another_way, _share(fits, counted)),
    }


def _another_way(
    clearing: Clearing, points: Floats, normals: Floats, areas: Floats, fits: Array
) -> float:
    left = np.flatnonzero(~fits & (areas > 0))
    if not len(left) or clearing.blind:
        return _share(fits, areas)
    some = left[np.unique(np.linspace(0, len(left) - 1, OTHER_WAYS).astype(int))]
    gained = _share(in_any_direction(clearing, points[some], normals[some]), areas[some])
    return _share(fits, areas) + gained * (1.0 - _share(fits, areas))


def _along(ways: Floats, normals: Floats) -> Floats:
    """Unit tangents next to ``ways``; any where these stand on the surface."""
    found = ways - (ways * normals).sum(axis=1)[:, None] * normals
    steep = np.linalg.norm(found, axis=1) < 1e-3
    other = np.cross(normals, np.eye(3)[np.argmin(abs(normals), axis=1)])
    found[steep] = other[steep]
    return found / np.linalg.norm(found, axis=1)[:, None]


def nearest(points: Floats, others: Floats) -> Array:
    """(n,) the number of the nearest of ``others`` (m, 3) to each point (n, 3)."""
    middle = others.mean(axis=0)
    points, others = points - middle, others - middle
    squares = (others**2).sum(axis=1)
    found = np.empty(len(points), dtype=int)
    block = max(1, 4_000_000 // len(others))
    for k in range(0, len(points), block):
        found[k : k + block] = (squares - 2.0 * points[k : k + block] @ others.T).argmin(axis=1)
    return found


def nearest_distance(points: Floats, others: Floats) -> Floats:
    """mm (n,) from each point (n, 3) to the nearest of ``others`` (m, 3)."""
    return np.linalg.norm(points - others[nearest(points, others)], axis=1)


def touched(points: Floats, contacts: Sequence[Floats], tool: Tool, extents: Extents) -> Array:
    """(n,) bool: over which the wheel or the belt (of ``tool.of``) stands, at one of its poses or between two, no higher than
    over the edge of a contact of these extents (as ``look`` has them)."""
    length = max(extents[0], LEAST_CONTACT)
    gap = tool.edge_gap(length, extents[1]) if extents[2] is None else extents[2]
    found = np.zeros(len(points), dtype=bool)
    reach = tool.width + length
    for poses in contacts:
        fine = _between(poses, BETWEEN * length)
        for k in range(0, len(fine), BLOCK):
            some = fine[k : k + BLOCK]
            middle = some[:, :3, 3].mean(axis=0)
            radius = np.linalg.norm(some[:, :3, 3] - middle, axis=1).max() + reach
            near = np.flatnonzero(~found & (((points - middle) ** 2).sum(axis=1) <= radius**2))
            if len(near):
                found[near] = tool.under(points[near], some, length, gap)
    return found


def _between(frames: Floats, spacing: float) -> Floats:
    """Frames (k, 4, 4), no farther apart than ``spacing``; those between are means, nearly rotations."""
    count = np.ceil(np.linalg.norm(np.diff(frames[:, :3, 3], axis=0), axis=1) / spacing)
    count = np.maximum(count, 1).astype(int)
    i = np.repeat(np.arange(len(count)), count)
    share = (np.arange(len(i)) - np.repeat(np.cumsum(count) - count, count)) / count[i]
    found = frames[i] + share[:, None, None] * (frames[i + 1] - frames[i])
    return np.concatenate([found, frames[-1:]])


def told(seen: Json, tool: Tool, settings: Json, warnings: Facts) -> dict[str, Any]:
    """Adds what ``look`` found to the list of warnings. Returns dict(share, faces: {face from 1: share} of the faces
    that the wheel does not get to all of, left_out, no_pass: of the area)."""
    areas = seen["counted"]
    share, alone = seen["share"], _share(seen["alone"], areas)
    no_pass = _share(seen["state"] == NO_PASS, areas)
    if alone < WHOLE:
        lacking = _lacking(_by_face(seen["alone"], seen["faces"], areas))
        words = {
            "tool": tool.name,
            "smaller": tool.smaller,
            "share": 100.0 * alone,
            "fit": settings["fit_mm"],
            "faces": ", ".join(f"Face{k} {100.0 * v:.0f} %" for k, v in list(lacking.items())[:8]),
        }
        if settings["where_it_collides"] == "tilt":
            warnings.append(
                core.Fact(
                    "raster.not_reachable_leaned",
                    "{tool} gets to {share:.0f} % of the area only ({faces}): elsewhere it would stand more than "
                    "{fit:.3g} mm deep in the part, leaned by up to {tilt:.3g} degrees, too; allow more, take "
                    "{smaller}, or leave it to another tool",
                    tilt=settings["max_tilt_deg"],
                    **words,
                )
            )
        else:
            warnings.append(
                core.Fact(
                    "raster.not_reachable",
                    "{tool} gets to {share:.0f} % of the area only ({faces}): elsewhere it would stand more than "
                    "{fit:.3g} mm deep in the part; let it lean, take {smaller}, or leave it to another tool",
                    **words,
                )
            )
    if alone - share > 1.0 - WHOLE:
        warnings.append(
            core.Fact(
                "raster.held_in_the_way",
                "on {share:.0f} % of the area {tool} itself has room, but what goes with it would meet the part, or what is "
                "fixed to it: {bodies}",
                share=100.0 * (alone - share),
                tool=tool.name,
                bodies=", ".join(seen["in_the_way"]),
            )
        )
    if share < WHOLE and seen["another_way"] > share + BETTER:
        warnings.append(
            core.Fact(
                "raster.another_way",
                "with the belt in other directions {tool} would get to {share:.0f} % of the area: try "
                "another belt angle, or passes along another direction",
                tool=tool.name,
                share=100.0 * seen["another_way"],
            )
        )
    if no_pass > 2.0 * (1.0 - WHOLE):
        warnings.append(
            core.Fact(
                "raster.no_pass_there",
                "{share:.1f} % of the area, to which {tool} would get, no pass touches",
                tool=tool.name,
                share=100.0 * no_pass,
            )
        )
    return {
        "share": share,
        "faces": _lacking(seen["by_face"]),
        "left_out": _share(seen["state"] == NO_ROOM, areas),
        "no_pass": no_pass,
    }


def _by_face(fits: Array, owner: Array, areas: Floats) -> dict[int, float]:
    return {
        int(face) + 1: _share(fits[owner == face], areas[owner == face])
        for face in np.unique(owner[areas > 0])
    }


def _lacking(shares: Mapping[int, float]) -> dict[int, float]:
    return {face: value for face, value in shares.items() if value < WHOLE}


def _share(fits: Array, areas: Floats) -> float:
    return float(areas[fits].sum() / max(areas.sum(), 1e-300))
