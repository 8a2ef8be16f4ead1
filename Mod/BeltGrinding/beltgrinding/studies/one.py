"""One run of a study: its job, and the record of what came out. In this process, or in a worker's anywhere."""

from __future__ import annotations

import collections
import functools
import hashlib
import json
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.files import write_whole
from ..base.kinds import Context, Json
from ..engine import InputError, core
from ..job import inputs, load as jobs
from ..simulation import run as runs
from . import figures, table, vary
from .keys import Key

if TYPE_CHECKING:
    from .kinds import Blobs, Record, Task

FOLLOWING = (
    "programs",
    "inspection",
)  # parts of a job that leave the first steps of a run as they are, or all
BASES = 16  # jobs that a worker keeps
FOLDER = "beltgrind-inputs"  # of files that were sent to a worker
# What another try may mend: such an error is told, and not kept as the run's result.
PASSING = (  # ends of their codes
    "memory",
    "timeout",
    "crash",
    "no_answer",
    "not_started",
    "no_reader",
    "cannot_be_read",
    "cannot_be_written",
)


class Base:
    """A job and what varies in it."""

    def __init__(self, job: Json, entries: Sequence[Json], placement: Json) -> None:
        """``job``: validated; ``entries``: of ``vary``; ``placement``: as in the study."""
        self.job, self.placement = job, placement
        self.entries = entries
        self.variables = vary.variables({"vary": entries})
        self.resume = any(self._follows(variable.key) for variable in self.variables)

    @staticmethod
    def _follows(key: Key | str) -> bool:
        """Whether two runs of the study can begin with the same steps where a variable's key, of ``vary``, differs."""
        return isinstance(key, Key) and key.steps[0] in FOLLOWING

    def job_of(self, values: Sequence[Any]) -> Json:
        """The job of a run with these values. Raises InputError."""
        return vary.job_of(self.job, self.variables, values, self.placement)

    def blob(self) -> bytes:
        """Bytes that make it again."""
        return inputs.canonical(
            {"job": self.job, "vary": self.entries, "placement": self.placement}
        )

    @classmethod
    def of_blob(cls, data: bytes) -> Base:
        made = json.loads(data)
        return cls(made["job"], made["vary"], made["placement"])


def solve(
    job: Json,
    job_hash: str,
    fields: bool = False,
    context: Context = None,
    sent: str = "",
    resume: bool = False,
) -> Record:
    """The record of a run of a job: dict(job_hash, status, figures, error, seconds, passing: another try may
    mend the error, field: bytes of its height field in HDF5, or None). ``sent``: the folder that stands before the paths of
    its files, which nobody is told; ``resume``: as in ``run.run``. Raises Cancelled."""
    begun = time.perf_counter()
    record: Record = {"job_hash": job_hash, "status": table.DONE, "figures": {}, "error": None}
    record.update(passing=False, field=None)
    try:
        _check(job)
        result = runs.run(job, context, resume=resume)
        record["figures"] = figures.of_result(result)
        if fields:
            record["field"] = result.field.hdf5(json.dumps(moved(job, sent, ""), allow_nan=False))
    except (InputError, MemoryError) as error:
        _failed(record, error, sent)
    record["seconds"] = time.perf_counter() - begun
    return record


def _failed(record: Record, error: InputError | MemoryError, sent: str) -> None:
    ours = error if isinstance(error, InputError) else None
    text = "out of memory" if ours is None else str(ours)
    if sent:
        text = text.replace(sent, "")
    record.update(status=table.FAILED, error=" ".join(text.split()))
    record["passing"] = ours is None or ours.code.endswith(PASSING)


def _check(job: Json) -> None:
    """Raises InputError where keys that varied contradict each other. What cannot vary so is left out: it is checked
    already, and large."""
    slim: dict[str, Any] = {
        **job,
        "design": _without_brep(job["design"]),
        "stock": _without_brep(job["stock"]),
    }
    slim["programs"] = [
        {**one, "poses": one["poses"][:1]} if "poses" in one else one for one in job["programs"]
    ]
    bodies = [_without_brep(one) for one in job["cell"]["bodies"]]
    slim["cell"] = {**job["cell"], "bodies": bodies}
    jobs.validate(slim, "/")


