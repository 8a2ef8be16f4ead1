"""The workpiece of a job: its design, the height field of its faces, the stock on it."""

from pathlib import Path

import numpy as np

from ..base import frames
from ..base.files import at_key
from ..engine import InputError, core
from . import spacing

BELOW = (
    "stock.below_design",
    "stock.negative_allowance",
)  # warnings of stock before something is added
MESH_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".3mf"}


class OwnBrep(str):
    """The BREP text of a shape that this process has, as a job's "brep": it is read here. Any other
    text is foreign, as files are, and is read by a process of its own."""


def read_design(design, context=None):
    """The design's core.Shape, its loose faces flipped as the job says; a mesh becomes a faceted B-rep.
    Raises InputError, Cancelled."""
    if "file" in design and Path(design["file"]).suffix.lower() in MESH_SUFFIXES:
        mesh = core.read_mesh(design["file"], design["unit_mm"], context=context)
        shape = core.shape_from_mesh(mesh, context)
    else:
        shape = read_shape(design, "design", context)
    return flipped(shape, design)


def flipped(shape, design):
    """A core.Shape with the loose faces flipped that a job's design names. Raises InputError."""
    faces = design.get("flip_faces", [])
    if not (faces or design.get("flip_normals")):
        return shape
    try:
        return shape.flipped(design.get("flip_normals", False), [face - 1 for face in faces])
    except InputError as error:
        raise at_key(error, "design.flip_faces") from None


def read_shape(data, name, context=None):
    """core.Shape of what a job gives as "brep" or as "file". Raises InputError, Cancelled."""
    scale = data.get("unit_mm", 1.0)
    if "brep" not in data:
        return core.Shape.read(data["file"], context, scale)
    if isinstance(data["brep"], OwnBrep):
        return core.Shape.from_brep(data["brep"], name, scale)
    return core.Shape.read_brep(data["brep"], name, context, scale)


def check_faces(job, shape):
    """The job's list of faces, from 1. Raises InputError for one that the shape lacks."""
    faces = job["design"]["faces"]
    for face in faces:
        if face > shape.face_count:
            raise InputError(
                "job.no_such_face",
                "{key}: there is no face {face}; the shape has {count}",
                key="design.faces",
                face=face,
                count=shape.face_count,
            )
    return faces


def make_field(job, shape, warnings, context):
    """The height field of the job's faces, without stock."""
    faces = check_faces(job, shape)
    if job["sampling"]["spacing_mm"] == 0:
        job, _ = spacing.settled(job, shape, warnings, context)
    sampling = job["sampling"]
    field, report = core.sample_faces(
        shape,
        [face - 1 for face in faces],
        sampling["spacing_mm"],
        sampling["depth_mm"],
        context=context,
        precision=sampling["precision_mm"],
        edge_spacing=sampling["edge_spacing_mm"],
    )
    warnings += report["warnings"]
    if spacing.by_curvature(job):
        warnings += spacing.edge_doubts(job, field)
    return field


def apply_stock(field, stock, warnings, context):
    """Puts the stock on the field: where its placement has it, and thicker by its offset."""
    placement = frame_of(stock.get("placement"), "stock.placement")
    moved = not np.array_equal(placement, np.eye(4))
    offset = stock["offset_mm"]
    if stock["kind"] == "allowance":
        report = core.apply_allowance(field, stock["allowance_mm"] + offset)
        # A layer that is moved as a whole: at first order its thickness changes by the shift along the normal.
        shift = field.points @ placement[:3, :3].T + placement[:3, 3] - field.points
        added = np.einsum("ij,ij->i", field.normals, shift) if moved else None
    else:
        if stock["kind"] == "mesh":
            mesh = core.read_mesh(stock["file"], stock["unit_mm"], placement, context)
        else:
            shape = read_design(stock, context)
            warnings += [
                core.Fact("job.of_stock", "stock: {warning}", warning=text)
                for text in shape.warnings()
            ]
            mesh = core.triangulate(shape, stock["deflection_mm"], context)
            if moved:
                points = mesh.vertices @ placement[:3, :3].T + placement[:3, 3]
                mesh = core.TriangleMesh(points.astype(np.float32), mesh.triangles)
        report = core.apply_mesh(
            field,
            mesh,
            stock["search_above_mm"],
            stock["search_below_mm"],
            context,
            unit_mm=stock["unit_mm"] if stock["kind"] == "mesh" else 1.0,
        )
        added = np.full(field.size, offset) if offset else None
    told = report["warnings"]
    if added is not None:
        told = [fact for fact in told if fact.code not in BELOW]
        told += core.add_stock(field, added)["warnings"]
    warnings += told


def frame_of(data, where):
    """(4, 4), mm: the transform that a job gives under the key ``where``. Raises InputError."""
    try:
        return frames.from_data(data)
    except InputError as error:
        raise at_key(error, where) from None
