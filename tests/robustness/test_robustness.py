"""Short runs of fuzz_jobs.py, kill.py and kill_study.py, and proof that their oracles see what they are for."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from support.freecad import SHARED
from support.thorough import cases

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import fault_injection  # noqa: E402
import fuzz_jobs  # noqa: E402
import kill  # noqa: E402
import kill_study  # noqa: E402

JOBS = cases(14, 25)
GROUND = JOBS // 3  # at least so many of them grind


def test_random_jobs():
    if not (SHARED / "data" / "cad").is_dir():
        pytest.skip(f"no parts at {SHARED}")
    found = list(fuzz_jobs.run_all(range(JOBS), environment={"BELTGRINDING_SHARED": str(SHARED)}))
    wrong = [f"job {number}: {words}" for number, words, finding in found if finding]
    assert not wrong, "\n".join([*wrong, "replay with fuzz_jobs.py --replay NUMBER"])
    assert len(found) == JOBS
    assert sum(words == "ground" for _, words, _ in found) >= GROUND


@pytest.mark.parametrize(
    "what, words", [("files", ("exchange", "journal", "C++")), ("memory", ("memory",))]
)
def test_every_call_fails_once(what, words):
    done = fault_injection.run(what, 0.02)
    assert done.returncode == 0, done.stdout + done.stderr
    told = done.stdout.splitlines()
    assert [line.split()[0].rstrip(":") for line in told] == list(words), told


def test_a_fault_that_is_not_survived_is_found(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import sys; from pathlib import Path; sys.path.insert(0, sys.argv[1])\n"
        "import fault_injection as f\n"
        "path = Path(sys.argv[2], 'file')\n"
        "def work():\n    path.write_text('half'); path.write_text('new')\n"
        "def look():\n"
        "    if path.read_text() not in ('old', 'new'): raise f.Finding('half')\n"
        "    return path.read_text() == 'new'\n"
        "try: f.every_call(work, look, lambda: path.write_text('old'))\n"
        "except f.Finding: sys.exit(7)\n"
    )
    library = str(fault_injection.build(tmp_path))
    environment = {**os.environ, fault_injection.PRELOADED: library, "LD_PRELOAD": library}
    command = [sys.executable, str(script), str(HERE), str(tmp_path)]
    assert subprocess.run(command, env=environment).returncode == 7


def test_ten_million_samples_fit_in_two_gigabytes(tmp_path):
    known = dict(line.split(":") for line in Path("/proc/meminfo").read_text().splitlines())
    free = int(known["MemAvailable"].split()[0]) * 1024 / 1e9
    if free < 3.0:
        pytest.skip(f"only {free:.1f} GB are free")
    command = [sys.executable, str(HERE / "memory.py"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["samples"] > 9.9e6 and told["peak_GB"] < 2.0, told


def result(**changes):
    """A sound result of two samples, or one with ``changes`` in its field and steps."""
    field = dict(
        height=np.array([0.1, 0.2]),
        stock_height=np.array([0.3, 0.3], np.float32),
        areas=np.array([1.0, 1.0], np.float32),
        flags=np.zeros(2, np.uint8),
    )
    steps = {name: np.array([0.3]) for name in ("force", "contact_area", "peak_pressure")}
    steps.update(duration=np.array([1.0]), removal_rate=np.array([0.3]))
    summary = {"removed_volume_mm3": 0.3, "deviation_mm": {"mean": 0.1}}
    for part in (field, steps, summary):
        part.update((name, changes.pop(name)) for name in list(changes) if name in part)
    return SimpleNamespace(
        field=SimpleNamespace(**field), steps=steps, summary=summary, events=[], **changes
    )


def test_a_sound_result_passes():
    fuzz_jobs._check_result(result())


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"height": np.array([np.nan, 0.2])}, "height holds a value that is not finite"),
        ({"height": np.array([0.4, 0.2])}, "a height grew by 0.1"),
        ({"force": np.array([-1.0])}, "force of a step is negative"),
        ({"removed_volume_mm3": 0.31}, "the summary says 0.31"),
        ({"removal_rate": np.array([0.29])}, "the steps add up to 0.29"),
        ({"deviation_mm": {"mean": float("inf")}}, "deviation_mm.mean is inf"),
    ],
)
def test_a_wrong_result_is_a_finding(changes, words):
    with pytest.raises(fuzz_jobs.Finding, match=words):
        fuzz_jobs._check_result(result(**changes))


def test_killed_runs_leave_whole_results():
    counts = kill.kill_runs(8, 1, 3.0)
    assert sum(counts.values()) == 8 and counts.get("a whole result", 0) > 0


def test_killed_documents_open():
    if shutil.which("freecadcmd") is None:
        pytest.skip("freecadcmd is not installed")
    assert sum(kill.kill_documents(2, 1, 3.0).values()) == 2


def test_killed_workers_leave_the_serial_table():
    pytest.importorskip("distributed")
    pytest.importorskip("openturns")
    found = kill_study.kill_studies(kill_study.study(kill.plate(), 12), 1, (0.3, 0.9))
    assert found.equal and found.runs == 12 and found.done >= 10, found
    assert found.killed + found.clusters > 0, found


def test_another_table_than_the_serial_one_is_found(monkeypatch):
    pytest.importorskip("openturns")
    from beltgrinding.studies import making, table

    study = making.study

    def other(given, folder=None, workers=None):
        found = study(given, folder, workers=0)
        if workers:
            path = folder / table.FILE
            path.write_bytes(path.read_bytes().replace(b"1", b"2", 1))
        return found

    monkeypatch.setattr(making, "study", other)
    monkeypatch.setattr(kill_study, "first_run", lambda given: 60.0)
    found = kill_study.kill_studies(kill_study.study(kill.plate(), 2), 1)
    assert not found.equal and found.killed == 0