def _without_brep(held: Json) -> Json:
    return {**held, "brep": ""} if "brep" in held else held


def moved(job: Json, before: str, after: str) -> Json:
    """The job with ``after`` in place of ``before`` at the beginning of its files' paths."""
    if before == after:
        return job

    def named(held: Json, key: str = "file") -> Json:
        path = held.get(key)
        if not isinstance(path, str) or not path:
            return held
        return {**held, key: after + path.removeprefix(before)}

    machine = job["belt_machine"]
    return {
        **job,
        "design": named(job["design"]),
        "stock": named(named(job["stock"]), "left_by"),
        "programs": [named(named(one), "values") for one in job["programs"]],
        "cell": {**job["cell"], "bodies": [named(one) for one in job["cell"]["bodies"]]},
        "belt_machine": {
            **machine,
            "compliance": named(machine["compliance"], "surrogate_file"),
        },
    }


# In a worker -----------------------------------------------------------------------------------------

busy = threading.Lock()  # one run at a time in a process, however many threads its worker has
_bases = collections.OrderedDict[str, Base]()  # Base by the SHA-256 of its blob
_digests: dict[
    tuple[str, int, int], str | None
] = {}  # SHA-256 of files by (path, bytes, time of change)


def in_worker(task: Task, blobs: Blobs, folder: str | None) -> dict[str, Any]:
    """What a worker answers to a task: a record, or {"needs": [sha256]} of what it must be sent first, or {"versions"} where
    its engine is another one.

    ``task``: dict(job_hash, base: the sha256 of a Base's blob, values, files: [(path, sha256)], fields, versions); ``blobs``:
    {sha256: bytes} that were sent along; ``folder``: where it may keep files, None: in one of its own.
    """
    if task["versions"] != core.versions():
        return {"versions": core.versions()}
    core.set_threads(1)
    with busy:
        needs, sent = [], ""
        base = _base(task["base"], blobs)
        if base is None:
            needs.append(task["base"])
        if any(sha is not None and digest(path) != sha for path, sha in task["files"]):
            sent = str(Path(folder or _own_folder().name, FOLDER, _tree(task["files"])))
            needs += _laid_down(task["files"], blobs, sent)
        if base is None or needs:
            return {"needs": needs}
        job = moved(base.job_of(task["values"]), "", sent)
        return solve(job, task["job_hash"], task["fields"], sent=sent, resume=base.resume)


def _base(sha: str, blobs: Blobs) -> Base | None:
    if sha not in _bases and sha in blobs:
        _bases[sha] = Base.of_blob(blobs[sha])
        while len(_bases) > BASES:
            _bases.popitem(last=False)
    return _bases.get(sha)


def digest(path: str) -> str | None:
    """The SHA-256 of a file here; None where it is not to be had."""
    try:
        state = Path(path).stat()
    except OSError:
        return None
    known = (path, state.st_size, state.st_mtime_ns)
    if known not in _digests:
        _digests[known] = inputs.file_digest("", path)["sha256"]
    return _digests[known]


@functools.lru_cache
def _own_folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="beltgrind-worker-")


def _tree(files: Sequence[tuple[str, str | None]]) -> str:
    return hashlib.sha256(inputs.canonical(files)).hexdigest()[:32]


def _laid_down(files: Sequence[tuple[str, str | None]], blobs: Blobs, sent: str) -> list[str]:
    """Writes the files that were sent under the folder ``sent``, as they lie to each other; sha256 of those that are
    missing."""
    missing = []
    for path, sha in files:
        place = Path(sent + path)
        if sha is None or digest(str(place)) == sha:
            continue
        if sha not in blobs:
            missing.append(sha)
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        write_whole(place, blobs[sha])
    return missing
