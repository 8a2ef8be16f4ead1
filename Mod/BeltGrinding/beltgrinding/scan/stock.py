"""A scan of the raw part, laid on the design, as the stock of a job: this very casting."""

from types import SimpleNamespace

import numpy as np

from ..base import frames
from ..engine import InputError, core
from ..job import workpiece
from . import comparison, file as scan_file, start as scan_start, trust


def as_stock(
    job,
    path,
    unit_mm=1.0,
    start=None,
    pairs=None,
    datum_faces=None,
    aligned=False,
    context=None,
):
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
        surface = comparison.datum(SimpleNamespace(job=job, field=field), datum_faces, context)
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
            start, _ = scan_start.by_pairs(pairs, unit_mm)
        found = comparison.align(scan, surface, start)
        poor = trust.poor_fit(found["rms_mm"], job["inspection"]["tolerance_mm"])
        found["warnings"] = poor + found["warnings"]
        found["trusted"] = found["trusted"] and not poor
        matrix = found["work_from_scan"]
    placement = {
        "position_mm": matrix[:3, 3].tolist(),
        "quaternion_wxyz": frames.to_quaternions(matrix[None, :3, :3])[0].tolist(),
    }
    stock = {**job["stock"], "kind": "mesh", "file": str(path), "unit_mm": float(unit_mm)}
    stock.pop("brep", None)
    return {**job, "stock": {**stock, "placement": placement}}, found
