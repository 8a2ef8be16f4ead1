"""Tracks and positioners: where they put the robot, what meets on their way, what is written; where a robot stands best."""

import csv
import json
import math
import re

import numpy as np
import pytest
from test_collision import brep
from test_raster import X, job_of, plate
from test_robot_program import ABB, HOME, KUKA, cell, jobs_plain, run as program_robot
from test_robot import run as reach_command

from beltgrinding.base import frames
from beltgrinding.cell import collision, placing, reach, tool_path
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs, workpiece
from beltgrinding.job.typed import typed
from beltgrinding.presets import external_axes, robot as robots
from beltgrinding.programs.writers.writer import ProgramError
from beltgrinding.raster import raster_path as raster
from beltgrinding.robot_program import external, scenes, write as writing

TRACK = {"kind": "linear", "carries": "robot", "axis": [0, 2, 0], "lower": -900, "upper": 900}
TURN = {"kind": "rotary", "carries": "part", "origin_mm": [50, 30, 0], "lower": -180, "upper": 180}


@pytest.fixture(scope="module")
def laid():
    return raster.raster(job_of(plate()), {**X, "step_over_mm": 20, "feed_mm_s": 40})


def with_axes(*axes, **keys):
    return {**KUKA, "external_axes": list(axes), **keys}


def test_a_track_moves_the_robot_and_a_positioner_the_part():
    at_zero = frames.from_abc([-450, 30, -350], [10, 0, 0])
    track = robots.checked(with_axes({**TRACK, "position": 300}))["external_axes"]
    moved = external_axes.base_from_robot(track, [300.0], at_zero)
    assert moved - at_zero == pytest.approx(np.pad([[300.0]], ((1, 2), (3, 0))))
    turn = robots.checked(with_axes(TURN))["external_axes"]
    turned = external_axes.base_from_robot(turn, [90.0], at_zero)
    # What stands before the part on one side stands, seen from the turned part, on the next.
    where = turned[:3, 3] - [50, 30, 0]
    x, y, z = at_zero[:3, 3] - [50, 30, 0]
    assert where == pytest.approx([y, -x, z])
    # Of two axes the first carries the second: tilt about x, then turn about z.
    tilt = {**TURN, "axis": [1, 0, 0], "origin_mm": [0, 0, 0]}
    two = robots.checked(with_axes(tilt, {**TURN, "origin_mm": [0, 0, 0]}))["external_axes"]
    part = external_axes.displacement(two, [90.0, 90.0], "part")
    assert part[:3, :3] @ [1, 0, 0] == pytest.approx([0, 0, 1])


@pytest.mark.slow
def test_an_indexed_cell_is_the_cell_with_the_robot_there(laid):
    """Joints and clearances are those of a job whose robot and bodies stand where the axes put them."""
    post = {"name": "post", "frame": "base", "brep": brep([-70, -290, -350], [-10, -230, 350])}
    by_axes = with_axes({**TRACK, "position": 60}, {**TURN, "position": 20})
    job = typed(cell(by_axes, [post], laid=laid))
    there = robots.robot_frame(robots.checked(by_axes), "base_from_robot")
    told = {"position_mm": there[:3, 3].tolist(), "abc_deg": list(frames.to_abc(there))}
    turned = np.linalg.inv(external_axes.displacement(robots.checked(with_axes(TURN))["external_axes"], [20.0], "part"))  # fmt: skip
    placement = {"position_mm": turned[:3, 3].tolist(), "abc_deg": list(frames.to_abc(turned))}
    plain = typed(cell({**KUKA, "base_from_robot": told}, [{**post, "placement": placement}], laid=laid))  # fmt: skip
    found = []
    for one in (job, plain):
        path = tool_path.tool_path(one, 0, [])
        reached = reach.job_reach(one, [path])
        shape = workpiece.read_design(one.design)
        met = collision.check(one, shape, [path], [], None, reached)
        found.append((reached[0]["joints"], {tuple(p["bodies"]): p["distance"] for p in met[0]["pairs"]}))  # fmt: skip
    assert found[0][0] == pytest.approx(found[1][0], abs=1e-6)
    assert found[0][1].keys() == found[1][1].keys()
    for pair, distance in found[0][1].items():
        assert distance == pytest.approx(found[1][1][pair], abs=0.5), pair


