"""Results on disk: replaced as a whole, known by their sums, never written over what is not ours."""

import errno
import hashlib
import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import files, folders
from beltgrinding.cli import main
from beltgrinding.engine import InputError, core
from beltgrinding.simulation.result import Result
from support.results import unseal
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def results():
    """Two results that differ in every figure."""
    found = []
    for spacing, force in ((2.0, 30), (3.0, 60)):
        job = plate_job()
        job["sampling"]["spacing_mm"] = spacing
        job["belt_machine"]["force_N"] = force
        found.append(beltgrinding.run(job))
    return found


@pytest.fixture(params=["exchange", "journal"])
def way(request, monkeypatch):
    """Both ways to replace a folder's files; the second as on a mount point."""
    if request.param == "journal":
        monkeypatch.setattr(folders, "_may_change_places", lambda folder: False)
    return request.param


def told(folder):
    """What a folder holds, by name."""
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def which(folder, results):
    """The number of the result in a folder, which is whole."""
    found = Result.read(folder).summary
    number = [r.summary["samples"] for r in results].index(found["samples"])
    head = (Path(folder) / "deviation.ply").read_bytes()[:400]
    assert b"run " + found["run_id"].encode() in head
    assert b"element vertex %d\n" % found["samples"] in head
    return number


def test_a_result_takes_the_place_of_another_and_leaves_what_is_not_a_result(
    tmp_path, results, way
):
    out = tmp_path / "out"
    results[0].write(out)
    (out / "notes.txt").write_text("mine")
    os.chmod(out, 0o750)
    assert which(out, results) == 0
    results[1].write(out)
    assert which(out, results) == 1
    assert (out / "notes.txt").read_text() == "mine"
    assert out.stat().st_mode & 0o777 == 0o750
    assert [p.name for p in tmp_path.iterdir()] == ["out"]
    assert not [name for name in told(out) if name.startswith(".")]


def test_a_folder_that_somebody_works_in_stays_the_same_folder(tmp_path, results, monkeypatch):
    out = tmp_path / "out"
    results[0].write(out)
    monkeypatch.chdir(out)
    before = out.stat().st_ino
    results[1].write(".")
    assert out.stat().st_ino == before and which(out, results) == 1


@pytest.mark.slow
@pytest.mark.parametrize("at", range(40))
def test_what_fails_on_the_way_leaves_the_old_or_the_new(tmp_path, results, way, at, monkeypatch):
    """Each call of the file system fails in turn, or Ctrl-C comes there."""
    out = tmp_path / "out"
    results[0].write(out)
    calls = {"left": at}
    stop = OSError(28, "No space left on device") if at % 2 else KeyboardInterrupt()

    def failing(name):
        real = getattr(os, name)

        def call(*arguments, **options):
            calls["left"] -= 1
            if calls["left"] == -1:
                raise stop
            return real(*arguments, **options)

        monkeypatch.setattr(folders.os, name, call)

    for name in ("replace", "rename", "fsync", "link", "open"):
        failing(name)
    failed = False
    try:
        results[1].write(out)
    except (InputError, KeyboardInterrupt):
        failed = True
    monkeypatch.undo()
    number = which(out, results)
    assert failed or number == 1
    results[0].write(out)
    assert which(out, results) == 0


def test_a_journal_that_was_decided_is_ended_by_who_reads(tmp_path, results, monkeypatch):
    out = tmp_path / "out"
    results[0].write(out)
    (out / "notes").mkdir()  # so that the folder cannot change places

    monkeypatch.setattr(folders, "_end_journals", lambda folder: None)
    results[1].write(out)
    monkeypatch.undo()
    assert [name for name in os.listdir(out) if name.startswith(folders.JOURNAL)]
    assert which(out, results) == 1
    assert not [name for name in os.listdir(out) if name.startswith(".")]


def test_what_a_killed_writer_left_is_removed_when_it_is_old(tmp_path, results, way):
    out = tmp_path / "out"
    results[0].write(out)
    parent = tmp_path if way == "exchange" else out
    for name, age in (("old", 3600), ("new", 0)):
        stage = parent / (folders.STAGE + name)
        stage.mkdir()
        os.utime(stage, (stage.stat().st_mtime - age,) * 2)
    results[1].write(out)
    left = [p.name for p in parent.iterdir() if p.name.startswith(folders.STAGE)]
    assert left == [folders.STAGE + "new"]


def test_what_a_killed_writer_of_a_file_left_is_removed_when_it_is_old(tmp_path):
    for name, age in (("old", files.LEFT_OVER + 60), ("new", 0)):
        part = tmp_path / (files.PART + name)
        part.write_text("half")
        os.utime(part, (part.stat().st_mtime - age,) * 2)
    files.write_whole(tmp_path / "a.json", b"{}")
    assert sorted(told(tmp_path)) == [files.PART + "new", "a.json"]


