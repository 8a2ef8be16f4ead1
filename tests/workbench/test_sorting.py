"""Castings sorted by their scans: passes, passes with a plan of its own, scrap."""

import csv
import json
import os
import shlex
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.reporting.language import Language
from beltgrinding.studies import casting, sorting, sorting_report
from beltgrinding.studies.delivery import Delivery
from support.workers import ByHand, worker_processes
from test_plan_stock import given, ply, raw  # noqa: F401
from test_scan import pytestmark  # noqa: F401

QUICK = {"check": False, "rounds": 3}


def stock(thick, amplitude=0.02):
    return lambda x, y: thick + amplitude * np.sin(2 * np.pi * x / 40.0) + 0.0 * y


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scans")
    for name, thick in (("deep", -0.3), ("even", 0.25), ("thick", 1.5)):
        ply(folder / f"{name}.ply", *raw(stock(thick)))
    return folder


@pytest.fixture(scope="module")
def coarse(given):  # noqa: F811
    return jobs.validate({**given, "sampling": {"spacing_mm": 2.0}})


@pytest.fixture(scope="module")
def batch(coarse, scans, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sorted")
    told = []
    found = sorting.sort(
        coarse, [scans], folder, QUICK, 0.9, {"aligned": True}, workers=0, told=told.append
    )
    assert [one.done for one in told] == [1, 2, 3]
    return folder, found


@pytest.mark.slow
def test_each_part_is_sorted_with_its_reason(batch):
    folder, found = batch
    rows = {row["part"]: row for row in found.parts}
    assert {name: row["sorted"] for name, row in rows.items()} == {
        "deep": casting.SCRAP,
        "even": casting.PLANNED,
        "thick": casting.SCRAP,
    }
    even, thick, deep = rows["even"], rows["thick"], rows["deep"]
    assert even["in_share"] < 0.9 <= even["planned_in_share"]
    assert (folder / "even" / "job.json").exists() and even["plan"] == str(folder / "even")
    assert not (folder / "thick").exists() and thick["planned_in_share"] < 0.9
    assert "grinding adds nothing" in deep["reason"] and deep["in_share"] is None
    assert max(thick["shares"].values()) > 0.1 and "%" in thick["reason"]
    with open(folder / sorting.TABLE, newline="") as file:
        kept = list(csv.DictReader(file))
    assert [row["sorted"] for row in kept] == [row["sorted"] for row in found.parts]
    assert [row["plan"] for row in kept] == ["", "even", ""]


def test_the_plan_that_is_told_is_the_one_that_grinds_it_so(batch):
    folder, found = batch
    row = next(row for row in found.parts if row["part"] == "even")
    ground = beltgrinding.run(folder / "even" / "job.json")
    assert ground.verdict["in_share"] == pytest.approx(row["planned_in_share"], abs=2e-3)


def test_a_part_passes_where_the_program_is_good_enough(coarse, scans):
    options = {"aligned": True}
    found = sorting.sort(coarse, [scans / "even.ply"], None, QUICK, 0.2, options, workers=0)
    assert found.parts[0]["sorted"] == casting.PASSES and found.parts[0]["planned_in_share"] is None


def test_the_report_names_all_in_both_languages(batch, coarse):
    folder, found = batch
    html = sorting_report.write(folder, found, coarse, 0.9).read_text()
    for text in ("passes with this plan", "scrap", "even", "grinding adds nothing"):
        assert text in html
    german = sorting_report.document(found, coarse, 0.9, Language("de"))
    for text in ("besteht mit diesem Plan", "Ausschuss", "das Schleifen trägt nichts auf"):
        assert text in german
    assert sorting_report.counts(found)[casting.SCRAP] == 2


def test_the_command_sorts_on_processes(coarse, scans, tmp_path, capsys):
    job = tmp_path / "job.json"
    job.write_text(json.dumps(coarse))
    parts = [str(scans / "deep.ply"), str(scans / "even.ply")]
    options = ["--aligned", "--share", "0.2", "--workers", "2", "-o", str(tmp_path / "out")]
    assert cli.main(["sort", str(job), *parts, *options]) == 0
    said = capsys.readouterr().out
    assert "deep: scrap" in said and "even: passes" in said and "1 passes, 1 scrap" in said
    assert (tmp_path / "out" / sorting_report.REPORT).exists()


# What is there, and who finds it ---------------------------------------------------------------------------


SHARE = 0.9
ALIGNED = {"aligned": True}


@pytest.fixture
def copied(batch, tmp_path):
    """The folder of a sorted batch, to itself."""
    return Path(shutil.copytree(batch[0], tmp_path / "sorted"))


@pytest.fixture
def sorted_now(monkeypatch):
    """The parts that are sorted in this process."""
    found, one_part = [], casting.one_part

    def counting(task, context=None):
        found.append(task["part"])
        return one_part(task, context)

    monkeypatch.setattr(casting, "one_part", counting)
    return found


def again(coarse, scans, folder, share=SHARE, **more):
    return sorting.sort(coarse, scans, folder, QUICK, share, ALIGNED, workers=0, **more)


@pytest.mark.slow
def test_a_part_that_is_there_is_not_sorted_again(batch, coarse, scans, copied, sorted_now):
    found = again(coarse, [scans], copied)
    assert found.reused == 3 and not sorted_now
    table = (copied / sorting.TABLE).read_bytes()
    assert table == (batch[0] / sorting.TABLE).read_bytes()
    shutil.rmtree(copied / "even")  # its plan
    assert again(coarse, [scans], copied).reused == 2 and sorted_now == ["even"]
    assert (copied / "even" / "job.json").exists()
    assert (copied / sorting.TABLE).read_bytes() == table
    again(coarse, [scans / "deep.ply"], copied, share=0.5)
    again(coarse, [scans / "deep.ply"], copied, again=True)
    assert sorted_now == ["even", "deep", "deep"]
    another = copied / "deep.ply"
    another.write_bytes((scans / "even.ply").read_bytes())
    again(coarse, [another], copied, share=0.2)
    assert sorted_now[3:] == ["deep"]


def test_what_cannot_be_judged_is_tried_again(coarse, tmp_path, sorted_now):
    scan = tmp_path / "torn.ply"
    scan.write_text("no mesh")
    for _ in range(2):
        found = again(coarse, [scan], tmp_path / "out")
        assert found.parts[0]["sorted"] == casting.UNKNOWN and found.reused == 0
    assert sorted_now == ["torn", "torn"]


def test_a_scan_called_as_what_the_folder_holds_has_another_name(scans):
    named = sorting._named([scans / "kept.ply", scans / "slurm.ply", scans / "other.ply"])
    assert [name for name, _ in named] == ["kept-2", "slurm-2", "other"]


@pytest.mark.slow
def test_a_cancelled_batch_goes_on(coarse, scans, tmp_path, batch, sorted_now):
    context = core.RunContext()
    with pytest.raises(Cancelled):
        again(coarse, [scans], tmp_path, context=context, told=lambda progress: context.cancel())
    assert sorted_now == ["deep"] and not (tmp_path / sorting.TABLE).exists()
    assert again(coarse, [scans], tmp_path).reused == 1
    assert (tmp_path / sorting.TABLE).read_bytes() == (batch[0] / sorting.TABLE).read_bytes()


@pytest.mark.slow
def test_workers_that_are_killed_change_no_bit_of_the_table(coarse, scans, tmp_path, batch):
    killed, over = [], threading.Event()

    def kill():
        while not killed and not over.is_set():
            killed.extend(worker_processes(os.getpid())[:1])
            time.sleep(0.05)
        if killed:
            time.sleep(0.5)
            os.kill(killed[0], signal.SIGKILL)

    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    found = sorting.sort(coarse, [scans], tmp_path, QUICK, SHARE, ALIGNED, workers=2)
    over.set()
    killer.join()
    assert killed and found.reused == 0
    assert (tmp_path / sorting.TABLE).read_bytes() == (batch[0] / sorting.TABLE).read_bytes()
    for name in ("job.json", "feeds.csv"):
        made = (tmp_path / "even" / name).read_bytes()
        assert made == (batch[0] / "even" / name).read_bytes(), name


@pytest.mark.slow
def test_a_scheduler_that_is_there_sorts(coarse, scans, tmp_path, batch):
    pytest.importorskip("distributed")
    cluster = ByHand(tmp_path / "elsewhere")
    try:
        cluster.worker("--nthreads", "1")
        found = sorting.sort(
            coarse,
            [scans],
            tmp_path / "out",
            QUICK,
            SHARE,
            ALIGNED,
            scheduler=cluster.address,
            tls=cluster.key,
        )
    finally:
        cluster.stop()
    assert found.reused == 0 and (tmp_path / "out" / "even" / "plan.json").exists()
    made = (tmp_path / "out" / sorting.TABLE).read_bytes()
    assert made == (batch[0] / sorting.TABLE).read_bytes()


def test_a_worker_refuses_what_it_does_not_see(coarse, scans, tmp_path):
    scan = tmp_path / "even.ply"
    scan.write_bytes((scans / "even.ply").read_bytes())
    task = sorting.Tasks(coarse, [scan], None, {}, 0.2, ALIGNED).tasks[0]
    older = {**task, "versions": {**task["versions"], "beltgrinding": "0.0.1"}}
    assert sorting.in_worker(older) == {"versions": core.versions()}
    scan.write_bytes(b"another")
    assert sorting.in_worker(task) == {"unseen": str(scan)}
    with pytest.raises(InputError, match="does not see .*even.ply as it is here"):
        Delivery(None, None).answered(task, {"unseen": str(scan)}, "tls://there")


@pytest.mark.slow
def test_an_array_of_slurm_jobs_sorts_and_the_next_command_collects(
    coarse, scans, tmp_path, batch, capsys, monkeypatch
):
    (tmp_path / "job.json").write_text(json.dumps(coarse))
    (tmp_path / "quick.json").write_text(json.dumps(QUICK))
    monkeypatch.chdir(tmp_path)
    out = tmp_path / "out with blanks"
    command = ["sort", "job.json", str(scans), "-o", out.name, "--aligned", "--share", "0.9"]
    command += ["--settings", "quick.json"]
    assert cli.main([*command, "--slurm", "2", "--sbatch=--time=01:00:00"]) == 0
    script = out / "slurm" / "sort.sbatch"
    said = capsys.readouterr().out
    assert f"submit it by: sbatch '{script}'" in said
    then = shlex.split(said.rpartition("then: ")[2])
    assert then[:2] == ["beltgrind", "sort"]
    assert "#SBATCH --array=1-2\n" in script.read_text()
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    for number, there in ((1, 2), (2, 3)):  # deep and thick, then even
        environment["SLURM_ARRAY_TASK_ID"] = str(number)
        done = subprocess.run(
            ["bash", script], env=environment, cwd="/", capture_output=True, text=True
        )
        assert done.returncode == 0 and done.stdout == "", done.stderr
        kept = list((out / sorting.KEPT).rglob("*.json"))
        assert len(kept) == there and not (out / sorting.TABLE).exists()
    assert cli.main([*then[1:], "--workers", "0"]) == 0
    assert "3 were there already" in capsys.readouterr().out
    assert (out / sorting.TABLE).read_bytes() == (batch[0] / sorting.TABLE).read_bytes()
    assert cli.main([*command, "--submit"]) == 2
    assert "go with --slurm" in capsys.readouterr().err


def test_mistakes_are_told(coarse, tmp_path):
    for arguments, code in (
        (([tmp_path],), "studies.no_scans"),
        ((["a.ply"], None, {}, 1.5), "studies.sort_share"),
        ((["a.ply"], None, {"round": 3}), "base.unknown_key"),
    ):
        with pytest.raises(InputError) as error:
            sorting.sort(coarse, *arguments)
        assert error.value.code == code
    row = sorting.sort(coarse, [tmp_path / "none.ply"], workers=0).parts[0]
    assert row["sorted"] == casting.UNKNOWN and "none.ply" in row["reason"]
