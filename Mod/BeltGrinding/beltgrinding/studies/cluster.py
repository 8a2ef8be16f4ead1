"""A study's runs on Dask workers: what is sent, what comes back, and what is done when workers or the scheduler go.

Records come back to whoever asked, who keeps them; workers need no common disk. A task tells a job by its hash, and files by
theirs; what a worker does not have it asks for, and gets it with the task's next try.
"""

import collections
import contextlib
import logging
import queue
import time

from ..engine import InputError, core
from . import clusters, one, table

LOGGERS = "asyncio distributed.client distributed.core distributed.comm".split()
LOOK_S = 0.1  # between two looks for a cancellation
CHECK_S = 2.0  # between two looks at the scheduler
WAIT_S = 60.0  # for the first worker, and for a scheduler that has gone
MORE = 2  # tasks waiting beside each one that is run
MOST_TRIES = 20  # of sending what a worker needs
ALONE_S = 60.0  # without a worker, after which a local cluster is started again
RESTARTS = 5  # of a local cluster, one after the other without a run in between
BLAMED = 2  # times that workers were lost with a run that was alone, after which it is given up
ODD = 3  # errors of a worker that are none of ours, such as of one that is just ending, after which a run's is told
MISSED = (
    2  # looks in which a task is nowhere although workers are idle: then the scheduler has lost it
)


class Lost(Exception):
    """The scheduler has gone, or another one has taken its place."""


def run(where, tasks, blob, taken, context, told=None, done_by=None):
    """Runs ``tasks`` (dicts as ``one.in_worker`` takes them) and calls ``taken(record)`` for each as it comes.

    ``where``: ``clusters.Local`` or ``There``; ``blob(sha256)``: the bytes of what a worker asks for; ``told(workers)``: how
    many processes work, when that changes; ``done_by``: what workers do in place of ``work``, of tasks with a ``job_hash``. Raises InputError, Cancelled; what was taken stays taken.
    """
    distributed = clusters.distributed()
    with _quiet():
        _run(distributed, where, tasks, (blob, done_by or work), taken, context, told)


@contextlib.contextmanager
def _quiet():
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


def _run(distributed, where, tasks, means, taken, context, told):
    waiting, suspects, blamed = collections.deque(tasks), collections.deque(), collections.Counter()
    restarts = 0

    def counted(record):
        nonlocal restarts
        restarts = 0
        taken(record)

    try:
        while waiting or suspects:
            context.throw_if_cancelled()
            if where.own and not where.alive():
                restarts += 1
                if restarts > RESTARTS:
                    raise _gone(where, len(waiting) + len(suspects))
            where.start(context)
            if where.own and where.address is None:  # killed as it started
                continue
            client = _connected(where, len(waiting) + len(suspects), context)
            session = _Session(
                distributed,
                client,
                where,
                (waiting, suspects, blamed),
                means,
                counted,
                context,
                told,
            )
            try:
                session.work()
            except Lost:
                session.put_back()
            finally:
                session.close()
    finally:
        where.close()


def _connected(where, open_runs, context):
    """A client. Raises InputError where nobody answers, Cancelled."""
    end, reason = time.monotonic() + WAIT_S, None
    while time.monotonic() < end:
        context.throw_if_cancelled()
        try:
            return clusters.client(where.address)
        except (OSError, ValueError, TimeoutError) as error:
            reason = error
            if isinstance(error, ValueError):  # the address is none
                break
            time.sleep(LOOK_S)
            if where.own and not where.alive():
                break
    raise _gone(where, open_runs, reason)


def _gone(where, open_runs, reason=None):
    if where.own:
        return where.not_started()
    return InputError(
        "studies.no_scheduler",
        "no scheduler answers at {address}{reason}; {open} runs are open, those that have ended are kept: start the same "
        "study again when it is there",
        address=where.address,
        reason=f" ({' '.join(str(reason).split())[:160]})" if reason else "",
        open=open_runs,
    )


