"""Studies: figures, what is kept and what is made again, tables bit for bit, chunks of an array, cancellation, a full disk."""

import csv
import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.base import files as base_files
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.simulation import run as runs
from beltgrinding.studies import hashes, making, one, store, table
from support.freecad import MOD
from support.workers import alive, descendants
from test_job import plate_job

FORCES = [20.0, 30.0, 40.0, 50.0]


def quick_job():
    job = plate_job()
    job["sampling"]["spacing_mm"] = 2.0
    job["cell"] = {"check_collisions": False}
    return job


def study_of(values=FORCES, **more):
    given = {
        "job": quick_job(),
        "vary": [{"name": "force", "key": "belt_machine.force_N", "values": list(values)}],
        "design": {"method": "grid"},
    }
    return {**given, **more}


def make(given, folder, **options):
    return making.study(given, folder, workers=0, **options)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A study of four forces and its folder."""
    folder = tmp_path_factory.mktemp("study")
    return make(study_of(), folder)


@pytest.fixture
def copied(made, tmp_path):
    """A folder of its own with that study."""
    return Path(shutil.copytree(made.folder, tmp_path / "copy"))


@pytest.fixture
def counted(monkeypatch):
    """The hashes of the jobs that are run."""
    found, solve = [], one.solve

    def counting(job, job_hash, *arguments, **options):
        found.append(job_hash)
        return solve(job, job_hash, *arguments, **options)

    monkeypatch.setattr(one, "solve", counting)
    return found


def test_the_figures_are_those_of_the_verdict_and_the_summary(made):
    job = jobs.validate(
        {**quick_job(), "belt_machine": {**quick_job()["belt_machine"], "force_N": 40.0}}
    )
    result = runs.run(job)
    rows = made.table
    k = FORCES.index(rows["force"][2])
    assert rows["run"].tolist() == [1, 2, 3, 4] and rows["force"].tolist() == FORCES and k == 2
    verdict, summary = result.verdict, result.summary
    assert rows["overall"][k] == verdict["overall"]
    for name in ("in_share", "above_share", "below_share", "gouge_volume_mm3", "missed_rays"):
        assert rows[name][k] == verdict[name], name
    for name in ("min", "max", "mean", "rms"):
        assert rows[f"deviation_mm.{name}"][k] == verdict["deviation_mm"][name]
    assert rows["deviation_mm.p95"][k] == summary["deviation_mm"]["p95"]
    assert rows["worst.beyond_mm"][k] == verdict["worst"]["beyond_mm"]
    assert rows["process_time_s"][k] == summary["process_time_s"]
    assert rows["belt.remaining_cut"][k] == summary["belt"]["remaining_cut"]
    assert rows["peak_pressure_MPa"][k] == result.steps["peak_pressure"].max()
    assert rows["peak_force_N"][k] == pytest.approx(40.0, rel=1e-3)
    removed = rows["removed_volume_mm3"]
    assert (np.diff(removed) > 0).all() and made.table.done.all()


def test_zones_and_figures_that_are_named_have_columns(tmp_path):
    job = quick_job()
    job["inspection"] = {"zones": [{"name": "all of it", "faces": [1], "tolerance_mm": [0, 0.5]}]}
    usual = make({**study_of([20.0]), "job": job}, tmp_path / "a").table
    assert usual["zones.all of it.in_share"][0] == 1.0
    keep = {"figures": ["faces.1.deviation_mm.rms", "events.not_converged", "no.such.figure"]}
    found = make({**study_of([20.0]), "job": job, "keep": keep}, tmp_path / "a").table
    assert found.names[2:5] == keep["figures"]
    assert found["faces.1.deviation_mm.rms"][0] > 0 and found["events.not_converged"][0] == 0
    assert np.isnan(found["no.such.figure"][0])


def test_a_table_comes_back_bit_for_bit(made, tmp_path):
    again = making.Study.read(made.folder)
    assert again.table.csv_bytes() == made.table.csv_bytes()
    assert again.table.varied == ["force"] and again.table.figures == made.table.figures
    assert again.design["method"] == "grid" and again.study["job"]["belt_machine"]["force_N"] == 30
    for name in made.table.names:
        assert again.table[name].dtype == made.table[name].dtype, name
        assert (again.table[name] == made.table[name]).all()
    with open(made.folder / table.FILE, newline="") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[1]["in_share"]) == made.table["in_share"][1]


def test_cells_of_every_kind_come_back(tmp_path):
    columns = {
        "run": [1, 2, 3],
        "a": [0.1 + 0.2, None, 1e-300],
        "b": ['x, "y"', None, "z\nz"],
        "c": [True, False, None],
        "d": [[1, 2.5], [], None],
        "e": [1, 2, 3],
        "status": ["done", "error", "open"],
        "error": ["", "why", ""],
        "job_hash": ["1e5", "22", "ab"],
    }
    made = table.Table(columns)
    (tmp_path / "t.csv").write_bytes(made.csv_bytes())
    again = table.Table.read(tmp_path / "t.csv")
    assert again.csv_bytes() == made.csv_bytes()
    assert again["a"][0] == 0.1 + 0.2 and np.isnan(again["a"][1]) and again["e"].dtype == np.int64
    for name in "bcd":
        assert again[name].tolist() == columns[name]
    assert again["job_hash"].tolist() == columns["job_hash"]
    assert again.done.tolist() == [True, False, False]
    with pytest.raises(InputError, match="no column 'q'"):
        again["q"]


@pytest.mark.parametrize(
    "text, code",
    [("a,b\n1,2\n", "studies.no_table"), ("run,status,job_hash\n1,done\n", "studies.row_length")],
)
def test_what_is_no_table_is_refused(tmp_path, text, code):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(InputError) as error:
        table.Table.read(tmp_path / "t.csv")
    assert error.value.code == code


def test_parquet_has_the_same_where_pyarrow_is(made):
    pytest.importorskip("pyarrow")
    import io

    from pyarrow import parquet

    found = parquet.read_table(io.BytesIO(made.table.parquet_bytes()))
    assert found.column_names == made.table.names
    assert found["in_share"].to_pylist() == made.table["in_share"].tolist()


class Buffer:
    """Of the stand-in of pyarrow: what Debian 12 has none of. It shows what is handed over, not what pyarrow makes of it."""

    data = b""

    def getvalue(self):
        return self

    def to_pybytes(self):
        return self.data


def stand_in():
    """(pyarrow, pyarrow.parquet) that write the columns as JSON."""
    package, parquet = ModuleType("pyarrow"), ModuleType("pyarrow.parquet")
    package.string = lambda: "string"

    def array(values, kind=None):
        numbers = isinstance(values, np.ndarray) and values.dtype.kind in "if"
        assert numbers != (kind == "string"), (kind, values)
        assert numbers or all(v is None or isinstance(v, str) for v in values)
        return values.tolist() if numbers else values

    def write_table(made, buffer):
        buffer.data = json.dumps(made).encode()

    package.array, package.table, package.BufferOutputStream = array, dict, Buffer
    package.parquet, parquet.write_table = parquet, write_table
    return package, parquet


def test_parquet_is_handed_all_columns_and_an_older_one_does_not_stay(made, copied, monkeypatch):
    package, parquet = stand_in()
    monkeypatch.setitem(sys.modules, "pyarrow", package)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", parquet)
    kept = store.Store(copied)
    kept.write_table(made.table)
    found = json.loads((copied / table.PARQUET).read_bytes())
    assert list(found) == made.table.names
    for name in ("run", "force", "in_share", "removed_volume_mm3", "job_hash", "status"):
        assert found[name] == made.table[name].tolist(), name
    odd = table.Table(
        {"run": [1, 2], "a": [None, [1, 2.5]], "b": [True, None], "status": ["done"] * 2}
    )
    kept.write_table(odd)
    found = json.loads((copied / table.PARQUET).read_bytes())
    assert found["a"] == [None, "[1, 2.5]"] and found["b"] == ["true", None]
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    kept.write_table(odd)
    assert not (copied / table.PARQUET).exists()


# What is there is not made again ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "key, resumed",
    [
        ("belt_machine.force_N", False),
        ("programs[0].feed_mm_s", True),
        ("inspection.tolerance_mm[1]", True),
    ],
)
def test_states_of_runs_are_kept_where_another_run_can_begin_with_them(key, resumed):
    entry = {"key": key, "how": "values", "values": [0.1, 0.2]}
    assert one.Base(jobs.validate(quick_job()), [entry], None).resume == resumed


def test_a_run_that_is_there_is_not_made_again(copied, counted, made):
    assert make(study_of(), copied).reused == 4 and not counted
    found = make(study_of([*FORCES, 60.0]), copied)
    assert len(counted) == 1 and found.reused == 4 and found.table.done.all()
    assert (found.table["removed_volume_mm3"][:4] == made.table["removed_volume_mm3"]).all()
    make(study_of(), copied, again=True)
    assert len(counted) == 5
    assert (copied / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def test_equal_jobs_are_run_once(tmp_path, counted):
    found = make(study_of([20.0, 20.0, 20]), tmp_path)
    assert len(counted) == 1 and found.table.done.all() and len(found.table) == 3


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"job_hash": "x"', "null"])
def test_a_damaged_run_is_made_again(copied, counted, made, text):
    path = next((copied / store.RUNS).glob("*/*.json"))
    path.write_text(text)
    make(study_of(), copied)
    assert counted == [path.stem]
    assert (copied / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def program_job(folder):
    """A job whose shape and program are files."""
    job = quick_job()
    folder.mkdir(exist_ok=True)
    (folder / "part.brep").write_text(job["design"].pop("brep"))
    job["design"]["file"] = "part.brep"
    rows = [f"{x},20,0.2,0,1,0,0,30" for x in (10, 50)]
    head = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"
    (folder / "path.csv").write_text("\n".join([head, *rows]) + "\n")
    job["programs"] = [{"file": "path.csv"}]
    (folder / "job.json").write_text(json.dumps(job))
    given = {**study_of(), "job": "job.json"}
    (folder / "study.json").write_text(json.dumps(given))
    return folder / "study.json"


def hashes_of(path):
    return [run.job_hash for run in making.prepare(making.load(path)).runs]


def test_a_hash_follows_content_and_version_but_no_path(tmp_path, monkeypatch):
    path = program_job(tmp_path / "one")
    first = hashes_of(path)
    assert len(set(first)) == 4
    assert hashes_of(program_job(tmp_path / "two")) == first
    text = (tmp_path / "one" / "path.csv").read_text()
    (tmp_path / "one" / "path.csv").write_text(text.replace("50,", "51,"))
    changed = hashes_of(path)
    assert not set(changed) & set(first)
    (tmp_path / "one" / "path.csv").write_text(text)
    assert hashes_of(path) == first
    older = SimpleNamespace(versions=lambda: {**core.versions(), "beltgrinding": "0.0.1"})
    monkeypatch.setattr(hashes, "core", older)
    assert not set(hashes_of(path)) & set(first)


def test_a_study_in_a_folder_can_be_run_again_from_there(tmp_path, counted):
    path = program_job(tmp_path / "one")
    making.study(path, tmp_path / "out", workers=0)
    assert len(counted) == 4
    before = {p: p.read_bytes() for p in (tmp_path / "out").glob("*.*")}
    again = making.study(tmp_path / "out" / store.STUDY, tmp_path / "out", workers=0)
    assert again.reused == 4 and len(counted) == 4
    assert {p: p.read_bytes() for p in (tmp_path / "out").glob("*.*")} == before
    with pytest.raises(InputError, match="results would replace it"):
        making.study(path, tmp_path / "one", workers=0)


def test_fields_are_kept_if_asked(tmp_path, counted):
    given = study_of([20.0])
    make(given, tmp_path)
    found = make({**given, "keep": {"fields": True}}, tmp_path)
    assert len(counted) == 2  # the field was not there
    job_hash = found.table["job_hash"][0]
    field, text = core.HeightField.from_hdf5(str(tmp_path / store.FIELDS / f"{job_hash}.h5"))
    lower, upper = json.loads(text)["inspection"]["tolerance_mm"]
    share = core.deviation_statistics(field, lower, upper)["in_tolerance_share"]
    assert share == found.table["in_share"][0]
    assert make({**given, "keep": {"fields": True}}, tmp_path).reused == 1


def test_without_a_folder_nothing_is_kept():
    found = beltgrinding.study(study_of([20.0]), workers=0)
    assert found.folder is None and found.table.done.all()
    assert beltgrinding.study(study_of([20.0]), workers=0).reused == 0


KINDS = ["contact_wheel", "free_belt", "platen"]


def test_a_kind_of_belt_machine_brings_its_parts_with_it():
    # Kinds ended in a fault: what the job's own kind has no need of was not there.
    kind = {"name": "kind", "key": "belt_machine.kind", "values": KINDS}
    tension = {"key": "belt_machine.free_run.tension_N_per_mm", "how": "multiply", "values": [2.0]}
    given = {**study_of(), "vary": [kind]}
    found = making.study(given, workers=0)
    assert found.table["status"].tolist() == ["done"] * 3
    assert len(set(found.table["removed_volume_mm3"].tolist())) == 3
    prepared = making.prepare(making.validate(given))
    for run, name in zip(prepared.runs, KINDS):
        job = quick_job()
        job["belt_machine"]["kind"] = name
        assert prepared.job(run) == jobs.validate(job)
    kind["values"] = ["free_belt"]
    twice = making.prepare(making.validate({**given, "vary": [kind, tension]}))
    usual = jobs.validate({**quick_job(), "belt_machine": {"kind": "free_belt"}})
    tensions = [
        job["belt_machine"]["free_run"]["tension_N_per_mm"]
        for job in (twice.job(twice.runs[0]), usual)
    ]
    assert tensions[0] == 2.0 * tensions[1] > 0.0


# Runs that fail ----------------------------------------------------------------------------------------


def failing():
    """Of three jobs the second cannot be run: the limits of its tolerance are swapped."""
    values = [[-0.1, 0.1], [0.1, -0.1], [-0.2, 0.1]]
    return {
        **study_of(),
        "vary": [{"name": "band", "key": "inspection.tolerance_mm", "values": values}],
    }


def test_forces_of_the_programs_own_are_told_where_the_machines_varies():
    given = study_of()
    assert not making.prepare(making.validate(given)).warnings
    poses = [dict(pose) for pose in given["job"]["programs"][0]["poses"]]
    poses[0]["force_N"] = 12.0
    poses[-1].update(force_N=3.0, rapid=True)  # in the air
    given["job"]["programs"] = [{"poses": poses, "name": "pass"}]
    (fact,) = making.prepare(making.validate(given)).warnings
    assert fact.code == "studies.own_forces" and fact.arguments["own"] == 1
    assert fact.arguments["count"] == sum(not pose.get("rapid") for pose in poses)
    other = {"name": "feed", "key": "programs[*].feed_mm_s", "values": [10.0, 20.0]}
    assert not making.prepare(making.validate({**given, "vary": [other]})).warnings
    # One force for all poses takes their place.
    given["job"]["programs"][0]["force_N"] = 20.0
    (fact,) = making.prepare(making.validate(given)).warnings
    assert fact.arguments["own"] == fact.arguments["count"]


def test_a_run_that_fails_says_why_and_the_others_go_on(tmp_path, counted):
    found = make(failing(), tmp_path)
    assert found.table["status"].tolist() == ["done", "error", "done"] and not found.broken_off
    assert "inspection.tolerance_mm" in found.table["error"][1]
    assert np.isnan(found.table["in_share"][1]) and found.table["overall"][1] == ""
    assert found.table["band"][1] == [0.1, -0.1]
    assert make(failing(), tmp_path).reused == 3 and len(counted) == 3


def test_what_another_try_may_mend_is_tried_again(tmp_path, monkeypatch):
    run = runs.run

    def no_memory(job, context=None, **options):
        if job["belt_machine"]["force_N"] == 30.0:
            raise MemoryError
        return run(job, context, **options)

    monkeypatch.setattr(runs, "run", no_memory)
    found = make(study_of(), tmp_path)
    assert found.broken_off == 1 and found.table["status"].tolist().count("error") == 1
    monkeypatch.setattr(runs, "run", run)
    found = make(study_of(), tmp_path)
    assert found.reused == 3 and found.table.done.all()


# Interruptions -----------------------------------------------------------------------------------------


def test_a_cancelled_study_keeps_what_is_finished(tmp_path, counted, made, monkeypatch):
    context = core.RunContext()
    monkeypatch.setattr(making, "TOLD_S", 0.0)

    def told(progress):
        if progress.done == 2:
            context.cancel()

    with pytest.raises(Cancelled):
        make(study_of(), tmp_path, context=context, told=told)
    assert len(counted) == 2
    left = table.Table.read(tmp_path / table.FILE)
    assert left["status"].tolist() == ["done", "done", "open", "open"]
    assert make(study_of(), tmp_path).reused == 2 and len(counted) == 4
    assert (tmp_path / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def test_the_progress_counts_and_guesses(tmp_path, monkeypatch):
    monkeypatch.setattr(making, "TOLD_S", 0.0)
    told = []
    context = core.RunContext()
    make(study_of(), tmp_path, told=told.append, context=context)
    assert [one_.done for one_ in told] == [0, 1, 2, 3, 4] and told[0].left_s is None
    assert told[1].left_s == pytest.approx(3 * told[1].seconds) and told[-1].left_s == 0.0
    assert context.progress == 1.0
    make(study_of(), tmp_path, told=told.append)
    assert told[-1].reused == 4 and told[-1].left_s == 0.0


def test_a_full_disk_is_told_and_what_is_finished_stays(tmp_path, monkeypatch, made):
    write, count = base_files.write_new, []

    def full(path, data):
        count.append(path)
        if len(count) > 4:  # the study, its design, two runs
            write(path, data[: len(data) // 2])
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        write(path, data)

    monkeypatch.setattr(base_files, "write_new", full)
    with pytest.raises(InputError, match="No space left") as error:
        make(study_of(), tmp_path)
    assert error.value.code == "files.cannot_be_written"
    assert not list(tmp_path.rglob(base_files.PART + "*"))
    monkeypatch.setattr(base_files, "write_new", write)
    assert make(study_of(), tmp_path).reused == 2
    assert (tmp_path / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def start(*arguments, **options):
    environment = {
        **os.environ,
        "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}",
        "LANG": "C.UTF-8",
    }
    return subprocess.Popen(
        [sys.executable, str(MOD / "beltgrind.py"), "study", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        **options,
    )


def run_files(folder):
    return list((folder / store.RUNS).glob("*/*.json"))


@pytest.mark.parametrize("workers", [0, 2])
def test_ctrl_c_keeps_what_is_finished_and_leaves_no_process(tmp_path, workers):
    forces = np.linspace(20, 60, 200).tolist()
    path = tmp_path / "study.json"
    path.write_text(json.dumps(study_of(forces)))
    out = tmp_path / "out"
    process = start(path, "-o", out, "--workers", workers, start_new_session=True)
    end = time.monotonic() + 120
    while len(run_files(out)) < 3 and time.monotonic() < end:
        time.sleep(0.05)
    children = descendants(process.pid)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130, told
    finished = len(run_files(out))
    assert 3 <= finished < 200
    assert told.startswith(
        f"beltgrind: interrupted; {finished} of 200 runs are finished and kept in"
    )
    assert len(told.splitlines()) == 1, told
    end = time.monotonic() + 20
    while any(alive(pid) for pid in children) and time.monotonic() < end:
        time.sleep(0.1)
    assert not [pid for pid in children if alive(pid)]
    assert (table.Table.read(out / table.FILE)["status"] == table.OPEN).sum() >= 200 - finished


# The command line, and arrays of Slurm jobs ------------------------------------------------------------


@pytest.fixture
def study_file(tmp_path):
    path = tmp_path / "study.json"
    path.write_text(json.dumps(study_of()))
    return path


@pytest.mark.slow
def test_the_command_makes_counts_and_tells(study_file, tmp_path, capsys, made):
    out = str(tmp_path / "out")
    command = ["study", str(study_file), "-o", out, "--workers", "0"]
    assert cli.main([*command, "--count"]) == 0
    assert "4 different jobs, 0 of them are there" in capsys.readouterr().out
    assert not Path(out).exists()
    assert cli.main(command) == 0
    assert "4 of 4 runs have figures, 0 were there already" in capsys.readouterr().out
    assert cli.main([*command, "--count"]) == 0
    assert "4 of them are there already; the others take about 0 s" in capsys.readouterr().out
    assert (tmp_path / "out" / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def test_the_command_warns_of_runs_that_fail_and_fails_if_all_do(tmp_path, capsys):
    path = tmp_path / "study.json"
    path.write_text(json.dumps(failing()))
    assert cli.main(["study", str(path), "-o", str(tmp_path / "a"), "--workers", "0"]) == 0
    assert "1 runs failed, such as 2: inspection.tolerance_mm" in capsys.readouterr().err
    given = failing()
    given["vary"][0]["values"] = [[0.1, -0.1]]
    path.write_text(json.dumps(given))
    assert cli.main(["study", str(path), "-o", str(tmp_path / "b"), "--workers", "0"]) == 2
    assert "all of the 1 runs failed" in capsys.readouterr().err


@pytest.mark.parametrize(
    "options, told",
    [
        (["--workers", "-1"], "--workers -1"),
        (["--submit"], "go with --slurm"),
        (["--chunk", "4/3"], "--chunk 4/3"),
        (["--chunk", "x"], "write I/N"),
        (["--slurm", "0"], "1 to 100000 jobs"),
        (["--slurm", "2", "--sbatch=time"], "no option of sbatch"),
    ],
)
def test_options_that_make_no_sense_are_refused(study_file, tmp_path, capsys, options, told):
    assert cli.main(["study", str(study_file), "-o", str(tmp_path / "out"), *options]) == 2
    assert told in capsys.readouterr().err


SBATCH = """#!/bin/bash
echo "$*" >>"$(dirname "$0")/calls"
[ "$(basename "$1")" = refused ] && exit 1
echo "Submitted batch job 4711"
"""


@pytest.mark.slow
def test_an_array_makes_all_runs_and_the_next_study_collects_them(
    study_file, tmp_path, monkeypatch, capsys, made
):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "sbatch").write_text(SBATCH)
    (tmp_path / "bin" / "sbatch").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    out = tmp_path / "out with blanks"
    command = ["study", str(study_file), "-o", str(out)]
    assert cli.main([*command, "--slurm", "3", "--sbatch=--time=01:00:00", "--submit"]) == 0
    assert "Submitted batch job 4711" in capsys.readouterr().out
    script = out / "slurm" / "study.sbatch"
    assert (tmp_path / "bin" / "calls").read_text().strip() == str(script)
    text = script.read_text()
    assert "#SBATCH --array=1-3\n" in text and "#SBATCH --time=01:00:00\n" in text
    head = text.split("export")[0].splitlines()
    assert head[0] == "#!/bin/bash" and all(line.startswith("#SBATCH --") for line in head[1:])
    assert subprocess.run(["bash", "-n", script]).returncode == 0
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    for number, there in ((1, 2), (3, 3), (2, 4)):  # runs 1 and 4, 3, 2
        environment["SLURM_ARRAY_TASK_ID"] = str(number)
        done = subprocess.run(
            ["bash", script], env=environment, cwd="/", capture_output=True, text=True
        )
        assert done.returncode == 0 and done.stdout == done.stderr == "", done.stderr
        assert len(run_files(out)) == there and not (out / table.FILE).exists()
    assert cli.main([*command, "--workers", "0"]) == 0
    assert "4 were there already" in capsys.readouterr().out
    assert (out / table.FILE).read_bytes() == (made.folder / table.FILE).read_bytes()


def test_an_array_that_cannot_be_submitted_is_told(study_file, tmp_path, monkeypatch, capsys):
    command = ["study", str(study_file), "-o", str(tmp_path / "out"), "--slurm", "2", "--submit"]
    monkeypatch.setattr(shutil, "which", lambda name: None)
    assert cli.main(command) == 2
    assert "there is no sbatch here" in capsys.readouterr().err
    (tmp_path / "sbatch").write_text("#!/bin/bash\necho 'invalid partition' >&2; exit 1\n")
    (tmp_path / "sbatch").chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda name: str(tmp_path / name))
    assert cli.main(command) == 2
    assert "sbatch does not take it: invalid partition" in capsys.readouterr().err


# Packages ----------------------------------------------------------------------------------------------


def test_packages_are_loaded_only_when_a_study_runs():
    code = (
        "import sys, beltgrinding, beltgrinding.cli, beltgrinding.studies.making\n"
        "print([n for n in ('openturns', 'distributed', 'dask', 'pyarrow') if n in sys.modules])"
    )
    environment = {**os.environ, "PYTHONPATH": f"{MOD}:{Path(core.__file__).parent}"}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True
    )
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.parametrize(
    "module, package, options",
    [
        ("openturns", "python3-openturns", {"workers": 0}),
        ("distributed", "python3-distributed", {"scheduler": "tcp://127.0.0.1:1", "tls": False}),
    ],
)
def test_a_missing_package_is_named(tmp_path, monkeypatch, module, package, options):
    (tmp_path / f"{module}.py").write_text("raise ImportError('it is not there')\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, module, None)
    given = {**study_of(), "design": {"method": "sobol", "runs": 4}}
    if module != "openturns":
        given["design"] = {"method": "grid"}
    with pytest.raises(InputError, match=f"Debian: {package}"):
        making.study(given, tmp_path / "out", **options)
