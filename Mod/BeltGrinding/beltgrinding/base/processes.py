"""Processes of our own, over pipes: no port, no name in a file system by which another could reach them.

``Process`` is one; ``apart`` runs one function in one and waits for it; ``crew.Crew`` runs calls on several, ``studies.pool``
many tasks. They are a Python of their own, so that they need nothing of the program that wants them: not its executable (FreeCAD's is no Python), nor that its
script could be imported again, nor its terminal, whose Ctrl-C would reach them.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, TypeVar

from ..engine import InputError, core
from . import worker
from .kinds import Context

LOOK_S = 0.1  # between two looks for a cancellation
TRIES = 4  # of what is done apart, where its process dies
TAIL = 300  # characters of what a process said that failed
START = f"import sys; from {__package__}.worker import main; main(int(sys.argv[1]))"
# One simulation a core: libraries must not share it out further.
T = TypeVar("T")

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Process:
    """A process that works for this one, and ends with it. ``answers``: the Connection of what it sends, see worker.py.
    Raises OSError where it cannot be started."""

    def __init__(self) -> None:
        self._log = tempfile.TemporaryFile()
        # Descriptors of new pipes are handed on to nobody else.
        (work, given), (answers, answer), (life, alive) = os.pipe(), os.pipe(), os.pipe()
        self._given, self._alive = Connection(given, readable=False), alive
        self.answers = Connection(answers, writable=False)
        try:
            self._process = subprocess.Popen(
                [python(), "-c", START, str(life)],
                stdin=work,
                stdout=answer,
                stderr=self._log,
                pass_fds=[life],
                env=_environment(),
                cwd="/",  # a folder in which nobody else puts what Python would import
                start_new_session=True,
            )
        except BaseException:
            self._close()
            raise
        finally:
            for number in (work, answer, life):
                os.close(number)

    def send(
        self, function: Callable[..., object], arguments: Sequence[Any], told: bool = False
    ) -> None:
        """Has it do ``function(*arguments)``, after what it was sent before. ``told``: the function takes a ``context`` by
        whose progress it answers, too. Raises OSError where it has gone."""
        self._given.send((function, arguments, told))

    def said(self) -> str:
        """The end of what it told on its standard error."""
        size = os.fstat(self._log.fileno()).st_size
        begin = max(size - 4 * TAIL, 0)
        text = os.pread(self._log.fileno(), size - begin, begin).decode(errors="replace")
        return " ".join(text.split())[-TAIL:]

    @property
    def pid(self) -> int:
        return self._process.pid

    def end(self) -> None:
        """Ends it, whatever it is doing."""
        try:
            os.killpg(self._process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self._process.wait()
        self._close()

    def _close(self) -> None:
        self._given.close()
        self.answers.close()
        os.close(self._alive)
        self._log.close()


def apart(function: Callable[..., T], *arguments: Any, context: Context = None) -> T:
    """``function(*arguments, context=...)``, in a process of its own: for a library that does to its process what it likes.

    ``context``: its progress is that of the function, which need not look for a cancellation. Raises what the function raises,
    InputError where the process does not live, Cancelled."""
    context = context or core.RunContext()
    for left in reversed(range(TRIES)):
        try:
            process = Process()
        except OSError as error:
            raise not_started(str(error)) from None
        try:
            process.send(function, arguments, told=True)
            kind, value = _heard(process, context)
            break
        except (EOFError, OSError):  # it has died, perhaps since somebody killed it
            if not left:
                raise not_started(process.said()) from None
        finally:
            process.end()
    if kind == worker.FAILED:
        raise value
    found: T = value
    return found


def _heard(process: Process, context: core.RunContext) -> tuple[str, Any]:
    """Its last answer. Raises EOFError, OSError, Cancelled."""
    while True:
        context.throw_if_cancelled()
        if not process.answers.poll(LOOK_S):
            continue
        kind, value = process.answers.recv()
        if kind == worker.TOLD:
            context.report(value)
        elif kind != worker.READY:
            return kind, value


def not_started(said: str) -> InputError:
    """The InputError of processes that do not live, with what the last one told."""
    return InputError(
        "studies.cluster_not_started",
        "the workers could not be started: {reason}",
        reason=said or core.Fact("studies.no_answer", "no answer"),
    )


def python() -> str:
    """The Python that fits this process: FreeCAD's own executable is none."""
    if Path(sys.executable or "").name.startswith("python"):
        return sys.executable
    version = f"python{sys.version_info[0]}.{sys.version_info[1]}"
    for place in (sysconfig.get_config_var("BINDIR"), sys.exec_prefix + "/bin"):
        if place and os.access(Path(place, version), os.X_OK):
            return str(Path(place, version))
    return shutil.which(version) or "python3"


def _environment() -> dict[str, str]:
    """Of the processes: they find this package and this core."""
    package = Path(__file__).resolve().parents[2]
    places = [str(package), str(Path(core.__file__).resolve().parent)]
    if os.environ.get("PYTHONPATH"):
        places.append(os.environ["PYTHONPATH"])
    return {
        **os.environ,
        **{name: "1" for name in ONE_THREAD},
        "PYTHONPATH": os.pathsep.join(places),
    }


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def with_room(bytes_each: float) -> int:
    """How many processes, one a core at most, find so many bytes of memory each now; 1 at least."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        free = next(int(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration, ValueError):
        return cores()
    return max(1, min(cores(), int(1024 * free // max(bytes_each, 1.0))))
