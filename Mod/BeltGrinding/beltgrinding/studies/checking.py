"""Runs what a response surface suggests: a prediction is told with what a simulation says of it."""

from __future__ import annotations

from typing import Any

from ..base.kinds import Context, Json
from ..engine import InputError
from . import best, one, table


def check(found: dict[str, Any], study: Json, context: Context = None) -> None:
    """Simulates the setting that the answers ``found`` suggest between the runs of a study (with its job). It gets
    ``checked`` {figure: value} and ``checked_feasible``, or ``check_failed``, why it could not be run. Nothing is done where
    nothing is suggested, or where parts vary. Raises Cancelled."""
    said = found.get("best", {}).get("surface")
    if not said or "values" not in said or any("parts" in entry for entry in study["vary"]):
        return
    base = one.Base(study["job"], study["vary"], study["placement"])
    try:
        values = [said["values"][variable.name] for variable in base.variables]
        record = one.solve(base.job_of(values), "", context=context)
    except InputError as error:
        said["check_failed"] = str(error)
        return
    if record["status"] != table.DONE:
        said["check_failed"] = record["error"]
        return
    said["checked"] = {name: record["figures"].get(name) for name in said["predicted"]}
    said["checked_feasible"] = all(
        record["figures"].get(name) is not None
        and best.beyond(record["figures"][name], *pair) <= 0.0
        for name, pair in found["best"]["limits"].items()
    )
