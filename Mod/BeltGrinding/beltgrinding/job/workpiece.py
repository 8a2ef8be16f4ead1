"""The workpiece of a job: its design, the height field of its faces, the stock on it."""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias, Union

import numpy as np

from ..base import frames, kept, records
from ..base.files import at_key
from ..base.kinds import Context, Facts, Floats, Json, known
from ..engine import InputError, core
from . import inputs, sizes, spacing
from .settings import Body, Design, Frame, Job, Stock
from .typed import typed

Given: TypeAlias = Union[Design, Stock, Body, Json]  # which may say where a body comes from

BELOW = (
    "stock.below_design",
    "stock.negative_allowance",
)  # warnings of stock before something is added
MESH_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".3mf"}
SHAPE_BYTES = 12  # in memory, of a byte of a B-rep's file or text, about; of a mesh's file more
MESH_SHAPE_BYTES = 40
SMALL = 10_000  # bytes, of what has no size to speak of
_of_mesh: weakref.WeakKeyDictionary[
    core.Shape, Facts
] = weakref.WeakKeyDictionary()  # what was found out while a shape's mesh was read, Facts


class OwnBrep(str):
    """The BREP text of a shape that this process has, as a job's "brep": it is read here. Any other
    text is foreign, as files are, and is read by a process of its own."""


class Source(NamedTuple):
    """Where a body of a job comes from."""

    file: str | None
    brep: str | None
    unit_mm: float | None


def source(data: Given) -> Source:
    """Of a job's design, stock or body of the cell."""
    if isinstance(data, Mapping):
        return Source(data.get("file"), data.get("brep"), data.get("unit_mm"))
    return Source(data.file, data.brep, data.unit_mm)


def read_design(design: Given, context: Context = None) -> core.Shape:
    """The design's core.Shape, its loose faces flipped as the job says; a mesh becomes a faceted B-rep.
    Kept for the next who reads the same. Raises InputError, Cancelled."""
    meshed = is_mesh(design)

    def read() -> core.Shape:
        if meshed:
            told: dict[str, Any] = {}
            file, _, unit = source(design)
            mesh = core.read_mesh(known(file), known(unit), context=context, report=told)
            shape = flipped(core.shape_from_mesh(mesh, context), design)
            _of_mesh[shape] = told["warnings"]
        else:
            shape = flipped(read_shape(design, "design", context), design)
        return kept.named(shape, parts())

    def parts() -> tuple[Any, ...]:
        return made_from(design), *_flips(design)

    return kept.get("design", parts, read, lambda _: _shape_bytes(design))


def _flips(design: Given) -> tuple[bool, Sequence[int]]:
    """(whether all normals are flipped, faces from 1 that are); of a design alone."""
    if isinstance(design, Mapping):
        return bool(design.get("flip_normals")), design.get("flip_faces") or ()
    return (design.flip_normals, design.flip_faces) if isinstance(design, Design) else (False, ())


def is_mesh(data: Given) -> bool:
    """Whether what a job gives as "brep" or as "file" is a mesh's file."""
    file = source(data).file
    return file is not None and Path(file).suffix.lower() in MESH_SUFFIXES


def made_from(data: Given) -> list[Any]:
    """All that ``read_shape`` and core.read_mesh read of what a job gives as "brep" or as "file", for ``kept``."""
    file, brep, unit = source(data)
    if brep is not None:
        return [type(brep).__name__, brep, unit]
    return [inputs.file_digest("", known(file)), unit]


def _shape_bytes(data: Given) -> float:
    """About what a core.Shape of a job's "brep" or "file" holds."""
    file, brep, _ = source(data)
    if brep is not None:
        return SHAPE_BYTES * len(brep)
    each = MESH_SHAPE_BYTES if is_mesh(data) else SHAPE_BYTES
    return each * os.path.getsize(known(file))


