"""Plans a job's feeds here and now, and applies what was found. Offered by ``api``."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCAD

from ..base.kinds import Context
from ..engine import InputError
from . import job_inputs, plan as planned, runs
from .creation import make_child, removed_on_error
from .job_data import child
from .kinds import DocumentObject

if TYPE_CHECKING:
    from ..planning.grinding import Ground
    from ..simulation.result import Result


def make_plan(
    job: DocumentObject, compute: bool = True, context: Context = None, **properties: Any
) -> DocumentObject:
    """Plans the feeds (and, where ``ForceMin`` or ``ForceMax`` is set, the forces) with which the job keeps its
    tolerance, with ``LayPasses`` the passes, too (searched for ``SearchSeconds`` on all cores, 0: by rules alone), and
    keeps them in its Plan object, which it returns; ``apply_plan`` puts them into the paths.
    ``compute=False`` only makes the object. ``properties``: settings (docs/planning-settings.md) by the names of the
    properties. Raises InputError, Cancelled.
    """
    label, before = FreeCAD.Qt.translate("BeltGrinding", "Plan"), child(job, planned.Plan)
    obj = make_child(job, planned.Plan, "Plan", label, properties)
    if compute:
        with ExitStack() as undo:
            if before is None:
                undo.enter_context(removed_on_error(obj))
            with job_inputs.scratch_folder() as folder:
                data = job_inputs.to_data(job, folder)
                work = planned.Work(obj, job)
                planned.store(obj, job, work.find(data, context))
    return obj


def apply_plan(
    plan: DocumentObject, result: Result | None = None, ground: Ground | None = None
) -> DocumentObject:
    """Gives the paths of a Plan's job the planned feeds and forces, in place of their own and of one feed or force for
    all; where it lays passes, these, too. ``result``: the Result of the planned job, which becomes the job's; without it
    the job's result goes out of date. ``ground``: as ``plan.put_in`` takes it. Raises InputError; then nothing is
    changed.
    """
    planned.put_in(plan, ground)
    job = plan.getParentGroup()
    if result is not None:
        runs.store_result(job, result, job_inputs.fingerprint(job))
    else:
        job.touch()
        job.Document.recompute()
    return plan


def write_plan(plan: DocumentObject, folder: Path | str) -> tuple[list[Path], list[str]]:
    """Writes the programs' files of a Plan's job with the planned feeds and forces into ``folder``; nothing else of
    them changes. Returns (paths written, labels of paths that were not read from a file). Raises InputError.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError("planning.no_folder", "{folder}: is no folder", folder=folder)
    return planned.write_programs(plan, folder)
