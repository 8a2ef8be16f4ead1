"""Many tasks on processes of this machine, over pipes: what is handed out, and what is done when processes die.

Records come back to whoever asked, who keeps them. A process has the task that it works at and, as long as there are enough, the
next one, so that it need not wait for us. One that dies is replaced; who is to blame is known: the task that it worked at.
"""

from __future__ import annotations

import collections
import time
from collections.abc import Sequence
from multiprocessing.connection import wait
from typing import TYPE_CHECKING, TypeAlias

from ..base import worker
from ..base.processes import LOOK_S, Process, not_started
from . import one
from .delivery import Delivery

if TYPE_CHECKING:
    from ..engine import core
    from .kinds import Blob, Blobs, DoneBy, Taken, Task, Working

AHEAD = 1  # tasks of a process beside the one that it works at
START_S = 60.0  # for a process to start
RESTARTS = 5  # processes that die before they work, one after the other, until that is told
BESIDE, ALONE = (
    2,
    2,
)  # deaths of processes with a task: after the first it has all for itself, after both it is given up

Sent: TypeAlias = "tuple[Task, Blobs]"  # a task with what is sent along


def run(
    workers: int,
    tasks: Sequence[Task],
    blob: Blob | None,
    taken: Taken,
    context: core.RunContext,
    told: Working | None = None,
    done_by: DoneBy = one.in_worker,
) -> None:
    """Runs ``tasks`` (dicts with a ``job_hash``) on so many processes and calls ``taken(record)`` for each as it comes.

    ``blob(sha256)``: the bytes of what a worker asks for; ``told(workers)``: how many processes work, when that changes;
    ``done_by(task, blobs, folder)``: what they do, as ``one.in_worker``. Raises InputError, Cancelled; what was taken stays taken.
    """
    pool = _Pool(workers, tasks, Delivery(blob, taken), told, done_by)
    try:
        pool.work(context)
    finally:
        pool.end()


class _Worker:
    """A process, and what it was given."""

    def __init__(self) -> None:
        self.process, self.begun = Process(), time.monotonic()
        self.ready = False
        self.tasks = collections.deque[Sent]()  # in the order of its answers


class _Pool:
    def __init__(
        self,
        most: int,
        tasks: Sequence[Task],
        delivery: Delivery,
        told: Working | None,
        done_by: DoneBy,
    ) -> None:
        self.most, self.delivery, self.told, self.done_by = most, delivery, told, done_by
        self.waiting = collections.deque[Sent]((task, {}) for task in tasks)
        self.suspects = collections.deque[Sent]()  # each is to be tried alone
        self.deaths = collections.Counter[str]()
        self.alone: str | None = None
        self.workers: list[_Worker] = []
        self.working, self.restarts = 0, 0

    def work(self, context: core.RunContext) -> None:
        """Until all is done."""
        while open_ := len(self.waiting) + len(self.suspects) + self._flying():
            context.throw_if_cancelled()
            while len(self.workers) < min(self.most, open_):
                self._start()
            self._hand_out()
            heard = wait([each.process.answers for each in self.workers], LOOK_S)
            for each in [each for each in self.workers if each.process.answers in heard]:
                self._hear(each)
            for each in [each for each in self.workers if not each.ready]:
                if time.monotonic() - each.begun > START_S:
                    self._gone(each)
            self._tell()

    def end(self) -> None:
        """Ends all processes."""
        for each in self.workers:
            each.process.end()
        self.workers = []

    def _flying(self) -> int:
        return sum(len(each.tasks) for each in self.workers)

    def _start(self) -> None:
        try:
            self.workers.append(_Worker())
        except OSError as error:
            raise not_started(str(error)) from None

    def _tell(self) -> None:
        working = sum(each.ready for each in self.workers)
        if working != self.working and self.told is not None:
            self.told(working)
        self.working = working

    def _hand_out(self) -> None:
        ready = [each for each in self.workers if each.ready]
        if self.alone is not None or not ready:
            return
        if self.suspects and not self.waiting and not self._flying():
            task, blobs = self.suspects.popleft()
            self.alone = task["job_hash"]
            self._send(ready[0], task, blobs)
            return
        for held in range(1 + AHEAD):
            for each in ready:
                # The last ones go to whoever is free first.
                enough = held == 0 or len(self.waiting) > len(self.workers)
                if len(each.tasks) == held and self.waiting and enough:
                    self._send(each, *self.waiting.popleft())

    def _send(self, each: _Worker, task: Task, blobs: Blobs) -> None:
        each.tasks.append((task, blobs))
        try:
            each.process.send(self.done_by, (task, blobs, None))
        except OSError:  # it has died, which is heard next
            each.tasks.pop()
            self._again(task, blobs)

    def _again(self, task: Task, blobs: Blobs) -> None:
        """For nothing that it has done it is to be done again, at once."""
        if self.alone == task["job_hash"]:
            self.alone = None
            self.suspects.appendleft((task, blobs))
        else:
            self.waiting.appendleft((task, blobs))

    def _hear(self, each: _Worker) -> None:
        try:
            kind, value = each.process.answers.recv()
        except (EOFError, OSError):
            self._gone(each)
            return
        if kind == worker.READY:
            each.ready, self.restarts = True, 0
            return
        task, blobs = each.tasks.popleft()
        if kind == worker.FAILED:
            sent: Blobs | None = {} if self.delivery.failed(task, value) else None
        else:
            sent = self.delivery.answered(task, value, f"process {each.process.pid}")
        if sent is not None:
            self._again(task, {**blobs, **sent})
        elif self.alone == task["job_hash"]:
            self.alone = None

    def _gone(self, each: _Worker) -> None:
        """A process has died, or does not start."""
        self.workers.remove(each)
        said = each.process.said()
        each.process.end()
        if not each.ready:
            self.restarts += 1
            if self.restarts > RESTARTS:
                raise not_started(said)
        for task, blobs in reversed(list(each.tasks)[1:]):
            self._again(task, blobs)
        if each.tasks:
            self._blame(*each.tasks[0])

    def _blame(self, task: Task, blobs: Blobs) -> None:
        """It may only have been beside another that took all memory: at last it is tried alone."""
        self.alone = None
        self.deaths[task["job_hash"]] += 1
        deaths = self.deaths[task["job_hash"]]
        if deaths < BESIDE:
            self.waiting.appendleft((task, blobs))
        elif deaths < BESIDE + ALONE:
            self.suspects.append((task, blobs))
        else:
            self.delivery.given_up(task)
