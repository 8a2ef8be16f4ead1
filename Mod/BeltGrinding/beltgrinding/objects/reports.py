"""What a macro calls to tell others of a job's result: report, figures."""

from __future__ import annotations

import json
from pathlib import Path

import FreeCAD

from ..engine import InputError
from ..reporting import report as reporting
from ..simulation.result import Result
from . import figures, job_inputs, report_data
from .kinds import DocumentObject, Sheet
from .simulation import simulated
from .verdict import limits_changed, verdict_of


def make_figures_page(job: DocumentObject) -> DocumentObject:
    """Makes a TechDraw page with a table of the job's figures, which follows its spreadsheet; returns it. Raises InputError
    without a result."""
    return figures.make_page(job)


def make_figures(job: DocumentObject) -> Sheet:
    """A spreadsheet of the job's figures, live; filled anew where there is one already."""
    return figures.make(job)


def write_report(
    job: DocumentObject,
    output: Path | str,
    pdf: Path | str | None = None,
    language: str = "en",
    title: str | None = None,
) -> Path:
    """Writes the report of the job's result as one HTML file, and as PDF; returns the HTML's path. See
    ``beltgrinding.report``.
    """
    with job_inputs.scratch_folder() as folder:
        result, name, notes = result_to_report(job, folder)
        return reporting.report(result, output, pdf, language, title or name, notes=notes)


def result_to_report(job: DocumentObject, folder: Path | str) -> tuple[Result, str, list[str]]:
    """(``Result``, title, notes) of the job's stored result, for ``reporting.report`` in any thread. A
    mesh stock is written to ``folder``. Raises InputError.
    """
    simulation = simulated(job)
    field = simulation.Proxy.field(simulation)
    if field is None or not simulation.SummaryData:
        raise InputError(
            "objects.too_little_for_report",
            "{object}: it holds too little for a report; simulate again",
            object=simulation.Label,
        )
    data, notes = job_inputs.to_data(job, folder), []
    if simulation.OutOfDate:
        notes.append(
            FreeCAD.Qt.translate(
                "BeltGrinding",
                "An input has changed since the simulation: figures and pictures are of the old one, "
                "the settings and the job file of the new one.",
            )
        )
    elif limits_changed(job, simulation):
        notes.append(
            FreeCAD.Qt.translate(
                "BeltGrinding",
                "The limits have changed since the simulation: the verdict is by the new ones, the "
                "events of gouges by the old.",
            )
        )
    if "file" in data["stock"]:
        notes.append(
            FreeCAD.Qt.translate(
                "BeltGrinding",
                "The stock is a mesh in the FreeCAD document; the job file below does not hold it. "
                "Export the job to repeat it.",
            )
        )
    result = Result(
        data, field, json.loads(simulation.SummaryData), simulation.Proxy.events(simulation), None
    )
    result.bins = json.loads(simulation.SeriesData) if simulation.SeriesData else None
    result.verdict = verdict_of(job, simulation, data["inspection"])
    result.convergence = report_data.convergence(simulation, data["inspection"])
    names = dict.fromkeys(obj.Label for obj, _ in job.DesignFaces)
    return result, ", ".join(names), notes
