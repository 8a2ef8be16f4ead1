"""A scan of the raw part, in the stock's file: laid on the design, so that the job has this very casting."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..base.kinds import Context, Floats, Json
from ..engine import InputError
from ..scan import stock as scan_stock
from . import job_inputs
from .geometry import placement_from_job
from .job_data import child
from .kinds import DocumentObject
from .stock import Stock


def prepare(job: DocumentObject) -> tuple[DocumentObject, dict[str, Any], Floats | None]:
    """(Stock object, job as data, where the file's mesh lies (4, 4) or None where it is not placed). Raises InputError where
    the stock is no mesh's file."""
    stock = child(job, Stock)
    if stock is None or stock.Kind != "mesh" or stock.Source is not None or not stock.File:
        raise InputError(
            "objects.stock_no_scan",
            "{object}: its stock is no mesh's file, so that there is no scan to lay on the design",
            object=job.Label,
        )
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.without_programs(job, folder)
    start = np.reshape(stock.FilePlacement.toMatrix().A, (4, 4))
    return stock, data, None if stock.FilePlacement.isIdentity() else start


def align(
    data: Json, file: Path | str, unit_mm: float, context: Context = None, **options: Any
) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """(the stock's place as a job has it, figures of the alignment); ``options``: of ``scan.stock.as_stock``."""
    laid, found = scan_stock.as_stock(data, file, unit_mm, context=context, **options)
    return laid["stock"]["placement"], found


def lay_stock(job: DocumentObject, **options: Any) -> dict[str, Any] | None:
    """Lays the scan in the stock's file on the design, from where it is placed; returns the figures of the alignment.
    ``options``: of ``scan.stock.as_stock`` (start, pairs, datum_faces)."""
    stock, data, start = prepare(job)
    if start is not None and not {"start", "pairs"} & set(options):
        options["start"] = start
    placement, found = align(data, stock.File, stock.FileUnit, **options)
    stock.FilePlacement = placement_from_job(placement)
    job.Document.recompute()
    return found
