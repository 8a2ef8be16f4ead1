"""One casting of a batch by its scan: whether it passes as the job's program grinds it, with a plan of its own, or is scrap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Context, Json
from ..base.messages import fact_data, sentence
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import inputs, workpiece
from ..planning import apply, pictures, reasons, rounds as plans
from ..scan import stock as scan_stock
from ..simulation import run as runs

if TYPE_CHECKING:
    from ..reporting.language import Language
    from .kinds import Task

PASSES, PLANNED, SCRAP, UNKNOWN = "passes", "passes with plan", "scrap", "unknown"
SORTS = (PASSES, PLANNED, SCRAP, UNKNOWN)
FIGURES = (  # of a row, beside its names
    "sorted",
    "in_share",
    "planned_in_share",
    "process_time_s",
    "planned_time_s",
    "aligned_rms_mm",
    "trusted",
    "reason",
    "reason_facts",
    "shares",
)


def one_part(task: Task, context: Context = None) -> dict[str, Any]:
    """The row of a part: ``FIGURES`` and ``failed``, whether it could not be judged for a reason of its own. ``reason``: why
    it is what it is, in English, ``reason_facts`` the same as facts; ``shares``: of the area, of the reasons why it stays
    out of tolerance. In any process. Raises Cancelled.

    ``task``: dict(job, scan, options: as ``scan.stock.as_stock`` takes them, settings: of the plan, share, folder: where a plan
    is written, or None).
    """
    context = context or core.RunContext()
    row: dict[str, Any] = {**dict.fromkeys(FIGURES), "sorted": UNKNOWN, "reason": "", "shares": {}}
    row.update(trusted=True, reason_facts=[], failed=False)
    try:
        _sort(task, row, context)
    except InputError as error:
        row.update(reason_facts=[fact_data(error)], reason=str(error), failed=True)
    return row


def _sort(task: Task, row: dict[str, Any], context: core.RunContext) -> None:
    job, laid = scan_stock.as_stock(
        task["job"], task["scan"], **task["options"], context=context.part(0.0, 0.1)
    )
    if laid is not None:
        row.update(aligned_rms_mm=float(laid["rms_mm"]), trusted=bool(laid["trusted"]))
    lacking = _lacking(job, context.part(0.1, 0.12))
    if lacking > 1.0 - task["share"]:
        fact = core.Fact(
            "studies.sort_lacks",
            "the raw part lies below the lower limit on {percent:.1f} % of the area already, and grinding adds nothing",
            percent=100.0 * lacking,
        )
        row.update(sorted=SCRAP, reason=str(fact), reason_facts=[fact_data(fact)])
        return
    result = runs.run(job, context.part(0.12, 0.2))
    verdict = result.verdict or verdicts.of_result(result)
    row["in_share"] = verdict["in_share"]
    row["process_time_s"] = result.summary["process_time_s"]
    word = _word(verdict, task["share"])
    if word == "pass":
        row["sorted"] = PASSES
        return
    if word == "unknown":
        fact = core.Fact(
            "studies.sort_missed",
            "the scan leaves {area:.3g} mm2 of the ground faces without stock: nothing is known there",
            area=verdict["missed_area_mm2"],
        )
        row.update(reason=str(fact), reason_facts=[fact_data(fact)])
        return
    plan = plans.plan(job, task["settings"], context.part(0.2, 1.0))
    after = verdicts.of_result(plan.after)
    row["planned_in_share"] = after["in_share"]
    row["planned_time_s"] = plan.after.summary["process_time_s"]
    if _word(after, task["share"]) == "pass" and plan.better:
        row["sorted"] = PLANNED
        if task["folder"] is not None:
            apply.write(plan, task["folder"], [task["scan"], *inputs.files(task["job"])], False)
        return
    row["sorted"] = SCRAP
    shares = {word: share for word, share in plan.why["shares"].items() if share > reasons.LEAST}
    row["shares"] = shares
    if shares:
        worst = max(shares, key=lambda word: float(shares[word]))
        row["reason"] = f"{100.0 * shares[worst]:.1f} %: {pictures.WORDS[worst]}"


def _lacking(job: Json, context: core.RunContext) -> float:
    """Share of the area on which the stock of a job lies below the lower limit of the tolerance."""
    field = workpiece.make_field(job, workpiece.read_design(job["design"], context), [], context)
    workpiece.apply_stock(field, job["stock"], [], context)
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    below = seen & (np.asarray(field.height, dtype=float) < verdicts.limits(job, field)[0])
    areas = np.asarray(field.areas, dtype=float)
    return float(areas[below].sum() / max(areas.sum(), 1e-300))


def _word(verdict: Json, share: float) -> str:
    """ "pass", "fail" or "unknown". Where the scan has no stock nothing is known, of either sign."""
    if share >= 1.0:
        return verdict["overall"]
    known = verdict["in_share"] * verdict["inspected_area_mm2"] / verdict["area_mm2"]
    if known >= share:
        return "pass"
    return (
        "unknown" if known + verdict["missed_area_mm2"] / verdict["area_mm2"] >= share else "fail"
    )


def reason(row: Json, words: Language) -> str:
    """Why a part is what it is, in the words of a ``reporting.language.Language``."""
    if row["reason_facts"]:
        return "; ".join(sentence(one, words.code) for one in row["reason_facts"])
    told = sorted(row["shares"].items(), key=lambda pair: -pair[1])
    shares = [f"{words.percent(share)}: {words(pictures.WORDS[w])}" for w, share in told]
    return "; ".join(shares) or row["reason"]
