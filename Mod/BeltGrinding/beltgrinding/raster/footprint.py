"""How large the contact is across and along the passes: solved where they lie, or on a cylinder."""

import math

import numpy as np

from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from ..job import contact_extents, engine_input
from . import passes
from .sheets import curvature_along_and_across

FLAT = 1e4  # mm; a larger radius of curvature is a plane
PLACES = 50  # along the passes, at which the contact is solved
FEWEST = 8  # of them that have a whole contact: from fewer nothing is said
ACROSS = 30  # samples across the contact
SAMPLES = 100_000  # on the faces, at most
NARROW = 0.2  # of the places have a contact that is narrower than is said
LONG = 0.8  # of the places have one that is shorter
MOST_CELLS = 100  # across the wheel
MOST_OF_GAPS = 0.98  # of the cells of a contact have a smaller one
COVERED = 0.5  # of a cell that is on the faces


def contact_width(job, settings, surfaces, warnings):
    """Width of the contact across the pass, mm: the job's wheel under the force, by the job's model
    of elasticity, on a cylinder with the faces' median curvature across the passes.
    """
    wheel, compliance, _, options = engine_input.engine_arguments(job)
    if compliance["model"] == "geometric":
        raise InputError(
            "raster.rigid_step_over",
            "{key}: a rigid tool has no contact width; give a step-over in mm",
            key="raster.step_over_mm",
        )
    across, areas = zip(*(curvature_along_and_across(s)[1:] for s in surfaces))
    curvature = weighted_quantile(np.concatenate(across), np.concatenate(areas), 0.5)
    force = settings["force_N"] or options["force"]
    angle = -settings["belt_angle_deg"]  # of the pass against the belt

    def width_on(workpiece):
        spacing, turned = options["contact_spacing"], math.radians(angle)
        found = contact_extents.single(wheel, workpiece, compliance, force, spacing, turned)
        return found[1]

    workpiece = {"shape": "plane"}
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


def plane_extents(job, settings):
    """(mm along the pass, mm across it) of the contact on a plane, of the job's wheel under the force. Under
    position control, the wheel's chord at the depth of the allowance, and a little more, and its width.
    """
    wheel, compliance, _, options = engine_input.engine_arguments(job)
    machine = job["belt_machine"]
    if machine["control"] != "force" or compliance["model"] == "geometric":
        depth = max(job["stock"].get("allowance_mm", 0.0), 0.1)
        return 2.0 * math.sqrt(2.0 * wheel["radius"] * 1.5 * depth), wheel["width"]
    force = settings["force_N"] or options["force"]
    # The pass lies at -belt_angle to the belt's travel.
    angle = -math.radians(settings["belt_angle_deg"])
    spacing = options["contact_spacing"]
    return contact_extents.single(wheel, {"shape": "plane"}, compliance, force, spacing, angle)


def solved(job, shape, faces, levels, settings, plain, context=None):
    """The contact at ``PLACES`` places along passes, solved by the simulator's own contact on the design as it is
    sampled, without stock.

    ``levels``: the passes, lists of dict(points, normals, tangents (n, 3)); ``plain``: mm, of its width, about.
    Returns dict(width_mm: across the pass, that of all but the narrowest share ``NARROW``; length_mm: along it, of
    all but the longest; gap_mm: how far from the undeformed wheel, placed on the design, the outermost of the faces
    are that it touches, of all but the share with the least; widths, lengths (k,) mm), or None where fewer than ``FEWEST`` places have a contact that is
    whole on the faces. Raises InputError, Cancelled.
    """
    if not any(levels):
        return None
    wheel, compliance, _, options = engine_input.engine_arguments(job)
    frames = _places(levels, settings)
    area = sum(shape.face_area(face) for face in faces)
    spacing = max(plain / ACROSS, math.sqrt(area / SAMPLES))
    field, _ = core.sample_faces(shape, list(faces), spacing, context=context)
    force = settings["force_N"] or options["force"]
    fine = min(options["contact_spacing"], max(plain / ACROSS, wheel["width"] / MOST_CELLS))
    options = {**options, "force": force, "contact_spacing": fine, "must_touch": False}
    path = core.ToolPath(
        frames=frames,
        feeds=np.ones(len(frames)),
        forces=np.full(len(frames), force),
        rapid=np.zeros(len(frames), dtype=bool),
        lines=np.zeros(len(frames), dtype=int),
        zones=np.full(len(frames), -1.0),
    )
    angle = -math.radians(settings["belt_angle_deg"])
    sizes, gaps = [], []
    poses = list(range(len(frames)))
    for found in core.contacts_at(field, path, poses, wheel, compliance, options, context):
        if found is not None and _whole(found):
            sizes.append(contact_extents.extents(found, angle))
            gaps.append(_outermost_gap(found))
    if len(sizes) < FEWEST:
        return None
    lengths, widths = np.array(sizes).T
    even = np.ones(len(sizes))
    return {
        "width_mm": weighted_quantile(widths, even, NARROW),
        "length_mm": weighted_quantile(lengths, even, LONG),
        "gap_mm": weighted_quantile(np.array(gaps), even, NARROW),
        "widths": widths,
        "lengths": lengths,
    }


def _places(levels, settings):
    """work_from_contact (k, 4, 4), evenly along all passes."""
    angle = math.radians(settings["belt_angle_deg"])
    pieces = [piece for pieces in levels for piece in pieces]
    frames = [
        passes.contact_frames(piece["points"], piece["normals"], piece["tangents"], angle)
        for piece in pieces
    ]
    ends = np.cumsum([0.0, *(passes.length(piece["points"]) for piece in pieces)])
    found = []
    for place in (np.arange(PLACES) + 0.5) / PLACES * ends[-1]:
        k = min(int(np.searchsorted(ends, place, side="right")) - 1, len(pieces) - 1)
        steps = np.linalg.norm(np.diff(pieces[k]["points"], axis=0), axis=1)
        s = np.concatenate([[0.0], np.cumsum(steps)])
        i = int(np.clip(np.searchsorted(s, place - ends[k], side="right") - 1, 0, len(steps) - 1))
        share = (place - ends[k] - s[i]) / steps[i] if steps[i] > 0.0 else 0.0
        found.append(passes.between(frames[k][i], frames[k][i + 1], np.array([share]))[0])
    return np.array(found)


def _outermost_gap(contact):
    """mm between the undeformed wheel and the work, where it touches, beyond that where they are nearest."""
    gaps = contact["gap"][contact["pressure"] > contact_extents.TOUCHED * contact["pressure"].max()]
    return float(np.quantile(gaps, MOST_OF_GAPS) - gaps.min())


def _whole(contact):
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
