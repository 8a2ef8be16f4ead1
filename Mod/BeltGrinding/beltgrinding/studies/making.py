"""A study from its file to its table: what is there already is not run again, and what is finished stays."""

from __future__ import annotations

import hashlib
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..base import schemas
from ..base.files import absolute, at_key, in_file, json_bytes, remove_tree
from ..base.kinds import Context, Facts, Json
from ..base.processes import cores
from ..base.regular_files import read_regular
from ..engine import InputError, core
from ..job import inputs, load as jobs
from . import (
    batch,
    design as designs,
    figures,
    one,
    own_forces,
    places,
    store,
    table,
    vary,
)
from .hashes import Hashes

if TYPE_CHECKING:
    from . import kinds
    from .kinds import Read, Record
    from .store import Store
    from .clusters import Tls

TOLD_S = 0.5  # between two tellings of the progress, at least


class Run(NamedTuple):
    """A run of the design."""

    number: int  # from 1
    values: tuple[Any, ...]  # of what varies, in order; a part by its number from 0
    base: int  # of ``Prepared.bases``
    job_hash: str


class Prepared(NamedTuple):
    """A study whose runs are known."""

    study: dict[str, Any]  # with all defaults, paths absolute, the job in it
    bases: list[one.Base]  # one a part
    files: list[list[str]]  # of each base: paths of the files that it reads
    names: list[str]  # of what varies
    figures: list[str]  # columns
    rows: designs.Rows  # of the table: the values of what varies
    runs: list[Run]
    design: dict[str, Any]  # design.json
    hashes: Hashes
    warnings: Facts

    def job(self, run: Run) -> Json:
        """The validated job of a run."""
        return self.bases[run.base].job_of(run.values)


class Progress(NamedTuple):
    """How far a study is."""

    runs: int  # of the design; those with the same job count once
    done: int  # finished, with those that were there
    reused: int  # of them, there already
    failed: int  # of those that are done
    seconds: float  # since it began
    left_s: float | None  # as it goes; None: not known yet
    workers: int  # processes that run


class Study(NamedTuple):
    """What a study gave."""

    folder: Path | None  # None where it was given none
    table: table.Table
    design: dict[str, Any]
    study: dict[str, Any]
    warnings: Facts
    reused: int = 0  # runs that were there already
    broken_off: int = 0  # that did not come to an end; another try may mend it

    @classmethod
    def read(cls, folder: Path | str) -> Study:
        """The study that lies in a folder. Raises InputError."""
        folder = Path(folder)
        design = store.read_json(folder / store.DESIGN, "design")
        found = table.Table.read(folder / table.FILE, design["varied"], design["figures"])
        for name in (*design["varied"], *design["figures"]):
            if name not in found.columns:
                raise InputError(
                    "studies.lacks_column",
                    "{file}: the column '{name}' is missing that {design} names: the study is damaged; run it again",
                    file=folder / table.FILE,
                    name=name,
                    design=store.DESIGN,
                )
        return cls(folder, found, design, store.read_json(folder / store.STUDY, "study"), [])


def schema() -> dict[str, Any]:
    """The JSON Schema of a study, as a dict."""
    return schemas.schema("study")


def validate(given: Json, folder: Path | str = ".") -> dict[str, Any]:
    """A copy of a study with all defaults, its job checked and in it, its paths absolute (relative to ``folder``). Raises
    InputError naming the key."""
    study = schemas.checked(given, schema(), "study")
    if isinstance(study["job"], str):
        study["job"] = jobs.load(absolute(folder, study["job"]))
    else:
        try:
            study["job"] = jobs.validate(study["job"], folder)
        except InputError as error:
            raise at_key(error, "job") from None
    for entry in study["vary"]:
        for part in entry.get("parts", ()):
            for name in ("job", "scan"):
                if name in part:
                    part[name] = absolute(folder, part[name])
    return study


