"""A study's runs on Dask workers: what is sent, what comes back, and what is done when workers or the scheduler go.

Records come back to whoever asked, who keeps them; workers need no common disk. A task tells a job by its hash, and files by
theirs; what a worker does not have it asks for, and gets it with the task's next try.
"""

from __future__ import annotations

import collections
import contextlib
import logging
import queue
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias


from ..engine import InputError
from . import clusters, one
from .delivery import Delivery

if TYPE_CHECKING:
    from ..engine import core
    from .clusters import There
    from .kinds import Blob, Blobs, DoneBy, Taken, Task, Working

LOGGERS = "asyncio distributed.client distributed.core distributed.comm".split()
LOOK_S = 0.1  # between two looks for a cancellation
CHECK_S = 2.0  # between two looks at the scheduler
WAIT_S = 60.0  # for the first worker, and for a scheduler that has gone
MORE = 2  # tasks waiting beside each one that is run
BLAMED = 2  # times that workers were lost with a run that was alone, after which it is given up
MISSED = (
    2  # looks in which a task is nowhere although workers are idle: then the scheduler has lost it
)


# Tasks that wait; those that Dask gave up as their workers died; how often each was lost alone, by job.
Waiting: TypeAlias = (
    "tuple[collections.deque[Task], collections.deque[Task], collections.Counter[str]]"
)


class Lost(Exception):
    """The scheduler has gone, or another one has taken its place."""


def run(
    where: There,
    tasks: Sequence[Task],
    blob: Blob | None,
    taken: Taken,
    context: core.RunContext,
    told: Working | None = None,
    done_by: DoneBy = one.in_worker,
) -> None:
    """As ``pool.run``, on the workers of a scheduler; ``where``: a ``clusters.There``."""
    distributed = clusters.distributed()
    with _quiet():
        _run(distributed, where, tasks, Delivery(blob, taken), done_by, context, told)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Dask's client logs what we see ourselves, such as a worker that is gone."""
    loggers = [logging.getLogger(name) for name in LOGGERS]
    before = [logger.level for logger in loggers]
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL + 1)
        yield
    finally:
        for logger, level in zip(loggers, before):
            logger.setLevel(level)


def _run(
    distributed: Any,
    where: There,
    tasks: Sequence[Task],
    delivery: Delivery,
    done_by: DoneBy,
    context: core.RunContext,
    told: Working | None,
) -> None:
    waiting = collections.deque(tasks)
    suspects: collections.deque[Task] = collections.deque()
    blamed = collections.Counter[str]()
    while waiting or suspects:
        client = _connected(where, len(waiting) + len(suspects), context)
        session = _Session(
            distributed, client, (waiting, suspects, blamed), delivery, done_by, context, told
        )
        try:
            session.work()
        except Lost:
            session.put_back()
        finally:
            session.close()


def _connected(where: There, open_runs: int, context: core.RunContext) -> Any:
    """A client. Raises InputError where nobody answers, Cancelled."""
    end, reason = time.monotonic() + WAIT_S, None
    while time.monotonic() < end:
        context.throw_if_cancelled()
        try:
            return where.client()
        except (OSError, ValueError, TimeoutError) as error:
            reason = error
            if isinstance(error, ValueError):  # the address is none
                break
            time.sleep(LOOK_S)
    raise InputError(
        "studies.no_scheduler",
        "no scheduler answers at {address}{reason}; {open} runs are open, those that have ended are kept: start the same "
        "study again when it is there",
        address=where.address,
        reason=f" ({' '.join(str(reason).split())[:160]})" if reason else "",
        open=open_runs,
    )


