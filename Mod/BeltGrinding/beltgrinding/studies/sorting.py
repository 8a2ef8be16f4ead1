"""Sorts a batch of castings by their scans: which pass as the job's program grinds them, which with a plan of their own, and
which are scrap. Each part is one task, on processes of this machine or here."""

import os
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.messages import fact_data, sentence
from ..engine import Cancelled, InputError, core
from ..inspection import verdict as verdicts
from ..job import inputs, workpiece
from ..planning import apply, pictures, reasons, rounds as plans
from ..scan import stock as scan_stock
from ..simulation import run as runs
from . import clusters
from .making import cores
from .table import Table

PASSES, PLANNED, SCRAP, UNKNOWN = "passes", "passes with plan", "scrap", "unknown"
SORTS = (PASSES, PLANNED, SCRAP, UNKNOWN)
TABLE = "parts.csv"
LOOK_S = 0.1
COLUMNS = (
    "part",
    "scan",
    "sorted",
    "in_share",
    "planned_in_share",
    "process_time_s",
    "planned_time_s",
    "aligned_rms_mm",
    "trusted",
    "reason",
    "plan",
)


class Batch(NamedTuple):
    """What was sorted."""

    parts: list  # dicts with ``COLUMNS`` and ``shares``, in the order that was given
    table: Table


class Progress(NamedTuple):
    """How far it is."""

    parts: int
    done: int
    seconds: float
    left_s: float  # None: not known yet


def sort(
    job,
    scans,
    folder=None,
    settings=None,
    share=1.0,
    options=None,
    workers=None,
    context=None,
    told=None,
):
    """Sorts parts by their scans, meshes of the raw parts. Returns a ``Batch``.

    ``job``: validated; ``scans``: paths; ``folder``: for parts.csv and, of each part that needs one, its plan in a folder of its
    name; ``settings``: of the plans (Resources/schema/plan.schema.json); ``share``: of the area that must be in tolerance, 1:
    the verdict must be pass; ``options``: as ``scan.stock.as_stock`` takes them; ``workers``: processes, by default one a
    core, 0: none. Raises InputError, Cancelled. A part that fails by itself is told in its row.
    """
    context = context or core.RunContext()
    settings = plans.validate(settings or {})
    if not 0.0 < share <= 1.0:
        raise InputError(
            "studies.sort_share", "share {share:g}: must lie above 0, up to 1", share=share
        )
    named = _named(scans)
    if folder is not None:
        _check(job, named, Path(folder))
    tasks = [
        {
            "part": name,
            "scan": str(path),
            "folder": None if folder is None else str(Path(folder, name)),
            "job": job,
            "settings": settings,
            "share": share,
            "options": options or {},
        }
        for name, path in named
    ]
    rows, begun = {}, time.monotonic()

    def taken(row):
        rows[row["part"]] = row
        context.report(len(rows) / len(tasks))
        if told is not None:
            seconds = time.monotonic() - begun
            left = seconds / len(rows) * (len(tasks) - len(rows))
            told(Progress(len(tasks), len(rows), seconds, left))

    if workers == 0 or len(tasks) < 2:
        for place, task in enumerate(tasks):
            part = context.part(place / len(tasks), (place + 1) / len(tasks))
            taken(one_part(task, part))
    else:
        _side_by_side(tasks, workers, taken, context)
    parts = [rows[name] for name, _ in named]
    made = Table({column: [row[column] for row in parts] for column in COLUMNS})
    if folder is not None:
        _write(Path(folder, TABLE), made.csv_bytes())
    return Batch(parts, made)


def _named(scans):
    """[(name, path)]: a folder stands for the meshes in it. Raises InputError where there are none."""
    paths = []
    for scan in scans:
        path = Path(scan)
        if path.is_dir():
            kinds = (".stl", ".ply", ".obj")
            paths += sorted(p for p in path.iterdir() if p.suffix.lower() in kinds)
        else:
            paths.append(path)
    if not paths:
        raise InputError(
            "studies.no_scans",
            "there is nothing to sort: give scans (.stl, .ply, .obj) or a folder",
        )
    found, taken = [], set()
    for path in paths:
        name, number = path.stem, 1
        while name.lower() in taken:
            number += 1
            name = f"{path.stem}-{number}"
        taken.add(name.lower())
        found.append((name, path))
    return found


