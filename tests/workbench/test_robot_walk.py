"""The arm's way through a program: times, joints, what is near, events; a program kept and brought back."""

import json

import numpy as np
import pytest
from test_robot_program import POST, cell

from beltgrinding.presets import robot as robots
from beltgrinding.robot_program import walk as walks, write as writing
from beltgrinding.robot_program.moves import Whole


@pytest.fixture(scope="module")
def planned():
    """A job whose clearance is wide, and its program."""
    job = cell(bodies=[POST])
    job["cell"]["clearance_mm"] = 60.0
    return job, writing.plan_job(job)


def test_the_walk_goes_by_joint_speeds_and_feeds(planned):
    job, whole = planned
    found = walks.walk(job, whole)
    q, t = np.array(found.joints_deg), np.array(found.times)
    assert q[0] == pytest.approx(q[-1], abs=1e-6) and (np.diff(t) > 0).all()
    for k, move in enumerate(whole.moves):
        assert q[found.at_move(k)] == pytest.approx(move.joints_deg, abs=1e-6)
    arm = robots.arm_of(job["robot"])
    share = np.abs(np.diff(np.radians(q), axis=0)) / np.diff(t)[:, None] / arm.max_speed
    links = np.array([whole.moves[k].kind == "PTP" for k in found.moves[1:]])
    percent = job["robot"]["program"]["joint_speed_percent"] / 100.0
    assert share[links].max() == pytest.approx(percent, rel=1e-3) and share.max() < 1.001
    # Frames are the arm's, in the base of the program.
    pose = robots.pose_function(job["robot"])
    for frame, row in zip(found.frames()[::20], q[::20]):
        assert frame == pytest.approx(pose(row), abs=1e-6)
    steps = np.linalg.norm(np.diff(found.frames()[:, :3, 3], axis=0), axis=1)
    assert steps[~links].max() <= walks.STEP * 1.001


def test_what_is_near_is_an_event_with_its_distance(planned):
    job, whole = planned
    found = walks.walk(job, whole)
    listed = walks.events(whole, found, 60.0)
    near = [one for one in listed if one["kind"] == "near_miss" and "post" in one["bodies"]]
    assert near and {one["severity"] for one in near} == {"warning"}
    for one in near:
        assert found.bodies[one["pose"]] == one["bodies"] and 5.0 <= one["value"] <= 60.0
        assert one["time"] <= one["worst_time"] <= one["time"] + one["duration"] + 1e-9
    assert [one["time"] for one in listed] == sorted(one["time"] for one in listed)
    # Where a body stands in the way, the problem has its place.
    whole.add_problem("collision", whole.notes[0] if whole.notes else _fact(), ("post", "wheel"), 3)
    try:
        met = [one for one in walks.events(whole, found, 60.0) if one["severity"] == "error"]
        assert len(met) == 1 and found.moves[met[0]["pose"]] == 3
        assert met[0]["bodies"] == ["post", "wheel"] and met[0]["line"] == whole.moves[3].line
    finally:
        whole.problems.pop()
        whole.incidents.pop()


def _fact():
    from beltgrinding.robot_program import facts

    return facts.meet_there(body="post", other="wheel")


def test_a_program_is_kept_to_the_last_bit(planned):
    job, whole = planned
    back = Whole.from_data(json.loads(json.dumps(whole.data(), allow_nan=False)))
    assert len(back.moves) == len(whole.moves) and back.figures == whole.figures
    for one, other in zip(whole.moves, back.moves):
        assert (one.frame == other.frame).all() and (one.joints_deg == other.joints_deg).all()
        assert (one.feed, one.force, one.zone, one.note) == (
            other.feed, other.force, other.zone, other.note,
        )  # fmt: skip
    assert [str(one) for one in back.notes] == [str(one) for one in whole.notes]
    found = walks.walk(job, whole)
    assert walks.Walk.from_data(json.loads(json.dumps(found.data(), allow_nan=False))) == found
