"""From faces to passes, feeds and forces: the search, and the command that begins with a part's file."""

import csv
import json

import pytest

from beltgrinding import cli
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.job.typed import typed
from beltgrinding.planning import grinding, rounds
from test_job import plate

QUICK = {"rounds": 2, "check": False}
PASSES = {"along": "direction", "direction": [1.0, 0.0, 0.0], "feed_mm_s": 90.0}


def job_of(allowance=0.2, **machine):
    return jobs.validate(
        {
            "design": {"brep": plate().write_brep()},
            "sampling": {"spacing_mm": 1.0},
            "stock": {"allowance_mm": allowance},
            "belt_machine": {
                "wheel": {"radius_mm": 30, "width_mm": 15, "crown_radius_mm": 80},
                "force_N": 30,
                **machine,
            },
            "cell": {"check_collisions": False},
            "programs": [{"poses": []}],
        }
    )


def test_stripes_between_passes_bring_them_closer():
    told = []
    found = grinding.grind(job_of(), {**PASSES, "step_over_mm": 18.0}, QUICK, told=told.append)
    first = found.tried[0]
    assert found.settings["step_over_mm"] < 18.0 == first["step_over_mm"]
    share = found.plan.after.summary["in_tolerance_area_share"]
    assert share > first["in_tolerance"] + 0.1, (first, share)
    assert told[: len(found.tried)] == found.tried and len(told) > len(found.tried)
    # What is told is what the passes of these settings give.
    alone = rounds.plan(
        {**job_of(), "programs": found.plan.job["programs"]}, {**QUICK, "rounds": 1}
    )
    assert alone.rounds[0]["in_tolerance"] == pytest.approx(share, abs=1e-9)


@pytest.mark.slow
def test_too_much_stock_for_the_least_feed_repeats_the_passes():
    limits = {**QUICK, "feed_min_mm_s": 60.0}
    found = grinding.grind(job_of(0.6), {**PASSES, "max_tcp_feed_mm_s": 100.0}, limits)
    assert found.settings["repeats"] > 1, found.tried
    once = found.tried[0]
    assert found.plan.after.summary["in_tolerance_area_share"] > once["in_tolerance"] + 0.3, once
    poses, repeats = found.plan.job["programs"][0]["poses"], found.settings["repeats"]
    assert len(poses) == len(found.laid["frames"]) and len(poses) % repeats == 0


@pytest.mark.slow
def test_without_a_device_a_force_that_is_right_stays():
    found = grinding.grind(job_of(), PASSES, QUICK)
    assert set(found.plan.factors) == {1.0}
    assert set(found.laid["forces"]) == {-1.0}
    job = found.plan.job["programs"][0]["poses"]
    assert {one.get("force_N", 30.0) for one in job} <= {30.0}


@pytest.mark.slow
def test_a_force_that_cuts_too_deep_at_the_greatest_feed_comes_down():
    limits = {**QUICK, "feed_max_mm_s": 25.0}
    found = grinding.grind(job_of(0.1), {**PASSES, "max_tcp_feed_mm_s": 20.0}, limits)
    force = found.plan.job["belt_machine"]["force_N"]
    share = found.plan.after.summary["in_tolerance_area_share"]
    assert force == found.settings["force_N"] < 20.0 and {
        one["change"] for one in found.tried[:2]
    } == {"first", "force"}
    assert share > found.tried[0]["in_tolerance"] + 0.5, (force, share)
    assert set(found.laid["forces"]) == {-1.0}  # the program sets none
    kept = grinding.grind(job_of(0.1), {**PASSES, "force_N": 30.0}, limits)
    assert kept.plan.job["belt_machine"]["force_N"] == 30.0


def test_forces_go_down_only_unless_asked():
    device = {"kind": "analog", "greatest_N": 60.0, "scale_per_N": 0.01}
    found = grinding.grind(job_of(force_device=device), PASSES, QUICK)
    assert found.plan.factors.min() < 1.0 and min(found.laid["forces"]) < 30.0
    forces = found.plan.commands.force(found.plan.factors)
    assert forces.max() <= 30.0 + 1e-9 and found.plan.factors.min() >= grinding.GENTLER - 1e-9
    position = grinding.with_forces(typed(job_of(control="position")), rounds.validate({}))
    assert position["force_min_N"] == 0.0


@pytest.mark.slow
def test_a_part_alone_becomes_a_program(tmp_path, capsys):
    (tmp_path / "plate.brep").write_text(plate().write_brep())
    out = tmp_path / "out"
    options = ["--set", "check=false", "--set", "rounds=2", "--program", "plate.csv"]
    options += ["--budget", "0"]
    begin = ["grind", str(tmp_path / "plate.brep"), "-o", str(out), "--stock", "0.2", *options]
    assert cli.main(begin) == 0
    printed = capsys.readouterr().out
    assert "passes       wheel mm" in printed and "planned: " in printed
    names = {path.name for path in out.iterdir()}
    assert names == {"plate.csv", "job.json", "feeds.csv", "plan.json", "plan.png", "result"}
    plan = json.loads((out / "plan.json").read_text())
    assert plan["after"]["in_tolerance"] > 0.7, plan
    job = json.loads((out / "job.json").read_text())
    rows = [
        r for r in csv.reader((out / "plate.csv").read_text().splitlines()) if r and r[0][0] != "#"
    ]
    assert len(rows) - 1 == len(job["programs"][0]["poses"])
    assert cli.main(["run", str(out / "job.json"), "-o", str(tmp_path / "again"), "-q"]) == 0
    again = json.loads((tmp_path / "again" / "summary.json").read_text())
    assert again["in_tolerance_area_share"] == pytest.approx(
        plan["after"]["in_tolerance"], abs=1e-9
    )
    # Its own files may be replaced, others not.
    assert cli.main(begin) == 0
    (out / "plan.json").write_text("{}")
    assert cli.main(begin) == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    "options, words",
    [
        (["--faces", "one"], "write numbers from 1"),
        (["--faces", "99"], "no face 99"),
        (["--program", "a/b.src"], "give a name"),
        (["--program", "a.xyz"], "a.xyz: no program is written as '.xyz'"),
        (["--program", "my-part.src"], "'my-part' is no name of a KRL module"),
        (["--wanted", "0"], "--wanted 0: give a share"),
        (["--set", "rounds=0"], "rounds"),
        (["--set-raster", "along=west"], "along"),
        (["--tolerance", "0.1", "0.0"], "tolerance"),
    ],
)
def test_nonsense_is_refused(tmp_path, capsys, options, words):
    (tmp_path / "plate.brep").write_text(plate().write_brep())
    out = tmp_path / "out"
    assert cli.main(["grind", str(tmp_path / "plate.brep"), "-o", str(out), *options]) == 2
    assert words in capsys.readouterr().err
    assert not out.exists()


def test_a_job_has_its_own_stock(tmp_path, capsys):
    (tmp_path / "job.json").write_text("{}")
    assert cli.main(["grind", str(tmp_path / "job.json"), "-o", "out", "--stock", "1"]) == 2
    assert "the job has its own" in capsys.readouterr().err
