"""Signals at any moment, to studies above all: 130 and one line for Ctrl-C, which stays ignored where it was, and no process left.

OpenTURNS puts a handler of its own in the place of Python's whenever it is called; it never is in our process.
"""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from beltgrinding.engine import core
from beltgrinding.studies import store, table
from support.freecad import MOD
from support.thorough import cases
from support.workers import alive, descendants
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]

pytest.importorskip("openturns")
MOMENTS = cases(8, 40)  # of each command
RUNS = 24  # enough for a chaos expansion
GONE_S = 10.0  # for what a killed process had started, on a busy machine
ENVIRONMENT = {**os.environ, "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}", "LANG": "C.UTF-8"}


def lay_down(folder):
    """A job and a study whose design, effects and surface are OpenTURNS' work."""
    job = plate_job()
    job["sampling"]["spacing_mm"] = 1.0
    job["cell"] = {"check_collisions": False}
    (folder / "job.json").write_text(json.dumps(job))
    vary = [
        {"name": "force", "key": "belt_machine.force_N", "range": [20, 60]},
        {"name": "band", "key": "stock.allowance_mm", "range": [0.15, 0.25]},
    ]
    study = {"job": "job.json", "vary": vary, "design": {"method": "sobol", "runs": RUNS}}
    (folder / "study.json").write_text(json.dumps(study))


COMMANDS = {
    "study 0": ["study", "study.json", "--workers", "0"],
    "study 1": ["study", "study.json", "--workers", "1"],
    "study 2": ["study", "study.json", "--workers", "2"],
    "run": ["run", "job.json"],
    "plan": ["plan", "job.json"],
}


def start(folder, command, out, **options):
    words = [sys.executable, str(MOD / "beltgrind.py"), *command, "-o", str(out)]
    # Ctrl-C is held back until it is heard, as tools/beltgrind does.
    return subprocess.Popen(
        ["env", "--block-signal=INT", *words],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
        start_new_session=True,
        **options,
    )


def ended(process, number=None, after=0.0):
    """(status, standard error, seconds) of a process to which a signal is sent; what it had started ends, too."""
    begun, children = time.monotonic(), set()
    while process.poll() is None and (number is None or time.monotonic() - begun < after):
        children.update(descendants(process.pid))
        time.sleep(0.01)
    if number is not None and process.poll() is None:
        children.update(descendants(process.pid))
        os.kill(process.pid, number)
    told = process.communicate(timeout=120)[1]
    seconds, end = time.monotonic() - begun, time.monotonic() + GONE_S
    while any(map(alive, children)) and time.monotonic() < end:
        time.sleep(0.02)
    assert not [pid for pid in children if alive(pid)]
    return process.returncode, told, seconds


def finished(out):
    return len(list((out / store.RUNS).glob("*/*.json")))


@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_at_many_moments(tmp_path, name):
    lay_down(tmp_path)
    status, told, seconds = ended(start(tmp_path, COMMANDS[name], "whole"))
    assert status == 0, told
    dice, early = random.Random(name), 0
    for number in range(MOMENTS):
        out = tmp_path / str(number)
        after = seconds * (number + dice.random()) / MOMENTS
        status, told, _ = ended(start(tmp_path, COMMANDS[name], out), signal.SIGINT, after)
        if status == 0:
            continue
        early += 1
        assert status == 130, (after, told)
        told = [line for line in told.splitlines() if not line.startswith("warning: ")]
        assert len(told) == 1 and told[0].startswith("beltgrind: interrupted; "), told
        if "runs are finished" in told[0]:
            assert (
                f"interrupted; {finished(out)} of {RUNS} runs are finished and kept in" in told[0]
            )
            assert (
                table.Table.read(out / table.FILE)["status"] == table.OPEN
            ).sum() == RUNS - finished(out)
        elif "nothing was written" in told[0]:
            assert not finished(out)
        else:
            assert "was written" in told[0] and (
                finished(out) == RUNS or not name.startswith("study")
            )
    assert early > MOMENTS // 3


@pytest.mark.parametrize("name", ["study 0", "study 2", "run"])
def test_ctrl_c_that_is_ignored_stays_so(tmp_path, name):
    """As of what a shell's script runs in the background."""
    lay_down(tmp_path)
    words = [sys.executable, str(MOD / "beltgrind.py"), *COMMANDS[name], "-o", "out"]
    process = subprocess.Popen(
        words,
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),
    )
    while process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
        time.sleep(0.02)
    told = process.stderr.read()
    assert process.returncode == 0 and "interrupted" not in told, told
    if name != "run":
        assert finished(tmp_path / "out") == RUNS and (tmp_path / "out" / "report.html").exists()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
@pytest.mark.parametrize("name", ["study 0", "study 2"])
def test_what_is_ended_leaves_no_process(tmp_path, name, number):
    lay_down(tmp_path)
    for moment in (0.2, 0.5, 0.8):
        out = tmp_path / str(moment)
        status, _, seconds = ended(start(tmp_path, COMMANDS[name], out), number, 4.0 * moment)
        assert status in (-number, 0)


HANDLERS = """
import ctypes, json, sys
libc = ctypes.CDLL(None)
def handlers():
    found = {}
    for number in range(1, 32):
        held = ctypes.create_string_buffer(512)
        if libc.sigaction(number, None, held) == 0:
            found[number] = held.raw[:8]
    return found
before = handlers()
import beltgrinding
beltgrinding.study("study.json", "out", workers=int(sys.argv[1]))
beltgrinding.study_answers("out")
beltgrinding.run("job.json")
after = handlers()
changed = [number for number in before if before[number] != after[number]]
print(json.dumps([changed, "openturns" in sys.modules]))
"""


@pytest.mark.parametrize("workers", [0, 2])
def test_no_library_leaves_a_handler_in_a_program_that_uses_ours(tmp_path, workers):
    lay_down(tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", HANDLERS, str(workers)],
        cwd=tmp_path,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [[], False]
