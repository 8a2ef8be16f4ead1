"""The workpiece of a job: its design, the height field of its faces, the stock on it."""

import os
from pathlib import Path

import numpy as np

from ..base import frames, kept
from ..base.files import at_key
from ..engine import InputError, core
from . import inputs, spacing

BELOW = (
    "stock.below_design",
    "stock.negative_allowance",
)  # warnings of stock before something is added
MESH_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".3mf"}
SHAPE_BYTES = 12  # in memory, of a byte of a B-rep's file or text, about; of a mesh's file more
MESH_SHAPE_BYTES = 40
SMALL = 10_000  # bytes, of what has no size to speak of


class OwnBrep(str):
    """The BREP text of a shape that this process has, as a job's "brep": it is read here. Any other
    text is foreign, as files are, and is read by a process of its own."""


def read_design(design, context=None):
    """The design's core.Shape, its loose faces flipped as the job says; a mesh becomes a faceted B-rep.
    Kept for the next who reads the same. Raises InputError, Cancelled."""
    meshed = is_mesh(design)

    def read():
        if meshed:
            mesh = core.read_mesh(design["file"], design["unit_mm"], context=context)
            shape = core.shape_from_mesh(mesh, context)
        else:
            shape = read_shape(design, "design", context)
        return kept.named(flipped(shape, design), parts())

    def parts():
        return made_from(design), design.get("flip_normals"), design.get("flip_faces")

    return kept.get("design", parts, read, lambda _: _shape_bytes(design))


def is_mesh(data):
    """Whether what a job gives as "brep" or as "file" is a mesh's file."""
    return "file" in data and Path(data["file"]).suffix.lower() in MESH_SUFFIXES


def made_from(data):
    """All that ``read_shape`` and core.read_mesh read of what a job gives as "brep" or as "file", for ``kept``."""
    if "brep" in data:
        return [type(data["brep"]).__name__, data["brep"], data.get("unit_mm")]
    return [inputs.file_digest("", data["file"]), data.get("unit_mm")]


def _shape_bytes(data):
    """About what a core.Shape of a job's "brep" or "file" holds."""
    if "brep" in data:
        return SHAPE_BYTES * len(data["brep"])
    each = MESH_SHAPE_BYTES if is_mesh(data) else SHAPE_BYTES
    return each * os.path.getsize(data["file"])


def shape_warnings(shape):
    """What the user should know of a core.Shape, as Facts."""
    name = kept.name(shape)
    if name is None:
        return shape.warnings()
    return kept.get("warnings", lambda: name, shape.warnings, lambda _: SMALL)


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
    """The height field of the job's faces, without stock; the caller's own. Raises InputError, Cancelled."""
    faces = check_faces(job, shape)
    if job["sampling"]["spacing_mm"] == 0:
        job, _ = spacing.settled(job, shape, warnings, context)
    field, told = _sampled(job, shape, faces, context)
    warnings += told
    return field


def _sampled(job, shape, faces, context):
    """(core.HeightField, the caller's own; its warnings)."""
    sampling = job["sampling"]
    name = kept.name(shape)

    def sample():
        field, report = core.sample_faces(
            shape,
            [face - 1 for face in faces],
            sampling["spacing_mm"],
            sampling["depth_mm"],
            context=context,
            precision=sampling["precision_mm"],
            edge_spacing=sampling["edge_spacing_mm"],
        )
        doubts = spacing.edge_doubts(job, field) if spacing.by_curvature(job) else []
        return field, report["warnings"] + doubts

    if name is None:
        return sample()
    parts = lambda: _field_parts(job, name, faces)
    return kept.get("field", parts, sample, _field_bytes, _field_copy)


def _field_parts(job, name, faces):
    return name, faces, job["sampling"], spacing.doubted_by(job)


def _field_bytes(found):
    return found[0].bytes


def make_stocked_field(job, shape, warnings, context, sampled=lambda: None):
    """``make_field`` with the job's stock on it; the caller's own. ``sampled()``: is called between the two.
    Raises InputError, Cancelled."""
    stock, name = job["stock"], kept.name(shape)
    if stock["kind"] == "allowance" or name is None or job["sampling"]["spacing_mm"] == 0:
        field = make_field(job, shape, warnings, context.part(0.0, 0.75))
        sampled()
        apply_stock(field, stock, warnings, context.part(0.75, 1.0))
        return field

    def make():
        told = []
        field = make_field(job, shape, told, context.part(0.0, 0.75))
        sampled()
        apply_stock(field, stock, told, context.part(0.75, 1.0))
        return field, told

    def parts():
        return _field_parts(job, name, check_faces(job, shape)), stock, made_from(stock)

    field, told = kept.get("stock", parts, make, _field_bytes, _field_copy)
    sampled()
    warnings += told
    return field


def _field_copy(found):
    """Of (core.HeightField, warnings), whose field is then the caller's own."""
    return found[0].copy(), found[1]


def apply_stock(field, stock, warnings, context):
    """Puts the stock on the field: where its placement has it, and thicker by its offset."""
    placement = frame_of(stock.get("placement"), "stock.placement")
    moved = not np.array_equal(placement, np.eye(4))
    offset = stock["offset_mm"]
    if stock["kind"] == "allowance":
        report = core.apply_allowance(field, stock["allowance_mm"] + offset)
        added = None
        if moved:
            # As a whole: at first order its thickness changes by the shift along the normal.
            shift = field.points @ placement[:3, :3].T + placement[:3, 3] - field.points
            added = np.einsum("ij,ij->i", field.normals, shift)
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