def load(path: Path | str) -> dict[str, Any]:
    """Reads and validates a study's file. Raises InputError."""
    path = Path(path)
    given = schemas.read_json(path)
    try:
        return validate(given, Path(absolute(".", path)).parent)
    except InputError as error:
        raise in_file(error, path) from None


def prepare(study: dict[str, Any], context: Context = None) -> Prepared:
    """A ``Prepared`` of a validated study: its runs, each with the hash of its job. Raises InputError for values that the
    job's schema forbids, naming the run; Cancelled."""
    context = context or core.RunContext()
    found = vary.variables(study)
    names, base_jobs, warnings = batch.parts(study["job"], found, context)
    warnings += own_forces.told(found, study["job"])
    made = designs.design(study, found, context)
    bases = [one.Base(job, study["vary"], study["placement"]) for job in base_jobs]
    hashes = Hashes(base_jobs)
    at = next((k for k, v in enumerate(found) if v.key == vary.PART), None)
    runs = []
    for number, values in enumerate(made.rows, 1):
        context.throw_if_cancelled()
        base = 0 if at is None else values[at]
        try:
            job_hash = hashes.job(bases[base].job_of(values))
        except InputError as error:
            raise error.within("studies.in_run", "run {run}: ", run=number) from None
        runs.append(Run(number, values, base, job_hash))
    columns = study["keep"]["figures"] or figures.usual(study["job"])
    _check_columns(columns, [v.name for v in found])
    told = designs.meta(study, made, [v.name for v in found])
    told["figures"] = columns
    return Prepared(
        study,
        bases,
        [[path for _, path, _ in hashes.files(job)] for job in base_jobs],
        told["varied"],
        columns,
        designs.part_column(found, made.rows, names),
        runs,
        told,
        hashes,
        warnings,
    )


def _check_columns(columns: Sequence[str], names: Sequence[str]) -> None:
    for name in columns:
        if name in names or name in (table.RUN, table.STATUS, table.ERROR, table.HASH):
            raise InputError(
                "studies.figure_name",
                "{key}: '{name}' is another column of the table; give what varies another name",
                key="keep.figures",
                name=name,
            )


def study(
    given: dict[str, Any] | Path | str,
    output: Path | str | None = None,
    context: Context = None,
    told: Callable[[Progress], object] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    again: bool = False,
    chunk: tuple[int, int] | None = None,
    tls: Tls | None = None,
) -> Study:
    """Makes the runs of a study (a dict, or the path of a study.json) that are not there yet, and returns a ``Study``.

    ``output``: its folder; None: nothing is kept but what is returned. ``told(Progress)``: is called now and then.
    ``workers``: processes of this machine, by default one a core; 0: none, one run after the other in this process.
    ``scheduler``: the address of a Dask scheduler whose workers make the runs, tls://HOST:PORT; ``tls``: its key, as
    ``places.runner`` takes it. ``again``: also what is there already.
    ``chunk``: (I, N): only every Nth run, from the Ith, and no table. Raises InputError, Cancelled; every run that has ended by
    then stays in ``output``, and is not made again.
    """
    context = context or core.RunContext()
    read = () if isinstance(given, dict) else (given,)
    checked = validate(given) if isinstance(given, dict) else load(given)
    prepared = prepare(checked, context)
    if output is not None:
        return run(prepared, output, context, told, workers, scheduler, again, chunk, read, tls)
    folder = Path(tempfile.mkdtemp(prefix="beltgrind-study-"))
    try:
        found = run(prepared, folder, context, told, workers, scheduler, again, chunk, tls=tls)
        return found._replace(folder=None)
    finally:
        remove_tree(folder)