def _check(job, named, folder):
    """Raises InputError where a result would be written over what is read."""
    read = {os.path.realpath(path) for path in [*inputs.files(job), *(p for _, p in named)]}
    for path in (folder / TABLE, *(folder / name for name, _ in named)):
        if os.path.realpath(path) in read:
            raise InputError(
                "studies.own_input",
                "{file}: the study reads it, and its results would replace it; choose another folder",
                file=path,
            )
    for name, _ in named:
        apply.check(job, folder / name, read)


def one_part(task, context=None):
    """The row of a part: ``COLUMNS`` and ``shares``, of the area, of the reasons why it stays out of tolerance. In any
    process. Raises Cancelled."""
    context = context or core.RunContext()
    row = dict.fromkeys(COLUMNS)
    row.update(part=task["part"], scan=task["scan"], sorted=UNKNOWN, reason="", shares={})
    row.update(trusted=True, reason_facts=[])
    try:
        _sort(task, row, context)
    except InputError as error:
        row["reason_facts"] = [fact_data(error)]
        row["reason"] = str(error)
    return row


def _sort(task, row, context):
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
            row["plan"] = task["folder"]
        return
    row["sorted"] = SCRAP
    shares = {word: share for word, share in plan.why["shares"].items() if share > reasons.LEAST}
    row["shares"] = shares
    if shares:
        worst = max(shares, key=shares.get)
        row["reason"] = f"{100.0 * shares[worst]:.1f} %: {pictures.WORDS[worst]}"


def _lacking(job, context):
    """Share of the area on which the stock of a job lies below the lower limit of the tolerance."""
    field = workpiece.make_field(job, workpiece.read_design(job["design"], context), [], context)
    workpiece.apply_stock(field, job["stock"], [], context)
    seen = (np.asarray(field.flags) & core.MISSED) == 0
    below = seen & (np.asarray(field.height, dtype=float) < verdicts.limits(job, field)[0])
    areas = np.asarray(field.areas, dtype=float)
    return float(areas[below].sum() / max(areas.sum(), 1e-300))


def _word(verdict, share):
    """ "pass", "fail" or "unknown". Where the scan has no stock nothing is known, of either sign."""
    if share >= 1.0:
        return verdict["overall"]
    known = verdict["in_share"] * verdict["inspected_area_mm2"] / verdict["area_mm2"]
    if known >= share:
        return "pass"
    return (
        "unknown" if known + verdict["missed_area_mm2"] / verdict["area_mm2"] >= share else "fail"
    )


def _side_by_side(tasks, workers, taken, context):
    """Each task on a Dask worker of this machine."""
    distributed = clusters.distributed()
    local = clusters.Local(min(workers or cores(), len(tasks)))
    try:
        local.start(context)
        with distributed.Client(local.address, set_as_default=False) as client:
            open_ = [client.submit(in_worker, task, pure=False) for task in tasks]
            while open_:
                context.throw_if_cancelled()
                ended = [future for future in open_ if future.done()]
                for future in ended:
                    open_.remove(future)
                    taken(_answer(future))
                if not ended:
                    time.sleep(LOOK_S)
    except Cancelled:
        local.close()
        raise
    finally:
        local.close()


def _answer(future):
    if future.status != "finished":
        raise InputError(
            "studies.sort_died",
            "a process that sorted a part ended without an answer, perhaps for want of memory; take fewer by --workers",
        )
    return future.result()


def in_worker(task):
    """``one_part`` in a worker's process, with a thread of its own."""
    core.set_threads(1)
    return one_part(task)


def _write(path, data):
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)
    except OSError as error:
        raise cannot_be_written(path, error) from None


def reason(row, words):
    """Why a part is what it is, in the words of a ``reporting.language.Language``."""
    if row["reason_facts"]:
        return "; ".join(sentence(one, words.code) for one in row["reason_facts"])
    told = sorted(row["shares"].items(), key=lambda pair: -pair[1])
    return "; ".join(f"{words.percent(share)}: {words(pictures.WORDS[w])}" for w, share in told)
