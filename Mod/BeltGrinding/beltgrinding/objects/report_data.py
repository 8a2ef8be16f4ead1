"""What a result tells others: kept beside the height field, so that a document has its report too."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from ..base import messages
from ..base.kinds import Json
from ..reporting import charts
from ..simulation.convergence_record import assessed
from .kinds import DocumentObject
from .properties import Output, add_outputs

if TYPE_CHECKING:
    from ..simulation.result import Result

NOT_CHECKED, FINE, COARSE = "not checked", "yes", "no"
OUTPUTS = (
    Output("EventCount", "Integer", "Result", "how many events there are"),
    Output("LawExtrapolated", "Integer", "Trust", "events outside of the law's range"),
    Output("NotConverged", "Integer", "Trust", "contacts whose pressure did not settle"),
    Output("WarningCount", "Integer", "Trust", "how many warnings of the input there are"),
    Output("Calibrated", "Bool", "Trust", "whether the law of removal was calibrated"),
    Output("FineEnough", "String", "Trust", "whether the job's settings are: yes, no, not checked"),
    Output(
        "SettingsError",
        "Distance",
        "Trust",
        "how far a depth may be off because of the settings; 0: not checked",
    ),
    Output("SummaryData", "String", "Result", "summary.json", True),
    Output("SeriesData", "String", "Result", "the time series as JSON", True),
    Output("ConvergenceData", "String", "Trust", "convergence.json", True),
)
EXTRAPOLATED = ("law_out_of_range", "belt_out_of_range")


def add(obj: DocumentObject) -> None:
    """Adds the properties to a Simulation."""
    add_outputs(obj, OUTPUTS)
    if not obj.FineEnough:
        obj.FineEnough = NOT_CHECKED


def store(obj: DocumentObject, result: Result) -> None:
    """Fills them from a ``simulation.result.Result``."""
    counts = result.summary["events"]
    obj.LawExtrapolated = sum(counts.get(kind, 0) for kind in EXTRAPOLATED)
    obj.NotConverged = counts.get("not_converged", 0)
    obj.WarningCount = len(result.summary["warnings"])
    obj.Calibrated = bool(result.job["law"]["calibration"])
    obj.SummaryData = json.dumps(result.summary, allow_nan=False)
    bins = result.bins if result.steps is None else charts.binned(result.steps)
    obj.SeriesData = json.dumps(bins, allow_nan=False) if bins else ""
    _store_convergence(obj, result.convergence)


def warnings(obj: DocumentObject, language: str) -> list[str]:
    """The sentences of the run's warnings."""
    if obj.SummaryData:
        return messages.warnings(json.loads(obj.SummaryData), language)
    return list(obj.Warnings)  # of a version before 0.2


def _store_convergence(obj: DocumentObject, convergence: Json | None) -> None:
    if convergence is None:  # not known
        obj.ConvergenceData, obj.FineEnough, obj.SettingsError = "", NOT_CHECKED, 0.0
        return
    obj.ConvergenceData = json.dumps(convergence, allow_nan=False)
    obj.FineEnough = _answer(convergence)
    depths = [one["error"] for one in convergence["quantities"] if one["unit"] == "mm"]
    obj.SettingsError = max((error for error in depths if error is not None), default=0.0)


def convergence(obj: DocumentObject, inspection: Json) -> dict[str, Any] | None:
    """The dict that convergence.json holds, judged by the job's present ``inspection``; None where the
    settings were not checked, or have changed since.
    """
    text = getattr(obj, "ConvergenceData", "")
    return assessed(json.loads(text), inspection) if text and not obj.OutOfDate else None


def update(obj: DocumentObject, inspection: Json) -> None:
    """Judges again by another tolerance what is known of the settings."""
    found = convergence(obj, inspection)
    answer = _answer(found)
    if obj.FineEnough != answer:
        obj.FineEnough = answer


def _answer(found: Json | None) -> str:
    return NOT_CHECKED if found is None else FINE if found["fine_enough"] else COARSE
