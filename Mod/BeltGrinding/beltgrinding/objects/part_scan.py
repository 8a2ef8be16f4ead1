"""A scan of the ground part beside a Simulation's prediction."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from ..base.kinds import Floats, Json
from ..calibration import learning, part_scan
from ..engine import InputError, core
from ..scan import comparison as scan
from . import job_data, job_inputs, result_files
from .kinds import DocumentObject
from .properties import Output, add_outputs, from_job

if TYPE_CHECKING:
    from ..scan.kinds import Ground

OUTPUTS = (
    Output("ScanFile", "String", "Scan", "the scan of the ground part that was compared"),
    Output("ScanShare", "Float", "Scan", "share of the area that the scan covers, percent"),
    Output("ScanResidual", "Distance", "Scan", "root mean square of the alignment"),
    Output("MeasuredMean", "Distance", "Scan", "of the scan's height over the design"),
    Output("DifferenceMean", "Distance", "Scan", "measured less predicted height"),
    Output("DifferenceRms", "Distance", "Scan", "root mean square of that"),
    Output("ScanFigures", "String", "Scan", "all figures of the comparison, as JSON", True),
)


def prepare(simulation: DocumentObject, job: DocumentObject) -> SimpleNamespace:
    """What ``scan.compare`` takes for a result, from the document. Raises InputError."""
    if simulation.OutOfDate or job_inputs.fingerprint(job) != simulation.Fingerprint:
        raise InputError(
            "objects.out_of_date",
            "{object} is out of date; simulate again",
            object=simulation.Label,
        )
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.to_data(job, folder)
    if "brep" not in data["design"]:
        raise InputError(
            "objects.design_without_shape", "{object}: its design has no shape", object=job.Label
        )
    return SimpleNamespace(field=simulation.Proxy.field(simulation), job=data)


def store(simulation: DocumentObject, result: Ground, figures: Json) -> None:
    """Keeps what ``scan.compare`` gave in the Simulation object."""
    kept: Any = result_files.sound(simulation, "HeightField")
    attributes = core.HeightField.from_hdf5(kept)[1]
    result_files.store(
        simulation, {"HeightField": lambda file: result.field.hdf5_into(file, attributes)}
    )
    add_outputs(simulation, OUTPUTS)
    simulation.ScanFile = figures["file"]
    simulation.ScanShare = 100.0 * figures["measured_area_share"]
    alignment = figures["alignment"]
    simulation.ScanResidual = alignment["rms_mm"] if alignment else 0.0
    simulation.MeasuredMean = figures["measured_mm"]["mean"]
    simulation.DifferenceMean = figures["difference_mm"]["mean"]
    simulation.DifferenceRms = figures["difference_mm"]["rms"]
    simulation.ScanFigures = json.dumps(figures, allow_nan=False)


def forget(simulation: DocumentObject) -> None:
    """Another result: what was measured belongs to the old one."""
    if getattr(simulation, "ScanFigures", ""):
        simulation.ScanFile = simulation.ScanFigures = ""
        for name in ("ScanShare", "ScanResidual", "MeasuredMean"):
            setattr(simulation, name, 0.0)
        simulation.DifferenceMean = simulation.DifferenceRms = 0.0


def compare(
    simulation: DocumentObject, job: DocumentObject, path: Path | str, **options: Any
) -> dict[str, Any]:
    """``scan.compare`` on the document; returns its figures."""
    result = prepare(simulation, job)
    figures = scan.compare(result, path, **options)
    store(simulation, result, figures)
    return figures


def to_learn(simulation: DocumentObject, job: DocumentObject) -> tuple[dict[str, Any], Floats]:
    """(job as data, measured heights (samples,)) of the scan that was compared, as ``learning.learn`` takes them. Raises
    InputError where there is none."""
    result: Any = prepare(simulation, job)
    return result.job, part_scan.measured_heights(result)


def take(job: DocumentObject, learned: learning.Learned) -> None:
    """Puts what was learned into the job's law."""
    from_job(job, job_data.KEYS, {"law": learned.law})


def learn(simulation: DocumentObject, job: DocumentObject, **options: Any) -> learning.Learned:
    """``learning.learn`` from the scan that was compared, into the job's law; returns what was learned."""
    data, measured = to_learn(simulation, job)
    learned = learning.learn(data, measured, **options)
    take(job, learned)
    return learned
