"""What a written program does: read again, under the robot's time, at half the spacing."""

import json

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.engine import core
from beltgrinding.job import load as jobs, poses
from beltgrinding.job.robot_time import timed
from beltgrinding.planning import from_file, rounds
from beltgrinding.programs.writers.writer import write_program
from beltgrinding.raster import raster_path
from beltgrinding.simulation import convergence, run as runs
from test_grinding import PASSES, job_of

QUICK = {"rounds": 1, "check": False, "force_min_N": 6.0}


def laid_on(job, folder, suffix=".csv", **settings):
    """The job with passes as its poses, and the same as a program's file."""
    laid = raster_path.raster(job, {**PASSES, **settings})
    file = folder / f"path{suffix}"
    write_program(file, None, raster_path.program(laid))
    return {**job, "programs": [{"poses": poses.list_poses(laid), "unresolved": 0}]}, file


@pytest.fixture(scope="module")
def planned():
    job = job_of()
    laid = raster_path.raster(job, PASSES)
    data = {**timed(job), "programs": [{"poses": poses.list_poses(laid), "unresolved": 0}]}
    return rounds.plan(data, QUICK)


def writer(folder, suffix):
    """Writes a plan's program; every plan that it wrote."""
    written = []

    def write(found):
        listed = poses.listed_poses(found.job["programs"][0]["poses"], "raster")
        write_program(folder / f"path{suffix}", None, raster_path.program(listed))
        written.append(found)
        return [{"file": f"path{suffix}"}]

    return write, written


def test_a_file_that_holds_all_is_what_was_planned(planned, tmp_path):
    write, written = writer(tmp_path, ".csv")
    rows = []
    checked = from_file.check(planned, tmp_path, write, told=rows.append, before=False)
    # The same job and path, simulated here at half the spacing, step and contact cells.
    job = jobs.validate({**planned.job, "programs": [{"file": str(tmp_path / "path.csv")}]})
    alone = runs.run(convergence.scaled(timed(job), "fine"))
    np.testing.assert_array_equal(checked.plan.after.field.height, alone.field.height)
    told = alone.summary["in_tolerance_area_share"]
    assert checked.entry["in_tolerance"] == told
    share = planned.after.summary["in_tolerance_area_share"]
    assert checked.entry["sampling"] == pytest.approx(told - share, abs=1e-12)
    assert len(written) == len(rows) == 1 and checked.short == checked.notes == []
    assert rows[0]["from_file"] is True
    assert rows[0]["in_tolerance"] == alone.summary["in_tolerance_area_share"]
    # One run has the result, its verdict, the figures and why the rest stays.
    plan = checked.plan
    assert plan.after.verdict["in_share"] == pytest.approx(checked.entry["in_tolerance"], abs=1e-9)
    assert len(plan.why["state"]) == plan.after.field.size
    out = sum(plan.why["shares"].values())
    assert out == pytest.approx(1.0 - checked.entry["in_tolerance"], abs=1e-6)


def test_forces_that_the_file_does_not_set_are_told_and_planned_without(planned, tmp_path):
    assert planned.factors.min() < 0.9  # there is something to lose
    write, written = writer(tmp_path, ".src")
    read = from_file._read(
        planned, write(planned), tmp_path, False, core.RunContext().part(0.0, 1.0)
    )
    assert not read.forces
    told = " ".join(map(str, read.short))
    assert "points less than planned" in told and "the file sets none: 30.0 N" in told
    checked = from_file.check(planned, tmp_path, write, before=False)
    assert len(written) == 3, "it did not plan on"
    assert "with the force that the file has" in str(checked.notes[0])
    assert checked.entry["in_tolerance"] > read.figures["in_tolerance"] + 0.05
    # What stands in the folder in the end is what is told.
    job = {**planned.commands.job, "programs": [{"file": str(tmp_path / "path.src")}]}
    assert from_file._arrays(jobs.validate(job))[0]["feeds"] == pytest.approx(
        from_file._arrays(checked.plan.job)[0]["feeds"], rel=1e-3
    )


def test_what_a_short_block_reaches():
    """10 mm from standstill to standstill at 1000 mm/s2: up to 100 mm/s, on the mean 50, in 0.2 s."""
    ends = [
        {"x_mm": x, "y_mm": 0, "z_mm": 0, "qw": 0, "qx": 1, "qy": 0, "qz": 0, "feed_mm_s": 200}
        for x in (0, 10, 20)
    ]
    job = jobs.validate(
        {
            "design": {"brep": ""},
            "simulation": {
                "timing": "trapezoidal",
                "path_acceleration_mm_s2": 1000,
                "default_zone_mm": 0,
            },
            "programs": [{"poses": ends}],
        }
    )
    reached = from_file._reached(job, 0)
    assert reached[1:] == pytest.approx([50.0, 50.0])
    mine = from_file._arrays(job)[0]
    told = str(from_file._reason(mine, mine, reached, 1))
    assert told == "the robot reaches 50.0 of 200.0 mm/s there"
    other = {**mine, "forces": mine["forces"] + 5.0}
    assert "sets none: " in str(from_file._reason(other, mine, reached, 1))
    slower = {**mine, "feeds": 0.5 * mine["feeds"]}
    assert "planned with 200.0 mm/s, and the file has 100.0" in str(
        from_file._reason(mine, slower, reached, 1)
    )
    fewer = {name: values[:2] for name, values in mine.items()}
    assert "1 poses of the plan" in str(from_file._reason(mine, fewer, reached, 1))


def test_verify_says_what_a_file_does(tmp_path, capsys):
    data, file = laid_on(job_of(0.1), tmp_path)
    data["inspection"] = {"tolerance_mm": [-0.02, 0.02]}
    (tmp_path / "job.json").write_text(json.dumps(data))
    begin = ["verify", str(file), "--job", str(tmp_path / "job.json")]
    out = tmp_path / "out"
    assert cli.main([*begin, "-o", str(out)]) == 1
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("FAIL: ")
    summary = json.loads((out / "summary.json").read_text())
    assert summary["spacing_mm"] == 0.5  # of 1 mm
    job = jobs.validate({**data, "programs": [{"file": str(file)}]})
    alone = runs.run(convergence.scaled(timed(job), "fine"))
    assert summary["in_tolerance_area_share"] == alone.summary["in_tolerance_area_share"]
    assert f"FAIL: {100 * alone.summary['in_tolerance_area_share']:.1f} %" in last
    wide = {**data, "inspection": {"tolerance_mm": [-1.0, 1.0]}, "programs": []}
    (tmp_path / "job.json").write_text(json.dumps(wide))
    assert cli.main([*begin, "--check"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("PASS: 100.0 % in tolerance")
    assert cli.main(["verify", "none.src", "--job", str(tmp_path / "job.json")]) == 2
    assert "none.src" in capsys.readouterr().err
