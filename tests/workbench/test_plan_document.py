"""Plans as document objects, without a window: what a macro does."""

import json
from pathlib import Path

import pytest
import FreeCAD

import beltgrinding
from beltgrinding import InputError
from support.block import block, make, near, write_pass


def raster_job(doc, **stock):
    job = beltgrinding.make_job(block(doc), ["Face6"], Spacing="1 mm")
    beltgrinding.make_stock(job, **(stock or {"Allowance": "0.2 mm"}))
    beltgrinding.make_belt_machine(
        job, WheelRadius=30, WheelWidth="15 mm", CrownRadius="80 mm", Force="30 N"
    )
    beltgrinding.make_raster(
        job, Along="direction", Direction=FreeCAD.Vector(1, 0, 0), Feed="90 mm/s"
    )
    return job


def raster():
    QUICK = {"Rounds": 3, "Check": False}
    return QUICK


@pytest.mark.slow
@pytest.mark.freecad
def test_a_plan_is_kept_applied_taken_back_and_goes_out_of_date():
    write_pass()
    QUICK = raster()
    doc = FreeCAD.newDocument("life")
    doc.UndoMode = 1
    job = raster_job(doc)
    path = doc.RasterPath
    feeds, digest = list(path.Feeds), path.Proxy.digest(path)
    plan = beltgrinding.make_plan(job, **QUICK)
    assert plan in job.Group and plan.Better and not plan.Applied and not plan.OutOfDate
    assert plan.InTolerance > plan.InToleranceBefore + 10.0, (
        plan.InToleranceBefore,
        plan.InTolerance,
    )
    assert (
        list(path.Feeds) == feeds and path.Proxy.digest(path) == digest
    ), "planning changes no path"
    assert len(plan.NewFeeds) == len(feeds) == len(plan.Along) and plan.Along[-1] > 100.0
    assert plan.Rates and plan.Proxy.data(plan)["better"]
    assert Path(plan.Picture).read_bytes().startswith(b"\x89PNG")

    doc.openTransaction("Apply")
    beltgrinding.apply_plan(plan)
    doc.commitTransaction()
    assert plan.Applied and not plan.OutOfDate and path.Planned
    assert list(path.Feeds) == list(plan.NewFeeds) != feeds
    assert job.Timing == "trapezoidal" and list(path.Zones) == list(plan.Zones)
    simulation = beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    assert near(deviation.InTolerance, plan.InTolerance, 1e-6), "what was told is what is ground"

    doc.saveAs("plan.FCStd")
    FreeCAD.closeDocument("life")
    doc = FreeCAD.openDocument("plan.FCStd")
    plan, job, path = doc.Plan, doc.BeltGrindingJob, doc.RasterPath
    doc.recompute()
    assert plan.Applied and path.Planned and Path(plan.Picture).exists()

    # A setting that the passes depend on lays them anew: the plan is of others.
    path.Feed = "80 mm/s"
    doc.recompute()
    assert not path.Planned and any("laid anew" in one for one in path.Warnings), path.Warnings
    assert not plan.Applied and plan.OutOfDate
    try:
        beltgrinding.apply_plan(plan)
        raise AssertionError("out of date")
    except InputError as error:
        assert "plan again" in str(error)
    path.Feed = "90 mm/s"
    doc.recompute()
    assert plan.OutOfDate and not plan.Applied, "the job has the robot's time since it was applied"
    job.ToleranceUpper = "0.2 mm"
    doc.recompute()
    assert plan.OutOfDate
    job.ToleranceUpper = "0.05 mm"
    plan.FeedMax = "200 mm/s"
    doc.recompute()
    assert plan.OutOfDate, "another setting"


@pytest.mark.freecad
def test_a_plan_replaces_one_feed_for_all_and_plans_forces():
    write_pass()
    QUICK = raster()
    doc = FreeCAD.newDocument("life")
    job = raster_job(doc)
    path = doc.RasterPath
    path.FeedOverride, path.ForceOverride = 100, "25 N"
    doc.recompute()
    limits = {"ForceMin": "10 N", "ForceMax": "60 N", "FeedMin": "60 mm/s", "FeedMax": "120 mm/s"}
    plan = beltgrinding.make_plan(job, Timing="job", **limits, **QUICK)
    assert set(plan.OldForces) == {25.0} and max(plan.NewForces) <= 60.0 + 1e-9
    moving = [f for f, fast in zip(plan.NewFeeds, plan.Rapid) if not fast]
    assert 60.0 - 1e-9 <= min(moving) and max(moving) <= 120.0 + 1e-9
    beltgrinding.apply_plan(plan)
    assert path.FeedOverride.Value == 0.0 and path.ForceOverride.Value == 0.0
    simulation = beltgrinding.simulate(job)
    assert near(beltgrinding.make_deviation(job).InTolerance, plan.InTolerance, 1e-6)


