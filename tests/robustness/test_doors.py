"""Nothing that this program starts listens: no port, no named or abstract socket, of whatever processes it has.

Each is looked at while it works. What Dask's own programs open, which a user may start, is not ours; how they are reached is.
"""

import functools
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from beltgrinding import cli
from beltgrinding.engine import InputError, core
from beltgrinding.studies import clusters, making
from support.doors import doors
from support.freecad import MOD, SHARED
from support.workers import ByHand, descendants, make_key, worker_processes
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]

RUNS = 12


def given():
    """A study whose design is made by OpenTURNS."""
    job = plate_job()
    job["sampling"]["spacing_mm"] = 0.3
    job["cell"] = {"check_collisions": False}
    vary = [{"name": "force", "key": "belt_machine.force_N", "range": [20, 60]}]
    return {"job": job, "vary": vary, "design": {"method": "sobol", "runs": RUNS}}


def start(*arguments, **options):
    environment = {**os.environ, "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}"}
    return subprocess.Popen(
        [sys.executable, *map(str, arguments)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        **options,
    )


def watched(process, seconds=120):
    """(doors, workers, other processes) that were seen until a process has ended."""
    found, workers, others, end = set(), set(), set(), time.monotonic() + seconds
    while process.poll() is None and time.monotonic() < end:
        found.update(doors(process.pid))
        workers.update(worker_processes(process.pid))
        others.update(set(descendants(process.pid)) - workers)
        time.sleep(0.02)
    return found, workers, others


LISTENERS = """
import os, socket, sys, time
held = [socket.socket(getattr(socket, f), getattr(socket, k)) for f, k in
        [("AF_INET", "SOCK_STREAM"), ("AF_INET6", "SOCK_STREAM"), ("AF_INET", "SOCK_DGRAM"), ("AF_UNIX", "SOCK_STREAM"),
         ("AF_UNIX", "SOCK_STREAM"), ("AF_UNIX", "SOCK_DGRAM")]]
for one, place in zip(held, [("127.0.0.1", 0), ("::", 0), ("0.0.0.0", 0), "named", "\\0beltgrind-abstract", "letters"]):
    one.bind(place)
for one in (held[0], held[1], held[3], held[4]):
    one.listen()
there, here = socket.socketpair()  # connected to each other alone: no door
print(flush=True)
time.sleep(60)
"""


def test_what_listens_is_seen(tmp_path):
    command = [
        sys.executable,
        "-c",
        f"import subprocess, sys\nsubprocess.run([sys.executable, '-c', {LISTENERS!r}])",
    ]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE)
    try:
        process.stdout.readline()
        found = [one.partition(": ")[2] for one in doors(process.pid)]
        assert doors(process.pid, family=False) == []
    finally:
        for pid in descendants(process.pid):
            os.kill(pid, 9)
        process.communicate()
    wanted = [
        "tcp 127.0.0.1:",
        "tcp6 :::",
        "udp 0.0.0.0:",
        "unix named",
        "unix @beltgrind-abstract",
        "unix letters",
    ]
    assert len(found) == len(wanted), found
    for one in wanted:
        assert any(door.startswith(one) for door in found), (one, found)


@pytest.mark.parametrize("options", [[], ["--workers", "2"], ["--workers", "0"]])
def test_a_study_listens_nowhere(tmp_path, options):
    pytest.importorskip("openturns")
    path = tmp_path / "study.json"
    path.write_text(json.dumps(given()))
    process = start(MOD / "beltgrind.py", "study", path, "-o", tmp_path / "out", *options)
    found, workers, _ = watched(process)
    assert process.wait() == 0, process.stderr.read()
    assert not found
    assert workers  # the one of OpenTURNS at least
    assert len(workers) >= 3 or options == ["--workers", "0"] or len(os.sched_getaffinity(0)) < 2
    assert (tmp_path / "out" / "report.html").exists()


@pytest.mark.parametrize("command", ["run", "plan", "report", "view"])
def test_other_commands_listen_nowhere(tmp_path, command):
    path = tmp_path / "job.json"
    path.write_text(json.dumps(given()["job"]))
    out = tmp_path / "out"
    asked = {"run": ["run", path, "-o", out], "plan": ["plan", path, "-o", out]}
    if command in ("report", "view"):
        assert cli.main(["run", str(path), "-o", str(out), "--quiet"]) == 0
        asked[command] = [command, out]
    process = start(MOD / "beltgrind.py", *asked[command])
    found, _, _ = watched(process)
    assert process.wait() == 0, process.stderr.read()
    assert not found