def test_files_that_are_written_as_they_are_made_have_the_same_bytes(tmp_path, results):
    field, scale = results[0].field, (-0.1, 0.1, 0.5)
    for name, into, whole in (
        ("a.h5", lambda file: field.hdf5_into(file, "{}"), field.hdf5("{}")),
        (
            "a.ply",
            lambda file: core.deviation_ply_into(file, field, *scale, True, "run"),
            core.deviation_ply(field, *scale, True, "run"),
        ),
    ):
        files.write_new(tmp_path / name, into)
        assert (tmp_path / name).read_bytes() == whole
        with open(tmp_path / name, "rb") as file:
            told = files.sum_of(file.fileno())
        assert told == {"bytes": len(whole), "sha256": hashlib.sha256(whole).hexdigest()}
        full = os.open("/dev/full", os.O_RDWR)
        try:
            with pytest.raises(OSError) as failed:
                into(full)
        finally:
            os.close(full)
        assert failed.value.errno == errno.ENOSPC


def test_a_table_of_steps_of_0_1_0_is_read(tmp_path, results):
    """It had no deepest approach: that is not known, and nothing else changes."""
    out = tmp_path / "out"
    results[0].write(out)
    rows = [row.rsplit(",", 1) for row in (out / "steps.csv").read_text().splitlines()]
    assert rows[0][1] == "deepest_approach_mm"
    (out / "steps.csv").write_text("".join(row[0] + "\n" for row in rows))
    unseal(out)
    steps = Result.read(out).steps
    assert np.isnan(steps["deepest_approach"]).all()
    assert steps["approach"] == pytest.approx(results[0].steps["approach"])


@pytest.mark.parametrize(
    "name",
    ["deviation.ply", "heightfield.h5", "steps.csv", "motions.csv", "verdict.json", "summary.json"],
)
def test_a_flipped_bit_is_told(tmp_path, results, name):
    out = tmp_path / "out"
    results[0].write(out)
    path = out / name
    data = bytearray(path.read_bytes())
    at = data.rindex(b"0.") + 2 if name.endswith("json") else len(data) // 2
    data[at] ^= 1
    path.write_bytes(data)
    with pytest.raises(InputError) as told:
        Result.read(out)
    assert name in str(told.value) and "not as the run wrote it" in str(told.value)


def test_a_flipped_bit_in_a_height_field_alone_is_told(tmp_path, results):
    image = results[0].field.hdf5("text")
    at = image.index(results[0].field.height.tobytes()[:64]) + 24
    damaged = image[:at] + bytes([image[at] ^ 1]) + image[at + 1 :]
    with pytest.raises(
        InputError, match="field.h5: the height field its array 'height' is damaged"
    ):
        core.HeightField.from_hdf5_bytes(damaged, "field.h5")
    path = tmp_path / "field.h5"
    path.write_bytes(damaged)
    with pytest.raises(InputError, match="damaged"):
        core.HeightField.from_hdf5(str(path))


def test_files_of_another_run_and_missing_ones_are_told(tmp_path, results):
    for number, result in enumerate(results):
        result.write(tmp_path / str(number))
    shutil.copy(tmp_path / "1" / "events.json", tmp_path / "0" / "events.json")
    shutil.copy(tmp_path / "1" / "deviation.ply", tmp_path / "0" / "deviation.ply")
    with pytest.raises(InputError, match="deviation.ply: is not as the run wrote it"):
        Result.read(tmp_path / "0")
    (tmp_path / "1" / "steps.csv").unlink()
    with pytest.raises(InputError, match="steps.csv: cannot be read: No such file"):
        Result.read(tmp_path / "1")


def test_the_same_job_has_the_same_run_id_and_bytes(tmp_path):
    for name in ("a", "b"):
        beltgrinding.run(plate_job()).write(tmp_path / name)
    a, b = told(tmp_path / "a"), told(tmp_path / "b")
    assert a.pop("summary.json") != b.pop("summary.json")  # its times
    assert a == b


def job_file(folder, **changes):
    folder.mkdir(parents=True, exist_ok=True)
    data = {**plate_job(), **changes}
    data["sampling"]["spacing_mm"] = 3.0
    (folder / "job.json").write_text(json.dumps(data))
    return folder / "job.json"


def test_a_job_in_the_output_folder_is_never_written_over(tmp_path, capsys):
    job = job_file(tmp_path).rename(tmp_path / "summary.json")
    (tmp_path / "scan.json").write_text("mine")
    before = told(tmp_path)
    for more in ([], ["--force"]):
        assert main(["run", str(job), "-o", str(tmp_path), "-q", *more]) == 2
        assert told(tmp_path) == before
    assert "the run reads it" in capsys.readouterr().err