@pytest.mark.parametrize("name, robot", [("whole.src", KUKA), ("whole.mod", ABB)])
def test_a_program_moves_them_with_the_arm_at_home(name, robot, laid, tmp_path):
    axes = [{**TRACK, "position": 40}, {**TURN, "position": 15, "home": -30}]
    home = HOME if name == "whole.src" else [60, 0, 0, 0, 60, 0]
    job = cell({**robot, "external_axes": axes}, laid=laid, home_joints_deg=home)
    whole = writing.plan_job(job)
    assert not whole.problems
    stops = [(0.0, -30.0), (40.0, -30.0), (40.0, 15.0)]
    assert [move.external for move in whole.moves[:3]] == stops
    assert [move.external for move in whole.moves[-3:]] == stops[::-1]
    assert all(move.external == stops[-1] for move in whole.moves[3:-2])
    for move in (*whole.moves[:3], *whole.moves[-3:]):
        assert move.kind == "PTP" and move.joints_deg == pytest.approx(home)
    file = tmp_path / name
    writing.write(file, job, whole)
    text = file.read_text()
    if name == "whole.src":
        targets = re.findall(r"^(?:PTP|LIN) (\{.*\})", text, re.MULTILINE)
        assert len(targets) == len(whole.moves)
        assert all(",E1 " in one and ",E2 " in one for one in targets)
        assert targets[1].endswith(",E1 40,E2 -30}") and targets[3].endswith(",E1 40,E2 15}")
    else:
        assert text.count("[40,15,9E+09,9E+09,9E+09,9E+09]") == len(whole.moves) - 4
        assert text.count("[0,-30,9E+09,9E+09,9E+09,9E+09]") == 2
    again = writing.joints_of_file(file, job)
    wanted = np.stack([move.joints_deg for move in whole.moves])
    assert np.abs(again - wanted).max() < 1e-3


@pytest.mark.slow
def test_what_an_axis_runs_into_is_a_problem(laid, tmp_path):
    """A post beside the arm at home, that the track goes through; and a part that turns into one."""
    post = {"name": "post", "frame": "base", "brep": brep([-560, 330, -350], [-520, 370, 350])}
    robot = with_axes({**TRACK, "home": 700, "position": 0})
    whole = writing.plan_job(cell(robot, [post], laid=laid))
    codes = {fact.code for fact in whole.problems}
    assert codes == {"robot_program.external_meets"}
    assert any("E1" in str(fact) and "post" in str(fact) for fact in whole.problems)
    clear = writing.plan_job(
        cell(with_axes({**TRACK, "home": 0, "position": 0}), [post], laid=laid)
    )
    assert not clear.problems
    beside = {"name": "beside", "frame": "base", "brep": brep([40, 70, -30], [60, 74, 30])}
    turning = with_axes({**TURN, "home": 90, "position": 0})
    whole = writing.plan_job(cell(turning, [beside], laid=laid))
    assert any({"part", "beside"} <= set(re.findall(r"\w+", str(one))) for one in whole.problems)
    with pytest.raises(InputError, match="beside"):
        writing.write(tmp_path / "w.src", cell(turning, [beside], laid=laid), whole)


def test_stages_move_one_axis_each():
    axes = [{"home": 1, "position": 2}, {"home": 5, "position": 5}, {"home": 0, "position": -7}]
    found = external.stages(axes)
    assert [one.number for one in found] == [0, 2]
    assert found[0].begin == (1, 5, 0) and found[0].end == found[1].begin == (2, 5, 0)
    assert found[1].end == (2, 5, -7)


@pytest.mark.parametrize(
    "axis, message",
    [
        ({**TURN, "position": 200}, "E1: its position 200 is beyond its limits of -180 to 180"),
        ({**TURN, "home": -181}, "E1: its home -181 is beyond"),
        ({**TURN, "lower": 10, "upper": 10, "position": 10}, "E1 cannot move: its lower limit 10"),
        ({**TRACK, "axis": [0, 0, 0]}, "E1 has no direction"),
    ],
)
def test_an_axis_that_cannot_stand_there_gets_one_line(axis, message, laid):
    with pytest.raises(InputError, match=message):
        cell(with_axes(axis), laid=laid)


