"""How far apart the samples of a job must lie: by its faces, its wheel and its tolerance.

Rules of thumb, each from what would be missed otherwise: a contact that lies on too few samples, a face
that has too few, a curved face whose samples' chords are far from it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base import kept
from ..base.kinds import Context, Facts, Floats, Json
from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from . import contact_extents, engine_input
from .engine_input import Elasticity
from .settings import Job, Wheel
from .typed import typed

LOOK, GLANCE = 4000, 400  # samples of a first look at the faces, and of one at their size
MOST = 400_000  # samples, of a spacing that is chosen
COARSEST = 0.5  # mm, of a spacing that is chosen
FINEST = 0.01
SAMPLES_A_CELL = 1.5  # of the contact's grid, at least, each way
CELL_ON_EDGE = 0.75  # of an edge's radius: cells with which force and removal there are within 10 %
LEAST_SHARE_OF_CELL = 0.011  # of a cell that a face covers, to bear pressure
WANTED_CELL = 4.0  # of a face's width, for its cells
ACROSS_CONTACT, ACROSS_FACE = 12, 4  # spacings, of a spacing that is chosen
LEAST_ACROSS_CONTACT, LEAST_ACROSS_FACE = 6, 3  # fewer are warned of
CHORD = 0.1  # of the tolerance's band: between the surface and the chord from sample to sample
LEAST_CHORD = 0.5  # more is warned of
SHARE = 0.98  # of the area: what is more curved, or narrower, is a fillet or a sliver
TOUCHED = 0.75  # of the area on which the contact is as large as it is told, or larger
SMALL = 1000  # bytes of a few figures
FLAT = 1e4  # mm; a larger radius of curvature is a plane
EDGE = 1e-3  # of the area: less that is sharper than the contact's cells is no edge
MOST_ON_PLANE = 2.0  # of the wheel's diameter or width: no contact with its whole cells is larger
WITHIN = 0.05  # of the contact on a plane: a part that is smaller has another unit, probably


def settled(
    job: Json, shape: core.Shape, told: Facts, context: Context = None
) -> tuple[dict[str, Any], bool]:
    """(the job with a spacing: the one that it gives, or else the chosen one; whether it was chosen). What is
    too coarse is added to the list ``told``, as Facts. Raises InputError, Cancelled."""
    read = typed(job)
    faces = [face - 1 for face in read.design.faces] or range(shape.face_count)
    seen = look(read, shape, faces, context)
    given = read.sampling.spacing_mm
    spacing = given or chosen(read, seen)
    told += warnings(read, seen, spacing)
    return {**job, "sampling": {**job["sampling"], "spacing_mm": spacing}}, given == 0


def by_curvature(job: Job | Json) -> bool:
    """Whether samples lie closer together where the faces are curved."""
    job = typed(job)
    return max(job.sampling.precision_mm, job.sampling.edge_spacing_mm) > 0


def look(
    job: Job | Json, shape: core.Shape, faces: Sequence[int], context: Context = None
) -> dict[str, Any]:
    """What the rules need to know of the faces (from 0) of a core.Shape: dict(area mm2, size mm (largest
    extent), radius mm (of curvature; inf: plane), width mm (of the narrowest face that counts), narrow: that
    face from 1, length, breadth mm: the contact's extents on a place as curved as a quarter of the area,
    plane mm: the larger one on a plane; None for a rigid tool, plane also where the faces are so large that nobody
    asks how large it is).
    """
    job = typed(job)
    name = kept.name(shape)
    if name is None:
        seen = _look_at_faces(shape, faces, context)
    else:
        look = lambda: _look_at_faces(shape, faces, context)
        seen = kept.get("look", lambda: (name, list(faces)), look, lambda _: SMALL)
    length, breadth = _contact(job, seen["convex"]) or (None, None)
    wheel = job.belt_machine.wheel
    most = MOST_ON_PLANE * max(2.0 * wheel.radius_mm, wheel.width_mm)
    plane = _contact(job, 0.0) if seen["size"] < WITHIN * most else None
    return {
        **{key: value for key, value in seen.items() if key != "convex"},
        "length": length,
        "breadth": breadth,
        "plane": max(plane) if plane else None,
    }


def _look_at_faces(shape: core.Shape, faces: Sequence[int], context: Context) -> dict[str, Any]:
    """What of ``look`` the faces alone decide; and convex: 1/mm, the curvature at which the contact is looked at."""
    area = _area(shape, faces)
    spacing = math.sqrt(area / LOOK)
    field, _ = core.sample_faces(shape, list(faces), spacing, context=context)
    bend, weights = curvatures(field)
    most = weighted_quantile(np.abs(bend).max(axis=1), weights, SHARE)
    widths = _widths(field)
    order = sorted(widths, key=lambda face: -widths[face][0])
    counted = np.searchsorted(np.cumsum([widths[face][1] for face in order]), SHARE * area)
    narrow = order[min(int(counted), len(order) - 1)]
    return {
        "convex": float(weighted_quantile(np.maximum(bend.max(axis=1), 0.0), weights, TOUCHED)),
        "area": area,
        "size": float(np.ptp(field.points, axis=0).max()),
        "radius": 1.0 / most if most * FLAT > 1.0 else math.inf,
        "width": widths[narrow][0],
        "narrow": narrow + 1,
    }


def size(
    job: Job | Json, shape: core.Shape, faces: Sequence[int], context: Context = None
) -> dict[str, Any]:
    """The size, area and plane of ``look``, which cost less."""
    job = typed(job)
    area = _area(shape, faces)
    field, _ = core.sample_faces(shape, list(faces), math.sqrt(area / GLANCE), context=context)
    plane = _contact(job, 0.0)
    return {
        "area": area,
        "size": float(np.ptp(field.points, axis=0).max()),
        "plane": max(plane) if plane else None,
    }


def _area(shape: core.Shape, faces: Sequence[int]) -> float:
    area = sum(shape.face_area(face) for face in faces)
    if not area > 0:
        raise InputError("job.no_area", "none of the chosen faces has an area")
    return area


def unit_doubts(seen: Json) -> Facts:
    """Facts of faces, by ``look`` or ``size``, that are too small for their unit to be right."""
    if seen["plane"] is None or seen["size"] >= WITHIN * seen["plane"]:
        return []
    return [
        core.Fact(
            "job.within_contact",
            "the faces are only {size:.3g} mm large, the contact of the wheel on a plane {contact:.3g} mm: "
            "check the unit (design.unit_mm)",
            size=seen["size"],
            contact=seen["plane"],
        )
    ]


def chosen(job: Job | Json, seen: Json) -> float:
    """The spacing in mm that the rules give; ``seen``: by ``look``. Raises InputError for faces that are
    too large for the contact to be seen."""
    job = typed(job)
    lower, upper = job.inspection.tolerance_mm
    wanted = [COARSEST, seen["width"] / ACROSS_FACE]
    if seen["length"] is not None:
        wanted.append(min(seen["length"], seen["breadth"]) / ACROSS_CONTACT)
    if upper > lower and not by_curvature(job):
        wanted.append(math.sqrt(8.0 * seen["radius"] * CHORD * (upper - lower)))
    least = max(math.sqrt(seen["area"] / MOST), FINEST)
    across = min(seen["length"] or math.inf, seen["breadth"] or math.inf)
    if least > across:
        raise InputError(
            "job.too_large_for_contact",
            "{key}: the faces are {size:.4g} mm large, the contact of the wheel {contact:.3g} mm: it takes "
            "more than {most} samples to see it there. Check the unit (design.unit_mm), choose fewer faces, "
            "or give a spacing",
            key="sampling.spacing_mm",
            size=seen["size"],
            contact=across,
            most=MOST,
        )
    return float(f"{max(min(wanted), least):.2g}")


def warnings(job: Job | Json, seen: Json, spacing: float) -> Facts:
    """Facts of what is too coarse, or of another unit probably, at a spacing in mm."""
    job = typed(job)
    found = unit_doubts(seen)
    lower, upper = job.inspection.tolerance_mm
    if seen["length"] is not None:
        across = min(seen["length"], seen["breadth"])
        if spacing * LEAST_ACROSS_CONTACT > across:
            found.append(
                core.Fact(
                    "job.few_samples_in_contact",
                    "the samples are {spacing:.3g} mm apart, the contact is {contact:.3g} mm across: what is "
                    "removed may be wrong by far; take {wanted:.2g} mm or less for sampling.spacing_mm",
                    spacing=spacing,
                    contact=across,
                    wanted=across / ACROSS_CONTACT,
                )
            )
        cell = max(job.belt_machine.contact_spacing_mm, SAMPLES_A_CELL * spacing)
        if cell * LEAST_ACROSS_CONTACT / 2.0 > across:
            found.append(
                core.Fact(
                    "job.few_cells_in_contact",
                    "the cells of the contact's grid are {cell:.3g} mm wide, the contact is {contact:.3g} mm "
                    "across; take {wanted:.2g} mm or less for belt_machine.contact_spacing_mm",
                    cell=cell,
                    contact=across,
                    wanted=across / LEAST_ACROSS_CONTACT,
                )
            )
    if spacing * LEAST_ACROSS_FACE > seen["width"]:
        found.append(
            core.Fact(
                "job.few_samples_on_face",
                "the samples are {spacing:.3g} mm apart, Face{face} is {width:.3g} mm wide; take {wanted:.2g} "
                "mm or less for sampling.spacing_mm",
                spacing=spacing,
                face=seen["narrow"],
                width=seen["width"],
                wanted=seen["width"] / ACROSS_FACE,
            )
        )
    chord = min(spacing / (8.0 * seen["radius"]) * spacing, seen["radius"])
    if chord > LEAST_CHORD * (upper - lower) > 0 and not by_curvature(job):
        found.append(
            core.Fact(
                "job.coarse_chords",
                "the samples are {spacing:.3g} mm apart on a radius of {radius:.3g} mm: between them the "
                "surface bulges by {chord:.2g} mm; take {wanted:.2g} mm or less for sampling.spacing_mm",
                spacing=spacing,
                radius=seen["radius"],
                chord=chord,
                wanted=math.sqrt(8.0 * seen["radius"] * CHORD * (upper - lower)),
            )
        )
    return found


def unseen(job: Job | Json, shape: core.Shape, context: Context = None) -> InputError | None:
    """Why a wheel at the part touches nothing: a face that is far narrower than the contact's cells; None: another cause."""
    job = typed(job)
    cell = max(job.belt_machine.contact_spacing_mm, SAMPLES_A_CELL * job.sampling.spacing_mm)
    seen = look(
        job, shape, [face - 1 for face in job.design.faces] or range(shape.face_count), context
    )
    if seen["width"] > LEAST_SHARE_OF_CELL * cell:
        return None
    return InputError(
        "job.narrower_than_cells",
        "the wheel touches nothing: Face{face} is {width:.3g} mm wide, less than cells of {cell:.3g} mm show; take "
        "{wanted:.2g} mm or less for belt_machine.contact_spacing_mm, and {samples:.2g} mm for sampling.spacing_mm",
        face=seen["narrow"],
        width=seen["width"],
        cell=cell,
        wanted=WANTED_CELL * seen["width"],
        samples=WANTED_CELL * seen["width"] / SAMPLES_A_CELL,
    )


