"""A Slurm of one node on this machine, as it is installed: a controller and a node of the test's own, without munge."""

import getpass
import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ("slurmctld", "slurmd", "sbatch", "squeue", "scancel")
PLACES = "/usr/sbin:/usr/bin:/sbin:/bin"
START_S = 60.0

CONFIGURATION = """ClusterName=beltgrinding
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/node.pid
SlurmctldLogFile={folder}/controller.log
SlurmdLogFile={folder}/node.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Of the programs that it takes."""
    return [name for name in PROGRAMS if shutil.which(name, path=PLACES) is None]


def _free_ports(count):
    taken = [socket.socket() for _ in range(count)]
    try:
        for one in taken:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in taken]
    finally:
        for one in taken:
            one.close()


class DoesNotStart(Exception):
    """This machine does not let Slurm run; why."""


class Slurm:
    """In ``folder``, from ``start`` to ``stop``. ``environment``: in which its commands find it."""

    def __init__(self, folder, cores=2):
        self.folder = Path(folder)
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        controller, node = _free_ports(2)
        self.configuration = self.folder / "slurm.conf"
        self.configuration.write_text(
            CONFIGURATION.format(
                host=socket.gethostname().split(".")[0],
                user=getpass.getuser(),
                folder=self.folder,
                controller=controller,
                node=node,
                cores=cores,
            )
        )
        self.environment = {"SLURM_CONF": str(self.configuration)}
        self._running = []

    def start(self):
        """Until its node takes jobs. Raises DoesNotStart."""
        for program in ("slurmctld", "slurmd"):
            words = [shutil.which(program, path=PLACES), "-D", "-f", str(self.configuration)]
            with open(self.folder / f"{program}.out", "wb") as told:
                self._running.append(subprocess.Popen(words, stdout=told, stderr=told))
        end = time.monotonic() + START_S
        while "idle" not in self.ask("sinfo", "--noheader", "--format=%T"):
            if time.monotonic() > end:
                said = "\n".join(path.read_text() for path in self.folder.glob("*.[lo]*"))
                self.stop()
                raise DoesNotStart(said[-1000:])
            time.sleep(0.2)

    def ask(self, *words):
        """What a command of Slurm says."""
        environment = {**os.environ, **self.environment}
        done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=60)
        return done.stdout

    def wait(self, seconds):
        """Until no job is there."""
        end = time.monotonic() + seconds
        while self.ask("squeue", "--noheader").strip():
            assert time.monotonic() < end, "jobs are left"
            time.sleep(0.2)

    def stop(self):
        self.ask("scancel", f"--user={getpass.getuser()}")
        for one in reversed(self._running):
            one.terminate()
        for one in self._running:
            try:
                one.wait(20)
            except subprocess.TimeoutExpired:
                one.kill()
                one.wait()
