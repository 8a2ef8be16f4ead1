"""Calls of functions side by side, on processes of this machine.

What comes back does not depend on how many processes there are, nor on which of them is ready first: answers stand in the
order of the calls, and every process computes with one thread.
"""

from __future__ import annotations

import collections
import time
from collections.abc import Callable, Sequence
from multiprocessing.connection import wait
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

from ..engine import InputError, core
from . import worker
from .kinds import Context
from .processes import LOOK_S, Process, cores, not_started, with_room

TRIES = 2  # of a call whose process dies
START_TRIES = 5  # of processes that die before they work


class Call(NamedTuple):
    """``function(*arguments)``; both must be picklable."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]


class Answer(NamedTuple):
    """What a call returned, or the error that it raised."""

    value: Any = None
    error: Exception | None = None


class _Worker:
    def __init__(self) -> None:
        try:
            self.process = Process()
        except OSError as error:
            raise not_started(str(error)) from None
        self.ready = False
        self.at: int | None = None  # the call that it works at


class Crew:
    """Processes that live for several ``run``. Used by ``with``; at its end they are gone."""

    def __init__(self, workers: int = 0, bytes_each: float = 0.0) -> None:
        """``workers``: at most, 0: one a core; fewer where memory has no room for ``bytes_each`` in each."""
        self.most = (
            min(workers or cores(), with_room(bytes_each)) if bytes_each else workers or cores()
        )
        self._workers: list[_Worker] = []
        self._failed_starts = 0

    def __enter__(self) -> Crew:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._end(self._workers)

    def run(
        self,
        calls: Sequence[Call],
        taken: Callable[[int, Answer], object] | None = None,
        over: Callable[[], bool] | None = None,
        context: Context = None,
    ) -> list[Answer | None]:
        """The answers of ``calls``, in their order. Calls begin in their order, too.

        ``taken(number, answer)``: is called for each as it comes; ``over()``: once it says so, what is not done is left, and its
        answer is None. ``context``: its progress is the share of calls that are done. A call whose process dies twice fails.
        Raises InputError where no process can be started, Cancelled; then no process works any more.
        """
        context = context or core.RunContext()
        found: list[Answer | None] = [None] * len(calls)
        waiting = collections.deque(range(len(calls)))
        deaths: collections.Counter[int] = collections.Counter()
        try:
            while waiting or self._busy():
                context.throw_if_cancelled()
                if over is not None and over():
                    break
                self._hand_out(calls, waiting)
                for each in self._heard():
                    done = self._hear(each, waiting, deaths)
                    if done is not None:
                        number, found[number] = done[0], done[1]
                        if taken is not None:
                            taken(*done)
                context.report(sum(one is not None for one in found) / max(len(calls), 1))
        finally:
            self._end(self._busy())
        return found

    def _busy(self) -> list[_Worker]:
        return [each for each in self._workers if each.at is not None]

    def _end(self, workers: list[_Worker]) -> None:
        for each in workers:
            each.process.end()
        self._workers = [each for each in self._workers if each not in workers]

    def _hand_out(self, calls: Sequence[Call], waiting: collections.deque[int]) -> None:
        while len(self._workers) < min(self.most, len(waiting) + len(self._busy())):
            self._workers.append(_Worker())
        for each in [one for one in self._workers if one.ready and one.at is None]:
            if not waiting:
                break
            each.at = waiting.popleft()
            try:
                each.process.send(*calls[each.at])
            except OSError:
                pass  # it has died, which is heard next

    def _heard(self) -> list[_Worker]:
        heard = wait([each.process.answers for each in self._workers], LOOK_S)
        return [each for each in self._workers if each.process.answers in heard]

    def _hear(
        self, each: _Worker, waiting: collections.deque[int], deaths: collections.Counter[int]
    ) -> tuple[int, Answer] | None:
        """The number of a call that is done, and its answer."""
        try:
            kind, value = each.process.answers.recv()
        except (EOFError, OSError):
            return self._died(each, waiting, deaths)
        if kind == worker.READY:
            each.ready, self._failed_starts = True, 0
            return None
        number, each.at = each.at, None
        assert number is not None
        return number, Answer(error=value) if kind == worker.FAILED else Answer(value)

    def _died(
        self, each: _Worker, waiting: collections.deque[int], deaths: collections.Counter[int]
    ) -> tuple[int, Answer] | None:
        said, number = each.process.said(), each.at
        self._end([each])
        if not each.ready:
            self._failed_starts += 1
            if self._failed_starts > START_TRIES:
                raise not_started(said)
        if number is None:
            return None
        deaths[number] += 1
        if deaths[number] < TRIES:
            waiting.appendleft(number)
            return None
        return number, Answer(
            error=InputError(
                "base.process_died",
                "a process that worked for this one has died, perhaps for want of memory: {reason}",
                reason=said or core.Fact("studies.no_answer", "no answer"),
            )
        )


class End(NamedTuple):
    """Until when something new may begin, also in other processes."""

    at: float  # s of the monotonic clock, which they have in common
    file: str = ""  # is there as long as it may; "": by the clock alone

    def passed(self, lasts: float = 0.0) -> bool:
        """For ``over``; whether something that ``lasts`` so many s would not end by then."""
        late = time.monotonic() + lasts >= self.at
        return late or (bool(self.file) and not Path(self.file).exists())