@pytest.mark.freecad
def test_programs_of_files_are_written_with_their_new_feeds_only():
    write_pass()
    doc = FreeCAD.newDocument("life")
    frames = "{X %d,Y %d,Z 20.0,A 0,B 0,C 180}"
    lines = ["DEF grind()", "$TOOL={X 0,Y 0,Z 0,A 0,B 0,C 0}", "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}"]
    for y in range(4, 40, 4):
        lines += ["PTP " + frames % (2, y), "$VEL.CP=0.09"] + [
            f"LIN {frames % (x, y)}" for x in range(6, 60, 4)
        ]
    Path("grind.src").write_text("\n".join([*lines, "END"]) + "\n")
    job = make(block(doc))
    doc.removeObject("RobotPath")
    path = beltgrinding.import_program(job, "grind.src")
    plan = beltgrinding.make_plan(job, Timing="job", Rounds=3, Check=False)
    assert plan.Better, plan.Rates
    Path("out").mkdir()
    files, without = beltgrinding.write_plan(plan, "out")
    assert [f.name for f in files] == ["grind.src"] and not without
    text = Path("out/grind.src").read_text()
    unchanged = [l for l in text.splitlines() if "VEL" not in l]
    assert unchanged == [l for l in lines + ["END"] if "VEL" not in l]
    again = beltgrinding.import_program(job, "out/grind.src")
    for one, other in zip(again.Feeds, plan.NewFeeds):
        assert near(one, other, 1e-4), (one, other)
    doc.removeObject(again.Name)
    doc.recompute()

    before = Path("out/grind.src").read_bytes()
    for wrong, words in (
        (lambda: beltgrinding.write_plan(plan, "out"), "there already"),
        (lambda: beltgrinding.write_plan(plan, "nowhere"), "no folder"),
        (lambda: beltgrinding.write_plan(plan, "."), "there already"),
    ):
        try:
            wrong()
            raise AssertionError(words)
        except InputError as error:
            assert words in str(error), error
    assert Path("out/grind.src").read_bytes() == before
    Path("grind.src").write_text("\n".join([*lines[:-1], "END"]) + "\n")
    Path("other").mkdir()
    try:
        beltgrinding.write_plan(plan, "other")
        raise AssertionError("the file is another one")
    except InputError as error:
        assert "no longer" in str(error), error
    assert not list(Path("other").iterdir())


@pytest.mark.freecad
def test_what_cannot_be_planned_is_refused_and_changes_nothing():
    write_pass()
    QUICK = raster()
    doc = FreeCAD.newDocument("life")
    job = raster_job(doc)
    for settings, words in (
        ({"FeedMin": "200 mm/s"}, "feed_min_mm_s"),
        ({"Keep": json.dumps([{"first_line": 4000}])}, "keep"),
    ):
        try:
            beltgrinding.make_plan(job, **settings, **QUICK)
            raise AssertionError(words)
        except InputError as error:
            assert words in str(error), error
        assert doc.getObject("Plan") is None
    plan = beltgrinding.make_plan(job, compute=False)
    try:
        beltgrinding.apply_plan(plan)
        raise AssertionError("nothing is planned")
    except InputError as error:
        assert "nothing is planned yet" in str(error)
    try:
        beltgrinding.make_plan(job, FeedMin="200 mm/s", **QUICK)
        raise AssertionError("limits")
    except InputError as error:
        assert doc.getObject("Plan") is plan and not plan.Data, "the one that was there stays"


@pytest.mark.slow
@pytest.mark.freecad
def test_before_new_passes_is_the_job_as_it_was():
    doc = FreeCAD.newDocument("again")
    job = raster_job(doc)
    first = beltgrinding.make_plan(job, Rounds=3, Check=False)
    share = first.InTolerance
    assert share > first.InToleranceBefore + 10.0
    beltgrinding.apply_plan(first)
    again = beltgrinding.make_plan(job, LayPasses=True, Rounds=1, Check=False)
    assert near(again.InToleranceBefore, share, 2.0), (again.InToleranceBefore, share)


@pytest.mark.slow
@pytest.mark.freecad
def test_passes_with_less_force_are_what_was_told():
    write_pass()
    raster()
    doc = FreeCAD.newDocument("gentle")
    job = raster_job(doc)
    doc.BeltMachine.Force = "40 N"
    doc.RasterPath.MaxTcpFeed = 20.0
    doc.recompute()
    plan = beltgrinding.make_plan(job, LayPasses=True, Rounds=3, Check=False, FeedMax=25.0)
    told, force = plan.InTolerance, json.loads(plan.Raster)["force_N"]
    assert 0.0 < force < 40.0 and not any(plan.Kept)
    doc.saveAs("gentle.FCStd")
    FreeCAD.closeDocument("gentle")
    doc = FreeCAD.openDocument("gentle.FCStd")
    beltgrinding.apply_plan(doc.Plan)
    pressed = [one for one in doc.RasterPath.Forces if one > 0.0]
    assert pressed and max(pressed) == pytest.approx(force)
    beltgrinding.simulate(doc.BeltGrindingJob)
    assert near(beltgrinding.make_deviation(doc.BeltGrindingJob).InTolerance, told, 1e-6)


