"""Runs a job's study here and now, and sets the job to one of its runs. Offered by ``api``."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import FreeCAD

from ..base.kinds import Context
from . import job_inputs, study as studies
from .creation import make_child, removed_on_error
from .job_data import child
from .kinds import DocumentObject

if TYPE_CHECKING:
    from ..studies.making import Progress
    from .study import Opened


def make_study(
    job: DocumentObject,
    compute: bool = True,
    context: Context = None,
    told: Callable[[Progress], object] | None = None,
    **properties: Any,
) -> DocumentObject:
    """Runs a study of the job and keeps its table and answers in its Study object, which it returns. ``Vary``: what varies,
    as JSON or as a list of dict, as a study.json has it (docs/study.md); ``compute=False`` only makes the object;
    ``told(Progress)``: is called now and then; other ``properties`` by their names. Raises InputError, Cancelled.
    """
    for name in ("Vary", "Correlations", "Asked"):
        if name in properties and not isinstance(properties[name], str):
            properties[name] = json.dumps(properties[name], allow_nan=False)
    label, before = FreeCAD.Qt.translate("BeltGrinding", "Study"), child(job, studies.Study)
    obj = make_child(job, studies.Study, "Study", label, properties)
    if compute:
        with ExitStack() as undo:
            if before is None:
                undo.enter_context(removed_on_error(obj))
            with job_inputs.scratch_folder() as folder:
                data = job_inputs.to_data(job, folder)
                obj.Proxy.update(obj)
                work = studies.Work(obj, job)
                studies.store(obj, work.find(data, context, told))
    return obj


def open_study_run(study: DocumentObject, number: int) -> Opened:
    """Sets the job of a Study to what run ``number`` of its table had; its simulation goes out of date. Returns (names of
    what varies that the document has no property for, which stay as they are; labels of raster paths that were laid anew
    for the settings, so that a simulation may give other figures than the table). Raises InputError; then nothing is
    changed."""
    return studies.open_run(study, number)
