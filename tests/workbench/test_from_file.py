"""What a written program does: read again, under the robot's time, at half the spacing."""

import json

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.engine import core
from beltgrinding.job import load as jobs, poses
from beltgrinding.job.robot_time import timed
from beltgrinding.planning import by_rules, from_file, rounds
from beltgrinding.programs.writers.writer import write_program
from beltgrinding.raster import raster_path
from beltgrinding.simulation import convergence, run as runs
from test_grinding import PASSES, job_of
from test_job import plate

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
    write, _ = writer(tmp_path, ".csv")
    context = core.RunContext().part(0.0, 1.0)
    read = from_file._read(planned, write(planned), tmp_path, False, context)
    # The same job and path, simulated here at half the spacing, step and contact cells.
    job = jobs.validate({**planned.job, "programs": [{"file": str(tmp_path / "path.csv")}]})
    alone = runs.run(convergence.scaled(timed(job), "fine"))
    np.testing.assert_array_equal(read.result.field.height, alone.field.height)
    told, share = (one.summary["in_tolerance_area_share"] for one in (alone, planned.after))
    assert read.forces and read.figures["in_tolerance"] == told
    # What half the spacing changes is the difference, for all else is the same.
    assert read.sampling == pytest.approx(told - share, abs=1e-12)


def test_one_run_has_the_result_its_verdict_the_figures_and_the_reasons(planned, tmp_path):
    write, written = writer(tmp_path, ".csv")
    rows = []
    checked = from_file.check(planned, tmp_path, write, told=rows.append, before=False)
    plan, told = checked.plan, checked.entry["in_tolerance"]
    assert told == max(one["in_tolerance"] for one in rows if one.get("from_file"))
    assert plan.after.summary["in_tolerance_area_share"] == told
    assert plan.after.verdict["in_share"] == pytest.approx(told, abs=1e-9)
    assert len(plan.why["state"]) == plan.after.field.size
    assert sum(plan.why["shares"].values()) == pytest.approx(1.0 - told, abs=1e-6)
    # And what stands in the folder is that plan's.
    job = jobs.validate({**planned.job, "programs": [{"file": str(tmp_path / "path.csv")}]})
    (mine,), (its,) = from_file._arrays(plan.job), from_file._arrays(job)
    for name in ("feeds", "forces", "zones"):
        assert its[name] == pytest.approx(mine[name], abs=1e-6)


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
    (mine,), (its,) = from_file._arrays(checked.plan.job), from_file._arrays(jobs.validate(job))
    grinds = ~its["rapid"]  # a file has no feed for the others
    assert its["feeds"][grinds] == pytest.approx(mine["feeds"][grinds], rel=1e-3)


def test_a_refined_plan_is_not_halved_again(tmp_path):
    job = tmp_path / "job.json"
    assert not from_file.is_at_half(job)
    for told, half in (
        ({"half": True}, True),
        ({"half": False}, False),
        ({}, False),
        (None, False),
    ):
        (tmp_path / "plan.json").write_text(json.dumps({"from_file": told}))
        assert from_file.is_at_half(job) is half
    (tmp_path / "plan.json").write_text('{"from_file": {"half": true}}')
    assert not from_file.is_at_half(tmp_path / "other.json")  # no plan has written that
    (tmp_path / "plan.json").write_text("[1]")
    assert not from_file.is_at_half(job)


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


def share_told(line):
    """In percent, as printed."""
    return float(line.partition(" %")[0].rpartition(" ")[2])


