"""The workpiece of a job: its design, the height field of its faces, the stock on it."""

from pathlib import Path

from ..base import frames
from ..engine import InputError, core

MESH_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".3mf"}


def read_design(design):
    """The design's core.Shape; a mesh becomes a faceted B-rep."""
    if "brep" in design:
        return core.Shape.from_brep(design["brep"], "design")
    if Path(design["file"]).suffix.lower() in MESH_SUFFIXES:
        return core.shape_from_mesh(core.read_mesh(design["file"], design["unit_mm"]))
    return core.Shape.read(design["file"])


def make_field(job, shape, warnings, context):
    """The height field of the job's faces, without stock."""
    faces = job["design"]["faces"]
    for face in faces:
        if face > shape.face_count:
            raise InputError(
                f"design.faces: there is no face {face}; the shape has {shape.face_count}"
            )
    field, report = core.sample_faces(
        shape,
        [face - 1 for face in faces],
        job["sampling"]["spacing_mm"],
        job["design"]["flip_normals"],
        job["sampling"]["depth_mm"],
        context=context,
    )
    warnings += report["warnings"]
    return field


def apply_stock(field, stock, warnings, context):
    """Puts the stock on the field."""
    if stock["kind"] == "allowance":
        report = core.apply_allowance(field, stock["allowance_mm"])
    else:
        if stock["kind"] == "mesh":
            placement = frame_of(stock.get("placement"), "stock.placement")
            mesh = core.read_mesh(stock["file"], stock["unit_mm"], placement)
        else:
            shape = read_design(stock)
            warnings += [f"stock: {text}" for text in shape.warnings()]
            mesh = core.triangulate(shape, stock["deflection_mm"], context)
        report = core.apply_mesh(
            field, mesh, stock["search_above_mm"], stock["search_below_mm"], context
        )
    warnings += report["warnings"]


def frame_of(data, where):
    """(4, 4), mm: the transform that a job gives under the key ``where``. Raises InputError."""
    try:
        return frames.from_data(data)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