class _Session:
    """One client's connection."""

    def __init__(
        self,
        distributed: Any,
        client: Any,
        tasks: Waiting,
        delivery: Delivery,
        done_by: DoneBy,
        context: core.RunContext,
        told: Working | None,
    ) -> None:
        """``tasks``: two deques, of those that wait, and of those that Dask has given up because the workers that had them
        died; and how often, by job, one of these was lost with all workers while it was alone. One of these may only have been beside another that killed them: it is tried once more, alone.
        ``done_by``: what a worker does.
        """
        self.distributed, self.client = distributed, client
        self.waiting, self.suspects, self.blamed = tasks
        self.alone: str | None = None  # the key of a suspect's future
        self.delivery, self.done_by = delivery, done_by
        self.context, self.told = context, told
        self.flying: dict[str, tuple[Task, Any]] = {}  # future's key: (task, future)
        self.ended = queue.SimpleQueue[str]()
        self.missed = collections.Counter[str]()  # looks in which a task was nowhere, by key
        self.scheduler: str | None = None
        self.workers = 0
        self.number = 0

    def work(self) -> None:
        """Until all is done. Raises Lost, InputError, Cancelled."""
        looked, alone = 0.0, time.monotonic()
        while self.waiting or self.flying or self.suspects:
            self.context.throw_if_cancelled()
            if time.monotonic() - looked > CHECK_S:
                self._look()
                looked = time.monotonic()
                alone = looked if self.workers else alone
                if looked - alone > WAIT_S:
                    raise InputError(
                        "studies.no_workers",
                        "the scheduler {address} has no workers; start some (dask-worker), and the same study again",
                        address=self.client.scheduler.address,
                    )
            room = 0 if self.alone in self.flying else (1 + MORE) * self.workers
            while self.waiting and len(self.flying) < room:
                self._submit(self.waiting.popleft(), {})
            if self.suspects and self.workers and not self.flying:
                self._try_alone(self.suspects.popleft())
            try:
                key = self.ended.get(timeout=LOOK_S)
            except queue.Empty:
                continue
            if key in self.flying:
                self._take(*self.flying.pop(key), alone=key == self.alone)

    def put_back(self) -> None:
        """What is under way is to be done again."""
        for key in reversed(list(self.flying)):
            self._again(key, self.flying.pop(key)[0])

    def _again(self, key: str, task: Task) -> None:
        """It did not come to an end, for nothing that it is known to have done; alone it is the one to blame."""
        if key != self.alone:
            self.waiting.appendleft(task)
            return
        self.blamed[task["job_hash"]] += 1
        self.suspects.append(task)

    def _try_alone(self, task: Task) -> None:
        if self.blamed[task["job_hash"]] < BLAMED:
            self.alone = self._submit(task, {})
        else:
            self.delivery.given_up(task)

    def close(self) -> None:
        """Drops what is under way."""
        try:
            futures = [future for _, future in self.flying.values()]
            if futures and self.client.status == "running":
                self.client.cancel(futures, force=True)
            self.client.close(timeout=clusters.ANSWER_S)
        except Exception:  # of a connection that is gone; nothing is to be saved
            self.client.status = "closed"  # else Dask tries it again when the program ends

    def _look(self) -> None:
        """Who works, and whether it is still the same scheduler."""
        try:
            found = self.client.sync(
                self.client.scheduler.identity, callback_timeout=clusters.ANSWER_S
            )
            held = self.client.sync(
                self.client.scheduler.processing, callback_timeout=clusters.ANSWER_S
            )
        except Exception:  # whatever a broken connection raises
            raise Lost from None
        if self.scheduler not in (None, found["id"]) or self.client.status != "running":
            raise Lost
        self.scheduler = found["id"]
        workers = len(found["workers"])
        if workers != self.workers and self.told is not None:
            self.told(workers)
        self.workers = workers
        self._find_lost(held)

    def _find_lost(self, held: Mapping[str, Collection[str]]) -> None:
        """Dask's scheduler (2022.12) forgets tasks that wait while all workers die: these are done again. ``held``: keys of
        the tasks that each worker has."""
        workers_idle = any(not keys for keys in held.values())
        known = {key for keys in held.values() for key in keys}
        for key in list(self.flying):
            task, future = self.flying[key]
            nowhere = workers_idle and key not in known and future.status == "pending"
            self.missed[key] = self.missed[key] + 1 if nowhere else 0
            if self.missed[key] >= MISSED:
                del self.flying[key]
                self.client.cancel([future], force=True)
                self._again(key, task)

    def _submit(self, task: Task, blobs: Blobs, worker: str | None = None) -> str:
        self.number += 1
        try:
            future = self.client.submit(
                work,
                self.done_by,
                task,
                blobs,
                key=f"beltgrind-{task['job_hash']}-{self.number}",
                pure=False,
                workers=None if worker is None else [worker],
                allow_other_workers=worker is not None,
            )
        except Exception:  # whatever a broken connection raises
            self.waiting.appendleft(task)
            raise Lost from None
        self.flying[future.key] = (task, future)
        future.add_done_callback(lambda done: self.ended.put(done.key))
        return future.key

    def _take(self, task: Task, future: Any, alone: bool = False) -> None:
        if future.status == "finished":
            try:
                answer, worker = future.result(timeout=clusters.ANSWER_S)
            except Exception as error:
                if isinstance(error, InputError):
                    raise
                self._again(future.key, task)  # gone with its worker
                return
            self._answered(task, answer, worker, alone)
        elif future.status == "error":
            self._failed(task, future, alone)
        else:  # cancelled, lost: with the scheduler
            self._again(future.key, task)
            self._look()

    def _answered(
        self, task: Task, answer: dict[str, Any], worker: str, alone: bool = False
    ) -> None:
        sent = self.delivery.answered(task, answer, worker)
        if sent is not None:
            key = self._submit(task, sent, worker)
            self.alone = key if alone else self.alone

    def _failed(self, task: Task, future: Any, alone: bool) -> None:
        try:
            error = future.exception(timeout=clusters.ANSWER_S)
        except Exception:  # whatever a broken connection raises
            self._again(future.key, task)
            return
        if not isinstance(error, self.distributed.KilledWorker):
            if self.delivery.failed(task, error):
                self.waiting.append(task)
        elif alone:
            self.delivery.given_up(task)
        else:
            self.suspects.append(task)


def work(done_by: DoneBy, task: Task, blobs: Blobs) -> tuple[dict[str, Any], str]:
    """What a worker does: (the answer of ``done_by``, the worker's address)."""
    from distributed import get_worker

    worker = get_worker()
    return done_by(task, blobs, worker.local_directory), worker.address