@pytest.mark.slow
def test_grind_tells_one_set_of_figures_and_they_are_the_files(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(by_rules, "TRIES", 1)
    (tmp_path / "plate.brep").write_text(plate().write_brep())
    out = tmp_path / "out"
    begin = ["grind", str(tmp_path / "plate.brep"), "-o", str(out), "--stock", "0.2"]
    begin += ["--budget", "0"]
    begin += ["--set", "rounds=1", "--program", "plate.csv"]
    assert cli.main(begin) == 0
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    data = json.loads((out / "plan.json").read_text())
    summary = json.loads((out / "result" / "summary.json").read_text())
    verdict = json.loads((out / "result" / "verdict.json").read_text())
    told = data["from_file"]["in_tolerance"]
    assert data["after"]["in_tolerance"] == summary["in_tolerance_area_share"] == told
    assert verdict["in_share"] == pytest.approx(told, abs=1e-9)
    planned = next(line for line in lines if line.startswith("planned: "))
    rows = [line.split() for line in lines if line.lstrip().startswith("file ")]
    assert share_told(planned) == share_told(lines[-1]) == float(f"{100 * told:.1f}")
    assert f"{100 * told:.1f}" in [row[1] for row in rows]
    assert lines[-1].startswith("FAIL: ") and lines[-1].endswith(" collisions")
    assert "error: gouge" in printed.err
    header = next(k for k, line in enumerate(lines) if line.startswith("round "))
    assert all(len(line) >= len("round  in tol. %") for line in lines[header : header + 3])
    # A stranger finds the same, at half the spacing that the plan has.
    capsys.readouterr()
    job = str(out / "job.json")
    assert cli.main(["verify", str(out / "plate.csv"), "--job", job]) == 1
    again = share_told(capsys.readouterr().out.splitlines()[-1])
    assert again == pytest.approx(share_told(lines[-1]), abs=0.5)
    assert cli.main([*begin, "--check", "-q"]) == 1
    assert cli.main([*begin, "--check", "--wanted", "0"]) == 2


@pytest.mark.slow
def test_plan_reads_the_programs_that_it_wrote(tmp_path, capsys):
    data, file = laid_on(job_of(), tmp_path)
    data["programs"] = [{"file": str(file)}]
    (tmp_path / "job.json").write_text(json.dumps(data))
    out = tmp_path / "out"
    begin = ["plan", str(tmp_path / "job.json"), "-o", str(out), "--set", "rounds=1"]
    assert cli.main(begin) == 0
    lines = capsys.readouterr().out.splitlines()
    plan = json.loads((out / "plan.json").read_text())
    told = plan["from_file"]["in_tolerance"]
    result = json.loads((out / "result" / "summary.json").read_text())
    assert result["in_tolerance_area_share"] == told == plan["after"]["in_tolerance"]
    assert plan["checked"]["after"]["in_tolerance"] == told > plan["before"]["in_tolerance"]
    assert result["spacing_mm"] == 0.5
    job = jobs.load(out / "job.json")
    assert job["programs"][0]["file"] == str(out / "path.csv")
    alone = runs.run(convergence.scaled(timed(job), "fine"))
    assert alone.summary["in_tolerance_area_share"] == told
    assert share_told(lines[-1]) == float(f"{100 * told:.1f}")


def test_a_coarse_sampling_is_told_and_planned_on_at_half(tmp_path):
    """Samples as far apart as the contact is long do not see what the passes leave between them."""
    job = {**job_of(), "sampling": {**job_of()["sampling"], "spacing_mm": 6.0}}
    laid = raster_path.raster(job_of(), {**PASSES, "step_over_mm": 14.0})
    data = {**timed(job), "programs": [{"poses": poses.list_poses(laid), "unresolved": 0}]}
    found = rounds.plan(data, {"rounds": 1, "check": False})
    write, written = writer(tmp_path, ".csv")
    rows = []
    checked = from_file.check(found, tmp_path, write, told=rows.append, before=False)
    read = [one for one in rows if one.get("from_file")]
    assert abs(read[0]["in_tolerance"] - found.after.summary["in_tolerance_area_share"]) > 0.01
    assert len(read) == 2 and "at half the spacing" in str(checked.notes[0])
    assert written[1].job["sampling"]["spacing_mm"] == 3.0
    assert checked.entry["in_tolerance"] == max(one["in_tolerance"] for one in read)
    if abs(checked.entry["sampling"]) > from_file.SAMPLING:
        assert f"+-{100 * abs(checked.entry['sampling']):.1f} points" in str(checked.notes[-1])


@pytest.mark.slow
@pytest.mark.parametrize(
    "program, device",
    [
        ("path.src", {"kind": "call", "name": "PRESS", "resolution_N": 0.1}),
        ("path.mod", {"kind": "analog", "name": "aoForce", "scale_per_N": 0.1}),
    ],
)
def test_with_a_force_device_the_file_presses_as_planned(
    tmp_path, capsys, monkeypatch, program, device
):
    monkeypatch.setattr(by_rules, "TRIES", 1)
    job = job_of(force_device=device)
    (tmp_path / "job.json").write_text(json.dumps(job))
    out = tmp_path / "out"
    begin = ["grind", str(tmp_path / "job.json"), "-o", str(out), "--program", program]
    begin += ["--budget", "0"]
    assert cli.main([*begin, "--set", "rounds=1"]) == 0, capsys.readouterr().err
    capsys.readouterr()
    data = json.loads((out / "plan.json").read_text())
    planned = jobs.load(out / "job.json")
    read = from_file.with_programs(planned, [{"file": program}], out)
    (mine,), (its,) = from_file._arrays(planned), from_file._arrays(read)
    grinds = ~mine["rapid"]
    assert mine["forces"][grinds].min() < 15.0  # the plan is gentle somewhere
    assert its["forces"][grinds] == pytest.approx(mine["forces"][grinds], abs=0.11)
    assert not [one for one in data["from_file"]["notes"] if "force" in one]
