"""What workers are sent beside their tasks, and what becomes of their answers: the same for our own processes and for Dask's."""

from __future__ import annotations

import collections
from typing import TYPE_CHECKING

from ..base.kinds import Json, known
from ..engine import InputError, core
from . import table

if TYPE_CHECKING:
    from .kinds import Blob, Record, Taken, Task

MOST_TRIES = 20  # of sending what a worker needs
ODD = 3  # errors of a worker that are none of ours, such as of one that is just ending, after which a run's is told


class Delivery:
    """``blob(sha256)``: the bytes of what a worker asks for; ``taken(record)``: is called for each task that has ended."""

    def __init__(self, blob: Blob | None, taken: Taken) -> None:
        self.blob, self.taken = blob, taken
        self.tries = collections.Counter[str]()  # of sending what a worker needs, by job
        self.odd = collections.Counter[str]()  # errors that are none of ours, by job

    def answered(self, task: Task, answer: Record, worker: str) -> dict[str, bytes] | None:
        """None where the task has ended; else {sha256: bytes} to be sent with its next try. Raises InputError."""
        if "versions" in answer:
            raise InputError(
                "studies.other_version",
                "the worker {worker} has another engine, whose figures may differ: {there} there, {here} here; install the "
                "same",
                worker=worker,
                there=_versions(answer["versions"]),
                here=_versions(core.versions()),
            )
        if "unseen" in answer:
            raise InputError(
                "studies.worker_sees_not",
                "the worker {worker} does not see {file} as it is here; its disk must show the same files under the same paths",
                worker=worker,
                file=answer["unseen"],
            )
        if "needs" not in answer:
            self.taken(answer)
            return None
        self.tries[task["job_hash"]] += 1
        if self.tries[task["job_hash"]] > MOST_TRIES:
            raise InputError(
                "studies.files_do_not_arrive",
                "the worker {worker} asks again and again for the files of a run; is its disk full?",
                worker=worker,
            )
        return {sha: known(self.blob)(sha) for sha in answer["needs"]}

    def failed(self, task: Task, error: BaseException) -> bool:
        """A task ended by an error; True where it is to be tried again. Raises InputError, and ``error`` itself."""
        if isinstance(error, (ImportError, AttributeError)):
            raise InputError(
                "studies.worker_without_us",
                "a worker has not this program, or another version of it: {reason}; install it there, or set PYTHONPATH",
                reason=" ".join(str(error).split())[:200],
            )
        if isinstance(error, OSError):
            self.broken_off(task, " ".join(str(error).split())[:200])
            return False
        if self.odd[task["job_hash"]] < ODD:
            self.odd[task["job_hash"]] += 1
            return True
        raise error

    def given_up(self, task: Task) -> None:
        """No worker survived it."""
        fact = core.Fact(
            "studies.worker_died",
            "each worker that was given it died; perhaps it needs more memory than they have",
        )
        self.broken_off(task, str(fact))

    def broken_off(self, task: Task, reason: str) -> None:
        """It did not come to an end, for reasons of its own no more than another try might show."""
        self.taken(
            {
                "job_hash": task["job_hash"],
                "status": table.FAILED,
                "figures": {},
                "error": reason,
                "passing": True,
                "field": None,
                "seconds": 0.0,
            }
        )


def _versions(held: Json) -> str:
    return ", ".join(f"{name} {version}" for name, version in held.items())