def doubted_by(job: Job | Json) -> tuple[float, str | None] | None:
    """All of a job besides its faces and their sampling that ``edge_doubts`` reads, if it is asked at all."""
    job = typed(job)
    machine = job.belt_machine
    if not by_curvature(job):
        return None
    return machine.contact_spacing_mm, machine.kind


def edge_doubts(job: Job | Json, field: core.HeightField) -> Facts:
    """Facts of convex places of a job's core.HeightField that are sharper than the contact's cells are wide:
    what a belt grinds there is not resolved. A wheel's cells follow the noses that it presses on.
    """
    job = typed(job)
    machine = job.belt_machine
    if machine.kind not in ("free_belt", "platen"):
        return []
    cell = max(machine.contact_spacing_mm, SAMPLES_A_CELL * field.spacing)
    bend, areas = curvatures(field)
    sharpest = bend.max(axis=1)
    sharp = sharpest * cell > 1.0
    if not areas[sharp].sum() > EDGE * areas.sum():
        return []
    radius = 1.0 / weighted_quantile(sharpest[sharp], areas[sharp], 0.5)
    return [
        core.Fact(
            "job.few_cells_on_edge",
            "the cells of the contact's grid are {cell:.3g} mm wide on an edge of radius {radius:.2g} mm: force and "
            "removal there may be wrong by half; take {wanted:.2g} mm or less for belt_machine.contact_spacing_mm "
            "and {samples:.2g} mm for sampling.spacing_mm, in a job of the edge's faces alone",
            cell=cell,
            radius=radius,
            wanted=CELL_ON_EDGE * radius,
            samples=CELL_ON_EDGE * radius / SAMPLES_A_CELL,
        )
    ]


