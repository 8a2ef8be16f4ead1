"""The parts of a batch: each the study's job with a scan as its stock, or a job of its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.files import at_key
from ..base.kinds import Context, Facts, Json
from ..engine import InputError, core
from ..job import load as jobs
from ..scan import stock as scan_stock
from . import vary

if TYPE_CHECKING:
    from .vary import Variable


def parts(
    job: Json, found: Sequence[Variable], context: Context = None
) -> tuple[list[str], list[Json], Facts]:
    """(names, validated jobs, warnings) of the parts; ([], [``job``], []) where the study has none. ``job``: the
    study's, validated; ``found``: [Variable]. A scan is laid on the design here, once. Raises InputError, Cancelled.
    """
    lists = [one.given["parts"] for one in found if one.key == vary.PART]
    if not lists:
        return [], [job], []
    context = context or core.RunContext()
    names: list[str] = []
    made: list[Json] = []
    warnings: Facts = []
    for k, part in enumerate(lists[0]):
        file = part.get("job") or part["scan"]
        name = part.get("name", Path(file).stem)
        if name in names:
            raise InputError(
                "studies.part_twice",
                "vary: two parts are called '{name}'; give them names",
                name=name,
            )
        names.append(name)
        try:
            made.append(_job(part, file, job, name, warnings, context.part(0.0, 0.0)))
        except InputError as error:
            raise at_key(error, f"parts[{k}]") from None
    return names, made, warnings


def _job(
    part: Json, file: str, job: Json, name: str, warnings: Facts, context: core.RunContext
) -> Json:
    if "job" in part:
        return jobs.load(file)
    made, laid = scan_stock.as_stock(
        job,
        file,
        unit_mm=part["unit_mm"],
        start="principal" if part["principal"] else None,
        datum_faces=part["datum_faces"] or None,
        aligned=part["aligned"],
        context=context,
    )
    for warning in laid["warnings"] if laid is not None else ():
        warnings.append(
            core.Fact("studies.of_part", "part '{name}': {warning}", name=name, warning=warning)
        )
    return made
