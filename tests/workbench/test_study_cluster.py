"""Studies on other processes: workers that are killed, a scheduler started by hand elsewhere, one that restarts, files that are sent."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.studies import cluster, clusters, making, one, store, table
from beltgrinding.studies.delivery import Delivery
from support.freecad import MOD
from support.workers import ByHand, alive, worker_processes
from test_study import program_job, quick_job, study_of

RUNS = 24
SPACING = (
    0.12  # mm: a run takes so long that what happens between runs is seen, however fast the machine
)
BETWEEN = 4  # runs from a kill to the next


def many(runs=RUNS):
    """A study of several variables, drawn at random; a job in it cannot be run."""
    bands = [[-0.05, 0.05], [-0.1, 0.1], [0.1, -0.1]]
    job = quick_job()
    job["sampling"]["spacing_mm"] = SPACING
    return {
        "job": job,
        "vary": [
            {"name": "force", "key": "belt_machine.force_N", "range": [20, 60]},
            {
                "name": "off",
                "key": "stock_placement.rx_deg",
                "distribution": {"kind": "normal", "mean": 0, "sd": 0.1},
            },
            {
                "name": "band",
                "key": "inspection.tolerance_mm",
                "values": bands,
                "weights": [12, 12, 1],
            },
        ],
        "design": {"method": "monte_carlo", "runs": runs, "seed": 7},
    }


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """The bytes of the table of ``many`` runs one after the other."""
    folder = tmp_path_factory.mktemp("serial")
    found = making.study(many(), folder, workers=0)
    assert found.table.done.sum() > 0.8 * RUNS and (found.table["status"] == "error").any()
    return (folder / table.FILE).read_bytes()


@pytest.mark.slow
def test_workers_that_are_killed_change_no_bit_of_the_table(tmp_path, serial):
    """By what is done, not by the clock: runs take what the machine takes."""
    dice, killed = random.Random(1), []

    def told(progress):
        if progress.done >= BETWEEN * len(killed) + 1 and progress.done < RUNS - 1:
            found = [pid for pid in worker_processes(os.getpid()) if alive(pid)]
            if found:
                killed.append(dice.choice(found))
                os.kill(killed[-1], signal.SIGKILL)

    found = making.study(many(), tmp_path, workers=2, told=told)
    assert len(killed) >= 3 and not found.broken_off
    assert (tmp_path / table.FILE).read_bytes() == serial
    assert not worker_processes(os.getpid())


@pytest.mark.slow
def test_a_cancelled_study_ends_its_workers_and_goes_on(tmp_path, serial):
    context = core.RunContext()

    def told(progress):
        if progress.done >= 3:
            context.cancel()

    with pytest.raises(Cancelled):
        making.study(many(), tmp_path, workers=2, told=told, context=context)
    assert not worker_processes(os.getpid())
    finished = len(list((tmp_path / store.RUNS).glob("*/*.json")))
    assert 3 <= finished < RUNS
    assert making.study(many(), tmp_path, workers=2).reused == finished
    assert (tmp_path / table.FILE).read_bytes() == serial


@pytest.mark.slow
def test_workers_that_all_die_at_once_are_started_again(tmp_path, serial):
    died = []

    def told(progress):
        if progress.done >= 5 and not died:
            died.extend(worker_processes(os.getpid()))
            for pid in died:
                os.kill(pid, signal.SIGKILL)

    making.study(many(), tmp_path, workers=2, told=told)
    assert died and (tmp_path / table.FILE).read_bytes() == serial


@pytest.mark.slow
def test_workers_that_are_killed_as_they_start_are_started_again(tmp_path, serial):
    prepared, killed = making.prepare(making.validate(many())), []

    def kill():
        while len(killed) < 4:
            for pid in worker_processes(os.getpid()):
                if pid not in killed:
                    killed.append(pid)
                    os.kill(pid, signal.SIGKILL)
            time.sleep(0.02)

    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    making.run(prepared, tmp_path, workers=2)
    killer.join()
    assert killed and (tmp_path / table.FILE).read_bytes() == serial


# A cluster that is there -------------------------------------------------------------------------------


@pytest.fixture
def by_hand(tmp_path):
    made = ByHand(tmp_path / "elsewhere")
    yield made
    made.stop()


@pytest.mark.slow
def test_a_scheduler_that_was_started_by_hand_in_another_folder(tmp_path, by_hand, serial, capsys):
    by_hand.worker("--nthreads", "1")
    by_hand.worker("--nthreads", "3")  # one run at a time in a process all the same
    path = tmp_path / "study.json"
    path.write_text(json.dumps(many()))
    command = ["study", str(path), "-o", str(tmp_path / "out"), "--scheduler", by_hand.address]
    command += ["--tls", str(by_hand.key)]
    assert cli.main(command) == 0
    assert f"of {RUNS} runs have figures" in capsys.readouterr().out
    assert (tmp_path / "out" / table.FILE).read_bytes() == serial
    assert all(process.poll() is None for process in by_hand.processes)  # it is the user's


def need_mounts():
    if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
        pytest.skip("a mount namespace needs root")


FILLED = """
beltgrind() { "$PYTHON" "$BELTGRIND" study "$1/study.json" -o "$1/out" --workers 2 --no-report; }
mkdir "$1/out" && mount -t tmpfs -o size=72k none "$1/out" || exit 9
beltgrind "$1" >"$1/first" 2>&1
echo $? >"$1/status"
ls "$1"/out/runs/*/*.json | wc -l >"$1/finished"
mount -o remount,size=16m "$1/out"
beltgrind "$1" >"$1/second" 2>&1
cp "$1/out/table.csv" "$1/table.csv"
"""


@pytest.mark.slow
def test_a_disk_that_is_full_loses_no_run_of_a_cluster(tmp_path, serial):
    need_mounts()
    (tmp_path / "study.json").write_text(json.dumps(many()))
    environment = {
        **os.environ,
        "PYTHON": sys.executable,
        "BELTGRIND": str(MOD / "beltgrind.py"),
        "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}",
        "LANG": "C.UTF-8",
    }
    command = ["unshare", "--mount", "bash", "-c", FILLED, "full", str(tmp_path)]
    assert subprocess.run(command, env=environment, timeout=240).returncode == 0
    assert (tmp_path / "status").read_text() == "2\n"
    first, second = ((tmp_path / name).read_text() for name in ("first", "second"))
    assert "No space left on device" in first and "Traceback" not in first
    finished = int((tmp_path / "finished").read_text())
    assert 0 < finished < RUNS and f"{finished} were there already" in second, second
    assert (tmp_path / "table.csv").read_bytes() == serial


def test_a_worker_whose_disk_is_full_is_told(tmp_path, by_hand):
    need_mounts()
    path = program_job(tmp_path / "job")
    place = tmp_path / "elsewhere" / "full"
    place.mkdir()
    made = (
        f'mount -t tmpfs none {tmp_path / "job"} && mount -t tmpfs -o size=64k none {place} && '
        f'{{ cat /dev/zero >{place}/full 2>/dev/null; exec "$@"; }}'
    )
    before = ["unshare", "--mount", "bash", "-c", made, "worker"]
    by_hand.worker("--nthreads", "1", "--local-directory", str(place), before=before)
    found = making.study(path, tmp_path / "out", scheduler=by_hand.address, tls=by_hand.key)
    assert found.broken_off == len(found.table) == 4
    assert all("No space left on device" in error for error in found.table["error"])
    again = making.study(path, tmp_path / "out", workers=0)
    assert again.reused == 0 and again.table.done.all()


def test_files_are_sent_to_workers_that_do_not_see_them(tmp_path, by_hand):
    need_mounts()
    path = program_job(tmp_path / "job")
    making.study(path, tmp_path / "here", workers=0)
    hidden = f'mount -t tmpfs none {tmp_path / "job"} && exec "$@"'
    by_hand.worker("--nthreads", "1", before=["unshare", "--mount", "bash", "-c", hidden, "worker"])
    found = making.study(path, tmp_path / "out", scheduler=by_hand.address, tls=by_hand.key)
    assert found.table.done.all(), found.table["error"]
    assert (tmp_path / "out" / table.FILE).read_bytes() == (
        tmp_path / "here" / table.FILE
    ).read_bytes()
    sent = list(
        (tmp_path / "elsewhere").rglob(f"{one.FOLDER}/*/{tmp_path}/job/*".replace("//", "/"))
    )
    assert {file.name for file in sent} == {"part.brep", "path.csv"}


@pytest.mark.slow
def test_a_scheduler_that_restarts_loses_no_run(tmp_path, by_hand, serial):
    by_hand.worker("--nthreads", "1")
    restarted = []

    def told(progress):
        if progress.done >= 5 and not restarted:
            by_hand.stop()
            restarted.append(ByHand(by_hand.folder, by_hand.port))
            restarted[0].worker("--nthreads", "1")

    try:
        making.study(
            many(), tmp_path / "out", scheduler=by_hand.address, tls=by_hand.key, told=told
        )
    finally:
        for made in restarted:
            made.stop()
    assert restarted and (tmp_path / "out" / table.FILE).read_bytes() == serial


def loops():
    """How many threads of Dask's clients run."""
    return sum(thread.name == "IO loop" for thread in threading.enumerate())


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_or_alone_is_told(tmp_path, by_hand, monkeypatch):
    before = loops()
    monkeypatch.setattr(cluster, "WAIT_S", 3.0)
    with pytest.raises(InputError, match="has no workers; start some"):
        making.study(study_of(), tmp_path / "a", scheduler=by_hand.address, tls=by_hand.key)
    by_hand.stop()
    monkeypatch.setattr(clusters, "ANSWER_S", 0.5)
    with pytest.raises(
        InputError, match=f"no scheduler answers at {by_hand.address}.*4 runs are open"
    ):
        making.study(study_of(), tmp_path / "b", scheduler=by_hand.address, tls=by_hand.key)
    with pytest.raises(InputError, match="no scheduler answers at nonsense://"):
        making.study(study_of(), tmp_path / "c", scheduler="nonsense://1", tls=False)
    left = table.Table.read(tmp_path / "b" / table.FILE)
    assert (left["status"] == table.OPEN).all()
    # A connection that failed leaves no thread, for which the program's end would wait.
    assert loops() == before


# What a worker answers ---------------------------------------------------------------------------------


def task_of(prepared, files, **more):
    base = prepared.bases[0].blob()
    import hashlib

    run = prepared.runs[0]
    return {
        "job_hash": run.job_hash,
        "base": hashlib.sha256(base).hexdigest(),
        "values": list(run.values),
        "files": files,
        "fields": False,
        "versions": core.versions(),
        **more,
    }, base


def test_a_worker_asks_for_what_it_lacks(tmp_path):
    path = program_job(tmp_path / "job")
    prepared = making.prepare(making.load(path))
    job = prepared.job(prepared.runs[0])
    files = [[file, sha] for _, file, sha in prepared.hashes.files(job)]
    assert sorted(Path(file).name for file, _ in files) == ["part.brep", "path.csv"]
    task, base = task_of(prepared, files)
    contents = {sha: Path(file).read_bytes() for file, sha in files}
    shutil.rmtree(tmp_path / "job")  # as on another machine
    work = tmp_path / "worker"
    needs = one.in_worker(task, {}, work)["needs"]
    assert set(needs) == {task["base"], *contents}
    assert set(one.in_worker(task, {task["base"]: base}, work)["needs"]) == set(contents)
    found = one.in_worker(task, contents, work)
    assert found["status"] == "done", found
    assert one.in_worker(task, {}, work)["figures"] == found["figures"]  # it has them now
    laid = next(work.rglob("part.brep"))
    laid.write_text("damaged")
    assert len(one.in_worker(task, {}, work)["needs"]) == 1


def test_what_a_worker_tells_has_the_users_paths(tmp_path):
    path = program_job(tmp_path / "job")
    (tmp_path / "job" / "part.brep").write_text("no shape")
    prepared = making.prepare(making.load(path))
    job = prepared.job(prepared.runs[0])
    files = [[file, sha] for _, file, sha in prepared.hashes.files(job)]
    task, base = task_of(prepared, files)
    blobs = {sha: Path(file).read_bytes() for file, sha in files} | {task["base"]: base}
    here = one.in_worker(task, blobs, tmp_path / "worker")
    shutil.rmtree(tmp_path / "job")
    there = one.in_worker(task, blobs, tmp_path / "worker")
    assert here["status"] == there["status"] == "error" and here["error"] == there["error"]
    assert str(tmp_path / "job" / "part.brep") in there["error"]
    assert one.FOLDER not in there["error"]


def test_a_worker_with_another_engine_is_refused(tmp_path):
    prepared = making.prepare(making.validate(study_of()))
    task, base = task_of(prepared, [], versions={**core.versions(), "beltgrinding": "0.0.1"})
    assert one.in_worker(task, {task["base"]: base}, tmp_path) == {"versions": core.versions()}
    with pytest.raises(InputError, match="another engine"):
        Delivery(None, None).answered(task, {"versions": {"beltgrinding": "0.0.1"}}, "tls://there")


def test_a_file_that_changes_meanwhile_is_not_sent(tmp_path):
    (tmp_path / "part.brep").write_text("one")
    sha = one.inputs.file_digest("", tmp_path / "part.brep")["sha256"]
    assert making._file(tmp_path / "part.brep", sha) == b"one"
    (tmp_path / "part.brep").write_text("two")
    with pytest.raises(InputError, match="has changed since the study began"):
        making._file(tmp_path / "part.brep", sha)


def test_a_run_that_kills_its_workers_is_given_up(tmp_path, monkeypatch):
    """Of a real cluster: one of the runs ends the process that it is in."""
    hook = tmp_path / "hook"
    hook.mkdir()
    (hook / "sitecustomize.py").write_text(
        "import sys, importlib.abc, importlib.machinery\n"
        "class Finder(importlib.abc.MetaPathFinder):\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name != 'beltgrinding.studies.one':\n"
        "            return None\n"
        "        spec = importlib.machinery.PathFinder.find_spec(name, path)\n"
        "        load = spec.loader.exec_module\n"
        "        def loaded(module):\n"
        "            load(module)\n"
        "            solve = module.solve\n"
        "            def deadly(job, *arguments, **options):\n"
        "                if job['belt_machine']['force_N'] == 30.0:\n"
        "                    import os\n"
        "                    os._exit(1)\n"
        "                return solve(job, *arguments, **options)\n"
        "            module.solve = deadly\n"
        "        spec.loader.exec_module = loaded\n"
        "        return spec\n"
        "sys.meta_path.insert(0, Finder())\n"
    )
    monkeypatch.setenv("PYTHONPATH", f"{hook}:{os.environ.get('PYTHONPATH', '')}")
    found = making.study(study_of(), tmp_path / "out", workers=2)
    assert found.table["status"].tolist() == ["done", "error", "done", "done"]
    assert found.broken_off == 1 and "worker that was given it died" in found.table["error"][1]
    assert np.isnan(found.table["in_share"][1])
    begun = time.monotonic()
    assert making.study(study_of(), tmp_path / "out", workers=0).reused == 3
    assert time.monotonic() - begun < 60