@pytest.mark.skipif(not SHARED.is_dir(), reason=f"no shared data at {SHARED}")
def test_the_reader_of_foreign_files_listens_nowhere():
    spring = SHARED / "data" / "cad_nasty" / "spring_invalid.igs"
    code = f"from beltgrinding.engine import core; core.triangulate(core.Shape.read({str(spring)!r}), 0.1)"
    process = start("-c", code)
    try:
        seen, end = set(), time.monotonic() + 60
        while len(seen) < 20 and time.monotonic() < end:
            found = doors(process.pid)
            assert not found
            seen.update((pid, time.monotonic()) for pid in descendants(process.pid))
            time.sleep(0.05)
        assert len(seen) >= 20, process.stderr.read()
    finally:
        process.kill()
        process.communicate()


# A scheduler of the user's ---------------------------------------------------------------------------------


@pytest.fixture
def by_hand(tmp_path):
    pytest.importorskip("distributed")
    made = ByHand(tmp_path / "elsewhere")
    yield made
    made.stop()


def small():
    job = {**given(), "design": {"method": "grid"}}
    job["vary"] = [{"name": "force", "key": "belt_machine.force_N", "values": [20, 30]}]
    return job


def test_who_asks_a_scheduler_listens_nowhere(tmp_path, by_hand):
    by_hand.worker("--nthreads", "1")
    path = tmp_path / "study.json"
    path.write_text(json.dumps(given()))
    where = ["--scheduler", by_hand.address, "--tls", by_hand.key]
    process = start(MOD / "beltgrind.py", "study", path, "-o", tmp_path / "out", *where)
    found, _, _ = watched(process)
    assert process.wait() == 0, process.stderr.read()
    assert not found


def test_a_scheduler_takes_nobody_without_the_key(tmp_path, by_hand, monkeypatch):
    from beltgrinding.studies import cluster

    by_hand.worker("--nthreads", "1")
    study = functools.partial(making.study, small(), scheduler=by_hand.address)
    assert study(tls=by_hand.key).table.done.all()
    make_key(tmp_path / "other.pem")
    monkeypatch.setattr(cluster, "WAIT_S", 1.0)
    monkeypatch.setattr(clusters, "ANSWER_S", 1.0)
    with pytest.raises(InputError, match=f"no scheduler answers at {by_hand.address}"):
        study(tls=tmp_path / "other.pem")
    with pytest.raises(InputError, match="no scheduler answers"):
        making.study(small(), scheduler=by_hand.address.replace("tls", "tcp"), tls=False)
    with pytest.raises(InputError, match="give the file of it by --tls"):
        study()


def test_a_scheduler_without_tls_is_asked_only_if_that_is_wanted(tmp_path, capsys):
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="whoever reaches its port can run programs as you"):
        making.study(small(), scheduler="tcp://127.0.0.1:1")
    with pytest.raises(InputError, match="give its address too"):
        making.study(small(), workers=2, tls=False)
    path = tmp_path / "study.json"
    path.write_text(json.dumps(small()))
    command = ["study", str(path), "-o", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:1"]
    assert cli.main(command) == 2
    assert "or give --without-tls" in capsys.readouterr().err


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620, 0o602])
def test_a_key_that_others_may_read_or_write_is_refused(tmp_path, mode):
    make_key(tmp_path / "key.pem")
    assert (tmp_path / "key.pem").stat().st_mode & 0o777 == 0o600
    clusters.check_key(tmp_path / "key.pem")
    (tmp_path / "key.pem").chmod(mode)
    with pytest.raises(InputError, match="chmod 600"):
        clusters.There("tls://127.0.0.1:1", tmp_path / "key.pem")


def test_a_key_that_is_none_is_told(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        clusters.check_key(tmp_path / "key.pem")
    (tmp_path / "key.pem").touch(0o600)
    with pytest.raises(InputError, match="no PEM file with a key"):
        clusters.check_key(tmp_path / "key.pem")
    make_key(tmp_path / "whole.pem")
    text = (tmp_path / "whole.pem").read_text()
    (tmp_path / "key.pem").write_text(text[text.index("-----BEGIN CERT") :])
    with pytest.raises(InputError, match="no PEM file with a key"):
        clusters.check_key(tmp_path / "key.pem")
    with pytest.raises(InputError, match="chmod 600"):
        clusters.check_key(tmp_path)
    if os.geteuid() == 0:
        os.chown(tmp_path / "whole.pem", 65534, 65534)
        with pytest.raises(InputError, match="a file of your own"):
            clusters.check_key(tmp_path / "whole.pem")
