"""A scan of the raw part, laid on the design, as the stock of a job: this very casting."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base import frames
from ..base.kinds import Context, Json
from ..engine import InputError, core
from ..job import workpiece
from . import comparison, file as scan_file, start as scan_start, trust

if TYPE_CHECKING:
    from .kinds import Start


class _Raw(NamedTuple):
    """A job whose part is not ground."""

    job: Json
    field: core.HeightField


def as_stock(
    job: Json,
    path: Path | str,
    unit_mm: float = 1.0,
    start: Start | None = None,
    pairs: ArrayLike | None = None,
    datum_faces: Iterable[int] | None = None,
    aligned: bool = False,
    context: Context = None,
) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """(copy of a validated job whose stock is the scan in a mesh file, figures of the alignment or None). It is laid on
    ``datum_faces`` (numbers from 1; None: all faces that are not ground), unless it is ``aligned`` already; start and
    pairs as ``comparison.compare`` takes them. The figures are those of ``comparison.align``.

    Raises InputError: a cloud, or no datum (what is ground cannot tell where its own stock begins), Cancelled.
    """
    scan = scan_file.read(path, unit_mm)
    if scan.triangles is None:
        raise InputError(
            "scan.stock_cloud",
            "{file}: is a cloud of points, and stock must be a surface; mesh it first",
            file=path,
        )
    matrix, found = np.eye(4), None
    if not aligned:
        shape = workpiece.read_design(job["design"], context)
        field = workpiece.make_field(job, shape, [], context)
        surface = comparison.datum(_Raw(job, field), datum_faces, context)
        if surface["predicted"]:
            raise InputError(
                "scan.stock_no_datum",
                "{file}: the scan cannot be laid on faces that are still to be ground, for its stock would be lost; "
                "name datum faces that are finished, or lay the scan on the design elsewhere and say that it is aligned",
                file=path,
            )
        if pairs is not None:
            if start is not None:
                raise InputError(
                    "scan.pairs_and_start", "scan: give pairs of points or a start, not both"
                )
            start, _ = scan_start.by_pairs(pairs, scan.unit_mm)
        found = comparison.align(scan, surface, start)
        if found["turned"]:
            raise InputError(
                "scan.stock_turned",
                "{file}: its triangles look into the part; turn them (reverse the normals) and export it again",
                file=path,
            )
        poor = trust.poor_fit(found["rms_mm"], job["inspection"]["tolerance_mm"])
        found["warnings"] = poor + found["warnings"]
        found["trusted"] = found["trusted"] and not poor
        matrix = found["work_from_scan"]
    placement = {
        "position_mm": matrix[:3, 3].tolist(),
        "quaternion_wxyz": frames.to_quaternions(matrix[None, :3, :3])[0].tolist(),
    }
    stock = {**job["stock"], "kind": "mesh", "file": str(path), "unit_mm": float(unit_mm)}
    for key in ("brep", "left_by"):
        stock.pop(key, None)
    return {**job, "stock": {**stock, "placement": placement}}, found
