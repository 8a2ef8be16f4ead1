"""A study as an array of jobs of a real Slurm; one of them is cancelled while it runs."""

import json
import time

import pytest

from beltgrinding import cli
from beltgrinding.studies import making, table
from support import slurm
from test_study import run_files
from test_study_cluster import many

RUNS = 12


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    lacking = slurm.missing()
    if lacking:
        pytest.skip(f"no {', '.join(lacking)} here")
    one = slurm.Slurm(tmp_path_factory.mktemp("slurm"))
    try:
        one.start()
    except slurm.DoesNotStart as error:
        pytest.skip(f"Slurm does not start here: {error}")
    yield one
    one.stop()


@pytest.mark.slow
def test_an_array_whose_jobs_are_cancelled_gives_the_serial_table(
    cluster, tmp_path, monkeypatch, capsys
):
    making.study(many(RUNS), tmp_path / "serial", workers=0)
    study = tmp_path / "the study.json"
    study.write_text(json.dumps(many(RUNS)))
    out = tmp_path / "out"
    for name, value in cluster.environment.items():
        monkeypatch.setenv(name, value)
    command = ["study", str(study), "-o", str(out)]
    assert cli.main([*command, "--slurm", "3", "--submit"]) == 0
    said = capsys.readouterr().out
    assert "Submitted batch job" in said
    # What is to be typed then can be pasted.
    assert said.rstrip().endswith(f"then: beltgrind study '{study}' -o {out}")
    number = said.split("Submitted batch job ")[1].split()[0]
    end = time.monotonic() + 120.0
    while not run_files(out):
        assert time.monotonic() < end, cluster.ask("squeue")
        time.sleep(0.05)
    cluster.ask("scancel", f"{number}_1")
    cluster.wait(240.0)
    there = len(run_files(out))
    assert 2 * RUNS // 3 <= there < RUNS
    # The array again makes what is missing, and no more; the next study collects it all.
    assert cli.main([*command, "--slurm", "3", "--submit", "--quiet"]) == 0
    cluster.wait(240.0)
    logs = [path.read_text() for path in (out / "slurm").glob("*.log")]
    assert len(logs) == 6 and not any("Traceback" in log for log in logs), logs
    assert not (out / table.FILE).exists()
    capsys.readouterr()
    assert cli.main([*command, "--workers", "0"]) == 0
    assert f"{RUNS} were there already" in capsys.readouterr().out
    assert (out / table.FILE).read_bytes() == (tmp_path / "serial" / table.FILE).read_bytes()
