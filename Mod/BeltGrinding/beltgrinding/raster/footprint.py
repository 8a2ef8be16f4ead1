"""How large the contact is across and along the passes: solved where they lie, or on a cylinder."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Context, Facts, Floats, Json
from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from ..job import contact_extents
from ..job.settings import Job
from . import passes, tool as tools
from .kinds import Levels
from .sheets import curvature_along_and_across

if TYPE_CHECKING:
    from ..job.engine_input import Elasticity, EngineInput

FLAT = 1e4  # mm; a larger radius of curvature is a plane
PLACES = 50  # along the passes, at which the contact is solved
BELT_PLACES = 16  # of a belt
FEWEST = 8  # of them that have a whole contact: from fewer nothing is said
ACROSS = 30  # samples across the contact
SAMPLES = 100_000  # on the faces, at most
NARROW = 0.2  # of the places have a contact that is narrower than is said
LONG = 0.8  # of the places have one that is shorter
MOST_CELLS = 100  # across the wheel
MOST_OF_GAPS = 0.98  # of the cells of a contact have a smaller one
COVERED = 0.5  # of a cell that is on the faces
BELT_TOLERANCE = 1e-3  # of a belt's pressure
DEEPER = 1.5  # times the allowance: so deep position control presses


def contact_width(
    given: EngineInput, settings: Json, surfaces: Sequence[Json], warnings: Facts
) -> float:
    """Width of the contact across the pass, mm: the wheel of a job's EngineInput under the force, by the job's model
    of elasticity, on a cylinder with the faces' median curvature across the passes.
    """
    machine = given.machine
    assert given.elasticity is not None  # a wheel presses
    elasticity: Elasticity = given.elasticity
    if given.rigid:
        raise InputError(
            "raster.rigid_step_over",
            "{key}: a rigid tool has no contact width; give a step-over in mm",
            key="raster.step_over_mm",
        )
    across, areas = zip(*(curvature_along_and_across(s)[1:] for s in surfaces))
    curvature = weighted_quantile(np.concatenate(across), np.concatenate(areas), 0.5)
    force = settings["force_N"] or machine.force_N
    angle = -settings["belt_angle_deg"]  # of the pass against the belt

    def width_on(workpiece: Json) -> float:
        spacing, turned = machine.contact_spacing_mm, math.radians(angle)
        found = contact_extents.single(machine.wheel, workpiece, elasticity, force, spacing, turned)
        return found[1]

    workpiece: dict[str, Any] = {"shape": "plane"}
    if abs(curvature) * FLAT > 1:
        workpiece = {"shape": "cylinder", "radius": 1.0 / curvature, "axis_angle_deg": angle}
    try:
        return width_on(workpiece)
    except InputError as error:
        if workpiece["shape"] == "plane":  # it is not the surface's curvature
            raise
        warnings.append(
            core.Fact(
                "raster.width_on_a_plane",
                "the contact's width is that on a plane: on a cylinder of {radius:.4g} mm radius "
                "it cannot be found ({reason})",
                radius=1.0 / curvature,
                reason=error,
            )
        )
        return width_on({"shape": "plane"})


def belt_extents(
    job: Job, given: EngineInput, settings: Json, surfaces: Sequence[Json], warnings: Facts
) -> dict[str, Any]:
    """dict(length_mm: along the pass, width_mm: across it, gap_mm: from the flat belt to the part at the contact's edge,
    advance_mm: that the belt gives way) of the contact of a job's free belt or platen on a part with the median curvatures
    of the faces along and across the passes; under position control, of one as deep as the allowance. On a plane it is all
    of the belt between its rollers, or of the platen.
    """
    machine = given.machine
    seen = zip(*map(curvature_along_and_across, surfaces))
    along, across, areas = (np.concatenate(parts) for parts in seen)
    bends = [weighted_quantile(curvature, areas, 0.5) for curvature in (along, across)]
    pressed = {"force": settings["force_N"] or machine.force_N}
    if machine.control != "force":
        pressed = {"approach": DEEPER * max(job.stock.allowance_mm, 0.1)}
    angle = -math.radians(settings["belt_angle_deg"])
    found = core.press_belt(machine, bends[0], bends[1], angle, tolerance=BELT_TOLERANCE, **pressed)
    length, width = contact_extents.extents(found, angle)
    if not found["converged"] or not width > 0.0:
        # The belt as it is: the contacts along the passes are looked at besides.
        warnings.append(
            core.Fact(
                "raster.belt_contact_unknown",
                "the contact's width is that of the belt: on the faces' curvatures of {along:.3g} and {across:.3g} "
                "per mm its contact cannot be found",
                along=bends[0],
                across=bends[1],
            )
        )
        length = width = tools.of(job).width
        return {"length_mm": length, "width_mm": width, "gap_mm": None, "advance_mm": 0.0}
    return {
        "length_mm": length,
        "width_mm": width,
        "gap_mm": _outermost_gap(found),
        "advance_mm": max(float(found["approach"]), 0.0) if machine.control == "force" else 0.0,
    }


def plane_extents(job: Job, given: EngineInput, settings: Json) -> tuple[float, float]:
    """(mm along the pass, mm across it) of the contact on a plane, of the job's wheel under the force. Under
    position control, the wheel's chord at the depth of the allowance, and a little more, and its width.
    """
    machine, elasticity = given.machine, given.elasticity
    wheel = machine.wheel
    if machine.control != "force" or given.rigid:
        depth = max(job.stock.allowance_mm, 0.1)
        return 2.0 * math.sqrt(2.0 * wheel.radius_mm * 1.5 * depth), wheel.width_mm
    assert elasticity is not None  # a wheel presses
    force = settings["force_N"] or machine.force_N
    # The pass lies at -belt_angle to the belt's travel.
    angle = -math.radians(settings["belt_angle_deg"])
    spacing = machine.contact_spacing_mm
    return contact_extents.single(wheel, {"shape": "plane"}, elasticity, force, spacing, angle)


def solved(
    job: Job,
    given: EngineInput,
    shape: core.Shape,
    faces: Sequence[int],
    levels: Levels,
    settings: Json,
    plain: float,
    context: Context = None,
) -> dict[str, Any] | None:
    """The contact at ``PLACES`` places along passes, solved by the simulator's own contact on the design as it is
    sampled, without stock; ``given``: the job's EngineInput.

    ``levels``: the passes, lists of dict(points, normals, tangents (n, 3)); ``plain``: mm, of its width, about.
    Returns dict(width_mm: across the pass, that of all but the narrowest share ``NARROW``; length_mm: along it, of
    all but the longest; gap_mm: how far from the undeformed wheel, placed on the design, the outermost of the faces
    are that it touches, of all but the share with the least; widths, lengths (k,) mm; beyond: share of these that
    are not whole on the faces), or None where fewer than ``FEWEST`` places have one that is. Of a belt, which is often wider
    than the faces, those that are not whole count as well then, by the median of all, and none that has not converged.
    Raises InputError, Cancelled.
    """
    if not any(levels):
        return None
    machine, tool = given.machine, tools.of(job)
    frames = _places(levels, settings, BELT_PLACES if tool.belt else PLACES)
    area = sum(shape.face_area(face) for face in faces)
    spacing = max(plain / ACROSS, math.sqrt(area / SAMPLES))
    field, _ = core.sample_faces(shape, list(faces), spacing, context=context)
    force = settings["force_N"] or machine.force_N
    if isinstance(tool, tools.Belt):
        machine = tool.coarse(machine)
    else:
        fine = max(plain / ACROSS, tool.width / MOST_CELLS)
        machine = replace(machine, contact_spacing_mm=min(machine.contact_spacing_mm, fine))
    given = replace(given, machine=replace(machine, force_N=force), must_touch=False)
    path = core.ToolPath(
        frames=frames,
        feeds=np.ones(len(frames)),
        forces=np.full(len(frames), force),
        rapid=np.zeros(len(frames), dtype=bool),
        lines=np.zeros(len(frames), dtype=int),
        zones=np.full(len(frames), -1.0),
    )
    angle = -math.radians(settings["belt_angle_deg"])
    whole: list[tuple[float, float, float]] = []
    cut_off: list[tuple[float, float, float]] = []
    poses = list(range(len(frames)))
    for found in core.contacts_at(field, path, poses, given, context):
        if found is None or not found["pressure"].max(initial=0.0) > 0.0:
            continue
        if tool.belt and not found["converged"]:  # its extents are of no use
            continue
        some = whole if _whole(found) else cut_off
        some.append((*contact_extents.extents(found, angle), _outermost_gap(found)))
    narrow, long, counted = NARROW, LONG, whole
    if tool.belt and len(whole) < FEWEST:
        narrow, long, counted = 0.5, 0.5, whole + cut_off
    if len(counted) < FEWEST:
        return None
    lengths, widths, gaps = np.array(counted).T
    even = np.ones(len(counted))
    return {
        "width_mm": weighted_quantile(widths, even, narrow),
        "length_mm": weighted_quantile(lengths, even, long),
        "gap_mm": weighted_quantile(gaps, even, narrow),
        "widths": widths,
        "lengths": lengths,
        "beyond": 1.0 - len(whole) / len(counted),
    }


def _places(levels: Levels, settings: Json, count: int) -> Floats:
    """work_from_contact (count, 4, 4), evenly along all passes."""
    angle = math.radians(settings["belt_angle_deg"])
    pieces = [piece for pieces in levels for piece in pieces]
    frames = [
        passes.contact_frames(piece["points"], piece["normals"], piece["tangents"], angle)
        for piece in pieces
    ]
    ends = np.cumsum([0.0, *(passes.length(piece["points"]) for piece in pieces)])
    found = []
    for place in (np.arange(count) + 0.5) / count * ends[-1]:
        k = min(int(np.searchsorted(ends, place, side="right")) - 1, len(pieces) - 1)
        steps = np.linalg.norm(np.diff(pieces[k]["points"], axis=0), axis=1)
        s = np.concatenate([[0.0], np.cumsum(steps)])
        i = int(np.clip(np.searchsorted(s, place - ends[k], side="right") - 1, 0, len(steps) - 1))
        share = (place - ends[k] - s[i]) / steps[i] if steps[i] > 0.0 else 0.0
        found.append(passes.between(frames[k][i], frames[k][i + 1], np.array([share]))[0])
    return np.array(found)


def _outermost_gap(contact: Json) -> float:
    """mm between the undeformed wheel and the work, where it touches, beyond that where they are nearest."""
    gaps = contact["gap"][contact["pressure"] > contact_extents.TOUCHED * contact["pressure"].max()]
    return float(np.quantile(gaps, MOST_OF_GAPS) - gaps.min())


def _whole(contact: Json) -> bool:
    """Whether a contact lies on the faces with all its sides: none of its outermost cells is on their border."""
    pressed = contact["pressure"] > contact_extents.TOUCHED * contact["pressure"].max()
    if not contact["pressure"].max() > 0.0:
        return False
    off = contact["coverage"] < COVERED
    beside = np.zeros_like(off)
    for axis in (0, 1):
        for step in (-1, 1):
            beside |= np.roll(off, step, axis=axis)
    return not (pressed & (off | beside)).any()
