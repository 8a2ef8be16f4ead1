"""The robot's time: its controller's limits in a job, and plans that keep to them."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import planning
from beltgrinding.base import frames, schemas
from beltgrinding.cell.tool_path import tool_path
from beltgrinding.cli import plan as cli_plan
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs, poses, robot_time
from beltgrinding.planning import rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.presets import library
from beltgrinding.raster import raster_path
from beltgrinding.simulation import run as runs
from test_job import ROOT, plate

SIMULATION = schemas.schema("job")["properties"]["simulation"]["properties"]


def job_of(**more):
    listed = [{"x_mm": x, "y_mm": 0, "z_mm": 0, "qw": 1, "qx": 0, "qy": 0, "qz": 0} for x in (0, 9)]
    given = {"design": {"file": "part.step"}, "programs": [{"poses": listed}], **more}
    return jobs.validate(given)


def test_a_job_under_its_controllers_time():
    job = job_of(robot={"controller": "krc4"})
    simulation = robot_time.timed(job)["simulation"]
    assert job["simulation"]["timing"] == "constant_feed"  # the job given stays
    assert simulation["timing"] == "trapezoidal"
    assert simulation["path_acceleration_mm_s2"] == 2300.0  # $ACC.CP 2.3 m/s2
    assert simulation["angular_acceleration_deg_s2"] == 500.0
    assert simulation["max_travel_mm"] == SIMULATION["max_travel_mm"]["default"]
    found = robot_time.limits(job)
    assert found.cycle_s == 0.012 and found.least_block_s == pytest.approx(0.036)
    assert found.form == "spline" and found.look_ahead == 3


def test_what_the_job_gives_itself_stays():
    own = {"path_acceleration_mm_s2": 900.0, "default_zone_mm": 0.0}
    job = job_of(robot={"controller": "ur_e"}, simulation=own)
    simulation = robot_time.timed(job)["simulation"]
    assert simulation["path_acceleration_mm_s2"] == 900.0 and simulation["default_zone_mm"] == 0.0
    assert simulation["rotation_speed_deg_s"] == 180.0
    again = robot_time.timed(robot_time.timed(job))
    assert again == robot_time.timed(job)
    assert robot_time.limits(job) == robot_time.limits(again)


def test_without_a_controller_it_is_the_common_one_which_all_others_keep():
    common = robot_time.limits(job_of())
    assert common.controller == "common"
    for preset in library.controllers():
        one = robot_time.limits(job_of(robot={"controller": preset["id"]}))
        assert one.cycle_s <= common.cycle_s and one.least_block_mm <= common.least_block_mm
        for key in ("path_acceleration_mm_s2", "angular_acceleration_deg_s2"):
            assert getattr(one, key) >= getattr(common, key), (preset["id"], key)
        assert one.rotation_speed_deg_s >= common.rotation_speed_deg_s


def test_a_controller_that_is_not_there_is_named():
    with pytest.raises(InputError, match="no 'krc5' among the controllers; did you mean 'krc4'"):
        job_of(robot={"controller": "krc5"})


def test_block_time_is_three_cycles_or_the_controllers_own():
    times = {
        name: robot_time.limits(job_of(robot={"controller": name})).least_block_s
        for name in ("krc2", "irc5", "r30ib", "yrc1000", "ur_e")
    }
    assert times == pytest.approx(
        {"krc2": 0.036, "irc5": 0.02, "r30ib": 0.024, "yrc1000": 0.012, "ur_e": 0.006}
    )


def poses_of(places, feed=50.0, **more):
    return [
        {"x_mm": x, "y_mm": y, "z_mm": z, "qw": 1, "qx": 0, "qy": 0, "qz": 0, "feed_mm_s": feed}
        | more
        for x, y, z in places
    ]


def commands_of(listed, controller="krc4", **settings):
    job = job_of(robot={"controller": controller}, programs=[{"poses": listed}])
    data, given = rounds.in_time(job, rounds.validate(settings))
    return Commands(data, given)


def test_no_block_is_faster_than_three_cycles():
    """0.2 mm in 3 cycles of 12 ms: 5.56 mm/s, 5.5 with the digits of a program; with 2 ms 33.3."""
    places = [(x, 0, 0) for x in (0.0, 20.0, 20.2, 40.2)]
    assert commands_of(poses_of(places)).feed_range[1][2] == 5.5
    assert commands_of(poses_of(places), "ur_e").feed_range[1][2] == pytest.approx(33.3)
    assert commands_of(poses_of(places), timing="job").feed_range[1][2] == 150.0


def test_no_feed_is_greater_than_the_robot_comes_to():
    """From rest over 6 mm to rest with 2300 mm/s2: sqrt(6 * 2300) = 117.5 mm/s half way, on a thirty-second of it 115.6."""
    places = [(0, 0, 0), (6, 0, 0), (6, 0, 0.0)]
    given = poses_of(places)
    given[1]["zone_mm"] = 0.0
    given[2].update(x_mm=30.0, rapid=True)
    most = commands_of(given).feed_range[1]
    assert math.sqrt(6.0 * 2300.0) * 0.98 < most[1] <= math.sqrt(6.0 * 2300.0)
    # A turn of 90 degrees over 10 mm at 200 degrees/s takes 0.45 s at least.
    turned = poses_of([(0, 0, 0), (10, 0, 0), (20, 0, 0)])
    turned[1].update(qw=math.sqrt(0.5), qz=math.sqrt(0.5))
    turned[2].update(qw=math.sqrt(0.5), qz=math.sqrt(0.5))
    assert commands_of(turned).feed_range[1][1] < 10.0 / 0.45


def test_poses_have_the_digits_of_a_program_and_zones_of_half_a_block():
    given = poses_of([(0.12345, 0, 0), (3, 0, 0), (4, 0, 0), (4, 5, 0), (4, 5.5, 0)])
    for pose in given[1:]:
        turn = math.radians(10.00042)
        pose.update(qw=math.cos(turn / 2), qz=math.sin(turn / 2))
    given[4]["zone_mm"] = 3.0
    (arrays,) = commands_of(given).arrays
    assert arrays["frames"][0, 0, 3] == 0.123
    assert frames.to_abc(arrays["frames"][2])[0] == pytest.approx(10.0, abs=1e-9)
    # Straight on: half of the shorter way. At the corner the default of 1 mm, or half of the millimetre before it.
    assert arrays["zones"][1:] == pytest.approx([0.5, 0.5, 0.25, 0.25])
    assert robot_time.rounded_feeds(np.array([5.5556, 0.3, 0.04, 30.0])).tolist() == [
        5.5,
        0.3,
        0.04,
        30.0,
    ]


@pytest.fixture(scope="module")
def laid():
    """A job with the passes of a plate of 60 x 40 mm as poses, 0.25 mm of stock, a force that may follow the feed."""
    given = {
        "design": {"brep": plate().write_brep()},
        "sampling": {"spacing_mm": 1.0},
        "stock": {"allowance_mm": 0.25},
        "belt_machine": {
            "wheel": {"radius_mm": 30, "width_mm": 15, "crown_radius_mm": 80},
            "force_N": 30,
        },
        "cell": {"check_collisions": False},
        "robot": {"controller": "krc4"},
        "programs": [{"poses": []}],
    }
    way = {"along": "direction", "direction": [1, 0, 0], "step_over_share": 0.5}
    found = raster_path.raster(jobs.validate(given), {**way, "feed_mm_s": 60.0})
    return jobs.validate({**given, "programs": [{"poses": poses.list_poses(found)}]})


@pytest.fixture(scope="module")
def plan(laid):
    return planning.plan(laid, {"check": False, "rounds": 5, "force_min_N": 3.0})


def within(plan):
    """Asserts that all blocks last three cycles and that speeds change within the acceleration."""
    (arrays,), found = plan.commands.arrays, robot_time.limits(plan.job)
    new = np.array([pose["feed_mm_s"] for pose in plan.job["programs"][0]["poses"]])
    way = np.append(0.0, np.linalg.norm(np.diff(arrays["frames"][:, :3, 3], axis=0), axis=1))
    blocks = ~arrays["rapid"] & (way > 1e-6)
    assert (way[blocks] / new[blocks]).min() >= found.least_block_s * (1.0 - 1e-6)
    assert np.allclose(new[blocks] * 10.0, np.round(new[blocks] * 10.0), atol=1e-6)
    pairs = np.flatnonzero(blocks[1:] & blocks[:-1]) + 1
    between = 0.5 * (way[pairs] + way[pairs - 1])
    change = abs(new[pairs] ** 2 - new[pairs - 1] ** 2) / (2.0 * between)
    assert change.max() <= found.path_acceleration_mm_s2 * (1.0 + 1e-6)
    half = 0.5 * np.minimum(way[pairs - 1], way[pairs])
    assert (arrays["zones"][pairs - 1] <= half + 1e-9).all()


def test_blocks_and_accelerations_of_a_plan(plan):
    assert plan.better
    within(plan)
    simulation = plan.job["simulation"]
    assert simulation["timing"] == "trapezoidal"
    assert simulation["path_acceleration_mm_s2"] == 2300.0
    forces = np.array([pose.get("force_N", 30.0) for pose in plan.job["programs"][0]["poses"]])
    assert np.allclose(forces * 10.0, np.round(forces * 10.0), atol=1e-6)


def test_the_robot_moves_within_its_acceleration(plan):
    """The way of the tool centre point itself, in steps of half a millisecond: what is left over is that of differences."""
    found, path = robot_time.limits(plan.job), tool_path(plan.job, 0, [])
    step = 0.0005
    times = np.arange(0.0, path.duration(), step)
    places = np.array([path.frame_at(time)[0][:3, 3] for time in times])
    acceleration = np.linalg.norm(np.diff(places, 2, axis=0), axis=1) / step**2
    # Along and across the path are held each by itself.
    assert np.percentile(acceleration, 99) <= math.sqrt(2.0) * found.path_acceleration_mm_s2 * 1.01


def test_the_kept_job_keeps_what_was_told(plan):
    alone = runs.run(jobs.validate(plan.job)).summary["in_tolerance_area_share"]
    assert alone == pytest.approx(plan.after.summary["in_tolerance_area_share"], abs=0.005)
    # What is planned again from it begins where that ended.
    again = planning.plan(jobs.validate(plan.job), {"check": False, "rounds": 1})
    assert again.rounds[0]["in_tolerance"] == pytest.approx(alone, abs=0.005)


def test_it_loses_little_against_a_robot_without_limits(laid, plan):
    free = planning.plan(laid, {**plan.settings, "timing": "job", "acceleration_mm_s2": 0.0})
    share = free.after.summary["in_tolerance_area_share"]
    assert plan.after.summary["in_tolerance_area_share"] > share - 0.02
    assert free.job["simulation"]["timing"] == "constant_feed"
    late = runs.run(robot_time.timed(free.job)).summary["in_tolerance_area_share"]
    assert late < plan.after.summary["in_tolerance_area_share"]
    assert "constant_feed" in cli_plan.text(rounds.summary(free))
    assert "constant_feed" not in cli_plan.text(rounds.summary(plan))


def test_levels_stay_within_blocks(laid):
    plan = planning.plan(laid, {"check": False, "rounds": 2, "levels": 5})
    grinds = ~plan.commands.rapid
    assert len(np.unique(plan.new[grinds])) <= 5
    assert (plan.new <= plan.commands.feed_range[1] + 1e-9)[plan.commands.way() > 0].all()


@pytest.mark.slow
def test_blocks_of_a_plan_on_a_blade():
    file = ROOT.parent / "shared" / "data" / "cad" / "blade_marine_upper.iges"
    file = Path(os.environ.get("BELTGRINDING_SHARED", file.parents[2])) / "data" / "cad" / file.name
    if not file.exists():
        pytest.skip("the test data are not there")
    given = {
        "design": {"file": str(file), "faces": [1]},
        "sampling": {"spacing_mm": 1.0},
        "stock": {"allowance_mm": 0.3},
        "belt_machine": {"wheel": {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}},
        "cell": {"check_collisions": False},
        "programs": [{"poses": []}],
    }
    laid = raster_path.raster(jobs.validate(given), {"along": "u", "smoothing_mm": 10.0})
    given["programs"] = [{"poses": poses.list_poses(laid)}]
    within(planning.plan(jobs.validate(given), {"check": False, "rounds": 2, "force_min_N": 2.0}))