def curvatures(field: core.HeightField) -> tuple[Floats, Floats]:
    """(principal curvatures (m, 2) in 1/mm, positive where the surface is convex; areas (m,) in mm2) of the
    triangles of a core.HeightField, by how the normals change along their edges."""
    corners = field.triangles
    p, n = field.points[corners], field.normals.astype(float)[corners]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    cross = np.cross(u, v)
    size, length = np.linalg.norm(cross, axis=1), np.linalg.norm(u, axis=1)
    sound = size > 1e-3 * np.maximum(length, np.linalg.norm(v, axis=1)) ** 2  # no slivers
    u, v, n, cross, size, length = (a[sound] for a in (u, v, n, cross, size, length))
    first = u / length[:, None]
    second = np.cross(cross / size[:, None], first)
    axes = np.stack([first, second], axis=1)  # (m, 2, 3)
    edges = np.stack([u, v], axis=2)
    turns = np.stack([n[:, 1] - n[:, 0], n[:, 2] - n[:, 0]], axis=2)
    shape = (axes @ turns) @ np.linalg.inv(axes @ edges)
    shape = 0.5 * (shape + shape.transpose(0, 2, 1))
    return np.linalg.eigvalsh(shape), 0.5 * size


def _widths(field: core.HeightField) -> dict[int, tuple[float, float]]:
    """{face from 0: (mm, mm2)}: twice the area over the border's length, as of a strip; and the area."""
    corners = field.triangles
    p = field.points[corners]
    areas = 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    border = edges[first[count == 1]]
    lengths = np.linalg.norm(np.diff(field.points[border], axis=1)[:, 0], axis=1)
    faces = np.asarray(field.faces)
    size = int(faces.max()) + 1
    area = np.bincount(faces[corners[:, 0]], areas, size)
    length = np.bincount(faces[border[:, 0]], lengths, size)
    closed = np.sqrt(area)  # of a face without a border
    return {
        int(face): (
            2.0 * area[face] / length[face] if length[face] > 0 else closed[face],
            area[face],
        )
        for face in np.unique(faces[corners[:, 0]])
    }