@pytest.mark.slow
@pytest.mark.freecad
def test_passes_are_laid_and_planned_and_applied_together():
    write_pass()
    raster()
    doc = FreeCAD.newDocument("life")
    job = raster_job(doc)
    path = doc.RasterPath
    path.StepOver = "18 mm"  # so far apart that stripes stay between them
    doc.recompute()
    poses = len(path.Poses)
    only = beltgrinding.make_plan(job, Rounds=3, Check=False).InTolerance
    plan = beltgrinding.make_plan(job, LayPasses=True, Rounds=3, Check=False)
    assert plan.InTolerance > only + 10.0, (only, plan.InTolerance)
    assert path.StepOver.Value == 18.0 and len(path.Poses) == poses and not plan.OutOfDate
    assert len(plan.NewFeeds) > poses and json.loads(plan.Raster)["step_over_mm"] < 18.0
    told = plan.InTolerance
    doc.saveAs("laid.FCStd")
    FreeCAD.closeDocument("life")
    doc = FreeCAD.openDocument("laid.FCStd")
    plan, job, path = doc.Plan, doc.BeltGrindingJob, doc.RasterPath
    beltgrinding.apply_plan(plan)
    assert plan.Applied and path.StepOver.Value < 18.0 and list(path.Feeds) == list(plan.NewFeeds)
    beltgrinding.simulate(job)
    assert near(beltgrinding.make_deviation(job).InTolerance, told, 1e-6)
    doc.recompute()
    assert path.Planned and plan.Applied

    # Searched for, too.
    plan.SearchSeconds = 10
    doc.recompute()
    assert plan.OutOfDate and not plan.Applied
    plan = beltgrinding.make_plan(job, LayPasses=True, SearchSeconds=10, Rounds=2, Check=False)
    found = json.loads(plan.Data)["search"]
    assert 0.0 < found["reachable"] <= found["reachable_by_any"] <= 1.0 and found["wheels"]
    assert plan.InTolerance >= told - 1.0 and found["seconds"] < 60.0
    searched = plan.InTolerance
    beltgrinding.apply_plan(plan)
    beltgrinding.simulate(job)
    assert near(beltgrinding.make_deviation(job).InTolerance, searched, 1e-6)

    # With a program of another kind there are no passes to lay.
    beltgrinding.import_program(job, "pass.csv")
    try:
        beltgrinding.make_plan(job, LayPasses=True)
        raise AssertionError("two paths")
    except InputError as error:
        assert "one active raster path" in str(error), error


@pytest.mark.slow
@pytest.mark.freecad
def test_what_is_told_is_what_the_file_does():
    write_pass()
    doc = FreeCAD.newDocument("life")
    job = raster_job(doc)
    # There is no force device: the file sets no force, and the plan goes on with the belt machine's.
    plan = beltgrinding.make_plan(job, Rounds=1, ForceMin="5 N")
    told = plan.Proxy.data(plan)["from_file"]["in_tolerance"]
    assert near(plan.InTolerance, 100.0 * told, 1e-9)
    assert any("with the force that the file has" in one for one in plan.FilesShort)
    beltgrinding.apply_plan(plan)
    beltgrinding.export_program(doc.RasterPath, "passes.src")
    again = beltgrinding.import_program(job, "passes.src")
    grinds = [not fast for fast in doc.RasterPath.Rapid]
    for name in ("Feeds", "Forces"):
        mine, its = getattr(doc.RasterPath, name), getattr(again, name)
        off = [(a, b) for a, b, on in zip(mine, its, grinds) if on and not near(a, b, 0.1)]
        assert not off, (name, off[:5])


@pytest.mark.freecad
def test_a_program_takes_along_what_it_is_read_with():
    write_pass()
    doc = FreeCAD.newDocument("life")
    frames = "{X %d,Y %d,Z Z0,A 0,B 0,C 180}"
    lines = ["DEF grind()", "$TOOL={X 0,Y 0,Z 0,A 0,B 0,C 0}", "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}"]
    for y in range(4, 40, 4):
        lines += ["PTP " + frames % (2, y), "$VEL.CP=0.09"] + [
            f"LIN {frames % (x, y)}" for x in range(6, 60, 4)
        ]
    Path("grind.src").write_text("\n".join([*lines, "END"]) + "\n")
    values = {"variables": {"Z0": 20.0}}
    Path("grind.values.json").write_text(json.dumps(values))
    job = make(block(doc))
    doc.removeObject("RobotPath")
    beltgrinding.import_program(job, "grind.src")
    plan = beltgrinding.make_plan(job, Timing="job", Rounds=2)
    assert plan.Better, plan.Rates
    assert not any("poses of the plan" in one for one in plan.FilesShort), plan.FilesShort
    Path("out").mkdir()
    beltgrinding.write_plan(plan, "out")
    assert json.loads(Path("out/grind.values.json").read_text()) == values
    again = beltgrinding.import_program(job, "out/grind.src")
    assert list(again.Poses) == list(doc.RobotPath.Poses)
