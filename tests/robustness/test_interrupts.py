"""Ctrl-C at any moment: 130, and the old result or the new one, whole, as the message says."""

import errno
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from support.thorough import cases

from beltgrinding.base import folders
from beltgrinding.cli import background, interrupts
from beltgrinding.engine import core
from beltgrinding.simulation.result import Result
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]

MOMENTS = cases(100, 200)
WORKERS = 4
SPACINGS = (2.0, 2.5)  # mm: what was written says which
START = ROOT / "Mod" / "BeltGrinding" / "beltgrind.py"


def grind(folder, number, after=None):
    """Status, standard error and seconds of a run of job ``number``, interrupted ``after`` s."""
    begin = time.perf_counter()
    process = subprocess.Popen(
        [
            "env",
            "--block-signal=INT",
            sys.executable,
            str(START),
            "run",
            f"{number}.json",
            "-o",
            "out",
            "-q",
        ],
        cwd=folder,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "PYTHONPATH": str(Path(core.__file__).parent)},
    )
    if after is not None:
        time.sleep(after)
        process.send_signal(signal.SIGINT)
    told = process.communicate(timeout=120)[1]
    return process.returncode, told, time.perf_counter() - begin


def moments(worker, folder):
    """(status, message, whether the new result was there) for the moments of one worker."""
    folder.mkdir()
    counts = []
    for number, spacing in enumerate(SPACINGS):
        job = plate_job()
        job["sampling"]["spacing_mm"] = spacing
        (folder / f"{number}.json").write_text(json.dumps(job))
        status, told, seconds = grind(folder, number)
        assert status == 0, told
        counts.append(Result.read(folder / "out").summary["samples"])
    there, dice, found = 1, random.Random(worker), []
    for _ in range(MOMENTS // WORKERS):
        wanted = 1 - there
        status, told, took = grind(folder, wanted, dice.uniform(0.0, 1.1 * seconds))
        if status == 0:  # a whole run, on a machine that is as busy as it is now
            seconds = took
        now = counts.index(Result.read(folder / "out").summary["samples"])
        found.append((status, told.strip(), now == wanted))
        there = now
    left = [p.name for p in folder.iterdir() if p.name not in ("0.json", "1.json", "out")]
    assert left == [], "what an interrupted run began is left"
    return found


def test_ctrl_c_at_many_moments(tmp_path):
    with ThreadPoolExecutor(WORKERS) as pool:
        work = [pool.submit(moments, k, tmp_path / str(k)) for k in range(WORKERS)]
        found = [one for part in work for one in part.result()]
    assert len(found) == MOMENTS
    for status, told, new in found:
        if status == -signal.SIGINT:  # not even env was up yet
            assert not new
        elif status == 0:  # too late
            assert new and told == ""
        else:
            assert status == 130, told
            assert told.startswith("beltgrind: interrupted; ") and "\n" not in told
            assert new == ("was written" in told and "nothing" not in told)
    early = sum(status == 130 for status, _, _ in found)
    assert early > MOMENTS // 3


def test_ctrl_c_at_every_line_of_waiting_is_an_interruption():
    """Of Python's own lines too: what it raises when it is interrupted there must not take its place."""
    before = signal.getsignal(signal.SIGINT)
    kept, outcomes = sys.gettrace(), []
    try:
        while not outcomes or outcomes[-1] != "result":
            signal.signal(signal.SIGINT, interrupts.stop)
            left = len(outcomes)

            def line(_, event, __):
                nonlocal left
                if event == "line" and signal.getsignal(signal.SIGINT) is not interrupts.stop:
                    left -= 1
                    if left == -1:
                        raise KeyboardInterrupt
                return line

            sys.settrace(line)
            try:
                outcomes.append(background.run(lambda _: time.sleep(0.15) or "result", quiet=True))
            except KeyboardInterrupt:
                outcomes.append("interrupted")
            finally:
                sys.settrace(kept)
    finally:
        signal.signal(signal.SIGINT, before)
    assert len(outcomes) > 5


@pytest.mark.parametrize("place", ["made", "removed"])
def test_an_interruption_between_two_lines_leaves_nothing(tmp_path, monkeypatch, place):
    came = []

    def interrupted(real, after):
        def call(path, *arguments, **keywords):
            if came or folders.STAGE not in str(path):
                return real(path, *arguments, **keywords)
            came.append(path)
            if after:
                real(path, *arguments, **keywords)
            raise KeyboardInterrupt

        return call

    if place == "made":
        monkeypatch.setattr(Path, "mkdir", interrupted(Path.mkdir, True))
    else:
        monkeypatch.setattr(shutil, "rmtree", interrupted(shutil.rmtree, False))
    before = signal.signal(signal.SIGINT, interrupts.stop)
    try:
        with pytest.raises(KeyboardInterrupt):
            folders.replace(tmp_path / "out", {"a": b"new"})
    finally:
        signal.signal(signal.SIGINT, before)
    assert came and not [p.name for p in tmp_path.rglob(folders.STAGE + "*")]


def test_an_interruption_waits_for_a_folder_to_be_gone(tmp_path, monkeypatch):
    # shutil.rmtree closes a descriptor twice if it comes between two of its lines, and raises the error of that.
    real, came = shutil.rmtree, []

    def interrupted(path, *arguments, **keywords):
        came.append(path)
        try:
            os.kill(os.getpid(), signal.SIGINT)
            real(path, *arguments, **keywords)
        except KeyboardInterrupt:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF)) from None

    monkeypatch.setattr(shutil, "rmtree", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            folders.replace(tmp_path / "out", {"a": b"new"})
    finally:
        signal.signal(signal.SIGINT, before)
    assert came and not [p.name for p in tmp_path.rglob(folders.STAGE + "*")]
