"""Sorts a batch of castings by their scans: which pass as the job's program grinds them, which with a plan of their own, and
which are scrap. Each part is one task, on processes of this machine, a Dask cluster, an array of Slurm jobs, or here.

What is found of a part is kept as a study keeps its runs, and is not found again. Plans are written by whoever makes them: workers
elsewhere need the scans, the job's files and the folder under the same paths.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Context, Json, known
from ..base.processes import cores
from ..engine import InputError, core
from ..job import inputs
from ..planning import apply, rounds as plans
from . import casting, one, places, slurm, store, table
from .casting import PLANNED, UNKNOWN
from .hashes import Hashes

if TYPE_CHECKING:
    from .kinds import Blobs, Record, Run, Task
    from .clusters import Tls

FORMAT = 1  # of what is kept of a part
TABLE = "parts.csv"
KEPT = "kept"  # the folder of what is found of each part
OWN = {TABLE, "parts.html", KEPT, slurm.FOLDER}  # names in the folder that no part has
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

Named: TypeAlias = list[tuple[str, Path]]


class Batch(NamedTuple):
    """What was sorted."""

    parts: list[
        dict[str, Any]
    ]  # dicts with ``COLUMNS`` (``plan``: its folder), ``shares`` and ``reason_facts``, in the order that was given
    table: table.Table  # ``plan``: the folder's name
    reused: int  # parts that were there already


class Progress(NamedTuple):
    """How far it is."""

    parts: int
    done: int
    reused: int  # of them, there already
    seconds: float
    left_s: float | None  # None: not known yet
    workers: int  # processes that sort


def sort(
    job: Json,
    scans: Iterable[Path | str],
    folder: Path | str | None = None,
    settings: Json | None = None,
    share: float = 1.0,
    options: Json | None = None,
    workers: int | None = None,
    context: Context = None,
    told: Callable[[Progress], object] | None = None,
    scheduler: str | None = None,
    again: bool = False,
    chunk: tuple[int, int] | None = None,
    tls: Tls | None = None,
) -> Batch:
    """Sorts parts by their scans, meshes of the raw parts. Returns a ``Batch``.

    ``job``: validated; ``scans``: paths; ``folder``: for parts.csv, for what is kept of each part, and of each that needs one its
    plan in a folder of its name; ``settings``: of the plans (Resources/schema/plan.schema.json); ``share``: of the area that must
    be in tolerance, 1: the verdict must be pass; ``options``: as ``scan.stock.as_stock`` takes them; ``workers``: processes, by
    default one a core, 0: none; ``scheduler``, ``tls``: the address of a Dask scheduler whose workers sort, and its key, as ``places.runner`` takes them; ``again``: also what is
    there already; ``chunk``: (I, N): only every Nth part, from the Ith, and no table. Raises InputError, Cancelled; what is found
    by then stays in ``folder``. A part that fails by itself is told in its row.
    """
    context = context or core.RunContext()
    settings = plans.validate(settings or {})
    if not 0.0 < share <= 1.0:
        raise InputError(
            "studies.sort_share", "share {share:g}: must lie above 0, up to 1", share=share
        )
    batch = Tasks(job, scans, folder, settings, share, options or {})
    batch = batch if chunk is None else batch.chunk(*chunk)
    work = _Work(batch, again, context, told)
    if work.open and scheduler is None and (workers == 0 or len(batch.tasks) < 2):
        work.here()
    elif work.open:
        work.on(places.runner(scheduler, tls, min(workers or cores(), len(work.open))))
    found = work.batch()
    if folder is not None and chunk is None:
        _write(Path(folder, TABLE), found.table.csv_bytes())
    return found


class Tasks:
    """The parts of a batch as tasks, each known by the hash of what its row depends on. Raises InputError."""

    def __init__(
        self,
        job: Json,
        scans: Iterable[Path | str],
        folder: Path | str | None,
        settings: Json,
        share: float,
        options: Json,
    ) -> None:
        named = _named(scans)
        self.folder = None if folder is None else Path(os.path.abspath(folder))
        if self.folder is not None:
            _check(job, named, self.folder)
        hashes = Hashes([job])
        files = [[str(path), sha] for _, path, sha in hashes.files(job)]
        common = [FORMAT, hashes.job(job), settings, share, _plain(options)]
        self.tasks: list[dict[str, Any]] = []
        for name, path in named:
            scan = os.path.abspath(path)
            sha = inputs.file_digest("", scan)["sha256"]
            known = inputs.canonical([*common, name, Path(path).name, sha])
            self.tasks.append(
                {
                    "job_hash": hashlib.sha256(known).hexdigest(),
                    "part": name,
                    "given": str(path),
                    "scan": scan,
                    "files": [*files, [scan, sha]],
                    "folder": None if self.folder is None else str(self.folder / name),
                    "job": job,
                    "settings": settings,
                    "share": share,
                    "options": options,
                    "versions": core.versions(),
                }
            )

    def chunk(self, first: int, step: int) -> Tasks:
        """Every ``step``-th from the ``first``, counted from 1."""
        self.tasks = self.tasks[first - 1 :: step]
        return self


def _plain(value: Any) -> Any:
    """Options as plain data."""
    if isinstance(value, dict):
        return {name: _plain(one_) for name, one_ in value.items()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(one_) for one_ in value] if isinstance(value, (list, tuple)) else value


class _Work:
    """What is to be sorted."""

    def __init__(
        self,
        batch: Tasks,
        again: bool,
        context: core.RunContext,
        told: Callable[[Progress], object] | None,
    ) -> None:
        self.tasks, self.context, self.told = batch.tasks, context, told
        self.kept = None if batch.folder is None else store.Store(batch.folder / KEPT)
        self.rows: dict[str, dict[str, Any]] = {}  # by hash
        self.open: dict[str, Task] = {}
        for task in self.tasks:
            row = None if again or self.kept is None else self._there(task)
            if row is None:
                self.open[task["job_hash"]] = task
            else:
                self.rows[task["job_hash"]] = row
        self.reused, self.workers, self.begun = len(self.rows), 0, time.monotonic()

    def _there(self, task: Task) -> dict[str, Any] | None:
        """The figures of a part that are kept; None where there are none, or its plan is gone."""
        record = known(self.kept).read(task["job_hash"])
        row = record and record["figures"]
        if not row or not set(casting.FIGURES) <= set(row):
            return None
        planned = row["sorted"] == PLANNED
        return None if planned and not Path(task["folder"], apply.PLAN).exists() else row

    def here(self) -> None:
        """One after the other, in this process."""
        self.workers, count = 1, len(self.tasks)
        for number, task in enumerate(list(self.open.values()), self.reused):
            self.context.throw_if_cancelled()
            part = self.context.part(number / count, (number + 1) / count)
            self.take(_record(task, casting.one_part(task, part)))

    def on(self, run: Run) -> None:
        """On other processes; ``run``: as ``pool.run`` with its first argument."""

        def workers(count: int) -> None:
            self.workers = count

        tasks = list(self.open.values())
        run(tasks, None, self.take, self.context, workers, in_worker)

    def take(self, record: Record) -> None:
        """A part is sorted."""
        task = self.open.pop(record["job_hash"], None)
        if task is None:  # a second answer
            return
        if self.kept is not None and not record["passing"]:
            self.kept.write(record)
        row = record["figures"]
        if record["status"] == table.FAILED:  # its workers died
            row = {**dict.fromkeys(casting.FIGURES), "sorted": UNKNOWN, "trusted": True}
            row.update(reason=record["error"], reason_facts=[], shares={})
        self.rows[record["job_hash"]] = row
        self.context.report(len(self.rows) / len(self.tasks))
        if self.told is not None:
            seconds, made = time.monotonic() - self.begun, len(self.rows) - self.reused
            count = len(self.tasks), len(self.rows), self.reused
            self.told(Progress(*count, seconds, seconds / made * len(self.open), self.workers))

    def batch(self) -> Batch:
        """The ``Batch`` of all, in their order."""
        parts = []
        for task in self.tasks:
            row = self.rows[task["job_hash"]]
            plan = task["folder"] if row["sorted"] == PLANNED else None
            parts.append({**row, "part": task["part"], "scan": task["given"], "plan": plan})
        columns = {column: [row[column] for row in parts] for column in COLUMNS}
        columns["plan"] = [row["plan"] and row["part"] for row in parts]
        return Batch(parts, table.Table(columns), self.reused)


def _named(scans: Iterable[Path | str]) -> Named:
    """[(name, path)]: a folder stands for the meshes in it. Raises InputError where there are none."""
    paths: list[Path] = []
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
    found: Named = []
    taken = set(OWN)
    for path in paths:
        name, number = path.stem, 1
        while name.lower() in taken:
            number += 1
            name = f"{path.stem}-{number}"
        taken.add(name.lower())
        found.append((name, path))
    return found


def _check(job: Json, named: Named, folder: Path) -> None:
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


def _record(task: Task, row: dict[str, Any]) -> Record:
    """What is kept of a part. One that could not be judged is tried again the next time."""
    failed = row.pop("failed")
    return {
        "job_hash": task["job_hash"],
        "status": table.DONE,
        "figures": row,
        "error": None,
        "passing": failed,
        "field": None,
        "seconds": 0.0,
    }


def in_worker(task: Task, blobs: Blobs | None = None, folder: str | None = None) -> dict[str, Any]:
    """The record of a part, by one thread; {"unseen": path} where a file is not there as it was when the task was made,
    {"versions"} where the engine is another one. ``blobs``, ``folder``: as ``one.in_worker`` has them; nothing is sent.
    """
    if task["versions"] != core.versions():
        return {"versions": core.versions()}
    for path, sha in task["files"]:
        if sha is not None and one.digest(path) != sha:
            return {"unseen": path}
    core.set_threads(1)
    with one.busy:
        return _record(task, casting.one_part(task))


def _write(path: Path, data: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)
    except OSError as error:
        raise cannot_be_written(path, error) from None