def run(
    prepared: Prepared,
    folder: Path | str,
    context: Context = None,
    told: Callable[[Progress], object] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    again: bool = False,
    chunk: tuple[int, int] | None = None,
    read: Read = (),
    tls: Tls | None = None,
) -> Study:
    """``study`` of a ``Prepared`` one. ``read``: files that it was read from."""
    context = context or core.RunContext()
    kept = lay_out(prepared, folder, read, chunk is None)
    mine = prepared.runs if chunk is None else prepared.runs[chunk[0] - 1 :: chunk[1]]
    work = _Work(prepared, kept, mine, again, context, told)
    try:
        if work.open:
            if scheduler is None and workers == 0:
                work.here()
            else:
                work.on(places.runner(scheduler, tls, workers or min(cores(), len(work.open))))
    except BaseException:
        work.tell(now=True)
        if chunk is None:
            _write_what_is_there(kept, prepared, work)
        raise
    made = work.table()
    if chunk is None:
        kept.write_table(made)
    return Study(
        Path(folder),
        made,
        prepared.design,
        prepared.study,
        prepared.warnings,
        work.reused,
        sum(record.get("passing", False) for record in work.records.values()),
    )


def lay_out(prepared: Prepared, folder: Path | str, read: Read = (), write: bool = True) -> Store:
    """The ``store.Store`` of a study in its folder, in which the study itself and its design are written. Raises
    InputError."""
    kept = store.Store(folder, prepared.study["keep"]["fields"])
    own = _own(read, prepared, kept)
    store.check_folder(folder, [*own, *(path for files in prepared.files for path in files)])
    if write:
        kept.write_study(prepared.study, prepared.design)
    return kept


class Survey(NamedTuple):
    """What is to be done."""

    runs: int
    jobs: int  # different ones
    there: int  # of them
    mean_s: float | None  # that a run took; None: not known
    cores: int

    def left_s(self, workers: int) -> float | None:
        """s, of all that is not there, on so many cores; None: not known."""
        if self.jobs == self.there:
            return 0.0
        return None if self.mean_s is None else self.mean_s * (self.jobs - self.there) / workers


def survey(prepared: Prepared, folder: Path | str) -> Survey:
    """A ``Survey`` of a study's folder, in which nothing is changed."""
    kept = store.Store(folder, prepared.study["keep"]["fields"])
    jobs_ = {each.job_hash for each in prepared.runs}
    seconds = [record["seconds"] for record in map(kept.read, jobs_) if record is not None]
    mean = sum(seconds) / len(seconds) if seconds else None
    return Survey(len(prepared.runs), len(jobs_), len(seconds), mean, cores())


def _own(read: Read, prepared: Prepared, kept: Store) -> list[Path | str]:
    """The files that a study was read from, but one that this study wrote itself."""
    found = []
    for path in read:
        same = json_bytes(prepared.study) == read_regular(path, schemas.LARGEST)
        if not (same and os.path.realpath(path) == os.path.realpath(kept.folder / store.STUDY)):
            found.append(path)
    return found


def _write_what_is_there(kept: Store, prepared: Prepared, work: _Work) -> None:
    try:
        kept.write_table(work.table())
    except InputError:  # such as of a full disk, which is being told already
        pass


