"""A process that does what it is sent; processes.py starts it.

Work comes by its standard input, answers go by its standard output: pipes that nobody has but who started it. It ends with
that process, at once, whatever it is doing then.
"""

from __future__ import annotations

import fcntl
import os
import queue
import select
import signal
import threading
import traceback
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from multiprocessing.reduction import ForkingPickler
from typing import Any

READY, TOLD, DONE, FAILED = "ready", "told", "done", "failed"  # kinds of answers


def main(life: int) -> None:
    """Runs until whoever started it has ended; ``life``: the descriptor of a pipe that is closed then."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who started it hears Ctrl-C, and ends it
    _end_with(life)
    given = Connection(os.dup(0), writable=False)
    answers = Connection(os.dup(1), readable=False)
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    os.dup2(2, 1)  # what a library prints is no answer
    tasks = queue.SimpleQueue[Any]()
    threading.Thread(target=_listen, args=(given, tasks), daemon=True).start()
    answers.send((READY, None))
    while True:
        function, arguments, told = tasks.get()
        answers.send_bytes(_answer(function, arguments, told, answers))


def _end_with(life: int) -> None:
    """Has the kernel end this process when the pipe's other end is closed: a thread that watched it could not while a
    library holds Python's lock."""
    fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(life, fcntl.F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
    if select.select([life], [], [], 0)[0]:  # it had ended before
        os._exit(1)


def _listen(given: Connection, tasks: queue.SimpleQueue[Any]) -> None:
    """Takes work while other work is done, so that whoever sends it need not wait."""
    try:
        while True:
            tasks.put(given.recv())
    except EOFError:
        os._exit(0)
    except BaseException:
        traceback.print_exc()
        os._exit(1)


def _answer(
    function: Callable[..., object], arguments: Sequence[Any], told: bool, answers: Connection
) -> bytes | memoryview:
    """The bytes of an answer. ``told``: whether the function takes a context, whose progress is sent."""
    try:
        options = {"context": _Context(answers)} if told else {}
        return ForkingPickler.dumps((DONE, function(*arguments, **options)))
    except Exception as error:
        if hasattr(error, "add_note"):
            error.add_note(traceback.format_exc())
        try:
            return ForkingPickler.dumps((FAILED, error))
        except Exception:  # such an error cannot be sent itself
            return ForkingPickler.dumps((FAILED, RuntimeError(traceback.format_exc())))


class _Context:
    """A RunContext of work that is cancelled by its end."""

    def __init__(self, answers: Connection) -> None:
        self.answers = answers

    def report(self, share: float) -> None:
        self.answers.send((TOLD, share))

    def throw_if_cancelled(self) -> None:
        """Never."""
