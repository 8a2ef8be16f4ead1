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

import fault_injection
import fuzz_documents
import fuzz_jobs
import kill
import kill_study
import schema_jobs

HERE = Path(__file__).resolve().parent

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
    pytest.importorskip("openturns")
    found = kill_study.kill_studies(kill_study.study(kill.plate(), 12), 1, (0.3, 0.9))
    assert found.equal and found.runs == 12 and found.done >= 10, found
    assert found.killed > 0, found


def test_another_table_than_the_serial_one_is_found(monkeypatch):
    pytest.importorskip("openturns")
    from beltgrinding.studies import making, table

    study = making.study

    def other(given, folder=None, workers=None, told=None):
        found = study(given, folder, workers=0)
        if workers:
            path = folder / table.FILE
            path.write_bytes(path.read_bytes().replace(b"1", b"2", 1))
        return found

    monkeypatch.setattr(making, "study", other)
    monkeypatch.setattr(kill_study, "first_run", lambda given: 60.0)
    found = kill_study.kill_studies(kill_study.study(kill.plate(), 2), 1)
    assert not found.equal and found.killed == 0


@pytest.mark.parametrize("kind, count", [("valid", cases(60, 300)), ("nearly", cases(120, 600))])
def test_jobs_made_from_the_schema(kind, count):
    found = list(fuzz_jobs.run_all(range(count), kind=kind, environment={}))
    wrong = [f"job {number}: {words}" for number, words, finding in found if finding]
    assert not wrong, "\n".join([*wrong, f"replay with fuzz_jobs.py --kind {kind} --replay NUMBER"])
    ended = [words.split(":")[0] for _, words, _ in found]
    assert len(found) == count and set(ended) <= {"ground", "untouched", "refused", "long"}
    if kind == "valid":
        assert ended.count("ground") > count // 2


def test_a_job_of_a_seed_is_the_same_each_time():
    command = [sys.executable, str(HERE / "fuzz_jobs.py"), "--kind", "nearly", "--job", "7"]
    told = [subprocess.run(command, capture_output=True, text=True).stdout for _ in range(2)]
    assert told[0] == told[1] and json.loads(told[0])


def test_every_key_of_the_schema_comes_up():
    def keys(value, way=()):
        for name, one in value.items() if isinstance(value, dict) else ():
            yield (*way, name)
            yield from keys(one, (*way, name))
        for one in value if isinstance(value, list) else ():
            yield from keys(one, way)

    seen = {way for number in range(400) for way in keys(schema_jobs.job(1, number))}
    wanted = {tuple(step for step in way if step != 0) for way, _ in schema_jobs.leaves()}
    missing = {way for way in wanted - seen if not BY_HAND & set(way)}
    assert not missing, "say in schema_jobs.py how these are made"


# What jobs are made without: what nearly valid ones have then.
BY_HAND = {
    "abc_deg",
    "fit",
    "joints",
    "values",
    "roll",
    "roll_direction",
    "surrogate_file",
    "base_link",
    "tip_link",
    "urdf",
    "brep",
    "file",
    "flip_faces",
}
BY_HAND |= {"acceptance", "lay", "lay_direction", "lay_centre_mm", "lay_tolerance_deg", "placement"}
BY_HAND |= {"joint6_from_flange", "coupling", "floor_mm", "convention"}


def test_documents_with_a_flipped_bit_open():
    if shutil.which("freecadcmd") is None:
        pytest.skip("freecadcmd is not installed")
    found = list(fuzz_documents.cases(1, range(cases(25, 200))))
    wrong = [f"{number}: {about}: {what}\n{said}" for number, about, what, said in found if what]
    assert not wrong, "\n".join(wrong)


def test_a_list_that_claims_gigabytes_is_named():
    path = SHARED / "faults" / "bit_in_profile.FCStd"
    if not path.is_file() or shutil.which("freecadcmd") is None:
        pytest.skip(f"no {path}, or no freecadcmd")
    said, peak = fuzz_documents.opened([path])[path]
    assert "Belt machine: Profile: damaged" in said and "told: Belt machine" in said, said
    assert fuzz_documents.judge(said, peak) == ""