class _Work:
    """The runs of a study that are to be made."""

    def __init__(
        self,
        prepared: Prepared,
        kept: Store,
        mine: Sequence[Run],
        again: bool,
        context: core.RunContext,
        told: Callable[[Progress], object] | None,
    ) -> None:
        self.prepared, self.kept, self.context, self.told = prepared, kept, context, told
        self.records: dict[str, Record] = {}  # by hash, without fields
        self.open: dict[str, Run] = {}  # Run by hash: those with the same job are one
        for each in mine:
            if each.job_hash in self.records or each.job_hash in self.open:
                continue
            record = None if again else kept.read(each.job_hash)
            if record is None:
                self.open[each.job_hash] = each
            else:
                self.records[each.job_hash] = record
        self.reused, self.workers = len(self.records), 0
        self.count = self.reused + len(self.open)
        self.begun, self.last = time.monotonic(), -TOLD_S
        self.first: float | None = None  # when the first record came
        self.tell()

    def here(self) -> None:
        """One after the other, in this process."""
        self.workers = 1
        for number, each in enumerate(list(self.open.values()), self.reused):
            self.context.throw_if_cancelled()
            part = self.context.part(number / self.count, (number + 1) / self.count)
            job = self.prepared.job(each)
            resume = self.prepared.bases[each.base].resume
            self.take(one.solve(job, each.job_hash, self.kept.fields, part, resume=resume))

    def on(self, run: kinds.Run) -> None:
        """On other processes; ``run``: as ``pool.run`` with its first argument."""
        blobs: dict[str, bytes] = {}
        shas: list[str] = []
        for base in self.prepared.bases:
            data = base.blob()
            shas.append(hashlib.sha256(data).hexdigest())
            blobs[shas[-1]] = data
        paths: dict[str, str] = {}
        tasks = [self._task(each, shas, paths) for each in self.open.values()]

        def blob(sha: str) -> bytes:
            return blobs[sha] if sha in blobs else _file(paths[sha], sha)

        def workers(count: int) -> None:
            self.workers = count
            self.tell(now=True)

        run(tasks, blob, self.take, self.context, workers)

    def _task(self, each: Run, shas: Sequence[str], paths: dict[str, str]) -> dict[str, Any]:
        files = self.prepared.hashes.files(self.prepared.job(each))
        paths.update((sha, path) for _, path, sha in files if sha is not None)
        return {
            "job_hash": each.job_hash,
            "base": shas[each.base],
            "values": list(each.values),
            "files": [[path, sha] for _, path, sha in files],
            "fields": self.kept.fields,
            "versions": core.versions(),
        }

    def take(self, record: Record) -> None:
        """A run has ended."""
        if record["job_hash"] not in self.open:  # a second answer
            return
        if not record["passing"]:
            self.kept.write(record)
        record = {**record, "field": None}
        del self.open[record["job_hash"]]
        self.records[record["job_hash"]] = record
        self.first = self.first or time.monotonic()
        self.context.report(len(self.records) / self.count)
        self.tell()

    def tell(self, now: bool = False) -> None:
        """Calls ``told``, not too often unless ``now``."""
        time_s = time.monotonic()
        if self.told is None or (time_s - self.last < TOLD_S and self.open and not now):
            return
        self.last = time_s
        self.told(self.progress())

    def progress(self) -> Progress:
        """A ``Progress``."""
        now = time.monotonic()
        made = len(self.records) - self.reused
        left = (now - self.begun) / made * len(self.open) if made else None
        failed = sum(r["status"] == table.FAILED for r in self.records.values())
        return Progress(
            self.count,
            len(self.records),
            self.reused,
            failed,
            now - self.begun,
            left if self.open else 0.0,
            self.workers,
        )

    def table(self) -> table.Table:
        """The ``Table`` of all runs of the study, in the design's order."""
        prepared = self.prepared
        records = [self.records.get(each.job_hash) for each in prepared.runs]
        done = [r["figures"] if r and r["status"] == table.DONE else {} for r in records]
        columns: dict[str, list[Any]] = {table.RUN: [each.number for each in prepared.runs]}
        for k, name in enumerate(prepared.names):
            columns[name] = [row[k] for row in prepared.rows]
        for name in prepared.figures:
            columns[name] = [figures_.get(name) for figures_ in done]
        columns[table.STATUS] = [table.OPEN if r is None else r["status"] for r in records]
        columns[table.ERROR] = ["" if r is None else r["error"] or "" for r in records]
        columns[table.HASH] = [each.job_hash for each in prepared.runs]
        return table.Table(columns, prepared.names, prepared.figures)


def _file(path: str, sha: str) -> bytes:
    """The bytes of a file that a worker needs. Raises InputError where it is not what it was."""
    if inputs.file_digest("", path)["sha256"] != sha:
        raise InputError(
            "studies.file_changed",
            "{file}: has changed since the study began; start it again",
            file=path,
        )
    return read_regular(path, inputs.LARGEST)