def shape_warnings(shape: core.Shape) -> Facts:
    """What the user should know of a core.Shape, as Facts."""
    name, read = kept.name(shape), _of_mesh.get(shape, [])
    if name is None:
        return read + shape.warnings()
    return read + kept.get("warnings", lambda: name, shape.warnings, lambda _: SMALL)


def flipped(shape: core.Shape, design: Given) -> core.Shape:
    """A core.Shape with the loose faces flipped that a job's design names. Raises InputError."""
    whole, faces = _flips(design)
    if not (faces or whole):
        return shape
    try:
        return shape.flipped(whole, [face - 1 for face in faces])
    except InputError as error:
        raise at_key(error, "design.flip_faces") from None


def read_shape(data: Given, name: str, context: Context = None) -> core.Shape:
    """core.Shape of what a job gives as "brep" or as "file". Raises InputError, Cancelled."""
    file, brep, unit = source(data)
    scale = 1.0 if unit is None else unit
    if brep is None:
        return core.Shape.read(known(file), context, scale)
    if isinstance(brep, OwnBrep):
        return core.Shape.from_brep(brep, name, scale)
    return core.Shape.read_brep(brep, name, context, scale)


def check_faces(job: Job | Json, shape: core.Shape) -> Sequence[int]:
    """The job's list of faces, from 1. Raises InputError for one that the shape lacks."""
    job = typed(job)
    faces = job.design.faces
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


def make_field(
    job: Job | Json, shape: core.Shape, warnings: Facts, context: Context
) -> core.HeightField:
    """The height field of the job's faces, without stock; the caller's own. Raises InputError, Cancelled."""
    job = typed(job)
    faces = check_faces(job, shape)
    if job.sampling.spacing_mm == 0:
        job = typed(spacing.settled(records.plain(job), shape, warnings, context)[0])
    field, told = _sampled(job, shape, faces, context)
    warnings += told
    return field


def _sampled(
    job: Job, shape: core.Shape, faces: Sequence[int], context: Context
) -> tuple[core.HeightField, Facts]:
    """(core.HeightField, the caller's own; its warnings)."""
    sampling = job.sampling
    name = kept.name(shape)

    def sample() -> tuple[core.HeightField, Facts]:
        field, report = core.sample_faces(
            shape,
            [face - 1 for face in faces],
            sampling.spacing_mm,
            sampling.depth_mm,
            context=context,
            precision=sampling.precision_mm,
            edge_spacing=sampling.edge_spacing_mm,
        )
        doubts = spacing.edge_doubts(job, field) if spacing.by_curvature(job) else []
        return field, report["warnings"] + doubts

    if name is None:
        return sample()
    parts = lambda: _field_parts(job, name, faces)
    return kept.get("field", parts, sample, _field_bytes, _field_copy)


def _field_parts(job: Job, name: str | None, faces: Sequence[int]) -> tuple[Any, ...]:
    return name, faces, job.sampling, spacing.doubted_by(job)


def _field_bytes(found: tuple[core.HeightField, Facts]) -> int:
    return found[0].bytes


def make_stocked_field(
    job: Job | Json,
    shape: core.Shape,
    warnings: Facts,
    context: core.RunContext,
    sampled: Callable[[], None] = lambda: None,
) -> core.HeightField:
    """``make_field`` with the job's stock on it; the caller's own. ``sampled()``: is called between the two.
    Raises InputError, Cancelled."""
    read = typed(job)
    stock, name = read.stock, kept.name(shape)
    _refuse_moved(stock)
    quick = stock.kind == "allowance" and stock.left_by is None
    finish = read.finish is not None and read.law.model != "geometric"
    if quick or name is None or read.sampling.spacing_mm == 0:
        field = make_field(read, shape, warnings, context.part(0.0, 0.75))
        sampled()
        apply_stock(field, stock, warnings, context.part(0.75, 1.0), shape, finish)
        return field

    def make() -> tuple[core.HeightField, Facts]:
        told: Facts = []
        field = make_field(read, shape, told, context.part(0.0, 0.75))
        sampled()
        apply_stock(field, stock, told, context.part(0.75, 1.0), shape, finish)
        return field, told

    def parts() -> tuple[Any, ...]:
        sampled_by = _field_parts(read, name, check_faces(read, shape))
        if stock.left_by is None:
            return sampled_by, stock, made_from(stock)
        return sampled_by, finish, inputs.file_digest("", stock.left_by)

    field, told = kept.get("stock", parts, make, _field_bytes, _field_copy)
    sampled()
    warnings += told
    return field


