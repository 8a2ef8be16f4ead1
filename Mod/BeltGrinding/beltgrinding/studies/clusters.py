"""Where a study's scheduler is: a LocalCluster of this machine, which is started and ended here, or one that is there."""

import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
import time
from pathlib import Path

from ..base.files import remove_tree
from ..engine import InputError, core

START_S = 60.0  # for a local cluster to start
ANSWER_S = 10.0  # for a scheduler to answer
END_S = 5.0  # for a local cluster to end by itself
KILLED_S = 0.5  # for one that says nothing more to be gone
TAIL = 300  # characters of what a cluster said that failed
# One simulation a core: libraries must not share it out further.
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def distributed():
    """The package. Raises InputError where it is missing."""
    try:
        import distributed as package
    except ImportError as error:
        raise InputError(
            "studies.no_distributed",
            "runs side by side need Dask (Debian: python3-distributed): {reason}; without it: one after the other, by "
            "--workers 0",
            reason=error,
        ) from None
    return package


def client(address):
    """A client of a scheduler. Raises OSError, ValueError, TimeoutError where none answers."""
    package = distributed()

    class Client(package.Client):
        def start(self, **options):
            try:
                super().start(**options)
            except BaseException:
                # Dask leaves its thread running, or closes it when the program ends: then it waits in vain.
                self.status = "connecting"
                self.close(timeout=ANSWER_S)
                raise

    return Client(address, timeout=ANSWER_S, set_as_default=False)


class There:
    """A scheduler that the user has started, at an ``address`` such as tcp://10.0.0.1:8786."""

    own = False

    def __init__(self, address):
        self.address = address

    def start(self, context):
        """Nothing is to be started."""

    def alive(self):
        """Whether it is worth asking again; nobody knows."""
        return True

    def close(self):
        """Nothing is to be ended."""


class Local:
    """A LocalCluster of so many worker processes on this machine."""

    own = True

    def __init__(self, workers):
        self.workers = workers
        self.address = self._process = self._folder = None
        self.said = ""  # the end of what the last one told on its standard error

    def start(self, context):
        """Starts it, where it does not run; one that is killed meanwhile has no ``address`` then. Raises InputError where it
        cannot be started, Cancelled."""
        if self._process is not None:
            return
        distributed()
        self._folder = Path(tempfile.mkdtemp(prefix="beltgrind-study-"))
        package = __package__
        with open(self._folder / "log", "wb") as log:
            self._process = subprocess.Popen(
                [
                    python(),
                    "-m",
                    f"{package}.local_cluster",
                    str(self.workers),
                    str(self._folder),
                ],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=_environment(),
                cwd=self._folder,
                start_new_session=True,
            )
        said = []
        reader = threading.Thread(
            target=lambda: said.append(self._process.stdout.readline()), daemon=True
        )
        reader.start()
        end = time.monotonic() + START_S
        while reader.is_alive() and time.monotonic() < end:
            context.throw_if_cancelled()
            reader.join(0.1)
        self.address = said[0].decode().strip() if said else ""
        if not self.address:
            killed = self._killed()
            self.close()
            if not killed:
                raise self.not_started()

    def not_started(self):
        """An InputError with what the last one told."""
        return InputError(
            "studies.cluster_not_started",
            "the workers could not be started: {reason}",
            reason=self.said or core.Fact("studies.no_answer", "no answer"),
        )

    def alive(self):
        """Whether it runs; one that has ended is started again by ``start``."""
        if self._process is not None and self._process.poll() is not None:
            self.close()
        return self._process is not None

    def _killed(self):
        """Whether a signal ended it."""
        try:
            return self._process.wait(KILLED_S) < 0
        except subprocess.TimeoutExpired:
            return False

    def _log(self):
        try:
            text = (self._folder / "log").read_text(errors="replace")
        except OSError:
            return ""
        return " ".join(text.split())[-TAIL:]

    def close(self):
        """Ends it with all its workers."""
        process, folder = self._process, self._folder
        if folder is not None:
            self.said = self._log()
        self._process = self._folder = self.address = None
        if process is not None:
            process.stdin.close()
            try:
                process.wait(END_S)
            except subprocess.TimeoutExpired:
                pass
            try:  # the whole group: a worker that computes does not hear that it should end
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
            process.stdout.close()
        if folder is not None:
            remove_tree(folder)


def python():
    """The Python that fits this process: FreeCAD's own executable is none."""
    if Path(sys.executable or "").name.startswith("python"):
        return sys.executable
    version = f"python{sys.version_info[0]}.{sys.version_info[1]}"
    for place in (sysconfig.get_config_var("BINDIR"), sys.exec_prefix + "/bin"):
        if place and os.access(Path(place, version), os.X_OK):
            return str(Path(place, version))
    return shutil.which(version) or "python3"


def _environment():
    """Of the cluster: it finds this package and this core."""
    package = Path(__file__).resolve().parents[2]
    places = [str(package), str(Path(core.__file__).resolve().parent)]
    if os.environ.get("PYTHONPATH"):
        places.append(os.environ["PYTHONPATH"])
    return {
        **os.environ,
        **{name: "1" for name in ONE_THREAD},
        "PYTHONPATH": os.pathsep.join(places),
    }