def test_a_held_part_is_on_no_positioner():
    job = jobs_plain(job_of(plate(), robot=KUKA))
    job["cell"] = {"holding": "part_in_hand"}
    with pytest.raises(InputError, match="no external axis carries the part"):
        jobs.validate({**job, "robot": with_axes(TURN)})
    jobs.validate({**job, "robot": with_axes(TRACK)})


def test_languages_without_external_axes_are_refused(laid, tmp_path):
    job = cell(with_axes(TRACK), laid=laid)
    whole = writing.plan_job(job)
    with pytest.raises(ProgramError, match="external axes are written as .src"):
        writing.write(tmp_path / "w.script", job, whole)


def test_what_is_beyond_a_limit_is_not_reached(laid):
    search = placing.Search(typed(cell(KUKA, laid=laid)))
    inside = 0.5 * (search.arm.lower + search.arm.upper) + math.radians(20.0)
    beyond = np.where(np.arange(6) == 4, search.arm.upper + 0.1, inside)
    place = search._judged((), np.stack([inside, beyond, np.full(6, np.nan)]), 0)
    assert place.reached == pytest.approx(1 / 3) and place.margin_deg > 0.0
    (doubt,) = placing.doubts(place, [])
    assert "33.3 %" in str(doubt)
    assert placing.doubts(place._replace(reached=1.0), []) == []
    # Rapid ways are links in a program for the whole robot.
    met = {"kind": "collision", "facts": [{"code": "event.collision_rapid"}]}
    assert not search._is_hard(met) and search._is_hard({**met, "facts": []})
    alone = typed(cell({**KUKA, "program": {}}, laid=laid, home_joints_deg=[]))
    assert placing.Search(alone)._is_hard(met)


@pytest.mark.slow
def test_a_robot_out_of_reach_is_placed(laid, tmp_path):
    far = {**KUKA, "base_from_robot": {"position_mm": [-2500, 30, -350]}, "program": {"home_joints_deg": HOME}}  # fmt: skip
    job = cell(far, laid=laid)
    (tmp_path / "job.json").write_text(json.dumps(jobs_plain(job)))
    done = reach_command(tmp_path, tmp_path / "job.json", "--place", "-o", tmp_path / "map.csv")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["reached"] == 1.0 and told["events"] == []
    rows = list(csv.DictReader((tmp_path / "map.csv").open()))
    assert len(rows) == told["places"] > 400
    assert max(float(row["reached"]) for row in rows) == 1.0
    # By itself: the same job with that place.
    placed = {**KUKA, "base_from_robot": told["base_from_robot"]}
    again = typed(cell(placed, laid=laid))
    path = tool_path.tool_path(again, 0, [])
    (found,) = reach.job_reach(again, [path])
    assert found["events"] == [] and np.isfinite(found["joints"]).all()
    arm = robots.arm_of(robots.checked(placed))
    q = np.radians(found["joints"])
    margin = min(np.minimum(q - arm.lower, arm.upper - q).min(), min(map(arm.singular_distance, q)))
    assert math.degrees(margin) == pytest.approx(told["least_margin_deg"], abs=1e-6)
    # The place that a person chose for these tests is no better.
    by_hand = placing.Search(typed(cell(KUKA, laid=laid)))
    joints = np.radians(reach.job_reach(by_hand.job, by_hand.paths)[0]["joints"])
    assert by_hand._judged((), joints, 0).margin_deg <= told["least_margin_deg"]


@pytest.mark.slow
def test_a_positioner_is_turned_to_where_the_arm_reaches(laid):
    """The robot stands behind the work; the table must turn it about."""
    job = typed(cell(with_axes({**TURN, "origin_mm": [350, 30, 0]}), laid=laid))
    path = tool_path.tool_path(job, 0, [])
    (before,) = reach.job_reach(job, [path])
    search = placing.Search(job)
    place, events = search.run()
    assert place.reached == 1.0 and not events
    assert place.margin_deg >= search._judged((), np.radians(before["joints"]), 0).margin_deg
    assert set(search.made(place.values)) == {"external_axes"}