def _contact(job: Job, curvature: float) -> tuple[float, float] | None:
    """(length along the belt's travel, breadth along the wheel's axis) in mm of the contact on a cylinder of
    ``curvature``, the lesser of those along and across its axis; None for a rigid tool, for a belt without a wheel, or where
    it cannot be found."""
    given = engine_input.of(job)
    machine = given.machine
    if given.elasticity is None or given.rigid:
        return None
    wanted = (
        machine.wheel,
        given.elasticity,
        machine.force_N,
        machine.contact_spacing_mm,
        curvature,
    )
    return kept.get("contact", lambda: wanted, lambda: _extents(*wanted), lambda _: SMALL)


def _extents(
    wheel: Wheel, elasticity: Elasticity, force: float, spacing: float, curvature: float
) -> tuple[float, float] | None:
    found = []
    curved = curvature * FLAT > 1.0
    for angle in (0.0, 90.0) if curved else (0.0,):
        workpiece: dict[str, Any] = {"shape": "plane"}
        if curved:
            workpiece = {"shape": "cylinder", "radius": 1.0 / curvature, "axis_angle_deg": angle}
        try:
            found.append(contact_extents.single(wheel, workpiece, elasticity, force, spacing))
        except ValueError:  # an InputError, or a wheel beyond all bounds: the run tells
            continue
    if not found:
        return None
    lengths, breadths = zip(*found)
    return min(lengths), min(breadths)
