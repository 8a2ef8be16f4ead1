"""Grinds a job here and now, and keeps results in its Simulation. Offered by ``api``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..base.kinds import Context
from ..simulation import convergence, run as runs
from ..simulation.result import Result
from . import fields, job_inputs, simulation as results
from .job_data import child
from .kinds import DocumentObject

if TYPE_CHECKING:
    from .result_files import Written


def simulate(
    job: DocumentObject, context: Context = None, write_to: Path | str | None = None
) -> DocumentObject:
    """Grinds the job here and now; returns its Simulation object. ``write_to``: a folder for the
    files that ``beltgrind run`` writes.
    """
    with job_inputs.scratch_folder() as folder:
        result = runs.run(job_inputs.to_data(job, folder), context)
    if write_to is not None:
        result.write(write_to)
    return store_result(job, result, job_inputs.fingerprint(job))


def store_result(
    job: DocumentObject, result: Result, fingerprint: str, files: Written | None = None
) -> DocumentObject:
    """Puts a run's ``Result`` into the job's Simulation and returns that. ``fingerprint``: of the
    inputs that the run had (``job_object.fingerprint``); the job marks others as out of date. ``files``:
    what ``simulation.files_of`` gives, if it is there already.
    """
    simulation = child(job, results.Simulation)
    if simulation is None:
        simulation = job.Document.addObject("App::FeaturePython", "Simulation")
        results.Simulation(simulation)
        job.addObject(simulation)
    results.store(simulation, result, fingerprint, files)
    fields.keep(simulation, result.field)
    simulation.touch()
    job.Document.recompute()
    return simulation


def import_result(job: DocumentObject, folder: Path | str) -> DocumentObject:
    """Brings back what ``beltgrind run`` wrote to ``folder`` for this job. A result of other inputs
    is marked out of date.
    """
    result = Result.read(folder)
    with job_inputs.scratch_folder() as scratch:
        same = job_inputs.same_inputs(job_inputs.to_data(job, scratch), result.job)
    return store_result(job, result, job_inputs.fingerprint(job) if same else "other inputs")


def check_settings(job: DocumentObject, context: Context = None) -> DocumentObject:
    """Runs the job coarser, as given and finer, here and now; keeps result and answer in its
    Simulation, which it returns. See ``beltgrinding.converge``.
    """
    with job_inputs.scratch_folder() as folder:
        result = convergence.converge(job_inputs.to_data(job, folder), context)
    return store_result(job, result, job_inputs.fingerprint(job))