def test_a_stock_in_the_output_folder_is_never_written_over(tmp_path, results):
    out = tmp_path / "out"
    results[0].write(out)
    stock = {"kind": "mesh", "file": "out/deviation.ply"}
    job = job_file(tmp_path, stock=stock)
    before = told(out)
    assert main(["run", str(job), "-o", str(out), "-q", "--force"]) == 2
    found = beltgrinding.run(str(job))
    with pytest.raises(InputError, match="deviation.ply: the result would replace it"):
        found.write(out, force=True)
    assert told(out) == before


def test_anothers_file_under_a_result_s_name_needs_force(tmp_path, capsys):
    job, out = job_file(tmp_path), tmp_path / "out"
    out.mkdir()
    (out / "events.json").write_text("mine")
    assert main(["run", str(job), "-o", str(out), "-q"]) == 2
    assert "events.json" in capsys.readouterr().err
    assert told(out) == {"events.json": b"mine"}
    assert main(["run", str(job), "-o", str(out), "-q", "--force"]) == 0
    assert main(["run", str(job), "-o", str(out), "-q"]) == 0


def test_a_report_goes_with_its_result(tmp_path, results, capsys):
    out = tmp_path / "out"
    results[0].write(out)
    assert main(["report", str(out)]) == 0
    assert main(["report", str(out), "-o", str(out / "second.html")]) == 0
    assert main(["report", str(out), "-o", str(tmp_path / "elsewhere.html")]) == 0
    assert main(["view", str(out)]) == 0
    Result.read(out)
    (out / "second.html").write_text("mine now")
    results[1].write(out)
    assert not (out / "view.html").exists()
    assert not (out / "report.html").exists() and (tmp_path / "elsewhere.html").exists()
    assert (out / "second.html").read_text() == "mine now"


def test_a_verdict_and_a_scan_belong_to_the_result_that_they_are_of(tmp_path, results, capsys):
    out = tmp_path / "out"
    results[0].write(out)
    assert main(["verdict", str(out)]) == 0
    read = Result.read(out)
    results[1].write(out)
    with pytest.raises(InputError, match="another result has taken the place"):
        read.update(verdict=True)
    assert which(out, results) == 1


OUTPUTS = [
    ["section", "OUT", "--point", "30,20,0", "--normal", "1,0,0", "-o", "FILE.csv"],
    ["verdict", "OUT", "-o", "FILE.json"],
    ["mesh", "OUT", "-o", "FILE.stl"],
    ["report", "OUT", "-o", "FILE.html"],
    ["report", "OUT", "--language", "de", "-o", "FILE.html"],
    ["view", "OUT", "-o", "FILE.html"],
    ["view", "OUT", "--language", "de", "-o", "FILE.html"],
    ["program", "PROGRAM", "-o", "FILE.csv"],
    ["contact", "JOB", "--pose", "1", "-o", "FILE.csv"],
]


@pytest.mark.slow
@pytest.mark.parametrize("command", OUTPUTS, ids=lambda command: command[0])
def test_no_command_writes_over_its_input_or_over_another_s_file(
    tmp_path, results, command, capsys
):
    out, job = tmp_path / "out", job_file(tmp_path)
    results[0].write(out)
    program = tmp_path / "program.csv"
    program.write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n0,0,0,1,0,0,0,50\n9,0,0,1,0,0,0,50\n")
    names = {"OUT": out, "JOB": job, "PROGRAM": program}
    suffix = Path(command[-1]).suffix
    target = tmp_path / ("mine" + suffix)
    words = [str(names.get(word, word)) for word in command[:-1]]
    target.write_text("mine")
    assert main([*words, str(target)]) == 2
    assert target.read_text() == "mine"
    assert main([*words, str(target), "--force"]) == 0
    assert target.read_bytes() != b"mine"
    assert main([*words, str(target)]) == 0  # our own
    own = {"section": "out/summary.json", "contact": "job.json", "program": "program.csv"}
    own = tmp_path / own.get(command[0], "out/heightfield.h5")
    before = own.read_bytes()
    link = tmp_path / ("link" + suffix)
    link.symlink_to(own)
    assert main([*words, str(link), "--force"]) == 2
    assert own.read_bytes() == before


def test_a_program_is_not_replaced_by_its_own_poses(tmp_path, capsys):
    program = tmp_path / "p.src"
    program.write_text("DEF p()\nLIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\nLIN {X 9}\nEND\n")
    before = program.read_bytes()
    for words in (["program"], ["program", "convert"]):
        assert main([*words, str(program), "-o", str(program), "--force"]) == 2
    assert program.read_bytes() == before
