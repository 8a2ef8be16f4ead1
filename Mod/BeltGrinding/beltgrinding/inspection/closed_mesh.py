"""The ground part as one closed mesh: STL, PLY and 3MF for those who measure with other tools."""

from __future__ import annotations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Context
from ..engine import InputError, core
from ..job import workpiece
from ..job.tolerances import colour_scale

if TYPE_CHECKING:
    from .ground import Ground

DEFLECTION = 0.05  # mm, chord error on faces that are not ground
SUFFIXES = (".stl", ".ply", ".3mf")
STANDING = ("design", "ground", "missed", "border")  # the values of GroundMesh.standing


def ground_mesh(
    result: Ground, ground: bool = True, deflection_mm: float = DEFLECTION, context: Context = None
) -> core.GroundMesh:
    """core.GroundMesh of a ``simulation.result.Result``: the whole part, its sampled faces displaced by the heights (``ground`` False: as designed).

    Arrays, mm, work frame: ``vertices`` (n, 3), ``triangles`` (m, 3), ``faces`` (m,) from 0,
    ``deviation`` (n,) NaN on faces that are not ground, ``standing`` (n,) an index into
    ``STANDING``. On ground faces the vertices lie as close as the samples; elsewhere the chord
    error is ``deflection_mm``. ``report()`` tells if it is closed. Raises InputError.
    """
    design = result.job["design"]
    return core.ground_mesh(
        workpiece.read_design(design, context),
        result.field,
        ground,
        deflection_mm,
        context=context,
    )


def file_bytes(
    mesh: core.GroundMesh, suffix: str, scale: tuple[float, float, float] | None = None
) -> bytes:
    """The mesh as a file: suffix ".stl" (binary), ".ply" (binary) or ".3mf". scale: (lower, upper,
    limit) mm of the deviation's colours, for PLY and 3MF. Raises InputError for another suffix, and for .3mf where the core was
    built without lib3mf.
    """
    if suffix == ".stl":
        return mesh.stl()
    if suffix == ".ply":
        return mesh.ply(scale)
    if suffix != ".3mf":
        raise InputError(
            "inspection.mesh_suffix",
            "a mesh is written as {suffixes}, not as '{suffix}'",
            suffixes=", ".join(SUFFIXES),
            suffix=suffix,
        )
    return mesh.three_mf(scale)


def write(
    mesh: core.GroundMesh, path: Path | str, scale: tuple[float, float, float] | None = None
) -> None:
    """Writes ``file_bytes``, whole or not at all. Raises InputError."""
    path = Path(path)
    data = file_bytes(mesh, path.suffix.lower(), scale)
    try:
        write_whole(path, data)
    except OSError as error:
        raise cannot_be_written(path, error) from None


def export(
    result: Ground,
    path: Path | str,
    ground: bool = True,
    deflection_mm: float = DEFLECTION,
    context: Context = None,
) -> dict[str, Any]:
    """``ground_mesh`` into a file; returns its ``summary``."""
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(
            "inspection.mesh_file_suffix",
            "{file}: a mesh is written as {suffixes}",
            file=path,
            suffixes=", ".join(SUFFIXES),
        )
    mesh = ground_mesh(result, ground, deflection_mm, context)
    write(mesh, path, colour_scale(result.job))
    return summary(mesh)


def summary(mesh: core.GroundMesh) -> dict[str, Any]:
    """Figures of a mesh, mm, mm2, mm3."""
    report = mesh.report()
    ground, design = report["ground"], report["design"]
    return {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.triangles),
        "closed": ground["closed"],
        "border_edges": ground["border_edges"],
        "non_manifold_edges": ground["non_manifold_edges"],
        "components": ground["components"],
        "euler_characteristic": ground["euler"],
        "volume_mm3": ground["volume"] if ground["closed"] else None,
        "design_volume_mm3": design["volume"] if design["closed"] else None,
        "samples_volume_mm3": report["expected_volume"],
        "area_mm2": ground["area"],
        "turned_triangles": report["flipped"],
        "slid_vertices": report["slid"],
        "missed_vertices": report["missed"],
        "defective_samples": report["defective"],
        "ground_vertices": int(np.count_nonzero(mesh.standing == STANDING.index("ground"))),
        "warnings": report["warnings"],
    }
