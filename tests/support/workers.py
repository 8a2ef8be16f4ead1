"""Processes of studies: who works for whom, workers that are killed at random, a Dask cluster started as by hand, by TLS."""

import os
import random
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

from beltgrinding.engine import core
from support.freecad import MOD


def descendants(pid):
    found, wanted = [], {pid}
    parents = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                text = Path("/proc", entry, "stat").read_text()
            except OSError:
                continue
            parents[int(entry)] = int(text.rpartition(")")[2].split()[1])
    while wanted:
        wanted = {child for child, parent in parents.items() if parent in wanted}
        found += wanted
    return found


def alive(pid):
    try:
        return Path("/proc", str(pid), "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def worker_processes(pid):
    """Those of the descendants that do a study's work."""
    found = []
    for child in descendants(pid):
        try:
            words = Path("/proc", str(child), "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if any(b"beltgrinding.base.worker" in word for word in words):
            found.append(child)
    return found


class Killer(threading.Thread):
    """Kills a worker of process ``pid`` at random, ``kills`` times, ``between`` so many seconds; with the probability
    ``whole`` all of them at once. ``killed``: how many it has, ``at_once``: how often all; ``tell(text)`` is called after each.
    """

    def __init__(self, pid, kills, seed=1, between=(0.3, 1.2), whole=0.0, tell=lambda text: None):
        super().__init__(daemon=True)
        self.tell = tell
        self.pid, self.left, self.dice = pid, kills, random.Random(seed)
        self.between, self.whole = between, whole
        self.over, self.killed, self.at_once = threading.Event(), 0, 0

    def run(self):
        while self.left and not self.over.wait(self.dice.uniform(*self.between)):
            found = [pid for pid in worker_processes(self.pid) if alive(pid)]
            if not found:
                continue
            if self.dice.random() < self.whole:
                self.at_once += 1
            else:
                found = [self.dice.choice(found)]
            for pid in found:
                os.kill(pid, signal.SIGKILL)
            self.left, self.killed = self.left - 1, self.killed + len(found)
            self.tell(f"{self.killed} workers killed, {self.at_once} times all at once")

    def stop(self):
        """Returns when it kills no more."""
        self.over.set()
        if self.is_alive():
            self.join()


def free_port():
    with socket.socket() as one_:
        one_.bind(("127.0.0.1", 0))
        return one_.getsockname()[1]


TLS = ("--tls-ca-file", "--tls-cert", "--tls-key")


def make_key(path):
    """A file with a key and its certificate, as docs/study-run.md has it made."""
    words = "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=study".split()
    command = ["openssl", *words, "-keyout", str(path), "-out", str(path)]
    subprocess.run(command, check=True, capture_output=True, umask=0o077)


class ByHand:
    """dask-scheduler and dask-worker as a person starts them, in another folder."""

    def __init__(self, folder, port=None):
        self.folder = folder
        folder.mkdir(exist_ok=True)
        self.port = port or free_port()
        self.address = f"tls://127.0.0.1:{self.port}"
        self.processes, self.key = [], folder / "key.pem"
        if not self.key.exists():
            make_key(self.key)
        self.tls = [word for name in TLS for word in (name, str(self.key))]
        place = ["--host", self.address, "--no-dashboard"]
        self.start("distributed.cli.dask_scheduler", *place, *self.tls)

    def start(self, module, *arguments, before=()):
        environment = {
            **os.environ,
            "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}",
            "DASK_TEMPORARY_DIRECTORY": str(self.folder),
        }
        process = subprocess.Popen(
            [*before, sys.executable, "-m", module, *arguments],
            cwd=self.folder,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=open(self.folder / "log", "ab"),
            start_new_session=True,
        )
        self.processes.append(process)
        return process

    def worker(self, *arguments, before=()):
        options = ["--no-dashboard", "--local-directory", str(self.folder), *self.tls, *arguments]
        return self.start("distributed.cli.dask_worker", self.address, *options, before=before)

    def stop(self):
        for process in self.processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.processes = []
