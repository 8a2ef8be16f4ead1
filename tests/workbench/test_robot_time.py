"""The robot's time: its controller's limits in a job, and plans that keep to them."""

import pytest

from beltgrinding.base import schemas
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs, robot_time
from beltgrinding.presets import library

SIMULATION = schemas.schema("job")["properties"]["simulation"]["properties"]


def job_of(**more):
    poses = [{"x_mm": x, "y_mm": 0, "z_mm": 0, "qw": 1, "qx": 0, "qy": 0, "qz": 0} for x in (0, 9)]
    given = {"design": {"file": "part.step"}, "programs": [{"poses": poses}], **more}
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