def _field_copy(found: tuple[core.HeightField, Facts]) -> tuple[core.HeightField, Facts]:
    """Of (core.HeightField, warnings), whose field is then the caller's own."""
    return found[0].copy(), found[1]


def _refuse_moved(stock: Stock) -> None:
    """Raises InputError where what an earlier run left is to lie elsewhere, or thicker: it is on the part already."""
    if stock.left_by is None:
        return
    moved = not np.array_equal(frame_of(stock.placement, "stock.placement"), np.eye(4))
    for given, key in ((stock.offset_mm != 0.0, "offset_mm"), (moved, "placement")):
        if given:
            raise InputError(
                "job.left_moved",
                "{key}: what an earlier run left is where it is and as thick as it is; take the key out",
                key=f"stock.{key}",
            )


def apply_stock(
    field: core.HeightField,
    stock: Stock | Json,
    warnings: Facts,
    context: Context,
    shape: core.Shape | None = None,
    finish: bool = False,
) -> None:
    """Puts the stock on the field: where its placement has it, and thicker by its offset; or what an earlier run left, with
    its ``finish`` if that is wanted. ``shape``: the design, which a mesh is compared with in size. Raises InputError,
    Cancelled."""
    stock = records.made(Stock, stock)
    _refuse_moved(stock)
    if stock.left_by is not None:
        left, _ = core.HeightField.from_hdf5(stock.left_by)
        warnings += core.apply_left(field, left, finish, known(context))["warnings"]
        return
    placement = frame_of(stock.placement, "stock.placement")
    moved = not np.array_equal(placement, np.eye(4))
    offset, unit = stock.offset_mm, 1.0
    if stock.kind == "allowance":
        report = core.apply_allowance(field, stock.allowance_mm + offset)
        added = None
        if moved:
            # As a whole: at first order its thickness changes by the shift along the normal.
            shift = field.points @ placement[:3, :3].T + placement[:3, 3] - field.points
            added = np.einsum("ij,ij->i", field.normals, shift)
    else:
        if stock.kind == "mesh":
            of_mesh: dict[str, Any] = {}
            mesh = core.read_mesh(known(stock.file), stock.unit_mm, placement, context, of_mesh)
            unit = of_mesh["unit_mm"]
            warnings += of_mesh["warnings"]
            if shape is not None:
                try:
                    sizes.check_box(mesh.vertices, shape, unit, stock.search_above_mm)
                except InputError as error:
                    raise at_key(error, "stock.unit_mm") from None
        else:
            shape = read_design(stock, context)
            warnings += [
                core.Fact("job.of_stock", "stock: {warning}", warning=text)
                for text in shape.warnings()
            ]
            mesh = core.triangulate(shape, stock.deflection_mm, context)
            if moved:
                points = mesh.vertices @ placement[:3, :3].T + placement[:3, 3]
                mesh = core.TriangleMesh(points.astype(np.float32), mesh.triangles)
        report = core.apply_mesh(
            field,
            mesh,
            stock.search_above_mm,
            stock.search_below_mm,
            context,
            unit_mm=unit,
        )
        added = np.full(field.size, offset) if offset else None
    told = report["warnings"]
    if added is not None:
        told = [fact for fact in told if fact.code not in BELOW]
        told += core.add_stock(field, added)["warnings"]
    warnings += told


def frame_of(data: Frame | Json | None, where: str) -> Floats:
    """(4, 4), mm: the transform that a job gives under the key ``where``. Raises InputError."""
    try:
        return frames.from_data(records.plain(data))
    except InputError as error:
        raise at_key(error, where) from None