class _Session:
    """One client's connection."""

    def __init__(self, distributed, client, where, tasks, means, taken, context, told):
        """``tasks``: two deques, of those that wait, and of those that Dask has given up because the workers that had them
        died; and how often, by job, one of these was lost with all workers while it was alone. One of these may only have been beside another that killed them: it is tried once more, alone.
        ``means``: what gives the bytes that a worker asks for, and what a worker does.
        """
        self.distributed, self.client, self.where = distributed, client, where
        self.waiting, self.suspects, self.blamed = tasks
        self.alone = None  # the key of a suspect's future
        (self.blob, self.done_by), self.taken = means, taken
        self.context, self.told = context, told
        self.flying = {}  # future's key: (task, future)
        self.ended = queue.SimpleQueue()
        self.tries = collections.Counter()  # of sending what a worker needs, by job
        self.odd = collections.Counter()  # errors that are none of ours, by job
        self.missed = collections.Counter()  # looks in which a task was nowhere, by key
        self.scheduler = None
        self.workers = 0
        self.number = 0

    def work(self):
        """Until all is done. Raises Lost, InputError, Cancelled."""
        looked, alone = 0.0, time.monotonic()
        while self.waiting or self.flying or self.suspects:
            self.context.throw_if_cancelled()
            if time.monotonic() - looked > CHECK_S:
                self._look()
                looked = time.monotonic()
                alone = looked if self.workers else alone
                if self.where.own and looked - alone > ALONE_S:
                    self.where.close()
                    raise Lost
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

    def put_back(self):
        """What is under way is to be done again."""
        for key in reversed(list(self.flying)):
            self._again(key, self.flying.pop(key)[0])

    def _again(self, key, task):
        """It did not come to an end, for nothing that it is known to have done; alone it is the one to blame."""
        if key != self.alone:
            self.waiting.appendleft(task)
            return
        self.blamed[task["job_hash"]] += 1
        self.suspects.append(task)

    def _try_alone(self, task):
        if self.blamed[task["job_hash"]] < BLAMED:
            self.alone = self._submit(task, {})
        else:
            self._give_up(task)

    def _give_up(self, task):
        fact = core.Fact(
            "studies.worker_died",
            "each worker that was given it died; perhaps it needs more memory than they have",
        )
        self.taken(broken_off(task["job_hash"], str(fact)))

    def close(self):
        """Drops what is under way."""
        try:
            futures = [future for _, future in self.flying.values()]
            if futures and self.client.status == "running":
                self.client.cancel(futures, force=True)
            self.client.close(timeout=clusters.ANSWER_S)
        except Exception:  # of a connection that is gone; nothing is to be saved
            self.client.status = "closed"  # else Dask tries it again when the program ends

    def _look(self):
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

    def _find_lost(self, held):
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

    def _submit(self, task, blobs, worker=None):
        self.number += 1
        try:
            future = self.client.submit(
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

    def _take(self, task, future, alone=False):
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

    def _answered(self, task, answer, worker, alone=False):
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
            return
        self.tries[task["job_hash"]] += 1
        if self.tries[task["job_hash"]] > MOST_TRIES:
            raise InputError(
                "studies.files_do_not_arrive",
                "the worker {worker} asks again and again for the files of a run; is its disk full?",
                worker=worker,
            )
        key = self._submit(task, {sha: self.blob(sha) for sha in answer["needs"]}, worker)
        self.alone = key if alone else self.alone

    def _failed(self, task, future, alone):
        try:
            error = future.exception(timeout=clusters.ANSWER_S)
        except Exception:  # whatever a broken connection raises
            self._again(future.key, task)
            return
        if isinstance(error, self.distributed.KilledWorker):
            if not alone:
                self.suspects.append(task)
                return
            self._give_up(task)
        elif isinstance(error, (ImportError, AttributeError)):
            raise InputError(
                "studies.worker_without_us",
                "a worker has not this program, or another version of it: {reason}; install it there, or set PYTHONPATH",
                reason=" ".join(str(error).split())[:200],
            )
        elif isinstance(error, OSError):
            text = " ".join(str(error).split())[:200]
            self.taken(broken_off(task["job_hash"], text))
        elif self.odd[task["job_hash"]] < ODD:
            self.odd[task["job_hash"]] += 1
            self.waiting.append(task)
        else:
            raise error


def broken_off(job_hash, reason):
    """The record of a run that did not come to an end, for reasons of its own no more than another try might show."""
    return {
        "job_hash": job_hash,
        "status": table.FAILED,
        "figures": {},
        "error": reason,
        "passing": True,
        "field": None,
        "seconds": 0.0,
    }


def _versions(held):
    return ", ".join(f"{name} {version}" for name, version in held.items())


def work(task, blobs):
    """What a worker does: (the answer of ``one.in_worker``, the worker's address)."""
    from distributed import get_worker

    worker = get_worker()
    return one.in_worker(task, blobs, worker.local_directory), worker.address
