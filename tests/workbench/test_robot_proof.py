"""The proof of programs for the whole robot (tools/bench robot) finds what is wrong; and nothing on a real part."""

import numpy as np
import pytest
import robot_program_bench as bench
from test_collision import brep
from test_raster import X, job_of, plate
from test_robot_program import POST, cell

from beltgrinding.base import records
from beltgrinding.job.typed import typed
from beltgrinding.presets import library, robot as robots
from beltgrinding.raster import raster_path as raster
from beltgrinding.robot_program import write as writing
from support.freecad import SHARED


@pytest.fixture(scope="module")
def laid():
    return raster.raster(job_of(plate()), {**X, "step_over_mm": 20, "feed_mm_s": 40})


@pytest.fixture(scope="module")
def planned(laid):
    job = typed(cell(laid=laid, bodies=[POST]))
    return job, writing.plan_job(job)


@pytest.mark.slow
def test_a_sound_program_is_proved(planned):
    found = bench.proved(*planned)
    assert found["met"] == found["beyond"] == 0 and found["kdl"] < 1e-9
    assert found["places"] > 1000 and 0.0 < found["speed"] <= 100.0


@pytest.mark.slow
def test_what_stands_in_the_way_is_found(planned, laid):
    job, whole = planned
    link = next(k for k, one in enumerate(whole.moves) if one.note == "pass 1")
    x, y, z = (whole.moves[link].frame @ [0, 0, -40, 1])[:3]  # the wheel's middle
    post = {"name": "in the way", "frame": "base", "brep": brep([x - 5, y - 5, z - 60], [x + 5, y + 5, z + 60])}  # fmt: skip
    found = bench.proved(typed(cell(laid=laid, bodies=[POST, post])), whole)
    assert found["met"] > 10


@pytest.mark.slow
def test_a_joint_beyond_its_limit_and_a_wrong_pose_are_found(planned):
    job, whole = planned
    robot = records.plain(job.robot)
    narrow = records.plain(robots.model_of(robot))
    narrow["joints"][0]["upper_deg"] = 30.0  # home is at 60
    own = typed({**records.plain(job), "robot": {**robot, "preset": "", "model": narrow}})
    assert bench.proved(own, whole)["beyond"] > 0
    fast = [bench.proved(job, whole)["speed"]]
    for move in whole.moves:
        move.feed *= 100.0
    fast.append(bench.proved(job, whole)["speed"])
    for move in whole.moves:
        move.feed *= 0.01
    assert fast[1] > 20.0 * fast[0]
    last = next(one for one in whole.moves if one.kind == "LIN")
    last.frame[0, 3] += 0.5
    with pytest.raises(AssertionError, match="ends elsewhere"):
        bench.proved(job, whole)
    last.frame[0, 3] -= 0.5


@pytest.mark.parametrize("preset", [one["id"] for one in library.robots()])
def test_kdls_chain_is_that_of_each_preset(preset):
    robot = robots.checked({"preset": preset})
    chain, arm = bench.Chain(robot), robots.arm_of(robot)
    coupled = robots.model_of(robot)["coupling"]
    random = np.random.default_rng(5)
    for q in random.uniform(arm.lower, arm.upper, (5, 6)):
        turned = q + coupled * q[1] * np.eye(6)[2]
        assert chain.link(turned, 6) @ chain.flange == pytest.approx(arm.forward(q), abs=1e-6)


@pytest.mark.slow
@pytest.mark.skipif(not bench.PARTS.is_dir(), reason=f"no shared data at {SHARED}")
@pytest.mark.parametrize("holding", bench.HOLDING)
@pytest.mark.parametrize("robot", bench.ROBOTS)
def test_a_real_part_is_ground_by_three_robots(robot, holding):
    found = bench.measure(bench.job_of("crank_arm", holding), robot, holding)
    assert found["problems"] == []
    assert found["met"] == found["beyond"] == 0
    assert found["kdl"] < 1e-4 and 0.0 < found["speed"] <= 100.0
